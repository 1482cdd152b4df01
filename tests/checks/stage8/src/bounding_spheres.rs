//! Checks of `bounding_sphere` and `enter_bounding_sphere`.

use super::boxes::ROUNDINGS;
use super::mistakes::agree;
use checks::generate::sphere;
use checks::prelude::*;
use oracle::exact::{Body, meet};

/// Points on a grid or of any kind, at any size, often in a plane, on a line or all equal; and points far from the origin.
fn clouds() -> impl Strategy<Value = Vec<Vec3>> + Clone {
    let points = prop_oneof![3 => point(8), 1 => nasty::lattice(2), 1 => nasty::unit()];
    let cloud = prop::collection::vec(points, 1..12);
    let flat = prop_oneof![3 => Just(Vec3::ONE), 1 => Just(Vec3::new(1.0, 0.0, 1.0)), 1 => Just(Vec3::Y)];
    let any = (cloud, flat, nasty::any_scale())
        .prop_map(|(points, flat, scale)| points.into_iter().map(|point| scale * flat * point).collect());
    let far = prop::collection::vec(point(8), 1..12).prop_map(|points| {
        points.into_iter().map(|point| 0.1 * point + Vec3::new(148_376.0, 1_234.0, -223_423.0)).collect()
    });
    prop_oneof![3 => any, 1 => far]
}

/// The largest coordinate, whose rounding errors a sphere may add to its radius.
pub(super) fn reach<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> f64 {
    points.into_iter().map(|point| f64::from(point.abs().max_element())).fold(0.0, f64::max)
}

pub(super) fn sphere_holds_all_points(trial: &Trial<'_>) -> CheckResult {
    let corner = vec![Vec3::ZERO, Vec3::new(4.0, 2.0, 1.0), Vec3::X];
    trial.forall_and(&[corner], 1300, clouds(), |queries| judge_covers(trial, queries, ROUNDINGS))
}

/// Spheres without the tolerance of other checks, and rays that enter spheres.
pub(super) fn are_rounded_outwards(trial: &Trial<'_>) -> CheckResult {
    // Distances of points with all digits have the most rounding errors.
    let rough = prop::collection::vec(rough_point(8.0), 2..5);
    let any = prop_oneof![1 => clouds(), 2 => rough];
    trial.forall(1500, any, |queries| judge_covers(trial, queries, 0.0))?;
    trial.forall(2000, entries(true, true), |queries| judge_entries(trial, queries, true))
}

/// Judges whether spheres hold their points, up to an error relative to the largest coordinate.
fn judge_covers(trial: &Trial<'_>, queries: &[Vec<Vec3>], allowed: f64) -> Vec<CheckResult> {
    let judge = |points: &Vec<Vec3>, sphere| judge_cover(points, sphere, allowed);
    compare(queries, trial.kit.bounding_sphere(queries), judge)
}

fn judge_cover(points: &Vec<Vec3>, sphere: Sphere, allowed: f64) -> Judged {
    let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
    let distances = || points.iter().map(|point| point.as_dvec3().distance(center));
    let most = radius + allowed * reach(points);
    let outside = points.iter().zip(distances()).find(|(_, distance)| !(*distance <= most));
    let farthest = distances().fold(0.0, f64::max);
    // Rounding errors of the usual formulas: a few of the coordinates, and a few of the radius.
    let near = |right: f64| (radius - right).abs() <= 16.0 * U * (reach(points) + right);
    let min = points.iter().copied().fold(Vec3::INFINITY, Vec3::min).as_dvec3();
    let max = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max).as_dvec3();
    let mean = distances().sum::<f64>() / points.len() as f64;
    let ends = [points.first(), points.last()].map(|point| point.map_or(center, |point| point.as_dvec3()));
    let broken = || {
        let input = format!("bounding_sphere(&{})", list(points));
        let outside = outside.map_or(Vec3::NAN, |(point, _)| *point);
        let yours = format!("radius {radius:?} around {}, and {outside} lies outside", sphere.center);
        let rounded = "your radius is too small by a rounding error: compute it in double and round up";
        Broken::with_texts(input, yours, "a sphere that contains all points", "double precision")
            .explained_by([(near(farthest), rounded)])
    };
    // One point needs no radius.
    let open = points.len() < 2 && outside.is_none();
    let formulas = [
        "your radius is half the longest side of the box: its corners lie outside"
            .when(near(0.5 * (max - min).max_element())),
        "your radius is half the shortest side of the box: its corners lie outside"
            .when(near(0.5 * (max - min).min_element())),
        (near(mean), "your radius is the mean distance from the centre: take the largest"),
        "your sphere contains the first and the last point only".when(
            near(0.5 * ends[0].distance(ends[1]))
                && (center - 0.5 * (ends[0] + ends[1])).length() <= 16.0 * U * reach(points),
        ),
        "your radius is the smallest distance from the centre"
            .when(near(distances().fold(f64::INFINITY, f64::min))),
        (near(distances().next().unwrap_or(0.0)), "your radius is the distance of the first point"),
        (near(0.5 * farthest), "your radius is half the largest distance from the centre"),
        (near(farthest * farthest), "your radius is the square of the largest distance"),
    ];
    unless(outside.is_none(), broken).formulas(formulas.map(|(gives, text)| (gives || open, text)))
}

pub(super) fn sphere_is_small(trial: &Trial<'_>) -> CheckResult {
    trial.each(500, clouds(), <dyn Kit>::bounding_sphere, judge_size)
}

fn judge_size(points: &Vec<Vec3>, sphere: Sphere) -> Judged {
    let all: Vec<DVec3> = points.iter().map(|point| point.as_dvec3()).collect();
    let pairs = all.iter().flat_map(|p| all.iter().map(move |q| p.distance(*q)));
    let widest = pairs.fold(0.0, f64::max);
    // Jung's theorem: if no two points are farther apart than `widest`, the smallest sphere around them has a
    // radius of √(3/8) · widest at most. Its diameter is at least `widest`; half of that is demanded here, because
    // another check judges whether all points are inside.
    let most = 2.0 * (3.0f64 / 8.0).sqrt() * widest + 16.0 * U * reach(points) + f64::from(f32::MIN_POSITIVE);
    let radius = f64::from(sphere.radius);
    let is_large = radius > most;
    let [center, reach] = [sphere.center.as_dvec3().length(), reach(points)];
    let farthest = all.iter().map(|point| point.distance(sphere.center.as_dvec3())).fold(0.0, f64::max);
    let with_origin = all.iter().copied().chain([DVec3::ZERO]);
    let (min, max) =
        with_origin.fold((DVec3::ZERO, DVec3::ZERO), |(min, max), point| (min.min(point), max.max(point)));
    let broken = || {
        Broken::with_texts(
            format!("bounding_sphere(&{})", list(points)),
            format!("radius {radius:?}"),
            format!("{:?} to {most:?}, twice the radius of the smallest sphere", 0.25 * widest),
            "Jung's theorem",
        )
        .explained_by(["your sphere is too large: its radius is far above the largest distance of a point from its centre"
            .when(is_large && radius > 1.5 * farthest)])
    };
    unless(0.25 * widest <= radius && !is_large, broken).formulas([
        "your sphere is too large, because its centre is the origin: use the centre of the points' box"
            .when(center <= 16.0 * U * reach),
        "your sphere is too large, because your box includes the origin: start the minimum at infinity"
            .when((sphere.center.as_dvec3() - 0.5 * (min + max)).length() <= 16.0 * U * reach),
    ])
}

/// A sphere and a ray at any size. The coordinates are multiplied by `size`, and the direction by `speed`.
#[derive(Clone, Copy, Debug)]
struct Entry {
    plain: BoundingSphereQuery,
    size: f32,
    speed: f32,
}

impl Entry {
    fn asked(&self) -> BoundingSphereQuery {
        let (BoundingSphereQuery { ray, sphere }, t_scale) = (self.plain, self.size / self.speed);
        let scaled = Ray { origin: self.size * ray.origin, direction: self.speed * ray.direction, ..ray };
        BoundingSphereQuery {
            ray: scaled.with_range(t_scale * ray.t_min, t_scale * ray.t_max),
            sphere: Sphere { center: self.size * sphere.center, radius: self.size * sphere.radius },
        }
    }
}

/// The roots of the line and a sphere in double precision; `None` if the line misses it.
fn roots(ray: &Ray, sphere: &Sphere, squared_radius: f64) -> Option<[f64; 2]> {
    let (direction, to_center) = (ray.direction.as_dvec3(), sphere.center.as_dvec3() - ray.origin.as_dvec3());
    let (a, b) = (direction.length_squared(), to_center.dot(direction));
    let discriminant = a * squared_radius - to_center.cross(direction).length_squared();
    (discriminant >= 0.0).then(|| [-1.0, 1.0].map(|sign| (b + sign * discriminant.sqrt()) / a))
}

/// Judges the entries of rays. A search skips a sphere that is entered late, if only by a rounding error.
fn judge_entries(trial: &Trial<'_>, queries: &[Entry], never_late: bool) -> Vec<CheckResult> {
    let asked: Vec<BoundingSphereQuery> = queries.iter().map(Entry::asked).collect();
    // All sizes are powers of two, so the answers for the plain queries are exactly these.
    let plain = |(entry, yours): (&Entry, Option<f32>)| yours.map(|t| t * entry.speed / entry.size);
    let answers = queries.iter().zip(trial.kit.enter_bounding_sphere(&asked)).map(plain).collect();
    let judge = |entry: &Entry, yours: Option<f32>| {
        let BoundingSphereQuery { ray, sphere } = entry.plain;
        let first =
            |radius: f32| meet(&ray, Body::Sphere(Sphere { radius, ..sphere })).and_then(|meeting| meeting.t);
        let starts_inside = |radius: f32| (ray.at(ray.t_min) - sphere.center).length() < radius;
        let way = ((sphere.center - ray.origin).length() + sphere.radius) / ray.direction.length();
        let near = |t: f32, right: f32| (t - right).abs() <= 1e-5 * way;
        let (smaller, larger) = (0.999 * sphere.radius, 1.001 * sphere.radius);
        let describe = |t: Option<f32>| format!("{:?}", t.map(|t| entry.size / entry.speed * t));
        let broken = |right: Option<f32>, remark: &str| {
            let input = entry.asked().call("enter_bounding_sphere");
            let expected = format!("{}{remark}", describe(right));
            let mut shown = observations(entry, yours, right);
            // Powers of two change no digit, so only a limit tells the sizes apart.
            let plain = trial.kit.enter_bounding_sphere(&[entry.plain])[0];
            shown.push((
                plain.is_some() != yours.is_some() && plain.is_some() == right.is_some(),
                "you compare with a fixed limit: the ray finds the sphere at another size or length of direction",
            ));
            Err(Broken::with_texts(input, describe(yours), expected, "exact arithmetic").explained_by(shown))
        };
        if starts_inside(smaller) {
            return match yours {
                Some(t) if t == ray.t_min => Ok(()),
                _ => broken(Some(ray.t_min), ""),
            };
        }
        match (first(smaller), first(larger), yours) {
            // The ray passes through the inside: the entry must not be late.
            (Some(_), Some(early), None) => broken(Some(early), ""),
            (Some(late), Some(early), Some(t)) => {
                let exact = first(sphere.radius).unwrap_or(late);
                // Accept any answer for a ray whose range ends between the two spheres.
                let is_late = t > exact && (never_late || !near(t, exact));
                let is_early = t < ray.t_min || !(t >= early || near(t, early) || starts_inside(larger));
                if is_late || is_early { broken(Some(exact), ", or a little less") } else { Ok(()) }
            }
            (None, None, Some(_)) if !starts_inside(larger) => broken(None, ""),
            _ => Ok(()),
        }
    };
    compare_formulas(queries, answers, judge, |entry, yours| formulas(entry, *yours))
}

/// Whether a wrong method gives this `t`. It may round in another way; single precision has errors of some roundings.
fn near(t: f64, wrong: f64) -> bool {
    (t - wrong).abs() <= 1e-4 * wrong.abs().max(1.0)
}

/// Wrong formulas, each with whether it gives the answer `yours`.
fn formulas(entry: &Entry, yours: Option<f32>) -> Vec<(bool, &'static str)> {
    let BoundingSphereQuery { ray, sphere } = entry.plain;
    let radius = f64::from(sphere.radius);
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let is = |wrong: Option<f64>| agree(yours, wrong, |t, wrong| near(t.into(), wrong));
    let entered = |ends: Option<[f64; 2]>| {
        ends.and_then(|[enter, leave]| (leave >= t_min && enter <= t_max).then(|| enter.max(t_min)))
    };
    let ends = roots(&ray, &sphere, radius * radius);
    let length = f64::from(entry.speed) * ray.direction.as_dvec3().length();
    named![
        is(entered(ends.map(|ends| ends.map(|end| length * end)))) =>
            "your t has another unit, that of the world: it counts lengths of direction",
        is(entered(roots(&ray, &sphere, radius / f64::from(entry.size)))) =>
            "you use the radius in place of its square: the distance from the centre is squared, too",
        is(entered(roots(&ray, &sphere, radius * radius / (length * length)))) =>
            "direction is not a unit vector here: a = d·d belongs to the discriminant, too",
        is(entered(roots(&ray, &sphere, 4.0 * radius * radius))) =>
            "your sphere is too large: you compare with twice the radius",
    ]
    .to_vec()
}

/// Mistakes that the wrong answer `yours` shows where `right` is right.
fn observations(entry: &Entry, yours: Option<f32>, right: Option<f32>) -> Vec<(bool, &'static str)> {
    let BoundingSphereQuery { ray, sphere } = entry.plain;
    let radius = f64::from(sphere.radius);
    let ends = roots(&ray, &sphere, radius * radius);
    let is = |end: usize| matches!((yours, ends), (Some(t), Some(ends)) if near(t.into(), ends[end].min(ray.t_max.into())));
    let starts_inside = right == Some(ray.t_min);
    let found = yours.is_some() && right.is_none();
    let to_center = sphere.center.as_dvec3() - ray.origin.as_dvec3();
    let direction = ray.direction.as_dvec3();
    let closest = to_center.dot(direction) / direction.length_squared();
    let late = matches!((yours, right), (Some(yours), Some(right)) if yours > right && near(yours.into(), right.into()));
    named![
        late =>
            "you are late by a rounding error, and a search would skip a hit at this t: return a slightly earlier t",
        starts_inside && yours == Some(0.0) && ray.t_min != 0.0 =>
            "you return 0 for a ray that starts inside: it enters the sphere at t_min",
        yours.is_some_and(|t| near(t.into(), closest.max(ray.t_min.into()))) && right.is_some() =>
            "you return where the ray is closest to the centre: it enters the sphere before",
        starts_inside && is(0) => "you return a t before t_min: a ray that starts inside the sphere enters it at t_min",
        starts_inside && is(1) =>
            "you return where the ray leaves: a ray that starts inside the sphere enters it at t_min",
        starts_inside && yours.is_none() =>
            "you return None for a ray that starts inside: a ray that starts inside the sphere enters it at t_min",
        found && ends.is_some_and(|ends| ends[1] < ray.t_min.into()) =>
            "you return an entry for a sphere that lies behind the ray: the ray leaves it before t_min",
        found && ends.is_some_and(|ends| ends[0] > ray.t_max.into()) =>
            "you return an entry for a sphere that lies beyond t_max",
        found && ends.is_none() => "you return an entry for a sphere that lies beside the ray",
        is(1) => "your t is later than the entry, which is the nearer root",
    ].to_vec()
}

/// With `behind`, some ranges begin behind the origin.
fn entries(aimed: bool, behind: bool) -> impl Strategy<Value = Entry> + Clone {
    let directions = prop_oneof![3 => direction(), 1 => nasty::unit()];
    // The fourth power of a size, times the square of a speed, is a normal number in single precision.
    let scales = prop_oneof![
        2 => (Just(1.0f32), Just(1.0f32)),
        1 => (nasty::scale(-20..=20), nasty::scale(-12..=12)),
    ];
    (point(8), directions, sphere(), 0..4 + u32::from(behind), scales).prop_map(
        move |(origin, direction, sphere, range, (size, speed))| {
            let to_center = sphere.center - origin;
            let direction = if aimed && to_center != Vec3::ZERO {
                to_center + 0.5 * sphere.radius * direction.normalize()
            } else {
                direction
            };
            // The last range begins behind the origin, and the sphere lies there.
            let direction = if range == 4 { -direction } else { direction };
            let infinite = f32::INFINITY;
            let (t_min, t_max) =
                [(0.0, infinite), (0.5, infinite), (0.0, 0.75), (0.0, 16.0), (-16.0, infinite)]
                    [range as usize];
            let ray = Ray::new(origin, direction).with_range(t_min, t_max);
            Entry { plain: BoundingSphereQuery { ray, sphere }, size, speed }
        },
    )
}

/// The unit sphere, and a ray along the x axis from here.
fn along_x(from: f32) -> Entry {
    let sphere = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let ray = Ray::new(Vec3::new(from, 0.0, 0.0), Vec3::X);
    Entry { plain: BoundingSphereQuery { ray, sphere }, size: 1.0, speed: 1.0 }
}

pub(super) fn enter_bounding_sphere_finds_what_is_met(trial: &Trial<'_>) -> CheckResult {
    // The ray starts inside, and the centre lies behind it.
    let facing_away = along_x(0.5);
    trial.forall_and(&[facing_away], 3000, entries(true, false), |queries| {
        judge_entries(trial, queries, false)
    })?;
    ranges_that_begin_at_the_exit(trial)
}

/// Rays whose range begins exactly where they leave the sphere: this point belongs to the sphere and to the range.
fn ranges_that_begin_at_the_exit(trial: &Trial<'_>) -> CheckResult {
    let query = |from: f32| {
        let BoundingSphereQuery { ray, sphere } = along_x(from).plain;
        BoundingSphereQuery { ray: ray.with_range(1.0 - from, f32::INFINITY), sphere }
    };
    // Rays that touch the sphere at t = -x. The distance from the centre is 5 or 13, so no formula rounds.
    let touching = [(-4.0, 3.0), (-12.0, 5.0)].map(|(x, radius)| BoundingSphereQuery {
        ray: Ray::new(vec3(x, radius, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius },
    });
    let touched = compare(&touching, trial.kit.enter_bounding_sphere(&touching), |query, yours| {
        let (exact, slack) = (-query.ray.origin.x, 1e-5 * (query.ray.origin.length() + query.sphere.radius));
        if yours.is_some_and(|t| (exact - slack..=exact).contains(&t)) {
            return Ok(());
        }
        let says = "you return None for a ray that touches the sphere: the surface belongs to the sphere";
        Err(Broken::new(query.call("enter_bounding_sphere"), yours, Some(exact), "closed form")
            .explained_by([(yours.is_none(), says)]))
    });
    all_hold(touched)?;
    let queries: Vec<BoundingSphereQuery> = [-7.0, -3.0, -2.0, -1.0, 0.0, 0.5].map(query).into();
    all_hold(compare(&queries, trial.kit.enter_bounding_sphere(&queries), |query, yours| {
        let ray = &query.ray;
        if yours == Some(ray.t_min) {
            return Ok(());
        }
        let input = query.call("enter_bounding_sphere");
        Err(Broken::new(input, yours, Some(ray.t_min), "closed form")
            .explained_by(["you return None for a ray whose range begins where it leaves the sphere: the surface belongs to the sphere"
                .when(yours.is_none())]))
    }))
}

pub(super) fn enter_bounding_sphere_passes_what_is_missed(trial: &Trial<'_>) -> CheckResult {
    let behind = along_x(5.0);
    trial.forall_and(&[behind], 3000, entries(false, false), |queries| judge_entries(trial, queries, false))
}
