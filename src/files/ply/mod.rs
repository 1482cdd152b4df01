//! Reads PLY files (lectures "PLY Files" and "Additional Data").
//!
//! A PLY file describes itself: its header says which elements follow, how many of each, and which properties
//! make one element. So a reader can skip `fooness` and `barness` without knowing what they mean.
//!
//! ```text
//! ply
//! format ascii 1.0
//! element vertex 3
//! property float x
//! property float y
//! property float z
//! property float fooness
//! element face 1
//! property list uchar int vertex_indices
//! end_header
//! 0 0 0 0.1
//! 1 0 0 0.2
//! 0 1 0 0.3
//! 3 0 1 2
//! ```
//!
//! Only numbers follow `end_header`. `header` reads the lines down to there, `body` reads the numbers one by
//! one, and `tables` puts them into a [`Mesh`].

mod body;
mod header;
mod scalar;
mod tables;
#[cfg(test)]
mod tests;
pub(crate) mod text;

use crate::files::error::LoadError;
use crate::mesh::Mesh;
use body::Body;
use glam::{Vec2, Vec3};
use std::path::Path;
use tables::Layout;

/// The content of a PLY file.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyFile {
    /// The vertices and faces of the file.
    pub mesh: Mesh,
    /// What was guessed, with file, line and column.
    pub warnings: Vec<LoadError>,
}

/// Reads the mesh of the PLY file `file`, as [`parse`] does with its bytes.
///
/// # Errors
///
/// If `file` cannot be read, and in all cases in which [`parse`] fails.
pub fn read(file: &Path) -> Result<PlyFile, LoadError> {
    parse(file, &text::read_bytes(file)?)
}

/// Reads the mesh from the bytes of a PLY file, ASCII or binary of either byte order; `file` is its name in
/// messages.
///
/// Positions are finite. Concave faces are cut into triangles that cover them; convex faces become fans around their
/// first corner. A face whose outline crosses itself adds a warning. Normals are scaled to unit length, and dropped all together if one of them has no direction.
/// Texture coordinates are dropped all together if one of them is not finite.
///
/// # Errors
///
/// If the header is malformed or declares no vertices or no faces, if a number or the length of a list is
/// malformed, if the file ends early, if an ASCII file goes on after its last element, if a face has fewer
/// than three corners or names a vertex that does not exist, if a position is not finite, or if there are no
/// triangles. An error at a place in an ASCII file names its line and column.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<PlyFile, LoadError> {
    let header = header::read(file, bytes)?;
    let layout = Layout::of(file, bytes, &header)?;

    // Elements come in the order of the header, which may put faces before vertices.
    let mut body = Body::new(file, bytes, &header);
    let (mut mesh, mut polygons) = (Mesh::default(), Vec::new());
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => layout.vertices(&mut body, element, &mut mesh)?,
            "face" => layout.faces(&mut body, element, &mut mesh, &mut polygons)?,
            _ => body.skip_element(element)?,
        }
    }
    body.finish()?;
    let warnings = tables::cut_polygons(file, bytes, &header, &mut mesh, &polygons);

    mesh.normals = unit_normals(mesh.normals);
    mesh.uvs = finite_uvs(mesh.uvs);
    mesh.validate().map_err(|message| {
        LoadError::new(file, message).help(if mesh.triangles.is_empty() {
            "export the mesh with faces: without faces there is nothing to render"
        } else {
            "export the mesh again: each x, y and z has to be a number below 3e38"
        })
    })?;
    Ok(PlyFile { mesh, warnings })
}

/// The normals scaled to unit length, or none at all if one of them has no direction (zero, infinite or NaN).
///
/// Some writers leave zeros for vertices whose normal they do not know. A mesh has a normal for each vertex
/// or for none, and an invented one would be visible as a dark spot. Without the table, normals are computed
/// from the triangles, which is correct everywhere.
pub(crate) fn unit_normals(normals: Vec<Vec3>) -> Vec<Vec3> {
    normals.into_iter().map(Vec3::try_normalize).collect::<Option<_>>().unwrap_or_default()
}

/// The texture coordinates, or none at all if one of them is not finite.
fn finite_uvs(uvs: Vec<Vec2>) -> Vec<Vec2> {
    if uvs.iter().all(|uv| uv.is_finite()) { uvs } else { Vec::new() }
}
