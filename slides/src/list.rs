//! `slides/figures.toml`: which figures the slides have, and how each is made.

use anyhow::{Context, Result};
use serde::Deserialize;
use std::path::Path;

/// A figure of the slides.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Its file in `slides/figures`.
    pub file: String,
    /// The deck that shows it, such as `stage03`.
    pub deck: String,
    /// What is seen, in words.
    #[allow(dead_code, reason = "for readers of the list")]
    pub shows: String,
    /// The command that makes it. If it is not `raykata figures NAME`, the option `--out` is added.
    pub command: String,
    /// The file to take, for a command that writes a folder.
    pub take: Option<String>,
    /// What of it is the same on every machine.
    pub exact: Exact,
}

/// What `raykata figures --check` compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Exact {
    /// Every byte.
    All,
    /// Every pixel of a picture.
    Pixels,
    /// Nothing, because it shows times. It is made only by its name.
    Nothing,
}

#[derive(Deserialize)]
struct Listed {
    figures: Vec<Figure>,
}

impl Figure {
    /// The name of the file without its ending.
    pub fn name(&self) -> &str {
        self.file.rsplit_once('.').map_or(&self.file, |(name, _)| name)
    }
}

/// The figures of the kit at `root`.
pub fn read(root: &Path) -> Result<Vec<Figure>> {
    let file = root.join("slides/figures.toml");
    let text = std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    let listed: Listed =
        toml::from_str(&text).with_context(|| format!("{} is not a list of figures", file.display()))?;
    Ok(listed.figures)
}
