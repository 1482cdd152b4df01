//! Indexed triangle meshes: one table of vertices, one of triangles (lecture "Compact Representation").

use crate::aabb::{Aabb, bounds_of_points};
use crate::message;
use glam::{DVec3, Vec2, Vec3};
use std::sync::Arc;

/// A triangle mesh. Triangles refer to their vertices by index, so a vertex is stored once however many
/// triangles share it. Texture coordinates and normals are optional; [`Mesh::validate`] says which tables fit
/// together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The position of each vertex, in units of the mesh's own space.
    pub positions: Vec<Vec3>,
    /// One unit normal per vertex, or empty if the file has none.
    pub normals: Vec<Vec3>,
    /// One texture coordinate per vertex, or empty if the file has none.
    pub uvs: Vec<Vec2>,
    /// Three vertex indices per triangle, anticlockwise as seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// One index in [`Mesh::material_names`] per triangle, or empty if the whole mesh has one material.
    pub face_materials: Vec<u32>,
    /// The names of the materials that the file gives to its faces, in order of first use.
    pub material_names: Vec<String>,
}

message! { Mesh { positions, normals, uvs, triangles, face_materials, material_names } }

impl Mesh {
    /// The positions of the three corners of triangle `index`.
    ///
    /// # Panics
    ///
    /// If there is no triangle `index`, or one of its vertex indices is out of range.
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|vertex| self.positions[vertex as usize])
    }

    /// Checks that the tables fit together. Normals and texture coordinates may have any value.
    ///
    /// # Errors
    ///
    /// A sentence that names the first fault: no triangles; normals or texture coordinates whose number is
    /// neither 0 nor that of the vertices; face materials whose number is neither 0 nor that of the
    /// triangles; a position that is not finite; a triangle with a vertex index out of range; a face material
    /// without a name.
    pub fn validate(&self) -> Result<(), String> {
        let vertices = self.positions.len();
        if self.triangles.is_empty() {
            return Err("the mesh has no triangles".into());
        }
        for (name, length) in [("normals", self.normals.len()), ("texture coordinates", self.uvs.len())] {
            if length != 0 && length != vertices {
                return Err(format!("{length} {name} for {vertices} vertices"));
            }
        }
        if !self.face_materials.is_empty() && self.face_materials.len() != self.triangles.len() {
            return Err(format!(
                "{} face materials for {} triangles",
                self.face_materials.len(),
                self.triangles.len()
            ));
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(format!("vertex {vertex} is at {}, which is not finite", self.positions[vertex]));
        }
        if let Some(face) = self.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
            return Err(format!(
                "triangle {face} names vertices {:?}, but there are only {vertices}",
                self.triangles[face]
            ));
        }
        if let Some(face) = self.face_materials.iter().position(|&m| m as usize >= self.material_names.len())
        {
            return Err(format!("triangle {face} names a material that the mesh does not have"));
        }
        Ok(())
    }

    /// The smallest box around all vertices, in the mesh's own space; empty for a mesh without vertices.
    pub fn bounds(&self) -> Aabb {
        bounds_of_points(&self.positions)
    }
}

/// A mesh of the scene: what its file says beyond the tables of a [`Mesh`], and the settings that the scene gives for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneMesh {
    /// Positions, triangles and optional normals, texture coordinates and face materials, in the space of the
    /// mesh, relative to [`SceneMesh::origin`]. Empty if nothing shows the mesh.
    pub mesh: Arc<Mesh>,
    /// The point of the space of the mesh from which its positions are counted. It is not 0 only for a mesh that is far
    /// away for its size, such as one in map coordinates: a position there would lose its last digits in single precision.
    pub origin: Vec3,
    /// For each vertex the number of its position, below the number of vertices; empty if each vertex has its own. A file
    /// has several vertices at a position where texture coordinates or normals differ (a seam); they are one vertex of the shape.
    pub places: Vec<u32>,
    /// For each triangle its smoothing group: averaged normals are shared only within a group, and 0 stands for flat.
    /// Empty if all triangles are in one group.
    pub groups: Vec<u32>,
    /// Whether shading normals are interpolated over each triangle; otherwise the normal of the triangle is
    /// used.
    pub smooth: bool,
    /// Whether only the front of each triangle is hit, the side from which its corners run anticlockwise. Rays
    /// pass through its back, shadow rays as well.
    pub one_sided: bool,
    /// Number of Loop subdivision steps before anything is traced (stage 8), 0 to 12 in a scene file. Each
    /// step divides every triangle into four.
    pub subdivisions: u32,
    /// For each of the mesh's own material names, an index into [`Scene::materials`](crate::scene::Scene::materials). Empty if all triangles
    /// take the material of the node that shows the mesh.
    pub materials: Vec<usize>,
}

message! { SceneMesh { mesh, origin, places, groups, smooth, one_sided, subdivisions, materials } }

impl SceneMesh {
    /// A mesh with `positions` in double precision, one per vertex, which replace those of `mesh`; `places` is as in
    /// [`SceneMesh::places`]. Normals that are zero are mended: at such a corner the face has its own normal. If all
    /// are zero, the mesh has none.
    ///
    /// The positions are counted from the middle of the mesh if that is farther away than 16 times its size, because then
    /// 4 of the 24 bits of a coordinate would be lost. A position that no triangle names counts as the first one that is
    /// named, so that its value does not matter.
    pub fn new(mut mesh: Mesh, mut positions: Vec<DVec3>, mut places: Vec<u32>) -> SceneMesh {
        if mesh.normals.iter().all(|normal| *normal == Vec3::ZERO) {
            mesh.normals.clear();
        }
        mend_normals(&mut mesh, &mut positions, &mut places);
        if places.iter().enumerate().all(|(vertex, &place)| vertex == place as usize) {
            places.clear();
        }

        let mut used = vec![false; positions.len()];
        mesh.triangles.as_flattened().iter().for_each(|&vertex| used[vertex as usize] = true);
        let first = used.iter().position(|&used| used).unwrap_or(0);
        let at = |vertex: usize| positions[if used[vertex] { vertex } else { first }];
        let [mut low, mut high] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for vertex in 0..positions.len() {
            (low, high) = (low.min(at(vertex)), high.max(at(vertex)));
        }
        let (middle, size) = (0.5 * (low + high), 0.5 * (high - low).max_element());
        // Take a multiple of a power of two, so that the origin and its sums with translations are exact in single precision.
        let distance = middle.abs().max_element();
        let unit = size.max(distance / f64::from(1 << 20)).log2().ceil().exp2();
        let is_far = distance > 16.0 * size && unit.is_normal();
        let origin = if is_far { (middle / unit).round() * unit } else { DVec3::ZERO };
        mesh.positions = (0..positions.len()).map(|vertex| (at(vertex) - origin).as_vec3()).collect();
        let mesh = Arc::new(mesh);
        SceneMesh { mesh, origin: origin.as_vec3(), places, smooth: true, ..SceneMesh::default() }
    }
}

/// Gives each corner with a normal of zero the normal of its face. The first face of a vertex sets the normal of the vertex,
/// and each other one gets a vertex of its own at the same place.
fn mend_normals(mesh: &mut Mesh, positions: &mut Vec<DVec3>, places: &mut Vec<u32>) {
    let is_zero: Vec<bool> = mesh.normals.iter().map(|normal| *normal == Vec3::ZERO).collect();
    if !is_zero.contains(&true) {
        return;
    }
    if places.is_empty() {
        *places = (0..positions.len() as u32).collect();
    }
    for triangle in &mut mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
        // A face without an area is not seen, and has any normal.
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z).as_vec3();
        for corner in triangle {
            let vertex = *corner as usize;
            if !is_zero[vertex] {
                continue;
            }
            if mesh.normals[vertex] == Vec3::ZERO {
                mesh.normals[vertex] = normal;
            } else if mesh.normals[vertex] != normal {
                *corner = positions.len() as u32;
                positions.push(positions[vertex]);
                places.push(places[vertex]);
                mesh.normals.push(normal);
                if let Some(&uv) = mesh.uvs.get(vertex) {
                    mesh.uvs.push(uv);
                }
            }
        }
    }
    // No triangle names the vertices that are left.
    mesh.normals.iter_mut().filter(|normal| **normal == Vec3::ZERO).for_each(|normal| *normal = Vec3::Z);
}
