//! Verifies that the rubric and the lists of checks agree.

use crate::STAGES;
use checks::rubric::{CheckEntry, RUBRIC};

/// The differences between the rubric and the lists of checks, one sentence each.
pub fn differences() -> Vec<String> {
    let mut differences = Vec::new();
    for (number, checks) in STAGES {
        let Some(stage) = RUBRIC.get(&format!("stage{number}")) else {
            differences.push(format!("the rubric has no stage {number}"));
            continue;
        };
        for check in *checks {
            match stage.checks.get(check.name) {
                None => differences.push(format!("the rubric lacks `{}` of stage {number}", check.name)),
                Some(entry) => differences.extend(faults(entry, check.name)),
            }
        }
        let order = stage.in_order().into_iter().map(|(name, _)| name);
        if !order.eq(checks.iter().map(|check| check.name)) {
            differences.push(format!("the rubric has the checks of stage {number} in another order"));
        }
        for name in stage.checks.keys() {
            if !checks.iter().any(|check| check.name == name) {
                differences
                    .push(format!("the rubric has `{name}` in stage {number}, but there is no such check"));
            }
        }
    }
    differences
}

fn faults(entry: &CheckEntry, name: &str) -> Vec<String> {
    let empty =
        [&entry.title, &entry.slide].into_iter().chain(&entry.hints).any(|text| text.trim().is_empty());
    let mut faults = Vec::new();
    if empty {
        faults.push(format!("`{name}` lacks a title, a slide or a hint"));
    }
    if entry.points == 0 {
        faults.push(format!("`{name}` has 0 points"));
    }
    faults
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_rubric_and_the_checks_are_the_same_list() {
        assert_eq!(super::differences(), Vec::<String>::new());
    }
}
