//! The scaffold of Raykata: everything around the exercises and nothing that answers one.

pub mod aabb;
pub mod building;
pub mod bvh;
pub mod camera;
pub mod count;
pub mod effects;
pub mod film;
pub mod frame;
pub mod graph;
pub mod kit;
pub mod material;
pub mod mesh;
pub mod partition;
pub mod random;
pub mod ray;
pub mod rubric;
pub mod scene;
pub mod shape;
pub mod tracer;
pub mod worker;
pub mod world;
