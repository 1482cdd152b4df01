//! Diagrams of normals, of the Phong model, and of tone curves.

use anyhow::Result;
use glam::{Vec3, vec3};
use raykata::film::ToneCurve;
use raykata::kit::{Kit, TermQuery};
use raykata_cli::svg::{
    Axis, Drawing, End, Ink, Middle, Plot, Point, SMALL, Start, TEXT, offset, plane, polar, steps,
};

/// The unit vector that leans by `degrees` from the vertical to the right.
fn leaning(degrees: f32) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    vec3(sin, cos, 0.0)
}

fn draw_surface(drawing: &mut Drawing, y: f64, [left, right]: [f64; 2]) {
    drawing.rectangle([left, y], [right, y + 36.0], Ink::Faint, 0.3);
    drawing.line([left, y], [right, y], Ink::Text.pen(3.0));
}

/// A surface that is seen from its front and from its back.
pub fn face_forward(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The normal, turned to the side of the ray", 1000.0, 500.0);
    for (x, direction, name) in
        [(250.0, vec3(0.6, -0.8, 0.0), "from above"), (750.0, vec3(0.6, 0.8, 0.0), "from below")]
    {
        let center = [x, 240.0];
        let (_, at) = plane(center, 170.0);
        drawing.line([x - 210.0, 240.0], [x + 210.0, 240.0], Ink::Text.pen(5.0));
        let forward = kit.face_forward(&[(Vec3::Y, direction)])[0];
        drawing.arrow(center, at(Vec3::Y), Ink::Faint.pen(3.0));
        drawing.text(offset(at(Vec3::Y), [12.0, 16.0]), Start, TEXT, Ink::Text, "n");
        drawing.arrow(at(-1.15 * direction), center, Ink::Color(0).pen(4.0));
        drawing.text(offset(at(-1.15 * direction), [-10.0, 6.0]), End, TEXT, Ink::Color(0), "d");
        drawing.arrow(center, at(0.85 * forward), Ink::Color(1).pen(6.0));
        let result = if forward.y > 0.0 { "n" } else { "-n" };
        drawing.text([x, 450.0], Middle, TEXT, Ink::Color(1), &format!("face_forward returns {result}"));
        let dot = Vec3::Y.dot(direction);
        let sign = if dot < 0.0 { "<" } else { ">" };
        let text = format!("{name}: n·d = {dot:.1} {sign} 0");
        drawing.text([x, 484.0], Middle, SMALL, Ink::Text, &text);
    }
    Ok(drawing.svg())
}

/// The vectors of the Phong model at a surface.
pub fn phong_vectors(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The vectors of the Phong model", 1000.0, 520.0);
    let center = [440.0, 450.0];
    let (_, at) = plane(center, 380.0);
    draw_surface(&mut drawing, 450.0, [80.0, 920.0]);
    let light = leaning(-40.0);
    let reflected = kit.reflect(&[(-light, Vec3::Y)])[0];
    let viewer = leaning(55.0);
    let arrows = [
        (Vec3::Y, "n, the normal", Ink::Text, Middle, [0.0, -14.0]),
        (light, "l, to the light", Ink::Color(3), Middle, [0.0, -14.0]),
        (reflected, "r, reflected", Ink::Color(1), Start, [10.0, -6.0]),
        (viewer, "v, to the viewer", Ink::Color(0), Start, [10.0, -4.0]),
    ];
    for (vector, name, ink, anchor, by) in arrows {
        drawing.arrow(center, at(vector), ink.pen(4.0));
        drawing.text(offset(at(vector), by), anchor, TEXT, ink, name);
    }
    let degrees = |v: Vec3| f64::from(v.y.atan2(v.x)).to_degrees();
    let (turn_l, turn_r, turn_v) = (degrees(light), degrees(reflected), degrees(viewer));
    let angles = [
        ([turn_l, 90.0], 130.0, "θ", Ink::Color(3)),
        ([90.0, turn_r], 130.0, "θ", Ink::Color(1)),
        ([turn_r, turn_v], 210.0, "φ", Ink::Color(0)),
    ];
    for ([from, to], radius, name, ink) in angles {
        drawing.arc(center, radius, [from, to], ink.pen(2.0));
        let label = offset(polar(center, radius + 24.0, (from + to) / 2.0), [0.0, 9.0]);
        drawing.text(label, Middle, TEXT, ink, name);
    }
    let text = format!("θ = {:.0}°, φ = {:.0}°", turn_l - 90.0, turn_r - turn_v);
    drawing.text([100.0, 430.0], Start, SMALL, Ink::Text, &text);
    Ok(drawing.svg())
}

/// A beam of light of width 1 that meets a surface at right angles and at 60 degrees.
pub fn lambert(kit: &dyn Kit) -> Result<String> {
    let mut drawing =
        Drawing::new("The light of a beam is spread over a longer part of a surface", 1000.0, 520.0);
    for (x, degrees) in [(230.0, 0.0f32), (710.0, 60.0)] {
        let to_light = leaning(-degrees);
        let query = TermQuery { normal: Vec3::Y, to_light, to_viewer: Vec3::Y, exponent: 1.0 };
        let diffuse = kit.diffuse_term(&[query])[0];
        let (view, at) = plane([x, 400.0], 150.0);
        draw_surface(&mut drawing, 400.0, [x - 215.0, x + 230.0]);
        // The beam has width 1, so it lights 1 / cos θ of the surface.
        let half = 0.5 / to_light.dot(Vec3::Y);
        let ends = [vec3(-half, 0.0, 0.0), vec3(half, 0.0, 0.0)];
        // Cut the beam off at right angles.
        let across = vec3(to_light.y, -to_light.x, 0.0) / 2.0;
        let far = [2.0 * to_light - across, 2.0 * to_light + across];
        drawing.area(&[at(far[0]), at(far[1]), at(ends[1]), at(ends[0])], Ink::Color(3), 0.22);
        for (far, end) in far.into_iter().zip(ends) {
            drawing.arrow(at(far), at(end), Ink::Color(3).pen(3.0));
        }
        drawing.line(at(far[0]), at(far[1]), Ink::Text.pen(2.0));
        let label: Point = offset(at(2.0 * to_light), [0.0, -14.0]);
        let (anchor, label) =
            if degrees > 0.0 { (End, offset(label, [-16.0, 0.0])) } else { (Middle, label) };
        drawing.text(label, anchor, SMALL, Ink::Text, "1 wide");
        drawing.line(at(ends[0]), at(ends[1]), Ink::Color(1).pen(9.0));
        let text = format!("lit length {:.0}", 2.0 * half);
        drawing.text(view.at(0.0, -0.42), Middle, TEXT, Ink::Color(1), &text);
        let text = format!("θ = {degrees}°, diffuse_term = {diffuse:.1}");
        drawing.text(view.at(0.1, -0.68), Middle, SMALL, Ink::Text, &text);
    }
    Ok(drawing.svg())
}

/// The specular term against the angle between the reflected light and the viewer.
pub fn phong_exponents(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The specular term for four exponents", 1000.0, 620.0);
    let plot = Plot::new(Axis::linear(0.0, 90.0), Axis::linear(0.0, 1.0), [80.0, 530.0], [600.0, 460.0]);
    let x = [(0.0, "0°"), (30.0, "30°"), (60.0, "60°"), (90.0, "90°")];
    let y = [(0.0, "0"), (0.5, "0.5"), (1.0, "1")];
    plot.draw_axes(&mut drawing, &x, &y, ["angle φ between r and v", "specular_term"]);
    let exponents =
        [(1.0, Ink::Color(4)), (10.0, Ink::Color(2)), (100.0, Ink::Color(1)), (1000.0, Ink::Color(0))];
    for (row, (exponent, ink)) in exponents.into_iter().enumerate() {
        let angles: Vec<f64> = steps(0.0, 90.0, 900).collect();
        let query = |&degrees: &f64| TermQuery {
            normal: Vec3::Y,
            to_light: Vec3::Y,
            to_viewer: leaning(degrees as f32),
            exponent,
        };
        let terms = kit.specular_term(&angles.iter().map(query).collect::<Vec<_>>());
        let values: Vec<[f64; 2]> =
            angles.iter().zip(terms).map(|(&degrees, term)| [degrees, f64::from(term)]).collect();
        plot.draw_curve(&mut drawing, values.iter().copied(), ink.pen(4.0));
        // Mark the angle at which half of the light is left, between the two steps around it.
        let after = values.iter().position(|[_, term]| *term < 0.5).unwrap_or(1);
        let ([x0, y0], [x1, y1]) = (values[after - 1], values[after]);
        let half = x0 + (x1 - x0) * (y0 - 0.5) / (y0 - y1);
        drawing.dot(plot.at(half, 0.5), 8.0, ink);
        let y = 130.0 + 90.0 * row as f64;
        drawing.text([705.0, y], Start, TEXT, ink, &format!("exponent {exponent}"));
        drawing.text([705.0, y + 32.0], Start, SMALL, ink, &format!("half height at {half:.1}°"));
    }
    Ok(drawing.svg())
}

/// The three tone curves.
pub fn tone_curves(_kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("Three tone curves", 1000.0, 600.0);
    let plot = Plot::new(Axis::linear(0.0, 4.0), Axis::linear(0.0, 1.1), [80.0, 510.0], [640.0, 440.0]);
    let x = [(0.0, "0"), (1.0, "1"), (2.0, "2"), (3.0, "3"), (4.0, "4")];
    plot.draw_axes(&mut drawing, &x, &[(0.0, "0"), (0.5, "0.5"), (1.0, "1")], ["linear light x", "shown"]);
    plot.draw_mark(&mut drawing, 1.0, Ink::Text.pen(2.0).dashed());
    let inks = [Ink::Color(0), Ink::Color(1), Ink::Color(2)];
    for ((name, curve), ink) in ToneCurve::ALL.into_iter().zip(inks) {
        let value = |x: f64| f64::from(curve.apply(x as f32));
        plot.draw_curve(&mut drawing, steps(0.0, 4.0, 200).map(|x| [x, value(x)]), ink.pen(4.0));
        drawing.dot(plot.at(1.0, value(1.0)), 8.0, ink);
        // Clamp and ACES end close to each other.
        let by = match curve {
            ToneCurve::Clamp => -22.0,
            ToneCurve::Aces => 26.0,
            ToneCurve::Reinhard => 8.0,
        };
        let text = format!("{name}: {:.2} at 1", value(1.0));
        drawing.text(offset(plot.at(4.0, value(4.0)), [14.0, by]), Start, SMALL, ink, &text);
    }
    Ok(drawing.svg())
}
