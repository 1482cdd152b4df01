//! The report: one HTML file that needs nothing else, for screens, phones and paper.

use super::Told;
use super::advice::Advice;
use super::error::{heat, shown};
use super::files::{expected_slope, plots};
use super::ladder::Knob;
use super::measure::Series;
use super::table::{about_hits, goal, named, verdict, waste};
use anyhow::{Context, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use image::RgbImage;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use raykata::film::write_atomically;
use std::io::Write;
use std::path::Path;

/// Writes the page.
pub fn write(file: &Path, told: &Told<'_>) -> Result<()> {
    let page = page(told)?.into_string();
    write_atomically(file, |out| out.write_all(page.as_bytes()))
        .with_context(|| format!("cannot write {}", file.display()))
}

fn page(told: &Told<'_>) -> Result<Markup> {
    let title = format!("What accuracy costs: {}", told.scene);
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body {
                h1 { (title) }
                p.about {
                    (told.width) " × " (told.height) " pixels by " (told.kit) ", " (told.measured.rounds)
                    " rounds by turns, each with other random numbers. Errors are root mean squares in linear light, against "
                    (told.reference_samples) " samples a pixel, which are off by " (format!("{:.1e}", told.reference_error))
                    " themselves. Times are medians. Made by " code { (told.command) } " in " (format!("{:.0}", told.took)) " s."
                }
                @if told.partial { p.warning { "Stopped before the end: this is what had been measured by then." } }
                @if let Some(advice) = &told.advice { (proposal(told, advice)) }
                @for (_, plot) in plots(told) { figure.plot { (PreEscaped(plot)) } }
                @if !told.front.is_empty() {
                    p.about { "The broad yellow line is the front: no setting that was measured is both faster and more accurate. What leaks is left out of it." }
                }
                @for series in told.measured.series.iter().filter(|series| !series.rungs.is_empty()) { (ladder(told, series)?) }
                (numerics(told))
                h2 { "Not measured" }
                ul {
                    @for (knob, why) in &told.not_offered { li { (knob.name()) ": " (why) } }
                    @for left_out in &told.measured.left_out { li { (left_out) } }
                    @for lacking in &told.measured.lacking { li { "Lacking: " (lacking) } }
                    li { "Lens and time have no samples of their own: each sample of a pixel has its own place on the lens and its own moment." }
                }
            }
        }
    })
}

fn proposal(told: &Told<'_>, advice: &Advice) -> Markup {
    html! {
        section.advice {
            h2 { (goal(told, advice)) }
            table.values {
                @for (knob, value) in &advice.values { tr { th scope="row" { (knob.name()) } td { (value) } } }
            }
            @for line in verdict(advice) { p { (line) } }
            @if !advice.steps.is_empty() {
                details {
                    summary { "the way there: always the step that lowers the error most for its time" }
                    table {
                        tr { th { "turn" } th { "to" } th { "error" } th { "seconds in full size" } }
                        @for step in &advice.steps {
                            tr {
                                td { (step.knob.name()) }
                                td { (step.to) }
                                td { (format!("{:.4}", step.error)) }
                                td { (format!("{:.2}", step.seconds)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn ladder(told: &Told<'_>, series: &Series) -> Result<Markup> {
    let name =
        if series.knob == Knob::Sampler { format!("sampler: {}", series.name) } else { series.name.clone() };
    let slope = told.slopes.iter().find(|(name, _)| *name == series.name);
    Ok(html! {
        section {
            h2 { (name) }
            @if let Some((name, slope)) = slope {
                p {
                    "Error falls as samples to the power " b { (format!("{:.2} ± {:.2}", slope.mean, slope.half_interval)) }
                    @if let Some(theory) = expected_slope(told, name) { " (in theory " (theory) " where there are edges)" }
                }
            }
            div.wide {
                table {
                    tr {
                        th {} th { "RMSE" }
                        @if !series.knob.is_geometric() { th { "relative MSE" } th { "similarity" } }
                        th { "ms" } th { "rays a pixel" } th { "tests a ray" }
                        @if series.knob.is_geometric() { th { "wrong hits" } th { "leaks" } }
                    }
                    @for (value, index) in &series.rungs { (rung(told, value, *index, series.knob.is_geometric())) }
                }
            }
            @if let Some(waste) = waste(told, series) { p.waste { (waste) } }
            @if let (true, Some(hits)) = (series.knob.is_geometric(), about_hits(told)) { p.about { "Wrong hits and leaks " (hits) "." } }
            @if !series.knob.is_geometric() && series.knob != Knob::Sampler { (pictures(told, series)?) }
        }
    })
}

fn rung(told: &Told<'_>, value: &str, index: usize, is_geometric: bool) -> Markup {
    let point = &told.measured.points[index];
    let rays = point.counts.rays();
    let tests = (point.counts.box_tests + point.counts.primitive_tests) as f64 / rays.max(1) as f64;
    let unbeaten = told.front.contains(&index);
    html! {
        tr.front[unbeaten] {
            th scope="row" { (named(told, value, index)) @if unbeaten { " •" } }
            td { (format!("{:.5}", point.error())) }
            @if !is_geometric {
                td { (format!("{:.2e}", point.errors.relative_mse)) }
                td { (format!("{:.4}", point.errors.similarity)) }
            }
            td { (format!("{:.2} ± {:.2}", 1e3 * point.seconds, 1e3 * point.spread)) }
            td { (format!("{:.2}", rays as f64 / (f64::from(told.width) * f64::from(told.height)))) }
            td { (format!("{tests:.1}")) }
            @if is_geometric {
                td { @if let Some(hits) = point.hits { (hits.wrong) } }
                td { @if let Some(hits) = point.hits { (hits.leaks) } }
            }
        }
    }
}

/// The cheapest, the middle and the dearest, and where they are wrong, on one scale.
fn pictures(told: &Told<'_>, series: &Series) -> Result<Markup> {
    let last = series.rungs.len() - 1;
    let mut shown_rungs = vec![0, last / 2, last];
    shown_rungs.dedup();
    let worst = &told.measured.points[series.rungs[0].1];
    // A pixel that is off by three times the mean of the cheapest is white.
    let most = 3.0 * worst.error();
    let mut figures = Vec::new();
    for rung in shown_rungs {
        let (value, index) = &series.rungs[rung];
        let film = &told.measured.points[*index].film;
        figures.push((value, embedded(&shown(film)?)?, embedded(&heat(film, &told.right.film, most))?));
    }
    Ok(html! {
        div.pictures {
            @for (value, picture, heat) in figures {
                figure {
                    img src=(picture) alt={ "the picture with " (series.name) " " (value) };
                    img src=(heat) alt={ "where it is wrong" };
                    figcaption { (value) }
                }
            }
        }
    })
}

fn embedded(picture: &RgbImage) -> Result<String> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    picture.write_with_encoder(encoder).context("a picture cannot be encoded")?;
    Ok(format!("data:image/png;base64,{}", BASE64.encode(bytes)))
}

#[cfg(feature = "author")]
fn numerics(told: &Told<'_>) -> Markup {
    html! {
        @if !told.numerics.is_empty() {
            section {
                h2 { "what right digits cost" }
                p.about { "Ray/triangle tests on hard inputs, judged exactly: verdicts that are wrong, and rays from inside closed meshes that get out." }
                div.wide {
                    table {
                        tr { th {} th { "ns a test" } th { "wrong in a million" } th { "leaks in a million" } }
                        @for one in &told.numerics {
                            tr {
                                th scope="row" { (one.name) }
                                td { (format!("{:.1}", one.nanoseconds)) }
                                td { (format!("{:.0}", one.wrong_per_million)) }
                                td { (format!("{:.0}", one.leaks_per_million)) }
                            }
                        }
                    }
                }
                @if let Some(warning) = super::table::about_kit_times(told) { p.about { (warning) } }
            }
        }
    }
}

#[cfg(not(feature = "author"))]
fn numerics(_: &Told<'_>) -> Markup {
    html! {}
}
