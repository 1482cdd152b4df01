//! Collects the Rust code of the slides, so that the tests compile it.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=.");
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let mut files: Vec<PathBuf> = fs::read_dir(&folder)
        .expect("the folder of the slides")
        .map(|file| file.expect("a file of this folder").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .collect();
    files.sort();
    let code: String = files.iter().map(|file| modules(file)).collect();
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("code.rs"), code).expect("cargo made this folder");
}

/// A module for each block of this file that is Rust and not a signature, with the line at which the block begins.
fn modules(file: &Path) -> String {
    let text = fs::read_to_string(file).expect("a text");
    let deck = file.file_stem().expect("a name").to_string_lossy();
    let mut modules = String::new();
    let mut inside = false;
    for (line, number) in text.lines().zip(1..) {
        match (inside, line) {
            (false, "```rust") => {
                let _ =
                    writeln!(modules, "mod {deck}_line_{number} {{\n#[allow(unused_imports)] use super::*;");
                inside = true;
            }
            (true, "```") => {
                modules.push_str("}\n");
                inside = false;
            }
            (true, line) => {
                let _ = writeln!(modules, "{line}");
            }
            (false, _) => {}
        }
    }
    modules
}
