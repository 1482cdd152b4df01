//! `grader export slurm` and `grader export slurm-picture`: job scripts for a cluster that runs Slurm. The engine queues, limits
//! and starts again; the parts that it runs can be stopped at any time, and the merge refuses a result with holes.

use super::{COURSE, Grading, write};
use crate::grade::find_submissions;
use anyhow::{Context, Result, ensure};
use raykata::rows::Rows;
use raykata_cli::args::{Argument, Given, Opt, Spec};
use raykata_cli::kits::{Program, build, root};
use raykata_cli::quality_options::{QualityOptions, ToneOptions};
use std::ffi::OsStr;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// `grader export slurm`.
pub static SLURM: Spec = Spec {
    name: "grader export slurm",
    about: "Write job scripts for Slurm that grade a class on many machines and merge the grades.",
    arguments: &[Argument::required("SUBMISSIONS", "The folder of the class, as for `grader grade`.")],
    options: &[
        &[
            Opt::value("--chunk", "N", "About how many submissions each task grades [default: 200]."),
            Opt::value("--out", "FOLDER", "The folder for scripts, logs and grades. All nodes must see it.")
                .required(),
        ],
        Grading::OPTIONS,
    ],
};

/// `grader export slurm-picture`.
pub static PICTURE: Spec = Spec {
    name: "grader export slurm-picture",
    about: "Write job scripts for Slurm that render the pieces of a picture on many machines and merge them.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[
            Opt::value("--pieces", "N", "The number of pieces: at most one per 16 rows [default: 64]."),
            Opt::value(
                "--out",
                "FOLDER",
                "The folder for scripts, logs and the picture. All nodes must see it.",
            )
            .required(),
            Opt::value("--seed", "N", "Seed of the random numbers [default: 0]."),
        ],
        QualityOptions::OPTIONS,
        ToneOptions::OPTIONS,
    ],
};

/// Most tasks of an array in a Slurm with its default settings (`MaxArraySize`).
const MOST_TASKS: usize = 1000;

/// Writes the scripts that grade a class.
pub fn slurm(given: &Given) -> Result<bool> {
    let class = Path::new(given.required(0)?);
    let chunk = given.number("--chunk", 1..=usize::MAX)?.unwrap_or(200);
    let (out, grading) = (given.required_path("--out")?, Grading::read(given)?);
    let root = root()?;
    let submissions = absolute(class)?;
    let n_submissions = find_submissions(&submissions)?.0.len();
    ensure!(n_submissions > 0, "there is no submission in {}", submissions.display());
    let parts = n_submissions.div_ceil(chunk);
    let grader = std::env::current_exe().context("the path of this program is unknown")?;
    let course = grading.course()?;
    let folder = Folder::make(&out, "parts")?;
    let file = course.map(|course| -> Result<String> {
        course.write_to(&folder.path.join(COURSE))?;
        quoted(folder.path.join(COURSE).join(&course.course.0).as_os_str())
    });
    let file = file.transpose()?;
    folder.fill(
        &[
            ("grade.sbatch", include_str!("grade.sbatch")),
            ("merge.sbatch", include_str!("merge.sbatch")),
            ("submit.sh", include_str!("submit.sh")),
            ("README.md", include_str!("slurm.md")),
        ],
        &[
            ("kit", quoted(root.as_os_str())?),
            ("grader", quoted(grader.as_os_str())?),
            ("submissions_count", n_submissions.to_string()),
            ("submissions", quoted(submissions.as_os_str())?),
            ("parts", parts.to_string()),
            ("chunk", chunk.to_string()),
            ("options", grading.options(file.as_deref())),
            ("results", "parts".into()),
            ("first", "grade.sbatch".into()),
            ("second", "merge.sbatch".into()),
        ],
    )?;
    println!(
        "{}: {n_submissions} submissions in {parts} parts; submit.sh submits them, see README.md",
        folder.path.display()
    );
    if parts > MOST_TASKS {
        println!(
            "note: a Slurm with its default settings accepts {MOST_TASKS} tasks; `--chunk {}` or more makes so few",
            n_submissions.div_ceil(MOST_TASKS)
        );
    }
    Ok(true)
}

/// Writes the scripts that render a picture.
pub fn picture(given: &Given) -> Result<bool> {
    // These are passed on to each task, so they must be right now.
    given.number("--seed", 0..=u64::MAX)?;
    ToneOptions::read(given)?;
    let file = Path::new(given.required(0)?);
    let pieces = given.number("--pieces", 1..=u32::MAX)?.unwrap_or(64);
    let (out, quality) = (given.required_path("--out")?, QualityOptions::read(given)?);
    let root = root()?;
    let file = absolute(file)?;
    let rows = Rows::divide(quality.load(&file)?.film.height, pieces);
    let [raykata] = build(&root, "the program that renders", [Program::RAYKATA])?;
    let folder = Folder::make(&out, "pieces")?;
    let name = file.file_stem().context("the scene has no name")?;
    let picture = folder.path.join(name).with_extension("png");
    let words = given.words_without(&["--pieces", "--out"]);
    let words: Vec<String> = words.iter().map(|word| quoted(word)).collect::<Result<_>>()?;
    let list: String = rows.iter().map(|rows| format!("{rows}\n")).collect();
    write(&folder.path.join("rows.txt"), list.as_bytes())?;
    folder.fill(
        &[
            ("render.sbatch", include_str!("render.sbatch")),
            ("merge.sbatch", include_str!("merge_picture.sbatch")),
            ("submit.sh", include_str!("submit.sh")),
            ("README.md", include_str!("slurm_picture.md")),
        ],
        &[
            ("kit", quoted(root.as_os_str())?),
            ("raykata", quoted(raykata.as_os_str())?),
            ("scene", quoted(file.as_os_str())?),
            ("picture", quoted(picture.as_os_str())?),
            ("pieces", rows.len().to_string()),
            ("options", words.join(" ")),
            ("results", "pieces".into()),
            ("first", "render.sbatch".into()),
            ("second", "merge.sbatch".into()),
        ],
    )?;
    println!("{}: {} pieces; submit.sh submits them, see README.md", folder.path.display(), rows.len());
    ensure!(
        raykata.is_file(),
        "the scripts are written, but {} is not built yet: build it by `cargo build --package raykata-cli`, with `--release` if \
         this program was built so",
        raykata.display()
    );
    Ok(true)
}

/// The folder of the scripts.
struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder, which must be new, with a folder for results and one for logs. Nobody else can read it, because the
    /// scripts of a class contain the seed.
    fn make(out: &Path, results: &str) -> Result<Folder> {
        let is_new = fs::read_dir(out).map_or(true, |mut entries| entries.next().is_none());
        ensure!(is_new, "{} is not empty: choose another folder", out.display());
        for folder in [results, "logs"] {
            crate::report::make_folder(&out.join(folder))?;
        }
        fs::set_permissions(out, fs::Permissions::from_mode(0o700))
            .with_context(|| format!("cannot protect {}", out.display()))?;
        let path = absolute(out)?;
        // Slurm reads these in the name of a log.
        let plain = !path.to_string_lossy().contains(['%', '"', '\\', '\n']);
        ensure!(
            plain,
            "the path {} contains %, a quotation mark or a backslash: choose another folder",
            path.display()
        );
        Ok(Folder { path })
    }

    /// Writes files from templates, in which `{name}` stands for the value of that name.
    fn fill(&self, files: &[(&str, &str)], values: &[(&str, String)]) -> Result<()> {
        let own = [("out", self.path.display().to_string()), ("out_quoted", quoted(self.path.as_os_str())?)];
        for (name, template) in files {
            let values = values.iter().chain(&own);
            let text = values.fold((*template).to_owned(), |text, (key, value)| {
                text.replace(&format!("{{{key}}}"), value)
            });
            let file = self.path.join(name);
            write(&file, text.as_bytes())?;
            if text.starts_with("#!") {
                fs::set_permissions(&file, fs::Permissions::from_mode(0o700))
                    .with_context(|| format!("{} cannot be made executable", file.display()))?;
            }
        }
        Ok(())
    }
}

fn absolute(path: &Path) -> Result<PathBuf> {
    path.canonicalize().with_context(|| format!("cannot read {}", path.display()))
}

/// Returns a word as a shell reads it back. Plain words stay as they are.
pub(super) fn quoted(word: &OsStr) -> Result<String> {
    let text = word.to_str().with_context(|| format!("{} is not UTF-8: rename it", word.display()))?;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@".contains(c);
    Ok(match !text.is_empty() && text.chars().all(is_plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_for_a_shell() {
        assert_eq!(quoted("/a/b-c.d".as_ref()).unwrap(), "/a/b-c.d");
        assert_eq!(quoted("a b".as_ref()).unwrap(), "'a b'");
        assert_eq!(quoted("it's $HOME".as_ref()).unwrap(), r"'it'\''s $HOME'");
        assert_eq!(quoted("".as_ref()).unwrap(), "''");
    }
}
