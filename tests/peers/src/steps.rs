//! What each step of stage 12 changes, in counts: the same in every run and on every machine.

use crate::reference::{self, Search, Wide};
use raykata::bvh::Node;
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::Triangle;
use raykata::wide::{BLOCK, FlatNode, Forks, NO_PRIMITIVE, WideTree};
use solutions::{stage3_build, stage12_build, stage12_wide};
use stage12_checks::forks::work_and_span_of_log;
use stage12_checks::trees::cost;

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
    let per_ray = |search| built.counts(rays, search).map(|count| count as f64 / rays.len() as f64);
    let [visits, blocks, exact] = per_ray(Search::Closest);
    let [visits_unordered, blocks_unordered, _] = per_ray(Search::ClosestWithoutOrder);
    line("5 enter_boxes", format!("{visits:.2} steps per camera ray, of up to eight boxes each"));
    line("6 may_hit", format!("{blocks:.2} steps of four triangles, {exact:.2} exact tests"));
    line(
        "7 wide_closest_hit",
        format!("{:.2} steps in order, {:.2} without", visits + blocks, visits_unordered + blocks_unordered),
    );

    let (work, span) = work_and_span_of_log(&tree, &log);
    line(
        "8 build_parallel",
        format!("work {work}, span {span}: {:.1}; {} forks", work as f64 / span as f64, log.len()),
    );
}
