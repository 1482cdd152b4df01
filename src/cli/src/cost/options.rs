//! The command line of `raykata cost`.

use super::parameter::Parameter;
use crate::args::{Argument, Given, Misuse, Opt, Spec, chosen, names};
use crate::kits::Choice;
use crate::quality_options::{QualityOptions, THREADS, key_of, threads};
use raykata::scene::Accelerator;
use std::path::PathBuf;

/// `raykata cost`.
pub static SPEC: Spec = Spec {
    name: "raykata cost",
    about: "Measure error and time for the values of each quality parameter, and propose the best settings \
            for a time or an error.",
    arguments: &[Argument::optional("SCENE", "The scene, a TOML file; not with `--headline`.")],
    options: &[
        &[
            Opt::flag(
                "--headline",
                "Instead of a scene: compare brute force with the hierarchy on landscapes of more and more \
                 triangles, on 3840 × 2160 pixels.",
            ),
            Opt::value("--most", "N", "Triangles of the largest landscape [default: 12000000]."),
            Opt::value(
                "--parameter",
                "LIST",
                "The parameters to measure [default: all that the scene needs].",
            )
            .choices(&names(&Parameter::NAMES))
            .many(),
            Opt::value(
                "--budget",
                "TIME",
                "Propose the settings with the smallest error within this time, such as 60s or 1500ms, at \
                 the scene's own size.",
            ),
            Opt::value(
                "--error",
                "X",
                "Propose the fastest settings with at most this root mean square error.",
            ),
            Opt::value(
                "--reference",
                "N",
                "Samples per pixel of the reference; a larger number makes its own error smaller [default: \
                 256; with `--full` 1024].",
            ),
            Opt::value(
                "--rounds",
                "N",
                "How often each picture is rendered, all in turn and with other random numbers; intervals need 6 rounds \
                 [default: 6; with `--full` 9].",
            ),
            Opt::flag(
                "--full",
                "Measure pictures of 10,000 pixels instead of 2,500, with the samples per pixel of the scene instead of at most 16, \
                 in more rounds, and against a better reference. That takes minutes.",
            ),
            Opt::flag(
                "--equal-time",
                "Instead of the report: compare the values of each parameter with as many samples per pixel as fit into \
                 the same time.",
            ),
            Opt::value(
                "--light-sizes",
                "LIST",
                "With `--equal-time`: factors for the size of spheres and polygons that emit light, which keep \
                 their power [default: 1].",
            )
            .many(),
            Opt::value("--seed", "N", "Seed of the random numbers [default: 0]."),
            Opt::value(
                "--out",
                "FOLDER",
                "The folder for the report, plots and tables [default: out/NAME-cost].",
            )
            .short("-o"),
        ],
        Choice::OPTIONS,
        THREADS,
        QualityOptions::OPTIONS,
    ],
};

/// The scene, the parameters, and how long to measure.
pub struct CostOptions {
    /// `None` for the headline.
    pub scene: Option<PathBuf>,
    pub most: u64,
    pub turned: Vec<Parameter>,
    pub kit: Choice,
    pub budget: Option<f64>,
    pub error: Option<f64>,
    pub reference: u32,
    pub rounds: u32,
    pub full: bool,
    pub equal_time: bool,
    /// Factors for the size of the lights, above 0; at least one.
    pub light_sizes: Vec<f32>,
    pub threads: usize,
    pub seed: u64,
    pub quality: QualityOptions,
    pub out: Option<PathBuf>,
}

impl CostOptions {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<CostOptions, Misuse> {
        let (scene, headline) = (given.argument(0).map(PathBuf::from), given.has("--headline"));
        given.refuse(headline && scene.is_some(), "`--headline` takes no SCENE")?;
        given.refuse(!headline && scene.is_none(), "SCENE is missing")?;
        given.refuse(!headline && given.has("--most"), "`--most` goes with `--headline`")?;
        given.exclude("--budget", "--error")?;
        given.exclude("--equal-time", "--budget")?;
        given.exclude("--equal-time", "--error")?;
        given.exclude("--equal-time", "--headline")?;
        let quality = QualityOptions::read(given)?;
        let is_tree = |one: Accelerator| one.is_hierarchy() || one.is_wide();
        let is_other = headline && !quality.accelerator().is_none_or(is_tree);
        given.refuse(is_other, "`--headline` needs a hierarchy, such as `--accelerator bvh`")?;
        let mut light_sizes = given.list("--light-sizes", parse_size)?;
        let equal_time = given.has("--equal-time");
        given.refuse(!(light_sizes.is_empty() || equal_time), "`--light-sizes` goes with `--equal-time`")?;
        if light_sizes.is_empty() {
            light_sizes = vec![1.0];
        }
        let full = given.has("--full");
        Ok(CostOptions {
            scene,
            most: given.number("--most", 2..=16_000_000)?.unwrap_or(12_000_000),
            turned: given.list("--parameter", |text| match key_of(text) {
                Some(key) if chosen(text, &Parameter::NAMES).is_err() => {
                    Err(format!("it is now called `{key}`"))
                }
                _ => chosen(text, &Parameter::NAMES),
            })?,
            kit: Choice::read(given)?,
            budget: given.parsed("--budget", parse_seconds)?,
            error: given.parsed("--error", parse_error)?,
            reference: given.number("--reference", 128..=1_048_576)?.unwrap_or(if full { 1024 } else { 256 }),
            rounds: given.number("--rounds", 1..=1000)?.unwrap_or(if full { 9 } else { 6 }),
            full,
            equal_time,
            light_sizes,
            threads: threads(given)?,
            seed: given.number("--seed", 0..=u64::MAX)?.unwrap_or(0),
            quality,
            out: given.path("--out"),
        })
    }

    /// The most pixels of a measured picture, unless a size is given, because some hundred pictures are rendered. Without
    /// `--full` the scene of the README then takes about half a minute.
    pub fn pixels(&self) -> f64 {
        if self.full { 10_000.0 } else { 2_500.0 }
    }

    /// The number of samples that ladders reach at least.
    pub fn most_samples(&self) -> u32 {
        if self.full { 64 } else { 16 }
    }
}

/// `60s`, `1500ms`, `2m` or a number of seconds.
fn parse_seconds(text: &str) -> Result<f64, String> {
    let units = [("ms", 0.001), ("s", 1.0), ("m", 60.0), ("", 1.0)];
    let number =
        |(unit, scale): (&str, f64)| Some(text.strip_suffix(unit)?.trim().parse::<f64>().ok()? * scale);
    let seconds = units.into_iter().find_map(number).filter(|seconds| *seconds > 0.0 && seconds.is_finite());
    seconds.ok_or_else(|| "a time is a number above 0 with the unit s, ms or m, such as 60s".into())
}

fn parse_size(text: &str) -> Result<f32, String> {
    let size = text.trim().parse().ok().filter(|size| (0.001..=1000.0).contains(size));
    size.ok_or_else(|| "a size is a number from 0.001 to 1000, such as 0.5".into())
}

fn parse_error(text: &str) -> Result<f64, String> {
    let error = text.parse().ok().filter(|error: &f64| *error > 0.0 && error.is_finite());
    error.ok_or_else(|| "an error is a number above 0, such as 0.01".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_as_people_write_them() {
        let read = ["60s", "1500ms", "2m", "7", "0.5 s"].map(parse_seconds);
        assert_eq!(read, [60.0, 1.5, 120.0, 7.0, 0.5].map(Ok));
        for wrong in ["", "s", "-1s", "0", "inf", "soon"] {
            assert!(parse_seconds(wrong).is_err(), "{wrong}");
        }
    }
}
