//! A plot of error over time on logarithmic axes, with the names of its lines below. The same numbers give the same SVG file.

use crate::svg::{self, Axis, Drawing, End, Ink, Middle, Pen, Point, SMALL, Start, TEXT};

/// The contents of a plot.
#[derive(Default)]
pub struct Plot<'a> {
    /// The heading.
    pub title: &'a str,
    /// What the horizontal axis shows, with its unit.
    pub x_axis: &'a str,
    /// The same for the vertical axis.
    pub y_axis: &'a str,
    /// What is drawn.
    pub lines: Vec<Line>,
    /// Slopes to compare with, drawn from the first point of the first line on, as numbers and in writing.
    pub guides: Vec<(f64, String)>,
    /// The points of the Pareto front, from left to right.
    pub pareto_front: Vec<(f64, f64)>,
    /// The smallest error that is drawn; smaller ones are drawn at this height.
    pub floor: f64,
}

impl Plot<'_> {
    /// Whether a point lies below the floor.
    fn holds_less(&self) -> bool {
        self.lines.iter().flat_map(|line| &line.points).any(|point| point[1] < self.floor)
    }
}

/// Points with a name.
pub struct Line {
    /// What it shows.
    pub name: String,
    /// x, y, and the smallest and the largest measured y.
    pub points: Vec<[f64; 4]>,
}

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 120.0;
/// The field takes 86 % of the width; the rest is for the numbers of the axis on its left, and for half a number on its right.
const RIGHT: f64 = 980.0;
const TOP: f64 = 116.0;
const BOTTOM: f64 = 460.0;
/// The first line of names, and the distance of two lines: a quarter more than the height of their letters.
const NAMES: f64 = 584.0;
const APART: f64 = 40.0;
/// The width of a letter of size 1: digits have 0.556 in Helvetica and Arial, and text has less.
const LETTER: f64 = 0.55;

/// A logarithmic axis over these values, which ends at whole or half powers of ten.
fn axis_over(values: impl Iterator<Item = f64>) -> Axis {
    let logs = values.filter(|value| *value > 0.0 && value.is_finite()).map(f64::log10);
    let (low, high) =
        logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let (low, high) = match low > high {
        true => (0.0, 1.0),
        false => ((2.0 * low - 0.1).floor() / 2.0, (2.0 * high + 0.1).ceil() / 2.0),
    };
    Axis::logarithmic(10f64.powf(low), 10f64.powf(high))
}

/// The ticks of an axis, and whether each has a number: 1, 2 and 5 times the powers of ten between the ends, or only the
/// powers if there are many.
fn ticks(axis: &Axis) -> impl Iterator<Item = (f64, bool)> {
    let (low, high) = (axis.low.log10(), axis.high.log10());
    let powers = (low - 1.0) as i32..=high.ceil() as i32;
    let ticks = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|digit| (digit, power)));
    let named = move |digit: f64| digit == 1.0 || high - low < 3.1;
    ticks
        .map(move |(digit, power)| (digit * 10f64.powi(power), named(digit)))
        .filter(move |(value, _)| (low - 1e-9..=high + 1e-9).contains(&value.log10()))
}

/// The plot as SVG.
pub fn svg(plot: &Plot<'_>) -> String {
    let floored = |y: f64| y.max(plot.floor);
    let points = || plot.lines.iter().flat_map(|line| &line.points);
    let x = axis_over(points().map(|point| point[0]));
    let y = axis_over(points().flat_map(|point| [floored(point[1]), floored(point[3])]));
    let field =
        Field { axes: svg::Plot::new(x, y, [LEFT, BOTTOM], [RIGHT - LEFT, BOTTOM - TOP]), floor: plot.floor };
    // The names below, those of the dashed lines among them: in as many columns as fit.
    let mut names: Vec<(&str, Option<Pen>)> =
        plot.lines.iter().map(|line| (line.name.as_str(), None)).collect();
    let guides: Vec<&str> = plot.guides.iter().map(|(_, name)| name.as_str()).collect();
    let guides = format!("slopes {}", guides.join(" and "));
    if !plot.guides.is_empty() {
        names.push((&guides, Some(GUIDE)));
    }
    if !plot.pareto_front.is_empty() {
        names.push(("Pareto front", Some(FRONT)));
    }
    let columns = |n: usize| names.chunks(names.len().div_ceil(n).max(1)).map(width_of).collect::<Vec<f64>>();
    let fits = |n: &usize| columns(*n).iter().sum::<f64>() <= WIDTH - 20.0;
    let n_columns = [3, 2].into_iter().find(fits).unwrap_or(1);
    let n_rows = names.len().div_ceil(n_columns).max(1);
    let height = NAMES + APART * n_rows as f64 - APART / 2.0;
    let mut drawing = Drawing::new(plot.title, WIDTH, height);
    drawing.text(
        [20.0, 36.0],
        Start,
        TEXT.min((WIDTH - 40.0) / (LETTER * plot.title.chars().count() as f64)),
        Ink::Text,
        plot.title,
    );
    draw_axes(&mut drawing, plot, &field);
    draw_pareto_front(&mut drawing, &plot.pareto_front, &field);
    draw_guides(&mut drawing, plot, &field);
    for (index, line) in plot.lines.iter().enumerate() {
        draw_line(&mut drawing, line, index, &field);
    }
    let widths = columns(n_columns);
    for (index, (name, pen)) in names.iter().enumerate() {
        let left = 20.0 + widths[..index / n_rows].iter().sum::<f64>();
        let at = [left, NAMES + APART * (index % n_rows) as f64];
        let (from, to) = ([at[0], at[1] - 10.0], [at[0] + MARK - 14.0, at[1] - 10.0]);
        drawing.line(from, to, pen.unwrap_or(Ink::Color(index).pen(2.5)));
        if pen.is_none() {
            draw_marker(&mut drawing, [(from[0] + to[0]) / 2.0, from[1]], index);
        }
        drawing.text([at[0] + MARK, at[1]], Start, SMALL, Ink::Text, name);
    }
    drawing.svg()
}

/// The lines of the front and of slopes to compare with.
const FRONT: Pen = Ink::Text.pen(2.0).dashed();
const GUIDE: Pen = Ink::Faint.pen(2.0).dashed();

/// The width of a column of names, with the piece of a line before each of them and a space behind.
fn width_of(names: &[(&str, Option<Pen>)]) -> f64 {
    let longest = names.iter().map(|(name, _)| name.chars().count()).max().unwrap_or_default();
    MARK + LETTER * SMALL * (longest + 1) as f64
}

/// The width of a piece of a line before its name.
const MARK: f64 = 64.0;

/// The axes, and the smallest error that is drawn.
struct Field {
    axes: svg::Plot,
    floor: f64,
}

impl Field {
    fn at(&self, time: f64, error: f64) -> Point {
        self.axes.at(time, error.max(self.floor))
    }
}

fn draw_axes(drawing: &mut Drawing, plot: &Plot<'_>, field: &Field) {
    let pen = Ink::Faint.pen(0.5);
    let mut free = 0.0;
    for (value, is_named) in ticks(&field.axes.x) {
        let [at, _] = field.at(value, 1.0);
        drawing.line([at, TOP], [at, BOTTOM], pen);
        // Leave out a number that would touch the one before it.
        let name = number(value);
        let half = LETTER * SMALL * name.chars().count() as f64 / 2.0;
        if is_named && at - half >= free && at + half <= WIDTH {
            free = at + half + 12.0;
            drawing.text([at, BOTTOM + 48.0], Middle, SMALL, Ink::Text, &name);
        }
    }
    let mut free = f64::INFINITY;
    for (value, is_named) in ticks(&field.axes.y) {
        let [_, at] = field.axes.at(1.0, value);
        drawing.line([LEFT, at], [RIGHT, at], pen);
        if is_named && at <= free {
            free = at - 1.2 * SMALL;
            // Everything below the floor is drawn there, for example 0, which has no place on a logarithmic axis.
            let below = if plot.holds_less() && value <= plot.floor { "≤ " } else { "" };
            let name = format!("{below}{}", number(value));
            drawing.text([LEFT - 10.0, at + 8.0], End, SMALL, Ink::Text, &name);
        }
    }
    drawing.text([RIGHT, BOTTOM + 88.0], End, SMALL, Ink::Text, plot.x_axis);
    drawing.text([20.0, TOP - 36.0], Start, SMALL, Ink::Text, plot.y_axis);
}

/// Draws the Pareto front as a dashed step line: every setting above it is slower or less accurate than one on it.
fn draw_pareto_front(drawing: &mut Drawing, points: &[(f64, f64)], field: &Field) {
    let mut steps: Vec<Point> = Vec::new();
    for &(time, error) in points {
        let corner = field.at(time, error);
        if let Some(&[_, before]) = steps.last() {
            steps.push([corner[0], before]);
        }
        steps.push(corner);
    }
    if !steps.is_empty() {
        drawing.polyline(&steps, FRONT);
    }
}

fn draw_guides(drawing: &mut Drawing, plot: &Plot<'_>, field: &Field) {
    let Some(&[x0, y0, ..]) = plot.lines.first().and_then(|line| line.points.first()) else { return };
    let (x, y, y0) = (&field.axes.x, &field.axes.y, y0.max(field.floor));
    for (slope, _) in &plot.guides {
        // Draw to the right end, or to where the line leaves the plot at the bottom.
        let to_bottom = if *slope < 0.0 { (y.low.log10() - y0.log10()) / slope } else { f64::INFINITY };
        let length = (x.high.log10() - x0.log10()).min(to_bottom);
        let to = field.axes.at(x0 * 10f64.powf(length), y0 * 10f64.powf(slope * length));
        drawing.line(field.at(x0, y0), to, GUIDE);
    }
}

/// Draws one line with its markers, and the range over all rounds at each point.
fn draw_line(drawing: &mut Drawing, line: &Line, index: usize, field: &Field) {
    let ink = Ink::Color(index);
    let path: Vec<Point> = line.points.iter().map(|point| field.at(point[0], point[1])).collect();
    drawing.polyline(&path, ink.pen(2.5));
    for (point, &at) in line.points.iter().zip(&path) {
        let [low, high] = [point[2], point[3]].map(|error| field.at(point[0], error)[1]);
        if (low - high).abs() > 1.0 {
            drawing.line([at[0], low], [at[0], high], ink.pen(1.5));
        }
        draw_marker(drawing, at, index);
    }
}

/// A marker whose shape tells lines apart for colour-blind readers, and those beyond the eighth, whose colours begin again.
fn draw_marker(drawing: &mut Drawing, [cx, cy]: Point, index: usize) {
    let (r, ink) = (7.0, Ink::Color(index));
    match (index + index / 8) % 4 {
        0 => drawing.dot([cx, cy], r, ink),
        1 => drawing.rectangle([cx - r, cy - r], [cx + r, cy + r], ink, 1.0),
        2 => drawing.area(&[[cx, cy - 9.0], [cx + 8.0, cy + 6.0], [cx - 8.0, cy + 6.0]], ink, 1.0),
        _ => drawing.area(&[[cx, cy - 9.0], [cx + 9.0, cy], [cx, cy + 9.0], [cx - 9.0, cy]], ink, 1.0),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(lines: Vec<Line>) -> String {
        let guides = vec![(-0.5, "−1/2".to_owned())];
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
        assert!(drawn.contains("≤ 1e-6"), "{drawn}");
    }

    #[test]
    fn numbers_are_written_short() {
        let written = [0.001, 0.02, 0.5, 1.0, 20.0, 5000.0, 1e-5, 1e6].map(number);
        assert_eq!(written, ["0.001", "0.02", "0.5", "1", "20", "5000", "1e-5", "1e6"]);
    }
}
