//! Diagrams of the camera: its axes and film, and its thin lens.

use crate::pictures::load;
use anyhow::{Context, Result};
use glam::{Vec2, Vec3};
use raykata::camera::Camera;
use raykata::kit::{Kit, LensQuery};
use raykata::ray::Ray;
use raykata::scene::Scene;
use raykata::shape::Shape;
use raykata::world::camera_for;
use raykata_cli::svg::{
    Axis, Drawing, End, Ink, Middle, Plot, Point, SMALL, Start, TEXT, View, offset, steps,
};
use std::path::Path;

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

/// The diameter of the circle of confusion in pixels over the distance, for the camera of a scene, and that of the centre of
/// each of its spheres.
pub fn circle_of_confusion(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let scene = load(root, "lens.toml")?;
    let camera = camera_for(&scene);
    let lens = camera.lens.context("this camera has no lens")?;
    let (aperture, focus) = (f64::from(lens.aperture), f64::from(lens.focal_distance));
    // A length at distance 1 in pixels.
    let pixels = f64::from(scene.film.height) / (2.0 * f64::from(camera.half_height));
    let diameter = |z: f64| aperture * (z - focus).abs() / z * pixels / focus;

    let mut drawing = Drawing::new("The circle of confusion over the distance", 1000.0, 620.0);
    let plot = Plot::new(Axis::linear(2.0, 12.0), Axis::linear(0.0, 80.0), [90.0, 530.0], [870.0, 460.0]);
    let x = [(2.0, "2"), (4.0, "4"), (6.0, "6"), (8.0, "8"), (10.0, "10"), (12.0, "12")];
    let y = [(0.0, "0"), (20.0, "20"), (40.0, "40"), (60.0, "60"), (80.0, "80")];
    plot.draw_axes(&mut drawing, &x, &y, ["distance z along the view direction", "diameter in pixels"]);
    let curve = steps(2.0, 12.0, 200).map(|z| [z, diameter(z)]);
    plot.draw_curve(&mut drawing, curve, Ink::Color(0).pen(4.0));
    // The diameter has a limit for distant points, and is 0 at the focal distance.
    let limit = aperture * pixels / focus;
    let pen = Ink::Faint.pen(2.0).dashed();
    drawing.line(plot.at(2.0, limit), plot.at(12.0, limit), pen);
    let label = offset(plot.at(12.0, limit), [-4.0, -10.0]);
    drawing.text(label, End, SMALL, Ink::Text, &format!("limit {limit:.1}"));
    plot.draw_mark(&mut drawing, focus, pen);
    let label = offset(plot.at(focus, 80.0), [10.0, 26.0]);
    drawing.text(label, Start, SMALL, Ink::Text, &format!("focal distance f = {focus:.2}"));
    // Measure the circle of each sphere from the rays through the rim of the lens.
    for center in centers(&scene) {
        let way = center - camera.position;
        let z = way.dot(camera.towards);
        let pinhole = Ray::new(camera.position, camera.towards);
        let rim = (0..64).map(|i| Vec2::from_angle(i as f32 / 64.0 * std::f32::consts::TAU));
        let queries: Vec<_> = rim.map(|on_lens| LensQuery { camera, pinhole, lens, on_lens }).collect();
        let points: Vec<Vec3> = kit
            .lens_ray(&queries)
            .iter()
            .map(|ray| {
                let t = (z - (ray.origin - camera.position).dot(camera.towards))
                    / ray.direction.dot(camera.towards);
                ray.at(t)
            })
            .collect();
        let wide = points.iter().flat_map(|p| points.iter().map(move |q| p.distance(*q))).fold(0.0, f32::max);
        let value = f64::from(wide / z) * pixels;
        let dot = plot.at(f64::from(z), value);
        drawing.dot(dot, 9.0, Ink::Color(1));
        drawing.text(offset(dot, [22.0, -16.0]), Start, TEXT, Ink::Color(1), &format!("{value:.1}"));
    }
    Ok(drawing.svg().into_bytes())
}

/// The centres of the spheres of a scene whose nodes have no parents.
fn centers(scene: &Scene) -> Vec<Vec3> {
    let sphere = |node: &raykata::scene::Node| match &node.shape {
        Some(Shape::Sphere(sphere)) => Some(node.transform.transform_point3(sphere.center)),
        _ => None,
    };
    scene.nodes.iter().filter_map(sphere).collect()
}
