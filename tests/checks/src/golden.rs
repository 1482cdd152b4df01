//! Golden texts: trees, tables and counts that any correct solution prints alike, kept by insta in `tests/golden`.

use crate::broken::{Broken, Outcome};
use raykata::kit::mishap;

/// Compares `text` with the golden text `name`. `INSTA_UPDATE=always cargo test -p solutions` writes it anew.
pub fn compare(name: &str, input: &str, text: &str) -> Outcome {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../golden");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let same = mishap::catch(|| settings.bind(|| insta::assert_snapshot!(name, text)));
    if same.is_ok() {
        return Ok(());
    }
    let golden = std::fs::read_to_string(format!("{folder}/{name}.snap")).unwrap_or_default();
    let golden = golden.splitn(3, "---\n").nth(2).unwrap_or("(there is no golden text)");
    let difference = text
        .lines()
        .chain(std::iter::repeat("(the end)"))
        .zip(golden.lines().chain(std::iter::repeat("(the end)")))
        .take(text.lines().count().max(golden.lines().count()) + 1)
        .enumerate()
        .find(|(_, (yours, theirs))| yours.trim_end() != theirs.trim_end());
    let (line, (yours, theirs)) = difference.unwrap_or((0, ("", "")));
    let input = format!("{input}\nline {} of tests/golden/{name}.snap", line + 1);
    Err(Broken::told(input, yours.trim(), theirs.trim(), "the golden text"))
}
