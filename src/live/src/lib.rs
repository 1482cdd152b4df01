//! What the programs `watch`, `view` and `update` share.

pub mod compiler;
pub mod course;
pub mod files;
pub mod functions;
pub mod process;

use std::path::{Path, PathBuf};

/// The folder that the student writes in.
pub fn exercises(root: &Path) -> PathBuf {
    root.join("exercises/src")
}
