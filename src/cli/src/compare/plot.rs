//! The plot: bars for time and for tests, one pair per row, on logarithmic scales. The same numbers give the
//! same SVG file.

use super::measure::Measured;
use crate::svg::{Drawing, End, Ink, Middle, SMALL, Start, TEXT};

const ROW: f64 = 34.0;
const LABEL: f64 = 270.0;
const BARS: f64 = 270.0;
const GAP: f64 = 95.0;
const TOP: f64 = 110.0;

/// One panel: numbers above 0, and their format.
struct Panel {
    title: &'static str,
    /// The remark below the title.
    what: &'static str,
    value: fn(&Measured) -> f64,
    write: fn(f64) -> String,
    ink: Ink,
}

fn tests(one: &Measured) -> f64 {
    let counts = &one.counts;
    (counts.box_tests + counts.node_visits + counts.primitive_tests) as f64 / one.rays.max(1) as f64
}

const PANELS: [Panel; 2] = [
    Panel {
        title: "nanoseconds per ray",
        what: "logarithmic",
        value: |one| one.nanoseconds,
        write: |x| format!("{x:.0}"),
        ink: Ink::Color(5),
    },
    Panel {
        title: "visits and tests per ray",
        what: "of boxes and primitives, logarithmic",
        value: tests,
        write: |x| format!("{x:.1}"),
        ink: Ink::Color(3),
    },
];

/// The plot.
pub fn svg(title: &str, rows: &[Measured]) -> String {
    let height = TOP + ROW * rows.len() as f64 + 44.0;
    let mut drawing = Drawing::new(title, LABEL + 2.0 * (BARS + GAP), height);
    drawing.text([10.0, 34.0], Start, TEXT, Ink::Text, title);
    for (i, row) in rows.iter().enumerate() {
        let y = TOP + ROW * (i as f64 + 0.7);
        drawing.text([LABEL - 12.0, y], End, SMALL, Ink::Text, &row.name);
    }
    for (i, panel) in PANELS.iter().enumerate() {
        panel.draw(&mut drawing, LABEL + i as f64 * (BARS + GAP), rows);
    }
    drawing.svg()
}

impl Panel {
    fn draw(&self, drawing: &mut Drawing, left: f64, rows: &[Measured]) {
        let values: Vec<f64> = rows.iter().map(self.value).collect();
        let most = values.iter().copied().fold(1.0, f64::max);
        let least = values.iter().copied().filter(|x| *x > 0.0).fold(most, f64::min);
        // Begin the axis at least one power of ten below the smallest number, so that no bar has length 0.
        let (low, high) =
            ((0.5 * least).log10().floor(), most.log10().ceil().max((0.5 * least).log10().floor() + 1.0));
        let x = |value: f64| left + BARS * ((value.log10() - low) / (high - low)).max(0.0);
        let bottom = TOP + ROW * rows.len() as f64;
        drawing.text([left, TOP - 38.0], Start, SMALL, Ink::Text, self.title);
        drawing.text([left, TOP - 12.0], Start, SMALL, Ink::Faint, self.what);
        for power in low as i32..=high as i32 {
            let at = x(10f64.powi(power));
            drawing.line([at, TOP], [at, bottom], Ink::Faint.pen(0.5));
            let text = power_of_ten(power);
            drawing.text([at, bottom + 28.0], Middle, SMALL, Ink::Faint, &text);
        }
        let winner = values.iter().copied().fold(f64::INFINITY, f64::min);
        for (i, &value) in values.iter().enumerate() {
            let y = TOP + ROW * (i as f64 + 0.15);
            let (end, star) = (x(value), if value == winner { "*" } else { "" });
            drawing.rectangle([left, y], [end, y + 0.7 * ROW], self.ink, 1.0);
            let text = format!("{}{star}", (self.write)(value));
            drawing.text([end + 6.0, y + 0.55 * ROW], Start, SMALL, Ink::Text, &text);
        }
    }
}

fn power_of_ten(power: i32) -> String {
    match power {
        0..=5 => crate::report::Thousands(10u64.pow(power.unsigned_abs())).to_string(),
        _ => format!("1e{power}"),
    }
}
