//! The rubric: for each check its points, its title, its slide and three hints, read from `tests/rubric.toml`.

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

/// The whole rubric, by stage name (`stage1`, `stage2`, …).
pub static RUBRIC: LazyLock<BTreeMap<String, Stage>> = LazyLock::new(|| {
    let mut rubric: BTreeMap<String, Stage> = toml::from_str(include_str!("../../rubric.toml"))
        .unwrap_or_else(|error| panic!("tests/rubric.toml: {error}"));
    for (name, stage) in &mut rubric {
        let number = name.trim_start_matches("stage").parse().unwrap_or_default();
        stage.checks.values_mut().for_each(|entry| entry.stage = number);
    }
    rubric
});

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
