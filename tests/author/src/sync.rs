//! `author sync`: writes the [exercises] and the [numbers] in documents.
//!
//! [exercises]: grader::exercises

use crate::{numbers, printed};
use anyhow::{Result, bail};
use grader::exercises::{Exercise, RECORD, exercises, fingerprint, stage_of};
use grader::grade::shard;
use grader::kits::root;
use grader::report::write_file;
use raykata_cli::args::{Given, Opt, Spec};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// `author sync`.
pub static SPEC: Spec = Spec {
    name: "author sync",
    about: "Make exercises/ from solutions/, and write the numbers in documents. Keeps exercises that you have begun.",
    arguments: &[],
    options: &[&[
        Opt::flag("--check", "Only report differences, and write nothing."),
        Opt::flag("--force", "Overwrite exercises that have been begun."),
        Opt::flag("--printed", "First run the commands whose numbers documents print (minutes)."),
        Opt::value("--shard", "I/N", "Of these commands, run only part I of N, such as 2/5."),
    ]],
};

/// The file with the untouched functions, from which `raykata watch` resets one. Students have it too.
const STUBS: &str = "tests/stubs.toml";

/// Runs `author sync`.
pub fn run(given: &Given) -> Result<bool> {
    given.exclude("--force", "--check")?;
    let (is_check, shard) = (given.has("--check"), given.parsed("--shard", shard)?);
    let root = root()?;
    if given.has("--printed") {
        let different = printed::run_all(&root, is_check, shard)?;
        match is_check && !different.is_empty() {
            true => bail!(
                "commands print something else; `author sync --printed` writes it:\n{}",
                different.join("\n")
            ),
            false => different.iter().for_each(|line| println!("{}", line.trim_start())),
        }
    }
    if is_check {
        check(&root)?
    } else {
        sync(&root, given.has("--force"))?
    }
    Ok(true)
}

/// Compares the exercises and the documents with the files that `sync` would write. Returns an error that lists the differences.
pub fn check(root: &Path) -> Result<()> {
    let exercises = exercises(root)?;
    let mut different: Vec<String> = exercises
        .iter()
        .filter(|exercise| exercise.present.as_ref() != Some(&exercise.stub))
        .map(|exercise| format!("  {}", exercise.path.display()))
        .collect();
    if fs::read_to_string(root.join(STUBS)).ok() != Some(stubs(&exercises)) {
        different.push(format!("  {STUBS}"));
    }
    different.extend(numbers::documents(root)?.iter().flat_map(numbers::Document::stale));
    if different.is_empty() {
        println!("exercises/ is up to date with solutions/, and documents have the right numbers");
        return Ok(());
    }
    bail!("these files differ from what `author sync` would write:\n{}", different.join("\n"))
}

/// Writes all untouched exercises, with `force` the others as well, and the documents whose numbers are stale.
pub fn sync(root: &Path, force: bool) -> Result<()> {
    let exercises = exercises(root)?;
    let mut record = BTreeMap::new();
    let mut kept = Vec::new();
    for exercise in &exercises {
        if exercise.untouched || force {
            if exercise.present.as_ref() != Some(&exercise.stub) {
                write_file(&root.join(&exercise.path), exercise.stub.as_bytes())?;
                println!("wrote {}", exercise.path.display());
            }
            record.insert(exercise.path.clone(), fingerprint(&exercise.stub));
        } else {
            kept.push(exercise.path.display().to_string());
        }
    }
    let lines: Vec<String> =
        record.iter().map(|(path, print)| format!("{print} {}\n", path.display())).collect();
    write_file(&root.join(RECORD), lines.concat().as_bytes())?;
    write_file(&root.join(STUBS), stubs(&exercises).as_bytes())?;
    for document in numbers::documents(root)?.iter().filter(|document| document.present != document.synced) {
        write_file(&root.join(&document.path), document.synced.as_bytes())?;
        println!("wrote {}", document.path.display());
    }
    for path in &kept {
        println!("kept {path}: you have begun it (`author sync --force` would overwrite it)");
    }
    Ok(())
}

/// Returns the untouched functions of all exercises as TOML: a table per file, and in it the text of each function.
fn stubs(exercises: &[Exercise]) -> String {
    let mut toml = "# The functions of the exercises before they are written. `author sync` writes this file, and `raykata watch` \
                    resets a\n# function from it.\n"
        .to_owned();
    for exercise in exercises {
        let file = exercise.path.file_stem().unwrap_or_default().to_string_lossy();
        if stage_of(&file).is_none() {
            continue;
        }
        toml += &format!("\n[{file}]\n");
        let mut lines = exercise.stub.lines();
        while let Some(line) = lines.next() {
            let Some(head) = line.strip_prefix("pub fn ") else { continue };
            let name: String =
                head.chars().take_while(|sign| sign.is_ascii_alphanumeric() || *sign == '_').collect();
            let rest = lines.by_ref().take_while(|line| *line != "}").map(|line| format!("{line}\n"));
            toml += &format!("{name} = '''\n{line}\n{}}}\n'''\n", rest.collect::<String>());
        }
    }
    toml
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_was_begun_is_kept_unless_forced() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        fs::create_dir_all(at("solutions/src")).unwrap();
        fs::create_dir_all(at("exercises/src")).unwrap();
        fs::create_dir_all(at("tests")).unwrap();
        let solution =
            "fn f() -> u8 {\n    // <solution>\n    7\n    // <stub> todo!()\n    // </solution>\n}\n";
        fs::write(at("solutions/src/a.rs"), solution).unwrap();
        sync(root.path(), false).unwrap();
        check(root.path()).unwrap();

        // A newer kit replaces an untouched file …
        fs::write(at("solutions/src/a.rs"), solution.replace("u8", "u16")).unwrap();
        assert!(check(root.path()).is_err());
        sync(root.path(), false).unwrap();
        assert!(fs::read_to_string(at("exercises/src/a.rs")).unwrap().contains("u16"));

        // … and keeps a changed one.
        fs::write(at("exercises/src/a.rs"), "fn f() -> u16 { 8 }\n").unwrap();
        sync(root.path(), false).unwrap();
        assert_eq!(fs::read_to_string(at("exercises/src/a.rs")).unwrap(), "fn f() -> u16 { 8 }\n");
        sync(root.path(), true).unwrap();
        check(root.path()).unwrap();
    }

    #[test]
    fn a_stale_number_in_a_document_is_found_and_written() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        for folder in ["solutions/src", "exercises", "tests"] {
            fs::create_dir_all(at(folder)).unwrap();
        }
        fs::write(at("README.md"), "There are 11<!--=stages--> stages.\n").unwrap();
        sync(root.path(), false).unwrap();
        assert_eq!(fs::read_to_string(at("README.md")).unwrap(), "There are 12<!--=stages--> stages.\n");
        check(root.path()).unwrap();
        fs::write(at("README.md"), "There are 13<!--=stages--> stages.\n").unwrap();
        assert!(
            check(root.path())
                .unwrap_err()
                .to_string()
                .ends_with("\n  README.md:1: yours `13`, expected `12`")
        );
    }
}
