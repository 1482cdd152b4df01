#![doc = include_str!("format.md")]

mod files;
mod graph;
mod lights;
mod materials;
mod meshes;
mod names;
mod nodes;
mod numbers;
mod polygon;
mod reader;
mod settings;
mod shapes;
mod syntax;
#[cfg(test)]
mod tests;
mod textures;
mod transform;
mod words;

use super::Scene;
use super::error::LoadError;
use reader::{Source, Table};
use std::io::ErrorKind;
use std::path::Path;

const TABLES: [&str; 9] =
    ["film", "camera", "environment", "quality", "materials", "textures", "meshes", "lights", "nodes"];

/// Reads the scene file `file`, and the meshes and textures that it names relative to its folder.
///
/// # Errors
///
/// If `file` does not exist, cannot be read or is not UTF-8, and in all cases in which [`parse`] fails.
pub fn load(file: &Path) -> Result<Scene, LoadError> {
    let bytes = std::fs::read(file).map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            LoadError::new(file, "there is no such file").help(files::where_it_might_be(file))
        }
        _ => LoadError::new(file, format!("cannot be read: {error}")),
    })?;
    match std::str::from_utf8(&bytes) {
        Ok(text) => parse(file, text),
        Err(error) => {
            let start = error.valid_up_to();
            let sound = String::from_utf8_lossy(&bytes[..start]);
            Err(LoadError::at(file, &sound, start..start, "the file is not text in UTF-8")
                .help("save it as UTF-8"))
        }
    }
}

/// Reads a scene from `text`. Meshes and textures are searched for from the folder of `file`, which need not
/// exist itself.
///
/// # Errors
///
/// If the text is not TOML, `[camera]` is missing, a key is unknown, a value is of the wrong type or out of
/// range, a name is not defined, a shape or a transform is degenerate, the nodes form a loop, or a file that
/// the scene names is missing or malformed. The error names the file with line and column, and mostly says
/// how to repair it.
pub fn parse(file: &Path, text: &str) -> Result<Scene, LoadError> {
    let source = Source { file, text };
    let document = source.document()?;
    let root = Table::root(&source, &document, &TABLES)?;

    let film = settings::film(root.get("film"))?;
    let camera = match root.get("camera") {
        Some(camera) => settings::camera(camera, film.width as f32 / film.height as f32)?,
        None => {
            let help = "add `[camera]` with, for example, `position = [0, 1, 5]` and `look_at = [0, 0, 0]`";
            return Err(root.error("the scene lacks `[camera]`").help(help));
        }
    };
    let environment = settings::environment(root.get("environment"))?;
    let quality = settings::quality(root.get("quality"))?;

    let (mut textures, texture_names) = textures::textures(root.get("textures"))?;
    let mut materials = materials::materials(root.get("materials"), &texture_names)?;
    let (meshes, mesh_names) = meshes::meshes(root.get("meshes"), &mut materials, &mut textures)?;
    let lights = lights::lights(root.get("lights"))?;
    let (nodes, roots) = nodes::nodes(root.get("nodes"), &materials.names, &mesh_names)?;
    Ok(Scene {
        film,
        camera,
        background: environment.background,
        ambient: environment.ambient,
        indirect_light: environment.indirect_light,
        lights,
        materials: materials.list,
        material_names: materials.list_names,
        textures,
        meshes,
        nodes,
        roots,
        quality,
    })
}
