//! Laws for all solids.

use super::solid::Solid;
use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::generate::{direction, point};
use checks::judge::{compare, known};
use checks::paste::call;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use raykata::kit::{SolidHit, SolidQuery};
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

macro_rules! laws {
    ($($solid:ty: $($name:ident $law:ident)*;)*) => {
        $($(pub(super) fn $name(trial: &Trial<'_>) -> Outcome {
            $law::<$solid>(trial)
        })*)*
    };
}

laws! {
    Cuboid: cuboid_agrees_with_exact_arithmetic agrees cuboid_normals_point_outwards outwards
        cuboid_keeps_to_the_rules keeps_to_the_rules;
    Cylinder: cylinder_agrees_with_exact_arithmetic agrees cylinder_normals_point_outwards outwards
        cylinder_keeps_to_the_rules keeps_to_the_rules;
    Cone: cone_agrees_with_exact_arithmetic agrees cone_normals_point_outwards outwards
        cone_keeps_to_the_rules keeps_to_the_rules;
    Disk: disk_keeps_to_the_rules keeps_to_the_rules;
    Polygon: polygon_agrees_with_exact_arithmetic agrees_flat polygon_keeps_to_the_rules keeps_to_the_rules;
}

/// A verdict is judged only if it is the same for the shape this much larger and smaller: methods in single precision are
/// off by a few hundred roundings, 1e-5, of the coordinates here. Edges, rims and tips are looked at by other checks.
const SHELL: f32 = 1e-4;

/// Rays from outside and inside, most of them aimed at a point of the solid.
fn rays<S: Solid>(range: bool) -> impl Strategy<Value = SolidQuery<S>> + Clone {
    let ranges: &[(f32, f32)] = if range {
        &[(0.5, f32::INFINITY), (0.0, 0.75), (1.25, 3.0), (-2.0, 0.875)]
    } else {
        &[(0.0, f32::INFINITY)]
    };
    let inputs = (S::any(), point(8), point(1), direction(), 0..4u32, 0..ranges.len());
    inputs.prop_map(move |(solid, origin, at, direction, kind, range)| {
        let (t_min, t_max) = ranges[range];
        let (origin, direction) = match kind {
            0 => (origin, direction),
            1 if !S::FLAT => (solid.inside(at), direction),
            _ => (origin, solid.inside(at) - origin),
        };
        let direction = if direction == Vec3::ZERO { Vec3::X } else { direction };
        SolidQuery { ray: Ray::new(origin, direction).with_range(t_min, t_max), solid }
    })
}

/// The `t` that may come back, `None` if a miss may, too; nothing if the ray passes too near to an edge to say.
fn expected<S: Solid>(query: &SolidQuery<S>) -> Option<Option<(f32, f32)>> {
    let SolidQuery { ray, solid } = query;
    // Shells of a flat shape lie in its plane and say nothing about a ray that does, too. A height above the plane is off by
    // 1e-5, and by that over the slope where the ray comes through: no more than a shell.
    let slope = own_normal(query).map_or(1.0, |normal| {
        let direction = ray.direction.as_dvec3();
        (direction.dot(normal).abs() / (direction.length() * normal.length())) as f32
    });
    if slope < 1e-5 / SHELL {
        return None;
    }
    let [smaller, larger] = [1.0 - SHELL, 1.0 + SHELL].map(|factor| Some(solid.grown(factor).meet(ray)?.t));
    match (smaller?, solid.meet(ray)?.t, larger?) {
        (None, None, None) => Some(None),
        (Some(p), Some(q), Some(r)) => {
            let (low, high) = (p.min(q).min(r), p.max(q).max(r));
            // A method in single precision is off by a hundred roundings, 1e-5 of the way; twice that, in lengths of direction.
            let slack = 2e-5 * (1.0 + ray.origin.length()) / (slope * ray.direction.length());
            if low - slack <= ray.t_min || ray.t_max <= high + slack {
                return None;
            }
            // A range that begins or ends between the shells gives different ends of the solid. Shells lie 1e-3 apart at
            // most, slanting rays go farther; but the thinnest solid is 1/8 high, so that its ends are beyond a twentieth.
            (high - low < 0.05 / ray.direction.length()).then_some(Some((low - slack, high + slack)))
        }
        _ => None,
    }
}

pub(super) fn input<S: Solid>(query: &SolidQuery<S>) -> String {
    call(S::NAME, &[&query.ray, &query.solid])
}

pub(super) fn judge<S: Solid>(trial: &Trial<'_>, queries: &[SolidQuery<S>]) -> Vec<Outcome> {
    compare(queries, S::ask(trial.kit, queries), |query, yours| {
        let Some(expected) = expected(query) else { return Ok(()) };
        let right = match (yours, expected) {
            (None, None) => true,
            (Some(hit), Some((low, high))) => low <= hit.t && hit.t <= high,
            _ => false,
        };
        if right {
            return Ok(());
        }
        let exact = query.solid.meet(&query.ray).and_then(|meeting| meeting.t);
        let describe = |t: Option<f32>| t.map_or("None".into(), |t| format!("Some at t = {t:?}"));
        Err(Broken::with_texts(
            input(query),
            describe(yours.map(|hit| hit.t)),
            describe(exact),
            "exact arithmetic",
        )
        .looks_like(known(diagnosis(query, yours, exact))))
    })
}

fn diagnosis<S: Solid>(query: &SolidQuery<S>, yours: Option<SolidHit>, exact: Option<f32>) -> &'static str {
    let SolidQuery { ray, solid } = query;
    let endless = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    // This and the rest only word what is wrong already: near enough to recognize a mistake, far from any other number.
    let near = |t: f32, right: f32| (t - right).abs() <= 1e-3 * right.abs().max(0.1);
    let first = solid.meet(&endless).and_then(|meeting| meeting.t);
    let inside = solid.meet(&ray.with_range(f32::NEG_INFINITY, 0.0)).is_some_and(|back| back.t.is_some())
        && solid.meet(&ray.with_range(0.0, f32::INFINITY)).is_some_and(|front| front.t.is_some());
    let last = || {
        let back = Ray { direction: -ray.direction, ..endless };
        solid.meet(&back).and_then(|meeting| meeting.t).map(|t| -t)
    };
    match (yours.map(|hit| hit.t), exact) {
        (Some(t), _) if t.is_nan() => "NaN is no hit: compare so that NaN fails",
        (Some(t), _) if !ray.contains(t) => "a t that ray.contains(t) refuses",
        (None, Some(_)) if inside => {
            "a ray that starts inside meets the surface where it leaves, be it at a side or at an end"
        }
        (None, Some(_)) if first.is_some_and(|t| t <= ray.t_min) => {
            "the way in lies before t_min, but the way out counts"
        }
        (None, Some(_)) if S::FLAT => {
            "a part of it is missing, or one of its two sides: it can be hit from either"
        }
        (None, Some(_)) => "a part of the surface is missing: an end, or a side",
        (Some(_), None) if S::FLAT => "a point of its plane, but beside it",
        (Some(_), None) => "a point beside the solid: beyond an end, or outside of the round",
        (Some(t), Some(right))
            if near(t * ray.direction.length(), right) || near(t / ray.direction.length(), right) =>
        {
            "t must count lengths of direction"
        }
        (Some(t), Some(_)) if last().is_some_and(|last| near(t, last)) => {
            "the far side: the nearest point of the surface in the range of the ray is the hit, be it on a side or on an end"
        }
        (Some(_), Some(_)) => "another point of the endless surface: cut it where the solid ends",
        (None, None) => "",
    }
}

fn agrees<S: Solid>(trial: &Trial<'_>) -> Outcome {
    trial.forall(4000, rays::<S>(false), |queries| judge(trial, queries))
}

/// For shapes without an inside the normal is judged as well: it is the shape's own.
pub(super) fn agrees_flat<S: Solid>(trial: &Trial<'_>) -> Outcome {
    agrees::<S>(trial)?;
    outwards::<S>(trial)
}

/// At a point `p` of a convex solid, `n` is an outward normal if no point `q` has `n · (q - p) > 0`: true on faces, rims and
/// tips alike, whichever of several normals somebody takes there. For a flat shape both sides have this, and the one is
/// right that its own description gives.
fn outwards<S: Solid>(trial: &Trial<'_>) -> Outcome {
    trial.forall(3000, rays::<S>(false), |queries| {
        compare(queries, S::ask(trial.kit, queries), |query, yours| {
            let (Some(hit), Some(Some(_))) = (yours, expected(query)) else { return Ok(()) };
            let normal = hit.normal.as_dvec3();
            let at = query.ray.origin.as_dvec3() + f64::from(hit.t) * query.ray.direction.as_dvec3();
            let beyond = |normal: DVec3| query.solid.reach(normal) - normal.dot(at);
            // The point is off by 1e-5, and the normal by as much of a radius, which is 0.5 or more: over a solid 16 across
            // 3e-4, and some times that is let pass. A hundredth of a radius, 5e-3, would be a wrong normal.
            let outward = beyond(normal) <= 2e-3;
            // A normalized vector is off by 2e-7; fifty times that is no forgotten root.
            let unit = (normal.length() - 1.0).abs() <= 1e-5;
            // A flat shape reaches as far along its normal as against it: nothing but roundings of coordinates up to 8.
            let turned = query.solid.reach(normal) + query.solid.reach(-normal) < 1e-3
                && own_normal(query).is_some_and(|own| own.dot(normal) < 0.0);
            if outward && unit && !turned {
                return Ok(());
            }
            let diagnosis = match () {
                () if turned => {
                    "the normal of the other side: it does not depend on where the ray comes from"
                }
                () if normal.is_nan() => "NaN: a vector of length 0 was made a unit vector",
                () if outward => "the normal is not of unit length",
                () if beyond(-normal) <= 2e-3 => "the normal points inwards",
                () if unit => "not the normal of this part of the surface",
                () => "neither of unit length nor at right angles to the surface",
            };
            Err(Broken::with_texts(
                input(query),
                format!("normal {} at t = {:?}", hit.normal, hit.t),
                "a unit vector out of the surface there",
                "the points of the solid all lie behind it",
            )
            .looks_like(Some(diagnosis)))
        })
    })
}

/// The normal that a flat shape gives itself, if this is one.
fn own_normal<S: Solid>(query: &SolidQuery<S>) -> Option<DVec3> {
    let solid: &dyn std::any::Any = &query.solid;
    if let Some(disk) = solid.downcast_ref::<Disk>() {
        return Some(disk.normal.as_dvec3());
    }
    let corners = &solid.downcast_ref::<Polygon>()?.corners;
    let edge = |i: usize| (corners[i] - corners[0]).as_dvec3();
    Some((2..corners.len()).map(|i| edge(i - 1).cross(edge(i))).sum())
}

fn keeps_to_the_rules<S: Solid>(trial: &Trial<'_>) -> Outcome {
    trial.forall(2000, rays::<S>(true), |queries| judge(trial, queries))?;
    // A direction 1024 times as long makes t as much smaller: t counts lengths of direction, and no limit is a fixed number.
    trial.forall(500, rays::<S>(false), |queries| {
        let answers = S::ask(trial.kit, queries);
        let longer = |query: &SolidQuery<S>| SolidQuery {
            ray: Ray { direction: 1024.0 * query.ray.direction, ..query.ray },
            solid: query.solid.clone(),
        };
        let scaled: Vec<SolidQuery<S>> = queries.iter().map(longer).collect();
        let pairs: Vec<_> = answers.into_iter().zip(S::ask(trial.kit, &scaled)).collect();
        compare(&scaled, pairs, |query, (answer, scaled)| {
            if expected(query).is_none() {
                return Ok(());
            }
            let t = answer.map(|hit| hit.t / 1024.0);
            // Scaling by a power of two is exact, so t should be, too; but a method may make direction a unit vector, which rounds.
            // 1e-5 is eighty such roundings, of t or, near the origin, of coordinates.
            let same = match (t, scaled) {
                (Some(t), Some(hit)) => (hit.t - t).abs() <= 1e-5 * t.max(0.01),
                (None, None) => true,
                _ => false,
            };
            let describe = |t: Option<f32>| t.map_or("None".into(), |t| format!("Some at t = {t:?}"));
            let diagnosis = scaled.is_none().then_some(
                "a fixed epsilon drops it: t is small because direction is long, not because the hit is near",
            );
            if same {
                return Ok(());
            }
            Err(Broken::with_texts(
                input(query),
                describe(scaled.map(|hit| hit.t)),
                describe(t),
                "1/1024 of the t for direction / 1024",
            )
            .looks_like(diagnosis))
        })
    })?;
    nonsense::<S>(trial)
}

fn nonsense<S: Solid>(trial: &Trial<'_>) -> Outcome {
    let mut solids = Vec::new();
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    for _ in 0..20 {
        if let Ok(tree) = S::any().new_tree(&mut runner) {
            solids.push(proptest::strategy::ValueTree::current(&tree));
        }
    }
    let ray = |solid: &S| {
        let origin = Vec3::new(9.0, 8.0, 7.0);
        Ray::new(origin, solid.inside(Vec3::ZERO) - origin)
    };
    let mut queries: Vec<SolidQuery<S>> = Vec::new();
    for solid in solids {
        let ray = ray(&solid);
        let broken = [
            Ray { direction: Vec3::NAN, ..ray },
            Ray { direction: Vec3::ZERO, ..ray },
            Ray { origin: Vec3::NAN, ..ray },
            Ray { origin: Vec3::INFINITY, ..ray },
        ];
        queries.extend(broken.map(|ray| SolidQuery { ray, solid: solid.clone() }));
        queries.push(SolidQuery { ray, solid: solid.grown(f32::NAN) });
    }
    compare(&queries, S::ask(trial.kit, &queries), |query, yours| match yours {
        None => Ok(()),
        Some(hit) => Err(Broken::with_texts(input(query), format!("{hit:?}"), "None", "the definition")
            .looks_like(Some("such a ray or shape cannot be hit; compare so that NaN fails"))),
    })
    .into_iter()
    .collect()
}
