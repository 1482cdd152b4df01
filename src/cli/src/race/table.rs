//! The table of a race, in 80 columns.

use super::pictures::is_tolerable;
use super::statistics::{Median, paired_ratio};
use crate::args::wrapped;
use crate::report::{Thousands, counted};
use std::fmt::Write;

/// What was measured of one kit.
#[derive(Clone, Debug, Default)]
pub struct Lane {
    /// The name of the kit.
    pub name: String,
    /// The time of the frame of each round, in seconds.
    pub seconds: Vec<f64>,
    /// The largest number of pixels of a round that differ from the baseline's picture.
    pub different_pixels: usize,
    /// What its pictures lack.
    pub notes: Vec<String>,
}

/// A race: its lanes, of which the first is the baseline.
#[derive(Clone, Debug, Default)]
pub struct Race {
    /// The scene, with the size of the pictures.
    pub title: String,
    /// The number of pixels of a picture.
    pub pixels: usize,
    /// Whether the times are processor times, or else elapsed times.
    pub processor_time: bool,
    /// The kits. The first one is the baseline.
    pub lanes: Vec<Lane>,
}

/// The smallest difference of speeds that two digits after the point show.
const SHOWN: f64 = 0.005;

/// The width of the column of names.
const NAMES: usize = 24;

impl Race {
    /// Whether the picture of a lane is that of the baseline.
    fn is_right(&self, lane: &Lane) -> bool {
        is_tolerable(lane.different_pixels, self.pixels)
    }

    /// Whether every picture is that of the baseline.
    pub fn is_valid(&self) -> bool {
        self.lanes.iter().all(|lane| self.is_right(lane))
    }

    /// Whether any kit has the baseline's picture, beside the baseline.
    pub fn has_opponent(&self) -> bool {
        self.lanes.iter().skip(1).any(|lane| self.is_right(lane))
    }

    /// How many times as fast as the baseline a lane is: the median over rounds of the ratios of times, because the frames of
    /// a round were rendered within moments of each other. `None` for a wrong picture.
    fn speed(&self, lane: &Lane) -> Option<Median> {
        let baseline = self.lanes.first().filter(|_| self.is_right(lane))?;
        paired_ratio(&baseline.seconds, &lane.seconds)
    }

    /// The report.
    pub fn report(&self) -> String {
        let Some(baseline) = self.lanes.first() else { return String::new() };
        let rounds = counted(baseline.seconds.len() as u64, "round");
        let mut text = format!("{}\n", wrapped(&self.title, 0));
        let what = if self.processor_time { "processor time" } else { "ELAPSED time" };
        let _ = writeln!(text, "{what} of whole frames on one thread, {rounds}, all kits in turn\n");
        let _ = writeln!(
            text,
            "{:NAMES$} {:>9}  {:^19}  {:>5}  95 % interval",
            "kit", "median s", "range of rounds", "speed"
        );
        for lane in &self.lanes {
            text += &self.row(lane);
        }
        text += "\n";
        for lane in &self.lanes[1..] {
            let _ = writeln!(text, "{}", wrapped(&self.verdict(lane, baseline), 0));
        }
        if !self.processor_time {
            let note = "This system does not say how much processor time another process has used, so these are elapsed times: \
                        they count everything else that the computer does.";
            let _ = writeln!(text, "{}", wrapped(note, 0));
        }
        for lane in &self.lanes {
            for note in &lane.notes {
                let _ = writeln!(text, "{}", wrapped(&format!("note: {}: {note}", lane.name), 2));
            }
        }
        text
    }

    fn row(&self, lane: &Lane) -> String {
        let mut sorted = lane.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        let (Some(least), Some(most)) = (sorted.first(), sorted.last()) else { return String::new() };
        let middle = sorted[sorted.len() / 2];
        let speed = match (std::ptr::eq(lane, &self.lanes[0]), self.speed(lane)) {
            (true, _) => " 1.00".to_owned(),
            (_, Some(speed)) => format!("{:>5.2}  {:.2} to {:.2}", speed.value, speed.low, speed.high),
            (_, None) => format!("{:>5}  wrong picture", "–"),
        };
        let name = shortened(&lane.name);
        format!("{name:NAMES$} {middle:>9.3}  {least:>8.3} to {most:<7.3}  {speed}\n")
    }

    /// Which kit is faster, in words.
    fn verdict(&self, lane: &Lane, baseline: &Lane) -> String {
        let (name, other) = (&lane.name, &baseline.name);
        let Some(speed) = self.speed(lane) else {
            return format!(
                "{} of {} pixels of {name} differ from those of {other}, more than rounding explains: a wrong picture \
                 wins no race.",
                Thousands(lane.different_pixels as u64),
                Thousands(self.pixels as u64)
            );
        };
        let sure = format!("with {:.0} % confidence", (100.0 * speed.confidence).floor());
        // A difference that the table's two digits do not show is not worth a sentence.
        if speed.low >= 1.0 + SHOWN {
            format!("{name} is faster than {other}, {sure}.")
        } else if speed.high <= 1.0 - SHOWN {
            format!("{name} is slower than {other}, {sure}.")
        } else if speed.low > 1.0 - SHOWN && speed.high < 1.0 + SHOWN {
            format!("{name} is as fast as {other} within 1 %, {sure}.")
        } else {
            format!(
                "Neither {name} nor {other} is certainly faster: the interval contains 1.00. More rounds narrow it."
            )
        }
    }
}

/// The name, cut at its start if it is longer than its column: the end of a path says most.
fn shortened(name: &str) -> String {
    let n = name.chars().count();
    if n <= NAMES {
        return name.to_owned();
    }
    std::iter::once('…').chain(name.chars().skip(n - NAMES + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn race() -> Race {
        let lane = |name: &str, seconds: f64, different_pixels: usize| Lane {
            name: name.into(),
            // Rounds differ by up to 3 %, in an order of their own.
            seconds: (0..15).map(|i| seconds * (1.0 + 0.002 * f64::from(i * 4 % 15))).collect(),
            different_pixels,
            notes: Vec::new(),
        };
        let mut race = Race {
            title: "scenes/forest.toml, 282 × 176 pixels, 4 samples each".into(),
            pixels: 49_632,
            processor_time: true,
            lanes: vec![
                lane("solutions", 0.4, 0),
                lane("exercises", 0.5, 49),
                lane("/home/students/anna/raykata/exercises", 0.3999, 0),
                lane("../ben", 0.1, 12_345),
            ],
        };
        race.lanes[1]
            .notes
            .push("spheres are left out: `sphere_algebraic` of stage 1 is not written yet".into());
        race
    }

    #[test]
    fn the_table_fits_80_columns() {
        let report = race().report();
        insta::assert_snapshot!(report);
        assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
    }

    #[test]
    fn a_wrong_picture_has_no_speed() {
        let mut race = race();
        assert!(!race.is_valid());
        let report = race.report();
        assert!(
            report.replace('\n', " ").contains("12,345 of 49,632 pixels of ../ben differ")
                && report.contains("wins no race"),
            "{report}"
        );
        assert!(!report.contains("4.00") && report.contains("–  wrong picture"), "{report}");
        race.lanes.pop();
        assert!(race.is_valid());
    }

    #[test]
    fn elapsed_time_is_called_so() {
        let report = Race { processor_time: false, ..race() }.report();
        assert!(
            report.contains("ELAPSED time of whole frames") && report.contains("these are elapsed times"),
            "{report}"
        );
    }
}
