//! The gauntlet: hard inputs for intersection methods, judged by the exact oracle.
//!
//! `distributions` (rays and triangles) · `meshes` and `families` (closed meshes) · `boxes` · `scenes` (hard to search) ·
//! `job` (frames of triangles) · `table` (wrong answers) · `leaks` (rays that leave a closed mesh)

pub mod boxes;
pub mod distributions;
pub mod families;
pub mod job;
pub mod leaks;
pub mod meshes;
pub mod scenes;
pub mod table;
