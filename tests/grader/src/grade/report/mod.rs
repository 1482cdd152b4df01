//! Reports of a graded class: tables, files for other programs, and pages to read.
//!
//! Much of their text comes from students. `presentable` cleans each text once, before it goes into any format. The
//! libraries that write CSV, JSON, XML and HTML do the escaping.

mod chart;
mod class_page;
pub mod clean;
mod junit;
mod machines;
mod messages;
mod names;
mod page;
mod student_page;
mod tables;
mod tally;
#[cfg(test)]
mod tests;

pub use clean::{clean, clean_line};
pub use machines::{classroom, classroom_output, gradescope};
pub use names::file_names;

use super::result::{CheckResult, Class, Graded, Picture, Remark, Session};
use anyhow::{Context, Result};
use raykata::film::write_atomically;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Longest name or other text of one line, in bytes.
const LINE: usize = 300;

/// Longest message, in bytes.
const MESSAGE: usize = 2048;

/// Longest output of the compiler, in bytes.
const COMPILER: usize = 16 * 1024;

/// Most remarks that are shown per submission. A submission may have thousands of files.
const REMARKS: usize = 50;

/// Writes all reports of a class into `folder`: `grades.csv`, `checks.csv`, `timings.csv`, `results.json`, `junit.xml`,
/// `index.html`, and for each student a file in `students`, `gradescope` and `classroom`.
///
/// The same results give the same bytes in any order of the students. Only `timings.csv` and `index.html` contain times.
/// Each file is replaced atomically.
pub fn write_all(class: &Class, folder: &Path) -> Result<()> {
    let mut students: Vec<&Graded> = class.students.iter().collect();
    // Two submissions may have the same name. Sort these by their content.
    students.sort_by_key(|&graded| (&graded.student, &graded.content, &graded.trouble));
    let students: Vec<Graded> = students.into_iter().cloned().collect();
    let pages = names::file_names(&students);
    // Clean all texts.
    let session = Session {
        kit: clean_line(&class.session.kit, LINE),
        isolation: clean_line(&class.session.isolation, LINE),
        ..class.session.clone()
    };
    let class = &Class { session, students: students.iter().map(presentable).collect() };
    let tallies = tally::tallies(class);

    // Write the tables and the files for programs.
    write(folder, "grades.csv", &tables::grades(class, &tallies, &pages)?)?;
    write(folder, "checks.csv", &tables::checks(class)?)?;
    write(folder, "timings.csv", &tables::timings(class, &pages)?)?;
    write(folder, "results.json", &machines::results(class)?)?;
    write(folder, "junit.xml", &junit::junit(class)?)?;
    // Write the files of each student.
    for (graded, name) in class.students.iter().zip(&pages) {
        let page = student_page::student_page(graded, &class.session);
        write(folder, &format!("students/{name}.html"), page.as_bytes())?;
        let results = machines::pretty(&gradescope(graded, &class.session))?;
        write(folder, &format!("gradescope/{name}.json"), &results)?;
        write(folder, &format!("classroom/{name}.json"), &machines::pretty(&classroom(graded))?)?;
    }
    // Write the index last, so that all its links work.
    let index = class_page::class_page(class, &tallies, &pages);
    write(folder, "index.html", index.as_bytes())
}

/// Returns the submission with every text cleaned. Cleaning it again changes nothing.
fn presentable(graded: &Graded) -> Graded {
    let n_more = graded.remarks.len().saturating_sub(REMARKS + 1);
    // If there is only one remark too many, show it instead of a note.
    let n_shown = if n_more == 0 { graded.remarks.len() } else { REMARKS };
    let mut remarks: Vec<Remark> = graded.remarks[..n_shown].iter().map(presentable_remark).collect();
    if n_more > 0 {
        let what = format!("{} more remarks are left out", n_more + 1);
        remarks.push(Remark { file: "…".to_owned(), what });
    }
    Graded {
        student: clean_line(&graded.student, LINE),
        content: clean_line(&graded.content, LINE),
        checks: graded.checks.iter().map(presentable_check).collect(),
        remarks,
        compiler: clean(&graded.compiler, COMPILER),
        trouble: clean_line(&graded.trouble, MESSAGE),
        cpu_ms: graded.cpu_ms,
    }
}

fn presentable_remark(remark: &Remark) -> Remark {
    Remark { file: clean_line(&remark.file, LINE), what: clean_line(&remark.what, LINE) }
}

fn presentable_check(check: &CheckResult) -> CheckResult {
    let picture = check
        .picture
        .as_ref()
        .map(|picture| Picture { caption: clean_line(&picture.caption, LINE), png: picture.png.clone() });
    let name = clean_line(&check.name, LINE);
    CheckResult { name, message: clean(&check.message, MESSAGE), picture, ..check.clone() }
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    let file = folder.join(name);
    let parent = file.parent().unwrap_or(folder);
    let written =
        fs::create_dir_all(parent).and_then(|()| write_atomically(&file, |out| out.write_all(bytes)));
    written.with_context(|| format!("{} cannot be written", file.display()))
}
