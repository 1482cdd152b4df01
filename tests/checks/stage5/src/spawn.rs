//! The origins of secondary rays.

use checks::offset::{ALONG_SHADING, Start};
use checks::prelude::*;

/// A surface and a secondary ray that leaves it.
type Leaving = (Surface, SecondaryRay);

/// The geometric normal on the side on which a ray starts.
fn side(surface: &Surface, bounce: Bounce) -> Vec3 {
    match bounce {
        Bounce::Reflection => surface.geometric_normal,
        Bounce::Transmission => -surface.geometric_normal,
    }
}

/// A ray that leaves `surface` at an angle to the geometric normal.
fn leaving(surface: Surface, bounce: Bounce, (angle, turn): (f64, f64)) -> Leaving {
    let direction = nasty::tilted(side(&surface, bounce), angle, turn);
    (surface, SecondaryRay { bounce, direction, weight: Vec3::ONE })
}

/// Rays in all directions down to 0.001 above the horizon, from surfaces with two normals and another error on each axis, at
/// all scales.
fn inputs() -> impl Strategy<Value = Leaving> + Clone {
    let bounce = prop_oneof![Just(Bounce::Reflection), Just(Bounce::Transmission)];
    (nasty::surface(), bounce, nasty::tilt())
        .prop_map(|(surface, bounce, tilt)| leaving(surface, bounce, tilt))
}

fn describe((surface, child): &Leaving) -> String {
    call("spawn_ray", &[surface, child])
}

/// The slide starts the ray at `hit.Point()`, which is rounded, so about half of the rays hit their own surface.
pub(super) fn secondary_rays_leave_their_surface(trial: &Trial<'_>) -> CheckResult {
    trial.each(1000, inputs(), <dyn Kit>::spawn_ray, judge)
}

fn judge(query: &Leaving, ray: Ray) -> Judged {
    let (surface, child) = query;
    let broken =
        |yours: String, expected: String| Broken::with_texts(describe(query), yours, expected, "closed form");
    let direction = ray.direction.as_dvec3().normalize();
    let is = |v: Vec3| (direction - v.as_dvec3()).length() < 1e-5; // a few roundings
    let side = side(surface, child.bounce);
    if !is(child.direction) {
        let [yours, expected] = [ray.direction, child.direction].map(|way| format!("direction {way}"));
        return Err(broken(yours, expected).explained_by([
            (is(side), "your ray goes along the geometric normal: use secondary.direction"),
            (is(surface.shading_normal), "your ray goes along the shading normal: use secondary.direction"),
            (is(-child.direction), "your ray goes backwards: use secondary.direction"),
        ]));
    }
    if ray.t_max != f32::INFINITY {
        return Err(broken(format!("t_max = {}", ray.t_max), "t_max = inf".into())
            .because("a secondary ray is infinite: leave t_max infinite"));
    }
    let start = Start::new(surface, side, child.direction, &ray);
    let starts = || {
        let height = start.height();
        format!("starts {height:.3e} from the point, along the normal of the side into which the ray goes")
    };
    let wrong = || match start.is_too_low() {
        true => {
            let by_shading = surface.geometric_normal.dot(child.direction)
                * surface.shading_normal.dot(child.direction)
                < 0.0;
            // A start on the wrong side that would be right on the other one.
            let other = Start::new(surface, -side, child.direction, &ray);
            broken(starts(), format!("{:.3e} or more", start.least())).explained_by([
                "the side is that of the shading normal: the geometric normal tells on which side the ray goes"
                    .when(by_shading && !other.is_too_low() && other.height() <= other.most()),
                "your ray starts on the wrong side: a reflected ray starts on the side of the normal, a refracted ray on the other side"
                    .when(!other.is_too_low() && other.height() <= other.most()),
            ])
        }
        false => broken(starts(), format!("at most {:.3e}", start.most())),
    };
    let is_right = !start.is_too_low() && !start.is_too_high();
    // The same for rays of one kind only.
    let of_one_kind = [Bounce::Reflection, Bounce::Transmission].map(|bounce| {
        ALONG_SHADING.when(if child.bounce == bounce { start.is_along_shading() } else { is_right })
    });
    unless(is_right, wrong).formulas(start.mistakes().into_iter().chain(of_one_kind))
}
