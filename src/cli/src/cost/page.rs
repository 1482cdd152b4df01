//! The report as one self-contained HTML file, for screens, phones and paper.

use super::Report;
use super::error::{heat, shown};
use super::files::{expected_slope, plots};
use super::measured::Series;
use super::parameter::Parameter;
use super::search::Advice;
use super::table::{about_hits, about_kit_times, bias, goal, named, verdict, waste};
use crate::html::{around, base64, element, escape};
use crate::report::write_file;
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
    let about = format!(
        "{} × {} pixels by {}, {} rounds with other random numbers each, all pictures in turn. Errors are \
         root mean squares in linear light against a reference of {} samples per pixel, whose own error is \
         {:.1e}. Times are medians. Made by {} in {:.0} s.",
        report.width,
        report.height,
        report.kit,
        report.measured.rounds,
        report.reference_samples,
        report.reference_error,
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
    if !report.pareto_front.is_empty() {
        let words = "The broad yellow line is the Pareto front: no measured setting is both faster and more \
                     accurate. Settings that leak are left out of it.";
        body += &around("p", "class=\"about\"", words);
    }
    for series in report.measured.series.iter().filter(|series| !series.levels.is_empty()) {
        body += &ladder(report, series)?;
    }
    body += &numerics(report);
    body += &element("h2", "Not measured");
    let mut left_out = String::new();
    for (parameter, why) in &report.not_offered {
        left_out += &element("li", format!("{}: {why}", parameter.name()));
    }
    for words in &report.measured.left_out {
        left_out += &element("li", words);
    }
    for lacking in &report.measured.lacking {
        left_out += &element("li", format!("Note: {lacking}"));
    }
    left_out += &element(
        "li",
        "Lens and time have no samples of their own: each sample of a pixel has its own point on the lens \
         and its own time.",
    );
    body += &around("ul", "", &left_out);
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
    let values: String = values
        .map(|(parameter, value)| row([head_of_row(&parameter.name()), element("td", value)]))
        .collect();
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
    let name = if series.parameter == Parameter::Sampler {
        format!("sampler: {}", series.name)
    } else {
        series.name.clone()
    };
    let mut text = element("h2", name);
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
    let mut columns = vec!["", "RMSE"];
    columns.extend(if geometric { &[][..] } else { &["relative MSE", "similarity"] });
    columns.extend(report.has_bias.then_some("bias"));
    columns.extend(["ms", "rays per pixel", "tests per ray"]);
    columns.extend(if geometric { &["wrong hits", "leaks"][..] } else { &[] });
    let levels = series.levels.iter().map(|(value, index)| level(report, value, *index, geometric));
    let table = heads(&columns) + &levels.collect::<String>();
    text += &around("div", "class=\"wide\"", &around("table", "", &table));
    if let Some(waste) = waste(report, series) {
        text += &around("p", "class=\"waste\"", &escape(waste));
    }
    if let (true, Some(hits)) = (geometric, about_hits(report)) {
        text += &around("p", "class=\"about\"", &escape(format!("Wrong hits and leaks {hits}.")));
    }
    if !geometric && series.parameter != Parameter::Sampler {
        text += &pictures(report, series)?;
    }
    Ok(around("section", "", &text))
}

fn level(report: &Report<'_>, value: &str, index: usize, is_geometric: bool) -> String {
    let point = &report.measured.points[index];
    let rays = point.counts.rays();
    let tests = (point.counts.box_tests + point.counts.primitive_tests) as f64 / rays.max(1) as f64;
    let unbeaten = report.pareto_front.contains(&index);
    let mark = if unbeaten { " •" } else { "" };
    let mut cells = vec![format!("{:.5}", point.error())];
    if !is_geometric {
        cells.push(format!("{:.2e}", point.errors.relative_mse));
        cells.push(format!("{:.4}", point.errors.similarity));
    }
    if report.has_bias {
        cells.push(bias(report, index));
    }
    cells.push(format!("{:.2} ± {:.2}", 1e3 * point.seconds, 1e3 * point.spread));
    cells.push(format!("{:.2}", rays as f64 / (f64::from(report.width) * f64::from(report.height))));
    cells.push(format!("{tests:.1}"));
    if is_geometric {
        cells.push(point.hits.map_or(String::new(), |hits| hits.wrong.to_string()));
        cells.push(point.hits.map_or(String::new(), |hits| hits.leaks.to_string()));
    }
    let head = head_of_row(&format!("{}{mark}", named(report, value, index)));
    let cells: String = cells.iter().map(|cell| element("td", cell)).collect();
    around("tr", if unbeaten { "class=\"front\"" } else { "" }, &(head + &cells))
}

/// The pictures of the cheapest, the middle and the most expensive level, and their error images on one scale.
fn pictures(report: &Report<'_>, series: &Series) -> Result<String> {
    let last = series.levels.len() - 1;
    let mut shown_levels = vec![0, last / 2, last];
    shown_levels.dedup();
    let worst = &report.measured.points[series.levels[0].1];
    // White stands for three times the mean error of the cheapest level.
    let most = 3.0 * worst.error();
    let mut figures = String::new();
    for level in shown_levels {
        let (value, index) = &series.levels[level];
        let film = &report.measured.points[*index].film;
        let picture = embedded(&shown(film)?)?;
        let heat = embedded(&heat(film, &report.right.film, most))?;
        let about = escape(format!("the picture with {} {value}", series.name));
        let images =
            format!("<img src=\"{picture}\" alt=\"{about}\"><img src=\"{heat}\" alt=\"its errors\">");
        figures += &around("figure", "", &(images + &element("figcaption", value)));
    }
    Ok(around("div", "class=\"pictures\"", &figures))
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
    if let Some(warning) = about_kit_times(report) {
        text += &around("p", "class=\"about\"", warning);
    }
    around("section", "", &text)
}
