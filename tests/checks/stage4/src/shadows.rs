//! Shadow rays.

use checks::offset::Start;
use checks::prelude::*;

/// Angles closer to 90° than this have a cosine whose sign rounding may change; they are not asked.
const CLEAR: f32 = 1e-4;

/// A light in direction `direction` at distance `distance`.
pub(super) fn light(direction: Vec3, distance: f32) -> LightSample {
    LightSample { direction, distance, radiance: Vec3::ONE }
}

/// A surface at the origin with one normal.
fn flat(normal: Vec3) -> Surface {
    Surface { point: Vec3::ZERO, error: Vec3::splat(1e-7), geometric_normal: normal, shading_normal: normal }
}

/// The cosines of the angles between a direction and both normals of a surface, and the smaller one.
pub(super) fn lowest(surface: &Surface, direction: Vec3) -> f32 {
    surface.geometric_normal.dot(direction).min(surface.shading_normal.dot(direction))
}

/// Lights in front of surfaces: in all directions down to 0.001 above the horizon, on surfaces with two normals and another
/// error on each axis, at all scales.
pub(super) fn lit() -> impl Strategy<Value = ShadowQuery> + Clone {
    (nasty::surface(), nasty::tilt(), fractions(1..=64, 4.0), nasty::any_scale()).prop_filter_map(
        "a light in front",
        |(surface, (angle, turn), distance, scale)| {
            let direction = nasty::tilted(surface.geometric_normal, angle, turn);
            let light = light(direction, scale * distance);
            (lowest(&surface, direction) > CLEAR).then_some(ShadowQuery { surface, light })
        },
    )
}

/// The error that a query gets the text `yours`, but another one is expected.
fn broken(query: &ShadowQuery, yours: impl Into<String>, expected: impl Into<String>) -> Broken {
    Broken::with_texts(query.call("shadow_ray"), yours, expected, "closed form")
}

/// Judges shadow rays to lights in front of a surface by `law`.
fn judge_shadow_rays(
    trial: &Trial<'_>,
    queries: &[ShadowQuery],
    law: impl Fn(&ShadowQuery, &Ray) -> Judged,
) -> Vec<CheckResult> {
    compare(queries, trial.kit.shadow_ray(queries), |query, yours| {
        let expected = "a ray: the light is in front of the surface";
        yours.map_or_else(|| Err(broken(query, "None", expected)), |ray| law(query, &ray))
    })
}

pub(super) fn shadow_ray_reaches_just_short_of_the_light(trial: &Trial<'_>) -> CheckResult {
    let suns = [vec3(0.6, 0.8, 0.0), Vec3::Y]
        .map(|direction| ShadowQuery { surface: flat(Vec3::Y), light: light(direction, f32::INFINITY) });
    all_hold(judge_shadow_rays(trial, &suns, judge_end))?;
    trial.forall(500, lit(), |queries| judge_shadow_rays(trial, queries, judge_end))
}

/// The surface of the light itself must not occlude it. An object close to the light must.
fn judge_end(query: &ShadowQuery, ray: &Ray) -> Judged {
    let light = &query.light;
    let length = ray.direction.as_dvec3().length();
    let unit = ray.direction.as_dvec3() / length;
    // A direction that is computed again has a few rounding errors, of 1e-7 each.
    if !((unit - light.direction.as_dvec3()).length() < 1e-4) {
        let away = (unit + light.direction.as_dvec3()).length() < 1e-4;
        let [yours, expected] = [ray.direction, light.direction].map(|way| format!("direction {way}"));
        return Err(broken(query, yours, expected)
            .explained_by([(away, "your ray goes away from the light: use light.direction")]));
    }
    if light.distance == f32::INFINITY {
        let says =
            "a directional light is infinitely far away: t_max stays infinite".when(ray.t_max.is_finite());
        let broken = broken(query, format!("t_max = {}", ray.t_max), "t_max = inf").explained_by([says]);
        return if ray.t_max == f32::INFINITY { Ok(().into()) } else { Err(broken) };
    }
    // Compare t_max itself if t counts world units, because the length of a unit vector is rounded as well, and likewise if
    // t is 1 at the light.
    let (end, distance) = (f64::from(ray.t_max), f64::from(light.distance));
    let reach = match () {
        () if (length - 1.0).abs() < 1e-6 => end,
        () if (length / distance - 1.0).abs() < 1e-6 => end * distance,
        () => end * length,
    };
    let subtracted = (1..=7).map(|digits| {
        "you subtract the same length at every scale: end at a fraction of the distance"
            .when(ray.t_max == light.distance - 10f32.powi(-digits))
    });
    let broken = || {
        broken(query, format!("ends after {reach:?}"), format!("just below {distance:?}")).explained_by(named![
            (length - 1.0).abs() > 1e-3 && (0.99 * distance..=distance).contains(&end) =>
                "t counts lengths of the direction: if the direction ends at the light, t is 1 there",
            reach == f64::INFINITY => "your ray goes on behind the light, where no object can occlude the light: set t_max",
            reach >= distance => "your ray reaches the light, so the light would occlude itself: end slightly before it",
            reach < 0.99 * distance => "your ray ends too early: it misses objects just in front of the light",
        ])
    };
    unless(reach < distance && reach >= 0.99 * distance, broken).formulas(subtracted)
}

/// Judges the starts of shadow rays. The true surface is up to `error` above the point.
fn judge_starts(
    trial: &Trial<'_>,
    is_right: fn(&Start) -> bool,
    expected: fn(&Start) -> String,
) -> CheckResult {
    trial.forall(1000, lit(), |queries| {
        judge_shadow_rays(trial, queries, |query, ray| {
            let ShadowQuery { surface, light } = query;
            let start = Start::new(surface, surface.geometric_normal, light.direction, ray);
            let broken = || {
                let yours = format!("starts {:.3e} above the point", start.height());
                let below = "your ray starts below the surface: move to the viewer's side";
                broken(query, yours, expected(&start)).explained_by([(start.height() < 0.0, below)])
            };
            unless(is_right(&start), broken).formulas(start.mistakes())
        })
    })
}

pub(super) fn shadow_ray_leaves_its_own_surface_at_any_scale(trial: &Trial<'_>) -> CheckResult {
    judge_starts(trial, |start| !start.is_too_low(), |start| format!("{:.3e} or more", start.least()))
}

pub(super) fn shadow_ray_sees_what_is_close(trial: &Trial<'_>) -> CheckResult {
    judge_starts(trial, |start| !start.is_too_high(), |start| format!("at most {:.3e}", start.most()))
}

pub(super) fn shadow_ray_is_not_traced_without_effect(trial: &Trial<'_>) -> CheckResult {
    // Lights on all sides of both normals. Of four lights one is switched off, and one has a single colour.
    let lights = (nasty::surface(), nasty::unit(), 0..4i32).prop_filter_map(
        "clearly on one side of both normals",
        |(surface, direction, kind)| {
            let radiance = [Vec3::ZERO, Vec3::Z, Vec3::ONE, Vec3::X][kind as usize];
            let light = LightSample { radiance, ..light(direction, 5.0) };
            let clear = |normal: Vec3| normal.dot(direction).abs() > CLEAR;
            (clear(surface.geometric_normal) && clear(surface.shading_normal))
                .then_some(ShadowQuery { surface, light })
        },
    );
    // Light exactly parallel to the surface, by either normal or both, adds nothing. These products are exact.
    let lean = |normal: Vec3| Surface { shading_normal: normal, ..flat(Vec3::Y) };
    let ties = [
        (flat(Vec3::Y), Vec3::X),
        (lean(vec3(-0.6, 0.8, 0.0)), vec3(0.8, 0.6, 0.0)),
        (lean(vec3(0.6, 0.8, 0.0)), Vec3::X),
        (flat(Vec3::NEG_Z), Vec3::NEG_Y),
    ]
    .map(|(surface, direction)| ShadowQuery { surface, light: light(direction, 5.0) });
    trial.each_and(&ties, 1000, lights, <dyn Kit>::shadow_ray, judge_effect)
}

fn judge_effect(query: &ShadowQuery, yours: Option<Ray>) -> CheckResult {
    let ShadowQuery { surface, light } = query;
    let [geometric, shading] =
        [surface.geometric_normal, surface.shading_normal].map(|normal| normal.dot(light.direction));
    let dark = light.radiance == Vec3::ZERO;
    let lit = geometric > 0.0 && shading > 0.0 && !dark;
    let Some(ray) = yours.filter(|_| !lit) else {
        if yours.is_some() || !lit {
            return Ok(());
        }
        let single = light.radiance.min_element() == 0.0;
        let expected = "a ray: the light is in front of the surface, and not switched off";
        return Err(Broken::with_texts(query.call("shadow_ray"), "None", expected, "the definition")
            .explained_by(named![
                single => "you return None for a light that is black in one channel: return None if all are 0",
            ]));
    };
    let yours = format!("a ray along {}", ray.direction);
    Err(Broken::with_texts(query.call("shadow_ray"), yours, "None", "the definition").explained_by(named![
        dark && geometric > 0.0 && shading > 0.0 => "you trace a ray to a light of radiance 0, which adds nothing: return None",
        geometric.min(shading) == 0.0 && !dark => "you trace a ray to a light whose cosine with a normal is 0: return None",
        geometric > 0.0 && shading <= 0.0 => "you trace a ray to a light behind the shading normal: test both normals",
        geometric <= 0.0 && shading > 0.0 => "you trace a ray to a light behind the geometric normal: test both normals",
        geometric.min(shading) <= 0.0 => "you trace a ray to a light behind the surface, which adds nothing: return None",
    ]))
}
