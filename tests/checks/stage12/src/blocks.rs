//! `may_hit`: it keeps every triangle that may be hit, and rejects nearly all others.

use checks::prelude::*;
use oracle::STABLE;
use oracle::exact::{Body, meet, triangle};
use oracle::gauntlet::distributions::DISTRIBUTIONS;
use oracle::gauntlet::families::families;
use oracle::gauntlet::leaks::{Aim, aimed};
use oracle::gauntlet::meshes::{Closed, closed};
use oracle::splitmix::Random;
use raykata::wide::{BLOCK, Filtered, LARGEST, NO_PRIMITIVE, TriangleBlock};

/// A block of triangles, and a ray.
struct Lanes {
    triangles: Vec<Triangle>,
    ray: Ray,
}

impl Lanes {
    /// The query; `None` if a coordinate of the ray is so large that frames do not ask.
    fn query(&self) -> Option<BlockQuery> {
        let largest = self.ray.origin.abs().max(self.ray.direction.abs()).max_element();
        let ids =
            std::array::from_fn(|lane| if lane < self.triangles.len() { lane as u32 } else { NO_PRIMITIVE });
        let block = TriangleBlock::new(ids, |id| self.triangles.get(id as usize).copied());
        (largest <= LARGEST).then(|| BlockQuery { block: Box::new(block), ray: self.ray })
    }
}

/// The exact `t` of a hit within the range of the ray, rounded once.
fn exact(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let line = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    meet(&line, Body::Triangle(*triangle))?.t.filter(|&t| ray.contains(t))
}

/// The causes that a rejected hit can prove.
fn causes(ray: &Ray, triangle: &Triangle, t: f32) -> [(bool, &'static str); 6] {
    let Triangle { a, b, c } = triangle;
    let normal = (*b - *a).as_dvec3().cross((*c - *a).as_dvec3());
    let slope = normal.dot(ray.direction.as_dvec3()).abs();
    let edge_on = slope <= 1e-5 * normal.length() * ray.direction.as_dvec3().length();
    let size = (*b - *a).abs().max((*c - *a).abs()).max_element();
    let is_far = (*a - ray.origin).abs().max_element() > 1e3 * size;
    let clear = triangle::margin(ray, triangle).is_some_and(|margin| margin > STABLE);
    let at_end = t >= ray.t_max.next_down().next_down() || t <= ray.t_min.next_up().next_up();
    let is_too_large = a.abs().max(b.abs()).max(c.abs()).max_element() > LARGEST;
    named![
        is_too_large => NAN_REJECTED,
        edge_on => "the triangle is seen edge-on: where d·n is smaller than its error, neither its sign nor that of t is known",
        at_end && clear => "the hit is at an end of the range: reject it only if it is beyond the end by more than its error",
        is_far && !clear => "rounding errors decide here, and they grow with the distance of the triangle, not with its size",
        !clear => "rounding errors decide here: reject only if both numbers are larger than their errors",
        clear => "no rounding decides here: a sign of U, V, W, N or t is wrong, or what follows from it",
    ]
}

/// Judges the lanes of one block: none that is hit may be rejected, and a certain one must be met by the line of the ray.
fn judge_hits(lanes: &Lanes, filtered: Filtered) -> CheckResult {
    let Filtered { possible, certain } = filtered;
    if (possible | certain) >> BLOCK != 0 {
        return Err(Broken::new("may_hit", format!("{filtered:x?}"), "eight bits", "the definition"));
    }
    let line = lanes.ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    for (lane, triangle) in lanes.triangles.iter().enumerate() {
        if certain >> lane & 1 == 1 && exact(&line, triangle).is_none() {
            let input = format!("may_hit of {}, lane {lane}: {}", lanes.ray.paste(), triangle.paste());
            let broken =
                Broken::with_texts(input, "certain", "not certain: its line passes beside it", "exactly");
            return Err(broken.because("a lane is certain only if U, V and W are all above their error, or all below minus their error, and N is larger than its own"));
        }
        let Some(t) = exact(&lanes.ray, triangle) else { continue };
        if possible >> lane & 1 == 0 {
            let input = format!("may_hit of {}, lane {lane}: {}", lanes.ray.paste(), triangle.paste());
            let broken =
                Broken::with_texts(input, "rejected", format!("kept: it is hit at t = {t:?}"), "exactly");
            return Err(broken.explained_by(causes(&lanes.ray, triangle, t)));
        }
    }
    Ok(())
}

/// Rays straight at the middle of a triangle, from both sides. No rounding decides about them unless the triangle is thin.
fn straight_at(triangle: &Triangle) -> [Lanes; 2] {
    let Triangle { a, b, c } = triangle;
    let middle = (*a + *b + *c) / 3.0;
    let size = (*b - *a).abs().max((*c - *a).abs()).max_element();
    let away = size * (*b - *a).as_dvec3().cross((*c - *a).as_dvec3()).normalize_or_zero().as_vec3();
    [away, -away].map(|away| Lanes { triangles: vec![*triangle], ray: Ray::new(middle + away, -away) })
}

const NAN_REJECTED: &str = "a lane with NaN is rejected: it holds another shape, or a triangle too large for a block. A comparison with NaN is false, so reject where a comparison is true";

const NONE_REJECTED: &str = "nothing is rejected, so each triangle is tested again";

/// The blocks that frames ask about, with their queries.
fn queries(drawn: Vec<Lanes>) -> (Vec<Lanes>, Vec<BlockQuery>) {
    drawn.into_iter().filter_map(|lanes| lanes.query().map(|query| (lanes, query))).unzip()
}

fn judge_all(trial: &Trial<'_>, drawn: Vec<Lanes>) -> CheckResult {
    // Triangles behind the ray and beside it: a constant that keeps each lane is wrong.
    let triangles = vec![Triangle { a: Vec3::X, b: Vec3::Y, c: Vec3::Z }; BLOCK];
    let from = Vec3::splat(trial.varied(4.0, 3.0..9f32));
    let beside = Lanes { triangles, ray: Ray::new(from, Vec3::new(1.0, -0.25, 0.5)) };
    if beside.query().is_some_and(|query| trial.kit.may_hit(&[query])[0].possible == 255) {
        let broken =
            Broken::new("may_hit of a block beside the ray", "all kept", "misses rejected", "exactly");
        return Err(broken.because(NONE_REJECTED));
    }
    let (drawn, asked) = queries(drawn);
    all_hold(compare(&drawn, trial.kit.may_hit(&asked), |lanes, filtered| {
        judge_hits(lanes, filtered).map_err(|broken| {
            // A clear hit that is rejected, too, is the simpler example, and shows that no rounding decides.
            let (clear, asked) = queries(lanes.triangles.iter().flat_map(straight_at).collect());
            let simpler = all_hold(compare(&clear, trial.kit.may_hit(&asked), judge_hits));
            let broken = simpler.err().unwrap_or(broken);
            // A direction whose length is multiplied by a power of two, and a range that is divided by it, changes no digit.
            let length = lanes.ray.direction.abs().max_element();
            let scale = 2f32.powi(-length.log2().floor().clamp(-120.0, 120.0) as i32);
            let ray = lanes.ray.with_range(lanes.ray.t_min / scale, lanes.ray.t_max / scale);
            let ray = Ray { direction: scale * ray.direction, ..ray };
            let lanes = Lanes { triangles: lanes.triangles.clone(), ray };
            let query = lanes.query().filter(|_| scale != 1.0);
            let again = query.map(|query| trial.kit.may_hit(&[query])[0]);
            let is_right = again.is_some_and(|filtered| judge_hits(&lanes, filtered).is_ok());
            broken.explained_by(named![
                is_right => "the bound is right for a direction of length 1 only: the error of t grows as 1 / |d_z|",
            ])
        })
    }))
}

pub(super) fn may_hit_keeps_what_is_hit(trial: &Trial<'_>) -> CheckResult {
    DISTRIBUTIONS.iter().zip(30..).try_for_each(|(distribution, stream)| {
        let mut random = Random::new(trial.seed, stream);
        let drawn = (0..250).map(|_| {
            let (ray, first) = (distribution.draw)(&mut random);
            let others = (0..7).map(|_| (distribution.draw)(&mut random).1);
            let triangles = std::iter::once(first).chain(others).collect();
            Lanes { triangles, ray: Ray { t_min: ray.t_min.max(0.0), ..ray } }
        });
        judge_all(trial, drawn.collect())
    })
}

/// A ray whose range begins one float before its hit, or ends one float or far behind it; `None` without a hit.
fn at_the_ends(random: &mut Random, ray: &Ray, triangle: Triangle) -> Option<Lanes> {
    let ray = Ray::new(ray.origin, ray.direction);
    let t = exact(&ray, &triangle)?;
    let (t_min, t_max) = match random.below(4) {
        0 => (t.next_down().max(0.0), f32::INFINITY),
        1 => (0.0, t.next_up()),
        2 => (0.0, t * 2f32.powi(1 + random.below(40) as i32)),
        _ => (t.next_down().max(0.0), t.next_up()),
    };
    let triangles = vec![triangle; 1 + random.below(8) as usize];
    Some(Lanes { triangles, ray: ray.with_range(t_min, t_max) })
}

/// A ray that starts near the corner a of a triangle and hits it far from there, at any `t`. So the error of `t` depends on the way
/// of the ray, and not on the distance of the corner.
fn a_long_way(random: &mut Random) -> (Ray, Triangle) {
    let scale = 2f32.powi(random.below(121) as i32 - 81);
    let [a, b, c] = [(); 3].map(|()| scale * random.in_cube());
    let origin = a + scale * 2f32.powi(-1 - random.below(12) as i32) * random.in_cube();
    let target = a.lerp(b.lerp(c, random.unit()), 0.5 + 0.5 * random.unit());
    let t = 2f32.powi(random.below(81) as i32 - 40);
    (Ray::new(origin, (target - origin) / t), Triangle { a, b, c })
}

pub(super) fn may_hit_keeps_hits_at_the_ends_of_the_range(trial: &Trial<'_>) -> CheckResult {
    for (index, distribution) in DISTRIBUTIONS.iter().enumerate() {
        let mut random = Random::new(trial.seed, 50 + index as u64);
        let drawn = (0..300).filter_map(|_| {
            let (ray, first) = (distribution.draw)(&mut random);
            at_the_ends(&mut random, &ray, first)
        });
        judge_all(trial, drawn.collect())?;
    }
    let mut random = Random::new(trial.seed, 49);
    let drawn = (0..1000).filter_map(|_| {
        let (ray, first) = a_long_way(&mut random);
        at_the_ends(&mut random, &ray, first)
    });
    judge_all(trial, drawn.collect())
}

/// Rays from inside closed meshes, each with the triangles around the vertex near which it should hit.
fn aimed_lanes(trial: &Trial<'_>, mesh: &Closed, index: u64) -> Vec<Lanes> {
    let mut random = Random::new(trial.seed, 70 + index);
    let mut drawn = Vec::new();
    for n in 0..60 {
        let (ray, vertex) = aimed(mesh, Aim::ALL[n % 2], &mut random);
        let fan: Vec<Triangle> =
            mesh.fans[vertex as usize].iter().map(|&index| mesh.triangle(index)).collect();
        drawn.extend(fan.chunks(BLOCK).map(|part| Lanes { triangles: part.to_vec(), ray }));
    }
    drawn
}

pub(super) fn may_hit_loses_no_ray_at_an_edge(trial: &Trial<'_>) -> CheckResult {
    let meshes = closed().into_iter().chain(families());
    meshes.zip(0..).try_for_each(|(mesh, index)| judge_all(trial, aimed_lanes(trial, &mesh, index)))
}

pub(super) fn may_hit_of_any_size(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 90);
    let mut drawn = Vec::new();
    for _ in 0..3000 {
        // Scales up to LARGEST, down to where products of three lengths underflow, and triangles far from the origin.
        let scale = 2f32.powi(random.below(161) as i32 - 121);
        let place = [0.0, 1.0, 1e3, 1e6][random.below(4) as usize] * random.in_cube();
        let corner = |random: &mut Random| scale * (place + random.in_cube());
        let [a, b, c] = [(); 3].map(|()| corner(&mut random));
        let origin = scale * (place + 4.0 * random.in_cube());
        let target = a.lerp(b, random.unit()).lerp(c, [0.0, 0.5][random.below(2) as usize] * random.unit());
        // Half of the directions have a length of their own, and half of their ranges begin one float before the hit.
        let way = (target - origin).as_dvec3();
        let length = 2f64.powi(random.below(79) as i32 - 39);
        let ray = match random.below(4) {
            0 => Ray::new(origin, way.as_vec3()),
            1 => Ray::new(origin, way.normalize_or_zero().as_vec3()),
            2 => Ray::new(origin, (length * way.normalize_or_zero()).as_vec3()),
            _ => {
                let ray = Ray::new(origin, (length * way.normalize_or_zero()).as_vec3());
                let t = exact(&ray, &Triangle { a, b, c }).unwrap_or(0.0);
                ray.with_range(t.next_down().max(0.0), f32::INFINITY)
            }
        };
        if ray.direction != Vec3::ZERO {
            drawn.push(Lanes { triangles: vec![Triangle { a, b, c }; 2], ray });
        }
    }
    judge_all(trial, drawn)
}

pub(super) fn may_hit_keeps_lanes_without_a_triangle(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 91);
    let mut drawn = Vec::new();
    for _ in 0..300 {
        let n = random.below(8) as usize;
        let mut corner = || 0.5 * random.in_cube();
        let mut triangles: Vec<Triangle> =
            (0..n).map(|_| Triangle { a: corner(), b: corner(), c: corner() }).collect();
        // A triangle with too large a coordinate gets NaN, like another shape.
        triangles.insert(0, Triangle { a: Vec3::splat(4.0 * LARGEST), b: Vec3::X, c: Vec3::Y });
        drawn.push(Lanes { triangles, ray: Ray::new(4.0 * random.direction(), random.direction()) });
    }
    let (drawn, queries) = queries(drawn);
    let without =
        |query: &BlockQuery| (0..BLOCK).filter(|&lane| query.block.size[lane].is_nan()).collect::<Vec<_>>();
    let masks = trial.kit.may_hit(&queries);
    // Some lane with a triangle must be rejected, because 255 is no answer to every question.
    let rejected = masks
        .iter()
        .zip(&drawn)
        .filter(|(mask, lanes)| mask.possible.count_ones() < 8 && lanes.triangles.len() > 1)
        .count();
    let judge = |query: &BlockQuery, Filtered { possible, certain }| {
        let lost = without(query).into_iter().find(|lane| (possible & !certain) >> lane & 1 == 0);
        let Some(lane) = lost else { return Ok(()) };
        let input = format!("may_hit of {}, lane {lane} with NaN", query.ray.paste());
        let yours = if certain >> lane & 1 == 1 { "certain" } else { "rejected" };
        Err(Broken::with_texts(input, yours, "possible", "the definition").explained_by(named![
            yours == "rejected" => NAN_REJECTED,
            yours == "certain" => "a lane with NaN is certain: it holds another shape, whose test must decide",
        ]))
    };
    all_hold(compare(&queries, masks, judge))?;
    if rejected == 0 {
        let broken =
            Broken::new("may_hit of 300 blocks", "all triangles kept", "misses rejected", "the definition");
        return Err(broken.because(NONE_REJECTED));
    }
    Ok(())
}

/// The share of sure misses that must be rejected.
const REJECTED: f64 = 0.99;

/// Judges the share of sure misses that are rejected, and that hits are kept.
fn judge_share(trial: &Trial<'_>, what: &str, drawn: &[Lanes], cause: &'static str) -> CheckResult {
    let queries: Vec<BlockQuery> = drawn.iter().filter_map(Lanes::query).collect();
    let masks = trial.kit.may_hit(&queries);
    all_hold(compare(drawn, masks.clone(), judge_hits))?;
    let (mut misses, mut rejected, mut n_hits, mut certain) = (0, 0, 0, 0);
    for (lanes, mask) in drawn.iter().zip(masks) {
        for (lane, triangle) in lanes.triangles.iter().enumerate() {
            if exact(&lanes.ray, triangle).is_some() {
                n_hits += 1;
                certain += usize::from(mask.certain >> lane & 1 == 1);
            } else {
                misses += 1;
                rejected += usize::from(mask.possible >> lane & 1 == 0);
            }
        }
    }
    assert!(n_hits > 100 && misses > 100, "{what}: {n_hits} hits, {misses} misses");
    if 2 * certain < n_hits {
        let input = format!("may_hit of {} blocks: {what}", drawn.len());
        let yours = format!("{certain} of {n_hits} hits are certain");
        return Err(Broken::with_texts(input, yours, "at least half", "exactly")
            .explained_by(["no lane is certain: it is if U, V, W and N have the same sign for certain"
                .when(certain == 0)]));
    }
    if rejected as f64 >= REJECTED * misses as f64 {
        return Ok(());
    }
    let input = format!("may_hit of {} blocks: {what}", drawn.len());
    let yours = format!("{rejected} of {misses} misses are rejected");
    Err(Broken::with_texts(input, yours, format!("at least {:.0} %", 100.0 * REJECTED), "exactly")
        .explained_by([(2 * rejected < misses, cause)]))
}

pub(super) fn may_hit_rejects_rays_beside_a_triangle(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 92);
    // Small triangles in a cube, seen from two units away.
    let drawn: Vec<Lanes> = (0..3000)
        .map(|_| {
            let triangles = (0..8).map(|_| {
                let [a, b, c] = [(); 3].map(|()| 0.1 * random.in_cube());
                Triangle { a, b, c }
            });
            let triangles = triangles.collect();
            let origin = 2.0 * random.direction();
            Lanes { triangles, ray: Ray::new(origin, 0.1 * random.in_cube() - origin) }
        })
        .collect();
    judge_share(
        trial,
        "triangles beside which the ray passes",
        &drawn,
        "most misses are kept: if two of U, V, W have different signs for certain, the ray misses",
    )
}

pub(super) fn may_hit_rejects_hits_outside_of_the_range(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 93);
    // Rays aimed at the middle of triangles, of which half begin behind the triangle, end before it, or point away.
    let drawn: Vec<Lanes> = (0..2000)
        .map(|_| {
            let place = 2.0 * random.direction();
            let triangles: Vec<Triangle> = (0..8)
                .map(|_| {
                    let [a, b, c] = [(); 3].map(|()| place + random.in_cube());
                    // Move the triangle such that its centre is at `place`.
                    let shift = place - (a + b + c) / 3.0;
                    Triangle { a: a + shift, b: b + shift, c: c + shift }
                })
                .collect();
            let ray = Ray::new(Vec3::ZERO, place);
            let ray = match random.below(6) {
                0 => Ray::new(Vec3::ZERO, -place),
                1 => ray.with_range(0.0, 0.5 + 0.4 * random.unit()),
                2 => ray.with_range(1.1 + random.unit(), f32::INFINITY),
                _ => ray,
            };
            Lanes { triangles, ray }
        })
        .collect();
    judge_share(
        trial,
        "triangles in the line of the ray, outside of its range",
        &drawn,
        "most hits outside of the range are kept: compare t with t_min and t_max",
    )
}
