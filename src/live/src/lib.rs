//! What the programs `watch`, `view` and `update` share: the stages with their verdicts, which files have changed, the functions of a file, the errors of the
//! compiler, and processes that a save ends.

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
