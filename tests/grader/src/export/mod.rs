//! `grader export`: writes the files with which Gradescope and GitHub Classroom grade as `grader grade` does.

mod bundle;

use crate::grade::{draw_seed, stages};
use anyhow::{Context, Result, ensure};
use raykata::film::write_atomically;
use raykata_cli::args::{Given, Misuse, Opt, Spec};
use std::io::Write;
use std::path::{Path, PathBuf};

/// `grader export gradescope`.
pub static GRADESCOPE: Spec = Spec {
    name: "grader export gradescope",
    about: "Write an autograder zip for Gradescope. It contains the answers; students do not see it.",
    arguments: &[],
    options: &[
        &[Opt::value("--out", "FILE", "The file for the zip [default: autograder.zip].")],
        Grading::OPTIONS,
    ],
};

/// `grader export classroom`.
pub static CLASSROOM: Spec = Spec {
    name: "grader export classroom",
    about: "Write two workflows for GitHub: one grades each push of a student, one grades a class on several \
            machines.",
    arguments: &[],
    options: &[
        &[Opt::value("--out", "FOLDER", "The folder for .github/workflows.").required()],
        Grading::OPTIONS,
    ],
};

/// The options of both commands.
pub struct Options {
    out: PathBuf,
    grading: Grading,
}

impl Options {
    /// Reads the options of [`GRADESCOPE`].
    pub fn of_gradescope(given: &Given) -> Result<Options, Misuse> {
        let out = given.path("--out").unwrap_or_else(|| "autograder.zip".into());
        Ok(Options { out, grading: Grading::read(given)? })
    }

    /// Reads the options of [`CLASSROOM`].
    pub fn of_classroom(given: &Given) -> Result<Options, Misuse> {
        Ok(Options { out: given.required_path("--out")?, grading: Grading::read(given)? })
    }
}

/// Stages and seed, the same for all students.
struct Grading {
    stages: Option<String>,
    seed: Option<u64>,
}

fn known_stages(text: &str) -> Result<String> {
    stages(text)?;
    Ok(text.replace(' ', ""))
}

impl Grading {
    const OPTIONS: &[Opt] = &[
        Opt::value("--stages", "LIST", "The stages, as `3`, `1-4` or `1-4,10` [default: all]."),
        Opt::value("--seed", "N", "Picks the hidden inputs [default: drawn at random]."),
    ];

    fn read(given: &Given) -> Result<Grading, Misuse> {
        Ok(Grading {
            stages: given.parsed("--stages", known_stages)?,
            seed: given.number("--seed", 0..=u64::MAX)?,
        })
    }

    /// Returns these as options of `grader grade-one`.
    fn options(&self) -> String {
        let seed = self.seed.unwrap_or_else(draw_seed);
        let stages = self.stages.as_ref().map_or_else(String::new, |stages| format!("--stages {stages} "));
        format!("{stages}--seed {seed}")
    }
}

const SETUP: &str = include_str!("setup.sh");
const RUN: &str = include_str!("run_autograder");
const EACH_PUSH: &str = include_str!("classroom.yml");
const WHOLE_CLASS: &str = include_str!("class.yml");

/// The place of the options in a template.
const OPTIONS: &str = "{options}";

/// Writes the zip for Gradescope.
pub fn gradescope(root: &Path, options: &Options) -> Result<()> {
    let scripts = [
        ("setup.sh", SETUP.to_owned()),
        ("run_autograder", RUN.replace(OPTIONS, &options.grading.options())),
    ];
    let zip = bundle::zip(root, &scripts)?;
    write(&options.out, &zip)?;
    println!("{}: upload it as the autograder of a programming assignment", options.out.display());
    Ok(())
}

/// Writes the workflows for GitHub.
pub fn classroom(options: &Options) -> Result<()> {
    let folder = options.out.join(".github/workflows");
    let graded = options.grading.options();
    for (name, template) in [("classroom.yml", EACH_PUSH), ("class.yml", WHOLE_CLASS)] {
        let file = folder.join(name);
        ensure!(!file.exists(), "{} already exists", file.display());
        write(&file, template.replace(OPTIONS, &graded).as_bytes())?;
    }
    println!("{}: read the comment at the top of each file before you use it", folder.display());
    Ok(())
}

fn write(file: &Path, bytes: &[u8]) -> Result<()> {
    crate::report::make_folder_of(file)?;
    write_atomically(file, |out| out.write_all(bytes))
        .with_context(|| format!("{} cannot be written", file.display()))
}
