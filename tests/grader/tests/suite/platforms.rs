//! A class goes to Moodle and Canvas and back: tables in the form in which the platforms write them.

use super::grade::{hand_in, right};
use super::{grader, grader_succeeds, said_by};
use std::fs;
use std::io::Read;
use std::path::Path;

const COURSE: &str = "stages = \"1\"\n[stage1]\npoints = 100\ndue = 2026-11-02\n";

/// A grading worksheet with a header in German, `;`, a decimal comma, a name with a line end, and two students of one name.
const MOODLE: &str = "\u{feff}ID;\"Vollständiger Name\";E-Mail-Adresse;Status;Bewertung;Bestwertung;\"Bewertung kann geändert werden\";\"Zuletzt geändert (Abgabe)\";\"Feedback als Kommentar\"\r\n\
Teilnehmer/in41;\"Ann \"\"A.\"\"\nLee\";ann@uni.example;\"Abgegeben\";;50,00;Ja;\"Montag, 2. November 2026, 18:30\";\r\n\
Teilnehmer/in42;\"Bo Böll\";b@uni.example;\"Abgegeben\";\"7,5\";50,00;Ja;\"Mittwoch, 4. November 2026, 08:00\";\"alt; mit\"\r\n\
Teilnehmer/in43;\"Bo Böll\";bb@uni.example;\"Keine Abgabe\";;50,00;Ja;-;\r\n";

const CANVAS: &str = "Student,ID,SIS User ID,SIS Login ID,Section,Kit (77),Essay (78),Final Score\n\
    Points Possible,,,,,100,10.0,(read only)\n\
\"Böll, Bo\",42,s42,bo1,A,,9.5,95.0\n\"Fox, Tom\",44,s44,tom,A,3.00,,\n\"Student, Test\",99,,x,A,,,\n";

fn text(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

#[test]
fn a_class_goes_from_the_platforms_and_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (class, grades, out) = (path("class"), path("grades"), path("out"));
    let course = path("course.toml");
    fs::write(&course, COURSE).unwrap();
    fs::write(path("moodle.csv"), MOODLE).unwrap();
    fs::write(path("canvas.csv"), CANVAS).unwrap();
    let class_folder = folder.path().join("class");
    hand_in(&class_folder, "Ann A. Lee_41_assignsubmission_file_", &right());
    hand_in(&class_folder, "bollbo_LATE_42_9_kit", &right());
    hand_in(&class_folder, "eve", "");
    let times = path("moodle.csv");
    let grade = format!("grade {class} --out {grades} --course {course} --seed 5 --handed-in {times}");
    let graded = grader(grade.split(' '));
    let said = said_by(&graded);
    assert!(graded.status.success() && said.contains("--handed-in: eve: no row has this name"), "{said}");
    assert!(text(&folder.path().join("grades/gradescope/bollbo_LATE_42_9_kit.json")).contains("1 day late"));

    // The instructor's notes survive each run, and one submission is graded again.
    fs::write(path("grades/notes.csv"), "student;points;note\nbollbo_late_42_9_kit;-5;late\nzed;1;\n")
        .unwrap();
    let said = said_by(&grader(["grade", &class, "--out", &grades, "--resume", "--again", "eve"]));
    assert!(said.contains("notes.csv:3: zed: no submission"), "{said}");
    let page = text(&folder.path().join("grades/students/bollbo_LATE_42_9_kit.html"));
    assert!(page.contains("-5 points from your instructor: late"));

    // The points of the platform and of the stages differ, which is said.
    let export = |platform: &str, table: &str, more: &[&str]| {
        grader([&["export", platform, table, &grades, "--out", &out], more].concat())
    };
    let refused = said_by(&export("moodle", &path("moodle.csv"), &[]));
    assert!(
        refused.contains("the assignment has 50 points at most, and the graded stages have 100"),
        "{refused}"
    );
    let said = said_by(&export("moodle", &path("moodle.csv"), &["--scale"]));
    assert!(
        said.contains("2 of 3 submissions filled in") && said.contains("not matched: eve: no row"),
        "{said}"
    );
    assert!(said.contains("moodle.csv:5: Bo Böll, Teilnehmer/in43, bb@uni.example: no submission"), "{said}");
    let filled = text(&folder.path().join("out/moodle.csv"));
    let points = |row: &str| row.rsplit(";50,00").nth(1).unwrap().rsplit(';').next().unwrap().to_owned();
    assert_eq!(points(filled.split("Teilnehmer/in").nth(1).unwrap()), "50");
    let bo = points(filled.split("Teilnehmer/in").nth(2).unwrap());
    assert_eq!(bo, "\"47,5\"", "half of 95, in the quotes of the cell before");
    // All else is as it was downloaded.
    let without = |text: &str| {
        let rows = text.split("Teilnehmer/in").map(|row| {
            row.split(";50,00").next().unwrap().rsplit_once(';').map_or("", |(kept, _)| kept).to_owned()
        });
        rows.collect::<Vec<_>>()
    };
    assert_eq!(without(&filled), without(MOODLE));
    assert!(filled.contains(";\"100 of 100 points ") || filled.contains("100 of 100 points"), "{filled}");
    let mut zip =
        zip::ZipArchive::new(fs::File::open(folder.path().join("out/feedback.zip")).unwrap()).unwrap();
    let names: Vec<String> = zip.file_names().map(str::to_owned).collect();
    assert_eq!(
        names,
        [
            "Ann \"A.\" Lee_41_assignsubmission_file_/feedback.html",
            "Bo Böll_42_assignsubmission_file_/feedback.html"
        ]
    );
    let mut page = String::new();
    zip.by_index(0).unwrap().read_to_string(&mut page).unwrap();
    assert!(page.contains("100</b> of 100 points"));

    // Canvas: one column is meant, and rows that are no students stay.
    let said = said_by(&export("canvas", &path("canvas.csv"), &[]));
    assert!(
        said.contains("choose the column of the points with --column; the table has `Student`"),
        "{said}"
    );
    let said = said_by(&export("canvas", &path("canvas.csv"), &["--column", "Kit"]));
    assert!(said.contains("1 of 3 submissions filled in") && said.contains("Fox, Tom"), "{said}");
    let filled = text(&folder.path().join("out/canvas.csv"));
    let (before, after): (Vec<&str>, Vec<&str>) = (CANVAS.lines().collect(), filled.lines().collect());
    assert_eq!((&after[..2], &after[3..]), (&before[..2], &before[3..]));
    assert!(
        after[2].starts_with("\"Böll, Bo\",42,s42,bo1,A,")
            && after[2].ends_with(",9.5,95.0")
            && after[2] != before[2]
    );

    // New points count after grading, without grading again.
    fs::write(&course, COURSE.replace("100", "60")).unwrap();
    grader_succeeds(["grade", &class, "--out", &grades, "--course", &course, "--resume"]);
    assert!(
        text(&folder.path().join("grades/grades.csv"))
            .contains("\"Ann A. Lee_41_assignsubmission_file_\",60,60,100")
    );
}
