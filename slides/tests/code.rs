//! The Rust code of the slides compiles. `build.rs` makes a module of each block.

#![allow(dead_code, missing_docs, clippy::all, reason = "slides show mistakes, too")]

#[allow(unused_imports)]
use glam::*;
#[allow(unused_imports)]
use raykata::*;

include!(concat!(env!("OUT_DIR"), "/code.rs"));

#[test]
fn the_code_of_the_slides_compiles() {
    // It does if this test is reached.
    assert!(include_str!(concat!(env!("OUT_DIR"), "/code.rs")).contains("mod stage01_line_"));
}
