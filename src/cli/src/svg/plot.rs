//! Plots over two axes.

use super::{Axis, Drawing, End, Ink, Middle, Pen, Point, SMALL, Start, offset};

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
    /// A plot whose field has its lower left corner at `corner`, and this width and height.
    pub const fn new(x: Axis, y: Axis, corner: Point, size: Point) -> Plot {
        Plot { x, y, corner, size }
    }

    /// Where a value is drawn.
    pub fn at(&self, x: f64, y: f64) -> Point {
        [self.corner[0] + self.size[0] * self.x.share(x), self.corner[1] - self.size[1] * self.y.share(y)]
    }

    /// Draws both axes, with labels at the values `x` and `y` and a title for each axis.
    pub fn draw_axes(&self, drawing: &mut Drawing, x: &[(f64, &str)], y: &[(f64, &str)], titles: [&str; 2]) {
        let (low, high) = ([self.x.low, self.y.low], [self.x.high, self.y.high]);
        for &(value, label) in x {
            drawing.line(self.at(value, low[1]), self.at(value, high[1]), Ink::Faint.pen(0.5));
            let at = offset(self.at(value, low[1]), [0.0, 36.0]);
            drawing.text(at, Middle, SMALL, Ink::Text, label);
        }
        for &(value, label) in y {
            drawing.line(self.at(low[0], value), self.at(high[0], value), Ink::Faint.pen(0.5));
            let at = offset(self.at(low[0], value), [-12.0, 6.0]);
            drawing.text(at, End, SMALL, Ink::Text, label);
        }
        let axes = [self.at(low[0], high[1]), self.at(low[0], low[1]), self.at(high[0], low[1])];
        drawing.polyline(&axes, Ink::Text.pen(2.0));
        let below = offset(self.at(low[0], low[1]), [self.size[0] / 2.0, 72.0]);
        drawing.text(below, Middle, SMALL, Ink::Text, titles[0]);
        let above = offset(self.at(low[0], high[1]), [-40.0, -30.0]);
        drawing.text(above, Start, SMALL, Ink::Text, titles[1]);
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
