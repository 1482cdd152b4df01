//! The lecture's headline example, measured: n triangles and one ray per pixel of a screen, with a hierarchy
//! and without.
//!
//! Brute force for a whole screen takes days. It is timed on a slice of rays that takes about a second, and
//! extrapolated; the report shows the multiplication.

use super::landscape::{scene, sides};
use super::measure::Bench;
use crate::columns::Columns;
use crate::journal::Journal;
use crate::report::{FrameBar, Thousands, make_folder, write_file};
use anyhow::Result;
use raykata::kit::{RenderJob, View};
use raykata::scene::Accelerator;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::path::Path;

/// The screen of the lecture notes.
const SCREEN: (u32, u32) = (3840, 2160);

/// One ray per pixel of the screen.
const RAYS: u64 = SCREEN.0 as u64 * SCREEN.1 as u64;

/// The number of tests on which brute force is timed; they take a second or two.
const TESTS_OF_SLICE: u64 = 200_000_000;

/// Work is counted for a sixteenth of the rays, which have the same means, because counting is slower.
const SHARE_COUNTED: u32 = 4;

/// The results for one size.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Row {
    triangles: u64,
    build_seconds: f64,
    structure_bytes: u64,
    /// Averages per ray.
    node_visits: f64,
    box_tests: f64,
    triangle_tests: f64,
    /// Seconds for the whole screen.
    frame_seconds: f64,
    /// The number of rays in the slice, and the seconds that brute force took for them.
    slice_rays: u64,
    slice_seconds: f64,
    /// The number of pixels of the slice that differ between brute force and hierarchy.
    different_pixels: usize,
}

impl Row {
    fn nanoseconds_a_test(&self) -> f64 {
        1e9 * self.slice_seconds / (self.slice_rays as f64 * self.triangles as f64)
    }

    /// The expected build time for this many triangles: sorting makes it n log n.
    fn build_seconds_of(&self, triangles: u64) -> f64 {
        let work = |n: u64| n as f64 * (n as f64).ln();
        self.build_seconds * work(triangles) / work(self.triangles)
    }

    /// Seconds of brute force for the whole screen.
    fn brute_seconds(&self) -> f64 {
        self.slice_seconds / self.slice_rays as f64 * RAYS as f64
    }
}

/// Measures 12 times each power of ten up to `most` triangles with this hierarchy, prints the table, and writes it to a file. The
/// rows are kept until then, so that a run that is stopped continues where it was, if `code` is the same.
pub fn run(bench: &Bench<'_>, hierarchy: Accelerator, most: u64, out: &Path, code: &str) -> Result<bool> {
    let file = out.join("unfinished.jsonl");
    let about = format!("rows of {hierarchy:?} with {} threads by the program {code}", bench.threads);
    let mut kept: Journal<Row> = Journal::open(&file, &about)?;
    println!(
        "A landscape of n triangles on {} × {} pixels: one ray per pixel,\nnormals as colours, {} \
         threads. Brute force is timed on a slice of rays, and\nthe counts per ray are means over a sixteenth \
         of the rays.\n",
        SCREEN.0,
        SCREEN.1,
        if bench.threads == 0 { crate::queue::cores() } else { bench.threads }
    );
    const COLUMNS: Columns = Columns(" ", &[10, 6, 8, 5, 9, 6, 8, 11, 9]);
    let heads: [&dyn Display; 9] =
        [&"n", &"log2 n", &"build", &"boxes", &"triangles", &"ns/ray", &"frame", &"brute force", &"times"];
    println!("{}", COLUMNS.row(&heads));
    let mut rows: Vec<Row> = Vec::new();
    for triangles in sizes(most) {
        let row = match kept.take(&triangles.to_string()) {
            Some(row) => row,
            None => {
                let Some(row) = measure(bench, hierarchy, triangles, rows.last())? else { break };
                kept.add(&triangles.to_string(), &row)?;
                row
            }
        };
        let cells: [&dyn Display; 9] = [
            &Thousands(row.triangles),
            &format!("{:.1}", (row.triangles as f64).log2()),
            &duration(row.build_seconds),
            &format!("{:.1}", row.box_tests),
            &format!("{:.2}", row.triangle_tests),
            &format!("{:.0}", 1e9 * row.frame_seconds / RAYS as f64),
            &duration(row.frame_seconds),
            &duration(row.brute_seconds()),
            &Thousands((row.brute_seconds() / row.frame_seconds) as u64),
        ];
        println!("{}", COLUMNS.row(&cells));
        rows.push(row);
        if bench.stopped() {
            break;
        }
    }
    let Some(last) = rows.last() else { return Ok(false) };
    arithmetic(last);
    make_folder(out)?;
    let file = out.join("headline.json");
    write_file(&file, &serde_json::to_vec_pretty(&rows)?)?;
    if !bench.stopped() {
        kept.finish()?;
    }
    println!("the numbers: {}", file.display());
    Ok(rows.iter().all(|row| row.different_pixels == 0) && !bench.stopped())
}

/// Prints how the numbers of the table follow from each other, and how those of the lecture do.
fn arithmetic(row: &Row) {
    println!("\nbrute force");
    println!(
        "  {} triangles × {} rays = {} tests",
        Thousands(row.triangles),
        Thousands(RAYS),
        Thousands(row.triangles * RAYS)
    );
    println!(
        "  × {:.2} ns per test ({} rays of a slice took {:.2} s) = {}",
        row.nanoseconds_a_test(),
        Thousands(row.slice_rays),
        row.slice_seconds,
        duration(row.brute_seconds())
    );
    println!("hierarchy");
    println!("  {:.1} box tests and {:.2} triangle tests per ray", row.box_tests, row.triangle_tests);
    println!(
        "  {} for the frame after {} for the build, {:.0} bytes per triangle",
        duration(row.frame_seconds),
        duration(row.build_seconds),
        row.structure_bytes as f64 / row.triangles as f64
    );
    println!(
        "  the frame is {} times as fast as brute force, {} times with the build",
        Thousands((row.brute_seconds() / row.frame_seconds) as u64),
        Thousands((row.brute_seconds() / (row.frame_seconds + row.build_seconds)) as u64)
    );
    for line in of_the_lecture(row) {
        println!("{line}");
    }
}

/// The floating-point operations of a ray/triangle test, and the seconds that all tests of brute force take on a GPU; both
/// from the lecture notes.
const FLOPS_PER_TEST: f64 = 40.0;
const SECONDS_ON_A_GPU: f64 = 120.0;

/// The lecture's estimate for this number of triangles, step by step, and what it leaves out.
fn of_the_lecture(row: &Row) -> Vec<String> {
    let n = row.triangles as f64;
    let flops = FLOPS_PER_TEST * n * RAYS as f64;
    let of_the_example = FLOPS_PER_TEST * 12e6 * RAYS as f64;
    let rate = of_the_example / SECONDS_ON_A_GPU;
    let claimed = flops / rate * n.log2() / n;
    // Three factors lead from the lecture's time to the measured one. The rate of this machine is that of brute force, where
    // nearly all time goes to tests.
    let tests = row.box_tests + row.triangle_tests;
    let rate_here = FLOPS_PER_TEST / row.nanoseconds_a_test() * 1e9;
    let (more_tests, slower) = (tests / n.log2(), rate / rate_here);
    let cheaper = claimed * more_tests * slower / row.frame_seconds;
    vec![
        "the lecture's arithmetic".into(),
        format!("  tests × {FLOPS_PER_TEST:.0} flops = {flops:.2e} flops"),
        format!(
            "  two minutes for 12,000,000 triangles are {:.0} teraflops per second, so {}",
            rate / 1e12,
            duration(flops / rate)
        ),
        format!("  × log2 n / n = {:.1} / n, that is {}", n.log2(), duration(claimed)),
        format!("from there to the measured {}", duration(row.frame_seconds)),
        format!("  × {more_tests:.1}: a ray makes {tests:.1} tests, not log2 n = {:.1}", n.log2()),
        format!(
            "  × {}: brute force reaches {:.1} gigaflops per second here, no teraflops",
            Thousands(slower as u64),
            rate_here / 1e9
        ),
        format!("  ÷ {cheaper:.1}: most tests are of boxes, which take less than {FLOPS_PER_TEST:.0} flops"),
    ]
}

/// The sizes: 12 times the powers of ten below `most`, and `most`.
fn sizes(most: u64) -> Vec<u64> {
    let powers = (2..).map(|power| 12 * 10u64.pow(power));
    let mut sizes: Vec<u64> = powers.take_while(|size| *size < most).collect();
    sizes.push(most);
    sizes
}

/// `None` if the program is being stopped.
fn measure(
    bench: &Bench<'_>,
    hierarchy: Accelerator,
    triangles: u64,
    smaller: Option<&Row>,
) -> Result<Option<Row>> {
    let sides = sides(triangles);
    let exact = 2 * u64::from(sides.0) * u64::from(sides.1);
    let bar = FrameBar::new("");
    let say = |what: &str| bar.begin(format!("{} triangles: {what}", Thousands(exact)));
    say("making the landscape");
    let scene = scene(SCREEN, sides)?;
    // No progress can be shown before the first leaf, so estimate the build time from the smaller landscape.
    let expected = smaller.map_or(0.0, |row| row.build_seconds_of(exact));
    let frame = |what: &str, accelerator: Accelerator, (width, height): (u32, u32), count: bool| {
        if accelerator == hierarchy && expected >= 1.0 {
            say(&format!("{what}, about {expected:.0} s to build"));
        } else {
            say(what);
        }
        let mut job = RenderJob { view: View::Normals, ..bench.job(&scene, bench.seed, count) };
        (job.scene.film.width, job.scene.film.height) = (width, height);
        job.scene.quality.accelerator = accelerator;
        bench.render(&job, None, &bar)
    };

    // The hierarchy is built for each picture, because a kit keeps nothing between two pictures.
    let sixteenth = (SCREEN.0 / SHARE_COUNTED, SCREEN.1 / SHARE_COUNTED);
    let Some(counted) = frame("counting", hierarchy, sixteenth, true)? else { return Ok(None) };
    let Some(whole) = frame("the whole frame", hierarchy, SCREEN, false)? else { return Ok(None) };
    // A slice with the aspect ratio of the screen: 16 × 9 times a number.
    let across = ((TESTS_OF_SLICE as f64 / (144.0 * exact as f64)).sqrt() * 16.0).clamp(4.0, 960.0) as u32;
    let slice = (across, (across * 9 / 16).max(1));
    let brute = frame("brute force on a slice", Accelerator::BruteForce, slice, false)?;
    let same = frame("the slice again", hierarchy, slice, false)?;
    let (Some(brute), Some(same)) = (brute, same) else { return Ok(None) };
    bar.finish();
    let rays = counted.counts.primary.max(1) as f64;
    let different =
        brute.film.pixels.iter().zip(&same.film.pixels).filter(|(one, other)| one != other).count();
    Ok(Some(Row {
        triangles: exact,
        build_seconds: whole.build_seconds,
        structure_bytes: whole.structure.map_or(0, |size| size.bytes),
        node_visits: counted.counts.node_visits as f64 / rays,
        box_tests: counted.counts.box_tests as f64 / rays,
        triangle_tests: counted.counts.primitive_tests as f64 / rays,
        frame_seconds: whole.render_seconds,
        slice_rays: u64::from(slice.0) * u64::from(slice.1),
        slice_seconds: brute.render_seconds,
        different_pixels: different,
    }))
}

/// The time in a readable unit.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.01 => format!("{:.1} ms", 1e3 * s),
        s if s < 120.0 => format!("{s:.2} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s if s < 48.0 * 3600.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_go_up_to_the_one_that_was_asked_for() {
        assert_eq!(sizes(12_000_000), [1_200, 12_000, 120_000, 1_200_000, 12_000_000]);
        assert_eq!(sizes(1_000), [1_000]);
        assert_eq!(sizes(5_000), [1_200, 5_000]);
    }

    #[test]
    fn the_lecture_arrives_at_two_minutes_and_at_a_fifth_of_a_millisecond() {
        let row = Row {
            triangles: 12_000_000,
            build_seconds: 40.0,
            structure_bytes: 1 << 30,
            node_visits: 25.0,
            box_tests: 47.7,
            triangle_tests: 2.1,
            frame_seconds: 2.3,
            slice_rays: 16,
            slice_seconds: 3.84,
            different_pixels: 0,
        };
        let text = of_the_lecture(&row).join("\n");
        for part in ["3.98e15 flops", "33 teraflops", "so 2.0 min", "that is 0.2 ms", "2.0 gigaflops"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }

    #[test]
    fn durations_are_said_as_people_say_them() {
        let said = [0.0012, 5.0, 600.0, 10_000.0, 1e6].map(duration);
        assert_eq!(said, ["1.2 ms", "5.00 s", "10.0 min", "2.8 h", "11.6 days"]);
    }
}
