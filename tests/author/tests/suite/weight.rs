//! What comes in takes something out: the lines of Rust are bounded.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The most lines of Rust in the repository. It rose from 130,471 with what files, `cost`, hard cases and scenes can do since then,
/// and with numbers of documents that are made.
const MOST_LINES: usize = 133_926;

#[test]
fn what_comes_in_takes_something_out() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let listed = Command::new("git").args(["ls-files", "*.rs"]).current_dir(&root).output();
    let Some(listed) = listed.ok().filter(|listed| listed.status.success()) else {
        return println!("this is no checkout, whose files could be listed");
    };
    // Count the lines and files of each folder, and of those below `src` and `tests`.
    let mut folders: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for file in String::from_utf8(listed.stdout).expect("names of files").lines() {
        let Ok(text) = std::fs::read_to_string(root.join(file)) else { continue };
        let n_parts = if file.starts_with("src/") || file.starts_with("tests/") { 2 } else { 1 };
        let folder = file.split('/').take(n_parts).collect::<Vec<_>>().join("/");
        let (lines, files) = folders.entry(folder).or_default();
        (*lines, *files) = (*lines + text.lines().count(), *files + 1);
    }
    let table: Vec<String> =
        folders.iter().map(|(folder, (lines, files))| format!("{lines:>7} {files:>4} {folder}")).collect();
    let n_lines: usize = folders.values().map(|(lines, _)| lines).sum();
    println!("  lines files\n{}\n{n_lines:>7} lines of Rust", table.join("\n"));
    assert!(
        n_lines <= MOST_LINES,
        "{n_lines} lines of Rust, at most {MOST_LINES}: what comes in takes something out (CONTRIBUTING.md)"
    );
}
