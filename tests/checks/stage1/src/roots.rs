//! `nearest_root`: which of two roots is the hit.

use checks::prelude::*;

const OPEN_AT_BOTH_ENDS: &str = "you return an end of the range, but the range is open at both ends";

pub(super) const T_ABOVE_0: &str = "you ask t > 0 and not ray.contains(t): t_min and t_max count";

const LARGER: &str = "you return the larger root, also if the smaller one counts";

const SORTED_WITH_NAN: &str =
    "comparisons with NaN are false, so NaN takes the place of the other root: use f32::min and f32::max";

const NAN_HIDES_THE_OTHER: &str = "one root is NaN, but the other one may still count";

fn judge(query: &RootQuery, yours: Option<f32>) -> Judged {
    let ([first, second], ray) = (query.roots, query.ray);
    let counting = |t: f32| ray.contains(t);
    let expected = query.roots.into_iter().filter(|&t| counting(t)).reduce(f32::min);
    let is_right = yours == expected;
    let broken = || {
        Broken::new(query.call("nearest_root"), yours, expected, "the definition").explained_by([
            (yours.is_some_and(f32::is_nan), "you return NaN, which ray.contains(t) refuses"),
            (yours.is_some_and(f32::is_infinite), "you return infinity, which ray.contains(t) refuses"),
        ])
    };
    let (near, far) = (first.min(second), first.max(second));
    let among = |counts: &dyn Fn(f32) -> bool| [near, far].into_iter().find(|&t| counts(t));
    // Whether the answer is the first root that counts, and whether it is the first root if that one counts.
    let first_that_counts = |roots: [f32; 2]| yours == roots.into_iter().find(|&t| counting(t));
    let first_if_it_counts = |roots: [f32; 2]| yours == Some(roots[0]).filter(|&t| counting(t));
    let positive = if near > 0.0 { near } else { far };
    // Each comparison with NaN is false, so a sort by an if-else always swaps the roots, or never.
    let with_nan = |gives: bool| if first.is_nan() || second.is_nan() { gives } else { is_right };
    let none_if = |condition: bool| if condition { yours.is_none() } else { is_right };
    unless(is_right, broken).formulas([
        "you return an end of the range; the range is open: t_min and t_max do not count"
            .when(yours == among(&|t| ray.t_min <= t && t <= ray.t_max)),
        (yours == among(&|t| ray.t_min < t && t <= ray.t_max), OPEN_AT_BOTH_ENDS),
        (yours == among(&|t| ray.t_min <= t && t < ray.t_max), OPEN_AT_BOTH_ENDS),
        (yours == among(&|t| t > ray.t_min), "you return a root beyond t_max, which ray.contains(t) refuses"),
        (yours == among(&|t| t < ray.t_max), "you return a root before t_min, which ray.contains(t) refuses"),
        (yours == among(&|t| t > 0.0), T_ABOVE_0),
        (yours == among(&|t| t > 0.0 && t < ray.t_max), T_ABOVE_0),
        (yours == Some(near), "you return the smaller root, also if ray.contains(t) refuses it"),
        "you return None if the smaller root does not count, but the larger one may"
            .when(yours == Some(near).filter(|&t| counting(t))),
        "you choose the first positive root and ask ray.contains(t) about it alone: the larger root may count"
            .when(yours == Some(positive).filter(|&t| counting(t))),
        (first_if_it_counts([first, second]), "you only look at the first root, but they come in any order"),
        "you take the first root that counts for the smaller one, but they come in any order"
            .when(first_that_counts([first, second])),
        (yours == Some(far).filter(|&t| counting(t)), LARGER),
        (first_that_counts([far, near]), LARGER),
        "you take the root with the smaller absolute value first, but -1 is smaller than 0.5"
            .when(first_that_counts(if near.abs() <= far.abs() { [near, far] } else { [far, near] })),
        (with_nan(first_if_it_counts([first, second])), SORTED_WITH_NAN),
        (with_nan(first_that_counts([first, second])), SORTED_WITH_NAN),
        (with_nan(first_if_it_counts([second, first])), SORTED_WITH_NAN),
        (with_nan(first_that_counts([second, first])), SORTED_WITH_NAN),
        (none_if(first.is_nan()), NAN_HIDES_THE_OTHER),
        (none_if(second.is_nan()), NAN_HIDES_THE_OTHER),
        (none_if(first.is_nan() || second.is_nan()), NAN_HIDES_THE_OTHER),
        "one root is NaN or infinite, but the other one may still count"
            .when(none_if(!first.is_finite() || !second.is_finite())),
    ])
}

fn judge_all(trial: &Trial<'_>, queries: &[RootQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.nearest_root(queries), judge)
}

pub(super) fn nearest_root_is_the_smaller_one_that_counts(trial: &Trial<'_>) -> CheckResult {
    // Begin with roots that are clearly out of range, and with both orders: random roots shrink to an end of the range.
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let drawn = [
        RootQuery { roots: [-2.0, -1.0], ray },
        RootQuery { roots: [2.0, 3.0], ray: ray.with_range(0.0, 1.0) },
        RootQuery { roots: [3.0, 2.0], ray },
        RootQuery { roots: [2.0, 3.0], ray },
        RootQuery { roots: [0.5, 3.0], ray: ray.with_range(1.0, 4.0) },
        RootQuery { roots: [3.0, 0.5], ray: ray.with_range(1.0, 4.0) },
    ];
    let root = || fractions(-24..=24, 8.0);
    let coarse = (root(), root(), 0..=8i32, 0..=24i32).prop_map(|(first, second, start, length)| {
        let (t_min, length) = (start as f32 / 8.0, length as f32 / 8.0);
        RootQuery { roots: [first, second], ray: ray.with_range(t_min, t_min + length) }
    });
    // Roots of any size, and ranges that end at a root, one float before it or one float behind it.
    let fine = (root(), root(), nasty::any_scale(), 0..7usize, 0..2usize).prop_map(
        move |(first, second, scale, end, which)| {
            let roots = [scale * first, scale * second];
            let (range, _) = match end {
                6 => ((0.0, f32::INFINITY), true),
                end => nasty::ranges(roots[which])[end],
            };
            RootQuery { roots, ray: ray.with_range(range.0, range.1) }
        },
    );
    trial.forall_and(&drawn, 3000, prop_oneof![coarse, fine], |queries| judge_all(trial, queries))
}

pub(super) fn nearest_root_of_nan_is_the_other_one(trial: &Trial<'_>) -> CheckResult {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let t = trial.varied(2.0, 0.5f32..50.0);
    let roots = [
        [f32::NAN, f32::NAN],
        [f32::NAN, t],
        [t, f32::NAN],
        [f32::NAN, -t],
        [f32::INFINITY, f32::NEG_INFINITY],
        [f32::NEG_INFINITY, t],
        [f32::INFINITY, t],
    ];
    let queries = roots.map(|roots| RootQuery { roots, ray });
    all_hold(judge_all(trial, &queries))
}
