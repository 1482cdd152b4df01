//! The report as files for programs and slides: JSON, CSV and plots.

use super::measured::{Point, Series, Verdicts};
use super::parameter::Parameter;
use super::plot::{Line, Plot, svg};
use super::slope::theory;
use super::{Report, Summary};
use crate::html::csv_line;
use crate::race::statistics::Median;
use crate::report::write_file;
use anyhow::Result;
use std::path::Path;

/// Writes `cost.json`, `cost.csv` and the plots into a folder.
pub fn write(out: &Path, report: &Report<'_>) -> Result<()> {
    write_file(&out.join("cost.json"), &serde_json::to_vec_pretty(report)?)?;
    write_file(&out.join("cost.csv"), table(report).as_bytes())?;
    for (name, plot) in plots(report) {
        write_file(&out.join(name), plot.as_bytes())?;
    }
    Ok(())
}

/// All points as CSV, one per line.
fn table(report: &Report<'_>) -> String {
    let mut table = String::new();
    for series in &report.measured.series {
        for (value, index) in &series.levels {
            let own = &report.measured.points[*index];
            let rows = [(report.kit, own, &report.measured.points[series.base])];
            let reference = own.reference.as_ref().map(|reference| ("reference", &**reference, own));
            for (kit, point, base) in rows.into_iter().chain(reference) {
                let is_own = kit == report.kit;
                let marks = [&report.pareto_front, &report.unclear].map(|of| is_own && of.contains(index));
                let cells = cells(report, point, base, marks);
                let named = [
                    ("parameter", series.parameter.name().to_owned()),
                    ("ladder", series.name.clone()),
                    ("value", value.clone()),
                    ("kit", kit.to_owned()),
                ];
                let (heads, cells): (Vec<_>, Vec<_>) = named.into_iter().chain(cells).unzip();
                if table.is_empty() {
                    table = csv_line(&heads.into_iter().map(str::to_owned).collect::<Vec<_>>());
                }
                table += &csv_line(&cells);
            }
        }
    }
    table
}

/// The numbers of a point, each with the head of its column. What was not measured is empty.
fn cells(
    report: &Report<'_>,
    point: &Point,
    base: &Point,
    [on_front, too_noisy]: [bool; 2],
) -> [(&'static str, String); 20] {
    let pixels = f64::from(report.width) * f64::from(report.height);
    let (bias, bias_error) = point.bias(report.reference_error, pixels);
    let time = point.time_ratio(base);
    let ratio = |of: fn(&Median) -> f64| time.as_ref().map_or(String::new(), |time| of(time).to_string());
    let judged =
        |of: fn(&Verdicts) -> u64| point.hits.as_ref().map_or(String::new(), |hits| of(hits).to_string());
    let counts = &point.counts;
    [
        ("rmse", point.error().to_string()),
        ("relative_mse", point.errors.relative_mse.to_string()),
        ("similarity", point.errors.similarity.to_string()),
        ("bias", bias.to_string()),
        ("bias_error", bias_error.to_string()),
        ("seconds", point.seconds.to_string()),
        ("ratio", ratio(|time| time.value)),
        ("ratio_low", ratio(|time| time.low)),
        ("ratio_high", ratio(|time| time.high)),
        ("rays", counts.rays().to_string()),
        ("box_tests", counts.box_tests.to_string()),
        ("primitive_tests", counts.primitive_tests.to_string()),
        ("exact_tests", counts.exact_tests.to_string()),
        ("shadow_acne", counts.shadow_acne.to_string()),
        ("light_leaks", counts.light_leaks.to_string()),
        ("rays_judged", judged(|hits| hits.rays)),
        ("wrong_hits", judged(|hits| hits.wrong)),
        ("leaks", judged(|hits| hits.leaks)),
        ("on_front", on_front.to_string()),
        ("too_noisy", too_noisy.to_string()),
    ]
}

/// The names and contents of the plots: all parameters, and the samplers if they were compared.
pub fn plots(report: &Report<'_>) -> Vec<(&'static str, String)> {
    let series = &report.measured.series;
    let with_errors = series.iter().filter(|one| !one.parameter.is_geometric());
    let (samplers, parameters): (Vec<&Series>, Vec<&Series>) =
        with_errors.partition(|one| one.parameter == Parameter::Sampler);
    let mut plots = Vec::new();
    if !parameters.is_empty() {
        let title = format!("{}: error over time, one parameter at a time", report.scene);
        plots.push(("cost.svg", draw(report, &title, &parameters, Vec::new())));
    }
    if !samplers.is_empty() {
        let title = format!("{}: samplers, 1 to {} samples per pixel", report.scene, most(&samplers));
        let guides = [(-0.5, "−1/2"), (-0.75, "−3/4")].map(|(slope, name)| (slope, name.to_owned()));
        plots.push(("samplers.svg", draw(report, &title, &samplers, guides.to_vec())));
    }
    if !report.numerics.is_empty() {
        plots.push(("numerics.svg", numerics(&report.numerics)));
    }
    plots
}

/// The largest number of samples.
fn most(samplers: &[&Series]) -> String {
    let last = samplers.iter().filter_map(|series| series.levels.last()?.0.parse::<u32>().ok());
    last.max().map_or(String::new(), |most| most.to_string())
}

fn draw(report: &Report<'_>, title: &str, series: &[&Series], guides: Vec<(f64, String)>) -> String {
    let points = &report.measured.points;
    let line = |one: &&Series| {
        let slope = report.slopes.iter().find(|(name, _)| *name == one.name);
        let name = match slope {
            Some((name, slope)) => format!("{name} ({:.2})", slope.mean),
            None => one.name.clone(),
        };
        let place = |(_, index): &(String, usize)| {
            let point = &points[*index];
            let least = point.rmse.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = point.rmse.iter().copied().fold(0.0, f64::max);
            [point.seconds, point.error(), least, greatest]
        };
        Line { name, points: one.levels.iter().map(place).collect() }
    };
    // The same levels by the reference, where it was measured beside the kit.
    let by_reference = |one: &&Series| {
        let place = |(_, index): &(String, usize)| {
            let point = points[*index].reference.as_ref()?;
            Some([point.seconds, point.error(), point.error(), point.error()])
        };
        let points: Option<Vec<_>> = one.levels.iter().map(place).collect();
        points.map(|points| Line { name: format!("{}, the reference", one.name), points })
    };
    let samplers_only = series.iter().all(|one| one.parameter == Parameter::Sampler);
    // Of the front, the points that are drawn here.
    let is_drawn =
        |index: &&usize| series.iter().any(|one| one.levels.iter().any(|(_, level)| level == *index));
    let pareto_front = report.pareto_front.iter().filter(is_drawn);
    let pareto_front = pareto_front.map(|&index| (points[index].seconds, points[index].error()));
    svg(&Plot {
        title,
        x_axis: "seconds of processor time per picture",
        y_axis: "root mean square error in linear light",
        lines: series.iter().map(line).chain(series.iter().filter_map(by_reference)).collect(),
        guides,
        pareto_front: if samplers_only { Vec::new() } else { pareto_front.collect() },
        // Below this line the error of the reference itself dominates.
        floor: report.reference_error.max(1e-9),
    })
}

/// Nanoseconds against wrong hits: each method in single and in double precision, and the functions of the kit.
fn numerics(all: &[Summary]) -> String {
    let mut lines: Vec<Line> = Vec::new();
    for one in all {
        let place = [one.nanoseconds, one.wrong_per_million, one.wrong_per_million, one.wrong_per_million];
        match lines.last_mut() {
            // The double precision version belongs to the line of its method.
            Some(line) if one.name.trim() == "in double" => line.points.push(place),
            _ if one.name.starts_with(' ') => {}
            _ => lines.push(Line { name: one.name.clone(), points: vec![place] }),
        }
    }
    svg(&Plot {
        title: "ray/triangle tests: from single to double precision",
        x_axis: "nanoseconds per test",
        y_axis: "wrong hits per million hard inputs",
        lines,
        // Zero cannot be drawn on a logarithmic axis, so it is drawn as one.
        floor: 1.0,
        ..Plot::default()
    })
}

/// The theoretical slope for a series of sample counts.
pub fn expected_slope(report: &Report<'_>, name: &str) -> Option<f64> {
    theory(if name == Parameter::Samples.name() { &report.own_sampler } else { name })
}
