//! Where rays start that go on.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::generate::{magnitude, rough_point, unit};
use checks::judge::{compare, known};
use checks::paste::Paste;
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{Bounce, SecondaryRay, Surface};
use raykata::ray::Ray;

/// A ray that goes on from a surface, and the unit normal on the side to which it goes.
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

/// Points at coordinates of all sizes, on surfaces in any position.
fn at_any_scale() -> impl Strategy<Value = Leaving> + Clone {
    let bounce = prop_oneof![Just(Bounce::Reflection), Just(Bounce::Transmission)];
    (unit(), unit(), rough_point(1.0), magnitude(-3.0, 5.0), bounce).prop_map(
        |(normal, lean, at, size, bounce)| {
            // Seven roundings of each coordinate, as for a point of a triangle of this size.
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

/// R6: the slide starts the ray at `hit.Point()`, which is rounded: in half of all cases the ray meets its own surface.
pub(super) fn rays_that_go_on_leave_their_surface(trial: &Trial<'_>) -> Outcome {
    // A point with a large error, at which mistakes differ most.
    let drawn = [Bounce::Reflection, Bounce::Transmission].map(|bounce| {
        leaving(vec3(30.0, -20.0, 10.0), vec3(0.0, 0.6, 0.8), vec3(0.6, 0.0, 0.8), bounce, 1e-3)
    });
    compare(&drawn, trial.kit.spawn_ray(&drawn), judge).into_iter().collect::<Outcome>()?;
    trial.forall(3000, at_any_scale(), |queries| compare(queries, trial.kit.spawn_ray(queries), judge))
}

fn judge(query: &Leaving, ray: Ray) -> Outcome {
    let (surface, child) = query;
    let broken = |yours: String, expected: String, diagnosis: &'static str| {
        Err(Broken::with_texts(describe(query), yours, expected, "closed form").looks_like(known(diagnosis)))
    };
    let direction = ray.direction.as_dvec3();
    if !((direction.normalize() - child.direction.as_dvec3()).length() < 1e-5) {
        return broken(
            format!("direction {}", ray.direction),
            format!("direction {}", child.direction),
            "the direction is that of the child",
        );
    }
    if ray.t_max != f32::INFINITY {
        return broken(format!("t_max = {}", ray.t_max), "t_max = inf".into(), "the ray has no end");
    }
    let side = side(surface.geometric_normal, child.bounce).as_dvec3();
    let start = ray.origin.as_dvec3() + f64::from(ray.t_min) * direction;
    let moved: DVec3 = start - surface.point.as_dvec3();
    let height = moved.dot(side);
    let bound = surface.error.as_dvec3().dot(side.abs());
    let starts = || format!("starts {height:.3e} beyond the point, on the side to which the ray goes");
    // A hundredth for the rounding of the bound itself.
    if !(height >= 0.99 * bound) {
        let along = moved.normalize_or_zero();
        let diagnosis = match () {
            () if height == 0.0 => {
                "the ray starts on the surface itself, and hits it again in half of all cases"
            }
            () if height <= -0.99 * bound => {
                "the ray starts on the other side: what is mirrored stays on the side of the normal, what goes \
                 through does not"
            }
            () if along.dot(child.direction.as_dvec3()) > 0.99 && along.dot(side) < 0.97 => {
                "the offset goes along the ray, which may be nearly along the surface: go along the normal"
            }
            () => "a fixed offset is too small here: move by the error of the point, error · |n|",
        };
        return broken(starts(), format!("{bound:.3e} or more"), diagnosis);
    }
    // 64 steps of the largest coordinate: anything farther away than that must be seen.
    let most = 64.0 * 2.0 * checks::double::U * f64::from(surface.point.abs().max_element()) + 4.0 * bound;
    if height > most {
        let diagnosis = "a fixed offset is too large here: what touches the surface is not seen";
        return broken(starts(), format!("at most {most:.3e}"), diagnosis);
    }
    Ok(())
}
