//! The table of stage 10: the same questions at scales from 2^-60 to 2^60, whose answers are scaled back.

use checks::golden::{Table, digits};
use checks::prelude::*;

/// The exponents of the scales.
const EXPONENTS: [i32; 7] = [-60, -40, -20, 0, 20, 40, 60];

fn lines(kit: &dyn Kit, shift: Vec3) -> String {
    let scales = EXPONENTS.map(|exponent| (exponent as f32).exp2());
    // The products of three lengths must not overflow in single precision, so triangles get a half of the exponent.
    let halves = EXPONENTS.map(|exponent| (0.5 * exponent as f32).exp2());
    let target = vec3(0.3, 0.4, 0.1);
    let eye = vec3(1.0, 2.0, 5.0) + shift;
    let ray = |scale: f32| Ray::new(scale * eye, target - eye);
    let triangle = |scale: f32| Triangle {
        a: scale * vec3(-1.0, -0.5, 0.0),
        b: scale * vec3(1.5, 0.2, 0.3),
        c: scale * vec3(0.1, 1.7, 0.1),
    };
    let sphere = |scale: f32| Sphere { center: scale * vec3(0.2, 0.3, -0.1), radius: 0.8 * scale };
    let bounds = |scale: f32| Aabb::new(scale * vec3(-0.5, -0.6, -0.7), scale * vec3(0.9, 1.0, 0.8));
    let triangles =
        |scales: [f32; 7]| scales.map(|scale| TriangleQuery { ray: ray(scale), triangle: triangle(scale) });
    let watertight = kit.watertight(&triangles(halves));
    let double = kit.triangle_in_double(&triangles(scales));
    let spheres = scales.map(|scale| SphereQuery { ray: ray(scale), sphere: sphere(scale) });
    let spheres = kit.sphere_in_double(&spheres);
    let boxes = scales.map(|scale| SlabQuery { ray: ray(scale), bounds: bounds(scale) });
    let boxes = kit.conservative_slab(&boxes);
    let units = kit.safe_normalize(&scales.map(|scale| scale * vec3(0.3, -0.4, 1.2)));
    // The roots 0.001 and 1000: the smaller one is lost by cancellation.
    let roots = kit.stable_roots(&halves.map(|scale| [1.0, -1000.001 * scale, scale * scale]));
    let number = |value: f32| digits(value, 4);
    let line = |i: usize| {
        let of_triangle = |hit: Option<raykata::kit::TriangleHit>, scale: f32| match hit {
            Some(hit) => [hit.t / scale, hit.beta, hit.gamma].map(number).join(" "),
            None => "-".into(),
        };
        let sphere = spheres[i].map_or("-".into(), |t| number(t / scales[i]));
        let bounds = boxes[i]
            .map_or("-".into(), |(enter, leave)| [enter, leave].map(|t| number(t / scales[i])).join(" "));
        let unit = units[i].map_or("-".into(), |unit| unit.to_array().map(number).join(" "));
        let roots =
            roots[i].map_or("-".into(), |roots| roots.map(|root| digits(root / halves[i], 5)).join(" "));
        format!(
            "2^{}: watertight {}  triangle_in_double {}  sphere_in_double {sphere}  conservative_slab {bounds}  \
             safe_normalize {unit}  stable_roots {roots}",
            EXPONENTS[i],
            of_triangle(watertight[i], halves[i]),
            of_triangle(double[i], scales[i]),
        )
    };
    (0..EXPONENTS.len()).map(line).collect::<Vec<String>>().join("\n")
}

pub(super) fn table_of_seven_scales(trial: &Trial<'_>) -> CheckResult {
    let hidden = (-1.0..1f32, -1.0..1f32, 0.0..3f32).prop_map(Vec3::from);
    let shift = trial.composed(Vec3::ZERO, hidden);
    let input = "one triangle, sphere, box, vector and equation at seven scales, scaled back";
    Table { name: "stage10_seven_scales", input }.check(trial, |kit| lines(kit, shift))
}
