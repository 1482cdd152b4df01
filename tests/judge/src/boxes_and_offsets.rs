//! Measures box tests and the origins of secondary rays on hard inputs, against exact arithmetic.

use crate::gauntlet::{is_written, percent};
use crate::table::Table;
use glam::{DVec3, Vec3};
use oracle::exact::aabb::overlap;
use oracle::gauntlet::boxes::{at_a_corner, of_any_size};
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::kit::{Kit, OffsetQuery, SlabQuery};
use raykata::ray::Ray;

/// The share of boxes that a test loses though the ray meets them, and the share of origins of secondary rays behind or too
/// far in front of their surface.
pub fn tables(kit: &dyn Kit, n_inputs: u64, seed: u64) -> Vec<Table> {
    vec![boxes(kit, n_inputs, seed), offsets(kit, n_inputs, seed)]
}

/// Draws a ray and a box.
type Draw = fn(&mut Random) -> Option<SlabQuery>;

/// Answers a batch of queries.
type Ask<'a, Q, A> = Box<dyn Fn(&[Q]) -> Vec<A> + 'a>;

fn boxes(kit: &dyn Kit, n_inputs: u64, seed: u64) -> Table {
    let kinds: [(&str, Draw); 2] = [("at corners", at_a_corner), ("any size", of_any_size)];
    // Keep only the boxes that the ray meets.
    let met: Vec<Vec<SlabQuery>> = kinds
        .iter()
        .map(|(_, draw)| {
            let mut random = Random::new(seed, 0);
            let drawn = (0..n_inputs).filter_map(|_| draw(&mut random));
            drawn
                .filter(|query| overlap(&query.ray, &query.bounds).is_some_and(|o| o.verdict.is_hit()))
                .collect()
        })
        .collect();
    type AskSlab<'a> = Ask<'a, SlabQuery, Option<(f32, f32)>>;
    let asked: [(&str, AskSlab); 2] = [
        ("kit: slab", Box::new(|queries| kit.slab(queries))),
        ("kit: conservative_slab", Box::new(|queries| kit.conservative_slab(queries))),
    ];
    let example = SlabQuery { ray: Ray::new(Vec3::ZERO, Vec3::X), bounds: Aabb::new(Vec3::ZERO, Vec3::ONE) };
    let rows = rows(&asked, example, |ask| {
        let lost = |queries: &Vec<SlabQuery>| {
            let lost = ask(queries).iter().filter(|answer| answer.is_none()).count();
            percent(share(lost, queries.len()))
        };
        met.iter().map(lost).collect()
    });
    Table {
        title: "boxes that the ray meets, and the test loses, in %".into(),
        heads: kinds.iter().map(|(name, _)| (*name).to_owned()).collect(),
        rows,
        notes: vec!["A lost box is a hole in the picture, because nothing in it is tested.".into()],
    }
}

/// A point of a plane, rounded to single precision, and the exact point.
struct Place {
    query: OffsetQuery,
    exact: DVec3,
}

/// Sizes of the coordinates at which secondary rays start.
const SIZES: [(&str, f32); 4] =
    [("size 0.001", 1e-3), ("size 1", 1.0), ("size 1000", 1e3), ("size 1e6", 1e6)];

fn place(random: &mut Random, size: f32) -> Place {
    // Round a point to single precision: each coordinate moves by at most half of its last place.
    let coarse = random.in_cube().as_dvec3();
    let fine = random.in_cube().as_dvec3();
    let exact = f64::from(size) * (coarse + f64::from(f32::EPSILON) * fine);
    let point = exact.as_vec3();
    let error = point.abs() * (0.5 * f32::EPSILON);
    let query = OffsetQuery { point, error, normal: random.direction(), direction: random.direction() };
    Place { query, exact }
}

fn offsets(kit: &dyn Kit, n_inputs: u64, seed: u64) -> Table {
    let places: Vec<Vec<Place>> = SIZES
        .iter()
        .map(|&(_, size)| {
            let mut random = Random::new(seed, 1);
            (0..n_inputs).map(|_| place(&mut random, size)).collect()
        })
        .collect();
    let asked: [(&str, Ask<OffsetQuery, Vec3>); 2] = [
        ("always by 0.0001", Box::new(|queries| queries.iter().map(moved_by_a_fixed_distance).collect())),
        ("kit: offset_origin", Box::new(|queries| kit.offset_origin(queries))),
    ];
    let example = OffsetQuery { point: Vec3::ZERO, error: Vec3::ZERO, normal: Vec3::Z, direction: Vec3::Z };
    let rows = rows(&asked, example, |ask| {
        let judged = |places: &Vec<Place>| {
            let queries: Vec<OffsetQuery> = places.iter().map(|place| place.query).collect();
            let answers = ask(&queries);
            let count = |is_bad: &dyn Fn(&Place, f64) -> bool| {
                let bad = places
                    .iter()
                    .zip(&answers)
                    .filter(|(place, origin)| is_bad(place, height(place, **origin)));
                percent(share(bad.count(), places.len()))
            };
            let behind = count(&|_, height| height <= 0.0);
            let too_far = count(&|place, height| height > most(&place.query));
            format!("{behind} / {too_far}")
        };
        places.iter().map(judged).collect()
    });
    Table {
        title: "origins of secondary rays behind their surface / too far in front of it, in %".into(),
        heads: SIZES.iter().map(|(name, _)| (*name).to_owned()).collect(),
        rows,
        notes: vec![
            "Behind the surface, a ray hits it again (shadow acne). Too far is more than the".into(),
            "doc comment of `offset_origin` allows: rays miss what touches the surface.".into(),
        ],
    }
}

fn moved_by_a_fixed_distance(query: &OffsetQuery) -> Vec3 {
    let side = if query.normal.dot(query.direction) < 0.0 { -query.normal } else { query.normal };
    query.point + 1e-4 * side
}

/// The height of `origin` above the plane through the exact point, on the side to which the ray goes. Double precision has 29
/// binary digits more than the coordinates, so the sign is right unless the height is far below their last place.
fn height(place: &Place, origin: Vec3) -> f64 {
    let OffsetQuery { normal, direction, .. } = place.query;
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    (origin.as_dvec3() - place.exact).dot(side.as_dvec3())
}

/// The greatest height that the doc comment of `offset_origin` allows, and the error of the point itself.
fn most(query: &OffsetQuery) -> f64 {
    let bound = query.error.dot(query.normal.abs());
    let largest = query.point.abs().max_element();
    f64::from(5.0 * bound + 64.0 * (largest.next_up() - largest))
}

/// A row for each function that is written.
fn rows<Q, A>(
    asked: &[(&str, Ask<Q, A>)],
    example: Q,
    cells: impl Fn(&dyn Fn(&[Q]) -> Vec<A>) -> Vec<String>,
) -> Vec<(String, Vec<String>)> {
    let example = [example];
    let written = asked.iter().filter(|(name, ask)| is_written(name, || ask(&example)));
    written.map(|(name, ask)| ((*name).to_owned(), cells(ask))).collect()
}

/// The share of `count` in %.
fn share(count: usize, of: usize) -> f64 {
    100.0 * count as f64 / of.max(1) as f64
}
