//! Builds the worker of a submission: one call of `rustc` for the exercises and one for the program, both in a sandbox. The
//! libraries were built once. Cargo is not used, because it might take the build of one submission for that of another.

use super::once::Once;
use super::result::Outcome;
use super::submission::helpers;
use crate::exercises::stage_of;
use crate::sandbox::{self, Confinement, Ended, How, Purpose, Sandbox};
use anyhow::{Context, Result, ensure};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

mod blame;
mod libraries;

/// Time limit of the compiler per call. The reference takes a second.
pub const COMPILER_PATIENCE: Duration = Duration::from_secs(60);

/// Most bytes of compiler messages that are read. Each error is a few kilobytes of JSON.
const MOST_MESSAGES: usize = 4 << 20;

/// Builds workers.
#[derive(Clone)]
pub struct WorkerBuilder {
    rustc: PathBuf,
    toolchain: PathBuf,
    /// A folder with the compiled scaffold and foreign crates. It contains nothing else, because a submission can read it.
    libraries: PathBuf,
    /// The untouched exercises and the glue that connects them with the kit.
    pristine: BTreeMap<String, String>,
    /// The sandbox around the compiler.
    confinement: Confinement,
    /// Time limit of the compiler per call.
    patience: Duration,
    /// The workers that were built before, by their files, if equal files need not be compiled again.
    shared: Option<Arc<SharedWorkers>>,
}

/// Workers by the texts of their files, without untouched exercises.
type SharedWorkers = Once<BTreeMap<String, String>, Arc<SharedWorker>>;

/// A worker that may be used several times.
struct SharedWorker {
    program: Vec<u8>,
    replaced: BTreeMap<String, (Outcome, String)>,
    cpu: Duration,
}

/// The result of a build.
pub struct BuiltWorker {
    /// The path of the worker program.
    pub worker: PathBuf,
    /// Files that the empty exercise replaces, with the outcome of their checks and the reason.
    pub replaced: BTreeMap<String, (Outcome, String)>,
    /// Processor time of the build.
    pub cpu: Duration,
}

impl WorkerBuilder {
    /// Builds the libraries if necessary, and reads the untouched exercises.
    pub fn prepare(root: &Path, confinement: Confinement) -> Result<WorkerBuilder> {
        let toolchain = PathBuf::from(said_by(Command::new("rustc").args(["--print", "sysroot"]))?);
        let rustc = toolchain.join("bin/rustc");
        ensure!(rustc.is_file(), "no compiler at {}", rustc.display());
        let pristine = crate::exercises::pristine(root)?;
        Ok(WorkerBuilder {
            libraries: libraries::build(root)?,
            rustc,
            toolchain,
            pristine,
            confinement,
            patience: COMPILER_PATIENCE,
            shared: None,
        })
    }

    /// Ends the compiler after another time.
    pub fn with_patience(self, patience: Duration) -> WorkerBuilder {
        WorkerBuilder { patience, ..self }
    }

    /// Compiles equal files only once.
    pub fn with_shared_workers(self) -> WorkerBuilder {
        WorkerBuilder { shared: Some(Arc::default()), ..self }
    }

    /// Returns the names of the exercise files.
    pub fn exercises(&self) -> Vec<String> {
        self.pristine.keys().filter(|name| stage_of(name).is_some()).cloned().collect()
    }

    /// Returns whether this is the text of the untouched exercise.
    pub fn is_untouched(&self, name: &str, text: &str) -> bool {
        self.pristine.get(name).is_some_and(|pristine| pristine == text)
    }

    /// Returns a fingerprint of the exercises, the glue and the libraries.
    pub fn fingerprint(&self) -> String {
        let mut hash = Sha256::new();
        self.pristine.iter().for_each(|(name, text)| hash.update(format!("{name}\0{text}\0")));
        hash.update(self.libraries.to_string_lossy().as_bytes());
        hex(&hash.finalize())
    }

    /// Compiles these files in the empty folder `scratch`. While the build fails, the empty exercise replaces the files
    /// that cause the errors.
    pub fn build(&self, scratch: &Path, files: &BTreeMap<String, String>) -> Result<BuiltWorker> {
        let Some(shared) = &self.shared else { return self.build_alone(scratch, files) };
        let written = files.iter().filter(|(name, text)| !self.is_untouched(name, text));
        let written = written.map(|(name, text)| (name.clone(), text.clone())).collect();
        let known = shared.get(written, || {
            let BuiltWorker { worker, replaced, cpu } = self.build_alone(scratch, files)?;
            Ok(Arc::new(SharedWorker { program: fs::read(worker)?, replaced, cpu }))
        })?;
        let worker = scratch.join("out/worker");
        fs::create_dir_all(scratch.join("out"))?;
        fs::write(&worker, &known.program)?;
        fs::set_permissions(&worker, fs::Permissions::from_mode(0o755))?;
        Ok(BuiltWorker { worker, replaced: known.replaced.clone(), cpu: known.cpu })
    }

    fn build_alone(&self, scratch: &Path, files: &BTreeMap<String, String>) -> Result<BuiltWorker> {
        let mut cpu = Duration::ZERO;
        let mut replaced = BTreeMap::new();
        // Compile the exercises. Replace the files with errors until the rest compiles.
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
                // The compiler died without a message, or its errors lie in the glue. Compile each file alone to find the
                // cause, unless there is only one.
                let is_only = suspects.len() == 1;
                for name in suspects {
                    if is_only {
                        replaced.insert(name.clone(), (Outcome::DoesNotCompile, why(&ended)));
                        break;
                    }
                    let alone = files.keys().filter(|other| *other != name).chain(replaced.keys());
                    let alone = alone
                        .map(|other| (other.clone(), (Outcome::DoesNotCompile, String::new())))
                        .collect();
                    self.lay_out(scratch, files, &alone)?;
                    let ended = self.compile_exercises(scratch)?;
                    cpu += ended.cpu;
                    if ended.how != How::Exited(0) {
                        replaced.insert(name.clone(), (Outcome::DoesNotCompile, why(&ended)));
                    }
                }
                ensure!(!replaced.is_empty(), "the compiler ended without a message: {}", died(&ended));
            }
            replaced.extend(verdict.into_iter().map(|(name, why)| (name, (Outcome::DoesNotCompile, why))));
        }
        // Link the worker.
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
            // A linker error does not name a file, so replace all files of the student.
            let why = format!("the files compile but cannot be linked: {}\n", died(&ended));
            let all = suspects.into_iter().map(|name| (name.clone(), (Outcome::DoesNotCompile, why.clone())));
            let mut empty = self.build_alone(scratch, &BTreeMap::new())?;
            empty.replaced.extend(all);
            empty.cpu += cpu;
            return Ok(empty);
        }
        Ok(BuiltWorker { worker, replaced, cpu })
    }

    fn lay_out(
        &self,
        scratch: &Path,
        files: &BTreeMap<String, String>,
        replaced: &BTreeMap<String, (Outcome, String)>,
    ) -> Result<()> {
        let folder = scratch.join("exercises/src");
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir_all(&folder)?;
        fs::create_dir_all(scratch.join("out"))?;
        for (name, pristine) in &self.pristine {
            let text = files.get(name).filter(|_| stage_of(name).is_some() && !replaced.contains_key(name));
            // The compiler refuses every level but `deny`, also a harmless one.
            let text = text.unwrap_or(pristine).replace("warn(unsafe_code)", "deny(unsafe_code)");
            fs::write(folder.join(name), text)?;
        }
        // Add the modules that the student has added.
        let is_module = |name: &&String| !self.pristine.contains_key(*name) && !replaced.contains_key(*name);
        for name in files.keys().filter(is_module) {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap_or(&folder))?;
            fs::write(path, &files[name])?;
        }
        let mut library = fs::OpenOptions::new().append(true).open(folder.join("lib.rs"))?;
        library.write_all(helpers::lines(files.keys().filter(is_module)).as_bytes())?;
        Ok(())
    }

    /// Compiles the exercises without the feature `frames`. No check asks for a frame, and the renderer would be the larger
    /// part of each build.
    fn compile_exercises(&self, scratch: &Path) -> Result<Ended> {
        let arguments = [
            "exercises/src/lib.rs",
            "--crate-name=exercises",
            "--crate-type=rlib",
            "--emit=link",
            "-o",
            "out/libexercises.rlib",
            // Do not use --cap-lints: it would turn the error of the next line into a warning.
            "-Awarnings",
            "-Funsafe_code",
            "--error-format=json",
        ];
        self.compile(Purpose::Compiler, scratch, &arguments, &["raykata", "glam"])
    }

    /// Links the worker program with the exercises.
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
        // Do not optimise: the checks ask so little that optimisation would take longer than the answers.
        command.args(["-Copt-level=0", "-Ccodegen-units=1", "-Cembed-bitcode=no"]);
        command.arg(option("-Ldependency=", &self.libraries));
        for name in externs {
            command
                .arg(option(&format!("--extern={name}="), &self.libraries.join(format!("lib{name}.rlib"))));
        }
        sandbox::run(command, &[], self.patience, MOST_MESSAGES).context("the compiler cannot be started")
    }
}

fn option(name: &str, path: &Path) -> OsString {
    let mut option = OsString::from(name);
    option.push(path);
    option
}

/// Returns why a file does not compile although no message of the compiler names it.
fn why(ended: &Ended) -> String {
    match blame::texts(ended) {
        errors if errors.is_empty() => died(ended),
        errors => format!("{}{errors}", blame::OLDER),
    }
}

fn died(ended: &Ended) -> String {
    match ended.how {
        How::Exited(code) => format!("the compiler ended with code {code}"),
        How::Signalled(6 | 9 | 11) => {
            "the compiler ran out of memory or stack: some code here grows without end during compilation"
                .into()
        }
        How::Signalled(signal) => format!("the compiler was ended by signal {signal}"),
        How::TookTooLong | How::UsedUpCpu => {
            "the compiler exceeded its time limit: the compilation of some code here never ends".into()
        }
        How::TooManyProcesses => "the compiler started more processes than it needs".into(),
        How::WroteTooMuch => "the compiler printed too many messages".into(),
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
