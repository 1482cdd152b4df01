//! Laws that hold for all solids.

use super::solid::Solid;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
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
        $($(pub(super) fn $name(trial: &Trial<'_>) -> CheckResult {
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

/// An answer is judged only if the shape scaled up and down by this fraction is hit or missed alike: methods in single
/// precision have errors of a few hundred roundings, 1e-5 of the coordinates here. Other checks test edges, rims and
/// apexes.
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

/// The interval of correct `t`, or `Some(None)` for a miss. `None` if the ray passes too near to an edge to judge.
fn expected<S: Solid>(query: &SolidQuery<S>) -> Option<Option<(f32, f32)>> {
    let SolidQuery { ray, solid } = query;
    // The scaled copies of a flat shape lie in its plane and cannot judge a ray that lies in this plane, too. A height
    // above the plane has an error of 1e-5, and the point in the plane that error over the slope: demand less than a
    // shell.
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
            // A method in single precision has an error of a hundred roundings, 1e-5 of t; allow twice that, in lengths
            // of direction.
            let slack = 2e-5 * (1.0 + ray.origin.length()) / (slope * ray.direction.length());
            if low - slack <= ray.t_min || ray.t_max <= high + slack {
                return None;
            }
            // If the range of the ray begins or ends between the scaled copies, their hits are different ends of the
            // solid. The copies are at most 1e-3 apart, more along slanting rays; two ends of a solid are more than
            // 0.05 apart.
            (high - low < 0.05 / ray.direction.length()).then_some(Some((low - slack, high + slack)))
        }
        _ => None,
    }
}

pub(super) fn input<S: Solid>(query: &SolidQuery<S>) -> String {
    call(S::NAME, &[&query.ray, &query.solid])
}

pub(super) fn judge<S: Solid>(trial: &Trial<'_>, queries: &[SolidQuery<S>]) -> Vec<CheckResult> {
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
    let infinite = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    // The answer is wrong already. This tolerance only chooses the diagnosis.
    let near = |t: f32, right: f32| (t - right).abs() <= 1e-3 * right.abs().max(0.1);
    let first = solid.meet(&infinite).and_then(|meeting| meeting.t);
    let inside = solid.meet(&ray.with_range(f32::NEG_INFINITY, 0.0)).is_some_and(|back| back.t.is_some())
        && solid.meet(&ray.with_range(0.0, f32::INFINITY)).is_some_and(|front| front.t.is_some());
    let last = || {
        let back = Ray { direction: -ray.direction, ..infinite };
        solid.meet(&back).and_then(|meeting| meeting.t).map(|t| -t)
    };
    match (yours.map(|hit| hit.t), exact) {
        (Some(t), _) if t.is_nan() => "you return NaN: write the comparisons so that they are false for NaN",
        (Some(t), _) if !ray.contains(t) => "you return a t outside of the ray's range: test ray.contains(t)",
        (None, Some(_)) if inside => {
            "you return None for a ray that starts inside: it hits the surface where it leaves, on a side or \
             on an end"
        }
        (None, Some(_)) if first.is_some_and(|t| t <= ray.t_min) => {
            "you give up because the entry lies before t_min: the exit still counts"
        }
        (None, Some(_)) if S::FLAT => {
            "you lose a part of the shape, or one of its two sides: a ray can hit it from both"
        }
        (None, Some(_)) => "you lose a part of the surface: an end, or a side",
        (Some(_), None) if S::FLAT => "you return a point of the plane that lies outside of the shape",
        (Some(_), None) => "you return a point outside of the solid: beyond an end, or beside it",
        (Some(t), Some(right))
            if near(t * ray.direction.length(), right) || near(t / ray.direction.length(), right) =>
        {
            "your t has another unit: it counts lengths of direction"
        }
        (Some(t), Some(_)) if last().is_some_and(|last| near(t, last)) => {
            "you return the far side: the hit is the nearest point of the surface in the ray's range, on a \
             side or on an end"
        }
        (Some(_), Some(_)) => {
            "your hit is not the nearest point of the surface: check the roots, and intersect with the \
             interval between the ends"
        }
        (None, None) => "",
    }
}

fn agrees<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    trial.forall(4000, rays::<S>(false), |queries| judge(trial, queries))
}

/// For flat shapes this judges the normal, too, which must be that of the shape's description.
pub(super) fn agrees_flat<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    agrees::<S>(trial)?;
    outwards::<S>(trial)
}

/// At a point `p` of a convex solid, `n` is an outward normal if no point `q` of the solid has `n · (q - p) > 0`. This
/// holds on faces, rims and apexes, for each of the possible normals there. A flat shape has two such normals, and the
/// one that its description gives is right.
fn outwards<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    trial.forall(3000, rays::<S>(false), |queries| {
        compare(queries, S::ask(trial.kit, queries), |query, yours| {
            let (Some(hit), Some(Some(_))) = (yours, expected(query)) else { return Ok(()) };
            let normal = hit.normal.as_dvec3();
            let at = query.ray.origin.as_dvec3() + f64::from(hit.t) * query.ray.direction.as_dvec3();
            let beyond = |normal: DVec3| query.solid.reach(normal) - normal.dot(at);
            // The hit point has an error of 1e-5, and the normal one of 1e-5 of a radius, which is 0.5 or more:
            // together 3e-4 over a solid 16 across. The limit is some times that; an error of 0.01 of a radius would
            // give 5e-3.
            let outward = beyond(normal) <= 2e-3;
            // A normalized vector has an error of 2e-7; the limit is fifty times that.
            let unit = (normal.length() - 1.0).abs() <= 1e-5;
            // The extent of a flat shape along its normal is 0, up to rounding errors of coordinates up to 8.
            let turned = query.solid.reach(normal) + query.solid.reach(-normal) < 1e-3
                && own_normal(query).is_some_and(|own| own.dot(normal) < 0.0);
            if outward && unit && !turned {
                return Ok(());
            }
            let diagnosis = match () {
                () if turned => {
                    "you return the normal of the other side: it does not depend on where the ray comes from"
                }
                () if normal.is_nan() => "your normal is NaN: you normalized a vector of length 0",
                () if outward => "your normal does not have unit length",
                () if beyond(-normal) <= 2e-3 => "your normal points inwards",
                () if unit => "you return a unit vector that is not perpendicular to the surface at the hit",
                () => "your normal has another length than 1 and is not perpendicular to the surface",
            };
            Err(Broken::with_texts(
                input(query),
                format!("normal {} at t = {:?}", hit.normal, hit.t),
                "the outward unit normal at the hit",
                "all points of the solid lie behind it",
            )
            .looks_like(Some(diagnosis)))
        })
    })
}

/// The normal from the description of a flat shape; `None` for a solid.
fn own_normal<S: Solid>(query: &SolidQuery<S>) -> Option<DVec3> {
    let solid: &dyn std::any::Any = &query.solid;
    if let Some(disk) = solid.downcast_ref::<Disk>() {
        return Some(disk.normal.as_dvec3());
    }
    let corners = &solid.downcast_ref::<Polygon>()?.corners;
    let edge = |i: usize| (corners[i] - corners[0]).as_dvec3();
    Some((2..corners.len()).map(|i| edge(i - 1).cross(edge(i))).sum())
}

fn keeps_to_the_rules<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    trial.forall(2000, rays::<S>(true), |queries| judge(trial, queries))?;
    // A direction 1024 times as long must give 1/1024 of t, because t counts lengths of the direction.
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
            // Scaling by a power of two is exact, but a method may normalize the direction, which rounds. Allow 1e-5,
            // which is eighty such rounding errors, of t or, near the origin, of the coordinates.
            let same = match (t, scaled) {
                (Some(t), Some(hit)) => (hit.t - t).abs() <= 1e-5 * t.max(0.01),
                (None, None) => true,
                _ => false,
            };
            let describe = |t: Option<f32>| t.map_or("None".into(), |t| format!("Some at t = {t:?}"));
            let diagnosis = scaled.is_none().then_some(
                "you drop the hit by a fixed epsilon: t is small because direction is long, not because the \
                 hit is near",
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
    invalid_numbers::<S>(trial)
}

fn invalid_numbers<S: Solid>(trial: &Trial<'_>) -> CheckResult {
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
            .looks_like(Some(
                "you return a hit for an invalid ray or shape: write comparisons that are false for NaN",
            ))),
    })
    .into_iter()
    .collect()
}
