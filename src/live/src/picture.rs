//! The picture of a scene as the exercises render it.

use anyhow::{Result, anyhow};
use raykata::film::{Film, encode_srgb};
use raykata::kit::{Door, Shading, kit_error};
use raykata::scene::{Encoding, Scene};
use raykata_cli::worker::Worker;
use std::path::Path;

/// The colours as they are shown. Without a written `encode_gamma`, a scene with gamma 2 is shown in sRGB.
pub fn encoded(scene: &Scene, film: &Film, kit: &Door<Worker>) -> Vec<u8> {
    let toned = film.toned(scene.film.tone);
    let srgb = toned.to_bytes(encode_srgb).rgb;
    if scene.film.encoding == Encoding::Srgb {
        return srgb;
    }
    let components: Vec<f32> = toned.pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
    match kit_error::catch(|| kit.encode_gamma(&components)) {
        Ok(bytes) => bytes,
        Err(_) => srgb,
    }
}

/// Reads a scene. The error shows the line that is wrong.
pub fn read_scene(file: &Path) -> Result<Scene> {
    raykata::scene::load::load(file).map_err(|error| anyhow!(raykata_cli::report::draw(&error)))
}
