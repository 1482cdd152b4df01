//! The built decks work offline and are whole. Node.js, Marp and a browser build them, so this runs only with `CI_LONG=1`.

use super::deck::{Deck, decks, root, runs_marp};
use flate2::read::ZlibDecoder;
use std::fs;
use std::io::Read;
use std::process::Command;

/// The number of pages of a PDF file. Pages may stand in compressed streams.
fn n_pages(pdf: &[u8]) -> usize {
    let mut text = String::from_utf8_lossy(pdf).into_owned();
    let mut rest = pdf;
    while let Some(at) = rest.windows(6).position(|six| six == b"stream") {
        rest = &rest[at + 6..];
        let start = rest.iter().position(|&byte| byte != b'\r' && byte != b'\n').unwrap_or(rest.len());
        let mut inflated = Vec::new();
        // The decoder ends where the stream ends. What follows `endstream` is no stream and fails.
        if ZlibDecoder::new(&rest[start..]).read_to_end(&mut inflated).is_ok() {
            text += &String::from_utf8_lossy(&inflated);
        }
    }
    let squeezed: String = text.split_whitespace().collect();
    squeezed.matches("/Type/Page").count() - squeezed.matches("/Type/Pages").count()
}

/// What a page loads from elsewhere: each value of `src` or `href` and each `url(…)` that begins with a network address. Links that
/// a reader may follow are allowed.
fn loaded_from_the_network(html: &str) -> Vec<&str> {
    let values = [
        "src=\"",
        "src='",
        "url(",
        "url(\"",
        "@import \"",
        "<link href=\"",
        "<link rel=\"stylesheet\" href=\"",
    ];
    let after = |before: &'static str| html.split(before).skip(1);
    let found = values.into_iter().flat_map(after);
    found
        .filter(|rest| ["http:", "https:", "//"].iter().any(|start| rest.starts_with(start)))
        .map(|rest| &rest[..rest.len().min(60)])
        .collect()
}

#[test]
fn network_references_are_found() {
    assert_eq!(loaded_from_the_network("<img src=\"figures/a.png\"><a href=\"https://b\">").len(), 0);
    assert_eq!(loaded_from_the_network("<img src=\"https://a/b.png\"> url(//c/font)").len(), 2);
}

#[test]
fn decks_are_built_whole_and_without_the_network() {
    if !runs_marp() {
        return;
    }
    if browser::path().is_none() {
        return eprintln!("SKIPPED: there is no browser, which makes the PDF files");
    }
    let out = std::env::temp_dir().join(format!("raykata-built-slides-{}", std::process::id()));
    let built = Command::new(env!("CARGO"))
        .current_dir(root())
        .args(["run", "--quiet", "--", "slides", "--pdf", "--out"])
        .arg(&out)
        .output()
        .expect("cargo starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let decks = decks();
    for Deck { name, slides, .. } in &decks {
        let html = fs::read_to_string(out.join(format!("{name}.html"))).unwrap();
        assert_eq!(loaded_from_the_network(&html), Vec::<&str>::new(), "{name}");
        let pdf = fs::read(out.join(format!("{name}.pdf"))).unwrap();
        assert_eq!(n_pages(&pdf), slides.len(), "{name}: pages of the PDF and slides");
    }
    assert!(decks.len() > 10, "{} decks", decks.len());
    fs::remove_dir_all(out).unwrap();
}
