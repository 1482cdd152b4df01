//! `author weaken`: shows that the corpus guards the checks. It weakens numbers by which checks judge, one at a time, and demands
//! that an entry of the corpus notices: a mistake is accepted, a right solution is rejected, or a message differs.
//!
//! A number that survives is a gap in the corpus, or decides nothing that an entry should notice. Those that were reviewed are
//! listed in tests/corpus/harmless.toml, each with its reason.
//!
//! `numbers` (finds them) · `judges` (asks a judge with a change) · `reviewed` (the harmless changes)

mod judges;
mod numbers;
mod reviewed;

use crate::corpus::FOLDER;
use crate::corpus::build_folder::{BuildFolder, Built, Product};
use crate::corpus::entry::{Entry, read_all};
use crate::corpus::plan::{Plan, Trial};
use crate::corpus::program::Program;
use crate::corpus::records::{Matrix, Messages, without_rubric};
use all_checks::STAGES;
use anyhow::{Context, Result, bail};
use checks::Check;
use grader::files_below::{files_below, last_part};
use grader::kits::root;
use grader::queue::{self, lock};
use grader::report::bar_of_steps;
use judges::Judge;
use numbers::numbers;
use raykata_cli::args::{Given, Opt, Spec};
use raykata_cli::fingerprint::fingerprint;
use raykata_cli::journal::Journal;
use raykata_cli::lock::Lock;
use reviewed::Reviewed;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::Path;
use std::sync::Mutex;

/// `author weaken`.
pub static SPEC: Spec = Spec {
    name: "author weaken",
    about: "Weaken numbers by which checks judge, and demand that the corpus notices.",
    arguments: &[],
    options: &[&[
        Opt::value("--sample", "N", "How many numbers to weaken [default: 40]."),
        Opt::value("--seed", "N", "Draws another sample [default: 1]."),
        Opt::value("--file", "NAME", "Only numbers of files whose paths contain this."),
        Opt::flag("--resume", "Continue the last run: skip the numbers that it has weakened."),
    ]],
};

/// How many trials a judge gets before it is started again.
const TRIALS_OF_A_JUDGE: usize = 30;

/// The list of reviewed changes.
const REVIEWED: &str = "tests/corpus/harmless.toml";

/// A changed number.
struct Change {
    /// The stage of the check; 0 for code that all stages share.
    stage: u8,
    file: String,
    line: usize,
    was: String,
    becomes: String,
    /// The whole text of the file with the change.
    text: String,
}

impl Change {
    fn key(&self) -> String {
        format!("{}\n- {}\n+ {}", self.file, self.was, self.becomes)
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}\n    - {}\n    + {}", self.file, self.line, self.was, self.becomes)
    }
}

/// What happened to a change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum WeakenVerdict {
    /// It does not compile.
    DoesNotCompile,
    /// The corpus turns red, for this reason.
    Caught(String),
    /// Nothing differs.
    Survived,
}

/// Weakens numbers and prints a report. Returns whether each survivor was reviewed and no reviewed one was caught.
pub fn run(given: &Given) -> Result<bool> {
    let sample = given.number("--sample", 1..=usize::MAX)?.unwrap_or(40);
    let seed = given.number("--seed", 0..=u64::MAX)?.unwrap_or(1);
    let file = given.path("--file").unwrap_or_default();
    let root = &root()?;
    let reviewed = Reviewed::read(root, REVIEWED)?;
    let _lock = Lock::on(&root.join(FOLDER))?;
    let drawn = drawn(root, seed, &file.to_string_lossy())?;
    let journal_file = root.join(FOLDER).join("weaken.jsonl");
    let about = format!("numbers of checks, seed {seed}");
    let mut journal: Journal<WeakenVerdict> = match given.has("--resume") {
        true => Journal::resume(&journal_file, &about)?,
        false => Journal::create(&journal_file, &about)?,
    };
    let guard = Guard::open(root)?;
    let bar = bar_of_steps(sample);
    // Take the numbers of the stages in turn, until there are enough that compile.
    let mut tried: Vec<(&Change, WeakenVerdict)> = Vec::new();
    for change in &drawn {
        let compiled = tried.iter().filter(|(_, verdict)| *verdict != WeakenVerdict::DoesNotCompile);
        if compiled.count() == sample {
            break;
        }
        bar.set_message(format!("{}:{}", change.file, change.line));
        let known = journal.kept().find(|(key, _)| **key == change.key()).map(|(_, verdict)| verdict.clone());
        let verdict = match known {
            Some(verdict) => verdict,
            None => {
                let verdict = guard.judge(change)?;
                journal.add(&change.key(), &verdict)?;
                verdict
            }
        };
        bar.suspend(|| {
            println!("{change}");
            match &verdict {
                WeakenVerdict::DoesNotCompile => println!("  does not compile, so another one is drawn\n"),
                WeakenVerdict::Caught(why) => println!("  caught: {why}\n"),
                WeakenVerdict::Survived if reviewed.reason(change).is_some() => {
                    println!("  reviewed as harmless\n")
                }
                WeakenVerdict::Survived => println!("  SURVIVED\n"),
            }
        });
        bar.inc(u64::from(verdict != WeakenVerdict::DoesNotCompile));
        tried.push((change, verdict));
    }
    bar.finish_and_clear();
    Ok(report(&tried, &reviewed))
}

fn report(tried: &[(&Change, WeakenVerdict)], reviewed: &Reviewed) -> bool {
    let is_reviewed = |change: &Change| reviewed.reason(change).is_some();
    println!("stage   weakened  caught  reviewed  survived");
    let stages: Vec<u8> = (0..=STAGES.len() as u8).collect();
    for stage in stages.into_iter().map(Some).chain([None]) {
        let count = |which: &dyn Fn(&Change, &WeakenVerdict) -> bool| {
            let of_stage = tried.iter().filter(|(change, _)| stage.is_none_or(|stage| stage == change.stage));
            of_stage.filter(|(change, verdict)| which(change, verdict)).count()
        };
        println!(
            "{:<6}  {:>8}  {:>6}  {:>8}  {:>8}",
            match stage {
                None => "all".to_owned(),
                Some(0) => "shared".to_owned(),
                Some(stage) => stage.to_string(),
            },
            count(&|_, verdict| *verdict != WeakenVerdict::DoesNotCompile),
            count(&|_, verdict| matches!(verdict, WeakenVerdict::Caught(_))),
            count(&|change, verdict| *verdict == WeakenVerdict::Survived && is_reviewed(change)),
            count(&|change, verdict| *verdict == WeakenVerdict::Survived && !is_reviewed(change)),
        );
    }
    let (mut caught, mut survivors) = (0, 0);
    for (change, verdict) in tried {
        match (verdict, reviewed.reason(change)) {
            (WeakenVerdict::Caught(_), Some(because)) => {
                println!("\ncaught, but {REVIEWED} says that nothing can notice it ({because}): {change}");
                caught += 1;
            }
            (WeakenVerdict::Survived, None) => survivors += 1,
            _ => {}
        }
    }
    if survivors > 0 {
        println!(
            "\nfor each survivor add an entry to the corpus that notices it, or its reason to {REVIEWED}"
        );
    }
    survivors == 0 && caught == 0
}

/// All numbers in the order in which they are drawn: one of each stage in turn. Every fourth turns its comparison, if it stands
/// in one; the others are multiplied by 10. Only the paths of files that contain `name` count.
fn drawn(root: &Path, seed: u64, name: &str) -> Result<Vec<Change>> {
    let mut stages: BTreeMap<u8, Vec<(String, Change)>> = BTreeMap::new();
    for (stage, file) in files(root)?.into_iter().filter(|(_, file)| file.contains(name)) {
        let text = fs::read_to_string(root.join(&file)).with_context(|| file.clone())?;
        for number in numbers(&text).with_context(|| file.clone())? {
            // Draw by the text of the line, so that changes elsewhere in the file draw no other numbers.
            let start = text[..number.place.start].rfind('\n').map_or(0, |end| end + 1);
            let line = text[start..].lines().next().unwrap_or_default();
            let words = format!("{} {line}", number.place.start - start);
            let order = fingerprint([&seed.to_le_bytes()[..], file.as_bytes(), words.as_bytes()]);
            let turns = order.as_bytes().last().is_some_and(|digit| digit % 4 == 0);
            let turned = number.turned(&text).filter(|_| turns);
            let changed = turned.unwrap_or_else(|| number.times_ten(&text));
            // The sign of a comparison may stand on another line than the number.
            let differs = text.lines().zip(changed.lines()).position(|(was, becomes)| was != becomes);
            let line = differs.context("a change of a line")?;
            let of_line = |text: &str| text.lines().nth(line).unwrap_or_default().trim().to_owned();
            let (was, becomes) = (of_line(&text), of_line(&changed));
            let change = Change { stage, file: file.clone(), line: line + 1, was, becomes, text: changed };
            stages.entry(stage).or_default().push((order, change));
        }
    }
    for of_stage in stages.values_mut() {
        of_stage.sort_by(|(one, _), (other, _)| other.cmp(one));
    }
    let mut drawn = Vec::new();
    while stages.values().any(|of_stage| !of_stage.is_empty()) {
        drawn.extend(stages.values_mut().filter_map(Vec::pop).map(|(_, change)| change));
    }
    Ok(drawn)
}

/// The files of the checks, with their stages; 0 for those that all stages share.
fn files(root: &Path) -> Result<Vec<(u8, String)>> {
    let of_stages = STAGES.iter().map(|(stage, _)| (*stage, format!("tests/checks/stage{stage}/src")));
    let mut files = Vec::new();
    for (stage, folder) in [(0, "tests/checks/src".to_owned())].into_iter().chain(of_stages) {
        let all = files_below(root, &folder, &|_| true)?.into_iter();
        let code = all.filter(|path| path.ends_with(".rs") && last_part(path) != "tests.rs");
        files.extend(code.map(|path| (stage, path)));
    }
    files.sort();
    Ok(files)
}

/// The corpus as it is kept, and the judges.
struct Guard {
    judges: BuildFolder,
    program: Program,
    entries: Vec<Entry>,
    messages: Messages,
    plan: Plan,
}

impl Guard {
    fn open(root: &Path) -> Result<Guard> {
        let entries = read_all(root)?;
        let program = Program::build(root, &entries)?;
        let plan = Plan::of(&program, &Matrix::read(root), &entries, queue::cores())?;
        let judges = BuildFolder::open(root, "checks", Product::Judge)?;
        if let Built::DoesNotCompile(error) = judges.build_with::<&str>(&[])? {
            bail!("the unchanged judge does not compile:\n{error}");
        }
        Ok(Guard { judges, program, entries, messages: Messages::read(root), plan })
    }

    fn judge(&self, change: &Change) -> Result<WeakenVerdict> {
        let Built::Program(judge) = self.judges.build_with(&[(&change.file, &change.text)])? else {
            return Ok(WeakenVerdict::DoesNotCompile);
        };
        let mut trials: Vec<(Trial, &Check, &Entry)> = Vec::new();
        for (stage, checks) in STAGES.iter().filter(|(stage, _)| [0, *stage].contains(&change.stage)) {
            for check in *checks {
                let of_stage = self.entries.iter().filter(|entry| entry.stage == *stage);
                let tried = of_stage
                    .filter_map(|entry| Some((self.plan.trial(&self.program, entry, check)?, check, entry)));
                trials.extend(tried);
            }
        }
        // A check is in the changed file, most likely, if the file contains its name: ask it first.
        trials.sort_by_key(|(_, check, _)| !change.text.contains(check.name));
        // A judge has a limit of processor time, because a changed loop may not end. So each judge gets a few trials.
        let parts: Vec<&[(Trial, &Check, &Entry)]> = trials.chunks(TRIALS_OF_A_JUDGE).collect();
        let caught: Mutex<Option<String>> = Mutex::default();
        queue::run(&queue::one_a_core(), &parts, |(), part| {
            let mut running = None;
            for (trial, check, entry) in *part {
                if lock(&caught).is_some() {
                    break;
                }
                let running = match &mut running {
                    Some(running) => running,
                    none => none.insert(Judge::start(&judge)?),
                };
                if let Some(why) = self.difference(running, *trial, check, entry)? {
                    *lock(&caught) = Some(why);
                }
            }
            Ok(())
        })?;
        let caught = lock(&caught).take();
        Ok(caught.map_or(WeakenVerdict::Survived, WeakenVerdict::Caught))
    }

    /// How a check differs from what the corpus keeps of it, if it does.
    fn difference(
        &self,
        judge: &mut Judge,
        trial: Trial,
        check: &Check,
        entry: &Entry,
    ) -> Result<Option<String>> {
        let message = judge.message(check, &self.program.kit(entry))?;
        let named = check.name;
        Ok(match (trial, message) {
            (Trial::Accepts, None) | (Trial::Rejects, Some(_)) => None,
            (Trial::Accepts, Some(_)) => Some(format!("`{named}` rejects {entry}")),
            (Trial::Rejects | Trial::Message, None) => Some(format!("`{named}` accepts {entry}")),
            (Trial::Message, Some(message)) => {
                let is_kept = self.messages.of(entry) == Some(&without_rubric(&message));
                (!is_kept).then(|| format!("the message of `{named}` about {entry} differs"))
            }
        })
    }
}
