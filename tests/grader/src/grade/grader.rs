//! Grades all submissions of a folder, some at a time.

use super::forge::Forge;
use super::judge::Judge;
use super::lint::{self, Finding, Reading};
use super::report::clean::{clean, clean_line};
use super::result::{Graded, Outcome, Remark};
use super::store::Store;
use super::submission::{self, Submission, Taken};
use crate::queue;
use crate::sandbox::{self, Confinement, How, Purpose, Sandbox};
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The syntax check reads tokens; the longest file takes it a few milliseconds.
const LINT_PATIENCE: Duration = Duration::from_secs(10);

/// All that a submission is graded with.
pub struct Grader {
    /// Makes workers.
    pub forge: Arc<Forge>,
    /// Asks them.
    pub judge: Arc<Judge>,
    /// Lerp a submission and the machine.
    pub confinement: Confinement,
    /// Rules of the syntax check that do not apply.
    pub allowed: Vec<String>,
}

/// How many findings in a file are told: the first says what is wrong, and the twentieth nothing new.
const MOST_FINDINGS: usize = 10;

/// How much of what the compiler says is kept, of all files together.
const MOST_FROM_COMPILER: usize = 16 * 1024;

/// A file that was not built with, and why.
type Lost = BTreeMap<String, (Outcome, String)>;

/// What the syntax check says of a submission.
struct Read {
    /// The files that hold what no exercise needs.
    refused: Lost,
    /// Whether an answer may depend on what was asked before.
    may_remember: bool,
}

impl Grader {
    /// Grades all that `store` does not know yet, on `jobs` threads; tells `done` of each.
    pub fn grade_all(
        &self,
        submissions: &[Submission],
        store: &Store,
        jobs: usize,
        done: impl Fn(&Graded) + Sync,
    ) -> Result<()> {
        let grade = |_: &(), submission: &Submission| {
            let taken = self.take(&submission.path);
            if let Some(known) = store.known(&submission.student, &taken.content())? {
                done(&known);
                return Ok(());
            }
            let empty = self.graded(&submission.student, &taken);
            let graded =
                self.grade(&submission.student, taken).unwrap_or_else(|error| self.broken(empty, &error));
            store.keep(&graded)?;
            done(&graded);
            Ok(())
        };
        queue::run(&vec![(); jobs], submissions, grade).map(drop)
    }

    /// What is taken of a submission.
    pub fn take(&self, path: &Path) -> Taken {
        submission::take(path, &self.forge.exercises())
    }

    /// Grades what was taken of a submission. Fails only if the grader itself does.
    pub fn grade(&self, student: &str, taken: Taken) -> Result<Graded> {
        let mut graded = self.graded(student, &taken);
        let Taken { files, mut remarks, .. } = taken;
        if !graded.trouble.is_empty() {
            graded.checks = self.judge.all(Outcome::NotWritten, "nothing could be taken of the submission");
            graded.remarks = remarks.into_iter().map(cleaned).collect();
            return Ok(graded);
        }
        // Outside of the folders of the kit and of the submission, and gone afterwards.
        let scratch = tempfile::tempdir().context("cannot make a folder to compile in")?;
        let Read { refused, may_remember } = self.read(&files, &mut remarks)?;
        let kept: BTreeMap<String, String> =
            files.into_iter().filter(|(name, _)| !refused.contains_key(name)).collect();
        let forged = self.forge.build(scratch.path(), &kept)?;
        graded.cpu_ms = forged.cpu.as_millis() as u64;
        for (name, (_, messages)) in &forged.replaced {
            let what =
                "does not compile; the empty exercise was put in its place, so that others can be judged";
            remarks.push(Remark { file: name.clone(), what: what.into() });
            graded.compiler += messages;
        }
        graded.compiler = clean(&graded.compiler, MOST_FROM_COMPILER);
        let lost: Lost = refused.into_iter().chain(forged.replaced).collect();
        let started = Instant::now();
        graded.checks = self.judge.judge(&forged.worker, &lost, may_remember);
        graded.cpu_ms += started.elapsed().as_millis() as u64;
        graded.remarks = remarks.into_iter().map(cleaned).collect();
        Ok(graded)
    }

    /// A grade to be filled in.
    fn graded(&self, student: &str, taken: &Taken) -> Graded {
        Graded {
            student: student.into(),
            content: taken.content(),
            checks: Vec::new(),
            remarks: Vec::new(),
            compiler: String::new(),
            trouble: taken.trouble.clone().unwrap_or_default(),
            cpu_ms: 0,
        }
    }

    /// The grade where grading itself broke: the class goes on, and the next run tries it again.
    fn broken(&self, mut graded: Graded, error: &anyhow::Error) -> Graded {
        graded.content.clear();
        graded.trouble = format!("could not be graded: {error:#}");
        graded.checks = self.judge.all(Outcome::NotTried, "grading broke; see what the instructor was told");
        graded
    }

    /// Puts the files to the syntax check, each in a sandbox: what is meant to confuse a compiler may confuse the check.
    fn read(&self, files: &BTreeMap<String, String>, remarks: &mut Vec<Remark>) -> Result<Read> {
        let mut lost = Lost::new();
        // What a rule would have kept out may remember in ways that the check does not know.
        let mut may_remember = !self.allowed.is_empty();
        for (name, text) in files.iter().filter(|(name, text)| !self.forge.is_untouched(name, text)) {
            let reading = match self.reading(text)? {
                Some(reading) => reading,
                None => {
                    let why =
                        "the syntax check broke on it: it is nested too deeply for any exercise".to_owned();
                    let broke = Finding { rule: "nesting".into(), line: 1, why };
                    Reading { findings: vec![broke], may_remember: true }
                }
            };
            may_remember |= reading.may_remember;
            let against: Vec<String> = reading
                .findings
                .iter()
                .filter(|finding| !self.allowed.contains(&finding.rule))
                .map(|finding| format!("{name}:{}: {} [{}]", finding.line, finding.why, finding.rule))
                .collect();
            if !against.is_empty() {
                let more = against.len().saturating_sub(MOST_FINDINGS);
                let mut told = against[..against.len() - more].join("\n");
                if more > 0 {
                    told += &format!("\nand {more} more");
                }
                remarks.push(Remark { file: name.clone(), what: format!("was refused:\n{told}") });
                lost.insert(name.clone(), (Outcome::Refused, format!("refused:\n{told}")));
            }
        }
        Ok(Read { refused: lost, may_remember })
    }

    /// What the syntax check reads in a file; `None` if it broke.
    fn reading(&self, text: &str) -> Result<Option<Reading>> {
        let mut command = Sandbox::with(self.confinement, Purpose::Reader).command(&own_program()?);
        command.arg(LINT_WORD);
        let ended = sandbox::run(command, text.as_bytes(), LINT_PATIENCE, 4 << 20)
            .context("the syntax check cannot be started")?;
        if ended.how != How::Exited(0) {
            return Ok(None);
        }
        Ok(Some(serde_json::from_slice(&ended.stdout).context("the syntax check gave no answer")?))
    }
}

/// A remark that can be printed: names of files may hold anything.
fn cleaned(remark: Remark) -> Remark {
    Remark { file: clean_line(&remark.file, 256), what: clean(&remark.what, 4096) }
}

/// With this word for its first argument the program checks what it reads.
const LINT_WORD: &str = "__syntax";

/// Does the syntax check if this process was started for that. For the start of `main`.
pub fn lint_if_asked() {
    if std::env::args().nth(1).as_deref() == Some(LINT_WORD) {
        let mut text = String::new();
        let read = std::io::Read::read_to_string(&mut std::io::stdin(), &mut text);
        let found = lint::read(&text);
        match (read, serde_json::to_string(&found)) {
            (Ok(_), Ok(json)) => println!("{json}"),
            _ => std::process::exit(1),
        }
        std::process::exit(0);
    }
}

fn own_program() -> Result<PathBuf> {
    std::env::current_exe().context("this program cannot find itself")
}
