//! Small helpers of all drawings: shifted points, arcs of angles, and plots over axes.

pub use raykata_cli::svg::Axis;
use raykata_cli::svg::{Anchor, Drawing, Ink, Pen, Point, SMALL};

/// `point`, moved by `by`.
pub fn offset(point: Point, by: Point) -> Point {
    [point[0] + by[0], point[1] + by[1]]
}

/// The point at `radius` from `center`, in a direction that is `degrees` counterclockwise from the right.
pub fn polar(center: Point, radius: f64, degrees: f64) -> Point {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [center[0] + radius * cos, center[1] - radius * sin]
}

/// An arc around `center` between two directions in degrees.
pub fn arc(drawing: &mut Drawing, center: Point, radius: f64, [from, to]: [f64; 2], pen: Pen) {
    let points: Vec<Point> =
        (0..=24).map(|i| polar(center, radius, from + (to - from) * f64::from(i) / 24.0)).collect();
    drawing.polyline(&points, pen);
}

/// A plot over two axes.
#[derive(Clone, Copy, Debug)]
pub struct Plot {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The lower left corner of its field.
    pub corner: Point,
    /// The width and height of its field.
    pub size: Point,
}

impl Plot {
    /// Where a value is drawn.
    pub fn at(&self, x: f64, y: f64) -> Point {
        [self.corner[0] + self.size[0] * self.x.share(x), self.corner[1] - self.size[1] * self.y.share(y)]
    }

    /// Draws both axes, with labels at the values `x` and `y` and a title for each axis.
    pub fn draw_axes(&self, drawing: &mut Drawing, x: &[(f64, &str)], y: &[(f64, &str)], titles: [&str; 2]) {
        let (low, high) = ([self.x.low, self.y.low], [self.x.high, self.y.high]);
        for &(value, label) in x {
            drawing.line(self.at(value, low[1]), self.at(value, high[1]), Pen::new(Ink::Faint).wide(0.5));
            let at = offset(self.at(value, low[1]), [0.0, 36.0]);
            drawing.text(at, Anchor::Middle, SMALL, Ink::Text, label);
        }
        for &(value, label) in y {
            drawing.line(self.at(low[0], value), self.at(high[0], value), Pen::new(Ink::Faint).wide(0.5));
            let at = offset(self.at(low[0], value), [-12.0, 6.0]);
            drawing.text(at, Anchor::End, SMALL, Ink::Text, label);
        }
        let axes = [self.at(low[0], high[1]), self.at(low[0], low[1]), self.at(high[0], low[1])];
        drawing.polyline(&axes, Pen::new(Ink::Text).wide(2.0));
        let below = offset(self.at(low[0], low[1]), [self.size[0] / 2.0, 72.0]);
        drawing.text(below, Anchor::Middle, SMALL, Ink::Text, titles[0]);
        let above = offset(self.at(low[0], high[1]), [-40.0, -30.0]);
        drawing.text(above, Anchor::Start, SMALL, Ink::Text, titles[1]);
    }

    /// Draws a curve through values.
    pub fn draw_curve(&self, drawing: &mut Drawing, values: impl IntoIterator<Item = [f64; 2]>, pen: Pen) {
        let points: Vec<Point> = values.into_iter().map(|[x, y]| self.at(x, y)).collect();
        drawing.polyline(&points, pen);
    }

    /// Draws a vertical line at `x` over the whole field.
    pub fn draw_mark(&self, drawing: &mut Drawing, x: f64, pen: Pen) {
        drawing.line(self.at(x, self.y.low), self.at(x, self.y.high), pen);
    }
}

/// `n + 1` values from `low` to `high`.
pub fn steps(low: f64, high: f64, n: u32) -> impl Iterator<Item = f64> {
    (0..=n).map(move |i| low + (high - low) * f64::from(i) / f64::from(n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_values_are_drawn_farther_right_and_higher() {
        let plot = Plot {
            x: Axis::linear(0.0, 1.0),
            y: Axis::linear(0.0, 10.0),
            corner: [50.0, 400.0],
            size: [200.0, 300.0],
        };
        assert_eq!(plot.at(0.0, 0.0), [50.0, 400.0]);
        assert_eq!(plot.at(1.0, 10.0), [250.0, 100.0]);
    }

    #[test]
    fn steps_have_both_ends() {
        assert_eq!(steps(1.0, 2.0, 4).collect::<Vec<_>>(), [1.0, 1.25, 1.5, 1.75, 2.0]);
    }

    #[test]
    fn directions_turn_counterclockwise() {
        let [x, y] = polar([10.0, 10.0], 5.0, 90.0);
        // The cosine of 90 degrees is rounded.
        assert!((x - 10.0).abs() < 1e-12 && y == 5.0);
    }
}
