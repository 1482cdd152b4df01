//! The plot: bars for time and for tests, one pair per row, on logarithmic scales. The same numbers give the
//! same SVG file.

use super::measure::Measured;
use anyhow::{Context, Result};
use std::fmt::Write;
use std::path::Path;

const ROW: f64 = 26.0;
const LABEL: f64 = 190.0;
const BARS: f64 = 330.0;
const GAP: f64 = 60.0;
const TOP: f64 = 64.0;

/// Writes the plot.
pub fn write(file: &Path, title: &str, rows: &[Measured]) -> Result<()> {
    let text = svg(title, rows);
    raykata::film::write_atomically(file, |out| std::io::Write::write_all(out, text.as_bytes()))
        .with_context(|| format!("cannot write {}", file.display()))
}

/// One panel: numbers above 0, and their format.
struct Panel {
    title: &'static str,
    value: fn(&Measured) -> f64,
    write: fn(f64) -> String,
    color: &'static str,
}

fn tests(one: &Measured) -> f64 {
    let counts = &one.counts;
    (counts.box_tests + counts.node_visits + counts.primitive_tests) as f64 / one.rays.max(1) as f64
}

const PANELS: [Panel; 2] = [
    Panel {
        title: "nanoseconds per ray",
        value: |one| one.nanoseconds,
        write: |x| format!("{x:.0}"),
        color: "#4477aa",
    },
    Panel {
        title: "visits, box tests and primitive tests per ray",
        value: tests,
        write: |x| format!("{x:.1}"),
        color: "#cc6677",
    },
];

fn svg(title: &str, rows: &[Measured]) -> String {
    let (width, height) = (LABEL + 2.0 * (BARS + GAP), TOP + ROW * rows.len() as f64 + 30.0);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"10\" y=\"22\" font-size=\"16\">{}</text>\n",
        escaped(title)
    );
    for (i, row) in rows.iter().enumerate() {
        let y = TOP + ROW * (i as f64 + 0.65);
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{y:.1}\" text-anchor=\"end\">{}</text>",
            LABEL - 10.0,
            escaped(&row.name)
        );
    }
    for (i, panel) in PANELS.iter().enumerate() {
        panel.draw(&mut out, LABEL + i as f64 * (BARS + GAP), rows);
    }
    out + "</svg>\n"
}

impl Panel {
    fn draw(&self, out: &mut String, left: f64, rows: &[Measured]) {
        let values: Vec<f64> = rows.iter().map(self.value).collect();
        let most = values.iter().copied().fold(1.0, f64::max);
        let least = values.iter().copied().filter(|x| *x > 0.0).fold(most, f64::min);
        // Begin the axis at least one power of ten below the smallest number, so that no bar has length 0.
        let (low, high) =
            ((0.5 * least).log10().floor(), most.log10().ceil().max((0.5 * least).log10().floor() + 1.0));
        let x = |value: f64| left + BARS * ((value.log10() - low) / (high - low)).max(0.0);
        let bottom = TOP + ROW * rows.len() as f64;
        let _ = writeln!(out, "<text x=\"{left:.1}\" y=\"44\">{}, logarithmic</text>", self.title);
        for power in low as i32..=high as i32 {
            let at = x(10f64.powi(power));
            let _ = writeln!(
                out,
                "<line x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{bottom:.1}\" stroke=\"#ccc\"/>\
                 <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#666\" font-size=\"11\">{}</text>",
                bottom + 16.0,
                power_of_ten(power)
            );
        }
        let winner = values.iter().copied().fold(f64::INFINITY, f64::min);
        for (i, &value) in values.iter().enumerate() {
            let y = TOP + ROW * (i as f64 + 0.2);
            let (end, weight) = (x(value), if value == winner { "bold" } else { "normal" });
            let _ = writeln!(
                out,
                "<rect x=\"{left:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" font-weight=\"{weight}\" font-size=\"12\">{}</text>",
                end - left,
                0.6 * ROW,
                self.color,
                end + 4.0,
                y + 0.45 * ROW,
                (self.write)(value)
            );
        }
    }
}

fn power_of_ten(power: i32) -> String {
    match power {
        0..=5 => crate::report::Thousands(10u64.pow(power.unsigned_abs())).to_string(),
        _ => format!("1e{power}"),
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
