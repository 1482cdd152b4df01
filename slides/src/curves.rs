//! Diagrams of stage 8: transforms, and curved surfaces.

use anyhow::{Context, Result};
use glam::{Affine3A, Vec2, Vec3, vec3};
use raykata::kit::{BasisQuery, Kit, NormalQuery, ObjectRayQuery, PatchQuery, SphereQuery};
use raykata::ray::Ray;
use raykata::shape::{BezierPatch, Sphere};
use raykata_cli::svg::{Axis, Drawing, Ink, Middle, Plot, Point, SMALL, Start, TEXT, offset, plane, steps};
use std::f32::consts::TAU;

fn circle() -> impl Iterator<Item = Vec3> {
    (0..=120).map(|i| Vec2::from_angle(i as f32 / 120.0 * TAU).extend(0.0))
}

/// A ray in the world and in the space of an object: the hit has the same t.
pub fn ray_to_object(kit: &dyn Kit) -> Result<String> {
    let to_world = Affine3A::from_rotation_z(0.5) * Affine3A::from_scale(vec3(1.7, 0.8, 1.0));
    let ray = Ray::new(vec3(-2.3, -0.9, 0.0), vec3(0.5, 0.23, 0.0));
    let to_object = to_world.inverse();
    let object_ray = kit.ray_to_object(&[ObjectRayQuery { ray, to_object }])[0];
    let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let t = kit.sphere_algebraic(&[SphereQuery { ray: object_ray, sphere }])[0].context("this ray misses")?;
    let mut drawing = Drawing::new("A ray in the world and in the space of an object", 1000.0, 500.0);
    let spaces = [(250.0, to_world, ray, "world"), (760.0, Affine3A::IDENTITY, object_ray, "object")];
    for (x, shape, ray, name) in spaces {
        let (_, at) = plane([x, 240.0], 98.0);
        let outline: Vec<Point> = circle().map(|v| at(shape.transform_point3(v))).collect();
        drawing.area(&outline, Ink::Color(4), 0.16);
        drawing.polyline(&outline, Ink::Color(4).pen(3.0));
        drawing.arrow(at(ray.origin), at(ray.at(6.6)), Ink::Text.pen(3.0));
        for mark in [1.0, 2.0, 3.0] {
            drawing.dot(at(ray.at(mark)), 6.0, Ink::Text);
            drawing.text(offset(at(ray.at(mark)), [8.0, 28.0]), Middle, SMALL, Ink::Text, &format!("{mark}"));
        }
        drawing.dot(at(ray.at(t)), 9.0, Ink::Color(1));
        let label = offset(at(ray.at(t)), [-2.0, -22.0]);
        drawing.text(label, Middle, SMALL, Ink::Color(1), &format!("t = {t:.2}"));
        drawing.text([x, 480.0], Middle, TEXT, Ink::Text, name);
    }
    drawing.arrow([410.0, 440.0], [600.0, 440.0], Ink::Color(0).pen(4.0));
    drawing.text([505.0, 424.0], Middle, TEXT, Ink::Color(0), "inverse");
    Ok(drawing.svg())
}

/// Normals of a stretched circle: transformed like points, and as normals.
pub fn normal_transform(kit: &dyn Kit) -> Result<String> {
    let stretch = Affine3A::from_scale(vec3(2.0, 1.0, 1.0));
    let mut drawing = Drawing::new("How normals are transformed", 1000.0, 430.0);
    let like_points = |normal: Vec3| stretch.transform_vector3(normal).normalize();
    let right = |normal: Vec3| {
        kit.normal_to_world(&[NormalQuery { normal, to_object: stretch.inverse() }])[0].normalize()
    };
    type Turn<'a> = &'a dyn Fn(Vec3) -> Vec3;
    let columns: [(f64, Affine3A, Turn<'_>, &str, Ink); 3] = [
        (120.0, Affine3A::IDENTITY, &|normal| normal, "object", Ink::Text),
        (440.0, stretch, &like_points, "like points: wrong", Ink::Color(1)),
        (810.0, stretch, &right, "normal_to_world", Ink::Color(2)),
    ];
    for (x, shape, turn, name, ink) in columns {
        let (_, at) = plane([x, 190.0], 61.0);
        let outline: Vec<Point> = circle().map(|v| at(shape.transform_point3(v))).collect();
        drawing.polyline(&outline, Ink::Faint.pen(4.0));
        for i in 0..12 {
            let normal = Vec2::from_angle((i as f32 + 0.5) / 12.0 * TAU).extend(0.0);
            let place = shape.transform_point3(normal);
            drawing.arrow(at(place), at(place + 0.75 * turn(normal)), ink.pen(3.0));
        }
        drawing.text([x, 390.0], Middle, TEXT, ink, name);
    }
    Ok(drawing.svg())
}

/// A cubic Bézier curve, and the rounds of the algorithm of de Casteljau.
pub fn de_casteljau(kit: &dyn Kit) -> Result<String> {
    let row = [vec3(0.0, 0.0, 0.0), vec3(1.2, 3.2, 0.0), vec3(5.4, 3.8, 0.0), vec3(7.2, 0.5, 0.0)];
    let patch = BezierPatch { rows: [row; 4] };
    let at_u = |u: f32| kit.bezier_point(&[PatchQuery { patch, uv: Vec2::new(u, 0.5) }])[0];
    let u = 0.6;
    let mut drawing = Drawing::new("The algorithm of de Casteljau", 1000.0, 560.0);
    let (_, at) = plane([120.0, 490.0], 108.0);
    let curve: Vec<Point> = steps(0.0, 1.0, 80).map(|u| at(at_u(u as f32))).collect();
    drawing.polyline(&curve, Ink::Text.pen(5.0));
    // Each round replaces neighbouring points by points between them.
    let mut points = row.to_vec();
    let names =
        [("four control points", Ink::Faint), ("three points", Ink::Color(4)), ("two points", Ink::Color(2))];
    for (line, (name, ink)) in names.into_iter().enumerate() {
        let places: Vec<Point> = points.iter().map(|&point| at(point)).collect();
        drawing.polyline(&places, ink.pen(3.0));
        for place in places {
            drawing.dot(place, 9.0, ink);
        }
        drawing.text([330.0, 392.0 + 34.0 * line as f64], Start, SMALL, ink, name);
        points = points.windows(2).map(|pair| pair[0].lerp(pair[1], u)).collect();
    }
    drawing.dot(at(at_u(u)), 12.0, Ink::Color(1));
    drawing.text([330.0, 494.0], Start, SMALL, Ink::Color(1), "the point of the curve, u = 0.6");
    for (i, point) in row.iter().enumerate() {
        let below = if i % 3 == 0 { 38.0 } else { -16.0 };
        drawing.text(offset(at(*point), [0.0, below]), Middle, TEXT, Ink::Text, &format!("p{i}"));
    }
    Ok(drawing.svg())
}

/// The cubic B-spline basis functions over clamped knots, and their sum.
pub fn bspline_basis(kit: &dyn Kit) -> Result<String> {
    let knots = vec![0.0f32, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0];
    let degree = 3;
    let n = knots.len() - degree - 1;
    let mut drawing = Drawing::new("Cubic B-spline basis functions", 1000.0, 560.0);
    let plot = Plot::new(Axis::linear(0.0, 4.0), Axis::linear(0.0, 1.1), [80.0, 470.0], [870.0, 400.0]);
    let x = [(0.0, "0"), (1.0, "1"), (2.0, "2"), (3.0, "3"), (4.0, "4")];
    plot.draw_axes(
        &mut drawing,
        &x,
        &[(0.0, "0"), (0.5, "0.5"), (1.0, "1")],
        ["u; knots 0 0 0 0 1 2 3 4 4 4 4", ""],
    );
    let us: Vec<f64> = steps(0.0, 4.0, 200).collect();
    let mut sums = vec![0.0; us.len()];
    for index in 0..n {
        let query = |&u: &f64| BasisQuery { knots: knots.clone(), degree, index, u: u as f32 };
        let values = kit.bspline_basis(&us.iter().map(query).collect::<Vec<_>>());
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        for (sum, value) in sums.iter_mut().zip(&values) {
            *sum += value;
        }
        let curve: Vec<[f64; 2]> = us.iter().zip(values).map(|(&u, value)| [u, value]).collect();
        plot.draw_curve(&mut drawing, curve.iter().copied(), Ink::Color(index).pen(4.0));
        let top = curve
            .iter()
            .copied()
            .fold([0.0, 0.0], |best: [f64; 2], one| if one[1] > best[1] { one } else { best });
        let by = if index == 0 {
            [30.0, 34.0]
        } else if index + 1 == n {
            [-30.0, 34.0]
        } else {
            [0.0, -14.0]
        };
        let label = offset(plot.at(top[0], top[1]), by);
        drawing.text(label, Middle, TEXT, Ink::Color(index), &index.to_string());
    }
    plot.draw_curve(
        &mut drawing,
        us.into_iter().zip(sums).map(|(u, sum)| [u, sum]),
        Ink::Text.pen(3.0).dashed(),
    );
    drawing.text(offset(plot.at(2.0, 1.0), [0.0, -14.0]), Middle, SMALL, Ink::Text, "sum");
    Ok(drawing.svg())
}
