//! No slide is fuller than its page. Node.js and Marp build the pages and a browser measures them, so this runs only with
//! `CI_LONG=1`.

use super::deck::{Deck, decks, root, runs_marp};
use browser::Browser;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// A line per slide that overflows. `None` if this is not to run, or if a program is missing; the output says which.
fn overflowing(decks: &[PathBuf]) -> Option<Vec<String>> {
    if !runs_marp() {
        return None;
    }
    let slides = root().join("slides");
    let mut browser = Browser::start().expect("the browser starts")?;
    browser.window(1280, 720, false).expect("the browser answers");
    // Build the pages in a folder that also has the figures.
    let folder = tempfile::tempdir().expect("a folder");
    let figures = folder.path().join("figures");
    fs::create_dir(&figures).expect("a folder");
    for file in fs::read_dir(slides.join("figures")).expect("figures").flatten() {
        fs::copy(file.path(), figures.join(file.file_name())).expect("a figure");
    }
    let mut lines = Vec::new();
    for deck in decks {
        let name = deck.file_stem().expect("a name").to_string_lossy();
        let page = folder.path().join(format!("{name}.html"));
        let mut node = Command::new("node");
        node.arg(slides.join("node_modules/@marp-team/marp-cli/marp-cli.js"));
        node.args(["--no-stdin", "--template", "bare", "--theme-set"]).arg(slides.join("raykata.css"));
        // Without an option between them, Marp would take the deck for another theme.
        node.arg("--html").arg(deck).arg("-o").arg(&page);
        let built = node.output().expect("node starts, because npm has installed Marp");
        assert!(built.status.success(), "{name}: {}", String::from_utf8_lossy(&built.stderr));
        browser.open(&format!("file://{}", page.display())).expect("a page");
        let found = browser.evaluate(include_str!("../overflow.js")).expect("measures");
        let found = found.as_array().expect("a list").iter().filter_map(|line| line.as_str());
        lines.extend(found.map(|line| format!("{name}, {line}")));
    }
    Some(lines)
}

#[test]
fn every_slide_fits_its_page() {
    let file = |deck: &Deck| root().join("slides").join(format!("{}.md", deck.name));
    let decks: Vec<PathBuf> = decks().iter().map(file).collect();
    assert!(decks.len() > 10, "{decks:?}");
    if let Some(lines) = overflowing(&decks) {
        assert!(lines.is_empty(), "{}", lines.join("\n"));
    }
}

#[test]
fn a_slide_that_is_too_long_is_found() {
    let lines: String = (1..=25).map(|line| format!("- line {line}\n")).collect();
    let head = "---\nmarp: true\ntheme: raykata\nmath: mathjax\n---\n";
    let deck = format!("{head}\n# Fits\n\ntext\n\n---\n\n## Too long\n\n{lines}");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("long.md");
    fs::write(&file, deck).expect("the temporary folder can be written");
    if let Some(lines) = overflowing(&[file]) {
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(lines[0].starts_with("long, slide 2 (Too long): ends at"), "{lines:?}");
    }
}
