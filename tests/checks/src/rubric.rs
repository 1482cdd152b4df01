//! The rubric, which `raykata::rubric` reads.

pub use raykata::rubric::*;
