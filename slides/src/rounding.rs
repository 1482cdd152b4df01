//! Diagrams of normals near a silhouette, and of rounding: points beside their surface, offsets, and gaps between triangles.

use anyhow::{Context, Result, ensure};
use glam::{DVec3, Vec3, dvec3, vec3};
use raykata::kit::{Kit, LightSample, OffsetQuery, ShadowQuery, Surface};
use raykata_cli::svg::{Drawing, End, Ink, LARGE, Middle, SMALL, Start, TEXT, View, offset, plane};

/// The unit vector at an angle in degrees, counterclockwise from the right.
fn at_angle(degrees: f32) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    vec3(cos, sin, 0.0)
}

/// A faceted cylinder, and a ray that meets a facet near its silhouette.
pub fn silhouette_normal(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The interpolated normal near a silhouette", 1000.0, 620.0);
    let (_, at) = plane([250.0, 660.0], 400.0);
    // The corners of the ten facets are at these angles; the facet that is met lies between 62 and 98 degrees.
    let corner = |index: i32| at_angle(62.0 + 36.0 * index as f32);
    let outline: Vec<[f64; 2]> = (-2..=3).map(|index| at(corner(index))).collect();
    drawing.area(&outline, Ink::Faint, 0.3);
    drawing.polyline(&outline, Ink::Text.pen(3.0));
    let [a, b] = [corner(0), corner(1)];
    drawing.line(at(a), at(b), Ink::Text.pen(7.0));
    let geometric = at_angle(80.0);
    let direction = at_angle(181.5);
    // Interpolate the normals of both ends at the hit.
    let share = 0.84;
    let point = a.lerp(b, share);
    let interpolated = kit.lerp(&[(a, b, share)])[0].normalize();
    let shading = kit.shading_normal(&[(geometric, Some(interpolated), direction)])[0];
    let turned = kit.face_forward(&[(interpolated, direction)])[0];
    ensure!(geometric.dot(direction) < 0.0 && interpolated.dot(direction) > 0.0, "the facet is not seen");
    for end in [a, b] {
        drawing.arrow(at(end), at(1.3 * end), Ink::Faint.pen(3.0));
    }
    drawing.arrow(at(point - 1.0 * direction), at(point), Ink::Color(3).pen(4.0));
    drawing.text(offset(at(point - 0.94 * direction), [0.0, -14.0]), Middle, TEXT, Ink::Color(3), "d");
    drawing.arrow(at(point), at(point + 0.42 * geometric), Ink::Text.pen(3.0));
    drawing.arrow(at(point), at(point + 0.55 * shading), Ink::Color(0).pen(6.0));
    drawing.arrow(at(point), at(point + 0.42 * turned), Ink::Color(1).pen(5.0).dashed());
    drawing.dot(at(point), 9.0, Ink::Text);
    let label = offset(at(point + 0.42 * geometric), [16.0, 10.0]);
    drawing.text(label, Start, SMALL, Ink::Text, "geometric normal");
    let label = offset(at(point + 0.55 * shading), [-20.0, -14.0]);
    drawing.text(label, Start, SMALL, Ink::Color(0), "shading_normal");
    let label = offset(at(point + 0.42 * turned), [18.0, -4.0]);
    drawing.text(label, Start, SMALL, Ink::Color(1), "turned by the ray: inside");
    for (row, (name, vector, ink)) in
        [("geometric", geometric, Ink::Text), ("interpolated", interpolated, Ink::Color(0))]
            .into_iter()
            .enumerate()
    {
        let dot = vector.dot(direction);
        let sign = if dot < 0.0 { "< 0" } else { "> 0" };
        let text = format!("{name}: n·d {sign}");
        drawing.text([690.0, 390.0 + 40.0 * row as f64], Start, SMALL, ink, &text);
    }
    let lines = ["The viewer sees the", "front of the facet:", "n decides the side."];
    drawing.lines([690.0, 490.0], 40.0, SMALL, Ink::Text, &lines);
    Ok(drawing.svg())
}

/// Exact hits with a slanted surface, and the rounded points beside it.
pub fn rounded_point(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("Rounded points above and below their surface", 1000.0, 620.0);
    let view = View { origin: [60.0, 560.0], scale: 104.0 };
    // One unit of the drawing is the distance of two floats near 1.
    let unit = f64::from(f32::EPSILON);
    let exact = |x: f64| dvec3(x, 0.3 + 0.43 * x, 0.0);
    let normal = dvec3(-0.43, 1.0, 0.0).normalize();
    let place = |v: DVec3| view.at(v.x, v.y);
    for column in 0..=8 {
        for row in 0..=4 {
            drawing.dot(view.at(f64::from(column), f64::from(row)), 2.5, Ink::Faint);
        }
    }
    drawing.line(place(exact(-0.3)), place(exact(8.4)), Ink::Text.pen(4.0));
    drawing.text(offset(place(exact(8.3)), [10.0, 44.0]), End, SMALL, Ink::Text, "surface");
    let mut below = 0;
    let xs = [0.42, 1.3, 2.45, 3.38, 4.3, 5.35, 6.6, 7.55];
    let mut chosen = None;
    for x in xs {
        let hit = exact(x);
        // Round near 1, where the floats have the distance `unit`, and move the point back into the drawing.
        let rounded = (DVec3::ONE + unit * hit).as_vec3();
        let grid = ((rounded.as_dvec3() - 1.0) / unit).with_z(0.0);
        let is_below = (grid - hit).dot(normal) < 0.0;
        below += usize::from(is_below);
        drawing.line(place(hit), place(grid), Ink::Faint.pen(1.5));
        drawing.circle(place(hit), 8.0, Ink::Text.pen(2.0));
        drawing.dot(place(grid), 9.0, if is_below { Ink::Color(1) } else { Ink::Color(0) });
        if is_below && chosen.is_none() && x > 2.0 {
            chosen = Some((rounded, grid));
        }
    }
    let (point, grid) = chosen.context("no point is below its surface")?;
    // The error of rounding is at most half of the distance of two floats, on each axis.
    let error = vec3(0.5 * f32::EPSILON, 0.5 * f32::EPSILON, 0.0);
    let geometric_normal = normal.as_vec3();
    let surface = Surface { point, error, geometric_normal, shading_normal: geometric_normal };
    let to_light = dvec3(0.45, 1.0, 0.0).normalize();
    let light = LightSample { direction: to_light.as_vec3(), distance: 1.0, radiance: Vec3::ONE };
    let ray = kit.shadow_ray(&[ShadowQuery { surface, light }])[0].context("there is no shadow ray")?;
    let start = ((ray.origin.as_dvec3() - 1.0) / unit).with_z(0.0);
    let half = dvec3(0.5, 0.5, 0.0);
    drawing.frame(place(grid - half), place(grid + half), Ink::Color(3).pen(3.0));
    let label = offset(place(grid + half.with_y(-0.5)), [8.0, 24.0]);
    drawing.text(label, Start, SMALL, Ink::Color(3), "error box");
    drawing.arrow(place(grid), place(start), Ink::Color(3).pen(3.0));
    drawing.arrow(place(start), place(start + 0.8 * to_light), Ink::Color(2).pen(4.0));
    drawing.dot(place(start), 9.0, Ink::Color(2));
    drawing.text(offset(place(start), [20.0, 8.0]), Start, SMALL, Ink::Color(2), "start of shadow_ray");
    drawing.text([500.0, 496.0], Start, SMALL, Ink::Text, "circles: exact; dots: rounded");
    let text = format!("{below} of {} points are below the surface", xs.len());
    drawing.text([500.0, 528.0], Start, SMALL, Ink::Color(1), &text);
    drawing.text([60.0, 604.0], Start, SMALL, Ink::Text, "the grid: all points whose coordinates are floats");
    Ok(drawing.svg())
}

/// Two triangles whose shared edge each of them rounds to its own side.
pub fn edge_gap(_kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("A ray between two triangles that share an edge", 1000.0, 460.0);
    let [top, bottom] = [[520.0, 40.0], [470.0, 420.0]];
    // How far the computed edge of each triangle lies inside of it, exaggerated.
    let gap = 26.0;
    for (side, far, ink, name) in [
        (-1.0, [90.0, 250.0], Ink::Color(0), "first triangle"),
        (1.0, [910.0, 200.0], Ink::Color(3), "second triangle"),
    ] {
        let computed = [offset(top, [side * gap, 6.0]), offset(bottom, [side * gap, -6.0])];
        drawing.area(&[far, computed[0], computed[1]], ink, 0.22);
        drawing.polyline(&[top, far, bottom], ink.pen(3.0));
        drawing.line(computed[0], computed[1], ink.pen(3.0).dashed());
        let middle = 495.0 + side * 190.0;
        drawing.text([middle, 190.0], Middle, SMALL, ink, name);
        drawing.text([middle, 240.0], Middle, TEXT, ink, "hit? no");
    }
    drawing.line(top, bottom, Ink::Text.pen(4.0));
    drawing.dot([497.0, 214.0], 11.0, Ink::Color(1));
    drawing.text([610.0, 46.0], Start, SMALL, Ink::Color(1), "the ray, seen end-on");
    drawing.line([602.0, 46.0], [504.0, 201.0], Ink::Color(1).pen(1.5));
    drawing.text([250.0, 430.0], Middle, SMALL, Ink::Text, "solid: the shared edge");
    drawing.text([740.0, 430.0], Middle, SMALL, Ink::Text, "dashed: as each computes it");
    Ok(drawing.svg())
}

/// The error box of a point, and how far its farthest corner lies along the normal.
pub fn offset_bound(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The offset that the error box needs", 1000.0, 620.0);
    let view = View { origin: [390.0, 400.0], scale: 150.0 };
    let unit = f32::EPSILON;
    let error = vec3(1.5, 0.9, 0.0);
    let normal = at_angle(62.0);
    let at = |v: Vec3| view.at(f64::from(v.x), f64::from(v.y));
    // Ask for the offset of a point near 1 whose error is some hundred roundings, so that those of the answer are small.
    let scale = 512.0 * unit;
    let query = OffsetQuery { point: Vec3::ONE, error: scale * error, normal, direction: normal };
    let origin = kit.offset_origin(&[query])[0];
    let moved = ((origin.as_dvec3() - 1.0) / f64::from(scale)).with_z(0.0).as_vec3();
    let height = error.x * normal.x.abs() + error.y * normal.y.abs();
    ensure!(moved.dot(normal) >= 0.99 * height, "`offset_origin` stays below the corner of the box");
    let along = vec3(-normal.y, normal.x, 0.0);
    // The true surface passes somewhere through the box.
    let inside = -0.45 * normal;
    drawing.line(at(inside - 1.9 * along), at(inside + 2.3 * along), Ink::Text.pen(4.0));
    drawing.text(offset(at(inside - 1.9 * along), [-190.0, -6.0]), End, LARGE, Ink::Text, "the true surface");
    drawing.rectangle(at(-error), at(error), Ink::Color(3), 0.14);
    drawing.frame(at(-error), at(error), Ink::Color(3).pen(3.0));
    drawing.text(offset(at(vec3(0.6, -error.y, 0.0)), [0.0, 42.0]), Middle, LARGE, Ink::Color(3), "2 eₓ");
    drawing.text(offset(at(vec3(-error.x, 0.0, 0.0)), [-14.0, 8.0]), End, LARGE, Ink::Color(3), "2 e_y");
    // The line perpendicular to the normal through the farthest corner.
    let corner = error;
    drawing.line(at(corner - 1.0 * along), at(corner + 2.9 * along), Ink::Faint.pen(3.0).dashed());
    drawing.dot(at(corner), 8.0, Ink::Color(3));
    drawing.arrow(at(Vec3::ZERO), at(height * normal), Ink::Color(1).pen(5.0));
    drawing.dot(at(Vec3::ZERO), 10.0, Ink::Text);
    drawing.text(offset(at(Vec3::ZERO), [18.0, 40.0]), Start, LARGE, Ink::Text, "the computed point");
    drawing.dot(at(moved), 10.0, Ink::Color(2));
    drawing.text(offset(at(moved), [-20.0, -8.0]), End, LARGE, Ink::Color(2), "offset_origin");
    drawing.text([620.0, 60.0], Start, LARGE, Ink::Color(1), "height =");
    drawing.text([620.0, 106.0], Start, LARGE, Ink::Color(1), "eₓ |nₓ| + e_y |n_y|");
    let text = format!("offset_origin: {:.2} ×", moved.dot(normal) / height);
    drawing.text([560.0, 160.0], Start, LARGE, Ink::Color(2), &text);
    drawing.text(offset(at(0.6 * height * normal), [16.0, 22.0]), Start, LARGE, Ink::Color(1), "n");
    Ok(drawing.svg())
}
