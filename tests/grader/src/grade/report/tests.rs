use super::*;
use crate::files_below::files_below;
use crate::grade::result::{Class, Outcome};
use anyhow::Context;
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use quick_xml::events::Event;
use serde_json::Value;
use std::collections::BTreeMap;

type Files = BTreeMap<String, String>;

fn check(stage: u8, name: &str, outcome: Outcome, points: u32, message: &str) -> CheckResult {
    let new = CheckResult::new(stage, name, outcome, message.to_owned());
    CheckResult { points, earned: if outcome == Outcome::Passed { points } else { 0 }, ..new }
}

fn student(name: &str, outcomes: [(Outcome, &str); 4]) -> Graded {
    let names = [
        (1, "nearest_root_is_the_smaller_one_that_counts", 3),
        (1, "sphere_algebraic_touches", 3),
        (1, "picture_of_a_sphere_on_a_plane", 5),
        (2, "triangle_cramer_agrees_with_double_precision", 6),
    ];
    let checks = names.into_iter().zip(outcomes);
    let checks =
        checks.map(|((stage, name, points), (outcome, said))| check(stage, name, outcome, points, said));
    Graded {
        student: name.to_owned(),
        content: "00".repeat(32),
        checks: checks.collect(),
        cpu_ms: 1234,
        ..Graded::default()
    }
}

/// A class whose students write text that could break reports.
fn class() -> Class {
    use Outcome::*;
    let nasty_message =
        "\u{1b}[31mred\u{1b}[0m ]]> <b onload='x()'>\u{202e}desrever\u{202c} \0& \"quoted\"\r\nsecond line";
    let mut formula = student(
        "=cmd|' /C calc'!A0",
        [(Passed, ""), (Wrong, nasty_message), (WrongOnHidden, "hidden input: 0.1234"), (Crashed, "")],
    );
    formula.remarks = vec![Remark {
        file: "<img src=x onerror=alert(1)>.rs\n".to_owned(),
        what: "ignored, because no exercise has that file".to_owned(),
    }];
    let mut script = student(
        "<script>alert(1)</script>",
        [(DoesNotCompile, ""), (Refused, ""), (NotTried, ""), (TooLong, &"long ".repeat(1000))],
    );
    script.compiler = "error[E0308]: </pre><script>alert(2)</script>\u{1b}]0;title\u{7}".to_owned();
    let mut picture = student("anna", [(Passed, ""), (Passed, ""), (Wrong, "it differs"), (NotWritten, "")]);
    picture.checks[2].picture = Some(Picture {
        caption: "reference | yours | difference".to_owned(),
        png: BASE64.encode(b"\x89PNG\r\n\x1a\nnot much of a picture"),
    });
    let best = student("Anna", [(Passed, ""); 4]);
    let mut broken = student("../../broken", [(Passed, ""); 4]);
    broken.checks.clear();
    broken.trouble = "the archive cannot be read: \u{202e}bad <magic>".to_owned();
    let session = Session {
        kit: "0.1.0 (abcdef)".to_owned(),
        stages: vec![1, 2],
        seed: 7,
        isolation: "rlimits + Landlock <6> + seccomp".to_owned(),
        ..Session::default()
    };
    Class { session, students: vec![formula, script, picture, best, broken] }
}

/// Writes all reports of a class into `folder`; see [`write_from`]. The students may have any order.
fn write_all(class: &Class, folder: &Path) -> Result<()> {
    let mut students: Vec<&Graded> = class.students.iter().collect();
    // Two submissions may have the same name. Sort these by their content.
    students.sort_by_key(|&graded| (&graded.student, &graded.content, &graded.trouble));
    write_from(&class.session, &|each| students.iter().try_for_each(|&graded| each(graded.clone())), folder)
        .map(drop)
}

fn files_of(class: &Class) -> Result<Files> {
    let folder = tempfile::tempdir()?;
    write_all(class, folder.path())?;
    let names = files_below(folder.path(), "", &|_| true)?;
    names.into_iter().map(|name| Ok((name.clone(), fs::read_to_string(folder.path().join(name))?))).collect()
}

/// The sum of a number over the tests of a file in JSON.
fn sum(files: &Files, file: &str, key: &str) -> Result<u64> {
    let value: Value = serde_json::from_str(&files[file])?;
    let tests = value["tests"].as_array().into_iter().flatten();
    Ok(tests.filter_map(|test| test[key].as_u64()).sum())
}

fn matches_snapshot(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("golden");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

#[test]
fn tables_and_files_for_machines_are_as_before() -> Result<()> {
    let files = files_of(&class())?;
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    matches_snapshot("files", &names.join("\n"));
    for name in ["grades.csv", "checks.csv", "timings.csv", "results.json", "junit.xml"] {
        matches_snapshot(name, &files[name]);
    }
    for folder in ["gradescope", "classroom"] {
        let of_folder = files.iter().filter(|(name, _)| name.starts_with(folder));
        let text: String = of_folder.map(|(name, text)| format!("== {name}\n{text}")).collect();
        matches_snapshot(folder, &text);
    }
    Ok(())
}

#[test]
fn pages_show_what_students_write_and_never_run_it() -> Result<()> {
    let files = files_of(&class())?;
    let pages: Vec<(&String, &String)> = files.iter().filter(|(name, _)| name.ends_with(".html")).collect();
    assert_eq!(pages.len(), 6);
    for (name, page) in &pages {
        for tag in
            ["<script", "<img src=x", "<b ", "onerror=alert(1)>.", "<magic>", "<6>", "http://", "https://"]
        {
            assert!(!page.contains(tag), "{name} contains {tag}");
        }
        assert_eq!(page.matches("</pre>").count(), page.matches("<pre>").count(), "{name}");
    }
    let anna = pages.iter().find(|(_, page)| page.contains("<pre>it differs<")).map(|(_, page)| page);
    assert!(anna.is_some_and(|page| page.contains("<img src=\"data:image/png;base64,iVBO")));
    assert!(files["index.html"].contains("&lt;script&gt;alert(1)&lt;/script&gt;"));
    Ok(())
}

#[test]
fn no_format_lets_through_what_cannot_be_seen() -> Result<()> {
    for (name, text) in files_of(&class())? {
        let hidden =
            text.chars().find(|&c| c != '\n' && (c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c)));
        assert_eq!(hidden, None, "{name}");
    }
    Ok(())
}

#[test]
fn a_check_that_fails_on_hidden_inputs_tells_no_more_than_that() -> Result<()> {
    let mut files = files_of(&class())?;
    // The instructor's file may contain the hidden input.
    files.remove("results.json");
    assert!(files.iter().all(|(_, text)| !text.contains("0.1234")));
    let text = files.values().filter(|text| text.contains("stage 1: 1 check fails on hidden inputs only"));
    assert_eq!(text.count(), 1);
    Ok(())
}

#[test]
fn the_same_results_give_the_same_bytes_in_any_order() -> Result<()> {
    let class = class();
    let files = files_of(&class)?;
    let mut other = class.clone();
    other.students.reverse();
    assert_eq!(files_of(&other)?, files);
    other.students.iter_mut().for_each(|student| student.cpu_ms += 5000);
    let slower = files_of(&other)?;
    let differing: Vec<&str> =
        files.iter().filter(|(name, text)| &slower[*name] != *text).map(|(name, _)| name.as_str()).collect();
    assert_eq!(differing, ["index.html", "timings.csv"]);
    Ok(())
}

#[test]
fn points_are_the_same_in_every_format() -> Result<()> {
    let files = files_of(&class())?;
    let back: Class = serde_json::from_str(&files["results.json"])?;
    let records = |file: &str| {
        csv::Reader::from_reader(files[file].as_bytes()).into_records().collect::<Result<Vec<_>, _>>()
    };
    let (rows, cells) = (records("grades.csv")?, records("checks.csv")?);
    assert_eq!(rows.len(), back.students.len());
    for (graded, row) in back.students.iter().zip(&rows) {
        let (earned, of) = graded.score().points();
        let [page, core] = [5, 2].map(|place| &row[row.len() - place]);
        assert_eq!(core, graded.score().core.0.to_string());
        assert_eq!(row[1], earned.to_string());
        assert_eq!(&row[2], "17");
        let stages: u32 = row[4].parse::<u32>()? + row[5].parse::<u32>()?;
        assert_eq!(stages, earned);

        let of_student = cells.iter().filter(|cells| cells[0] == row[0]);
        let in_checks: u32 = of_student.map(|cells| cells[5].parse::<u32>().unwrap_or(u32::MAX)).sum();
        assert_eq!(in_checks, earned);

        let gradescope = format!("gradescope/{page}.json");
        assert_eq!(sum(&files, &gradescope, "score")?, u64::from(earned));
        assert_eq!(sum(&files, &gradescope, "max_score")?, u64::from(of));
        assert_eq!(sum(&files, &format!("classroom/{page}.json"), "score")?, u64::from(earned));

        let html = &files[&format!("students/{page}.html")];
        let percent = if of == 0 { 0.0 } else { (100.0 * f64::from(earned) / f64::from(of)).round() };
        let shown = format!("<p class=\"points\"><b>{earned}</b> of {of} points ({percent} %)");
        assert_eq!(html.contains(&shown), !graded.checks.is_empty());
        assert!(files["junit.xml"].contains(&format!("<property name=\"points\" value=\"{earned}\"/>")));
    }
    Ok(())
}

/// A bonus is in no maximum, and is shown apart.
#[test]
fn bonus_points_stand_apart() -> Result<()> {
    let mut graded = student("Anna", [(Outcome::Passed, ""); 4]);
    let bonus = check(12, "build_parallel_has_an_eighth_of_the_span", Outcome::Passed, 2, "");
    graded.checks.push(bonus);
    assert_eq!((graded.score().points(), graded.score().bonus.0), ((17, 17), 2));
    let session = class().session;
    let files = files_of(&Class { session, students: vec![graded] })?;
    assert!(files["grades.csv"].contains("\"Anna\",17,17,100,"), "{}", files["grades.csv"]);
    let html = &files["students/Anna.html"];
    assert!(html.contains("<b>17</b> of 17 points (100 %): 9 of 9 core · 8 deeper · 2 bonus"), "{html}");
    // Gradescope adds up scores beyond the maximum; Classroom has no extra credit.
    assert_eq!(sum(&files, "gradescope/Anna.json", "score")?, 19);
    assert_eq!(sum(&files, "gradescope/Anna.json", "max_score")?, 17);
    assert_eq!(sum(&files, "classroom/Anna.json", "score")?, 17);
    assert!(files["classroom/Anna.json"].contains("(bonus: 2 of 2)"));
    Ok(())
}

/// The elements and attributes of the schema `junit-10.xsd` of Jenkins' xUnit plugin, as far as they are used.
const JUNIT: [(&str, &[&str]); 9] = [
    ("testsuites", &["name", "time", "tests", "failures", "errors"]),
    ("testsuite", &["name", "tests", "failures", "errors", "time", "skipped", "timestamp", "hostname", "id"]),
    ("properties", &[]),
    ("property", &["name", "value"]),
    ("testcase", &["name", "time", "classname", "group"]),
    ("failure", &["type", "message"]),
    ("error", &["type", "message"]),
    ("system-out", &[]),
    ("system-err", &[]),
];

#[test]
fn junit_holds_only_what_the_schema_of_jenkins_allows() -> Result<()> {
    let files = files_of(&class())?;
    let mut reader = quick_xml::Reader::from_str(&files["junit.xml"]);
    let mut n_elements = 0;
    loop {
        match reader.read_event()? {
            Event::Start(element) | Event::Empty(element) => {
                let name = String::from_utf8(element.name().as_ref().to_vec())?;
                let allowed = JUNIT.iter().find(|(allowed, _)| *allowed == name);
                let (_, attributes) = allowed.with_context(|| format!("<{name}>"))?;
                for attribute in element.attributes() {
                    let key = String::from_utf8(attribute?.key.as_ref().to_vec())?;
                    assert!(attributes.contains(&key.as_str()), "<{name} {key}=…>");
                }
                n_elements += 1;
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert!(n_elements > 20, "{n_elements} elements");
    Ok(())
}

#[test]
fn cleaning_a_submission_twice_is_cleaning_it_once() {
    for mut graded in class().students {
        let remark = Remark { file: "a".to_owned(), what: "b".to_owned() };
        graded.remarks = vec![remark; 1000];
        let once = presentable(&graded);
        assert_eq!(once.remarks.len(), REMARKS + 1);
        assert_eq!(presentable(&once), once);
    }
}

#[test]
fn an_empty_class_has_reports_too() -> Result<()> {
    let class = Class { students: Vec::new(), ..class() };
    let files = files_of(&class)?;
    assert_eq!(
        files["grades.csv"],
        "\"name\",\"points\",\"of\",\"percent\",\"bonus\",\"remarks\",\"trouble\",\"page\",\"added\",\"note\",\"core\",\"core_of\"\n"
    );
    assert!(files["index.html"].contains("No submission tried a check and failed."));
    Ok(())
}

#[test]
fn a_large_class_has_small_pages_and_every_student_is_in_one() -> Result<()> {
    let message = "  input     Ray::new(…)\n".repeat(40);
    let outcomes = [Outcome::Passed, Outcome::Wrong, Outcome::NotWritten, Outcome::Crashed];
    let students: Vec<Graded> = (0..1100)
        .map(|number| student(&format!("student-{number:04}"), outcomes.map(|one| (one, message.as_str()))))
        .collect();
    let files = files_of(&Class { students, ..class() })?;
    let index = &files["index.html"];
    let lists: Vec<(&String, &String)> =
        files.iter().filter(|(name, _)| name.starts_with("lists/")).collect();
    assert_eq!(lists.len(), 2);
    for (name, page) in lists.iter().copied().chain([(&"index.html".to_owned(), index)]) {
        assert!(page.len() < 1_000_000, "{name} has {} bytes", page.len());
        assert!(name == "index.html" || index.contains(&format!("href=\"{name}\"")), "no link to {name}");
    }
    for number in 0..1100 {
        let page = format!("students/student-{number:04}.html");
        let links = lists.iter().filter(|(_, list)| list.contains(&format!("href=\"../{page}\""))).count();
        assert!(links == 1 && files.contains_key(&page), "{links} links to {page}");
    }
    Ok(())
}
