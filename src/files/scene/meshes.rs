//! `[meshes.NAME]`: triangle meshes from PLY and OBJ files.

use super::files;
use super::materials::{Materials, from_obj};
use super::names::Names;
use super::reader::{Table, Value};
use super::textures;
use super::words::quoted;
use crate::files::error::LoadError;
use crate::files::obj::{self, ObjFile, ObjMaterial};
use crate::files::ply::{self, PlyFile};
use crate::material::{Texture, Wrap};
use crate::scene::SceneMesh;
use std::path::{Path, PathBuf};

/// All `[meshes.NAME]` in the order of the file, with their names. Materials and textures that come with them
/// are added to those of the scene. Fails if a file is missing or malformed, or if the triangles need more memory than the
/// limit.
pub(super) fn meshes<'a>(
    value: Option<Value<'a>>,
    materials: &mut Materials,
    textures: &mut Vec<Texture>,
) -> Result<(Vec<SceneMesh>, Names<'a>), LoadError> {
    let (mut meshes, mut names) = (Vec::new(), Names::new("mesh"));
    let Some(value) = value else { return Ok((meshes, names)) };
    for entry in value.any_table()?.values() {
        let table = entry.table(&["file", "smooth", "one_sided", "materials", "subdivide"])?;
        let smooth = table.get("smooth").map_or(Ok(true), |smooth| smooth.truth())?;
        let one_sided = table.get("one_sided").map_or(Ok(false), |wanted| wanted.truth())?;
        let own_materials = table.get("materials").map_or(Ok(true), |wanted| wanted.truth())?;
        let ObjFile { mesh, materials: described, undefined, warnings } = read(&table, own_materials)?;
        value.source.warnings.borrow_mut().extend(warnings);
        let indices = match own_materials {
            true => {
                MaterialFinder { mesh: entry, described, undefined, materials, textures, images: Vec::new() }
                    .indices(&mesh.mesh.material_names)?
            }
            false => Vec::new(),
        };
        names.insert(entry.key, meshes.len());
        let subdivisions = table.get("subdivide").map_or(Ok(0), |steps| steps.whole(0..=12))?;
        let triangles = (mesh.mesh.triangles.len() as u64) << (2 * subdivisions);
        let place = table.get("subdivide").unwrap_or(entry);
        value.source.budget.triangles(|why| place.error(why), triangles)?;
        // A surface that is subdivided is smooth, also where the file asks for flat faces.
        let smooth = smooth && (mesh.smooth || subdivisions > 0);
        meshes.push(SceneMesh { smooth, one_sided, subdivisions, materials: indices, ..mesh });
    }
    Ok((meshes, names))
}

/// Reads the mesh file that `table` names, with its material libraries only if its materials are wanted. A PLY file is
/// treated like an OBJ file without materials.
fn read(table: &Table, with_materials: bool) -> Result<ObjFile, LoadError> {
    let value = table.need("file", "\"bunny.ply\"")?;
    let file = files::find(value)?;
    match files::extension(&file).as_str() {
        "ply" => {
            let PlyFile { mesh, warnings } = ply::read(&file)?;
            Ok(ObjFile { mesh, materials: Vec::new(), undefined: Vec::new(), warnings })
        }
        "obj" if with_materials => obj::read(&file),
        "obj" => obj::read_without_libraries(&file),
        _ => {
            let message = format!("{} is not a mesh that can be read", value.spelled());
            Err(value.error(message).help("meshes are `.ply` or `.obj` files"))
        }
    }
}

/// Finds the scene's materials for the names that one mesh uses.
struct MaterialFinder<'m, 's> {
    /// The entry of the mesh in the scene.
    mesh: Value<'m>,
    /// The materials that came with it.
    described: Vec<ObjMaterial>,
    /// The names that its files do not define, each with a warning.
    undefined: Vec<(String, LoadError)>,
    materials: &'m mut Materials<'s>,
    textures: &'m mut Vec<Texture>,
    /// Images that were read already, each with its index among the textures; `None` if it cannot be used.
    images: Vec<(PathBuf, Option<usize>)>,
}

impl MaterialFinder<'_, '_> {
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
        if let Some(image) = &described.diffuse_texture {
            material.texture = self.texture(image)?;
        }
        Ok(Some(self.materials.push(format!("{}/{name}", self.mesh.key), material)))
    }

    /// The index of the texture in the file `image`, which is read once. If it cannot be used, a warning says so, and the
    /// material has no texture.
    fn texture(&mut self, image: &Path) -> Result<Option<usize>, LoadError> {
        if let Some((_, index)) = self.images.iter().find(|(path, _)| path == image) {
            return Ok(*index);
        }
        let index = match image.is_file() {
            true => match textures::read(image, Wrap::Repeat, None, self.mesh) {
                Ok((texture, _)) => {
                    self.textures.push(texture);
                    Some(self.textures.len() - 1)
                }
                Err(warning) => {
                    let message = format!("{}; it is left out", warning.message);
                    self.mesh.warn(LoadError { message, ..warning });
                    None
                }
            },
            false => {
                let name = quoted(&image.file_name().unwrap_or_default().to_string_lossy());
                let message =
                    format!("there is no texture {name} for mesh {}; it is left out", quoted(self.mesh.key));
                self.mesh.warn(self.mesh.error(message).help(files::where_it_might_be(image)));
                None
            }
        };
        self.images.push((image.into(), index));
        Ok(index)
    }
}
