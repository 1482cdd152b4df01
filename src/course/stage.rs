//! A stage of the rubric and its checks as data, and the reader of the rubric's files.

use super::score::{Level, Score};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The rubric's entry for a check: its points and its texts.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckEntry {
    /// The number of the check's stage. It is filled in from the file.
    #[serde(skip)]
    pub stage: u8,
    /// The name of the check.
    #[serde(skip)]
    pub name: String,
    /// The line of the entry in the rubric of its stage, which gives the order of the checks.
    #[serde(skip)]
    pub place: usize,
    /// The number of points for a passed check.
    pub points: u32,
    /// Whether the check is one of [`Level::Core`]. The file may set one of these three; the default is [`Level::Deeper`].
    #[serde(default)]
    pub(super) core: bool,
    /// Whether it is one of [`Level::Elective`].
    #[serde(default)]
    pub(super) elective: bool,
    /// Whether it is one of [`Level::Bonus`]: a stage has all of its points without them.
    #[serde(default)]
    pub(super) bonus: bool,
    /// The law that the check tests, in one sentence.
    pub title: String,
    /// The slide of the lecture, to which the [page of the kit's deck](CheckEntry::taught) refers.
    pub slide: String,
    /// Three hints, from a first thought to nearly the answer.
    pub hints: [String; 3],
}

/// The rubric's entry for a stage: its title, its file and its checks.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// The name of the stage, such as `shapes`.
    pub title: String,
    /// The path of the file that students write, from the root of the repository.
    pub file: String,
    /// The checks of the stage by name, in alphabetical order; [`Stage::in_order`] has them in the order of
    /// the lecture.
    pub checks: BTreeMap<String, CheckEntry>,
    /// The counts of the reference, by name, by which the counts of students are judged. `author bars` writes them.
    #[serde(default)]
    pub bars: BTreeMap<String, f64>,
}

/// The rubric before a course changes it.
pub(crate) static PLAIN: LazyLock<BTreeMap<String, Stage>> =
    LazyLock::new(|| read(&RUBRIC_FILES).unwrap_or_else(|error| panic!("{error}")));

/// Reads the rubric from the paths and texts of its files. File number N holds the table `stageN` and no other.
fn read(files: &[(&str, &str)]) -> Result<BTreeMap<String, Stage>, String> {
    let mut stages = BTreeMap::new();
    for (number, (path, text)) in (1..).zip(files) {
        let mut file: BTreeMap<String, Stage> =
            toml::from_str(text).map_err(|error| format!("{path}: {error}"))?;
        let name = format!("stage{number}");
        let Some(mut stage) = file.remove(&name).filter(|_| file.is_empty()) else {
            return Err(format!("{path} must hold the table [{name}] and its subtables, and no other"));
        };
        let prefix = format!("[{name}.checks.");
        let heads =
            text.lines().map(|line| line.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(']')));
        let places: BTreeMap<&str, usize> =
            heads.enumerate().filter_map(|(place, check)| Some((check?, place))).collect();
        for (check, entry) in &mut stage.checks {
            (entry.stage, entry.name) = (number, check.clone());
            entry.place = places.get(check.as_str()).copied().unwrap_or(usize::MAX);
        }
        stages.insert(name, stage);
    }
    Ok(stages)
}

macro_rules! rubric_files {
    ($($number:literal)*) => {
        [$((
            concat!("tests/checks/stage", $number, "/rubric.toml"),
            include_str!(concat!("../../tests/checks/stage", $number, "/rubric.toml")),
        )),*]
    };
}

/// The path and the text of the rubric of each stage, in ascending order.
pub(super) const RUBRIC_FILES: [(&str, &str); 12] = rubric_files!(1 2 3 4 5 6 7 8 9 10 11 12);

impl Stage {
    /// The points of all checks, without bonus points.
    pub fn points(&self) -> u32 {
        self.score().points().1
    }

    /// The possible points by level, none of them earned.
    pub fn score(&self) -> Score {
        self.checks.values().map(|check| (check.level(), 0, check.points)).collect()
    }

    /// The checks of the stage with their names, in the order of the rubric, which is that of the lecture.
    pub fn in_order(&self) -> Vec<(&str, &CheckEntry)> {
        let mut checks: Vec<(&str, &CheckEntry)> =
            self.checks.iter().map(|(name, entry)| (name.as_str(), entry)).collect();
        checks.sort_by_key(|(_, entry)| entry.place);
        checks
    }
}

impl CheckEntry {
    /// What the check is for.
    pub fn level(&self) -> Level {
        match (self.core, self.elective, self.bonus) {
            (true, ..) => Level::Core,
            (_, true, _) => Level::Elective,
            (.., true) => Level::Bonus,
            _ => Level::Deeper,
        }
    }

    /// Whether a stage is complete only with this check: it has points, and they are no bonus.
    pub fn is_asked_for(&self) -> bool {
        self.points > 0 && !self.bonus
    }

    /// The points in words: `1 core point`, `4 deeper points`, `4 bonus points`.
    pub fn worth(&self) -> String {
        let s = if self.points == 1 { "" } else { "s" };
        format!("{} {} point{s}", self.points, self.level().word())
    }

    /// The two lines with which every report about the check begins: stage and title, then the slide.
    pub fn header(&self) -> String {
        let apart = match self.level() {
            Level::Core | Level::Deeper => String::new(),
            level => format!(" ({})", level.word()),
        };
        format!("stage {}{apart} · {}\n  slides: {}\n", self.stage, self.title, self.taught())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_holds_its_own_stage() {
        let stage2 = "[stage2]\ntitle = \"triangles\"\nfile = \"a.rs\"\n[stage2.checks]\n";
        assert_eq!(
            read(&[("1.toml", stage2)]).unwrap_err(),
            "1.toml must hold the table [stage1] and its subtables, and no other"
        );
        let both = stage2.replace("stage2", "stage1") + stage2;
        assert!(read(&[("1.toml", &both)]).is_err());
        assert!(read(&[("1.toml", "points = ")]).unwrap_err().starts_with("1.toml: "));
    }
}
