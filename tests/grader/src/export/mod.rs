//! `grader export`: writes the files with which Gradescope, GitHub Classroom and Slurm grade as `grader grade` does, and fills
//! the tables of Moodle and Canvas.

mod bundle;
mod platforms;
mod slurm;

pub use platforms::{CANVAS, MOODLE, platform};
pub use slurm::{PICTURE, SLURM, picture, slurm};

use crate::course::{self, CourseFiles};
use crate::grade::draw_seed;
use crate::kits::root;
use anyhow::{Context, Result, ensure};
use raykata::course::stages_of;
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
        &[
            Opt::value("--out", "FOLDER", "The folder for .github/workflows.").required(),
            Opt::value(
                "--parts",
                "N",
                "The number of jobs that grade a class, at most 256, the limit of GitHub [default: 4].",
            ),
        ],
        Grading::OPTIONS,
    ],
};

/// Most jobs of a matrix on GitHub.
const MOST_JOBS: u16 = 256;

/// Stages, seed and course file, the same for all students.
#[derive(Clone)]
struct Grading {
    course: Option<PathBuf>,
    stages: Option<String>,
    seed: Option<u64>,
}

impl Grading {
    const OPTIONS: &[Opt] = &[
        course::OPTION,
        Opt::value("--stages", "LIST", "The stages, as `3`, `1-4` or `1-4,10` [default: all]."),
        Opt::value("--seed", "N", "Picks the hidden inputs [default: drawn at random]."),
    ];

    fn read(given: &Given) -> Result<Grading, Misuse> {
        Ok(Grading {
            course: given.path("--course"),
            stages: given.parsed("--stages", |text| stages_of(text).map(|_| text.replace(' ', "")))?,
            seed: given.number("--seed", 0..=u64::MAX)?,
        })
    }

    /// Reads the course file.
    fn course(&self) -> Result<Option<CourseFiles>> {
        let files = self.course.as_deref().map(CourseFiles::read).transpose()?;
        if let (Some(files), Some(list)) = (&files, &self.stages) {
            let course = files.parse()?;
            let mut stages = stages_of(list).map_err(anyhow::Error::msg)?.into_iter();
            ensure!(
                !stages.any(|stage| course.leaves_out(stage)),
                "--stages names a stage that the course file leaves out: change one of the two"
            );
        }
        Ok(files)
    }

    /// Returns these as options of `grader grade-one`. `course` is the path of the copied course file, as a word of a shell.
    fn options(&self, course: Option<&str>) -> String {
        let seed = self.seed.unwrap_or_else(draw_seed);
        let stages = self.stages.as_ref().map_or_else(String::new, |stages| format!("--stages {stages} "));
        let course = course.map_or_else(String::new, |file| format!("--course {file} "));
        format!("{course}{stages}--seed {seed}")
    }
}

/// The folder of the course file, in the folder of the kit.
const COURSE: &str = "course";

/// Returns the path of the course file from the folder of the kit, as a word of a shell.
fn in_folder(course: &CourseFiles) -> Result<String> {
    slurm::quoted(format!("{COURSE}/{}", course.course.0).as_ref())
}

const SETUP: &str = include_str!("setup.sh");
const RUN: &str = include_str!("run_autograder");
const EACH_PUSH: &str = include_str!("classroom.yml");
const WHOLE_CLASS: &str = include_str!("class.yml");

/// The places of the options, of the number of parts and of their list in a template.
const OPTIONS: &str = "{options}";
const PARTS: &str = "{parts}";
const NUMBERS: &str = "{numbers}";

/// Writes the zip for Gradescope.
pub fn gradescope(given: &Given) -> Result<bool> {
    let out = given.path("--out").unwrap_or_else(|| "autograder.zip".into());
    let grading = Grading::read(given)?;
    let root = root()?;
    let course = grading.course()?;
    let file = course.as_ref().map(in_folder).transpose()?;
    let scripts = [
        ("setup.sh", SETUP.to_owned()),
        ("run_autograder", RUN.replace(OPTIONS, &grading.options(file.as_deref()))),
    ];
    let zip = bundle::zip(&root, &scripts, course.as_ref())?;
    write(&out, &zip)?;
    println!("{}: upload it as the autograder of a programming assignment", out.display());
    Ok(true)
}

/// Writes the workflows for GitHub.
pub fn classroom(given: &Given) -> Result<bool> {
    let parts = given.number("--parts", 1..=MOST_JOBS)?.unwrap_or(4);
    let (out, grading) = (given.required_path("--out")?, Grading::read(given)?);
    let folder = out.join(".github/workflows");
    let course = grading.course()?;
    let file = course.as_ref().map(in_folder).transpose()?;
    let numbers: Vec<String> = (1..=parts).map(|part| part.to_string()).collect();
    let (parts, numbers) = (parts.to_string(), numbers.join(", "));
    // Students can read the seed of their own workflow, so the final grades have another.
    let of_students = Grading { seed: None, ..grading.clone() };
    for (name, template, grading) in
        [("classroom.yml", EACH_PUSH, &of_students), ("class.yml", WHOLE_CLASS, &grading)]
    {
        let graded = grading.options(file.as_deref());
        let file = folder.join(name);
        ensure!(!file.exists(), "{} already exists", file.display());
        let text = template.replace(OPTIONS, &graded).replace(PARTS, &parts).replace(NUMBERS, &numbers);
        write(&file, text.as_bytes())?;
    }
    if let Some(course) = course {
        course.write_to(&out.join(COURSE))?;
        println!("{}: copy this folder into the repository of the kit", out.join(COURSE).display());
    }
    println!("{}: read the comment at the top of each file before you use it", folder.display());
    Ok(true)
}

/// Writes a whole file and makes its folder.
pub(crate) fn write(file: &Path, bytes: &[u8]) -> Result<()> {
    crate::report::make_folder_of(file)?;
    write_atomically(file, |out| out.write_all(bytes))
        .with_context(|| format!("{} cannot be written", file.display()))
}
