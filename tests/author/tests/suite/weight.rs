//! What comes in takes something out: the lines of Rust are bounded.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The most lines of Rust in the repository. It rose from 130,471 with what files, `cost`, hard cases and scenes can do since then,
/// with numbers of documents that are made, and, by 711, with comments of exercises and solutions at 100 columns and `raykata try`.
const MOST_LINES: usize = 134_637;

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

/// The words of the doc comment above each function of a text, by its name. A paragraph that begins with `Source:` does not
/// count, and a sign is no word.
fn words_of_docs(text: &str, functions: &str) -> Vec<(String, usize)> {
    let mut doc = String::new();
    let mut found = Vec::new();
    for line in text.lines().map(str::trim) {
        if let Some(line) = line.strip_prefix("///") {
            doc += &format!("{}\n", line.trim());
        } else if !line.starts_with("#[") {
            if let Some((_, rest)) = line.split_once(functions) {
                let counted = doc.split("\n\n").filter(|paragraph| !paragraph.starts_with("Source:"));
                let words = counted.flat_map(str::split_whitespace);
                let n_words = words.filter(|word| word.contains(char::is_alphanumeric)).count();
                let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
                found.push((
                    rest.split(|letter| !is_name(letter)).next().unwrap_or_default().to_owned(),
                    n_words,
                ));
            }
            doc.clear();
        }
    }
    found
}

/// A student reads the doc comments of exercises before the first line of code: the median has at most 80 words, the longest
/// 180, and all together 11,500.
#[test]
fn doc_comments_of_exercises_are_short() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let files = std::fs::read_dir(root.join("exercises/src")).expect("exercises").flatten();
    let exercises = files.flat_map(|file| {
        let text = std::fs::read_to_string(file.path()).expect("a file of exercises");
        words_of_docs(&text, "pub fn ")
    });
    let list = std::fs::read_to_string(root.join("src/kit/list.rs")).expect("the list of functions");
    let (_, list) = list.split_once("macro_rules! student_functions").expect("the list");
    for (whose, mut docs) in
        [("exercises/src", exercises.collect()), ("src/kit/list.rs", words_of_docs(list, " fn "))]
    {
        let n_words = |docs: &[(String, usize)]| docs.iter().map(|(_, words)| words).sum::<usize>();
        assert!(docs.len() > 120, "{whose}: only {} functions are found", docs.len());
        docs.sort_by_key(|(_, words)| *words);
        let (median, longest, total) = (docs[docs.len() / 2].1, &docs[docs.len() - 1], n_words(&docs));
        println!("{whose}: median {median} words, longest {longest:?}, {total} in {} functions", docs.len());
        assert!(median <= 80, "{whose}: the median doc comment has {median} words, at most 80");
        assert!(
            longest.1 <= 180,
            "{whose}: the doc comment of `{}` has {} words, at most 180",
            longest.0,
            longest.1
        );
        assert!(total <= 11_500, "{whose}: the doc comments have {total} words, at most 11,500");
    }
}
