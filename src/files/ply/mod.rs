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
//! one, and `tables` puts them into a [`Mesh`](crate::mesh::Mesh).

mod body;
mod header;
mod scalar;
mod tables;
#[cfg(test)]
mod tests;
pub(crate) mod text;

use crate::files::error::{LoadError, Warnings};
use crate::mesh::SceneMesh;
use body::Body;
use std::path::Path;
use tables::{Layout, Tables};

/// The content of a PLY file.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyFile {
    /// The vertices and faces of the file.
    pub mesh: SceneMesh,
    /// What was ignored or guessed, once for each kind, with file, line and column.
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
/// first corner. Normals are scaled to unit length; where one has no direction, faces have their own normal. Texture
/// coordinates that are not finite are replaced by (0.5, 0.5). Each such repair adds a warning, and so do faces that are left
/// out because they have fewer than three corners or name a vertex that does not exist or is not at a finite position.
///
/// A vertex of this format has one normal and one pair of texture coordinates, so a file that has them repeats vertices
/// where they differ: then vertices at the same position are one vertex of the shape.
///
/// # Errors
///
/// If the header is malformed or declares no vertices or no faces, if a number or the length of a list is
/// malformed, if the file ends early, if an ASCII file goes on after its last element, or if there are no
/// triangles. An error at a place in an ASCII file names its line and column.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<PlyFile, LoadError> {
    let mut warnings = Warnings::default();
    let header = header::read(file, bytes, &mut warnings)?;
    let layout = Layout::of(file, bytes, &header, &mut warnings)?;

    // Elements come in the order of the header, which may put faces before vertices.
    let mut body = Body::new(file, bytes, &header);
    let mut tables = Tables::default();
    tables.warnings = warnings;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => layout.vertices(&mut body, element, &mut tables)?,
            "face" => layout.faces(&mut body, element, &mut tables)?,
            _ => body.skip_element(element)?,
        }
    }
    body.finish()?;
    tables.cut_polygons(&body);
    tables.leave_out_infinite_faces();
    if tables.mesh.triangles.is_empty() {
        return Err(tables.refused.unwrap_or_else(|| {
            LoadError::new(file, "the mesh has no triangles")
                .help("export the mesh with faces: without faces there is nothing to render")
        }));
    }
    let places = tables.places();
    let mesh = SceneMesh::new(tables.mesh, tables.positions, places);
    mesh.mesh.validate().map_err(|message| LoadError::new(file, message).help("export the mesh again"))?;
    Ok(PlyFile { mesh, warnings: tables.warnings.list() })
}
