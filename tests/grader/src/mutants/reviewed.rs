//! Changes that change nothing anybody could see, each looked at by a person: tests/corpus/equivalent.toml.

use super::list::Mutant;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::path::Path;

/// Changes of one line, and why they change nothing.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Review {
    /// A file of solutions/src.
    pub file: String,
    /// The line as it is.
    pub was: String,
    /// What it may become.
    pub becomes: Vec<String>,
    /// Why nobody can notice.
    pub because: String,
}

/// All of them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reviewed {
    /// In the order of the files.
    #[serde(default)]
    pub change: Vec<Review>,
}

impl Reviewed {
    /// Reads the list of the kit at `root`.
    pub fn read(root: &Path) -> Result<Reviewed> {
        let file = root.join("tests/corpus/equivalent.toml");
        let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        toml::from_str(&text).with_context(|| file.display().to_string())
    }

    /// Whether this change is one of them.
    pub(super) fn has(&self, mutant: &Mutant) -> bool {
        let (was, becomes) = (mutant.was(), mutant.becomes());
        self.change.iter().any(|review| {
            mutant.file.ends_with(&format!("/{}", review.file))
                && review.was.trim() == was
                && review.becomes.iter().any(|line| line.trim() == becomes)
        })
    }
}
