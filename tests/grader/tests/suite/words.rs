//! The kit uses the terms of the field. This test refuses the terms of its own that it used before.

use super::program_runs::root;
use std::fs;
use std::path::{Path, PathBuf};

/// Terms that are refused, each with the term to write. An underscore ends a word, so names in code count too.
const REFUSED: [(&str, &str); 30] = [
    ("ball", "sphere"),
    ("balls", "spheres"),
    ("box tests a ray", "box tests per ray"),
    ("desk", "scratch"),
    ("develop", "filter_pixel"),
    ("endless cylinder", "infinite cylinder"),
    ("endless plane", "infinite plane"),
    ("face_viewer", "face_forward"),
    ("gloss", "glossy, or sample_phong_lobe"),
    ("jail", "sandbox"),
    ("jailed", "sandboxed"),
    ("knob", "parameter"),
    ("knobs", "parameters"),
    ("lamp", "light"),
    ("lamps", "lights"),
    ("mirrored share", "Fresnel reflectance"),
    ("mishap", "error"),
    ("nonsense", "invalid, or malformed"),
    ("normalise", "normalize"),
    ("normalised", "normalized"),
    ("on_disk", "sample_disk"),
    ("on_rectangle", "sample_rectangle"),
    ("plane of focus", "focal plane"),
    ("primitive tests a ray", "primitive tests per ray"),
    ("rung", "level"),
    ("rungs", "levels"),
    ("siege", "attacks"),
    ("told", "described, reported, or written"),
    ("toward_ball", "sample_sphere"),
    ("where the formula lies", "Pitfall"),
];

/// Where an old term may stand: the start of a path, and the term (all terms if it is empty).
const ALLOWED: [(&str, &str); 10] = [
    // History, and the table from which a course's own patches are carried over.
    ("CHANGELOG.md", ""),
    ("tests/corpus/renames.toml", ""),
    ("tests/grader/tests/suite/words.rs", ""),
    // What scenes contain: balls and lamps are things, spheres and lights are terms.
    ("scenes/", ""),
    ("README.md", "ball"),
    ("slides/stage07.md", "lamp"),
    ("src/cli/tests/suite/program.rs", "ball"),
    ("tests/corpus/gaps.txt", "ball"),
    ("tests/grader/src/generate/images.rs", "ball"),
    // Code of submissions that attack the grader.
    ("tests/corpus/attack/", "told"),
];

/// Whether `text` (in lower case) contains `term` as a word.
fn contains(text: &str, term: &str) -> bool {
    text.match_indices(term).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        let after = text[at + term.len()..].chars().next();
        !before.is_some_and(char::is_alphabetic) && !after.is_some_and(char::is_alphabetic)
    })
}

/// All files with text that people write, from `folder` down.
fn texts(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && !matches!(&*name, "target" | "out" | ".git" | "node_modules") {
            texts(&path, found);
        } else if [".rs", ".md", ".toml", ".patch"].iter().any(|ending| name.ends_with(ending)) {
            found.push(path);
        }
    }
}

#[test]
fn old_terms_do_not_come_back() {
    let (root, mut files, mut old) = (root(), Vec::new(), Vec::new());
    texts(&root, &mut files);
    assert!(files.len() > 1000, "{} files", files.len());
    for file in files {
        let name = file.strip_prefix(&root).expect("a file of the kit").display().to_string();
        let text = fs::read_to_string(&file).unwrap_or_default().to_lowercase();
        for (term, instead) in REFUSED {
            let allowed =
                |(path, word): &(&str, &str)| name.starts_with(path) && (word.is_empty() || *word == term);
            if !contains(&text, term) || ALLOWED.iter().any(allowed) {
                continue;
            }
            let lines = text.lines().enumerate().filter(|(_, line)| contains(line, term));
            old.extend(lines.map(|(line, _)| format!("{name}:{}: `{term}`; write `{instead}`", line + 1)));
        }
    }
    assert!(old.is_empty(), "{} old terms:\n{}", old.len(), old.join("\n"));
}

#[test]
fn a_term_is_found_as_a_word_and_in_names() {
    assert!(contains("a lamp.", "lamp") && contains("lamp_disk", "lamp") && contains("the_lamp", "lamp"));
    assert!(!contains("a clamp", "lamp") && !contains("lamplight", "lamp"));
}
