//! `grader release`: the archives of a version, for students and for instructors. The same sources give the same bytes.

use crate::course::{self, CourseFiles};
use crate::files_below::{files_below, last_part};
use crate::handout;
use anyhow::{Context, Result, bail, ensure};
use flate2::Compression;
use flate2::write::GzEncoder;
use raykata::film::write_atomically;
use raykata_cli::args::{Given, Opt, Spec};
use raykata_cli::kits::root;
use raykata_cli::lock::Lock;
use raykata_cli::report::{Bytes, make_folder, write_file};
use sha2::{Digest as _, Sha256};
use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

/// `grader release`.
pub static SPEC: Spec = Spec {
    name: "grader release",
    about: "Write the archives of this version: the hand-out for students, and the whole kit for instructors.",
    arguments: &[],
    options: &[&[
        Opt::value("--out", "FOLDER", "The folder for the archives and their checksums.").required(),
        course::OPTION,
        Opt::flag(
            "--vendor",
            "Put the sources of all packages into the archives, by `cargo vendor`, so that they build without a network.",
        ),
        Opt::flag(
            "--draft",
            "Also if CHANGELOG.md has no chapter of this version. The names then end in `-draft`.",
        ),
    ]],
};

/// What the archive for instructors contains.
const KIT: [&str; 19] = [
    ".cargo",
    ".ci",
    ".gitignore",
    ".typos.toml",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "exercises",
    "rustfmt.toml",
    "scenes",
    "slides",
    "solutions",
    "src",
    "tests",
];

/// Folders of that list that tools generate.
const GENERATED: [&str; 3] = ["target", "node_modules", "out"];

/// Tells cargo to build from the folder `vendor`.
const VENDORED: &str = "
# All packages are in this archive, so that it builds without a network.
[source.crates-io]
replace-with = \"vendored\"

[source.vendored]
directory = \"vendor\"
";

/// Writes both archives and their checksums.
pub fn run(given: &Given) -> Result<bool> {
    let (out, is_draft) = (given.required_path("--out")?, given.has("--draft"));
    let root = root()?;
    let version = env!("CARGO_PKG_VERSION");
    let changelog = fs::read_to_string(root.join("CHANGELOG.md")).context("cannot read CHANGELOG.md")?;
    let has_chapter = changelog.lines().any(|line| {
        line.strip_prefix("## ")
            .and_then(|title| title.split(' ').next())
            .is_some_and(|title| title == version)
    });
    ensure!(
        has_chapter || is_draft,
        "CHANGELOG.md has no chapter `## {version}`: rename `## Unreleased`, or write a draft by --draft"
    );
    let version = if is_draft { format!("{version}-draft") } else { version.to_owned() };
    let course = CourseFiles::given(given)?;
    let _lock = Lock::on(&out)?;
    make_folder(&out)?;

    // Gather the files of both archives in folders, so that cargo can add the packages that they need.
    let place = tempfile::tempdir()?;
    let mut sums = String::new();
    for contents in ["course", "grader"] {
        let name = format!("raykata-{contents}-{version}");
        let folder = place.path().join(&name);
        fs::create_dir(&folder)?;
        if contents == "course" {
            handout::write(&root, &folder, course.as_ref())?;
            let found = handout::leaks(&root, &folder)?;
            ensure!(found.is_empty(), "the hand-out would contain answers:\n  {}", found.join("\n  "));
        } else {
            for part in KIT {
                copy(&root, part, &folder)?;
            }
            if let Some(course) = &course {
                course.write_to(&folder.join("course"))?;
            }
        }
        if given.has("--vendor") {
            vendor(&folder)?;
        }
        let file = out.join(format!("{name}.tar.gz"));
        let sum = archive(place.path(), &name, &file)?;
        let size = fs::metadata(&file).map_or(0, |about| about.len());
        println!("{}  {}", file.display(), Bytes(size));
        sums += &format!("{sum}  {name}.tar.gz\n");
    }
    let file = out.join("SHA256SUMS");
    write_file(&file, sums.as_bytes())?;
    println!("{}", file.display());
    Ok(true)
}

/// Copies a part of the kit.
fn copy(root: &Path, part: &str, to: &Path) -> Result<()> {
    for path in files_below(root, part, &|path| !GENERATED.contains(&last_part(path)))? {
        let (from, to) = (root.join(&path), to.join(&path));
        fs::create_dir_all(to.parent().unwrap_or(&to))
            .and_then(|()| fs::copy(&from, &to))
            .with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
    }
    Ok(())
}

/// Adds the sources of all packages that the lock file names, and tells cargo to use them.
fn vendor(folder: &Path) -> Result<()> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder).args(["vendor", "--locked", "--versioned-dirs", "--quiet"]);
    let output = cargo.output().context("cargo cannot be started")?;
    if !output.status.success() {
        bail!(
            "`cargo vendor` failed; it downloads the packages of all systems once:\n{}",
            String::from_utf8_lossy(&output.stderr).trim()
        );
    }
    let config = folder.join(".cargo/config.toml");
    let mut text =
        fs::read_to_string(&config).with_context(|| format!("cannot read {}", config.display()))?;
    text += VENDORED;
    fs::write(&config, text).with_context(|| format!("cannot write {}", config.display()))
}

/// Packs a folder, sorted by name and without times, owners and other properties of this machine. Returns the checksum.
fn archive(around: &Path, name: &str, file: &Path) -> Result<String> {
    let mut paths = files_below(around, name, &|_| true)?;
    paths.sort();
    let packed = write_atomically(file, |out| {
        let mut tar = tar::Builder::new(GzEncoder::new(out, Compression::default()));
        for path in &paths {
            let from = around.join(path);
            let mut header = tar::Header::new_gnu();
            header.set_size(fs::metadata(&from)?.len());
            header.set_mode(if is_executable(&from) { 0o755 } else { 0o644 });
            header.set_mtime(0);
            header.set_cksum();
            tar.append_data(&mut header, path, File::open(&from)?)?;
        }
        tar.into_inner()?.finish()?;
        Ok(())
    });
    packed.with_context(|| format!("cannot write {}", file.display()))?;
    let bytes = fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
    Ok(Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect())
}

fn is_executable(file: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::metadata(file).is_ok_and(|about| about.permissions().mode() & 0o100 != 0)
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        false
    }
}
