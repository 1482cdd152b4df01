//! Stage 1: spheres and planes.

use crate::broken::{Broken, Outcome};
use crate::double::{self, Expected};
use crate::generate::{direction, magnitude, point, ray, rough_point, sphere, unit};
use crate::paste::{Arguments, Paste, call};
use crate::{Trial, checks, picture};
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::{Kit, PlaneQuery, RootQuery, SphereQuery};
use raykata::ray::Ray;
use raykata::shape::{Plane, Sphere};

checks! { ($) 1 stage1 [
    nearest_root_is_the_smaller_one_that_counts
    nearest_root_of_nan_is_the_other_one
    sphere_algebraic_agrees_with_double_precision
    sphere_algebraic_starts_inside
    sphere_algebraic_counts_lengths_of_the_direction
    sphere_algebraic_respects_the_range
    sphere_algebraic_far_away_and_tiny
    sphere_algebraic_touches
    sphere_algebraic_leaves_the_surface
    sphere_algebraic_survives_nonsense
    sphere_geometric_agrees_with_double_precision
    sphere_geometric_starts_inside
    sphere_geometric_counts_lengths_of_the_direction
    sphere_geometric_respects_the_range
    sphere_geometric_far_away_and_tiny
    sphere_geometric_touches
    sphere_geometric_leaves_the_surface
    sphere_geometric_survives_nonsense
    sphere_normal_points_outwards
    plane_agrees_with_double_precision
    plane_is_missed_by_rays_along_it
    plane_far_from_the_origin
    face_viewer_turns_the_normal_to_the_ray
    picture_of_a_ball_on_a_plane
] }

// ---- roots ----

fn nearest_root_is_the_smaller_one_that_counts(trial: &Trial<'_>) -> Outcome {
    let root = || (-24..=24i32).prop_map(|eighths| eighths as f32 / 8.0);
    let inputs = (root(), root(), 0..=8i32, 0..=24i32).prop_map(|(first, second, start, length)| {
        let (t_min, length) = (start as f32 / 8.0, length as f32 / 8.0);
        RootQuery {
            roots: [first, second],
            ray: Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min, t_min + length),
        }
    });
    trial.forall(2000, inputs, |queries| {
        compare(queries, trial.kit.nearest_root(queries), |query, yours| {
            let [first, second] = query.roots;
            let counting = [first, second].into_iter().filter(|&t| query.ray.contains(t));
            let expected = counting.reduce(f32::min);
            if yours == expected {
                return Ok(());
            }
            let diagnosis = match (yours, expected) {
                (Some(t), _) if t == query.ray.t_min || t == query.ray.t_max => {
                    "the range is open: its ends do not count"
                }
                (Some(t), _) if !query.ray.contains(t) => "a root that ray.contains(t) refuses",
                (None, Some(_)) if !query.ray.contains(first.min(second)) => {
                    "the smaller root does not count, but the larger one does"
                }
                (Some(_), Some(_)) => "the larger root; they come in any order",
                _ => "",
            };
            Err(Broken::new(query.call("nearest_root"), yours, expected, "the definition")
                .looks_like(known(diagnosis)))
        })
    })
}

fn nearest_root_of_nan_is_the_other_one(trial: &Trial<'_>) -> Outcome {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let cases = [
        ([f32::NAN, f32::NAN], None),
        ([f32::NAN, 2.0], Some(2.0)),
        ([2.0, f32::NAN], Some(2.0)),
        ([f32::NAN, -2.0], None),
        ([f32::INFINITY, f32::NEG_INFINITY], None),
    ];
    let queries = cases.map(|(roots, _)| RootQuery { roots, ray });
    for ((query, yours), (_, expected)) in queries.iter().zip(trial.kit.nearest_root(&queries)).zip(cases) {
        if yours != expected {
            return Err(Broken::new(query.call("nearest_root"), yours, expected, "the definition"));
        }
    }
    Ok(())
}

// ---- spheres ----

/// One of the two ways to intersect a sphere.
#[derive(Clone, Copy)]
struct Method {
    name: &'static str,
    ask: fn(&dyn Kit, &[SphereQuery]) -> Vec<Option<f32>>,
}

const ALGEBRAIC: Method =
    Method { name: "sphere_algebraic", ask: |kit, queries| kit.sphere_algebraic(queries) };
const GEOMETRIC: Method =
    Method { name: "sphere_geometric", ask: |kit, queries| kit.sphere_geometric(queries) };

macro_rules! for_both_methods {
    ($($algebraic:ident $geometric:ident $law:ident;)*) => {
        $(fn $algebraic(trial: &Trial<'_>) -> Outcome {
            $law(trial, ALGEBRAIC)
        }
        fn $geometric(trial: &Trial<'_>) -> Outcome {
            $law(trial, GEOMETRIC)
        })*
    };
}

for_both_methods! {
    sphere_algebraic_agrees_with_double_precision sphere_geometric_agrees_with_double_precision sphere_agrees;
    sphere_algebraic_starts_inside sphere_geometric_starts_inside sphere_from_inside;
    sphere_algebraic_counts_lengths_of_the_direction sphere_geometric_counts_lengths_of_the_direction sphere_scaled;
    sphere_algebraic_respects_the_range sphere_geometric_respects_the_range sphere_in_range;
    sphere_algebraic_far_away_and_tiny sphere_geometric_far_away_and_tiny sphere_far;
    sphere_algebraic_touches sphere_geometric_touches sphere_tangent;
    sphere_algebraic_leaves_the_surface sphere_geometric_leaves_the_surface sphere_on_surface;
    sphere_algebraic_survives_nonsense sphere_geometric_survives_nonsense sphere_nonsense;
}

impl Method {
    /// Judges answers against double precision.
    fn judge(self, trial: &Trial<'_>, queries: &[SphereQuery]) -> Vec<Outcome> {
        compare(queries, (self.ask)(trial.kit, queries), |query, yours| {
            let expected = double::sphere(&query.ray, &query.sphere);
            if expected.accepts(yours) {
                return Ok(());
            }
            let broken = Broken::told(
                query.call(self.name),
                format!("{yours:?}"),
                expected.words(),
                "double precision",
            );
            Err(broken.looks_like(sphere_diagnosis(query, yours, expected)))
        })
    }

    /// Judges answers that are known exactly.
    fn judge_exact(self, trial: &Trial<'_>, cases: &[(SphereQuery, Option<f32>, &str)]) -> Outcome {
        let queries: Vec<SphereQuery> = cases.iter().map(|case| case.0).collect();
        for ((query, expected, diagnosis), yours) in cases.iter().zip((self.ask)(trial.kit, &queries)) {
            if yours != *expected {
                let broken = Broken::new(query.call(self.name), yours, expected, "exact arithmetic");
                return Err(broken.looks_like(known(diagnosis)));
            }
        }
        Ok(())
    }
}

/// The mistake that gives this answer.
fn sphere_diagnosis(query: &SphereQuery, yours: Option<f32>, expected: Expected) -> Option<&'static str> {
    let roots = double::sphere_roots(&query.ray, &query.sphere).ok();
    let length = f64::from(query.ray.dir.length());
    let near = |t: f32, exact: f64, tolerance: f64| {
        (f64::from(t) - exact).abs() <= 4.0 * tolerance + 1e-6 * exact.abs()
    };
    Some(match (yours, expected, roots) {
        (Some(t), _, _) if t.is_nan() => "NaN is no hit: compare so that NaN fails",
        (Some(t), _, _) if t <= query.ray.t_min => {
            "a hit at or behind the start of the ray: ask ray.contains(t)"
        }
        (Some(t), _, _) if t >= query.ray.t_max => {
            "a hit at or beyond the end of the ray: ask ray.contains(t)"
        }
        (Some(t), Expected::Hit { t: exact, .. }, Some(roots))
            if exact < roots.far && near(t, roots.far, roots.tolerance) =>
        {
            "your t equals the far root"
        }
        (Some(t), Expected::Hit { t: exact, .. }, Some(roots))
            if (length - 1.0).abs() > 1e-3 && near(t, exact * length, roots.tolerance) =>
        {
            "your t counts world units; it must count lengths of dir (is dir taken for a unit vector?)"
        }
        (Some(t), _, Some(roots)) if near(t, 0.5 * (roots.near + roots.far), roots.tolerance) => {
            "your t is the point nearest to the centre: half the chord is missing"
        }
        (None, Expected::Hit { .. }, Some(roots)) if roots.near < 0.0 => {
            "the ray starts inside: the near root is behind it, and the far one counts (t_ca < 0 is no miss)"
        }
        (_, Expected::Hit { .. }, _)
            if f64::from((query.ray.origin - query.sphere.center).length())
                > 100.0 * f64::from(query.sphere.radius) =>
        {
            "a far, small sphere: b² - a c (or L·L - t_ca²) cancels; use r² - |f⊥|²"
        }
        (Some(_), Expected::Hit { .. }, Some(_)) if (length - 1.0).abs() > 1e-3 => {
            "dir is not of unit length here: is a = d·d left out?"
        }
        (Some(_), Expected::Miss, _) => "a hit where the ray passes by",
        _ => return None,
    })
}

fn sphere_agrees(trial: &Trial<'_>, method: Method) -> Outcome {
    let inputs = (ray(), sphere(), any::<bool>()).prop_map(|(ray, sphere, aim)| {
        // Half of the rays are aimed at the sphere, or hardly any would hit it.
        let to_center = sphere.center - ray.origin;
        let dir = if aim && to_center != Vec3::ZERO {
            (to_center.normalize() + 0.1 * ray.dir).normalize()
        } else {
            ray.dir
        };
        SphereQuery { ray: Ray::new(ray.origin, dir), sphere }
    });
    trial.forall(4000, inputs, |queries| method.judge(trial, queries))
}

fn sphere_from_inside(trial: &Trial<'_>, method: Method) -> Outcome {
    let inputs = (sphere(), unit(), unit(), 0..=7i32).prop_map(|(sphere, dir, out, eighths)| {
        let origin = sphere.center + 0.9 * sphere.radius * eighths as f32 / 8.0 * out;
        SphereQuery { ray: Ray::new(origin, dir), sphere }
    });
    trial.forall(2000, inputs, |queries| method.judge(trial, queries))
}

fn sphere_scaled(trial: &Trial<'_>, method: Method) -> Outcome {
    let inputs = (point(8), direction(), sphere())
        .prop_map(|(origin, dir, sphere)| SphereQuery { ray: Ray::new(origin, dir), sphere });
    trial.forall(2000, inputs.clone(), |queries| method.judge(trial, queries))?;

    // A direction twice as long makes t half as large, to the last bit: powers of two change no rounding.
    trial.forall(500, inputs, |queries| {
        let longer = |query: &SphereQuery| SphereQuery {
            ray: Ray::new(query.ray.origin, 1024.0 * query.ray.dir),
            ..*query
        };
        let answers = (method.ask)(trial.kit, queries);
        let queries: Vec<SphereQuery> = queries.iter().map(longer).collect();
        let scaled = (method.ask)(trial.kit, &queries);
        let pairs: Vec<_> = answers.into_iter().zip(scaled).collect();
        compare(&queries, pairs, |query, (answer, scaled)| match answer.map(|t| t / 1024.0) == scaled {
            true => Ok(()),
            false => Err(Broken::new(
                query.call(method.name),
                scaled,
                answer.map(|t| t / 1024.0),
                "1/1024 of the t for dir / 1024",
            )),
        })
    })
}

fn sphere_in_range(trial: &Trial<'_>, method: Method) -> Outcome {
    let query = |t_min, t_max| SphereQuery {
        ray: Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X).with_range(t_min, t_max),
        sphere: Sphere { center: Vec3::ZERO, radius: 1.0 },
    };
    let behind = SphereQuery { ray: Ray::new(Vec3::new(5.0, 0.0, 0.0), Vec3::X), ..query(0.0, 1.0) };
    method.judge_exact(
        trial,
        &[
            (behind, None, "the sphere is behind the ray: a negative t does not count"),
            (query(0.0, f32::INFINITY), Some(4.0), ""),
            (query(4.5, f32::INFINITY), Some(6.0), "the near root lies before t_min, but the far one counts"),
            (query(0.0, 3.5), None, "the hit lies beyond t_max"),
            (query(4.0, f32::INFINITY), Some(6.0), "the range is open: a hit at t_min does not count"),
            (query(0.0, 4.0), None, "the range is open: a hit at t_max does not count"),
            (query(4.5, 5.5), None, "both roots lie outside of the range"),
            (query(6.5, f32::INFINITY), None, "both roots lie before t_min"),
        ],
    )
}

/// S2, S4: a unit sphere up to 100,000 away, and a sphere of a thousandth at 100. Each ray is aimed at the sphere.
fn sphere_far(trial: &Trial<'_>, method: Method) -> Outcome {
    let inputs = (unit(), rough_point(0.55), magnitude(1.0, 5.0), magnitude(-3.0, 0.0)).prop_map(
        |(away, at, distance, radius)| {
            let origin = distance * away;
            SphereQuery {
                ray: Ray::new(origin, (radius * at - origin).normalize()),
                sphere: Sphere { center: Vec3::ZERO, radius },
            }
        },
    );
    trial.forall(4000, inputs, |queries| method.judge(trial, queries))?;
    // S6: from 100 above a ground of radius 100,000 no formula in single precision keeps all digits, but the error
    // must stay within the rounding of the inputs.
    let ground = (rough_point(100.0), unit()).prop_map(|(origin, dir)| {
        let origin = origin + Vec3::new(0.0, 110.0, 0.0);
        let dir = Vec3::new(dir.x, -dir.y.abs() - 0.2, dir.z).normalize();
        SphereQuery {
            ray: Ray::new(origin, dir),
            sphere: Sphere { center: Vec3::new(0.0, -1e5, 0.0), radius: 1e5 },
        }
    });
    trial.forall(1000, ground, |queries| method.judge(trial, queries))
}

fn sphere_tangent(trial: &Trial<'_>, method: Method) -> Outcome {
    let at_height = |y: f32| SphereQuery {
        ray: Ray::new(Vec3::new(-5.0, y, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius: 1.0 },
    };
    method.judge_exact(
        trial,
        &[(
            at_height(1.0),
            Some(5.0),
            "the ray touches the sphere: the discriminant is exactly 0, and that is a hit",
        )],
    )?;
    // One step higher misses, one step lower hits, and neither may make NaN.
    let (above, below) = (at_height(1.0f32.next_up()), at_height(1.0f32.next_down()));
    for (query, yours) in [above, below].iter().zip((method.ask)(trial.kit, &[above, below])) {
        // A step of height moves the root by sqrt(2u): 3.5e-4 to either side of 5.
        if yours.is_some_and(|t| !((t - 5.0).abs() < 1e-3)) {
            return Err(Broken::told(
                query.call(method.name),
                format!("{yours:?}"),
                "None, or 5 ± 0.001",
                "closed form",
            ));
        }
    }
    Ok(())
}

fn sphere_on_surface(trial: &Trial<'_>, method: Method) -> Outcome {
    // Points exactly on the sphere: leaving it outwards meets nothing, crossing it meets the other side.
    let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let from = |origin: Vec3, dir: Vec3| SphereQuery { ray: Ray::new(origin, dir), sphere };
    method.judge_exact(
        trial,
        &[
            (
                from(Vec3::X, Vec3::X),
                None,
                "the ray starts on the sphere and leaves it: t = 0 does not count",
            ),
            (
                from(Vec3::NEG_Y, Vec3::NEG_Y),
                None,
                "the ray starts on the sphere and leaves it: t = 0 does not count",
            ),
            (
                from(Vec3::X, Vec3::Y),
                None,
                "the ray starts on the sphere and runs along it: t = 0 does not count",
            ),
            (from(Vec3::X, Vec3::NEG_X), Some(2.0), "the ray starts on the sphere and crosses it"),
            (from(Vec3::NEG_Z, Vec3::Z), Some(2.0), "the ray starts on the sphere and crosses it"),
        ],
    )
}

fn sphere_nonsense(trial: &Trial<'_>, method: Method) -> Outcome {
    let ray = Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X);
    let unit = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let nothing = "such a sphere or ray cannot be hit; compare so that NaN fails";
    method.judge_exact(
        trial,
        &[
            (SphereQuery { ray, sphere: Sphere { radius: 0.0, ..unit } }, None, nothing),
            (SphereQuery { ray, sphere: Sphere { radius: f32::NAN, ..unit } }, None, nothing),
            (SphereQuery { ray, sphere: Sphere { center: Vec3::NAN, ..unit } }, None, nothing),
            (SphereQuery { ray: Ray { dir: Vec3::NAN, ..ray }, sphere: unit }, None, nothing),
            (SphereQuery { ray: Ray { dir: Vec3::ZERO, ..ray }, sphere: unit }, None, nothing),
            (SphereQuery { ray: Ray { origin: Vec3::INFINITY, ..ray }, sphere: unit }, None, nothing),
        ],
    )
}

fn sphere_normal_points_outwards(trial: &Trial<'_>) -> Outcome {
    let inputs =
        (sphere(), unit()).prop_map(|(sphere, out)| (sphere, sphere.center + sphere.radius * out, out));
    trial.forall(1000, inputs, |cases| {
        let queries: Vec<_> = cases.iter().map(|(sphere, point, _)| (*sphere, *point)).collect();
        compare(cases, trial.kit.sphere_normal(&queries), |(sphere, point, out), yours| {
            // The point is rounded at the size of centre plus radius; seen from the centre that turns the normal.
            let tolerance = 8.0 * f32::EPSILON * (1.0 + sphere.center.length() / sphere.radius);
            let right = (yours - *out).length() <= tolerance
                && (yours.length() - 1.0).abs() <= 4.0 * f32::EPSILON + tolerance;
            let diagnosis = match () {
                () if (yours + *out).length() <= tolerance => "the normal points inwards",
                () if (yours.normalize_or_zero() - *out).length() <= tolerance => {
                    "the normal is not of unit length"
                }
                () => "",
            };
            let input = call("sphere_normal", &[&sphere.center, point]);
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, out, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}

// ---- planes ----

fn judge_planes(trial: &Trial<'_>, queries: &[PlaneQuery]) -> Vec<Outcome> {
    compare(queries, trial.kit.plane(queries), |query, yours| {
        let expected = double::plane(&query.ray, &query.plane);
        if expected.accepts(yours) {
            return Ok(());
        }
        let length = query.ray.dir.length();
        let diagnosis = match (yours, expected) {
            (Some(t), _) if t.is_nan() => "NaN is no hit: compare so that NaN fails",
            (Some(t), _) if !query.ray.contains(t) => "a t that ray.contains(t) refuses",
            (Some(t), Expected::Hit { t: exact, .. }) if f64::from(t) * exact < 0.0 => {
                "the sign of t is wrong"
            }
            (Some(t), Expected::Hit { t: exact, tolerance })
                if (f64::from(t / length) - exact).abs() <= tolerance =>
            {
                "your t counts world units; it must count lengths of dir"
            }
            (None, Expected::Hit { .. }) if query.ray.dir.dot(query.plane.normal) > 0.0 => {
                "the plane can be hit from behind, too"
            }
            _ => "",
        };
        let broken =
            Broken::told(query.call("plane"), format!("{yours:?}"), expected.words(), "double precision");
        Err(broken.looks_like(known(diagnosis)))
    })
}

fn plane_agrees_with_double_precision(trial: &Trial<'_>) -> Outcome {
    let inputs = (point(8), direction(), point(8), direction()).prop_map(|(origin, dir, point, normal)| {
        PlaneQuery { ray: Ray::new(origin, dir), plane: Plane { point, normal } }
    });
    trial.forall(4000, inputs, |queries| judge_planes(trial, queries))?;
    let short = PlaneQuery {
        ray: Ray::new(Vec3::new(0.0, 2.0, 0.0), Vec3::NEG_Y).with_range(0.0, 1.0),
        plane: Plane { point: Vec3::ZERO, normal: Vec3::Y },
    };
    judge_planes(trial, &[short]).into_iter().collect()
}

fn plane_is_missed_by_rays_along_it(trial: &Trial<'_>) -> Outcome {
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let cases = [
        (Ray::new(Vec3::Y, Vec3::X), plane),
        (Ray::new(Vec3::ZERO, Vec3::X), plane),
        (Ray::new(Vec3::NEG_Y, Vec3::new(1.0, -0.0, 1.0)), plane),
        (Ray::new(Vec3::ZERO, Vec3::NEG_Y), plane),
        (Ray::new(Vec3::Y, Vec3::NAN), plane),
        (Ray::new(Vec3::Y, Vec3::NEG_Y), Plane { normal: Vec3::ZERO, ..plane }),
    ];
    let queries = cases.map(|(ray, plane)| PlaneQuery { ray, plane });
    for (query, yours) in queries.iter().zip(trial.kit.plane(&queries)) {
        if yours.is_some() {
            let diagnosis =
                "n·d = 0 makes t infinite or NaN, and a start in the plane makes t = 0: none of them counts";
            return Err(Broken::told(query.call("plane"), format!("{yours:?}"), "None", "the definition")
                .looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}

fn plane_far_from_the_origin(trial: &Trial<'_>) -> Outcome {
    // T12: -(D + n·o) subtracts two numbers of the size of the coordinates; (p0 - o)·n does not.
    let inputs = (rough_point(4.0), direction(), direction()).prop_map(|(offset, dir, normal)| {
        let point = Vec3::new(148_376.0, 1_234.0, -223_423.0);
        PlaneQuery { ray: Ray::new(point + offset, dir), plane: Plane { point, normal } }
    });
    let cancels = "-(D + n·o) cancels far from the origin; (p0 - o)·n does not";
    trial
        .forall(2000, inputs, |queries| judge_planes(trial, queries))
        .map_err(|broken| if broken.diagnosis.is_some() { broken } else { broken.looks_like(Some(cancels)) })
}

fn face_viewer_turns_the_normal_to_the_ray(trial: &Trial<'_>) -> Outcome {
    trial.forall(1000, (direction(), direction()), |queries| {
        compare(queries, trial.kit.face_viewer(queries), |(normal, dir), yours| {
            let expected = if normal.dot(*dir) > 0.0 { -*normal } else { *normal };
            // At a right angle either side will do.
            let right = yours == expected || (normal.dot(*dir) == 0.0 && yours == -expected);
            let diagnosis = (yours == -expected).then_some("the normal points away from the viewer");
            let input = format!("face_viewer({}, {})", normal.paste(), dir.paste());
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "the definition").looks_like(diagnosis))
            }
        })
    })
}

fn picture_of_a_ball_on_a_plane(trial: &Trial<'_>) -> Outcome {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let ball = Sphere { center: Vec3::Y, radius: 1.0 };
    let rays = picture::rays(Vec3::new(2.0, 2.5, 5.0), 0.8 * Vec3::Y);
    let on_floor =
        trial.kit.plane(&rays.iter().map(|&ray| PlaneQuery { ray, plane: floor }).collect::<Vec<_>>());
    let to_ball: Vec<SphereQuery> = rays.iter().map(|&ray| SphereQuery { ray, sphere: ball }).collect();
    let on_ball = trial.kit.sphere_geometric(&to_ball);
    let points: Vec<(Sphere, Vec3)> =
        rays.iter().zip(&on_ball).map(|(ray, t)| (ball, ray.at(t.unwrap_or(0.0)))).collect();
    let outwards = trial.kit.sphere_normal(&points);
    let normals: Vec<(Vec3, Vec3)> = rays
        .iter()
        .zip(&on_ball)
        .zip(outwards)
        .map(|((ray, t), out)| (t.map_or(Vec3::Y, |_| out), ray.dir))
        .collect();
    let facing = trial.kit.face_viewer(&normals);
    // The ball hides the floor wherever both are hit: it stands between the floor and the eye.
    let hit = on_floor.iter().zip(&on_ball).map(|(floor, ball)| floor.is_some() || ball.is_some());
    let colors =
        hit.zip(facing).map(|(hit, normal)| if hit { picture::normal_color(normal) } else { Vec3::ZERO });
    // The outline of the ball crosses about 60 of 4800 pixels, and a ray that only just hits may fall either way.
    picture::compare("stage1_ball_on_a_plane", &picture::develop(colors.collect()), 0.001)
}

// ---- helpers ----

/// A diagnosis that is not empty.
pub(crate) fn known(diagnosis: &str) -> Option<&str> {
    (!diagnosis.is_empty()).then_some(diagnosis)
}

/// Judges each answer with its query.
pub(crate) fn compare<Q, A>(
    queries: &[Q],
    answers: Vec<A>,
    judge: impl Fn(&Q, A) -> Outcome,
) -> Vec<Outcome> {
    queries.iter().zip(answers).map(|(query, answer)| judge(query, answer)).collect()
}
