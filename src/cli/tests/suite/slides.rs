//! Every slide with a figure names the command that makes it, and every command on a slide exists.

use std::fs;
use std::path::Path;
use std::process::Command;

/// All slides: the file and number of each, and its text.
fn slides(root: &Path) -> Vec<(String, String)> {
    let mut slides = Vec::new();
    for file in fs::read_dir(root.join("slides")).unwrap().map(|file| file.unwrap().path()) {
        if file.extension().is_none_or(|ending| ending != "md") {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        // Other files in the folder are for readers: `curriculum.rs` tests one.
        if !text.starts_with("---\nmarp: true") {
            continue;
        }
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let numbered = text.split("\n---\n").enumerate();
        slides.extend(numbered.map(|(number, slide)| (format!("{name}, slide {number}"), slide.to_owned())));
    }
    slides
}

/// The commands in backticks.
fn commands(slide: &str) -> Vec<&str> {
    slide.split('`').skip(1).step_by(2).filter(|code| code.starts_with("cargo run")).collect()
}

/// The files of the pictures.
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
        // A 16:9 page at the usual font size has room for 18 lines.
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
            // `--help` prints the help in place of the work, after all words before it were understood.
            let output = asked.args(words).arg("--help").current_dir(&root).output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{place}: {command}: {said}");
            for scene in words.iter().filter(|word| word.starts_with("scenes/")) {
                assert!(root.join(scene).is_file(), "{place}: there is no {scene}");
            }
        }
    }
}
