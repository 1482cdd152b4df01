//! Nothing to do here: the structures by which rays find primitives, built by the functions of the stages.

use crate::search::Search;
use crate::stage8_scene_graph::{bounding_ball, enter_ball};
use crate::{stage3_bvh, stage9_bsp, stage9_grid, stage9_kd_tree, stage9_octree};
use glam::{UVec3, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Node};
use raykata::graph::Graph;
use raykata::kit::StructureSize;
use raykata::partition::{Bsp, Grid, KdTree, MOST_CELLS_ALONG, Octree, corners};
use raykata::ray::Ray;
use raykata::scene::Quality;
use raykata::shape::Sphere;

/// What a search goes through.
pub enum Structure {
    /// Nothing: every primitive is asked.
    None,
    Hierarchy(Bvh),
    /// The scene graph, with a volume around each node.
    Graph {
        graph: Graph,
        volumes: Volumes,
    },
    Grid(Grid),
    Octree(Octree),
    KdTree(KdTree),
    Bsp {
        tree: Bsp,
        /// The box around all.
        around: Aabb,
    },
}

/// One a node; nothing for a node that holds nothing.
pub enum Volumes {
    Boxes(Vec<Aabb>),
    Balls(Vec<Option<Sphere>>),
}

/// Cells for each primitive, if the scene does not say how many (Wald et al., "Ray Tracing Animated Scenes Using Coherent
/// Grid Traversal", 2006, find 2 to 5 best).
const DENSITY: f32 = 4.0;

/// Deeper octants are a thousandth of a thousandth of the scene wide.
const DEEPEST_OCTANT: usize = 20;

impl Structure {
    /// Over primitives in these boxes. A part has no graph, and gets a hierarchy in its place. `hull` gives the corners of
    /// a primitive that is flat.
    pub fn new(
        bounds: &[Aabb],
        graph: Option<Graph>,
        hull: impl Fn(usize) -> Option<Vec<Vec3>>,
        search: Search,
        quality: &Quality,
    ) -> Structure {
        let leaf_size = quality.leaf_size as usize;
        match (search, graph) {
            (Search::BruteForce | Search::Painter, _) => Structure::None,
            (Search::GraphOfBoxes | Search::GraphOfBalls, Some(graph)) => {
                let boxes = boxes(&graph, bounds);
                let volumes = match search {
                    Search::GraphOfBoxes => Volumes::Boxes(boxes),
                    _ => Volumes::Balls(boxes.iter().map(ball_around).collect()),
                };
                Structure::Graph { graph, volumes }
            }
            (Search::Grid, _) => Structure::Grid(stage9_grid::build(bounds, resolution(bounds, quality))),
            (Search::Octree | Search::OctreeByCells, _) => {
                Structure::Octree(stage9_octree::build(bounds, leaf_size, DEEPEST_OCTANT))
            }
            (Search::KdTree, _) => {
                Structure::KdTree(stage9_kd_tree::build(bounds, &quality.kd_heuristics, leaf_size))
            }
            (Search::Bsp, _) => {
                let hull = |(index, bounds): (usize, &Aabb)| hull(index).unwrap_or_else(|| corners(bounds));
                let hulls: Vec<Vec<Vec3>> = bounds.iter().enumerate().map(hull).collect();
                let depth = KdTree::most_depth(hulls.len());
                Structure::Bsp { tree: stage9_bsp::build(&hulls, leaf_size, depth), around: around(bounds) }
            }
            _ => Structure::Hierarchy(stage3_bvh::build(bounds, quality.split, leaf_size)),
        }
    }

    /// The nodes of a hierarchy.
    pub fn nodes(&self) -> &[Node] {
        match self {
            Structure::Hierarchy(bvh) => &bvh.nodes,
            _ => &[],
        }
    }

    /// How large it is, if there is anything.
    pub fn size(&self) -> Option<StructureSize> {
        fn bytes<T>(list: &[T]) -> usize {
            std::mem::size_of_val(list)
        }
        fn tree<Node>(nodes: &[Node], levels: usize, items: &[u32]) -> (usize, usize, usize, usize) {
            (nodes.len(), levels, items.len(), bytes(nodes) + bytes(items))
        }
        let (nodes, levels, references, bytes) = match self {
            Structure::None => return None,
            Structure::Hierarchy(bvh) => tree(&bvh.nodes, bvh.depth(), &bvh.order),
            Structure::Graph { graph, volumes } => {
                let lists: usize =
                    graph.nodes.iter().map(|n| bytes(&n.children) + bytes(&n.primitives)).sum();
                let volumes = match volumes {
                    Volumes::Boxes(boxes) => bytes(boxes),
                    Volumes::Balls(balls) => bytes(balls),
                };
                let references = graph.nodes.iter().map(|node| node.primitives.len()).sum();
                (graph.nodes.len(), graph.depth(), references, bytes(&graph.nodes) + lists + volumes)
            }
            Structure::Grid(grid) => {
                (grid.n_nodes(), grid.depth(), grid.items.len(), bytes(&grid.starts) + bytes(&grid.items))
            }
            Structure::Octree(octree) => tree(&octree.nodes, octree.depth(), &octree.items),
            Structure::KdTree(kd_tree) => tree(&kd_tree.nodes, kd_tree.depth(), &kd_tree.items),
            Structure::Bsp { tree: bsp, .. } => tree(&bsp.nodes, bsp.depth(), &bsp.items),
        };
        let [nodes, levels, references, bytes] = [nodes, levels, references, bytes].map(|n| n as u64);
        Some(StructureSize { nodes, levels, references, bytes })
    }
}

impl Volumes {
    /// Where a ray enters the volume around a node.
    pub fn enter(&self, node: u32, ray: &Ray, inverse_dir: Vec3) -> Option<f32> {
        match self {
            Volumes::Boxes(boxes) => {
                stage3_bvh::slab(ray, inverse_dir, &boxes[node as usize]).map(|(enter, _)| enter)
            }
            Volumes::Balls(balls) => enter_ball(ray, balls[node as usize].as_ref()?),
        }
    }
}

/// As many cells along the longest side as the scene says, and cubes; or what the formula gives.
fn resolution(bounds: &[Aabb], quality: &Quality) -> UVec3 {
    let around = around(bounds);
    let longest = (around.max - around.min).max_element();
    match quality.grid_resolution {
        0 => stage9_grid::resolution(&around, bounds.len(), DENSITY),
        n if longest > 0.0 && longest.is_finite() => {
            let cells = n as f32 * ((around.max - around.min) / longest);
            cells.ceil().as_uvec3().clamp(UVec3::ONE, UVec3::splat(MOST_CELLS_ALONG))
        }
        _ => UVec3::ONE,
    }
}

/// The box around all boxes that are any.
fn around(bounds: &[Aabb]) -> Aabb {
    let boxes = bounds.iter().filter(|one| !one.is_empty());
    boxes.fold(Aabb::EMPTY, |all, one| Aabb::new(all.min.min(one.min), all.max.max(one.max)))
}

/// A box around each node of a graph and all below it.
fn boxes(graph: &Graph, bounds: &[Aabb]) -> Vec<Aabb> {
    let mut boxes = vec![Aabb::EMPTY; graph.nodes.len()];
    // Children have higher numbers than their parents.
    for (index, node) in graph.nodes.iter().enumerate().rev() {
        let own = node.primitives.iter().map(|&primitive| bounds[primitive as usize]);
        let below = node.children.iter().map(|&child| boxes[child as usize]);
        boxes[index] = own.chain(below).fold(Aabb::EMPTY, |all, one| stage3_bvh::union(&all, &one));
    }
    boxes
}

fn ball_around(bounds: &Aabb) -> Option<Sphere> {
    (!bounds.is_empty()).then(|| bounding_ball(&corners(bounds)))
}
