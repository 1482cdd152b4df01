//! Every measured table on a slide names the command that makes it, every command exists, no slide is too long, and every deck asks
//! before it answers.

use super::program_runs::root;
use raykata_cli::slides::{Deck, decks};
use std::process::Command;

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
            let mut asked = Command::new(env!("CARGO_BIN_EXE_raykata"));
            // `--help` prints the help in place of the work, after all words before it were understood.
            let output = asked.args(words).arg("--help").current_dir(root()).output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{place}: {command}: {said}");
            for scene in words.iter().filter(|word| word.starts_with("scenes/")) {
                assert!(root().join(scene).is_file(), "{place}: there is no {scene}");
            }
        }
    }
}

/// The title of a slide.
fn heading(slide: &str) -> &str {
    slide.lines().find_map(|line| line.trim_start_matches('#').strip_prefix(' ')).unwrap_or_default()
}

/// The minutes that the speaker note states, as in `3 min.` or `1 minute.`
fn minutes(slide: &str) -> Option<usize> {
    let (_, note) = slide.rsplit_once("<!--")?;
    let words: Vec<&str> = note.split_whitespace().collect();
    let stated = words.windows(2).filter(|pair| ["min.", "minute.", "minutes."].contains(&pair[1]));
    let mut stated = stated.filter_map(|pair| pair[0].parse().ok());
    let first = stated.next();
    assert_eq!(stated.next(), None, "{}: the note states the minutes twice", heading(slide));
    first
}

#[test]
fn the_minutes_of_a_deck_are_the_sum_of_its_notes() {
    for deck in decks(&root().join("slides")).unwrap() {
        let mut sum = 0;
        for slide in &deck.slides {
            let is_appendix = heading(slide).starts_with("Appendix: ");
            let its_minutes = minutes(slide);
            assert_eq!(its_minutes.is_none(), is_appendix, "{}, {}: minutes", deck.name, heading(slide));
            sum += its_minutes.unwrap_or_default();
            // A deck of two lectures states the minutes of each in the last column of a table.
            if heading(slide) == "The first lecture ends here" {
                let cells = |lecture: &str| {
                    let row = slide.lines().find(|line| line.starts_with(&format!("| {lecture} |")));
                    row.and_then(|row| row.trim_end_matches(" |").rsplit("| ").next()?.parse().ok())
                };
                let rest = deck.minutes().unwrap() - sum;
                assert_eq!((cells("1"), cells("2")), (Some(sum), Some(rest)), "{}: two lectures", deck.name);
            }
        }
        assert_eq!(deck.minutes(), Some(sum), "{}: the minutes of the notes", deck.name);
    }
}

#[test]
fn a_deck_asks_for_a_prediction_every_fifteen_minutes() {
    for deck in decks(&root().join("slides")).unwrap() {
        let asks = |slide: &&String| heading(slide).starts_with("Predict: ");
        let n = deck.slides.iter().filter(asks).count();
        let least = deck.minutes().unwrap() / 15;
        assert!(n >= least, "{}: {n} predictions in {} minutes", deck.name, deck.minutes().unwrap());
        // The answer is on the next slide.
        for pair in deck.slides.windows(2).filter(|pair| asks(&&pair[0])) {
            assert!(!asks(&&pair[1]), "{}: no answer to {}", deck.name, heading(&pair[0]));
        }
        assert!(!deck.slides.last().is_some_and(|slide| asks(&slide)), "{}: no answer", deck.name);
    }
}

#[test]
fn a_deck_has_a_lab_card() {
    for deck in decks(&root().join("slides")).unwrap() {
        let cards = deck.slides.iter().filter(|slide| heading(slide).starts_with("Lab card: "));
        let [card] = cards.collect::<Vec<_>>()[..] else { panic!("{} needs one lab card", deck.name) };
        for step in ["**Run**", "**Note**", "**Change**", "**Predict**", "**run again**"] {
            assert!(card.contains(step), "{}: the lab card lacks {step}", deck.name);
        }
        assert!(!commands(card).is_empty(), "{}: a lab card without a command", deck.name);
    }
}

#[test]
fn a_title_states_the_pitfall() {
    for (place, slide) in slides() {
        let title = heading(&slide);
        assert!(!title.starts_with("Pitfall"), "{place}: the title must be a claim: {title}");
    }
}

#[test]
fn two_of_five_slides_have_a_figure() {
    let has_figure = |slide: &&String| slide.contains("](figures/");
    let [mut n_slides, mut n_figures] = [0; 2];
    for deck in decks(&root().join("slides")).unwrap() {
        let n = deck.slides.iter().filter(has_figure).count();
        assert!(4 * n >= deck.slides.len(), "{}: {n} figures on {} slides", deck.name, deck.slides.len());
        n_slides += deck.slides.len();
        n_figures += n;
    }
    assert!(5 * n_figures >= 2 * n_slides, "{n_figures} figures on {n_slides} slides");
}
