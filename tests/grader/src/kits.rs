//! Whose code answers: the reference, which is linked, or the exercises, which run in a worker.

use crate::worker::{CALL_PATIENCE, Worker};
use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use raykata::kit::{Door, Kit};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// Whose code to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Which {
    /// Your code in exercises/, in a process of its own.
    Exercises,
    /// The reference in solutions/.
    #[cfg(feature = "author")]
    Solutions,
}

/// Whose code a command uses, where there is a choice.
#[derive(Args, Clone, Copy, Debug)]
pub struct Choice {
    /// Whose code to use [default: solutions; for `check`: exercises].
    #[cfg(feature = "author")]
    #[arg(long, value_enum)]
    kit: Option<Which>,
}

#[cfg(feature = "author")]
impl Choice {
    /// The reference, if nothing else was said.
    pub fn or_reference(self) -> Which {
        self.kit.unwrap_or(Which::Solutions)
    }

    /// The exercises, if nothing else was said.
    pub fn or_exercises(self) -> Which {
        self.kit.unwrap_or(Which::Exercises)
    }
}

#[cfg(not(feature = "author"))]
impl Choice {
    /// There is no reference here.
    pub fn or_reference(self) -> Which {
        Which::Exercises
    }

    /// There is nothing else here.
    pub fn or_exercises(self) -> Which {
        Which::Exercises
    }
}

/// What a command has to be told to use the exercises.
#[cfg(feature = "author")]
pub const WITH_EXERCISES: &str = " --kit exercises";

/// What a command has to be told to use the exercises.
#[cfg(not(feature = "author"))]
pub const WITH_EXERCISES: &str = "";

/// A source of fresh kits.
pub enum Source {
    /// Linked.
    #[cfg(feature = "author")]
    Solutions,
    /// The program of a worker.
    Worker(PathBuf),
}

impl Source {
    /// Gets the kit ready; the exercises are those of the folder in which we are, or above it.
    pub fn here(which: Which) -> Result<Source> {
        match which {
            #[cfg(feature = "author")]
            Which::Solutions => Ok(Source::Solutions),
            Which::Exercises => Source::prepare(which, &root()?),
        }
    }

    /// Gets the kit ready; builds the exercises if need be.
    pub fn prepare(which: Which, root: &Path) -> Result<Source> {
        match which {
            #[cfg(feature = "author")]
            Which::Solutions => Ok(Source::Solutions),
            Which::Exercises => build_worker(root, "exercises").map(Source::Worker),
        }
    }

    /// A kit that no call has touched yet.
    pub fn fresh(&self) -> Arc<dyn Kit + Send + Sync> {
        match self {
            #[cfg(feature = "author")]
            Source::Solutions => Arc::new(raykata::kit::Linked(solutions::Kit)),
            Source::Worker(program) => Arc::new(Door(Worker::new(program.clone(), CALL_PATIENCE))),
        }
    }
}

/// Builds the worker of a package, `exercises` or `solutions`, in the profile of this program, and says where it is.
pub fn build_worker(root: &Path, package: &str) -> Result<PathBuf> {
    let here = std::env::current_exe().context("this program cannot find itself")?;
    let folder = here.parent().context("this program lies nowhere")?;
    let folder = if folder.ends_with("deps") { folder.parent().unwrap_or(folder) } else { folder };
    let release = folder.ends_with("release");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root).args([
        "build",
        "--quiet",
        "--package",
        package,
        "--bin",
        &format!("{package}-worker"),
    ]);
    if release {
        cargo.arg("--release");
    }
    if let Some(target) = folder.parent() {
        cargo.arg("--target-dir").arg(target);
    }
    let status = cargo.status().context("cargo, which builds your exercises, cannot be started")?;
    if !status.success() {
        bail!("{package} does not compile yet: the compiler says above what is wrong");
    }
    Ok(folder.join(format!("{package}-worker{}", std::env::consts::EXE_SUFFIX)))
}

/// The folder of the kit: the one with `exercises/` at or above the current folder.
pub fn root() -> Result<PathBuf> {
    let here = std::env::current_dir().context("the current folder is gone")?;
    let is_kit = |folder: &&Path| {
        folder.join("exercises/Cargo.toml").is_file() && folder.join("tests/rubric.toml").is_file()
    };
    match here.ancestors().find(is_kit) {
        Some(root) => Ok(root.to_owned()),
        None => bail!(
            "no kit at or above {}: go to the folder that holds exercises/ and try again",
            here.display()
        ),
    }
}
