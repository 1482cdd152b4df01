//! Refraction.

use crate::Touch;
use crate::svg::{Drawing, End, Ink, Middle, Point, SMALL, Start, offset, plane};
use anyhow::Result;
use glam::{Vec3, vec3};
use raykata::kit::{Kit, RefractQuery};

const GLASS: f32 = 1.5;

/// The starts of both rays, at distance 1 from the points where they meet the surface: 50 and 30 degrees.
pub const START: [f64; 4] = [-0.766_044_443_118_978, 0.642_787_609_686_539, -0.5, -0.866_025_403_784_439];

/// A ray from air into glass and one from glass into air, with their angles and their parts along the surface.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let mut drawing = Drawing::new("Refraction from air into glass and from glass into air", 1000.0, 560.0);
    panel(kit, touch, &mut drawing, [250.0, 280.0], true);
    panel(kit, touch, &mut drawing, [750.0, 280.0], false);
    Ok(drawing.svg())
}

/// A ray that meets the surface of glass around `center` at an angle, from above or from below.
fn panel(kit: &dyn Kit, touch: &mut Touch, drawing: &mut Drawing, center: Point, from_above: bool) {
    let (view, at) = plane(center, 190.0);
    let up = if from_above { 1.0 } else { -1.0 };
    let (low, high, name) = match from_above {
        true => ([-9.0, 0.02], [9.0, 9.0], "ray in air"),
        false => ([-9.0, -9.0], [9.0, -0.02], "ray in glass"),
    };
    let start = touch.point(view, name, low, high).normalize();
    touch.place_last(start);
    let (direction, normal) = (-start, vec3(0.0, up, 0.0));
    let (n1, n2) = if from_above { (1.0, GLASS) } else { (GLASS, 1.0) };
    let refracted = kit.refract(&[RefractQuery { direction, normal, n1, n2 }])[0];
    touch.value(&format!("{name}: sin θ1"), direction.x.abs());
    touch.value("sin θ2", refracted.map_or("none".to_owned(), |way| way.x.abs().to_string()));

    // Shade the glass, and draw surface and normal.
    drawing.step();
    drawing.rectangle(view.at(-1.22, 0.0), view.at(1.22, -1.35), Ink::Color(4), 0.14);
    drawing.line(view.at(-1.22, 0.0), view.at(1.22, 0.0), Ink::Text.pen(3.0));
    drawing.line(view.at(0.0, 1.35), view.at(0.0, -1.35), Ink::Faint.pen(2.0).dashed());
    drawing.text(view.at(1.2, 0.06), End, SMALL, Ink::Text, "air, n = 1");
    drawing.text(view.at(-1.2, -0.15), Start, SMALL, Ink::Text, "glass, n = 1.5");

    // Draw both rays with their angles, and their parts along the surface.
    let outgoing = match refracted {
        Some(refracted) => ("2", refracted, refracted, Ink::Color(1)),
        None => {
            drawing.text(at(1.2 * up * Vec3::Y), Middle, SMALL, Ink::Color(1), "total reflection");
            let reflected = kit.reflect(&[(direction, normal)])[0];
            ("1", reflected, reflected, Ink::Color(1))
        }
    };
    for (name, way, end, ink) in [("1", direction, -direction, Ink::Color(0)), outgoing] {
        // The angle is written on the free side of the normal.
        if end != -direction {
            drawing.step();
        }
        let ends = if end == -direction { [at(end), at(Vec3::ZERO)] } else { [at(Vec3::ZERO), at(end)] };
        drawing.arrow(ends[0], ends[1], ink.pen(4.0));
        let vertical: f64 = if end.y > 0.0 { 90.0 } else { 270.0 };
        let angle = f64::from(way.x.abs().atan2(way.y.abs()).to_degrees());
        let turn = if (end.x > 0.0) == (end.y > 0.0) { -angle } else { angle };
        drawing.arc(center, 75.0, [vertical, vertical + turn], ink.pen(2.0));
        let (anchor, x) = if end.x > 0.0 { (End, -10.0) } else { (Start, 10.0) };
        let y = if end.y > 0.0 { -62.0 } else { 78.0 };
        drawing.text(offset(center, [x, y]), anchor, SMALL, ink, &format!("θ{name} = {angle:.1}°"));
        // The part along the surface is the sine of the angle.
        drawing.step();
        let foot = vec3(0.0, end.y, 0.0);
        drawing.line(at(foot), at(end), Ink::Color(2).pen(5.0));
        let below = if end.y > 0.0 { -12.0 } else { 28.0 };
        let middle = offset(at((foot + end) / 2.0), [0.0, below]);
        let (anchor, middle) = if end.x > 0.0 {
            (Start, [at(foot)[0] + 8.0, middle[1]])
        } else {
            (End, [at(foot)[0] - 8.0, middle[1]])
        };
        drawing.text(middle, anchor, SMALL, Ink::Color(2), &format!("sin θ{name} = {:.2}", way.x.abs()));
    }
}
