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
//! A corner of a face has up to three indices, counted from 1: into the positions `v`, the texture coordinates `vt`
//! and the normals `vn`. Our [`Mesh`] has one index a corner, so each combination that occurs becomes a vertex of
//! its own; that is what `tobj` does for us, together with cutting polygons into triangles. It does not say where
//! an error sits, though, and some nonsense makes it panic. So `lines` first reads the file line by line, finds
//! all that is wrong, and hands on only what is right.

mod library;
mod lines;
#[cfg(test)]
mod tests;

use crate::mesh::Mesh;
use crate::scene::error::LoadError;
use crate::scene::ply::text::{LOOKS_LIKE_OBJ, guess, read_bytes, readable};
use crate::scene::ply::unit_normals;
use glam::{Vec2, Vec3};
use std::path::{Path, PathBuf};

/// What an OBJ file and its material libraries hold.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjFile {
    /// All objects and groups of the file in one mesh: in the end all triangles go into one set of primitives.
    pub mesh: Mesh,
    /// All materials of the libraries, used or not. A name in [`Mesh::material_names`] may be missing here.
    pub materials: Vec<ObjMaterial>,
}

/// A material of a library, as it is written there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjMaterial {
    /// `newmtl`
    pub name: String,
    /// `Ka`
    pub ambient: Option<Vec3>,
    /// `Kd`
    pub diffuse: Option<Vec3>,
    /// `Ks`
    pub specular: Option<Vec3>,
    /// `Ns`, the Phong exponent.
    pub shininess: Option<f32>,
    /// `Ni`
    pub index_of_refraction: Option<f32>,
    /// `d`: 1 is opaque.
    pub dissolve: Option<f32>,
    /// `map_Kd`, as a path that starts where the library lies.
    pub diffuse_texture: Option<PathBuf>,
    /// `Ke`
    pub emission: Option<Vec3>,
}

/// The material of faces above the first `usemtl` line, if other faces have one.
pub const DEFAULT_MATERIAL: &str = "default";

/// Reads the mesh and the materials of an OBJ file.
pub fn read(file: &Path) -> Result<ObjFile, LoadError> {
    parse(file, &read_bytes(file)?)
}

/// Reads the bytes of an OBJ file; its libraries are looked for next to `file`.
pub fn parse(file: &Path, bytes: &[u8]) -> Result<ObjFile, LoadError> {
    let text = readable(bytes);
    let lines = lines::read(file, &text)?;
    if lines.faces == 0 {
        return Err(match guess(bytes).filter(|help| *help != LOOKS_LIKE_OBJ) {
            Some(help) if lines.vertices == 0 => LoadError::new(file, "this is not an OBJ file").help(help),
            _ => LoadError::new(file, "the file has no faces").help(
                "export the mesh with faces: lines that start with `f` and name three vertices or more",
            ),
        });
    }

    let mut materials: Vec<ObjMaterial> = Vec::new();
    for library in &lines.libraries {
        for path in library::find(file, &text, library)? {
            for material in library::read(&path)? {
                // The last material with a name is the one that is meant, as if all libraries were one file.
                materials.retain(|earlier| earlier.name != material.name);
                materials.push(material);
            }
        }
    }

    let mesh = merge(load(file, &lines)?, &lines.material_names);
    mesh.validate().map_err(|message| LoadError::new(file, message).help("export the mesh again"))?;
    Ok(ObjFile { mesh, materials })
}

/// One mesh for each run of faces with the same material.
fn load(file: &Path, lines: &lines::Lines) -> Result<Vec<tobj::Mesh>, LoadError> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    // `tobj` forgets names that no library defines, but a scene may define them as well. So it is told that each
    // name is a material; their numbers are all that we ask back.
    let numbers = || lines.material_names.iter().enumerate().map(|(number, name)| (name.clone(), number));
    let all_materials = |_: &Path| Ok((Vec::new(), numbers().collect()));
    match tobj::load_obj_buf(&mut lines.clean.as_bytes(), &options, all_materials) {
        Ok((models, _)) => Ok(models.into_iter().map(|model| model.mesh).collect()),
        Err(error) => Err(LoadError::new(file, format!("the mesh cannot be read: {error}"))
            .help("export the mesh again, or as PLY")),
    }
}

/// All parts in one mesh. Normals stay only if every corner has one: a mesh has one for each vertex or none at all, and a
/// made-up one would be seen in the picture. A part without texture coordinates shows the middle of its image.
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

/// The number of a material in the mesh, which numbers them in order of first use.
fn material_number(mesh: &mut Mesh, name: &str) -> u32 {
    let known = mesh.material_names.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        mesh.material_names.push(name.into());
        mesh.material_names.len() - 1
    }) as u32
}
