//! Generates a field of small spheres of all materials around three large ones.

use glam::{Vec2, vec2};
use std::fmt::Write;

/// The scene without its small spheres.
const START: &str = include_str!("spheres.toml");

/// The materials of the small spheres. A material that is listed twice is twice as frequent.
const MATERIALS: [&str; 14] = [
    "red", "red", "orange", "orange", "teal", "teal", "ivory", "ivory", "violet", "mirror", "brushed",
    "glass", "glow", "ember",
];

/// Half the number of cells along each side of the field; each cell has at most one sphere.
const CELLS: i32 = 10;

/// Returns the scene as TOML.
pub fn toml() -> String {
    let mut text = String::from(START);
    // The large spheres, whose radius is 1.
    let large = [-2.3_f32, 0.0, 2.3].map(|x| vec2(x, 0.0));
    for row in -CELLS..CELLS {
        for column in -CELLS..CELLS {
            let random = |purpose: i32| super::images::shade(100 * column + purpose, row);
            let radius = 0.13 + 0.12 * random(0);
            // Spheres of neighbouring cells do not touch: a centre keeps 0.3 from the edge of its cell.
            let center = 0.85
                * (vec2(column as f32, row as f32) + Vec2::splat(0.3) + 0.4 * vec2(random(1), random(2)));
            if large.iter().any(|other| center.distance(*other) < 1.25) {
                continue;
            }
            let material = MATERIALS[(random(3) * MATERIALS.len() as f32) as usize];
            let (x, z) = (center.x, center.y);
            let _ = write!(
                text,
                "\n[[nodes]]\nmaterial = \"{material}\"\n\
                 shape = {{ sphere = {{ center = [{x:.3}, {radius:.3}, {z:.3}], radius = {radius:.3} }} }}\n"
            );
        }
    }
    text
}
