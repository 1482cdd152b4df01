//! Indexed triangle meshes: one table of vertices, one of triangles (lecture "Compact Representation").

use crate::aabb::{Aabb, bounds_of_points};
use crate::message;
use glam::{Vec2, Vec3};
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

/// A mesh of the scene, with the settings that the scene file gives for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneMesh {
    /// Positions, triangles and optional normals, texture coordinates and face materials, in the space of the
    /// mesh. Empty if nothing shows the mesh.
    pub mesh: Arc<Mesh>,
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

message! { SceneMesh { mesh, smooth, one_sided, subdivisions, materials } }
