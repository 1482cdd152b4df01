//! What surfaces and lights are made of: materials, emitters, the background, and the steps of a path.

pub(crate) mod background;
pub mod emitter;
pub mod material;
pub mod path_step;
pub(crate) mod surface;
