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
//! occurs becomes a vertex of its own. `tobj` makes these vertices and cuts polygons into triangles. Its
//! errors name no line, however, and some malformed files make it panic. Therefore `lines` first reads the
//! file line by line, reports every error with its place, and hands on only the lines that are correct.

mod library;
mod lines;
#[cfg(test)]
mod tests;

use crate::files::error::LoadError;
use crate::files::ply::text::{LOOKS_LIKE_OBJ, guess, quote, read_bytes, readable};
use crate::files::ply::unit_normals;
use crate::mesh::Mesh;
use glam::{Vec2, Vec3};
use std::path::{Path, PathBuf};

/// The content of an OBJ file and of its material libraries.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjFile {
    /// All objects and groups of the file as one mesh, because all triangles become one set of primitives in
    /// the end.
    pub mesh: Mesh,
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
/// fans around their first corner. Normals are of unit length; if any corner has no normal, or
/// a normal without direction, the mesh has none at all. Where only some materials of the file have texture
/// coordinates, those of the others are `(0.5, 0.5)`.
///
/// A warning is added if a library is missing or one of its lines cannot be used, if a face names texture coordinates or
/// normals and the file has none above it, if `usemtl` or `mtllib` has no name, and if the outline of a face crosses itself.
///
/// # Errors
///
/// If a line of the file is malformed, if an index names no vertex, texture coordinate or normal above its face, if a
/// position or a texture coordinate is not finite, or if there are no faces. An error at a place in a file names its line
/// and column.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<ObjFile, LoadError> {
    parse_with(file, bytes, true)
}

fn parse_with(file: &Path, bytes: &[u8], with_libraries: bool) -> Result<ObjFile, LoadError> {
    let text = readable(bytes);
    let mut lines = lines::read(file, &text)?;
    if lines.faces == 0 {
        return Err(match guess(bytes).filter(|help| *help != LOOKS_LIKE_OBJ) {
            Some(help) if lines.vertices == 0 => LoadError::new(file, "this is not an OBJ file").help(help),
            _ => LoadError::new(file, "the file has no faces").help(
                "export the mesh with faces: lines that start with `f` and name three vertices or more",
            ),
        });
    }

    let mut warnings = std::mem::take(&mut lines.warnings);
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

    let mesh = merge(load(file, &lines)?, &lines.material_names);
    mesh.validate().map_err(|message| LoadError::new(file, message).help("export the mesh again"))?;
    let undefined = lines.material_names.iter().zip(&lines.material_spans).filter(|(name, _)| {
        mesh.material_names.contains(name) && materials.iter().all(|material| material.name != **name)
    });
    let undefined = undefined.map(|(name, span)| {
        let message = format!("material {} is not defined", quote(name));
        (name.clone(), LoadError::at(file, &text, span.clone(), message))
    });
    Ok(ObjFile { undefined: undefined.collect(), mesh, materials, warnings })
}

/// Reads one mesh for each run of faces with the same material.
fn load(file: &Path, lines: &lines::Lines) -> Result<Vec<tobj::Mesh>, LoadError> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    // `tobj` drops names that no library defines, but a scene may define them. So pass each name to it as a material;
    // only the numbers of the materials are used.
    let numbers = || lines.material_names.iter().enumerate().map(|(number, name)| (name.clone(), number));
    let all_materials = |_: &Path| Ok((Vec::new(), numbers().collect()));
    match tobj::load_obj_buf(&mut lines.clean.as_bytes(), &options, all_materials) {
        Ok((models, _)) => Ok(models.into_iter().map(|model| model.mesh).collect()),
        Err(error) => Err(LoadError::new(file, format!("the mesh cannot be read: {error}"))
            .help("export the mesh again, or as PLY")),
    }
}

/// All parts as one mesh. Normals are kept only if every corner has one: a mesh has one per vertex or none at
/// all, and an invented one would be visible in the picture. A part without texture coordinates shows the
/// middle of its image.
fn merge(parts: Vec<tobj::Mesh>, names: &[String]) -> Mesh {
    let vec3s = |numbers: &[f32]| -> Vec<Vec3> { numbers.chunks_exact(3).map(Vec3::from_slice).collect() };
    let mut mesh = Mesh::default();
    let has_materials = parts.iter().any(|part| part.material_id.is_some() && !part.indices.is_empty());
    for part in parts.iter().filter(|part| !part.indices.is_empty()) {
        let first = mesh.positions.len() as u32;
        let material = material_number(&mut mesh, part.material_id.map_or(DEFAULT_MATERIAL, |id| &names[id]));
        mesh.positions.extend(vec3s(&part.positions));
        mesh.normals.extend(vec3s(&part.normals));
        mesh.uvs.extend(part.texcoords.chunks_exact(2).map(Vec2::from_slice));
        if mesh.uvs.len() != mesh.positions.len() {
            mesh.uvs.resize(mesh.positions.len(), Vec2::splat(0.5));
        }
        for corners in part.indices.chunks_exact(3) {
            mesh.triangles.push([first + corners[0], first + corners[1], first + corners[2]]);
            mesh.face_materials.push(material);
        }
    }

    if mesh.normals.len() != mesh.positions.len() {
        mesh.normals.clear();
    }
    if parts.iter().all(|part| part.texcoords.is_empty()) {
        mesh.uvs.clear();
    }
    if !has_materials {
        mesh.material_names.clear();
        mesh.face_materials.clear();
    }
    mesh.normals = unit_normals(mesh.normals);
    mesh
}

/// The index of a material in the mesh, in order of first use; a new name is added.
fn material_number(mesh: &mut Mesh, name: &str) -> u32 {
    let known = mesh.material_names.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        mesh.material_names.push(name.into());
        mesh.material_names.len() - 1
    }) as u32
}
