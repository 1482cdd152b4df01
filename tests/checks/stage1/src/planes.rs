//! Ray-plane intersection, and the normal on the side that the ray comes from.

use crate::roots::T_ABOVE_0;
use crate::sphere_mistakes::{DROPS_NEAR_HITS, EPSILONS};
use checks::double::{self, Expected, LIMITS, compare_tolerant};
use checks::prelude::*;

type Case = (PlaneQuery, Expected);

fn judge_planes(trial: &Trial<'_>, queries: &[PlaneQuery]) -> Vec<CheckResult> {
    let case = |query: &PlaneQuery| (*query, double::plane(&query.ray, &query.plane));
    judge_cases(trial, &queries.iter().map(case).collect::<Vec<_>>(), "double precision")
}

fn judge_cases(trial: &Trial<'_>, cases: &[Case], source: &'static str) -> Vec<CheckResult> {
    let shown = |query: &PlaneQuery, yours| observations(&query.ray, yours);
    compare_tolerant(cases, ("plane", source), |queries| trial.kit.plane(queries), shown, mistakes)
}

/// Mistakes that a wrong answer alone shows.
pub(super) fn observations(ray: &Ray, yours: Option<f32>) -> [(bool, &'static str); 3] {
    [
        "a ray along the plane makes t infinite or NaN, and neither counts: ask ray.contains(t)"
            .when(yours.is_some_and(|t| !t.is_finite())),
        "the range is open: t_min (0 for a ray that starts in the plane) and t_max do not count"
            .when(yours.is_some_and(|t| t == ray.t_min || t == ray.t_max)),
        (yours.is_some_and(|t| !ray.contains(t)), "you return a t that ray.contains(t) refuses"),
    ]
}

/// All known mistakes, each with whether it gives this answer.
fn mistakes(query: &PlaneQuery, yours: Option<f32>, is_right: bool) -> Vec<(bool, &'static str)> {
    let (ray, plane) = (&query.ray, &query.plane);
    let [o, d, p, n] = [ray.origin, ray.direction, plane.point, plane.normal].map(Vec3::as_dvec3);
    let slope = n.dot(d);
    let t = n.dot(p - o) / slope;
    // The rounding errors of t, which are large for a ray that is almost parallel to the plane.
    let line = Ray { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY, ..*ray };
    let relative = match double::plane(&line, plane) {
        Expected::Hit { t, tolerance } if t != 0.0 => 4.0 * tolerance / t.abs(),
        _ => 1e-5,
    };
    // The answer of a method that computes `t` and accepts it in this range.
    let gives = |t: f64, (low, high): (f64, f64)| match yours {
        Some(yours) => f64::from(yours) == t || (f64::from(yours) - t).abs() <= relative * t.abs(),
        None => !(low < t && t < high),
    };
    let range = (f64::from(ray.t_min), f64::from(ray.t_max));
    // The terms of the plane's equation are rounded at the size of the coordinates.
    let of_coordinates = 8.0 * U * n.abs().dot(o.abs() + p.abs()) / slope.abs();
    let mut all = of_tests(ray, t, slope, yours, is_right, &gives);
    all.extend([
        "-(D + n·o) cancels far from the origin; (p0 - o)·n does not".when(
            is_right
                || yours.is_some_and(|t1| ray.contains(t1) && (f64::from(t1) - t).abs() <= of_coordinates)
                || (yours.is_none() && t <= of_coordinates),
        ),
        "you return |t| for a plane behind the ray: keep the signs of (p0 - o)·n and of n·d"
            .when(gives(t.abs(), range)),
        (gives(-t, range), "the sign of t is wrong: compute p0 - o, not o - p0"),
        (
            gives(t / n.length(), range),
            "you normalize the normal in (p0 - o)·n alone: its length cancels in t",
        ),
    ]);
    all
}

/// Wrong tests of the right `t`, for either equation of a plane. `slope` is n·direction, and `gives` tells whether this `t` gives
/// the answer if it counts in this range.
pub(super) fn of_tests(
    ray: &Ray,
    t: f64,
    slope: f64,
    yours: Option<f32>,
    is_right: bool,
    gives: &dyn Fn(f64, (f64, f64)) -> bool,
) -> Vec<(bool, &'static str)> {
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let lost_if = |is_lost: bool| if is_lost { yours.is_none() } else { is_right };
    let in_world_units = gives(t * ray.direction.as_dvec3().length(), (t_min, t_max));
    let mut all = vec![
        (gives(t, (0.0, f64::INFINITY)), T_ABOVE_0),
        (gives(t, (0.0, t_max)), T_ABOVE_0),
        (in_world_units, "your t counts world units; it must count lengths of direction"),
        (lost_if(slope > 0.0), "the plane can be hit from behind, too: do not demand n·direction < 0"),
        (lost_if(slope < 0.0), "the plane can be hit from its front, too: do not demand n·direction > 0"),
    ];
    all.extend(LIMITS.map(|limit| {
        let text = "you compare n·direction with a limit, but a ray is parallel only if it is 0";
        (lost_if(slope.abs() < limit), text)
    }));
    all.extend(EPSILONS.map(|epsilon| (gives(t, (t_min.max(epsilon), t_max)), DROPS_NEAR_HITS)));
    all
}

/// Rays at planes of any place and direction, with normals of any length. Half of the rays are at a chosen angle, so that some are
/// almost parallel to the plane.
pub(super) fn at_planes() -> impl Strategy<Value = PlaneQuery> + Clone {
    let plain =
        (point(8), direction(), point(8), direction()).prop_map(|(origin, direction, point, normal)| {
            PlaneQuery { ray: Ray::new(origin, direction), plane: Plane { point, normal } }
        });
    let slanted = (point(8), point(8), nasty::unit(), nasty::tilt(), any::<bool>()).prop_map(
        |(origin, point, normal, (angle, turn), behind)| {
            let direction = nasty::tilted(if behind { normal } else { -normal }, angle, turn);
            PlaneQuery { ray: Ray::new(origin, direction), plane: Plane { point, normal } }
        },
    );
    prop_oneof![plain, slanted]
}

pub(super) fn plane_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    // Any sizes of the scene, of the direction and of the normal.
    let scales = (nasty::scale(-40..=40), nasty::scale(-40..=40), nasty::scale(-40..=40));
    let sized = (at_planes(), scales).prop_map(|(query, (size, length, of_normal))| {
        let PlaneQuery { ray, plane } = query;
        let ray = Ray { origin: size * ray.origin, direction: length * ray.direction, ..ray };
        PlaneQuery { ray, plane: Plane { point: size * plane.point, normal: of_normal * plane.normal } }
    });
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let down = |x: f32, y: f32| Ray::new(2.0 * Vec3::Y, vec3(x, y, 0.0));
    let on_floor = |ray| PlaneQuery { ray, plane: floor };
    // From both sides, with products of n·d that cancel to 0.00003 of their size.
    let diagonal = Plane { point: Vec3::ONE, normal: vec3(1.0, 1.0, 0.0) };
    let cancels = |x: f32, length: f32| PlaneQuery {
        ray: Ray::new(x * Vec3::X, length * vec3(1.0, -1.0 + 2f32.powi(-14), 0.0)),
        plane: diagonal,
    };
    let drawn = [
        on_floor(down(1.0, -2f32.powi(-14))),
        on_floor(down(0.0, -1.0).with_range(0.0, 1.0)),
        on_floor(down(0.0, -1.0).with_range(3.0, 5.0)),
        on_floor(Ray::new(-2.0 * Vec3::Y, 0.5 * Vec3::Y)),
        on_floor(Ray::new(2.0 * Vec3::Y, Vec3::Y)),
        cancels(0.0, 1024.0),
        cancels(4.0, -1024.0),
    ];
    trial.forall_and(&drawn, 4000, sized, |queries| judge_planes(trial, queries))?;
    trial.forall(500, (point(8), direction(), direction()), |inputs| judge_ends(trial, inputs))
}

/// Asks again with ranges that end exactly at the answer, one float before it and one float behind it.
fn judge_ends(trial: &Trial<'_>, inputs: &[(Vec3, Vec3, Vec3)]) -> Vec<CheckResult> {
    let query = |(origin, direction, normal): &(Vec3, Vec3, Vec3)| PlaneQuery {
        ray: Ray::new(*origin, *direction),
        plane: Plane { point: Vec3::ONE, normal: *normal },
    };
    let queries: Vec<PlaneQuery> = inputs.iter().map(query).collect();
    let judge = |(query, t): (&PlaneQuery, Option<f32>)| {
        let Some(t) = t.filter(|&t| query.ray.contains(t)) else { return Ok(()) };
        let cases = nasty::ranges(t).map(|((t_min, t_max), counts)| {
            let ray = query.ray.with_range(t_min, t_max);
            (PlaneQuery { ray, ..*query }, Expected::exactly(counts.then_some(t)))
        });
        all_hold(judge_cases(trial, &cases, "the t for the infinite ray"))
    };
    queries.iter().zip(trial.kit.plane(&queries)).map(judge).collect()
}

/// Rays along a plane, a plane without a normal, and rays that hit.
pub(super) fn along_planes() -> [(PlaneQuery, Expected); 8] {
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let slanted = Plane { point: vec3(0.0, 1.0, 0.0), normal: vec3(1.0, 2.0, -1.0) };
    let hit = |t| Expected::exactly(Some(t));
    let cases = [
        (Ray::new(Vec3::Y, Vec3::X), plane, Expected::Miss),
        (Ray::new(Vec3::ZERO, Vec3::X), plane, Expected::Miss),
        (Ray::new(Vec3::NEG_Y, Vec3::new(1.0, -0.0, 1.0)), plane, Expected::Miss),
        (Ray::new(Vec3::ONE, vec3(1.0, 1.0, 3.0)), slanted, Expected::Miss),
        (Ray::new(Vec3::ZERO, Vec3::NEG_Y), plane, Expected::Miss),
        (Ray::new(Vec3::Y, Vec3::NEG_Y), Plane { normal: Vec3::ZERO, ..plane }, Expected::Miss),
        (Ray::new(Vec3::Y, Vec3::NEG_Y), plane, hit(1.0)),
        (Ray::new(2.0 * Vec3::NEG_Y, vec3(4.0, 0.5, 0.0)), plane, hit(4.0)),
    ];
    cases.map(|(ray, plane, expected)| (PlaneQuery { ray, plane }, expected))
}

pub(super) fn plane_is_missed_by_rays_along_it(trial: &Trial<'_>) -> CheckResult {
    all_hold(judge_cases(trial, &along_planes(), "the definition"))
}

/// Rays at planes that are far from the origin.
pub(super) fn at_far_planes() -> impl Strategy<Value = PlaneQuery> + Clone {
    (rough_point(4.0), direction(), direction()).prop_map(|(offset, direction, normal)| {
        let point = Vec3::new(148_376.0, 1_234.0, -223_423.0);
        PlaneQuery { ray: Ray::new(point + offset, direction), plane: Plane { point, normal } }
    })
}

pub(super) fn plane_far_from_the_origin(trial: &Trial<'_>) -> CheckResult {
    // -(D + n·o) subtracts two numbers as large as the coordinates; (p0 - o)·n does not.
    trial.forall(2000, at_far_planes(), |queries| judge_planes(trial, queries))
}

pub(super) fn face_forward_turns_the_normal_to_the_ray(trial: &Trial<'_>) -> CheckResult {
    let plain = (direction(), direction());
    let sized = (nasty::unit(), nasty::tilt(), any::<bool>(), nasty::scale(-40..=40), nasty::scale(-40..=40));
    let sized = sized.prop_map(|(normal, (angle, turn), behind, of_normal, length)| {
        let axis = if behind { normal } else { -normal };
        (of_normal * normal, length * nasty::tilted(axis, angle, turn))
    });
    let drawn = [
        (2.0 * Vec3::Z, vec3(1.0, 0.0, 0.5)),
        (Vec3::Y, vec3(1.0, -3.0, 0.0)),
        // Nearly a right angle.
        (Vec3::Z, vec3(1.0, 0.0, 1e-5)),
        (Vec3::X, vec3(1e-3, 2.0, 0.0)),
    ];
    trial.each_and(
        &drawn,
        1500,
        prop_oneof![plain, sized],
        <dyn Kit>::face_forward,
        |(normal, direction), yours| {
            let [n, d] = [normal, direction].map(|v| v.as_dvec3());
            let expected = if n.dot(d) > 0.0 { -*normal } else { *normal };
            // Where the rounding of the dot product decides, and at a right angle, both sides are accepted.
            let open = n.dot(d).abs() <= 4.0 * U * n.abs().dot(d.abs());
            let input = || format!("face_forward({}, {})", normal.paste(), direction.paste());
            let broken = || {
                let along = yours.is_normalized()
                    && (yours.as_dvec3() - expected.as_dvec3().normalize()).length() < 1e-6;
                Broken::new(input(), yours, expected, "the definition").explained_by([
                    (yours == -expected, "your normal points away from the viewer"),
                    (along, "the length of the normal must not change: do not normalize it"),
                ])
            };
            let names = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2].map(|cosine| {
                let given = if n.dot(d) > cosine * n.length() * d.length() { -*normal } else { *normal };
                "you do not turn a normal that is nearly at a right angle to the ray: compare n·d with 0"
                    .when(open || yours == given)
            });
            let as_it_is = "you return the normal as it is, also if it points away from the viewer"
                .when(yours == *normal || (open && yours == -*normal));
            unless(yours == expected || (open && yours == -expected), broken)
                .formulas([as_it_is].into_iter().chain(names))
        },
    )
}
