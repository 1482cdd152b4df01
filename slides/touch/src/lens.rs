//! The thin lens.

use crate::Touch;
use crate::svg::{Drawing, Ink, Middle, SMALL, Start, TEXT, offset, plane};
use anyhow::Result;
use glam::{Vec2, Vec3};
use raykata::camera::{Camera, Lens};
use raykata::kit::{Kit, LensQuery};
use raykata::ray::Ray;

/// A thin lens from the side: five rays meet in a point of the focal plane, and a point behind it is spread over a circle of
/// confusion.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let (view, at) = plane([90.0, 290.0], 112.0);
    let half = touch.point(view, "edge of the lens", [0.0, 0.05], [0.0, 1.7]).y;
    let sharp = touch.point(view, "sharp point", [0.8, -1.5], [7.0, 1.8]);
    let behind = touch.point(view, "blurred point", [0.8, -1.6], [7.9, 1.8]);
    // Ask for the rays through five points of the lens that meet in a point of the focal plane.
    let lens = Lens { aperture: 2.0 * half, focal_distance: sharp.x };
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
    let rays = kit.lens_ray(&[-1.0, -0.5, 0.0, 0.5, 1.0].map(|y| query(pinhole(sharp), y)));
    let reach = |ray: &Ray, x: f32| ray.at((x - ray.origin.x) / ray.direction.x);

    let mut drawing = Drawing::new("A thin lens and the circle of confusion", 1000.0, 560.0);
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
    let ends = [&rays[0], &rays[4]].map(|ray| ray.origin);
    let crossings = ends.map(|end| end.lerp(behind, lens.focal_distance / behind.x));
    drawing.area(&[at(ends[0]), at(behind), at(ends[1])], blur, 0.14);
    for (end, crossing) in ends.into_iter().zip(crossings) {
        drawing.line(at(end), at(behind), blur.pen(2.0));
        if behind.x < lens.focal_distance {
            drawing.line(at(behind), at(crossing), blur.pen(2.0));
        }
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
    let lengths = [("A", lens.aperture), ("f", lens.focal_distance), ("z", behind.x)];
    for (name, length) in lengths.into_iter().chain([("c", crossings[0].distance(crossings[1]))]) {
        touch.value(name, length);
    }
    Ok(drawing.svg())
}
