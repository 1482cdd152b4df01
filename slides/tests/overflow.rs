//! No slide is fuller than its page. Node.js, Marp and a browser measure the built pages, so this runs only with `CI_LONG=1`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn slides() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

/// Measures the decks. `None` if this is not to run, or if a program is missing; the output says which.
fn measured(decks: &[PathBuf]) -> Option<Output> {
    if std::env::var_os("CI_LONG").is_none() {
        println!("skipped: run only with CI_LONG=1");
        return None;
    }
    if !slides().join("node_modules").is_dir() {
        println!("skipped: Marp is not installed: npm ci --prefix slides");
        return None;
    }
    let output = Command::new("node").arg(slides().join("overflow.mjs")).args(decks).output();
    let output = match output {
        Ok(output) if output.status.code() == Some(2) => {
            println!("skipped: {}", String::from_utf8_lossy(&output.stderr).trim_end());
            return None;
        }
        Ok(output) => output,
        Err(error) => {
            println!("skipped: node cannot be started: {error}");
            return None;
        }
    };
    Some(output)
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn every_slide_fits_its_page() {
    let mut decks: Vec<PathBuf> = fs::read_dir(slides())
        .expect("slides/ is a folder")
        .map(|file| file.expect("slides/ can be read").path())
        .filter(|file| file.extension().is_some_and(|ending| ending == "md"))
        .filter(|file| fs::read_to_string(file).is_ok_and(|text| text.starts_with("---\nmarp: true\n")))
        .collect();
    decks.sort();
    assert!(decks.len() > 10, "{decks:?}");
    if let Some(output) = measured(&decks) {
        assert!(output.status.success(), "{}", said(&output));
    }
}

#[test]
fn a_slide_that_is_too_long_is_found() {
    let lines: String = (1..=25).map(|line| format!("- line {line}\n")).collect();
    let head = "---\nmarp: true\ntheme: raykata\nmath: mathjax\n---\n";
    let deck = format!("{head}\n# Fits\n\ntext\n\n---\n\n## Too long\n\n{lines}");
    let file = std::env::temp_dir().join(format!("raykata-long-slide-{}.md", std::process::id()));
    fs::write(&file, deck).expect("the temporary folder can be written");
    let output = measured(std::slice::from_ref(&file));
    fs::remove_file(&file).expect("the deck was just written");
    if let Some(output) = output {
        let said = said(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("slide 2 (Too long): ends at") && !said.contains("slide 1"), "{said}");
    }
}
