//! Reports of a graded class: tables, files for other programs, and pages to read.
//!
//! Much of their text comes from students. `presentable` cleans each text once, before it goes into any format. The
//! libraries that write CSV, JSON, XML and HTML do the escaping.

mod chart;
mod class_page;
pub mod clean;
mod junit;
mod line;
mod machines;
pub mod messages;
mod names;
mod page;
mod student_list;
mod student_page;
mod tables;
mod tally;
#[cfg(test)]
mod tests;

pub use clean::{clean, clean_line};
pub use machines::{classroom, gradescope};
pub use names::FileNames;

use super::result::{CheckResult, Graded, Note, Picture, Remark, Session};
use anyhow::{Context, Result};
use line::Line;
use raykata::film::write_atomically;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// Longest name or other text of one line, in bytes.
const LINE: usize = 300;

/// Longest message, in bytes.
const MESSAGE: usize = 2048;

/// Longest output of the compiler, in bytes.
const COMPILER: usize = 16 * 1024;

/// Most remarks that are shown per submission. A submission may have thousands of files.
const REMARKS: usize = 50;

/// Passes the submissions of a class to a function, one after the other, sorted by name. It is called several times, and keeps
/// one submission in memory at a time, because a class may be larger than the memory.
pub type Each<'a> = dyn Fn(&mut dyn FnMut(Graded) -> Result<()>) -> Result<()> + 'a;

/// What is printed after the reports are written.
pub struct Summary {
    /// The number of submissions.
    pub submissions: usize,
    /// The submissions that could not be graded, with the reason.
    pub troubled: Vec<(String, String)>,
}

/// Writes all reports of a class into `folder`: `grades.csv`, `checks.csv`, `timings.csv`, `results.json`, `junit.xml`,
/// `index.html`, and for each student a file in `students`, `gradescope` and `classroom`. If the class is large, the list of
/// students has pages of its own.
///
/// The same results give the same bytes in any order of the students. Only `timings.csv` and `index.html` contain times.
/// Each file is replaced atomically.
pub fn write_from(session: &Session, each: &Each<'_>, folder: &Path) -> Result<Summary> {
    let session = &Session {
        kit: clean_line(&session.kit, LINE),
        isolation: clean_line(&session.isolation, LINE),
        course: clean_line(&session.course, LINE),
        ..session.clone()
    };
    let each_cleaned: &Each<'_> = &|work| each(&mut |graded| work(presentable(&graded)));

    // Count, and keep a line of each submission.
    let (mut tallies, mut totals) = (tally::Tallies::default(), junit::Totals::default());
    let (mut names, mut lines) = (names::FileNames::default(), Vec::new());
    each(&mut |graded| {
        let cleaned = presentable(&graded);
        tallies.add(&cleaned);
        totals.add(&cleaned);
        lines.push(Line::new(&cleaned, &graded.student, session, &mut names));
        Ok(())
    })?;
    let tallies = tallies.in_order();

    // Write the tables and the files for programs.
    write(folder, "grades.csv", &tables::grades(&lines, &tallies, session)?)?;
    write_with(folder, "checks.csv", |out| tables::checks(each_cleaned, out))?;
    write(folder, "timings.csv", &tables::timings(&lines)?)?;
    write_with(folder, "results.json", |out| machines::results(session, each_cleaned, out))?;
    write_with(folder, "junit.xml", |out| junit::junit(totals, each_cleaned, out))?;
    // Write the files of each student.
    let mut pages = lines.iter().map(|line| line.page.as_str());
    each_cleaned(&mut |graded| {
        let name =
            pages.next().context("the grades changed while the reports were written: write them again")?;
        let page = student_page::student_page(&graded, session);
        write(folder, &format!("students/{name}.html"), page.as_bytes())?;
        let results = machines::pretty(&gradescope(&graded, session))?;
        write(folder, &format!("gradescope/{name}.json"), &results)?;
        write(folder, &format!("classroom/{name}.json"), &machines::pretty(&classroom(&graded))?)
    })?;
    // Write the index last, so that all its links work.
    for (name, page) in student_list::pages(&lines, &tallies) {
        write(folder, &name, page.as_bytes())?;
    }
    let index = class_page::class_page(session, &lines, &tallies);
    write(folder, "index.html", index.as_bytes())?;
    let submissions = lines.len();
    let troubled = lines.into_iter().filter(|line| !line.trouble.is_empty());
    Ok(Summary { submissions, troubled: troubled.map(|line| (line.student, line.trouble)).collect() })
}

/// Returns the submission with every text cleaned. Cleaning it again changes nothing.
fn presentable(graded: &Graded) -> Graded {
    let n_more = graded.remarks.len().saturating_sub(REMARKS + 1);
    // If there is only one remark too many, show it instead of a note.
    let n_shown = if n_more == 0 { graded.remarks.len() } else { REMARKS };
    let cleaned = |Remark { file, what }: &Remark| Remark {
        file: clean_line(file, LINE),
        what: clean_line(what, LINE),
    };
    let mut remarks: Vec<Remark> = graded.remarks[..n_shown].iter().map(cleaned).collect();
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
        handed_in: clean_line(&graded.handed_in, LINE),
        note: graded.note.as_ref().map(|note| Note { text: clean_line(&note.text, MESSAGE), ..*note }),
    }
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
    write_with(folder, name, |out| Ok(out.write_all(bytes)?))
}

/// Writes a file that may be larger than the memory.
fn write_with(folder: &Path, name: &str, fill: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let file = folder.join(name);
    let parent = file.parent().unwrap_or(folder);
    let written = fs::create_dir_all(parent)
        .and_then(|()| write_atomically(&file, |out| fill(out).map_err(io::Error::other)));
    written.with_context(|| format!("{} cannot be written", file.display()))
}
