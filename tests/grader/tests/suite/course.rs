//! Tests the course file as instructors use it: in grades, in reports, in exports and in a hand-out.

use super::grade::{graded, hand_in, right};
use super::program_runs::root;
use super::{grader, grader_succeeds, said_by};
use std::fs;
use std::path::Path;

const COURSE: &str = "title = \"Computergrafik\"\nstages = \"1\"\nlanguage = \"german.toml\"\n\
                      [stage1]\npoints = 200\ndue = 2026-11-02\n\
                      [stage1.checks.nearest_root_of_nan_is_the_other_one]\npoints = 0\n";
const GERMAN: &str = "[texts]\nwelcome = \"Willkommen.\"\n[stage1]\ntitle = \"Formen\"\n\
                      [stage1.checks.nearest_root_of_nan_is_the_other_one]\ntitle = \"NaN ist kein Treffer\"\n";

/// Writes a course file and its language file into a folder, and returns the path of the course file.
fn written(folder: &Path, course: &str) -> String {
    fs::write(folder.join("german.toml"), GERMAN).unwrap();
    let file = folder.join("course.toml");
    fs::write(&file, course).unwrap();
    file.to_string_lossy().into_owned()
}

fn text(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

#[test]
fn a_course_file_decides_stages_points_and_titles_of_a_class_and_marks_what_is_late() {
    let folders: Vec<tempfile::TempDir> = (0..5).map(|_| tempfile::tempdir().unwrap()).collect();
    let [class, out, first, second, merged] = [0, 1, 2, 3, 4].map(|index| folders[index].path());
    let files = tempfile::tempdir().unwrap();
    let course = written(files.path(), COURSE);
    hand_in(class, "ann", &right());
    hand_in(class, "bob", &right().replace("pub fn plane(", "pub fn plane_("));
    let times = files.path().join("times.csv");
    fs::write(&times, "student,time\nann,2026-11-02T20:00:00\nbob,2026-11-04T08:00:00\n").unwrap();
    let times = times.to_string_lossy().into_owned();
    let grade = |out: &Path, more: &[&str]| {
        let [class, out] = [class, out].map(|path| path.to_string_lossy().into_owned());
        grader([&["grade", &class, "--out", &out, "--seed", "11"], more].concat())
    };

    let output = grade(out, &["--course", &course, "--handed-in", &times]);
    assert!(output.status.success(), "{}", said_by(&output));
    let table = text(out, "grades.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..5], ["\"name\"", "\"points\"", "\"of\"", "\"percent\"", "\"stage1\""]);
    assert_eq!(rows[0][5..8], ["\"bonus\"", "\"handed_in\"", "\"late_stages\""]);
    assert_eq!(rows[1][..5], ["\"ann\"", "200", "200", "100", "200"], "all points of the stage");
    assert_eq!(rows[1][6..8], ["\"2026-11-02 20:00:00\"", "\"\""]);
    assert_eq!((rows[2][0], rows[2][7]), ("\"bob\"", "1"));
    let page = text(out, "students/bob.html");
    for words in
        ["NaN ist kein Treffer", "Stage 1 · Formen", "Computergrafik (", "1 day late", "as if it was in time"]
    {
        assert!(page.contains(words), "{words}");
    }
    assert!(!text(out, "students/ann.html").contains("<h2>Late"));
    assert!(text(out, "gradescope/bob.json").contains("stage 1 was handed in 1 day late"));
    assert!(text(out, "index.html").contains("Handed in late"));

    // Other points count without grading again, and stages that were not graded are refused.
    let other = tempfile::tempdir().unwrap();
    let more_points = tempfile::tempdir().unwrap();
    let changed = written(more_points.path(), &COURSE.replace("200", "300"));
    assert!(grade(out, &["--course", &changed, "--resume"]).status.success());
    assert!(text(out, "grades.csv").contains("\"ann\",300,300,100"));
    let untitled = written(other.path(), "title = \"x\"\n");
    let output = grade(out, &["--stages", "2", "--resume", "--course", &untitled]);
    let said = said_by(&output);
    assert!(!output.status.success() && said.contains("were made in another way (stages 1,"), "{said}");
    assert!(grade(out, &["--course", &course, "--resume"]).status.success());
    // A later date grades nothing again; a run without the option takes the stored file.
    let before = graded(out);
    let later = written(other.path(), &COURSE.replace("2026-11-02", "2026-11-09"));
    assert!(grade(out, &["--course", &later, "--resume"]).status.success());
    assert!(grade(out, &["--resume"]).status.success());
    assert_eq!(graded(out), before);
    assert!(!text(out, "students/bob.html").contains("<h2>Late"), "the new date counts");
    assert!(text(out, "students/bob.html").contains("NaN ist kein Treffer"));

    // Parts are merged with the titles of their course, and not with those of another one.
    assert!(grade(first, &["--course", &course, "--shard", "1/2", "--handed-in", &times]).status.success());
    let merge = || {
        let [first, second, merged] = [first, second, merged].map(|path| path.to_string_lossy().into_owned());
        grader(["merge", &first, &second, "--out", &merged])
    };
    for (other, words) in [(&later, "has other dates than"), (&changed, "the same kit, course file")] {
        assert!(grade(second, &["--course", other, "--shard", "2/2"]).status.success());
        let output = merge();
        assert!(!output.status.success() && said_by(&output).contains(words), "{}", said_by(&output));
        fs::remove_dir_all(second).unwrap();
    }
    assert!(grade(second, &["--course", &course, "--shard", "2/2", "--handed-in", &times]).status.success());
    let output = merge();
    assert!(output.status.success(), "{}", said_by(&output));
    assert_eq!(text(merged, "grades.csv"), table);
    assert!(text(merged, "students/ann.html").contains("Formen"));
}

#[test]
fn a_course_file_that_is_wrong_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let class = tempfile::tempdir().unwrap();
    hand_in(class.path(), "ann", "");
    let [submissions, out] =
        [class.path().to_owned(), folder.path().join("out")].map(|path| path.to_string_lossy().into_owned());
    let course = written(folder.path(), "title = \"x\"\n[stage1]\ndeu = 2026-11-02\n");
    for arguments in [
        &["course", &course][..],
        &["grade", &submissions, "--out", &out, "--course", &course],
        &["handout", &out, "--course", &course],
        &["export", "classroom", "--out", &out, "--course", &course],
    ] {
        let output = grader(arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let said = said_by(&output);
        assert!(said.contains("course.toml:3:1: unknown key `deu`; did you mean `due`?"), "{said}");
    }
    let course = written(folder.path(), COURSE);
    let said = said_by(&grader(["grade", &submissions, "--out", &out, "--course", &course, "--stages", "2"]));
    assert!(said.contains("--stages names stage 2, which the course file leaves out"), "{said}");
    let said = grader_succeeds(["course", &course]);
    for words in ["Computergrafik (", "200", "2026-11-02", "Formen"] {
        assert!(said.contains(words), "{}", said);
    }
}

#[test]
fn a_hand_out_and_exports_contain_the_course_file() {
    let folder = tempfile::tempdir().unwrap();
    let course = written(folder.path(), COURSE);
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    grader_succeeds(["handout", &at("kit"), "--course", &course]);
    assert_eq!(text(folder.path(), "kit/tests/course.toml"), COURSE);
    assert_eq!(text(folder.path(), "kit/tests/language.toml"), GERMAN);
    let readme = text(folder.path(), "kit/README.md");
    assert!(!readme.contains("kd-trees"), "stage 9 is left out");
    assert!(readme.starts_with("# Computergrafik: Raykata\n"), "{readme}");
    assert!(readme.contains("\n| 1 | ") && !readme.contains("\n| 2 | "), "{readme}");
    assert!(!readme.contains("weeks"), "{readme}");
    // The title and the stages alone need no file.
    grader_succeeds(["handout", &at("plain"), "--title", "Graphics \"1\"", "--stages", "1-2"]);
    assert_eq!(
        text(folder.path(), "plain/tests/course.toml"),
        "title = \"Graphics \\\"1\\\"\"\nstages = \"1-2\"\n"
    );
    assert_eq!(text(folder.path(), "plain/tests/language.toml"), text(&root(), "tests/language.toml"));

    grader_succeeds(["export", "classroom", "--out", &at("classroom"), "--course", &course, "--seed", "7"]);
    let workflow = text(folder.path(), "classroom/.github/workflows/class.yml");
    assert!(workflow.contains("--course course/course.toml --seed 7"), "{workflow}");
    assert_eq!(text(folder.path(), "classroom/course/course.toml"), COURSE);
    grader_succeeds(["export", "gradescope", "--out", &at("zip"), "--course", &course]);
    let mut zip = zip::ZipArchive::new(fs::File::open(at("zip")).unwrap()).unwrap();
    assert!(zip.by_name("course/course.toml").is_ok() && zip.by_name("course/german.toml").is_ok());
    hand_in(&folder.path().join("class"), "ann", "");
    grader_succeeds(["export", "slurm", &at("class"), "--out", &at("jobs"), "--course", &course]);
    let script = text(folder.path(), "jobs/grade.sbatch");
    assert!(script.contains("/jobs/course/course.toml"), "{script}");
    assert_eq!(text(folder.path(), "jobs/course/german.toml"), GERMAN);
}
