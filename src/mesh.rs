//! Indexed triangle meshes: one table of vertices, one of triangles (lecture "Compact Representation").

use crate::aabb::Aabb;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// A triangle mesh. Triangles name their vertices by index, so a vertex is stored once however many triangles
/// share it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// One unit normal a vertex, or nothing when the file has none.
    pub normals: Vec<Vec3>,
    /// One texture coordinate a vertex, or nothing when the file has none.
    pub uvs: Vec<Vec2>,
    /// Three indices into the vertex tables a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// One index into [`Mesh::material_names`] a triangle, or nothing when the mesh has one material.
    pub face_materials: Vec<u32>,
    /// The materials that the file names for its faces, in order of first use.
    pub material_names: Vec<String>,
}

impl Mesh {
    /// The three corners of triangle `index`.
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|vertex| self.positions[vertex as usize])
    }

    /// Says what is wrong with the tables, if anything: lengths that differ, indices out of range, numbers that
    /// are not finite, no triangle at all.
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
            return Err(format!("vertex {vertex} is at {}, which is no place", self.positions[vertex]));
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

    /// The smallest box around all vertices; empty for a mesh without vertices.
    pub fn bounds(&self) -> Aabb {
        crate::shape::bounds_of_points(&self.positions)
    }
}
