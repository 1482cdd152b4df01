//! Checks of `sample_light`.

use crate::directions::{LARGEST, numbers};
use crate::emitters::{Lit, layouts};
use checks::prelude::*;
use checks::statistics::{SAMPLES, pairs};
use raykata::emitter::{EmitterSample, EmitterShape};

impl Lit {
    pub(super) fn sample(&self, u: Vec2) -> EmitterQuery {
        EmitterQuery { emitter: self.emitter, from: self.from, u }
    }

    pub(super) fn pdf(&self, direction: DVec3) -> EmitterPdfQuery {
        EmitterPdfQuery { emitter: self.emitter, from: self.from, direction: direction.normalize().as_vec3() }
    }
}

pub(super) fn of(query: &EmitterQuery) -> Lit {
    Lit { emitter: query.emitter, from: query.from }
}

/// Every `u` gives a sample of an emitter that sends light, so a sample that is missing is a mistake.
pub(super) fn missing(query: &EmitterQuery) -> Broken {
    let behind = query.emitter.two_sided && of(query).is_behind();
    let (yours, source) = (None::<EmitterSample>, "the emitter sends light here");
    Broken::new(query.call("sample_light"), yours, "a sample", source)
        .explained_by([(behind, "you leave out the back of emitters that are two-sided")])
}

/// Emitters whose front is seen, and two-sided ones that are seen from the back or from inside.
pub(super) fn bright() -> impl Strategy<Value = Lit> + Clone {
    (layouts(), any::<bool>()).prop_map(|(layout, behind)| {
        let mut layout = layout;
        if behind && layout.two_sided {
            // -0.75: inside the sphere, a quarter of its radius from the centre.
            layout.place.z = if layout.kind == 2 { -0.75 } else { -layout.place.z };
        }
        layout.lit()
    })
}

pub(super) fn light_samples_lie_on_the_light(trial: &Trial<'_>) -> CheckResult {
    let queries = (bright(), numbers()).prop_map(|(lit, u)| lit.sample(u));
    trial.each(1000, queries, <dyn Kit>::sample_light, |query, yours| {
        let Some(yours) = yours else { return Err(missing(query)) };
        judge_sample(query, &yours)
    })
}

pub(super) fn judge_sample(query: &EmitterQuery, yours: &EmitterSample) -> CheckResult {
    let (lit, direction) = (of(query), yours.direction.as_dvec3());
    let distance = f64::from(yours.distance);
    let unit = (direction.length() - 1.0).abs() < 1e-5;
    let off = lit.off(direction, distance);
    // The direction is rounded, which moves the point along an emitter that is seen at a grazing angle: by up to 1e-7 of the
    // distance over the cosine, which is at least a twentieth. The point itself is rounded at its distance from the origin.
    let slack = 1e-3;
    // For the same reason the distance is off by up to 1e-5 of the numbers. Near the rim of a sphere it is less exact by the
    // root of a rounding error, but the point is no farther off the surface.
    let on_it = off <= 2e-4 && lit.outside(direction) <= slack;
    let same_radiance = yours.radiance == query.emitter.radiance;
    let density = yours.pdf.is_finite() && yours.pdf > 0.0;
    if unit && on_it && same_radiance && density {
        return Ok(());
    }
    let expected = match (unit && on_it, same_radiance) {
        (false, _) => "a unit direction and the distance to a point of the emitter".to_owned(),
        (true, false) => format!("radiance: {:?}", query.emitter.radiance),
        (true, true) => "a density above 0".to_owned(),
    };
    let sphere = query.emitter.shape;
    let is_sphere = matches!(sphere, EmitterShape::Sphere(_));
    let far = is_sphere
        && unit
        && lit.outside(direction) <= 0.0
        && (lit.far_side(direction) - distance).abs() <= 2e-4 * distance;
    let squared = {
        let root = distance.max(0.0).sqrt();
        unit && lit.off(direction, root) <= 2e-4
    };
    let radiance = yours.radiance.as_dvec3() / query.emitter.radiance.as_dvec3();
    let is_even = (radiance - radiance.x).abs().max_element() <= 1e-5 * radiance.x;
    let over_distance = is_even && (radiance.x * distance * distance - 1.0).abs() < 1e-3;
    let normal = match query.emitter.shape {
        EmitterShape::Triangle(Triangle { a, b, c }) => (b - a).as_dvec3().cross((c - a).as_dvec3()),
        EmitterShape::Parallelogram { edges, .. } => edges.0.as_dvec3().cross(edges.1.as_dvec3()),
        EmitterShape::Sphere(Sphere { center, .. }) => {
            query.from.as_dvec3() + distance * direction - center.as_dvec3()
        }
    };
    let by_cosine = is_even && (radiance.x.abs() - normal.normalize().dot(direction).abs()).abs() < 1e-3;
    let by_pdf = is_even && (radiance.x * f64::from(yours.pdf) - 1.0).abs() < 1e-3;
    let broken =
        Broken::with_texts(query.call("sample_light"), format!("{yours:?}"), expected, "the definition");
    Err(broken.explained_by(named![
        yours.direction.is_nan() || yours.distance.is_nan() || yours.pdf.is_nan() => "you return NaN",
        !unit && !yours.direction.is_nan() => "your direction does not have unit length",
        !on_it && far => "your point is on the far side of the sphere: the near one hides it",
        !on_it && squared => "your distance is squared",
        unit && distance < 0.0 => "your distance is negative: seen from inside, the farther root is the hit",
        !on_it && (far || unit && distance < 0.0) =>
            "you exchange the two roots of a sphere: the nearer one is the hit, or seen from inside the farther one",
        is_sphere && (distance / lit.toward_center().length() - 1.0).abs() < 1e-5 =>
            "your distance is that of the centre: return that of the first hit",
        unit && is_sphere && lit.outside(direction) > slack && lit.off(-direction, distance) > 2e-4 =>
            "your direction misses the sphere",
        unit && off <= 2e-4 && lit.outside(direction) > slack =>
            "your point is in the plane of the emitter, but outside of the emitter",
        !on_it && lit.off(-direction, distance) <= 2e-4 && unit => "your direction leads from the light to the point",
        on_it && !same_radiance && over_distance =>
            "you divide the radiance by the squared distance: that is already in the density",
        on_it && !same_radiance && by_pdf => "you divide the radiance by the density: the caller does that",
        on_it && !same_radiance && by_cosine =>
            "you multiply the radiance by the cosine at the light: it is in the density",
        on_it && !same_radiance => "you return another radiance than that of the emitter",
        on_it && same_radiance && !density => "your density is not above 0 and finite",
    ]))
}

/// Emitters that send no light to the point, and others.
fn dark() -> impl Strategy<Value = (Lit, bool)> + Clone {
    // A lattice in a plane at right angles to an axis: the point is exactly in the plane of the emitter.
    let in_plane = (0..3usize, nasty::lattice(4), nasty::lattice(4), 0..2usize, any::<bool>()).prop_map(
        |(axis, corner, from, kind, two_sided)| {
            let (x, y) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
            let mut from = from;
            from[axis] = corner[axis];
            let shape = match kind {
                0 => EmitterShape::Parallelogram { corner, edges: (2.0 * x, y) },
                _ => EmitterShape::Triangle(Triangle { a: corner, b: corner + x, c: corner + y }),
            };
            let emitter = raykata::emitter::AreaEmitter { shape, radiance: Vec3::ONE, two_sided };
            (Lit { emitter, from }, true)
        },
    );
    let turned = (layouts(), 0..4i32).prop_map(|(layout, which)| {
        let mut layout = layout;
        // A one-sided emitter from behind or from inside, and a black one.
        if which < 2 {
            layout.two_sided = which == 1 && layout.kind != 2;
            layout.place.z = if layout.kind == 2 { -0.5 } else { -layout.place.z };
        }
        let mut lit = layout.lit();
        if which == 2 {
            lit.emitter.radiance = Vec3::ZERO;
        }
        (lit, which == 2 || which == 0 || (which == 1 && layout.kind == 2))
    });
    prop_oneof![1 => in_plane, 4 => turned]
}

pub(super) fn dark_sides_send_no_light(trial: &Trial<'_>) -> CheckResult {
    trial.forall(500, (dark(), numbers()), |cases| {
        let queries: Vec<EmitterQuery> = cases.iter().map(|((lit, _), u)| lit.sample(*u)).collect();
        // The density of a direction to the middle of the emitter.
        let middle = |lit: &Lit| lit.pdf(lit.toward((0.45, 0.4)).try_normalize().unwrap_or(DVec3::Y));
        let pdfs: Vec<EmitterPdfQuery> = cases.iter().map(|((lit, _), _)| middle(lit)).collect();
        let densities = trial.kit.light_pdf(&pdfs);
        let answers = trial.kit.sample_light(&queries).into_iter().zip(densities).collect();
        compare(cases, answers, |((lit, is_dark), u), (yours, density): (Option<EmitterSample>, f32)| {
            let (radiance, source) = (lit.emitter.radiance, "the definition");
            let black = radiance == Vec3::ZERO;
            let inside = matches!(lit.emitter.shape, EmitterShape::Sphere(_));
            if yours.is_some() == *is_dark {
                let expected = if *is_dark { "None" } else { "a sample" };
                let input = lit.sample(*u).call("sample_light");
                let broken = Broken::with_texts(input, format!("{yours:?}"), expected, source);
                return Err(broken.explained_by(named![
                    *is_dark && black => "an emitter of radiance 0 sends no light: return None",
                    *is_dark && !black && !inside && !lit.is_behind() =>
                        "you sample an emitter for a point in its plane, from which it has no area: return None",
                    *is_dark && !black && inside => "from inside, a sphere that is not two-sided sends no light",
                    *is_dark && !black && !inside && !lit.emitter.two_sided =>
                        "you sample the back of an emitter that is not two-sided",
                    !black && !inside && !lit.emitter.two_sided && yours.is_some() == lit.is_behind() =>
                        "front and back are exchanged: the front is the side of first edge × second edge",
                    !*is_dark => "you leave out emitters that send light",
                ]));
            }
            // The direction of a point in the plane of the emitter says nothing.
            let is_right = if *is_dark { density == 0.0 } else { density > 0.0 };
            if is_right {
                return Ok(());
            }
            let expected = if *is_dark { "0.0" } else { "above 0" };
            Err(Broken::with_texts(middle(lit).call("light_pdf"), format!("{density:?}"), expected, source)
                .explained_by([
                    (*is_dark && black, "an emitter of radiance 0 is never sampled: its density is 0"),
                    "the back of an emitter that is not two-sided is never sampled: its density is 0"
                        .when(*is_dark && !black && !lit.emitter.two_sided && density > 0.0),
                    (density.is_nan(), "you return NaN"),
                ]))
        })
    })
}

/// Pairs of random numbers for a mean, with the four corners of the unit square.
pub(super) fn with_corners(seed: u64) -> Vec<Vec2> {
    let corners = [0.0, LARGEST].map(|x| [vec2(x, 0.0), vec2(x, LARGEST)]);
    corners.as_flattened().iter().copied().chain(pairs(seed, SAMPLES - 4)).collect()
}
