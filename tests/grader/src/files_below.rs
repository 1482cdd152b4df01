//! Lists the files of a folder.

use anyhow::{Context, Result};
use std::fs;
use std::path::Path;

/// Returns the paths below `root` of all files in `path`, or `path` itself if it is a file. The order is that of the names in
/// each folder. Files and folders of which `keeps` is false, and links, are left out.
///
/// # Errors
///
/// If `path` does not exist, a folder cannot be read, or a name is not UTF-8.
pub fn files_below(root: &Path, path: &str, keeps: &dyn Fn(&str) -> bool) -> Result<Vec<String>> {
    let place = root.join(path);
    let kind = fs::symlink_metadata(&place);
    let kind = kind.with_context(|| format!("there is no {}: is this the whole kit?", place.display()))?;
    if !kind.is_dir() {
        return Ok(if kind.is_file() { vec![path.to_owned()] } else { Vec::new() });
    }
    let mut names = Vec::new();
    for entry in fs::read_dir(&place).with_context(|| format!("cannot read {}", place.display()))? {
        let entry = entry?;
        let name = entry.file_name().into_string();
        names.push(name.ok().with_context(|| format!("{} is not UTF-8", entry.path().display()))?);
    }
    names.sort();
    let mut files = Vec::new();
    for name in names {
        let inside = if path.is_empty() { name } else { format!("{path}/{name}") };
        if keeps(&inside) {
            files.extend(files_below(root, &inside, keeps)?);
        }
    }
    Ok(files)
}

/// Returns the last part of a path.
pub fn last_part(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}
