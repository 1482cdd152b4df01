//! Diagrams of samples: the Gaussian filter, points of a disk, soft shadows, and boxes that move.

use anyhow::Result;
use glam::{Vec2, Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{FILTER_RADIUS, Kit, RectangleQuery};
use raykata::random::{Points, Purpose};
use raykata::scene::Sampler;
use raykata_cli::svg::{
    Axis, Drawing, Ink, LARGE, Middle, Plot, SMALL, Start, TEXT, View, offset, plane, steps,
};

/// The weight of the Gaussian filter, and the Gaussian that is cut off.
pub fn gaussian_weight(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The weight of a sample over its distance", 1000.0, 600.0);
    let plot = Plot::new(Axis::linear(-2.0, 2.0), Axis::linear(0.0, 1.0), [70.0, 510.0], [560.0, 430.0]);
    let radius = f64::from(FILTER_RADIUS);
    let xs: Vec<f64> = steps(-2.0, 2.0, 400).collect();
    let points: Vec<Vec2> = xs.iter().map(|&x| Vec2::new(x as f32, 0.0)).collect();
    let weights = kit.gaussian_weight(&points);
    let middle = f64::from(kit.gaussian_weight(&[Vec2::ZERO])[0]);
    let ours: Vec<[f64; 2]> = xs.iter().zip(weights).map(|(&x, w)| [x, f64::from(w) / middle]).collect();
    let gauss = |x: f64| (-2.0 * x * x).exp();
    let cut: Vec<[f64; 2]> = steps(-radius, radius, 300).map(|x| [x, gauss(x)]).collect();
    let step = gauss(radius);
    let cut: Vec<[f64; 2]> =
        [[-2.0, 0.0], [-radius, 0.0]].into_iter().chain(cut).chain([[radius, 0.0], [2.0, 0.0]]).collect();

    drawing.rectangle(plot.at(-0.5, 0.0), plot.at(0.5, 1.0), Ink::Faint, 0.2);
    let x = [(-2.0, "-2"), (-1.0, "-1"), (0.0, "0"), (1.0, "1"), (2.0, "2")];
    let titles = ["distance from the centre of the pixel, in pixels", "weight, 1 in the middle"];
    plot.draw_axes(&mut drawing, &x, &[(0.0, "0"), (0.5, "0.5"), (1.0, "1")], titles);
    drawing.text(offset(plot.at(0.0, 0.0), [0.0, -14.0]), Middle, SMALL, Ink::Text, "pixel");
    // The inset shows the end of both curves, with weights ten times as large.
    let inset = Plot::new(Axis::linear(1.2, 1.7), Axis::linear(0.0, 0.06), [720.0, 510.0], [250.0, 258.0]);
    let ticks = [(0.0, "0"), (0.02, "0.02"), (0.04, "0.04"), (0.06, "0.06")];
    inset.draw_axes(&mut drawing, &[(1.2, "1.2"), (1.5, "1.5")], &ticks, ["", "the end, magnified"]);
    for (curve, pen) in [(&cut, Ink::Color(1).pen(4.0).dashed()), (&ours, Ink::Color(0).pen(4.0))] {
        plot.draw_curve(&mut drawing, curve.iter().copied(), pen);
        let end = curve.iter().copied().filter(|[x, y]| (1.2..=1.7).contains(x) && *y <= 0.06);
        inset.draw_curve(&mut drawing, end, pen);
    }
    drawing.text([660.0, 90.0], Start, SMALL, Ink::Color(0), "gaussian_weight, scaled");
    drawing.text([660.0, 130.0], Start, SMALL, Ink::Color(1), "exp(-2 x²), cut at 1.5:");
    drawing.text([660.0, 166.0], Start, SMALL, Ink::Color(1), &format!("a step of {step:.3}"));
    Ok(drawing.svg())
}

/// A thousand points of a disk: with the radius `u`, and by `sample_disk`.
pub fn disk_samples(kit: &dyn Kit) -> Result<String> {
    let numbers: Vec<Vec2> = (0..1000)
        .map(|pixel| Points::new(Sampler::Random, 0, pixel, 0, 1).stratum(Purpose::Lens, 0, 1).u)
        .collect();
    let wrong: Vec<Vec2> =
        numbers.iter().map(|u| u.x * Vec2::from_angle(std::f32::consts::TAU * u.y)).collect();
    let right = kit.sample_disk(&numbers);
    let mut drawing = Drawing::new("Points of a disk with two formulas for the radius", 1000.0, 560.0);
    for (x, points, name, ink) in [
        (250.0, wrong, "radius = u", Ink::Color(1)),
        (750.0, right, "sample_disk: radius = √u", Ink::Color(0)),
    ] {
        let view = View { origin: [x, 240.0], scale: 220.0 };
        for point in &points {
            drawing.dot(view.at(f64::from(point.x), f64::from(point.y)), 3.0, ink);
        }
        drawing.circle(view.origin, 220.0, Ink::Text.pen(2.0));
        drawing.circle(view.origin, 110.0, Ink::Text.pen(4.0));
        let inside = points.iter().filter(|point| point.length() < 0.5).count();
        drawing.text([x, 502.0], Middle, TEXT, Ink::Text, name);
        let share = format!("{:.1} % within half the radius", inside as f64 / 10.0);
        drawing.text([x, 538.0], Middle, SMALL, Ink::Text, &share);
    }
    Ok(drawing.svg())
}

/// The number of shades of grey of a floor, apart from white.
const LEVELS: u32 = 32;

/// The shadows of a point light and of an area light, with the fraction of the light that is visible along the floor.
pub fn penumbra(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("A sharp shadow and a soft shadow", 1000.0, 620.0);
    // The light is 3 above the floor, and the occluder 1.2 above it, from -0.5 to 0.5.
    let occluder = [vec3(-0.5, 1.2, 0.0), vec3(0.5, 1.2, 0.0)];
    for (x, half, name) in [(250.0, 0.0f32, "point light"), (750.0, 0.5, "area light")] {
        let u = (0..1000).map(|i| Vec2::new((i as f32 + 0.5) / 1000.0, 0.5));
        let query = |u| RectangleQuery {
            corner: vec3(-half, 3.0, 0.0),
            edges: (vec3(2.0 * half, 0.0, 0.0), Vec3::Z),
            u,
        };
        let points = kit.sample_rectangle(&u.map(query).collect::<Vec<_>>());
        // Count the points of the light whose line to the floor passes beside the occluder.
        let visible = |place: f64| {
            let free = points.iter().filter(|point| {
                let share = f64::from(occluder[0].y / point.y);
                let crossing = place + (f64::from(point.x) - place) * share;
                !(f64::from(occluder[0].x)..=f64::from(occluder[1].x)).contains(&crossing)
            });
            free.count() as f64 / points.len() as f64
        };
        let (view, at) = plane([x, 370.0], 105.0);
        let fractions: Vec<[f64; 2]> = steps(-2.0, 2.0, 400).map(|place| [place, visible(place)]).collect();
        // Draw the floor, darker where less light arrives: one layer per level over all places that are darker. Layers are
        // nested, because gaps would show between pieces side by side.
        for level in 1..=LEVELS {
            let least = (f64::from(level) - 0.5) / f64::from(LEVELS);
            let mut places = fractions.iter().filter(|[_, visible]| 1.0 - visible > least).map(|[x, _]| *x);
            let Some(first) = places.next() else { continue };
            let last = places.next_back().unwrap_or(first);
            // With this opacity the first k layers together are k / LEVELS opaque.
            let opacity = 1.0 / f64::from(LEVELS - level + 1);
            drawing.rectangle(view.at(first, 0.0), view.at(last, -0.14), Ink::Text, opacity);
        }
        drawing.line(view.at(-2.0, 0.0), view.at(2.0, 0.0), Ink::Text.pen(3.0));
        for end in [-half, half] {
            for edge in occluder {
                let light = vec3(end, 3.0, 0.0);
                let floor = light + (edge - light) * (3.0 / (3.0 - 1.2));
                drawing.line(at(light), at(floor), Ink::Color(3).pen(1.5));
            }
        }
        drawing.line(at(occluder[0]), at(occluder[1]), Ink::Text.pen(10.0));
        drawing.line(view.at(-f64::from(half), 3.0), view.at(f64::from(half), 3.0), Ink::Color(3).pen(10.0));
        drawing.dot(view.at(0.0, 3.0), 8.0, Ink::Color(3));
        drawing.text(view.at(0.7, 2.95), Start, SMALL, Ink::Color(3), name);
        drawing.text(view.at(0.62, 1.14), Start, SMALL, Ink::Text, "occluder");
        let plot =
            Plot::new(Axis::linear(-2.0, 2.0), Axis::linear(0.0, 1.0), [x - 210.0, 570.0], [420.0, 120.0]);
        plot.draw_axes(&mut drawing, &[], &[(0.0, "0"), (1.0, "1")], ["", ""]);
        plot.draw_curve(&mut drawing, fractions.iter().copied(), Ink::Color(0).pen(4.0));
        drawing.text([x, 604.0], Middle, SMALL, Ink::Color(0), "fraction of the light that is visible");
    }
    Ok(drawing.svg())
}

/// A box that moves, its places at five times, and the box around its motion.
pub fn motion_bounds(kit: &dyn Kit) -> Result<String> {
    let start = Aabb::new(vec3(0.0, 0.0, 0.0), vec3(1.6, 1.1, 1.0));
    let end = Aabb::new(vec3(6.0, 2.2, 0.0), vec3(7.1, 4.0, 1.0));
    let mut drawing = Drawing::new("A box in motion, and the box around its motion", 1000.0, 560.0);
    let (_, at) = plane([90.0, 500.0], 112.0);
    for time in [0.25, 0.5, 0.75] {
        let [low, high] =
            [(start.min, end.min), (start.max, end.max)].map(|(a, b)| kit.lerp(&[(a, b, time)])[0]);
        drawing.rectangle(at(low), at(high), Ink::Color(4), 0.16);
        drawing.frame(at(low), at(high), Ink::Color(4).pen(1.5));
        let middle = offset(at((low + high) / 2.0), [0.0, 14.0]);
        drawing.text(middle, Middle, LARGE, Ink::Text, &time.to_string());
    }
    let corner = |bounds: &Aabb, i: usize| {
        let [low, high] = [bounds.min, bounds.max];
        vec3(if i & 1 == 0 { low.x } else { high.x }, if i & 2 == 0 { low.y } else { high.y }, 0.0)
    };
    for i in 0..4 {
        drawing.arrow(at(corner(&start, i)), at(corner(&end, i)), Ink::Faint.pen(1.5));
    }
    for (bounds, name) in [(start, "time 0"), (end, "time 1")] {
        drawing.frame(at(bounds.min), at(bounds.max), Ink::Color(0).pen(4.0));
        let middle = offset(at((bounds.min + bounds.max) / 2.0), [0.0, 14.0]);
        drawing.text(middle, Middle, LARGE, Ink::Color(0), name);
    }
    let around = kit.motion_bounds(&[(start, end)])[0];
    drawing.frame(at(around.min), at(around.max), Ink::Color(1).pen(4.0).dashed());
    let label = offset(at(vec3(around.min.x, around.max.y, 0.0)), [14.0, 46.0]);
    drawing.text(label, Start, LARGE, Ink::Color(1), "motion_bounds");
    Ok(drawing.svg())
}
