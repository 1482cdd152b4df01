//! On what terms submissions are graded, and the grader that keeps to them.

use super::forge::{self, Forge};
use super::grader::Grader;
use super::judge::Judge;
use super::result::Session;
use crate::sandbox::{self, Confinement};
use all_checks::STAGES;
use anyhow::{Context, Result, ensure};
use raykata_cli::args::{Given, Misuse, Opt};
use sha2::{Digest, Sha256};
use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What an instructor decides, for a class and for one submission alike.
#[derive(Default)]
pub struct GradingOptions {
    pub(super) stages: Option<Stages>,
    pub(super) seed: Option<u64>,
    pub(super) allow: Vec<String>,
    pub(super) insecure: bool,
}

impl GradingOptions {
    /// As options.
    pub const OPTIONS: &[Opt] = &[
        Opt::value("--stages", "LIST", "The stages, as `3`, `1-4` or `1-4,10` [default: all]."),
        Opt::value(
            "--seed",
            "N",
            "Picks the hidden inputs [default: drawn at random]. Give it if submissions of a class are graded one at a \
             time; otherwise each gets different inputs.",
        ),
        Opt::value(
            "--allow",
            "LIST",
            "Rules of the syntax check that do not apply, as a refusal names them.",
        )
        .many(),
        Opt::flag(
            "--insecure",
            "Grade even where submissions cannot be contained. They can then do what you can.",
        ),
    ];

    /// As they were given.
    pub fn read(given: &Given) -> Result<GradingOptions, Misuse> {
        Ok(GradingOptions {
            stages: given.parsed("--stages", stages)?,
            seed: given.number("--seed", 0..=u64::MAX)?,
            allow: given.list("--allow", |rule| Ok::<_, String>(rule.to_owned()))?,
            insecure: given.has("--insecure"),
        })
    }

    /// A grader, and what is to be written down about it. Stages and seed that are not given are those with which the
    /// class was `begun`.
    pub fn begin(&self, root: &Path, begun: Option<&Session>) -> Result<(Grader, Session)> {
        let (confinement, isolation) = self.confinement()?;
        let forge = Forge::prepare(root, confinement)?;
        let stages = self.stages.as_ref().map(|Stages(stages)| stages.clone());
        let session = Session {
            kit: kit(root, &self.allow, &forge)?,
            stages: stages.or(begun.map(|session| session.stages.clone())).unwrap_or_else(all_stages),
            seed: self.seed.or(begun.map(|session| session.seed)).unwrap_or_else(draw_seed),
            isolation,
        };
        let judge = Judge::of(root, &session.stages, session.seed, confinement)?;
        let allowed = self.allow.clone();
        Ok((Grader { forge: Arc::new(forge), judge: Arc::new(judge), confinement, allowed }, session))
    }

    /// What stands around submissions, and in a line for the reports.
    fn confinement(&self) -> Result<(Confinement, String)> {
        match sandbox::self_test() {
            Ok(level) => Ok((Confinement::Full, level.to_string())),
            Err(error) if self.insecure => {
                eprintln!("warning: submissions are not contained: {error:#}");
                let isolation = "nothing but limits on resources, on the word of the instructor (--insecure)";
                Ok((Confinement::LimitsOnly, isolation.into()))
            }
            Err(error) => Err(error.context(
                "submissions cannot be contained here, so none is run (--insecure runs them all the same, with your \
                 rights)",
            )),
        }
    }
}

/// Numbers of stages, in order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stages(pub(super) Vec<u8>);

/// As people write them.
pub(crate) fn stages(text: &str) -> Result<Stages> {
    let number =
        |text: &str| text.trim().parse::<u8>().with_context(|| format!("`{text}` is no number of a stage"));
    let mut stages = Vec::new();
    for part in text.split(',') {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        stages.extend(number(first)?..=number(last)?);
    }
    stages.sort_unstable();
    stages.dedup();
    ensure!(!stages.is_empty(), "`{text}` names no stage");
    for stage in &stages {
        ensure!(STAGES.iter().any(|(number, _)| number == stage), "there is no stage {stage}");
    }
    Ok(Stages(stages))
}

fn all_stages() -> Vec<u8> {
    STAGES.iter().map(|(number, _)| *number).collect()
}

/// A seed that nobody knows: the standard library draws keys for its tables at random.
pub(crate) fn draw_seed() -> u64 {
    RandomState::new().hash_one("seed")
}

/// Version of the kit, with a fingerprint of all that decides a grade.
fn kit(root: &Path, allow: &[String], forge: &Forge) -> Result<String> {
    let mut hash = Sha256::new();
    hash.update(forge.fingerprint());
    hash.update(allow.join(","));
    let decide = ["tests/checks", "tests/golden", "tests/oracle", "tests/rubric.toml"];
    let mut waiting: Vec<PathBuf> =
        decide.iter().map(|path| root.join(path)).filter(|path| path.exists()).collect();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            let mut inside: Vec<PathBuf> =
                fs::read_dir(&path)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
            inside.sort();
            waiting.extend(inside);
        } else {
            hash.update(fs::read(&path).with_context(|| path.display().to_string())?);
        }
    }
    Ok(format!("{} ({})", env!("CARGO_PKG_VERSION"), &forge::hex(&hash.finalize())[..12]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_read_as_people_write_them() {
        assert_eq!(stages("1-4,10").unwrap(), Stages(vec![1, 2, 3, 4, 10]));
        assert_eq!(stages("3").unwrap(), Stages(vec![3]));
        for wrong in ["", "x", "0", "4-2", "1-99"] {
            assert!(stages(wrong).is_err(), "{wrong}");
        }
    }
}
