//! The gauntlet: hard inputs for ways to intersect, judged by the exact oracle.
//!
//! `distributions` (inputs) · `meshes` (closed ones) · `boxes` · `scenes` (hard to search) · `table` (wrong answers) ·
//! `leaks` (rays that escape)

pub mod boxes;
pub mod distributions;
pub mod leaks;
pub mod meshes;
pub mod scenes;
pub mod table;
