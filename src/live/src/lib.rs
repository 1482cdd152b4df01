//! What the programs `watch`, `view` and `update` share: which files have changed, the functions of a file, the errors of the
//! compiler, processes that a save ends, and the scene of a stage and its picture.

pub mod compiler;
pub mod files;
pub mod functions;
pub mod picture;
pub mod process;

use std::path::{Path, PathBuf};

/// The folder that the student writes in.
pub fn exercises(root: &Path) -> PathBuf {
    root.join("exercises/src")
}

/// The scene that shows what a stage adds.
pub fn scene_of(root: &Path, stage: u8) -> PathBuf {
    let own = root.join(format!("scenes/stage{stage}.toml"));
    let file = match stage {
        _ if own.is_file() => return own,
        11 => "cornell.toml",
        _ => "showcase.toml",
    };
    root.join("scenes").join(file)
}
