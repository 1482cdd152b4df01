//! The kits: the exercises and the solutions. Both run in worker programs, which cargo builds when they are
//! needed and with which this program communicates through a pipe; it links neither.

use crate::args::{Given, Misuse, Opt, names};
use crate::worker::{CALL_PATIENCE, Worker};
use anyhow::{Context, Result, anyhow, bail};
use raykata::kit::{Door, Kit};
use std::ffi::OsStr;
use std::io::{BufRead, BufReader, IsTerminal, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Arc;

/// The kit whose code is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Your code in exercises/.
    Exercises,
    /// The reference in solutions/.
    Solutions,
}

impl Which {
    /// The names of both, which are those of their packages.
    pub const NAMES: [(&str, Which); 2] = [("exercises", Which::Exercises), ("solutions", Which::Solutions)];

    /// The name of the kit's package.
    pub fn package(self) -> &'static str {
        Which::NAMES[self as usize].0
    }
}

/// The option that selects the kit of a command.
#[derive(Clone, Copy, Debug)]
pub struct Choice(Option<Which>);

impl Choice {
    /// The option.
    pub const OPTIONS: &[Opt] = &[Opt::value(
        "--kit",
        "NAME",
        "The code to use [default: solutions if there are any, else exercises; for `check` and `race`: exercises].",
    )
    .choices(&names(&Which::NAMES))];

    /// Reads the option.
    pub fn read(given: &Given) -> Result<Choice, Misuse> {
        Ok(Choice(given.choice("--kit", &Which::NAMES)?))
    }

    /// The selected kit. By default the solutions, if there are any; a student's repository has none.
    pub fn or_reference(self, root: &Path) -> Which {
        let default = if has_solutions(root) { Which::Solutions } else { Which::Exercises };
        self.0.unwrap_or(default)
    }

    /// Builds the selected kit with the renderer, and starts it. By default it is that of [`Choice::or_reference`].
    pub fn start(self) -> Result<Arc<dyn Kit + Send + Sync>> {
        let root = root()?;
        Ok(Source::prepare(&root, self.or_reference(&root), Need::Frames)?.fresh())
    }

    /// The selected kit. By default the exercises.
    pub fn or_exercises(self) -> Which {
        self.0.unwrap_or(Which::Exercises)
    }
}

/// Whether the reference is here, as it is in no hand-out.
pub fn has_solutions(root: &Path) -> bool {
    root.join("solutions/Cargo.toml").is_file()
}

/// The option that must be added to a command so that it uses the exercises; empty if that is the default.
pub fn with_exercises(root: &Path) -> &'static str {
    if has_solutions(root) { " --kit exercises" } else { "" }
}

/// The use of a worker. Frames need the renderer, which takes time to build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Rendering frames and calling student functions.
    Frames,
    /// Calling student functions only.
    Checks,
}

impl Need {
    /// The feature that a worker must be built with.
    pub fn feature(self) -> Option<&'static str> {
        (self == Need::Frames).then_some("frames")
    }
}

/// Starts kits of one kind.
pub struct Source {
    /// Which kit it is.
    pub which: Which,
    /// The path of the worker program.
    pub program: PathBuf,
}

impl Source {
    /// Builds the worker if it is not up to date.
    pub fn prepare(root: &Path, which: Which, need: Need) -> Result<Source> {
        let what = match which {
            Which::Exercises => "your exercises",
            Which::Solutions => "the solutions",
        };
        let [program] = build(root, what, [Program::worker(which, need)])?;
        Ok(Source { which, program })
    }

    /// A new kit, with a process of its own.
    pub fn fresh(&self) -> Arc<dyn Kit + Send + Sync> {
        Arc::new(Door(Worker::new(self.program.clone(), CALL_PATIENCE)))
    }
}

/// A program of this workspace.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// The package that it is in.
    pub package: &'static str,
    /// Its name.
    pub name: &'static str,
    /// A feature that it must be built with.
    pub feature: Option<&'static str>,
}

impl Program {
    /// The worker of a kit.
    pub fn worker(which: Which, need: Need) -> Program {
        // The two have different names, so that two builds at the same time do not overwrite each other.
        let name = match (which, need) {
            (Which::Exercises, Need::Checks) => "exercises-worker",
            (Which::Exercises, Need::Frames) => "exercises-frames",
            (Which::Solutions, Need::Checks) => "solutions-worker",
            (Which::Solutions, Need::Frames) => "solutions-frames",
        };
        Program { package: which.package(), name, feature: need.feature() }
    }

    /// The program that runs the checks.
    pub const JUDGE: Program = Program { package: "judge", name: "judge", feature: None };

    /// The program that follows a student's edits.
    pub const WATCH: Program = Program { package: "live", name: "watch", feature: None };

    /// The program that shows pictures in a browser.
    pub const VIEW: Program = Program { package: "live", name: "view", feature: None };

    /// The program that updates a student's kit.
    pub const UPDATE: Program = Program { package: "live", name: "update", feature: None };

    /// The program that makes the figures of the slides.
    pub const FIGURES: Program = Program { package: "figures", name: "figures", feature: None };

    /// The program that renders and measures.
    pub const RAYKATA: Program = Program { package: "raykata-cli", name: "raykata", feature: None };
}

/// Builds programs of the workspace at `root` in the profile of this program, and returns their paths. If
/// something has to be built, it prints a line that names `what`, followed by the output of cargo.
pub fn build<const N: usize>(root: &Path, what: &str, programs: [Program; N]) -> Result<[PathBuf; N]> {
    let built = run_build(cargo_build(root, &programs)?, what)?;
    let path = |program: &Program| built.path(program.name);
    let paths = programs.iter().map(path).collect::<Result<Vec<_>>>()?;
    paths.try_into().map_err(|_| anyhow!("cargo has not built all programs"))
}

/// Runs a build by cargo in the profile of this program, as [`run_cargo`] does.
pub fn run_build(mut cargo: Command, what: &str) -> Result<BuiltPrograms> {
    cargo.arg("--message-format=json-render-diagnostics");
    let messages = run_cargo(cargo, what)?;
    let mut built = BuiltPrograms::default();
    String::from_utf8_lossy(&messages).lines().for_each(|line| built.add(line));
    Ok(built)
}

/// The programs that cargo has built, with their names. Only cargo knows their paths: they depend on the target, the profile,
/// settings and environment variables.
#[derive(Default)]
pub struct BuiltPrograms(Vec<(String, PathBuf)>);

impl BuiltPrograms {
    /// Adds the program, or the library of WebAssembly, of a line that cargo writes in the format JSON, if the line is about one.
    pub fn add(&mut self, line: &str) {
        let Ok(message) = serde_json::from_str::<serde_json::Value>(line) else { return };
        let files = message["filenames"].as_array().into_iter().flatten().filter_map(|file| file.as_str());
        let library = || files.clone().find(|file| file.ends_with(".wasm"));
        let path = message["executable"].as_str().or_else(library);
        if let (Some(name), Some(path)) = (message["target"]["name"].as_str(), path) {
            self.0.push((name.to_owned(), path.into()));
        }
    }

    /// The path of the program with this name; fails if it was not built.
    pub fn path(&self, name: &str) -> Result<PathBuf> {
        let found = self.0.iter().find(|(built, _)| built == name);
        Ok(found.with_context(|| format!("cargo has not built the program {name}"))?.1.clone())
    }
}

/// Runs a program with these words to its end, and returns its exit code; 1 if it was killed. On Unix it takes the place of this
/// process, so that a signal to this process ends the program.
pub fn run_program(program: &Path, words: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Result<ExitCode> {
    let mut command = Command::new(program);
    command.args(words);
    #[cfg(unix)]
    let status: std::io::Result<std::process::ExitStatus> =
        Err(std::os::unix::process::CommandExt::exec(&mut command));
    #[cfg(not(unix))]
    let status = command.status();
    let status = status.with_context(|| format!("{} cannot be started", program.display()))?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}

/// The command that builds the workspace at `root` in the profile of this program.
pub fn cargo_in(root: &Path) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root).arg("build");
    if let Some(profile) = profile() {
        cargo.arg(format!("--profile={profile}"));
    }
    cargo
}

/// The command that builds programs of the workspace at `root` in the target folder and the profile of this program.
pub fn cargo_build(root: &Path, programs: &[Program]) -> Result<Command> {
    let mut cargo = cargo_in(root);
    for program in programs {
        if program.package == Which::Solutions.package() && !has_solutions(root) {
            bail!("there are no solutions in {}: omit `--kit solutions`", root.display());
        }
        cargo.args(["--package", program.package, "--bin", program.name]);
        if let Some(feature) = program.feature {
            // Pass the feature without the name of the package: the solutions depend on themselves in their
            // tests, and cargo would read `solutions/frames` as a feature of that dependency.
            cargo.args(["--features", feature]);
        }
    }
    if let Some(folder) = target_folder() {
        cargo.arg("--target-dir").arg(folder);
    }
    Ok(cargo)
}

/// The folder of a profile inside of the target folder, in which cargo has built this program; `None` for a copy elsewhere.
fn profile_folder() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?;
    // Tests lie in a folder `deps` inside of that with the name of the profile, in which cargo keeps its fingerprints.
    let folder = program.ancestors().skip(1).find(|folder| !folder.ends_with("deps"))?;
    folder.join(".fingerprint").is_dir().then(|| folder.to_owned())
}

/// The target folder in which cargo has built this program; `None` for a copy elsewhere.
pub fn target_folder() -> Option<PathBuf> {
    // Cargo writes this file into each target folder.
    let folder = profile_folder()?;
    folder.ancestors().skip(1).find(|folder| folder.join(".rustc_info.json").is_file()).map(Path::to_owned)
}

/// The profile in which cargo has built this program; `None` for `dev`, and for a copy elsewhere.
pub fn profile() -> Option<String> {
    let name = profile_folder()?.file_name()?.to_str()?.to_owned();
    (name != "debug").then_some(name)
}

/// Runs a build by cargo and returns what it writes to standard output. If something has to be built, or if the build waits for
/// another one, it prints a line that names `what`, followed by the messages of cargo.
pub fn run_cargo(mut cargo: Command, what: &str) -> Result<Vec<u8>> {
    if std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none() {
        cargo.env("CARGO_TERM_COLOR", "always");
    }
    let started = cargo.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut running = started.context("cargo, which builds the kit, cannot be started")?;
    // Read both outputs at the same time, because a full pipe would stop cargo.
    let stdout = running.stdout.take();
    let reader = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        stdout.map_or(Ok(0), |mut stdout| stdout.read_to_end(&mut bytes)).map(|_| bytes)
    });
    // Show its messages as soon as something is compiled.
    let mut output = CargoOutput { what, held_back: Vec::new(), building: false };
    if let Some(stderr) = running.stderr.take() {
        for line in BufReader::new(stderr).split(b'\n') {
            output.line(String::from_utf8_lossy(&line?).into_owned());
        }
    }
    if !running.wait()?.success() {
        output.begin();
        bail!("{what} cannot be built: see the errors of the compiler above");
    }
    // Reading cannot panic.
    reader
        .join()
        .map_err(|_| anyhow!("the output of cargo is lost"))?
        .context("the output of cargo cannot be read")
}

/// Filters the output of cargo: it shows nothing while everything is up to date.
struct CargoOutput<'a> {
    what: &'a str,
    /// Lines that are held back, such as warnings of crates that were built before.
    held_back: Vec<String>,
    building: bool,
}

impl CargoOutput<'_> {
    fn line(&mut self, line: String) {
        let plain = without_colours(&line);
        let word = plain.split_whitespace().next().unwrap_or_default();
        let begins =
            ["Compiling", "Blocking", "Downloading", "Downloaded", "Updating", "Locking", "Building"];
        if begins.contains(&word) {
            self.begin();
        }
        match word {
            "Finished" => {}
            _ if self.building => eprintln!("{line}"),
            _ => self.held_back.push(line),
        }
    }

    /// Shows everything from here on.
    fn begin(&mut self) {
        if !self.building {
            eprintln!("building {} …", self.what);
            self.building = true;
        }
        self.held_back.drain(..).for_each(|line| eprintln!("{line}"));
    }
}

fn without_colours(line: &str) -> String {
    let mut plain = String::new();
    let mut inside = false;
    for letter in line.chars() {
        match letter {
            '\u{1b}' => inside = true,
            'm' if inside => inside = false,
            _ if inside => {}
            _ => plain.push(letter),
        }
    }
    plain
}

/// The folder of the kit: the one with `exercises/` at or above the current folder, or else above this program.
pub fn root() -> Result<PathBuf> {
    let here = std::env::current_dir().context("the current folder is gone")?;
    let program = std::env::current_exe().unwrap_or_default();
    let is_kit = |folder: &&Path| {
        folder.join("exercises/Cargo.toml").is_file() && folder.join("tests/course.toml").is_file()
    };
    match here.ancestors().chain(program.ancestors()).find(is_kit) {
        Some(root) => Ok(root.to_owned()),
        None => bail!(
            "no kit at or above {}: go to the folder that holds exercises/ and try again",
            here.display()
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::without_colours;

    #[test]
    fn colours_are_no_words() {
        assert_eq!(without_colours("\u{1b}[1m\u{1b}[92m   Compiling\u{1b}[0m glam"), "   Compiling glam");
        assert_eq!(without_colours("memory"), "memory");
    }
}
