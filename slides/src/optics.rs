//! Diagrams of refraction and of the thin lens.

use anyhow::Result;
use glam::{Vec2, Vec3, vec3};
use raykata::camera::{Camera, Lens};
use raykata::kit::{Kit, LensQuery, RefractQuery};
use raykata::ray::Ray;
use raykata_cli::svg::{Anchor, Drawing, Ink, Pen, Point, SMALL, TEXT, View};

/// Rays that meet a surface at three angles, from air into glass and from glass into air.
pub fn snell(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("Refraction into glass and out of glass, at three angles", 1000.0, 560.0);
    panel(
        kit,
        &mut drawing,
        [250.0, 275.0],
        (1.0, 1.5),
        [25.0, 50.0, 75.0],
        ("air, n = 1", "glass, n = 1.5"),
    );
    panel(
        kit,
        &mut drawing,
        [750.0, 275.0],
        (1.5, 1.0),
        [20.0, 36.0, 55.0],
        ("glass, n = 1.5", "air, n = 1"),
    );
    Ok(drawing.svg())
}

/// One surface around `center`, with the medium `n1` above it and `n2` below.
fn panel(
    kit: &dyn Kit,
    drawing: &mut Drawing,
    center: Point,
    (n1, n2): (f32, f32),
    degrees: [f32; 3],
    (above, below): (&str, &str),
) {
    let view = View { origin: center, scale: 190.0 };
    let at = |v: Vec3| view.at(f64::from(v.x), f64::from(v.y));
    // Shade the glass, and draw surface and normal.
    let glass = if n1 < n2 { view.at(1.25, -1.3) } else { view.at(1.25, 1.3) };
    drawing.rectangle(view.at(-1.25, 0.0), glass, Ink::Color(4), 0.14);
    drawing.line(view.at(-1.25, 0.0), view.at(1.25, 0.0), Pen::new(Ink::Text));
    drawing.line(view.at(0.0, 1.25), view.at(0.0, -1.25), Pen::new(Ink::Faint).wide(2.0).dashed());
    drawing.text(view.at(-1.22, 0.07), Anchor::Start, SMALL, Ink::Text, above);
    drawing.text(view.at(-1.22, -0.16), Anchor::Start, SMALL, Ink::Text, below);

    // Ask for the refracted and the reflected direction of each ray.
    for (index, degrees) in degrees.into_iter().enumerate() {
        let pen = Pen::new(Ink::Color([0, 1, 2][index])).wide(4.0);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let direction = vec3(sin, -cos, 0.0);
        drawing.arrow(at(-1.15 * direction), at(-0.55 * direction), pen);
        drawing.line(at(-0.6 * direction), at(Vec3::ZERO), pen);
        drawing.text(
            shifted(at(-1.15 * direction), [-6.0, -8.0]),
            Anchor::Middle,
            SMALL,
            pen.ink,
            &format!("{degrees}°"),
        );
        let refracted = kit.refract(&[RefractQuery { direction, normal: Vec3::Y, n1, n2 }])[0];
        let (way, pen, words) = match refracted {
            Some(refracted) => {
                let angle = refracted.x.atan2(-refracted.y).to_degrees();
                (refracted, pen, format!("{angle:.1}°"))
            }
            None => (kit.reflect(&[(direction, Vec3::Y)])[0], pen.dashed(), "all reflected".into()),
        };
        drawing.arrow(at(Vec3::ZERO), at(1.08 * way), pen);
        let label = shifted(at(1.08 * way), [8.0, if way.y < 0.0 { 22.0 } else { -8.0 }]);
        drawing.text(label, Anchor::Middle, SMALL, pen.ink, &words);
    }
}

/// A thin lens from the side: rays through points of the lens meet in the focal plane, and spread over a circle of confusion
/// nearer and farther.
pub fn thin_lens(kit: &dyn Kit) -> Result<String> {
    // Ask for the rays through five points of the lens, for one point of the film.
    let lens = Lens { aperture: 1.6, focal_distance: 4.6 };
    let camera = Camera {
        position: Vec3::ZERO,
        towards: Vec3::X,
        right: Vec3::Z,
        up: Vec3::Y,
        half_height: 0.5,
        aspect: 1.0,
        lens: Some(lens),
        shutter: None,
    };
    let pinhole = Ray::new(Vec3::ZERO, vec3(1.0, 0.07, 0.0).normalize());
    let places = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let queries = places.map(|y| LensQuery { camera, pinhole, lens, on_lens: Vec2::new(0.0, y) });
    let rays = kit.lens_ray(&queries);

    let mut drawing =
        Drawing::new("A thin lens, the focal plane, and the circle of confusion", 1000.0, 560.0);
    let view = View { origin: [110.0, 285.0], scale: 108.0 };
    let at = |v: Vec3| view.at(f64::from(v.x), f64::from(v.y));
    let reach = |ray: &Ray, x: f32| ray.at((x - ray.origin.x) / ray.direction.x);

    // Draw the lens and the focal plane.
    let half = f64::from(lens.aperture / 2.0);
    let lens_line = Pen::new(Ink::Color(4)).wide(9.0);
    drawing.line(view.at(0.0, -half), view.at(0.0, half), lens_line);
    drawing.text(view.at(0.0, half + 0.22), Anchor::Middle, TEXT, lens_line.ink, "lens");
    let focus = f64::from(lens.focal_distance);
    drawing.line(view.at(focus, -1.7), view.at(focus, 1.7), Pen::new(Ink::Text).wide(2.0).dashed());
    drawing.text(view.at(focus, 1.85), Anchor::Middle, TEXT, Ink::Text, "focal plane");
    // Mark the focal distance and the aperture.
    drawing.arrow(view.at(0.1, -1.95), view.at(focus - 0.05, -1.95), Pen::new(Ink::Faint).wide(2.0));
    drawing.arrow(view.at(focus - 0.1, -1.95), view.at(0.05, -1.95), Pen::new(Ink::Faint).wide(2.0));
    drawing.text(view.at(focus / 2.0, -2.25), Anchor::Middle, SMALL, Ink::Text, "focal distance");
    drawing.text_upwards(view.at(-0.35, 0.0), SMALL, Ink::Text, "aperture");

    // Draw the rays, and how far they spread nearer and farther than the focal plane.
    for ray in &rays {
        drawing.line(at(ray.origin), at(reach(ray, 7.6)), Pen::new(Ink::Color(0)).wide(2.0));
    }
    for x in [2.3, 6.9] {
        let ends = [&rays[0], &rays[4]].map(|ray| reach(ray, x));
        drawing.line(at(ends[0]), at(ends[1]), Pen::new(Ink::Color(1)).wide(9.0));
        let wide = (ends[0].y - ends[1].y).abs();
        let top = ends[0].y.max(ends[1].y);
        drawing.text(
            at(vec3(x, top + 0.32, 0.0)),
            Anchor::Middle,
            SMALL,
            Ink::Color(1),
            "circle of confusion",
        );
        drawing.text(
            at(vec3(x, top + 0.1, 0.0)),
            Anchor::Middle,
            SMALL,
            Ink::Color(1),
            &format!("{wide:.2} wide"),
        );
    }
    drawing.dot(at(reach(&rays[2], lens.focal_distance)), 9.0, Ink::Color(1));
    Ok(drawing.svg())
}

fn shifted(point: Point, by: Point) -> Point {
    [point[0] + by[0], point[1] + by[1]]
}
