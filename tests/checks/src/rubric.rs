//! The rubric, as `raykata::rubric` reads it.

pub use raykata::rubric::*;
