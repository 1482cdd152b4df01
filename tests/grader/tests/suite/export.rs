//! Tests the files for Gradescope and GitHub Classroom, and that grading one submission always writes a result.

use super::grade::{hand_in, right};
use super::program_runs::{printed, root};
use super::{grader, grader_succeeds};
use serde_json::Value;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Command;

fn written(arguments: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let out = out.to_string_lossy();
    grader_succeeds([arguments, &["--out", &out, "--stages", "1-4", "--seed", "77"]].concat());
    folder
}

fn parses(script: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("script");
    fs::write(&file, script).expect("written");
    let output = Command::new("sh").arg("-n").arg(&file).output().expect("sh");
    assert!(output.status.success(), "{}\n{script}", printed(&output).1);
}

fn json(file: &Path) -> Value {
    serde_json::from_slice(&fs::read(file).expect("results")).expect("JSON")
}

#[test]
fn gradescope_gets_the_kit_and_two_scripts_that_can_be_run() {
    let folder = written(&["export", "gradescope"]);
    let zip = fs::File::open(folder.path().join("out")).expect("a zip");
    let mut zip = zip::ZipArchive::new(zip).expect("a zip");
    for script in ["setup.sh", "run_autograder"] {
        let mut entry = zip.by_name(script).expect("a script");
        assert_eq!(entry.unix_mode().map(|mode| mode & 0o777), Some(0o755), "{script}");
        let mut text = String::new();
        entry.read_to_string(&mut text).expect("text");
        parses(&text);
        assert!(
            text.starts_with("#!/bin/sh\n") && text.contains("${AUTOGRADER_ROOT:-/autograder}"),
            "{script}"
        );
        assert!(script != "run_autograder" || text.contains("\n    --stages 1-4 --seed 77\n"), "{text}");
    }
    let names: Vec<&str> = zip.file_names().collect();
    for needed in [
        ".cargo/config.toml",
        "Cargo.lock",
        "solutions/src/lib.rs",
        "tests/checks/stage1/rubric.toml",
        "tests/golden/pictures.snap",
    ] {
        assert!(names.contains(&needed), "{needed}");
    }
    for unwanted in ["target/", "tests/corpus/", ".git/", "out/"] {
        assert!(!names.iter().any(|name| name.starts_with(unwanted)), "{unwanted}");
    }
}

#[test]
fn classroom_gets_workflows_whose_steps_are_scripts() {
    let folder = written(&["export", "classroom"]);
    for name in ["classroom.yml", "class.yml"] {
        let text =
            fs::read_to_string(folder.path().join("out/.github/workflows").join(name)).expect("a workflow");
        assert!(text.contains("--stages 1-4 --seed ") && !text.contains("{options}"), "{text}");
        // Students can read their own workflow, so the final grades have another seed.
        assert_eq!(text.split_whitespace().any(|word| word == "77"), name == "class.yml", "{text}");
        assert!(!text.contains('\t'));
        let mut scripts = 0;
        for step in text.split("run: |\n").skip(1) {
            let indent = step.len() - step.trim_start().len();
            let lines = step.lines().take_while(|line| line.starts_with(&" ".repeat(indent)));
            parses(&lines.map(|line| format!("{}\n", &line[indent..])).collect::<String>());
            scripts += 1;
        }
        assert!(scripts >= 1, "{name}");
    }
    // Each part of the class is graded by one job, and the merge takes the parts of all jobs.
    let most = folder.path().join("most");
    grader_succeeds(["export", "classroom", "--out", &most.to_string_lossy(), "--parts", "256"]);
    let text = fs::read_to_string(most.join(".github/workflows/class.yml")).expect("a workflow");
    let list = text.split_once("part: [").and_then(|(_, rest)| rest.split_once(']')).expect("a matrix").0;
    let parts: Vec<u16> = list.split(", ").map(|part| part.parse().expect("a number")).collect();
    assert_eq!(parts, (1..=256).collect::<Vec<u16>>());
    assert!(text.contains("--shard ${{ matrix.part }}/256 ") && !text.contains("{parts}"), "{text}");
    // The files exist, and the instructor may have edited them.
    let out = folder.path().join("out");
    let again = grader(["export", "classroom", "--out", &out.to_string_lossy()]);
    assert!(printed(&again).1.contains("already exists"), "{}", printed(&again).1);
}

/// Runs the bundle's entry point with another program in place of the grader.
fn entry_point(program: &str) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let release = folder.path().join("source/target/release");
    fs::create_dir_all(&release).expect("made");
    fs::create_dir(folder.path().join("submission")).expect("made");
    std::os::unix::fs::symlink(program, release.join("grader")).expect("linked");
    let script = root().join("tests/grader/src/export/run_autograder");
    let run = Command::new("sh").arg(script).env("AUTOGRADER_ROOT", folder.path()).output().expect("sh");
    assert!(run.status.success(), "{}", printed(&run).1);
    json(&folder.path().join("results/results.json"))
}

#[test]
fn gradescope_gets_an_answer_even_from_a_grader_that_dies() {
    for program in ["/bin/false", "/nowhere"] {
        let results = entry_point(program);
        assert_eq!(results["score"], 0);
        assert!(results["output"].as_str().is_some_and(|output| output.contains("tell your instructor")));
    }
}

#[test]
fn what_breaks_in_the_grader_is_an_answer_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let (gradescope, classroom) = (folder.path().join("g.json"), folder.path().join("c.json"));
    // There is no kit in this folder or above the program.
    let program = folder.path().join("grader");
    fs::copy(env!("CARGO_BIN_EXE_grader"), &program).expect("copied");
    let output = Command::new(&program)
        .current_dir(folder.path())
        .args(["grade-one", "nothing", "--stages", "1", "--seed", "5", "--gradescope"])
        .arg(&gradescope)
        .arg("--classroom")
        .arg(&classroom)
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(1));
    let results = json(&gradescope);
    assert_eq!(results["score"], 0);
    let said = results["output"].as_str().expect("text");
    assert!(said.contains("the grader failed, tell your instructor: "), "{said}");
    let result = json(&classroom);
    assert_eq!((&result["version"], &result["status"]), (&1.into(), &"error".into()));
    assert_eq!(result["tests"][0]["score"], 0);
}

#[test]
fn one_submission_is_graded_for_both() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    hand_in(folder.path(), "right", &right());
    for (submission, share) in [(at("right"), 1.0), ("exercises".to_owned(), 0.0)] {
        let results = format!("--gradescope {} --classroom {}", at("g.json"), at("c.json"));
        grader_succeeds(format!("grade-one {submission} --stages 1 --seed 5 {results}").split(' '));
        let (results, result) = (json(Path::new(&at("g.json"))), json(Path::new(&at("c.json"))));
        let sum = |tests: &Value, of: &str| -> f64 {
            tests.as_array().into_iter().flatten().filter_map(|test| test[of].as_f64()).sum()
        };
        let of = sum(&results["tests"], "max_score");
        assert!(of > 0.0);
        assert_eq!(sum(&results["tests"], "score"), share * of, "{results:#}");
        assert_eq!(result["max_score"].as_f64(), Some(of));
        assert_eq!(sum(&result["tests"], "score"), share * of);
    }
}
