//! Stage 2: triangles and meshes.

use crate::broken::{Broken, Outcome};
use crate::double::{self, Expected};
use crate::generate::{direction, point, rough_point, triangle};
use crate::paste::{Arguments, Paste, call};
use crate::stage1::{compare, known};
use crate::{Trial, checks, golden, picture};
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{InsideQuery, InterpolateQuery, Kit, SearchQuery, Table, TriangleHit, TriangleQuery};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;

checks! { ($) 2 stage2 [
    triangle_cramer_agrees_with_double_precision
    triangle_cramer_knows_inside_from_outside
    triangle_cramer_is_hit_from_either_side
    triangle_cramer_respects_the_range
    triangle_cramer_owns_its_edges
    triangle_cramer_has_no_smallest_size
    triangle_cramer_far_from_the_origin
    triangle_cramer_is_missed_where_there_is_none
    triangle_gram_agrees_with_double_precision
    triangle_gram_knows_inside_from_outside
    triangle_gram_is_hit_from_either_side
    triangle_gram_respects_the_range
    triangle_gram_owns_its_edges
    triangle_gram_has_no_smallest_size
    triangle_gram_far_from_the_origin
    triangle_gram_is_missed_where_there_is_none
    triangle_choice_agrees_with_double_precision
    triangle_choice_knows_inside_from_outside
    triangle_choice_is_hit_from_either_side
    triangle_choice_respects_the_range
    triangle_choice_owns_its_edges
    triangle_choice_has_no_smallest_size
    triangle_choice_far_from_the_origin
    triangle_choice_is_missed_where_there_is_none
    gram_scalars_of_thin_triangles_keep_their_sign
    inside_by_planes_agrees_with_double_precision
    inside_by_direction_agrees_with_double_precision
    inside_by_areas_gives_the_weights_of_the_corners
    interpolation_weighs_the_corners
    face_normal_has_unit_length_at_any_size
    vertex_normals_average_their_faces
    vertex_normals_that_cancel_are_still_normals
    brute_force_finds_the_closest_of_all
    hit_table_of_a_fan
    picture_of_an_octahedron
] }

// ---- ray against triangle, three ways ----

/// One of the ways to intersect a triangle.
#[derive(Clone, Copy)]
struct Method {
    name: &'static str,
    ask: fn(&dyn Kit, &[TriangleQuery]) -> Vec<Option<TriangleHit>>,
}

const CRAMER: Method = Method { name: "triangle_cramer", ask: |kit, queries| kit.triangle_cramer(queries) };
const GRAM: Method = Method { name: "triangle_gram", ask: |kit, queries| kit.triangle_gram(queries) };
const CHOICE: Method = Method { name: "triangle_choice", ask: |kit, queries| kit.triangle_choice(queries) };

macro_rules! for_all_methods {
    ($($cramer:ident $gram:ident $choice:ident $law:ident;)*) => {
        $(fn $cramer(trial: &Trial<'_>) -> Outcome {
            $law(trial, CRAMER)
        }
        fn $gram(trial: &Trial<'_>) -> Outcome {
            $law(trial, GRAM)
        }
        fn $choice(trial: &Trial<'_>) -> Outcome {
            $law(trial, CHOICE)
        })*
    };
}

for_all_methods! {
    triangle_cramer_agrees_with_double_precision triangle_gram_agrees_with_double_precision triangle_choice_agrees_with_double_precision triangle_agrees;
    triangle_cramer_knows_inside_from_outside triangle_gram_knows_inside_from_outside triangle_choice_knows_inside_from_outside triangle_regions;
    triangle_cramer_is_hit_from_either_side triangle_gram_is_hit_from_either_side triangle_choice_is_hit_from_either_side triangle_windings;
    triangle_cramer_respects_the_range triangle_gram_respects_the_range triangle_choice_respects_the_range triangle_in_range;
    triangle_cramer_owns_its_edges triangle_gram_owns_its_edges triangle_choice_owns_its_edges triangle_edges;
    triangle_cramer_has_no_smallest_size triangle_gram_has_no_smallest_size triangle_choice_has_no_smallest_size triangle_sizes;
    triangle_cramer_far_from_the_origin triangle_gram_far_from_the_origin triangle_choice_far_from_the_origin triangle_far;
    triangle_cramer_is_missed_where_there_is_none triangle_gram_is_missed_where_there_is_none triangle_choice_is_missed_where_there_is_none triangle_missed;
}

impl Method {
    fn judge(self, trial: &Trial<'_>, queries: &[TriangleQuery]) -> Vec<Outcome> {
        compare(queries, (self.ask)(trial.kit, queries), |query, yours| {
            let expected = double::triangle(&query.ray, &query.triangle);
            if expected.accepts(yours) {
                return Ok(());
            }
            let broken =
                Broken::told(query.call(self.name), told(yours), expected.words(), "double precision");
            Err(broken.looks_like(triangle_diagnosis(self.name, query, yours, &expected)))
        })
    }

    fn judge_exact(self, trial: &Trial<'_>, cases: &[(TriangleQuery, Option<TriangleHit>, &str)]) -> Outcome {
        let queries: Vec<TriangleQuery> = cases.iter().map(|case| case.0).collect();
        for ((query, expected, diagnosis), yours) in cases.iter().zip((self.ask)(trial.kit, &queries)) {
            if yours != *expected {
                let broken =
                    Broken::told(query.call(self.name), told(yours), told(*expected), "exact arithmetic");
                return Err(broken.looks_like(known(diagnosis)));
            }
        }
        Ok(())
    }
}

fn told(hit: Option<TriangleHit>) -> String {
    hit.map_or("None".into(), |hit| {
        format!("t = {:?}, beta = {:?}, gamma = {:?}", hit.t, hit.beta, hit.gamma)
    })
}

fn triangle_diagnosis(
    method: &str,
    query: &TriangleQuery,
    yours: Option<TriangleHit>,
    expected: &double::TriangleExpected,
) -> Option<&'static str> {
    let near = |value: f32, exact: f64| (f64::from(value) - exact).abs() <= 2.0 * expected.tolerance;
    let (beta, gamma) = (expected.beta, expected.gamma);
    let alpha = 1.0 - beta - gamma;
    Some(match (yours, expected.t) {
        (Some(hit), _) if hit.t.is_nan() || hit.beta.is_nan() => "NaN is no hit: compare so that NaN fails",
        (Some(hit), _) if hit.t <= query.ray.t_min => {
            "a hit at or behind the start of the ray: ask ray.contains(t)"
        }
        (Some(hit), _) if hit.t >= query.ray.t_max => "a hit beyond the end of the ray: ask ray.contains(t)",
        (Some(_), Expected::Miss) if beta < 0.0 || gamma < 0.0 => {
            "a point outside with one weight below 0: 0 ≤ s + t ≤ 1 is not enough, s ≥ 0 and t ≥ 0 as well"
        }
        (Some(_), Expected::Miss) if alpha < 0.0 => "a point beyond the third side: β + γ ≤ 1 is not tested",
        (Some(hit), _) if near(hit.beta, gamma) && near(hit.gamma, beta) => "β and γ look swapped",
        (Some(hit), _) if near(hit.beta, alpha) || near(hit.gamma, alpha) => {
            "a weight of corner a: β belongs to b and γ to c"
        }
        (Some(hit), Expected::Hit { t, .. }) if f64::from(hit.t) * t < 0.0 => "the sign of t is wrong",
        (Some(hit), Expected::Hit { t, .. })
            if (f64::from(hit.t) - t * f64::from(query.ray.dir.length())).abs() <= 1e-3 * t.abs() =>
        {
            "your t counts world units; it must count lengths of dir"
        }
        (_, Expected::Hit { .. }) if method == CRAMER.name && slide_determinant_is_off(query) => {
            "the determinant as the slide prints it: it must be a(fk - gj) + b(gi - ek) + c(ej - fi)"
        }
        (None, Expected::Hit { .. }) => "a hit was lost: is the triangle tested from one side only?",
        _ => return None,
    })
}

/// Whether the determinant that the slide prints differs much from the true one here.
fn slide_determinant_is_off(query: &TriangleQuery) -> bool {
    let [x, y, z] = [query.triangle.a - query.triangle.b, query.triangle.a - query.triangle.c, query.ray.dir];
    let s = query.triangle.a - query.ray.origin;
    let slide = x.x * (y.y * z.z - z.y * y.z) + y.x * (z.y * s.z - s.y * z.z) + z.x * (s.y * y.z - y.y * s.z);
    let right = x.dot(y.cross(z));
    (slide - right).abs() > 1e-3 * right.abs()
}

/// A ray that is aimed at the point `(β, γ)` of a triangle, inside or out.
fn aimed(
    triangles: impl Strategy<Value = Triangle> + Clone,
    origins: impl Strategy<Value = Vec3> + Clone,
) -> impl Strategy<Value = TriangleQuery> + Clone {
    (triangles, origins, -4..=12i32, -4..=12i32, 1..=16i32).prop_map(
        |(triangle, origin, beta, gamma, length)| {
            let (beta, gamma) = (beta as f32 / 8.0, gamma as f32 / 8.0);
            let target = triangle.a + beta * (triangle.b - triangle.a) + gamma * (triangle.c - triangle.a);
            let to_target = target - origin;
            let dir = if to_target == Vec3::ZERO { Vec3::X } else { to_target.normalize() };
            TriangleQuery { ray: Ray::new(origin, length as f32 / 4.0 * dir), triangle }
        },
    )
}

fn triangle_agrees(trial: &Trial<'_>, method: Method) -> Outcome {
    trial.forall(6000, aimed(triangle(), point(8)), |queries| method.judge(trial, queries))
}

/// T1, T2, T7: the three regions beyond the sides and the three beyond the corners, seen along an axis and aslant.
fn triangle_regions(trial: &Trial<'_>, method: Method) -> Outcome {
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let places = [
        (0.25, 0.25, true),
        (2.0, -1.5, false),
        (-1.5, 2.0, false),
        (-0.2, -0.2, false),
        (0.75, 0.75, false),
        (-0.25, 0.5, false),
        (0.5, -0.25, false),
        (1.5, 0.5, false),
    ];
    for dir in [Vec3::NEG_Z, vec3(1.0, 2.0, -4.0), vec3(-0.5, 0.25, -1.0)] {
        let queries = places.map(|(x, y, _)| TriangleQuery {
            ray: Ray::new(vec3(x, y, 0.0) - 2.0 * dir, dir),
            triangle: unit,
        });
        method.judge(trial, &queries).into_iter().collect::<Outcome>()?;
    }
    // The slide's determinant is right for the rays along z above, and wrong here: t is 2.
    let slanted = TriangleQuery {
        ray: Ray::new(vec3(-2.5, -4.5, -6.25), vec3(1.0, 2.0, 3.0)),
        triangle: Triangle { a: Vec3::ZERO, b: vec3(-1.0, -1.0, 0.0), c: vec3(-1.0, -1.0, -1.0) },
    };
    method.judge(trial, &[slanted]).into_iter().collect()
}

fn triangle_windings(trial: &Trial<'_>, method: Method) -> Outcome {
    // The corners in all six orders: the same verdict and the same t, from the front and from the back.
    trial.forall(1000, aimed(triangle(), point(8)), |queries| {
        let orders = |query: &TriangleQuery| {
            let Triangle { a, b, c } = query.triangle;
            [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]]
                .map(|[a, b, c]| TriangleQuery { triangle: Triangle { a, b, c }, ..*query })
        };
        let all: Vec<TriangleQuery> = queries.iter().flat_map(orders).collect();
        let outcomes = method.judge(trial, &all);
        outcomes.chunks(6).map(|six| six.iter().cloned().collect()).collect()
    })
}

fn triangle_in_range(trial: &Trial<'_>, method: Method) -> Outcome {
    let triangle = Triangle { a: vec3(-2.0, -2.0, 0.0), b: vec3(2.0, -2.0, 0.0), c: vec3(-2.0, 2.0, 0.0) };
    let hit = |t| Some(TriangleHit { t, beta: 0.25, gamma: 0.25 });
    let at = |z: f32, t_min: f32, t_max: f32| TriangleQuery {
        ray: Ray::new(vec3(-1.0, -1.0, z), Vec3::NEG_Z).with_range(t_min, t_max),
        triangle,
    };
    let endless = f32::INFINITY;
    method.judge_exact(
        trial,
        &[
            (at(4.0, 0.0, endless), hit(4.0), ""),
            (at(-4.0, 0.0, endless), None, "the triangle is behind the ray: a negative t does not count"),
            (at(0.0, 0.0, endless), None, "the ray starts in the triangle: t = 0 does not count"),
            (at(4.0, 5.0, endless), None, "the hit lies before t_min"),
            (at(4.0, 0.0, 3.0), None, "the hit lies beyond t_max"),
            (at(4.0, 0.0, 4.0), None, "the range is open: a hit at t_max does not count"),
            (at(4.0, 3.0, 5.0), hit(4.0), ""),
        ],
    )
}

fn triangle_edges(trial: &Trial<'_>, method: Method) -> Outcome {
    // Sides are powers of two and the ray runs along an axis, so every method gets these weights exactly.
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(4.0, 0.0, 0.0), c: vec3(0.0, 4.0, 0.0) };
    let at = |x: f32, y: f32| {
        let ray = Ray::new(vec3(x, y, 2.0), Vec3::NEG_Z);
        let hit = TriangleHit { t: 2.0, beta: x / 4.0, gamma: y / 4.0 };
        (
            TriangleQuery { ray, triangle },
            Some(hit),
            "points on an edge belong to the triangle: ≥ and ≤, not > and <",
        )
    };
    let on_the_rim = [(2.0, 0.0), (0.0, 1.0), (3.0, 1.0), (0.0, 0.0), (4.0, 0.0), (0.0, 4.0)];
    method.judge_exact(trial, &on_the_rim.map(|(x, y)| at(x, y)))
}

/// T11: a scene a million times smaller or larger gives the same verdict, the same weights, and `t` times the factor.
fn triangle_sizes(trial: &Trial<'_>, method: Method) -> Outcome {
    trial.forall(1000, aimed(triangle(), point(8)), |queries| {
        let answers = (method.ask)(trial.kit, queries);
        let mut outcomes = vec![Ok(()); queries.len()];
        for factor in [2f32.powi(-20), 2f32.powi(20)] {
            let scaled: Vec<TriangleQuery> = queries
                .iter()
                .map(|query| TriangleQuery {
                    ray: Ray { origin: factor * query.ray.origin, ..query.ray },
                    triangle: Triangle {
                        a: factor * query.triangle.a,
                        b: factor * query.triangle.b,
                        c: factor * query.triangle.c,
                    },
                })
                .collect();
            let scaled_answers = (method.ask)(trial.kit, &scaled);
            let pairs = answers.iter().zip(scaled_answers).collect();
            let judged = compare(&scaled, pairs, |query, (answer, yours)| {
                let expected = answer.map(|hit| TriangleHit { t: factor * hit.t, ..hit });
                if yours == expected {
                    return Ok(());
                }
                let broken = Broken::told(
                    query.call(method.name),
                    told(yours),
                    told(expected),
                    "the answer at scale 1",
                );
                let diagnosis = yours
                    .is_none()
                    .then_some("a fixed limit such as |det| < 1e-6 makes small triangles vanish");
                Err(broken.looks_like(diagnosis))
            });
            outcomes = outcomes.into_iter().zip(judged).map(|(one, other)| one.and(other)).collect();
        }
        outcomes
    })
}

/// T4: a small mesh at (148376, 1234, -223423), with the ray's origin near it.
fn triangle_far(trial: &Trial<'_>, method: Method) -> Outcome {
    let place = vec3(148_376.0, 1_234.0, -223_423.0);
    let triangles = (rough_point(4.0), rough_point(4.0), rough_point(4.0))
        .prop_map(move |(a, b, c)| Triangle { a: place + a, b: place + b, c: place + c });
    let origins = rough_point(8.0).prop_map(move |offset| place + offset);
    trial.forall(3000, aimed(triangles, origins), |queries| {
        method
            .judge(trial, queries)
            .into_iter()
            .map(|outcome| {
                outcome.map_err(|broken| match broken.diagnosis {
                    None => broken.looks_like(Some(
                        "far from the origin o + t d rounds too coarsely: subtract o first",
                    )),
                    Some(_) => broken,
                })
            })
            .collect()
    })
}

fn triangle_missed(trial: &Trial<'_>, method: Method) -> Outcome {
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    let down = Ray::new(vec3(0.25, 0.25, 1.0), Vec3::NEG_Z);
    let along = |origin| TriangleQuery { ray: Ray::new(origin, Vec3::X), triangle: unit };
    let with = |a, b, c| TriangleQuery { ray: down, triangle: Triangle { a, b, c } };
    let p = vec3(0.25, 0.25, 0.0);
    let flat = "a triangle without area, or a ray along its plane, divides by 0: that is a miss";
    let nan = "NaN is no hit: compare so that NaN fails";
    method.judge_exact(
        trial,
        &[
            (along(vec3(-1.0, 0.25, 0.0)), None, flat),
            (along(vec3(-1.0, 0.25, 1.0)), None, flat),
            (with(p, p, p), None, flat),
            (with(p, p, Vec3::X), None, flat),
            (with(Vec3::ZERO, 0.5 * p, 2.0 * p), None, flat),
            (with(Vec3::NAN, Vec3::X, Vec3::Y), None, nan),
            (with(Vec3::ZERO, Vec3::NAN, Vec3::Y), None, nan),
            (TriangleQuery { ray: Ray { dir: Vec3::NAN, ..down }, triangle: unit }, None, nan),
            (TriangleQuery { ray: Ray { dir: Vec3::ZERO, ..down }, triangle: unit }, None, flat),
            (TriangleQuery { ray: Ray { origin: Vec3::NAN, ..down }, triangle: unit }, None, nan),
        ],
    )?;
    // Sizes that overflow single precision may hit or miss, but never with a NaN.
    let huge = with(-1e20 * Vec3::ONE, 1e20 * Vec3::X, 1e20 * Vec3::Y);
    for yours in (method.ask)(trial.kit, &[huge]).into_iter().flatten() {
        if !(yours.t.is_finite() && yours.beta.is_finite() && yours.gamma.is_finite()) {
            return Err(Broken::told(
                huge.call(method.name),
                told(Some(yours)),
                "None, or finite numbers",
                "the definition",
            )
            .looks_like(Some(nan)));
        }
    }
    Ok(())
}

// ---- the Gram scalars ----

fn gram_scalars_of_thin_triangles_keep_their_sign(trial: &Trial<'_>) -> Outcome {
    let thin = (point(2), direction(), 1..=40i32).prop_map(|(a, u, thinness)| {
        let beside = u.any_orthogonal_vector() * 2f32.powi(-thinness);
        Triangle { a, b: a + u, c: a + (u + beside) }
    });
    // T3: the direct formula gives 0 for the first and +9.5e-7 for the second.
    let slide_cases = [
        Triangle { a: Vec3::ZERO, b: Vec3::X, c: vec3(2.0, 1e-4, 0.0) },
        Triangle { a: Vec3::ZERO, b: Vec3::ONE, c: vec3(1.0, 1.0, 1.0001) },
    ];
    let judge = |triangles: &[Triangle]| {
        compare(triangles, trial.kit.gram_scalars(triangles), |triangle, yours| {
            let (u, v) = (triangle.b - triangle.a, triangle.c - triangle.a);
            let exact = |p: Vec3, q: Vec3| p.as_dvec3().dot(q.as_dvec3());
            let scalars = [
                ("uv", yours.uv, exact(u, v), u.length() * v.length()),
                ("vv", yours.vv, exact(v, v), v.dot(v)),
                ("uu", yours.uu, exact(u, u), u.dot(u)),
            ];
            let input = call("gram_scalars", &[triangle]);
            for (name, yours, exact, size) in scalars {
                // Three products and two sums.
                if (f64::from(yours) - exact).abs() > 8.0 * double::U * f64::from(size) {
                    return Err(Broken::told(
                        input,
                        format!("{name} = {yours}"),
                        format!("{name} = {exact}"),
                        "double precision",
                    ));
                }
            }
            let d = -u.as_dvec3().cross(v.as_dvec3()).length_squared();
            // The cross product is rounded at the size of |u| |v|; squared, that is what remains of D.
            let slack = 16.0 * double::U * f64::from(u.length() * v.length());
            let tolerance = 2.0 * slack * d.abs().sqrt() + slack * slack;
            if yours.d <= 0.0 && (f64::from(yours.d) - d).abs() <= tolerance {
                return Ok(());
            }
            let broken =
                Broken::told(input, format!("D = {:?}", yours.d), format!("D = {d:e}"), "double precision");
            Err(broken.looks_like(Some("UV² - UU·VV cancels for a thin triangle; D is -|u × v|²")))
        })
    };
    judge(&slide_cases).into_iter().collect::<Outcome>()?;
    trial.forall(1000, triangle(), judge)?;
    trial.forall(1000, thin, judge)
}

// ---- inside or outside ----

/// A point in the plane of a triangle, as the hit of a ray, with its true weights.
fn plane_points() -> impl Strategy<Value = (InsideQuery, [f64; 3])> + Clone {
    aimed(triangle(), point(8)).prop_map(|TriangleQuery { ray, triangle }| {
        let hit = double::triangle(&ray, &triangle);
        let point = double::triangle_point(&triangle, hit.beta, hit.gamma).as_vec3();
        (InsideQuery { ray, point, triangle }, [1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma])
    })
}

/// Whether the point is inside: `None` if it is too near a side, or the triangle too thin, to tell.
fn clearly_inside(query: &InsideQuery, weights: [f64; 3]) -> Option<bool> {
    let Triangle { a, b, c } = query.triangle;
    let area = (b - a).cross(c - a).length();
    let thin = (b - a).length() * (c - a).length() / area;
    let facing = query.ray.dir.normalize().dot((b - a).cross(c - a) / area).abs();
    let least = weights.into_iter().fold(f64::INFINITY, f64::min);
    // A side's plane through the eye is no plane if the eye lies on the side's line; grazing rays come close.
    let sharp = thin < 30.0 && facing > 0.05 && weights.iter().all(|w| w.is_finite());
    (sharp && least.abs() > 1e-3).then_some(least > 0.0)
}

fn judge_inside(
    trial: &Trial<'_>,
    name: &'static str,
    ask: fn(&dyn Kit, &[InsideQuery]) -> Vec<bool>,
) -> Outcome {
    trial.forall(4000, plane_points(), |cases| {
        let queries: Vec<InsideQuery> = cases.iter().map(|case| case.0).collect();
        compare(cases, ask(trial.kit, &queries), |(query, weights), yours| {
            match clearly_inside(query, *weights) {
                Some(inside) if inside != yours => {
                    let normal =
                        (query.triangle.b - query.triangle.a).cross(query.triangle.c - query.triangle.a);
                    let backwards = normal.dot(query.ray.dir) > 0.0;
                    let diagnosis = match yours {
                        false if backwards => {
                            "seen from behind all three signs turn: accept all ≥ 0 or all ≤ 0"
                        }
                        false => "seen from the front all three signs are alike: accept all ≥ 0 or all ≤ 0",
                        true => "a point beyond a side: is P0 subtracted twice, or a side left out?",
                    };
                    Err(Broken::new(query.call(name), yours, inside, "double precision")
                        .looks_like(Some(diagnosis)))
                }
                _ => Ok(()),
            }
        })
    })
}

fn inside_by_planes_agrees_with_double_precision(trial: &Trial<'_>) -> Outcome {
    judge_inside(trial, "inside_by_planes", |kit, queries| kit.inside_by_planes(queries))?;
    // T10: the eye on the line of a side makes that plane's normal 0, and normalising it makes NaN.
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(4.0, 0.0, 0.0), c: vec3(0.0, 4.0, 0.0) };
    let eye = vec3(-4.0, 0.0, 0.0);
    let query = InsideQuery { ray: Ray::new(eye, vec3(5.0, 0.0, 0.0)), point: vec3(1.0, 0.0, 0.0), triangle };
    match trial.kit.inside_by_planes(&[query])[..] {
        [true] => Ok(()),
        ref yours => Err(Broken::new(query.call("inside_by_planes"), yours, [true], "exact arithmetic")
            .looks_like(Some("the eye lies on the line of a side: normalising that plane's normal is 0/0"))),
    }
}

fn inside_by_direction_agrees_with_double_precision(trial: &Trial<'_>) -> Outcome {
    judge_inside(trial, "inside_by_direction", |kit, queries| kit.inside_by_direction(queries))
}

fn inside_by_areas_gives_the_weights_of_the_corners(trial: &Trial<'_>) -> Outcome {
    trial.forall(4000, plane_points(), |cases| {
        let queries: Vec<InsideQuery> = cases.iter().map(|case| case.0).collect();
        compare(cases, trial.kit.inside_by_areas(&queries), |(query, weights), yours| {
            let Some(inside) = clearly_inside(query, *weights) else { return Ok(()) };
            let exact = DVec3::from_array(*weights);
            // The point is rounded at its own size, and a thin triangle (up to 30 times) makes more of that.
            let right = yours.is_none_or(|yours| (yours.as_dvec3() - exact).abs().max_element() < 1e-3);
            if yours.is_some() == inside && right {
                return Ok(());
            }
            let diagnosis = match yours {
                Some(_) if !inside => "areas without a sign cannot tell inside from outside: measure along the normal",
                Some(yours) if (yours.as_dvec3().truncate() - exact.truncate()).length() > 1e-3
                    && (yours.as_dvec3() - DVec3::new(exact.z, exact.y, exact.x)).length() < 1e-3 =>
                {
                    "the weights belong to other corners: α to a, β to b, γ to c (the slide counts the other way)"
                }
                _ => "",
            };
            let expected = inside.then_some(exact.as_vec3());
            let input = call("inside_by_areas", &[&query.point, &query.triangle]);
            Err(Broken::new(input, yours, expected, "double precision").looks_like(known(diagnosis)))
        })
    })
}

// ---- attributes ----

fn interpolation_weighs_the_corners(trial: &Trial<'_>) -> Outcome {
    let inputs = (0..=8i32, 0..=8i32, point(4), point(4), point(4)).prop_map(|(beta, gamma, a, b, c)| {
        let (beta, gamma) = if beta + gamma > 8 { (8 - beta, 8 - gamma) } else { (beta, gamma) };
        let (beta, gamma) = (beta as f32 / 8.0, gamma as f32 / 8.0);
        InterpolateQuery { weights: vec3(1.0 - beta - gamma, beta, gamma), corners: [a, b, c] }
    });
    trial.forall(1000, inputs, |queries| {
        compare(queries, trial.kit.interpolate(queries), |query, yours| {
            let [a, b, c] = query.corners;
            // Eighths of eighths: exact in single precision.
            let expected = query.weights.x * a + query.weights.y * b + query.weights.z * c;
            let input = format!(
                "interpolate({}, [{}, {}, {}])",
                query.weights.paste(),
                a.paste(),
                b.paste(),
                c.paste()
            );
            let diagnosis = if (yours.normalize_or_zero() - expected.normalize_or_zero()).length() < 1e-6 {
                "the value is normalised: that is for normals, not for every attribute"
            } else {
                "the weights are (α, β, γ) for the corners in this order"
            };
            if yours == expected {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(Some(diagnosis)))
            }
        })
    })
}

fn face_normal_has_unit_length_at_any_size(trial: &Trial<'_>) -> Outcome {
    let inputs = (triangle(), -60..=40i32).prop_map(|(t, power)| {
        let factor = 2f32.powi(power);
        Triangle { a: factor * t.a, b: factor * t.b, c: factor * t.c }
    });
    trial.forall(2000, inputs, |triangles| {
        compare(triangles, trial.kit.face_normal(triangles), |triangle, yours| {
            let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);
            let cross = (b - a).cross(c - a);
            let expected = cross.try_normalize().filter(|_| cross != DVec3::ZERO).map(|n| n.as_vec3());
            // Corners are multiples of 1/8 times the factor, so edges and cross product are exact to a few roundings.
            let right = match (yours, expected) {
                (Some(yours), Some(expected)) => (yours - expected).length() < 1e-5,
                (None, None) => true,
                _ => false,
            };
            let diagnosis = match (yours, expected) {
                (Some(yours), _) if yours.is_nan() => "0/0: a triangle without area has no normal",
                (Some(yours), Some(expected)) if (yours + expected).length() < 1e-5 => {
                    "the normal points the other way: u × v, not v × u"
                }
                (Some(yours), Some(expected)) if (yours.normalize_or_zero() - expected).length() < 1e-3 => {
                    "the length is not 1: for tiny edges |u × v|² underflows, so scale u and v first"
                }
                (None, Some(_)) => "a small triangle has a normal, too: scale u and v before the product",
                _ => "",
            };
            let input = call("face_normal", &[triangle]);
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "double precision").looks_like(known(diagnosis)))
            }
        })
    })
}

fn octahedron() -> Mesh {
    let corner = |i: u32| [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z][i as usize];
    let triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    Mesh { positions: (0..6).map(corner).collect(), triangles, ..Mesh::default() }
}

fn judge_normals(
    trial: &Trial<'_>,
    input: &str,
    mesh: &Mesh,
    accept: impl Fn(usize, Vec3) -> Option<Vec3>,
) -> Outcome {
    let answers = trial.kit.vertex_normals(std::slice::from_ref(mesh));
    let normals = &answers[0];
    if normals.len() != mesh.positions.len() {
        let (yours, expected) =
            (format!("{} normals", normals.len()), format!("{} normals", mesh.positions.len()));
        return Err(Broken::told(input, yours, expected, "one a vertex"));
    }
    for (vertex, &yours) in normals.iter().enumerate() {
        if let Some(expected) = accept(vertex, yours) {
            let input = format!("{input}, vertex {vertex} at {}", mesh.positions[vertex].paste());
            let diagnosis = match () {
                () if yours.is_nan() => {
                    "0/0: normals that cancel have no average; take the normal of one face"
                }
                () if (yours.length() - 1.0).abs() > 1e-4 => "the normal is not of unit length",
                () if (yours + expected).length() < 1e-3 => "the normal points inwards",
                () => "",
            };
            return Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)));
        }
    }
    Ok(())
}

fn vertex_normals_average_their_faces(trial: &Trial<'_>) -> Outcome {
    let octahedron = octahedron();
    let differs = |yours: Vec3, expected: Vec3| ((yours - expected).length() > 1e-5).then_some(expected);
    judge_normals(trial, "an octahedron", &octahedron, |vertex, yours| {
        differs(yours, octahedron.positions[vertex])
    })?;
    // The average counts each face once, however large: one face up, one to the side, of very different areas.
    let corner = Mesh {
        positions: vec![Vec3::ZERO, 8.0 * Vec3::X, 8.0 * Vec3::Y, vec3(0.0, 0.0, 0.125), vec3(0.0, 4.0, 0.0)],
        triangles: vec![[0, 1, 2], [0, 4, 3]],
        ..Mesh::default()
    };
    let both = (Vec3::Z + Vec3::X).normalize();
    judge_normals(trial, "a floor and a thin wall", &corner, |vertex, yours| match vertex {
        0 => differs(yours, both),
        1 | 2 => differs(yours, Vec3::Z),
        _ => differs(yours, Vec3::X),
    })
}

fn vertex_normals_that_cancel_are_still_normals(trial: &Trial<'_>) -> Outcome {
    // T14: a sheet with both sides as faces; a face without area; a vertex without faces.
    let sheet = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, vec3(5.0, 5.0, 5.0)],
        triangles: vec![[0, 1, 2], [0, 2, 1], [0, 1, 1]],
        ..Mesh::default()
    };
    judge_normals(trial, "a sheet with two sides", &sheet, |vertex, yours| match vertex {
        3 => (!((yours.length() - 1.0).abs() < 1e-4)).then_some(Vec3::Z),
        _ => (!((yours.abs() - Vec3::Z).length() < 1e-5)).then_some(Vec3::Z),
    })
}

// ---- the closest of many ----

fn brute_force_finds_the_closest_of_all(trial: &Trial<'_>) -> Outcome {
    let t = prop_oneof![Just(f32::INFINITY), (0..=20i32).prop_map(|t| t as f32 / 2.0 - 1.0)];
    let inputs = (prop::collection::vec(t, 0..12), 0..=4i32).prop_map(|(primitives, t_min)| {
        let ray = Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min as f32 / 2.0, 8.0);
        SearchQuery { bvh: Default::default(), ray, table: Table { boxes: Vec::new(), primitives } }
    });
    trial.forall(2000, inputs, |queries| {
        compare(queries, trial.kit.brute_force(queries), |query, yours| {
            let expected = closest_in_table(query);
            let n = query.table.primitives.len() as u64;
            let input = format!(
                "primitives at t = {:?}, ray range {:?}..{:?}",
                query.table.primitives, query.ray.t_min, query.ray.t_max
            );
            let found = yours.hit.map(|hit| (hit.primitive, hit.t));
            if found != expected {
                let diagnosis = match (found, expected) {
                    (_, Some((primitive, _))) if u64::from(primitive) + 1 == n => {
                        "the last primitive is left out"
                    }
                    (Some((_, yours)), Some((_, expected))) if yours == expected => {
                        "of two hits at one t the smaller number wins"
                    }
                    (Some((_, yours)), Some((_, expected))) if yours > expected => {
                        "the closest hit is not kept (is it assigned to another name?)"
                    }
                    _ => "",
                };
                return Err(Broken::new(input, found, expected, "the smallest t in the table")
                    .looks_like(known(diagnosis)));
            }
            let tests = yours.counts.primitive_tests;
            let told = |n: u64| format!("{n} primitive tests");
            if tests == n {
                Ok(())
            } else {
                Err(Broken::told(input, told(tests), told(n), "each primitive once"))
            }
        })
    })
}

/// `(primitive, t)` of the smallest `t` in the table that counts; of equal ones the first.
pub(crate) fn closest_in_table(query: &SearchQuery) -> Option<(u32, f32)> {
    let hits = query.table.primitives.iter().enumerate().filter(|(_, t)| query.ray.contains(**t));
    hits.min_by(|(_, p), (_, q)| p.total_cmp(q)).map(|(primitive, t)| (primitive as u32, *t))
}

// ---- golden text and picture ----

/// What each method finds on a fan of rays, to four digits: beyond that methods differ.
fn hit_table_of_a_fan(trial: &Trial<'_>) -> Outcome {
    let triangle = Triangle { a: vec3(-1.0, -1.0, 0.0), b: vec3(2.0, -0.5, 0.5), c: vec3(0.0, 2.0, -0.5) };
    let eye = vec3(0.3, 0.2, 4.0);
    let rays: Vec<TriangleQuery> = (0..25)
        .map(|i| {
            let target = vec3(-1.05 + 0.7 * (i % 5) as f32, -1.15 + 0.7 * (i / 5) as f32, 0.0);
            TriangleQuery { ray: Ray::new(eye, target - eye), triangle }
        })
        .collect();
    for method in [CRAMER, GRAM, CHOICE] {
        let lines: Vec<String> = rays
            .iter()
            .zip((method.ask)(trial.kit, &rays))
            .map(|(query, hit)| {
                let target = query.ray.at(1.0);
                let hit =
                    hit.map_or("-".into(), |hit| format!("{:.4} {:.4} {:.4}", hit.t, hit.beta, hit.gamma));
                format!("({:.2} {:.2})  {hit}", target.x, target.y)
            })
            .collect();
        golden::compare(
            "stage2_hit_table",
            &format!("{} on a fan of 25 rays from {eye}", method.name),
            &lines.join("\n"),
        )?;
    }
    Ok(())
}

fn picture_of_an_octahedron(trial: &Trial<'_>) -> Outcome {
    let mesh = octahedron();
    let rays = picture::rays(vec3(1.2, 1.6, 2.4), Vec3::ZERO);
    let mut nearest: Vec<(f32, Vec3)> = vec![(f32::INFINITY, Vec3::ZERO); rays.len()];
    let normals = trial.kit.vertex_normals(std::slice::from_ref(&mesh)).remove(0);
    for (face, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(face);
        let queries: Vec<TriangleQuery> =
            rays.iter().map(|&ray| TriangleQuery { ray, triangle: Triangle { a, b, c } }).collect();
        let hits = trial.kit.triangle_choice(&queries);
        let weights: Vec<InterpolateQuery> = hits
            .iter()
            .map(|hit| hit.map_or(Vec3::ZERO, |hit| vec3(1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma)))
            .map(|weights| InterpolateQuery {
                weights,
                corners: corners.map(|corner| normals[corner as usize]),
            })
            .collect();
        for ((pixel, hit), normal) in nearest.iter_mut().zip(hits).zip(trial.kit.interpolate(&weights)) {
            if let Some(hit) = hit.filter(|hit| hit.t < pixel.0) {
                *pixel = (hit.t, picture::normal_color(normal.normalize_or_zero()));
            }
        }
    }
    // The outline is about 120 of 4800 pixels long; a ray that only just hits may fall either way.
    let film = picture::develop(nearest.into_iter().map(|(_, color)| color).collect());
    picture::compare("stage2_octahedron", &film, 0.002)
}
