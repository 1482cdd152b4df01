//! Checks of `bounding_sphere` and `enter_bounding_sphere`.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{direction, point, sphere};
use checks::judge::compare;
use checks::paste::{call, list};
use glam::Vec3;
use oracle::exact::{Body, meet};
use proptest::prelude::*;
use raykata::kit::BoundingSphereQuery;
use raykata::ray::Ray;
use raykata::shape::Sphere;

fn clouds() -> impl Strategy<Value = Vec<Vec3>> + Clone {
    prop::collection::vec(point(8), 1..12)
}

pub(super) fn sphere_holds_all_points(trial: &Trial<'_>) -> CheckResult {
    let judge = |points: &Vec<Vec3>, sphere: Sphere| {
        let center = sphere.center.as_dvec3();
        let outside =
            points.iter().find(|point| !(point.as_dvec3().distance(center) <= f64::from(sphere.radius)));
        let Some(outside) = outside else { return Ok(()) };
        let beyond = outside.as_dvec3().distance(center) - f64::from(sphere.radius);
        let diagnosis = if beyond < 1e-5 {
            "your radius is too small by a rounding error: compute it in double and round up"
        } else {
            "your radius is too small: it is the largest distance of a point from the centre"
        };
        Err(Broken::with_texts(
            format!("bounding_sphere(&{})", list(points)),
            format!("radius {:?} around {}, and {outside} lies outside", sphere.radius, sphere.center),
            "a sphere that contains all points",
            "double precision",
        )
        .looks_like(Some(diagnosis)))
    };
    trial.forall(1000, clouds(), |queries| compare(queries, trial.kit.bounding_sphere(queries), judge))?;
    let far = clouds().prop_map(|points| {
        points.into_iter().map(|point| 0.1 * point + Vec3::new(148_376.0, 1_234.0, -223_423.0)).collect()
    });
    trial
        .forall(300, far, |queries: &[Vec<Vec3>]| compare(queries, trial.kit.bounding_sphere(queries), judge))
}

pub(super) fn sphere_is_small(trial: &Trial<'_>) -> CheckResult {
    trial.forall(500, clouds(), |queries| {
        compare(queries, trial.kit.bounding_sphere(queries), |points, sphere| {
            let pairs = points.iter().flat_map(|p| points.iter().map(move |q| p.distance(*q)));
            let widest = pairs.fold(0.0, f32::max);
            // Jung's theorem: if no two points are farther apart than `widest`, the smallest sphere around them has a
            // radius of √(3/8) · widest at most.
            let most = 2.0 * (3.0f32 / 8.0).sqrt() * widest + 1e-5;
            if sphere.radius <= most {
                return Ok(());
            }
            Err(Broken::with_texts(
                format!("bounding_sphere(&{})", list(points)),
                format!("radius {:?}", sphere.radius),
                format!("{most} at most, twice that of the smallest sphere"),
                "Jung's theorem",
            )
            .looks_like(Some(
                "your sphere is too large: use the centre of the points' box, and do not include the origin",
            )))
        })
    })
}

fn judge_entries(trial: &Trial<'_>, queries: &[BoundingSphereQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.enter_bounding_sphere(queries), |query, yours| {
        let BoundingSphereQuery { ray, sphere } = *query;
        let first =
            |radius: f32| meet(&ray, Body::Sphere(Sphere { radius, ..sphere })).and_then(|meeting| meeting.t);
        let starts_inside = |radius: f32| (ray.at(ray.t_min) - sphere.center).length() < radius;
        let near = |t: f32, right: f32| (t - right).abs() <= 1e-4 * right.abs().max(1.0);
        let (smaller, larger) = (0.999 * sphere.radius, 1.001 * sphere.radius);
        let broken = |expected: String, diagnosis: &'static str| {
            let input = call("enter_bounding_sphere", &[&ray, &sphere]);
            Err(Broken::with_texts(input, format!("{yours:?}"), expected, "exact arithmetic")
                .looks_like(Some(diagnosis)))
        };
        if starts_inside(smaller) {
            return match yours {
                Some(t) if t == ray.t_min => Ok(()),
                _ => broken(
                    format!("Some({:?})", ray.t_min),
                    "a ray that starts inside the sphere enters it at t_min",
                ),
            };
        }
        match (first(smaller), first(larger), yours) {
            // The ray passes through the inside: the entry must not be late.
            (Some(_), Some(early), None) => {
                broken(format!("Some({early:?})"), "you return None, but the ray enters the sphere")
            }
            (Some(late), Some(early), Some(t)) => {
                let exact = first(sphere.radius).unwrap_or(late);
                let length = ray.direction.length();
                let other_units = near(t / length, exact) || near(t, exact * length);
                if t > exact {
                    let diagnosis = match () {
                        () if near(t, exact) => {
                            "you are late by a rounding error, and a search would skip a hit at this t: \
                             return a slightly earlier t"
                        }
                        () if other_units => "your t has another unit: it counts lengths of direction",
                        () => "your t is later than the entry, which is the nearer root",
                    };
                    return broken(format!("Some({exact:?}), or a little less"), diagnosis);
                }
                // Accept any answer for a ray whose range ends between the two spheres.
                if t >= ray.t_min && (t >= early || near(t, early) || starts_inside(larger)) {
                    return Ok(());
                }
                let diagnosis = match () {
                    () if t < ray.t_min => "you return a t before t_min: clamp the entry to t_min",
                    () if other_units => "your t has another unit: it counts lengths of direction",
                    () => "your t is much too early: the entry is the nearer root",
                };
                broken(format!("Some({exact:?})"), diagnosis)
            }
            (None, None, Some(_)) if !starts_inside(larger) => broken(
                "None".into(),
                "you return an entry, but the sphere lies beside the ray, behind it or beyond t_max",
            ),
            _ => Ok(()),
        }
    })
}

fn entries(aimed: bool) -> impl Strategy<Value = BoundingSphereQuery> + Clone {
    (point(8), direction(), sphere(), 0..4u32).prop_map(move |(origin, direction, sphere, range)| {
        let to_center = sphere.center - origin;
        let direction = if aimed && to_center != Vec3::ZERO {
            to_center + 0.5 * sphere.radius * direction.normalize()
        } else {
            direction
        };
        let (t_min, t_max) =
            [(0.0, f32::INFINITY), (0.5, f32::INFINITY), (0.0, 0.75), (0.0, 16.0)][range as usize];
        BoundingSphereQuery { ray: Ray::new(origin, direction).with_range(t_min, t_max), sphere }
    })
}

pub(super) fn enter_bounding_sphere_finds_what_is_met(trial: &Trial<'_>) -> CheckResult {
    // S3: the ray starts inside, and the centre lies behind it.
    let facing_away = BoundingSphereQuery {
        ray: Ray::new(Vec3::new(0.5, 0.0, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius: 1.0 },
    };
    judge_entries(trial, &[facing_away]).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, entries(true), |queries| judge_entries(trial, queries))
}

pub(super) fn enter_bounding_sphere_passes_what_is_missed(trial: &Trial<'_>) -> CheckResult {
    let behind = BoundingSphereQuery {
        ray: Ray::new(Vec3::new(5.0, 0.0, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius: 1.0 },
    };
    judge_entries(trial, &[behind]).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, entries(false), |queries| judge_entries(trial, queries))
}
