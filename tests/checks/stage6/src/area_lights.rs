//! Points of area lights.

use super::lens::{polar, uneven_disk};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::paste::{Paste, call};
use checks::statistics::{SAMPLES, columns, covers_evenly, has_mean, pairs};
use glam::{DVec3, Vec2, Vec3, vec3};
use raykata::kit::{RectangleQuery, SphereSampleQuery};
use raykata::shape::{Disk, Sphere};

pub(super) fn places_on_a_rectangle_are_even(trial: &Trial<'_>) -> CheckResult {
    let (corner, edges) = (vec3(1.0, 5.0, -2.0), (vec3(3.0, 0.0, 0.0), vec3(0.5, 0.0, 2.0)));
    let queries: Vec<RectangleQuery> =
        pairs(trial.seed, SAMPLES).into_iter().map(|u| RectangleQuery { corner, edges, u }).collect();
    let answers = trial.kit.sample_rectangle(&queries);
    let mut shares = Vec::new();
    for (query, point) in queries.iter().zip(answers) {
        // Solve for the fractions of both edges. Only the second edge has a z component.
        let from_corner = point.as_dvec3() - corner.as_dvec3();
        let v = from_corner.z / 2.0;
        let u = (from_corner.x - 0.5 * v) / 3.0;
        let inside = |share: f64| (-1e-6..=1.0 + 1e-6).contains(&share); // roundings of coordinates up to 5
        if !(inside(u) && inside(v) && from_corner.y.abs() < 1e-6) {
            let broken = Broken::new(
                format!(
                    "sample_rectangle({}, ({}, {}), {})",
                    corner.paste(),
                    edges.0.paste(),
                    edges.1.paste(),
                    query.u.paste()
                ),
                point,
                "a point of the rectangle",
                "the definition",
            );
            let to_corners =
                (1.0 - query.u.x - query.u.y) * corner + query.u.x * edges.0 + query.u.y * edges.1;
            let diagnosis = match () {
                () if (point - to_corners).length() < 1e-5 => {
                    "you use the edges as positions of corners: they are vectors from the corner"
                }
                () if (-1.0..1.0).contains(&u) && (-1.0..1.0).contains(&v) => {
                    "you use the corner as the centre of the rectangle"
                }
                () => "",
            };
            return Err(broken.looks_like(checks::judge::known(diagnosis)));
        }
        shares.push((u, v));
    }
    covers_evenly("sample_rectangle(…, u)", &shares, ["the first edge", "the second edge"], |counts| {
        // 28 of the 64 cells lie beyond the diagonal.
        let hit = counts.iter().filter(|count| **count > 0).count();
        if hit == 36 { "your points fill a triangle: half of the rectangle is missing" } else { "" }
    })
}

pub(super) fn places_on_a_round_light_are_even(trial: &Trial<'_>) -> CheckResult {
    let disk = Disk { center: vec3(1.0, 2.0, 3.0), normal: vec3(0.0, 3.0, -4.0), radius: 2.5 };
    let u = pairs(trial.seed, SAMPLES);
    let queries: Vec<(Disk, Vec2)> = u.iter().map(|u| (disk, *u)).collect();
    let normal = disk.normal.normalize();
    let (x, y) = normal.any_orthonormal_pair();
    let mut places = Vec::new();
    for (u, point) in u.iter().zip(trial.kit.sample_light_disk(&queries)) {
        let offset = point - disk.center;
        // The tolerance covers a few roundings of coordinates up to 5.
        if !(offset.dot(normal).abs() < 5e-6 && offset.length() < disk.radius + 5e-6) {
            let input = format!(
                "sample_light_disk(&Disk {{ center: {}, normal: {}, radius: {} }}, {})",
                disk.center.paste(),
                disk.normal.paste(),
                disk.radius.paste(),
                u.paste()
            );
            let beside = !(offset.dot(normal).abs() < 5e-6);
            let diagnosis = match () {
                () if beside && (offset.y == 0.0 || offset.z == 0.0) => {
                    "you leave out the normal: your disk is parallel to a coordinate plane"
                }
                () if beside => "your point is outside the plane of the disk: normalize disk.normal first",
                () => "your point is farther from the centre than the radius",
            };
            let broken = Broken::new(input, point, "a point of the disk", "the definition");
            return Err(broken.looks_like(checks::judge::known(diagnosis)));
        }
        places.push(polar(Vec2::new(offset.dot(x), offset.dot(y)) / disk.radius));
    }
    covers_evenly("sample_light_disk(…, u)", &places, ["radius²", "angle"], uneven_disk)
}

/// The directions to a sphere as two fractions of its solid angle: from the axis of the cone to its rim, and around the
/// axis.
fn seen(trial: &Trial<'_>, sphere: Sphere, from: Vec3) -> Result<Vec<(f64, f64)>, Broken> {
    let queries: Vec<SphereSampleQuery> =
        pairs(trial.seed, SAMPLES).into_iter().map(|u| SphereSampleQuery { sphere, from, u }).collect();
    let to_center = sphere.center.as_dvec3() - from.as_dvec3();
    let sin_squared = f64::from(sphere.radius).powi(2) / to_center.length_squared();
    let widest = if sin_squared < 1.0 { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) } else { 2.0 };
    let axis = to_center.normalize();
    let (x, y) = axis.any_orthonormal_pair();
    let mut shares = Vec::new();
    for (query, direction) in queries.iter().zip(trial.kit.sample_sphere(&queries)) {
        let toward = direction.as_dvec3();
        // Compute 1 - cos θ from the sine, which is precise for small angles.
        let sine_squared = toward.cross(axis).length_squared();
        let cosine = toward.dot(axis);
        let below_one = if cosine > 0.0 { sine_squared / (1.0 + cosine) } else { 1.0 - cosine };
        let share = below_one / widest;
        // The tolerance covers the rounding of the direction: 1e-7 of an angle of √(2 · widest).
        let slack = 4e-7 / widest.sqrt();
        let unit = (toward.length() - 1.0).abs() < 1e-5;
        if !(unit && share <= 1.0 + slack) {
            let input = format!(
                "sample_sphere(&Sphere {{ center: {}, radius: {} }}, {}, {})",
                sphere.center.paste(),
                sphere.radius.paste(),
                from.paste(),
                query.u.paste()
            );
            let broken = Broken::new(input, direction, "a unit direction to the sphere", "the definition");
            let diagnosis = match () {
                () if direction.is_nan() => "you return NaN: from inside the sphere 1 - sin² is negative",
                () if !unit => "your direction does not have unit length",
                () => "your direction misses the sphere",
            };
            return Err(broken.looks_like(Some(diagnosis)));
        }
        shares.push((share, toward.dot(y).atan2(toward.dot(x)) / std::f64::consts::TAU + 0.5));
    }
    Ok(shares)
}

const AXES: [&str; 2] = ["1 - cos θ, as a fraction of the rim's", "the angle around the axis"];

pub(super) fn directions_to_a_sphere_are_even(trial: &Trial<'_>) -> CheckResult {
    let sphere = Sphere { center: vec3(1.0, 4.0, 2.0), radius: 2.4 };
    let from = vec3(1.0, 1.0, 2.0);
    let shares = seen(trial, sphere, from)?;
    covers_evenly("sample_sphere from 1.25 radii away", &shares, AXES, |counts| {
        let rings = columns(counts);
        if rings[7] == 0 {
            "you never sample the rim of the sphere, where sin θ = radius / distance"
        } else if 2 * rings[0] > 3 * rings[7] {
            "too many directions near the centre: make cos θ uniform"
        } else if 2 * rings[7] > 3 * rings[0] {
            "too many directions near the rim"
        } else {
            ""
        }
    })?;
    // The irradiance of a surface that faces the sphere: the mean of cos θ over the cone is (1 + cos of its rim) / 2.
    let cos_rim = 0.6; // its sine is 2.4 / 3
    let cosines: Vec<f64> = shares.iter().map(|(share, _)| 1.0 - share * (1.0 - cos_rim)).collect();
    has_mean(
        "the cosine of sample_sphere with the direction to the centre",
        &cosines,
        0.5 * (1.0 + cos_rim),
        "",
    )
}

pub(super) fn a_far_sphere_is_still_a_sphere(trial: &Trial<'_>) -> CheckResult {
    // Ten thousand radii away 1 - cos θ of the rim is 5e-9, so cos θ is rounded to 1 in f32.
    let sphere = Sphere { center: vec3(0.0, 100.0, 0.0), radius: 0.01 };
    let rounded = "your 1 - cos θ is rounded: compute it as sin²θ / (1 + cos θ)";
    let shares = seen(trial, sphere, Vec3::ZERO)?;
    covers_evenly("sample_sphere from 10,000 radii away", &shares, AXES, |counts| {
        // Directions are rounded to a thousandth of the rim's angle, which moves no direction by more than a cell.
        if counts.iter().max() > Some(&(SAMPLES as u64 / 8)) { rounded } else { "" }
    })
}

pub(super) fn from_inside_a_sphere_it_is_everywhere(trial: &Trial<'_>) -> CheckResult {
    let sphere = Sphere { center: vec3(0.0, 1.0, 0.0), radius: 3.0 };
    let shares = seen(trial, sphere, vec3(0.5, 0.0, 0.5))?;
    covers_evenly("sample_sphere from inside", &shares, AXES, |counts| {
        let rings = columns(counts);
        if rings[4..].iter().sum::<u64>() == 0 {
            "your directions fill one hemisphere: from inside use all directions"
        } else {
            ""
        }
    })?;
    // From the centre any unit direction passes, and NaN fails.
    let query = SphereSampleQuery { sphere, from: sphere.center, u: Vec2::splat(0.25) };
    let direction = trial.kit.sample_sphere(&[query])[0];
    if (direction.length() - 1.0).abs() < 1e-5 {
        return Ok(());
    }
    let input = format!("sample_sphere from the centre of the sphere, {}", call("u =", &[&query.u]));
    Err(Broken::new(input, direction, "any unit direction", "the definition").looks_like(
        direction.is_nan().then_some("from the centre the vector to the centre is 0: use any axis"),
    ))
}

/// The fraction of a sphere that is visible past the straight edge of a wall.
pub(super) fn half_a_sphere_makes_half_a_shadow(trial: &Trial<'_>) -> CheckResult {
    let sphere = Sphere { center: vec3(0.0, 3.0, 0.0), radius: 1.0 };
    let queries: Vec<SphereSampleQuery> = pairs(trial.seed, SAMPLES)
        .into_iter()
        .map(|u| SphereSampleQuery { sphere, from: Vec3::ZERO, u })
        .collect();
    let directions = trial.kit.sample_sphere(&queries);
    for normal in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::new(0.6, 0.0, -0.8)] {
        let seen: Vec<f64> = directions
            .iter()
            .map(|direction| f64::from(u8::from(direction.as_dvec3().dot(normal) > 0.0)))
            .collect();
        has_mean(
            "sample_sphere past a wall that hides exactly half of the sphere",
            &seen,
            0.5,
            "you sample one side of the sphere more often than the other",
        )?;
    }
    Ok(())
}
