//! Names for contents: equal contents have equal fingerprints.

use anyhow::{Context, Result};
use raykata::message::to_bytes;
use raykata::scene::{FilmSettings, Quality, Scene};
use std::path::Path;

/// A hash of these bytes: FNV-1a with 128 bits. It distinguishes files and is not cryptographic.
pub fn fingerprint<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut hash = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128;
    for part in parts {
        for byte in part.iter().chain(&part.len().to_le_bytes()) {
            hash = (hash ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
    format!("{hash:032x}")
}

/// The fingerprint of the contents of files, in this order.
pub fn of_files<F: AsRef<Path>>(files: impl IntoIterator<Item = F>) -> Result<String> {
    let read = |file: F| {
        let file = file.as_ref();
        std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))
    };
    let contents: Vec<Vec<u8>> = files.into_iter().map(read).collect::<Result<_>>()?;
    Ok(fingerprint(contents.iter().map(Vec::as_slice)))
}

/// The fingerprint of a scene without its film and quality.
pub fn of_scene(scene: &Scene) -> String {
    let rest = Scene { film: FilmSettings::default(), quality: Quality::default(), ..scene.clone() };
    fingerprint([&to_bytes(&rest)[..]])
}
