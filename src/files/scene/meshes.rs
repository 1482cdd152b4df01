//! `[meshes.NAME]`: triangle meshes from PLY and OBJ files.

use super::files;
use super::materials::{Materials, from_obj};
use super::names::Names;
use super::reader::Value;
use super::textures::Images;
use crate::files::error::LoadError;
use crate::files::obj::{self, ObjFile, ObjMaterial};
use crate::files::ply::{self, PlyFile};
use crate::files::words::quoted;
use crate::scene::{Node, SceneMesh};
use crate::shape::Shape;
use std::path::{Path, PathBuf};

/// The meshes of `[meshes.NAME]`. Their files are read by [`Meshes::read`].
#[derive(Default)]
pub(super) struct Meshes<'a> {
    /// All meshes by index. One whose file is not read has no triangles.
    pub list: Vec<SceneMesh>,
    /// The entry in the scene and the file of each.
    entries: Vec<(Value<'a>, PathBuf)>,
}

const KEYS: [&str; 5] = ["file", "smooth", "one_sided", "materials", "subdivide"];

/// All `[meshes.NAME]` in the order of the file, with their names, and their files unread. Fails if a file is missing or
/// is not a mesh by its name.
pub(super) fn meshes<'a>(value: Option<Value<'a>>) -> Result<(Meshes<'a>, Names<'a>), LoadError> {
    let (mut meshes, mut names) = (Meshes::default(), Names::new("mesh"));
    let Some(value) = value else { return Ok((meshes, names)) };
    for entry in value.any_table()?.values() {
        let table = entry.table(&KEYS)?;
        let smooth = table.get("smooth").map_or(Ok(true), |smooth| smooth.truth())?;
        let one_sided = table.get("one_sided").map_or(Ok(false), |wanted| wanted.truth())?;
        table.get("materials").map_or(Ok(true), |wanted| wanted.truth())?;
        let subdivisions = table.get("subdivide").map_or(Ok(0), |steps| steps.whole(0..=12))?;
        let file = table.need("file", "\"bunny.ply\"")?;
        let path = files::find(file)?;
        if !["ply", "obj"].contains(&files::extension(&path).as_str()) {
            let message = format!("{} is not a mesh that can be read", file.spelled());
            return Err(file.error(message).help("meshes are `.ply` or `.obj` files"));
        }
        names.insert(entry.key, meshes.list.len());
        meshes.entries.push((entry, path));
        meshes.list.push(SceneMesh { smooth, one_sided, subdivisions, ..SceneMesh::default() });
    }
    Ok((meshes, names))
}

impl<'a> Meshes<'a> {
    /// Reads the files of those meshes that a node shows. Materials and images that come with them are added to those of
    /// the scene. Fails if a file is malformed, or if the triangles need more memory than the limit.
    pub fn read(
        &mut self,
        nodes: &[Node],
        materials: &mut Materials,
        images: &mut Images<'a>,
    ) -> Result<(), LoadError> {
        for (index, (entry, path)) in self.entries.iter().enumerate() {
            // All nodes are reached from a root.
            if nodes.iter().any(|node| matches!(node.shape, Some(Shape::Mesh(shown)) if shown == index)) {
                read(&mut self.list[index], *entry, path, materials, images)?;
            }
        }
        Ok(())
    }
}

/// Reads the file `path` of the mesh `entry`, with its material libraries only if its materials are wanted. A PLY file is
/// treated like an OBJ file without materials.
fn read<'a>(
    into: &mut SceneMesh,
    entry: Value<'a>,
    path: &Path,
    materials: &mut Materials,
    images: &mut Images<'a>,
) -> Result<(), LoadError> {
    let table = entry.table(&KEYS)?;
    let own_materials = table.get("materials").map_or(Ok(true), |wanted| wanted.truth())?;
    let ObjFile { mesh, materials: described, undefined, warnings } = match files::extension(path).as_str() {
        "ply" => {
            let PlyFile { mesh, warnings } = ply::read(path)?;
            ObjFile { mesh, materials: Vec::new(), undefined: Vec::new(), warnings }
        }
        _ if own_materials => obj::read(path)?,
        _ => obj::read_without_libraries(path)?,
    };
    entry.source.warnings.borrow_mut().extend(warnings);
    if own_materials {
        into.materials =
            MaterialFinder { mesh: entry, described, undefined, materials, images, found: Vec::new() }
                .indices(&mesh.mesh.material_names)?;
    }
    let triangles = (mesh.mesh.triangles.len() as u64) << (2 * into.subdivisions);
    let place = table.get("subdivide").unwrap_or(entry);
    entry.source.budget.triangles(|why| place.error(why), triangles)?;
    // A surface that is subdivided is smooth, also where the file asks for flat faces.
    into.smooth &= mesh.smooth || into.subdivisions > 0;
    (into.mesh, into.origin, into.places, into.groups) = (mesh.mesh, mesh.origin, mesh.places, mesh.groups);
    Ok(())
}

/// Finds the scene's materials for the names that one mesh uses.
struct MaterialFinder<'m, 'n, 's> {
    /// The entry of the mesh in the scene.
    mesh: Value<'s>,
    /// The materials that came with it.
    described: Vec<ObjMaterial>,
    /// The names that its files do not define, each with a warning.
    undefined: Vec<(String, LoadError)>,
    materials: &'m mut Materials<'n>,
    images: &'m mut Images<'s>,
    /// Image files that were looked for already, each with its index among the images; `None` if there is none.
    found: Vec<(PathBuf, Option<usize>)>,
}

impl MaterialFinder<'_, '_, '_> {
    /// The index of the material for each of `names`, or none if no name is defined: the mesh then has the material of
    /// its node. A `[materials.NAME]` has precedence over a material that came with the mesh.
    fn indices(&mut self, names: &[String]) -> Result<Vec<usize>, LoadError> {
        let mut indices = Vec::new();
        let mut any = false;
        for name in names {
            let index = self.index(name)?;
            any |= index.is_some();
            indices.push(index.unwrap_or(0));
        }
        let shown = match any {
            true => "these faces have the material `default`",
            false => "the mesh has the material of its node",
        };
        for (_, warning) in self.undefined.drain(..) {
            let message = format!("{}; {shown}", warning.message);
            let help =
                "define it in the scene under `[materials]`, or write `materials = false` for the mesh";
            self.mesh.warn(LoadError { message, ..warning }.help(help));
        }
        Ok(if any { indices } else { Vec::new() })
    }

    fn index(&mut self, name: &str) -> Result<Option<usize>, LoadError> {
        if let Some(index) = self.materials.names.get(name) {
            self.undefined.retain(|(undefined, _)| undefined != name);
            return Ok(Some(index));
        }
        let Some(described) = self.described.iter().find(|material| material.name == name).cloned() else {
            return Ok(None);
        };
        let mut material = from_obj(&described);
        material.texture = described.diffuse_texture.as_deref().and_then(|path| self.image(path));
        Ok(Some(self.materials.push(format!("{}/{name}", self.mesh.key), material)))
    }

    /// The index of the image in the file `path`. If there is no such file, a warning says so, and the material has no
    /// image.
    fn image(&mut self, path: &Path) -> Option<usize> {
        if let Some((_, index)) = self.found.iter().find(|(found, _)| found == path) {
            return *index;
        }
        let index = match path.is_file() {
            true => Some(self.images.add_optional(path.into(), self.mesh)),
            false => {
                let name = quoted(&path.file_name().unwrap_or_default().to_string_lossy());
                let message =
                    format!("there is no texture {name} for mesh {}; it is left out", quoted(self.mesh.key));
                self.mesh.warn(self.mesh.error(message).help(files::where_it_might_be(path)));
                None
            }
        };
        self.found.push((path.into(), index));
        index
    }
}
