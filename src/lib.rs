//! The scaffold of Raykata, a teaching kit for ray tracing: everything around the exercises, and no answer to
//! any of them.
//!
//! # Where to look
//!
//! | module | what it holds |
//! |---|---|
//! | [`ray`], [`aabb`], [`shape`], [`mesh`], [`rounding`] | geometry as data: rays with an open range of `t`, boxes, shapes, indexed meshes; bounds on rounding errors |
//! | [`material`], [`emitter`], [`light_path`] | what surfaces and lights are made of, the steps of a path |
//! | [`camera`], [`film`], [`rows`], [`random`] | where rays start, where colours end, and random numbers that are looked up by address |
//! | [`count`] | what a frame costs |
//! | [`bvh`], [`graph`], [`partition`], [`wide`] | acceleration structures as data, and what a search may ask ([`bvh::Probe`], [`partition::Cells`]) |
//! | [`scene`], [`effects`] | a scene as data, the readers of its files (TOML, PLY, OBJ), and the effects that it needs |
//! | [`message`] | values as bytes, for other programs |
//! | [`kit`], [`worker`] | the list of student functions, the door through which they are called, and the process that answers for a kit |
//! | [`world`] | the scene flattened into primitives |
//! | [`course`], [`rubric`] | points, titles and hints of the checks, and what a course changes in them |
//! | [`tracer`], [`frame`] | the renderer, its tiles and threads, and the progress of a frame |
//!
//! The files stand in folders by floor, and use files of their own floor and of lower ones; `tests/floors.rs` lists the floors.
//!
//! # Conventions
//!
//! Lengths are in world units, angles in radians unless a name says degrees, times in `0..=1` of the interval
//! in which nodes move. Colours are red, green and blue in linear light unless a name says encoded. A ray's
//! `t` counts lengths of its direction, which need not be of unit length. A range of `t` is open at both
//! ends; a box is closed. Coordinates are right-handed, and the anticlockwise side of a triangle is its
//! front.

pub mod camera;
pub mod count;
pub mod course;
mod files;
mod geometry;
pub mod kit;
mod light;
pub mod message;
mod progress;
pub mod tracer;
mod trees;
pub mod world;

pub use camera::{film, rows, samples as random};
pub use course::rubric;
pub use geometry::{aabb, mesh, ray, rounding, shape};
pub use kit::worker;
pub use light::{emitter, material, path_step as light_path};
pub use scene::effects;
pub use trees::{bvh, graph, partition, wide};

/// A scene as data: film, camera, lights, materials, meshes and the scene graph; and the readers of its files.
///
/// [`load`](scene::load) reads a scene from a TOML file and checks it. A scene that [`load::load`](scene::load::load) returns holds
/// everything that a frame needs: all its indices are in range, and its graph has no cycle.
pub mod scene {
    #[path = "mod.rs"]
    mod data;

    pub use crate::files::{error, obj, ply, scene as load};
    pub use data::*;
}

/// The frame driver, and the progress that it reports.
pub mod frame {
    pub use crate::progress::{Tile, Unwatched, Watch};
    pub use crate::tracer::driver::{CameraSample, FrameSettings, render};
}

#[cfg(test)]
mod tests {
    mod floors;
    pub mod folder;
}
