//! Exercises are made from solutions and contain no line of an answer.

use super::program_runs::root;
use grader::exercises::{Block, blocks, exercises, stub};

/// Whether `line` is `name: Type,` and no more: a parameter or a field.
fn is_parameter(line: &str) -> bool {
    let name = |text: &str| text.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
    line.strip_suffix(',')
        .and_then(|line| line.split_once(": "))
        .is_some_and(|(left, right)| name(left) && name(right))
}

/// The lines between the marks are answers. None of them may occur in an exercise.
#[test]
fn no_line_of_an_answer_is_in_an_exercise() {
    // Short lines, such as brackets, parameters, fields, attributes and marks are not answers.
    let is_answer = |line: &str| {
        line.len() > 12 && !is_parameter(line) && !line.starts_with("#[") && !line.starts_with("// <")
    };
    for exercise in exercises(&root()).expect("the kit is whole") {
        let solution = root().join("solutions/src").join(exercise.path.file_name().expect("a name"));
        let text = std::fs::read_to_string(&solution).expect("a solution");
        for block in blocks(&text, &solution).expect("pairs of marks") {
            let Block::Answer(answer, _) = block else { continue };
            for line in answer.into_iter().map(str::trim).filter(|line| is_answer(line)) {
                let left = exercise.stub.lines().any(|stub| stub.trim() == line);
                assert!(!left, "{}: {line}", exercise.path.display());
            }
        }
    }
}

#[test]
fn sync_is_the_same_every_time() {
    for exercise in exercises(&root()).expect("the kit is whole") {
        assert!(!exercise.stub.contains("<solution>") && !exercise.stub.contains("<stub>"));
        // A file without marks is its own stub, so generating twice changes nothing.
        let again = stub(&exercise.stub, &exercise.path).expect("no marks are left");
        assert_eq!(again, exercise.stub);
    }
}
