//! Which secondary rays leave a surface, and their weights.

use super::directions::arrival;
use super::fresnel::{exact, schlick};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::point;
use checks::judge::{compare, known};
use checks::paste::Paste;
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{Bounce, FresnelQuery, Limits, RefractQuery, ScatterQuery, SecondaryRay};
use raykata::material::{Fresnel, Material};

/// Limits that end no ray of these checks.
pub(super) const FAR: Limits = Limits { max_depth: 100, min_contribution: 0.0 };

pub(super) fn paste(query: &ScatterQuery) -> String {
    let material = &query.material;
    format!(
        "scatter({}, {}, {}, &Material {{ mirror: {}, transmission: {}, index_of_refraction: {}, fresnel: Fresnel::{:?}, ..Material::default() }},\n{}, {}, &{:?})",
        query.direction.paste(),
        query.normal.paste(),
        query.entering,
        material.mirror.paste(),
        material.transmission.paste(),
        material.index_of_refraction.paste(),
        material.fresnel,
        query.weight.paste(),
        query.depth,
        query.limits
    )
}

fn describe(children: &[SecondaryRay]) -> String {
    let one = |child: &SecondaryRay| format!("{:?} of weight {}", child.bounce, child.weight);
    match children {
        [] => "no rays".into(),
        some => some.iter().map(one).collect::<Vec<_>>().join(", "),
    }
}

pub(super) fn find(children: &[SecondaryRay], bounce: Bounce) -> Option<&SecondaryRay> {
    children.iter().find(|child| child.bounce == bounce)
}

/// `(n1, n2)`, and the Fresnel reflectance in double precision.
fn share(query: &ScatterQuery) -> (f32, f32, f64) {
    let index = query.material.index_of_refraction;
    let (n1, n2) = if query.entering { (1.0, index) } else { (index, 1.0) };
    let fresnel = FresnelQuery { cos_theta: -query.direction.dot(query.normal), n1, n2 };
    let share = match query.material.fresnel {
        Fresnel::None => 0.0,
        Fresnel::Schlick => schlick(&fresnel),
        Fresnel::Exact => exact(&fresnel),
    };
    (n1, n2, share)
}

pub(super) fn queries() -> impl Strategy<Value = ScatterQuery> + Clone {
    let fresnel = prop::sample::select(vec![Fresnel::None, Fresnel::Schlick, Fresnel::Exact]);
    (arrival(), any::<bool>(), point(1), point(1), 8..=16i32, fresnel, point(1)).prop_map(
        |((direction, normal), entering, mirror, transmission, index, fresnel, weight)| ScatterQuery {
            direction,
            normal,
            entering,
            material: Material {
                mirror: mirror.abs(),
                transmission: transmission.abs(),
                index_of_refraction: index as f32 / 8.0,
                fresnel,
                ..Material::default()
            },
            weight: weight.abs(),
            depth: 0,
            limits: FAR,
        },
    )
}

pub(super) fn scatter_weighs_rays_by_the_material(trial: &Trial<'_>) -> CheckResult {
    judge_weights(trial, &drawn()).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, queries(), |queries| judge_weights(trial, queries))
}

/// A surface that reflects and transmits; glass that reflects by Fresnel alone; and one channel per secondary ray.
pub(super) fn drawn() -> [ScatterQuery; 3] {
    let query = |mirror: Vec3, transmission: Vec3, fresnel: Fresnel| ScatterQuery {
        direction: vec3(0.96, -0.28, 0.0),
        normal: Vec3::Y,
        entering: true,
        material: Material { mirror, transmission, index_of_refraction: 1.5, fresnel, ..Material::default() },
        weight: vec3(0.5, 0.75, 0.25),
        depth: 0,
        limits: FAR,
    };
    [
        query(vec3(0.25, 0.375, 0.5), vec3(0.5, 0.25, 0.125), Fresnel::Exact),
        query(Vec3::ZERO, Vec3::ONE, Fresnel::Exact),
        query(0.5 * Vec3::X, 0.5 * Vec3::Y, Fresnel::None),
    ]
}

fn judge_weights(trial: &Trial<'_>, queries: &[ScatterQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.scatter(queries), |query, yours| {
        let (n1, n2, share) = share(query);
        let [weight, mirror, transmission] =
            [query.weight, query.material.mirror, query.material.transmission].map(Vec3::as_dvec3);
        let expected = [weight * (mirror + share * transmission), weight * (1.0 - share) * transmission];
        // Another check judges total internal reflection and angles close to it.
        let sine = (1.0 - f64::from(query.direction.dot(query.normal)).powi(2)).max(0.0).sqrt();
        if f64::from(n1 / n2) * sine > 0.999 {
            return Ok(());
        }
        let found = [Bounce::Reflection, Bounce::Transmission]
            .map(|bounce| find(&yours, bounce).map(|child| child.weight.as_dvec3()));
        let weights = found.map(|weight| weight.unwrap_or_default());
        let off = |limit: f64, other: [DVec3; 2]| {
            (0..2).any(|i| !((weights[i] - other[i]).abs().max_element() <= limit))
        };
        if !off(2e-4, expected) {
            return Ok(());
        }
        let same = |other: [DVec3; 2]| !off(1e-4, other);
        let lost = (0..2).any(|i| found[i].is_none() && expected[i].max_element() > 2e-4);
        let through = (1.0 - share) * transmission;
        let diagnosis = match () {
            () if same([mirror + share * transmission, through]) => {
                "you leave out the weight of the incoming ray: multiply by `weight`"
            }
            () if same([weight * expected[0], weight * expected[1]])
                || same([weight * expected[0], expected[1]])
                || same([expected[0], weight * expected[1]]) =>
            {
                "you multiply by the weight of the incoming ray twice"
            }
            () if lost && mirror == DVec3::ZERO && found[0].is_none() && share > 0.0 => {
                "clear glass reflects by Fresnel: test the reflected weight, not material.mirror"
            }
            () if same([weight * (transmission + share * mirror), weight * (1.0 - share) * mirror]) => {
                "you exchange material.mirror and material.transmission"
            }
            () if share > 0.0 && same([weight * mirror, weight * transmission]) => {
                "you leave out material.fresnel"
            }
            () if lost => "you leave out a ray with one channel above 0: test the largest channel",
            () if share > 0.0 => {
                "with Fresnel: reflection mirror + F transmission, refraction (1 - F) transmission"
            }
            () => "",
        };
        let [reflected, transmitted] = expected.map(|weight| weight.as_vec3());
        let expected = format!("Reflection of weight {reflected}, Transmission of weight {transmitted}");
        Err(Broken::with_texts(paste(query), describe(&yours), expected, "the formula in double precision")
            .looks_like(known(diagnosis)))
    })
}

const ENTERING: &str = "entering: n1 = 1 (air), n2 = index_of_refraction (glass)";

/// R4: a ray through a pane of glass leaves it in the direction in which it entered.
pub(super) fn scatter_swaps_indices_when_leaving_glass(trial: &Trial<'_>) -> CheckResult {
    let glass = Material { transmission: Vec3::ONE, index_of_refraction: 1.5, ..Material::default() };
    for direction in [vec3(0.6, -0.8, 0.0), vec3(0.0, -1.0, 0.0), vec3(-0.96, -0.28, 0.0)] {
        let enter = ScatterQuery {
            direction,
            normal: Vec3::Y,
            entering: true,
            material: glass.clone(),
            weight: Vec3::ONE,
            depth: 0,
            limits: FAR,
        };
        let inside = trial.kit.scatter(std::slice::from_ref(&enter)).remove(0);
        let snell = RefractQuery { direction, normal: Vec3::Y, n1: 1.0, n2: 1.5 };
        super::directions::judge_refractions(trial, &[snell]).into_iter().collect::<CheckResult>()?;
        let Some(inside) = find(&inside, Bounce::Transmission).copied() else {
            let broken =
                Broken::with_texts(paste(&enter), describe(&inside), "a refracted ray", "into glass");
            return Err(broken.looks_like(Some(ENTERING)));
        };
        let bent = super::directions::snell(&snell).0.map(|direction| direction.as_vec3());
        if bent.is_some_and(|bent| (inside.direction - bent).length() > 1e-5) {
            let broken =
                Broken::new(paste(&enter), inside.direction, bent, "Snell's law in double precision");
            return Err(broken.looks_like(Some(ENTERING)));
        }
        let leave = ScatterQuery { direction: inside.direction, entering: false, ..enter };
        let outside = trial.kit.scatter(std::slice::from_ref(&leave)).remove(0);
        let out = find(&outside, Bounce::Transmission).map(|child| child.direction);
        if !out.is_some_and(|out| (out - direction).length() < 1e-5) {
            let broken = Broken::new(paste(&leave), out, Some(direction), "as it entered");
            return Err(broken.looks_like(Some(match out {
                Some(out) if out.dot(leave.normal) > 0.0 => {
                    "you turn the normal: it is already on the side that the ray comes from"
                }
                _ => "leaving: n1 = index_of_refraction (glass), n2 = 1 (air)",
            })));
        }
    }
    Ok(())
}

pub(super) fn scatter_refracts_nothing_in_total_reflection(trial: &Trial<'_>) -> CheckResult {
    // R5: 60° inside glass. No ray is refracted, and 0 · NaN makes no NaN.
    for (fresnel, mirrored) in [(Fresnel::None, 0.25), (Fresnel::Schlick, 1.0), (Fresnel::Exact, 1.0)] {
        let query = ScatterQuery {
            direction: vec3(0.866_025_4, -0.5, 0.0),
            normal: Vec3::Y,
            entering: false,
            material: Material {
                mirror: Vec3::splat(0.25),
                transmission: Vec3::splat(0.75),
                index_of_refraction: 1.5,
                fresnel,
                ..Material::default()
            },
            weight: Vec3::ONE,
            depth: 0,
            limits: FAR,
        };
        let yours = trial.kit.scatter(std::slice::from_ref(&query)).remove(0);
        let reflected = find(&yours, Bounce::Reflection).map_or(0.0, |child| child.weight.x);
        let refracted = find(&yours, Bounce::Transmission).is_some();
        let sound = yours.iter().all(|child| child.weight.is_finite() && child.direction.is_finite());
        if refracted || !sound || (reflected - mirrored).abs() > 1e-5 {
            let expected = format!("Reflection of weight {mirrored}, and no Transmission");
            let broken =
                Broken::with_texts(paste(&query), describe(&yours), expected, "total internal reflection");
            return Err(broken
                .looks_like(Some("beyond the critical angle: no refracted ray, and Fresnel reflectance 1")));
        }
    }
    Ok(())
}

pub(super) fn scatter_skips_rays_without_weight(trial: &Trial<'_>) -> CheckResult {
    // R8: a secondary ray of weight 0 costs a whole tree of rays that add nothing.
    let dull = (queries(), 0..3i32).prop_map(|(query, which)| match which {
        0 => ScatterQuery { material: Material::default(), ..query },
        1 => ScatterQuery { weight: Vec3::ZERO, ..query },
        _ => {
            // A red ray on a blue mirror: the product is 0.
            let material = Material { mirror: Vec3::Z, transmission: Vec3::ZERO, ..query.material };
            ScatterQuery { weight: Vec3::X, material, ..query }
        }
    });
    trial.forall(1000, dull, |queries| {
        compare(queries, trial.kit.scatter(queries), |query, yours| {
            if yours.is_empty() {
                return Ok(());
            }
            let broken =
                Broken::with_texts(paste(query), describe(&yours), "no rays", "weight 0 adds nothing");
            Err(broken.looks_like(Some("you trace a secondary ray of weight 0: test its own weight")))
        })
    })
}
