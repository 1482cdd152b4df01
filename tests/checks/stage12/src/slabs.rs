//! `enter_boxes`.

use checks::prelude::*;
use oracle::gauntlet::boxes::{at_a_corner, of_any_size};
use oracle::splitmix::Random;
use raykata::wide::{Child, Entered, WideNode, WideRay};

/// The mistakes of a slab test.
#[derive(Clone, Copy, PartialEq)]
enum Flaw {
    None,
    NearForBoth,
    FarForBoth,
    EndsAtInfinity,
    StartsAtZero,
    Open,
    SidesNotSwapped,
    EntryIsExit,
    Exchanged,
    Without(usize),
}

const WITHOUT: &str = "an axis is left out: intersect the intervals of all three";

const FLAWS: [(Flaw, &str); 11] = named![
    Flaw::EntryIsExit => "the exit is returned as the entry: `t` has the entries of the boxes",
    Flaw::Exchanged => "the entry is the smallest t of the near planes: a ray is in a box when it has entered on all axes",
    Flaw::NearForBoth =>
        "far planes have factors of their own, scale[1] and offset[1]: with those of near planes the exit is too early, and rounding loses boxes",
    Flaw::FarForBoth =>
        "near planes have factors of their own, scale[0] and offset[0]: with those of far planes the entry is too late, and rounding loses boxes",
    Flaw::Without(0) => WITHOUT,
    Flaw::Without(1) => WITHOUT,
    Flaw::Without(2) => WITHOUT,
    Flaw::EndsAtInfinity => "t_max is left out: a box beyond it is not entered",
    Flaw::StartsAtZero => "t_min is left out: the entry is t_min or later",
    Flaw::Open => "boxes without thickness are lost: near <= far, not near < far",
    Flaw::SidesNotSwapped => "a ray in negative direction passes the largest coordinate first: near_side says which",
];

/// Whether the product and the sum of near planes are rounded once, and those of far planes: all are right.
const FUSED: [[bool; 2]; 4] = [[false, false], [true, true], [false, true], [true, false]];

/// The entry of a ray into one box, by the definition or by a wrong one, with the roundings `fused`. `None` if it misses.
fn entry(
    (node, place): (&WideNode, usize),
    ray: &WideRay,
    t_max: f32,
    flaw: Flaw,
    fused: [bool; 2],
) -> Option<f32> {
    let mut near = if flaw == Flaw::StartsAtZero { 0.0 } else { ray.t_min };
    let mut far = if flaw == Flaw::EndsAtInfinity { f32::INFINITY } else { t_max };
    for axis in (0..3).filter(|axis| flaw != Flaw::Without(*axis)) {
        let side = if flaw == Flaw::SidesNotSwapped { 0 } else { ray.near_side[axis] };
        let t = |side: usize, end: usize, fused: bool| {
            let (plane, scale, offset) =
                (node.bounds[axis][side][place], ray.scale[end][axis], ray.offset[end][axis]);
            if fused { plane.mul_add(scale, offset) } else { plane * scale + offset }
        };
        let enter = t(side, usize::from(flaw == Flaw::FarForBoth), fused[0]);
        let leave = t(1 - side, usize::from(flaw != Flaw::NearForBoth), fused[1]);
        (near, far) = match flaw {
            Flaw::Exchanged if axis > 0 => (near.min(enter), far.max(leave)),
            _ => (near.max(enter), far.min(leave)),
        };
    }
    let enters = if flaw == Flaw::Open { near < far } else { near <= far };
    enters.then_some(if flaw == Flaw::EntryIsExit { far } else { near })
}

fn entries(query: &WideBoxesQuery, flaw: Flaw, fused: [bool; 2]) -> [Option<f32>; 8] {
    let ray = WideRay::new(&query.ray);
    std::array::from_fn(|place| entry((&query.node, place), &ray, query.ray.t_max, flaw, fused))
}

fn answers(entered: &Entered) -> [Option<f32>; 8] {
    std::array::from_fn(|place| (entered.mask >> place & 1 == 1).then_some(entered.t[place]))
}

fn judge(query: &WideBoxesQuery, yours: &Entered) -> CheckResult {
    let (mine, expected) = (answers(yours), FUSED.map(|fused| entries(query, Flaw::None, fused)));
    // -0 and 0 are the same entry.
    let is_right = |place: &usize| expected.iter().any(|right| mine[*place] == right[*place]);
    let Some(place) = (0..8).find(|place| !is_right(place)) else {
        let beyond = yours.mask >> 8;
        let broken =
            || Broken::new("enter_boxes", format!("mask {:#x}", yours.mask), "eight bits", "the definition");
        return if beyond == 0 { Ok(()) } else { Err(broken()) };
    };
    let is_empty = if query.node.children[place] == Child::EMPTY { ", which is empty" } else { "" };
    let input = format!("enter_boxes, place {place}{is_empty}: {}", query.ray.paste());
    let of = |entry: Option<f32>| entry.map_or("not entered".into(), |t| format!("entered at {t:?}"));
    Err(Broken::with_texts(input, of(mine[place]), of(expected[0][place]), "one box at a time"))
}

/// Judges `n` queries, without those that are `None`. `stream` is the number of their random numbers.
fn judge_drawn(
    trial: &Trial<'_>,
    n: usize,
    stream: u64,
    mut draw: impl FnMut(&mut Random) -> Option<WideBoxesQuery>,
) -> CheckResult {
    let mut random = Random::new(trial.seed, stream);
    let queries: Vec<WideBoxesQuery> = (0..n).filter_map(|_| draw(&mut random)).collect();
    let mistakes = |query: &WideBoxesQuery, yours: &Entered| {
        let gives = |flaw| FUSED.iter().any(|&fused| answers(yours) == entries(query, flaw, fused));
        FLAWS.map(|(flaw, text)| (gives(flaw), text)).to_vec()
    };
    // Every known mistake must give another answer to some query, so that only one can explain all answers.
    let judge = |query: &WideBoxesQuery, yours| judge(query, &yours);
    all_hold(compare_formulas(&queries, trial.kit.enter_boxes(&queries), judge, mistakes))
}

/// A node with these boxes in its first places.
fn node_of(boxes: &[Aabb]) -> Box<WideNode> {
    let mut node = Box::new(WideNode::EMPTY);
    for (place, bounds) in boxes.iter().enumerate().take(8) {
        node.set(place, bounds, Child::leaf(place as u32, 1));
    }
    node
}

/// A query whose other boxes are drawn around the first one.
fn among_others(random: &mut Random, ray: Ray, first: Aabb) -> WideBoxesQuery {
    let n = random.below(8);
    let size = (first.max - first.min).abs().max_element();
    let place = random.below(n + 1) as usize;
    let mut boxes: Vec<Aabb> = (0..n)
        .map(|_| {
            let low = first.min + 3.0 * size * random.in_cube();
            Aabb::new(low, low + size * random.in_cube().abs())
        })
        .collect();
    boxes.insert(place, first);
    WideBoxesQuery { node: node_of(&boxes), ray: Ray { t_min: ray.t_min.max(0.0), ..ray } }
}

pub(super) fn enter_boxes_agrees_with_one_box_at_a_time(trial: &Trial<'_>) -> CheckResult {
    judge_drawn(trial, 1500, 24, |random| {
        let low = 4.0 * random.in_cube();
        let bounds = Aabb::new(low, low + random.in_cube().abs());
        let origin = 6.0 * random.in_cube();
        let target = low + random.in_cube();
        let mut ray = Ray::new(origin, target - origin);
        // Some ranges begin or end within the scene.
        if random.below(3) == 0 {
            ray = ray.with_range(random.unit(), 0.5 + random.unit());
        }
        Some(among_others(random, ray, bounds))
    })
}

pub(super) fn enter_boxes_takes_zeros_and_faces(trial: &Trial<'_>) -> CheckResult {
    judge_drawn(trial, 2000, 25, |random| {
        let whole = |random: &mut Random| vec3(1.0, 1.0, 1.0).map(|one| one * (random.below(5) as f32 - 2.0));
        let (low, mut size) = (whole(random), whole(random).abs());
        if random.below(2) == 0 {
            size[random.below(3) as usize] = 0.0;
        }
        let bounds = Aabb::new(low, low + size);
        let (mut origin, mut direction) = (3.0 * whole(random), whole(random));
        for axis in 0..3 {
            match random.below(6) {
                0 => direction[axis] = 0.0,
                1 => direction[axis] = -0.0,
                2 => (origin[axis], direction[axis]) = (bounds.min[axis], 0.0),
                3 => (origin[axis], direction[axis]) = (bounds.max[axis], -0.0),
                _ => {}
            }
        }
        if direction == Vec3::ZERO {
            direction[random.below(3) as usize] = -1.0;
        }
        Some(among_others(random, Ray::new(origin, direction), bounds))
    })
}

pub(super) fn enter_boxes_hits_the_corners_it_is_aimed_at(trial: &Trial<'_>) -> CheckResult {
    judge_drawn(trial, 2000, 26, |random| {
        let query = at_a_corner(random)?;
        Some(among_others(random, query.ray, query.bounds))
    })
}

pub(super) fn enter_boxes_of_any_size(trial: &Trial<'_>) -> CheckResult {
    // Directions down to the denormal numbers: where 1/d overflows, an axis decides nothing.
    judge_drawn(trial, 2000, 27, |random| {
        let query = of_any_size(random)?;
        Some(among_others(random, query.ray, query.bounds))
    })
}

pub(super) fn enter_boxes_respects_the_range(trial: &Trial<'_>) -> CheckResult {
    judge_drawn(trial, 2000, 28, |random| {
        // A box along an axis, entered and left at whole numbers; ranges that touch these from either side.
        let (axis, from) = (random.below(3) as usize, 1.0 + random.below(4) as f32);
        let thickness = random.below(3) as f32;
        let [mut low, mut high] = [Vec3::splat(-1.0), Vec3::splat(1.0)];
        (low[axis], high[axis]) = (from, from + thickness);
        let ray = Ray::new(Vec3::ZERO, Vec3::AXES[axis]);
        let end = |random: &mut Random| {
            let t = from + [0.0, thickness][random.below(2) as usize];
            [t, t.next_up(), t.next_down(), t * 1.5, t * 0.5, 0.0, f32::INFINITY][random.below(7) as usize]
        };
        let (t_min, t_max) = (end(random), end(random));
        let t_min = if t_min.is_finite() { t_min } else { 0.0 };
        let query =
            WideBoxesQuery { node: node_of(&[Aabb::new(low, high)]), ray: ray.with_range(t_min, t_max) };
        Some(if random.below(2) == 0 { query } else { among_others(random, query.ray, Aabb::new(low, high)) })
    })
}

pub(super) fn enter_boxes_enters_no_empty_place(trial: &Trial<'_>) -> CheckResult {
    judge_drawn(trial, 1000, 29, |random| {
        let n = 1 + random.below(7);
        let boxes: Vec<Aabb> = (0..n)
            .map(|_| {
                let low = random.in_cube();
                Aabb::new(low, low + random.in_cube().abs())
            })
            .collect();
        // Half of the directions are so small that 1/d overflows on every axis, so that no box decides anything.
        let scale = [1.0, f32::MIN_POSITIVE / 16_384.0][random.below(2) as usize];
        let ray = Ray::new(3.0 * random.in_cube(), scale * random.direction());
        Some(WideBoxesQuery { node: node_of(&boxes), ray })
    })
}
