//! One build of the solutions in which each function can be switched off when the worker starts, so that any set of
//! functions can be left out without another build.

use super::Gap;
use crate::corpus::build_folder::{BuildFolder, Built};
use anyhow::{Context, Result, bail};
use grader::exercises::{self, Block};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Added to the solutions. A worker at the path `p` leaves out the functions whose numbers stand in the file `p.gaps`.
const SWITCH: &str = r#"
/// Whether the function with this number is left out.
pub fn is_gap(number: usize) -> bool {
    static GAPS: std::sync::LazyLock<Vec<bool>> = std::sync::LazyLock::new(|| {
        let program = std::env::current_exe().expect("a program");
        let text = std::fs::read_to_string(program.with_extension("gaps")).expect("the file of its gaps");
        let mut gaps = Vec::new();
        for number in text.split_whitespace() {
            let number: usize = number.parse().expect("a number");
            gaps.resize(gaps.len().max(number + 1), false);
            gaps[number] = true;
        }
        gaps
    });
    GAPS.get(number) == Some(&true)
}
"#;

/// The program of a worker whose functions can be switched off.
pub struct Switchable {
    program: PathBuf,
    /// The folder with its links.
    folder: tempfile::TempDir,
}

impl Switchable {
    /// Builds the solutions with a switch in each of `gaps`, which are all functions of the exercises.
    pub fn build(build_folder: &BuildFolder, root: &Path, gaps: &[Gap]) -> Result<Switchable> {
        let mut files: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (number, gap) in gaps.iter().enumerate() {
            files.entry(&gap.file).or_default().push(number);
        }
        let mut changes = Vec::new();
        for (file, numbers) in files {
            let text = fs::read_to_string(root.join(file)).with_context(|| file.to_owned())?;
            changes.push((file.to_owned(), with_switches(file, &text, numbers)?));
        }
        let library = "solutions/src/lib.rs";
        changes.push((library.to_owned(), build_folder.original(library)? + SWITCH));
        let program = match build_folder.build_with(&changes)? {
            Built::Program(program) => program,
            Built::DoesNotCompile(error) => bail!(error),
        };
        // The links must be on the file system of the program.
        let folder = tempfile::tempdir_in(program.parent().context("a folder")?)?;
        Ok(Switchable { program, folder })
    }

    /// The program of a worker that leaves out the functions with these numbers. `name` is its name, which no other one has.
    pub fn without(&self, name: &str, numbers: &[usize]) -> Result<PathBuf> {
        let program = self.folder.path().join(name);
        let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
        fs::write(program.with_extension("gaps"), numbers.join(" "))?;
        fs::hard_link(&self.program, &program)?;
        Ok(program)
    }
}

/// The text of a file of the solutions, with a switch at the beginning of each answer. `numbers` are those of its functions,
/// in order.
fn with_switches(file: &str, text: &str, numbers: Vec<usize>) -> Result<String> {
    let mut numbers = numbers.into_iter();
    let mut switched = String::new();
    for block in exercises::blocks(text, Path::new(file))? {
        let (Block::Same(lines) | Block::Answer(lines, _)) = &block;
        if let Block::Answer(_, stub) = &block
            && super::is_function(stub)
        {
            let number = numbers.next().with_context(|| format!("{file} has more functions than gaps"))?;
            switched += &format!("if crate::is_gap({number}) {{\n{};\n}}\n", stub.join("\n"));
        }
        switched += &lines.join("\n");
        switched.push('\n');
    }
    Ok(switched)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_answer_begins_with_its_switch() {
        let text = "pub fn one(x: f32) -> f32 {\n    // <solution>\n    x\n    // <stub> todo!(\"x\")\n    // </solution>\n}\n\
                    // <solution>\nfn help() {}\n// </solution>\n";
        let switched = with_switches("f", text, vec![7]).unwrap();
        let begins =
            "pub fn one(x: f32) -> f32 {\nif crate::is_gap(7) {\n    todo!(\"x\");\n}\n    // <solution>";
        assert!(switched.starts_with(begins), "{switched}");
        assert_eq!(switched.matches("is_gap").count(), 1);
        assert!(with_switches("f", text, Vec::new()).is_err());
    }
}
