//! The laws of `watertight`.

use super::Odd;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::Vec3;
use oracle::STABLE;
use oracle::exact::{Body, meet, t_in_double, triangle};
use oracle::gauntlet::distributions::DISTRIBUTIONS;
use oracle::gauntlet::leaks::{Aim, aimed};
use oracle::gauntlet::meshes::closed;
use oracle::splitmix::Random;
use raykata::kit::{TriangleHit, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// Inputs of a distribution of the gauntlet.
pub(super) fn draw(trial: &Trial<'_>, name: &str, count: usize) -> Vec<TriangleQuery> {
    let mut random = Random::new(trial.seed, name.len() as u64);
    let found = DISTRIBUTIONS.iter().find(|distribution| distribution.name == name);
    let draw = found.map(|distribution| distribution.draw).expect("a distribution of the gauntlet");
    (0..count)
        .map(|_| {
            let (ray, triangle) = draw(&mut random);
            TriangleQuery { ray, triangle }
        })
        .collect()
}

/// The same triangles and origins, with rays aimed well inside or a little beside an edge, where the distance is larger
/// than rounding errors. Some rays are turned round, end before the triangle or begin behind it.
pub(super) fn aim_again(trial: &Trial<'_>, queries: &[TriangleQuery]) -> Vec<TriangleQuery> {
    let mut random = Random::new(trial.seed, 4);
    let again = |TriangleQuery { ray, triangle }: &TriangleQuery| {
        let beside = -(10f64.powf(-1.0 - 4.0 * f64::from(random.unit())));
        let gamma = if random.below(2) == 0 { beside } else { 0.2 };
        let beta = f64::from(0.1 + 0.6 * random.unit());
        let [o, a, b, c] = [ray.origin, triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);
        let way = a + beta * (b - a) + gamma * (c - a) - o;
        let ray = match random.below(6) {
            0 => Ray::new(ray.origin, (-way).as_vec3()),
            1 => Ray::new(ray.origin, way.as_vec3()).with_range(0.0, 0.5),
            2 => Ray::new(ray.origin, way.as_vec3()).with_range(2.0, f32::INFINITY),
            _ => Ray::new(ray.origin, way.as_vec3()),
        };
        TriangleQuery { ray, triangle: *triangle }
    };
    queries.iter().map(again).collect()
}

// The margin is that of the nearest edge. Rays that are turned round or have another range miss by half their range or
// more, which is far above all rounding errors.
pub(super) fn watertight_errs_only_where_roundings_decide(trial: &Trial<'_>) -> CheckResult {
    for distribution in &DISTRIBUTIONS {
        let mut queries = draw(trial, distribution.name, 400);
        queries.extend(aim_again(trial, &queries));
        let answers = trial.kit.watertight(&queries);
        let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| {
            let body = Body::Triangle(query.triangle);
            let Some(exact) = meet(&query.ray, body) else { return Ok(()) };
            let Some(margin) = triangle::margin(&query.ray, &query.triangle) else { return Ok(()) };
            if yours.is_some() == exact.verdict.is_hit() || margin <= STABLE {
                return Ok(());
            }
            let infinite = query.ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
            let on_the_line = meet(&infinite, body).is_some_and(|exact| exact.verdict.is_hit());
            let diagnosis = match (distribution.name, yours) {
                (_, Some(_)) if on_the_line => {
                    "you return a hit behind the origin or beyond the range: t counts only within the range of the ray"
                }
                (_, Some(_)) => "you return a hit where there is none, and rounding errors do not explain it",
                ("1e14", None) => "products of three lengths overflow: the normal alone has length 1e28",
                ("1e-14", None) => "a determinant that is small is not 0: only the triangle is small",
                ("needle", None) => "t has lost all digits on a needle: compute it from the plane",
                _ => "you return a miss where there is a hit, and rounding errors do not explain it",
            };
            Err(Broken::with_texts(
                query.call("watertight"),
                format!("{:?}", yours.map(|hit| hit.t)),
                format!("{:?}, {margin:.0} roundings from the opposite answer", exact.t),
                "exactly",
            )
            .looks_like(known(diagnosis)))
        };
        compare(&queries, answers, judge).into_iter().collect::<CheckResult>()?;
    }
    Ok(())
}

pub(super) fn watertight_meshes_do_not_leak(trial: &Trial<'_>) -> CheckResult {
    for mesh in closed() {
        let mut random = Random::new(trial.seed, 3);
        let rays: Vec<(Aim, Ray, u32)> = (0..600)
            .map(|n| {
                let aim = Aim::ALL[n % 2];
                let (ray, vertex) = aimed(&mesh, aim, &mut random);
                (aim, ray, vertex)
            })
            .collect();
        // Test the triangles around the vertex first, because nearly every ray hits one of them.
        let fan = |vertex: u32| mesh.fans[vertex as usize].iter().map(|&index| mesh.triangle(index));
        let near: Vec<TriangleQuery> = rays
            .iter()
            .flat_map(|&(_, ray, vertex)| fan(vertex).map(move |triangle| TriangleQuery { ray, triangle }))
            .collect();
        let mut answers = trial.kit.watertight(&near).into_iter();
        for (aim, ray, vertex) in &rays {
            let count = mesh.fans[*vertex as usize].len();
            if answers.by_ref().take(count).filter(Option::is_some).count() > 0 {
                continue;
            }
            let all: Vec<TriangleQuery> =
                mesh.all().into_iter().map(|triangle| TriangleQuery { ray: *ray, triangle }).collect();
            if trial.kit.watertight(&all).iter().any(Option::is_some) {
                continue;
            }
            let aimed_at = match aim {
                Aim::Edge => "an edge",
                Aim::Vertex => "a vertex",
            };
            let input = format!(
                "watertight of {:?}\nagainst each of the {} triangles of a closed mesh ({}), from inside, aimed at {aimed_at}",
                ray,
                mesh.triangles.len(),
                mesh.name
            );
            let infinite = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
            let hits = |ray: Ray| {
                let near: Vec<TriangleQuery> =
                    fan(*vertex).map(|triangle| TriangleQuery { ray, triangle }).collect();
                trial.kit.watertight(&near).iter().any(Option::is_some)
            };
            let middle = fan(*vertex).next().map_or(Vec3::ZERO, |Triangle { a, b, c }| (a + b + c) / 3.0);
            let diagnosis = match () {
                () if !hits(Ray::new(ray.origin, middle - ray.origin)) && mesh.name.contains("1e14") => {
                    "products of three lengths overflow: your code misses even the middle of a triangle"
                }
                () if !hits(Ray::new(ray.origin, middle - ray.origin)) => {
                    "your code misses even the middle of a triangle: a determinant that is small is not 0"
                }
                () if mesh.name.contains("needle") && hits(infinite) => {
                    "t has lost all digits and its sign: compute it from the plane"
                }
                () => {
                    "the ray misses both neighbours of an edge: decide an edge by its two ends only, in the same \
                     way for both, and count 0 as inside"
                }
            };
            return Err(Broken::with_texts(input, "no hit", "a hit", "the mesh is closed")
                .looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}

pub(super) fn watertight_has_a_good_t(trial: &Trial<'_>) -> CheckResult {
    for name in ["interior", "needle", "1e-14", "1e14"] {
        let queries = draw(trial, name, 400);
        let answers = trial.kit.watertight(&queries);
        let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| {
            let exact = t_in_double(&query.ray, Body::Triangle(query.triangle)).flatten();
            let (Some(exact), Some(yours)) = (exact, yours) else { return Ok(()) };
            let normal = {
                let Triangle { a, b, c } = query.triangle;
                let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
                (b - a).cross(c - a).normalize_or_zero()
            };
            // The error of t grows as the ray gets parallel to the plane. A thousandth at right angles accepts every
            // formula that uses the plane, and rejects those that lose all digits.
            let slope = normal.dot(query.ray.direction.as_dvec3().normalize()).abs();
            let tolerance = 1e-3 * exact.abs() / slope.max(1e-3);
            if (f64::from(yours.t) - exact).abs() <= tolerance {
                return Ok(());
            }
            let diagnosis = match () {
                () if name == "needle" => {
                    "t has lost its digits on a needle: compute it from the plane of the triangle"
                }
                () if yours.t < 0.0 => "t has the wrong sign",
                () => "",
            };
            Err(Broken::new(query.call("watertight"), yours.t, exact, "exactly").looks_like(known(diagnosis)))
        };
        compare(&queries, answers, judge).into_iter().collect::<CheckResult>()?;
    }
    Ok(())
}

pub(super) fn watertight_sees_size_alike(trial: &Trial<'_>) -> CheckResult {
    // A factor of a power of two changes no rounding unless a number over- or underflows.
    let queries = draw(trial, "edge", 300);
    let plain = trial.kit.watertight(&queries);
    for exponent in [-30, 30] {
        let size = 2f32.powi(exponent);
        let scaled: Vec<TriangleQuery> = queries
            .iter()
            .map(|query| {
                let Triangle { a, b, c } = query.triangle;
                TriangleQuery {
                    ray: Ray::new(size * query.ray.origin, size * query.ray.direction),
                    triangle: Triangle { a: size * a, b: size * b, c: size * c },
                }
            })
            .collect();
        for ((query, yours), plain) in scaled.iter().zip(trial.kit.watertight(&scaled)).zip(&plain) {
            if yours != *plain {
                let broken = Broken::with_texts(
                    query.call("watertight"),
                    format!("{yours:?}"),
                    format!("{plain:?}, as without the factor 2^{exponent}"),
                    "a power of two changes no rounding",
                );
                return Err(broken.looks_like(Some(
                    "a fixed epsilon decides: scaling by a power of two must change no answer",
                )));
            }
        }
    }
    Ok(())
}

pub(super) fn watertight_of_special_numbers_is_finite(trial: &Trial<'_>) -> CheckResult {
    let queries = Odd::new(trial, 6).triangles();
    let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| match yours {
        Some(hit) if !(hit.t.is_finite() && hit.beta.is_finite() && hit.gamma.is_finite()) => {
            let broken =
                Broken::new(query.call("watertight"), hit, "finite numbers, or None", "the definition");
            Err(broken
                .looks_like(Some("NaN is no hit: test the conditions of a hit, which are false for NaN")))
        }
        _ => Ok(()),
    };
    compare(&queries, trial.kit.watertight(&queries), judge).into_iter().collect()
}
