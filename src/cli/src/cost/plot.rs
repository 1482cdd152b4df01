//! A plot of error over time on logarithmic axes. The same numbers give the same SVG file.

use std::fmt::Write;

/// The contents of a plot.
pub struct Plot<'a> {
    pub title: &'a str,
    pub x_axis: &'a str,
    pub y_axis: &'a str,
    pub lines: Vec<Line>,
    /// Slopes to compare with, drawn from the first point of the first line on, and their names.
    pub guides: Vec<(f64, String)>,
    /// The points of the Pareto front, from left to right.
    pub pareto_front: Vec<(f64, f64)>,
    /// The smallest error that is drawn; smaller ones are drawn at this height.
    pub floor: f64,
}

/// Points with a name.
pub struct Line {
    pub name: String,
    /// x, y, and the smallest and the largest measured y.
    pub points: Vec<[f64; 4]>,
}

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 560.0;
const LEFT: f64 = 86.0;
const RIGHT: f64 = 690.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 500.0;

/// Tol's bright and muted colours, which colour-blind readers can distinguish; in this order they also differ
/// in grey.
const COLORS: [&str; 8] =
    ["#332288", "#ee6677", "#228833", "#997700", "#66ccee", "#aa3377", "#44aa99", "#555555"];

/// A logarithmic axis, which ends at whole or half powers of ten.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Axis {
        let logs = values.filter(|value| *value > 0.0 && value.is_finite()).map(f64::log10);
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if low > high {
            return Axis { low: 0.0, high: 1.0, from, to };
        }
        let (low, high) = ((2.0 * low - 0.1).floor() / 2.0, (2.0 * high + 0.1).ceil() / 2.0);
        Axis { low, high, from, to }
    }

    fn at(&self, value: f64) -> f64 {
        self.from + (self.to - self.from) * (value.log10() - self.low) / (self.high - self.low)
    }

    /// The ticks: 1, 2 and 5 times the powers of ten between the ends, or only the powers if there are many.
    fn ticks(&self) -> Vec<(f64, bool)> {
        let powers = (self.low - 1.0) as i32..=self.high.ceil() as i32;
        let ticks = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|digit| (digit, power)));
        let within = |value: f64| (self.low - 1e-9..=self.high + 1e-9).contains(&value.log10());
        let named = |digit: f64| digit == 1.0 || self.high - self.low < 2.6;
        ticks
            .map(|(digit, power)| (digit * 10f64.powi(power), named(digit)))
            .filter(|(value, _)| within(*value))
            .collect()
    }
}

/// The plot as SVG.
pub fn svg(plot: &Plot<'_>) -> String {
    let floored = |y: f64| y.max(plot.floor);
    let points = || plot.lines.iter().flat_map(|line| &line.points);
    let x = Axis::over(points().map(|point| point[0]), LEFT, RIGHT);
    let y = Axis::over(points().flat_map(|point| [floored(point[1]), floored(point[3])]), BOTTOM, TOP);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"13\" role=\"img\">\n<title>{0}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"28\" font-size=\"17\">{0}</text>\n",
        escaped(plot.title)
    );
    axes(&mut out, plot, &x, &y);
    pareto_front(&mut out, &plot.pareto_front, &x, &y, plot.floor);
    guides(&mut out, plot, &x, &y);
    let mut labels = Vec::new();
    for (index, line) in plot.lines.iter().enumerate() {
        let color = COLORS[index % COLORS.len()];
        draw(&mut out, line, color, index, &x, &y, plot.floor);
        if let Some(last) = line.points.last() {
            labels.push((y.at(floored(last[1])), x.at(last[0]), color, line.name.clone()));
        }
    }
    write_labels(&mut out, labels);
    out + "</svg>\n"
}

fn axes(out: &mut String, plot: &Plot<'_>, x: &Axis, y: &Axis) {
    for (value, named) in x.ticks() {
        let at = x.at(value);
        let _ = writeln!(
            out,
            "<line x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{BOTTOM}\" stroke=\"#e4e4e4\"/>"
        );
        if named {
            let label = number(value);
            let _ = writeln!(
                out,
                "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#555\">{label}</text>",
                BOTTOM + 19.0
            );
        }
    }
    for (value, named) in y.ticks() {
        let at = y.at(value);
        let _ = writeln!(
            out,
            "<line x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{RIGHT}\" y2=\"{at:.1}\" stroke=\"#e4e4e4\"/>"
        );
        if named {
            let label = number(value);
            let _ = writeln!(
                out,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">{label}</text>",
                LEFT - 8.0,
                at + 4.5
            );
        }
    }
    let middle = (TOP + BOTTOM) / 2.0;
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\n\
         <text x=\"22\" y=\"{middle:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 22 {middle:.1})\">{}</text>",
        (LEFT + RIGHT) / 2.0,
        BOTTOM + 46.0,
        escaped(plot.x_axis),
        escaped(plot.y_axis)
    );
}

/// The Pareto front as a broad step line: every setting above it is slower or less accurate than one on it.
fn pareto_front(out: &mut String, points: &[(f64, f64)], x: &Axis, y: &Axis, floor: f64) {
    let mut path = String::new();
    let mut before = None;
    for &(time, error) in points {
        let (time, error) = (x.at(time), y.at(error.max(floor)));
        match before {
            None => path += &format!("M{time:.1} {error:.1}"),
            Some(_) => path += &format!("H{time:.1}V{error:.1}"),
        }
        before = Some(error);
    }
    if before.is_some() {
        let _ = writeln!(
            out,
            "<path d=\"{path}\" fill=\"none\" stroke=\"#ffcc66\" stroke-width=\"9\" stroke-opacity=\"0.6\"/>"
        );
    }
}

fn guides(out: &mut String, plot: &Plot<'_>, x: &Axis, y: &Axis) {
    let Some(&[x0, y0, ..]) = plot.lines.first().and_then(|line| line.points.first()) else { return };
    let y0 = y0.max(plot.floor);
    for (slope, name) in &plot.guides {
        // Draw to the right end, or to where the line leaves the plot at the bottom.
        let to_bottom = (y.low - y0.log10()) / slope;
        let length = (x.high - x0.log10()).min(if *slope < 0.0 { to_bottom } else { f64::INFINITY });
        let end = (x0 * 10f64.powf(length), y0 * 10f64.powf(slope * length));
        let (x1, y1, x2, y2) = (x.at(x0), y.at(y0), x.at(end.0), y.at(end.1));
        let _ = writeln!(
            out,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"#888\" \
             stroke-dasharray=\"6 5\"/>\n<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#666\" \
             font-size=\"12\">{}</text>",
            x2 - 6.0,
            y2 - 6.0,
            escaped(name)
        );
    }
}

/// One line with markers of its own shape for colour-blind readers, and the range over all rounds at each point.
fn draw(out: &mut String, line: &Line, color: &str, index: usize, x: &Axis, y: &Axis, floor: f64) {
    let at = |point: &[f64; 4]| (x.at(point[0]), y.at(point[1].max(floor)));
    let path: Vec<String> = line.points.iter().map(at).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.8\"/>",
        path.join(" ")
    );
    for point in &line.points {
        let (cx, cy) = at(point);
        let (low, high) = (y.at(point[2].max(floor)), y.at(point[3].max(floor)));
        if (low - high).abs() > 1.0 {
            let _ = writeln!(
                out,
                "<line x1=\"{cx:.1}\" y1=\"{low:.1}\" x2=\"{cx:.1}\" y2=\"{high:.1}\" stroke=\"{color}\"/>"
            );
        }
        let r = 4.0;
        let _ = match index % 4 {
            0 => writeln!(out, "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"{r}\" fill=\"{color}\"/>"),
            1 => writeln!(
                out,
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{2}\" height=\"{2}\" fill=\"{color}\"/>",
                cx - r,
                cy - r,
                2.0 * r
            ),
            2 => writeln!(out, "<path d=\"M{cx:.1} {:.1}l5 9h-10z\" fill=\"{color}\"/>", cy - 5.5),
            _ => writeln!(
                out,
                "<path d=\"M{cx:.1} {:.1}l5.5 5.5-5.5 5.5-5.5-5.5z\" fill=\"{color}\"/>",
                cy - 5.5
            ),
        };
    }
}

/// Writes the names beside the ends of the lines, moved apart.
fn write_labels(out: &mut String, mut labels: Vec<(f64, f64, &str, String)>) {
    labels.sort_by(|a, b| a.0.total_cmp(&b.0));
    const APART: f64 = 17.0;
    let mut free = TOP - 10.0;
    for (y, x, color, name) in &labels {
        let at = y.max(free).min(HEIGHT - 10.0);
        free = at + APART;
        let _ = writeln!(
            out,
            "<line x1=\"{:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{at:.1}\" stroke=\"{color}\" stroke-opacity=\"0.35\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"{color}\">{}</text>",
            x + 6.0,
            RIGHT + 8.0,
            RIGHT + 12.0,
            at + 4.5,
            escaped(name)
        );
    }
}

/// The number in a short form.
fn number(value: f64) -> String {
    match value {
        value if (0.001..10_000.0).contains(&value) => {
            let digits = (-value.log10()).ceil().max(0.0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.0e}"),
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(lines: Vec<Line>) -> String {
        let guides = vec![(-0.5, "slope −1/2".to_owned())];
        let pareto_front = vec![(0.001, 0.1), (0.004, 0.05)];
        svg(&Plot {
            title: "a < b",
            x_axis: "seconds",
            y_axis: "error",
            lines,
            guides,
            pareto_front,
            floor: 1e-6,
        })
    }

    #[test]
    fn a_plot_is_the_same_for_the_same_numbers() {
        let line = |name: &str, scale: f64| Line {
            name: name.into(),
            points: (0..5)
                .map(|i| {
                    let (x, y) = (0.001 * 2f64.powi(i), scale * 2f64.powi(-i).sqrt());
                    [x, y, 0.9 * y, 1.1 * y]
                })
                .collect(),
        };
        insta::assert_snapshot!(plot(vec![line("random", 0.1), line("jittered & more", 0.08)]));
    }

    #[test]
    fn nothing_and_no_error_can_be_drawn() {
        assert!(plot(Vec::new()).ends_with("</svg>\n"));
        let flat = Line { name: "exact".into(), points: vec![[0.001, 0.0, 0.0, 0.0]] };
        let drawn = plot(vec![flat]);
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
    }

    #[test]
    fn numbers_are_written_short() {
        let written = [0.001, 0.02, 0.5, 1.0, 20.0, 5000.0, 1e-5, 1e6].map(number);
        assert_eq!(written, ["0.001", "0.02", "0.5", "1", "20", "5000", "1e-5", "1e6"]);
    }
}
