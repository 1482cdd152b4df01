//! `grader handout`: the student's repository, without the answers and without what only authors and instructors need.
//! Folders are copied as they are; only manifests that name what is missing are changed.

mod leaks;
mod manifests;

pub use leaks::{CANARY, answers, leaks};

use anyhow::{Context, Result, bail, ensure};
use raykata_cli::args::{Argument, Given, Misuse, Spec};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// `grader handout`.
pub static SPEC: Spec = Spec {
    name: "grader handout",
    about: "Make the student's repository: no answers, nothing that only instructors need (for instructors).",
    arguments: &[Argument::required("FOLDER", "The folder: an empty one, or one that is not there yet.")],
    options: &[],
};

/// Where to write it.
pub struct Options {
    folder: PathBuf,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        Ok(Options { folder: given.required(0)?.into() })
    }
}

/// Folders that are handed out, with all folders in them, and the endings of the files that are. A folder that is not
/// there is left out.
const FOLDERS: [(&str, &[&str]); 8] = [
    ("src", &["css", "md", "rs", "snap", "toml"]),
    ("tests/checks", &["rs", "toml"]),
    ("tests/oracle", &["rs", "toml"]),
    ("tests/judge", &["rs", "toml"]),
    ("scenes", &["toml"]),
    ("scenes/meshes", &["ply", "obj", "mtl"]),
    ("scenes/images", &["png", "hdr"]),
    ("slides", &["md", "svg"]),
];

/// What lies in those folders and is not handed out: tests of the kit itself, which need the solutions or fail once an
/// exercise is begun.
const KEPT_BACK: [&str; 2] = ["src/cli/tests", "tests/checks/all/tests"];

/// Files that are handed out as they are.
const FILES: [&str; 9] = [
    ".cargo/config.toml",
    ".gitignore",
    "Cargo.lock",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "exercises/Cargo.toml",
    "rustfmt.toml",
    "scenes/showcase.png",
    "tests/rubric.toml",
];

/// What a student's README says besides the kit's own.
const README: &str = include_str!("README.md");

/// Writes the student's repository, whole or not at all.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    let folder = std::path::absolute(&options.folder)?;
    if fs::read_dir(&folder).is_ok_and(|mut inside| inside.next().is_some()) || folder.is_file() {
        bail!("{} is not empty: a hand-out wants a folder of its own", options.folder.display());
    }
    let parent = folder.parent().context("a hand-out wants a folder of its own")?;
    crate::report::make_folder(parent)?;
    let draft = tempfile::tempdir_in(parent)?;
    let files = files(root)?;
    for (path, bytes) in &files {
        let file = draft.path().join(path);
        fs::create_dir_all(file.parent().unwrap_or(parent))?;
        fs::write(&file, bytes).with_context(|| format!("cannot write {path}"))?;
    }
    let found = leaks(root, draft.path())?;
    ensure!(found.is_empty(), "answers would be handed out, so nothing is:\n  {}", found.join("\n  "));
    settle_versions(draft.path());
    make_readable(draft.path())?;
    // An empty folder gives way to a folder.
    let draft = draft.keep();
    if let Err(error) = fs::rename(&draft, &folder) {
        let _ = fs::remove_dir_all(&draft);
        return Err(error).with_context(|| format!("cannot make {}", options.folder.display()));
    }
    println!("{}: {} files; `cargo run` in it says what to do first", options.folder.display(), files.len());
    Ok(())
}

/// All files of a hand-out but Cargo.lock, by their paths.
pub fn files(root: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    for path in FILES {
        files.insert(path.to_owned(), read(root, path)?);
    }
    for (folder, endings) in FOLDERS.into_iter().filter(|(folder, _)| root.join(folder).is_dir()) {
        gather(root, folder, endings, &mut files)?;
    }
    for (path, bytes) in
        named(root, "tests", "stage")?.into_iter().chain(named(root, "tests/golden", "stage")?)
    {
        files.insert(path, bytes);
    }
    for (name, text) in crate::sync::pristine(root)? {
        files.insert(format!("exercises/src/{name}"), text.into_bytes());
    }
    let manifest = manifests::of_workspace(&text(root, "Cargo.toml")?, &files)?;
    files.insert("Cargo.toml".into(), manifest.into_bytes());
    files.insert("README.md".into(), readme(&text(root, "README.md")?)?.into_bytes());
    Ok(files)
}

/// The files with these endings in a folder and below it.
fn gather(root: &Path, folder: &str, endings: &[&str], files: &mut BTreeMap<String, Vec<u8>>) -> Result<()> {
    for entry in fs::read_dir(root.join(folder)).with_context(|| format!("no folder {folder}"))? {
        let entry = entry?;
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        let is = |ending: &&str| Path::new(&path).extension().is_some_and(|one| one == *ending);
        if entry.file_type()?.is_dir() {
            if !KEPT_BACK.contains(&path.as_str()) && entry.file_name() != "target" {
                gather(root, &path, endings, files)?;
            }
        } else if endings.iter().any(is) {
            files.insert(path.clone(), read(root, &path)?);
        }
    }
    Ok(())
}

/// The texts and pictures in a folder, not below it, whose names begin so.
fn named(root: &Path, folder: &str, start: &str) -> Result<Vec<(String, Vec<u8>)>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root.join(folder)).with_context(|| format!("no folder {folder}"))? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_wanted = ["rs", "snap", "png"].iter().any(|ending| name.ends_with(&format!(".{ending}")));
        if name.starts_with(start) && is_wanted && entry.file_type()?.is_file() {
            let path = format!("{folder}/{name}");
            found.push((path.clone(), read(root, &path)?));
        }
    }
    Ok(found)
}

/// What the kit's README says to everybody and to students, with what a student's own repository needs besides.
fn readme(of_kit: &str) -> Result<String> {
    let (greeting, rest) = of_kit.split_once("\n```sh\n").context("README.md has no first command")?;
    let (_, rest) = rest.split_once("\n## As a student\n").context("README.md says nothing to students")?;
    let (student, _) = rest.split_once("\n## ").context("README.md ends with what it says to students")?;
    // There is no other kit here.
    let student = student.replace(" --kit exercises", "");
    Ok(README.replace("{greeting}", greeting.trim()).replace("{student}", student.trim()))
}

/// Takes out of Cargo.lock what is no longer asked for. Without what cargo keeps of its registry that does not work; then
/// cargo does it at the first build.
fn settle_versions(folder: &Path) {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder).args(["update", "--workspace", "--offline", "--quiet"]);
    let _ = cargo.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
}

/// A temporary folder is its maker's alone; a hand-out is for others, too.
fn make_readable(folder: &Path) -> Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(folder, fs::Permissions::from_mode(0o755))?;
    }
    let _ = folder;
    Ok(())
}

fn read(root: &Path, path: &str) -> Result<Vec<u8>> {
    fs::read(root.join(path)).with_context(|| format!("cannot read {path}: is this the whole kit?"))
}

fn text(root: &Path, path: &str) -> Result<String> {
    String::from_utf8(read(root, path)?).with_context(|| format!("{path} is no text"))
}
