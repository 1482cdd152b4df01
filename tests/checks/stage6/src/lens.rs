//! Rays through a thin lens.

use super::pixels::unit_number;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::paste::{Paste, call};
use checks::statistics::{SAMPLES, columns, covers_evenly, has_mean, pairs};
use glam::{DVec3, Vec2, Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::camera::{Camera, Lens};
use raykata::kit::LensQuery;
use raykata::ray::Ray;

/// The squared distance of a point of the unit disk from the centre, and its angle as a fraction of a full turn.
pub(super) fn polar(place: Vec2) -> (f64, f64) {
    let (x, y) = (f64::from(place.x), f64::from(place.y));
    (x * x + y * y, y.atan2(x) / std::f64::consts::TAU + 0.5)
}

/// What is wrong with a distribution on a disk, by the counts in rings of equal area from the centre outwards.
pub(super) fn uneven_disk(counts: &[u64]) -> &'static str {
    let rings = columns(counts);
    if rings[7] == 0 {
        "you fill only the inner part of the disk: points must reach up to its radius"
    } else if rings[0] > 2 * rings[7] {
        "too many points near the centre: use √u as the radius, because area grows with its square"
    } else if rings[7] > 2 * rings[0] {
        "too many points near the rim"
    } else {
        ""
    }
}

pub(super) fn places_on_the_disk_are_even(trial: &Trial<'_>) -> CheckResult {
    let u = pairs(trial.seed, SAMPLES);
    let places = trial.kit.sample_disk(&u);
    for (u, place) in u.iter().zip(&places) {
        // The tolerance covers a few roundings of a radius of 1.
        if !(place.length() <= 1.0 + 1e-6) {
            let broken =
                Broken::new(call("sample_disk", &[u]), place, "a length of 1 at most", "the definition");
            return Err(broken.looks_like(Some(
                "your point is outside the disk: the corners of the square are outside it",
            )));
        }
    }
    let polar: Vec<(f64, f64)> = places.iter().map(|place| polar(*place)).collect();
    covers_evenly("sample_disk(u)", &polar, ["radius²", "angle"], uneven_disk)?;
    let radii: Vec<f64> = polar.iter().map(|(squared, _)| squared.sqrt()).collect();
    has_mean("the length of sample_disk(u)", &radii, 2.0 / 3.0, "")
}

pub(super) fn places_on_the_disk_are_places(trial: &Trial<'_>) -> CheckResult {
    let numbers = (unit_number(), unit_number()).prop_map(|(x, y)| vec2(x, y));
    // Formulas divide by 0 at the middle of the square and on its diagonals.
    let corners = [0.0, 0.25, 0.5, 0.75].map(|x| [vec2(x, x), vec2(x, 1.0 - x), vec2(0.5, x), vec2(x, 0.5)]);
    let judge = |queries: &[Vec2]| {
        compare(queries, trial.kit.sample_disk(queries), |u, yours| {
            if yours.length() <= 1.0 + 1e-6 {
                return Ok(());
            }
            let nan = yours
                .is_nan()
                .then_some("you divide 0 by 0 for the middle of the square: return (0, 0) there");
            Err(Broken::new(call("sample_disk", &[u]), yours, "a length of 1 at most", "the definition")
                .looks_like(nan))
        })
    };
    judge(corners.as_flattened()).into_iter().collect::<CheckResult>()?;
    trial.forall(1000, numbers, judge)
}

fn camera(position: Vec3) -> Camera {
    let camera = Camera::new(position, vec3(0.6, -0.48, -0.64), Vec3::Y, 60.0, 1.5);
    camera.expect("the view direction is not parallel to up")
}

/// Lens rays for any point of the film of a camera at `position`.
fn lens_query(position: Vec3) -> impl Strategy<Value = LensQuery> + Clone {
    let place = || (-8..=8i32).prop_map(|eighths| eighths as f32 / 8.0);
    let on_lens = (place(), place()).prop_map(|(x, y)| vec2(x, y).clamp_length_max(1.0));
    ((0..=16i32, 0..=16i32), on_lens, (0..=8i32), (1..=40i32)).prop_map(
        move |((x, y), on_lens, aperture, distance)| {
            let camera = camera(position);
            LensQuery {
                camera,
                pinhole: camera.ray(x as f32 / 16.0, y as f32 / 16.0),
                lens: Lens { aperture: aperture as f32 / 8.0, focal_distance: distance as f32 / 2.0 },
                on_lens,
            }
        },
    )
}

fn paste(query: &LensQuery) -> String {
    let Camera { position, towards, .. } = &query.camera;
    let camera = format!(
        "let camera = Camera::new({}, {}, Vec3::Y, 60.0, 1.5).unwrap();",
        position.paste(),
        towards.paste()
    );
    let lens = format!(
        "Lens {{ aperture: {}, focal_distance: {} }}",
        query.lens.aperture.paste(),
        query.lens.focal_distance.paste()
    );
    format!("{camera}\nlens_ray(&camera, {}, &{lens}, {})", query.pinhole.paste(), query.on_lens.paste())
}

pub(super) fn lens_without_width_is_a_pinhole(trial: &Trial<'_>) -> CheckResult {
    let queries = lens_query(vec3(1.0, 2.0, 3.0)).prop_map(|query| match query.on_lens.x > 0.0 {
        true => LensQuery { lens: Lens { aperture: 0.0, ..query.lens }, ..query },
        false => LensQuery { on_lens: Vec2::ZERO, ..query },
    });
    trial.forall(500, queries, |queries| {
        compare(queries, trial.kit.lens_ray(queries), |query, yours| {
            if yours == query.pinhole {
                return Ok(());
            }
            let near = (yours.direction - query.pinhole.direction).length() < 1e-5
                && yours.origin == query.pinhole.origin;
            let diagnosis = match () {
                () if near => "you recompute the direction, which adds a rounding error: return *pinhole",
                () if yours.direction.is_nan() => "you return NaN",
                () => "",
            };
            Err(Broken::new(paste(query), yours, query.pinhole, "the pinhole ray, bit for bit")
                .looks_like(known(diagnosis)))
        })
    })
}

/// Where a ray meets the focal plane, relative to the camera, in double precision.
fn in_focus(query: &LensQuery, ray: &Ray) -> DVec3 {
    let towards = query.camera.towards.as_dvec3();
    let start = ray.origin.as_dvec3() - query.camera.position.as_dvec3();
    let direction = ray.direction.as_dvec3();
    start + (f64::from(query.lens.focal_distance) - start.dot(towards)) / direction.dot(towards) * direction
}

pub(super) fn focal_plane_is_sharp(trial: &Trial<'_>) -> CheckResult {
    let judge = |queries: &[LensQuery]| {
        compare(queries, trial.kit.lens_ray(queries), |query, yours| {
            let (expected, found) = (in_focus(query, &query.pinhole), in_focus(query, &yours));
            // The tolerance covers a few roundings of the direction, relative to the distance. A wide lens enlarges
            // them.
            let off = (found - expected).length() / expected.length();
            if off < 1e-5 {
                return Ok(());
            }
            let distance = f64::from(query.lens.focal_distance);
            let [direction, towards] = [query.pinhole.direction, query.camera.towards].map(Vec3::as_dvec3);
            let start = yours.origin.as_dvec3() - query.camera.position.as_dvec3();
            let aims =
                |way: DVec3| (yours.direction.as_dvec3().normalize() - way.normalize()).length() < 1e-5;
            let diagnosis = match () {
                () if yours.is_nan_anywhere() => "you return NaN",
                () if aims(distance * direction - start) => {
                    "you go focal_distance along the ray: divide it by the cosine with camera.towards"
                }
                () if aims(distance * direction.dot(towards) * direction - start) => {
                    "you multiply focal_distance by the cosine with camera.towards: divide by it"
                }
                () if aims(distance * towards - start) => {
                    "you aim every ray at the centre of the focal plane: aim where its pinhole ray meets it"
                }
                () if aims(expected + start) => "you add the offset to the focus: subtract it",
                () if aims(direction) => {
                    "your ray is parallel to the pinhole ray: aim where that meets the focal plane"
                }
                () => "",
            };
            Err(Broken::with_texts(
                paste(query),
                format!("a ray that misses by {:.2e}", (found - expected).length()),
                format!("a ray through camera.position + {:?}", expected.as_vec3()),
                "the focal plane",
            )
            .looks_like(known(diagnosis)))
        })
    };
    judge(&[drawn()]).into_iter().collect::<CheckResult>()?;
    trial.forall(2000, lens_query(vec3(1.0, 2.0, 3.0)), judge)
}

/// A ray far from the axis, from a point far from the centre of a wide lens, where all known mistakes give different
/// rays.
fn drawn() -> LensQuery {
    let camera = camera(vec3(1.0, 2.0, 3.0));
    LensQuery {
        camera,
        pinhole: camera.ray(0.25, 0.125),
        lens: Lens { aperture: 0.5, focal_distance: 3.0 },
        on_lens: vec2(0.5, -0.75),
    }
}

trait NanAnywhere {
    fn is_nan_anywhere(&self) -> bool;
}

impl NanAnywhere for Ray {
    fn is_nan_anywhere(&self) -> bool {
        self.origin.is_nan() || self.direction.is_nan()
    }
}

pub(super) fn lens_rays_start_on_the_lens(trial: &Trial<'_>) -> CheckResult {
    let judge = |queries: &[LensQuery]| {
        compare(queries, trial.kit.lens_ray(queries), |query, yours| {
            let camera = &query.camera;
            let place = 0.5 * query.lens.aperture * query.on_lens;
            let expected = camera.position + place.x * camera.right + place.y * camera.up;
            // The tolerance covers two roundings of coordinates up to 4.
            let near = |v: Vec3| (yours.origin - v).length() < 2e-6;
            let unit = (yours.direction.length() - 1.0).abs() < 1e-5;
            if near(expected) && unit {
                return Ok(());
            }
            let double = camera.position + 2.0 * (expected - camera.position);
            let diagnosis = match () {
                () if !unit => "your direction does not have unit length",
                () if near(double) => "you use aperture as the radius of the lens: it is the diameter",
                () if near(camera.position) => "you start every ray at the centre of the lens: use on_lens",
                () if near(camera.position + place.x * camera.right)
                    || near(camera.position + place.y * camera.up) =>
                {
                    "your lens is a line: it extends along camera.right and along camera.up"
                }
                () if near(camera.position + place.extend(0.0)) => {
                    "you use the world's x and y axes: use camera.right and camera.up"
                }
                () => "",
            };
            Err(Broken::new(
                paste(query),
                yours,
                expected,
                "position + aperture / 2 · on_lens, along right and up",
            )
            .looks_like(known(diagnosis)))
        })
    };
    judge(&[drawn()]).into_iter().collect::<CheckResult>()?;
    trial.forall(1000, lens_query(vec3(1.0, 2.0, 3.0)), judge)
}

pub(super) fn lens_is_as_sharp_a_million_units_away(trial: &Trial<'_>) -> CheckResult {
    // Near a million f32 numbers are 1/16 apart: the origin is rounded, but the direction can be precise.
    trial.forall(1000, lens_query(vec3(1e6, -1e6, 1e6)), |queries| {
        compare(queries, trial.kit.lens_ray(queries), |query, yours| {
            let camera = &query.camera;
            let place = 0.5 * query.lens.aperture * query.on_lens;
            let offset = (place.x * camera.right + place.y * camera.up).as_dvec3();
            let focus = in_focus(query, &query.pinhole);
            let expected = (focus - offset).normalize();
            // The tolerance covers a few roundings of the direction.
            if (yours.direction.as_dvec3() - expected).length() < 2e-6 {
                return Ok(());
            }
            let broken = Broken::new(paste(query), yours.direction, expected.as_vec3(), "double precision");
            Err(broken
                .looks_like(Some("your direction is imprecise: compute it relative to camera.position")))
        })
    })
}
