//! The weights of multiple importance sampling.

use crate::Touch;
use crate::svg::{Drawing, End, Ink, Middle, SMALL, Start, TEXT, offset, plane, steps};
use anyhow::Result;
use glam::{Vec3, vec3};
use raykata::emitter::{AreaEmitter, EmitterShape};
use raykata::kit::{EmitterPdfQuery, Kit};

/// A point under a light, and around it a ring of all directions of a plane: in each the weight of a sample of the light, and
/// the rest, which is the weight of a cosine-weighted direction.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let (view, at) = plane([500.0, 500.0], 170.0);
    let mut place = |name| touch.point(view, name, [-2.8, 0.05], [2.8, 2.8]);
    let [from, to, aim] = ["one end of the light", "the other end of the light", "direction"].map(&mut place);
    // The light is a parallelogram seen from its edge; its depth is 1.
    let shape = EmitterShape::Parallelogram { corner: from - 0.5 * Vec3::Z, edges: (Vec3::Z, to - from) };
    let emitter = AreaEmitter { shape, radiance: Vec3::ONE, two_sided: true };
    // Ask for both densities of a direction, and for both weights.
    let ask = |direction: Vec3| {
        let by_light = kit.light_pdf(&[EmitterPdfQuery { emitter, from: Vec3::ZERO, direction }])[0];
        let by_cosine = kit.cosine_pdf(&[(Vec3::Y, direction)])[0];
        let weights = kit.mis_weight(&[(by_light, by_cosine), (by_cosine, by_light)]);
        [by_light, by_cosine, weights[0], weights[1]]
    };

    // Draw the ring: the weight of the light from the inside, the other one outside of it.
    let mut drawing = Drawing::new("The weights of two densities, in each direction", 1000.0, 560.0);
    let (light, cosine) = (Ink::Color(3), Ink::Color(0));
    let on_circle = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        vec3(cos as f32, sin as f32, 0.0)
    };
    for degrees in steps(1.0, 179.0, 89) {
        let limit = 0.5 + 0.4 * ask(on_circle(degrees))[2];
        let sides = [degrees - 1.0, degrees + 1.0].map(on_circle);
        for ([inside, outside], ink) in [([0.5, limit], light), ([limit, 0.9], cosine)] {
            let corners = [inside * sides[0], outside * sides[0], outside * sides[1], inside * sides[1]];
            drawing.area(&corners.map(at), ink, 0.8);
        }
    }
    // Draw surface, light and direction.
    drawing.rectangle([60.0, 500.0], [940.0, 532.0], Ink::Faint, 0.3);
    drawing.line([60.0, 500.0], [940.0, 500.0], Ink::Text.pen(3.0));
    drawing.line(at(from), at(to), light.pen(9.0));
    drawing.text(offset(at(from), [0.0, -24.0]), Middle, TEXT, light, "light");
    let direction = aim.normalize();
    drawing.arrow(view.origin, at(aim), Ink::Text.pen(3.0));
    let [by_light, by_cosine, of_light, of_cosine] = ask(direction);
    for (anchor, x, ink, name, pdf, weight) in [
        (Start, 20.0, cosine, "cosine", by_cosine, of_cosine),
        (End, 980.0, light, "light", by_light, of_light),
    ] {
        drawing.text([x, 46.0], anchor, SMALL, ink, &format!("{name}: pdf {pdf:.3}, weight {weight:.3}"));
        touch.value(&format!("{name}_pdf"), pdf);
        touch.value(&format!("weight of a {name} sample"), weight);
    }
    Ok(drawing.svg())
}
