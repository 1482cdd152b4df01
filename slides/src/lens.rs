//! Diagrams of the thin lens.

use anyhow::{Context, Result};
use glam::{Vec2, Vec3, vec3};
use raykata::camera::{Camera, Lens};
use raykata::kit::{Kit, LensQuery};
use raykata::ray::Ray;
use raykata::scene::Scene;
use raykata::shape::Shape;
use raykata_cli::svg::{Axis, Drawing, End, Ink, Middle, Plot, SMALL, Start, TEXT, offset, plane, steps};
use std::path::Path;

/// A thin lens from the side: five rays meet in a point of the focal plane, and a point behind it is spread over a circle of
/// confusion.
pub fn thin_lens(kit: &dyn Kit) -> Result<String> {
    // Ask for the rays through five points of the lens that meet in a point of the focal plane.
    let lens = Lens { aperture: 2.4, focal_distance: 4.6 };
    let camera = Camera {
        position: Vec3::ZERO,
        towards: Vec3::X,
        right: Vec3::Z,
        up: Vec3::Y,
        half_height: 0.5,
        orthographic: false,
        aspect: 1.0,
        lens: Some(lens),
        shutter: None,
    };
    let pinhole = |point: Vec3| Ray::new(Vec3::ZERO, point.normalize());
    let query = |pinhole: Ray, y: f32| LensQuery { camera, pinhole, lens, on_lens: Vec2::new(0.0, y) };
    let sharp = vec3(lens.focal_distance, 1.3, 0.0);
    let rays = kit.lens_ray(&[-1.0, -0.5, 0.0, 0.5, 1.0].map(|y| query(pinhole(sharp), y)));
    let reach = |ray: &Ray, x: f32| ray.at((x - ray.origin.x) / ray.direction.x);

    let mut drawing = Drawing::new("A thin lens and the circle of confusion", 1000.0, 560.0);
    let (view, at) = plane([90.0, 290.0], 112.0);
    let (half, focus) = (f64::from(lens.aperture / 2.0), f64::from(lens.focal_distance));
    let (meet, blur) = (Ink::Color(0), Ink::Color(1));

    // Draw the lens and the optical axis.
    drawing.step();
    drawing.line(view.at(-0.4, 0.0), view.at(7.9, 0.0), Ink::Faint.pen(1.5));
    let lens_pen = Ink::Color(4).pen(9.0);
    drawing.line(view.at(0.0, -half), view.at(0.0, half), lens_pen);
    drawing.text(view.at(0.0, half + 0.18), Middle, TEXT, lens_pen.ink, "lens");
    drawing.text(view.at(-0.3, -0.08), Middle, TEXT, lens_pen.ink, "A");
    // Draw the focal plane, the ray through the centre, and the other rays, which meet it there.
    let meeting = |drawing: &mut Drawing, ray: &Ray| {
        drawing.line(at(ray.origin), at(reach(ray, lens.focal_distance + 0.7)), meet.pen(2.0));
    };
    drawing.step();
    meeting(&mut drawing, &rays[2]);
    drawing.step();
    drawing.line(view.at(focus, -1.6), view.at(focus, 1.9), Ink::Text.pen(2.0).dashed());
    drawing.text(view.at(focus, 2.05), Middle, TEXT, Ink::Text, "focal plane");
    drawing.dot(at(reach(&rays[2], lens.focal_distance)), 9.0, meet);
    drawing.step();
    for ray in [0, 1, 3, 4] {
        meeting(&mut drawing, &rays[ray]);
    }
    drawing.text(offset(at(sharp), [90.0, -14.0]), Start, SMALL, meet, "sharp");
    // Draw the cone of a point behind the focal plane: from the ends of the lens to the point.
    drawing.step();
    let behind = vec3(7.2, -0.45, 0.0);
    let ends = [&rays[0], &rays[4]].map(|ray| ray.origin);
    let crossings = ends.map(|end| end.lerp(behind, lens.focal_distance / behind.x));
    drawing.area(&[at(ends[0]), at(behind), at(ends[1])], blur, 0.14);
    for end in ends {
        drawing.line(at(end), at(behind), blur.pen(2.0));
    }
    drawing.dot(at(behind), 9.0, blur);
    drawing.step();
    drawing.line(at(crossings[0]), at(crossings[1]), blur.pen(9.0));
    drawing.text(offset(at((crossings[0] + crossings[1]) / 2.0), [14.0, 8.0]), Start, TEXT, blur, "c");
    drawing.text(offset(at(behind), [0.0, -20.0]), Middle, SMALL, blur, "blurred");
    // Mark the lengths.
    drawing.step();
    for (y, length, name) in [(-1.75, focus, "f"), (-2.1, f64::from(behind.x), "z")] {
        let pen = Ink::Text.pen(2.0);
        let middle = view.at(length / 2.0, y);
        for end in [0.0, length] {
            drawing.arrow(middle, view.at(end, y), pen);
            drawing.line(view.at(end, y + 0.1), view.at(end, y - 0.1), pen);
        }
        drawing.text(offset(middle, [60.0, -8.0]), Middle, TEXT, Ink::Text, name);
    }
    Ok(drawing.svg())
}

/// The diameter of the circle of confusion in pixels over the distance, for the camera of a scene, and that of the centre of
/// each of its spheres.
pub fn circle_of_confusion(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let scene = crate::pictures::load(root, "lens.toml")?;
    let camera = raykata::world::camera_for(&scene);
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
