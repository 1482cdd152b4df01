//! Figures that a reader can touch. Each is one function of handles: points to drag, and numbers of sliders and choices. With the
//! handles at their start it draws the still figure of the slides; in a web page the reference, compiled to WebAssembly, draws it
//! again at each move. So both are the same drawing, from the answers of the same functions.
//!
//! `page.html` is the page, with the script that moves the handles. `raykata slides` puts this library into it.

#[cfg(target_family = "wasm")]
mod exports;
mod frame;
mod lens;
mod mis;
mod slab;
mod snell;
mod triangle;
// The drawings of `raykata-cli`, which itself does not run in a page: it starts programs and catches signals.
#[path = "../../../src/cli/src/svg.rs"]
pub mod svg;
pub mod walk;

use anyhow::{Context, Result, ensure};
use glam::{Vec3, vec3};
use raykata::kit::Kit;
use std::fmt::{Display, Write};
use svg::View;

/// A figure, with its name in the slides and in the page.
pub struct Figure {
    /// The name.
    pub name: &'static str,
    /// The handles at the start: x and y of each point, then the numbers of the page's inputs.
    pub start: &'static [f64],
    /// Draws the figure, and notes points and values.
    draw: fn(&dyn Kit, &mut Touch) -> Result<String>,
}

/// All figures.
pub const FIGURES: &[Figure] = &[
    Figure {
        name: "barycentric",
        start: &[0.0, 0.0, 3.4, -0.2, 1.3, 2.7, 2.025, 0.575],
        draw: triangle::draw,
    },
    Figure { name: "slab-intervals", start: &[0.5, 0.3, 7.9, 3.408, 2.0, 0.7, 5.2, 2.7], draw: slab::draw },
    Figure { name: "snell", start: &snell::START, draw: snell::draw },
    Figure { name: "thin-lens", start: &[0.0, 1.2, 4.6, 1.3, 7.2, -0.45], draw: lens::draw },
    Figure { name: "mis-ring", start: &[-1.5, 1.3, 1.9, 1.1, 0.9, 2.2], draw: mis::draw },
    Figure { name: "bvh-descent", start: &[-0.6, 0.9, 6.6, 5.2704, 2.0, 2.0], draw: walk::draw_hierarchy },
    Figure { name: "grid-steps", start: &[-0.6, 1.35, 8.6, 4.018, 8.0], draw: walk::draw_grid },
    Figure { name: "kd-traversal", start: &[-0.6, 1.35, 8.6, 4.018, 2.0], draw: walk::draw_kd_tree },
    Figure { name: "live-frame", start: &[6.0, 0.0, 0.0, 5.0, 4.0, 5.0], draw: frame::draw },
];

/// What a figure reads from its handles, and what it shows beside its drawing.
#[derive(Default)]
pub struct Touch {
    handles: Vec<f64>,
    is_still: bool,
    points: Vec<(View, &'static str)>,
    values: String,
}

impl Touch {
    /// The next point, which stays between two corners; its name is read aloud. `view` maps it to the drawing.
    fn point(&mut self, view: View, name: &'static str, low: [f64; 2], high: [f64; 2]) -> Vec3 {
        let place = 2 * self.points.len();
        for axis in 0..2 {
            self.handles[place + axis] = self.handles[place + axis].clamp(low[axis], high[axis]);
        }
        self.points.push((view, name));
        vec3(self.handles[place] as f32, self.handles[place + 1] as f32, 0.0)
    }

    /// Moves the handle of the last point to where the figure shows it.
    fn place_last(&mut self, point: Vec3) {
        let place = 2 * (self.points.len() - 1);
        (self.handles[place], self.handles[place + 1]) = (point.x.into(), point.y.into());
    }

    /// The whole number in this place of the handles, within a range.
    fn whole(&mut self, place: usize, least: u32, most: u32) -> u32 {
        self.handles[place] = self.handles[place].round().clamp(least.into(), most.into());
        self.handles[place] as u32
    }

    /// Shows a value below the drawing. The text of an `f32` has as many digits as it takes to distinguish it from others.
    fn value(&mut self, name: &str, value: impl Display) {
        let _ = write!(self.values, "<div><dt>{name}</dt><dd>{value}</dd></div>");
    }
}

/// The still figure of this name, as an SVG file; `None` if it cannot be touched.
pub fn still(kit: &dyn Kit, name: &str) -> Option<Result<String>> {
    let figure = FIGURES.iter().find(|figure| figure.name == name)?;
    let mut touch = Touch { handles: figure.start.to_vec(), is_still: true, ..Touch::default() };
    Some((figure.draw)(kit, &mut touch))
}

/// The answer to a question of the page, which is the name of a figure and its handles, or only the name for those at the start.
/// It is HTML: the drawing, and the values. Its attributes have the handles, each within its range, and for each point the origin
/// and the scale of its view, and its name.
///
/// # Errors
///
/// If there is no such figure, if the handles are others than it has, or if it cannot be drawn with them.
pub fn answer(kit: &dyn Kit, question: &str) -> Result<String> {
    let mut words = question.split(' ');
    let name = words.next().unwrap_or_default();
    let figure = FIGURES.iter().find(|figure| figure.name == name);
    let figure = figure.with_context(|| format!("there is no figure `{name}`"))?;
    let mut handles: Vec<f64> = words.map(|word| word.parse().unwrap_or(f64::NAN)).collect();
    if handles.is_empty() {
        handles = figure.start.to_vec();
    }
    let are_right = handles.len() == figure.start.len() && handles.iter().all(|handle| handle.is_finite());
    ensure!(are_right, "`{question}` needs {} finite numbers after the name", figure.start.len());
    let mut touch = Touch { handles, ..Touch::default() };
    let drawing = (figure.draw)(kit, &mut touch)?;
    let numbers: Vec<String> = touch.handles.iter().map(f64::to_string).collect();
    let point = |(View { origin: [x, y], scale }, name): &(View, &str)| format!("{x} {y} {scale} {name}");
    let points: Vec<String> = touch.points.iter().map(point).collect();
    let (numbers, points, values) = (numbers.join(" "), points.join(","), touch.values);
    Ok(format!("<div data-handles=\"{numbers}\" data-points=\"{points}\">{drawing}<dl>{values}</dl></div>"))
}
