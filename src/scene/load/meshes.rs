//! `[meshes.NAME]`: triangle meshes from PLY and OBJ files.

use super::files;
use super::materials::{Materials, from_obj};
use super::names::Names;
use super::reader::{Table, Value};
use super::textures;
use super::words::quoted;
use crate::material::{Texture, Wrap};
use crate::mesh::Mesh;
use crate::scene::error::LoadError;
use crate::scene::obj::{self, ObjFile, ObjMaterial};
use crate::scene::{SceneMesh, ply};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All `[meshes.NAME]` in the order of the file, with their names. Materials and textures that come with them
/// are added to those of the scene. Fails if a file or a material is missing or malformed, or if subdivision
/// would make more than 2^24 triangles.
pub(super) fn meshes<'a>(
    value: Option<Value<'a>>,
    materials: &mut Materials,
    textures: &mut Vec<Texture>,
) -> Result<(Vec<SceneMesh>, Names<'a>), LoadError> {
    let (mut meshes, mut names) = (Vec::new(), Names::new("mesh"));
    let Some(value) = value else { return Ok((meshes, names)) };
    for entry in value.any_table()?.values() {
        let table = entry.table(&["file", "smooth", "materials", "subdivide"])?;
        let smooth = table.get("smooth").map_or(Ok(true), |smooth| smooth.truth())?;
        let own_materials = table.get("materials").map_or(Ok(true), |wanted| wanted.truth())?;
        let (file, ObjFile { mesh, materials: described }) = read(&table)?;
        let indices = match own_materials {
            true => Adopter { mesh: entry, file, described, materials, textures, images: Vec::new() }
                .indices(&mesh.material_names)?,
            false => Vec::new(),
        };
        names.insert(entry.key, meshes.len());
        let subdivisions = table.get("subdivide").map_or(Ok(0), |steps| subdivisions(steps, &mesh))?;
        meshes.push(SceneMesh { mesh: Arc::new(mesh), smooth, subdivisions, materials: indices });
    }
    Ok((meshes, names))
}

/// Reads the mesh file that `table` names. A PLY file is treated like an OBJ file without materials.
fn read(table: &Table) -> Result<(PathBuf, ObjFile), LoadError> {
    let value = table.need("file", "\"bunny.ply\"")?;
    let file = files::find(value)?;
    let read = match files::extension(&file).as_str() {
        "ply" => ObjFile { mesh: ply::read(&file)?, materials: Vec::new() },
        "obj" => obj::read(&file)?,
        _ => {
            let message = format!("{} is not a mesh that can be read", value.spelled());
            return Err(value.error(message).help("meshes are `.ply` or `.obj` files"));
        }
    };
    check(value, &read.mesh)?;
    Ok((file, read))
}

/// The largest number of triangles of a subdivided mesh.
const MOST_TRIANGLES: u64 = 1 << 24;

/// The number of subdivision steps; each makes four triangles of one.
fn subdivisions(value: Value, mesh: &Mesh) -> Result<u32, LoadError> {
    let steps = value.whole(0..=12)?;
    let triangles = (mesh.triangles.len() as u64) << (2 * steps);
    match triangles <= MOST_TRIANGLES {
        true => Ok(steps),
        false => {
            let message = format!("`subdivide = {steps}` makes {triangles} triangles of this mesh");
            Err(value
                .error(message)
                .help(format!("take fewer steps: {MOST_TRIANGLES} triangles are the most")))
        }
    }
}

fn check(value: Value, mesh: &Mesh) -> Result<(), LoadError> {
    mesh.validate().map_err(|message| value.error(format!("cannot use {}: {message}", value.spelled())))
}

/// Finds the scene's materials for the names that one mesh uses.
struct Adopter<'m, 's> {
    /// The entry of the mesh in the scene.
    mesh: Value<'m>,
    /// The file of the mesh.
    file: PathBuf,
    /// The materials that came with it.
    described: Vec<ObjMaterial>,
    materials: &'m mut Materials<'s>,
    textures: &'m mut Vec<Texture>,
    /// Images that were read already, each with its index among the textures.
    images: Vec<(PathBuf, usize)>,
}

impl Adopter<'_, '_> {
    /// The index of the material for each of `names`. A `[materials.NAME]` has precedence over a material
    /// that came with the mesh.
    fn indices(&mut self, names: &[String]) -> Result<Vec<usize>, LoadError> {
        names.iter().map(|name| self.index(name)).collect()
    }

    fn index(&mut self, name: &str) -> Result<usize, LoadError> {
        if let Some(index) = self.materials.names.get(name) {
            return Ok(index);
        }
        let remedy = format!(
            "define `[materials.{}]`, or write `materials = false` to give the whole mesh the material of \
             its node",
            name.escape_debug()
        );
        let Some(described) = self.described.iter().find(|material| material.name == name).cloned() else {
            let message = format!(
                "mesh {} uses material {}, which is not defined",
                quoted(self.mesh.key),
                quoted(name)
            );
            return Err(self.mesh.error(message).help(remedy));
        };
        let mut material = from_obj(&described).map_err(|trouble| {
            let message =
                format!("material {} of {} cannot be used: {trouble}", quoted(name), self.file.display());
            self.mesh.error(message).help(remedy)
        })?;
        if let Some(image) = &described.diffuse_texture {
            material.texture = Some(self.texture(image)?);
        }
        Ok(self.materials.push(format!("{}/{name}", self.mesh.key), material))
    }

    /// The index of the texture in the file `image`, which is read once.
    fn texture(&mut self, image: &Path) -> Result<usize, LoadError> {
        if let Some((_, index)) = self.images.iter().find(|(path, _)| path == image) {
            return Ok(*index);
        }
        let texture = textures::read(image, Wrap::Repeat).map_err(|message| {
            let message = format!("cannot use the texture of mesh {}: {message}", quoted(self.mesh.key));
            self.mesh.error(message).help(files::where_it_might_be(image))
        })?;
        self.textures.push(texture);
        self.images.push((image.into(), self.textures.len() - 1));
        Ok(self.textures.len() - 1)
    }
}
