//! How the checks judge a split: every primitive is kept, neither side is empty, and the rule of the strategy holds.

use checks::prelude::*;
use checks::tree;
use raykata::bvh::PrimitiveRef;
use raykata::scene::Split;

/// Sets of two boxes or more. Two of six sets are on a coarse grid or along a line, so that many centroids coincide. One of
/// six sets has boxes that are long on one axis, while their centroids are far apart on another.
pub(super) fn boxes(most: usize) -> impl Strategy<Value = Vec<Aabb>> + Clone {
    let small = (rough_point(8.0), point(1)).prop_map(|(p, size)| Aabb::new(p, p + size.abs()));
    let coarse = point(1).prop_map(|p| Aabb::new(p.round(), p.round() + 1.0));
    let nested = (0..9i32).prop_map(|i| Aabb::new(Vec3::ZERO, vec3(i as f32, 0.5, 0.25)));
    let long = (rough_point(2.0), 0..4i32).prop_map(|(p, length)| {
        Aabb::new(p - vec3(0.0, 0.0, 12.0 + length as f32), p + vec3(0.25, 0.25, 12.0))
    });
    prop_oneof![
        1 => prop::collection::vec(long, 2..most),
        3 => prop::collection::vec(small, 2..most),
        1 => prop::collection::vec(coarse, 2..most),
        1 => prop::collection::vec(nested, 2..most),
    ]
}

/// What is wrong with a split: yours, expected, and the known mistakes, each with whether it gives this split.
pub(super) type Fault = (String, String, Vec<(bool, &'static str)>);

/// Judges splits: every primitive is kept and neither side is empty. Then `law` judges the order and the middle, which
/// is 0 for a leaf. It gets the primitives as they were and in the new order, and returns a fault if they are wrong.
/// `formulas` gets the same, and lists wrong rules, each with whether it gives this split.
pub(super) fn judge_splits(
    trial: &Trial<'_>,
    split: Split,
    sets: &[Vec<Aabb>],
    law: impl Fn(&[PrimitiveRef], &[PrimitiveRef], usize) -> Option<Fault>,
    formulas: impl Fn(&[PrimitiveRef], &[PrimitiveRef], usize) -> Vec<(bool, &'static str)>,
) -> Vec<CheckResult> {
    let queries: Vec<SplitQuery> =
        sets.iter().map(|boxes| SplitQuery { split, primitives: tree::references(boxes) }).collect();
    let in_order = |query: &SplitQuery, order: &[u32]| -> Vec<PrimitiveRef> {
        order.iter().filter_map(|&id| query.primitives.get(id as usize)).copied().collect()
    };
    let judge = |query: &SplitQuery, yours: SplitAnswer| {
        let n = query.primitives.len();
        let input = format!("{split:?} of {n} boxes\n{}", list(query.primitives.iter().map(|p| &p.bounds)));
        let SplitAnswer { order, middle, .. } = yours;
        let mut ids = order.clone();
        ids.sort_unstable();
        if ids != (0..n as u32).collect::<Vec<_>>() {
            let all = format!("the primitives 0..{n} in some order");
            let broken = Broken::with_texts(input, format!("{order:?}"), all, "each primitive once");
            let twice = ids.windows(2).any(|pair| pair[0] == pair[1]);
            return Err(broken.explained_by([
                "a primitive was overwritten, and another one is there twice: swap two primitives instead"
                    .when(twice && ids.len() == n),
            ]));
        }
        if let Some(middle) = middle.filter(|&middle| middle == 0 || middle >= n) {
            let broken = Broken::with_texts(
                input,
                format!("{middle} left, {} right", n - middle.min(n)),
                "at least one on each side",
                "otherwise the build never ends",
            );
            // Whether all centroids are on one side of the middle of the box, or on it.
            let all = tree::around_all(&query.primitives);
            let one_side = tree::longest_axes(&all).into_iter().any(|axis| {
                let (cut, size) = (0.5 * (all.min[axis] + all.max[axis]), all.max[axis] - all.min[axis]);
                [0, n].into_iter().any(|middle| is_cut_at(&query.primitives, middle, axis, cut, size))
            });
            return Err(broken.explained_by([
                "all centroids are on one side of the cut: fall back on another split".when(one_side),
            ]));
        }
        let fault = match middle {
            Some(middle) => law(&query.primitives, &in_order(query, &order), middle),
            None => law(&query.primitives, &query.primitives, 0)
                .map(|(_, expected, mistakes)| ("None, a leaf".into(), expected, mistakes)),
        };
        fault.map_or(Ok(()), |(yours, expected, mistakes)| {
            Err(Broken::with_texts(input, yours, expected, "brute force").explained_by(mistakes))
        })
    };
    compare_formulas(
        &queries,
        trial.kit.split(&queries),
        judge,
        |query, SplitAnswer { order, middle, .. }| {
            let (ordered, middle) = (in_order(query, order), middle.unwrap_or(0));
            if middle >= ordered.len() { Vec::new() } else { formulas(&query.primitives, &ordered, middle) }
        },
    )
}

/// Whether `middle` divides the centroids along `axis`: none before it is beyond one behind it, in either direction.
pub(super) fn divided(ordered: &[PrimitiveRef], middle: usize, axis: usize) -> bool {
    divided_by(ordered, middle, &|p| p.centroid[axis])
}

/// The same with another number of each primitive.
pub(super) fn divided_by(
    ordered: &[PrimitiveRef],
    middle: usize,
    key: &dyn Fn(&PrimitiveRef) -> f32,
) -> bool {
    let range = |part: &[PrimitiveRef]| {
        let at = part.iter().map(key);
        at.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let (left, right) = (range(&ordered[..middle]), range(&ordered[middle..]));
    left.1 <= right.0 || right.1 <= left.0
}

/// Axes along which a median split may cut: the longest axes of the box around all boxes, and of the box around all
/// centroids.
pub(super) fn split_axes(primitives: &[PrimitiveRef]) -> Vec<usize> {
    let boxes = [tree::around_all(primitives), tree::around_centroids(primitives)];
    boxes.iter().flat_map(tree::longest_axes).collect()
}

/// Whether the primitives have kept their order.
pub(super) fn is_as_given(given: &[PrimitiveRef], ordered: &[PrimitiveRef]) -> bool {
    given.iter().map(|p| p.id).eq(ordered.iter().map(|p| p.id))
}

/// Whether the centroids before `middle` are below this cut and the others above it, in a box of this size. A centroid that is on
/// the cut, up to a rounding, may go to either side.
pub(super) fn is_cut_at(ordered: &[PrimitiveRef], middle: usize, axis: usize, cut: f32, size: f32) -> bool {
    let slack = 1e-5 * size;
    let left = ordered[..middle].iter().all(|p| p.centroid[axis] <= cut + slack);
    let right = ordered[middle..].iter().all(|p| p.centroid[axis] >= cut - slack);
    left && right
}
