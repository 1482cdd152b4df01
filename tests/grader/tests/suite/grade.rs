//! Tests `grader grade` and `merge` as instructors run them, with a small class on stage 1.

use super::said_by;
use grader::exercises;
use grader::files_below::files_below;
use grader::kits::root;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

const SEED: &str = "11";

fn grader() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_grader"));
    command.current_dir(root().unwrap()).stdin(Stdio::null());
    command
}

fn grade(class: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = grader();
    command.arg("grade").arg(class).arg("--out").arg(out);
    command.args(["--stages", "1", "--seed", SEED]).args(more);
    command
}

/// Returns the reference's stage 1 without the marks.
pub fn right() -> String {
    let file = root().unwrap().join("solutions/src/stage1_shapes.rs");
    exercises::answer(&fs::read_to_string(&file).unwrap(), &file).unwrap()
}

pub fn hand_in(class: &Path, student: &str, text: &str) {
    let folder = class.join(student).join("exercises/src");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("stage1_shapes.rs"), text).unwrap();
}

/// A class of five submissions: a right one, one that does not compile, an untouched one, one that exits, and a malformed
/// archive.
fn class() -> tempfile::TempDir {
    let class = tempfile::tempdir().unwrap();
    let (right, stub) =
        (right(), fs::read_to_string(root().unwrap().join("exercises/src/stage1_shapes.rs")).unwrap());
    hand_in(class.path(), "ann", &right);
    hand_in(class.path(), "bob", &right.replace("pub fn plane(", "pub fn plane_("));
    hand_in(class.path(), "cat", &stub);
    hand_in(class.path(), "dan", &format!("{right}\nunsafe fn leave() {{}}\n"));
    fs::write(class.path().join("eve.zip"), "no zip").unwrap();
    class
}

/// Returns students and points from the table.
fn points(out: &Path) -> Vec<(String, u32)> {
    let table = fs::read_to_string(out.join("grades.csv")).unwrap();
    // The names of these students contain no comma.
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        (cells[0].trim_matches('"').to_owned(), cells[1].parse().unwrap())
    };
    table.lines().skip(1).map(row).collect()
}

pub fn graded(out: &Path) -> Vec<(String, String)> {
    let Ok(connection) = rusqlite::Connection::open(out.join("grades.sqlite")) else { return Vec::new() };
    let Ok(mut statement) = connection.prepare("SELECT student, json FROM graded ORDER BY student") else {
        return Vec::new();
    };
    statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?))).unwrap().filter_map(Result::ok).collect()
}

fn results(out: &Path) -> String {
    fs::read_to_string(out.join("results.json")).unwrap()
}

fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let names = files_below(folder, "", &|_| true).unwrap();
    names.into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

/// Returns the outputs of a run without those that hold times: the database, `timings.csv`, and the list of slow submissions.
fn reports(out: &Path) -> Vec<(String, Vec<u8>)> {
    let timeless = |(name, bytes): (String, Vec<u8>)| {
        if name.starts_with("grades.sqlite") || name == "timings.csv" {
            return None;
        }
        let mut text = String::from_utf8(bytes).unwrap();
        if name == "index.html" {
            let (before, rest) = text.split_once("id=\"slowest\"").unwrap_or((&text, ""));
            text = format!("{before}{}", rest.split_once("</section>").map_or("", |(_, after)| after));
        }
        Some((name, text.into_bytes()))
    };
    files(out).into_iter().filter_map(timeless).collect()
}

/// Kills runs at moments that are spread over the time of a whole run. It takes minutes, so it runs only with `CI_LONG=1`.
#[test]
fn fifty_kills_change_no_byte_of_the_reports() {
    if std::env::var_os("CI_LONG").is_none() {
        return println!("killed only with CI_LONG=1");
    }
    const KILLS: u32 = 50;
    let class = class();
    for number in 0..30 {
        let text = right().replace("0.5", &format!("0.{number:02}"));
        hand_in(class.path(), &format!("student-{number:02}"), &text);
    }
    let outs = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let [whole, killed] = [0, 1].map(|index| outs[index].path());
    let begun = Instant::now();
    grade(class.path(), whole, &[]).output().unwrap();
    let longest = begun.elapsed() / 2;
    let mut stored = vec![0];
    for kill in 0..KILLS {
        let mut run = grade(class.path(), killed, &["--resume"]);
        let mut run = run.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(longest * kill / KILLS);
        run.kill().unwrap();
        run.wait().unwrap();
        stored.push(graded(killed).len());
    }
    stored.dedup();
    println!("stored grades between {KILLS} kills: {stored:?} of 35");
    assert!(stored.len() > 2, "the kills came too early or too late");
    grade(class.path(), killed, &["--resume"]).output().unwrap();
    assert_eq!(graded(killed).len(), 35);
    assert!(reports(killed) == reports(whole), "a report differs");
}

#[test]
fn a_class_gets_the_same_grades_however_often_the_run_is_killed_and_however_it_is_shared_out() {
    let class = class();
    let outs: Vec<tempfile::TempDir> = (0..4).map(|_| tempfile::tempdir().unwrap()).collect();
    let [whole, killed, first, second] = [0, 1, 2, 3].map(|index| outs[index].path());
    let handed_in = files(class.path());

    let output = grade(class.path(), whole, &["--jobs", "2"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "one of them is a malformed archive:\n{}", said_by(&output));
    assert!(said_by(&output).contains("eve: cannot be unpacked"), "{}", said_by(&output));
    let all = points(whole).into_iter().map(|(name, points)| (name, points > 0)).collect::<Vec<_>>();
    let expected = [("ann", true), ("bob", false), ("cat", false), ("dan", false), ("eve", false)];
    assert_eq!(all, expected.map(|(name, some)| (name.to_owned(), some)));
    let full: u32 = fs::read_to_string(root().unwrap().join("tests/checks/stage1/rubric.toml"))
        .unwrap()
        .lines()
        .filter_map(|line| line.strip_prefix("points = ")?.parse::<u32>().ok())
        .sum();
    assert_eq!(points(whole)[0].1, full);

    // Kill the run by its process id as soon as it has stored a grade.
    let mut run = grade(class.path(), killed, &["--jobs", "1"]).stderr(Stdio::null()).spawn().unwrap();
    let late = Instant::now() + Duration::from_secs(300);
    while graded(killed).is_empty() && run.try_wait().unwrap().is_none() {
        assert!(Instant::now() < late, "no grade is stored");
        std::thread::sleep(Duration::from_millis(20));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    let before = graded(killed);
    assert!(!before.is_empty() && before.len() < 5, "{} were done", before.len());
    let again = said_by(&grade(class.path(), killed, &[]).output().unwrap());
    assert!(again.contains("--resume"), "{again}");
    assert_eq!(grade(class.path(), killed, &["--resume"]).status().unwrap().code(), Some(1));
    // The stored grades are unchanged, with their milliseconds: nothing was graded twice.
    assert!(before.iter().all(|row| graded(killed).contains(row)));
    assert_eq!(results(killed), results(whole));

    for (part, out) in [("1/2", first), ("2/2", second)] {
        let output = grade(class.path(), out, &["--shard", part]).output().unwrap();
        assert!(out.join("results.json").exists(), "{}", said_by(&output));
    }
    let merged = tempfile::tempdir().unwrap();
    let mut merge = grader();
    merge.arg("merge").args([first, second]).arg("--out").arg(merged.path());
    assert_eq!(merge.status().unwrap().code(), Some(1));
    assert_eq!(results(merged.path()), results(whole));

    // A merge without one of the parts names it, and writes nothing.
    let hole = tempfile::tempdir().unwrap();
    let output = grader().arg("merge").arg(first).arg("--out").arg(hole.path()).output().unwrap();
    assert!(said_by(&output).contains("part 2 of 2 is missing"), "{}", said_by(&output));
    assert!(files(hole.path()).is_empty());
    let again = said_by(&grade(class.path(), first, &["--shard", "2/2", "--resume"]).output().unwrap());
    assert!(again.contains("the grades there are of part 1/2, and part 2/2 is to be graded"), "{again}");

    // One student hands in again. No other submission is graded again.
    let before = graded(whole);
    hand_in(class.path(), "cat", &right());
    assert_eq!(grade(class.path(), whole, &["--resume"]).status().unwrap().code(), Some(1));
    let after = graded(whole);
    let changed: Vec<&String> =
        before.iter().zip(&after).filter(|(old, new)| old != new).map(|((name, _), _)| name).collect();
    assert_eq!(changed, ["cat"]);
    assert_eq!(points(whole)[2].1, full);

    hand_in(
        class.path(),
        "cat",
        &fs::read_to_string(root().unwrap().join("exercises/src/stage1_shapes.rs")).unwrap(),
    );
    assert_eq!(files(class.path()), handed_in, "a submission was changed");
}

/// Cargo takes files with the same modification time for unchanged. In a shared target folder, one submission would get the
/// program of another.
#[test]
fn submissions_of_one_age_are_not_taken_for_each_other() {
    let (class, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let right = right();
    let wrong = right.replace(
        "pub fn plane(",
        "pub fn plane(_: &Ray, _: Vec3, _: Vec3) -> Option<f32> {\n    None\n}\n\nfn unused(",
    );
    assert_ne!(right, wrong);
    // Alternate right and wrong submissions, so that each kind follows the other.
    for (student, text) in [("a", &right), ("b", &wrong), ("c", &right), ("d", &wrong)] {
        hand_in(class.path(), student, text);
        let file = class.path().join(student).join("exercises/src/stage1_shapes.rs");
        fs::File::options().append(true).open(file).unwrap().set_modified(SystemTime::UNIX_EPOCH).unwrap();
    }
    let output = grade(class.path(), out.path(), &["--jobs", "1"]).output().unwrap();
    assert!(output.status.success(), "{}", said_by(&output));
    let points: Vec<u32> = points(out.path()).into_iter().map(|(_, points)| points).collect();
    assert!(points[1] < points[0] && points[1] > 0, "{points:?}");
    assert_eq!(points, [points[0], points[1], points[0], points[1]]);

    // A submission can link every library in the folder, so it must not contain the solutions.
    let folders = fs::read_dir(root().unwrap().join("target/grade")).unwrap();
    let folders = folders.map(|entry| entry.unwrap().path());
    let libraries: Vec<String> = folders
        .filter(|path| path.file_name().unwrap().to_string_lossy().starts_with("libraries-"))
        .flat_map(|folder| files(&folder).into_iter().map(|(file, _)| file))
        .collect();
    assert!(libraries.iter().any(|file| file == "libraykata.rlib"), "{libraries:?}");
    for secret in ["solutions", "exercises", "checks", "grader"] {
        assert_eq!(libraries.iter().find(|file| file.contains(secret)), None);
    }
}

#[test]
fn what_cannot_be_graded_is_said_in_words() {
    let (class, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let nowhere = grader().args(["grade", "/no/such/folder", "--out"]).arg(out.path()).output().unwrap();
    assert!(said_by(&nowhere).contains("cannot read the folder /no/such/folder"), "{}", said_by(&nowhere));
    let empty = said_by(&grade(class.path(), out.path(), &[]).output().unwrap());
    assert!(empty.contains("no submission"), "{empty}");
    let none = grader().arg("merge").arg(class.path()).arg("--out").arg(out.path()).output().unwrap();
    assert!(said_by(&none).contains("contains no grades"), "{}", said_by(&none));
}
