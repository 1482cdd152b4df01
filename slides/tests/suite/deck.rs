//! The decks of slides.

pub use raykata_cli::slides::{self, Deck};
use std::path::{Path, PathBuf};

/// The root of the kit.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("slides/ is in a folder").to_path_buf()
}

/// Whether Marp, which builds pages, is to run: with `CI_LONG=1`, if it is installed. The output says what is missing.
pub fn runs_marp() -> bool {
    if std::env::var_os("CI_LONG").is_none() {
        println!("skipped: run only with CI_LONG=1");
        return false;
    }
    let is_installed = root().join("slides/node_modules/@marp-team/marp-cli/marp-cli.js").is_file();
    if !is_installed {
        eprintln!("SKIPPED: Marp is not installed: npm ci --prefix slides");
    }
    is_installed
}

/// All decks, in the order of the course.
pub fn decks() -> Vec<Deck> {
    slides::decks(&root().join("slides")).unwrap()
}
