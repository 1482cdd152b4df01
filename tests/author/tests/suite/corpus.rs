//! Tests the files of the corpus: every entry fits, every named check exists, and the stored results are of exactly these
//! entries. `cargo run -p author -- corpus` builds and tests the entries, which takes minutes.

use super::author;
use super::program_runs::{printed, root};
use ::author::corpus::entry::{Claim, Entry, Original, read_all, read_files};
use ::author::corpus::records::{Matrix, Messages};
use std::collections::{BTreeMap, BTreeSet};

fn entries() -> Vec<Entry> {
    read_all(&root()).unwrap_or_else(|error| panic!("{error:#}"))
}

#[test]
fn every_entry_fits_the_solutions_as_they_are() {
    for (name, corpus) in read_files(&root()).unwrap() {
        let original = Original::read(&root(), &format!("solutions/src/{name}.rs")).unwrap();
        for entry in &corpus.entries {
            entry.apply(&original).unwrap_or_else(|error| panic!("{error:#}"));
        }
        // The file is as the tools write it: sorted by function, mistakes first, then by name.
        let mut sorted = corpus.clone();
        sorted.sort(&original);
        let text = std::fs::read_to_string(root().join(format!("tests/corpus/{name}.corpus"))).unwrap();
        assert!(
            text == sorted.text(),
            "tests/corpus/{name}.corpus is not sorted: `cargo run -p author -- corpus NAME --reword` sorts it"
        );
    }
}

/// The items of the contracts of a file: the numbers below `Exactly:` of each exercise, or the exercise if it has none.
fn items(text: &str) -> Vec<String> {
    let mut items = Vec::new();
    let mut docs = "";
    for function in text.split("\npub fn ") {
        let name: String = function.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let (body, next_docs) = function.split_once("\n}").unwrap_or(("", function));
        let number = |line: &str| line.strip_prefix("/// ")?.split_once(". ")?.0.parse::<u8>().ok();
        let numbered: Vec<String> =
            docs.lines().filter_map(number).map(|number| format!("{name}.{number}")).collect();
        docs = next_docs;
        if body.contains("todo!") {
            items.extend(if numbered.is_empty() { vec![name] } else { numbered });
        }
    }
    items
}

/// Prints each item, the checks that catch what breaks it, and the mistakes.
#[test]
fn every_item_of_a_contract_is_broken_alone_and_caught() {
    let mut broken: BTreeMap<(String, String), BTreeMap<String, Vec<String>>> = BTreeMap::new();
    let mut without_item = Vec::new();
    for entry in entries() {
        let Claim::Wrong { breaks, caught_by, .. } = &entry.claim else { continue };
        match breaks.as_str() {
            "" => without_item.push(entry.to_string()),
            item => {
                let key = (entry.file.replace("solutions", "exercises"), item.into());
                broken.entry(key).or_default().entry(caught_by.clone()).or_default().push(entry.name)
            }
        }
    }
    let mut unbroken = Vec::new();
    for (name, _) in read_files(&root()).unwrap() {
        let file = format!("exercises/src/{name}.rs");
        for item in items(&std::fs::read_to_string(root().join(&file)).unwrap()) {
            let checks = broken.remove(&(file.clone(), item.clone()));
            for (check, names) in checks.iter().flatten() {
                println!("{item}: {check}: {}", names.join(" "));
            }
            unbroken.extend(checks.is_none().then_some(item));
        }
    }
    // A sentence above a list may only introduce it.
    broken.retain(|(_, item), _| item.contains('.'));
    assert!(broken.is_empty(), "no contract has these items: {:?}", broken.keys());
    assert!(unbroken.is_empty(), "no mistake breaks these items alone: {unbroken:?}");
    assert!(without_item.is_empty(), "these entries lack `breaks: ITEM`: {without_item:?}");
}

#[test]
fn the_matrix_is_about_these_entries_and_all_is_as_it_must_be() {
    let matrix = Matrix::read(&root());
    let entries = entries();
    let names: BTreeSet<String> = entries.iter().map(ToString::to_string).collect();
    let known: BTreeSet<String> = matrix.0.keys().cloned().collect();
    let different: Vec<&String> = names.symmetric_difference(&known).collect();
    assert!(different.is_empty(), "run `cargo run -p author -- corpus --bless`: {different:?}");
    for entry in &entries {
        let failed = &matrix.0[&entry.to_string()];
        match &entry.claim {
            Claim::Right => assert_eq!(failed, "-", "{entry} is right but rejected"),
            Claim::Wrong { caught_by, .. } => {
                let stage = entry.stage;
                let known = all_checks::find(stage, caught_by);
                assert!(known.is_some(), "{entry}: stage {stage} has no `{caught_by}`");
                assert!(
                    failed.split(' ').any(|check| check == format!("={caught_by}")),
                    "{entry} is not caught"
                );
            }
        }
    }
}

#[test]
fn every_check_can_fail() {
    let matrix = Matrix::read(&root());
    let killers: BTreeSet<&str> = matrix.killers().collect();
    let stages: BTreeSet<u8> = entries().iter().map(|entry| entry.stage).collect();
    for (_, checks) in all_checks::STAGES.iter().filter(|(stage, _)| stages.contains(stage)) {
        for check in *checks {
            assert!(killers.contains(check.name), "no mistake of the corpus fails `{}`", check.name);
        }
    }
}

#[test]
fn nine_of_ten_messages_say_what_the_mistake_looks_like() {
    let messages = Messages::read(&root());
    let entries = entries();
    let wrong = || entries.iter().filter(|entry| entry.claim != Claim::Right);
    let names: BTreeSet<String> = wrong().map(ToString::to_string).collect();
    let known: BTreeSet<String> = messages.0.keys().cloned().collect();
    let different: Vec<&String> = names.symmetric_difference(&known).collect();
    assert!(different.is_empty(), "run `cargo run -p author -- corpus --bless`: {different:?}");
    let named: Vec<&str> =
        wrong().filter(|entry| entry.has_a_known_mistake()).filter_map(|entry| messages.of(entry)).collect();
    let diagnosed = named.iter().filter(|message| message.contains("looks like:")).count();
    assert!(diagnosed * 10 >= named.len() * 9, "{diagnosed} of {}", named.len());
}

#[test]
fn an_entry_that_does_not_exist_is_reported() {
    let output = author(&["corpus", "no_such_entry"]);
    assert_eq!(output.status.code(), Some(1));
    let (_, complaint) = printed(&output);
    assert!(complaint.contains("has no entry `no_such_entry`"), "{complaint}");
}

#[test]
fn questions_about_the_corpus_are_answered_without_a_build() {
    let answer = |option: &str, value: &str| {
        let output = author(&["corpus", option, value]);
        assert!(output.status.success(), "{output:?}");
        printed(&output).0
    };
    let says = answer("--saying", "you take a box for a hit");
    assert!(says.contains("wrong any_box_is_enough: ") && !says.contains("right "), "{says}");
    let changes = answer("--function", "slab");
    assert!(
        changes.starts_with("tests/corpus/stage3_boxes.corpus\n") && changes.contains("  right "),
        "{changes}"
    );
    let caught = answer("--check", "any_hit_stops_at_the_first");
    assert!(caught.contains(" =wrong any_does_not_stop: "), "{caught}");
}
