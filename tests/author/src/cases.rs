//! The catalogue of hard cases, `tests/cases.toml`: inputs, required results, and the checks or tests that cover them.

use anyhow::{Context, Result};
use raykata_cli::args::Spec;
use serde::Deserialize;
use std::path::Path;

/// `author cases`.
pub static SPEC: Spec = Spec {
    name: "author cases",
    about: "List the hard cases, and the checks that cover them.",
    arguments: &[],
    options: &[],
};

/// A hard case.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardCase {
    /// The name, with the family first.
    pub name: String,
    /// The input.
    pub input: String,
    /// The required result.
    pub required: String,
    /// The checks that cover it.
    #[serde(default)]
    pub checks: Vec<String>,
    /// The kit's own tests that cover it, by the names of their functions.
    #[serde(default)]
    pub tests: Vec<String>,
    /// Why no check and no test covers it.
    pub uncovered: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Catalogue {
    case: Vec<HardCase>,
}

/// Reads all cases, in the order of the catalogue: the first is number 1.
pub fn read(root: &Path) -> Result<Vec<HardCase>> {
    let file = root.join("tests/cases.toml");
    let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let catalogue: Catalogue = toml::from_str(&text).with_context(|| file.display().to_string())?;
    Ok(catalogue.case)
}

/// Prints all cases.
pub fn list(root: &Path) -> Result<()> {
    let cases = read(root)?;
    for (index, case) in cases.iter().enumerate() {
        println!("{:>2}  {}", index + 1, case.name);
        println!("    {} → {}", case.input, case.required);
        for name in case.checks.iter().chain(&case.tests) {
            println!("      {name}");
        }
        if let Some(reason) = &case.uncovered {
            println!("      not covered: {reason}");
        }
    }
    let uncovered = cases.iter().filter(|case| case.uncovered.is_some()).count();
    println!("\n{} cases, {uncovered} of which are not covered", cases.len());
    Ok(())
}
