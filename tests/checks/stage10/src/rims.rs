//! The laws of `sphere_in_double`.

use super::doubles::{SINGLE, describe, err_both_ways};
use checks::double::sphere_roots;
use checks::prelude::*;
use oracle::STABLE;
use oracle::exact::{Body, Meeting, meet, sphere, t_in_double};
use oracle::splitmix::Random;

/// A verdict may be wrong if r² and |f⊥|² differ by less than this fraction of |f|², where f goes from the centre to
/// the origin. The simplest method, b² - a c in double precision, has an error of at most 16 times 2^-53 there, because
/// each product has eight roundings.
const UNDECIDED: f64 = 1.0 / (1u64 << 48) as f64;

/// The error of the nearest `t` that is allowed besides a unit of its last place, as a fraction of |f| / |d|.
/// `t_ca - t_hc` in double precision loses 2^-48 of it for an origin near the surface, where both terms are as large as
/// r and the chord is at least half as long.
const CANCELLED: f64 = 1.0 / (1u64 << 46) as f64;

const CONVERTED_LATE: &str = "the difference of origin and centre is rounded to f32 before the rest is computed, and stays rounded when it is converted: convert the origin and the centre first";

/// A ray that passes the centre of the sphere at `aside` radii, its nearest point at `t = 1`; the origin is `away`
/// radii from the centre. Centre and origin are about as far from 0 as from each other, so that their difference is
/// rounded in single precision.
fn aimed(random: &mut Random, away: f64, aside: f64) -> SphereQuery {
    let radius = 10f32.powf(2.0 * random.signed());
    let reach = (f64::from(radius) * away) as f32;
    let center = reach * random.in_cube();
    let origin = center + reach * random.direction();

    let from_center = origin.as_dvec3() - center.as_dvec3();
    let back = -from_center.normalize();
    let across = back.cross(random.direction().as_dvec3()).normalize();
    let sin = (aside * f64::from(radius) / from_center.length()).min(1.0);
    let cos = (1.0 - sin * sin).sqrt();
    let direction = from_center.length() * cos * (cos * back + sin * across);
    SphereQuery { ray: Ray::new(origin, direction.as_vec3()), sphere: Sphere { center, radius } }
}

/// A random power of ten between `10^low` and `10^high`.
fn ten_to(random: &mut Random, low: f64, high: f64) -> f64 {
    10f64.powf(low + (high - low) * f64::from(random.unit()))
}

/// A ray at the rim of a sphere 1 to 100,000 radii away, or a ray for which its range decides, from there or from
/// inside.
fn at_rim(random: &mut Random) -> SphereQuery {
    let away = ten_to(random, 0.3, 5.0);
    // Aim at most half a radius off the centre: then either root is at least 8e-6 from t = 1.
    let well_inside = 0.5 * f64::from(random.unit());
    let ranged = |random: &mut Random, t_min: f32, t_max: f32| {
        let query = aimed(random, away, well_inside);
        SphereQuery { ray: query.ray.with_range(t_min, t_max), ..query }
    };
    match random.below(12) {
        0 => {
            let query = aimed(random, away, well_inside);
            SphereQuery { ray: Ray::new(query.ray.origin, -query.ray.direction), ..query }
        }
        1 => ranged(random, 0.0, 0.4),
        2 => ranged(random, 2.0, f32::INFINITY),
        3 => ranged(random, 1.0, f32::INFINITY),
        4 => from_inside(random, well_inside),
        _ => {
            let beside = ten_to(random, -7.0, -1.0);
            let aside = if random.below(2) == 0 { 1.0 - beside } else { 1.0 + beside };
            aimed(random, away, aside)
        }
    }
}

/// A ray that starts inside, `away < 1` radii from the centre.
fn from_inside(random: &mut Random, away: f64) -> SphereQuery {
    let query = aimed(random, away.max(0.01), 0.0);
    SphereQuery { ray: Ray::new(query.ray.origin, query.sphere.radius * random.direction()), ..query }
}

/// How far the verdict is from flipping: `|r² - |f⊥|²| / |f|²`.
fn margin(SphereQuery { ray, sphere }: &SphereQuery) -> f64 {
    let (f, d) = (ray.origin.as_dvec3() - sphere.center.as_dvec3(), ray.direction.as_dvec3());
    (f64::from(sphere.radius).powi(2) - f.cross(d).length_squared() / d.length_squared()).abs()
        / f.length_squared()
}

/// The exact answer for the input of a known mistake: the origin relative to the centre is rounded to single precision.
fn subtracted_in_single(SphereQuery { ray, sphere }: &SphereQuery) -> Option<Meeting> {
    let ray = Ray { origin: ray.origin - sphere.center, ..*ray };
    meet(&ray, Body::Sphere(Sphere { center: Vec3::ZERO, ..*sphere }))
}

pub(super) fn double_sphere_is_right_at_rims(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 17);
    let queries: Vec<SphereQuery> = (0..8000).map(|_| at_rim(&mut random)).collect();
    let judge = |(query, yours): (&SphereQuery, Option<f32>)| {
        let exact = meet(&query.ray, Body::Sphere(query.sphere))?;
        let right = yours.is_some() == exact.verdict.is_hit() || margin(query) <= UNDECIDED;
        (!right).then_some((*query, yours, exact.t))
    };
    let answers = trial.kit.sphere_in_double(&queries);
    let mut wrong: Vec<_> = queries.iter().zip(answers.iter().copied()).filter_map(judge).collect();
    // Report the plainest error.
    wrong.sort_by(|(p, ..), (q, ..)| margin(q).total_cmp(&margin(p)));
    let single = wrong.iter().all(|(query, ..)| margin(query) <= STABLE * U)
        && err_both_ways(wrong.iter().map(|(_, yours, _)| yours.is_some()));
    // The answers for a direction of length 1: q = -b ± √(b² - c) or q = -b ± √(r² - |f - b d|²), and c / q.
    let assumes_unit = [false, true].into_iter().any(|by_foot| {
        queries.iter().zip(&answers).all(|(SphereQuery { ray, sphere }, yours)| {
            let (f, d) = (ray.origin.as_dvec3() - sphere.center.as_dvec3(), ray.direction.as_dvec3());
            let (b, squared_radius) = (f.dot(d), f64::from(sphere.radius).powi(2));
            let across = if by_foot { (f - b * d).length_squared() } else { f.length_squared() - b * b };
            let q = -b - (squared_radius - across).sqrt().copysign(b);
            let of_unit = [(f.length_squared() - squared_radius) / q, q].map(|t| t as f32);
            // NaN, the square root of a negative number, is in no range.
            match (of_unit.into_iter().filter(|t| ray.contains(*t)).reduce(f32::min), yours) {
                (Some(t), Some(yours)) => (t - yours).abs() <= 1e-3 * t.abs(),
                (t, yours) => t.is_none() && yours.is_none(),
            }
        })
    });
    let broken = |(query, yours, exact): &(SphereQuery, Option<f32>, Option<f32>)| {
        let line = query.ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
        let on_the_line = meet(&line, Body::Sphere(query.sphere)).is_some_and(|it| it.verdict.is_hit());
        let only_the_far_root =
            sphere::roots(&query.ray, &query.sphere).is_some_and(|it| !it.near_counts && it.far_counts);
        let converted_late =
            subtracted_in_single(query).is_some_and(|exact| exact.t.is_some() == yours.is_some());
        let expected = format!("{exact:?}, {}", describe(margin(query) / U));
        Err(Broken::with_texts(query.call("sphere_in_double"), format!("{yours:?}"), expected, "exactly").explained_by([
            "you return a hit behind the origin or beyond the range: a root counts only within the range of the ray"
                .when(yours.is_some() && on_the_line),
            "you return None although the far root is in the range: the ray starts inside, or its range begins inside"
                .when(yours.is_none() && only_the_far_root),
            (converted_late, CONVERTED_LATE),
            (assumes_unit, "you take the direction to have length 1: a = d·d, and both roots are divided by it"),
            (single, SINGLE),
        ]))
    };
    all_hold(wrong.iter().map(broken).collect())?;
    touching_rays_hit(trial)?;
    rays_from_the_surface_hit_the_far_side(trial)
}

/// Rays along an axis that start exactly on a sphere with small integer coordinates and go through its inside. The near root
/// is 0, which is not in the range.
fn rays_from_the_surface_hit_the_far_side(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 23);
    let mut from_surface = |index: usize| {
        let center = Vec3::from_array([(); 3].map(|()| random.below(9) as f32 - 4.0));
        // A point of the sphere around 0 with radius 7, whose coordinates are 2, 3 and 6 in any order.
        let numbers = [[2.0, 3.0, 6.0], [3.0, 6.0, 2.0], [6.0, 2.0, 3.0]][index / 3 % 3];
        let point = Vec3::from_array(numbers) * if index % 4 < 2 { 1.0 } else { -1.0 };
        let mut direction = Vec3::ZERO;
        direction[index % 3] = if point.x < 0.0 { 1.0 } else { -1.0 };
        let query =
            SphereQuery { ray: Ray::new(center + point, direction), sphere: Sphere { center, radius: 7.0 } };
        (query, 2.0 * point[index % 3].abs())
    };
    let cases: Vec<(SphereQuery, f32)> = (0..96).map(&mut from_surface).collect();
    let queries: Vec<SphereQuery> = cases.iter().map(|(query, _)| *query).collect();
    all_hold(compare(&cases, trial.kit.sphere_in_double(&queries), |(query, exact), yours| {
        // Allow a rounding of t.
        if yours.is_some_and(|t| (t - exact).abs() <= 1e-6 * exact) {
            return Ok(());
        }
        Err(Broken::new(query.call("sphere_in_double"), yours, Some(*exact), "integers, exactly")
            .explained_by(
            ["you return None for a ray that starts on the sphere and goes through it: it hits the far side"
                .when(yours.is_none())],
        ))
    }))
}

/// Rays along an axis that touch a sphere with small integer coordinates: no product is rounded.
fn touching_rays_hit(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 19);
    let mut touching = |index: usize| {
        let center = Vec3::from_array([(); 3].map(|()| random.below(9) as f32 - 4.0));
        let radius = 1.0 + random.below(8) as f32;
        let (mut direction, mut aside) = (Vec3::ZERO, Vec3::ZERO);
        direction[index % 3] = if index.is_multiple_of(2) { 1.0 } else { -2.0 };
        aside[(index + 1 + index / 3 % 2) % 3] = if index % 4 < 2 { radius } else { -radius };
        let ray = Ray::new(center + aside - 5.0 * direction, direction);
        SphereQuery { ray, sphere: Sphere { center, radius } }
    };
    let queries: Vec<SphereQuery> = (0..96).map(&mut touching).collect();
    all_hold(compare(&queries, trial.kit.sphere_in_double(&queries), |query, yours| {
        // Both roots are one; allow a rounding of t.
        if yours.is_some_and(|t| (t - 5.0).abs() <= 1e-6) {
            return Ok(());
        }
        Err(Broken::new(query.call("sphere_in_double"), yours, Some(5.0), "integers, exactly").explained_by(
            [(yours.is_none(), "you return None for a ray that touches the sphere: it hits it")],
        ))
    }))
}

/// A ray that passes well through a sphere, from far away, from near its surface on either side, or from inside.
fn through(random: &mut Random) -> SphereQuery {
    let aside = 0.9 * f64::from(random.unit());
    let off = ten_to(random, -6.0, -1.0);
    match random.below(4) {
        0 => {
            let away = ten_to(random, 0.3, 5.0);
            aimed(random, away, aside)
        }
        1 => aimed(random, 1.0 + off, aside),
        2 => from_inside(random, 1.0 - off),
        _ => from_inside(random, aside),
    }
}

pub(super) fn double_sphere_has_the_nearest_t(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 18);
    let mut queries: Vec<SphereQuery> = (0..4000).map(|_| through(&mut random)).collect();
    // Leave out rays near a tangent, because there both roots contain the square root of a cancelled difference.
    queries.retain(|query| {
        let (f, d) =
            (query.ray.origin.as_dvec3() - query.sphere.center.as_dvec3(), query.ray.direction.as_dvec3());
        let aside = f.cross(d).length() / d.length();
        aside < 0.96 * f64::from(query.sphere.radius)
    });
    let allowed = |SphereQuery { ray, sphere }: &SphereQuery, rounded: f32| {
        let step = f64::from(rounded.next_up()) - f64::from(rounded);
        let f: DVec3 = ray.origin.as_dvec3() - sphere.center.as_dvec3();
        step + CANCELLED * f.length() / ray.direction.as_dvec3().length()
    };
    let judge = |(query, yours): (&SphereQuery, Option<f32>)| {
        let body = Body::Sphere(query.sphere);
        let (exact, rounded) = (t_in_double(&query.ray, body)??, meet(&query.ray, body)?.t?);
        // All rays pass well inside the rim, so each has a hit.
        let Some(t) = yours else { return Some((*query, yours, rounded, f64::INFINITY)) };
        let off = (f64::from(t) - exact) / allowed(query, rounded);
        (!(off.abs() <= 1.0)).then_some((*query, yours, rounded, off))
    };
    let answers = trial.kit.sphere_in_double(&queries);
    let mut wrong: Vec<_> = queries.iter().zip(answers).filter_map(judge).collect();
    // Report the largest error.
    wrong.sort_by(|(.., p), (.., q)| q.abs().total_cmp(&p.abs()));
    let single = wrong.iter().all(|(_, yours, rounded, _)| {
        yours.is_some_and(|yours| (yours - rounded).abs() <= 1e-2 * rounded.abs())
    }) && err_both_ways(wrong.iter().map(|(.., off)| *off > 0.0));
    let broken = |(query, yours, rounded, _): &(SphereQuery, Option<f32>, f32, f64)| {
        let expected = format!("Some({rounded:?}), or a neighbour");
        let is = |t: f32| yours.is_some_and(|yours| f64::from((t - yours).abs()) <= allowed(query, t));
        // Both roots, in double precision.
        let roots = sphere_roots(&query.ray, &query.sphere).ok();
        let is_far = roots.is_some_and(|roots| query.ray.contains(roots.near as f32) && is(roots.far as f32));
        let input = query.call("sphere_in_double");
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "exactly").explained_by([
            "you return the near root, which is outside the range of the ray: the far one is the hit"
                .when(yours.is_some_and(|yours| !query.ray.contains(yours))),
            (subtracted_in_single(query).and_then(|exact| exact.t).is_some_and(is), CONVERTED_LATE),
            (is_far, "you return the far root, but the near one counts as well"),
            (single, "t has only the accuracy of single precision: round the root, and nothing before it"),
        ]))
    };
    all_hold(wrong.iter().map(broken).collect())?;

    // Ranges that end exactly at the student's own hit, or one float beside it.
    let hits = queries.iter().zip(trial.kit.sphere_in_double(&queries)).take(100);
    let at_ends: Vec<(SphereQuery, f32, bool)> = hits
        .filter_map(|(query, yours)| Some((query, yours?)))
        .flat_map(|(query, t)| {
            let ranges = nasty::ranges(t);
            ranges.map(|((t_min, t_max), counts)| {
                (SphereQuery { ray: query.ray.with_range(t_min, t_max), ..*query }, t, counts)
            })
        })
        .collect();
    let only: Vec<SphereQuery> = at_ends.iter().map(|(query, ..)| *query).collect();
    let judge = |(query, t, counts): &(SphereQuery, f32, bool), yours: Option<f32>| {
        let fits =
            if *counts { yours == Some(*t) } else { yours.is_none_or(|yours| query.ray.contains(yours)) };
        if fits {
            return Ok(());
        }
        let expected = if *counts { format!("Some({t:?})") } else { "None, or the other root".into() };
        let input = query.call("sphere_in_double");
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "ray.contains of the rounded t"))
    };
    let formulas = |(query, ..): &(SphereQuery, f32, bool), yours: &Option<f32>| {
        let (t_min, t_max) = (f64::from(query.ray.t_min), f64::from(query.ray.t_max));
        let roots = sphere_roots(&query.ray, &query.sphere).ok();
        let first = |counts: &dyn Fn(f64) -> bool| {
            roots.and_then(|roots| [roots.near, roots.far].into_iter().find(|t| counts(*t))).map(|t| t as f32)
        };
        let closed = first(&|t| (t_min..=t_max).contains(&f64::from(t as f32)));
        vec![
            (closed == *yours, "the range of a ray is open at both ends: ask ray.contains(t)"),
            "you compare t with the range before you round it: ask ray.contains of the rounded t"
                .when(first(&|t| t_min < t && t < t_max) == *yours),
        ]
    };
    all_hold(compare_formulas(&at_ends, trial.kit.sphere_in_double(&only), judge, formulas))
}
