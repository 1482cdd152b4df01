//! `grader export`: what Gradescope and GitHub Classroom need to grade as `grader grade` does.

mod bundle;

use crate::grade::{draw_seed, stages};
use anyhow::{Context, Result, ensure};
use clap::{Args, Subcommand};
use raykata::film::write_atomically;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Which of them.
#[derive(Subcommand)]
pub enum What {
    /// A zip to upload to Gradescope as an autograder. It holds the answers; students do not see it.
    Gradescope {
        /// Where the zip goes.
        #[arg(long, default_value = "autograder.zip")]
        out: PathBuf,
        /// What is graded.
        #[command(flatten)]
        grading: Grading,
    },
    /// Workflows for GitHub: one that grades each push of a student, one that grades a class on several machines.
    Classroom {
        /// The folder for .github/workflows.
        #[arg(long)]
        out: PathBuf,
        /// What is graded.
        #[command(flatten)]
        grading: Grading,
    },
}

/// What is graded, the same for all students.
#[derive(Args)]
pub struct Grading {
    /// The stages, as `3`, `1-4` or `1-4,10`; all if not given.
    #[arg(long, value_parser = known_stages)]
    stages: Option<String>,
    /// Picks the hidden inputs; drawn at random if not given.
    #[arg(long)]
    seed: Option<u64>,
}

fn known_stages(text: &str) -> Result<String> {
    stages(text)?;
    Ok(text.replace(' ', ""))
}

impl Grading {
    /// As options of `grader grade-one`.
    fn options(&self) -> String {
        let seed = self.seed.unwrap_or_else(draw_seed);
        let stages = self.stages.as_ref().map_or_else(String::new, |stages| format!("--stages {stages} "));
        format!("{stages}--seed {seed}")
    }
}

const SETUP: &str = include_str!("setup.sh");
const RUN: &str = include_str!("run_autograder");
const CLASSROOM: &str = include_str!("classroom.yml");
const CLASS: &str = include_str!("class.yml");

/// Where a template says how to grade.
const OPTIONS: &str = "{options}";

/// Writes it.
pub fn run(root: &Path, what: &What) -> Result<()> {
    match what {
        What::Gradescope { out, grading } => {
            let scripts = [
                ("setup.sh", SETUP.to_owned()),
                ("run_autograder", RUN.replace(OPTIONS, &grading.options())),
            ];
            let zip = bundle::zip(root, &scripts)?;
            write(out, &zip)?;
            println!("{}: upload it as the autograder of a programming assignment", out.display());
        }
        What::Classroom { out, grading } => {
            let folder = out.join(".github/workflows");
            let options = grading.options();
            for (name, template) in [("classroom.yml", CLASSROOM), ("class.yml", CLASS)] {
                let file = folder.join(name);
                ensure!(!file.exists(), "{} is there already", file.display());
                write(&file, template.replace(OPTIONS, &options).as_bytes())?;
            }
            println!("{}: read what each file says at its top before you use it", folder.display());
        }
    }
    Ok(())
}

fn write(file: &Path, bytes: &[u8]) -> Result<()> {
    crate::report::make_folder_of(file)?;
    write_atomically(file, |out| out.write_all(bytes))
        .with_context(|| format!("{} cannot be written", file.display()))
}
