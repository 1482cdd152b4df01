//! Makes a worker of a submission: one `rustc` for the exercises, one for the program, both in a sandbox, against libraries
//! that were built once. Cargo is not asked, so no two submissions ever share what cargo would take for fresh.

use super::result::Outcome;
use crate::sandbox::{self, Confinement, Ended, How, Purpose, Sandbox};
use crate::sync::stage_of;
use anyhow::{Context, Result, ensure};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

mod blame;
mod libraries;

/// A class is compiled in minutes only if nobody takes more than this; the reference takes a second.
const COMPILER_PATIENCE: Duration = Duration::from_secs(60);

/// How much of the compiler's messages is read. Each error is a few kilobytes of JSON.
const MOST_MESSAGES: usize = 4 << 20;

/// What workers are made with.
pub struct Forge {
    rustc: PathBuf,
    toolchain: PathBuf,
    /// The scaffold and foreign crates, nothing else: whatever lies here a submission can read.
    libraries: PathBuf,
    /// The exercises as nobody has begun them, and what connects them.
    pristine: BTreeMap<String, String>,
    /// Lerp the compiler and the machine.
    confinement: Confinement,
}

/// What came of it.
pub struct Forged {
    /// The program that answers.
    pub worker: PathBuf,
    /// Files in whose place the empty exercise was put, with the outcome of their checks and the reason.
    pub replaced: BTreeMap<String, (Outcome, String)>,
    /// Processor time.
    pub cpu: Duration,
}

impl Forge {
    /// Builds the libraries, if that has not been done, and looks at what is there.
    pub fn prepare(root: &Path, confinement: Confinement) -> Result<Forge> {
        let toolchain = PathBuf::from(said_by(Command::new("rustc").args(["--print", "sysroot"]))?);
        let rustc = toolchain.join("bin/rustc");
        ensure!(rustc.is_file(), "no compiler at {}", rustc.display());
        let pristine = crate::sync::pristine(root)?;
        Ok(Forge { libraries: libraries::build(root)?, rustc, toolchain, pristine, confinement })
    }

    /// The names of the files in which students write.
    pub fn exercises(&self) -> Vec<String> {
        self.pristine.keys().filter(|name| stage_of(name).is_some()).cloned().collect()
    }

    /// Whether this is the exercise as nobody has begun it.
    pub fn is_untouched(&self, name: &str, text: &str) -> bool {
        self.pristine.get(name).is_some_and(|pristine| pristine == text)
    }

    /// Fingerprint of the exercises, the glue and the libraries.
    pub fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        self.pristine.iter().for_each(|(name, text)| hash.update(format!("{name}\0{text}\0")));
        hash.update(self.libraries.to_string_lossy().as_bytes());
        hex(&hash.finalize())
    }

    /// Compiles these files, in `scratch`, an empty folder. Files that stand in the way of a program are replaced by the
    /// empty exercise, one after the other.
    pub fn build(&self, scratch: &Path, files: &BTreeMap<String, String>) -> Result<Forged> {
        let mut cpu = Duration::ZERO;
        let mut replaced = BTreeMap::new();
        loop {
            self.lay_out(scratch, files, &replaced)?;
            let ended = self.compile_exercises(scratch)?;
            cpu += ended.cpu;
            if ended.how == How::Exited(0) {
                break;
            }
            let present =
                |name: &&String| !replaced.contains_key(*name) && !self.is_untouched(name, &files[*name]);
            let suspects: Vec<&String> = files.keys().filter(present).collect();
            ensure!(!suspects.is_empty(), "the empty exercises do not compile:\n{}", text_of(&ended));
            let verdict = blame::blame(&ended, &suspects);
            if verdict.is_empty() {
                // The compiler died without a word: whose file is it? Each is tried alone.
                for name in suspects {
                    let alone = files.keys().filter(|other| *other != name).chain(replaced.keys());
                    let alone = alone
                        .map(|other| (other.clone(), (Outcome::DoesNotCompile, String::new())))
                        .collect();
                    self.lay_out(scratch, files, &alone)?;
                    let ended = self.compile_exercises(scratch)?;
                    cpu += ended.cpu;
                    if ended.how != How::Exited(0) {
                        replaced.insert(name.clone(), (Outcome::DoesNotCompile, died(&ended)));
                    }
                }
                ensure!(!replaced.is_empty(), "the compiler ended without a message: {}", died(&ended));
            }
            replaced.extend(verdict.into_iter().map(|(name, why)| (name, (Outcome::DoesNotCompile, why))));
        }
        let ended = self.link_worker(scratch)?;
        cpu += ended.cpu;
        let worker = scratch.join("out/worker");
        if ended.how != How::Exited(0) {
            let suspects: Vec<&String> =
                files.keys().filter(|name| !self.is_untouched(name, &files[*name])).collect();
            ensure!(
                !suspects.is_empty(),
                "the worker cannot be linked: {}\n{}",
                died(&ended),
                text_of(&ended)
            );
            // Nobody knows whose fault it is, so all that was written is left out.
            let why = format!("what was written compiles and cannot be linked: {}\n", died(&ended));
            let all: BTreeMap<_, _> = suspects
                .into_iter()
                .map(|name| (name.clone(), (Outcome::DoesNotCompile, why.clone())))
                .collect();
            let mut empty = self.build(scratch, &BTreeMap::new())?;
            empty.replaced.extend(all);
            empty.cpu += cpu;
            return Ok(empty);
        }
        Ok(Forged { worker, replaced, cpu })
    }

    fn lay_out(
        &self,
        scratch: &Path,
        files: &BTreeMap<String, String>,
        replaced: &BTreeMap<String, (Outcome, String)>,
    ) -> Result<()> {
        let folder = scratch.join("exercises/src");
        fs::create_dir_all(&folder)?;
        fs::create_dir_all(scratch.join("out"))?;
        for (name, pristine) in &self.pristine {
            let text = files.get(name).filter(|_| stage_of(name).is_some() && !replaced.contains_key(name));
            fs::write(folder.join(name), text.unwrap_or(pristine))?;
        }
        Ok(())
    }

    /// Compiles the exercises, without the feature `frames`: no check asks for a frame, and the renderer is the larger
    /// part of what the compiler would have to do for each submission.
    fn compile_exercises(&self, scratch: &Path) -> Result<Ended> {
        let arguments = [
            "exercises/src/lib.rs",
            "--crate-name=exercises",
            "--crate-type=rlib",
            "--emit=link",
            "-o",
            "out/libexercises.rlib",
            // Not --cap-lints, which would turn the next line into a warning.
            "-Awarnings",
            "-Funsafe_code",
            "--error-format=json",
        ];
        self.compile(Purpose::Compiler, scratch, &arguments, &["raykata", "glam"])
    }

    /// Links the program that answers with the exercises.
    fn link_worker(&self, scratch: &Path) -> Result<Ended> {
        let arguments = [
            "exercises/src/worker.rs",
            "--crate-name=worker",
            "--crate-type=bin",
            "-o",
            "out/worker",
            "--extern=exercises=out/libexercises.rlib",
            "-Cstrip=debuginfo",
        ];
        self.compile(Purpose::Linker, scratch, &arguments, &["raykata"])
    }

    fn compile(
        &self,
        purpose: Purpose,
        scratch: &Path,
        arguments: &[&str],
        externs: &[&str],
    ) -> Result<Ended> {
        let sandbox = Sandbox {
            readable: vec![self.toolchain.clone(), self.libraries.clone()],
            writable: vec![scratch.to_owned()],
            ..Sandbox::with(self.confinement, purpose)
        };
        let mut command = sandbox.command(&self.rustc);
        command.current_dir(scratch).args(arguments).args(["--edition=2024", "-Cdebuginfo=0"]);
        // An exercise is asked so little that optimising it costs more than its answers take.
        command.args(["-Copt-level=0", "-Ccodegen-units=2", "-Cembed-bitcode=no"]);
        command.arg(option("-Ldependency=", &self.libraries));
        for name in externs {
            command
                .arg(option(&format!("--extern={name}="), &self.libraries.join(format!("lib{name}.rlib"))));
        }
        sandbox::run(command, &[], COMPILER_PATIENCE, MOST_MESSAGES).context("the compiler cannot be started")
    }
}

fn option(name: &str, path: &Path) -> OsString {
    let mut option = OsString::from(name);
    option.push(path);
    option
}

fn died(ended: &Ended) -> String {
    match ended.how {
        How::Exited(code) => format!("the compiler ended with code {code}"),
        How::Signalled(6 | 9 | 11) => {
            "the compiler ran out of memory or stack: something here grows without end while it is compiled"
                .into()
        }
        How::Signalled(signal) => format!("the compiler was ended by signal {signal}"),
        How::TookTooLong | How::UsedUpCpu => {
            "the compiler did not come to an end in time: something here never ends while it is compiled"
                .into()
        }
        How::TooManyProcesses => "the compiler started more processes than it needs".into(),
        How::WroteTooMuch => "the compiler had more to say than anybody can read".into(),
    }
}

fn text_of(ended: &Ended) -> String {
    String::from_utf8_lossy(&ended.stderr).chars().take(4000).collect()
}

fn said_by(command: &mut Command) -> Result<String> {
    let output = command.output().context("rustc, which compiles submissions, cannot be started")?;
    ensure!(output.status.success(), "rustc says: {}", String::from_utf8_lossy(&output.stderr));
    Ok(String::from_utf8(output.stdout)?.trim().to_owned())
}

pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
