//! Acceleration structures as data, and what a search may ask about them.

pub mod bvh;
pub mod graph;
pub mod partition;
pub mod wide;
