//! The readers of scene files (TOML), of meshes (OBJ, PLY) and of images, and their errors.

pub mod error;
pub mod obj;
pub mod ply;
pub mod scene;
mod words;
