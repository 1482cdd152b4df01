//! Tests of the scene reader: the scenes that valid files give, and the messages for invalid files.

mod cases;
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
