//! What stands in cells: the laws that all builders share.

use checks::broken::{Broken, Outcome};
use checks::judge::known;
use checks::paste::Paste;
use glam::Vec3;
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::kit::kit_error::{self, KitError};
use raykata::partition::Cell;

/// Boxes on a coarse grid, so that many touch; some flat, some not numbers.
pub(super) fn some_boxes() -> impl Strategy<Value = Vec<Aabb>> + Clone {
    let one =
        (checks::generate::point(4), checks::generate::point(2), 0..20i32).prop_map(|(p, size, kind)| {
            match kind {
                0 => Aabb::new(Vec3::NAN, Vec3::NAN),
                1..=5 => Aabb::new(p.round(), p.round() + size.abs().round()),
                _ => Aabb::new(p, p + size.abs()),
            }
        });
    prop::collection::vec(one, 1..24)
}

/// What is wrong with the box around all, if anything is: `(yours, expected)`.
pub(super) fn bounds_fault(bounds: &Aabb, boxes: &[Aabb]) -> Option<(String, String)> {
    let all = checks::tree::around(boxes.iter().filter(|one| !one.is_empty()));
    (!bounds.contains_box(&all)).then(|| {
        (format!("the structure ends at {}", bounds.paste()), format!("all of {} within", all.paste()))
    })
}

/// Whether a box that a cell lists has nothing to do with it: it is farther off than a 64th of all, and than the room that
/// builders leave, which is 2⁻²² of the largest coordinate at least. Around a single point that is all there is.
pub(super) fn is_far_off(all: &Aabb, cell: &Aabb, one: &Aabb) -> bool {
    let largest = all.min.abs().max(all.max.abs()).max_element();
    let room = ((all.max - all.min).max_element() / 64.0).max(2f32.powi(-20) * largest);
    let gap = (one.min - cell.max).max(cell.min - one.max);
    !(gap.max_element() <= room)
}

/// What is wrong: `(yours, expected, diagnosis)`.
pub(super) type Fault = (String, String, &'static str);

/// Judges a tree of `n_nodes` nodes: over `nothing` it has none, and over anything `fault` looks for what is wrong.
pub(super) fn judge_tree(
    describe: impl FnOnce() -> String,
    source: &'static str,
    (nothing, n_nodes): (bool, usize),
    fault: impl FnOnce() -> Option<Fault>,
) -> Outcome {
    let fault = match (nothing, n_nodes) {
        (true, 0) => None,
        (true, n) => Some((format!("{n} nodes"), "no nodes".into(), "nothing needs no tree")),
        (false, _) => fault(),
    };
    fault.map_or(Ok(()), |(yours, expected, diagnosis)| {
        Err(Broken::with_texts(describe(), yours, expected, source).looks_like(known(diagnosis)))
    })
}

/// The tree that `build` makes, if it comes to an end.
pub(super) fn ended<T>(
    input: &str,
    source: &'static str,
    says: &'static str,
    build: impl FnOnce() -> T,
) -> Result<T, Broken> {
    kit_error::catch(build).map_err(|error| match error {
        KitError::Panicked { message, .. } => {
            Broken::with_texts(input, message, "a tree", source).looks_like(Some(says))
        }
        error => kit_error::unwind(error),
    })
}

/// Whether no more than `most` primitives stand in leaves, each counted once a leaf.
pub(super) fn judge_references(input: &str, yours: &[u32], most: usize, says: &'static str) -> Outcome {
    let describe = |n: usize| format!("{n} references");
    if yours.len() <= most {
        return Ok(());
    }
    let broken =
        Broken::with_texts(input, describe(yours.len()), format!("at most {}", describe(most)), "counted");
    Err(broken.looks_like(Some(says)))
}

/// What is wrong with the lists of leaves, if anything is. Each leaf comes with its cell.
pub(super) fn lists_fault(bounds: &Aabb, boxes: &[Aabb], leaves: &[(u32, Cell, Vec<u32>)]) -> Option<Fault> {
    if let Some((yours, expected)) = bounds_fault(bounds, boxes) {
        return Some((yours, expected, "bounds must be around all boxes that are numbers"));
    }
    for (node, cell, listed) in leaves {
        for (id, one) in boxes.iter().enumerate() {
            let times = listed.iter().filter(|&&other| other == id as u32).count();
            let describe = |times: usize| format!("primitive {id} is listed {times} times in leaf {node}");
            if one.is_empty() && times > 0 {
                return Some((describe(times), describe(0), "what is not a number is in no cell"));
            }
            if !one.is_empty() && cell.touches(one) && times != 1 {
                let touches = (0..3).any(|axis| {
                    let [low, high] = [one.min[axis], one.max[axis]].map(f64::from);
                    high == cell.min[axis] || low == cell.max[axis]
                });
                let diagnosis = match times {
                    0 if touches => "trap A5: what touches a plane belongs to both sides",
                    0 => "a primitive that reaches into several cells belongs to all of them",
                    _ => "a primitive is listed twice in one leaf",
                };
                return Some((describe(times), describe(1), diagnosis));
            }
            if times > 0 && is_far_off(bounds, &cell.to_box(), one) {
                return Some((
                    describe(times),
                    describe(0),
                    "a primitive is listed in a leaf that it does not reach",
                ));
            }
        }
    }
    None
}

/// Sets of boxes on which builders may not end, each with its name.
pub(super) fn endless() -> Vec<(&'static str, Vec<Aabb>)> {
    let cube = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let corner = Aabb::new(Vec3::splat(9.0), Vec3::splat(9.0));
    let concentric = (1..=24).map(|i| Aabb::new(Vec3::splat(-i as f32), Vec3::splat(i as f32))).collect();
    let line = (0..64).map(|i| Aabb::new(Vec3::X * i as f32, Vec3::X * i as f32)).collect();
    let halving =
        (0..100).map(|i| Aabb::new(Vec3::splat(2f32.powi(-i)), Vec3::splat(2f32.powi(-i)))).collect();
    // Of ten, six reach across everything.
    let long = (0..10).map(|i| {
        let x = i as f32;
        if i < 6 {
            Aabb::new(Vec3::ZERO, Vec3::splat(10.0))
        } else {
            Aabb::new(Vec3::splat(x), Vec3::splat(x + 0.5))
        }
    });
    vec![
        ("no boxes", Vec::new()),
        ("one box", vec![cube]),
        ("two boxes", vec![cube, corner]),
        ("1000 boxes in one place", vec![cube; 1000]),
        ("1000 points in one place", vec![Aabb::new(Vec3::ONE, Vec3::ONE); 1000]),
        ("1000 boxes in one place and a point", std::iter::repeat_n(cube, 1000).chain([corner]).collect()),
        ("24 boxes in one another", concentric),
        ("64 points in a line", line),
        ("100 points, each half as far as the one before", halving),
        ("ten boxes of which six are everywhere", long.collect()),
        ("boxes that are not numbers", vec![Aabb::new(Vec3::NAN, Vec3::NAN); 3]),
    ]
}
