//! The laws of `watertight`.

use super::Odd;
use super::doubles::{judge_ends, judge_weights};
use super::next_to_faces::{
    hits_a_corner_seen_edge_on, passes_beside_a_triangle_seen_edge_on, starts_next_to_a_face,
};
use checks::prelude::*;
use oracle::STABLE;
use oracle::exact::{Body, meet, t_in_double, triangle, verdict};
use oracle::gauntlet::distributions::DISTRIBUTIONS;
use oracle::gauntlet::families::families;
use oracle::gauntlet::leaks::{Aim, aimed};
use oracle::gauntlet::meshes::{Closed, closed};
use oracle::splitmix::Random;

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

/// Whether the determinant is below 1e-6, the usual epsilon in the method of Möller and Trumbore.
fn small(query: &TriangleQuery) -> bool {
    let Triangle { a, b, c } = query.triangle;
    let determinant = (b - a).as_dvec3().cross((c - a).as_dvec3()).dot(query.ray.direction.as_dvec3());
    determinant.abs() < 1e-6
}

/// Wrong verdicts on a triangle in double precision, each with whether it is a hit.
pub(super) fn wrong_verdicts(query: &TriangleQuery) -> [(bool, &'static str); 10] {
    let ray = &query.ray;
    let [o, d, a, b, c] =
        [ray.origin, ray.direction, query.triangle.a, query.triangle.b, query.triangle.c].map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    let (t, slope) = ((a - o).dot(normal) / d.dot(normal), d.dot(normal));
    let weight = |p: DVec3, q: DVec3| (p - o).cross(q - o).dot(d) / slope;
    let [alpha, beta, gamma] = [weight(b, c), weight(c, a), weight(a, b)].map(|weight| -weight);
    let [alpha, beta, gamma] =
        if alpha + beta + gamma < 0.0 { [-alpha, -beta, -gamma] } else { [alpha, beta, gamma] };
    let [in_a, in_b, in_c] = [alpha, beta, gamma].map(|weight| weight >= 0.0);
    let main = d[d.abs().max_position()];
    let (inside, counts) = (in_a && in_b && in_c, |t: f64| ray.contains(t as f32));
    named![
        inside && counts(t) && slope < 0.0 => ONE_SIDE,
        inside && counts(t) && slope > 0.0 => ONE_SIDE,
        inside && counts(t) && slope * main > 0.0 => ONE_TURN,
        inside && counts(t) && slope * main < 0.0 => ONE_TURN,
        in_a && in_b && counts(t) => TWO_EDGES,
        in_a && in_c && counts(t) => TWO_EDGES,
        in_b && in_c && counts(t) => TWO_EDGES,
        in_b && in_c && beta <= 1.0 && gamma <= 1.0 && counts(t) => "a point of the parallelogram is a hit: β + γ is at most 1",
        inside && counts(-t) => "t has the wrong sign: it is the way from the origin to the plane",
        inside => "you return a hit behind the origin or beyond the range: t counts only within the range of the ray",
    ]
}

const ONE_TURN: &str = "a triangle is hit only if its corners turn one way in the coordinates of the ray: U, V and W may all be below 0";
const ONE_SIDE: &str = "a triangle is hit from one side only: both sides count";
const TWO_EDGES: &str = "only two of the three edges are tested: the point is inside of all three";

// The margin is that of the nearest edge. Rays that are turned round or have another range miss by half their range or
// more, which is far above all rounding errors.
pub(super) fn watertight_errs_only_where_roundings_decide(trial: &Trial<'_>) -> CheckResult {
    for distribution in &DISTRIBUTIONS {
        let mut queries = draw(trial, distribution.name, 400);
        queries.extend(aim_again(trial, &queries));
        let answers = trial.kit.watertight(&queries);
        let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| {
            let body = Body::Triangle(query.triangle);
            let Some(exact) = meet(&query.ray, body) else { return Ok(().into()) };
            let Some(margin) = triangle::margin(&query.ray, &query.triangle) else { return Ok(().into()) };
            let verdicts = wrong_verdicts(query)
                .map(|(is_hit, text)| (is_hit == yours.is_some() || margin <= STABLE, text));
            if yours.is_some() == exact.verdict.is_hit() || margin <= STABLE {
                return unless(true, Broken::default).formulas(verdicts);
            }
            let infinite = query.ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
            let on_the_line = meet(&infinite, body).is_some_and(|exact| exact.verdict.is_hit());
            let Triangle { a, b, c } = query.triangle;
            let normal = (b - a).cross(c - a);
            let underflows = normal == Vec3::ZERO || !normal.is_finite();
            let expected = format!("{:?}, {margin:.0} roundings from the opposite answer", exact.t);
            let yours_t = format!("{:?}", yours.map(|hit| hit.t));
            let broken = Broken::with_texts(query.call("watertight"), yours_t, expected, "exactly").explained_by([
                "you return a hit behind the origin or beyond the range: t counts only within the range of the ray"
                    .when(yours.is_some() && on_the_line),
                "the normal over- or underflows in single precision, because it grows with the square of the size"
                    .when(yours.is_none() && underflows),
                "you lose hits of small triangles: use no fixed limit for the determinant, and no products that lose their digits"
                    .when(yours.is_none() && small(query)),
            ]);
            unless(false, || broken).formulas(verdicts)
        };
        all_hold(compare(&queries, answers, judge))?;
    }
    Ok(())
}

/// The known mistakes that let `ray` leak out of a mesh: what exact arithmetic and the student's code say about the triangles
/// `hits`, which the ray hits.
fn reasons_of_leak(trial: &Trial<'_>, ray: &Ray, hits: &[Triangle]) -> [(bool, &'static str); 4] {
    let ask = |ray: &dyn Fn(&Triangle) -> Ray| {
        let query = |triangle: &Triangle| TriangleQuery { ray: ray(triangle), triangle: *triangle };
        trial.kit.watertight(&hits.iter().map(query).collect::<Vec<_>>())
    };
    // Ask for the whole line, and for the middle of each triangle.
    let line = ask(&|_| ray.with_range(f32::NEG_INFINITY, f32::INFINITY));
    let middle = |&Triangle { a, b, c }: &Triangle| (a / 3.0 + b / 3.0 + c / 3.0) - ray.origin;
    let middles_are_hit = ask(&|triangle| Ray::new(ray.origin, middle(triangle))).iter().all(Option::is_some);
    let normal = |Triangle { a, b, c }: &Triangle| (b - a).as_dvec3().cross((c - a).as_dvec3());
    let edge_on = |triangle: &Triangle| {
        let normal = normal(triangle);
        let slope = normal.dot(ray.direction.as_dvec3()).abs();
        slope <= 1e-6 * normal.length() * ray.direction.as_dvec3().length()
    };
    let by_rounding =
        |triangle: &Triangle| triangle::margin(ray, triangle).is_some_and(|margin| margin <= STABLE);
    let overflows = |triangle: &Triangle| {
        let volume = normal(triangle).length() * (triangle.a - ray.origin).as_dvec3().length();
        !(volume as f32).is_normal()
    };
    [
        "t has the wrong sign: where rounding may turn it, on a needle or edge-on, more digits must decide"
            .when(line.iter().flatten().any(|hit| hit.t <= 0.0)),
        "each triangle that the ray hits is seen edge-on: there t is a quotient of two rounding errors"
            .when(hits.iter().all(edge_on)),
        "the ray misses both neighbours of an edge: decide an edge by its two ends only, in the same way for both, and count 0 as inside"
            .when(middles_are_hit && hits.iter().all(|triangle| by_rounding(triangle) && !edge_on(triangle))),
        "products of three lengths over- or underflow in single precision here"
            .when(!middles_are_hit && hits.iter().all(overflows)),
    ]
}

/// A hit is a point of the triangle: none of its barycentric coordinates is negative, up to rounding. A thousandth accepts
/// every formula in single precision.
pub(super) fn judge_hit_point(query: &TriangleQuery, yours: Option<TriangleHit>) -> CheckResult {
    let is_inside = |hit: &TriangleHit| hit.beta.min(hit.gamma).min(1.0 - hit.beta - hit.gamma) >= -1e-3;
    if yours.as_ref().is_none_or(is_inside) {
        return Ok(());
    }
    let expected = "None, or β >= 0, γ >= 0 and β + γ <= 1";
    Err(Broken::with_texts(query.call("watertight"), format!("{yours:?}"), expected, "the definition")
        .because("you return a hit outside of the triangle: β, γ or 1 - β - γ is negative"))
}

fn mesh_does_not_leak(trial: &Trial<'_>, mesh: &Closed) -> CheckResult {
    let mut random = Random::new(trial.seed, 3);
    let rays: Vec<(Aim, Ray, u32)> = (0..600)
        .map(|n| {
            let aim = Aim::ALL[n % 2];
            let (ray, vertex) = aimed(mesh, aim, &mut random);
            (aim, ray, vertex)
        })
        .collect();
    // Test the triangles around the vertex first, because nearly every ray hits one of them.
    let fan = |vertex: u32| mesh.fans[vertex as usize].iter().map(|&index| mesh.triangle(index));
    let near: Vec<TriangleQuery> = rays
        .iter()
        .flat_map(|&(_, ray, vertex)| fan(vertex).map(move |triangle| TriangleQuery { ray, triangle }))
        .collect();
    let answers = trial.kit.watertight(&near);
    all_hold(compare(&near, answers.clone(), judge_hit_point))?;
    let mut answers = answers.into_iter();
    let judge = |(aim, ray, vertex): &(Aim, Ray, u32)| {
        let count = mesh.fans[*vertex as usize].len();
        if answers.by_ref().take(count).filter(Option::is_some).count() > 0 {
            return Ok(());
        }
        let all: Vec<TriangleQuery> =
            mesh.all().into_iter().map(|triangle| TriangleQuery { ray: *ray, triangle }).collect();
        if trial.kit.watertight(&all).iter().any(Option::is_some) {
            return Ok(());
        }
        let aimed_at = match aim {
            Aim::Edge => "an edge",
            Aim::Vertex => "a vertex",
        };
        let is_hit = |query: &TriangleQuery| {
            verdict(&query.ray, Body::Triangle(query.triangle)).is_some_and(|verdict| verdict.is_hit())
        };
        let hits: Vec<TriangleQuery> = all.into_iter().filter(is_hit).collect();
        let input = format!(
            "{}\nagainst a closed mesh ({}) from inside, aimed at {aimed_at}; the call has the triangles that it hits",
            ray.paste(),
            mesh.name
        );
        let triangles: Vec<Triangle> = hits.iter().map(|query| query.triangle).collect();
        Err(Broken::with_texts(input, "no hit", "a hit of one of them", "the mesh is closed")
            .explained_by(reasons_of_leak(trial, ray, &triangles))
            .in_call(Request::Watertight(hits)))
    };
    all_hold(rays.iter().map(judge).collect())?;
    // In the opposite direction the ray misses these triangles, unless they lie around its origin.
    let back: Vec<TriangleQuery> = near[..near.len().min(2000)]
        .iter()
        .map(|query| TriangleQuery { ray: Ray::new(query.ray.origin, -query.ray.direction), ..*query })
        .collect();
    let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| {
        let body = Body::Triangle(query.triangle);
        let missed = verdict(&query.ray, body).is_some_and(|verdict| !verdict.is_hit());
        let clear = triangle::margin(&query.ray, &query.triangle).is_some_and(|margin| margin > STABLE);
        if yours.is_none() || !missed || !clear {
            return Ok(());
        }
        Err(Broken::new(query.call("watertight"), yours, "None", "exactly"))
    };
    all_hold(compare(&back, trial.kit.watertight(&back), judge))
}

pub(super) fn watertight_meshes_do_not_leak(trial: &Trial<'_>) -> CheckResult {
    closed().iter().try_for_each(|mesh| mesh_does_not_leak(trial, mesh))?;
    starts_next_to_a_face(trial)
}

pub(super) fn watertight_walls_seen_edge_on_do_not_leak(trial: &Trial<'_>) -> CheckResult {
    let seen_edge_on = ["star prism", "star prism, tilted", "urchin", "cave", "scan"];
    let meshes = families().into_iter().filter(|mesh| seen_edge_on.contains(&mesh.name));
    meshes.into_iter().try_for_each(|mesh| mesh_does_not_leak(trial, &mesh))?;
    hits_a_corner_seen_edge_on(trial)?;
    passes_beside_a_triangle_seen_edge_on(trial)
}

/// The `t` of the paper in single precision: the depths of the corners, weighted with the edge functions, and divided by
/// that of the ray before or after.
fn from_depths(TriangleQuery { ray, triangle: Triangle { a, b, c } }: &TriangleQuery) -> [f32; 2] {
    let z = ray.direction.abs().max_position();
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let shear = ray.direction / ray.direction[z];
    let [p, q, r] = [*a, *b, *c].map(|corner| {
        let corner = corner - ray.origin;
        vec3(corner[x] - shear[x] * corner[z], corner[y] - shear[y] * corner[z], corner[z])
    });
    let edge = |p: Vec3, q: Vec3| p.x * q.y - p.y * q.x;
    let [alpha, beta, gamma] = [edge(q, r), edge(r, p), edge(p, q)];
    let sum = alpha + beta + gamma;
    let depth = |scale: f32| alpha * (p.z / scale) + beta * (q.z / scale) + gamma * (r.z / scale);
    [depth(ray.direction[z]) / sum, depth(1.0) / (sum * ray.direction[z])]
}

const OF_DEPTHS: &str =
    "t has lost its digits: the weighted depths of the corners cancel on a needle. Compute t from the plane";

pub(super) fn watertight_has_a_good_t(trial: &Trial<'_>) -> CheckResult {
    for name in ["interior", "needle", "1e-14", "1e14"] {
        let queries = draw(trial, name, 400);
        let answers = trial.kit.watertight(&queries);
        let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| {
            let exact = t_in_double(&query.ray, Body::Triangle(query.triangle)).flatten();
            let Some(exact) = exact else { return Ok(()) };
            let Some(yours) = yours else {
                // Leave verdicts that roundings decide to another check.
                let clear =
                    triangle::margin(&query.ray, &query.triangle).is_some_and(|margin| margin > STABLE);
                let hit = || Broken::new(query.call("watertight"), "None", exact, "exactly");
                return if clear { Err(hit()) } else { Ok(()) };
            };
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
            let [divided_before, divided_after] = from_depths(query);
            Err(Broken::new(query.call("watertight"), yours.t, exact, "exactly").explained_by([
                (yours.t == divided_before, OF_DEPTHS),
                (yours.t == divided_after, OF_DEPTHS),
                (f64::from(yours.t) * exact < 0.0, "t has the wrong sign"),
            ]))
        };
        all_hold(compare(&queries, answers, judge))?;
    }
    let queries = draw(trial, "interior", 400);
    // A thousandth accepts every formula in single precision.
    all_hold(judge_weights("watertight", &queries, trial.kit.watertight(&queries), 1e-3))?;
    // The same for points exactly on an edge. The coordinates are small whole numbers, so few roundings occur.
    let ties = draw(trial, "ties", 400);
    all_hold(judge_weights("watertight", &ties, trial.kit.watertight(&ties), 1e-3))?;
    all_hold(judge_ends("watertight", &queries, |queries| trial.kit.watertight(queries)))
}

pub(super) fn watertight_sees_size_alike(trial: &Trial<'_>) -> CheckResult {
    // A factor of a power of two changes no rounding unless a number over- or underflows. Half of the rays are aimed well
    // inside, where roundings do not decide.
    let mut queries = draw(trial, "edge", 300);
    let inside = draw(trial, "interior", 300);
    // And rays that go away from the triangle.
    let away = |query: &TriangleQuery| TriangleQuery {
        ray: Ray::new(query.ray.origin, -query.ray.direction),
        ..*query
    };
    queries.extend(inside.iter().map(away));
    queries.extend(inside);
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
        let pairs: Vec<_> = scaled.iter().zip(queries.iter().zip(&plain)).collect();
        let judge = |(query, (unscaled, plain)): &(
            &TriangleQuery,
            (&TriangleQuery, &Option<TriangleHit>),
        ),
                     yours: Option<TriangleHit>| {
            let exact = verdict(&query.ray, Body::Triangle(query.triangle));
            let clear = triangle::margin(&query.ray, &query.triangle).is_some_and(|margin| margin > STABLE);
            let is_hit = exact.is_some_and(|exact| exact.is_hit());
            let agrees = yours.is_some() == plain.is_some();
            if agrees && clear && yours.is_some() != is_hit {
                let expected = if is_hit { "a hit" } else { "None" };
                return Err(Broken::new(query.call("watertight"), yours, expected, "exactly"));
            }
            if yours == **plain {
                return Ok(());
            }
            Err(Broken::with_texts(
                query.call("watertight"),
                format!("{yours:?}"),
                format!("{plain:?}, as without the factor 2^{exponent}"),
                "a power of two changes no rounding",
            )
            .explained_by(["a determinant below a fixed epsilon counts as 0: scaling by a power of two must change no answer"
                .when(yours.is_none() && plain.is_some() && small(query) && !small(unscaled))]))
        };
        all_hold(compare(&pairs, trial.kit.watertight(&scaled), judge))?;
    }
    Ok(())
}

/// A triangle test of the student, and its name.
pub(super) type TriangleTest = (&'static str, fn(&dyn Kit, &[TriangleQuery]) -> Vec<Option<TriangleHit>>);

pub(super) const WATERTIGHT: TriangleTest = ("watertight", |kit, queries| kit.watertight(queries));
pub(super) const IN_DOUBLE: TriangleTest =
    ("triangle_in_double", |kit, queries| kit.triangle_in_double(queries));

pub(super) fn finite_hits(trial: &Trial<'_>, (name, ask): TriangleTest) -> CheckResult {
    let mut queries = Odd::new(trial, 6).triangles();
    // One ordinary hit and one ordinary miss.
    let triangle = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let at = |x: f32| TriangleQuery { ray: Ray::new(vec3(x, 0.25, 1.0), Vec3::NEG_Z), triangle };
    let (inside, outside) = trial.varied((0.25, 4.0), (0.1..0.6f32, 0.8..1.2f32));
    let (ordinary, beside) = (at(inside), at(outside));
    queries.extend([ordinary, beside]);
    let judge = |query: &TriangleQuery, yours: Option<TriangleHit>| match yours {
        None if *query == ordinary => Err(Broken::new(query.call(name), yours, "a hit at t = 1", "exactly")),
        Some(_) if *query == beside => Err(Broken::new(query.call(name), yours, "None", "exactly")),
        Some(hit) if !(hit.t.is_finite() && hit.beta.is_finite() && hit.gamma.is_finite()) => {
            let broken = Broken::new(query.call(name), hit, "finite numbers, or None", "the definition");
            Err(broken.explained_by(["NaN is no hit: test the conditions of a hit, which are false for NaN"
                .when(hit.t.is_nan() || hit.beta.is_nan() || hit.gamma.is_nan())]))
        }
        _ => Ok(()),
    };
    all_hold(compare(&queries, ask(trial.kit, &queries), judge))
}
