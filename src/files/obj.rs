//! Reads Wavefront OBJ files and the material libraries that they name, with the crate `tobj`.
//!
//! ```text
//! mtllib box.mtl
//! v 0 0 0
//! v 1 0 0
//! v 0 1 0
//! vt 0 0
//! vn 0 0 1
//! usemtl red
//! f 1/1/1 2/1/1 3/1/1
//! ```
//!
//! A corner of a face has up to three indices, counted from 1: into the positions `v`, the texture
//! coordinates `vt` and the normals `vn`. Our [`Mesh`] has one index per corner, so each combination that
//! occurs becomes a vertex of its own, and [`SceneMesh::places`] says which of them share a position. `lines` reads the file
//! line by line, reports every error with its place, and cuts faces into triangles; `library` reads the materials.

mod library;
mod lines;
#[cfg(test)]
mod tests;

use crate::files::error::{LoadError, Warnings};
use crate::files::ply::text::{LOOKS_LIKE_OBJ, guess, read_bytes, readable};
use crate::files::words::quoted;
use crate::mesh::{Mesh, SceneMesh};
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The content of an OBJ file and of its material libraries.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjFile {
    /// All objects and groups of the file as one mesh, because all triangles become one set of primitives in
    /// the end. [`SceneMesh::smooth`] is false if the file has no normals and asks for flat faces.
    pub mesh: SceneMesh,
    /// All materials of the libraries, used or not; of two with the same name only the last. A name in
    /// [`Mesh::material_names`] may be missing here.
    pub materials: Vec<ObjMaterial>,
    /// The names in [`Mesh::material_names`] that no library defines, each with a warning at its first `usemtl` line. The
    /// scene may still define them.
    pub undefined: Vec<(String, LoadError)>,
    /// What was ignored or replaced, with file, line and column.
    pub warnings: Vec<LoadError>,
}

/// A material of a material library (MTL file), with its numbers as they are written there. Each number is
/// finite and in the range of its meaning; `None` stands for a line that is missing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjMaterial {
    /// The name after `newmtl`; it may contain blanks.
    pub name: String,
    /// The colour after `Ka`: the share of ambient light that is reflected, in linear RGB.
    pub ambient: Option<Vec3>,
    /// The colour after `Kd`: the share of light that is reflected diffusely, in linear RGB.
    pub diffuse: Option<Vec3>,
    /// The colour after `Ks`: the strength of the highlight, in linear RGB.
    pub specular: Option<Vec3>,
    /// The number after `Ns`: the exponent of the Phong model.
    pub shininess: Option<f32>,
    /// The number after `Ni`: the index of refraction inside the material.
    pub index_of_refraction: Option<f32>,
    /// The number after `d`: the opacity, 1 for opaque and 0 for fully transparent.
    pub dissolve: Option<f32>,
    /// The image after `map_Kd`, as a path joined to the folder of the library. The file need not exist.
    pub diffuse_texture: Option<PathBuf>,
    /// The colour after `Ke`: the light that the surface emits, in linear RGB.
    pub emission: Option<Vec3>,
}

/// The material name of faces above the first `usemtl` line, if other faces have a material.
pub const DEFAULT_MATERIAL: &str = "default";

/// Reads the mesh and the materials of the OBJ file `file`, as [`parse`] does with its bytes.
///
/// # Errors
///
/// If `file` cannot be read, and in all cases in which [`parse`] fails.
pub fn read(file: &Path) -> Result<ObjFile, LoadError> {
    parse(file, &read_bytes(file)?)
}

/// Reads the OBJ file `file` as [`read`] does, but without its material libraries, which need not exist.
///
/// # Errors
///
/// As [`read`].
pub fn read_without_libraries(file: &Path) -> Result<ObjFile, LoadError> {
    parse_with(file, &read_bytes(file)?, false)
}

/// Reads the mesh and the materials from the bytes of an OBJ file; material libraries are searched for in the
/// folder of `file`, which need not exist itself.
///
/// Positions and texture coordinates are finite. Concave faces are cut into triangles that cover them; convex faces become
/// fans around their first corner. Normals are of unit length; if some corners have a normal, the others have that of their
/// face. Where only some corners have texture coordinates, those of the others are `(0.5, 0.5)`.
///
/// A warning is added for everything that is ignored, guessed or replaced, once for each kind: faces and indices that cannot be
/// used, normals without a direction, a missing library, and lines of a library.
///
/// # Errors
///
/// If a line of the file is malformed, if a face names vertex 0, or if no face is left. An error at a place in a file names its line
/// and column.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<ObjFile, LoadError> {
    parse_with(file, bytes, true)
}

fn parse_with(file: &Path, bytes: &[u8], with_libraries: bool) -> Result<ObjFile, LoadError> {
    let text = readable(bytes);
    let mut warnings = Warnings::default();
    let lines = lines::read(file, &text, &mut warnings)?;
    if lines.triangles.is_empty() {
        return Err(match guess(bytes).filter(|help| *help != LOOKS_LIKE_OBJ) {
            Some(help) if lines.positions.is_empty() => {
                LoadError::new(file, "this is not an OBJ file").help(help)
            }
            _ => LoadError::new(file, "the file has no faces").help(
                "export the mesh with faces: lines that start with `f` and name three vertices or more",
            ),
        });
    }

    let mut warnings = warnings.list();
    let mut materials: Vec<ObjMaterial> = Vec::new();
    let names = if with_libraries { &lines.libraries[..] } else { &[] };
    for library in names {
        for path in library::find(file, &text, library, &mut warnings) {
            for material in library::read(&path, &mut warnings) {
                // Of materials with the same name the last one counts, as if all libraries were one file.
                materials.retain(|earlier| earlier.name != material.name);
                materials.push(material);
            }
        }
    }

    let mesh = mesh_of(&lines);
    mesh.mesh.validate().map_err(|message| LoadError::new(file, message).help("export the mesh again"))?;
    let undefined = lines.material_names.iter().zip(&lines.material_spans).filter(|(name, _)| {
        mesh.mesh.material_names.contains(name) && materials.iter().all(|material| material.name != **name)
    });
    let undefined = undefined.map(|(name, span)| {
        let message = format!("material {} is not defined", quoted(name));
        (name.clone(), LoadError::at(file, &text, span.clone(), message))
    });
    Ok(ObjFile { undefined: undefined.collect(), mesh, materials, warnings })
}

/// The mesh of all faces. Its vertices, places and materials are numbered in order of first use.
fn mesh_of(lines: &lines::Lines) -> SceneMesh {
    let corners = || lines.triangles.iter().flat_map(|triangle| &triangle.corners);
    let has_normals = corners().any(|corner| corner.normal.is_some());
    let has_uvs = corners().any(|corner| corner.uv.is_some());
    let has_materials = lines.triangles.iter().any(|triangle| triangle.material.is_some());
    let mut mesh = Mesh::default();
    let (mut positions, mut places) = (Vec::new(), Vec::new());
    let (mut vertices, mut place_numbers) = (HashMap::new(), HashMap::new());
    for triangle in &lines.triangles {
        mesh.triangles.push(triangle.corners.map(|corner| {
            *vertices.entry(corner).or_insert_with(|| {
                let n_places = place_numbers.len() as u32;
                places.push(*place_numbers.entry(corner.position).or_insert(n_places));
                positions.push(lines.positions[corner.position as usize]);
                if has_normals {
                    let normal = corner.normal.map_or(Vec3::ZERO, |normal| lines.normals[normal as usize]);
                    mesh.normals.push(normal);
                }
                if has_uvs {
                    // A corner without texture coordinates shows the middle of its image.
                    mesh.uvs.push(corner.uv.map_or(Vec2::splat(0.5), |uv| lines.uvs[uv as usize]));
                }
                positions.len() as u32 - 1
            })
        }));
        if has_materials {
            let name = triangle.material.map_or(DEFAULT_MATERIAL, |id| &lines.material_names[id as usize]);
            let material = material_number(&mut mesh, name);
            mesh.face_materials.push(material);
        }
    }
    let mut groups: Vec<u32> = lines.triangles.iter().map(|triangle| triangle.group).collect();
    let smooth = has_normals || groups.iter().any(|&group| group != 0);
    if has_normals || groups.iter().all(|&group| group == groups[0]) {
        groups.clear();
    }
    SceneMesh { groups, smooth, ..SceneMesh::new(mesh, positions, places) }
}

/// The index of a material in the mesh, in order of first use; a new name is added.
fn material_number(mesh: &mut Mesh, name: &str) -> u32 {
    let known = mesh.material_names.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        mesh.material_names.push(name.into());
        mesh.material_names.len() - 1
    }) as u32
}
