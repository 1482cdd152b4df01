//! `author bars`: measures what the reference needs, and writes it into the rubric.

use anyhow::{Context, Result, bail};
use grader::kits::{Need, Source, Which, root};
use grader::report::write_file;
use raykata::rubric::RUBRIC;
use raykata_cli::args::{Given, Opt, Spec};
use std::fmt::Write as _;
use std::fs;

/// `author bars`.
pub static SPEC: Spec = Spec {
    name: "author bars",
    about: "Write what the reference needs into the rubric of stage 12, by which counts are judged.",
    arguments: &[],
    options: &[&[Opt::flag("--check", "Only report differences, and write nothing.")]],
};

const FILE: &str = "tests/checks/stage12/rubric.toml";
const TABLE: &str = "[stage12.bars]\n";

/// Measures the bars and writes them.
pub fn run(given: &Given) -> Result<bool> {
    let root = root()?;
    let reference = Source::prepare(&root, Which::Solutions, Need::Checks)?.fresh();
    let measured = stage12_checks::bars::measured(&*reference);
    // Name what changed.
    let known = RUBRIC.get("stage12").map(|stage| stage.bars.clone()).unwrap_or_default();
    let mut lines = String::new();
    for (name, bar) in &measured {
        match known.get(name) {
            Some(old) if old == bar => {}
            Some(old) => println!("{name}: {old} becomes {bar}"),
            None => println!("{name}: {bar} is new"),
        }
        writeln!(lines, "{name:?} = {bar:?}")?;
    }
    let path = root.join(FILE);
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    // Replace the lines of the table.
    let (before, rest) =
        text.split_once(TABLE).with_context(|| format!("{FILE} has no table {}", TABLE.trim_end()))?;
    let after = rest.find("\n[").map_or("", |end| &rest[end..]);
    let new = format!("{before}{TABLE}{lines}{after}");
    match (new == text, given.has("--check")) {
        (true, _) => println!("the bars in {FILE} are those of the reference"),
        (false, true) => {
            bail!("the bars in {FILE} are not those of the reference; `author bars` writes them")
        }
        (false, false) => {
            write_file(&path, new.as_bytes())?;
            println!("wrote {FILE}");
        }
    }
    Ok(true)
}
