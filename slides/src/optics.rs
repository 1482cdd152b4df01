//! Diagrams of reflection and refraction.

use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use raykata::kit::{FresnelQuery, Kit, RefractQuery};
use raykata_cli::svg::{Axis, Drawing, End, Ink, Middle, Plot, SMALL, Start, TEXT, offset, plane, steps};

const GLASS: f32 = 1.5;

/// The angle of the refracted ray for an angle in degrees; `None` at total internal reflection.
fn refracted_angle(kit: &dyn Kit, degrees: f64, n1: f32, n2: f32) -> Option<f64> {
    let (sin, cos) = (degrees.to_radians() as f32).sin_cos();
    let query = RefractQuery { direction: vec3(sin, -cos, 0.0), normal: Vec3::Y, n1, n2 };
    kit.refract(&[query])[0].map(|way| f64::from(way.x.atan2(-way.y)).to_degrees())
}

const DEGREES: [(f64, &str); 4] = [(0.0, "0°"), (30.0, "30°"), (60.0, "60°"), (90.0, "90°")];

/// The angle of the refracted ray against that of the ray.
pub fn critical_angle(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The angle of refraction, and the critical angle", 1000.0, 620.0);
    let plot = Plot::new(Axis::linear(0.0, 90.0), Axis::linear(0.0, 90.0), [90.0, 530.0], [640.0, 460.0]);
    plot.draw_axes(&mut drawing, &DEGREES, &DEGREES, ["θ1", "θ2"]);
    let media = [
        (1.5, 1.0, "1.5 to 1", Ink::Color(1)),
        (1.33, 1.0, "1.33 to 1", Ink::Color(4)),
        (1.0, 1.5, "1 to 1.5", Ink::Color(2)),
    ];
    for (row, (n1, n2, name, ink)) in media.into_iter().enumerate() {
        // Take steps of a hundredth of a degree, so that the last one before `None` is the critical angle.
        let values: Vec<[f64; 2]> = steps(0.0, 90.0, 9000)
            .map_while(|degrees| Some([degrees, refracted_angle(kit, degrees, n1, n2)?]))
            .collect();
        let last = *values.last().context("no angle has a refracted ray")?;
        // One point per half a degree is enough for a curve, and the steep end needs all.
        let thinned = values.iter().enumerate();
        let thinned =
            thinned.filter(|(i, value)| i % 50 == 0 || (last[1] > 80.0 && value[1] > 75.0 && i % 5 == 0));
        plot.draw_curve(&mut drawing, thinned.map(|(_, value)| *value).chain([last]), ink.pen(4.0));
        let y = 100.0 + 90.0 * row as f64;
        if values.len() < 9000 {
            plot.draw_mark(&mut drawing, last[0], ink.pen(2.0).dashed());
            drawing.text([760.0, y], Start, TEXT, ink, name);
            let text = format!("None from {:.1}°", last[0]);
            drawing.text([760.0, y + 32.0], Start, SMALL, ink, &text);
        } else {
            let [x, y] = plot.at(last[0], last[1]);
            drawing.text([x + 30.0, y - 4.0], Start, TEXT, ink, name);
            let text = format!("at most {:.1}°", last[1]);
            drawing.text([x + 30.0, y + 28.0], Start, SMALL, ink, &text);
        }
    }
    Ok(drawing.svg())
}

/// Reflectance against the angle, exact and by Schlick's approximation.
pub fn fresnel(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("Fresnel reflectance against the angle", 1000.0, 620.0);
    let plot = Plot::new(Axis::linear(0.0, 90.0), Axis::linear(0.0, 1.0), [90.0, 530.0], [640.0, 460.0]);
    let y = [(0.0, "0"), (0.5, "0.5"), (1.0, "1")];
    plot.draw_axes(&mut drawing, &DEGREES, &y, ["θ1", "reflectance"]);
    let media = [(1.0, GLASS, "air to glass", Ink::Color(0)), (GLASS, 1.0, "glass to air", Ink::Color(1))];
    for (row, (n1, n2, name, ink)) in media.into_iter().enumerate() {
        let query = |degrees: f64| FresnelQuery { cos_theta: degrees.to_radians().cos() as f32, n1, n2 };
        let angles: Vec<f64> = steps(0.0, 90.0, 900).collect();
        let queries: Vec<_> = angles.iter().map(|&degrees| query(degrees)).collect();
        for (values, pen) in [
            (kit.fresnel_exact(&queries), ink.pen(4.0)),
            (kit.fresnel_schlick(&queries), ink.pen(3.0).dashed()),
        ] {
            let values = angles.iter().zip(values).map(|(&degrees, value)| [degrees, f64::from(value)]);
            plot.draw_curve(&mut drawing, values, pen);
        }
        let at_zero = kit.fresnel_exact(&[query(0.0)])[0];
        let y = 160.0 + 170.0 * row as f64;
        drawing.text([760.0, y], Start, TEXT, ink, name);
        drawing.line([760.0, y + 26.0], [810.0, y + 26.0], ink.pen(4.0));
        drawing.text([820.0, y + 33.0], Start, SMALL, ink, "exact");
        drawing.line([760.0, y + 58.0], [810.0, y + 58.0], ink.pen(3.0).dashed());
        drawing.text([820.0, y + 65.0], Start, SMALL, ink, "Schlick");
        drawing.text([760.0, y + 97.0], Start, SMALL, ink, &format!("{at_zero:.2} at 0°"));
    }
    // Mark the critical angle: the first at which everything is reflected.
    let all = |degrees: &f64| {
        let cos_theta = degrees.to_radians().cos() as f32;
        kit.fresnel_exact(&[FresnelQuery { cos_theta, n1: GLASS, n2: 1.0 }])[0] == 1.0
    };
    let critical = steps(0.0, 90.0, 900).find(all).context("no angle with total internal reflection")?;
    plot.draw_mark(&mut drawing, critical, Ink::Faint.pen(2.0).dashed());
    drawing.text(offset(plot.at(critical, 0.5), [-10.0, 0.0]), End, SMALL, Ink::Text, "critical angle");
    Ok(drawing.svg())
}

/// A ray and its reflection, both divided into a part along the normal and a part along the surface.
pub fn reflection(kit: &dyn Kit) -> Result<String> {
    let (sin, cos) = 50f32.to_radians().sin_cos();
    let direction = vec3(sin, -cos, 0.0);
    let reflected = kit.reflect(&[(direction, Vec3::Y)])[0];
    let mut drawing = Drawing::new("A ray and its reflection", 1000.0, 560.0);
    let center = [500.0, 430.0];
    let (view, at) = plane(center, 390.0);
    drawing.rectangle([60.0, 430.0], [940.0, 470.0], Ink::Faint, 0.25);
    drawing.line([60.0, 430.0], [940.0, 430.0], Ink::Text.pen(3.0));
    drawing.arrow(center, view.at(0.0, 0.95), Ink::Text.pen(3.0));
    drawing.text(offset(view.at(0.0, 0.95), [12.0, 16.0]), Start, TEXT, Ink::Text, "n");
    let (before, after, part) = (Ink::Color(0), Ink::Color(1), Ink::Color(2));
    // Draw the parts of both, then the rays over them.
    for (end, ink) in [(-direction, before), (reflected, after)] {
        let foot = vec3(end.x, 0.0, 0.0);
        drawing.line(at(end), at(foot), ink.pen(2.0).dashed());
        drawing.line(at(foot), center, ink.pen(5.0));
    }
    drawing.arrow(at(-direction), center, before.pen(4.0));
    drawing.arrow(center, at(reflected), after.pen(4.0));
    drawing.text(offset(at(-direction), [-12.0, 0.0]), End, TEXT, before, "d");
    drawing.text(offset(at(reflected), [12.0, 0.0]), Start, TEXT, after, "d'");
    for (degrees, ink) in [([90.0, 140.0], before), ([40.0, 90.0], after)] {
        drawing.arc(center, 90.0, degrees, ink.pen(2.0));
    }
    let angle = f64::from(reflected.x.atan2(reflected.y)).to_degrees();
    drawing.text(offset(center, [-46.0, -100.0]), Middle, SMALL, before, "50°");
    drawing.text(offset(center, [46.0, -100.0]), Middle, SMALL, after, &format!("{angle:.0}°"));
    // Move d to the foot of d', where the difference of both is along the normal.
    let below = vec3(reflected.x, direction.y + 0.0, 0.0);
    let length = (reflected - direction).length();
    let half = at(vec3(below.x, reflected.y / 2.0, 0.0));
    let along = format!("along n: {:.2}", length / 2.0);
    drawing.text(offset(half, [12.0, 0.0]), Start, SMALL, after, &along);
    let half = at(vec3(-direction.x, -direction.y / 2.0, 0.0));
    drawing.text(offset(half, [-12.0, 0.0]), End, SMALL, before, &format!("along n: {:.2}", direction.y));
    for (x, value, ink) in
        [(-direction.x / 2.0, direction.x, before), (reflected.x / 2.0, reflected.x, after)]
    {
        let label = offset(at(vec3(x, 0.0, 0.0)), [0.0, 30.0]);
        drawing.text(label, Middle, SMALL, ink, &format!("along it: {value:.2}"));
    }
    let text = format!("d' = reflect(d, n): d' - d = {length:.2} n = -2 n (d·n)");
    drawing.text([500.0, 530.0], Middle, TEXT, part, &text);
    Ok(drawing.svg())
}
