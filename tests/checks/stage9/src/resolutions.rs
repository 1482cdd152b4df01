//! The laws of the resolution of a grid and of the interval of a ray in a cell.

use super::scenes::{Scales, rays, scales};
use checks::double::slabs_interval;
use checks::prelude::*;
use glam::{UVec3, uvec3};

pub(super) fn spans_of_cells_agree_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let on_lattice = (nasty::lattice(4), nasty::lattice(3));
    let cell = prop_oneof![3 => on_lattice, 1 => (rough_point(4.0), rough_point(3.0))]
        .prop_map(|(corner, size)| Aabb::new(corner, corner + size.abs()));
    let inputs = (cell, rays(), scales(), 0..24usize).prop_map(|(bounds, ray, scales, range)| Spanned {
        plain: SlabQuery { ray: at_border(ray, &bounds, range), bounds },
        scales,
    });
    let empty = SlabQuery { ray: Ray::new(Vec3::ZERO, Vec3::X), bounds: Aabb::EMPTY };
    // A cell that is empty along one axis, by a rounding error.
    let thin = Aabb::new(Vec3::ZERO, vec3(1.0, 1.0, -f32::MIN_POSITIVE));
    let through = SlabQuery { ray: Ray::new(vec3(0.5, 0.25, -1.0), Vec3::Z), bounds: thin };
    let plain = |plain| Spanned { plain, scales: Scales { size: 1.0, speed: 1.0 } };
    trial.forall_and(&[empty, through].map(plain), 1000, inputs, |queries| judge_spans(trial, queries))
}

/// The ray with a range that begins or ends where the ray enters the box (six ranges) or leaves it (six more), or one float
/// beside it. For six numbers it begins in the middle of the box, which may lie behind the origin. For other numbers, and if the
/// ray never enters the box, the range is that of the ray.
fn at_border(ray: Ray, bounds: &Aabb, range: usize) -> Ray {
    let (near, far) = slabs_interval(&ray, bounds);
    let t = if range < 6 { near } else { far } as f32;
    match nasty::ranges(t).get(range % 6) {
        Some(((t_min, t_max), _)) if range < 12 && t > 0.0 && t.is_finite() => ray.with_range(*t_min, *t_max),
        _ if (12..18).contains(&range) && near.is_finite() => {
            ray.with_range((0.5 * (near + far)) as f32, f32::INFINITY)
        }
        _ => ray,
    }
}

/// A cell and a ray, and the scales at which the student's function receives them.
#[derive(Clone, Copy, Debug)]
struct Spanned {
    plain: SlabQuery,
    scales: Scales,
}

impl Spanned {
    fn asked(&self) -> SlabQuery {
        let Spanned { plain: SlabQuery { ray, bounds }, scales } = self;
        let bounds = Aabb::new(scales.size * bounds.min, scales.size * bounds.max);
        SlabQuery { ray: scales.of_ray(ray), bounds }
    }
}

fn judge_spans(trial: &Trial<'_>, queries: &[Spanned]) -> Vec<CheckResult> {
    let asked: Vec<SlabQuery> = queries.iter().map(Spanned::asked).collect();
    compare(queries, trial.kit.cell_span(&asked), |spanned, yours| {
        let query = &spanned.plain;
        // All scales are powers of two, so the answer for the plain query is exactly this.
        let t_scale = f64::from(spanned.scales.size / spanned.scales.speed);
        let yours = yours.map(|(t, t_end)| (t / t_scale, t_end / t_scale));
        let (near, far) = slabs_interval(&query.ray, &query.bounds);
        let range = (f64::from(query.ray.t_min), f64::from(query.ray.t_max));
        let expected = (near.max(range.0), far.min(range.1));
        // Allow 2⁻¹⁸ for rounding, relative to t or to the numbers from which t is computed. If a ray passes a corner
        // or a flat box within this distance, both answers are accepted.
        let room = |t: f64| (-18f64).exp2() * (1.0 + t.abs());
        let close = |p: f64, q: f64| p == q || (p - q).abs() <= room(q);
        // Range and faces have room for rounding, 2⁻²⁰ of `t`. Demand half of it at each end, because the product may be
        // rounded.
        let half = |t: f64| if t.is_finite() { (-21f64).exp2() * t.abs() } else { 0.0 };
        let wider = (expected.0 - half(expected.0), expected.1 + half(expected.1));
        let is_close = |(t, t_end): (f64, f64)| close(t, expected.0) && close(t_end, expected.1);
        let is_empty = query.bounds.is_empty();
        let has_span = !is_empty && expected.0 <= expected.1 + room(expected.1);
        let fits = match yours {
            Some(span) => has_span && is_close(span) && (span.0 <= wider.0 && span.1 >= wider.1),
            None => is_empty || !(wider.0 <= wider.1),
        };
        if fits {
            return Ok(());
        }
        // The interval without the axes along which the ray does not move.
        let mut open = query.bounds;
        for axis in 0..3 {
            if query.ray.direction[axis] == 0.0 {
                (open.min[axis], open.max[axis]) = (f32::NEG_INFINITY, f32::INFINITY);
            }
        }
        let (near_open, far_open) = slabs_interval(&query.ray, &open);
        let unasked = yours.is_some_and(|(t, t_end)| {
            close(t, near_open.max(range.0)) && close(t_end, far_open.min(range.1))
        });
        let along_a_face = (0..3).any(|axis| {
            let (at, bounds) = (query.ray.origin[axis], query.bounds);
            query.ray.direction[axis] == 0.0 && (at == bounds.min[axis] || at == bounds.max[axis])
        });
        let parallel = query.ray.direction.to_array().contains(&0.0);
        let is_none = yours.is_none();
        let mistakes = [
            "you return NaN: 0 / 0 for a ray in the plane of a face"
                .when(yours.is_some_and(|(t, t_end)| t.is_nan() || t_end.is_nan())),
            (!is_none && is_empty, "you return a span for an empty cell"),
            (
                // A span behind the origin is lost by a range that begins there.
                yours.map_or(expected.0 <= expected.1 && expected.1 < 0.0, |(t, t_end)| {
                    t < range.0 - room(range.0) || t_end > range.1 + room(range.1)
                }),
                "you ignore the range of the ray",
            ),
            (is_none && near == far, "you return None for a ray that touches the cell: the cell is closed"),
            "a ray along a face is between the two planes for every t or for no t: you do not compare its origin with them"
                .when(parallel && unasked),
            "you return None for a ray along a face, in its plane: the cell is closed"
                .when(is_none && along_a_face),
            "you return None for a ray along a face: between the two planes it is inside for every t"
                .when(is_none && parallel),
            "your answer is wrong for a ray along a face: its direction is 0 there, so compare its origin with both planes"
                .when(parallel),
            "the span lacks the room for rounding: the range of the ray and the faces have ROUNDING as room, at a negative t as well"
                .when(yours.map_or(expected.0 > expected.1, |span| has_span && is_close(span))),
        ];
        let expected = match expected {
            (t, t_end) if t <= t_end && !yours.is_some_and(is_close) => Some(expected),
            _ => (!is_empty && wider.0 <= wider.1).then_some(wider),
        };
        let at_scale = |span: Option<(f64, f64)>| span.map(|(t, t_end)| (t_scale * t, t_scale * t_end));
        let input = spanned.asked().call("span");
        Err(Broken::new(input, at_scale(yours), at_scale(expected), "double precision")
            .explained_by(mistakes))
    })
}

fn describe(query: &ResolutionQuery) -> String {
    format!("resolution({}, {}, {:?})", query.bounds.paste(), query.n_primitives, query.density)
}

pub(super) fn grid_resolution_makes_cubes(trial: &Trial<'_>) -> CheckResult {
    let size =
        (4..=40i32, 4..=40i32, 4..=40i32).prop_map(|(x, y, z)| vec3(x as f32, y as f32, z as f32) / 4.0);
    let inputs = (size, nasty::lattice(4), nasty::any_scale(), 500..20_000usize, 1..=8i32).prop_map(
        |(size, min, scale, n_primitives, density)| ResolutionQuery {
            bounds: Aabb::new(scale * min, scale * (min + size)),
            n_primitives,
            density: density as f32 / 2.0,
        },
    );
    trial.each(200, inputs, <dyn Kit>::grid_resolution, |query, yours| {
        let wanted = f64::from(query.density) * query.n_primitives as f64;
        let n: f64 = yours.to_array().into_iter().map(f64::from).product();
        let side = (query.bounds.max - query.bounds.min) / yours.as_vec3();
        let cubes = side.max_element() <= 2.0 * side.min_element();
        // Rounding up or down on three axes of five or more cells changes the number by at most half.
        let is_right = cubes && 0.5 * wanted <= n && n <= 2.0 * wanted;
        let broken = || {
            let expected = format!("about {wanted} cells that are nearly cubes");
            let yours = format!("{yours}, {n} cells");
            Broken::with_texts(describe(query), yours, expected, "the definition").explained_by(named![
                !cubes => "your cells are not nearly cubes",
                n < wanted => "you make too few cells: the product over the three axes must be about density · n",
                n > wanted => "you make too many cells: the product over the three axes must be about density · n",
            ])
        };
        unless(is_right, broken).formulas([
            "you make as many cells on every axis: a longer side needs more"
                .when(yours.x == yours.y && yours.y == yours.z),
            (cubes && (n * f64::from(query.density) / wanted - 1.0).abs() < 0.6, "you leave out the density"),
        ])
    })
}

pub(super) fn grid_resolution_of_flat_and_empty_boxes(trial: &Trial<'_>) -> CheckResult {
    let query = |max: Vec3, n_primitives: usize, density: f32| ResolutionQuery {
        bounds: Aabb::new(Vec3::ZERO, max),
        n_primitives,
        density,
    };
    let empty = ResolutionQuery { bounds: Aabb::EMPTY, n_primitives: 0, density: 2.0 };
    // A box with a corner `min` above `max` is empty, too.
    let inverted =
        ResolutionQuery { bounds: Aabb::new(Vec3::X, vec3(0.0, 8.0, 8.0)), n_primitives: 64, density: 1.0 };
    let cases = [
        (query(vec3(8.0, 8.0, 0.0), 64, 1.0), uvec3(8, 8, 1)),
        (query(vec3(0.0, 16.0, 4.0), 64, 1.0), uvec3(1, 16, 4)),
        (query(vec3(0.0, 0.0, 5.0), 10, 2.0), uvec3(1, 1, 20)),
        (query(Vec3::ZERO, 10, 2.0), UVec3::ONE),
        (query(vec3(100.0, 1e-3, 100.0), 100, 1.0), uvec3(10, 1, 10)),
        (query(Vec3::ONE, 0, 2.0), UVec3::ONE),
        (empty, UVec3::ONE),
        (inverted, UVec3::ONE),
        (query(Vec3::splat(1e30), 8, 1.0), UVec3::splat(2)),
        (query(vec3(1e6, 1.0, 1.0), 1000, 1.0), uvec3(256, 1, 1)),
    ];
    let queries = cases.map(|(query, _)| query);
    let judge = |(query, expected): &(ResolutionQuery, UVec3), yours: UVec3| {
        // Accept rounding up or down. A flat axis has exactly one cell, and the limit holds.
        let fits = (0..3).all(|axis| match expected[axis] {
            1 => yours[axis] == 1,
            n => yours[axis].abs_diff(n) <= 1.max(n / 8) && (1..=256).contains(&yours[axis]),
        });
        if fits {
            return Ok(());
        }
        let size = query.bounds.max - query.bounds.min;
        let flat = size.min_element() < 1e-4 * size.max_element();
        Err(Broken::new(describe(query), yours, expected, "by hand").explained_by([
            (yours.max_element() > 256, "you return more cells along an axis than MOST_CELLS_ALONG"),
            "a flat box has no volume: use only the thick axes, whose product is an area or a length"
                .when(flat && !query.bounds.is_empty() && yours.max_element() <= 256),
            "an empty box, or one without primitives, gets one cell"
                .when(query.bounds.is_empty() || query.n_primitives == 0),
            (yours.min_element() == 0, "you return an axis without a cell: at least 1"),
        ]))
    };
    all_hold(compare(&cases, trial.kit.grid_resolution(&queries), judge))
}
