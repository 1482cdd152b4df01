//! What a folder with a kit holds: its version and its files, as `grader handout` lists them.

use anyhow::{Context, Result, bail};
use live::functions::{Stubs, stubs};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The list of the kit's files.
const LIST: &str = "tests/kit.toml";

#[derive(Deserialize)]
struct List {
    version: String,
    files: BTreeSet<String>,
}

/// A student's kit.
pub struct Kit {
    pub root: PathBuf,
    pub version: Version,
    /// The paths of its files. Those of a kit that was made before there was a list are not known.
    pub files: BTreeSet<String>,
    pub stubs: Stubs,
}

/// A version such as 1.2.3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version([u64; 3]);

impl std::fmt::Display for Version {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [major, minor, patch] = self.0;
        write!(out, "{major}.{minor}.{patch}")
    }
}

impl Version {
    fn read(text: &str) -> Option<Version> {
        let mut numbers = text.split('.').map(|part| part.parse().ok());
        let version = [numbers.next()??, numbers.next()??, numbers.next()??];
        numbers.next().is_none().then_some(Version(version))
    }
}

impl Kit {
    /// Reads the new kit that an instructor has handed out.
    pub fn handed_out(root: &Path) -> Result<Kit> {
        let Some((version, files)) = read_list(root)? else {
            bail!(
                "{} is no hand-out of this kit, because it has no {LIST}: unpack the new hand-out, and name its folder",
                root.display()
            );
        };
        Ok(Kit { root: root.to_owned(), version, files, stubs: stubs(root)? })
    }

    /// Reads the kit of a student.
    /// An error if it is the complete kit of an author.
    pub fn of_student(root: &Path) -> Result<Kit> {
        if root.join("solutions").is_dir() {
            bail!("{} is the complete kit, which is updated by its version control", root.display());
        }
        let (version, files) = read_list(root)?.unwrap_or((Version([0; 3]), BTreeSet::new()));
        Ok(Kit { root: root.to_owned(), version, files, stubs: stubs(root)? })
    }
}

/// The version and the files of a kit, if it has a list.
fn read_list(root: &Path) -> Result<Option<(Version, BTreeSet<String>)>> {
    let file = root.join(LIST);
    let text = match fs::read_to_string(&file) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error).with_context(|| format!("{} cannot be read", file.display())),
    };
    let list: List = toml::from_str(&text).with_context(|| format!("{} is malformed", file.display()))?;
    let version = Version::read(&list.version)
        .with_context(|| format!("{}: `{}` is no version such as 1.2.3", file.display(), list.version))?;
    // A path that leads out of the kit would write anywhere.
    let is_below =
        |path: &&String| Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
    if let Some(path) = list.files.iter().find(|path| !is_below(path)) {
        bail!("{}: `{path}` is no path below the kit", file.display());
    }
    Ok(Some((version, list.files)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_ordered_by_their_numbers() {
        let versions = ["0.9.9", "0.10.0", "1.0.0", "10.0.0"].map(|text| Version::read(text).unwrap());
        assert!(versions.is_sorted());
        assert_eq!(versions[1].to_string(), "0.10.0");
        assert!(["1.2", "1.2.3.4", "1.2.x", ""].iter().all(|text| Version::read(text).is_none()));
    }
}
