//! The course file: what a course changes in the kit without a change of its sources. An instructor copies
//! `tests/course.toml`, which explains all keys, and gives the copy to `grader … --course`. A hand-out contains the
//! file of its course in the place of the kit's own, which changes nothing.

mod moment;
mod points;
mod read;
pub mod rubric;
mod score;
mod stage;
#[cfg(test)]
mod tests;
mod verdict;

pub use moment::Moment;
pub use read::{parse, parse_language, stages_of};
pub use verdict::Verdict;

use score::Level;
use serde::Serialize;
use stage::{CheckEntry, Stage};
use std::collections::BTreeMap;

/// What a course changes in the kit. The default changes nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Course {
    /// The title of the course; empty if it has none.
    pub title: String,
    /// The numbers of the stages that students are asked for, in ascending order; empty for all stages.
    pub stages: Vec<u8>,
    /// Whether only the core counts: deeper and elective checks have no points, unless the file gives them some.
    pub core_only: bool,
    /// The name of the file with the texts in another language, beside the course file.
    pub language: Option<String>,
    /// The changes of each stage, by its name in the rubric.
    pub changes: BTreeMap<String, StageChange>,
    /// When each stage is due. Grades do not depend on it: reports mark what was handed in later.
    #[serde(skip)]
    pub due: BTreeMap<u8, Moment>,
    /// Texts of the start page, by the keys of [`TEXTS`].
    pub texts: BTreeMap<String, String>,
}

/// What a course or a language changes in a stage. What is `None` stays as it is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StageChange {
    /// Another title.
    pub title: Option<String>,
    /// The points of the whole stage, which are divided among its checks in proportion to their points. Bonus points, which
    /// count apart, stay as they are.
    pub points: Option<u32>,
    /// The changes of each check, by its name.
    pub checks: BTreeMap<String, CheckChange>,
}

/// What a course or a language changes in a check. What is `None` stays as it is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CheckChange {
    /// Other points.
    pub points: Option<u32>,
    /// Another title.
    pub title: Option<String>,
    /// Another lecture and slide.
    pub slide: Option<String>,
    /// Other hints.
    pub hints: [Option<String>; 3],
}

/// The texts of the start page that a language file may translate, with their keys.
pub const TEXTS: [(&str, &str); 8] = [
    (
        "welcome",
        "Welcome. You build a ray tracer: you write its functions in exercises/src, one\nat a time. A check passes for each \
         law of light and geometry that they obey.\nIts points count as core or as deeper. Nothing is written yet.",
    ),
    // Only where the course has all stages.
    (
        "weeks",
        "The core of stages 1 to 6 is a course of four weeks, all stages are one of\ntwelve (README.md).",
    ),
    ("due", "due"),
    ("next", "Next"),
    ("slides", "slides"),
    ("run_it", "run it"),
    ("a_hint", "a hint"),
    ("after_each_save", "all the time, after each save"),
];

impl Course {
    /// The text of the start page for a key of [`TEXTS`], in the language of the course.
    pub fn text(&self, key: &str) -> &str {
        let english = || TEXTS.iter().find(|(known, _)| *known == key).map_or("", |(_, text)| text);
        self.texts.get(key).map_or_else(english, String::as_str)
    }

    /// Whether the course file leaves out a stage.
    pub fn leaves_out(&self, stage: u8) -> bool {
        !self.stages.is_empty() && !self.stages.contains(&stage)
    }

    /// Whether a check of this level counts in the course.
    fn counts(&self, check: &CheckEntry) -> bool {
        !self.core_only || matches!(check.level(), Level::Core | Level::Bonus)
    }

    /// Adds the texts of a language. Where the course file has a text of its own, it stays.
    pub fn translate(&mut self, language: Course) {
        for (name, theirs) in language.changes {
            let stage = self.changes.entry(name).or_default();
            stage.title = stage.title.take().or(theirs.title);
            for (name, theirs) in theirs.checks {
                let check = stage.checks.entry(name).or_default();
                check.title = check.title.take().or(theirs.title);
                check.slide = check.slide.take().or(theirs.slide);
                for (hint, theirs) in check.hints.iter_mut().zip(theirs.hints) {
                    *hint = hint.take().or(theirs);
                }
            }
        }
        for (key, text) in language.texts {
            self.texts.entry(key).or_insert(text);
        }
    }

    /// Changes the rubric as the course asks.
    pub(crate) fn apply(&self, stages: &mut BTreeMap<String, Stage>) {
        let checks = stages.values_mut().flat_map(|stage| stage.checks.values_mut());
        checks.filter(|check| !self.counts(check)).for_each(|check| check.points = 0);
        for (name, change) in &self.changes {
            let Some(stage) = stages.get_mut(name) else { continue };
            replace(&mut stage.title, &change.title);
            for (name, change) in &change.checks {
                let Some(check) = stage.checks.get_mut(name) else { continue };
                check.points = change.points.unwrap_or(check.points);
                replace(&mut check.title, &change.title);
                replace(&mut check.slide, &change.slide);
                check.hints.iter_mut().zip(&change.hints).for_each(|(hint, change)| replace(hint, change));
            }
            if let Some(points) = change.points {
                // The order of the rubric decides between equal checks.
                let mut checks: Vec<_> =
                    stage.checks.values_mut().filter(|check| check.level() != Level::Bonus).collect();
                checks.sort_by_key(|check| check.place);
                let weights: Vec<u32> = checks.iter().map(|check| check.points).collect();
                for (check, points) in checks.into_iter().zip(points::divide(points, &weights)) {
                    check.points = points;
                }
            }
        }
    }
}

fn replace(text: &mut String, change: &Option<String>) {
    if let Some(change) = change {
        text.clone_from(change);
    }
}
