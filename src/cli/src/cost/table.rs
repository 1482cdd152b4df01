//! The report as a table in the terminal.

use super::Report;
use super::files::expected_slope;
use super::measured::{Point, Series, Verdicts};
use super::parameter::Parameter;
use super::search::{Advice, Goal, KEPT};
use crate::args::wrapped;
use crate::columns::Columns;
use crate::race::statistics::Median;
use crate::report::{Thousands, counted};

/// The columns of a ladder: name and marks, error, two that depend on the parameter, time with its ratio, and one more.
const COLUMNS: Columns = Columns("", &[-24, -2, 8, 8, 7, 8, 17, 6]);

/// The same with a bias and its standard error in place of two numbers.
const BIASED: Columns = Columns("", &[-24, -2, 8, 15, 0, 8, 17, 6]);

/// Prints the report.
pub fn print(report: &Report<'_>) {
    let about = format!(
        "{}: {} × {} pixels, {}; ms: {}, the median; ratio: to the line marked =, the median of the rounds and its 95 % \
         interval; rays are per pixel, tests per ray",
        report.scene,
        report.width,
        report.height,
        counted(report.measured.rounds, "round"),
        report.about_times()
    );
    println!("{}", wrapped(&about, 0));
    let mut above = None;
    for series in report.measured.series.iter().filter(|series| !series.levels.is_empty()) {
        // The samplers have one ladder each.
        let is_first = above.replace(series.parameter) != Some(series.parameter);
        let trade = if is_first { format!(": {}", series.parameter.trade()) } else { String::new() };
        println!("\n{}", wrapped(&format!("{}{trade}", heading(series)), 2));
        if let Some(slope) = slope(report, series) {
            println!("  {slope}");
        }
        let heads = heads(report, series);
        println!(
            "{}",
            columns(&heads)
                .row(&[&"", &"", &"RMSE", &heads[0], &heads[1], &"ms", &"ratio", &heads[2]])
                .trim_end()
        );
        for (name, index) in &series.levels {
            let point = &report.measured.points[*index];
            let own = if report.own == Some(*index) { "*" } else { "" };
            let marks = format!("{own}{}", report.mark(*index));
            row(report, series, &format!("  {name}"), &marks, point, &report.measured.points[series.base]);
            if let Some(reference) = &point.reference {
                row(report, series, "    the reference", "", reference, point);
            }
        }
        if let Some(waste) = waste(report, series) {
            println!("  {}", wrapped(&waste, 2));
        }
    }
    println!("\n* the scene's own value");
    if report.measured.points.iter().any(|point| point.reference.is_some()) {
        println!(
            "{}",
            wrapped("the reference: the same value with the solutions; its ratio is to your line above", 2)
        );
    }
    if report.has_bias {
        println!(
            "bias: the mean signed difference from the reference, and its standard error.\n  It stays when samples are \
             added: error² = bias² + variance / samples"
        );
    }
    println!("{}", wrapped(&report.about_marks(), 2));
    if let Some(hits) = about_hits(report) {
        println!("{}", wrapped(&format!("wrong and leaks: {hits}"), 2));
    }
    let left_out = report.measured.left_out.iter().map(|words| format!("left out: {words}"));
    let lacking = report.measured.lacking.iter().map(|words| format!("note: {words}"));
    left_out.chain(lacking).for_each(|line| println!("{}", wrapped(&line, 2)));
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

fn columns(heads: &[&str; 3]) -> &'static Columns {
    if heads[1].is_empty() { &BIASED } else { &COLUMNS }
}

/// The heads of the columns that depend on the parameter.
pub fn heads(report: &Report<'_>, series: &Series) -> [&'static str; 3] {
    match series.parameter {
        Parameter::RayOffset => ["acne", "leaks", "rays"],
        one if one.is_geometric() => ["wrong", "leaks", "tests"],
        _ if report.has_bias => ["bias", "", "rays"],
        _ => ["similar", "tests", "rays"],
    }
}

/// The cells below these heads.
pub fn cells(report: &Report<'_>, series: &Series, point: &Point) -> [String; 3] {
    let counts = &point.counts;
    // Only pictures of the kit are counted, and not those of the reference beside it.
    let counted = |text: String| if counts.primary == 0 { String::new() } else { text };
    let rays = counts.rays().max(1) as f64;
    let tests = counted(short(1, (counts.box_tests + counts.primitive_tests) as f64 / rays));
    let per_pixel = counted(short(1, rays / (f64::from(report.width) * f64::from(report.height))));
    let judged = |number: fn(&Verdicts) -> u64| {
        point.hits.as_ref().map_or(String::new(), |hits| number(hits).to_string())
    };
    match series.parameter {
        Parameter::RayOffset => {
            [counted(counts.shadow_acne.to_string()), counted(counts.light_leaks.to_string()), per_pixel]
        }
        one if one.is_geometric() => [judged(|hits| hits.wrong), judged(|hits| hits.leaks), tests],
        _ if report.has_bias => [bias(report, point), String::new(), per_pixel],
        _ => [format!("{:.4}", point.errors.similarity), tests, per_pixel],
    }
}

fn row(report: &Report<'_>, series: &Series, name: &str, marks: &str, point: &Point, base: &Point) {
    let [one, two, three] = cells(report, series, point);
    let (error, ms) = (format!("{:.5}", point.error()), short(2, 1e3 * point.seconds));
    let line = columns(&heads(report, series)).row(&[
        &name,
        &marks,
        &error,
        &one,
        &two,
        &ms,
        &ratio(point, base),
        &three,
    ]);
    println!("{}", line.trim_end());
}

/// A ratio and its interval, with as many digits as three need at its upper end.
fn interval(ratio: &Median) -> String {
    let places = match ratio.high {
        value if value < 9.995 => 2,
        value if value < 99.95 => 1,
        _ => 0,
    };
    format!("{:.places$} ({:.places$}–{:.places$})", ratio.value, ratio.low, ratio.high)
}

/// The processor time of a point as a multiple of that of `base`, with its 95 % interval; `=` for the base itself.
pub fn ratio(point: &Point, base: &Point) -> String {
    let Some(ratio) = point.time_ratio(base) else { return String::new() };
    if std::ptr::eq(point, base) {
        return "=".into();
    }
    interval(&ratio)
}

/// The bias of a point with its standard error.
pub fn bias(report: &Report<'_>, point: &Point) -> String {
    let pixels = f64::from(report.width) * f64::from(report.height);
    let (bias, error) = point.bias(report.reference_error, pixels);
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

/// The name of a ladder.
pub fn heading(series: &Series) -> String {
    match series.parameter {
        Parameter::Sampler => format!("sampler {}, samples per pixel", series.name),
        _ => series.name.clone(),
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
    // Other formulas and other scenes are no steps of a scale.
    if series.parameter.is_geometric() || KEPT.contains(&series.parameter) {
        return None;
    }
    let point = |index: usize| &report.measured.points[series.levels[index].1];
    let last = series.levels.len().checked_sub(1)?;
    let end = point(last);
    // The intervals say that the error of the last value is not below that of this one by more than this share.
    let as_good =
        |index: &usize| end.error_ratio(point(*index)).is_some_and(|ratio| ratio.low > 1.0 / (1.0 + SAME));
    let enough = (0..last).find(as_good)?;
    let (level, same) = (&series.levels[enough].0, 100.0 * SAME);
    let takes = match end.time_ratio(point(enough))? {
        ratio if ratio.low > 1.0 => format!("and takes {} times as long", interval(&ratio)),
        _ => "and takes no measurable extra time".into(),
    };
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
}

fn print_advice(report: &Report<'_>, advice: &Advice) {
    println!("\n{}", goal(report, advice));
    for (parameter, value) in &advice.values {
        println!("  {:<22}{value}", parameter.name());
    }
    for line in verdict(advice) {
        println!("  {}", wrapped(&line, 2));
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
    let mut spent = Vec::new();
    for name in advice.steps.iter().map(|step| step.parameter.name()) {
        if !spent.contains(&name) {
            spent.push(name);
        }
    }
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
    use super::*;
    use crate::cost::setting::Setting;

    #[test]
    fn numbers_leave_a_space_between_columns() {
        assert_eq!(short(2, 0.5), "0.50");
        assert_eq!(short(2, 99.5), "99.50");
        assert_eq!(short(2, 233.07), "233.1");
        assert_eq!(short(2, 1165.42), "1165");
        let scene = crate::report::scene_of_kit("stage1");
        let point = |seconds| Point::made_up(Setting::of(&scene), 0.1, seconds, 0);
        let base = point(1.0);
        let written = [0.031, 1.0, 12.34, 123.4].map(|seconds| ratio(&point(seconds), &base));
        assert_eq!(written, ["0.03 (0.03–0.03)", "1.00 (1.00–1.00)", "12.3 (12.3–12.3)", "123 (123–123)"]);
        assert_eq!(ratio(&base, &base), "=");
    }
}
