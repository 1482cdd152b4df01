#![doc = include_str!("format.md")]

mod files;
mod graph;
mod lights;
mod limits;
mod materials;
mod meshes;
mod names;
mod nodes;
mod numbers;
mod nurbs;
mod radiance;
pub(crate) mod reader;
mod settings;
mod shapes;
#[cfg(test)]
mod tests;
mod textures;
mod transform;

use super::error::LoadError;
use crate::scene::{Gamma2, Scene};
pub use limits::Limits;
use reader::{Source, Table};
pub use settings::set;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::Path;

const TABLES: [&str; 10] = [
    "color_encoding",
    "film",
    "camera",
    "environment",
    "quality",
    "materials",
    "textures",
    "meshes",
    "lights",
    "nodes",
];

/// A scene, and what was noticed while it was read.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, which can be rendered.
    pub scene: Scene,
    /// What was ignored or replaced in files that the scene names, with file, line and column.
    pub warnings: Vec<LoadError>,
}

/// Reads the scene file `file`, and the meshes and textures that it names relative to its folder. Warnings are
/// dropped; [`load_within`] returns them.
///
/// # Errors
///
/// If `file` does not exist, cannot be read or is not UTF-8, and in all cases in which [`parse`] fails.
pub fn load(file: &Path) -> Result<Scene, LoadError> {
    load_within(file, Limits::default()).map(|loaded| loaded.scene)
}

/// Reads the scene file `file` as [`load`] does, within these limits.
///
/// # Errors
///
/// If `file` does not exist, cannot be read or is not UTF-8, and in all cases in which [`parse`] fails.
pub fn load_within(file: &Path, limits: Limits) -> Result<Loaded, LoadError> {
    let bytes = std::fs::read(file).map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            LoadError::new(file, "there is no such file").help(files::where_it_might_be(file))
        }
        _ => LoadError::new(file, format!("cannot be read: {error}")),
    })?;
    match std::str::from_utf8(&bytes) {
        Ok(text) => parse_within(file, text, limits),
        Err(error) => {
            let start = error.valid_up_to();
            let sound = String::from_utf8_lossy(&bytes[..start]);
            Err(LoadError::at(file, &sound, start..start, "the file is not text in UTF-8")
                .help("save it as UTF-8"))
        }
    }
}

/// Reads a scene from `text`. Meshes and textures are searched for from the folder of `file`, which need not
/// exist itself. Warnings are dropped; [`parse_within`] returns them.
///
/// # Errors
///
/// If the text is not TOML, `[camera]` is missing, a key is unknown, a value is of the wrong type or out of
/// range, a name is not defined, a shape or a transform is degenerate, the nodes form a loop, a file that
/// the scene names is missing or malformed, or the scene needs more memory than the default of [`Limits`]. The error
/// names the file with line and column, and mostly says how to repair it.
pub fn parse(file: &Path, text: &str) -> Result<Scene, LoadError> {
    parse_within(file, text, Limits::default()).map(|loaded| loaded.scene)
}

/// Reads a scene from `text` as [`parse`] does, within these limits.
///
/// # Errors
///
/// In all cases in which [`parse`] fails.
pub fn parse_within(file: &Path, text: &str, limits: Limits) -> Result<Loaded, LoadError> {
    let source = Source::new(file, text, limits);
    let document = source.document()?;
    let root = Table::root(&source, "the scene", &document, &TABLES)?;

    if let Some(encoding) = root.get("color_encoding") {
        source.encoding.set(encoding.choice(&settings::ENCODINGS)?);
    }
    let film = settings::film(root.get("film"))?;
    let camera = match root.get("camera") {
        Some(camera) => settings::camera(camera, film.width as f32 / film.height as f32)?,
        None => {
            let help = "add `[camera]` with, for example, `position = [0, 1, 5]` and `look_at = [0, 0, 0]`";
            return Err(root.error("the scene lacks `[camera]`").help(help));
        }
    };
    let quality = settings::quality(root.get("quality"))?;

    let (mut images, image_names) = textures::textures(root.get("textures"))?;
    let environment = settings::environment(root.get("environment"), &mut images)?;
    let mut materials = materials::materials(root.get("materials"), &image_names)?;
    let (mut meshes, mesh_names) = meshes::meshes(root.get("meshes"))?;
    let lights = lights::lights(root.get("lights"), camera.position)?;
    let (nodes, roots) = nodes::nodes(root.get("nodes"), &materials.names, &mesh_names, &mut meshes.list)?;
    // Files are read last, when it is known which of them the picture shows.
    meshes.read(&nodes, &mut materials, &mut images)?;
    let mut scene = Scene {
        film,
        camera,
        background: environment.background,
        ambient: environment.ambient,
        indirect_light: environment.indirect_light,
        lights: lights.list.clone(),
        visible_lights: Vec::new(),
        materials: materials.list,
        material_names: materials.list_names,
        textures: Vec::new(),
        meshes: meshes.list,
        nodes,
        roots,
        gamma2: Gamma2::default(),
        quality,
        max_primitives: limits.triangles(),
    };
    for material in scene.shown().into_iter().flat_map(|shape| shape.materials).collect::<BTreeSet<_>>() {
        if let Some(image) = scene.materials[material].texture
            && scene.is_lit(&scene.materials[material])
            && !images.read(image)?
        {
            scene.materials[material].texture = None;
        }
    }
    scene.textures = images.list;
    scene.gamma2 = source.gamma2.take();
    lights::show(&mut scene, &lights);
    Ok(Loaded { scene, warnings: source.warnings.take() })
}
