//! `grader handout`: makes the student's repository, without the answers and without files that only authors and
//! instructors need. Folders are copied unchanged. Only manifests that name missing parts are changed.

mod leaks;
mod manifests;

pub use leaks::{CANARY, answers, leaks};

use crate::course::{self, CourseFiles};
use crate::files_below::{files_below, last_part};
use anyhow::{Context, Result, bail, ensure};
use raykata::course::{Course, stages_of};
use raykata_cli::args::{Argument, Given, Opt, Spec};
use raykata_cli::kits::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// `grader handout`.
pub static SPEC: Spec = Spec {
    name: "grader handout",
    about: "Make the student's repository, without answers and instructors' files.",
    arguments: &[Argument::required("FOLDER", "An empty or new folder.")],
    options: &[&[
        course::OPTION,
        Opt::value("--title", "TEXT", "The title of the course, above its README and the start page."),
        Opt::value(
            "--stages",
            "LIST",
            "The stages that students see, as `3`, `1-4` or `1-4,10` [default: all].",
        ),
    ]],
};

/// Reads a title, which is one line.
fn title(text: &str) -> Result<String> {
    ensure!(!text.trim().is_empty() && !text.contains(char::is_control), "a title is one line of text");
    Ok(text.trim().to_owned())
}

/// Folders that are handed out with their subfolders, and the extensions of the files in them. A missing folder is left
/// out.
const FOLDERS: [(&str, &[&str]); 10] = [
    ("src", &["css", "html", "md", "rs", "snap", "svg", "toml", "txt"]),
    ("tests/checks", &["rs", "toml"]),
    ("tests/oracle", &["rs", "toml"]),
    ("tests/judge", &["rs", "toml"]),
    ("tests/browser", &["rs", "toml"]),
    ("scenes", &["md", "toml"]),
    ("scenes/meshes", &["ply", "obj", "mtl"]),
    ("scenes/images", &["png", "hdr"]),
    ("scenes/reference", &["png"]),
    ("slides", &["css", "json", "md", "png", "svg"]),
];

/// Parts of those folders that are not handed out: tests of the kit itself, which need the solutions or fail after an exercise
/// was begun, and what only lecturers and authors use.
const KEPT_BACK: [&str; 8] = [
    "slides/README.md",
    "slides/grading.md",
    "slides/plan.md",
    "slides/printed",
    "slides/src",
    "slides/tests",
    "src/cli/tests",
    "tests/checks/all/tests",
];

/// Files that are handed out unchanged.
const FILES: [&str; 12] = [
    ".cargo/config.toml",
    ".gitignore",
    "Cargo.lock",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "exercises/Cargo.toml",
    "rustfmt.toml",
    "scenes/showcase.png",
    "scenes/terrace.png",
    "tests/course.toml",
    "tests/language.toml",
    "tests/stubs.toml",
];

/// The file with the version and the files of the kit, from which `raykata update` knows what an older kit held.
const LIST: &str = "tests/kit.toml";

/// The student's README, with places for parts of the kit's README.
const README: &str = include_str!("README.md");

/// Writes the student's repository, completely or not at all.
pub fn run(given: &Given) -> Result<bool> {
    given.exclude("--course", "--title")?;
    given.exclude("--course", "--stages")?;
    let stages = |text: &str| stages_of(text).map(|_| text.to_owned());
    let asked = Path::new(given.required(0)?);
    let (title, stages) = (given.parsed("--title", title)?, given.parsed("--stages", stages)?);
    let root = root()?;
    let folder = std::path::absolute(asked)?;
    if fs::read_dir(&folder).is_ok_and(|mut inside| inside.next().is_some()) || folder.is_file() {
        bail!("{} is not empty: a hand-out needs a new or empty folder", asked.display());
    }
    let parent = folder.parent().context("a hand-out needs a new or empty folder")?;
    crate::report::make_folder(parent)?;
    // Write all files into a draft folder.
    let draft = tempfile::tempdir_in(parent)?;
    // The title and the stages alone need no file.
    let course = match (&title, &stages) {
        (None, None) => CourseFiles::given(given)?,
        _ => Some(CourseFiles::of(title.as_deref(), stages.as_deref())?),
    };
    let n_files = write(&root, draft.path(), course.as_ref())?;
    // Stop if the draft contains an answer.
    let found = leaks(&root, draft.path())?;
    ensure!(
        found.is_empty(),
        "the hand-out would contain answers, so it was not written:\n  {}",
        found.join("\n  ")
    );
    make_readable(draft.path())?;
    // A rename replaces an empty folder.
    let draft = draft.keep();
    if let Err(error) = fs::rename(&draft, &folder) {
        let _ = fs::remove_dir_all(&draft);
        return Err(error).with_context(|| format!("cannot make {}", asked.display()));
    }
    println!("{}: {n_files} files; run `cargo run` in it to see the first task", asked.display());
    Ok(true)
}

/// Writes the files of a hand-out into a folder, with Cargo.lock if cargo can make it. Returns the number of the others.
pub fn write(root: &Path, folder: &Path, course: Option<&CourseFiles>) -> Result<usize> {
    let mut files = files(root)?;
    if let Some(course) = course {
        name_course(&mut files, course)?;
    }
    for (path, bytes) in &files {
        let file = folder.join(path);
        fs::create_dir_all(file.parent().unwrap_or(folder))
            .and_then(|()| fs::write(&file, bytes))
            .with_context(|| format!("cannot write {}", file.display()))?;
    }
    settle_versions(folder, &files["Cargo.lock"])?;
    Ok(files.len())
}

/// Returns all files of a hand-out except Cargo.lock, by their paths.
pub fn files(root: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    for path in FILES {
        files.insert(path.to_owned(), read(root, path)?);
    }
    for (folder, endings) in FOLDERS.into_iter().filter(|(folder, _)| root.join(folder).is_dir()) {
        let keeps =
            |path: &str| !KEPT_BACK.contains(&path) && !["target", "node_modules"].contains(&last_part(path));
        let is = |path: &&String| endings.iter().any(|ending| path.ends_with(&format!(".{ending}")));
        for path in files_below(root, folder, &keeps)?.iter().filter(is) {
            files.insert(path.clone(), read(root, path)?);
        }
    }
    // The decks show the reference, and name commands of authors; students have their own code only.
    for (_, bytes) in
        files.iter_mut().filter(|(path, _)| path.starts_with("slides/") && path.ends_with(".md"))
    {
        let text = String::from_utf8_lossy(bytes);
        let lines = text.lines().filter(|line| !line.contains("cargo run --release -p author"));
        let own = |line: &str| {
            line.replace(" --kit solutions", "").replace("solutions/src", "exercises/src") + "\n"
        };
        *bytes = lines.map(own).collect::<String>().into_bytes();
    }
    // The tests of the stages, and their golden texts and pictures.
    for folder in ["tests", "tests/golden"] {
        let of_stage = |path: &str| path.starts_with(&format!("{folder}/stage"));
        let endings = [".rs", ".snap", ".png"];
        for path in files_below(root, folder, &of_stage)? {
            if endings.iter().any(|ending| path.ends_with(ending)) {
                files.insert(path.clone(), read(root, &path)?);
            }
        }
    }
    for (name, text) in crate::exercises::pristine(root)? {
        files.insert(format!("exercises/src/{name}"), text.into_bytes());
    }
    let manifest = manifests::of_workspace(&text(root, "Cargo.toml")?, &files)?;
    files.insert("Cargo.toml".into(), manifest.into_bytes());
    files.insert("README.md".into(), readme(&text(root, "README.md")?)?.into_bytes());
    let list = list(files.keys());
    files.insert(LIST.into(), list.into_bytes());
    Ok(files)
}

/// The text of [`LIST`] for a kit of these files.
fn list<'a>(files: impl Iterator<Item = &'a String>) -> String {
    let paths: BTreeSet<&str> = files.map(String::as_str).chain([LIST]).collect();
    let lines: String = paths.iter().map(|path| format!("    {path:?},\n")).collect();
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "# The files of this kit, which `raykata update` replaces.\nversion = {version:?}\nfiles = [\n{lines}]\n"
    )
}

/// Puts the course file and its language file in the place of the kit's own, which the programs read, and the title and the
/// stages of the course into the README.
fn name_course(files: &mut BTreeMap<String, Vec<u8>>, course: &CourseFiles) -> Result<()> {
    let of_course: Course = course.parse()?;
    files.insert("tests/course.toml".into(), course.course.1.clone().into_bytes());
    if let Some((_, text)) = &course.language {
        files.insert("tests/language.toml".into(), text.clone().into_bytes());
    }
    let readme = files.get_mut("README.md").context("README.md is missing")?;
    let is_kept = |line: &&str| {
        let number = line.strip_prefix("| ").and_then(|rest| rest.split(' ').next()?.parse::<u8>().ok());
        let is_left_out = |stage: u8| {
            of_course.leaves_out(stage)
                && (number == Some(stage)
                    || line.contains(&format!("scenes/stage{stage}.toml"))
                    || (stage == 7 && line.contains("-- explain ")))
        };
        // The ways through the stages, of four and of twelve weeks, need all of them.
        !(1..=12).any(is_left_out) && (of_course.stages.is_empty() || !line.contains(" weeks**: "))
    };
    let lines = std::str::from_utf8(readme)?.lines().filter(is_kept);
    let mut lines = lines.map(|line| format!("{line}\n")).collect::<String>();
    // The table lists what the stages of the course ask for.
    if let (false, Some(list)) = (of_course.stages.is_empty(), lines.find(": ray–sphere")) {
        let end = lines.find("\nThe kit provides").context("README.md lacks what the kit provides")?;
        lines.replace_range(list..end, ".");
    }
    *readme = match of_course.title.is_empty() {
        true => lines,
        false => lines.replacen("# Raykata\n", &format!("# {}: Raykata\n", of_course.title), 1),
    }
    .into_bytes();
    Ok(())
}

/// Returns the student's README: the greeting and the chapter for students of the kit's README, and the student's own text.
fn readme(of_kit: &str) -> Result<String> {
    let (greeting, rest) = of_kit.split_once("\n```sh\n").context("README.md lacks a first command")?;
    let (_, rest) =
        rest.split_once("\n## As a student\n").context("README.md lacks a chapter `As a student`")?;
    let (student, _) = rest.split_once("\n## ").context("README.md lacks a chapter after `As a student`")?;
    let mut student = student.replace(" --kit exercises", "");
    // The names of numbers and the sources of quotes are for authors.
    while let Some((before, after)) = student.split_once("<!--") {
        student = format!("{before}{}", after.split_once("-->").map_or("", |(_, rest)| rest));
    }
    Ok(README.replace("{greeting}", greeting.trim()).replace("{student}", student.trim()))
}

/// Removes unused packages from Cargo.lock, which holds `whole`. Without cargo's copy of the registry this fails, and cargo does
/// it at the first build.
fn settle_versions(folder: &Path, whole: &[u8]) -> Result<()> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder).args(["update", "--workspace", "--offline", "--quiet"]);
    let status = cargo.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if status.is_ok_and(|status| status.success()) {
        return Ok(());
    }
    // Cargo may have written a part of the file, for example on a full disk.
    let file = folder.join("Cargo.lock");
    fs::write(&file, whole).with_context(|| format!("cannot write {}", file.display()))
}

/// Makes a hand-out readable for others. A temporary folder is readable only for its owner.
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
    String::from_utf8(read(root, path)?).with_context(|| format!("{path} is not valid UTF-8"))
}
