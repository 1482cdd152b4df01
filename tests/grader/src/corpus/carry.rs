//! `grader corpus carry`: updates the patches of the corpus after the files that they change were moved, split or changed.
//!
//! Each patch is applied to the old version of its file. The change is then merged into the new version, and the new
//! difference replaces the patch.

use super::entry::apply;
use anyhow::{Context, Result, bail, ensure};
use diffy::DiffOptions;
use raykata::film::write_atomically;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// `grader corpus carry`.
pub static SPEC: Spec = Spec {
    name: "grader corpus carry",
    about: "Update the patches after files of the solutions were moved, split or changed.",
    arguments: &[Argument::required(
        "FROM",
        "A git revision with the files to which the patches apply, or a folder that holds these files.",
    )],
    options: &[&[
        Opt::value(
            "--moved",
            "OLD=NEW",
            "A file that was moved, as OLD=NEW, from the root of the kit. Name a file that was split once for each \
             part.",
        )
        .many(),
        Opt::value("--word", "OLD=NEW", "An identifier that has another name now, as OLD=NEW.").many(),
        Opt::value(
            "--renames",
            "FILE",
            "A TOML file with more of both: a table `words` of lines OLD = \"NEW\", and a table `files` of lines \
             \"OLD\" = [\"NEW\"]. tests/corpus/renames.toml lists the names that changed in the kit.",
        ),
        Opt::value(
            "--corpus",
            "FOLDER",
            "The folder of the patches, with its subfolders [default: tests/corpus].",
        ),
        Opt::flag("--check", "Print what would be done, and write nothing."),
    ]],
};

/// The options of `grader corpus carry`.
pub struct Options {
    from: String,
    moved: Vec<(String, String)>,
    words: Vec<(String, String)>,
    corpus: PathBuf,
    check: bool,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        let renames = match given.path("--renames") {
            Some(file) => Renames::read(&file).map_err(|error| Misuse::new(format!("{error:#}")))?,
            None => Renames::default(),
        };
        let mut moved = given.repeated("--moved", pair)?;
        let mut words = given.repeated("--word", pair)?;
        for (old, parts) in renames.files {
            moved.extend(parts.into_iter().map(|new| (old.clone(), new)));
        }
        words.extend(renames.words);
        // A function goes before a name of the same spelling.
        words.sort_by_key(|(old, _)| !old.ends_with('('));
        Ok(Options {
            from: given.required(0)?.to_string_lossy().into_owned(),
            moved,
            words,
            corpus: given.path("--corpus").unwrap_or_else(|| "tests/corpus".into()),
            check: given.has("--check"),
        })
    }
}

/// Files that have moved and identifiers that have other names now, as a file lists them.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Renames {
    #[serde(default)]
    words: BTreeMap<String, String>,
    #[serde(default)]
    files: BTreeMap<String, Vec<String>>,
}

impl Renames {
    fn read(file: &Path) -> Result<Renames> {
        let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
        toml::from_str(&text).with_context(|| file.display().to_string())
    }
}

fn pair(text: &str) -> Result<(String, String)> {
    let (old, new) = text.split_once('=').with_context(|| format!("`{text}` is not OLD=NEW"))?;
    ensure!(!old.is_empty() && !new.is_empty(), "`{text}` is not OLD=NEW");
    Ok((old.into(), new.into()))
}

/// The result of updating a patch.
#[derive(Debug, PartialEq)]
enum Carried {
    /// Its file is unchanged.
    Same,
    /// The new text of the patch.
    Anew(String),
    /// The patch no longer applies, for this reason.
    Lost(String),
}

/// Updates all patches. Returns whether all of them still apply.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let corpus = root.join(&options.corpus);
    let mut files = BTreeMap::new();
    let (mut same, mut anew, mut lost) = (0, 0, 0);
    for file in patches(&corpus)? {
        let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        let shown = file.strip_prefix(&corpus).unwrap_or(&file).display();
        let mut old = |path: &str| -> Result<String> {
            if let Some(text) = files.get(path) {
                return Ok(String::clone(text));
            }
            let text = as_it_was(root, &options.from, path)?;
            files.insert(path.to_owned(), text.clone());
            Ok(text)
        };
        let new = |path: &str| fs::read_to_string(root.join(path)).ok();
        let carried = carry(&text, &options.moved, &options.words, &mut old, &new);
        match carried.with_context(|| shown.to_string())? {
            Carried::Same => same += 1,
            Carried::Anew(text) => {
                anew += 1;
                if !options.check {
                    write_atomically(&file, |out| out.write_all(text.as_bytes()))?;
                }
            }
            Carried::Lost(why) => {
                lost += 1;
                println!("{shown}: {why}");
            }
        }
    }
    println!("{same} patches are unchanged, {anew} are updated, {lost} no longer apply");
    Ok(lost == 0)
}

/// Returns all files NAME.patch below a folder, sorted.
fn patches(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(folder) = waiting.pop() {
        for entry in fs::read_dir(&folder).with_context(|| folder.display().to_string())? {
            let path = entry?.path();
            if path.is_dir() {
                waiting.push(path);
            } else if path.extension().is_some_and(|ending| ending == "patch") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Returns the text of a file in a folder or in a git revision.
fn as_it_was(root: &Path, from: &str, path: &str) -> Result<String> {
    if Path::new(from).is_dir() {
        let file = Path::new(from).join(path);
        return fs::read_to_string(&file).with_context(|| file.display().to_string());
    }
    let git = Command::new("git").current_dir(root).args(["show", &format!("{from}:{path}")]).output();
    let output = git.context("git cannot be started")?;
    if !output.status.success() {
        bail!("git has no {path} in {from}: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    String::from_utf8(output.stdout).with_context(|| format!("{path} in {from}"))
}

/// Updates one patch. `old` and `new` return the old and the new version of a file.
fn carry(
    text: &str,
    moved: &[(String, String)],
    words: &[(String, String)],
    old: &mut dyn FnMut(&str) -> Result<String>,
    new: &dyn Fn(&str) -> Option<String>,
) -> Result<Carried> {
    let start = if text.starts_with("--- ") { Some(0) } else { text.find("\n--- ").map(|at| at + 1) };
    let (header, diff) = text.split_at(start.context("the patch has no difference (a line `--- a/…`)")?);
    let named = diff.lines().find_map(|line| line.strip_prefix("+++ b/"));
    let path = named.context("the patch has no line `+++ b/…`")?.trim();

    // Apply the patch to the old version of its file.
    let before = old(path)?;
    let after = apply(path, diff, &before).context("the patch does not fit the old version of the file")?;
    let mut places: Vec<&str> =
        moved.iter().filter(|(old, _)| old == path).map(|(_, new)| new.as_str()).collect();
    if places.is_empty() {
        places.push(path);
    }
    if places == [path] && new(path).as_ref() == Some(&before) {
        return Ok(Carried::Same);
    }
    // Rename identifiers, then merge the change into the first place where it fits.
    let (before, after) = (spelled(&before, words), spelled(&after, words));
    let mut why = Vec::new();
    for place in places {
        let Some(now) = new(place) else {
            why.push(format!("there is no {place}"));
            continue;
        };
        let merged = match diffy::merge(&before, &now, &after) {
            Ok(merged) => Some(merged),
            Err(conflicts) => without_comment_conflicts(&conflicts),
        };
        match merged {
            Some(changed) if changed != now => {
                let mut options = DiffOptions::new();
                options.set_original_filename(format!("a/{place}"));
                options.set_modified_filename(format!("b/{place}"));
                let patch = options.create_patch(&now, &changed).to_string();
                // Check that the written patch gives the merged text.
                ensure!(
                    apply(place, &patch, &now)? == changed,
                    "the new patch makes another change than the old one"
                );
                return Ok(Carried::Anew(format!("{header}{patch}")));
            }
            Some(_) => why.push(format!("{place} already contains the change")),
            None => why.push(format!("{place} was changed at the same lines")),
        }
    }
    Ok(Carried::Lost(why.join("; ")))
}

/// The merged text, if in each conflict our side differs from the original in comments only: there the patch decides.
fn without_comment_conflicts(conflicts: &str) -> Option<String> {
    let code = |lines: &[&str]| -> Vec<String> {
        // The markers `// <solution>` and `// <stub> …` are not comments: exercises/ is made from them.
        let is_comment = |line: &&str| line.starts_with("//") && !line.starts_with("// <");
        let code = lines.iter().map(|line| line.trim()).filter(|line| !is_comment(line));
        code.map(str::to_owned).collect()
    };
    let (mut merged, mut lines) = (String::new(), conflicts.split_inclusive('\n'));
    while let Some(line) = lines.next() {
        if !line.starts_with("<<<<<<< ") {
            merged += line;
            continue;
        }
        let mut until =
            |mark: &str| -> Vec<&str> { lines.by_ref().take_while(|line| !line.starts_with(mark)).collect() };
        let (ours, original, theirs) = (until("||||||| "), until("======="), until(">>>>>>> "));
        if code(&ours) != code(&original) {
            return None;
        }
        merged.extend(theirs);
    }
    Some(merged)
}

/// The text with names replaced. A word is what Rust takes for a name; one that ends with `(` in the table is a function,
/// and only its definition and its calls are replaced.
fn spelled(text: &str, words: &[(String, String)]) -> String {
    if words.is_empty() {
        return text.to_owned();
    }
    let in_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut spelled = String::new();
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let end = rest.find(|next| in_word(next) != in_word(letter)).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        let new = words.iter().find_map(|(old, new)| match old.strip_suffix('(') {
            Some(old) if old == word && after.starts_with('(') => Some(new.trim_end_matches('(')),
            None if old == word => Some(new.as_str()),
            _ => None,
        });
        spelled += new.unwrap_or(word);
        rest = after;
    }
    spelled
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &str = "one\ntwo\nthree\nfour\nfive\nsix\nseven\neight\nnine\nten\n";
    const PATCH: &str = "mistake: it says drei\n\n--- a/src/a.rs\n+++ b/src/a.rs\n@@ -1,5 +1,5 @@\n one\n two\n-three\n\
                         +drei\n four\n five\n";

    fn carried(moved: &[(&str, &str)], words: &[(&str, &str)], now: &[(&str, &str)]) -> Carried {
        let owned = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
            pairs.iter().map(|(old, new)| ((*old).to_owned(), (*new).to_owned())).collect()
        };
        let new = |path: &str| now.iter().find(|(name, _)| *name == path).map(|(_, text)| (*text).to_owned());
        let mut old = |path: &str| {
            assert_eq!(path, "src/a.rs");
            Ok(OLD.to_owned())
        };
        carry(PATCH, &owned(moved), &owned(words), &mut old, &new).unwrap()
    }

    fn applied(carried: Carried, path: &str, now: &str) -> String {
        let Carried::Anew(text) = carried else { panic!("{carried:?}") };
        let diff = text.strip_prefix("mistake: it says drei\n\n").expect("the header stays");
        assert!(diff.starts_with(&format!("--- a/{path}\n+++ b/{path}\n")), "{diff}");
        apply(path, diff, now).unwrap()
    }

    #[test]
    fn a_patch_of_what_is_as_it_was_stays_as_it_is() {
        assert_eq!(carried(&[], &[], &[("src/a.rs", OLD)]), Carried::Same);
    }

    #[test]
    fn a_patch_follows_its_file_and_the_lines_around() {
        let now = OLD.replace("nine", "NINE").replace("one\n", "zero\nhalf\none\n");
        let there = [("src/b/c.rs", now.as_str())];
        let text = applied(carried(&[("src/a.rs", "src/b/c.rs")], &[], &there), "src/b/c.rs", &now);
        assert_eq!(text, now.replace("three", "drei"));
    }

    #[test]
    fn of_a_file_that_was_split_it_finds_its_part() {
        let (first, second) = OLD.split_at(OLD.find("six").unwrap());
        let there = [("b.rs", second), ("c.rs", first)];
        let moved = [("src/a.rs", "b.rs"), ("src/a.rs", "c.rs")];
        assert_eq!(applied(carried(&moved, &[], &there), "c.rs", first), first.replace("three", "drei"));
    }

    #[test]
    fn words_that_are_spelled_in_another_way_are_no_difference() {
        let now = OLD.replace("two", "2").replace("four", "4");
        let words = [("two", "2"), ("four", "4"), ("on", "off"), ("three(", "drei(")];
        let text = applied(carried(&[], &words, &[("src/a.rs", &now)]), "src/a.rs", &now);
        assert_eq!(text, now.replace("three", "drei"));
    }

    #[test]
    fn a_comment_beside_a_change_is_no_difference() {
        let now = OLD.replace("three", "// Say three.\nthree");
        let text = applied(carried(&[], &[], &[("src/a.rs", &now)]), "src/a.rs", &now);
        assert!(text.contains("two\n") && text.contains("drei\nfour") && !text.contains("\nthree"), "{text}");
        for other in ["// Say three.\nthree or more", "// <stub> Say three.\nthree"] {
            let now = OLD.replace("three", other);
            let carried = carried(&[], &[], &[("src/a.rs", &now)]);
            assert!(matches!(carried, Carried::Lost(_)), "{carried:?}");
        }
    }

    #[test]
    fn what_no_longer_applies_is_reported() {
        let now = OLD.replace("three", "3");
        let Carried::Lost(why) = carried(&[], &[], &[("src/a.rs", &now)]) else { panic!("it applies") };
        assert_eq!(why, "src/a.rs was changed at the same lines");
        let gone = carried(&[("src/a.rs", "b.rs")], &[], &[]);
        assert_eq!(gone, Carried::Lost("there is no b.rs".into()));
        let done = carried(&[], &[], &[("src/a.rs", &OLD.replace("three", "drei"))]);
        assert_eq!(done, Carried::Lost("src/a.rs already contains the change".into()));
    }
}
