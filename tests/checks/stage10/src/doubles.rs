//! The laws of `triangle_in_double`, and special numbers as input of both functions in double precision.

use super::triangles::{aim_again, draw, wrong_verdicts};
use checks::prelude::*;
use oracle::STABLE;
use oracle::exact::{Body, meet, t_error_in_ulps, t_in_double, triangle, verdict};
use oracle::gauntlet::distributions::DISTRIBUTIONS;
use oracle::splitmix::Random;

/// The largest margin, in roundings of single precision, at which a verdict in double precision may be wrong. A
/// rounding in double precision is 2^-29 of one in single precision. Of 192,000 inputs, the method of plane and Gram
/// scalars was wrong once at a margin above 1e-6 (at 5e-4, on a sliver: the condition number of its matrix is the
/// square of length divided by width). No other method was. Code that rounds to single precision is wrong at margins of
/// 0.3 to 0.7 on edges.
const IN_DOUBLE: f64 = 0.1;

/// Triangles a million times as long as wide. The square is 1e12, and the method of plane and Gram scalars loses all
/// digits of β and γ even in double precision. The exercise allows every method, so this distribution is left out.
const TOO_THIN_FOR_GRAM: &str = "needle";

const CONVERTED_LATE: &str = "you subtract in f32 and convert after that, and a number that was rounded before it was \
                              converted stays rounded: convert the corners and the origin first";

/// The distribution, with rays at all three edges and beside them.
fn at_all_edges(trial: &Trial<'_>, name: &str) -> Vec<TriangleQuery> {
    let mut queries = draw(trial, name, 400);
    queries.extend(aim_again(trial, &queries));
    for (index, TriangleQuery { triangle, .. }) in queries.iter_mut().enumerate() {
        let Triangle { a, b, c } = *triangle;
        // All rays aim at the edge between the first two corners, so rotate the corners.
        *triangle =
            [Triangle { a, b, c }, Triangle { a: b, b: c, c: a }, Triangle { a: c, b: a, c: b }][index % 3];
    }
    queries
}

pub(super) const SINGLE: &str =
    "the error is that of single precision, in both directions: you round an intermediate result to f32";

/// Whether answers err in both directions, as rounding errors do. A tolerance errs in one direction only.
pub(super) fn err_both_ways(mut is_above: impl Iterator<Item = bool>) -> bool {
    let Some(first) = is_above.next() else { return false };
    is_above.any(|other| other != first)
}

/// A wrong verdict: the query, the student's answer, the exact one, and how many roundings of single precision the exact
/// answer is from flipping.
struct Wrong {
    query: TriangleQuery,
    yours: Option<TriangleHit>,
    exact: Option<f32>,
    margin: f64,
}

pub(super) fn double_triangle_is_right_at_edges(trial: &Trial<'_>) -> CheckResult {
    for distribution in DISTRIBUTIONS.iter().filter(|one| one.name != TOO_THIN_FOR_GRAM) {
        let queries = at_all_edges(trial, distribution.name);
        let answers = trial.kit.triangle_in_double(&queries);
        let judge = |(query, yours): (&TriangleQuery, Option<TriangleHit>)| {
            if verdict_is_right(query, yours)? {
                return None;
            }
            let exact = meet(&query.ray, Body::Triangle(query.triangle))?;
            let margin = triangle::margin(&query.ray, &query.triangle)?;
            Some(Wrong { query: *query, yours, exact: exact.t, margin })
        };
        let mut wrong: Vec<Wrong> = queries.iter().zip(answers.clone()).filter_map(judge).collect();
        // Report the plainest error.
        wrong.sort_by(|p, q| q.margin.total_cmp(&p.margin));
        let known: Vec<(bool, &str)> = match wrong.first() {
            None => Vec::new(),
            // A verdict is named if it gives each answer that rounding does not decide.
            Some(first) => (0..wrong_verdicts(&first.query).len())
                .map(|n| {
                    let gives = |(query, yours): (&TriangleQuery, &Option<TriangleHit>)| {
                        let clear = triangle::margin(&query.ray, &query.triangle)
                            .is_some_and(|margin| margin > STABLE);
                        !clear || wrong_verdicts(query)[n].0 == yours.is_some()
                    };
                    (queries.iter().zip(&answers).all(gives), wrong_verdicts(&first.query)[n].1)
                })
                .collect(),
        };
        all_hold(
            explain(trial, &wrong)
                .into_iter()
                .map(|law| law.map_err(|broken| broken.explained_by(known.clone())))
                .collect(),
        )?;
    }
    points_on_edges_belong(trial)
}

/// Rays along an axis at points exactly on the edges and corners of triangles with small integer coordinates: no product is
/// rounded, and β and γ are multiples of a quarter.
fn points_on_edges_belong(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 21);
    let mut corner = || 4.0 * Vec3::from_array([(); 3].map(|()| random.below(9) as f32 - 4.0));
    let mut queries = Vec::new();
    for index in 0..600 {
        let (a, b, c) = (corner(), corner(), corner());
        let (axis, quarter) = (index % 3, (index / 3 % 5) as f32 / 4.0);
        let [from, to] = [[a, b], [b, c], [c, a]][index / 15 % 3];
        let mut direction = Vec3::ZERO;
        direction[axis] = if index.is_multiple_of(2) { 1.0 } else { -2.0 };
        if (b - a).cross(c - a)[axis] != 0.0 {
            let ray = Ray::new(from + quarter * (to - from) - 3.0 * direction, direction);
            queries.push(TriangleQuery { ray, triangle: Triangle { a, b, c } });
        }
    }
    all_hold(compare(&queries, trial.kit.triangle_in_double(&queries), |query, yours| {
        if yours.is_some_and(|hit| hit.t == 3.0) {
            return Ok(());
        }
        let weights = triangle::weights(&query.ray, &query.triangle).flatten();
        let lost = |on: fn(f64, f64) -> bool| {
            yours.is_none() && weights.is_some_and(|[beta, gamma]| on(beta, gamma))
        };
        Err(Broken::new(query.call("triangle_in_double"), yours, "a hit at t = 3", "integers, exactly")
            .explained_by([
                "you leave out points with β + γ = 1: points on the edge from b to c belong to the triangle"
                    .when(lost(|beta, gamma| beta + gamma == 1.0)),
                "you leave out points with β = 0 or γ = 0: points on these edges belong to the triangle"
                    .when(lost(|beta, gamma| beta == 0.0 || gamma == 0.0)),
                "you leave out points on edges: they belong to the triangle"
                    .when(lost(|beta, gamma| beta == 0.0 || gamma == 0.0 || beta + gamma == 1.0)),
            ]))
    }))
}

/// The broken laws of wrong verdicts, with the known mistakes.
fn explain(trial: &Trial<'_>, wrong: &[Wrong]) -> Vec<CheckResult> {
    let enlarged: Vec<TriangleQuery> = wrong.iter().map(|one| enlarged(&one.query)).collect();
    let enlarged = trial.kit.triangle_in_double(&enlarged);
    let is_right = |query: &TriangleQuery, yours| verdict_is_right(query, yours) == Some(true);
    let converted_late = is_converted_late(trial, wrong.iter().map(|one| (&one.query, one.yours)), is_right);
    let single = wrong.iter().all(|one| one.margin <= STABLE)
        && err_both_ways(wrong.iter().map(|one| one.yours.is_some()));
    // The plainest error comes first. Rounding errors alone do not give it.
    let clear = wrong.first().is_some_and(|one| one.margin > STABLE);
    let judge = |(Wrong { query, yours, exact, margin }, enlarged): (&Wrong, Option<TriangleHit>)| {
        let line = query.ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
        let on_the_line = meet(&line, Body::Triangle(query.triangle)).is_some_and(|it| it.verdict.is_hit());
        let weights = triangle::weights(&query.ray, &query.triangle).flatten();
        let beyond_the_third_edge = weights.is_some_and(|[beta, gamma]| beta >= 0.0 && gamma >= 0.0);
        let outside = yours.is_some() && !on_the_line && clear;
        let expected = format!("{exact:?}, {}", describe(*margin));
        let yours_t = format!("{:?}", yours.map(|hit| hit.t));
        Err(Broken::with_texts(query.call("triangle_in_double"), yours_t, expected, "exactly").explained_by(named![
            yours.is_none() && enlarged.is_some() =>
                "you treat a small determinant as 0: a determinant that is small is not 0, and the same triangle enlarged is hit",
            yours.is_some() && on_the_line =>
                "you return a hit behind the origin or beyond the range: t counts only within the range of the ray",
            outside && beyond_the_third_edge => "you return a hit where β + γ > 1: α = 1 - β - γ must be at least 0, too",
            outside && !beyond_the_third_edge => "you return a hit where there is none: β and γ must be at least 0",
            converted_late => CONVERTED_LATE,
            single => SINGLE,
        ]))
    };
    wrong.iter().zip(enlarged).map(judge).collect()
}

/// How far a verdict is from flipping, in roundings of single precision.
pub(super) fn describe(margin: f64) -> String {
    if margin > STABLE {
        return "and no rounding error can change that".into();
    }
    format!("{margin:.2} roundings of single precision from the opposite answer")
}

/// The query scaled by a power of two to a size of about a million, which changes no rounding.
fn enlarged(query: &TriangleQuery) -> TriangleQuery {
    let (Triangle { a, b, c }, ray) = (query.triangle, query.ray);
    let largest =
        [a, b, c, ray.origin].map(|point| point.abs().max_element()).into_iter().fold(0.0, f32::max);
    let size = (20.0 - largest.log2().floor()).max(0.0).exp2();
    TriangleQuery {
        ray: Ray { origin: size * ray.origin, direction: size * ray.direction, ..ray },
        triangle: Triangle { a: size * a, b: size * b, c: size * c },
    }
}

/// The same triangle and origin relative to `base`, with differences rounded to single precision. For code that
/// converts those differences this is the same input. Its answer may be wrong for `query` and right for this input.
fn seen_from(base: Vec3, query: &TriangleQuery) -> TriangleQuery {
    let TriangleQuery { ray, triangle: Triangle { a, b, c } } = *query;
    TriangleQuery {
        ray: Ray { origin: ray.origin - base, ..ray },
        triangle: Triangle { a: a - base, b: b - base, c: c - base },
    }
}

/// Whether the student's code gives the same answers for all these inputs as for their rounded differences to one of
/// the corners or to the origin, and `is_right` accepts these answers for the differences.
fn is_converted_late<'a>(
    trial: &Trial<'_>,
    wrong: impl Iterator<Item = (&'a TriangleQuery, Option<TriangleHit>)> + Clone,
    is_right: impl Fn(&TriangleQuery, Option<TriangleHit>) -> bool,
) -> bool {
    let bases: [fn(&TriangleQuery) -> Vec3; 4] =
        [|q| q.triangle.a, |q| q.triangle.b, |q| q.triangle.c, |q| q.ray.origin];
    bases.iter().any(|base| {
        let seen: Vec<TriangleQuery> =
            wrong.clone().map(|(query, _)| seen_from(base(query), query)).collect();
        let answers = trial.kit.triangle_in_double(&seen);
        let t = |hit: Option<TriangleHit>| hit.map(|hit| hit.t);
        let mut each = wrong.clone().zip(&seen).zip(answers);
        each.all(|(((_, yours), seen), answer)| t(yours) == t(answer) && is_right(seen, answer))
    })
}

/// Whether the verdict is the exact one, or its margin is at most [`IN_DOUBLE`]; `None` if there is no exact answer.
fn verdict_is_right(query: &TriangleQuery, yours: Option<TriangleHit>) -> Option<bool> {
    let exact = meet(&query.ray, Body::Triangle(query.triangle))?;
    let margin = triangle::margin(&query.ray, &query.triangle)?;
    Some(yours.is_some() == exact.verdict.is_hit() || margin <= IN_DOUBLE)
}

/// The error of `t` in units of the last place; `None` for a miss, or if there is no exact answer.
fn steps_off(query: &TriangleQuery, yours: Option<TriangleHit>) -> Option<f64> {
    t_error_in_ulps(&query.ray, Body::Triangle(query.triangle), yours?.t)
}

/// The greatest error, in units of the last place, that may come from rounding one intermediate result to single precision.
/// The cancellation that follows enlarges it a thousand times or more.
const OF_SINGLE: f64 = 1e5;

pub(super) fn double_triangle_has_the_nearest_t(trial: &Trial<'_>) -> CheckResult {
    for distribution in &DISTRIBUTIONS {
        let queries = draw(trial, distribution.name, 400);
        let answers = trial.kit.triangle_in_double(&queries);
        let is_lost = |query: &TriangleQuery, yours: Option<TriangleHit>| {
            // Leave verdicts that roundings decide to another check.
            let clear = triangle::margin(&query.ray, &query.triangle).is_some_and(|margin| margin > STABLE);
            yours.is_none()
                && clear
                && verdict(&query.ray, Body::Triangle(query.triangle)).is_some_and(|it| it.is_hit())
        };
        let judge = |(query, yours): (&TriangleQuery, Option<TriangleHit>)| {
            if is_lost(query, yours) {
                return Some((*query, yours, f64::INFINITY));
            }
            let off = steps_off(query, yours)?;
            // Rounding an accurate result leaves an error of half a unit. One whole unit accepts both neighbours of t.
            (!(off.abs() <= 1.0)).then_some((*query, yours, off))
        };
        let wrong: Vec<_> = queries.iter().zip(answers).filter_map(judge).collect();
        let is_right =
            |query: &TriangleQuery, yours| steps_off(query, yours).is_some_and(|off| off.abs() <= 1.0);
        let converted_late =
            is_converted_late(trial, wrong.iter().map(|(query, yours, _)| (query, *yours)), is_right);
        let single = wrong.iter().all(|(.., off)| off.abs() < OF_SINGLE)
            && err_both_ways(wrong.iter().map(|(.., off)| *off > 0.0));
        let broken = |(query, yours, off): &(TriangleQuery, Option<TriangleHit>, f64)| {
            let exact = meet(&query.ray, Body::Triangle(query.triangle)).and_then(|meeting| meeting.t);
            let expected = match yours {
                None => format!("{exact:?}"),
                Some(_) => format!(
                    "{exact:?}, or a neighbour: yours is {:.1} units of the last place off",
                    off.abs()
                ),
            };
            let (input, yours) = (query.call("triangle_in_double"), format!("{:?}", yours.map(|hit| hit.t)));
            Err(Broken::with_texts(input, yours, expected, "exactly").explained_by(named![
                converted_late => CONVERTED_LATE,
                single => "t has only the accuracy of single precision: round the quotient, and nothing before it",
            ]))
        };
        all_hold(wrong.iter().map(broken).collect())?;
    }
    let queries = draw(trial, "interior", 400);
    all_hold(judge_weights("triangle_in_double", &queries, trial.kit.triangle_in_double(&queries), 2.0 * U))?;
    let judge = |queries: &[TriangleQuery]| trial.kit.triangle_in_double(queries);
    all_hold(judge_ends("triangle_in_double", &queries, judge))
}

const HAS_ALPHA: &str = "one of your two numbers is α, the barycentric coordinate of corner a";

/// Judges β and γ of hits well inside, up to `tolerance`.
pub(super) fn judge_weights(
    function: &str,
    queries: &[TriangleQuery],
    answers: Vec<Option<TriangleHit>>,
    tolerance: f64,
) -> Vec<CheckResult> {
    compare(queries, answers, |query, yours| {
        let (Some(yours), Some([beta, gamma])) =
            (yours, triangle::weights(&query.ray, &query.triangle).flatten())
        else {
            return Ok(().into());
        };
        let is = |b: f64, g: f64| {
            (f64::from(yours.beta) - b).abs() <= tolerance && (f64::from(yours.gamma) - g).abs() <= tolerance
        };
        let describe = |beta: f64, gamma: f64| format!("β = {beta}, γ = {gamma}");
        let alpha = 1.0 - beta - gamma;
        unless(is(beta, gamma), || {
            let (yours, expected) = (describe(yours.beta.into(), yours.gamma.into()), describe(beta, gamma));
            Broken::with_texts(query.call(function), yours, expected, "exactly")
        })
        .formulas([
            (is(gamma, beta), "you exchange β and γ: β belongs to corner b, and γ to corner c"),
            (is(alpha, beta), HAS_ALPHA),
            (is(alpha, gamma), HAS_ALPHA),
            (is(beta, alpha), HAS_ALPHA),
            (is(gamma, alpha), HAS_ALPHA),
        ])
    })
}

/// Judges ranges that end exactly at a hit, or one float beside it. `t` is the student's own, which is rounded.
pub(super) fn judge_ends(
    function: &str,
    queries: &[TriangleQuery],
    ask: impl Fn(&[TriangleQuery]) -> Vec<Option<TriangleHit>>,
) -> Vec<CheckResult> {
    let whole = queries.iter().zip(ask(queries)).take(50);
    let at_ends: Vec<(TriangleQuery, bool)> = whole
        .filter_map(|(query, yours)| Some((query, yours?.t)))
        .flat_map(|(query, t)| {
            let ranges = nasty::ranges(t);
            ranges.map(|((t_min, t_max), counts)| {
                (TriangleQuery { ray: query.ray.with_range(t_min, t_max), ..*query }, counts)
            })
        })
        .collect();
    let only: Vec<TriangleQuery> = at_ends.iter().map(|(query, _)| *query).collect();
    let judge = |(query, counts): &(TriangleQuery, bool), yours: Option<TriangleHit>| {
        if yours.is_some() == *counts {
            return Ok(());
        }
        let expected = if *counts { "a hit" } else { "None" };
        let yours_t = format!("{:?}", yours.map(|hit| hit.t));
        Err(Broken::with_texts(query.call(function), yours_t, expected, "ray.contains of the rounded t"))
    };
    let formulas = |(query, _): &(TriangleQuery, bool), yours: &Option<TriangleHit>| {
        let (t_min, t_max) = (f64::from(query.ray.t_min), f64::from(query.ray.t_max));
        let exact =
            t_in_double(&query.ray.with_range(0.0, f32::INFINITY), Body::Triangle(query.triangle)).flatten();
        let is = |of: &dyn Fn(f64) -> bool| exact.is_some_and(of) == yours.is_some();
        let rounded = |t: f64| f64::from(t as f32);
        vec![
            "the range of a ray is open at both ends: ask ray.contains(t)"
                .when(is(&|t| t_min <= rounded(t) && rounded(t) <= t_max)),
            "you compare t with the range before you round it: ask ray.contains of the rounded t"
                .when(is(&|t| t_min < t && t < t_max)),
        ]
    };
    compare_formulas(&at_ends, ask(&only), judge, formulas)
}
