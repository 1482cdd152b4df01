//! The harmless changes, each reviewed by a person: tests/corpus/harmless.toml.

use super::Change;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::path::Path;

/// Changes of one line, and why they are harmless.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Review {
    /// A file of tests/checks.
    pub file: String,
    /// The original line.
    pub was: String,
    /// The changed lines.
    pub becomes: Vec<String>,
    /// The reason why no check or entry can notice.
    pub because: String,
}

/// All reviewed changes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reviewed {
    /// In the order of the files.
    #[serde(default)]
    pub change: Vec<Review>,
}

impl Reviewed {
    /// Reads a list of the kit at `root`.
    pub fn read(root: &Path, list: &str) -> Result<Reviewed> {
        let file = root.join(list);
        let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        toml::from_str(&text).with_context(|| file.display().to_string())
    }

    /// Why nothing can notice this change, if it is one of them.
    pub(super) fn reason(&self, change: &Change) -> Option<&str> {
        let review = self.change.iter().find(|review| {
            change.file.ends_with(&format!("/{}", review.file))
                && review.was.trim() == change.was
                && review.becomes.iter().any(|line| line.trim() == change.becomes)
        });
        review.map(|review| review.because.as_str())
    }
}
