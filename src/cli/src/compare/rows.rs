//! The rows that can be compared: settings that differ in one thing.

use raykata::graph::GraphOptimisations;
use raykata::partition::KdHeuristics;
use raykata::scene::{Accelerator, Precision, Quality, Scene, SphereMethod, Split, TriangleMethod};

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Every accelerator; the hierarchy with each of its splits.
    Structures,
    /// The optimisations of a scene graph search: volumes, skipping, sorting; and a hierarchy with a cache or
    /// packets.
    Savings,
    /// The kd-tree without each of its five heuristics.
    Heuristics,
    /// The grid at growing resolutions, and the formula's.
    Grids,
    /// The tests of triangles and of spheres, one after the other.
    Methods,
    /// Meshes with several instances: shared, or copied.
    Instances,
}

impl Comparison {
    /// All of them by name.
    pub const NAMES: [(&str, Comparison); 6] = [
        ("structures", Comparison::Structures),
        ("savings", Comparison::Savings),
        ("heuristics", Comparison::Heuristics),
        ("grids", Comparison::Grids),
        ("methods", Comparison::Methods),
        ("instances", Comparison::Instances),
    ];
}

/// One line of the table.
#[derive(Clone, Debug)]
pub struct Row {
    /// The name in the table, and in names of files.
    pub name: String,
    /// The settings.
    pub quality: Quality,
}

/// The lines. `only` names accelerators, or is empty.
pub fn rows(of: Comparison, only: &[Accelerator], scene: &Scene) -> Vec<Row> {
    let own = scene.quality;
    let row = |name: &str, quality| Row { name: name.replace('_', " "), quality };
    let by = |name: &str, accelerator| row(name, Quality { accelerator, ..own });
    match of {
        Comparison::Structures => {
            let all: &[Accelerator] = if only.is_empty() { &Accelerator::ALL } else { only };
            let bvh = |(name, split): (&str, Split)| {
                row(&format!("bvh, {name}"), Quality { accelerator: Accelerator::Bvh, split, ..own })
            };
            let rows = |&accelerator: &Accelerator| match accelerator {
                Accelerator::Bvh => Split::NAMES.map(bvh).to_vec(),
                other => vec![by(other.name(), other)],
            };
            all.iter().flat_map(rows).collect()
        }
        Comparison::Savings => {
            let graph = |name: &str, accelerator, savings| row(name, Quality { accelerator, savings, ..own });
            let none = GraphOptimisations { volumes: false, skip: false, sort: false };
            let boxes = Accelerator::BoundingBoxes;
            let spheres = Accelerator::BoundingSpheres;
            let cached = Accelerator::CachedBoundingBoxes;
            let all = GraphOptimisations::default();
            let unsorted = GraphOptimisations { sort: false, ..all };
            vec![
                graph("graph, nothing saved", boxes, none),
                graph("graph, boxes first", boxes, GraphOptimisations { volumes: true, ..none }),
                graph("graph, boxes, skip", boxes, unsorted),
                graph("graph, boxes, skip, cached child", cached, unsorted),
                graph("graph, boxes, sort", boxes, GraphOptimisations { skip: false, ..all }),
                graph("graph, boxes, skip and sort", boxes, all),
                graph("graph, boxes, skip, sort, cached child", cached, all),
                graph("graph, spheres, skip and sort", spheres, all),
                by("bvh, both children", Accelerator::BvhBothChildren),
                by("bvh", Accelerator::Bvh),
                by("bvh, last hit first", Accelerator::CachedBvh),
                by("bvh, packets of 8", Accelerator::PacketBvh),
                by("bvh, 8 children per node", Accelerator::WideBvh),
            ]
        }
        Comparison::Heuristics => {
            let (all, easy) = (KdHeuristics::default(), KdHeuristics::NONE);
            let tree = |name: &str, kd_heuristics| {
                row(name, Quality { accelerator: Accelerator::KdTree, kd_heuristics, ..own })
            };
            vec![
                tree("kd-tree, all five", all),
                tree("without longest axis", KdHeuristics { longest_axis: false, ..all }),
                tree("without balanced counts", KdHeuristics { balanced_counts: false, ..all }),
                tree("without few straddlers", KdHeuristics { few_straddlers: false, ..all }),
                tree("without empty space cut off", KdHeuristics { cut_off_empty_space: false, ..all }),
                tree("without stop at 60 %", KdHeuristics { stop_at_overlap: false, ..all }),
                tree("easy way", easy),
                tree("easy, longest axis", KdHeuristics { longest_axis: true, ..easy }),
                tree("easy, balanced counts", KdHeuristics { balanced_counts: true, ..easy }),
                tree("easy, few straddlers", KdHeuristics { few_straddlers: true, ..easy }),
                tree("easy, empty cut off", KdHeuristics { cut_off_empty_space: true, ..easy }),
                tree("easy, stop at 60 %", KdHeuristics { stop_at_overlap: true, ..easy }),
            ]
        }
        Comparison::Grids => {
            let grid = |name: &str, grid_resolution| {
                row(name, Quality { accelerator: Accelerator::Grid, grid_resolution, ..own })
            };
            let ladder = [1, 4, 8, 16, 32, 64, 128, 256].map(|n| grid(&format!("grid, {n} along"), n));
            [ladder.to_vec(), vec![grid("grid, by the formula", 0)]].concat()
        }
        Comparison::Methods => {
            let single = Quality { precision: Precision::Single, ..own };
            let triangles = TriangleMethod::NAMES.map(|(name, triangle_method)| {
                row(&format!("triangles, {name}"), Quality { triangle_method, ..single })
            });
            let spheres = SphereMethod::NAMES.map(|(name, sphere_method)| {
                row(&format!("spheres, {name}"), Quality { sphere_method, ..single })
            });
            let double = Quality { precision: Precision::Double, ..own };
            let double = row("both, double precision", double);
            [triangles.to_vec(), spheres.to_vec(), vec![double]].concat()
        }
        Comparison::Instances => vec![
            row("one mesh, many places", Quality { copies: false, ..own }),
            row("copies", Quality { copies: true, ..own }),
        ],
    }
}
