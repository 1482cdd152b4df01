//! The origins of secondary rays.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{magnitude, rough_point, unit};
use checks::judge::{compare, known};
use checks::paste::Paste;
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{Bounce, SecondaryRay, Surface};
use raykata::ray::Ray;

/// A surface and a secondary ray that leaves it.
type Leaving = (Surface, SecondaryRay);

fn leaving(point: Vec3, normal: Vec3, lean: Vec3, bounce: Bounce, error: f32) -> Leaving {
    let side = side(normal, bounce);
    let surface =
        Surface { point, error: Vec3::splat(error), geometric_normal: normal, shading_normal: normal };
    (surface, SecondaryRay { bounce, direction: (side + 0.8 * lean).normalize(), weight: Vec3::ONE })
}

fn side(normal: Vec3, bounce: Bounce) -> Vec3 {
    match bounce {
        Bounce::Reflection => normal,
        Bounce::Transmission => -normal,
    }
}

/// Points with coordinates of all sizes, on surfaces in any orientation.
fn at_any_scale() -> impl Strategy<Value = Leaving> + Clone {
    let bounce = prop_oneof![Just(Bounce::Reflection), Just(Bounce::Transmission)];
    (unit(), unit(), rough_point(1.0), magnitude(-3.0, 5.0), bounce).prop_map(
        |(normal, lean, at, size, bounce)| {
            // An error bound of seven roundings per coordinate, as for a point of a triangle of this size.
            leaving(size * at, normal, lean, bounce, 4e-7 * size)
        },
    )
}

fn describe((surface, child): &Leaving) -> String {
    let direction = child.direction.paste();
    let child = format!(
        "&SecondaryRay {{ bounce: Bounce::{:?}, direction: {direction}, weight: Vec3::ONE }}",
        child.bounce
    );
    format!("spawn_ray({}, {child})", surface.paste())
}

/// R6: the slide starts the ray at `hit.Point()`, which is rounded, so about half of the rays hit their own surface.
pub(super) fn secondary_rays_leave_their_surface(trial: &Trial<'_>) -> CheckResult {
    // Begin with a point with a large error, because known mistakes differ most there.
    let drawn = [Bounce::Reflection, Bounce::Transmission].map(|bounce| {
        leaving(vec3(30.0, -20.0, 10.0), vec3(0.0, 0.6, 0.8), vec3(0.6, 0.0, 0.8), bounce, 1e-3)
    });
    compare(&drawn, trial.kit.spawn_ray(&drawn), judge).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, at_any_scale(), |queries| compare(queries, trial.kit.spawn_ray(queries), judge))
}

fn judge(query: &Leaving, ray: Ray) -> CheckResult {
    let (surface, child) = query;
    let broken = |yours: String, expected: String, diagnosis: &'static str| {
        Err(Broken::with_texts(describe(query), yours, expected, "closed form").looks_like(known(diagnosis)))
    };
    let direction = ray.direction.as_dvec3();
    if !((direction.normalize() - child.direction.as_dvec3()).length() < 1e-5) {
        return broken(
            format!("direction {}", ray.direction),
            format!("direction {}", child.direction),
            "your direction is wrong: use child.direction",
        );
    }
    if ray.t_max != f32::INFINITY {
        return broken(
            format!("t_max = {}", ray.t_max),
            "t_max = inf".into(),
            "a secondary ray is infinite: leave t_max infinite",
        );
    }
    let side = side(surface.geometric_normal, child.bounce).as_dvec3();
    let start = ray.origin.as_dvec3() + f64::from(ray.t_min) * direction;
    let moved: DVec3 = start - surface.point.as_dvec3();
    let height = moved.dot(side);
    let bound = surface.error.as_dvec3().dot(side.abs());
    let starts = || {
        format!("starts {height:.3e} from the point, along the normal of the side into which the ray goes")
    };
    // One per cent of slack for the rounding of the bound itself.
    if !(height >= 0.99 * bound) {
        let along = moved.normalize_or_zero();
        let diagnosis = match () {
            () if height == 0.0 => {
                "your ray starts on the rounded point, so it may hit its own surface (shadow acne)"
            }
            () if height <= -0.99 * bound => {
                "your ray starts on the wrong side: a reflected ray starts on the side of the normal, a \
                 refracted ray on the other side"
            }
            () if along.dot(child.direction.as_dvec3()) > 0.99 && along.dot(side) < 0.97 => {
                "you move the origin along the ray: move it along the geometric normal"
            }
            () => "your offset is too small: move by error·|n|, then each coordinate one float outwards",
        };
        return broken(starts(), format!("{bound:.3e} or more"), diagnosis);
    }
    // 64 float steps of the largest coordinate: the ray must hit any object farther away than that.
    let most = 64.0 * 2.0 * checks::double::U * f64::from(surface.point.abs().max_element()) + 4.0 * bound;
    if height > most {
        let diagnosis = "your offset is too large here: the ray misses objects that nearly touch the surface";
        return broken(starts(), format!("at most {most:.3e}"), diagnosis);
    }
    Ok(())
}
