//! Laws that hold for all solids.

use super::mistakes::{Mistakes, OUTSIDE, agree, is_near};
use super::solid::Solid;
use checks::prelude::*;
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

/// A query of ordinary size, which is asked at another scale: coordinates times `size`, and the direction times `speed`, so
/// that `t` is multiplied by `size / speed`. Both are powers of two, so the answer is that of the ordinary query, exactly.
#[derive(Clone, Debug)]
pub(super) struct Scaled<S> {
    plain: SolidQuery<S>,
    size: f32,
    speed: f32,
}

impl<S: Solid> Scaled<S> {
    /// The factor of `t`.
    fn t_scale(&self) -> f32 {
        self.size / self.speed
    }

    fn asked(&self) -> SolidQuery<S> {
        let (ray, t_scale) = (self.plain.ray, self.t_scale());
        let ray = Ray { origin: self.size * ray.origin, direction: self.speed * ray.direction, ..ray };
        let (t_min, t_max) = (t_scale * self.plain.ray.t_min, t_scale * self.plain.ray.t_max);
        SolidQuery { ray: ray.with_range(t_min, t_max), solid: self.plain.solid.scaled(self.size) }
    }
}

/// The answers, with the `t` of the ordinary queries.
fn ask<S: Solid>(trial: &Trial<'_>, queries: &[Scaled<S>]) -> Vec<Option<SolidHit>> {
    let asked: Vec<SolidQuery<S>> = queries.iter().map(Scaled::asked).collect();
    let answers = queries.iter().zip(S::ask(trial.kit, &asked));
    answers.map(|(query, hit)| hit.map(|hit| SolidHit { t: hit.t / query.t_scale(), ..hit })).collect()
}

/// Ranges of rays, in which hits lie before, within and beyond.
const RANGES: &[(f32, f32)] = &[(0.5, f32::INFINITY), (0.0, 0.75), (1.25, 3.0), (-2.0, 0.875)];

/// Rays from outside and inside, most of them aimed at a point of the solid, with one of these ranges.
fn rays<S: Solid>(ranges: &'static [(f32, f32)]) -> impl Strategy<Value = SolidQuery<S>> + Clone {
    let directions = prop_oneof![3 => direction(), 1 => nasty::unit()];
    let inputs = (S::any(), point(8), point(1), directions, 0..4u32, 0..ranges.len());
    inputs.prop_map(move |(solid, origin, at, direction, kind, range)| {
        let (t_min, t_max) = ranges[range];
        let (origin, direction) = match kind {
            0 => (origin, direction),
            1 if !S::FLAT => (solid.inside(at), direction),
            _ => (origin, solid.inside(at) - origin),
        };
        let direction = nasty::slanted(if direction == Vec3::ZERO { Vec3::X } else { direction });
        SolidQuery { ray: Ray::new(origin, direction).with_range(t_min, t_max), solid }
    })
}

/// All rays with `t > 0`.
const AHEAD: &[(f32, f32)] = &[(0.0, f32::INFINITY)];

/// The same rays at ordinary size.
fn plain<S: Solid>(ranges: &'static [(f32, f32)]) -> impl Strategy<Value = Scaled<S>> + Clone {
    rays::<S>(ranges).prop_map(|plain| Scaled { plain, size: 1.0, speed: 1.0 })
}

/// The same rays, from a size of 1/4096 to 4096, with directions that are shorter or longer by as much. A product of eight
/// such numbers is a normal number in single precision, so the usual formulas neither overflow nor underflow. Some
/// directions are much longer or shorter, because they may have any length.
fn scaled<S: Solid>() -> impl Strategy<Value = Scaled<S>> + Clone {
    let scales = prop_oneof![
        2 => (nasty::scale(-12..=12), nasty::scale(-12..=12)),
        1 => (Just(1.0f32), nasty::scale(-24..=24)),
    ];
    (rays::<S>(AHEAD), scales).prop_map(|(plain, (size, speed))| Scaled { plain, size, speed })
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

fn is_right(yours: Option<SolidHit>, expected: Option<(f32, f32)>) -> bool {
    agree(yours, expected, |hit, (low, high)| low <= hit.t && hit.t <= high)
}

const LIMITED: &str = "you compare with a fixed limit: the same ray at another size, or with a direction of another \
                       length, gets the right answer";

fn judge<S: Solid>(trial: &Trial<'_>, queries: &[Scaled<S>]) -> Vec<CheckResult> {
    let judge = |scaled: &Scaled<S>, yours: Option<SolidHit>| {
        let query = &scaled.plain;
        let Some(expected) = expected(query) else { return Ok(()) };
        if is_right(yours, expected) {
            return Ok(());
        }
        let (yours, exact) = (yours.map(|hit| hit.t), query.solid.first(&query.ray));
        let describe =
            |t: Option<f32>| t.map_or("None".into(), |t| format!("Some at t = {:?}", scaled.t_scale() * t));
        let mut shown = mistakes(scaled, yours, exact);
        // Powers of two change no digit, so only a limit tells the sizes apart.
        let plain = || S::ask(trial.kit, std::slice::from_ref(query))[0];
        let is_limited = (scaled.size, scaled.speed) != (1.0, 1.0) && is_right(plain(), expected);
        shown.push((is_limited, LIMITED));
        Err(Broken::with_texts(input(&scaled.asked()), describe(yours), describe(exact), "exact arithmetic")
            .explained_by(shown))
    };
    // Where the ray passes too near to an edge, each formula may give each answer.
    let formulas = |Scaled { plain, size, speed }: &Scaled<S>, yours: &Option<SolidHit>| {
        let given = (S::MISTAKES)(plain, yours.map(|hit| hit.t), f64::from(size * speed));
        let is_open = expected(plain).is_none();
        given.into_iter().map(|(gives, text)| (gives || is_open, text)).collect()
    };
    compare_formulas(queries, ask(trial, queries), judge, formulas)
}

const FIXED_EPSILON: &str = "you drop the hit by a fixed epsilon: t is small because direction is long or the solid small, \
                             not because the ray starts there";

/// The mistakes that all solids have in common, each with whether it gives this answer.
fn mistakes<S: Solid>(scaled: &Scaled<S>, yours: Option<f32>, exact: Option<f32>) -> Mistakes {
    let SolidQuery { ray, solid } = &scaled.plain;
    let infinite = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    let first = solid.first(&infinite);
    let meets = |t_min, t_max| solid.first(&ray.with_range(t_min, t_max)).is_some();
    let inside = meets(f32::NEG_INFINITY, 0.0) && meets(0.0, f32::INFINITY);
    let last = || solid.first(&Ray { direction: -ray.direction, ..infinite }).map(|t| -f64::from(t));
    let near = |wrong: f64| yours.is_some_and(|t| is_near(ray, t, wrong));
    let lost = yours.is_none() && exact.is_some();
    // The length of the direction that the student's function received.
    let length = f64::from(scaled.speed) * ray.direction.as_dvec3().length();
    let counts_from = |factor: f64| {
        exact.is_some_and(|exact| (factor - 1.0).abs() > 1e-6 && near(factor * f64::from(exact)))
    };
    let is_far = !S::FLAT && last().is_some_and(near);
    // The answer of a student who uses another range.
    let is_range = |t_min, t_max| {
        agree(yours, solid.first(&ray.with_range(t_min, t_max)), |_, wrong| near(wrong.into()))
    };
    // Whether an epsilon may drop a point at this t of the plain query.
    let is_dropped = |t: f64| f64::from(scaled.t_scale()) * t < 0.01;
    let is_small = exact.is_some_and(|t| t > 0.0 && is_dropped(t.into()));
    let is_last_dropped = S::FLAT || last().is_none_or(|t| is_dropped(t) || t >= f64::from(ray.t_max));
    vec![
        "you return NaN: write the comparisons so that they are false for NaN"
            .when(yours.is_some_and(f32::is_nan)),
        (counts_from(length), "your t has another unit, that of the world: it counts lengths of direction"),
        (counts_from(length.recip()), "your t has another unit: you divide by the length of direction twice"),
        // Some return None for a small t, and others go on to the far side, which may be dropped, too.
        (is_small && lost, FIXED_EPSILON),
        (is_small && (is_far || (lost && is_last_dropped)), FIXED_EPSILON),
        "you use 0 in place of t_min: a hit outside of the ray's range does not count, so test ray.contains(t)"
            .when(ray.t_min != 0.0 && is_range(0.0, ray.t_max)),
        "you do not test t_max: a hit outside of the ray's range does not count, so test ray.contains(t)"
            .when(ray.t_max != f32::INFINITY && is_range(ray.t_min, f32::INFINITY)),
        "you return None for a ray that starts inside: it hits the surface where it leaves, on a side or on an end"
            .when(lost && inside && !S::FLAT),
        "you give up because the entry lies before t_min: the exit still counts"
            .when(lost && !S::FLAT && first.is_some_and(|t| t <= ray.t_min)),
        "you return the far side: the hit is the nearest point of the surface in the ray's range, on a side or on an end"
            .when(is_far && exact.is_some()),
        "you return a t outside of the ray's range: test ray.contains(t)"
            .when(yours.is_some_and(|t| !ray.contains(t))),
        (S::FLAT && yours.is_some() && exact.is_none(), OUTSIDE),
    ]
}

fn agrees<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    trial.forall(4000, plain::<S>(AHEAD), |queries| judge(trial, queries))
}

/// For flat shapes this judges the normal, too, which must be that of the shape's description.
pub(super) fn agrees_flat<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    agrees::<S>(trial)?;
    outwards::<S>(trial)
}

/// A solid and a ray through its middle, for a law that judges hits only.
fn through_the_middle<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let Ok(tree) = S::any().new_tree(&mut runner) else { return Ok(()) };
    let solid = trial.varied(proptest::strategy::ValueTree::current(&tree), S::any());
    let from = solid.inside(Vec3::ZERO) + 8.0 * Vec3::new(0.5, 0.75, -0.625);
    let query = SolidQuery { ray: Ray::new(from, solid.inside(Vec3::ZERO) - from), solid };
    // The t of a constant is not that of the hit.
    let exact = query.solid.first(&query.ray).unwrap_or(f32::NAN);
    let yours = S::ask(trial.kit, std::slice::from_ref(&query))[0].map(|hit| hit.t);
    if yours.is_some_and(|t| (t - exact).abs() < 1e-3) {
        return Ok(());
    }
    let expected = format!("Some({exact:?})");
    Err(Broken::with_texts(input(&query), format!("{yours:?}"), expected, "exact arithmetic"))
}

/// At a point `p` of a convex solid, `n` is an outward normal if no point `q` of the solid has `n · (q - p) > 0`. This
/// holds on faces, rims and apexes, for each of the possible normals there. A flat shape has two such normals, and the
/// one that its description gives is right.
fn outwards<S: Solid>(trial: &Trial<'_>) -> CheckResult {
    through_the_middle::<S>(trial)?;
    trial.forall(3000, scaled::<S>(), |queries| {
        compare(queries, ask(trial, queries), |scaled, yours| {
            let query = &scaled.plain;
            let (Some(hit), Some(Some(range))) = (yours, expected(query)) else { return Ok(()) };
            // Another check judges t.
            if !(range.0 <= hit.t && hit.t <= range.1) {
                return Ok(());
            }
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
            let turned = S::FLAT
                && query.solid.reach(normal) + query.solid.reach(-normal) < 1e-3 * normal.length()
                && own_normal(query).is_some_and(|own| own.dot(normal) < 0.0);
            if outward && unit && !turned {
                return Ok(());
            }
            let direction = normal.normalize_or_zero();
            let faces_viewer = normal.dot(query.ray.direction.as_dvec3()) < 0.0;
            let mut mistakes = named![
                normal.is_nan() => "your normal is NaN: you normalized a vector of length 0",
                normal == DVec3::ZERO => "your normal is 0, which has no direction",
                turned && faces_viewer && unit =>
                    "you turn the normal to the viewer: it does not depend on where the ray comes from",
                turned && unit => "you return the normal of the other side, from which the corners run clockwise",
                !turned && !unit && beyond(direction) <= 2e-3 => "your normal does not have unit length",
            ].to_vec();
            // The tolerance covers the error of the hit point over half a unit, the smallest radius.
            let is = |(wrong, text): (DVec3, &'static str)| {
                ((wrong.normalize_or_zero() - direction).length() < 1e-3, text)
            };
            mistakes.extend((S::WRONG_NORMALS)(&query.solid, at).into_iter().map(is));
            mistakes.extend([(!S::FLAT && beyond(-direction) <= 2e-3, "your normal points inwards")]);
            let plain = || S::ask(trial.kit, std::slice::from_ref(query))[0];
            let is_plain = |hit: SolidHit| (hit.t - range.0).min(range.1 - hit.t) >= 0.0;
            let is_fine = |hit: SolidHit| is_plain(hit) && beyond(hit.normal.as_dvec3()) <= 2e-3;
            let is_scaled = (scaled.size, scaled.speed) != (1.0, 1.0);
            mistakes.push((is_scaled && !turned && plain().is_some_and(is_fine), LIMITED));
            Err(Broken::with_texts(
                input(&scaled.asked()),
                format!("normal {} at t = {:?}", hit.normal, scaled.t_scale() * hit.t),
                "the outward unit normal at the hit",
                "all points of the solid lie behind it",
            )
            .explained_by(mistakes))
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
    trial.forall(1500, plain::<S>(RANGES), |queries| judge(trial, queries))?;
    // t counts lengths of the direction, and no size is special.
    trial.forall(1000, scaled::<S>(), |queries| judge(trial, queries))?;
    trial.forall(100, rays::<S>(AHEAD), |queries| judge_ranges(trial, queries))
}

/// Judges ranges that begin or end exactly at the hit, or one float before or after it.
fn judge_ranges<S: Solid>(trial: &Trial<'_>, queries: &[SolidQuery<S>]) -> Vec<CheckResult> {
    let hits: Vec<Option<f32>> =
        S::ask(trial.kit, queries).iter().map(|hit| hit.map(|hit| hit.t).filter(|t| *t > 0.0)).collect();
    let ranged = |(query, t): (&SolidQuery<S>, &Option<f32>)| {
        nasty::ranges(t.unwrap_or(1.0)).map(|((t_min, t_max), _)| SolidQuery {
            ray: query.ray.with_range(t_min, t_max),
            solid: query.solid.clone(),
        })
    };
    let asked: Vec<SolidQuery<S>> = queries.iter().zip(&hits).flat_map(ranged).collect();
    let answers = S::ask(trial.kit, &asked);
    let judge = |asked: &[SolidQuery<S>], answers: &[Option<SolidHit>], t: Option<f32>| {
        let Some(t) = t else { return Ok(()) };
        let each = asked.iter().zip(answers).zip(nasty::ranges(t));
        let judged = each.map(|((query, yours), (_, counts))| {
            let yours = yours.map(|hit| hit.t);
            // If the first point does not count, a later one may.
            if counts == (yours == Some(t)) {
                return Ok(());
            }
            let expected = if counts { format!("Some at t = {t:?}") } else { format!("no hit at t = {t:?}") };
            let source = "your t without these ends of the range";
            Err(Broken::with_texts(input(query), format!("{yours:?}"), expected, source).explained_by([
                "the range is open: a hit exactly at t_min or t_max does not count, so test ray.contains(t)"
                    .when(!counts && (t == query.ray.t_min || t == query.ray.t_max)),
                "you lose a hit that is one float inside the range: compare t with t_min and t_max, without an epsilon"
                    .when(counts && yours.is_none()),
            ]))
        });
        all_hold(judged.collect())
    };
    let of_hits = asked.chunks(6).zip(answers.chunks(6)).zip(hits);
    of_hits.map(|((asked, answers), t)| judge(asked, answers, t)).collect()
}
