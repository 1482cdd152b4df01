//! The points of some checks, by level.

use serde::{Deserialize, Serialize};
use std::fmt;

/// What a check is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// A first course wants it: the slides and the ideas of the doc comments lead to it.
    Core,
    /// It tests what is stable, extreme or invalid.
    #[default]
    Deeper,
    /// It belongs to a part of its stage that a course may leave out. Its points count as deeper ones.
    Elective,
    /// Its points count apart.
    Bonus,
}

impl Level {
    /// The level in one word.
    pub fn word(self) -> &'static str {
        match self {
            Level::Core => "core",
            Level::Deeper => "deeper",
            Level::Elective => "elective",
            Level::Bonus => "bonus",
        }
    }
}

/// The earned and the possible points of some checks, by level. As text: `35 of 35 core · 12 deeper`, with ` · 4 bonus` if any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Score {
    /// Of [`Level::Core`].
    pub core: (u32, u32),
    /// Of [`Level::Deeper`] and [`Level::Elective`].
    pub deeper: (u32, u32),
    /// Of [`Level::Bonus`]. They are not in [`points`](Score::points).
    pub bonus: (u32, u32),
}

impl Score {
    /// The earned and the possible points, without bonus points.
    pub fn points(&self) -> (u32, u32) {
        (self.core.0 + self.deeper.0, self.core.1 + self.deeper.1)
    }
}

/// Adds up checks: the level of each, its earned and its possible points.
impl FromIterator<(Level, u32, u32)> for Score {
    fn from_iter<I: IntoIterator<Item = (Level, u32, u32)>>(checks: I) -> Self {
        let mut score = Score::default();
        for (level, earned, of) in checks {
            let sum = match level {
                Level::Core => &mut score.core,
                Level::Deeper | Level::Elective => &mut score.deeper,
                Level::Bonus => &mut score.bonus,
            };
            *sum = (sum.0 + earned, sum.1 + of);
        }
        score
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Score { core, deeper, bonus } = self;
        match (core.1, deeper.1) {
            (0, of) => write!(f, "{} of {of} points", deeper.0)?,
            (of, 0) => write!(f, "{} of {of} core", core.0)?,
            (of, _) => write!(f, "{} of {of} core · {} deeper", core.0, deeper.0)?,
        }
        if bonus.0 > 0 { write!(f, " · {} bonus", bonus.0) } else { Ok(()) }
    }
}
