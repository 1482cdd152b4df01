//! The gauntlet: many methods against many distributions, judged by the exact oracle. Here accuracy shows its price.
//!
//! `distributions` (inputs) · `methods` and `printed` (ways to intersect) · `meshes` (closed ones) · `boxes` · `scenes` (hard to search) · `table` (wrong
//! answers) · `leaks` (rays that escape)

pub mod boxes;
pub mod distributions;
pub mod leaks;
pub mod meshes;
pub mod methods;
mod printed;
pub mod scenes;
pub mod table;
