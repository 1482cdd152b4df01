//! `build`: whole trees.

use super::cuts::centroids_differ;
use super::divided::boxes;
use super::slabs::UNIT_BOX;
use checks::golden::Table;
use checks::prelude::*;
use checks::tree;
use raykata::bvh::{Bvh, Contents, DEEPEST_SPLIT, Node};
use raykata::scene::Split;

/// The tree of one query, or the message about a panic.
fn built(trial: &Trial<'_>, query: &BuildQuery) -> Result<Bvh, Broken> {
    let build = |query: BuildQuery| kit_error::catch(|| trial.kit.build(&[query]).remove(0));
    match build(query.clone()) {
        Ok(bvh) => Ok(bvh),
        Err(KitError::Panicked { message, place }) => {
            let panic = format!("a panic at {place}: {message}");
            let broken =
                Broken::with_texts(query.call("build"), panic, "a tree", "the invariants of a hierarchy");
            // With n < leaf_size, leaves of at most two hold one primitive each, and leaves of one never end.
            let two = BuildQuery { split: Split::ObjectMedian, leaf_size: 2, ..query.clone() };
            let holds_one = |bvh: Bvh| {
                let is_larger =
                    |node: &Node| matches!(node.contents, Contents::Leaf { count, .. } if count > 1);
                !bvh.nodes.iter().any(is_larger)
            };
            Err(broken.explained_by(["this is the slide, e - s < N: exactly leaf_size primitives fit into a leaf, so stop at n ≤ leaf_size"
                .when(query.leaf_size == 1 && build(two).is_ok_and(holds_one))]))
        }
        Err(error) => kit_error::unwind(error),
    }
}

/// The tree of one query, if it has no faults.
fn judged(trial: &Trial<'_>, query: &BuildQuery) -> Result<Bvh, Broken> {
    let bvh = built(trial, query)?;
    let Some((yours, expected)) = tree::fault(&bvh, &query.bounds, query.leaf_size) else { return Ok(bvh) };
    let mistakes = build_mistakes(&yours);
    let broken = Broken::with_texts(query.call("build"), yours, expected, "the invariants of a hierarchy");
    Err(broken.explained_by(mistakes))
}

pub(super) fn judge_builds(trial: &Trial<'_>, queries: &[BuildQuery]) -> Vec<CheckResult> {
    queries.iter().map(|query| judged(trial, query).map(|_| ())).collect()
}

/// Whether each group of primitives is divided as the student's own `split_surface_area`, which other checks judge, says.
fn judge_groups(trial: &Trial<'_>, query: &BuildQuery) -> CheckResult {
    fn below(bvh: &Bvh, node: u32) -> Vec<u32> {
        match bvh.nodes[node as usize].contents {
            Contents::Leaf { first, count } => bvh.primitives(first, count).to_vec(),
            Contents::Inner { left, right } => [below(bvh, left), below(bvh, right)].concat(),
        }
    }
    let bvh = &judged(trial, query)?;
    let all = tree::references(&query.bounds);
    let groups: Vec<SplitQuery> = (0..bvh.nodes.len() as u32)
        .map(|node| below(bvh, node).into_iter().map(|id| all[id as usize]).collect())
        .map(|primitives| SplitQuery { split: Split::SurfaceArea, primitives })
        .collect();
    // Equal centroids may be sorted in any order, and then the costs depend on it.
    let decides = |group: &SplitQuery| group.primitives.len() > 1 && centroids_differ(&group.primitives);
    let (nodes, groups): (Vec<&Node>, Vec<SplitQuery>) =
        bvh.nodes.iter().zip(groups).filter(|(_, group)| decides(group)).unzip();
    let judge = |((node, group), own): ((&&Node, &SplitQuery), SplitAnswer)| {
        let n = group.primitives.len();
        let n_left = match node.contents {
            Contents::Leaf { .. } => None,
            Contents::Inner { left, .. } => Some(below(bvh, left).len()),
        };
        let (expected, rule) = match (own.middle, n_left) {
            (Some(_), None) => ("a cut", CHEAPER),
            (None, Some(_)) if n <= query.leaf_size => {
                ("a leaf", "a group of leaf_size or fewer for which no cut is cheaper becomes a leaf")
            }
            (None, Some(left)) if left.abs_diff(n - left) > 1 => {
                ("two halves", "a larger group for which no cut is cheaper is split by the object median")
            }
            _ => return Ok(()),
        };
        let yours = n_left.map_or("a leaf".into(), |left| format!("{left} and {}", n - left));
        let yours = format!(
            "{n} primitives, for which your split_surface_area gives {:?}, become {yours}",
            own.middle
        );
        Err(Broken::with_texts(query.call("build"), yours, expected, "the definition").because(rule))
    };
    let answers = trial.kit.split(&groups);
    all_hold(nodes.iter().zip(&groups).zip(answers).map(judge).collect())
}

pub(super) const CHEAPER: &str =
    "each group of leaf_size or fewer is a leaf: by the heuristic it is still split if that is cheaper";

/// The faults of a tree in the words of a diagnosis.
fn build_mistakes(fault: &str) -> [(bool, &'static str); 5] {
    let missing = fault.ends_with("in 0 leaves");
    [
        (missing, "a primitive was left out: both halves together must hold all of them"),
        "a primitive is in both halves: the right half begins where the left half ends"
            .when(fault.ends_with("leaves") && !missing),
        (fault.contains(" holds "), "a leaf must hold 1 to leaf_size primitives: stop only at n ≤ leaf_size"),
        (fault.contains("sticks out"), "the box of a node must contain everything below it"),
        (fault.ends_with("nodes"), "without primitives there is nothing to build: add no node"),
    ]
}

pub(super) fn split() -> impl Strategy<Value = Split> + Clone {
    prop::sample::select(Split::ALL.to_vec())
}

fn build_queries() -> impl Strategy<Value = BuildQuery> + Clone {
    (boxes(40), split(), 1..=5usize).prop_map(|(bounds, split, leaf_size)| BuildQuery {
        bounds,
        split,
        leaf_size,
    })
}

pub(super) fn build_holds_every_primitive_once(trial: &Trial<'_>) -> CheckResult {
    trial.forall(400, build_queries(), |queries| judge_builds(trial, queries))
}

/// Judges the groups of trees by the surface area heuristic.
pub(super) fn judge_by_area(trial: &Trial<'_>) -> CheckResult {
    // Boxes that hide each other, so that a leaf is cheaper than any cut, and whose middle is far from their median.
    let bounds = (0..7).map(|i| Vec3::splat(2f32.powi(-i))).map(|low| Aabb::new(low, low + 9.0)).collect();
    let heap = BuildQuery { bounds, split: Split::SurfaceArea, leaf_size: 2 };
    let queries = build_queries().prop_map(|query| BuildQuery { split: Split::SurfaceArea, ..query });
    trial.forall_and(&[heap], 200, queries, |queries| {
        queries.iter().map(|query| judge_groups(trial, query)).collect()
    })
}

/// Judges builds with every split strategy and two leaf sizes.
pub(super) fn build_all_ways(trial: &Trial<'_>, bounds: &[Aabb]) -> CheckResult {
    for split in Split::ALL {
        for leaf_size in [1, 4] {
            let query = BuildQuery { bounds: bounds.to_vec(), split, leaf_size };
            all_hold(judge_builds(trial, &[query]))?;
        }
    }
    Ok(())
}

pub(super) fn build_ends_where_all_centroids_are_one(trial: &Trial<'_>) -> CheckResult {
    build_all_ways(trial, &vec![UNIT_BOX; trial.about(1000)])?;
    let concentric: Vec<Aabb> = (1..=trial.varied(64, 50..80))
        .map(|i| Aabb::new(Vec3::splat(-i as f32), Vec3::splat(i as f32)))
        .collect();
    build_all_ways(trial, &concentric)?;
    let line: Vec<Aabb> =
        (0..64).map(|i| Aabb::new(vec3(i as f32, 0.0, 0.0), vec3(i as f32, 0.0, 0.0))).collect();
    build_all_ways(trial, &line)?;
    // Each coordinate is half of the one before, so a spatial median splits off one box per level.
    let halving: Vec<Aabb> = (0..100)
        .map(|i| {
            let x = 2f32.powi(-i);
            Aabb::new(Vec3::splat(x), Vec3::splat(x))
        })
        .collect();
    build_all_ways(trial, &halving)?;
    // To the left of 0 the other boxes are the right side of each split.
    let mirrored: Vec<Aabb> = halving.iter().map(|one| Aabb::new(-one.max, -one.min)).collect();
    judge_depth(
        trial,
        &mirrored,
        "100 points, each at half the distance of the one before to the left of 0",
    )?;
    // All boxes have a common corner, and a spatial median would split off the largest box at each of 400 levels.
    let nested: Vec<Aabb> = (1..=400).map(|i| Aabb::new(Vec3::ZERO, Vec3::splat(i as f32))).collect();
    judge_depth(trial, &nested, "400 boxes with a common corner, the box i with the sides i")
}

/// Whether the tree has at most `DEEPEST_SPLIT + ⌈log₂ n⌉ + 1` levels with every split.
fn judge_depth(trial: &Trial<'_>, bounds: &[Aabb], what: &str) -> CheckResult {
    let most = DEEPEST_SPLIT + bounds.len().next_power_of_two().ilog2() as usize + 1;
    for split in Split::ALL {
        let query = BuildQuery { bounds: bounds.to_vec(), split, leaf_size: 1 };
        let depth = judged(trial, &query)?.depth();
        if depth > most {
            let input = format!("build of {what}, {split:?}, leaf_size 1");
            let [yours, expected] = [depth, most].map(|n| format!("{n} levels"));
            let broken = Broken::with_texts(input, yours, format!("at most {expected}"), "counted");
            // An object median that does not halve explains it as well.
            return Err(broken.explained_by([
                "each level splits off few primitives: from depth DEEPEST_SPLIT on use the object median"
                    .when(built(trial, &BuildQuery { split: Split::ObjectMedian, ..query })?.depth() <= most),
            ]));
        }
    }
    Ok(())
}

pub(super) fn build_of_nothing_and_of_one(trial: &Trial<'_>) -> CheckResult {
    build_all_ways(trial, &[])?;
    build_all_ways(trial, &[UNIT_BOX])?;
    build_all_ways(trial, &[UNIT_BOX, Aabb::new(Vec3::splat(3.0), Vec3::splat(4.0))])?;
    // Exactly leaf_size primitives still fit into a leaf.
    let four: Vec<Aabb> =
        (0..4).map(|i| Aabb::new(vec3(i as f32, 0.0, 0.0), vec3(i as f32 + 1.0, 1.0, 1.0))).collect();
    build_all_ways(trial, &four)?;
    for split in [Split::ObjectMedian, Split::SpatialMedian] {
        let query = BuildQuery { bounds: four.clone(), split, leaf_size: 4 };
        let nodes = built(trial, &query)?.nodes.len();
        if nodes != 1 {
            let describe = |n: usize| format!("{n} nodes");
            let yours = describe(nodes);
            return Err(Broken::with_texts(query.call("build"), yours, "1 node, a leaf", "the definition")
                .explained_by([
                    "exactly leaf_size primitives fit into a leaf, so stop at n ≤ leaf_size".when(nodes > 1)
                ]));
        }
    }
    Ok(())
}

pub(super) fn object_median_is_balanced(trial: &Trial<'_>) -> CheckResult {
    let n = 512;
    let bounds: Vec<Aabb> = (0..n)
        .map(|i| {
            let p = vec3((i * 7 % n) as f32, (i % 5) as f32, 0.0);
            Aabb::new(p, p + 0.5)
        })
        .collect();
    let query = BuildQuery { bounds, split: Split::ObjectMedian, leaf_size: 1 };
    let bvh = built(trial, &query)?;
    let (depth, nodes) = (bvh.depth(), bvh.nodes.len());
    if (depth, nodes) == (10, 1023) {
        return Ok(());
    }
    let describe = |depth: usize, nodes: usize| format!("depth {depth}, {nodes} nodes");
    let input = "build of 512 boxes, ObjectMedian, leaf_size 1";
    Err(Broken::with_texts(input, describe(depth, nodes), describe(10, 1023), "log₂ 512 + 1"))
}

pub(super) fn trees_of_eight_boxes(trial: &Trial<'_>) -> CheckResult {
    // The boxes are at x = 1, 2, 3, 4, 10, 20, 40, 80. No two are equal, so each split strategy has exactly one tree. For a
    // hidden seed they have other distances, which are large enough that x is the longest axis of each pair.
    let gaps =
        trial.composed(vec![1.0, 1.0, 1.0, 1.0, 6.0, 10.0, 20.0, 40.0], prop::collection::vec(0.7..20f32, 8));
    let places: Vec<f32> =
        gaps.iter().scan(0.0, |x, gap| Some(std::mem::replace(x, *x + gap) + gap)).collect();
    let bounds: Vec<Aabb> = [6, 0, 2, 5, 1, 7, 3, 4]
        .map(|place| places[place])
        .map(|x| Aabb::new(vec3(x, 0.0, 0.0), vec3(x + 0.5, 1.0, 1.0)))
        .to_vec();
    for (split, name) in [
        (Split::ObjectMedian, "object_median"),
        (Split::SpatialMedian, "spatial_median"),
        (Split::SurfaceArea, "surface_area"),
    ] {
        let query = BuildQuery { bounds: bounds.clone(), split, leaf_size: 1 };
        let (name, input) =
            (format!("stage3_tree_{name}"), format!("build of eight boxes along x, {split:?}, leaf_size 1"));
        built(trial, &query)?;
        let text = |kit: &dyn Kit| tree::as_text(&kit.build(std::slice::from_ref(&query))[0]);
        Table { name: &name, input: &input }.check(trial, text)?;
    }
    Ok(())
}
