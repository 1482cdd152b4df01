//! Stage 8 · curved surfaces: what no formula intersects is made of triangles first.
//!
//! Slides: "Ray-tracing other primitives" (surfaces by subdivision); Loop, "Smooth Subdivision Surfaces Based on
//! Triangles", 1987; Hoppe et al. 1994 for its borders.

use glam::{Vec2, Vec3};
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;
use std::collections::HashMap;

/// The point of a bicubic Bézier patch at `u` along its rows and `v` along its columns, both `0..=1`, by de Casteljau's
/// repeated blending. At the corners it is the corner of the control net, to the last bit.
pub fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3 {
    // <solution>
    let across = patch.rows.map(|row| on_curve(row, uv.x));
    on_curve(across, uv.y)
    // <stub> todo!("blend neighbours three times along each row, then the four results along the column")
    // </solution>
}

// <solution>
fn on_curve([p0, p1, p2, p3]: [Vec3; 4], t: f32) -> Vec3 {
    // Both factors, and not p + t (q - p): at t = 1 this is q exactly.
    let blend = |p: Vec3, q: Vec3| (1.0 - t) * p + t * q;
    let (q0, q1, q2) = (blend(p0, p1), blend(p1, p2), blend(p2, p3));
    blend(blend(q0, q1), blend(q1, q2))
}
// </solution>

/// One step of Loop's subdivision: every triangle becomes four. The vertices of `mesh` keep their numbers and move; behind
/// them comes one new vertex for each edge.
///
/// - New vertex of an edge `p q` between triangles with the third corners `r` and `s`: `3/8 (p + q) + 1/8 (r + s)`; of an
///   edge with a triangle on one side only: its middle.
/// - Old vertex with `n` neighbours `pᵢ`: `(1 - n β) p + β Σ pᵢ` with `β = 3/16` for `n = 3` and `3 / 8n` otherwise; on a
///   border, with the neighbours `p₁`, `p₂` along it: `3/4 p + 1/8 (p₁ + p₂)`. A vertex that belongs to no triangle stays.
///
/// Texture coordinates of new vertices are the mean of their edge's ends; materials of faces are passed on; normals are
/// dropped, because the surface is another one.
pub fn loop_subdivide(mesh: &Mesh) -> Mesh {
    // <solution>
    let edges = Edges::of(mesh);
    let position = |vertex: u32| mesh.positions[vertex as usize];
    let on_edge = |edge: &Edge| {
        let ends = position(edge.ends[0]) + position(edge.ends[1]);
        match edge.opposite[..] {
            [r, s] => 0.375 * ends + 0.125 * (position(r) + position(s)),
            _ => 0.5 * ends,
        }
    };
    let mut positions = moved_vertices(mesh, &edges);
    positions.extend(edges.list.iter().map(on_edge));

    let mut uvs = mesh.uvs.clone();
    if !uvs.is_empty() {
        uvs.extend(edges.list.iter().map(|edge| {
            let [p, q] = edge.ends.map(|end| mesh.uvs[end as usize]);
            0.5 * (p + q)
        }));
    }
    let n_old = mesh.positions.len() as u32;
    let middle = |p: u32, q: u32| n_old + edges.numbers[&(p.min(q), p.max(q))];
    let quarters = |&[a, b, c]: &[u32; 3]| {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    Mesh {
        positions,
        uvs,
        normals: Vec::new(),
        triangles: mesh.triangles.iter().flat_map(quarters).collect(),
        face_materials: mesh.face_materials.iter().flat_map(|&material| [material; 4]).collect(),
        material_names: mesh.material_names.clone(),
    }
    // <stub> todo!("find the edges, place a vertex on each, move the old ones, make four triangles of each")
    // </solution>
}

// <solution>
struct Edge {
    ends: [u32; 2],
    /// The third corners of the triangles at this edge.
    opposite: Vec<u32>,
}

/// The edges of a mesh, in the order in which its triangles name them.
struct Edges {
    list: Vec<Edge>,
    /// By ends, the smaller first.
    numbers: HashMap<(u32, u32), u32>,
}

impl Edges {
    fn of(mesh: &Mesh) -> Edges {
        let mut edges = Edges { list: Vec::new(), numbers: HashMap::new() };
        for &[a, b, c] in &mesh.triangles {
            for (p, q, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
                let next = edges.list.len() as u32;
                let number = *edges.numbers.entry((p.min(q), p.max(q))).or_insert(next);
                if number == next {
                    edges.list.push(Edge { ends: [p, q], opposite: Vec::new() });
                }
                edges.list[number as usize].opposite.push(opposite);
            }
        }
        edges
    }
}

fn moved_vertices(mesh: &Mesh, edges: &Edges) -> Vec<Vec3> {
    let n = mesh.positions.len();
    // For each vertex how many neighbours it has and their sum: all of them, and those along a border.
    let (mut around, mut along) = (vec![(0u32, Vec3::ZERO); n], vec![(0u32, Vec3::ZERO); n]);
    for edge in &edges.list {
        let [p, q] = edge.ends;
        for (vertex, neighbour) in [(p, q), (q, p)] {
            let place = mesh.positions[neighbour as usize];
            let add = |sums: &mut Vec<(u32, Vec3)>| {
                let (count, sum) = &mut sums[vertex as usize];
                (*count, *sum) = (*count + 1, *sum + place);
            };
            add(&mut around);
            if edge.opposite.len() != 2 {
                add(&mut along);
            }
        }
    }
    let moved = |vertex: usize| {
        let (old, (count, sum)) = (mesh.positions[vertex], around[vertex]);
        match along[vertex] {
            _ if count == 0 => old,
            (0, _) => {
                let beta = if count == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * count as f32) };
                (1.0 - count as f32 * beta) * old + beta * sum
            }
            (2, ends) => 0.75 * old + 0.125 * ends,
            // Two borders meet here: no curve goes through.
            _ => old,
        }
    };
    (0..n).map(moved).collect()
}
// </solution>
