//! The laws of `conservative_slab`.

use super::Odd;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::compare;
use checks::paste::Arguments;
use glam::Vec3;
use oracle::STABLE;
use oracle::exact::aabb::overlap;
use oracle::exact::{Body, meet};
use oracle::gauntlet::boxes::at_a_corner;
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::kit::SlabQuery;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The reason why a slab test loses this box although the ray meets it. The first reason is the easiest to explain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Loss {
    Inside,
    Cancellation,
    Touch,
    Parallel,
    Rounding,
}

impl Loss {
    /// Determined by a careful slab test in single precision that does not widen the interval.
    fn of(SlabQuery { ray, bounds, .. }: &SlabQuery) -> Loss {
        let (mut near, mut far) = (ray.t_min, ray.t_max);
        for axis in 0..3 {
            let inverse = 1.0 / ray.direction[axis];
            let ends = [bounds.min, bounds.max].map(|corner| (corner[axis] - ray.origin[axis]) * inverse);
            let (enter, leave) =
                if inverse.is_sign_negative() { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
            near = if enter > near { enter } else { near };
            far = if leave < far { leave } else { far };
        }
        match () {
            () if near > far => Loss::Rounding,
            () if ray.direction.cmpeq(Vec3::ZERO).any() => Loss::Parallel,
            () if bounds.contains(ray.origin) => Loss::Inside,
            () if near == far => Loss::Touch,
            () => Loss::Cancellation,
        }
    }

    fn describe(self) -> &'static str {
        match self {
            Loss::Inside => "you return None although the ray starts in the box: it enters at t_min",
            Loss::Cancellation => "b / d - o / d cancels: subtract before you divide",
            Loss::Touch => "you return None for a flat or only touched box: compare with <= and not with <",
            Loss::Parallel => "the direction is 0 along an axis: 0 · ∞ is NaN, and -0.0 swaps the planes",
            Loss::Rounding => "rounding loses a corner of the box: multiply the exit by 1 + 2 γ₃",
        }
    }
}

pub(super) fn slab_misses_no_box_that_is_met(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 8);
    let mut queries: Vec<SlabQuery> = (0..20_000).filter_map(|_| at_a_corner(&mut random)).collect();
    // Only the first failure is reported, so put those with a single cause first.
    queries.sort_by_cached_key(Loss::of);
    let judge = |query: &SlabQuery, yours: Option<(f32, f32)>| {
        let Some(exact) = overlap(&query.ray, &query.bounds) else { return Ok(()) };
        if yours.is_some() || !exact.verdict.is_hit() {
            return Ok(());
        }
        let expected = "Some: the ray meets the box";
        Err(Broken::with_texts(query.call("conservative_slab"), format!("{yours:?}"), expected, "exactly")
            .looks_like(Some(Loss::of(query).describe())))
    };
    compare(&queries, trial.kit.conservative_slab(&queries), judge).into_iter().collect()
}

pub(super) fn slab_meets_no_box_that_is_passed(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 13);
    // Turn the same rays away from the corner, by 1e-5 to 0.1 of the distance.
    let beside = |query: SlabQuery| {
        let aside = 10f32.powf(-1.0 - 4.0 * random.unit()) * query.ray.direction.length() * random.in_cube();
        let mut ray = query.ray;
        ray.direction += aside;
        (ray.direction != Vec3::ZERO).then_some(SlabQuery { ray, ..query })
    };
    let mut corners = Random::new(trial.seed, 14);
    let queries: Vec<SlabQuery> =
        (0..20_000).filter_map(|_| at_a_corner(&mut corners)).filter_map(beside).collect();
    let judge = |query: &SlabQuery, yours: Option<(f32, f32)>| {
        let Some(exact) = overlap(&query.ray, &query.bounds) else { return Ok(()) };
        // Accept a hit that is wrong by a few roundings only: it costs a visit and loses no hit.
        if yours.is_none() || exact.verdict.is_hit() || exact.margin <= STABLE {
            return Ok(());
        }
        let roundings = format!("None: the ray passes by {:.0} roundings", exact.margin);
        Err(Broken::with_texts(query.call("conservative_slab"), format!("{yours:?}"), roundings, "exactly")
            .looks_like(Some(
                "you return a hit where there is none: you widen the interval by more than 64 roundings, and each wrong \
                 hit costs a visit",
            )))
    };
    compare(&queries, trial.kit.conservative_slab(&queries), judge).into_iter().collect()
}

pub(super) fn slab_is_entered_before_what_it_holds(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 15);
    // Aim rays at a corner of a triangle that lies on its bounding box: the exact t of box and triangle are equal.
    let draw = |_| {
        let place = [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e3)][random.below(3) as usize];
        let [a, b, c] = [(); 3].map(|()| place + random.in_cube());
        let triangle = Triangle { a, b, c };
        let origin = place + 4.0 * random.in_cube();
        let bounds = Aabb::new(a.min(b).min(c), a.max(b).max(c));
        (SlabQuery { ray: Ray::new(origin, a - origin), bounds }, triangle)
    };
    let drawn: Vec<(SlabQuery, Triangle)> = (0..20_000).map(draw).collect();
    let queries: Vec<SlabQuery> = drawn.iter().map(|(query, _)| *query).collect();
    let judge = |(query, triangle): &(SlabQuery, Triangle), yours: Option<(f32, f32)>| {
        let Some(t) = meet(&query.ray, Body::Triangle(*triangle)).and_then(|meeting| meeting.t) else {
            return Ok(());
        };
        match yours {
            Some((enter, _)) if enter > t => Err(Broken::with_texts(
                query.call("conservative_slab"),
                format!("enters at {enter}"),
                format!("at {t} or before: there the ray hits a triangle in the box"),
                "exactly",
            )
            .looks_like(Some(
                "the entry is rounded up, so a search that has a hit at this t skips the box: multiply the entry by \
                 1 - 2 γ₃",
            ))),
            _ => Ok(()),
        }
    };
    compare(&drawn, trial.kit.conservative_slab(&queries), judge).into_iter().collect()
}

pub(super) fn slab_of_special_numbers_is_finite(trial: &Trial<'_>) -> CheckResult {
    let mut odd = Odd::new(trial, 9);
    let mut queries = vec![SlabQuery { ray: Ray::new(Vec3::ZERO, Vec3::X), bounds: Aabb::EMPTY }];
    queries.extend(
        (0..3000).map(|_| SlabQuery { ray: odd.ray(), bounds: Aabb::new(odd.vector(), odd.vector()) }),
    );
    let judge = |query: &SlabQuery, yours: Option<(f32, f32)>| {
        let broken = |expected: &str, diagnosis: &'static str| {
            Err(Broken::with_texts(
                query.call("conservative_slab"),
                format!("{yours:?}"),
                expected,
                "the definition",
            )
            .looks_like(Some(diagnosis)))
        };
        match yours {
            Some((enter, leave)) if enter.is_nan() || leave.is_nan() => broken(
                "numbers, or None",
                "you return NaN: replace an end only if a comparison with it is true",
            ),
            Some(_) if query.bounds == Aabb::EMPTY => broken("None", "you return a hit with an empty box"),
            _ => Ok(()),
        }
    };
    compare(&queries, trial.kit.conservative_slab(&queries), judge).into_iter().collect()
}
