//! Scenes that tests write as text.

use raykata::scene::{Scene, load};
use std::path::Path;

/// The scene in `text`, as if it were a file in `scenes`.
pub fn scene(text: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/test.toml");
    load::parse(&file, text).unwrap_or_else(|error| panic!("{error}"))
}
