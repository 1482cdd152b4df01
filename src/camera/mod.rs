//! The camera, the film with its rows, and the samples of a pixel.

pub mod film;
mod pinhole;
pub mod rows;
pub mod samples;

pub use pinhole::{Camera, CameraError, Lens, Shutter};
