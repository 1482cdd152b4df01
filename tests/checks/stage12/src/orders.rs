//! `stream_order`: every ray once, by octant and along the curve of Morton.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, compare_formulas};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use raykata::ray::Ray;

/// Rays whose origins lie on a grid, or anywhere, or are all equal. Directions are often parallel to an axis.
fn rays(most: usize) -> impl Strategy<Value = Vec<Ray>> + Clone {
    let component = prop::sample::select(vec![-1.0f32, -0.5, -0.0, 0.0, 0.5, 1.0]);
    let direction = prop::array::uniform3(component)
        .prop_map(Vec3::from_array)
        .prop_map(|d| if d == Vec3::ZERO { Vec3::NEG_X } else { d });
    let origin = prop_oneof![
        2 => checks::generate::point(8),
        2 => checks::generate::rough_point(8.0),
        1 => Just(Vec3::ONE),
    ];
    prop::collection::vec((origin, direction), 0..=most)
        .prop_map(|rays| rays.into_iter().map(|(origin, direction)| Ray::new(origin, direction)).collect())
}

/// Rays of one octant, whose origins lie anywhere, and half of them so close together that they share larger cells.
fn one_octant(most: usize) -> impl Strategy<Value = Vec<Ray>> + Clone {
    let origin = (checks::generate::rough_point(8.0), any::<bool>())
        .prop_map(|(point, is_near)| if is_near { point / 64.0 } else { point });
    prop::collection::vec(origin, 2..=most)
        .prop_map(|origins| origins.into_iter().map(|origin| Ray::new(origin, Vec3::ONE)).collect())
}

fn octant(ray: &Ray) -> u32 {
    (0..3).map(|axis| u32::from(ray.direction[axis] < 0.0) << axis).sum()
}

/// The number of cells along an axis.
const CELLS: f64 = 1024.0;

/// An origin that is closer than this part of a cell to the next one may count there, because formulas round differently.
const ROUNDING: f64 = 1e-3;

/// Where all origins lie: for each the place in units of cells, or 0 on an axis without extent.
fn places(rays: &[Ray]) -> Vec<DVec3> {
    let origins = || rays.iter().map(|ray| ray.origin.as_dvec3());
    let (low, high) =
        (origins().fold(DVec3::INFINITY, DVec3::min), origins().fold(DVec3::NEG_INFINITY, DVec3::max));
    let size = (high - low).map(|size| if size > 0.0 { size } else { f64::INFINITY });
    origins().map(|origin| CELLS * (origin - low) / size).collect()
}

/// A code of cells, with bit `b` of the cell on an axis at `3 b + shift[axis]`.
fn code(cells: [u32; 3], shift: [u32; 3]) -> u32 {
    (0..30)
        .map(|bit| (cells[bit as usize % 3] >> (bit / 3) & 1) << (bit - bit % 3 + shift[bit as usize % 3]))
        .sum()
}

/// All codes that a place may have by rounding, in ascending order.
fn codes(place: DVec3) -> Vec<u32> {
    let cell = |at: f64| (at.floor() as u32).min(CELLS as u32 - 1);
    let near = place.to_array().map(|at| [cell((at - ROUNDING).max(0.0)), cell(at + ROUNDING)]);
    let mut codes: Vec<u32> =
        (0..8).map(|i| code([near[0][i & 1], near[1][i >> 1 & 1], near[2][i >> 2]], [0, 1, 2])).collect();
    codes.sort_unstable();
    codes
}

fn describe(rays: &[Ray]) -> String {
    let shown: Vec<String> = rays
        .iter()
        .take(5)
        .map(|ray| format!("{:?} → {:?}", ray.origin.to_array(), ray.direction.to_array()))
        .collect();
    let more = if rays.len() > 5 { ", …" } else { "" };
    format!("stream_order of {} rays: {}{more}", rays.len(), shown.join(", "))
}

fn shown(order: &[u32]) -> String {
    let more = if order.len() > 20 { ", …" } else { "" };
    format!("{:?}{more}", &order[..order.len().min(20)])
}

fn judge_permutation(rays: &[Ray], yours: &[u32]) -> CheckResult {
    let mut sorted = yours.to_vec();
    sorted.sort_unstable();
    if sorted.iter().copied().eq(0..rays.len() as u32) {
        return Ok(());
    }
    let expected = format!("each of 0..{} once", rays.len());
    Err(Broken::with_texts(describe(rays), shown(yours), expected, "the numbers of the rays")
        .explained_by([]))
}

pub(super) fn stream_order_lists_every_ray_once(trial: &Trial<'_>) -> CheckResult {
    // No rays, and one, come first.
    let simple = [Vec::new(), vec![Ray::new(Vec3::ONE, Vec3::X)]];
    trial.forall_and(&simple, 200, rays(30), |sets| {
        compare(sets, trial.kit.stream_order(sets), |rays, yours| judge_permutation(rays, &yours))
    })
}

/// Whether a key of the rays ascends in this order.
fn ascends(rays: &[Ray], order: &[u32], key: impl Fn(usize) -> u64) -> bool {
    order.len() == rays.len()
        && order.iter().all(|&ray| (ray as usize) < rays.len())
        && order.is_sorted_by_key(|&ray| key(ray as usize))
}

pub(super) fn stream_order_sorts_by_octant(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, rays(30), |sets| {
        let judge = |rays: &Vec<Ray>, yours: Vec<u32>| {
            judge_permutation(rays, &yours)?;
            let octants: Vec<u32> = yours.iter().map(|&ray| octant(&rays[ray as usize])).collect();
            if octants.is_sorted() {
                return Ok(());
            }
            let expected = "octants that ascend";
            Err(Broken::with_texts(
                describe(rays),
                format!("the octants {octants:?}"),
                expected,
                "the directions",
            )
            .explained_by([]))
        };
        let formulas = |rays: &Vec<Ray>, yours: &Vec<u32>| {
            let by = |octant: &dyn Fn(&Ray) -> u64| ascends(rays, yours, |ray| octant(&rays[ray]));
            let sum = |bit: &dyn Fn(usize) -> bool, weights: [u64; 3]| -> u64 {
                (0..3).map(|axis| u64::from(bit(axis)) * weights[axis]).sum()
            };
            vec![
                (
                    by(&|ray| sum(&|axis| ray.direction[axis].is_sign_negative(), [1, 2, 4])),
                    "-0 counts as a negative direction: compare with 0",
                ),
                (
                    by(&|ray| sum(&|axis| ray.direction[axis] >= 0.0, [1, 2, 4])),
                    "the bits of the octant are inverted: a bit is set where the direction is below 0",
                ),
                (
                    by(&|ray| sum(&|axis| ray.direction[axis] < 0.0, [4, 2, 1])),
                    "the axes of the octant are reversed: bit 0 is x",
                ),
            ]
        };
        compare_formulas(sets, trial.kit.stream_order(sets), judge, formulas)
    })
}

/// Judges the order within the octants: a code is chosen for each ray, the smallest possible one that does not descend.
fn judge_codes(rays: &[Ray], yours: &[u32]) -> CheckResult {
    judge_permutation(rays, yours)?;
    let places = places(rays);
    let mut last: Option<(u32, u32, u32)> = None;
    for &ray in yours {
        let (octant, codes) = (octant(&rays[ray as usize]), codes(places[ray as usize]));
        let least = last.filter(|(same, ..)| *same == octant).map_or(0, |(_, code, _)| code);
        let Some(code) = codes.iter().copied().find(|&code| code >= least) else {
            let of = |code: u32| format!("{code:#b}");
            let before = last.map_or(0, |(.., ray)| ray);
            let yours = format!("ray {before} with code {}, then ray {ray} with {}", of(least), of(codes[0]));
            let expected = "codes that ascend within an octant";
            return Err(
                Broken::with_texts(describe(rays), yours, expected, "the definition").explained_by([])
            );
        };
        last = Some((octant, code, ray));
    }
    Ok(())
}

const ROW_BY_ROW: &str = "the cells are one after the other, row by row: interleave their bits";
const LARGER_CELLS: &str = "the cells are larger: there are 1024 along each axis";

/// The known mistakes of a code that sort all rays in this order.
fn wrong_codes(rays: &[Ray], yours: &[u32]) -> Vec<(bool, &'static str)> {
    let places = places(rays);
    let cells =
        |ray: usize, n: f64| places[ray].to_array().map(|at| ((at * n / CELLS) as u32).min(n as u32 - 1));
    let by = |code: &dyn Fn(usize) -> u64| {
        ascends(rays, yours, |ray| u64::from(octant(&rays[ray])) << 32 | code(ray))
    };
    let row = |ray: usize, [p, q, r]: [usize; 3]| {
        let cells = cells(ray, CELLS);
        u64::from(cells[p] << 20 | cells[q] << 10 | cells[r])
    };
    vec![
        (by(&|ray| row(ray, [2, 1, 0])), ROW_BY_ROW),
        (by(&|ray| row(ray, [0, 1, 2])), ROW_BY_ROW),
        (
            by(&|ray| code(cells(ray, CELLS), [2, 1, 0]).into()),
            "the axes are reversed: bit 3 b belongs to x, 3 b + 1 to y, and 3 b + 2 to z",
        ),
        (by(&|ray| code(cells(ray, 32.0), [0, 1, 2]).into()), LARGER_CELLS),
        (by(&|ray| code(cells(ray, 256.0), [0, 1, 2]).into()), LARGER_CELLS),
        (by(&|_| 0), "the rays are sorted by octant only: the Morton code of the origin comes next"),
    ]
}

pub(super) fn stream_order_follows_the_curve_of_morton(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, one_octant(40), |sets| {
        compare_formulas(
            sets,
            trial.kit.stream_order(sets),
            |rays, yours| judge_codes(rays, &yours),
            |rays, yours| wrong_codes(rays, yours),
        )
    })
}

/// Origins in a plane, on a line, at one point and on the largest coordinates, with all octants.
pub(super) fn stream_order_of_flat_sets(trial: &Trial<'_>) -> CheckResult {
    let flat = (rays(30), 0..8u32).prop_map(|(rays, axes)| {
        let flatten = |ray: Ray| {
            let keep = |axis: u32| if axes >> axis & 1 == 1 { 2.5 } else { ray.origin[axis as usize] };
            Ray { origin: Vec3::new(keep(0), keep(1), keep(2)), ..ray }
        };
        rays.into_iter().map(flatten).collect::<Vec<Ray>>()
    });
    trial.forall(300, flat, |sets| {
        compare(sets, trial.kit.stream_order(sets), |rays, yours| judge_codes(rays, &yours))
    })
}
