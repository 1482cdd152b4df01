//! The memory that a scene may use. It is estimated before anything is allocated: a few words in a scene, or an image
//! file of some hundred kilobytes, can ask for more than a computer has.

use crate::files::error::LoadError;
use crate::scene::MOST_PRIMITIVES;
use std::cell::Cell;

/// What a scene may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most memory, in bytes, for film, textures and triangles together, as it is estimated from their numbers.
    pub memory: u64,
}

impl Default for Limits {
    /// 4 GB: half of what a small computer has.
    fn default() -> Self {
        Limits { memory: u64::from(MOST_PRIMITIVES) * TRIANGLE }
    }
}

const GIGABYTE: u64 = 1_000_000_000;
/// Bytes per pixel of the film: the worker and the program have a film each, and a message is between them.
const FILM_PIXEL: u64 = 28;
/// Bytes per pixel of a texture: the program and the worker have one copy each, and a message is between them. Smaller copies for
/// filtering have a third of the pixels of one.
const TEXTURE_PIXEL: u64 = 40;
/// Bytes per triangle: vertices, primitive, normals, texture coordinates, and its part of an acceleration structure.
const TRIANGLE: u64 = 200;

impl Limits {
    /// The most triangles of a scene in which nothing else takes memory, but at most `u32::MAX`, because primitives are
    /// numbered by `u32`.
    pub fn triangles(self) -> u32 {
        u32::try_from(self.memory / TRIANGLE).unwrap_or(u32::MAX)
    }

    /// Checks that a film of this size fits into the memory.
    ///
    /// # Errors
    ///
    /// A sentence that says how much memory the film takes and how to allow it.
    pub fn check_film(self, width: u32, height: u32) -> Result<(), String> {
        let bytes = film_bytes(width, height);
        match bytes <= self.memory {
            true => Ok(()),
            false => {
                let what = film_name(width, height);
                Err(format!("{}; {}", exceeds(&what, bytes, self.memory), advice(bytes)))
            }
        }
    }
}

/// The limits of a scene, and how much of the memory is in use.
pub(crate) struct Budget {
    limits: Limits,
    used: Cell<u64>,
}

impl Budget {
    pub fn new(limits: Limits) -> Budget {
        Budget { limits, used: Cell::new(0) }
    }

    /// Sets memory aside for the film; `error` makes the error if there is not enough.
    pub fn film(
        &self,
        error: impl FnOnce(String) -> LoadError,
        width: u32,
        height: u32,
    ) -> Result<(), LoadError> {
        self.take(error, film_bytes(width, height), &film_name(width, height))
    }

    /// Sets memory aside for a texture; `error` makes the error if there is not enough.
    pub fn texture(
        &self,
        error: impl FnOnce(String) -> LoadError,
        width: u32,
        height: u32,
    ) -> Result<(), LoadError> {
        let bytes = pixels(width, height).saturating_mul(TEXTURE_PIXEL);
        self.take(error, bytes, &format!("an image of {width} by {height} pixels"))
    }

    /// Sets memory aside for triangles; `error` makes the error if there is not enough.
    pub fn triangles(
        &self,
        error: impl FnOnce(String) -> LoadError,
        triangles: u64,
    ) -> Result<(), LoadError> {
        self.take(error, triangles.saturating_mul(TRIANGLE), &format!("a surface of {triangles} triangles"))
    }

    fn take(&self, error: impl FnOnce(String) -> LoadError, bytes: u64, what: &str) -> Result<(), LoadError> {
        let used = self.used.get().saturating_add(bytes);
        if used <= self.limits.memory {
            self.used.set(used);
            return Ok(());
        }
        let message = match self.used.get() {
            0 => exceeds(what, bytes, self.limits.memory),
            before => format!(
                "{what} takes about {}, and with {} for what stands above it the scene exceeds the limit of {}",
                size(bytes),
                size(before),
                size(self.limits.memory)
            ),
        };
        Err(error(message).help(advice(used)))
    }
}

fn pixels(width: u32, height: u32) -> u64 {
    u64::from(width) * u64::from(height)
}

fn film_bytes(width: u32, height: u32) -> u64 {
    pixels(width, height).saturating_mul(FILM_PIXEL)
}

fn film_name(width: u32, height: u32) -> String {
    format!("a picture of {width} by {height} pixels")
}

fn exceeds(what: &str, bytes: u64, limit: u64) -> String {
    format!("{what} takes about {} of memory; the limit is {}", size(bytes), size(limit))
}

fn advice(needed: u64) -> String {
    format!("make it smaller, or allow more memory: at least `--memory {}`", needed.div_ceil(GIGABYTE))
}

fn size(bytes: u64) -> String {
    match bytes {
        GIGABYTE.. => format!("{:.1} GB", bytes as f64 / GIGABYTE as f64),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
