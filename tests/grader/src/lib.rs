//! The parts of the tool, so that tests and benchmarks can reach them. The program is `main.rs`.

pub mod cases;
pub mod check;
pub mod compare;
pub mod corpus;
pub mod explain;
pub mod gaps;
pub mod gauntlet;
pub mod generate;
#[cfg(target_os = "linux")]
pub mod grade;
pub mod jail;
pub mod kits;
pub mod knobs;
pub mod mutants;
pub mod pictures;
pub mod queue;
pub mod render;
pub mod report;
pub mod strip;
pub mod sync;
pub mod tree;
pub mod worker;
