//! The page of the figures that a reader can touch, for `raykata slides`.
//!
//! `slides/touch` draws them. It is compiled to WebAssembly and put into the page, so that the page works from a folder and
//! offline. Without the target of the compiler, the page shows the still figures.

use crate::html::base64;
use crate::kits::run_build;
use crate::report::write_file;
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::Path;
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";

/// Writes `touch.html` to the folder of the decks, and returns the names of its figures; none if this kit has no such figures.
pub fn write_page(root: &Path, out: &Path) -> Result<Vec<String>> {
    let Ok(page) = fs::read_to_string(root.join("slides/touch/page.html")) else { return Ok(Vec::new()) };
    let library = library(root).unwrap_or_else(|problem| {
        eprintln!("figures cannot be touched, and stay still: {problem:#}");
        Vec::new()
    });
    let place = "type=\"text/plain\">";
    let whole = page.replace(place, &format!("{place}{}", base64(&library)));
    write_file(&out.join("touch.html"), whole.as_bytes())?;
    let sections = page.split("<section id=\"").skip(1);
    Ok(sections.filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect())
}

/// Builds the library as WebAssembly.
fn library(root: &Path) -> Result<Vec<u8>> {
    let ask = ["--print", "target-libdir", "--target", TARGET];
    let folder =
        Command::new("rustc").args(ask).current_dir(root).output().context("rustc cannot be started")?;
    if !Path::new(String::from_utf8_lossy(&folder.stdout).trim()).is_dir() {
        bail!("`rustup target add {TARGET}` installs what they need");
    }
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root).args(["rustc", "--package", "touch", "--profile", "touch", "--target", TARGET]);
    cargo.args(["--crate-type", "cdylib"]);
    let file = run_build(cargo, "the library of figures that can be touched")?.path("touch")?;
    fs::read(&file).with_context(|| format!("cannot read {}", file.display()))
}

/// A page of a deck, with a link before each figure that can be touched.
pub fn with_links(deck: String, names: &[String]) -> String {
    names.iter().fold(deck, |deck, name| {
        let image = format!("<img src=\"figures/{name}.svg\"");
        deck.replace(&image, &format!("<a class=\"touch\" href=\"touch.html#{name}\">touch it</a>{image}"))
    })
}
