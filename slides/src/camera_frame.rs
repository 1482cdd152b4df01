//! The diagram of the camera's axes and film.

use anyhow::Result;
use glam::Vec3;
use raykata::camera::Camera;
use raykata::kit::Kit;
use raykata_cli::svg::{Drawing, Ink, Middle, Point, SMALL, Start, TEXT, View, offset};

/// The camera from the side, and from above with the rays of eight pixels.
pub fn camera_frame(_kit: &dyn Kit) -> Result<String> {
    let camera = Camera::new(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 40.0, 16.0 / 9.0)?;
    let mut drawing = Drawing::new("The camera from the side and from above", 1000.0, 560.0);
    let width = camera.aspect * camera.half_height;
    let (film, rays) = (Ink::Color(1), Ink::Color(0));
    let views = [
        (70.0, camera.half_height, "from the side", ["u", "h", "θ/2"]),
        (560.0, width, "from above", ["r", "a·h", "θx/2"]),
    ];
    for (x, half, name, [axis, length, angle]) in views {
        // To the right runs the view direction, upwards the other axis.
        let view = View { origin: [x, 270.0], scale: 300.0 };
        let half = f64::from(half);
        drawing.line(view.at(1.0, -half), view.at(1.0, half), film.pen(5.0));
        for end in [-half, half] {
            drawing.line(view.origin, view.at(1.0, end), Ink::Faint.pen(2.0));
        }
        if name == "from above" {
            for pixel in 0..8 {
                let way = camera.ray((pixel as f32 + 0.5) / 8.0, 0.5).direction;
                let (along, across) = (f64::from(way.dot(camera.towards)), f64::from(way.dot(camera.right)));
                drawing.line(view.origin, view.at(1.12, 1.12 * across / along), rays.pen(1.5));
            }
        }
        drawing.arrow(view.origin, view.at(0.72, 0.0), Ink::Text.pen(3.0));
        drawing.arrow(view.origin, view.at(0.0, 0.5), Ink::Text.pen(3.0));
        drawing.dot(view.origin, 8.0, Ink::Text);
        let mut label = |at: Point, by: Point, text: &str, ink: Ink| {
            drawing.text(offset(at, by), Middle, TEXT, ink, text);
        };
        label(view.origin, [-20.0, 28.0], "e", Ink::Text);
        label(view.at(0.72, 0.0), [-6.0, 32.0], "v", Ink::Text);
        label(view.at(0.0, 0.5), [-22.0, 16.0], axis, Ink::Text);
        label(view.at(1.0, half / 2.0), [if name == "from above" { 64.0 } else { 24.0 }, 8.0], length, film);
        label(view.at(1.0, -half), [0.0, 34.0], "film", film);
        let degrees = half.atan().to_degrees();
        drawing.arc(view.origin, 130.0, [0.0, degrees], Ink::Color(2).pen(3.0));
        let text = format!("{angle} = {degrees:.1}°");
        drawing.text(view.at(0.06, -0.55), Start, TEXT, Ink::Color(2), &text);
        let text = format!("{length} = {half:.3}");
        drawing.text(view.at(0.06, -0.68), Start, TEXT, film, &text);
        drawing.text(view.at(0.06, -0.86), Start, SMALL, Ink::Text, &format!("{name}, film at distance 1"));
    }
    Ok(drawing.svg())
}
