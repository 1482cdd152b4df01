//! Rays through a thin lens.

use super::pixels::unit_number;
use checks::prelude::*;
use checks::statistics::{
    Mistakes, SAMPLES, columns, covers_each_part, is_of_one_number, is_other_power, pairs,
};
use raykata::camera::{Camera, Lens};

/// The squared distance of a point of the unit disk from the centre, and its angle as a fraction of a full turn.
pub(super) fn polar(place: Vec2) -> (f64, f64) {
    let (x, y) = (f64::from(place.x), f64::from(place.y));
    (x * x + y * y, y.atan2(x) / std::f64::consts::TAU + 0.5)
}

/// Wrong polar coordinates that reproduce all points of the unit disk: which radius and angle they have.
pub(super) fn is_polar(u: &[Vec2], places: &[Vec2]) -> Mistakes {
    let radius_is = |radius: fn(f64) -> f64| {
        is_of_one_number(u, places.iter(), |u, place| (f64::from(place.length()) - radius(u)).abs() < 1e-3)
    };
    vec![
        "too many points near the centre: your radius is u; use √u, because area grows with its square"
            .when(radius_is(|u| u)),
        "your points keep their angle in the square: the concentric map turns them, φ = π/4 · b/a in each quarter"
            .when(u.iter().zip(places).all(|(u, place)| {
                let at = 2.0 * *u - 1.0;
                let by_angle = at.abs().max_element() * at.normalize_or_zero();
                let elliptic = at * (Vec2::ONE - 0.5 * vec2(at.y, at.x).powf(2.0)).map(f32::sqrt);
                (*place - by_angle).length() < 1e-3 || (*place - elliptic).length() < 1e-3
            })),
        (radius_is(|u| u * u), "too many points near the centre: your radius is u²; use √u"),
        (radius_is(f64::cbrt), "too many points near the rim: your radius is ∛u, as in a sphere; use √u"),
        (radius_is(|_| 1.0), "too many points near the rim: all of your points are on it"),
        "your radius is another power of a random number: use √u"
            .when(is_other_power(u, &places.iter().map(|place| f64::from(place.length())).collect::<Vec<_>>(), 0.5)),
    ]
}

/// What is wrong with a distribution on a disk: the mistakes that reproduce the points, then what the counts show in rings of
/// equal area from the centre outwards.
pub(super) fn uneven_disk(counts: &[u64], reproduced: Mistakes) -> Mistakes {
    let rings = columns(counts);
    let shown = [
        (rings[7] == 0, "you fill only the inner part of the disk: points must reach up to its radius"),
        (rings[0] > 2 * rings[7], "too many points near the centre"),
        (rings[7] > 2 * rings[0], "too many points near the rim"),
    ];
    reproduced.into_iter().chain(shown).collect()
}

const IN_THE_SQUARE: &str =
    "your point is in the square around the disk: the corners of the square are outside it";

pub(super) fn places_on_the_disk_are_even(trial: &Trial<'_>) -> CheckResult {
    let u = pairs(trial.seed, SAMPLES);
    let places = trial.kit.sample_disk(&u);
    let judge = |(u, place): (&Vec2, &Vec2)| {
        // The tolerance covers a few roundings.
        if place.length() <= 1.0 + 1e-6 {
            return Ok(());
        }
        let is = |wrong: Vec2| (*place - wrong).length() < 1e-5;
        let broken = Broken::new(call("sample_disk", &[u]), place, "a length of 1 at most", "the definition");
        Err(broken.explained_by([
            (is(2.0 * *u - 1.0), IN_THE_SQUARE),
            (is(*u), IN_THE_SQUARE),
            (place.is_nan(), "you return NaN"),
            (!place.is_nan(), "your point is outside the disk"),
        ]))
    };
    all_hold(u.iter().zip(&places).map(judge).collect())?;
    let shares = |u: &[Vec2]| Ok(trial.kit.sample_disk(u).into_iter().map(polar).collect());
    covers_each_part("sample_disk(u)", ["radius²", "angle"], trial.seed, None, shares, |counts| {
        uneven_disk(counts, is_polar(&u, &places))
    })
}

pub(super) fn places_on_the_disk_are_places(trial: &Trial<'_>) -> CheckResult {
    let numbers = (unit_number(), unit_number()).prop_map(|(x, y)| vec2(x, y));
    // Formulas divide by 0 at the middle of the square and on its diagonals.
    let chosen: Vec<Vec2> = [0.0, 0.25, 0.5, 0.75]
        .into_iter()
        .flat_map(|x| [vec2(x, x), vec2(x, 1.0 - x), vec2(0.5, x), vec2(x, 0.5)])
        .filter(|u| u.max_element() < 1.0)
        .collect();
    trial.each_and(&chosen, 1000, numbers, <dyn Kit>::sample_disk, |u, yours| {
        // The tolerance covers a few roundings.
        if yours.length() <= 1.0 + 1e-6 {
            return Ok(());
        }
        let middle = *u == Vec2::splat(0.5);
        Err(Broken::new(call("sample_disk", &[u]), yours, "a length of 1 at most", "the definition")
            .explained_by(named![
                middle && yours.is_nan() => "you divide 0 by 0 for the middle of the square: return (0, 0) there",
                yours.is_nan() => "you return NaN",
                !yours.is_nan() => "your point is outside the disk",
            ]))
    })?;
    // Another check judges the distribution. Here points must only reach all four quarters of the disk.
    let places = trial.kit.sample_disk(&pairs(trial.seed, 256));
    for signs in [vec2(1.0, 1.0), vec2(-1.0, 1.0), vec2(-1.0, -1.0), vec2(1.0, -1.0)] {
        if !places.iter().any(|place| (*place * signs).min_element() > 0.0) {
            let expected = "points in all four quarters of the disk";
            let yours = format!("no point with signs {signs}");
            return Err(Broken::with_texts("sample_disk for 256 pairs u", yours, expected, "the definition"));
        }
    }
    Ok(())
}

/// Cameras at `position` in all orientations, with different angles of view.
fn camera(position: Vec3) -> impl Strategy<Value = Camera> + Clone {
    (nasty::unit(), nasty::unit(), 2..=9i32).prop_filter_map(
        "a view that is not along up",
        move |(view, up, tens)| {
            // Close to parallel vectors give a camera whose axes are imprecise.
            let clear = view.cross(up).length() > 1e-3;
            Camera::new(position, view, up, 10.0 * tens as f32, 1.5).ok().filter(|_| clear)
        },
    )
}

/// Lens rays for any point of the film of a camera at `position`.
fn lens_query(position: Vec3) -> impl Strategy<Value = LensQuery> + Clone {
    let place = || fractions(-8..=8, 8.0);
    let on_lens = (place(), place()).prop_map(|(x, y)| vec2(x, y).clamp_length_max(1.0));
    (camera(position), (0..=16i32, 0..=16i32), on_lens, (0..=8i32), (1..=40i32)).prop_map(
        |(camera, (x, y), on_lens, aperture, distance)| LensQuery {
            camera,
            pinhole: camera.ray(x as f32 / 16.0, y as f32 / 16.0),
            lens: Lens { aperture: aperture as f32 / 8.0, focal_distance: distance as f32 / 2.0 },
            on_lens,
        },
    )
}

fn paste(query: &LensQuery) -> String {
    let Lens { aperture, focal_distance } = query.lens;
    format!("lens_ray, aperture {aperture:?}, focal distance {focal_distance:?}, {}", query.on_lens.paste())
}

/// The start of the ray relative to the camera, in double precision.
fn offset(query: &LensQuery) -> DVec3 {
    let place = 0.5 * f64::from(query.lens.aperture) * query.on_lens.as_dvec2();
    place.x * query.camera.right.as_dvec3() + place.y * query.camera.up.as_dvec3()
}

pub(super) fn lens_without_width_is_a_pinhole(trial: &Trial<'_>) -> CheckResult {
    // A quarter of the lenses have a width, and give another ray.
    let queries = (lens_query(vec3(1.0, 2.0, 3.0)), 0..4i32).prop_map(|(query, which)| match which {
        0 | 1 => LensQuery { lens: Lens { aperture: 0.0, ..query.lens }, ..query },
        2 => LensQuery { on_lens: Vec2::ZERO, ..query },
        _ => LensQuery { lens: Lens { aperture: 0.5, ..query.lens }, on_lens: vec2(0.5, -0.5), ..query },
    });
    trial.each(500, queries, <dyn Kit>::lens_ray, |query, yours| {
        let wide = offset(query) != DVec3::ZERO;
        if (yours == query.pinhole) != wide {
            return Ok(());
        }
        if wide {
            let expected = "a ray that starts on the lens";
            return Err(Broken::new(paste(query), yours, expected, "the definition")
                .because("you return the pinhole ray for a lens that has a width"));
        }
        let near = (yours.direction - query.pinhole.direction).length() < 1e-5
            && yours.origin == query.pinhole.origin;
        let range = (yours.t_min, yours.t_max, yours.time);
        let kept = range == (query.pinhole.t_min, query.pinhole.t_max, query.pinhole.time);
        Err(Broken::new(paste(query), yours, query.pinhole, "the pinhole ray, bit for bit").explained_by([
            (near && kept, "you recompute the direction, which adds a rounding error: return *pinhole"),
            (yours.direction.is_nan(), "you return NaN"),
        ]))
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
    trial.each_and(&[drawn()], 2000, lens_query(vec3(1.0, 2.0, 3.0)), <dyn Kit>::lens_ray, judge_focus)
}

fn judge_focus(query: &LensQuery, yours: Ray) -> Judged {
    let (expected, found) = (in_focus(query, &query.pinhole), in_focus(query, &yours));
    // The tolerance covers a few roundings of the direction, relative to the distance, and of the origin, whose coordinates
    // are up to 4. A wide lens enlarges them.
    let off = (found - expected).length() / expected.length();
    let pinhole = yours == query.pinhole && offset(query) != DVec3::ZERO;
    let distance = f64::from(query.lens.focal_distance);
    let [direction, towards] = [query.pinhole.direction, query.camera.towards].map(Vec3::as_dvec3);
    let start = yours.origin.as_dvec3() - query.camera.position.as_dvec3();
    // A lens without a width has a case of its own.
    let aims = |way: DVec3| {
        offset(query) == DVec3::ZERO
            || (yours.direction.as_dvec3().normalize() - way.normalize()).length() < 1e-5
    };
    let broken = || {
        Broken::with_texts(
            paste(query),
            format!("a ray that misses by {:.2e}", (found - expected).length()),
            format!("a ray through camera.position + {:?}", expected.as_vec3()),
            "the focal plane",
        )
        .explained_by([
            (pinhole, "you return the pinhole ray for a lens that has a width"),
            (yours.origin.is_nan() || yours.direction.is_nan(), "you return NaN"),
        ])
    };
    unless(off < 2e-5 && !pinhole, broken).formulas([
        "you go focal_distance along the ray: divide it by the cosine with camera.towards"
            .when(aims(distance * direction - start)),
        "you multiply focal_distance by the cosine with camera.towards: divide by it"
            .when(aims(distance * direction.dot(towards) * direction - start)),
        "you aim every ray at the centre of the focal plane: aim where its pinhole ray meets it"
            .when(aims(distance * towards - start)),
        (aims(expected + start), "you add the offset to the focus: subtract it"),
        (aims(direction), "your ray is parallel to the pinhole ray: aim where that meets the focal plane"),
    ])
}

/// A ray far from the axis, from a point far from the centre of a wide lens, where all known mistakes give different
/// rays.
fn drawn() -> LensQuery {
    let camera = Camera::new(vec3(1.0, 2.0, 3.0), vec3(0.6, -0.48, -0.64), Vec3::Y, 60.0, 1.5);
    let camera = camera.expect("the view direction is not parallel to up");
    LensQuery {
        camera,
        pinhole: camera.ray(0.25, 0.125),
        lens: Lens { aperture: 0.5, focal_distance: 3.0 },
        on_lens: vec2(0.5, -0.75),
    }
}

pub(super) fn lens_rays_start_on_the_lens(trial: &Trial<'_>) -> CheckResult {
    trial.each_and(&[drawn()], 1000, lens_query(vec3(1.0, 2.0, 3.0)), <dyn Kit>::lens_ray, judge_start)
}

fn judge_start(query: &LensQuery, yours: Ray) -> Judged {
    let camera = &query.camera;
    let position = camera.position.as_dvec3();
    let expected = position + offset(query);
    // The tolerance covers a few roundings of coordinates up to 4.
    let near = |v: DVec3| (yours.origin.as_dvec3() - v).length() < 2e-6;
    let is = |v: DVec3| near(v) || (offset(query) == DVec3::ZERO && near(expected));
    let unit = (yours.direction.length() - 1.0).abs() < 1e-5;
    let place = 0.5 * f64::from(query.lens.aperture) * query.on_lens.as_dvec2();
    let (right, up) = (camera.right.as_dvec3(), camera.up.as_dvec3());
    let broken = || {
        let source = "position + aperture / 2 · on_lens, along right and up";
        Broken::new(paste(query), yours, expected.as_vec3(), source)
            .explained_by([(near(expected) && !unit, "your direction does not have unit length")])
    };
    unless(near(expected) && unit, broken).formulas(named![
        is(position + 2.0 * offset(query)) => "you use aperture as the radius of the lens: it is the diameter",
        is(position) => "you start every ray at the centre of the lens: use on_lens",
        is(position + place.x * right) => "your lens is a line: it extends along camera.right and along camera.up",
        is(position + place.y * up) => "your lens is a line: it extends along camera.right and along camera.up",
        is(position + place.extend(0.0)) => "you use the world's x and y axes: use camera.right and camera.up",
        is(position + place.y * right + place.x * up) => "you exchange x and y of on_lens: x is along camera.right",
        is(offset(query)) => "you leave out camera.position",
    ])
}

pub(super) fn lens_is_as_sharp_a_million_units_away(trial: &Trial<'_>) -> CheckResult {
    // Near a million f32 numbers are 1/16 apart: the origin is rounded, but the direction can be precise.
    trial.forall(1000, lens_query(vec3(1e6, -1e6, 1e6)), |queries| {
        // The same lenses at the origin show whether the position is the cause.
        let at_origin = |query: &LensQuery| LensQuery {
            camera: Camera { position: Vec3::ZERO, ..query.camera },
            pinhole: Ray { origin: Vec3::ZERO, ..query.pinhole },
            ..*query
        };
        let near = trial.kit.lens_ray(&queries.iter().map(at_origin).collect::<Vec<_>>());
        let pairs: Vec<(LensQuery, Vec3)> =
            queries.iter().copied().zip(near.iter().map(|ray| ray.direction)).collect();
        compare(&pairs, trial.kit.lens_ray(queries), |(query, near), yours| {
            let expected = (in_focus(query, &query.pinhole) - offset(query)).normalize();
            // The tolerance covers a few roundings of the direction.
            let is_right = |direction: Vec3| (direction.as_dvec3() - expected).length() < 2e-6;
            if is_right(yours.direction) {
                return Ok(());
            }
            let broken = Broken::new(paste(query), yours.direction, expected.as_vec3(), "double precision");
            Err(broken
                .explained_by(["your direction is imprecise: compute it relative to camera.position"
                    .when(is_right(*near))]))
        })
    })
}
