//! What each step of stage 12 changes, in counts: the same in every run and on every machine.

use crate::reference::{self, Triangles, Wide};
use raykata::bvh::{Node, PrimitiveHit};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::Triangle;
use raykata::wide::simd::{Instructions, Level, Vectorized};
use raykata::wide::{
    BLOCK, Child, Entered, FlatNode, FlatTree, Fork, ForkKind, Forks, NO_PRIMITIVE, NODE_COST, WideProbe,
    WideTree,
};
use solutions::{stage3_build, stage12_build, stage12_reinsertion, stage12_search, stage12_wide};
use std::collections::HashMap;

/// Prints the counts of all steps for these triangles and camera rays.
pub fn print(triangles: &[Triangle], rays: &[Ray]) {
    let line = |step: &str, text: String| println!("  {step:<34} {text}");
    let bounds = reference::bounds(triangles);

    let swept = stage12_wide::flatten(&stage3_build::build(&bounds, Split::SurfaceArea, BLOCK));
    line("1 flatten", format!("{} bytes per node, of {}", size_of::<FlatNode>(), size_of::<Node>()));

    let mut forks = Forks::new(true);
    let tree = stage12_build::build_parallel(&bounds, &mut forks);
    let log = forks.into_log();
    let halves = stage12_wide::flatten(&stage3_build::build(&bounds, Split::ObjectMedian, BLOCK));
    line(
        "2 build_binned",
        format!(
            "cost {:.2}; with the sweep of stage 3 {:.2}, with object median {:.2}",
            cost(&tree),
            cost(&swept),
            cost(&halves)
        ),
    );

    let wide = stage12_wide::collapse(&tree);
    let used = |tree: &WideTree| {
        tree.blocks.iter().flatten().filter(|&&id| id != NO_PRIMITIVE).count() as f64
            / tree.blocks.len() as f64
    };
    line(
        "3 block_cost",
        format!(
            "{:.2} of {BLOCK} triangles per block; with the sweep {:.2}",
            used(&wide),
            used(&stage12_wide::collapse(&swept))
        ),
    );

    let inner = tree.nodes.iter().filter(|node| !node.is_leaf()).count();
    let children: u32 = wide.nodes.iter().map(|node| node.n_children()).sum();
    line(
        "4 collapse",
        format!(
            "{inner} inner nodes become {}, of {:.2} children each",
            wide.nodes.len(),
            f64::from(children) / wide.nodes.len() as f64
        ),
    );

    let built = Wide::build(triangles, true);
    let [visits, blocks, exact] = built.counts(rays, false).map(|count| count as f64 / rays.len() as f64);
    let [unordered, blocks_unordered, _] =
        without_order(&built, rays).map(|count| count as f64 / rays.len() as f64);
    line("5 enter_boxes", format!("{visits:.2} steps per camera ray, of up to eight boxes each"));
    line("6 may_hit", format!("{blocks:.2} steps of four triangles, {exact:.2} exact tests"));
    line(
        "7 wide_closest_hit",
        format!("{:.2} steps in order, {:.2} without", visits + blocks, unordered + blocks_unordered),
    );

    let (work, span) = work_and_span(&tree, &log);
    line(
        "8 build_parallel",
        format!("work {work}, span {span}: {:.1}; {} forks", work as f64 / span as f64, log.len()),
    );

    let better = stage12_reinsertion::reinsert(&tree, tree.nodes.len() as u32);
    line("9 reinsert (bonus)", format!("cost {:.2} in place of {:.2}", cost(&better), cost(&tree)));
}

/// The cost of a tree by the surface area heuristic of stage 12, as a multiple of a block's.
fn cost(tree: &FlatTree) -> f64 {
    let area = |node: &FlatNode| {
        let size = (node.high - node.low).as_dvec3();
        size.x * size.y + size.y * size.z + size.z * size.x
    };
    let Some(root) = tree.nodes.first() else { return 0.0 };
    let of_node = |node: &FlatNode| {
        let cost = if node.is_leaf() { stage12_build::block_cost(node.count) } else { NODE_COST };
        area(node) * f64::from(cost)
    };
    tree.nodes.iter().map(of_node).sum::<f64>() / area(root)
}

/// Work and span of a build, counted in primitives, see `build_parallel`.
fn work_and_span(tree: &FlatTree, log: &[Fork]) -> (u64, u64) {
    let mut forked = HashMap::new();
    let mut pieces = HashMap::new();
    for fork in log {
        match fork.kind {
            ForkKind::Children => forked.insert((fork.first, fork.count), 1),
            ForkKind::Binning { pieces: n } => pieces.insert((fork.first, fork.count), n),
        };
    }
    // A parent stands before its children, so go backwards.
    let mut of_nodes = vec![(0, 0, 0, 0); tree.nodes.len()];
    for (i, node) in tree.nodes.iter().enumerate().rev() {
        of_nodes[i] = if node.is_leaf() {
            (node.first, node.count, u64::from(node.count), u64::from(node.count))
        } else {
            let (left, right) = (of_nodes[node.first as usize], of_nodes[node.first as usize + 1]);
            let (first, count) = (left.0, left.1 + right.1);
            let n = u64::from(count);
            let own = pieces.get(&(first, count)).map_or(n, |&pieces| n / 2 + n / (2 * u64::from(pieces)));
            let both =
                if forked.contains_key(&(first, count)) { left.3.max(right.3) } else { left.3 + right.3 };
            (first, count, n + left.2 + right.2, own + both)
        };
    }
    of_nodes.first().map_or((0, 0), |root| (root.2, root.3))
}

/// The counts of a search that does not know where a ray enters a child: nothing is sorted or skipped.
fn without_order(wide: &Wide, rays: &[Ray]) -> [u64; 3] {
    struct Unordered<'a, L>(Triangles<'a, L>);

    impl<L: Level> WideProbe for Unordered<'_, L> {
        #[inline(always)]
        fn enter(&mut self, node: u32, t_max: f32) -> Entered {
            Entered { t: [0.0; 8], ..self.0.enter(node, t_max) }
        }

        #[inline(always)]
        fn children(&self, node: u32) -> &[Child; 8] {
            self.0.children(node)
        }

        #[inline(always)]
        fn candidates(&mut self, block: u32, n: u32, t_max: f32) -> u32 {
            self.0.candidates(block, n, t_max)
        }

        #[inline(always)]
        fn hit(&mut self, block: u32, lane: u32, ray: &Ray) -> Option<PrimitiveHit> {
            self.0.hit(block, lane, ray)
        }
    }

    struct Search<'a>(&'a Wide, &'a [Ray]);

    impl Vectorized for Search<'_> {
        type Output = [u64; 3];

        #[inline(always)]
        fn run<L: Level>(self, level: L) -> [u64; 3] {
            let mut sum = [0; 3];
            for ray in self.1 {
                let mut probe = Unordered(Triangles::new(self.0, ray, level));
                let _ = stage12_search::wide_closest_hit(&mut probe, ray);
                sum.iter_mut().zip(probe.0.counts).for_each(|(sum, count)| *sum += count);
            }
            sum
        }
    }

    Instructions::detect().run(Search(wide, rays))
}
