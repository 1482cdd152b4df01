//! Drawings as SVG, for slides and reports. The same calls give the same file.
//!
//! Colours are Paul Tol's, which colour-blind readers can distinguish. Each is given twice, for light and for dark pages:
//! the file follows the setting of the reader's system.

// The crate `touch` compiles this file, too, from its own folder.
#[path = "svg/plot.rs"]
mod plot;

pub use Anchor::{End, Middle, Start};
use glam::Vec3;
pub use plot::Plot;
use std::fmt::Write;

/// A position in a drawing, from its upper left corner.
pub type Point = [f64; 2];

/// The range of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// The value at its beginning; above 0 if it is logarithmic.
    pub low: f64,
    /// The value at its end.
    pub high: f64,
    /// Whether equal distances are equal ratios.
    pub logarithmic: bool,
}

impl Axis {
    /// An axis on which equal distances are equal differences.
    pub const fn linear(low: f64, high: f64) -> Axis {
        Axis { low, high, logarithmic: false }
    }

    /// An axis on which equal distances are equal ratios.
    pub const fn logarithmic(low: f64, high: f64) -> Axis {
        Axis { low, high, logarithmic: true }
    }

    /// Where `value` lies: 0 at the beginning, 1 at the end.
    pub fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }
}

/// The size of letters. A drawing is 1,000 units wide or less and takes more than three fifths of a slide's width, so that
/// letters are 18 of its 720 pixels or more, legible from the last row.
pub const TEXT: f64 = 35.0;

/// The size of small letters, for ticks and remarks.
pub const SMALL: f64 = 31.0;

/// The size of letters in drawings that a slide shows small, beside much text.
pub const LARGE: f64 = 43.0;

/// What something is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The colour of text.
    Text,
    /// Grey, for axes, grids and what is less important.
    Faint,
    /// One of the eight colours of lines and areas; larger numbers begin again.
    Color(usize),
}

/// The colours on light and on dark paper: text, faint, paper, then the eight others.
const LIGHT: [&str; 11] = [
    "#1a1a1a", "#767676", "#ffffff", "#332288", "#cc3311", "#117733", "#997700", "#0077bb", "#aa3377",
    "#44aa99", "#555555",
];
const DARK: [&str; 11] = [
    "#f0f0f0", "#9a9a9a", "#141414", "#99aaff", "#ff7766", "#66cc77", "#ddcc66", "#66ccee", "#ee88bb",
    "#77ddcc", "#bbbbbb",
];

impl Ink {
    /// A line of this colour and width.
    pub const fn pen(self, width: f64) -> Pen {
        Pen { ink: self, width, dashed: false }
    }

    fn class(self) -> String {
        match self {
            Ink::Text => "0".into(),
            Ink::Faint => "1".into(),
            Ink::Color(index) => (3 + index % 8).to_string(),
        }
    }
}

/// How a line is drawn: see [`Ink::pen`].
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    /// Its colour.
    pub ink: Ink,
    /// Its width.
    pub width: f64,
    /// Whether it is dashed.
    pub dashed: bool,
}

impl Pen {
    /// The same, dashed.
    pub const fn dashed(self) -> Pen {
        Pen { dashed: true, ..self }
    }

    fn attributes(self) -> String {
        let dashes = if self.dashed { " stroke-dasharray=\"9 8\"" } else { "" };
        format!("class=\"l{}\" stroke-width=\"{}\"{dashes}", self.ink.class(), number(self.width))
    }
}

/// Which point of a text its position is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The left end.
    Start,
    /// The middle.
    Middle,
    /// The right end.
    End,
}

/// A drawing that grows call by call; later calls cover earlier ones.
///
/// The address `FILE.svg#step2` shows what is drawn up to the end of the second [`step`](Drawing::step), and `FILE.svg` shows all.
pub struct Drawing {
    width: f64,
    height: f64,
    title: String,
    body: String,
    n_steps: usize,
}

/// Hides the steps after the one that the address names, and the passing parts of all others.
const STEP_STYLE: &str = ".step:target~.step,.step:not(:target)>.passing{display:none}";

impl Drawing {
    /// An empty drawing of this size. `title` is read aloud by screen readers.
    pub fn new(title: &str, width: f64, height: f64) -> Drawing {
        Drawing { width, height, title: title.into(), body: String::new(), n_steps: 0 }
    }

    /// Begins the next step: all that follows belongs to it, up to the next call.
    pub fn step(&mut self) {
        let end = if self.n_steps > 0 { "</g>\n" } else { "" };
        self.n_steps += 1;
        let _ = writeln!(self.body, "{end}<g class=\"step\" id=\"step{}\">", self.n_steps);
    }

    /// Begins the next step with a remark at `at`, and with marks that `draw` draws. Both are seen on the page of this step only.
    pub fn step_with(&mut self, at: Point, remark: &str, draw: impl FnOnce(&mut Drawing)) {
        self.step();
        self.body += "<g class=\"passing\">\n";
        draw(self);
        self.text(at, Start, SMALL, Ink::Text, remark);
        self.body += "</g>\n";
    }

    /// Begins the next step with a remark at `at` that is seen on its page only.
    pub fn remark(&mut self, at: Point, remark: &str) {
        self.step_with(at, remark, |_| ());
    }

    /// A line from `a` to `b`.
    pub fn line(&mut self, a: Point, b: Point, pen: Pen) {
        self.polyline(&[a, b], pen);
    }

    /// Lines from point to point.
    pub fn polyline(&mut self, points: &[Point], pen: Pen) {
        let _ = writeln!(
            self.body,
            "<polyline points=\"{}\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" {}/>",
            list(points),
            pen.attributes()
        );
    }

    /// A line with an arrow head at `b`.
    pub fn arrow(&mut self, a: Point, b: Point, pen: Pen) {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        if length == 0.0 {
            return;
        }
        // The head is an arrow of 5 widths, and the line ends inside it.
        let (ux, uy) = (dx / length, dy / length);
        let (head, half) = (5.0 * pen.width.max(2.0), 1.9 * pen.width.max(2.0));
        let back = [b[0] - head * ux, b[1] - head * uy];
        self.line(a, back, pen);
        let sides = [[back[0] - half * uy, back[1] + half * ux], [back[0] + half * uy, back[1] - half * ux]];
        self.area(&[b, sides[0], sides[1]], pen.ink, 1.0);
    }

    /// A polygon filled with a colour, `0..=1` opaque.
    pub fn area(&mut self, corners: &[Point], ink: Ink, opacity: f64) {
        let _ = writeln!(
            self.body,
            "<polygon points=\"{}\" class=\"f{}\" fill-opacity=\"{}\"/>",
            list(corners),
            ink.class(),
            number(opacity)
        );
    }

    /// A filled rectangle between two opposite corners.
    pub fn rectangle(&mut self, a: Point, b: Point, ink: Ink, opacity: f64) {
        self.area(&[a, [b[0], a[1]], b, [a[0], b[1]]], ink, opacity);
    }

    /// The outline of a rectangle between two opposite corners.
    pub fn frame(&mut self, a: Point, b: Point, pen: Pen) {
        self.polyline(&[a, [b[0], a[1]], b, [a[0], b[1]], a], pen);
    }

    /// A circle.
    pub fn circle(&mut self, center: Point, radius: f64, pen: Pen) {
        self.round(center, radius, &format!("fill=\"none\" {}", pen.attributes()));
    }

    /// A filled circle.
    pub fn dot(&mut self, center: Point, radius: f64, ink: Ink) {
        self.round(center, radius, &format!("class=\"f{}\"", ink.class()));
    }

    fn round(&mut self, [x, y]: Point, radius: f64, attributes: &str) {
        let [x, y, radius] = [x, y, radius].map(number);
        let _ = writeln!(self.body, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {attributes}/>");
    }

    /// An arc around `center` between two directions in degrees, counterclockwise from the right.
    pub fn arc(&mut self, center: Point, radius: f64, [from, to]: [f64; 2], pen: Pen) {
        let points: Vec<Point> = steps(from, to, 24).map(|degrees| polar(center, radius, degrees)).collect();
        self.polyline(&points, pen);
    }

    /// Lines of text below each other, `apart` from baseline to baseline; that of the first one is at `at`.
    pub fn lines(&mut self, at: Point, apart: f64, size: f64, ink: Ink, lines: &[impl AsRef<str>]) {
        for (row, line) in lines.iter().enumerate() {
            self.text([at[0], at[1] + apart * row as f64], Start, size, ink, line.as_ref());
        }
    }

    /// Text whose baseline is at `at`.
    pub fn text(&mut self, at: Point, anchor: Anchor, size: f64, ink: Ink, text: &str) {
        let [x, y] = at.map(number);
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{}\" class=\"f{}\">{}</text>",
            number(size),
            ink.class(),
            escaped(text)
        );
    }

    /// The file.
    pub fn svg(self) -> String {
        let Drawing { width, height, title, body, n_steps } = self;
        let styles = |colors: &[&str; 11]| -> String {
            let one = |(index, color): (usize, &&str)| {
                format!(".l{index}{{stroke:{color}}}.f{index}{{fill:{color}}}")
            };
            colors.iter().enumerate().map(one).collect()
        };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" role=\"img\">\n\
             <title>{}</title>\n<style>{}@media(prefers-color-scheme:dark){{{}}}{}</style>\n\
             <rect width=\"100%\" height=\"100%\" class=\"f2\"/>\n{body}{}</svg>\n",
            number(width),
            number(height),
            escaped(&title),
            styles(&LIGHT),
            styles(&DARK),
            if n_steps > 0 { STEP_STYLE } else { "" },
            if n_steps > 0 { "</g>\n" } else { "" }
        )
    }
}

/// `point`, moved by `by`.
pub fn offset(point: Point, by: Point) -> Point {
    [point[0] + by[0], point[1] + by[1]]
}

/// The point at `radius` from `center`, in a direction that is `degrees` counterclockwise from the right.
pub fn polar(center: Point, radius: f64, degrees: f64) -> Point {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [center[0] + radius * cos, center[1] - radius * sin]
}

/// `n + 1` values from `low` to `high`.
pub fn steps(low: f64, high: f64, n: u32) -> impl Iterator<Item = f64> {
    (0..=n).map(move |i| low + (high - low) * f64::from(i) / f64::from(n))
}

fn list(points: &[Point]) -> String {
    points.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect::<Vec<_>>().join(" ")
}

/// A coordinate with one digit after the point, which is a fifth of a pixel or less, and without the digit if it is 0.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// The text with the characters replaced that mean something in SVG.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Maps coordinates of a diagram to positions in a drawing: the same scale on both axes, and y upwards.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Where the origin of the diagram stands in the drawing.
    pub origin: Point,
    /// Positions per unit.
    pub scale: f64,
}

impl View {
    /// The position of a point of the diagram.
    pub fn at(&self, x: f64, y: f64) -> Point {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }
}

/// A view with this origin and scale, and the position of a point by its x and y.
pub fn plane(origin: Point, scale: f64) -> (View, impl Fn(Vec3) -> Point + Copy) {
    let view = View { origin, scale };
    (view, move |v| view.at(f64::from(v.x), f64::from(v.y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_holds_what_was_drawn() {
        let mut drawing = Drawing::new("a < b", 100.0, 50.0);
        let view = View { origin: [10.0, 40.0], scale: 10.0 };
        drawing.arrow(view.at(0.0, 0.0), view.at(3.0, 0.0), Ink::Color(9).pen(3.0));
        drawing.rectangle(view.at(1.0, 1.0), view.at(2.0, 3.0), Ink::Faint, 0.25);
        drawing.step();
        drawing.circle([50.0, 25.0], 10.0, Ink::Text.pen(1.5).dashed());
        drawing.remark([5.0, 30.0], "seen in step 2 only");
        drawing.text([5.0, 12.0], Start, TEXT, Ink::Text, "t & u");
        insta::assert_snapshot!(drawing.svg());
    }

    #[test]
    fn positions_lie_where_they_are_said_to_lie() {
        for axis in [Axis::linear(-2.0, 6.0), Axis::logarithmic(0.5, 32.0)] {
            assert_eq!([axis.share(axis.low), axis.share(axis.high)], [0.0, 1.0]);
        }
        assert_eq!(Axis::linear(-2.0, 6.0).share(2.0), 0.5);
        // The middle of a logarithmic axis is the geometric mean of its ends, but for the rounding of two logarithms.
        assert!((Axis::logarithmic(0.5, 32.0).share(4.0) - 0.5).abs() < 1e-12);
        let plot = Plot::new(Axis::linear(0.0, 1.0), Axis::linear(0.0, 10.0), [50.0, 400.0], [200.0, 300.0]);
        assert_eq!([plot.at(0.0, 0.0), plot.at(1.0, 10.0)], [[50.0, 400.0], [250.0, 100.0]]);
        assert_eq!(steps(1.0, 2.0, 4).collect::<Vec<_>>(), [1.0, 1.25, 1.5, 1.75, 2.0]);
        let [x, y] = polar([10.0, 10.0], 5.0, 90.0);
        // The cosine of 90 degrees is rounded.
        assert!((x - 10.0).abs() < 1e-12 && y == 5.0);
    }

    #[test]
    fn an_arrow_without_length_is_not_drawn() {
        let mut drawing = Drawing::new("", 10.0, 10.0);
        drawing.arrow([1.0, 1.0], [1.0, 1.0], Ink::Text.pen(3.0));
        assert!(!drawing.svg().contains("polygon"));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([1.0, -0.001, 2.5, 3.456].map(number), ["1", "0", "2.5", "3.46"]);
    }
}
