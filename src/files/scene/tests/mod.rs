//! Tests of the scene reader: the scenes that valid files give, and the messages for invalid files.

mod cases;
mod changed;
mod files;
mod materials;
mod mutants;
mod nodes;
mod settings;
mod syntax;

use super::parse;
use crate::scene::Scene;
use std::path::Path;

/// A camera on one line, so that whatever a test adds begins on line 2.
const CAMERA: &str = "camera = { position = [0, 0, 5], look_at = [0, 0, 0] }\n";

/// The scene in `text`, which is valid.
#[track_caller]
fn scene(text: &str) -> Scene {
    parse(Path::new("s.toml"), text).unwrap_or_else(|error| panic!("{error}\nin\n{text}"))
}

/// The scene in `text` behind a camera.
#[track_caller]
fn scene_with(text: &str) -> Scene {
    scene(&format!("{CAMERA}{text}"))
}

/// Checks the whole message about `text`.
#[track_caller]
fn check_refused(text: &str, message: &str) {
    let error = parse(Path::new("s.toml"), text).expect_err("the scene should be refused");
    assert_eq!(error.to_string(), message, "\nin\n{text}");
    assert!(error.span.end <= text.len() && error.place.is_some(), "{error:?}");
}

/// Checks the whole message about `text` behind a camera; `text` begins on line 2.
#[track_caller]
fn check_refused_with(text: &str, message: &str) {
    check_refused(&format!("{CAMERA}{text}"), message);
}

/// The text with nodes and a light behind it that show each mesh and each texture, because the files of others are not read.
fn showing_all(text: &str) -> String {
    let mut shown = text.to_owned();
    let Ok(scene) = text.parse::<toml::Table>() else { return shown };
    let names =
        |key: &str| scene.get(key).and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::keys);
    for name in names("meshes") {
        shown += &format!("\n[[nodes]]\nshape = {{ mesh = '{name}' }}\n");
    }
    for name in names("textures") {
        shown += &format!("\n[materials.showing-{name}]\ntexture = '{name}'\n");
        shown += &format!(
            "\n[[nodes]]\nmaterial = 'showing-{name}'\nshape.sphere = {{ center = [0, 0, 0], radius = 1 }}\n"
        );
    }
    if shown.len() == text.len() { shown } else { shown + "\n[[lights]]\npoint.position = [0, 5, 0]\n" }
}
