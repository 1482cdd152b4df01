//! Every measured table on a slide names the command that makes it, every command exists, and no slide is too long.

use super::program_runs::{is_understood, root};
use raykata_cli::slides::{Deck, decks};

/// All slides: the deck and number of each, and its text.
fn slides() -> Vec<(String, String)> {
    let place = |name: &str, number| format!("{name}.md, slide {number}");
    let decks = decks(&root().join("slides")).unwrap().into_iter();
    let of_deck =
        |deck: Deck| (1..).zip(deck.slides).map(move |(number, slide)| (place(&deck.name, number), slide));
    decks.flat_map(of_deck).collect()
}

/// The commands in backticks and in blocks of commands.
fn commands(slide: &str) -> Vec<&str> {
    let inline = slide
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|code| code.starts_with("cargo run") && !code.contains('…'));
    let blocks = slide.split("```sh\n").skip(1).filter_map(|rest| rest.split("\n```").next());
    inline.chain(blocks.flat_map(str::lines).filter(|line| line.starts_with("cargo run"))).collect()
}

/// Whether a table holds numbers.
fn has_numbers(slide: &str) -> bool {
    let rows = slide.lines().filter(|line| line.starts_with('|'));
    rows.into_iter().any(|row| row.chars().any(|c| c.is_ascii_digit()))
}

#[test]
fn measured_tables_say_how_to_make_them() {
    let slides = slides();
    // Most tables of other decks follow from a formula.
    let measured = |(place, slide): &&(String, String)| place.starts_with("cost.md") && has_numbers(slide);
    assert!(slides.iter().filter(measured).count() > 3);
    for (place, slide) in slides.iter().filter(measured) {
        assert!(!commands(slide).is_empty(), "{place} shows numbers and names no command");
    }
}

#[test]
fn slides_are_short_enough() {
    for (place, slide) in slides() {
        // A 16:9 page at the usual font size has room for 18 lines. The note and the settings at the top are not on it.
        let shown =
            slide.split("<!--").map(|part| part.rsplit("-->").next().unwrap_or_default()).collect::<String>();
        let lines = shown.lines().filter(|line| !line.trim().is_empty()).count();
        assert!(lines <= 18, "{place}: {lines} lines do not fit");
    }
}

#[test]
fn commands_are_understood() {
    for (place, slide) in slides() {
        for command in commands(&slide) {
            let words: Vec<&str> = command.split_whitespace().collect();
            let words = match words[..] {
                ["cargo", "run", "--release", "--", ..] => &words[4..],
                ["cargo", "run", "--", ..] => &words[3..],
                ["cargo", "run"] => continue,
                // `author` takes `cost` with the same options; other commands have tests of their own.
                ["cargo", "run", "--release", "-p", "author", "--", "cost", ..] => &words[6..],
                ["cargo", "run", "--release", "-p", "author" | "grader", "--", ..]
                | ["cargo", "run", "-p", "grader", "--", ..] => continue,
                _ => panic!("{place}: {command}"),
            };
            is_understood(&place, &words.join(" "));
        }
    }
}
