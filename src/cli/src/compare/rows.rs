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
    let with = |name: &str, change: &dyn Fn(&mut Quality)| {
        let mut quality = scene.quality;
        change(&mut quality);
        Row { name: name.replace('_', " "), quality }
    };
    match of {
        Comparison::Structures => {
            let all: &[Accelerator] = if only.is_empty() { &Accelerator::ALL } else { only };
            let rows = |&accelerator: &Accelerator| match accelerator {
                Accelerator::Bvh => Split::ALL
                    .map(|split| {
                        let name = match split {
                            Split::ObjectMedian => "bvh, object median",
                            Split::SpatialMedian => "bvh, spatial median",
                            Split::SurfaceArea => "bvh, surface area",
                        };
                        with(name, &|quality| {
                            (quality.accelerator, quality.split) = (Accelerator::Bvh, split);
                        })
                    })
                    .to_vec(),
                other => vec![with(other.name(), &|quality| quality.accelerator = other)],
            };
            all.iter().flat_map(rows).collect()
        }
        Comparison::Savings => {
            let graph = |name: &str, accelerator, savings| {
                with(name, &|quality| (quality.accelerator, quality.savings) = (accelerator, savings))
            };
            let none = GraphOptimisations { volumes: false, skip: false, sort: false };
            let boxes = Accelerator::BoundingBoxes;
            let spheres = Accelerator::BoundingSpheres;
            let cached = Accelerator::CachedBoundingBoxes;
            let unsorted = GraphOptimisations { sort: false, ..GraphOptimisations::default() };
            vec![
                graph("graph, nothing saved", boxes, none),
                graph("graph, boxes first", boxes, GraphOptimisations { volumes: true, ..none }),
                graph("graph, boxes, skip", boxes, unsorted),
                graph("graph, boxes, skip, cached child", cached, unsorted),
                graph(
                    "graph, boxes, sort",
                    boxes,
                    GraphOptimisations { skip: false, ..GraphOptimisations::default() },
                ),
                graph("graph, boxes, skip and sort", boxes, GraphOptimisations::default()),
                graph("graph, boxes, skip, sort, cached child", cached, GraphOptimisations::default()),
                graph("graph, spheres, skip and sort", spheres, GraphOptimisations::default()),
                with("bvh, both children", &|quality| quality.accelerator = Accelerator::BvhBothChildren),
                with("bvh", &|quality| quality.accelerator = Accelerator::Bvh),
                with("bvh, last hit first", &|quality| quality.accelerator = Accelerator::CachedBvh),
                with("bvh, packets of 8", &|quality| quality.accelerator = Accelerator::PacketBvh),
                with("bvh, 8 children per node", &|quality| quality.accelerator = Accelerator::WideBvh),
            ]
        }
        Comparison::Heuristics => {
            let (all, easy) = (KdHeuristics::default(), KdHeuristics::NONE);
            let tree = |name: &str, heuristics: KdHeuristics| {
                with(name, &|quality| {
                    (quality.accelerator, quality.kd_heuristics) = (Accelerator::KdTree, heuristics);
                })
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
            let grid = |name: &str, n: u32| {
                with(name, &|quality| {
                    (quality.accelerator, quality.grid_resolution) = (Accelerator::Grid, n);
                })
            };
            let ladder = [1, 4, 8, 16, 32, 64, 128, 256].map(|n| grid(&format!("grid, {n} along"), n));
            [ladder.to_vec(), vec![grid("grid, by the formula", 0)]].concat()
        }
        Comparison::Methods => {
            let single = |name: String, change: &dyn Fn(&mut Quality)| {
                with(&name, &|quality| {
                    quality.precision = Precision::Single;
                    change(quality);
                })
            };
            let triangles = TriangleMethod::NAMES.map(|(name, method)| {
                single(format!("triangles, {name}"), &|quality| quality.triangle_method = method)
            });
            let spheres = SphereMethod::NAMES.map(|(name, method)| {
                single(format!("spheres, {name}"), &|quality| quality.sphere_method = method)
            });
            let double = with("both, double precision", &|quality| quality.precision = Precision::Double);
            [triangles.to_vec(), spheres.to_vec(), vec![double]].concat()
        }
        Comparison::Instances => vec![
            with("one mesh, many places", &|quality| quality.copies = false),
            with("copies", &|quality| quality.copies = true),
        ],
    }
}
