//! Nothing to do here: the structures by which rays find primitives, built by the functions of the stages.

use crate::plan::Search;
use crate::stage3_bvh;
use crate::stage8_scene_graph::{bounding_ball, enter_ball};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Node};
use raykata::graph::Graph;
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
}

/// One a node; nothing for a node that holds nothing.
pub enum Volumes {
    Boxes(Vec<Aabb>),
    Balls(Vec<Option<Sphere>>),
}

impl Structure {
    /// Over primitives in these boxes. A part is no graph, and gets a hierarchy in its place.
    pub fn new(bounds: &[Aabb], graph: Option<&Graph>, search: Search, quality: &Quality) -> Structure {
        match (search, graph) {
            (Search::BruteForce | Search::Painter, _) => Structure::None,
            (Search::GraphOfBoxes, Some(graph)) => {
                Structure::Graph { graph: graph.clone(), volumes: Volumes::Boxes(boxes(graph, bounds)) }
            }
            (Search::GraphOfBalls, Some(graph)) => {
                let balls = boxes(graph, bounds).iter().map(ball_around).collect();
                Structure::Graph { graph: graph.clone(), volumes: Volumes::Balls(balls) }
            }
            _ => Structure::Hierarchy(stage3_bvh::build(bounds, quality.split, quality.leaf_size as usize)),
        }
    }

    /// The nodes of a hierarchy.
    pub fn nodes(&self) -> &[Node] {
        match self {
            Structure::Hierarchy(bvh) => &bvh.nodes,
            _ => &[],
        }
    }

    /// How many nodes and levels there are, if there are any.
    pub fn size(&self) -> Option<(u64, u64)> {
        match self {
            Structure::None => None,
            Structure::Hierarchy(bvh) => Some((bvh.nodes.len() as u64, bvh.depth() as u64)),
            Structure::Graph { graph, .. } => Some((graph.nodes.len() as u64, graph.depth() as u64)),
        }
    }

    /// Where a ray enters the volume around a node of the graph.
    #[inline(never)]
    pub fn enter_volume(&self, node: u32, ray: &Ray, inverse_dir: Vec3) -> Option<f32> {
        match self {
            Structure::Graph { volumes: Volumes::Boxes(boxes), .. } => {
                stage3_bvh::slab(ray, inverse_dir, &boxes[node as usize]).map(|(enter, _)| enter)
            }
            Structure::Graph { volumes: Volumes::Balls(balls), .. } => {
                enter_ball(ray, balls[node as usize].as_ref()?)
            }
            Structure::None | Structure::Hierarchy(_) => None,
        }
    }
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
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    (!bounds.is_empty()).then(|| bounding_ball(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner)))
}
