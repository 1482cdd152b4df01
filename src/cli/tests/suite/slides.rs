//! Slides cite nothing that nobody can make again: who shows a figure says the command, and the command is one.

use std::fs;
use std::path::Path;
use std::process::Command;

/// A slide: where it is, and its text.
fn slides(root: &Path) -> Vec<(String, String)> {
    let mut slides = Vec::new();
    for file in fs::read_dir(root.join("slides")).unwrap().map(|file| file.unwrap().path()) {
        if file.extension().is_none_or(|ending| ending != "md") {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let numbered = text.split("\n---\n").enumerate();
        slides.extend(numbered.map(|(number, slide)| (format!("{name}, slide {number}"), slide.to_owned())));
    }
    slides
}

/// Commands in backticks.
fn commands(slide: &str) -> Vec<&str> {
    slide.split('`').skip(1).step_by(2).filter(|code| code.starts_with("cargo run")).collect()
}

/// Files of pictures.
fn pictures(slide: &str) -> Vec<&str> {
    slide.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

fn has_figures(slide: &str) -> bool {
    let rows = slide.lines().filter(|line| line.starts_with('|'));
    !pictures(slide).is_empty() || rows.into_iter().any(|row| row.chars().any(|c| c.is_ascii_digit()))
}

#[test]
fn whoever_shows_a_figure_says_how_to_make_it() {
    let root = raykata_cli::kits::root().unwrap();
    let slides = slides(&root);
    assert!(slides.len() > 5 && slides.iter().filter(|(_, slide)| has_figures(slide)).count() > 3);
    for (place, slide) in &slides {
        assert!(
            !has_figures(slide) || !commands(slide).is_empty(),
            "{place} shows figures and names no command"
        );
        for picture in pictures(slide) {
            assert!(root.join("slides").join(picture).is_file(), "{place}: there is no {picture}");
        }
        // A page of 16 : 9 at the size at which such decks are shown.
        let lines = slide.lines().filter(|line| !line.trim().is_empty()).count();
        assert!(lines <= 18, "{place}: {lines} lines do not fit");
    }
}

#[test]
fn commands_are_understood() {
    let root = raykata_cli::kits::root().unwrap();
    for (place, slide) in slides(&root) {
        for command in commands(&slide) {
            let words: Vec<&str> = command.split_whitespace().collect();
            // The grader takes `cost` with the same options.
            let words = match words[..] {
                ["cargo", "run", "--release", "--", ..] => &words[4..],
                ["cargo", "run", "--release", "-p", "grader", "--", "cost", ..] => &words[6..],
                _ => panic!("{place}: {command}"),
            };
            let mut asked = Command::new(env!("CARGO_BIN_EXE_raykata"));
            // Help comes in place of the work, once everything before it was understood.
            let output = asked.args(words).arg("--help").current_dir(&root).output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{place}: {command}: {said}");
            for scene in words.iter().filter(|word| word.starts_with("scenes/")) {
                assert!(root.join(scene).is_file(), "{place}: there is no {scene}");
            }
        }
    }
}
