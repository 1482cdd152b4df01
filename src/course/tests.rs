use super::*;
use crate::course::stage::PLAIN;
use std::path::Path;

fn course(text: &str) -> Course {
    parse(Path::new("course.toml"), text).unwrap()
}

fn error(text: &str) -> String {
    parse(Path::new("course.toml"), text).unwrap_err().to_string()
}

/// The rubric of a course.
fn rubric(course: &Course) -> BTreeMap<String, Stage> {
    let mut stages = PLAIN.clone();
    course.apply(&mut stages);
    stages
}

const NEAREST: &str = "nearest_root_of_nan_is_the_other_one";

#[test]
fn the_files_of_the_kit_change_nothing() {
    assert_eq!(course(include_str!("../../tests/course.toml")), Course::default());
    let language = include_str!("../../tests/language.toml");
    assert_eq!(parse_language(Path::new("language.toml"), language).unwrap(), Course::default());
}

/// The examples in the comments of the kit's files are what instructors copy.
#[test]
fn the_examples_in_the_kits_files_are_valid() {
    let active = |text: &str| -> String {
        let example = |line: &str| line.strip_prefix("#: ").map(|line| format!("{line}\n"));
        text.lines().filter_map(example).collect()
    };
    let course = course(&active(include_str!("../../tests/course.toml")));
    assert!(!course.title.is_empty() && !course.stages.is_empty() && !course.due.is_empty());
    let language = active(include_str!("../../tests/language.toml"));
    let language = parse_language(Path::new("language.toml"), &language).unwrap();
    let keys: Vec<&str> = language.texts.keys().map(String::as_str).collect();
    let mut known = TEXTS.map(|(key, _)| key);
    known.sort_unstable();
    assert_eq!(keys, known, "the example has all texts");
}

#[test]
fn the_points_of_a_stage_are_those_without_the_bonus() {
    let with = rubric(&course("[stage12]\npoints = 100\n"));
    assert_eq!(with["stage12"].points(), 100);
    let bonus = |stage: &Stage| -> u32 {
        stage.checks.values().filter(|check| check.level() == Level::Bonus).map(|check| check.points).sum()
    };
    assert!(bonus(&PLAIN["stage12"]) > 0);
    assert_eq!(bonus(&with["stage12"]), bonus(&PLAIN["stage12"]));
}

#[test]
fn a_course_pins_stages_points_titles_and_dates() {
    let course = course(&format!(
        "title = \"Graphics\"\nstages = \"1-2,4\"\nlanguage = \"german.toml\"\n[stage1]\ntitle = \"rays\"\npoints = 50\n\
         due = 2026-11-02\n[stage1.checks.{NEAREST}]\npoints = 0\ntitle = \"NaN\"\nhints = [\"\", \"b\", \"\"]\n"
    ));
    assert_eq!((course.title.as_str(), &course.stages[..]), ("Graphics", &[1, 2, 4][..]));
    assert!(course.leaves_out(3) && !course.leaves_out(4));
    assert_eq!(course.due[&1].to_string(), "2026-11-02");
    let stages = rubric(&course);
    let (stage, before) = (&stages["stage1"], &PLAIN["stage1"]);
    assert_eq!((stage.title.as_str(), stage.points()), ("rays", 50));
    let (check, was) = (&stage.checks[NEAREST], &before.checks[NEAREST]);
    assert_eq!((check.points, check.title.as_str()), (0, "NaN"));
    assert_eq!(check.hints, [was.hints[0].clone(), "b".into(), was.hints[2].clone()]);
    assert!(stage.checks.iter().all(|(name, check)| check.points > 0 || name == NEAREST));
    assert_eq!(stages["stage2"], PLAIN["stage2"]);
}

#[test]
fn a_course_may_grade_the_core_alone() {
    let stages = rubric(&course(&format!(
        "core_only = true\n[stage1.checks.{NEAREST}]\npoints = 2\n[stage2]\npoints = 40\n"
    )));
    let before = PLAIN["stage1"].score().core.1;
    assert_eq!(stages["stage1"].score().to_string(), format!("0 of {before} core · 0 deeper"));
    assert_eq!(stages["stage1"].points(), before + 2);
    assert_eq!(stages["stage2"].score().to_string(), "0 of 40 core");
    let error = error("core_only = true\n[stage3]\npoints = 3\n");
    assert!(error.contains("3 points cannot be divided among 24 checks"), "{error}");
}

#[test]
fn a_language_fills_in_what_the_course_does_not_say() {
    let mut course = course("[stage1]\ntitle = \"Strahlen\"\n");
    let language = format!(
        "[texts]\nwelcome = \"Willkommen.\"\n[stage1]\ntitle = \"Formen\"\n[stage2]\ntitle = \"Netze\"\n\
         [stage1.checks.{NEAREST}]\ntitle = \"NaN ist kein Treffer\"\n"
    );
    course.translate(parse_language(Path::new("german.toml"), &language).unwrap());
    let stages = rubric(&course);
    assert_eq!((stages["stage1"].title.as_str(), stages["stage2"].title.as_str()), ("Strahlen", "Netze"));
    assert_eq!(stages["stage1"].checks[NEAREST].title, "NaN ist kein Treffer");
    assert_eq!(stages["stage3"], PLAIN["stage3"]);
    assert_eq!((course.text("welcome"), course.text("next")), ("Willkommen.", "Next"));
}

#[test]
fn errors_name_the_place_and_what_to_do() {
    for (text, words) in [
        ("titel = \"x\"\n", "course.toml:1:1: unknown key `titel`; did you mean `title`?"),
        ("title = 3\n", "course.toml:1:9: `title` must be text between quotes, but is 3"),
        ("title = \"\"\n", "course.toml:1:9: `title` must be one line of text"),
        ("\nstages = \"1-13\"\n", "course.toml:2:10: there is no stage 13; there are stages 1 to 12"),
        ("stages = \"a\"\n", "course.toml:1:10: `a` is not a stage number"),
        ("stages = \"1,\"\n", "course.toml:1:10: `` is not a stage number"),
        ("stages = \"0\"\n", "course.toml:1:10: there is no stage 0"),
        ("stages = \"4-2\"\n", "course.toml:1:10: `4-2` names no stage"),
        (
            "[stage1]\ndue = \"monday\"\n",
            "course.toml:2:7: `due` must be a date without quotes, such as 2026-11-02",
        ),
        ("[stage1]\ndue = 12:00:00\n", "course.toml:2:7: `due` must be a date"),
        ("[stage1]\npoints = 3\n", "course.toml:2:10: 3 points cannot be divided among"),
        ("[stage1]\npoints = -3\n", "course.toml:2:10: `points` must be a whole number from 0 to 10000"),
        ("[stage13]\n", "course.toml:1:2: unknown key `stage13`"),
        ("language = \"../a.toml\"\n", "help: put the language file beside the course file"),
        ("[stage1.checks.nearest]\n", "unknown check of stage 1 `nearest`"),
        ("[stage1.checks.nearest]\n", "help: `cargo run -- list 1` shows the names of the checks"),
        ("title = Graphics\n", "help: put text between quotes"),
    ] {
        let error = error(text);
        assert!(error.contains(words), "{error}");
    }
    let points = "[stage1]\npoints = 3\n";
    let error = parse_language(Path::new("german.toml"), points).unwrap_err().to_string();
    assert!(error.starts_with("german.toml:2:1: unknown key `points`"), "{error}");
}
