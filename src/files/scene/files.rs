//! Files that a scene names: their paths, and the messages if they are missing.

use super::reader::{NO_BACKSLASHES, Value};
use crate::files::error::LoadError;
use crate::files::words::{nearest, quoted};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The path of the file that `value` names, relative to the folder of the scene; fails if it does not exist,
/// is a folder or cannot be read.
pub(super) fn find(value: Value) -> Result<PathBuf, LoadError> {
    let name = value.text()?;
    let path = value.source.file.parent().unwrap_or(Path::new("")).join(name);
    let trouble = match std::fs::metadata(&path) {
        Ok(found) if found.is_dir() => value.error(format!("{} is a folder, not a file", quoted(name))),
        Ok(_) => return Ok(path),
        // In `"C:\temp"` the escape is a tab.
        Err(_) if name.contains(char::is_control) => value
            .error(format!("the file name {} contains a control character", quoted(name)))
            .help(NO_BACKSLASHES),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            value.error(format!("there is no file {}", quoted(name))).help(where_it_might_be(&path))
        }
        Err(error) => value.error(format!("cannot read {}: {error}", quoted(name))),
    };
    Err(trouble)
}

/// The advice for a file that does not exist: the path that was tried, and a file in the same folder with a
/// similar name.
pub(super) fn where_it_might_be(path: &Path) -> String {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let Ok(entries) = std::fs::read_dir(folder) else {
        return format!("looked for {}, and there is no folder {}", path.display(), folder.display());
    };
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort(); // a folder lists its files in an arbitrary order
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    // Compare the names without extensions, which make any two short names similar.
    let stem = |name: &str| Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    names.retain(|name| nearest(&stem(&wanted), [stem(name).as_str()]).is_some());
    match nearest(&wanted, names.iter().map(String::as_str)) {
        Some(meant) => format!("looked for {}; did you mean {}?", path.display(), quoted(meant)),
        None => format!("looked for {}", path.display()),
    }
}

/// The extension of `path` in lower case and without the dot; empty if it has none.
pub(super) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
