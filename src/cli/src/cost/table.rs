//! The report as a table in the terminal.

use super::Report;
use super::files::expected_slope;
use super::measured::{Series, Verdicts};
use super::parameter::Parameter;
use super::search::{Advice, Goal};
use crate::args::wrapped;
use crate::columns::Columns;
use crate::report::Thousands;
use std::fmt::Display;

/// Prints the report.
pub fn print(report: &Report<'_>) {
    let rounds = if report.measured.rounds == 1 { "round" } else { "rounds" };
    println!(
        "{}: {} × {} pixels, {} {rounds}; times are medians in milliseconds ±\nhalf the distance between the \
         quartiles; rays are per pixel, tests per ray\n",
        report.scene, report.width, report.height, report.measured.rounds,
    );
    // A table of 80 columns has room for the bias in place of two other columns.
    let (columns, similar, tests) = match report.has_bias {
        true => (Columns("", &[-23, -1, -1, 8, 15, 14, 6, 0, 6, 6]), "bias", ""),
        false => (Columns("", &[-23, -1, -1, 8, 8, 14, 6, 7, 6, 6]), "similar", "tests"),
    };
    let heads: [&dyn Display; 10] =
        [&"", &"", &"", &"RMSE", &similar, &"ms", &"rays", &tests, &"wrong", &"leaks"];
    println!("{}", columns.row(&heads));
    for series in report.measured.series.iter().filter(|series| !series.levels.is_empty()) {
        println!("{}", heading(series));
        if let Some(slope) = slope(report, series) {
            println!("  {slope}");
        }
        for (name, index) in &series.levels {
            let point = &report.measured.points[*index];
            let rays = point.counts.rays();
            let tests = point.counts.box_tests + point.counts.primitive_tests;
            let hits = point.hits.filter(|_| series.parameter.is_geometric());
            let [similar, tests] = match report.has_bias {
                true => [bias(report, *index), String::new()],
                false => {
                    [format!("{:.4}", point.errors.similarity), short(1, tests as f64 / rays.max(1) as f64)]
                }
            };
            let of_hits = |number: fn(&Verdicts) -> u64| {
                hits.as_ref().map_or(String::new(), |hits| number(hits).to_string())
            };
            let cells: [&dyn Display; 10] = [
                &format!("  {name}"),
                if report.own == Some(*index) { &"*" } else { &"" },
                if report.pareto_front.contains(index) { &"•" } else { &"" },
                &format!("{:.5}", point.error()),
                &similar,
                &time(point.seconds, point.spread),
                &short(2, rays as f64 / (f64::from(report.width) * f64::from(report.height))),
                &tests,
                &of_hits(|hits| hits.wrong),
                &of_hits(|hits| hits.leaks),
            ];
            println!("{}", columns.row(&cells));
        }
        if let Some(waste) = waste(report, series) {
            println!("  {}", wrapped(&waste, 2));
        }
    }
    println!("\n* the scene's own value");
    if report.has_bias {
        println!(
            "bias: the mean signed difference from the reference, and its standard error.\n  It stays when samples are \
             added: error² = bias² + variance / samples"
        );
    }
    println!(
        "• no other value is both faster and more accurate (Pareto front); values that\n  leak are left out"
    );
    if let Some(hits) = about_hits(report) {
        println!("{}", wrapped(&format!("wrong and leaks: {hits}"), 2));
    }
    for left_out in &report.measured.left_out {
        println!("{}", wrapped(&format!("left out: {left_out}"), 2));
    }
    for lacking in &report.measured.lacking {
        println!("{}", wrapped(&format!("note: {lacking}"), 2));
    }
    numerics(report);
    if let Some(advice) = &report.advice {
        print_advice(report, advice);
    }
    if report.partial {
        println!("\nstopped before the end: the report shows what had been measured until then");
    }
}

/// The number of decimals that keeps a number within five characters, so that it does not touch the next column.
fn decimals(most: usize, value: f64) -> usize {
    let digits = (value.abs() + 0.005).max(1.0).log10() as usize + 1;
    most.min(4_usize.saturating_sub(digits))
}

fn short(most: usize, value: f64) -> String {
    format!("{value:.*}", decimals(most, value))
}

/// A median and its spread in milliseconds, with the same number of decimals.
fn time(seconds: f64, spread: f64) -> String {
    let places = decimals(2, 1e3 * seconds.max(spread));
    format!("{:.places$} ± {:.places$}", 1e3 * seconds, 1e3 * spread)
}

/// The bias of a point with its standard error.
pub fn bias(report: &Report<'_>, index: usize) -> String {
    let pixels = f64::from(report.width) * f64::from(report.height);
    let (bias, error) = report.measured.points[index].bias(report.reference_error, pixels);
    format!("{bias:+.4}±{error:.4}")
}

/// What the hits were judged by, if any were judged.
pub fn about_hits(report: &Report<'_>) -> Option<String> {
    let rays = report.measured.points.iter().find_map(|point| point.hits)?.rays;
    Some(format!(
        "of {} rays from the camera, through the picture and at visible edges and corners, against exact \
         arithmetic; a leak passes through a closed surface; the other wrong hits report a neighbouring \
         primitive because of rounding",
        Thousands(rays)
    ))
}

/// The name of a value; the scene's own value is marked.
pub fn named(report: &Report<'_>, name: &str, index: usize) -> String {
    if report.own == Some(index) { format!("{name} (the scene's)") } else { name.to_owned() }
}

fn heading(series: &Series) -> String {
    match series.parameter {
        Parameter::Sampler => format!("sampler: {}, samples per pixel", series.name),
        parameter => parameter.name(),
    }
}

fn slope(report: &Report<'_>, series: &Series) -> Option<String> {
    let (name, slope) = report.slopes.iter().find(|(name, _)| *name == series.name)?;
    let theory = expected_slope(report, name).map_or(String::new(), |slope| format!(", in theory {slope}"));
    Some(format!("error ~ samples to the power {:.2} ± {:.2}{theory}", slope.mean, slope.half_interval))
}

/// The relative difference below which errors count as the same.
const SAME: f64 = 0.02;

/// A sentence that says above which value a parameter costs time without lowering the error.
pub fn waste(report: &Report<'_>, series: &Series) -> Option<String> {
    if series.parameter.is_geometric() {
        return None;
    }
    let point = |index: usize| &report.measured.points[series.levels[index].1];
    let last = series.levels.len().checked_sub(1)?;
    let end = point(last);
    let enough = (0..last).find(|&index| point(index).error() <= (1.0 + SAME) * end.error())?;
    let less = point(enough);
    let times = end.seconds / less.seconds;
    // Times vary by about a fiftieth, and on a busy machine by more. Three times the half distance between the quartiles is
    // two standard deviations of a normal distribution.
    let varies = (SAME * less.seconds).max(3.0 * end.spread.max(less.spread));
    let takes = match end.seconds - less.seconds {
        more if more <= varies => "and takes no measurable extra time".into(),
        _ => format!("and takes up to {times:.2} times as long"),
    };
    let (level, same) = (&series.levels[enough].0, 100.0 * SAME);
    Some(format!("above {level} it lowers the error by less than {same:.0} %, {takes}"))
}

fn numerics(report: &Report<'_>) {
    let numerics = &report.numerics;
    if numerics.is_empty() {
        return;
    }
    const COLUMNS: Columns = Columns("", &[-36, 8, 18, 18]);
    let title = "ray/triangle tests, judged exactly";
    println!("\n{}", COLUMNS.row(&[&title, &"ns", &"wrong per million", &"leaks per million"]));
    for one in numerics {
        let [wrong, leaks] =
            [one.wrong_per_million, one.leaks_per_million].map(|n| Thousands(n.round() as u64));
        let (name, ns) = (format!("  {}", one.name), format!("{:.1}", one.nanoseconds));
        println!("{}", COLUMNS.row(&[&name, &ns, &wrong, &leaks]));
    }
    if let Some(warning) = about_kit_times(report) {
        println!("  {}", wrapped(warning, 2));
    }
}

/// A note about the times of a kit in a separate process.
pub fn about_kit_times(report: &Report<'_>) -> Option<&'static str> {
    report.numerics.iter().any(|one| one.name.starts_with("kit")).then_some(
        "kit: its ns include the messages to and from a separate process; wrong hits and \
         leaks do not depend on that",
    )
}

fn print_advice(report: &Report<'_>, advice: &Advice) {
    println!("\n{}", goal(report, advice));
    for (parameter, value) in &advice.values {
        println!("  {:<22}{value}", parameter.name());
    }
    for line in verdict(advice) {
        println!("  {line}");
    }
}

/// The goal of the proposal, in a sentence.
pub fn goal(report: &Report<'_>, advice: &Advice) -> String {
    let size = format!("{} × {} pixels", report.full_width, report.full_height);
    match advice.goal {
        Goal::Seconds(budget) => format!("the best settings for {budget:.1} s at {size}:"),
        Goal::Error(error) => format!("the fastest settings with an error of at most {error} at {size}:"),
    }
}

/// Errors and times of the proposal and of the scene's own settings, and remarks.
pub fn verdict(advice: &Advice) -> Vec<String> {
    let mut lines = vec![format!(
        "expected: error {:.4}, {:.2} s; the scene's own settings: error {:.4}, {:.2} s",
        advice.expected_error, advice.expected_seconds, advice.own_error, advice.own_seconds
    )];
    if let (Some(error), Some(seconds)) = (advice.verified_error, advice.verified_seconds) {
        lines.push(format!("rendered, with other random numbers: error {error:.4}, {seconds:.2} s"));
    }
    lines.push(format!("to render it: {}", advice.command));
    match advice.goal {
        Goal::Seconds(budget) if advice.verified_seconds.is_some_and(|seconds| seconds > budget) => {
            lines.push(
                "that is longer than requested, because times vary by some percent from one picture to the \
                 next"
                    .into(),
            );
        }
        Goal::Error(target) if advice.expected_error > target => {
            lines.push(format!("the search found no setting with an error of {target}; this is the closest"));
        }
        _ => {}
    }
    let spent: Vec<String> =
        advice.steps.iter().map(|step| step.parameter.name()).fold(Vec::new(), |mut names, name| {
            if !names.contains(&name) {
                names.push(name);
            }
            names
        });
    if !spent.is_empty() {
        lines.push(format!("time is spent on {}", spent.join(", ")));
    }
    lines.extend(advice.passed_over.iter().map(|sentence| format!("left out because it leaks: {sentence}")));
    let wasted = advice.left.iter().filter(|left| left.error_factor > 1.0 - SAME);
    for left in wasted {
        lines.push(format!(
            "not on {} above {}: one step more takes {:.2} times as long for {:.2} times the error",
            left.parameter.name(),
            left.at,
            left.time_factor,
            left.error_factor
        ));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{short, time};

    #[test]
    fn numbers_leave_a_space_between_columns() {
        assert_eq!(short(2, 0.5), "0.50");
        assert_eq!(short(2, 99.5), "99.50");
        assert_eq!(short(2, 233.07), "233.1");
        assert_eq!(short(2, 1165.42), "1165");
        assert_eq!(time(0.0077, 0.00058), "7.70 ± 0.58");
        assert_eq!(time(0.13389, 0.03471), "133.9 ± 34.7");
        for seconds in [1e-6, 0.0099, 0.0999, 0.999, 9.99, 99.9] {
            assert!(time(seconds, seconds).chars().count() < 14, "{}", time(seconds, seconds));
        }
    }
}
