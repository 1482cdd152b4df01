//! The decks of slides.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The root of the kit.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("slides/ is in a folder").to_path_buf()
}

pub struct Deck {
    pub name: String,
    /// The settings at its top.
    pub head: BTreeMap<String, String>,
    pub slides: Vec<String>,
}

impl Deck {
    pub fn stage(&self) -> Option<u8> {
        self.head.get("stage").map(|stage| stage.parse().expect("a number of a stage"))
    }

    pub fn text(&self) -> String {
        self.slides.concat()
    }
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

/// All decks, by name.
pub fn decks() -> Vec<Deck> {
    let mut decks = Vec::new();
    for file in fs::read_dir(root().join("slides")).unwrap().map(|file| file.unwrap().path()) {
        if file.extension().is_none_or(|ending| ending != "md") {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        let Some((head, slides)) =
            text.strip_prefix("---\nmarp: true\n").and_then(|rest| rest.split_once("\n---\n"))
        else {
            continue;
        };
        let pair = |line: &str| {
            let (key, value) = line.split_once(": ").unwrap_or_else(|| panic!("{}: {line}", file.display()));
            (key.to_owned(), value.trim_matches('"').to_owned())
        };
        decks.push(Deck {
            name: file.file_stem().unwrap().to_string_lossy().into_owned(),
            head: head.lines().map(pair).collect(),
            slides: slides.split("\n---\n").map(str::to_owned).collect(),
        });
    }
    decks.sort_by(|a, b| a.name.cmp(&b.name));
    decks
}
