//! What can be asked of `raykata cost`.

use super::ladder::Knob;
use crate::kits::Choice;
use crate::knobs::{Knobs, Threads};
use clap::Args;
use std::path::PathBuf;

/// Which scene, which knobs, and how long.
#[derive(Args)]
pub struct Options {
    /// The scene, a TOML file.
    #[arg(required_unless_present = "headline")]
    pub(super) scene: Option<PathBuf>,
    /// Instead: brute force against the hierarchy on a landscape of more and more triangles, on 3840 × 2160 pixels.
    #[arg(long, conflicts_with = "scene")]
    pub(super) headline: bool,
    /// How many triangles the largest landscape has.
    #[arg(long, default_value_t = 12_000_000, requires = "headline", value_parser = clap::value_parser!(u64).range(2..=16_000_000))]
    pub(super) most: u64,
    /// The knobs to turn [default: all that the scene calls for].
    #[arg(long = "knob", value_enum, value_delimiter = ',')]
    pub(super) turned: Vec<Knob>,
    #[command(flatten)]
    pub(super) kit: Choice,
    /// Propose the settings with the least error for so much time, such as 60s or 1500ms, in the scene's own size.
    #[arg(long, value_parser = parse_seconds, conflicts_with = "error")]
    pub(super) budget: Option<f64>,
    /// Propose the fastest settings with no more root mean square error than this.
    #[arg(long, value_parser = parse_error)]
    pub(super) error: Option<f64>,
    /// Samples a pixel of the reference; more make its own error smaller.
    #[arg(long, default_value_t = 1024, value_parser = clap::value_parser!(u32).range(128..=1_048_576))]
    pub(super) reference: u32,
    /// How often each picture is made, by turns and with other random numbers; medians and means count.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) rounds: u32,
    #[command(flatten)]
    pub(super) threads: Threads,
    /// Picks the random numbers.
    #[arg(long, default_value_t = 0)]
    pub(super) seed: u64,
    #[command(flatten)]
    pub(super) knobs: Knobs,
    /// The folder for the report, plots and tables [default: out/NAME-cost].
    #[arg(long, short)]
    pub(super) out: Option<PathBuf>,
}

/// `60s`, `1500ms`, `2m` or a number of seconds.
fn parse_seconds(text: &str) -> Result<f64, String> {
    let units = [("ms", 0.001), ("s", 1.0), ("m", 60.0), ("", 1.0)];
    let number =
        |(unit, scale): (&str, f64)| Some(text.strip_suffix(unit)?.trim().parse::<f64>().ok()? * scale);
    match units.into_iter().find_map(number) {
        Some(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("a time is a number above 0 with s, ms or m behind it, such as 60s".into()),
    }
}

fn parse_error(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(error) if error > 0.0 && error.is_finite() => Ok(error),
        _ => Err("an error is a number above 0, such as 0.01".into()),
    }
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
