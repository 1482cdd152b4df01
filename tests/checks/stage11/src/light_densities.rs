//! Checks of `light_pdf`, and of the samples of emitters by their density.

use crate::emitters::{KINDS, Layout, Lit, NODES_PER_CELL, layouts, nodes};
use crate::lights::{bright, judge_sample, missing, of};
use checks::prelude::*;
use checks::statistics::{CELLS, bins, covers_each_part, is_other_power};
use raykata::emitter::{EmitterSample, EmitterShape};
use std::f64::consts::{PI, TAU};

/// An emitter of each kind, for statistical tests. The nearest and the farthest point of the emitter are at similar distances,
/// so that no cell is rare if directions are uniform over the solid angle.
pub(super) fn seen_well(trial: &Trial<'_>) -> [Lit; 3] {
    let public = Layout {
        kind: 0,
        axis: Vec3::Y,
        turn: 0.1,
        corner: Vec3::new(1.0, 2.0, -1.0),
        size: 1.0,
        lean: 0.25,
        // Not 1: at that height distance · cos θ is 1, and wrong densities agree.
        place: DVec3::new(0.25, 0.5, 1.1),
        two_sided: false,
    };
    let hidden = (layouts(), 0.0..1.0f64, 0.0..1.0f64, 0.75..1.5f64).prop_map(|(layout, x, y, height)| {
        Layout { place: DVec3::new(x, y, height), two_sided: false, ..layout }
    });
    let layout = trial.varied(public, hidden);
    [0, 1, 2].map(|kind| Layout { kind, ..layout }.lit())
}

/// The solid angle of each bin of the unit square times the student's density, by a product rule.
fn shares_of_bins(trial: &Trial<'_>, lit: &Lit) -> Vec<f64> {
    let nodes = nodes(bins());
    let queries: Vec<EmitterPdfQuery> = nodes.iter().map(|(place, _)| lit.pdf(lit.toward(*place))).collect();
    let density = |((place, weight), density): (&((f64, f64), f64), f32)| {
        weight * lit.solid_angle(*place) * f64::from(density)
    };
    let parts: Vec<f64> = nodes.iter().zip(trial.kit.light_pdf(&queries)).map(density).collect();
    parts.chunks(NODES_PER_CELL).map(|bin| bin.iter().sum()).collect()
}

pub(super) fn light_samples_have_their_density(trial: &Trial<'_>) -> CheckResult {
    let [first, second, sphere] = seen_well(trial);
    // A point inside of the sphere, from which it is two-sided.
    let mut inside = sphere;
    inside.emitter.two_sided = true;
    if let EmitterShape::Sphere(Sphere { center, .. }) = sphere.emitter.shape {
        inside.from = center.lerp(sphere.from, 0.25);
    }
    for (kind, lit) in [(0, first), (1, second), (2, sphere), (2, inside)] {
        let samples = |u: &[Vec2]| {
            let queries: Vec<EmitterQuery> = u.iter().map(|u| lit.sample(*u)).collect();
            let of = |(yours, query): (Option<EmitterSample>, _)| yours.ok_or_else(|| missing(query));
            trial.kit.sample_light(&queries).into_iter().zip(&queries).map(of).collect::<Result<Vec<_>, _>>()
        };
        let places = |u: &[Vec2]| {
            let place = |sample: &EmitterSample| lit.place(sample.direction.as_dvec3());
            Ok(samples(u)?.iter().map(place).collect::<Vec<_>>())
        };
        let from = if lit.is_behind() { " from inside" } else { "" };
        let what = format!("sample_light of {}{from}, against your light_pdf", KINDS[kind]);
        let axes = match kind {
            2 => ["1 - cos θ, as a fraction of the rim's", "the angle around the axis"],
            1 => ["the part of the area before the point", "the position across"],
            _ => ["the first edge", "the second edge"],
        };
        let shares = shares_of_bins(trial, &lit);
        covers_each_part(&what, axes, trial.seed, Some(&shares), places, |counts| {
            let u = checks::statistics::pairs(trial.seed, 1000);
            let places = places(&u).unwrap_or_default();
            let columns = checks::statistics::columns(counts);
            let rows: Vec<u64> = counts.chunks(CELLS as usize).map(|row| row.iter().sum()).collect();
            let is_place = |formula: fn(f64, f64) -> (f64, f64)| {
                u.iter().zip(&places).all(|(u, place)| {
                    let (s, t) = formula(f64::from(u.x), f64::from(u.y));
                    (place.0 - s).abs() < 1e-2 && (place.1 - t).abs() < 1e-2
                })
            };
            // Uniform barycentric coordinates on the wrong side of the diagonal, scaled back to the triangle.
            let without_root = kind == 1
                && [|u: f64, v: f64| (1.0 - (1.0 - u) * (1.0 - u), v), |u: f64, v: f64| (1.0 - u * u, v)]
                    .into_iter()
                    .any(is_place);
            // A coordinate of a triangle is no random number itself: few points are near a corner.
            let [s, t] = [
                |p: &(f64, f64)| 1.0 - (1.0 - p.0).max(0.0).sqrt(),
                |p: &(f64, f64)| p.1 * (1.0 - p.0).max(0.0).sqrt(),
            ];
            let coordinates = [s, t, |p: &(f64, f64)| (1.0 - p.1) * (1.0 - p.0).max(0.0).sqrt()];
            let powers = [
                |x: f64| x,
                |x: f64| 1.0 - x,
                |x: f64| x * x,
                |x: f64| 1.0 - x * x,
                |x: f64| (1.0 - x) * (1.0 - x),
            ];
            let is_number = |coordinate: fn(&(f64, f64)) -> f64, of: fn(f64) -> f64| {
                let same = |number: fn(&Vec2) -> f32| {
                    u.iter()
                        .zip(&places)
                        .all(|(u, place)| (coordinate(place) - of(f64::from(number(u)))).abs() < 1e-2)
                };
                same(|u| u.x) || same(|u| u.y)
            };
            let without_root = without_root
                || kind == 1
                    && coordinates
                        .iter()
                        .any(|&coordinate| powers.iter().any(|&of| is_number(coordinate, of)));
            let rim = lit.solid_angle((0.5, 0.5)) / TAU;
            let by_angle = |u: f64| (1.0 - (u * (1.0 - rim).acos()).cos()) / rim;
            let numbers = u.iter().zip(&places);
            let theta_uniform = kind == 2
                && numbers.clone().all(|(u, (share, _))| (share - by_angle(f64::from(u.x))).abs() < 1e-3);
            let [first, second] = [|place: &(f64, f64)| place.0, |place: &(f64, f64)| place.1]
                .map(|coordinate| places.iter().map(coordinate).collect::<Vec<_>>());
            let power = kind == 0 && (is_other_power(&u, &first, 1.0) || is_other_power(&u, &second, 1.0));
            let crowded = "your points crowd in a corner of the triangle: take the root of one number";
            vec![
                (without_root, crowded),
                (theta_uniform, "your θ is uniform: make 1 - cos θ uniform"),
                (power, "a coordinate is a power of a random number: use the number itself"),
                (columns.contains(&0) || rows.contains(&0), "your samples leave out a part of the light"),
            ]
        })?;
    }
    Ok(())
}

/// Judges that the density of each emitter integrates to 1.
fn integrates_to_one(trial: &Trial<'_>, lits: &[Lit]) -> Vec<CheckResult> {
    let side = f64::from(CELLS);
    let corner = |cell: u32| (f64::from(cell % CELLS) / side, f64::from(cell / CELLS) / side);
    let nodes = nodes((0..CELLS * CELLS).map(|cell| (corner(cell), (1.0 / side, 1.0 / side))));
    let queries: Vec<EmitterPdfQuery> =
        lits.iter().flat_map(|lit| nodes.iter().map(|(place, _)| lit.pdf(lit.toward(*place)))).collect();
    let densities = trial.kit.light_pdf(&queries);
    let judge = |(lit, densities): (&Lit, &[f32])| {
        let (mut integral, mut over_area) = (0.0, 0.0);
        let mut gaps = 0;
        for ((place, weight), density) in nodes.iter().zip(densities) {
            let density = f64::from(*density);
            let solid_angle = weight * lit.solid_angle(*place);
            integral += density * solid_angle;
            gaps += usize::from(density == 0.0);
            if let Some(area) = lit.area() {
                over_area += density * weight * area;
            }
        }
        // The product rule is exact to 1e-4 for densities as smooth as these; the rest is rounding.
        if (integral - 1.0).abs() <= 1e-3 {
            return Ok(());
        }
        let is_one = |x: f64| (x - 1.0).abs() <= 1e-3;
        let flat = lit.area().is_some();
        let first = lit.pdf(lit.toward((0.5, 0.5)));
        let input =
            format!("{}\nand {} other directions to the emitter", first.call("light_pdf"), nodes.len() - 1);
        let yours = format!("the integral over the directions is {integral:.5}");
        let (full, half) = (is_one(integral / 2.0), is_one(2.0 * integral));
        let all = gaps == nodes.len();
        Err(Broken::with_texts(input, yours, "1", "a density integrates to 1").explained_by([
            (integral.is_nan(), "you return NaN"),
            (all, "your density is 0 for every direction to the emitter"),
            (gaps > 0 && !all, "your density is 0 for some directions that meet the emitter"),
            (flat && is_one(over_area), "your density is per area: multiply it by distance² / cos θ"),
            "your density is that of all directions, 1 / 4π: divide by the solid angle of the emitter"
                .when(densities.iter().all(|density| (f64::from(*density) * 4.0 * PI - 1.0).abs() < 1e-4)),
            "your 1 - cos θ is rounded: compute it as sin² θ / (1 + cos θ)"
                .when(!flat && densities.iter().all(|density| lit.is_rounded(*density))),
            (full, "your density is twice too large"),
            (half, "your density is half of what it must be"),
        ]))
    };
    lits.iter().zip(densities.chunks(nodes.len())).map(judge).collect()
}

pub(super) fn light_pdf_integrates_to_one(trial: &Trial<'_>) -> CheckResult {
    // A flat emitter of a 64th of the size has a density some thousand times as large.
    let small = (bright(), any::<bool>()).prop_map(|(mut lit, small)| {
        match &mut lit.emitter.shape {
            EmitterShape::Parallelogram { edges, .. } if small => *edges = (edges.0 / 64.0, edges.1 / 64.0),
            EmitterShape::Triangle(Triangle { a, b, c }) if small => {
                (*b, *c) = (*a + (*b - *a) / 64.0, *a + (*c - *a) / 64.0);
            }
            _ => {}
        }
        lit
    });
    trial.forall(80, small, |lits| integrates_to_one(trial, lits))
}

pub(super) fn far_sphere_lights_keep_their_density(trial: &Trial<'_>) -> CheckResult {
    // A thousand radii away 1 - cos θ of the rim is 5e-7, a few units of the last digit of cos θ. The point is the origin, so
    // that no rounding of a difference adds to this.
    let lits = (nasty::unit(), 800..1200i32, nasty::scale(-4..=4)).prop_map(|(axis, radii, scale)| {
        let shape = EmitterShape::Sphere(Sphere { center: scale * radii as f32 * axis, radius: scale });
        let emitter = raykata::emitter::AreaEmitter { shape, radiance: Vec3::ONE, two_sided: false };
        Lit { emitter, from: Vec3::ZERO }
    });
    trial.forall(60, lits.clone(), |lits| integrates_to_one(trial, lits))?;
    trial.forall(200, (lits, 0..16i32, 0..16i32), |cases| {
        let u = |n: i32| (n as f32 + 0.5) / 16.0;
        let queries: Vec<EmitterQuery> =
            cases.iter().map(|(lit, a, b)| lit.sample(vec2(u(*a), u(*b)))).collect();
        compare(&queries, with_densities(trial, &queries), |query, (sample, density)| {
            let Some(sample) = sample else { return Err(missing(query)) };
            // Rounding moves the direction by up to 1e-4 of the cone's radius. Uniform points of the area have a density
            // that grows towards the rim, by a tenth over this distance at the outermost of these samples.
            if (0.5..2.0).contains(&(sample.pdf / density)) {
                return Ok(());
            }
            Err(Broken::new(query.call("sample_light"), sample.pdf, density, "your light_pdf"))
        })
    })
}

impl Lit {
    /// Whether this is the density of a sphere by a `1 - cos θ` in single precision, in which the cosine is rounded.
    fn is_rounded(&self, density: f32) -> bool {
        let EmitterShape::Sphere(sphere) = self.emitter.shape else { return false };
        let to_center = sphere.center - self.from;
        let by_squares = sphere.radius * sphere.radius / to_center.length_squared();
        let by_sine = (sphere.radius / to_center.length()).powi(2);
        [by_squares, by_sine].iter().any(|sin_squared| {
            let rounded = f64::from(1.0 - (1.0 - sin_squared).sqrt());
            rounded == 0.0 && !(density.is_finite() && density > 0.0)
                || (f64::from(density) * TAU * rounded - 1.0).abs() < 1e-5
        })
    }
}

/// Asks for the density of the direction of `sample`.
fn of_direction(query: &EmitterQuery, sample: Option<EmitterSample>) -> EmitterPdfQuery {
    let direction = sample.map_or(Vec3::X, |sample| sample.direction);
    EmitterPdfQuery { emitter: query.emitter, from: query.from, direction }
}

/// The student's samples, each with the student's density of its direction.
fn with_densities(trial: &Trial<'_>, queries: &[EmitterQuery]) -> Vec<(Option<EmitterSample>, f32)> {
    let samples = trial.kit.sample_light(queries);
    let directions: Vec<EmitterPdfQuery> =
        queries.iter().zip(&samples).map(|(query, sample)| of_direction(query, *sample)).collect();
    samples.into_iter().zip(trial.kit.light_pdf(&directions)).collect()
}

pub(super) fn light_pdf_is_that_of_the_sample(trial: &Trial<'_>) -> CheckResult {
    // Away from the edges, where rounding decides whether a direction meets the emitter.
    // The sum of both numbers is never 1: a diagonal may be an edge.
    let inner = |shift: f32| (1..15i32).prop_map(move |n| (n as f32 + shift) / 16.0);
    let queries = (bright(), inner(0.3), inner(0.45)).prop_map(|(lit, x, y)| lit.sample(vec2(x, y)));
    trial.forall(500, queries, |queries| {
        compare(queries, with_densities(trial, queries), |query, (sample, density)| {
            let Some(sample) = sample else { return Err(missing(query)) };
            judge_sample(query, &sample)?;
            let ratio = f64::from(density) / f64::from(sample.pdf);
            // The rounding of the direction moves the hit by up to 1e-5 of the distance, and the density with it.
            if (ratio - 1.0).abs() <= 1e-3 {
                return Ok(());
            }
            let area = of(query).area();
            let is_area = area.is_some_and(|area| (f64::from(density) * area - 1.0).abs() < 1e-3);
            let squared = f64::from(sample.distance).powi(2);
            let is_off = |ratio: f64| (squared - 1.0).abs() > 1e-2 && (ratio * squared - 1.0).abs() < 1e-3;
            let own_is_area = area.is_some_and(|area| (f64::from(sample.pdf) * area - 1.0).abs() < 1e-3);
            let of_pdf = of_direction(query, Some(sample)).call("light_pdf");
            let input = format!("{of_pdf}\nand the pdf of {}", query.call("sample_light"));
            Err(Broken::new(input, density, sample.pdf, "your sample_light").explained_by([
                (density == 0.0, "your light_pdf is 0 for a direction that sample_light returns"),
                (is_area, "your light_pdf is per area, and the pdf of your sample is per steradian"),
                (own_is_area, "the pdf of your sample is per area, and your light_pdf is per steradian"),
                (density.is_nan(), "your light_pdf is NaN"),
                "your two densities differ by the square of the distance: both are r² / (cos θ A)"
                    .when(area.is_some() && (is_off(ratio) || is_off(1.0 / ratio))),
            ]))
        })
    })
}

pub(super) fn light_pdf_beside_the_light_is_zero(trial: &Trial<'_>) -> CheckResult {
    // Directions that meet the emitter (0), and that miss it: beside it (1, 2), away from it (3).
    let cases = (layouts(), 0..4i32, 0..16i32, 0..16i32).prop_map(|(layout, which, a, b)| {
        let lit = layout.lit();
        let u = |n: i32| (f64::from(n) + 0.5) / 16.0;
        let inside = lit.toward((u(a), u(b)));
        let direction = match (which, layout.kind) {
            (0, _) => inside,
            (3, _) => -inside,
            // A point beyond the rim, up to twice its angle away, and one beyond an edge of the parallelogram.
            (_, 2) => {
                let (axis, rim) = (lit.toward((0.0, 0.0)), lit.toward((1.0, u(b))));
                axis + (1.05 + u(a)) * (rim.normalize() - axis)
            }
            _ => {
                // Before the start of an edge, or beyond the opposite one.
                let (s, t) = match (which, layout.kind) {
                    (1, _) => (-0.02 - u(a), u(b)),
                    (_, 0) => (1.02 + u(a), u(b)),
                    _ => (0.05 + 0.9 * u(a), 1.02 - 0.9 * u(a) + 0.5 * u(b)),
                };
                lit.beyond(s, t)
            }
        };
        (lit, direction, which == 0)
    });
    trial.forall(500, cases, |cases| {
        let queries: Vec<EmitterPdfQuery> =
            cases.iter().map(|(lit, direction, _)| lit.pdf(*direction)).collect();
        compare(cases, trial.kit.light_pdf(&queries), |(lit, direction, meets), yours| {
            if if *meets { yours > 0.0 } else { yours == 0.0 } {
                return Ok(());
            }
            let expected = if *meets { "above 0" } else { "0.0: this direction misses the emitter" };
            let query = lit.pdf(*direction);
            let away = !*meets && lit.outside(-query.direction.as_dvec3()) < 0.0;
            let broken =
                Broken::with_texts(query.call("light_pdf"), format!("{yours:?}"), expected, "the definition");
            Err(broken.explained_by([
                (away && yours > 0.0, "this direction leads away from the emitter: the hit is behind `from`"),
                (
                    !*meets && yours > 0.0,
                    "you return a density above 0 for a direction that misses the emitter",
                ),
                (yours.is_nan(), "you return NaN"),
            ]))
        })
    })
}
