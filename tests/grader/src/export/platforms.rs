//! `grader export moodle` and `grader export canvas`: the platform's own table of grades with the points of a class, and the
//! reports as a zip of feedback files.

use crate::course::CourseFiles;
use crate::grade::Store;
use crate::grade::report::{FileNames, clean_line, messages};
use crate::grade::result::{Graded, score};
use crate::platform::{Column, PlatformTable, number_of, numbered};
use anyhow::{Context, Result, bail, ensure};
use raykata::course::stages_of;
use raykata_cli::args::{Argument, Given, Opt, Spec};
use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const ARGUMENTS: &[Argument] = &[
    Argument::required("TABLE", "The table that was downloaded from the platform, as CSV."),
    Argument::required("GRADES", "The folder with the grades of the class."),
];

const OPTIONS: &[&[Opt]] = &[&[
    Opt::value("--out", "FOLDER", "The folder for the filled table and for feedback.zip.").required(),
    Opt::value(
        "--column",
        "NAME",
        "The header of the column for the points [default: the only one that can be meant].",
    ),
    Opt::value(
        "--stages",
        "LIST",
        "The stages of the assignment, as `3` or `1-4` [default: all that were graded].",
    ),
    Opt::flag("--scale", "Convert the points to the most points of the assignment, rounded to two decimals."),
]];

/// `grader export moodle`.
pub static MOODLE: Spec = Spec {
    name: "grader export moodle",
    about: "Fill a grading worksheet of Moodle with points and feedback, and pack the reports as feedback files.",
    arguments: ARGUMENTS,
    options: OPTIONS,
};

/// `grader export canvas`.
pub static CANVAS: Spec = Spec {
    name: "grader export canvas",
    about: "Fill a gradebook of Canvas with points, and pack the reports for `Upload Submissions`.",
    arguments: ARGUMENTS,
    options: OPTIONS,
};

/// A student's part of the result.
struct Entry {
    student: String,
    points: u32,
    feedback: String,
    /// The path of the report below the folder of grades.
    page: String,
}

/// Fills a table and writes it with the feedback files.
pub fn platform(given: &Given, is_canvas: bool) -> Result<bool> {
    let (file, grades) = (Path::new(given.required(0)?), Path::new(given.required(1)?));
    let (out, scale) = (given.required_path("--out")?, given.has("--scale"));
    let column = given.parsed("--column", |name| Ok::<_, String>(name.to_owned()))?;
    let stages = given.parsed("--stages", stages_of)?;
    let mut table = PlatformTable::read(file)?;
    let (entries, of) = entries(grades, stages.as_deref())?;
    let (points, most) = columns(&table, file, column.as_deref(), is_canvas)?;

    // Canvas has rows that are no students: the most points, and a test student.
    let [name, identifier] = [Column::Name, Column::Identifier].map(|kind| table.column(kind));
    let text = |row, column: Option<usize>| column.map_or_else(String::new, |column| table.cell(row, column));
    let limits = table.rows().find(|&row| is_canvas && text(row, name) == "Points Possible");
    let is_row = |row| !is_canvas || !text(row, identifier).is_empty() && text(row, name) != "Student, Test";
    let students: Vec<&str> = entries.iter().map(|entry| entry.student.as_str()).collect();
    let found = table.find(&students, is_row);

    // Take the decimal sign and the most points from the table.
    let limit = match (limits, most) {
        (Some(row), _) => table.cell(row, points),
        (None, Some(most)) => {
            table.rows().map(|row| table.cell(row, most)).find(|cell| !cell.is_empty()).unwrap_or_default()
        }
        (None, None) => String::new(),
    };
    let with_comma = |cell: String| cell.contains(',') && cell.replace(',', ".").parse::<f64>().is_ok();
    let has_comma = with_comma(limit.clone()) || table.rows().any(|row| with_comma(table.cell(row, points)));
    let limit: Option<f64> = limit.replace(',', ".").parse().ok();
    if let Some(limit) = limit.filter(|limit| *limit != f64::from(of) && !scale) {
        bail!(
            "the assignment has {limit} points at most, and the graded stages have {of}: set it to {of} on the platform and \
             download the table again, choose other --stages, or convert the points with --scale"
        );
    }
    let factor = limit.filter(|_| scale).map_or(1.0, |limit| limit / f64::from(of.max(1)));
    let feedback = table.column(Column::Feedback).filter(|_| !is_canvas);

    // Fill the rows, and pack the reports under the names by which the platform knows them.
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut without_file = 0;
    for entry in &entries {
        let Some(&row) = found.rows.get(&entry.student) else { continue };
        let shown = (f64::from(entry.points) * factor * 100.0).round() / 100.0;
        let shown = if has_comma { shown.to_string().replace('.', ",") } else { shown.to_string() };
        table.set(row, points, &shown);
        feedback.into_iter().for_each(|column| table.set(row, column, &entry.feedback));
        let name = if is_canvas {
            numbered(&entry.student).then(|| format!("{}.html", entry.student))
        } else {
            moodle_file(&table, row)
        };
        let Some(name) = name else {
            without_file += 1;
            continue;
        };
        zip.start_file(name, SimpleFileOptions::default())?;
        let page = grades.join(&entry.page);
        zip.write_all(&fs::read(&page).with_context(|| format!("cannot read {}", page.display()))?)?;
    }
    let filled = out.join(file.file_name().context("the table has no file name")?);
    ensure!(
        fs::canonicalize(&filled).ok() != fs::canonicalize(file).ok() || !filled.exists(),
        "{} is the downloaded table: choose another --out",
        filled.display()
    );
    super::write(&filled, &table.bytes())?;
    super::write(&out.join("feedback.zip"), &zip.finish()?.into_inner())?;

    for line in found.students.iter().chain(&found.others) {
        eprintln!("not matched: {}", clean_line(line, 200));
    }
    if without_file > 0 {
        eprintln!(
            "note: feedback.zip has no file for {without_file} students, whose submissions are not named as the platform names them"
        );
    }
    println!("{}: {} of {} submissions filled in", filled.display(), found.rows.len(), entries.len());
    Ok(true)
}

/// What the class has earned in the chosen stages, and the possible points.
fn entries(grades: &Path, stages: Option<&[u8]>) -> Result<(Vec<Entry>, u32)> {
    ensure!(
        grades.join(crate::grade::STORE).is_file(),
        "{} contains no grades: give the folder of `grader grade --out`",
        grades.display()
    );
    let store = Store::open(grades)?;
    store.course()?.as_ref().map_or(Ok(()), CourseFiles::apply)?;
    let (mut entries, mut of, mut names) = (Vec::new(), 0, FileNames::default());
    store.each(&mut |graded| {
        let page = format!("students/{}.html", names.name(&graded.student));
        // The instructor's points are for the whole course.
        let graded = match stages {
            Some(stages) => Graded { note: None, ..graded.valued(stages) },
            None => graded,
        };
        of = of.max(score(graded.checks.iter()).points().1);
        let feedback = clean_line(&messages::in_short(&graded), 1000);
        entries.push(Entry { points: graded.earned(), feedback, page, student: graded.student });
        Ok(())
    })?;
    ensure!(!entries.is_empty(), "{} contains no grades", grades.display());
    Ok((entries, of))
}

/// The columns of the points and of the most points.
fn columns(
    table: &PlatformTable,
    file: &Path,
    column: Option<&str>,
    is_canvas: bool,
) -> Result<(usize, Option<usize>)> {
    let headers = table.headers();
    let most = table.column(Column::MostPoints);
    // An assignment of Canvas has its number in parentheses.
    let is_assignment = |header: &str| {
        let number = header.strip_suffix(')').and_then(|header| header.rsplit_once('('));
        number.is_some_and(|(_, number)| number.parse::<u64>().is_ok())
    };
    let candidates: Vec<usize> = match column {
        Some(name) => {
            let exact = headers.iter().position(|header| header == name);
            let starts = |i: &usize| headers[*i].starts_with(&format!("{name} ("));
            exact.map_or_else(|| (0..headers.len()).filter(starts).collect(), |column| vec![column])
        }
        None if is_canvas => (0..headers.len()).filter(|&i| is_assignment(&headers[i])).collect(),
        None => table.column(Column::Points).into_iter().collect(),
    };
    match candidates[..] {
        [column] => Ok((column, most)),
        _ => bail!(
            "{}: choose the column of the points with --column; the table has {}",
            file.display(),
            headers.iter().map(|header| format!("`{header}`")).collect::<Vec<_>>().join(", ")
        ),
    }
}

/// The path of a student's file in Moodle's zip of feedback files: that of the downloaded submission.
fn moodle_file(table: &PlatformTable, row: usize) -> Option<String> {
    let cell = |column| table.column(column).map(|column| table.cell(row, column));
    let identifier = cell(Column::Identifier)?;
    let number = number_of(&identifier);
    let name = cell(Column::Name).unwrap_or_default().replace(['_', '/', '\\', '\n', '\r'], " ");
    (!number.is_empty()).then(|| format!("{name}_{number}_assignsubmission_file_/feedback.html"))
}
