//! Grades all submissions of a folder, several at the same time.

use super::judge::{Judge, Judgement};
use super::once::Once;
use super::report::clean::{clean, clean_line};
use super::result::{CheckResult, Graded, Outcome, Remark};
use super::scratch;
use super::store::Store;
use super::submission::{self, Submission, SubmittedFiles};
use super::worker_builder::WorkerBuilder;
use crate::course::HandedIn;
use crate::exercises::stage_of;
use crate::queue;
use crate::room::has_room;
use crate::sandbox::{self, Confinement, How, Purpose, Sandbox};
use anyhow::{Context, Result};
use judge::lint::{self, Finding, Reading};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Time limit of the syntax check. It reads tokens and needs a few milliseconds for the longest file.
const LINT_PATIENCE: Duration = Duration::from_secs(10);

/// What to do if the disk of the temporary folders is full.
const MAKE_ROOM: &str = "delete something, or set TMPDIR to a folder on another disk";

/// Everything that grading a submission needs.
pub struct Grader {
    /// Makes workers.
    pub builder: Arc<WorkerBuilder>,
    /// Runs the checks against them.
    pub judge: Arc<Judge>,
    /// The sandbox around a submission.
    pub confinement: Confinement,
    /// Rules of the syntax check that do not apply.
    pub allowed: Vec<String>,
    /// When submissions were handed in, as far as it is known.
    pub handed_in: HandedIn,
    /// Time limit per call of a worker, in processor time.
    pub call_patience: Duration,
    /// The results of files that were judged before, if equal files need not be judged again.
    pub shared: Option<Arc<SharedResults>>,
}

/// The results of submissions, by the judge's checks, the rules that are switched off, and the files.
pub type SharedResults = Once<(Vec<&'static str>, Vec<String>, BTreeMap<String, String>), Judged>;

/// What compiling and judging the files of a submission gives.
#[derive(Clone)]
pub struct Judged {
    checks: Vec<CheckResult>,
    remarks: Vec<Remark>,
    /// The compiler's messages.
    compiler: String,
    cpu: Duration,
}

/// Most findings that are reported per file. More of them would not help a student.
const MOST_FINDINGS: usize = 10;

/// Most bytes of compiler messages that are kept, for all files together.
const MOST_FROM_COMPILER: usize = 16 * 1024;

/// Files that were left out of the build, with the outcome of their checks and the reason.
type Lost = BTreeMap<String, (Outcome, String)>;

/// The result of the syntax check of a submission.
struct Read {
    /// The files that contain constructs that no exercise needs.
    refused: Lost,
    /// The files to which no rule could be applied.
    unreadable: Vec<String>,
    /// Whether an answer may depend on earlier questions.
    may_remember: bool,
}

impl Grader {
    /// Grades all submissions that `store` does not know yet, on `jobs` threads. Calls `done` after each.
    pub fn grade_all(
        &self,
        submissions: &[Submission],
        store: &Store,
        jobs: usize,
        done: impl Fn(&Graded) + Sync,
    ) -> Result<()> {
        let grade = |_: &(), submission: &Submission| {
            let taken = self.take(&submission.path);
            let handed_in = self.handed_in.get(&submission.student).map(ToString::to_string);
            let known = store.known(&submission.student, &taken.content())?;
            // A stage that was dropped for a while is missing in newer grades.
            let has_all =
                |known: &Graded| self.judge.stages().iter().all(|stage| known.stages().contains(stage));
            if let Some(mut known) = known.filter(has_all) {
                if let Some(handed_in) = handed_in.filter(|time| *time != known.handed_in) {
                    known.handed_in = handed_in;
                    store.keep(&known)?;
                }
                done(&known);
                return Ok(());
            }
            let empty = self.graded(&submission.student, &taken);
            let mut graded =
                self.grade(&submission.student, taken).unwrap_or_else(|error| self.broken(empty, &error));
            graded.handed_in = handed_in.unwrap_or_default();
            store.keep(&graded)?;
            done(&graded);
            Ok(())
        };
        queue::run(&vec![(); jobs], submissions, grade).map(drop)
    }

    /// Reads the stage files of a submission.
    pub fn take(&self, path: &Path) -> SubmittedFiles {
        let exercises = self.builder.exercises();
        let graded = self.judge.stages();
        let of_stages = |name: &&String| stage_of(name).is_some_and(|stage| graded.contains(&stage));
        let expected: Vec<String> = exercises.iter().filter(of_stages).cloned().collect();
        submission::take(path, &exercises, &expected)
    }

    /// Grades the files of a submission. Returns an error only if the grader itself fails.
    pub fn grade(&self, student: &str, taken: SubmittedFiles) -> Result<Graded> {
        let mut graded = self.graded(student, &taken);
        let SubmittedFiles { files, mut remarks, .. } = taken;
        if !graded.trouble.is_empty() {
            graded.checks = self.judge.all(Outcome::NotWritten, "no file of the submission could be read");
            graded.remarks = remarks.into_iter().map(cleaned).collect();
            return Ok(graded);
        }
        let judged = match &self.shared {
            None => self.judged(files)?,
            Some(shared) => {
                let key = (self.judge.checks(), self.allowed.clone(), files.clone());
                shared.get(key, || self.judged(files))?
            }
        };
        remarks.extend(judged.remarks);
        graded.checks = judged.checks;
        graded.compiler = judged.compiler;
        graded.cpu_ms = judged.cpu.as_millis() as u64;
        graded.remarks = remarks.into_iter().map(cleaned).collect();
        Ok(graded)
    }

    /// Compiles and judges these files.
    fn judged(&self, files: BTreeMap<String, String>) -> Result<Judged> {
        let mut remarks = Vec::new();
        // Compile in a temporary folder outside of the kit and of the submission.
        let scratch = scratch::folder()?;
        has_room(scratch.path(), MAKE_ROOM)?;
        // Leave out the files that the syntax check refuses, and build the others.
        let Read { mut refused, unreadable, may_remember } = self.read(&files, &mut remarks)?;
        let build = |refused: &Lost| {
            let mut kept = files.clone();
            kept.retain(|name, _| !refused.contains_key(name));
            self.builder.build(scratch.path(), &kept)
        };
        let mut built = build(&refused);
        // The compiler explains a file that is not Rust. What it compiles unread may contain anything.
        let compiles = |name: &String| built.as_ref().is_ok_and(|built| !built.replaced.contains_key(name));
        let unread: Vec<String> = unreadable.into_iter().filter(compiles).collect();
        for name in &unread {
            let why = format!(
                "{name}:1: the syntax check cannot read this file: is there a first line with `#!`? Remove it [nesting]"
            );
            refuse(name, &why, &mut refused, &mut remarks);
        }
        if !unread.is_empty() {
            built = build(&refused);
        }
        // Blame no file for a disk that has become full.
        if built.as_ref().map_or(true, |built| !built.replaced.is_empty()) {
            has_room(scratch.path(), MAKE_ROOM)?;
        }
        let built = built?;
        // Report the files that do not compile.
        let mut compiler = String::new();
        for (name, (_, messages)) in &built.replaced {
            let what =
                "does not compile; the empty exercise replaces it, so that the other files can be graded";
            remarks.push(Remark { file: name.clone(), what: what.into() });
            compiler += messages;
        }
        // Run the checks.
        let lost: Lost = refused.into_iter().chain(built.replaced).collect();
        let Judgement { checks, unsteady, spent } =
            self.judge.judge(&built.worker, &lost, may_remember, self.call_patience);
        if let Some(check) = unsteady {
            let is_of_stage = |file: &&String| stage_of(file) == Some(check.stage);
            let what = format!(
                "answers differently in each process: {} failed in one and passed in another, so from there on each \
                 check had a process of its own and one try; let each answer depend on its arguments alone",
                check.name
            );
            let file = self.builder.exercises().iter().find(is_of_stage).cloned().unwrap_or_default();
            remarks.push(Remark { file, what });
        }
        Ok(Judged { checks, remarks, compiler: clean(&compiler, MOST_FROM_COMPILER), cpu: built.cpu + spent })
    }

    /// Returns a grade without checks, to be filled in.
    fn graded(&self, student: &str, taken: &SubmittedFiles) -> Graded {
        Graded {
            student: student.into(),
            content: taken.content(),
            trouble: taken.trouble.clone().unwrap_or_default(),
            ..Graded::default()
        }
    }

    /// Returns the grade of a submission on which grading itself failed. Grading continues with the class, and the next run
    /// tries this submission again.
    fn broken(&self, mut graded: Graded, error: &anyhow::Error) -> Graded {
        graded.content.clear();
        graded.trouble = format!("could not be graded: {error:#}");
        graded.checks = self
            .judge
            .all(Outcome::NotTried, "grading itself failed; the instructor's report has the reason");
        graded
    }

    /// Runs the syntax check on the files, each in a sandbox: a file that attacks the compiler may also attack the check.
    fn read(&self, files: &BTreeMap<String, String>, remarks: &mut Vec<Remark>) -> Result<Read> {
        let (mut lost, mut unreadable) = (Lost::new(), Vec::new());
        // Code that is allowed by `--allow` may store data in ways that the syntax check does not know.
        let mut may_remember = !self.allowed.is_empty();
        for (name, text) in files.iter().filter(|(name, text)| !self.builder.is_untouched(name, text)) {
            let reading = self.reading(text)?.unwrap_or_else(|| {
                let why = "the syntax check failed: the code is nested too deeply".to_owned();
                let broke = Finding { rule: "nesting".into(), line: 1, why };
                Reading { is_unreadable: false, findings: vec![broke], may_remember: true }
            });
            may_remember |= reading.may_remember;
            unreadable.extend(reading.is_unreadable.then(|| name.clone()));
            // Drop the findings of rules that are switched off.
            let findings = reading.findings.iter().filter(|finding| !self.allowed.contains(&finding.rule));
            let findings: Vec<&Finding> = findings.collect();
            may_remember |= !findings.is_empty();
            // Refuse the file unless the sandbox stops all that was found.
            if findings.iter().any(|finding| !finding.is_left_to_sandbox()) {
                refuse(name, &in_words(name, &findings), &mut lost, remarks);
            } else if !findings.is_empty() {
                let what = "is graded, but a function fails that reaches one of these lines:\n".to_owned();
                remarks.push(Remark { file: name.clone(), what: what + &in_words(name, &findings) });
            }
        }
        Ok(Read { refused: lost, unreadable, may_remember })
    }

    /// Runs the syntax check on one file. Returns `None` if the check crashed.
    fn reading(&self, text: &str) -> Result<Option<Reading>> {
        let program = std::env::current_exe().context("the path of this program is unknown")?;
        let mut command = Sandbox::with(self.confinement, Purpose::Reader).command(&program);
        command.arg(LINT_WORD);
        let ended = sandbox::run(command, text.as_bytes(), LINT_PATIENCE, 4 << 20)
            .context("the syntax check cannot be started")?;
        if ended.how != How::Exited(0) {
            return Ok(None);
        }
        Ok(Some(serde_json::from_slice(&ended.stdout).context("the syntax check gave no answer")?))
    }
}

/// The first findings about a file, one per line.
fn in_words(name: &str, findings: &[&Finding]) -> String {
    let lines = findings.iter().take(MOST_FINDINGS);
    let lines = lines.map(|finding| format!("{name}:{}: {} [{}]", finding.line, finding.why, finding.rule));
    let more = findings.len().saturating_sub(MOST_FINDINGS);
    lines.chain((more > 0).then(|| format!("and {more} more"))).collect::<Vec<_>>().join("\n")
}

/// Leaves a file out of the build because of these findings.
fn refuse(name: &str, findings: &str, lost: &mut Lost, remarks: &mut Vec<Remark>) {
    remarks.push(Remark { file: name.into(), what: format!("was refused:\n{findings}") });
    lost.insert(name.into(), (Outcome::Refused, format!("refused:\n{findings}")));
}

/// Returns the remark without control characters, which a file name may contain.
fn cleaned(remark: Remark) -> Remark {
    Remark { file: clean_line(&remark.file, 256), what: clean(&remark.what, 4096) }
}

/// The first argument that makes the program run the syntax check on its standard input.
const LINT_WORD: &str = "__syntax";

/// Runs the syntax check if this process was started for it. Call this at the start of `main`.
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
