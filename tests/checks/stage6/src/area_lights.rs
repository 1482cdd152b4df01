//! Points of area lights.

use super::lens::{is_polar, polar, uneven_disk};
use super::pixels::LARGEST;
use checks::prelude::*;
use checks::statistics::{SAMPLES, columns, covers_each_part, has_mean, is_of_one_number, pairs};
use raykata::shape::Disk;

/// Random numbers for a statistical test, and the four corners of the unit square, which a test of counts does not notice.
fn numbers(seed: u64) -> Vec<Vec2> {
    let corners = [0.0, LARGEST].map(|x| [Vec2::new(x, 0.0), Vec2::new(x, LARGEST)]);
    corners.as_flattened().iter().copied().chain(pairs(seed, SAMPLES - 4)).collect()
}

/// Rectangles in all orientations, some not at right angles, of different sizes and at different places.
fn rectangles() -> Vec<(Vec3, (Vec3, Vec3))> {
    let frames = nasty::directions();
    let rectangle = |(index, axis): (usize, &Vec3)| {
        let (x, y) = axis.any_orthonormal_pair();
        let size = [1.0, 0.125, 40.0][index % 3];
        let lean = [0.0, 0.5, -0.25][index % 3];
        let corner = [vec3(1.0, 5.0, -2.0), Vec3::ZERO, vec3(-30.0, 0.0, 7.0)][index % 3];
        (corner, (3.0 * size * x, size * (2.0 * y + lean * x)))
    };
    frames.iter().enumerate().map(rectangle).collect()
}

pub(super) fn places_on_a_rectangle_are_even(trial: &Trial<'_>) -> CheckResult {
    let rectangles = rectangles();
    let query = |(index, u): (usize, Vec2)| {
        let (corner, edges) = rectangles[index % rectangles.len()];
        RectangleQuery { corner, edges, u }
    };
    let queries: Vec<RectangleQuery> = numbers(trial.seed).into_iter().enumerate().map(query).collect();
    let shares_of = |queries: &[RectangleQuery]| {
        let mut shares = Vec::new();
        let judge =
            |(query, point): (&RectangleQuery, Vec3)| judge_rectangle_point(query, point, &mut shares);
        all_hold(proven(queries.iter().zip(trial.kit.sample_rectangle(queries)).map(judge)))?;
        Ok(shares)
    };
    shares_of(&queries)?;
    let places = |u: &[Vec2]| {
        let queries: Vec<RectangleQuery> = u.iter().map(|u| RectangleQuery { u: *u, ..queries[0] }).collect();
        shares_of(&queries)
    };
    covers_each_part("sample_rectangle(…, u)", RECTANGLE_AXES, trial.seed, None, places, |counts| {
        // 28 of the 64 cells lie beyond the diagonal.
        let hit = counts.iter().filter(|count| **count > 0).count();
        vec![(hit == 36, "your points fill a triangle: half of the rectangle is missing")]
    })
}

const RECTANGLE_AXES: [&str; 2] = ["the first edge", "the second edge"];

const CORNER_AS_CENTER: &str = "you use the corner as the centre of the rectangle";

/// Whether a point belongs to its rectangle. Adds its fractions of both edges to `shares`.
fn judge_rectangle_point(query: &RectangleQuery, point: Vec3, shares: &mut Vec<(f64, f64)>) -> Judged {
    let [corner, first, second] = [query.corner, query.edges.0, query.edges.1].map(Vec3::as_dvec3);
    let from_corner = point.as_dvec3() - corner;
    // Solve for the fractions of both edges with the vectors that are perpendicular to the other edge, in the plane.
    let normal = first.cross(second);
    let u = from_corner.dot(second.cross(normal)) / first.dot(second.cross(normal));
    let v = from_corner.dot(first.cross(normal)) / second.dot(first.cross(normal));
    // A few roundings of the coordinates, as a fraction of the shorter edge.
    let size = first.length().min(second.length());
    let slack = 1e-6 * (corner.length() + first.length() + second.length()) / size;
    let inside = |share: f64| (-slack..=1.0 + slack).contains(&share);
    let height = (from_corner - u * first - v * second).length();
    let right = inside(u) && inside(v) && height <= slack * size;
    if right {
        shares.push((u, v));
    }
    let is = |place: DVec3| (point.as_dvec3() - place).length() <= slack * size;
    let (x, y) = (f64::from(query.u.x), f64::from(query.u.y));
    let input = || call("sample_rectangle", &[&query.corner, &query.edges, &query.u]);
    unless(right, || Broken::new(input(), point, "a point of the rectangle", "the definition")).formulas([
        "you use the edges as positions of corners: they are vectors from the corner"
            .when(is((1.0 - x - y) * corner + x * first + y * second)),
        (is(corner + (x - 0.5) * first + (y - 0.5) * second), CORNER_AS_CENTER),
        (is(corner + (2.0 * x - 1.0) * first + (2.0 * y - 1.0) * second), CORNER_AS_CENTER),
        (is(x * first + y * second), "you leave out the corner"),
    ])
}

/// Disks in all orientations, with normals of different lengths.
fn disks() -> Vec<Disk> {
    let frames = nasty::directions();
    let disk = |(index, axis): (usize, &Vec3)| Disk {
        center: [vec3(1.0, 2.0, 3.0), Vec3::ZERO, vec3(-9.0, 0.5, 0.0)][index % 3],
        normal: [5.0, 1.0, 0.01, 300.0][index % 4] * *axis,
        radius: [2.5, 0.125, 30.0][index % 3],
    };
    frames.iter().enumerate().map(disk).collect()
}

pub(super) fn places_on_a_round_light_are_even(trial: &Trial<'_>) -> CheckResult {
    let disks = disks();
    let u = numbers(trial.seed);
    let queries: Vec<(Disk, Vec2)> =
        u.iter().enumerate().map(|(index, u)| (disks[index % disks.len()], *u)).collect();
    let places_of = |queries: &[(Disk, Vec2)]| {
        let mut places = Vec::new();
        let judge = |(query, point): (&(Disk, Vec2), Vec3)| judge_disk_point(query, point, &mut places);
        all_hold(queries.iter().zip(trial.kit.sample_light_disk(queries)).map(judge).collect())?;
        Ok(places)
    };
    let places = places_of(&queries)?;
    let shares = |u: &[Vec2]| {
        let queries: Vec<(Disk, Vec2)> = u.iter().map(|u| (disks[disks.len() - 1], *u)).collect();
        Ok(places_of(&queries)?.into_iter().map(polar).collect())
    };
    covers_each_part("sample_light_disk(…, u)", ["radius²", "angle"], trial.seed, None, shares, |counts| {
        uneven_disk(counts, is_polar(&u, &places))
    })
}

/// Whether a point belongs to its disk. Adds its place on the disk of radius 1 to `places`.
fn judge_disk_point((disk, u): &(Disk, Vec2), point: Vec3, places: &mut Vec<Vec2>) -> CheckResult {
    let offset = point.as_dvec3() - disk.center.as_dvec3();
    let normal = disk.normal.as_dvec3().normalize();
    let radius = f64::from(disk.radius);
    // A few roundings of the coordinates.
    let slack = 1e-6 * (disk.center.as_dvec3().length() + radius);
    let height = offset.dot(normal);
    // A rotation from z to the normal by the library is off by up to 7e-4, because it takes almost parallel vectors as
    // parallel. A wrong plane is much farther off for most disks.
    let beside = !(height.abs() <= 1e-3 * radius + slack);
    let far = offset.length() > radius + slack;
    if !beside && !far {
        let (x, y) = normal.any_orthonormal_pair();
        places.push(Vec2::new((offset.dot(x) / radius) as f32, (offset.dot(y) / radius) as f32));
        return Ok(());
    }
    let flat = [DVec3::X, DVec3::Y, DVec3::Z].iter().any(|axis| offset.dot(*axis) == 0.0);
    let input = format!("sample_light_disk({}, {})", disk.paste(), u.paste());
    Err(Broken::new(input, point, "a point of the disk", "the definition").explained_by([
        (point.is_nan(), "you return NaN: your two axes do not exist for this normal"),
        (beside && flat, "you leave out the normal: your disk is parallel to a coordinate plane"),
        "your point is outside the plane of the disk where disk.normal is not a unit vector: normalize it"
            .when(beside && !flat && (disk.normal.length() - 1.0).abs() > 1e-3),
        (far, "your point is farther from the centre than the radius"),
        (beside, "your point is outside the plane of the disk"),
    ]))
}

/// Spheres seen from outside or inside: `distance` away, in units of the radius, in all directions, with different radii and
/// from different points.
fn spheres(distance: f32, from: &[Vec3]) -> Vec<(Sphere, Vec3)> {
    let frames = nasty::directions();
    let sphere = |(index, axis): (usize, &Vec3)| {
        let (radius, from) = ([2.4, 0.01, 100.0][index % 3], from[index % from.len()]);
        (Sphere { center: from + distance * radius * *axis, radius }, from)
    };
    frames.iter().enumerate().map(sphere).collect()
}

/// The directions to spheres that are seen at the same distance in radii.
struct Seen {
    u: Vec<Vec2>,
    /// Two fractions of the solid angle of the sphere: from the axis of the cone to its rim, and around the axis.
    shares: Vec<(f64, f64)>,
    /// 1 - cos θ of the rim, and of each direction.
    rims: Vec<f64>,
    /// Each direction in the frame of its cone: along the axis, and along two vectors at right angles to it.
    local: Vec<DVec3>,
}

/// How many different angles to the axis there are, whose shares come first, up to a thousandth of the distribution.
pub(super) fn n_angles(shares: &[(f64, f64)]) -> usize {
    shares.iter().map(|(share, _)| (share * 1e3) as u64).collect::<std::collections::BTreeSet<u64>>().len()
}

impl Seen {
    /// What a wrong formula for 1 - cos θ gives: `share` computes it from a random number and that of the rim.
    fn is(&self, below_one: fn(u: f64, rim: f64) -> f64) -> bool {
        let shares = self.shares.iter().zip(&self.rims);
        is_of_one_number(&self.u, shares, |u, ((share, _), rim)| {
            (share - below_one(u, *rim) / rim).abs() < 1e-2
        })
    }
}

/// Samples spheres in turn. Every direction must have unit length and lead to its sphere.
fn seen(trial: &Trial<'_>, spheres: &[(Sphere, Vec3)], u: &[Vec2]) -> Result<Seen, Broken> {
    let query = |(index, u): (usize, &Vec2)| {
        let (sphere, from) = spheres[index % spheres.len()];
        SphereSampleQuery { sphere, from, u: *u }
    };
    let queries: Vec<SphereSampleQuery> = u.iter().enumerate().map(query).collect();
    let mut seen = Seen { u: u.to_vec(), shares: Vec::new(), rims: Vec::new(), local: Vec::new() };
    let answers = trial.kit.sample_sphere(&queries);
    let all_nan = answers.iter().all(|direction| direction.is_nan());
    let judge = |(query, direction)| judge_direction(query, direction, all_nan, &mut seen);
    all_hold(queries.iter().zip(answers).map(judge).collect())?;
    Ok(seen)
}

/// `all_nan` says whether the directions to all spheres are NaN.
fn judge_direction(
    query: &SphereSampleQuery,
    direction: Vec3,
    all_nan: bool,
    seen: &mut Seen,
) -> CheckResult {
    let SphereSampleQuery { sphere, from, .. } = query;
    let to_center = sphere.center.as_dvec3() - from.as_dvec3();
    let sin_squared = f64::from(sphere.radius).powi(2) / to_center.length_squared();
    let inside = sin_squared >= 1.0;
    let widest = if inside { 2.0 } else { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) };
    let axis = to_center.normalize();
    let (x, y) = axis.any_orthonormal_pair();
    let toward = direction.as_dvec3();
    // Compute 1 - cos θ from the sine, which is precise for small angles.
    let sine_squared = toward.cross(axis).length_squared();
    let cosine = toward.dot(axis);
    let below_one = if cosine > 0.0 { sine_squared / (1.0 + cosine) } else { 1.0 - cosine };
    let share = below_one / widest;
    // The tolerance covers the rounding of the direction, a few times 1e-7 of an angle of √(2 · widest).
    let slack = 8e-7 / widest.sqrt();
    let unit = (toward.length() - 1.0).abs() < 1e-5;
    if unit && share <= 1.0 + slack {
        seen.shares.push((share, toward.dot(y).atan2(toward.dot(x)) / std::f64::consts::TAU + 0.5));
        seen.rims.push(widest);
        seen.local.push(DVec3::new(cosine, toward.dot(x), toward.dot(y)));
        return Ok(());
    }
    let (input, expected) = (query.call("sample_sphere"), "a unit direction to the sphere");
    Err(Broken::new(input, direction, expected, "the definition").explained_by([
        (inside && all_nan, "you return NaN: from inside the sphere 1 - sin² is negative"),
        (direction.is_nan(), "you return NaN"),
        (!unit, "your direction does not have unit length"),
        (cosine < 0.0, "your direction misses the sphere: it goes away from it"),
        (unit, "your direction misses the sphere"),
    ]))
}

const AXES: [&str; 2] = ["1 - cos θ, as a fraction of the rim's", "the angle around the axis"];

/// Points of view for which `center - from` is exact or nearly so.
const HERE: [Vec3; 2] = [Vec3::ZERO, vec3(1.0, -1.0, 2.0)];

pub(super) fn directions_to_a_sphere_are_even(trial: &Trial<'_>) -> CheckResult {
    let spheres = spheres(1.25, &HERE);
    let all = seen(trial, &spheres, &numbers(trial.seed))?;
    // The last sphere is seen in a direction far from the axes, along which most frames are right by chance.
    let shares = |u: &[Vec2]| Ok(seen(trial, &spheres[spheres.len() - 1..], u)?.shares);
    covers_each_part("sample_sphere from 1.25 radii away", AXES, trial.seed, None, shares, |counts| {
        let rings = columns(counts);
        vec![
            "too many directions near the centre: your θ is uniform; make cos θ uniform"
                .when(all.is(|u, rim| 1.0 - (u * (1.0 - rim).acos()).cos())),
            "too many directions near the centre: your sin² θ is uniform; make cos θ uniform"
                .when(all.is(|u, rim| 1.0 - (1.0 - u * (1.0 - (1.0 - rim).powi(2))).sqrt())),
            (rings[7] == 0, "you never sample the rim of the sphere, where sin θ = radius / distance"),
            (2 * rings[0] > 3 * rings[7], "too many directions near the centre"),
            (2 * rings[7] > 3 * rings[0], "too many directions near the rim"),
        ]
    })
}

pub(super) fn a_far_sphere_is_still_a_sphere(trial: &Trial<'_>) -> CheckResult {
    // Ten thousand radii away 1 - cos θ of the rim is 5e-9, so cos θ is rounded to 1 in f32. The point of view is the origin,
    // so that no rounding of the difference adds to this.
    let u = numbers(trial.seed);
    let far = seen(trial, &spheres(1e4, &HERE[..1]), &u)?;
    let (rings, turns): (Vec<f64>, Vec<f64>) = far.shares.iter().copied().unzip();
    for (axis, shares) in AXES.iter().zip([rings, turns]) {
        has_mean(&format!("sample_sphere from 10,000 radii away, {axis}"), &shares, 0.5, |_| {
            // The formula is right for a near sphere, and gives few angles for a far one.
            let near = seen(trial, &spheres(1.25, &HERE[..1]), &u);
            let rounded = n_angles(&far.shares) <= 8 && near.is_ok_and(|near| n_angles(&near.shares) > 500);
            vec![(rounded, "your 1 - cos θ is rounded: compute it as sin²θ / (1 + cos θ)")]
        })?;
    }
    Ok(())
}

pub(super) fn from_inside_a_sphere_it_is_everywhere(trial: &Trial<'_>) -> CheckResult {
    let spheres = spheres(0.4, &HERE);
    let all = seen(trial, &spheres, &numbers(trial.seed))?;
    let shares = |u: &[Vec2]| Ok(seen(trial, &spheres[spheres.len() - 1..], u)?.shares);
    covers_each_part("sample_sphere from inside", AXES, trial.seed, None, shares, |_| {
        let hemisphere = all.local.iter().all(|direction| direction.x > -1e-6);
        vec![(hemisphere, "your directions fill one hemisphere: from inside use all directions")]
    })?;
    // From the centre any unit direction passes, and NaN fails.
    let query = |u: Vec2| SphereSampleQuery {
        sphere: Sphere { center: vec3(0.0, 1.0, 0.0), radius: 3.0 },
        from: vec3(0.0, 1.0, 0.0),
        u,
    };
    let queries = [Vec2::splat(0.25), Vec2::ZERO, Vec2::splat(LARGEST)].map(query);
    let judge = |(query, direction): (&SphereSampleQuery, Vec3)| {
        if (direction.length() - 1.0).abs() < 1e-5 {
            return Ok(());
        }
        let input = format!("sample_sphere from the centre of the sphere, {}", call("u =", &[&query.u]));
        Err(Broken::new(input, direction, "any unit direction", "the definition").explained_by([
            "from the centre the vector to the centre is 0: use any axis".when(direction.is_nan()),
        ]))
    };
    all_hold(queries.iter().zip(trial.kit.sample_sphere(&queries)).map(judge).collect())
}

/// The fraction of a sphere that is visible past the straight edge of a wall.
pub(super) fn half_a_sphere_makes_half_a_shadow(trial: &Trial<'_>) -> CheckResult {
    let seen = seen(trial, &spheres(3.0, &HERE), &numbers(trial.seed))?;
    for normal in [DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::new(0.0, 0.6, -0.8)] {
        let visible: Vec<f64> =
            seen.local.iter().map(|direction| f64::from(u8::from(direction.dot(normal) > 0.0))).collect();
        has_mean("sample_sphere past a wall that hides exactly half of the sphere", &visible, 0.5, |_| {
            vec![(true, "you sample one side of the sphere more often than the other")]
        })?;
    }
    Ok(())
}
