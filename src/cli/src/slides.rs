//! `raykata slides`: builds the decks of slides as web pages, or as PDF.
//!
//! The decks are Markdown for Marp, a program for Node.js. `slides/package.json` names its version, and npm installs it there.

use crate::args::{Argument, Given, Opt, Spec, did_you_mean};
use crate::html::escape;
use crate::kits::root;
use crate::report::{make_folder, write_file};
use crate::touch;
use anyhow::{Context, Error, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// `raykata slides`.
pub static SPEC: Spec = Spec {
    name: "raykata slides",
    about: "Build the slides as web pages, with speaker notes. Needs Node.js.",
    arguments: &[Argument::optional("DECK", "The decks to build, such as stage03 [default: all].").many()],
    options: &[&[
        Opt::flag("--pdf", "Also write PDF files. Needs Chromium, Chrome, Edge or Firefox."),
        Opt::value("--out", "FOLDER", "The folder for the pages [default: out/slides].").short("-o"),
    ]],
};

/// A deck: its name, the settings at its top, and its slides.
pub struct Deck {
    /// The name of its file, without the ending.
    pub name: String,
    /// The settings, by their keys, without quotation marks.
    pub head: BTreeMap<String, String>,
    /// The text of each slide, with its speaker note.
    pub slides: Vec<String>,
}

impl Deck {
    /// The stage that it teaches; 0 for the introduction.
    pub fn stage(&self) -> Option<u8> {
        self.head.get("stage")?.parse().ok()
    }

    /// The minutes that it takes.
    pub fn minutes(&self) -> Option<usize> {
        self.head.get("minutes")?.parse().ok()
    }

    /// The title; empty if it has none.
    pub fn title(&self) -> &str {
        self.head.get("title").map_or("", String::as_str)
    }

    /// The text of all slides.
    pub fn text(&self) -> String {
        self.slides.concat()
    }
}

/// Builds the decks, and prints where they are.
pub fn run(given: &Given) -> Result<ExitCode> {
    let (wanted, pdf) = (given.texts(0), given.has("--pdf"));
    // Find the decks.
    let slides = root()?.join("slides");
    let all = decks(&slides)?;
    let known: Vec<&str> = all.iter().map(|deck| deck.name.as_str()).collect();
    for name in &wanted {
        if !known.contains(&name.as_str()) {
            bail!("there is no deck `{name}` in {}{}", slides.display(), did_you_mean(name, &known));
        }
    }
    let is_wanted = |deck: &&Deck| wanted.is_empty() || wanted.contains(&deck.name);
    let chosen: Vec<&Deck> = all.iter().filter(is_wanted).collect();
    let marp = installed(&slides)?;

    // Copy decks and figures to one folder, because the pages name the figures by their place beside them.
    let out = given.path("--out").map_or_else(|| Ok::<_, Error>(root()?.join("out/slides")), Ok)?;
    make_folder(&out.join("figures"))?;
    for figure in fs::read_dir(slides.join("figures")).context("slides/figures cannot be read")? {
        let figure = figure?.path();
        if let Some(name) = figure.file_name() {
            copy(&figure, &out.join("figures").join(name))?;
        }
    }
    copy(&slides.join("raykata.css"), &out.join("raykata.css"))?;
    for deck in &chosen {
        let (from, to) = (slides.join(format!("{}.md", deck.name)), out.join(format!("{}.md", deck.name)));
        let text = fs::read_to_string(&from).with_context(|| format!("cannot read {}", from.display()))?;
        write_file(&to, without_names(&text).as_bytes())?;
    }
    // Build the pages.
    for is_pdf in [false, true].into_iter().take(1 + usize::from(pdf)) {
        let mut command = Command::new(&marp);
        command
            .current_dir(&out)
            .args(["--theme-set", "raykata.css", "--allow-local-files"])
            .stdin(Stdio::null());
        if is_pdf {
            command.args(["--pdf", "--pdf-notes"]);
        }
        let status = command.args(chosen.iter().map(|deck| format!("{}.md", deck.name))).status();
        let status = status.with_context(|| format!("{} cannot be started", marp.display()))?;
        if !status.success() {
            bail!("Marp could not build the slides: its messages are above");
        }
    }
    // Write the page of the figures that can be touched, link to it, and write an index of the decks.
    let names = touch::write_page(&root()?, &out)?;
    for deck in &chosen {
        let file = out.join(format!("{}.html", deck.name));
        let html = fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        write_file(&file, touch::with_links(html, &names).as_bytes())?;
    }
    let index = out.join("index.html");
    write_file(&index, page(&chosen, pdf, !names.is_empty()).as_bytes())?;
    println!("decks: {}, in {}", chosen.len(), index.display());
    Ok(ExitCode::SUCCESS)
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::copy(from, to).with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
    Ok(())
}

/// A deck without the comments that name its numbers for `author sync`, which Marp would take for speaker notes.
fn without_names(deck: &str) -> String {
    let mut parts = deck.split("<!--=");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once("-->").map_or(part, |(_, rest)| rest))
}

/// All decks in this folder, in the order of the course: the introduction, the stages, and the others.
pub fn decks(slides: &Path) -> Result<Vec<Deck>> {
    let mut found = Vec::new();
    for file in fs::read_dir(slides).with_context(|| format!("{} cannot be read", slides.display()))? {
        let file = file?.path();
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if file.extension().is_some_and(|ending| ending == "md") {
            let text =
                fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            found.extend(deck(name, &text));
        }
    }
    found.sort_by_key(|deck| (deck.stage().unwrap_or(u8::MAX), deck.name.clone()));
    Ok(found)
}

/// The deck with this text; `None` for a file that is no deck.
fn deck(name: String, text: &str) -> Option<Deck> {
    let (head, slides) = text.strip_prefix("---\nmarp: true\n")?.split_once("\n---\n")?;
    let pairs = head.lines().filter_map(|line| line.split_once(": "));
    let head = pairs.map(|(key, value)| (key.to_owned(), value.trim_matches('"').to_owned())).collect();
    Some(Deck { name, head, slides: slides.split("\n---\n").map(str::to_owned).collect() })
}

/// The program `marp`, which npm installs the first time.
fn installed(slides: &Path) -> Result<PathBuf> {
    let marp = slides.join("node_modules/.bin").join(if cfg!(windows) { "marp.cmd" } else { "marp" });
    if marp.is_file() {
        return Ok(marp);
    }
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    eprintln!("installing Marp into {} …", slides.join("node_modules").display());
    let status = match Command::new(npm).arg("ci").current_dir(slides).status() {
        Ok(status) => status,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => bail!(
            "the slides are built by Node.js, which is not installed: install Node.js 20 or newer \
             (https://nodejs.org), then run this command again. Without it, read the decks as text in slides/"
        ),
        Err(error) => return Err(error).context("npm cannot be started"),
    };
    if !status.success() {
        bail!("npm could not install Marp: its messages are above");
    }
    Ok(marp)
}

/// The page that links to all decks.
fn page(decks: &[&Deck], pdf: bool, touch: bool) -> String {
    let row = |deck: &&Deck| {
        let minutes = deck.minutes().map_or(String::new(), |minutes| format!("{minutes} min"));
        let pdf = if pdf { format!("<a href=\"{}.pdf\">PDF</a>", deck.name) } else { String::new() };
        format!(
            "<tr><td><a href=\"{}.html\">{}</a></td><td>{minutes}</td><td>{pdf}</td></tr>\n",
            deck.name,
            escape(deck.title())
        )
    };
    let touch = if touch { "<p><a href=\"touch.html\">Figures to touch</a></p>\n" } else { "" };
    format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>Slides</title>\n<style>:root{{color-scheme:light dark}}body{{font:18px/1.6 sans-serif;max-width:40em;margin:2em \
         auto;padding:0 1em}}td{{padding-right:2em}}</style>\n<h1>Slides</h1>\n<p>In a deck, the key P opens the window with the \
         speaker notes, F fills the screen.</p>\n<table>\n{}</table>\n{touch}</html>\n",
        decks.iter().map(row).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deck_says_what_it_is() {
        let text = "---\nmarp: true\ntitle: \"Stage 1: rays & shapes\"\nminutes: 60\n---\n\n# Rays\n";
        let deck = deck("stage01".into(), text).unwrap();
        assert_eq!((deck.title(), deck.minutes()), ("Stage 1: rays & shapes", Some(60)));
        assert!(
            page(&[&deck], true, false).contains("<a href=\"stage01.html\">Stage 1: rays &amp; shapes</a>")
        );
        assert!(super::deck("README".into(), "# Slides\n").is_none());
        assert_eq!(
            without_names("29<!--=checks 1--> checks\n\n<!-- a note -->\n"),
            "29 checks\n\n<!-- a note -->\n"
        );
    }

    #[test]
    fn the_introduction_comes_first_and_cost_after_the_stages() {
        let folder = tempfile::tempdir().unwrap();
        for (name, stage) in
            [("stage10", "stage: 10"), ("cost", ""), ("stage02", "stage: 2"), ("introduction", "stage: 0")]
        {
            let text = format!("---\nmarp: true\ntitle: x\n{stage}\n---\n");
            fs::write(folder.path().join(format!("{name}.md")), text).unwrap();
        }
        fs::write(folder.path().join("plan.md"), "# Plan\n").unwrap();
        let names: Vec<String> = decks(folder.path()).unwrap().into_iter().map(|deck| deck.name).collect();
        assert_eq!(names, ["introduction", "stage02", "stage10", "cost"]);
    }
}
