//! The boxes and cells of a structure as line segments that can be drawn.

use super::structure::{Structure, Volumes};
use crate::aabb::Aabb;
use crate::bvh::{Bvh, Contents};
use crate::graph::Graph;
use crate::partition;
use crate::shape::Sphere;
use glam::{DVec3, Vec3};
use std::f32::consts::TAU;

/// Line segments in world space for the boxes, spheres or cells of `structure` at depth `depth`, and for the
/// leaves above it. The root is at depth 0; a grid has one level.
///
/// Of a BSP tree, the segments are the edges of the polygons in which its planes above this depth cut each
/// other. Brute force has no segments.
pub fn outlines(structure: &Structure, depth: usize) -> Vec<[Vec3; 2]> {
    let edges =
        |boxes: Vec<Aabb>| boxes.iter().filter(|one| !one.is_empty()).flat_map(partition::edges).collect();
    match structure {
        Structure::List | Structure::Painter => Vec::new(),
        Structure::Wide(wide) => edges(wide.boxes_at(depth)),
        Structure::Hierarchy(bvh) | Structure::BothChildren(bvh) => edges(boxes_at(bvh, depth)),
        Structure::Graph { graph, volumes: Volumes::Boxes(boxes) } => {
            edges(nodes_at(graph, depth).into_iter().map(|node| boxes[node as usize]).collect())
        }
        Structure::Graph { graph, volumes: Volumes::Spheres(spheres) } => {
            let spheres = nodes_at(graph, depth).into_iter().filter_map(|node| spheres[node as usize]);
            spheres.flat_map(|sphere| circles(&sphere)).collect()
        }
        Structure::Grid(grid) => edges(grid.cells(depth)),
        Structure::Octree { tree, .. } => edges(tree.cells(depth)),
        Structure::KdTree(tree) => edges(tree.cells(depth)),
        Structure::Bsp { tree, around } => sides_of(tree.polygons(around, depth)),
        Structure::PolygonBsp { tree, around } => sides_of(tree.polygons(around, depth)),
    }
}

/// The sides of polygons.
fn sides_of(polygons: Vec<Vec<DVec3>>) -> Vec<[Vec3; 2]> {
    let sides = |polygon: Vec<DVec3>| {
        let corners: Vec<Vec3> = polygon.iter().map(|corner| corner.as_vec3()).collect();
        (0..corners.len()).map(move |i| [corners[i], corners[(i + 1) % corners.len()]])
    };
    polygons.into_iter().flat_map(sides).collect()
}

/// Three circles on the sphere, one around each axis, of 48 segments each.
fn circles(sphere: &Sphere) -> Vec<[Vec3; 2]> {
    const CORNERS: usize = 48;
    let circle = |axis: usize| {
        let at = move |i: usize| {
            let (sin, cos) = (TAU * i as f32 / CORNERS as f32).sin_cos();
            sphere.center
                + sphere.radius * (cos * Vec3::AXES[(axis + 1) % 3] + sin * Vec3::AXES[(axis + 2) % 3])
        };
        (0..CORNERS).map(move |i| [at(i), at(i + 1)])
    };
    (0..3).flat_map(circle).collect()
}

fn boxes_at(bvh: &Bvh, depth: usize) -> Vec<Aabb> {
    let mut boxes = Vec::new();
    let mut waiting: Vec<(u32, usize)> = bvh.root().map(|root| (root, 0)).into_iter().collect();
    while let Some((node, level)) = waiting.pop() {
        let node = &bvh.nodes[node as usize];
        match node.contents {
            Contents::Inner { left, right } if level < depth => {
                waiting.extend([(left, level + 1), (right, level + 1)]);
            }
            _ => boxes.push(node.bounds),
        }
    }
    boxes
}

fn nodes_at(graph: &Graph, depth: usize) -> Vec<u32> {
    let mut nodes = Vec::new();
    let mut waiting: Vec<(u32, usize)> = if graph.nodes.is_empty() { Vec::new() } else { vec![(0, 0)] };
    while let Some((node, level)) = waiting.pop() {
        let children = &graph.nodes[node as usize].children;
        if level == depth || children.is_empty() {
            nodes.push(node);
        } else {
            waiting.extend(children.iter().map(|&child| (child, level + 1)));
        }
    }
    nodes
}
