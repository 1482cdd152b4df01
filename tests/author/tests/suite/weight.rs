//! What comes in takes something out: the lines of Rust are bounded.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The most lines of Rust in the repository. It rose from 133,732 with tables of learning platforms, samplers that are judged in every
/// part of their range, diagnoses, and a grader that refuses less. What comes in from here takes something out.
const MOST_LINES: usize = 131_972;

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

/// The doc comment above each function of a text: its words with everything, those without the paragraph `Source:` and without
/// signs, and the line of the function.
fn docs(text: &str, functions: &str) -> Vec<(usize, usize, String)> {
    let (mut doc, mut found) = (String::new(), Vec::new());
    for line in text.lines().map(str::trim) {
        if let Some(line) = line.strip_prefix("///") {
            doc += &format!("{}\n", line.trim());
        } else if !line.starts_with("#[") {
            // The number of an item is no word of the contract.
            let is_word =
                |word: &&str| word.strip_suffix('.').is_none_or(|number| number.parse::<u8>().is_err());
            let own = doc.split("\n\n").filter(|paragraph| !paragraph.starts_with("Source:"));
            let words = own.flat_map(str::split_whitespace).filter(is_word);
            let words = words.filter(|word| word.contains(char::is_alphanumeric));
            if line.contains(functions) {
                found.push((doc.split_whitespace().count(), words.count(), line.to_owned()));
            }
            doc.clear();
        }
    }
    found
}

/// A student reads the doc comments of exercises before the first line of code: the median has at most 80 words, the longest
/// 180 with its source, and all together 11,500.
#[test]
fn doc_comments_of_exercises_are_short() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |file| std::fs::read_to_string(file).expect("a file of the kit");
    let exercises = std::fs::read_dir(root.join("exercises/src")).expect("exercises").flatten();
    let exercises = exercises.flat_map(|file| docs(&read(file.path()), "pub fn ")).collect();
    for (whose, mut docs) in
        [("exercises", exercises), ("list.rs", docs(&read(root.join("src/kit/list.rs")), " fn "))]
    {
        docs.sort();
        let (longest, total) =
            (docs.last().expect("a function"), docs.iter().map(|doc| doc.1).sum::<usize>());
        let median = docs[docs.len() / 2].1;
        let found =
            format!("{whose}: {} functions, median {median} words, {total} in all, {longest:?}", docs.len());
        println!("{found}");
        assert!(docs.len() > 120 && median <= 80 && longest.0 <= 180 && total <= 11_500, "{found}");
    }
}
