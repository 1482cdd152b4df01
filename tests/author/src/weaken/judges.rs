//! Builds the judge with a changed check, and asks it for verdicts.
//!
//! It is built in a folder that contains copies of the checks and of what they need, as a [build folder] of the corpus is.
//!
//! [build folder]: crate::corpus::build_folder

use crate::corpus::FOLDER;
use crate::corpus::build_folder::{copy_folder, copy_with_times, cut_manifest, read, write_if_new};
use crate::corpus::verdict::without_lines;
use all_checks::STAGES;
use anyhow::{Context, Result, bail};
use checks::Check;
use grader::kits::Source as Kits;
use grader::room::has_room;
use raykata::rubric;
use raykata::worker::{receive, send};
use raykata_cli::verdicts::{CheckTrial, Verdict};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::SystemTime;

/// The judge is built without debug information, and only the functions that changed are compiled.
const QUICK_BUILD: [&str; 12] = [
    "--config",
    "profile.dev.debug=false",
    "--config",
    "profile.dev.package.raykata.opt-level=1",
    "--config",
    "profile.dev.package.judge.opt-level=0",
    "--config",
    "profile.dev.package.judge.incremental=true",
    "--config",
    "profile.dev.package.all-checks.incremental=true",
    "--config",
    "profile.dev.package.all-checks.opt-level=0",
];

/// The most memory of a changed judge in KB: a changed loop may allocate without end.
const MEMORY: u64 = 8 << 20;

/// The most processor time of a changed judge in seconds: a changed loop may not end. All trials of a change take less.
const SECONDS: u64 = 90;

/// The folder in which judges are built.
pub(super) struct Judges {
    root: PathBuf,
    folder: PathBuf,
}

impl Judges {
    /// Copies the checks of the kit, and builds the judge without a change.
    pub fn open(root: &Path) -> Result<Judges> {
        let folder = root.join(FOLDER).join("checks");
        let judges = Judges { root: root.to_owned(), folder };
        judges.copy()?;
        if judges.build()?.is_none() {
            bail!("the unchanged judge does not compile");
        }
        Ok(judges)
    }

    fn copy(&self) -> Result<()> {
        let mut packages: Vec<String> =
            ["src/cli", "tests/checks", "tests/checks/all", "tests/judge", "tests/oracle"]
                .map(str::to_owned)
                .to_vec();
        packages.extend(STAGES.iter().map(|(stage, _)| format!("tests/checks/stage{stage}")));
        let members: Vec<&str> = packages.iter().map(String::as_str).collect();
        for package in [""].iter().chain(&members) {
            let (from, to) = (self.root.join(package), self.folder.join(package));
            copy_folder(&from.join("src"), &to.join("src"))?;
            let manifest = read(&from.join("Cargo.toml"))?;
            let without = ["dev-dependencies", "[test]", "[bench]"];
            write_if_new(&to.join("Cargo.toml"), &cut_manifest(&manifest, &without, &members))?;
        }
        for file in rubric::files().chain(["Cargo.lock"]) {
            if file != "Cargo.lock" || !self.folder.join(file).exists() {
                write_if_new(&self.folder.join(file), &read(&self.root.join(file))?)?;
            }
        }
        copy_with_times(&self.root.join("tests/golden"), &self.folder.join("tests/golden"))
    }

    /// Builds the judge with the text of a file of the checks replaced. `None` if it does not compile.
    pub fn changed(&self, file: &str, text: &str) -> Result<Option<PathBuf>> {
        let before = modified(&self.program());
        let path = self.folder.join(file);
        write_if_new(&path, text)?;
        let built = self.build();
        write_if_new(&path, &read(&self.root.join(file))?)?;
        let Some(judge) = built? else { return Ok(None) };
        // Its verdicts would be those of another change.
        if modified(&judge) == before {
            bail!("cargo found no change in {}: remove it and run this again", self.folder.display());
        }
        Ok(Some(judge))
    }

    fn program(&self) -> PathBuf {
        self.folder.join("target/debug/judge")
    }

    /// Builds the judge. `None` if it does not compile.
    fn build(&self) -> Result<Option<PathBuf>> {
        let output = Command::new(cargo())
            .current_dir(&self.folder)
            .args(["build", "--quiet", "--package", "judge", "--bin", "judge", "--target-dir", "target"])
            .args(QUICK_BUILD)
            .stdin(Stdio::null())
            .output()
            .context("cargo, which builds the judge, cannot be started")?;
        if output.status.success() {
            return Ok(Some(self.program()));
        }
        has_room(&self.folder, "delete something")?;
        Ok(None)
    }
}

/// A program that may not use more memory and processor time than a changed judge.
fn limited(program: &OsStr) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("ulimit -v {MEMORY}; ulimit -t {SECONDS}; exec \"$0\" \"$@\"")])
        .arg(program);
    command
}

fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

fn modified(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|file| file.modified()).ok()
}

/// A running judge.
pub(super) struct Judge {
    process: Child,
    asks: ChildStdin,
    answers: ChildStdout,
}

impl Judge {
    /// Starts a judge.
    pub fn start(program: &Path) -> Result<Judge> {
        let mut process = limited(program.as_os_str())
            .arg("trials")
            // A judge writes messages to its output, so a snapshot that differs may not be printed there.
            .envs([("INSTA_OUTPUT", "none"), ("INSTA_UPDATE", "no")])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("the judge cannot be started")?;
        let asks = process.stdin.take().context("the judge has no input")?;
        let answers = process.stdout.take().context("the judge has no output")?;
        Ok(Judge { process, asks, answers })
    }

    /// The message of a check about a kit; `None` if the kit passes. The messages of a judge that crashes are like no other.
    pub fn message(&mut self, check: &Check, kit: &Kits) -> Result<Option<String>> {
        let asked = CheckTrial {
            stage: check.stage,
            check: check.name.to_owned(),
            worker: kit.program.clone(),
            needs_message: true,
        };
        let answer = send(&mut self.asks, &asked).and_then(|()| receive(&mut self.answers));
        match answer {
            Ok(Verdict::Passed) => Ok(None),
            Ok(Verdict::Failed(message)) => Ok(Some(without_lines(&message))),
            Ok(Verdict::NotWritten { task, .. }) => Ok(Some(task)),
            Err(error) if matches!(error.kind(), ErrorKind::BrokenPipe | ErrorKind::UnexpectedEof) => {
                Ok(Some("the changed judge has crashed".to_owned()))
            }
            Err(error) => Err(error).context("the judge does not answer"),
        }
    }
}

impl Drop for Judge {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
