//! The kits of a race: their folders, and one build of all of them with the same options of the compiler.
//!
//! In the development build the exercises have checks for overflow, which cost time, and the solutions have none. So a race
//! does not use the workers of other commands. It writes a small workspace into the target folder, with one package per
//! kit, which compiles the files of its folder.

use crate::kits::{Which, cargo_in, run_build, target_folder};
use anyhow::{Context, Result, bail};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A kit of a race.
#[derive(Clone, Debug, PartialEq)]
pub struct Racer {
    /// Its name in the table.
    pub name: String,
    /// The folder with `src/lib.rs`.
    pub folder: PathBuf,
}

/// The racer of a kit of this repository.
pub fn of_kit(root: &Path, which: Which) -> Result<Racer> {
    let racer = Racer { name: which.package().into(), folder: root.join(which.package()) };
    if !is_kit(&racer.folder) {
        bail!(
            "there are no {} in {}: name an opponent, which is another folder of exercises, as in `--against ../other/exercises`",
            racer.name,
            root.display()
        );
    }
    Ok(racer)
}

/// The racer in another folder: a folder of exercises, or a repository that contains one. Relative paths start at the
/// current folder.
pub fn in_folder(root: &Path, folder: &Path) -> Result<Racer> {
    if let Some((_, which)) = Which::NAMES.iter().find(|(name, _)| folder == Path::new(name)) {
        return of_kit(root, *which);
    }
    if !folder.is_dir() {
        bail!("there is no folder {}: `--against` needs a folder of exercises", folder.display());
    }
    let candidates = [folder.to_owned(), folder.join("exercises")];
    let Some(found) = candidates.into_iter().find(|folder| is_kit(folder)) else {
        bail!(
            "{} holds no exercises: `--against` needs a folder with src/lib.rs, such as exercises/, or a repository \
             that contains exercises/",
            folder.display()
        );
    };
    let found = found.canonicalize().with_context(|| format!("cannot read {}", found.display()))?;
    Ok(Racer { name: folder.display().to_string(), folder: found })
}

fn is_kit(folder: &Path) -> bool {
    folder.join("src/lib.rs").is_file()
}

/// Builds all racers with the same options, and returns their worker programs.
pub fn build(root: &Path, racers: &[Racer]) -> Result<Vec<PathBuf>> {
    let target = target_folder().unwrap_or_else(|| root.join("target"));
    let workspace = target.join("race");
    // Write the workspace. A file with the same text keeps its time, so that cargo builds nothing again.
    let manifest = std::fs::read_to_string(root.join("Cargo.toml")).context("cannot read Cargo.toml")?;
    write_if_new(&workspace.join("Cargo.toml"), &workspace_manifest(&manifest, racers.len()))?;
    for (i, racer) in racers.iter().enumerate() {
        let package = workspace.join(package_name(i));
        write_if_new(&package.join("Cargo.toml"), &package_manifest(&manifest, root, i, racer)?)?;
        write_if_new(
            &package.join("main.rs"),
            &format!("fn main() {{\n    raykata::worker::serve(racer_{i}::Kit);\n}}\n"),
        )?;
    }
    // The same versions of dependencies are in the target folder already.
    let lock = workspace.join("Cargo.lock");
    if !lock.is_file() && root.join("Cargo.lock").is_file() {
        std::fs::copy(root.join("Cargo.lock"), &lock).context("cannot copy Cargo.lock")?;
    }
    let mut cargo = cargo_in(&workspace);
    cargo.args(["--workspace", "--bins", "--target-dir"]).arg(target);
    let built = run_build(cargo, "the kits of the race")?;
    (0..racers.len()).map(|i| built.path(&package_name(i))).collect()
}

/// Builds both kits of this repository with the same options, and returns their worker programs: those of the reference and of
/// the exercises.
pub fn build_both(root: &Path) -> Result<[PathBuf; 2]> {
    let programs = build(root, &[of_kit(root, Which::Solutions)?, of_kit(root, Which::Exercises)?])?;
    let [reference, own] = programs.as_slice() else { bail!("a kit has no program") };
    Ok([reference.clone(), own.clone()])
}

fn package_name(racer: usize) -> String {
    format!("racer-{racer}")
}

/// The crates whose options of the root manifest also count in a race: those that the racers are compiled with.
const CRATES: &str = "crc32fast crossbeam-deque crossbeam-epoch crossbeam-utils fdeflate fearless_simd flate2 glam miniz_oxide \
                      png raykata rayon rayon-core sobol_burley toml_parser";

/// The manifest of the workspace: its packages, and the profiles of the root manifest. All racers have the options of the
/// solutions.
fn workspace_manifest(root: &str, n_racers: usize) -> String {
    let names: Vec<String> = (0..n_racers).map(|i| format!("\"{}\"", package_name(i))).collect();
    let mut text = format!("[workspace]\nresolver = \"3\"\nmembers = [{}]\n", names.join(", "));
    let mut kept = false;
    for line in root.lines() {
        if let Some(header) = line.strip_prefix('[') {
            let header = header.trim_end_matches(']');
            kept = match header.strip_prefix("profile.dev.package.") {
                Some(name) => name == "\"*\"" || CRATES.split(' ').any(|one| one == name),
                None => header == "profile.dev" || header == "profile.release",
            };
        }
        if kept {
            text += line;
            text.push('\n');
        }
    }
    for i in 0..n_racers {
        let _ = writeln!(
            text,
            "[profile.dev.package.{}]\nopt-level = 3\nincremental = false\noverflow-checks = false",
            package_name(i)
        );
    }
    text
}

/// The manifest of one racer.
fn package_manifest(manifest: &str, root: &Path, i: usize, racer: &Racer) -> Result<String> {
    // A JSON string is a TOML string as well.
    let quoted = |path: &Path| -> Result<String> {
        let path = path.to_str().with_context(|| format!("the path {} is not Unicode", path.display()))?;
        Ok(serde_json::to_string(path)?)
    };
    let value = |key: &str| {
        let line = manifest.lines().find(|line| line.starts_with(&format!("{key} = ")));
        line.with_context(|| format!("Cargo.toml has no line `{key} = …`"))
    };
    let root = root.canonicalize().with_context(|| format!("cannot read {}", root.display()))?;
    Ok(format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\n{edition}\npublish = false\n\n\
         [features]\ndefault = [\"frames\"]\nframes = []\n\n\
         [dependencies]\n{glam}\nraykata = {{ path = {root} }}\n\n\
         [lib]\nname = \"racer_{i}\"\npath = {lib}\n\n\
         [[bin]]\nname = \"{name}\"\npath = \"main.rs\"\n\n\
         [lints.rust]\nunsafe_code = \"forbid\"\nwarnings = {{ level = \"allow\", priority = -1 }}\n",
        name = package_name(i),
        edition = value("edition")?,
        glam = value("glam")?,
        root = quoted(&root)?,
        lib = quoted(&racer.folder.join("src/lib.rs"))?,
    ))
}

fn write_if_new(file: &Path, text: &str) -> Result<()> {
    if std::fs::read_to_string(file).is_ok_and(|old| old == text) {
        return Ok(());
    }
    crate::report::make_folder_of(file)?;
    std::fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repository() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
    }

    #[test]
    fn all_racers_have_the_options_of_the_solutions() {
        if !repository().join("solutions").is_dir() {
            return println!("a hand-out has no solutions, whose options racers get");
        }
        let root = std::fs::read_to_string(repository().join("Cargo.toml")).expect("the manifest");
        let text = workspace_manifest(&root, 2);
        let section = |text: &str, name: &str| {
            let start = text.find(&format!("[{name}]\n")).unwrap_or_else(|| panic!("no {name} in\n{text}"));
            let lines =
                text[start..].lines().skip(1).take_while(|line| !line.is_empty() && !line.starts_with('['));
            lines.filter(|line| !line.starts_with('#')).map(String::from).collect::<Vec<_>>()
        };
        let solutions = section(&root, "profile.dev.package.solutions");
        for i in 0..2 {
            assert_eq!(section(&text, &format!("profile.dev.package.racer-{i}")), solutions);
        }
        for same in CRATES.split(' ').map(|name| format!("profile.dev.package.{name}")) {
            assert_eq!(section(&text, &same), section(&root, &same));
        }
        assert_eq!(section(&text, "profile.dev"), section(&root, "profile.dev"));
        assert!(!text.contains("package.exercises") && !text.contains("profile.test"), "{text}");
    }

    #[test]
    fn a_package_compiles_the_files_of_its_folder() {
        let root = std::fs::read_to_string(repository().join("Cargo.toml")).expect("the manifest");
        let racer = Racer { name: "anna".into(), folder: "/home/a \"b\"/exercises".into() };
        let text = package_manifest(&root, &repository(), 1, &racer).expect("a manifest");
        assert!(text.contains("path = \"/home/a \\\"b\\\"/exercises/src/lib.rs\""), "{text}");
        assert!(text.contains("unsafe_code = \"forbid\"") && text.contains("\nglam = { version"), "{text}");
    }

    #[test]
    fn folders_without_exercises_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let why = |at: &Path| in_folder(folder.path(), at).map(|_| ()).unwrap_err().to_string();
        // A hand-out has no solutions.
        let missing = why(Path::new("solutions"));
        assert!(missing.starts_with("there are no solutions in "), "{missing}");
        assert!(missing.contains(": name an opponent, which is another folder of exercises"), "{missing}");
        let exercises = folder.path().join("exercises/src");
        std::fs::create_dir_all(&exercises).expect("a folder");
        std::fs::write(exercises.join("lib.rs"), "").expect("a file");
        let found = in_folder(folder.path(), folder.path()).expect("a repository");
        assert!(found.folder.ends_with("exercises"));
        assert_eq!(
            in_folder(folder.path(), &folder.path().join("exercises")).expect("exercises").folder,
            found.folder
        );
    }
}
