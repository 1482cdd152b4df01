//! Slab tests in single precision with one mistake each.

use checks::prelude::*;
use raykata::rounding::gamma;

#[derive(Clone, Copy, PartialEq)]
enum Mistake {
    None,
    /// The planes are never swapped.
    NotSwapped,
    /// The planes are swapped if `d < 0`, which is false for -0.0.
    SwappedByLess,
    /// The two planes are sorted by min and max, which drop NaN, or by a comparison, which is false for NaN.
    MinMax,
    SwappedIfGreater,
    SwappedUnlessLess,
    /// All axes at once by the min and max of vectors.
    Vectors,
    /// The interval of the first axis is taken as it is.
    FirstAxis,
    /// A smaller component of the direction becomes this.
    LeastDirection(f32),
    /// A NaN replaces the entry or the exit.
    NanTakenOver,
    /// A NaN replaces the entry, and the limit of the range replaces the NaN.
    NanEntry,
    /// `b/d - o/d` in place of `(b - o)/d`.
    FastForm,
    /// The product with `1/d` where it overflows.
    Overflow,
    /// The interval must have a length.
    Open,
    /// The box is larger by this on each side, and the interval must have a length.
    Padded(f32),
    /// The entry must not lie before `t_min`.
    NotFromInside,
    /// The exit must lie behind `t_min`.
    ExitBehindStart,
    /// The entry must lie before `t_max`, and both at once.
    EntryBeforeEnd,
    OpenRange,
    /// The range begins at 0.
    FromZero,
    /// Entry or exit is not limited by the range.
    StartIgnored,
    EndIgnored,
    RangeIgnored,
    /// The interval of the line is returned if a part of it lies within the range.
    OfTheLine,
    /// This axis is left out.
    LeftOut(usize),
    /// The smaller entry and the larger exit.
    Widest,
    /// The exit in place of an entry at or before `t_min`.
    ExitFromInside,
    /// The exit is later by this.
    Later(f32),
}

const SORTED: &str = "0 · ∞ is NaN, and a comparison with NaN is false: choose the two planes by the sign of 1/d, and drop NaN";

const PADDED_BOX: &str =
    "you pad the box by a fixed length, which is rounded away far from the origin: use ≤ and no padding";

const LEFT_OUT: &str = "an axis is left out: the ray must be between the planes of all three axes at once";

const LATER: &str =
    "you move the exit by a fixed length, but its rounding error grows with t: multiply it by 1 + 2 γ₃";

const PADDED_DIRECTION: &str = "you replace a direction near 0 by an epsilon, so the ray bends: 1/d may be infinite, and 0 · ∞ is NaN and dropped";

const MISTAKES: [(Mistake, &str); 23] = named![
    Mistake::ExitFromInside => "you return the exit in place of the entry if the ray starts inside: it enters at t_min",
    Mistake::FromZero => "your range begins at 0: only the part within t_min..t_max counts",
    Mistake::EntryBeforeEnd => "the ends of the range count: an entry exactly at t_max is a hit",
    Mistake::OpenRange => "the ends of the range count: an exit exactly at t_min is a hit, and so is an entry at t_max",
    Mistake::NotSwapped => "for a negative direction component the ray enters at max: swap the two planes",
    Mistake::SwappedByLess => "-0.0 ≥ 0 is true, but 1 / -0.0 is -∞: swap the two planes by the sign of 1/d",
    Mistake::FastForm => "1/d is ∞ for d = 0, and ∞ - ∞ is NaN: subtract first, (b - o) · 1/d and not b/d - o/d",
    Mistake::MinMax => "0 · ∞ is NaN, and min and max drop NaN: a ray within a face hits the closed box",
    Mistake::SwappedIfGreater => SORTED,
    Mistake::SwappedUnlessLess => SORTED,
    Mistake::Vectors => "0 · ∞ is NaN, and Vec3::min and max may return NaN or drop it: a ray within a face hits",
    Mistake::FirstAxis => "0 · ∞ is NaN, and your interval begins with that of x: begin with the range of the ray",
    Mistake::NanTakenOver => "0 · ∞ is NaN, and it becomes your entry or exit: order the comparison so that it drops NaN",
    Mistake::NanEntry => "0 · ∞ is NaN, and it takes the place of your entry: order the comparison so that it drops NaN",
    Mistake::Overflow => "1/d overflows to ∞ for a tiny d: divide by d there",
    Mistake::ExitBehindStart => "the box is closed: an exit exactly at t_min is a hit",
    Mistake::Open => "entry equals exit in a flat box or at an edge: compare with ≤, not with <",
    Mistake::NotFromInside => "you return None if the ray starts inside, where the entry is behind it: test the exit, not t_b⁻ ≥ 0",
    Mistake::StartIgnored => "your entry or your exit is before t_min: only the part within t_min..t_max counts",
    Mistake::EndIgnored => "your entry or your exit is beyond t_max: only the part within t_min..t_max counts",
    Mistake::Widest => "you unite the intervals of the axes: intersect them",
    Mistake::RangeIgnored => "you do not limit the interval to t_min..t_max",
    Mistake::OfTheLine => "you do not limit the interval to t_min..t_max",
];

/// How far a slab test widens its interval.
#[derive(Clone, Copy, PartialEq)]
enum Widened {
    Not,
    Exit,
    Both,
}

/// The interval that the box of a wrong test has in common with the ray.
fn slab(mistake: Mistake, widened: Widened, SlabQuery { ray, bounds, .. }: &SlabQuery) -> Option<(f32, f32)> {
    if bounds.is_empty() {
        return None;
    }
    if mistake == Mistake::Vectors {
        let inverse = ray.direction.recip();
        let [p, q] = [bounds.min, bounds.max].map(|plane| (plane - ray.origin) * inverse);
        let near = p.min(q).max_element().max(ray.t_min);
        let far = p.max(q).min_element().min(ray.t_max);
        return (near <= far).then_some((near, far));
    }
    let (mut near, mut far) = (f32::NEG_INFINITY, f32::INFINITY);
    let pad = if let Mistake::Padded(pad) = mistake { pad } else { 0.0 };
    for axis in (0..3).filter(|&axis| mistake != Mistake::LeftOut(axis)) {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        let d = match mistake {
            Mistake::LeastDirection(least) if d.abs() < least => least.copysign(d),
            _ => d,
        };
        let inverse = 1.0 / d;
        let t = |plane: f32| match mistake {
            Mistake::FastForm => plane * inverse - o * inverse,
            Mistake::Overflow => (plane - o) * inverse,
            _ if inverse.is_infinite() && d != 0.0 => (plane - o) / d,
            _ => (plane - o) * inverse,
        };
        let ends = [t(bounds.min[axis] - pad), t(bounds.max[axis] + pad)];
        let swapped = match mistake {
            Mistake::NotSwapped => false,
            Mistake::SwappedByLess => d < 0.0,
            Mistake::SwappedIfGreater => ends[0] > ends[1],
            Mistake::SwappedUnlessLess => !(ends[0] < ends[1]),
            _ => inverse.is_sign_negative(),
        };
        let (enter, leave) = match mistake {
            Mistake::MinMax => (ends[0].min(ends[1]), ends[0].max(ends[1])),
            _ if swapped => (ends[1], ends[0]),
            _ => (ends[0], ends[1]),
        };
        if mistake == Mistake::NanTakenOver {
            near = if enter <= near { near } else { enter };
            far = if leave >= far { far } else { leave };
        } else if mistake == Mistake::NanEntry {
            near = if enter <= near { near } else { enter };
            far = if leave < far { leave } else { far };
        } else if axis == 0 && matches!(mistake, Mistake::FirstAxis | Mistake::Widest) {
            (near, far) = (enter, leave);
        } else if mistake == Mistake::Widest {
            (near, far) = (near.min(enter), far.max(leave));
        } else {
            near = if enter > near { enter } else { near };
            far = if leave < far { leave } else { far };
        }
    }
    if (mistake == Mistake::NotFromInside && near < ray.t_min)
        || (mistake == Mistake::FirstAxis && (near.is_nan() || far.is_nan()))
    {
        return None;
    }
    let (less, more) = (1.0 - 2.0 * gamma(3), 1.0 + 2.0 * gamma(3));
    near = if widened == Widened::Both { (near * less).min(near * more) } else { near };
    far = if widened == Widened::Not { far } else { (far * less).max(far * more) };
    far = if let Mistake::Later(by) = mistake { far + by } else { far };
    let (at_start, at_end) = (far <= ray.t_min, near >= ray.t_max);
    if matches!(mistake, Mistake::ExitBehindStart | Mistake::OpenRange) && at_start
        || matches!(mistake, Mistake::EntryBeforeEnd | Mistake::OpenRange) && at_end
    {
        return None;
    }
    let t_min = if mistake == Mistake::FromZero { 0.0 } else { ray.t_min };
    let line = (near, far);
    let is_open = matches!(mistake, Mistake::Open | Mistake::Padded(_));
    if !matches!(mistake, Mistake::StartIgnored | Mistake::RangeIgnored) {
        let is_dropped = near.is_nan() && mistake == Mistake::NanEntry;
        near = if near < t_min || is_dropped { t_min } else { near };
    }
    if !matches!(mistake, Mistake::EndIgnored | Mistake::RangeIgnored) {
        far = if far > ray.t_max { ray.t_max } else { far };
    }
    let is_inside = mistake == Mistake::ExitFromInside && near <= ray.t_min;
    near = if is_inside { near.max(far) } else { near };
    (if is_open { near < far } else { !(near > far) }).then_some(if mistake == Mistake::OfTheLine {
        line
    } else {
        (near, far)
    })
}

/// Whether a test with this mistake gives this answer, up to a few roundings, or this verdict.
fn gives(
    mistake: Mistake,
    widened: Widened,
    query: &SlabQuery,
    yours: Option<(f32, f32)>,
    only_verdict: bool,
) -> bool {
    let same = |yours: f32, t: f32| {
        let (yours, t) = (f64::from(yours), f64::from(t));
        yours == t || (yours - t).abs() <= 32.0 * U * t.abs() || (yours.is_nan() && t.is_nan())
    };
    match (yours, slab(mistake, widened, query)) {
        (Some((enter, leave)), Some((near, far))) if !only_verdict => same(enter, near) && same(leave, far),
        (yours, other) => yours.is_some() == other.is_some(),
    }
}

/// Mistakes that a wrong answer alone shows.
pub(super) fn observations(query: &SlabQuery, yours: Option<(f32, f32)>) -> [(bool, &'static str); 3] {
    let is_lost_by_rounding = yours.is_none()
        && slab(Mistake::None, Widened::Not, query).is_none()
        && slab(Mistake::None, Widened::Both, query).is_some();
    [
        "the empty box (inf, -inf) has no point, but sorted planes make it infinite: test is_empty()"
            .when(query.bounds.is_empty() && yours.is_some()),
        "1/d, the difference and the product are rounded, so far may be slightly below near: multiply far by 1 + 2 γ₃"
            .when(is_lost_by_rounding),
        "you return NaN: 0 · ∞ is NaN, so order the comparison so that it drops NaN"
            .when(yours.is_some_and(|(enter, leave)| enter.is_nan() || leave.is_nan())),
    ]
}

/// All known mistakes, each with whether it gives this answer, or only this verdict.
pub(super) fn mistakes(
    query: &SlabQuery,
    yours: Option<(f32, f32)>,
    only_verdict: bool,
) -> Vec<(bool, &'static str)> {
    let lengths = [1e-12, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3];
    let all = (MISTAKES.into_iter())
        .chain(lengths.map(|least| (Mistake::LeastDirection(least), PADDED_DIRECTION)))
        .chain(lengths.map(|pad| (Mistake::Padded(pad), PADDED_BOX)))
        .chain(lengths.map(|by| (Mistake::Later(by), LATER)))
        .chain([0, 1, 2].map(|axis| (Mistake::LeftOut(axis), LEFT_OUT)));
    // A wrong test may widen the interval or not.
    let variants = |(mistake, text)| {
        [Widened::Not, Widened::Exit, Widened::Both]
            .map(|widened| (gives(mistake, widened, query, yours, only_verdict), text))
    };
    all.flat_map(variants).collect()
}
