//! The decks are whole: every slide has a heading and a note, every row of the lectures and every slide that a check refers to has
//! its place, figures exist, and signatures are those of the exercises.

use super::deck::{Deck, decks, root};
use std::collections::BTreeSet;
use std::fs;

/// The heading of a slide; empty if it has none.
fn title(slide: &str) -> &str {
    let heading = slide.lines().find_map(|line| line.strip_prefix("## ").or_else(|| line.strip_prefix("# ")));
    heading.unwrap_or_default()
}

/// The speaker note: the last comment.
fn note(slide: &str) -> Option<&str> {
    slide.trim_end().strip_suffix("-->")?.rsplit_once("<!--").map(|(_, note)| note.trim())
}

/// The texts between each pair of `before` and `after`.
fn between<'a>(text: &'a str, before: &str, after: &str) -> Vec<&'a str> {
    text.split(before).skip(1).filter_map(|rest| rest.split(after).next()).collect()
}

/// The formulas within the lines of a slide, as the program that builds the decks divides them, without code and notes.
fn formulas(slide: &str) -> Vec<&str> {
    let text = slide.rsplit_once("<!--").map_or(slide, |(text, _)| text);
    let prose = text.split("```").step_by(2).flat_map(str::lines);
    prose
        .flat_map(|line| line.split('`').step_by(2).filter(|part| !part.contains("$$")))
        .flat_map(|part| part.split('$').skip(1).step_by(2))
        .collect()
}

/// A formula that begins or ends with a space is shown as its source.
#[test]
fn formulas_begin_and_end_without_spaces() {
    assert_eq!(formulas("$a = $ b\n```\n$x\n```\n`$` $c$\n<!-- $ d -->"), ["a = ", "c"]);
    let decks = decks();
    let slides = decks.iter().flat_map(|deck| deck.slides.iter().map(move |slide| (&deck.name, slide)));
    let formulas: Vec<_> = slides
        .flat_map(|(name, slide)| formulas(slide).into_iter().map(move |formula| (name, formula)))
        .collect();
    assert!(formulas.len() > 300, "{} formulas", formulas.len());
    let shown_as_source: Vec<_> = formulas.iter().filter(|(_, formula)| formula.trim() != *formula).collect();
    assert!(shown_as_source.is_empty(), "{shown_as_source:?}");
}

#[test]
fn every_deck_says_what_it_needs() {
    let decks = decks();
    let names: BTreeSet<&str> = decks.iter().map(|deck| deck.name.as_str()).collect();
    for Deck { name, head, .. } in &decks {
        let value = |key: &str| head.get(key).unwrap_or_else(|| panic!("{name} has no `{key}`")).as_str();
        assert_eq!(
            [value("theme"), value("math"), value("paginate")],
            ["raykata", "mathjax", "true"],
            "{name}"
        );
        let minutes: u32 = value("minutes").parse().unwrap();
        assert!((5..=180).contains(&minutes), "{name}: {minutes} minutes");
        let needed = value("prerequisites").trim_start_matches('[').trim_end_matches(']');
        for one in needed.split(", ").filter(|one| !one.is_empty()) {
            assert!(names.contains(one), "{name} needs {one}, which is no deck");
        }
    }
    let stages: Vec<u8> = decks.iter().filter_map(Deck::stage).collect();
    assert_eq!(
        stages,
        (0..stages.len() as u8).collect::<Vec<_>>(),
        "the introduction, and one deck per stage"
    );
}

#[test]
fn every_slide_has_a_heading_and_a_note() {
    for Deck { name, slides, .. } in &decks() {
        let mut headings = BTreeSet::new();
        for (slide, number) in slides.iter().zip(1..) {
            let heading = title(slide);
            assert!(!heading.is_empty(), "{name}, slide {number}: no heading");
            assert!(headings.insert(heading), "{name}: two slides are called {heading}");
            let note = note(slide).unwrap_or_else(|| panic!("{name}, {heading}: no speaker note"));
            assert!(note.len() > 40, "{name}, {heading}: {note}");
        }
    }
}

#[test]
fn a_deck_explains_on_twenty_to_forty_slides() {
    for deck in &decks() {
        // Questions to the class, the lab card, the appendix and the steps of a figure come on top.
        let extra = ["Predict: ", "Lab card: ", "Appendix: "];
        let is_extra = |slide: &str| extra.iter().any(|start| title(slide).starts_with(start));
        let explains = |slide: &&String| !is_extra(slide) && !slide.contains(".svg#step");
        let n = deck.slides.iter().filter(explains).count();
        assert!((20..=40).contains(&n), "{} explains on {n} slides", deck.name);
    }
}

/// The minutes that the speaker note states, as in `3 min.` or `1 minute.`
fn minutes(slide: &str) -> Option<usize> {
    let words: Vec<&str> = note(slide)?.split_whitespace().collect();
    let stated = words.windows(2).filter(|pair| ["min.", "minute.", "minutes."].contains(&pair[1]));
    let mut stated = stated.filter_map(|pair| pair[0].parse().ok());
    let first = stated.next();
    assert_eq!(stated.next(), None, "{}: the note states the minutes twice", title(slide));
    first
}

#[test]
fn the_minutes_of_a_deck_are_the_sum_of_its_notes() {
    for deck in decks() {
        let mut sum = 0;
        for slide in &deck.slides {
            let is_appendix = title(slide).starts_with("Appendix: ");
            let its_minutes = minutes(slide);
            assert_eq!(its_minutes.is_none(), is_appendix, "{}, {}: minutes", deck.name, title(slide));
            sum += its_minutes.unwrap_or_default();
            // A deck of two lectures states the minutes of each in the last column of a table.
            if title(slide) == "The first lecture ends here" {
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
    for deck in decks() {
        let asks = |slide: &&String| title(slide).starts_with("Predict: ");
        let n = deck.slides.iter().filter(asks).count();
        let least = deck.minutes().unwrap() / 15;
        assert!(n >= least, "{}: {n} predictions in {} minutes", deck.name, deck.minutes().unwrap());
        // The answer is on the next slide.
        for pair in deck.slides.windows(2).filter(|pair| asks(&&pair[0])) {
            assert!(!asks(&&pair[1]), "{}: no answer to {}", deck.name, title(&pair[0]));
        }
        assert!(!deck.slides.last().is_some_and(|slide| asks(&slide)), "{}: no answer", deck.name);
    }
}

#[test]
fn a_deck_has_a_lab_card() {
    for deck in decks() {
        let cards = deck.slides.iter().filter(|slide| title(slide).starts_with("Lab card: "));
        let [card] = cards.collect::<Vec<_>>()[..] else { panic!("{} needs one lab card", deck.name) };
        for step in ["**Run**", "**Note**", "**Change**", "**Predict**", "**run again**"] {
            assert!(card.contains(step), "{}: the lab card lacks {step}", deck.name);
        }
        assert!(card.contains("\ncargo run"), "{}: a lab card without a command", deck.name);
    }
}

#[test]
fn a_title_states_the_pitfall() {
    for slide in decks().iter().flat_map(|deck| &deck.slides) {
        assert!(!title(slide).starts_with("Pitfall"), "the title must be a claim: {}", title(slide));
    }
}

#[test]
fn two_of_five_slides_have_a_figure() {
    let has_figure = |slide: &&String| slide.contains("](figures/");
    let [mut n_slides, mut n_figures] = [0; 2];
    for deck in decks() {
        let n = deck.slides.iter().filter(has_figure).count();
        assert!(4 * n >= deck.slides.len(), "{}: {n} figures on {} slides", deck.name, deck.slides.len());
        n_slides += deck.slides.len();
        n_figures += n;
    }
    assert!(5 * n_figures >= 2 * n_slides, "{n_figures} figures on {n_slides} slides");
}

#[test]
fn every_row_of_the_lectures_stands_on_a_slide() {
    let decks = decks();
    let notes: Vec<&str> =
        decks.iter().flat_map(|deck| &deck.slides).filter_map(|slide| note(slide)).collect();
    let rows = [('R', 10), ('X', 15), ('M', 8), ('C', 12)];
    let missing: Vec<String> = rows
        .iter()
        .flat_map(|&(part, n)| (1..=n).map(move |row| format!("{part}{row}")))
        .filter(|row| !notes.iter().any(|note| names_row(note, row)))
        .collect();
    assert_eq!(missing, Vec::<String>::new());
}

/// Whether a note begins with `row R5` or `rows R5, R6`.
fn names_row(note: &str, row: &str) -> bool {
    let Some(rest) = note.strip_prefix("rows ").or_else(|| note.strip_prefix("row ")) else { return false };
    let list = rest.split('.').next().unwrap_or_default();
    list.split([',', ' ']).any(|one| one == row)
}

/// The rubric names the slide of the lecture, and a speaker note refers to it, so that messages name a page of the kit's own deck.
#[test]
fn every_check_is_taught_on_a_page_of_the_deck_of_its_stage() {
    let decks = decks();
    let page = |stage: u8, slide: &str| {
        let number = slide.strip_prefix(&format!("{}, page ", checks::rubric::deck(stage)))?;
        let (number, heading) = number.split_once(": ")?;
        let deck = decks.iter().find(|deck| deck.stage() == Some(stage))?;
        let page = deck.slides.get(number.parse::<usize>().ok()?.checked_sub(1)?)?;
        (title(page) == heading && number != "1").then_some(())
    };
    let all =
        all_checks::STAGES.iter().flat_map(|(stage, list)| list.iter().map(move |check| (*stage, check)));
    let of_check =
        |(stage, check): (u8, &checks::Check)| (stage, checks::rubric::entry(stage, check.name).taught());
    let missing: BTreeSet<_> =
        all.map(of_check).filter(|(stage, slide)| page(*stage, slide).is_none()).collect();
    assert_eq!(missing, BTreeSet::new());
}

#[test]
fn exercises_name_the_deck_of_their_stage() {
    for file in fs::read_dir(root().join("exercises/src")).unwrap().map(|file| file.unwrap().path()) {
        let stage = file
            .file_name()
            .and_then(|name| name.to_str()?.strip_prefix("stage")?.split('_').next()?.parse().ok());
        let text = fs::read_to_string(&file).unwrap();
        for named in between(&text, "//! Slides: ", "\n") {
            let deck = format!("`{}`", checks::rubric::deck(stage.unwrap()));
            assert!(named.starts_with(&deck), "{}: {named}", file.display());
        }
    }
}

#[test]
fn signatures_are_those_of_the_exercises() {
    let without_spaces = |text: &str| text.split_whitespace().collect::<String>().replace(",)", ")");
    let mut exercises = String::new();
    for file in fs::read_dir(root().join("exercises/src")).unwrap() {
        exercises += &without_spaces(&fs::read_to_string(file.unwrap().path()).unwrap());
    }
    for deck in &decks() {
        for signature in between(&deck.text(), "```rust signature\n", "\n```") {
            for one in signature.split("\n\n") {
                assert!(
                    exercises.contains(&without_spaces(one)),
                    "{}: no exercise has this signature:\n{one}",
                    deck.name
                );
            }
        }
    }
}

#[test]
fn every_figure_is_listed_and_used() {
    let list = fs::read_to_string(root().join("slides/figures.toml")).unwrap();
    let listed: BTreeSet<&str> = between(&list, "\nfile = \"", "\"").into_iter().collect();
    let mut used = BTreeSet::new();
    for deck in &decks() {
        let text = deck.text();
        for address in between(&text, "](figures/", ")") {
            let (picture, step) = address.split_once('#').unwrap_or((address, ""));
            assert!(listed.contains(picture), "{}: slides/figures.toml does not list {picture}", deck.name);
            used.insert(picture.to_owned());
            // A page that shows a step of a figure names one that the file has.
            let file = fs::read(root().join("slides/figures").join(picture))
                .unwrap_or_else(|error| panic!("{}: {picture}: {error}", deck.name));
            let has_step = String::from_utf8_lossy(&file).contains(&format!("id=\"{step}\""));
            assert!(step.is_empty() || has_step, "{}: {picture} has no {step}", deck.name);
        }
        // Whoever cannot see a figure reads what it shows.
        for words in between(&text, "![", "](figures/") {
            assert!(words.len() > 20, "{}: a figure without a description: {words}", deck.name);
        }
    }
    let unused: Vec<&str> = listed.into_iter().filter(|file| !used.contains(*file)).collect();
    assert_eq!(unused, Vec::<&str>::new());
}

#[test]
fn letters_of_diagrams_have_eighteen_pixels_or_more() {
    let number = |text: &str| -> f64 { text.parse().unwrap_or_else(|_| panic!("a number: {text}")) };
    let mut n_figures = 0;
    for deck in &decks() {
        for figure in deck.text().split("![").skip(1) {
            let Some((words, rest)) = figure.split_once("](figures/") else { continue };
            let file = rest.split([')', '#']).next().unwrap_or_default();
            if !file.ends_with(".svg") {
                continue;
            }
            let svg = fs::read_to_string(root().join("slides/figures").join(file)).unwrap();
            let view: Vec<f64> = between(&svg, "viewBox=\"0 0 ", "\"")[0].split(' ').map(number).collect();
            let sizes = between(&svg, "font-size=\"", "\"").into_iter().map(number);
            // The description ends with the width or the height on the slide, in pixels of 1280 by 720.
            let (side, size) = words.rsplit_once(", ").and_then(|(_, size)| size.split_once(':')).unwrap();
            let scale = number(size) / if side == "w" { view[0] } else { view[1] };
            let pixels = scale * sizes.fold(f64::INFINITY, f64::min);
            assert!(pixels >= 18.0, "{}, {file}: letters of {pixels:.1} pixels", deck.name);
            n_figures += 1;
        }
    }
    assert!(n_figures > 50, "{n_figures} figures");
}

/// The quoted outputs of the decks and of the README: the name of the file, the source, and the text.
fn quotes() -> Vec<(String, String, String)> {
    let mut quotes = Vec::new();
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let texts = decks().into_iter().map(|deck| (deck.text(), deck.name));
    for (text, name) in texts.chain([(readme, "README.md".to_owned())]) {
        for rest in text.split("<!-- from: ").skip(1) {
            let (source, rest) = rest.split_once(" -->\n").unwrap_or_else(|| panic!("{name}: {rest}"));
            // A table is quoted from a command; only blocks of text are compared.
            if let Some((text, _)) = rest.strip_prefix("```text\n").and_then(|rest| rest.split_once("\n```"))
            {
                quotes.push((name.clone(), source.to_owned(), text.to_owned()));
            }
        }
    }
    quotes
}

/// The first line of a quote that the source does not have, where spaces do not count, `…` leaves out anything, and the lines
/// have the order of the source.
fn missing_line<'a>(quote: &'a str, source: &str) -> Option<&'a str> {
    let squeezed = |text: &str| text.split_whitespace().collect::<String>();
    let source = squeezed(source);
    let mut from = 0;
    for line in quote.lines() {
        for part in squeezed(line).split('…').filter(|part| !part.is_empty()) {
            match source[from..].find(part) {
                Some(at) => from += at + part.len(),
                None => return Some(line),
            }
        }
    }
    None
}

#[test]
fn quoted_messages_are_those_of_the_kit() {
    let quotes = quotes();
    assert!(quotes.len() > 20);
    // The lines that messages take from the rubric.
    let mut rubric = String::new();
    for (stage, entries) in raykata::rubric::stages() {
        for (name, entry) in entries.in_order() {
            rubric += &entry.header();
            rubric += &format!(
                "  again: cargo test --test stage{stage} {name}\n  print: cargo run -- try {name}\n  stuck: cargo run -- hint {name}\n"
            );
        }
    }
    for (deck, source, quote) in quotes.iter().filter(|(_, source, _)| source.starts_with("tests/")) {
        // The message about a mistake of the corpus is named by its file and the mistake.
        let (file, mistake) =
            source.split_once(' ').map_or((source.as_str(), None), |(file, name)| (file, Some(name)));
        let text =
            fs::read_to_string(root().join(file)).unwrap_or_else(|_| panic!("{deck}: there is no {file}"));
        let text = match mistake {
            None => text,
            Some(name) => {
                let message = format!("\n{text}")
                    .split("\n=== ")
                    .find_map(|part| part.strip_prefix(name)?.strip_prefix(" ===\n").map(str::to_owned));
                message.unwrap_or_else(|| panic!("{deck}: {file} has no message about {name}"))
            }
        };
        // The lines that every message takes from the rubric are not stored.
        let (of_rubric, quote): (Vec<&str>, Vec<&str>) = quote.lines().partition(|line| {
            ["stage ", "  slides: ", "  again: ", "  print: ", "  stuck: "]
                .iter()
                .any(|start| line.starts_with(start))
        });
        assert_eq!(missing_line(&quote.join("\n"), &text), None, "{deck}: {source} has no such line");
        let missing = of_rubric.into_iter().find(|line| !rubric.lines().any(|other| other == *line));
        assert_eq!(missing, None, "{deck}: no message has such a line");
    }
}

#[test]
fn only_the_readme_says_how_long_the_first_build_takes() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let texts =
        decks().into_iter().map(|deck| (deck.text(), deck.name)).chain([(readme, "README.md".to_owned())]);
    let about =
        |text: &str| text.matches("irst build takes ").count() + text.matches("irst build is").count();
    let found: Vec<_> =
        texts.filter(|(text, _)| about(text) > 0).map(|(text, name)| (name, about(&text))).collect();
    assert_eq!(found, [("README.md".to_owned(), 1)]);
}
