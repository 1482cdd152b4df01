//! `author corpus import`: adds the patches of a course to the corpus.
//!
//! A patch is the output of `diff -u` below a header, in `FOLDER/wrong/stageN/NAME.patch` or `FOLDER/right/stageN/NAME.patch`.
//! Its lines that go and come are kept. Lines around them are kept only until the place is unique within its function.

use super::entry::{
    ANYWHERE, Change, Claim, CorpusFile, Entry, Original, Sign, corpus_file, read_files, write_file,
};
use super::patch::{self, Hunk};
use anyhow::{Context, Result, bail, ensure};
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// `author corpus import`.
pub static SPEC: Spec = Spec {
    name: "author corpus import",
    about: "Add the patches of a course to tests/corpus.",
    arguments: &[Argument::required(
        "FOLDER",
        "The folder of the patches: wrong/stageN/NAME.patch and right/stageN/NAME.patch.",
    )],
    options: &[&[
        Opt::value(
            "--renames",
            "FILE",
            "A TOML file with a table `words` of lines OLD = \"NEW\", and a table `files` of lines \"OLD\" = [\"NEW\"], for \
             patches of an older version. tests/corpus/renames.toml lists the names that changed in the kit.",
        ),
        Opt::flag("--check", "Print what would be done, and write nothing."),
    ]],
};

/// The options of `author corpus import`.
pub struct ImportOptions {
    folder: PathBuf,
    renames: Renames,
    check: bool,
}

impl ImportOptions {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<ImportOptions, Misuse> {
        let renames = match given.path("--renames") {
            Some(file) => Renames::read(&file).map_err(|error| Misuse::new(format!("{error:#}")))?,
            None => Renames::default(),
        };
        Ok(ImportOptions { folder: given.required(0)?.into(), renames, check: given.has("--check") })
    }
}

/// Identifiers and files that have other names now.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Renames {
    /// A name that ends with `(` is that of a function only.
    #[serde(default)]
    words: BTreeMap<String, String>,
    /// A file that was split has several names.
    #[serde(default)]
    files: BTreeMap<String, Vec<String>>,
}

impl Renames {
    fn read(file: &Path) -> Result<Renames> {
        let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
        toml::from_str(&text).with_context(|| file.display().to_string())
    }

    /// Returns a line with the names of today.
    fn line(&self, line: &str) -> String {
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let mut renamed = String::new();
        let mut rest = line;
        while let Some(start) = rest.find(is_part) {
            let word = &rest[start..];
            let end = word.find(|letter| !is_part(letter)).unwrap_or(word.len());
            let called = word[end..].starts_with('(').then(|| self.words.get(&word[..=end])).flatten();
            renamed += &rest[..start];
            renamed += match (called, self.words.get(&word[..end])) {
                (Some(new), _) => new.trim_end_matches('('),
                (None, Some(new)) => new,
                (None, None) => &word[..end],
            };
            rest = &word[end..];
        }
        renamed + rest
    }
}

/// Adds the patches. Returns whether all of them fit.
pub fn run(root: &Path, options: &ImportOptions) -> Result<bool> {
    let mut files: BTreeMap<String, CorpusFile> = read_files(root)?.into_iter().collect();
    let (mut added, mut lost) = (0, 0);
    for kind in ["wrong", "right"] {
        for (place, file) in patches(&options.folder.join(kind))? {
            let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
            match imported(root, kind, &place, &text, &options.renames) {
                Ok((name, entry)) => {
                    let corpus = files.entry(name).or_default();
                    let is_known = |other: &Entry| other.name == entry.name && other.kind() == entry.kind();
                    ensure!(
                        !corpus.entries.iter().any(is_known),
                        "{}: {} has an entry of this name",
                        file.display(),
                        corpus_file(&entry.file)
                    );
                    corpus.entries.push(entry);
                    added += 1;
                }
                Err(error) => {
                    println!("{}: {error:#}\n", file.display());
                    lost += 1;
                }
            }
        }
    }
    if !options.check {
        for (name, corpus) in &mut files {
            write_file(root, name, corpus)?;
        }
    }
    println!("{added} patches fit, {lost} do not");
    if added > 0 && !options.check {
        println!("next: `cargo run -p author -- corpus --bless`");
    }
    Ok(lost == 0)
}

/// The patches in the folders stage1, stage2, …, with their stages and names.
fn patches(folder: &Path) -> Result<Vec<(String, PathBuf)>> {
    let mut found = Vec::new();
    let list = |folder: &Path| -> Result<Vec<PathBuf>> {
        let read = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
        let mut files = read.map(|entry| Ok(entry?.path())).collect::<Result<Vec<PathBuf>>>()?;
        files.sort();
        Ok(files)
    };
    if !folder.exists() {
        return Ok(found);
    }
    for stage in list(folder)?.into_iter().filter(|path| path.is_dir()) {
        for file in list(&stage)? {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            match name.strip_suffix(".patch") {
                Some(name) => found.push((name.to_owned(), file)),
                None => bail!("{}: patches are files NAME.patch", file.display()),
            }
        }
    }
    Ok(found)
}

/// Makes an entry of a patch. Returns it with the name of its file of the corpus.
fn imported(root: &Path, kind: &str, name: &str, text: &str, renames: &Renames) -> Result<(String, Entry)> {
    let start = if text.starts_with("--- ") { Some(0) } else { text.find("\n--- ").map(|at| at + 1) };
    let start = start.context("there is no difference after the header (a line `--- a/…`)")?;
    let (header, diff) = text.split_at(start);
    let file = diff.lines().find_map(|line| line.strip_prefix("+++ b/"));
    let file = file.context("there is no line `+++ b/solutions/src/…`")?.trim();
    let hunks = patch::hunks(diff, |line| renames.line(line))?;
    // A file that was split has several names: try each.
    let files = renames.files.get(file).cloned().unwrap_or_else(|| vec![file.to_owned()]);
    let mut errors = Vec::new();
    for file in files {
        let original = Original::read(root, &file)?;
        match hunks.iter().map(|hunk| changes(hunk, &original)).collect::<Result<Vec<_>>>() {
            Ok(changes) => {
                let name_of_file =
                    file.trim_start_matches("solutions/src/").trim_end_matches(".rs").to_owned();
                let text = written(kind, name, header, changes.concat())?;
                let corpus = CorpusFile::parse(&name_of_file, &text)?;
                let entry = corpus.entries.into_iter().next().context("the patch changes nothing")?;
                entry.apply(&original)?;
                return Ok((name_of_file, entry));
            }
            Err(error) => errors.push(format!("{error:#}")),
        }
    }
    bail!("{}", errors.join("; "))
}

/// The text of a file of the corpus with one entry. The key `trap` of older patches is left out.
fn written(kind: &str, name: &str, header: &str, changes: Vec<Change>) -> Result<String> {
    let lines = || header.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let is_title = |line: &&str| line.starts_with("mistake:") || line.starts_with("method:");
    let (_, title) = lines()
        .find(is_title)
        .and_then(|line| line.split_once(':'))
        .context("the header lacks a line `mistake: …` or `method: …`")?;
    let keys = lines().filter(|line| !is_title(line) && !line.starts_with("trap:"));
    let keys: String = keys.map(|line| format!("{line}\n")).collect();
    let entry = Entry {
        stage: 0,
        name: name.to_owned(),
        title: title.trim().to_owned(),
        claim: Claim::Right,
        file: String::new(),
        changes,
    };
    let text = CorpusFile { about: String::new(), entries: vec![entry] }.text();
    let first = format!("\nright {name}: {}\n", title.trim());
    let with_keys = format!("\n{kind} {name}: {}\n{keys}", title.trim());
    Ok(text.replacen(&first, &with_keys, 1))
}

/// The changes of a part of a patch, each with the fewest lines around it that make its place unique.
fn changes(hunk: &Hunk, original: &Original) -> Result<Vec<Change>> {
    let lines: Vec<&str> = original.text.lines().collect();
    let start = hunk.find(&lines)?;
    // Divide the lines into runs that change, between which two or more lines stay.
    let mut changes = Vec::new();
    let is_change = |at: usize| hunk.lines.get(at).is_some_and(|(sign, _)| *sign != Sign::Stays);
    let mut at = 0;
    let mut line = start;
    while at < hunk.lines.len() {
        if !is_change(at) {
            (at, line) = (at + 1, line + 1);
            continue;
        }
        let mut end = at;
        while is_change(end) || (is_change(end + 1) && !hunk.lines[end].1.trim().is_empty()) {
            end += 1;
        }
        let run = &hunk.lines[at..end];
        let old = run.iter().filter(|(sign, _)| *sign != Sign::Comes).count();
        changes.push(located(original, &lines, line..line + old, run)?);
        (at, line) = (end, line + old);
    }
    Ok(changes)
}

/// A change of these lines of a file.
fn located(original: &Original, lines: &[&str], at: Range<usize>, run: &[(Sign, String)]) -> Result<Change> {
    let byte = |line: usize| lines[..line].iter().map(|line| line.len() + 1).sum::<usize>();
    let around = |line: usize| original.source.around(byte(line) + lines[line].len().saturating_sub(1));
    let has_text = |line: usize| lines.get(line).is_some_and(|text| !text.trim().is_empty());
    // Add lines that stay, on either side, until the place is unique. A place needs at least one line that is there already.
    let (mut first, mut last) = (at.start, at.end);
    loop {
        if first < last {
            let function = around(first)
                .filter(|function| around(last - 1).is_some_and(|other| other.whole == function.whole));
            let name = function.map_or(ANYWHERE, |function| &function.name);
            let place = original.place(name)?;
            if original.occurrences(place, &lines[first..last]).len() == 1 {
                let stays =
                    |range: Range<usize>| lines[range].iter().map(|line| (Sign::Stays, (*line).to_owned()));
                let lines =
                    stays(first..at.start).chain(run.iter().cloned()).chain(stays(at.end..last)).collect();
                return Ok(Change { function: name.to_owned(), lines });
            }
        }
        // Prefer the side with fewer added lines, and a line with text.
        let (above, below) = (at.start - first, last - at.end);
        let can_rise = first > 0;
        let can_fall = last < lines.len();
        match () {
            () if can_fall
                && (below <= above || !can_rise)
                && (has_text(last) || !can_rise || !has_text(first - 1)) =>
            {
                last += 1
            }
            () if can_rise => first -= 1,
            () if can_fall => last += 1,
            () => bail!("the place is not unique"),
        }
        // A place must not begin or end with an empty line, which would not be seen.
        while first < at.start && !has_text(first) && first > 0 {
            first -= 1;
        }
        while last > at.end && !has_text(last - 1) && last < lines.len() {
            last += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_today() {
        let words = [("ball", "sphere"), ("mirror(", "reflect(")];
        let words = words.map(|(old, new)| (old.to_owned(), new.to_owned())).into();
        let renames = Renames { words, files: BTreeMap::new() };
        assert_eq!(renames.line("let ball = mirror(balls.mirror);"), "let sphere = reflect(balls.mirror);");
    }

    #[test]
    fn a_patch_keeps_the_lines_around_it_that_make_it_unique() {
        let text = "fn one() {\n    a();\n    b();\n    a();\n}\n\nfn two() {\n    a();\n}\n";
        let original = Original::new("solutions/src/stage1_a.rs", text.to_owned()).unwrap();
        let diff = "--- a/x\n+++ b/x\n@@ -2,3 +2,3 @@\n     a();\n     b();\n-    a();\n+    c();\n }\n@@ -8 +8,2 @@\n fn two() {\n+    d();\n     a();\n";
        let hunks = patch::hunks(diff, str::to_owned).unwrap();
        let changes = hunks.iter().map(|hunk| changes(hunk, &original).unwrap()).collect::<Vec<_>>().concat();
        let text =
            written("wrong", "n", "mistake: it is so\ntrap: X\ncaught_by: c\nsays: s\n", changes).unwrap();
        assert_eq!(
            text,
            "\n=== one ===\n\nwrong n: it is so\ncaught_by: c\nsays: s\n-    a();\n+    c();\n }\n@ two\n+    d();\n     a();\n"
        );
    }
}
