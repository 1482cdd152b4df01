//! The course file on the command line (`--course`), and `grader course`, which says what a course file means.

use crate::platform::{self, Column, PlatformTable};
use anyhow::{Context, Result, bail, ensure};
use raykata::course::{self, Course, Moment};
use raykata::rubric;
use raykata_cli::args::{Argument, Given, Opt, Spec};
use raykata_cli::report::say;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// `grader course`.
pub static SPEC: Spec = Spec {
    name: "grader course",
    about: "Check a course file, and print its stages, points and dates.",
    arguments: &[Argument::required("FILE", "The course file; tests/course.toml explains it.")],
    options: &[],
};

/// The option of all commands that take a course file.
pub const OPTION: Opt = Opt::value(
    "--course",
    "FILE",
    "The course file: stages, points, titles, dates and language of the course. tests/course.toml explains it.",
);

/// Longest course or language file, in bytes.
const LONGEST: u64 = 4 << 20;

/// A course file and its language file, as texts. They are stored beside the grades, so that later runs need no other files.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CourseFiles {
    /// The name and the text of the course file.
    pub course: (String, String),
    /// The name and the text of the language file.
    pub language: Option<(String, String)>,
}

impl CourseFiles {
    /// Reads the course file of the command line, if it names one.
    pub fn given(given: &Given) -> Result<Option<CourseFiles>> {
        given.path("--course").map(|file| CourseFiles::read(&file)).transpose()
    }

    /// Reads a course file and the language file that it names. Returns an error with file, line and column if one of them is
    /// wrong.
    pub fn read(file: &Path) -> Result<CourseFiles> {
        let text = text(file)?;
        let language = course::parse(file, &text)?.language;
        let language = language.map(|name| -> Result<(String, String)> {
            let beside = file.with_file_name(&name);
            let text = self::text(&beside)
                .with_context(|| format!("{} names a language file that cannot be used", file.display()))?;
            course::parse_language(&beside, &text)?;
            Ok((name, text))
        });
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let files = CourseFiles { course: (name, text), language: language.transpose()? };
        ensure!(
            files.language.as_ref().is_none_or(|(name, _)| *name != files.course.0),
            "{} names itself as its language file: the texts of a language are in a file of their own",
            file.display()
        );
        Ok(files)
    }

    /// A course with a title and stages only.
    pub fn of(title: Option<&str>, stages: Option<&str>) -> Result<CourseFiles> {
        let mut text = String::new();
        for (key, value) in [("title", title), ("stages", stages)] {
            if let Some(value) = value {
                // A string of JSON without control characters is also one of TOML.
                writeln!(text, "{key} = {}", serde_json::to_string(value)?)?;
            }
        }
        Ok(CourseFiles { course: ("course.toml".into(), text), language: None })
    }

    /// Returns what the files mean.
    pub fn parse(&self) -> Result<Course> {
        let (name, text) = &self.course;
        let mut course = course::parse(Path::new(name), text)?;
        if let Some((name, text)) = &self.language {
            course.translate(course::parse_language(Path::new(name), text)?);
        }
        Ok(course)
    }

    /// Applies the course to the rubric of this process.
    pub fn apply(&self) -> Result<()> {
        let course = self.parse()?;
        ensure!(rubric::use_course(course), "the rubric was read before the course file");
        Ok(())
    }

    /// Writes both files into a folder.
    pub fn write_to(&self, folder: &Path) -> Result<()> {
        crate::report::make_folder(folder)?;
        for (name, text) in [&self.course].into_iter().chain(&self.language) {
            let file = folder.join(name);
            fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
        }
        Ok(())
    }
}

fn text(file: &Path) -> Result<String> {
    let cannot = || format!("cannot read {}", file.display());
    let length = fs::metadata(file).with_context(cannot)?.len();
    ensure!(length <= LONGEST, "{} is longer than {LONGEST} bytes", file.display());
    fs::read_to_string(file).with_context(cannot)
}

/// Names a course by its title and by a fingerprint of everything that it changes except the dates. Empty for a course that
/// changes nothing.
pub fn name(course: &Course) -> String {
    if *course == Course::default() {
        return String::new();
    }
    // The name of the language file changes nothing.
    let json = serde_json::to_vec(&Course { language: None, ..course.clone() }).unwrap_or_default();
    let hash: String = Sha256::digest(json).iter().take(6).map(|byte| format!("{byte:02x}")).collect();
    format!("{} ({hash})", course.title).trim_start().to_owned()
}

/// When submissions were handed in, by student.
pub type HandedIn = BTreeMap<String, Moment>;

/// Reads a table of students and times: the grading worksheet of Moodle, or any table with a header whose first two columns are
/// students and times. Returns the times of `students`, and a line about each student and each row that found no other.
/// Returns an error if a time cannot be compared with the dates of the course.
pub fn handed_in(file: &Path, course: &Course, students: &[&str]) -> Result<(HandedIn, Vec<String>)> {
    let table = PlatformTable::read(file)?;
    let column = table.column(Column::HandedIn).unwrap_or(1);
    ensure!(
        column < table.headers().len(),
        "{}: a table of times needs a header and a column of times, such as `student,time`",
        file.display()
    );
    // Who has handed in nothing has no time.
    let found = table.find(students, |row| platform::date(&table.cell(row, column)).is_some());
    let mut times = HandedIn::new();
    for (student, row) in found.rows {
        let place = table.place(row);
        let time = platform::date(&table.cell(row, column)).unwrap_or_default();
        let time: Moment = time.parse().map_err(|why| anyhow::anyhow!("{place}: {why}"))?;
        if let Some((stage, due)) = course.due.iter().find(|(_, due)| time.compare(due).is_none()) {
            bail!(
                "{place}: {time} cannot be compared with {due}, when stage {stage} is due: write both with an offset from UTC, \
                 such as +01:00, or both without"
            );
        }
        times.insert(student, time);
    }
    Ok((times, [found.students, found.others].concat()))
}

/// Prints what a course file means.
pub fn show(given: &Given) -> Result<bool> {
    CourseFiles::read(given.required(0)?.as_ref())?.apply()?;
    let course = rubric::course();
    let name = name(course);
    say(format_args!("{}\n\n", if name.is_empty() { "This course file changes nothing." } else { &name }));
    say(format_args!(
        "{:>5}  {:>6}  {:>6}  {:>6}  {:<25}  title\n",
        "stage", "checks", "points", "core", "due"
    ));
    let (mut total, mut total_core) = (0, 0);
    for (number, stage) in rubric::stages() {
        let (points, core) = (stage.points(), stage.score().core.1);
        (total, total_core) = (total + points, total_core + core);
        let due = course.due.get(&number).map_or("-".to_owned(), Moment::to_string);
        let n = stage.checks.len();
        say(format_args!("{number:>5}  {n:>6}  {points:>6}  {core:>6}  {due:<25}  {}\n", stage.title));
    }
    say(format_args!("{total:>21}  {total_core:>6}  in all\n"));
    for stage in course.due.keys().filter(|stage| course.leaves_out(**stage)) {
        say(format_args!("note: stage {stage} has a date, but `stages` leaves it out\n"));
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Course {
        course::parse(Path::new("course.toml"), text).unwrap()
    }

    #[test]
    fn a_course_is_named_by_what_it_changes_and_not_by_its_dates() {
        assert_eq!(name(&parsed("# nothing\n")), "");
        let one = name(&parsed("title = \"Graphics\"\n[stage1]\npoints = 100\ndue = 2026-11-02\n"));
        assert!(one.starts_with("Graphics (") && one.len() == "Graphics (".len() + 13, "{one}");
        assert_eq!(one, name(&parsed("title = 'Graphics'\n[stage1]\ndue = 2026-11-09\npoints = 100\n")));
        assert_ne!(one, name(&parsed("title = \"Graphics\"\n[stage1]\npoints = 101\n")));
    }

    #[test]
    fn times_are_read_from_a_table_and_errors_name_the_line() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("times.csv");
        let read = |text: &str, course: &str| {
            fs::write(&file, text).unwrap();
            handed_in(&file, &parsed(course), &["ann", "b, c"]).map_err(|error| format!("{error:#}"))
        };
        let (times, others) =
            read("student,time\nann, 2026-11-02 18:30:00\n\"b, c\",2026-11-03\nEve,2026-11-03\n", "")
                .unwrap();
        assert_eq!(times["ann"].to_string(), "2026-11-02 18:30:00");
        assert_eq!(times.len(), 2);
        assert!(others[0].ends_with(":4: Eve: no submission") && others.len() == 1, "{others:?}");
        let twice = read("student,time\nann,2026-11-02\nann,2026-11-03\n", "").unwrap();
        assert!(twice.0.is_empty() && twice.1[0].contains("have this name"), "{twice:?}");
        let moodle = "Identifier;\"Full name\";\"Last modified (submission)\"\n\
                      Participant 7;\"Ann Lee\";\"Montag, 2. November 2026, 18:30\"\nParticipant 8;Bob;-\n";
        std::fs::write(&file, moodle).unwrap();
        let student = "Ann Lee_7_assignsubmission_file_";
        let (times, others) = handed_in(&file, &parsed(""), &[student]).unwrap();
        assert_eq!((times[student].to_string().as_str(), others.len()), ("2026-11-02 18:30:00", 0));
        for (text, words) in [
            ("ann\n", ": a table of times needs a header and a column of times"),
            ("student,time\nann,monday\n", ":2: `monday` is not a date such as"),
            (
                "student,time\nann,2026-11-02T12:00:00Z\n",
                ":2: 2026-11-02 12:00:00Z cannot be compared with 2026-11-02",
            ),
        ] {
            let error = read(text, "[stage1]\ndue = 2026-11-02\n").unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn a_language_file_is_read_from_the_same_folder() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("course.toml");
        fs::write(&file, "language = \"german.toml\"\n").unwrap();
        let error = format!("{:#}", CourseFiles::read(&file).unwrap_err());
        assert!(error.contains("names a language file that cannot be used"), "{error}");
        fs::write(folder.path().join("german.toml"), "[stage1]\ntitel = \"Formen\"\n").unwrap();
        let error = format!("{:#}", CourseFiles::read(&file).unwrap_err());
        assert!(error.contains("german.toml:2:1: unknown key `titel`; did you mean `title`?"), "{error}");
        fs::write(folder.path().join("german.toml"), "[stage1]\ntitle = \"Formen\"\n").unwrap();
        let files = CourseFiles::read(&file).unwrap();
        assert_eq!(files.parse().unwrap().changes["stage1"].title.as_deref(), Some("Formen"));
        let copy = tempfile::tempdir().unwrap();
        files.write_to(copy.path()).unwrap();
        assert_eq!(CourseFiles::read(&copy.path().join("course.toml")).unwrap(), files);
    }
}
