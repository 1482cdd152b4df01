//! The laws of `conservative_slab`.

use checks::double;
use checks::prelude::*;
use oracle::STABLE;
use oracle::exact::aabb::overlap;
use oracle::exact::{Body, meet};
use oracle::gauntlet::boxes::{at_a_corner, of_any_size};
use oracle::splitmix::Random;
use raykata::rounding::{UNIT_ROUNDOFF, gamma};

/// A slab test in single precision with one mistake.
#[derive(Clone, Copy, PartialEq)]
enum Mistake {
    /// None but the widening that is left out.
    None,
    /// Entry and exit are multiplied by a factor, which moves negative ones the wrong way.
    FactorOnly,
    /// The interval must have a length.
    Open,
    /// The entry must not lie before `t_min`.
    NotFromInside,
    /// The planes are swapped if `d < 0`, which is false for -0.0.
    SwappedByLess,
    /// The two planes are sorted by min and max, which drop NaN.
    MinMax,
    /// `1/d` where it overflows.
    Overflow,
    /// `b/d - o/d` in place of `(b - o)/d`.
    FastForm,
    /// The range begins at 0, or at -∞, or has no end.
    FromZero,
    StartIgnored,
    EndIgnored,
    /// This axis is left out, or its planes are divided by the direction along another one.
    LeftOut(usize),
    Mixed(usize, usize),
}

/// How far a slab test widens its interval.
#[derive(Clone, Copy, PartialEq)]
enum Widened {
    Not,
    Exit,
    Both,
}

const MIXED: &str = "the planes across an axis are divided by the direction along another axis";
const OVERFLOW: &str = "1/d is infinite although d is not 0: divide by d there";

/// The mistakes with the words of the diagnosis, those that lose the fewest boxes first: the first one that explains all lost
/// boxes is named.
const MISTAKES: [(Mistake, Widened, &str); 18] = {
    use Mistake::*;
    use Widened::*;
    [
        (
            FactorOnly,
            Both,
            "a factor of 1 + 2 γ₃ moves a negative exit the wrong way: move it later by 2 γ₃ |t|",
        ),
        (FactorOnly, Exit, "a factor moves a negative exit the wrong way: move it later by 2 γ₃ |t|"),
        (Overflow, Both, OVERFLOW),
        (FromZero, Both, "the range begins at 0 in your test: it begins at t_min, which may be negative"),
        (StartIgnored, Both, "a box before t_min is met: the interval is that of the ray's range"),
        (StartIgnored, Exit, "a box before t_min is met: the interval is that of the ray's range"),
        (EndIgnored, Both, "a box beyond t_max is met: the interval is that of the ray's range"),
        (EndIgnored, Exit, "a box beyond t_max is met: the interval is that of the ray's range"),
        (Open, Not, "you return None for a flat or only touched box: compare with <= and not with <"),
        (NotFromInside, Both, "you return None although the ray starts in the box: it enters at t_min"),
        (
            NotFromInside,
            Not,
            "you return None although the ray starts in the box (and do not widen the interval)",
        ),
        (SwappedByLess, Both, "-0.0 < 0.0 is false: choose the planes by the sign bit of 1/d"),
        (
            SwappedByLess,
            Not,
            "-0.0 < 0.0 is false: choose the planes by the sign bit of 1/d, and widen the interval",
        ),
        (MinMax, Both, "0 · ∞ is NaN, and min and max drop NaN: that axis must change nothing"),
        (
            MinMax,
            Not,
            "0 · ∞ is NaN, and min and max drop NaN: that axis must change nothing (and widen the interval)",
        ),
        (FastForm, Both, "b/d - o/d cancels: subtract before you divide"),
        (FastForm, Exit, "b/d - o/d cancels: subtract before you divide, and move the entry earlier as well"),
        (FastForm, Not, "b/d - o/d cancels: subtract before you divide, and widen the interval"),
    ]
};

impl Mistake {
    fn slab(self, widened: Widened, SlabQuery { ray, bounds, .. }: &SlabQuery) -> Option<(f32, f32)> {
        let (mut near, mut far) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in (0..3).filter(|&axis| self != Mistake::LeftOut(axis)) {
            let of = if let Mistake::Mixed(of, other) = self
                && of == axis
            {
                other
            } else {
                axis
            };
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            let inverse = 1.0 / ray.direction[of];
            let t = |plane: f32| match self {
                Mistake::FastForm => plane * inverse - o * inverse,
                Mistake::Overflow => (plane - o) * inverse,
                _ if inverse.is_finite() => (plane - o) * inverse,
                _ => (plane - o) / d,
            };
            let ends = [t(bounds.min[axis]), t(bounds.max[axis])];
            let swapped = if self == Mistake::SwappedByLess { d < 0.0 } else { inverse.is_sign_negative() };
            let (enter, leave) = match swapped {
                _ if self == Mistake::MinMax => (ends[0].min(ends[1]), ends[0].max(ends[1])),
                true => (ends[1], ends[0]),
                false => (ends[0], ends[1]),
            };
            near = if enter > near { enter } else { near };
            far = if leave < far { leave } else { far };
        }
        if self == Mistake::NotFromInside && near < ray.t_min {
            return None;
        }
        let (less, more) = (1.0 - 2.0 * gamma(3), 1.0 + 2.0 * gamma(3));
        if self == Mistake::FactorOnly {
            near = if widened == Widened::Both { near * less } else { (near * less).min(near * more) };
            far *= more;
        } else {
            near = if widened == Widened::Both { (near * less).min(near * more) } else { near };
            far = if widened == Widened::Not { far } else { (far * less).max(far * more) };
        }
        let t_min = match self {
            Mistake::FromZero => 0.0,
            Mistake::StartIgnored => f32::NEG_INFINITY,
            _ => ray.t_min,
        };
        let t_max = if self == Mistake::EndIgnored { f32::INFINITY } else { ray.t_max };
        let (near, far) = (near.max(t_min), far.min(t_max));
        (if self == Mistake::Open { near < far } else { near <= far }).then_some((near, far))
    }
}

/// No box that is met by exact arithmetic may be missed, and no box that is passed by at more than 64 roundings may be met.
fn hit_and_missed_boxes_differ(trial: &Trial<'_>, queries: &[SlabQuery]) -> CheckResult {
    let judge = |query: &SlabQuery, yours: Option<(f32, f32)>| {
        let Some(exact) = overlap(&query.ray, &query.bounds) else { return Ok(().into()) };
        let is_hit = exact.verdict.is_hit();
        let broken = |expected: &str| {
            Broken::with_texts(query.call("conservative_slab"), format!("{yours:?}"), expected, "exactly")
        };
        // A box whose exit overflows may be entered at infinity, which costs a visit.
        let is_wrong =
            yours.is_some_and(|(enter, _)| !enter.is_infinite()) && !is_hit && exact.margin > STABLE;
        let same = |mistake: Mistake, widened| mistake.slab(widened, query).is_none() == yours.is_none();
        // Rounding loses a box if the test without widening loses it. A test that widens too little keeps some.
        let rounding = "rounding loses a corner of the box: move the exit later by 2 γ₃ |t|";
        let is_rounding = !is_wrong && Mistake::None.slab(Widened::Not, query).is_none();
        let lost = || {
            let expected =
                if is_wrong { "None: the ray passes by the box" } else { "Some: the ray meets the box" };
            broken(expected).explained_by([(is_rounding, rounding)])
        };
        let axes = || (0..3).flat_map(|axis| [(axis, (axis + 1) % 3), (axis, (axis + 2) % 3)]);
        let mixed = axes().map(|(axis, other)| (Mistake::Mixed(axis, other), MIXED));
        let out = (0..3).map(|axis| {
            (Mistake::LeftOut(axis), "an axis is left out: the ray is between the planes of all three")
        });
        let others = mixed.chain(out).map(|(mistake, text)| (mistake, Widened::Both, text));
        let all = MISTAKES.into_iter().chain(others);
        let open = !is_hit && exact.margin <= STABLE || yours.is_some_and(|(enter, _)| enter.is_infinite());
        unless(!is_wrong && (!is_hit || yours.is_some()), lost)
            .formulas(all.map(|(mistake, widened, text)| (open || same(mistake, widened), text)))
    };
    all_hold(compare(queries, trial.kit.conservative_slab(queries), judge))
}

/// Scales whose third powers are normal numbers in double precision, but not in single precision.
const SCALES: [f32; 3] = [1.0, 1.0 / (1u64 << 60) as f32, (1u64 << 60) as f32];

/// Rays in all directions with this range, and a box around the point at this `t`, through which the ray goes; at these
/// scales.
fn plain(t: f32, (t_min, t_max): (f32, f32), scales: &[f32]) -> Vec<SlabQuery> {
    let query = |(direction, scale): (Vec3, f32)| {
        let (center, half) = (scale * t * direction, scale * Vec3::new(0.5, 0.25, 0.75));
        let ray = Ray::new(Vec3::ZERO, scale * direction).with_range(t_min, t_max);
        SlabQuery { ray, bounds: Aabb::new(center - half, center + half) }
    };
    scales
        .iter()
        .flat_map(|&scale| nasty::directions().into_iter().map(move |d| (d, scale)))
        .map(query)
        .collect()
}

pub(super) fn slab_misses_no_box_that_is_met(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 8);
    let mut queries: Vec<SlabQuery> = (0..20_000).filter_map(|_| at_a_corner(&mut random)).collect();
    // Boxes behind the ray are missed.
    queries.extend(plain(-3.0, (0.0, f32::INFINITY), &[trial.varied(1.0, 0.25..4f32)]));
    hit_and_missed_boxes_differ(trial, &queries)
}

pub(super) fn slab_misses_no_box_in_any_range(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 18);
    let mut queries: Vec<SlabQuery> = (0..20_000).filter_map(|_| of_any_size(&mut random)).collect();
    // Boxes behind the range and before it are missed.
    queries.extend(plain(3.0, (-1.0, 1.0), &SCALES));
    queries.extend(plain(-3.0, (-1.0, 1.0), &SCALES));
    hit_and_missed_boxes_differ(trial, &queries)
}

/// Whether an end of the interval lies outside the exact interval by more than 64 roundings.
fn is_too_wide(query: &SlabQuery, (enter, leave): (f32, f32)) -> bool {
    let (near, far) = double::slabs_interval(&query.ray, &query.bounds);
    let room = |t: f64| STABLE * f64::from(UNIT_ROUNDOFF) * t.abs();
    f64::from(enter) < near - room(near) || f64::from(leave) > far + room(far)
}

/// Whether the entry differs from the exact one by at most 64 roundings.
fn is_entry(query: &SlabQuery, enter: f32) -> bool {
    let near = double::slabs_interval(&query.ray, &query.bounds).0.max(f64::from(query.ray.t_min));
    (f64::from(enter) - near).abs() <= STABLE * f64::from(UNIT_ROUNDOFF) * near.abs()
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
    let mut queries: Vec<SlabQuery> =
        (0..20_000).filter_map(|_| at_a_corner(&mut corners)).filter_map(beside).collect();
    // Boxes that the ray meets.
    queries.extend(plain(3.0, (0.0, f32::INFINITY), &SCALES));
    let judge = |query: &SlabQuery, yours: Option<(f32, f32)>| {
        let Some(exact) = overlap(&query.ray, &query.bounds) else { return Ok(()) };
        if yours.is_none() && exact.verdict.is_hit() && exact.margin > STABLE {
            let expected = "Some: the ray meets the box";
            return Err(Broken::with_texts(query.call("conservative_slab"), "None", expected, "exactly"));
        }
        // Accept a hit that is wrong by a few roundings only: it costs a visit and loses no hit.
        if yours.is_none() || exact.verdict.is_hit() || exact.margin <= STABLE {
            return Ok(());
        }
        let roundings = format!("None: the ray passes by {:.0} roundings", exact.margin);
        Err(Broken::with_texts(query.call("conservative_slab"), format!("{yours:?}"), roundings, "exactly")
            .explained_by(["your interval is wider than the exact one by more than 64 roundings, and each wrong hit costs a visit"
                .when(yours.is_some_and(|yours| is_too_wide(query, yours)))]))
    };
    all_hold(compare(&queries, trial.kit.conservative_slab(&queries), judge))
}

pub(super) fn slab_is_entered_before_what_it_holds(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 15);
    // Aim rays at a corner of a triangle that lies on its bounding box: the exact t of box and triangle are equal. Aim
    // every tenth ray inside the triangle, where no rounding decides whether the ray meets the box.
    let draw = |index: u32| {
        let place = [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e3)][random.below(3) as usize];
        let [a, b, c] = [(); 3].map(|()| place + random.in_cube());
        let triangle = Triangle { a, b, c };
        let origin = place + 4.0 * random.in_cube();
        let bounds = Aabb::new(a.min(b).min(c), a.max(b).max(c));
        let target = if index.is_multiple_of(10) { a + 0.3 * (b - a) + 0.4 * (c - a) } else { a };
        (SlabQuery { ray: Ray::new(origin, target - origin), bounds }, triangle)
    };
    let drawn: Vec<(SlabQuery, Triangle)> = (0..20_000).map(draw).collect();
    let queries: Vec<SlabQuery> = drawn.iter().map(|(query, _)| *query).collect();
    let judge = |(query, triangle): &(SlabQuery, Triangle), yours: Option<(f32, f32)>| {
        let Some(t) = meet(&query.ray, Body::Triangle(*triangle)).and_then(|meeting| meeting.t) else {
            return Ok(());
        };
        let is_clear = overlap(&query.ray, &query.bounds).is_some_and(|exact| exact.margin > STABLE);
        match yours {
            None if is_clear => {
                let expected = format!("at {t} or before: there the ray hits a triangle in the box");
                Err(Broken::with_texts(query.call("conservative_slab"), "None", expected, "exactly"))
            }
            // Where no rounding decides, the entry itself must be right, up to 64 roundings.
            Some((enter, _)) if is_clear && !is_entry(query, enter) => {
                let (near, _) = double::slabs_interval(&query.ray, &query.bounds);
                let expected = format!("enters at {}", near.max(f64::from(query.ray.t_min)));
                let text = format!("enters at {enter}");
                let broken = Broken::with_texts(query.call("conservative_slab"), text, expected, "double precision");
                let is_exit = yours.is_some_and(|(enter, leave)| enter == leave);
                Err(broken.explained_by([
                    (enter == query.ray.t_min, "the box is entered at t_min: return where the ray enters it"),
                    (is_exit, "the exit is returned as the entry"),
                ]))
            }
            Some((enter, _)) if enter > t => Err(Broken::with_texts(
                query.call("conservative_slab"),
                format!("enters at {enter}"),
                format!("at {t} or before: there the ray hits a triangle in the box"),
                "exactly",
            )
            .explained_by(["the entry is rounded up, so a search that has a hit at this t skips the box: move it earlier by 2 γ₃ |t|"
                .when(Mistake::None.slab(Widened::Exit, query).is_some_and(|(rounded, _)| rounded == enter))])),
            _ => Ok(()),
        }
    };
    all_hold(compare(&drawn, trial.kit.conservative_slab(&queries), judge))
}
