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
        let contains = |text: &str, check: &Check| text.contains(&format!("fn {}(", check.name));
        let is_decided = |check: &&Check| {
            self.modules.iter().any(|(name, text)| reached.contains(name) && contains(text, check))
        };
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
        let check = |name: &str| all_checks::find(12, name).is_some();
        assert!(check("block_cost_counts_whole_blocks") && check("flatten_is_depth_first"));
        let modules = [
            ("splits", "use super::trees::Tree;\npub(super) fn block_cost_counts_whole_blocks("),
            ("trees", "pub struct Tree"),
            ("flat", "pub(super) fn flatten_is_depth_first("),
        ];
        let modules = modules.map(|(name, text)| (name.to_owned(), text.to_owned())).to_vec();
        let files = StageFiles { stage: 12, modules };
        let decided = |file: &str| {
            let checks = files.decided_by(file).unwrap();
            checks.iter().map(|check| check.name).collect::<Vec<_>>()
        };
        assert_eq!(decided("tests/checks/stage12/src/trees.rs"), ["block_cost_counts_whole_blocks"]);
        assert_eq!(decided("tests/checks/stage12/src/flat.rs"), ["flatten_is_depth_first"]);
        assert_eq!(decided("tests/checks/stage12/src/lib.rs").len(), all_checks::of_stage(12).len());
    }
}
