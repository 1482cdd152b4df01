//! Diagrams of the intersection of rays and spheres.

use anyhow::{Context, Result};
use glam::{DVec3, Vec2, Vec3, vec3};
use raykata::kit::{Kit, SphereQuery};
use raykata::random::{Points, Purpose};
use raykata::ray::Ray;
use raykata::scene::Sampler;
use raykata::shape::Sphere;
use raykata_cli::svg::{Axis, Drawing, End, Ink, Middle, Plot, SMALL, Start, TEXT, offset, plane};

const UNIT: Sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };

/// Five rays and a circle, with the roots of their equations.
pub fn sphere_roots(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The roots of five rays and a sphere", 1000.0, 620.0);
    let (view, at) = plane([420.0, 310.0], 190.0);
    drawing.circle(view.origin, view.scale, Ink::Faint.pen(4.0));
    let starts = [(-2.0, 1.4), (-2.0, 1.0), (-2.0, 0.5), (0.2, -0.3), (1.5, -0.7)];
    for (x, y) in starts {
        let ray = Ray::new(vec3(x, y, 0.0), Vec3::X);
        let hit = kit.sphere_algebraic(&[SphereQuery { ray, sphere: UNIT }])[0];
        let ink = if hit.is_some() { Ink::Color(0) } else { Ink::Text };
        drawing.line(view.at(-2.1, f64::from(y)), at(ray.origin), Ink::Faint.pen(1.5).dashed());
        drawing.arrow(at(ray.origin), view.at(1.95, f64::from(y)), ink.pen(3.0));
        drawing.dot(at(ray.origin), 5.0, ink);
        // The line meets the circle at x = ±√(1 - y²).
        let square = 1.0 - y * y;
        let roots: Vec<f32> = match square {
            s if s < 0.0 => vec![],
            0.0 => vec![-x],
            s => vec![-s.sqrt() - x, s.sqrt() - x],
        };
        for t in roots {
            let place = at(ray.at(t));
            if ray.contains(t) {
                drawing.dot(place, 9.0, ink);
            } else {
                drawing.circle(place, 8.0, ink.pen(3.0));
            }
            // Write beside the circle: outside of its upper half, inside of its lower half.
            let by = 30.0 * f64::from((x + t) * y.signum()).signum();
            let by = if square == 0.0 { 0.0 } else { by };
            drawing.text(offset(place, [by, -16.0]), Middle, SMALL, ink, &format!("{t:.2}"));
        }
        let text = hit.map_or("None".into(), |t| format!("Some({t:.2})"));
        drawing.text(offset(view.at(2.0, f64::from(y)), [10.0, 9.0]), Start, TEXT, ink, &text);
    }
    let text = "filled: a root with t above 0; hollow: behind the origin";
    drawing.text([30.0, 606.0], Start, SMALL, Ink::Text, text);
    Ok(drawing.svg())
}

/// The lengths of the geometric solution.
pub fn sphere_geometry(kit: &dyn Kit) -> Result<String> {
    let ray = Ray::new(vec3(-2.6, 0.0, 0.0), Vec3::X);
    let sphere = Sphere { center: vec3(0.0, -0.62, 0.0), radius: 1.0 };
    let near = kit.sphere_geometric(&[SphereQuery { ray, sphere }])[0].context("this ray misses")?;
    // The far hit is the near one of the same line, backwards from the far side.
    let back = Ray::new(vec3(2.6, 0.0, 0.0), -Vec3::X);
    let far = kit.sphere_geometric(&[SphereQuery { ray: back, sphere }])[0].context("this ray misses")?;
    let [near, far] = [ray.at(near), back.at(far)];
    let foot = vec3(sphere.center.x, 0.0, 0.0);

    let mut drawing = Drawing::new("The geometric solution of a ray and a sphere", 1000.0, 560.0);
    let (view, at) = plane([600.0, 190.0], 205.0);
    drawing.circle(at(sphere.center), view.scale, Ink::Faint.pen(4.0));
    drawing.arrow(at(ray.origin), view.at(1.85, 0.0), Ink::Text.pen(3.0));
    drawing.arrow(at(ray.origin), at(sphere.center), Ink::Color(0).pen(3.0));
    drawing.line(at(foot), at(sphere.center), Ink::Color(2).pen(3.0));
    drawing.line(at(sphere.center), at(far), Ink::Text.pen(2.0).dashed());
    drawing.line(at(near), at(far), Ink::Color(1).pen(7.0));
    for (point, ink) in [
        (ray.origin, Ink::Text),
        (sphere.center, Ink::Text),
        (foot, Ink::Color(2)),
        (near, Ink::Color(1)),
        (far, Ink::Color(1)),
    ] {
        drawing.dot(at(point), 8.0, ink);
    }
    let labels = [
        (ray.origin, [0.0, -18.0], "o", Ink::Text),
        (sphere.center, [-4.0, 34.0], "c", Ink::Text),
        (foot, [0.0, -18.0], "t_ca", Ink::Color(2)),
        (near, [-60.0, -18.0], "t_ca - t_hc", Ink::Color(1)),
        (far, [70.0, -18.0], "t_ca + t_hc", Ink::Color(1)),
        ((near + foot) / 2.0, [0.0, 32.0], "t_hc", Ink::Color(1)),
        ((far + foot) / 2.0, [0.0, 32.0], "t_hc", Ink::Color(1)),
        ((ray.origin + sphere.center) / 2.0, [-40.0, 34.0], "L", Ink::Color(0)),
        ((foot + sphere.center) / 2.0, [-28.0, 22.0], "|N|", Ink::Color(2)),
        ((far + sphere.center) / 2.0, [26.0, 26.0], "r", Ink::Text),
    ];
    for (point, by, name, ink) in labels {
        drawing.text(offset(at(point), by), Middle, TEXT, ink, name);
    }
    Ok(drawing.svg())
}

/// How many hits are lost with the distance, by the textbook's discriminant and by the kit.
pub fn sphere_cancellation(kit: &dyn Kit) -> Result<String> {
    const RAYS: u64 = 20_000;
    let mut drawing = Drawing::new("Hits that are lost with the distance", 1000.0, 620.0);
    let plot =
        Plot::new(Axis::logarithmic(10.0, 1e6), Axis::linear(0.0, 100.0), [130.0, 530.0], [770.0, 460.0]);
    let x =
        [(10.0, "10"), (100.0, "100"), (1e3, "1,000"), (1e4, "10,000"), (1e5, "100,000"), (1e6, "1,000,000")];
    let y = [(0.0, "0 %"), (50.0, "50 %"), (100.0, "100 %")];
    plot.draw_axes(&mut drawing, &x, &y, ["distance in radii of the sphere", "hits that are lost"]);
    let (mut textbook, mut ours) = (Vec::new(), Vec::new());
    for power in 0..=20u32 {
        let distance = 10f64.powf(1.0 + f64::from(power) / 4.0);
        let rays: Vec<Ray> = (0..RAYS).map(|pixel| aimed(distance as f32, pixel)).collect();
        let queries: Vec<SphereQuery> = rays.iter().map(|&ray| SphereQuery { ray, sphere: UNIT }).collect();
        // The rays that hit by double precision.
        let exact = |ray: &Ray| {
            let (o, d): (DVec3, DVec3) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
            // The square of the distance of the line from the centre, without a difference of large numbers.
            o.cross(d).length_squared() / d.length_squared() <= 1.0
        };
        let single = |ray: &Ray| {
            let (o, d) = (ray.origin, ray.direction);
            let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
            b * b - a * c >= 0.0
        };
        let answers = kit.sphere_algebraic(&queries);
        let mut counts = [0u32; 3];
        for (ray, answer) in rays.iter().zip(answers).filter(|(ray, _)| exact(ray)) {
            counts[0] += 1;
            counts[1] += u32::from(!single(ray));
            counts[2] += u32::from(answer.is_none());
        }
        let percent = |lost: u32| 100.0 * f64::from(lost) / f64::from(counts[0].max(1));
        textbook.push([distance, percent(counts[1])]);
        ours.push([distance, percent(counts[2])]);
    }
    for (values, ink, name, at) in [
        (&textbook, Ink::Color(1), "b² - a c in single precision", 12),
        (&ours, Ink::Color(0), "sphere_algebraic", 20),
    ] {
        plot.draw_curve(&mut drawing, values.iter().copied(), ink.pen(4.0));
        let [x, y] = values[at];
        let label = if at == 20 { [-10.0, -22.0] } else { [-16.0, -30.0] };
        drawing.text(offset(plot.at(x, y), label), End, TEXT, ink, name);
    }
    Ok(drawing.svg())
}

/// A ray from a random place at a distance from the unit sphere to a random point inside it; its direction has the length of
/// the distance.
fn aimed(distance: f32, pixel: u64) -> Ray {
    let points = Points::new(Sampler::Random, 1, pixel, 0, 1);
    let numbers = |purpose| points.stratum(purpose, 0, 1).u;
    let direction = |u: Vec2| {
        let z = 1.0 - 2.0 * u.x;
        let side = Vec2::from_angle(std::f32::consts::TAU * u.y) * (1.0 - z * z).max(0.0).sqrt();
        vec3(side.x, side.y, z)
    };
    let origin = distance * direction(numbers(Purpose::Pixel));
    let inside = numbers(Purpose::Time).x.cbrt() * direction(numbers(Purpose::Lens));
    Ray::new(origin, inside - origin)
}
