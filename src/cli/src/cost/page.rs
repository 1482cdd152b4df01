//! The report as one self-contained HTML file, for screens, phones and paper.

use super::Report;
use super::error::{heat, shown};
use super::files::{expected_slope, plots};
use super::measured::{Point, Series};
use super::parameter::Parameter;
use super::search::Advice;
use super::table::{about_hits, cells, goal, heading, heads as special_heads, named, ratio, verdict, waste};
use crate::html::{around, base64, element, escape};
use crate::report::{counted, write_file};
use anyhow::{Context, Result};
use image::RgbImage;
use std::path::Path;

/// Writes the page.
pub fn write(file: &Path, report: &Report<'_>) -> Result<()> {
    write_file(file, page(report)?.as_bytes())
}

fn page(report: &Report<'_>) -> Result<String> {
    let title = format!("What accuracy costs: {}", report.scene);
    let mut body = element("h1", &title);
    let others = if report.measured.rounds == 1 { "" } else { " with other random numbers each" };
    let rounds = counted(report.measured.rounds, "round") + others;
    let about = format!(
        "{} × {} pixels by {}, {rounds}, all pictures in turn. Errors are \
         root mean squares in linear light against a picture of {} samples per pixel, whose own error is \
         {:.1e}. Times are medians of the {}; a ratio is the median over the rounds, to the line marked =, with its 95 % \
         interval. Made by {} in {:.0} s.",
        report.width,
        report.height,
        report.kit,
        report.reference_samples,
        report.reference_error,
        report.about_times(),
        element("code", &report.command),
        report.took
    );
    body += &around("p", "class=\"about\"", &about);
    if report.partial {
        let words = "Stopped before the end: the report shows what had been measured until then.";
        body += &around("p", "class=\"warning\"", words);
    }
    if let Some(advice) = &report.advice {
        body += &proposal(report, advice);
    }
    for (_, plot) in plots(report) {
        body += &around("figure", "class=\"plot\"", &plot);
    }
    let mut words = report.about_marks();
    if !report.pareto_front.is_empty() {
        words += ". The dashed black line in the plot is the Pareto front; a vertical line is the range of errors over the rounds";
    }
    body += &around("p", "class=\"about\"", &escape(words + "."));
    if !report.beside.is_empty() {
        body += &around("p", "class=\"about\"", &escape(&report.beside));
    }
    for series in report.measured.series.iter().filter(|series| !series.levels.is_empty()) {
        body += &ladder(report, series)?;
    }
    body += &numerics(report);
    body += &element("h2", "Not measured");
    let not_offered =
        report.not_offered.iter().map(|(parameter, why)| format!("{}: {why}", parameter.name()));
    let lacking = report.measured.lacking.iter().map(|lacking| format!("Note: {lacking}"));
    let left_out = not_offered.chain(report.measured.left_out.iter().cloned()).chain(lacking);
    let always = "Lens and time have no samples of their own: each sample of a pixel has its own point on the lens \
                  and its own time.";
    let items: String = left_out.chain([always.into()]).map(|words| element("li", words)).collect();
    body += &around("ul", "", &items);
    Ok(format!(
        "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">{}<style>{}</style></head>\
         <body>{body}</body></html>",
        element("title", &title),
        include_str!("style.css")
    ))
}

/// A row of a table from HTML cells; the first cell may be a head.
fn row(cells: impl IntoIterator<Item = String>) -> String {
    around("tr", "", &cells.into_iter().collect::<String>())
}

fn heads(heads: &[&str]) -> String {
    row(heads.iter().map(|head| element("th", head)))
}

fn head_of_row(words: &str) -> String {
    around("th", "scope=\"row\"", &escape(words))
}

fn proposal(report: &Report<'_>, advice: &Advice) -> String {
    let values = advice.values.iter();
    let values: String =
        values.map(|(parameter, value)| row([head_of_row(parameter.name()), element("td", value)])).collect();
    let mut text = element("h2", goal(report, advice)) + &around("table", "class=\"values\"", &values);
    text.extend(verdict(advice).iter().map(|line| element("p", line)));
    if !advice.steps.is_empty() {
        let mut steps = heads(&["parameter", "new value", "error", "seconds in full size"]);
        for step in &advice.steps {
            steps += &row([
                element("td", step.parameter.name()),
                element("td", &step.to),
                element("td", format!("{:.4}", step.error)),
                element("td", format!("{:.2}", step.seconds)),
            ]);
        }
        let summary =
            element("summary", "the steps of the greedy search: each lowers the error most for its time");
        text += &around("details", "", &(summary + &around("table", "", &steps)));
    }
    around("section", "class=\"advice\"", &text)
}

fn ladder(report: &Report<'_>, series: &Series) -> Result<String> {
    let geometric = series.parameter.is_geometric();
    let mut text = element("h2", heading(series)) + &element("p", series.parameter.trade());
    if let Some((name, slope)) = report.slopes.iter().find(|(name, _)| *name == series.name) {
        let theory = expected_slope(report, name)
            .map_or(String::new(), |theory| format!(" (in theory {theory} where pictures have edges)"));
        let slope = element("b", format!("{:.2} ± {:.2}", slope.mean, slope.half_interval));
        text += &around(
            "p",
            "",
            &format!("The error is proportional to the number of samples to the power {slope}{theory}"),
        );
    }
    let special = special_heads(report, series);
    let mut columns = vec!["", "RMSE", special[0], special[1], "ms", "ratio", special[2]];
    if special[1].is_empty() {
        columns.remove(3);
    }
    let mut levels = Vec::new();
    for (value, index) in &series.levels {
        let point = &report.measured.points[*index];
        let points = [point, &report.measured.points[series.base]];
        let name = format!("{} {}", named(report, value, *index), report.mark(*index));
        let is_front = report.pareto_front.contains(index);
        levels.push(level(report, series, points, name.trim_end(), is_front));
        if let Some(reference) = &point.reference {
            levels.push(level(report, series, [reference, point], "the reference", false));
        }
    }
    let table = heads(&columns) + &levels.concat();
    text += &around("div", "class=\"wide\"", &around("table", "", &table));
    if let Some(waste) = waste(report, series) {
        text += &around("p", "class=\"waste\"", &escape(waste));
    }
    if let (true, Some(hits)) = (geometric, about_hits(report)) {
        text += &around("p", "class=\"about\"", &escape(format!("Wrong hits and leaks: {hits}.")));
    }
    if !geometric && series.parameter != Parameter::Sampler {
        text += &pictures(report, series)?;
    }
    Ok(around("section", "", &text))
}

/// The row of a point, whose time is compared with that of `base`.
fn level(
    report: &Report<'_>,
    series: &Series,
    [point, base]: [&Point; 2],
    name: &str,
    is_front: bool,
) -> String {
    let [one, two, three] = cells(report, series, point);
    let ms = format!("{:.2}", 1e3 * point.seconds);
    let cells = [format!("{:.5}", point.error()), one, two, ms, ratio(point, base), three];
    // A bias takes the place of two numbers.
    let is_shown =
        |(place, _): &(usize, &String)| *place != 2 || !special_heads(report, series)[1].is_empty();
    let cells = cells.iter().enumerate().filter(is_shown).map(|(_, cell)| element("td", cell));
    let cells: String = cells.collect();
    around("tr", if is_front { "class=\"front\"" } else { "" }, &(head_of_row(name) + &cells))
}

/// The pictures of the first, the middle and the last level, and their error images on one scale.
fn pictures(report: &Report<'_>, series: &Series) -> Result<String> {
    let last = series.levels.len() - 1;
    // Of a ray offset every level is shown: it is judged by the eye.
    let mut shown_levels = match series.parameter {
        Parameter::RayOffset => (0..=last).collect(),
        _ => vec![0, last / 2, last],
    };
    shown_levels.dedup();
    let worst = &report.measured.points[series.levels[0].1];
    // Errors are shown against the converged picture, on a scale whose white is three times the mean error of the first level. A
    // ray offset is shown against the error bound, with the same samples, so that only acne and leaks are left; white is a
    // tenth of full light.
    let of_offsets = series.levels.last().filter(|_| series.parameter == Parameter::RayOffset);
    let (right, most, what) = match of_offsets {
        Some((_, bound)) => {
            (&report.measured.points[*bound].film, 0.1, "its differences from the error bound")
        }
        None => (&report.right.film, 3.0 * worst.error(), "its errors"),
    };
    let mut figures = String::new();
    for level in shown_levels {
        let (value, index) = &series.levels[level];
        let film = &report.measured.points[*index].film;
        let picture = embedded(&shown(film)?)?;
        let heat = embedded(&heat(film, right, most))?;
        let about = escape(format!("the picture with {} {value}", series.name));
        let images = format!("<img src=\"{picture}\" alt=\"{about}\"><img src=\"{heat}\" alt=\"{what}\">");
        figures += &around("figure", "", &(images + &element("figcaption", value)));
    }
    let below = element("p", format!("Below each picture: {what}."));
    Ok(around("div", "class=\"pictures\"", &figures) + &below)
}

fn embedded(picture: &RgbImage) -> Result<String> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    picture.write_with_encoder(encoder).context("a picture cannot be encoded")?;
    Ok(format!("data:image/png;base64,{}", base64(&bytes)))
}

fn numerics(report: &Report<'_>) -> String {
    if report.numerics.is_empty() {
        return String::new();
    }
    let mut table = heads(&["", "ns per test", "wrong per million", "leaks per million"]);
    for one in &report.numerics {
        table += &row([
            head_of_row(&one.name),
            element("td", format!("{:.1}", one.nanoseconds)),
            element("td", format!("{:.0}", one.wrong_per_million)),
            element("td", format!("{:.0}", one.leaks_per_million)),
        ]);
    }
    let words = "Ray/triangle tests on hard inputs, judged exactly: wrong verdicts, and rays that leave a \
                 closed mesh from inside.";
    let mut text = element("h2", "What precision costs") + &around("p", "class=\"about\"", words);
    text += &around("div", "class=\"wide\"", &around("table", "", &table));
    around("section", "", &text)
}
