//! Judges hostile workers that speak the protocol by themselves (tests/misbehaving/src/hostile.rs). They know the reference and
//! all public inputs. `cargo test -p grader --lib hostile -- --nocapture` prints the table of tests/grader/README.md.

use super::*;
use crate::grade::report;
use crate::grade::result::{Graded, Session};
use crate::kits::{self, Program};
use std::path::PathBuf;
use std::sync::OnceLock;

/// A hostile worker and the points that it may get.
struct Row {
    name: &'static str,
    what: &'static str,
    allowed: Allowed,
}

/// The checks that a hostile worker may pass.
enum Allowed {
    /// None.
    None,
    /// All but those that judge a cost.
    AllButCosts,
    /// All: it lies about nothing that matters.
    All,
    /// Some; the judge only has to end, without a panic.
    Some,
}

const ROWS: &[Row] = &[
    Row { name: "honest", what: "control: the reference, by its own protocol code", allowed: Allowed::All },
    Row {
        name: "learns-all-and-forges-counts",
        what: "learns all tables by questions, then answers as the reference with the reference's costs",
        allowed: Allowed::AllButCosts,
    },
    Row {
        name: "learns-primitives-and-forges-counts",
        what: "tests all primitives, and reports one visit, or the visits of the reference",
        allowed: Allowed::AllButCosts,
    },
    Row { name: "never-asks", what: "answers searches without a question", allowed: Allowed::AllButCosts },
    Row {
        name: "asks-of-another-query",
        what: "asks about queries that do not exist",
        allowed: Allowed::AllButCosts,
    },
    Row {
        name: "asks-of-nodes-that-do-not-exist",
        what: "asks about nodes, primitives and cells that do not exist",
        allowed: Allowed::AllButCosts,
    },
    Row {
        name: "asks-the-wrong-kind",
        what: "asks questions of other searches",
        allowed: Allowed::AllButCosts,
    },
    Row { name: "asks-forever", what: "asks the same question without end", allowed: Allowed::AllButCosts },
    Row {
        name: "asks-with-a-million-visits",
        what: "reports two million visits",
        allowed: Allowed::AllButCosts,
    },
    Row {
        name: "asks-without-need",
        what: "asks although its request has all tables",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-tells",
        what: "right for public inputs, quotes hidden ones as \"not written yet\"",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-panics",
        what: "right for public inputs, quotes hidden ones as a panic",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-malformed",
        what: "right for public inputs, quotes hidden ones as a malformed answer",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-crashed",
        what: "right for public inputs, says that it crashed on hidden ones",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-late",
        what: "right for public inputs, says that it was late on hidden ones",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-another-kind",
        what: "right for public inputs, then answers of another function",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-ends",
        what: "right for public inputs, ends at hidden ones",
        allowed: Allowed::None,
    },
    Row {
        name: "public-then-writes",
        what: "right for public inputs, prints hidden ones and aborts",
        allowed: Allowed::None,
    },
    Row { name: "answers-in-advance", what: "eight answers per request", allowed: Allowed::Some },
    Row {
        name: "answers-before-the-question",
        what: "one answer too many, at the start",
        allowed: Allowed::Some,
    },
    Row { name: "no-message", what: "bytes that are no message", allowed: Allowed::None },
    Row { name: "endless-message", what: "a message without end", allowed: Allowed::None },
    Row {
        name: "promises-a-gigabyte",
        what: "the length of a message that never comes",
        allowed: Allowed::None,
    },
    Row { name: "sends-60-megabytes", what: "60 MB of words per answer", allowed: Allowed::None },
    Row { name: "byte-by-byte", what: "20 bytes per second", allowed: Allowed::None },
    Row { name: "answers-nothing", what: "reads requests and answers nothing", allowed: Allowed::None },
    Row { name: "progress-forever", what: "reports progress without end", allowed: Allowed::None },
    Row { name: "fewer-answers", what: "no answers to a request with many queries", allowed: Allowed::None },
];

fn hostile() -> &'static PathBuf {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let program = Program { package: "misbehaving", name: "hostile-worker", feature: None };
        let built = kits::build(&kits::root().expect("a kit"), "a hostile worker", &[program]);
        built.expect("it builds").remove(0)
    })
}

/// Judges the hostile worker `name` with the checks of these stages.
fn judged(judge: &Judge, name: &str) -> Vec<CheckResult> {
    let folder = tempfile::tempdir().expect("a folder");
    let worker = folder.path().join(name);
    std::fs::hard_link(hostile(), &worker)
        .or_else(|_| std::fs::copy(hostile(), &worker).map(drop))
        .expect("a copy");
    judge.judge(&worker, &BTreeMap::new(), false).0
}

/// Rows whose worker keeps the judge waiting at every call. They get two checks, and run with `CI_LONG=1` only.
const SLOW: [&str; 7] = [
    "answers-nothing",
    "sends-60-megabytes",
    "asks-forever",
    "endless-message",
    "promises-a-gigabyte",
    "byte-by-byte",
    "progress-forever",
];

#[test]
fn hostile_workers_that_speak_the_protocol_forge_no_point() {
    let root = kits::root().expect("a kit");
    let judge = |stages: &[u8]| Judge::of(&root, stages, SEED, Confinement::Full).expect("a judge");
    // Stage 1 has no tables; its first checks are enough. Of stages 3 and 9, use the checks that judge a cost.
    let mut of_stage_1 = judge(&[1]);
    of_stage_1.checks.truncate(4);
    let mut both = judge(&[1, 3, 9]);
    both.checks.retain(|put| put.counts || put.check.stage == 1);
    let mut few = judge(&[1, 3]);
    few.checks.retain(|put| put.counts || put.check.stage == 1);
    few.checks.drain(1..few.checks.len() - 1);
    let judge_for = |row: &Row| match row.allowed {
        _ if SLOW.contains(&row.name) => &few,
        // The worker generates the public inputs of stage 1 to compare requests with them.
        Allowed::None => &of_stage_1,
        _ => &both,
    };
    // Most slow rows only wait, so judge them at the same time.
    let lines = std::thread::scope(|scope| {
        let rows = ROWS.iter().map(|row| (row, judge_for(row)));
        let (slow, fast): (Vec<_>, Vec<_>) = rows.partition(|(row, _)| SLOW.contains(&row.name));
        let is_long = std::env::var_os("CI_LONG").is_some();
        let slow = slow.into_iter().filter(|_| is_long);
        let waiting: Vec<_> =
            slow.into_iter().map(|(row, judge)| scope.spawn(|| try_row(row, judge))).collect();
        let mut lines: Vec<String> = fast.into_iter().map(|(row, judge)| try_row(row, judge)).collect();
        lines.extend(waiting.into_iter().map(|thread| thread.join().expect("a row")));
        lines
    });
    println!("| worker | what it does | points |\n|---|---|---|\n{}", lines.join("\n"));
}

const SEED: u64 = 0x5eed_0f7e_57ab_1e00;

#[test]
fn every_function_has_a_check_with_hidden_inputs() {
    let root = kits::root().expect("a kit");
    let stages: Vec<u8> = STAGES.iter().map(|(stage, _)| *stage).collect();
    let judge = Judge::of(&root, &stages, SEED, Confinement::Full).expect("a judge");
    let varied: HashSet<_> =
        judge.checks.iter().filter(|put| put.varies).flat_map(|put| put.asks.iter().copied()).collect();
    for put in &judge.checks {
        let open: Vec<_> = put.asks.difference(&varied).collect();
        assert!(open.is_empty(), "{}: no check with hidden inputs asks {open:?}", put.check.name);
    }
    let fixed: Vec<&Put> = judge.checks.iter().filter(|put| !put.varies).collect();
    let points = |puts: &[&Put]| -> u32 {
        puts.iter().map(|put| rubric::entry(put.check.stage, put.check.name).points).sum()
    };
    let all: Vec<&Put> = judge.checks.iter().collect();
    println!(
        "{} of {} checks have fixed inputs: {} of {} points",
        fixed.len(),
        all.len(),
        points(&fixed),
        points(&all)
    );
    for stage in &stages {
        let of_stage: Vec<&Put> = fixed.iter().copied().filter(|put| put.check.stage == *stage).collect();
        println!("stage {stage}: {} checks, {} points", of_stage.len(), points(&of_stage));
    }
}

/// Judges a hostile worker and tests that it passes no check that it must not pass, and that nothing that it says about hidden
/// inputs gets into a message. Returns its line of the table.
fn try_row(row: &Row, judge: &Judge) -> String {
    let results = judged(judge, row.name);
    for (put, result) in judge.checks.iter().zip(&results) {
        let passed = result.outcome == Outcome::Passed;
        let may_pass = match row.allowed {
            Allowed::None => false,
            Allowed::AllButCosts => !put.counts,
            Allowed::All | Allowed::Some => true,
        };
        assert!(may_pass || !passed, "{} passes {}", row.name, result.name);
        let must_pass = matches!(row.allowed, Allowed::All);
        assert!(passed || !must_pass, "{}: {}: {}", row.name, result.name, result.message);
    }
    let earned: u32 = results.iter().map(|result| result.earned).sum();
    let possible: u32 = results.iter().map(|result| result.points).sum();
    let graded = Graded {
        student: row.name.into(),
        content: String::new(),
        checks: results,
        remarks: Vec::new(),
        compiler: String::new(),
        trouble: String::new(),
        cpu_ms: 0,
    };
    let session = Session { kit: String::new(), stages: vec![1, 3, 9], seed: SEED, isolation: String::new() };
    let outputs = [
        report::gradescope(&graded, &session).to_string(),
        report::classroom(&graded).to_string(),
        report::classroom_output(&graded),
    ];
    let messages = graded.checks.iter().map(|result| &result.message);
    for text in messages.chain(&outputs) {
        assert!(!text.contains("SECRET") && !text.contains("123456"), "{}: {text}", row.name);
    }
    format!("| `{}` | {} | {earned} of {possible} |", row.name, row.what)
}
