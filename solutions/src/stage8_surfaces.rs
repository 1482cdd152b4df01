//! Stage 8 · curved surfaces: surfaces without a simple formula for ray hits are approximated by
//! triangles.
//!
//! Slides: `slides/stage08.md`. Sources: Loop, "Smooth Subdivision Surfaces Based on Triangles",
//! 1987; Hoppe et al. 1994 for its borders.

use glam::{Vec2, Vec3};
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;
use std::collections::HashMap;

/// A point of a bicubic Bézier patch by de Casteljau's algorithm, which is repeated linear
/// interpolation. `u` runs along the rows and `v` along the columns, both in `0..=1`. Is
/// `p + t (q - p)` exactly `q` at t = 1?
///
/// For `u` and `v` of 0 or 1 the result is exactly the corner of the net: (0, 0) gives
/// `rows[0][0]`, (1, 0) `rows[0][3]` and (0, 1) `rows[3][0]`.
pub fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3 {
    // <solution>
    let across = patch.rows.map(|row| on_curve(row, uv.x));
    on_curve(across, uv.y)
    // <stub> todo!("interpolate three times along each row with u, then the four results with v")
    // </solution>
}

// <solution>
/// A point of a cubic Bézier curve.
fn on_curve([p0, p1, p2, p3]: [Vec3; 4], t: f32) -> Vec3 {
    // Use both factors instead of p + t (q - p), because the result is then exactly q at t = 1.
    let blend = |p: Vec3, q: Vec3| (1.0 - t) * p + t * q;
    let (q0, q1, q2) = (blend(p0, p1), blend(p1, p2), blend(p2, p3));
    blend(blend(q0, q1), blend(q1, q2))
}
// </solution>

/// Each triangle becomes four, and vertices move towards their neighbours. What happens at a
/// border? An edge has at most two triangles, a vertex at most two borders.
///
/// Exactly:
///
/// 1. An edge `p q` with third corners `r` and `s` gets the vertex `3/8 (p+q) + 1/8 (r+s)`, a
///    border edge `1/2 (p+q)`.
/// 2. An old vertex `p` with `n` neighbours `pᵢ` moves to `(1 - nβ) p + β Σ pᵢ`. β is `3/16` for
///    `n = 3`, else `3/(8n)` (Warren), or Loop's `(5/8 - (3/8 + cos(2π/n)/4)²)/n`.
/// 3. On a border it moves to `3/4 p + 1/8 (p₁+p₂)` (neighbours on it). A vertex of no
///    triangle stays.
/// 4. All formulas use the old positions.
/// 5. Old vertices keep their numbers; new ones follow, one per edge, in any order.
/// 6. Triangles, in any order, keep the old order of corners and material.
/// 7. Old texture coordinates stay; a new vertex has the mean of its edge's ends. Without
///    them, or without materials, the result has none. It has no normals.
///
/// Source: Loop 1987; Warren 1995; Hoppe 1994.
pub fn loop_subdivide(mesh: &Mesh) -> Mesh {
    // <solution>
    // Place a new vertex on each edge.
    let edges = Edges::of(mesh);
    let position = |vertex: u32| mesh.positions[vertex as usize];
    let on_edge = |edge: &Edge| {
        let ends = position(edge.ends[0]) + position(edge.ends[1]);
        match edge.opposite[..] {
            [r, s] => 0.375 * ends + 0.125 * (position(r) + position(s)),
            _ => 0.5 * ends,
        }
    };
    // Move the old vertices, and append the new ones.
    let mut positions = moved_vertices(mesh, &edges);
    positions.extend(edges.list.iter().map(on_edge));

    // Average the texture coordinates of the ends of each edge.
    let mut uvs = mesh.uvs.clone();
    if !uvs.is_empty() {
        uvs.extend(edges.list.iter().map(|edge| {
            let [p, q] = edge.ends.map(|end| mesh.uvs[end as usize]);
            0.5 * (p + q)
        }));
    }
    // Replace each triangle by four.
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
    // <stub> todo!("find the edges, place a vertex on each, move the old vertices, make four triangles of each")
    // </solution>
}

// <solution>
/// An edge of a mesh.
struct Edge {
    ends: [u32; 2],
    /// The third corners of the triangles at this edge.
    opposite: Vec<u32>,
}

/// The edges of a mesh, in the order in which its triangles first name them.
struct Edges {
    list: Vec<Edge>,
    /// The index of each edge in `list`, by its ends, the smaller first.
    numbers: HashMap<(u32, u32), u32>,
}

impl Edges {
    /// Finds the edges of all triangles.
    fn of(mesh: &Mesh) -> Edges {
        let mut edges = Edges { list: Vec::new(), numbers: HashMap::new() };
        for &[a, b, c] in &mesh.triangles {
            // Add each edge of the triangle that is new, and store the third corner.
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

/// The new positions of the old vertices.
fn moved_vertices(mesh: &Mesh, edges: &Edges) -> Vec<Vec3> {
    let n = mesh.positions.len();
    // Collect the one-ring of each vertex, and the neighbours along a border.
    let (mut one_rings, mut border_rings) = (vec![Ring::default(); n], vec![Ring::default(); n]);
    for edge in &edges.list {
        let [p, q] = edge.ends;
        for (vertex, neighbour) in [(p, q), (q, p)] {
            let position = mesh.positions[neighbour as usize];
            one_rings[vertex as usize].add(position);
            if edge.opposite.len() != 2 {
                border_rings[vertex as usize].add(position);
            }
        }
    }
    // Apply the rule for a vertex of no triangle, for an inner vertex, or for a vertex on a border.
    let moved = |vertex: usize| {
        let (old, one_ring, border) = (mesh.positions[vertex], one_rings[vertex], border_rings[vertex]);
        match border.valence {
            _ if one_ring.valence == 0 => old,
            0 => {
                let n = one_ring.valence as f32;
                let beta = if one_ring.valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * n) };
                (1.0 - n * beta) * old + beta * one_ring.sum
            }
            2 => 0.75 * old + 0.125 * border.sum,
            // Several borders meet at this vertex, so it stays.
            _ => old,
        }
    };
    (0..n).map(moved).collect()
}

/// Some neighbours of a vertex.
#[derive(Clone, Copy, Default)]
struct Ring {
    /// How many there are.
    valence: u32,
    /// The sum of their positions.
    sum: Vec3,
}

impl Ring {
    fn add(&mut self, position: Vec3) {
        self.valence += 1;
        self.sum += position;
    }
}
// </solution>
