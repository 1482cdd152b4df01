//! Resets a function to the text that it had before it was written. The old file is kept.

use anyhow::{Context, Result, anyhow};
use live::files::new_folder;
use live::functions::{name_in, replaced, span, stubs};
use raykata_cli::report::write_file;
use std::fs;
use std::path::{Path, PathBuf};

/// The function that begins at `line` of a file or contains it; lines begin at 1.
pub fn function_at(text: &str, line: u32) -> Option<String> {
    let above: Vec<&str> = text.lines().take(line as usize).collect();
    above.into_iter().rev().find_map(|line| name_in(line).map(str::to_owned))
}

/// Resets the function `name` in `file`, a path from `root`. Returns where the old text of the file is kept.
pub fn reset(root: &Path, file: &str, name: &str) -> Result<PathBuf> {
    // Find the untouched text.
    let stubs = stubs(root)?;
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let stub = stubs.get(&stem).and_then(|file| file.get(name));
    let stub = stub.ok_or_else(|| anyhow!("`{name}` is no exercise, so it has no first text"))?;
    // Replace the function, and keep the old file.
    let path = root.join(file);
    let old = fs::read_to_string(&path).with_context(|| format!("{} cannot be read", path.display()))?;
    let new = with_stub(&old, name, stub)?;
    let kept = new_folder(root, "before-reset")?.join(format!("{stem}.rs"));
    write_file(&kept, old.as_bytes())?;
    write_file(&path, new.as_bytes())?;
    Ok(kept)
}

/// The text with `stub` in place of the function `name`.
fn with_stub(text: &str, name: &str, stub: &str) -> Result<String> {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    Ok(replaced(&lines, span(&lines, name)?, stub))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "/// One.\n#[inline]\npub fn one(a: f32) -> f32 {\n    if a > 0.0 {\n        1.0\n    }\n}\n\npub fn two() {}\n\n/// Three.\npub fn three() {\n    3\n}\n";
    const STUB: &str = "pub fn one(a: f32) -> f32 {\n    todo!(\"write it\")\n}\n";

    #[test]
    fn only_the_function_changes() {
        let new = with_stub(TEXT, "one", STUB).unwrap();
        let expected = TEXT.replace("    if a > 0.0 {\n        1.0\n    }\n", "    todo!(\"write it\")\n");
        assert_eq!(new, expected);
    }

    #[test]
    fn a_function_whose_end_is_not_sure_is_left_alone() {
        assert!(with_stub(TEXT, "two", STUB).unwrap_err().to_string().contains("the end of `two`"));
        assert!(with_stub(TEXT, "four", STUB).unwrap_err().to_string().contains("no `pub fn four`"));
        assert!(with_stub("pub fn one() {\n  1 }\n", "one", STUB).is_err());
    }

    #[test]
    fn the_function_of_a_line_is_the_one_above() {
        assert_eq!(function_at(TEXT, 3).as_deref(), Some("one"));
        assert_eq!(function_at(TEXT, 6).as_deref(), Some("one"));
        assert_eq!(function_at(TEXT, 12).as_deref(), Some("three"));
        assert_eq!(function_at(TEXT, 1), None);
    }

    #[test]
    fn the_old_file_is_kept_each_time() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        fs::create_dir_all(at("exercises/src")).unwrap();
        fs::create_dir_all(at("tests")).unwrap();
        fs::write(at("tests/stubs.toml"), format!("[stage1_a]\none = '''\n{STUB}'''\n")).unwrap();
        let file = "exercises/src/stage1_a.rs";
        fs::write(at(file), TEXT).unwrap();
        let kept = reset(root.path(), file, "one").unwrap();
        assert_eq!(kept, at("out/before-reset-1/stage1_a.rs"));
        assert_eq!(fs::read_to_string(kept).unwrap(), TEXT);
        assert!(fs::read_to_string(at(file)).unwrap().contains(STUB));
        assert_eq!(reset(root.path(), file, "one").unwrap(), at("out/before-reset-2/stage1_a.rs"));
        assert!(reset(root.path(), file, "three").is_err(), "no exercise");
    }
}
