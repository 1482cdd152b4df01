//! `author corpus`: tests the checks. Each entry is the reference with one difference. It is either a mistake, which a
//! named check must catch and diagnose, or another right solution, which every check must accept.
//!
//! `entry` (reads `tests/corpus`) · `source` (the functions of a file) · `schemata` (many entries in one file) · `program` (the
//! program of all entries) · `plan` (which checks are tried with which entries) · `verdict` (the result of an entry) · `records` (the
//! stored results) · `build_folder` (the folder in which solutions are built)

pub mod build_folder;
pub mod entry;
pub mod plan;
pub mod program;
pub mod records;
pub mod schemata;
pub mod source;
pub mod verdict;

use anyhow::{Result, bail};
use checks::Inputs;
use entry::{Claim, Entry};
use grader::kits::{Need, Source, Which, root};
use grader::queue;
use grader::report::bar_of_steps;
use plan::{Plan, Trial};
use program::Program;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use raykata_cli::lock::Lock;
use records::{Matrix, Messages};
use schemata::Form;
use std::path::Path;
use std::sync::Arc;
use verdict::{EntryVerdict, TriedEntry, one_line};

/// The folder in which entries and changes of the solutions are built. One run at a time uses it.
pub(crate) const FOLDER: &str = "target/corpus";

/// `author corpus`.
pub static SPEC: Spec = Spec {
    name: "author corpus",
    about: "Test the checks with known mistakes and other right solutions.",
    arguments: &[Argument::optional("NAME", "The names of entries [default: all].").many()],
    options: &[
        &[
            Opt::value("--stage", "N", "Only this stage."),
            Opt::flag("--right", "Only right solutions."),
            Opt::value("--function", "NAME", "List the entries that change this function."),
            Opt::value(
                "--check",
                "NAME",
                "List the mistakes that this check rejects; `=` marks those that it must catch.",
            ),
            Opt::value("--saying", "WORDS", "List the mistakes whose stored message has these words."),
            Opt::flag("--run", "Test the listed entries."),
        ],
        &[
            Opt::flag(
                "--bless",
                "Try every check of the stage, store the matrix and the messages, and sort the entries.",
            ),
            Opt::flag(
                "--reword",
                "Store the messages, and sort the entries. Use it after a change of words in a diagnosis.",
            ),
            Opt::value("--jobs", "N", "How many to test at the same time [default: one per core]."),
            Opt::value(
                "--seed",
                "N",
                "Pick the inputs of the checks with this seed instead of 0. The messages may then differ, so each mistake \
                 only has to fail the check that must catch it.",
            ),
        ],
    ],
};

/// The options of `author corpus`.
struct CorpusOptions {
    names: Vec<String>,
    stage: Option<u8>,
    right: bool,
    function: Option<String>,
    check: Option<String>,
    saying: Option<String>,
    lists: bool,
    bless: bool,
    reword: bool,
    jobs: usize,
    seed: Option<u64>,
}

impl CorpusOptions {
    fn read(given: &Given) -> Result<CorpusOptions, Misuse> {
        given.exclude("--bless", "--reword")?;
        given.exclude("--seed", "--bless")?;
        given.exclude("--seed", "--reword")?;
        let text = |name| given.path(name).map(|words| words.to_string_lossy().into_owned());
        let (function, check, saying) = (text("--function"), text("--check"), text("--saying"));
        let asks = function.is_some() || check.is_some() || saying.is_some();
        Ok(CorpusOptions {
            names: given.texts(0),
            stage: given.number("--stage", 0..=u8::MAX)?,
            right: given.has("--right"),
            function,
            check,
            saying,
            lists: asks && !["--run", "--bless", "--reword"].iter().any(|action| given.has(action)),
            bless: given.has("--bless"),
            reword: given.has("--reword"),
            jobs: given.number("--jobs", 1..=usize::MAX)?.unwrap_or_else(queue::cores),
            seed: given.number("--seed", 0..=u64::MAX)?,
        })
    }
}

/// Lists or tests entries and prints a report. Returns whether all results are as required.
pub fn run(given: &Given) -> Result<bool> {
    let options = &CorpusOptions::read(given)?;
    let root = &root()?;
    let all = entry::read_all(root)?;
    let (matrix, messages) = (Matrix::read(root), Messages::read(root));
    let chosen = choose(&all, options, &matrix, &messages)?;
    if options.lists {
        list(&chosen, options, &matrix);
        return Ok(true);
    }
    let complete = chosen.len() == all.len();
    let _lock = Lock::on(&root.join(FOLDER))?;
    // Build all entries, so that the next run with other ones needs no build.
    let program = Program::build(root, &all)?;
    let tried = try_all(root, &program, &matrix, &chosen, options)?;
    if options.bless || options.reword {
        records::bless(root, &tried, options.bless, complete)?;
        for (name, mut corpus) in entry::read_files(root)? {
            entry::write_file(root, &name, &mut corpus)?;
        }
    }
    let differences = match options.seed {
        None if !options.bless && !options.reword => records::differences(&messages, &tried),
        _ => Vec::new(),
    };
    report(&program, &tried, &differences);
    Ok(differences.is_empty() && tried.iter().all(|one| one.verdict.is_as_it_must_be()))
}

fn choose(
    all: &[Entry],
    options: &CorpusOptions,
    matrix: &Matrix,
    messages: &Messages,
) -> Result<Vec<Entry>> {
    for name in &options.names {
        if !all.iter().any(|entry| is_named(entry, name)) {
            bail!("tests/corpus has no entry `{name}`");
        }
    }
    let is_said = |entry: &Entry, words: &str| {
        messages.of(entry).is_some_and(|message| one_line(message).contains(&one_line(words)))
    };
    let is_wanted = |entry: &Entry| {
        (options.names.is_empty() || options.names.iter().any(|name| is_named(entry, name)))
            && options.stage.is_none_or(|stage| stage == entry.stage)
            && (!options.right || entry.claim == Claim::Right)
            && options.function.as_ref().is_none_or(|name| entry.changes_function(name))
            && options.check.as_ref().is_none_or(|check| matrix.fails(entry, check))
            && options.saying.as_ref().is_none_or(|words| is_said(entry, words))
    };
    let chosen: Vec<Entry> = all.iter().filter(|entry| is_wanted(entry)).cloned().collect();
    if chosen.is_empty() {
        bail!("tests/corpus has no entry for these options");
    }
    Ok(chosen)
}

fn is_named(entry: &Entry, name: &str) -> bool {
    entry.name == name || entry.to_string() == name
}

/// Prints the entries, each with its sentence.
fn list(chosen: &[Entry], options: &CorpusOptions, matrix: &Matrix) {
    let mut file = "";
    for entry in chosen {
        if entry.file != file {
            println!("{}{}", if file.is_empty() { "" } else { "\n" }, entry::corpus_file(&entry.file));
            file = &entry.file;
        }
        let caught = options.check.as_deref().is_some_and(|check| entry.caught_by() == Some(check));
        println!(" {}{} {}: {}", if caught { '=' } else { ' ' }, entry.kind(), entry.name, entry.title);
        if options.check.is_none()
            && let Some(checks) = matrix.0.get(&entry.to_string()).filter(|checks| *checks != "-")
        {
            println!("      fails {checks}");
        }
    }
    println!("\n{} entries", chosen.len());
}

/// Tests entries: with the planned checks, or with `--bless` with all checks of their stages.
fn try_all(
    root: &Path,
    program: &Program,
    matrix: &Matrix,
    entries: &[Entry],
    options: &CorpusOptions,
) -> Result<Vec<TriedEntry>> {
    let plan = if options.bless { None } else { Some(Plan::of(program, matrix, entries, options.jobs)?) };
    // With a seed, texts and pictures are drawn, and the expected ones come from the reference.
    let reference = match options.seed {
        Some(_) => Some(Source::prepare(root, Which::Solutions, Need::Checks)?.fresh()),
        None => None,
    };
    let inputs = Inputs { drawn: Some(Arc::default()), reference, ..Inputs::default() };
    let bar = bar_of_steps(entries.len());
    let tried = queue::run(&vec![(); options.jobs], entries, |(), entry| {
        bar.set_message(entry.to_string());
        let (mut failures, mut missed) = (verdict::Failures::new(), Vec::new());
        for check in all_checks::of_stage(entry.stage) {
            let kit = || program.kit(entry).fresh();
            match plan.as_ref().map(|plan| plan.trial(program, entry, check)) {
                Some(None) => {}
                Some(Some(Trial::Rejects)) => {
                    if checks::passes(check, &kit(), options.seed.unwrap_or(0)) {
                        missed.push(check.name);
                    }
                }
                _ => {
                    let examined = checks::examine(check, &kit(), options.seed.unwrap_or(0), inputs.clone());
                    let failure = verdict::failure(checks::verdict(check, examined));
                    failures.extend(failure.map(|message| (check.name, message)));
                }
            }
        }
        let verdict = match EntryVerdict::of(entry, &failures, missed) {
            EntryVerdict::Unnamed(_) | EntryVerdict::Misnamed if options.seed.is_some() => {
                EntryVerdict::Killed
            }
            verdict => verdict,
        };
        bar.inc(1);
        Ok(TriedEntry { entry: entry.clone(), verdict, failures })
    })?;
    bar.finish_and_clear();
    Ok(tried)
}

fn report(program: &Program, tried: &[TriedEntry], differences: &[String]) {
    for one in tried.iter().filter(|one| !one.verdict.is_as_it_must_be()) {
        println!("{one}\n");
    }
    for difference in differences {
        println!("{difference}\n");
    }
    let mut stages: Vec<u8> = tried.iter().map(|one| one.entry.stage).collect();
    stages.dedup();
    println!("stage  mistakes   caught  otherwise  survived  diagnosed   right  accepted");
    for stage in stages.iter().map(|stage| Some(*stage)).chain([None]) {
        let count = |which: &dyn Fn(&TriedEntry) -> bool| {
            let of_stage = tried.iter().filter(|one| stage.is_none_or(|stage| stage == one.entry.stage));
            of_stage.filter(|one| which(one)).count()
        };
        let with_verdict = |verdict: EntryVerdict| count(&|one| one.verdict == verdict);
        let otherwise = |one: &TriedEntry| {
            use EntryVerdict::{KilledByAnother, Misnamed, Missed, Unnamed};
            matches!(one.verdict, Unnamed(_) | Misnamed | KilledByAnother | Missed(_))
        };
        let right = |one: &TriedEntry| one.entry.claim == Claim::Right;
        println!(
            "{:<5}  {:>8}  {:>7}  {:>9}  {:>8}  {:>9}  {:>6}  {:>8}",
            stage.map_or("all".into(), |stage| stage.to_string()),
            count(&|one| !right(one)),
            with_verdict(EntryVerdict::Killed),
            count(&otherwise),
            with_verdict(EntryVerdict::Survived),
            count(&TriedEntry::is_diagnosed),
            count(&right),
            with_verdict(EntryVerdict::Accepted),
        );
    }
    let names = |form: Form| -> Vec<String> {
        let of_form = tried.iter().filter(|one| program.form(&one.entry) == form);
        of_form.map(|one| one.entry.to_string()).collect()
    };
    let (modules, alone) = (names(Form::Module), names(Form::Alone));
    println!("\nin one program: {} by their functions", names(Form::Functions).len());
    for (form, names) in [("by a copy of their module", modules), ("in a program of their own", alone)] {
        if !names.is_empty() {
            println!("{} {form}: {}", names.len(), names.join(", "));
        }
    }
    let undiagnosed = tried
        .iter()
        .filter(|one| one.message().is_some() && !one.is_diagnosed() && one.entry.has_a_known_mistake());
    let undiagnosed: Vec<String> = undiagnosed.map(|one| one.entry.to_string()).collect();
    if !undiagnosed.is_empty() {
        println!("caught without a diagnosis: {}", undiagnosed.join(", "));
    }
    if !differences.is_empty() {
        println!(
            "\n{} messages differ: read them, then `cargo run -p author -- corpus --reword` with the same options",
            differences.len()
        );
    }
}
