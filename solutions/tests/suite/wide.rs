//! Stage 12: eight boxes at once answer as one box at a time, eight triangles at once lose no hit, and trees over boxes that no
//! check has contain everything once.

use crate::watertight::kinds;
use checks::tree::around;
use glam::Vec3;
use oracle::gauntlet::boxes::{at_a_corner, of_any_size};
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::kit::{BlockQuery, WideBoxesQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use raykata::wide::{
    BLOCK, Child, ChildContents, FlatTree, Fork, Forks, LARGEST, NO_PRIMITIVE, TriangleBlock, WIDE_NODE_COST,
    WideNode, WideTree,
};
use solutions::stage10_stability::watertight;
use solutions::stage12_build::{build_binned, build_parallel};
use solutions::stage12_wide::collapse;

/// Boxes and rays for which slab tests are hard: corners, faces, zeros of both signs, infinities.
fn hard_boxes(random: &mut Random) -> Option<(Ray, Aabb)> {
    let query = if random.below(2) == 0 { of_any_size(random)? } else { at_a_corner(random)? };
    let (mut ray, mut bounds) = (query.ray, query.bounds);
    ray.t_min = if random.below(4) == 0 { ray.t_min.abs() } else { 0.0 };
    for axis in 0..3 {
        match random.below(12) {
            0 => ray.direction[axis] = 0.0,
            1 => ray.direction[axis] = -0.0,
            2 => ray.origin[axis] = bounds.min[axis],
            3 => ray.origin[axis] = bounds.max[axis],
            4 => bounds.max[axis] = bounds.min[axis],
            5 => bounds.min[axis] = -0.0,
            6 => bounds.max[axis] = f32::INFINITY,
            _ => {}
        }
    }
    Some((ray, bounds))
}

#[test]
fn eight_boxes_miss_no_box_that_the_ray_meets() {
    let mut random = Random::new(12, 1);
    let (mut entered, mut queries, mut met) = (0, Vec::new(), Vec::new());
    for _ in 0..100_000 {
        let Some((ray, first)) = hard_boxes(&mut random) else { continue };
        // The other places hold other boxes, or nothing.
        let mut node = Box::new(WideNode::EMPTY);
        let others = std::iter::repeat_with(|| hard_boxes(&mut random)).take(5).flatten();
        let boxes: Vec<Aabb> = std::iter::once(first).chain(others.map(|(_, bounds)| bounds)).collect();
        for (place, bounds) in boxes.iter().enumerate() {
            node.set(place, bounds, Child::leaf(place as u32, 1));
        }
        // Only these rays are promised to meet what they enter.
        let [o, d] = [ray.origin, ray.direction].map(|v| v.abs().max_element());
        if o > LARGEST || !(1.0 / LARGEST..=LARGEST).contains(&d) {
            continue;
        }
        met.push(boxes.iter().map(|bounds| exact_entry(&ray, bounds)).collect::<Vec<_>>());
        queries.push(WideBoxesQuery { node, ray });
    }
    let answers = solutions::kit().enter_boxes(&queries);
    for ((query, answer), met) in queries.iter().zip(answers).zip(met) {
        for (i, t) in met.iter().enumerate().filter_map(|(i, t)| Some((i, (*t)?))) {
            // Larger boxes are not in scenes.
            if t * f64::from(query.ray.direction.abs().max_element()) > f64::from(LARGEST) {
                continue;
            }
            assert!(answer.mask >> i & 1 == 1, "{query:?}, box {i} is entered at {t}");
            assert!(
                f64::from(answer.t[i]) <= t,
                "{query:?}, box {i} is entered at {t}, not at {}",
                answer.t[i]
            );
            entered += 1;
        }
        assert_eq!(answer.mask >> met.len(), 0, "an empty place is not entered: {query:?}");
    }
    println!("{} rays, {entered} boxes entered", queries.len());
}

/// The `t` at which a ray enters a box, in double precision; `None` if it does not meet the box within its range and at `t > 0`.
fn exact_entry(ray: &Ray, bounds: &Aabb) -> Option<f64> {
    let (mut near, mut far) = (f64::from(ray.t_min), f64::from(ray.t_max));
    for axis in 0..3 {
        let [o, d, low, high] =
            [ray.origin[axis], ray.direction[axis], bounds.min[axis], bounds.max[axis]].map(f64::from);
        if d == 0.0 {
            if !(low <= o && o <= high) {
                return None;
            }
            continue;
        }
        let (first, last) = if d > 0.0 { (low, high) } else { (high, low) };
        (near, far) = (near.max((first - o) / d), far.min((last - o) / d));
    }
    (near <= far && far > 0.0 && near < f64::INFINITY).then_some(near)
}

#[test]
fn eight_triangles_lose_no_hit() {
    for (index, (name, draw)) in kinds().into_iter().enumerate() {
        let mut random = Random::new(12, 100 + index as u64);
        let (mut queries, mut hits, mut lines) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..20_000 {
            let (mut ray, first) = draw(&mut random);
            let mut triangles = vec![first];
            triangles.extend((0..7).map(|_| draw(&mut random).1));
            let in_range = |p: Vec3| p.abs().max_element() <= LARGEST;
            if !(in_range(ray.origin) && in_range(ray.direction)) {
                continue;
            }
            ray.t_min = ray.t_min.max(0.0);
            // End some rays at a hit, a float before it, or a float beyond it.
            if let Some(hit) = watertight(&ray, &first) {
                let t = hit.t;
                ray.t_max = [ray.t_max, ray.t_max, t, t.next_up(), t.next_down()][random.below(5) as usize];
                ray.t_min = [0.0, 0.0, t, t.next_down(), t.next_up()][random.below(5) as usize].max(0.0);
            }
            let of = |id: u32| Some(triangles[id as usize]);
            let line = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
            lines.push([0, 1, 2, 3, 4, 5, 6, 7].map(|i| watertight(&line, &triangles[i])));
            hits.push([0, 1, 2, 3, 4, 5, 6, 7].map(|i| watertight(&ray, &triangles[i]).is_some()));
            queries
                .push(BlockQuery { block: Box::new(TriangleBlock::new([0, 1, 2, 3, 4, 5, 6, 7], of)), ray });
        }
        let (mut n_hits, mut n_passed, mut n_certain) = (0, 0, 0);
        for (((query, mask), hits), lines) in
            queries.iter().zip(solutions::kit().may_hit(&queries)).zip(hits).zip(lines)
        {
            // Where the filter is certain, t is that of the watertight test, bit for bit.
            for (lane, hit) in lines.into_iter().enumerate().filter(|(lane, _)| mask.certain >> lane & 1 == 1)
            {
                let t = query.block.t_of_plane(lane, &query.ray);
                assert!(
                    hit.is_some() && (t.is_none() || t == hit.map(|hit| hit.t)),
                    "{name}: lane {lane} of {query:?}"
                );
                n_certain += u32::from(t.is_some());
            }
            assert!(mask.possible < 256 && mask.certain < 256, "{mask:?}");
            for (lane, hit) in hits.into_iter().enumerate() {
                assert!(!hit || mask.possible >> lane & 1 == 1, "{name}: lane {lane} of {query:?} is hit");
                n_hits += usize::from(hit);
            }
            n_passed += mask.possible.count_ones();
        }
        println!(
            "{name}: {n_hits} hits, {n_certain} certain, {n_passed} of {} triangles remain",
            8 * queries.len()
        );
    }
}

#[test]
fn few_triangles_remain_that_are_not_hit() {
    // Triangles of a unit cube, seen from two units away.
    let mut random = Random::new(12, 2);
    let query = |_| {
        let triangles = [(); 8].map(|()| {
            let [a, b, c] = [(); 3].map(|()| 0.1 * random.in_cube());
            Triangle { a, b, c }
        });
        let ray = Ray::new(2.0 * random.direction(), Vec3::X);
        let ray = Ray { direction: 0.1 * random.in_cube() - ray.origin, ..ray };
        let hits = triangles.iter().filter(|triangle| watertight(&ray, triangle).is_some()).count();
        let of = |id: u32| Some(triangles[id as usize]);
        (BlockQuery { block: Box::new(TriangleBlock::new([0, 1, 2, 3, 4, 5, 6, 7], of)), ray }, hits)
    };
    let (queries, hits): (Vec<_>, Vec<usize>) = (0..25_000).map(query).unzip();
    let hits: usize = hits.into_iter().sum();
    let passed: u32 =
        solutions::kit().may_hit(&queries).into_iter().map(|mask| mask.possible.count_ones()).sum();
    println!("{hits} hits, {passed} of 200000 triangles remain");
    assert!(f64::from(passed) < 1.01 * hits as f64, "{hits} hits, {passed} remain");
}

#[test]
fn a_parallel_build_gives_the_same_tree_and_the_same_log() {
    let mut random = Random::new(12, 4);
    let bounds: Vec<Aabb> = (0..100_000)
        .map(|_| random.in_cube())
        .map(|center| Aabb::new(center - 0.01, center + 0.01))
        .collect();
    let log = |in_parallel: bool| -> (FlatTree, Vec<Fork>) {
        let mut forks = Forks::new(in_parallel);
        let tree = build_parallel(&bounds, &mut forks);
        (tree, forks.into_log())
    };
    let (alone, parallel) = (log(false), log(true));
    assert!(alone == parallel, "trees and logs are the same");
}

/// No check of stage 12 builds a tree over an empty box, or a box so far away that all costs round to one number.
#[test]
fn trees_over_empty_and_far_boxes_have_every_primitive_once_and_tight_boxes() {
    let mut random = Random::new(12, 3);
    let mut bounds: Vec<Aabb> =
        (0..500).map(|_| random.in_cube()).map(|center| Aabb::new(center - 0.02, center + 0.02)).collect();
    bounds[200] = Aabb::EMPTY;
    bounds[300] = Aabb::new(Vec3::splat(1e30) - 1.0, Vec3::splat(1e30) + 1.0);
    let wide: WideTree = collapse(&build_binned(&bounds), WIDE_NODE_COST);
    let mut found: Vec<u32> = Vec::new();
    let mut waiting = vec![Child::ROOT];
    while let Some(child) = waiting.pop() {
        let ChildContents::Inner(index) = child.contents() else { panic!("only inner nodes wait") };
        let node = &wide.nodes[index as usize];
        for i in 0..node.n_children() as usize {
            match node.children[i].contents() {
                ChildContents::Inner(below) => {
                    assert!(below > index, "a parent comes first");
                    waiting.push(node.children[i]);
                }
                ChildContents::Leaf { block, count } => {
                    let blocks = &wide.blocks[block as usize..][..(count as usize).div_ceil(BLOCK)];
                    let ids: Vec<u32> = blocks.iter().flatten().copied().collect();
                    let (ids, free) = ids.split_at(count as usize);
                    assert!(free.iter().all(|&id| id == NO_PRIMITIVE));
                    let boxes = ids.iter().map(|&id| &bounds[id as usize]).filter(|one| !one.is_empty());
                    assert_eq!(node.child_bounds(i), around(boxes));
                    found.extend(ids);
                }
            }
        }
    }
    found.sort_unstable();
    assert!(found.into_iter().eq(0..bounds.len() as u32));
}

#[test]
fn vectors_have_the_rules_of_their_comments() {
    use raykata::wide::simd::{F32x8, Instructions, Level, Vectorized};
    struct Rules;
    impl Vectorized for Rules {
        type Output = ();

        #[inline(always)]
        fn run<L: Level>(self, level: L) {
            let (nan, one, two) = (f32::NAN, 1.0, 2.0);
            let p = F32x8::load(level, &[nan, one, two, -0.0, nan, nan, nan, nan]);
            let q = F32x8::load(level, &[two, nan, one, 0.0, nan, nan, nan, nan]);
            let bits = |vector: F32x8<L>| vector.to_array().map(f32::to_bits)[..4].to_vec();
            assert_eq!(bits(p.max(q)), [two, nan, two, 0.0].map(f32::to_bits));
            assert_eq!(bits(p.min(q)), [two, nan, one, 0.0].map(f32::to_bits));
            assert_eq!((p.le(q).bits(), p.lt(q).bits(), q.lt(p).bits()), (0b1000, 0, 0b0100));
            let r = F32x8::load(level, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, nan]);
            let four = F32x8::splat(level, 4.0);
            assert_eq!(r.lt(four).bits(), 0b0000_1111);
            assert_eq!((r.le(four) & four.le(r)).bits(), 0b0001_0000);
            assert_eq!((r.lt(four) | four.lt(r)).bits(), 0b0110_1111);
            assert_eq!((r * four - four + r).to_array()[..7], [-4.0, 1.0, 6.0, 11.0, 16.0, 21.0, 26.0]);
        }
    }
    Instructions::detect().run(Rules);
}

#[test]
fn a_tiny_direction_enters_no_empty_place() {
    // `1 / d` overflows on all three axes, so no box decides anything. An empty place would lead back to the root, for ever.
    let kit = solutions::kit();
    let mut node = WideNode::EMPTY;
    node.set(0, &Aabb::new(Vec3::splat(-1e-38), Vec3::splat(1e-38)), Child::leaf(0, 1));
    let ray = Ray::new(Vec3::ZERO, Vec3::splat(1e-39));
    let entered = kit.enter_boxes(&[WideBoxesQuery { node: Box::new(node), ray }]);
    assert_eq!(entered[0].mask, 1);
}
