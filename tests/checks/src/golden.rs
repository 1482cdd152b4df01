//! Golden texts: trees, tables and counts that are the same for every correct solution. insta keeps them in
//! `tests/golden`.

use crate::broken::{Broken, CheckResult};
use raykata::kit::kit_error;
use std::sync::atomic::{AtomicBool, Ordering};

static SEALED: AtomicBool = AtomicBool::new(false);

/// From now on this process writes no files beside the golden texts and pictures, and environment variables do not
/// change a verdict. The grader calls this before it judges submissions.
pub fn seal() {
    SEALED.store(true, Ordering::Relaxed);
}

/// Whether [`seal`] was called.
pub(crate) fn is_sealed() -> bool {
    SEALED.load(Ordering::Relaxed)
}

/// Compares `text` with the golden text `name`. `INSTA_UPDATE=always cargo test -p solutions` writes it again.
pub fn compare(name: &str, input: &str, text: &str) -> CheckResult {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../golden");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let golden = std::fs::read_to_string(format!("{folder}/{name}.snap")).unwrap_or_default();
    let golden = golden.splitn(3, "---\n").nth(2).unwrap_or("(there is no golden text)");
    let same = match is_sealed() {
        true => golden.trim_end() == text.trim_end(),
        false => kit_error::catch(|| settings.bind(|| insta::assert_snapshot!(name, text))).is_ok(),
    };
    if same {
        return Ok(());
    }
    let difference = text
        .lines()
        .chain(std::iter::repeat("(the end)"))
        .zip(golden.lines().chain(std::iter::repeat("(the end)")))
        .take(text.lines().count().max(golden.lines().count()) + 1)
        .enumerate()
        .find(|(_, (yours, theirs))| yours.trim_end() != theirs.trim_end());
    let (line, (yours, theirs)) = difference.unwrap_or((0, ("", "")));
    let input = format!("{input}\nline {} of tests/golden/{name}.snap", line + 1);
    Err(Broken::with_texts(input, yours.trim(), theirs.trim(), "the golden text"))
}
