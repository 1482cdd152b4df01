//! Diagrams of the surface of a mesh: the inside tests, normals of vertices, texture coordinates, and the colour between pixels.

use anyhow::{Context, Result, ensure};
use glam::{DVec3, Vec2, Vec3, vec2, vec3};
use raykata::kit::{InsideQuery, InterpolateQuery, Kit, TextureQuery, TriangleQuery};
use raykata::material::{Texture, Wrap};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use raykata_cli::svg::{Drawing, End, Ink, Middle, Point, SMALL, Start, TEXT, View, offset, plane};
use std::sync::Arc;

/// The three inside tests at the same triangle and point.
pub fn inside_tests(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The inside tests I, II and III", 1000.0, 520.0);
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(2.5, 0.2, 0.0), c: vec3(0.9, 2.2, 0.0) };
    let Triangle { a, b, c } = triangle;
    let point = vec3(1.25, 0.75, 0.0);
    let origin = vec3(0.75, 0.85, 2.3);
    let ray = Ray::new(origin, point - origin);
    let query = [InsideQuery { ray, point, triangle }];
    let areas = kit.inside_by_areas(&query)[0].context("the point is outside")?;
    ensure!(kit.inside_by_planes(&query)[0] && kit.inside_by_direction(&query)[0], "the tests differ");
    for (panel, name) in ["I: three planes", "II: three turns", "III: three areas"].into_iter().enumerate() {
        let view = View { origin: [40.0 + 328.0 * panel as f64, 390.0], scale: 106.0 };
        // Oblique projection: z goes down and to the left, so that the origin of the ray stands in front.
        let at = |v: Vec3| view.at(f64::from(v.x - 0.28 * v.z + 0.05), f64::from(v.y + 0.55 * v.z - 0.1));
        let corners = [at(a), at(b), at(c)];
        match panel {
            0 => {
                drawing.area(&corners, Ink::Color(4), 0.2);
                // The plane through the origin and the side from a to b.
                drawing.area(&[at(origin), at(a), at(b)], Ink::Color(3), 0.3);
                let middle = (a + b + origin) / 3.0;
                let normal = (a - origin).cross(b - origin).normalize();
                let upwards = 0.8 * normal * normal.y.signum();
                drawing.arrow(at(middle), at(middle + upwards), Ink::Color(3).pen(3.0));
                drawing.arrow(at(origin), at(point), Ink::Text.pen(3.0));
                drawing.dot(at(origin), 8.0, Ink::Text);
                drawing.text(offset(at(origin), [14.0, 2.0]), Start, TEXT, Ink::Text, "o");
            }
            1 => {
                drawing.area(&corners, Ink::Color(4), 0.2);
                for corner in [a, b] {
                    drawing.arrow(at(point), at(corner), Ink::Color(3).pen(4.0));
                }
                // The turn from one end of the side to the other.
                let turn = |share: f32| at(point + 0.38 * (a.lerp(b, share) - point).normalize());
                let steps: Vec<Point> = (0..=20).map(|i| turn(i as f32 / 20.0)).collect();
                drawing.polyline(&steps[..19], Ink::Color(1).pen(4.0));
                drawing.arrow(steps[17], steps[20], Ink::Color(1).pen(4.0));
            }
            _ => {
                let parts = [
                    (b, c, areas.x, "α", Ink::Color(1)),
                    (c, a, areas.y, "β", Ink::Color(0)),
                    (a, b, areas.z, "γ", Ink::Color(2)),
                ];
                for (row, (from, to, share, name, ink)) in parts.into_iter().enumerate() {
                    drawing.area(&[at(point), at(from), at(to)], ink, 0.4);
                    let label = offset(at((point + from + to) / 3.0), [0.0, 9.0]);
                    drawing.text(label, Middle, TEXT, Ink::Text, name);
                    let text = format!("{name} {share:.2}");
                    let x = view.origin[0] + 22.0 + 95.0 * row as f64;
                    drawing.text([x, 500.0], Start, SMALL, ink, &text);
                }
            }
        }
        drawing.polyline(&[corners[0], corners[1], corners[2], corners[0]], Ink::Text.pen(3.0));
        drawing.dot(at(point), 9.0, Ink::Text);
        let by = if panel == 2 { [0.0, -14.0] } else { [16.0, -6.0] };
        drawing.text(offset(at(point), by), Start, TEXT, Ink::Text, "P");
        for (corner, name, by) in [(a, "a", [-12.0, 28.0]), (b, "b", [6.0, 28.0]), (c, "c", [12.0, 0.0])] {
            drawing.text(offset(at(corner), by), Start, SMALL, Ink::Text, name);
        }
        drawing.text([view.origin[0] + 20.0, 464.0], Start, TEXT, Ink::Text, name);
    }
    drawing.text([50.0, 500.0], Start, SMALL, Ink::Color(3), "same side of all");
    drawing.text([385.0, 500.0], Start, SMALL, Ink::Color(1), "one sense of rotation");
    Ok(drawing.svg())
}

/// A vertex with six triangles, their normals and its own.
pub fn vertex_normals(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The normal of a vertex", 1000.0, 600.0);
    // Seen from the front and above: x to the right, y up, z towards the viewer.
    let view = View { origin: [500.0, 400.0], scale: 165.0 };
    let at = |v: Vec3| view.at(f64::from(v.x - 0.35 * v.z), f64::from(v.y - 0.42 * v.z));
    let radii = [2.2f32, 1.9, 2.3, 2.0, 1.7, 2.1];
    let corner = |index: usize| {
        let (sin, cos) = (60.0 * index as f32 + 20.0).to_radians().sin_cos();
        radii[index % 6] * vec3(cos, 0.0, -sin)
    };
    let mut positions = vec![0.75 * Vec3::Y];
    positions.extend((0..6).map(corner));
    let triangles: Vec<[u32; 3]> = (0..6).map(|index| [0, 1 + index, 1 + (index + 1) % 6]).collect();
    let mesh = Mesh { positions, triangles, ..Mesh::default() };
    let normal = kit.vertex_normals(std::slice::from_ref(&mesh)).remove(0)[0];
    let faces: Vec<Triangle> =
        (0..6).map(|index| mesh.corners(index)).map(|[a, b, c]| Triangle { a, b, c }).collect();
    for triangle in &faces {
        let corners = [at(triangle.a), at(triangle.b), at(triangle.c)];
        drawing.area(&corners, Ink::Color(4), 0.18);
        drawing.polyline(&[corners[0], corners[1], corners[2]], Ink::Text.pen(2.0));
    }
    for (triangle, face) in faces.iter().zip(kit.face_normal(&faces)) {
        let middle = (triangle.a + triangle.b + triangle.c) / 3.0;
        let face = face.context("a triangle has no area")?;
        drawing.arrow(at(middle), at(middle + face), Ink::Color(0).pen(3.0));
        drawing.dot(at(middle), 5.0, Ink::Color(0));
    }
    let top = mesh.positions[0];
    drawing.arrow(at(top), at(top + 1.25 * normal), Ink::Color(1).pen(7.0));
    drawing.dot(at(top), 10.0, Ink::Color(1));
    drawing.text([40.0, 550.0], Start, TEXT, Ink::Color(0), "face_normal of each triangle");
    drawing.text([40.0, 586.0], Start, TEXT, Ink::Color(1), "vertex_normals: their sum, normalized");
    Ok(drawing.svg())
}

/// A triangle with texture coordinates, and the same triangle in the image.
pub fn texture_coordinates(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("Texture coordinates of a hit", 1000.0, 560.0);
    let triangle = Triangle { a: vec3(0.0, 0.2, 0.0), b: vec3(3.0, -0.3, 0.0), c: vec3(1.9, 2.8, 0.0) };
    let uvs = [vec2(0.15, 0.2), vec2(0.9, 0.35), vec2(0.35, 0.85)];
    let ray = Ray::new(vec3(1.75, 0.8, 4.0), -Vec3::Z);
    let hit = kit.triangle_choice(&[TriangleQuery { ray, triangle }])[0].context("the ray misses")?;
    let barycentric = vec3(1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma);
    let corners = uvs.map(|uv| uv.extend(0.0));
    let uv = kit.interpolate(&[InterpolateQuery { barycentric, corners }])[0].truncate();
    // The triangle in space.
    let (_, at) = plane([90.0, 380.0], 112.0);
    let places = [triangle.a, triangle.b, triangle.c].map(at);
    drawing.area(&places, Ink::Color(4), 0.2);
    drawing.polyline(&[places[0], places[1], places[2], places[0]], Ink::Text.pen(3.0));
    let by = [[0.0, 36.0], [-30.0, 36.0], [0.0, -16.0]];
    for ((place, uv), by) in places.iter().zip(uvs).zip(by) {
        drawing.dot(*place, 7.0, Ink::Text);
        let text = format!("({}, {})", uv.x, uv.y);
        drawing.text(offset(*place, by), Middle, SMALL, Ink::Text, &text);
    }
    drawing.dot(at(ray.at(hit.t)), 10.0, Ink::Color(1));
    let lines = [
        format!("α = {:.2}, β = {:.2}, γ = {:.2}", barycentric.x, barycentric.y, barycentric.z),
        format!("α (u, v) of a + β of b + γ of c = ({:.2}, {:.2})", uv.x, uv.y),
    ];
    drawing.lines([40.0, 512.0], 34.0, SMALL, Ink::Color(1), &lines);
    // The image, a board of eight by eight squares, from (0, 0) at the lower left to (1, 1).
    let view = View { origin: [560.0, 440.0], scale: 390.0 };
    let place = |uv: Vec2| view.at(f64::from(uv.x), f64::from(uv.y));
    for index in (0..64).filter(|index| (index % 8 + index / 8) % 2 == 0) {
        let corner = vec2((index % 8) as f32, (index / 8) as f32) / 8.0;
        drawing.rectangle(place(corner), place(corner + 0.125), Ink::Faint, 0.3);
    }
    drawing.frame(place(Vec2::ZERO), place(Vec2::ONE), Ink::Text.pen(3.0));
    let places = uvs.map(place);
    drawing.area(&places, Ink::Color(4), 0.35);
    drawing.polyline(&[places[0], places[1], places[2], places[0]], Ink::Text.pen(3.0));
    for place in places {
        drawing.dot(place, 7.0, Ink::Text);
    }
    drawing.dot(place(uv), 10.0, Ink::Color(1));
    let label = offset(place(uv), [-10.0, 34.0]);
    drawing.text(label, Start, SMALL, Ink::Color(1), &format!("({:.2}, {:.2})", uv.x, uv.y));
    drawing.text(offset(place(Vec2::ZERO), [-4.0, 32.0]), Middle, SMALL, Ink::Text, "(0, 0)");
    drawing.text(offset(place(Vec2::ONE), [4.0, -12.0]), Middle, SMALL, Ink::Text, "(1, 1)");
    drawing.text(offset(place(vec2(0.5, 0.0)), [0.0, 34.0]), Middle, TEXT, Ink::Text, "u");
    drawing.text(offset(place(vec2(0.0, 0.5)), [-24.0, 8.0]), End, TEXT, Ink::Text, "v");
    Ok(drawing.svg())
}

/// A point between the centres of four pixels, and the areas that are their weights.
pub fn bilinear(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The colour between four pixels", 1000.0, 620.0);
    // Four pixels of one colour each, by the colours of the drawing: 1 for a pixel and 0 for all others, so that the
    // answer of the kit is the weight.
    let point = vec2(0.62, 0.3);
    let uv = (vec2(0.5, 0.5) + point) / 2.0;
    let weight = |pixel: usize| {
        // Rows are stored from the top.
        let stored = [2, 3, 0, 1][pixel];
        let pixels = (0..4).map(|index| if index == stored { Vec3::ONE } else { Vec3::ZERO }).collect();
        let texture = Texture { width: 2, height: 2, pixels: Arc::new(pixels), wrap: Wrap::Clamp };
        kit.texture_color(&[TextureQuery { texture, uv }])[0].x
    };
    let view = View { origin: [170.0, 440.0], scale: 280.0 };
    let place = |p: Vec2| view.at(f64::from(p.x), f64::from(p.y));
    let inks = [Ink::Color(0), Ink::Color(1), Ink::Color(2), Ink::Color(3)];
    let centers = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(1.0, 1.0)];
    for (center, ink) in centers.into_iter().zip(inks) {
        let [low, high] = [center - 0.5, center + 0.5];
        drawing.rectangle(place(low), place(high), ink, 0.12);
        drawing.frame(place(low), place(high), Ink::Faint.pen(1.5));
    }
    // Each rectangle between the point and a centre belongs to the opposite pixel.
    let mut sum = 0.0;
    for (pixel, (center, ink)) in centers.into_iter().zip(inks).enumerate() {
        let opposite = Vec2::ONE - center;
        drawing.rectangle(place(point), place(opposite), ink, 0.55);
        let area = ((point.x - opposite.x) * (point.y - opposite.y)).abs();
        let asked = weight(pixel);
        ensure!((area - asked).abs() < 1e-4, "`texture_color` weights pixel {pixel} by {asked}");
        sum += f64::from(asked);
        let middle = offset(place((point + opposite) / 2.0), [0.0, 8.0]);
        drawing.text(middle, Middle, SMALL, Ink::Text, &format!("{asked:.2}"));
    }
    for ((center, ink), name) in centers.into_iter().zip(inks).zip(["c₀₀", "c₁₀", "c₀₁", "c₁₁"])
    {
        drawing.dot(place(center), 10.0, ink);
        let out = (center - 0.5).extend(0.0).as_dvec3();
        let by = DVec3::new(52.0 * out.x * 2.0, -52.0 * out.y * 2.0 + 9.0, 0.0);
        drawing.text(offset(place(center), [by.x, by.y]), Middle, TEXT, ink, name);
    }
    drawing.frame(place(Vec2::ZERO), place(Vec2::ONE), Ink::Text.pen(2.0));
    drawing.dot(place(point), 11.0, Ink::Text);
    let lines = ["A pixel has the weight", "of the rectangle across,", "which has its colour."];
    drawing.lines([620.0, 220.0], 42.0, TEXT, Ink::Text, &lines);
    let text = format!("δx = {}, δy = {}", point.x, point.y);
    drawing.text([630.0, 370.0], Start, SMALL, Ink::Text, &text);
    drawing.text([630.0, 408.0], Start, SMALL, Ink::Text, &format!("sum of weights {sum:.2}"));
    Ok(drawing.svg())
}
