//! Geometry as data: rays with an open range of `t`, closed boxes, shapes and indexed meshes, what their tests answer,
//! and bounds on rounding errors.

pub mod aabb;
pub mod hit;
pub mod mesh;
pub mod ray;
pub mod rounding;
pub mod shape;
pub(crate) mod triangulate;
