//! The checks that a file of a stage decides: those that it contains, and those of the files that use it.

use anyhow::{Context, Result};
use checks::Check;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The modules of a stage's crate, with their texts.
pub(super) struct StageFiles {
    stage: u8,
    modules: Vec<(String, String)>,
}

impl StageFiles {
    /// Reads the files of a stage.
    pub fn read(root: &Path, stage: u8) -> Result<StageFiles> {
        let folder = root.join(format!("tests/checks/stage{stage}/src"));
        let mut modules = Vec::new();
        for entry in fs::read_dir(&folder).with_context(|| folder.display().to_string())? {
            let file = entry?.path();
            let text = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
            modules.push((module(&file.to_string_lossy()), text));
        }
        Ok(StageFiles { stage, modules })
    }

    /// The checks that this file decides. A file that no check uses decides all of the stage.
    pub fn decided_by(&self, file: &str) -> Result<Vec<&'static Check>> {
        let mut reached = BTreeSet::from([module(file)]);
        // Add the files that use a file which was reached, until there are no more.
        loop {
            let uses = |text: &str| reached.iter().any(|module| mentions(text, module));
            let users = self.modules.iter().filter(|(name, text)| name != "lib" && uses(text));
            let more: BTreeSet<String> = users.map(|(name, _)| name.clone()).collect();
            let before = reached.len();
            reached.extend(more);
            if reached.len() == before {
                break;
            }
        }
        let all = all_checks::of_stage(self.stage);
        // A check is where its name is: as a function, or as an argument of a macro that defines functions.
        let contains = |text: &str, check: &Check| {
            text.split(|letter: char| !letter.is_alphanumeric() && letter != '_')
                .any(|word| word == check.name)
        };
        let of_checks = self.modules.iter().filter(|(name, _)| name != "lib" && reached.contains(name));
        let texts: Vec<&str> = of_checks.map(|(_, text)| text.as_str()).collect();
        let is_decided = |check: &&Check| texts.iter().any(|text| contains(text, check));
        let decided: Vec<&Check> = all.iter().filter(is_decided).collect();
        Ok(if decided.is_empty() { all.iter().collect() } else { decided })
    }
}

/// The name of a file's module.
fn module(file: &str) -> String {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.trim_end_matches(".rs").to_owned()
}

/// Whether a text contains a path through the module: `module::`, and not `some_module::`.
fn mentions(text: &str, module: &str) -> bool {
    let path = format!("{module}::");
    text.match_indices(&path).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        !before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_')
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_module_is_mentioned_by_its_paths() {
        assert!(mentions("use super::trees::Tree;", "trees"));
        assert!(mentions("trees::built()", "trees"));
        assert!(!mentions("wide_trees::built()", "trees"));
        assert!(!mentions("let trees = 1;", "trees"));
    }

    #[test]
    fn a_file_decides_its_checks_and_those_of_its_users() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let decides = |stage: u8, file: &str, check: &str| {
            assert!(all_checks::find(stage, check).is_some(), "{check}");
            let file = format!("tests/checks/stage{stage}/src/{file}.rs");
            let decided = StageFiles::read(&root, stage).unwrap().decided_by(&file).unwrap();
            decided.iter().any(|decided| decided.name == check)
        };
        assert!(decides(1, "planes", "plane_agrees_with_double_precision"));
        assert!(!decides(1, "planes", "nearest_root_is_the_smaller_one_that_counts"));
        // Another file uses this one.
        assert!(decides(12, "trees", "flatten_is_depth_first"));
        // A macro defines this check in a file that uses another, which uses this one.
        assert!(decides(1, "sphere_mistakes", "sphere_algebraic_touches"));
        let of_all = StageFiles::read(&root, 12).unwrap().decided_by("lib.rs").unwrap();
        assert_eq!(of_all.len(), all_checks::of_stage(12).len());
    }
}
