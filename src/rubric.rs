//! The rubric: for each check its points, its title, its slide and three hints, read from `tests/rubric.toml`. It is here so
//! that `raykata list` and `raykata hint` need not build the checks.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// What the rubric says of a check.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its stage; filled in from the table it stands in.
    #[serde(skip)]
    pub stage: u8,
    /// Where in the rubric it stands; filled in from its text.
    #[serde(skip)]
    pub place: usize,
    /// What it is worth.
    pub points: u32,
    /// The law in one sentence.
    pub title: String,
    /// Where to read it up.
    pub slide: String,
    /// From a nudge to nearly the answer.
    pub hints: [String; 3],
    /// Whether students see the inputs.
    #[serde(default)]
    pub visibility: Visibility,
}

/// What students see of a check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// Everything.
    #[default]
    Visible,
    /// That it exists and whether it passes.
    Hidden,
}

/// What the rubric says of a stage.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Its name.
    pub title: String,
    /// The file to work in.
    pub file: String,
    /// Its checks.
    pub checks: BTreeMap<String, Entry>,
}

const TEXT: &str = include_str!("../tests/rubric.toml");

/// The whole rubric, by stage name (`stage1`, `stage2`, …).
pub static RUBRIC: LazyLock<BTreeMap<String, Stage>> = LazyLock::new(|| {
    let mut rubric: BTreeMap<String, Stage> =
        toml::from_str(TEXT).unwrap_or_else(|error| panic!("tests/rubric.toml: {error}"));
    for (name, stage) in &mut rubric {
        let number = name.trim_start_matches("stage").parse().unwrap_or_default();
        for (check, entry) in &mut stage.checks {
            entry.stage = number;
            entry.place = TEXT.find(&format!("[{name}.checks.{check}]")).unwrap_or(usize::MAX);
        }
    }
    rubric
});

/// The stages with their numbers, in order.
pub fn stages() -> Vec<(u8, &'static Stage)> {
    let number = |name: &str| name.trim_start_matches("stage").parse().ok();
    let mut stages: Vec<(u8, &Stage)> =
        RUBRIC.iter().filter_map(|(name, stage)| Some((number(name)?, stage))).collect();
    stages.sort_by_key(|(number, _)| *number);
    stages
}

impl Stage {
    /// The checks with their names, in the order of the rubric, which is that of the lecture.
    pub fn in_order(&self) -> Vec<(&str, &Entry)> {
        let mut checks: Vec<(&str, &Entry)> =
            self.checks.iter().map(|(name, entry)| (name.as_str(), entry)).collect();
        checks.sort_by_key(|(_, entry)| entry.place);
        checks
    }
}

impl Entry {
    /// The first line of every message about the check.
    pub fn header(&self) -> String {
        format!("stage {} · {}\n  slides: {}\n", self.stage, self.title, self.slide)
    }
}

/// The entry of a check. A check that the rubric forgot, which the kit's own tests catch, gets a bare one.
pub fn entry(stage: u8, check: &str) -> Entry {
    RUBRIC
        .get(&format!("stage{stage}"))
        .and_then(|stage| stage.checks.get(check))
        .cloned()
        .unwrap_or_else(|| Entry { stage, points: 1, title: check.replace('_', " "), ..Entry::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_and_checks_have_the_order_of_the_lecture() {
        let numbers: Vec<u8> = stages().into_iter().map(|(number, _)| number).collect();
        assert_eq!(numbers, (1..=10).collect::<Vec<_>>());
        for (number, stage) in stages() {
            let checks = stage.in_order();
            assert!(checks.iter().all(|(_, entry)| entry.stage == number && entry.place < TEXT.len()));
            assert!(checks.is_sorted_by_key(|(_, entry)| entry.place));
        }
    }
}
