//! Judges hostile workers that speak the protocol by themselves (tests/misbehaving/src/hostile.rs). They know the reference and
//! all public inputs. `cargo test -p grader --lib hostile -- --nocapture` prints the table of tests/grader/README.md.

use super::*;
use crate::grade::report;
use crate::grade::result::{Graded, Session};
use crate::kits::{self, Program};
use std::path::PathBuf;
use std::sync::OnceLock;

/// The workers: which checks each may pass, whether it is slow, its name, and what it does.
///
/// `All` lies about nothing that matters; after `Some` the judge only has to end, without a panic. A `slow` one keeps the judge
/// waiting at every call: it gets two checks, and runs with `CI_LONG=1` only.
const ROWS: &str = r#"
All quick honest control: the reference, by its own protocol code
AllButCosts quick learns-all-and-forges-counts learns all tables by questions, then answers as the reference with the reference's costs
AllButCosts quick learns-primitives-and-forges-counts tests all primitives, and reports one visit, or the visits of the reference
AllButCosts quick never-asks answers searches without a question
AllButCosts quick asks-of-another-query asks about queries that do not exist
AllButCosts quick asks-of-nodes-that-do-not-exist asks about nodes, primitives and cells that do not exist
AllButCosts quick asks-the-wrong-kind asks questions of other searches
AllButCosts slow asks-forever asks the same question without end
AllButCosts quick asks-with-a-million-visits reports two million visits
None quick asks-without-need asks although its request has all tables
None quick public-then-tells right for public inputs, quotes hidden ones as "not written yet"
None quick public-then-panics right for public inputs, quotes hidden ones as a panic
None quick public-then-malformed right for public inputs, quotes hidden ones as a malformed answer
None quick public-then-crashed right for public inputs, says that it crashed on hidden ones
None quick public-then-late right for public inputs, says that it was late on hidden ones
None quick public-then-another-kind right for public inputs, then answers of another function
All quick public-then-marks without a sandbox: right, and quotes public inputs once another process has seen hidden ones
None quick public-then-ends right for public inputs, ends at hidden ones
None quick public-then-writes right for public inputs, prints hidden ones and aborts
Some quick answers-in-advance eight answers per request
Some quick answers-before-the-question one answer too many, at the start
None quick no-message bytes that are no message
None slow endless-message a message without end
None slow promises-a-gigabyte the length of a message that never comes
None slow sends-60-megabytes 60 MB of words per answer
None slow byte-by-byte 20 bytes per second
None slow answers-nothing reads requests and answers nothing
None slow progress-forever reports progress without end
None quick fewer-answers no answers to a request with many queries"#;

/// The words of [`ROWS`].
fn rows() -> impl Iterator<Item = [&'static str; 4]> {
    let row = |line: &'static str| line.splitn(4, ' ').collect::<Vec<_>>().try_into().expect("four words");
    ROWS.trim().lines().map(row)
}

fn hostile() -> &'static PathBuf {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let program = Program { package: "misbehaving", name: "hostile-worker", feature: None };
        let built = kits::build(&kits::root().expect("a kit"), "a hostile worker", [program]);
        let [program] = built.expect("it builds");
        program
    })
}

/// Judges the hostile worker `name`, with this time limit per call.
fn judged(judge: &Judge, name: &str, call_patience: Duration) -> Vec<CheckResult> {
    let folder = tempfile::tempdir().expect("a folder");
    let worker = folder.path().join(name);
    std::fs::hard_link(hostile(), &worker)
        .or_else(|_| std::fs::copy(hostile(), &worker).map(drop))
        .expect("a copy");
    judge.judge(&worker, &BTreeMap::new(), false, call_patience).checks
}

#[test]
fn hostile_workers_that_speak_the_protocol_forge_no_point() {
    let root = kits::root().expect("a kit");
    let judge = |stages: &[u8]| Judge::of(&root, stages, SEED, Confinement::Full).expect("a judge");
    // Stage 1 has no tables; use the checks whose public inputs the workers know. Of stages 3 and 9, use the checks that
    // judge a cost.
    let mut of_stage_1 = judge(&[1]);
    of_stage_1.checks.truncate(4);
    let mut with_costs = judge(&[1, 3, 9]);
    with_costs.checks.retain(|put| put.counts || put.check.stage == 1);
    let mut two_checks = judge(&[1, 3]);
    two_checks.checks.retain(|put| put.counts || put.check.stage == 1);
    two_checks.checks.drain(1..two_checks.checks.len() - 1);
    let without_sandbox = Judge { confinement: Confinement::LimitsOnly, ..of_stage_1.only(|_, _| true) };
    let try_one = |row: &[&str; 4]| match row {
        [_, _, "public-then-marks", _] => try_row(row, &without_sandbox),
        [_, "slow", ..] => try_row(row, &two_checks),
        ["None", ..] => try_row(row, &of_stage_1),
        _ => try_row(row, &with_costs),
    };
    let is_long = std::env::var_os("CI_LONG").is_some();
    let rows: Vec<[&str; 4]> = rows().filter(|[_, pace, ..]| is_long || *pace != "slow").collect();
    // Most slow workers only wait, so judge all at the same time.
    let lines: Vec<String> = std::thread::scope(|scope| {
        let tried: Vec<_> = rows.iter().map(|row| scope.spawn(|| try_one(row))).collect();
        tried.into_iter().map(|row| row.join().expect("a row")).collect()
    });
    // Right answers after short waits reach no limit of a call, but that of the submission (97 times 40 ms).
    let results = judged(&judge(&[1]), "waits-a-little", Duration::from_millis(40));
    let last = results.last().expect("a check");
    assert!(last.message.contains("used up the time of the submission"), "{}", last.message);
    println!("| worker | what it does | points |\n|---|---|---|\n{}", lines.join("\n"));
}

const SEED: u64 = 0x5eed_0f7e_57ab_1e00;

/// Judges a hostile worker and tests that it passes no check that it must not pass, and that nothing that it says about hidden
/// inputs gets into a message. Returns its line of the table.
fn try_row([allowed, _, worker, what]: &[&str; 4], judge: &Judge) -> String {
    let results = judged(judge, worker, CALL_PATIENCE);
    for (prepared, result) in judge.checks.iter().zip(&results) {
        let passed = result.outcome == Outcome::Passed;
        let may_pass = match *allowed {
            "None" => false,
            "AllButCosts" => !prepared.counts,
            _ => true,
        };
        assert!(may_pass || !passed, "{worker} passes {}", result.name);
        assert!(passed || *allowed != "All", "{worker}: {}: {}", result.name, result.message);
    }
    let earned: u32 = results.iter().map(|result| result.earned).sum();
    let possible: u32 = results.iter().map(|result| result.points).sum();
    let graded = Graded { student: (*worker).into(), checks: results, ..Graded::default() };
    let session = Session { stages: vec![1, 3, 9], seed: SEED, ..Session::default() };
    let outputs = [report::gradescope(&graded, &session).to_string(), report::classroom(&graded).to_string()];
    let messages = graded.checks.iter().map(|result| &result.message);
    for text in messages.chain(&outputs) {
        assert!(!text.contains("SECRET") && !text.contains("123456"), "{worker}: {text}");
    }
    format!("| `{worker}` | {what} | {earned} of {possible} |")
}

#[test]
fn luck_with_a_process_is_noticed_and_gets_one_try_from_then_on() {
    let started = std::cell::Cell::new(0);
    let start = || {
        started.set(started.get() + 1);
        Arc::new(Worker::new(PathBuf::new(), CALL_PATIENCE))
    };
    let mut processes = Processes::new(&start, false);
    let checks: Vec<&'static Check> = STAGES[0].1.iter().take(4).collect();
    // Every second process is wrong about each check but the first.
    let mut judged = checks.iter().map(|check| {
        let is_right = |_| check.name == checks[0].name || started.get() % 2 == 0;
        let outcome = |right| if right { Outcome::Passed } else { Outcome::Wrong };
        processes.answer(check, |worker| Answered::new(outcome(is_right(worker)), "")).outcome
    });
    let passed: Vec<bool> = judged.by_ref().map(|outcome| outcome == Outcome::Passed).collect();
    // The second check failed in the first process and passed in the second. Then each check has one process.
    assert_eq!((passed, started.get()), (vec![true, true, false, true], 4));
    assert_eq!(processes.unsteady.map(|check| check.name), Some(checks[1].name));
}
