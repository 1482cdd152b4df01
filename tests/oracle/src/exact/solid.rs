//! Convex solids: a line is inside between the last of its entries and the first of its exits.

use super::body::Hit;
use super::ring::Ring;
use super::root::{Root, beyond};
use super::scale::Frame;
use raykata::ray::Ray;

/// The part of a line that is inside a solid.
#[derive(Clone, Copy, Debug)]
pub(super) enum Span<R> {
    /// No point is inside.
    Empty,
    /// `t` is inside if it is not below any of the first and not above any of the second; there is one of each.
    Lerp([Option<Root<R>>; 3], [Option<Root<R>>; 3]),
}

/// The first point in the range of the ray where it enters or leaves.
#[inline(always)]
pub(super) fn first<R: Ring>(span: Span<R>, ray: &Ray, frame: &Frame) -> Option<Option<Hit<R>>> {
    let Span::Lerp(entries, exits) = span else {
        return Some(None);
    };
    // Compare the entries and exits pair by pair, because one pair in the wrong order is a miss, even if
    // other pairs are undecided.
    let mut undecided = false;
    let mut touches = false;
    for entry in entries.iter().flatten() {
        for exit in exits.iter().flatten() {
            // Two surds are the two roots of the one quadric that a solid has.
            let order = match (entry.surd, exit.surd) {
                (Some(quadric), Some(_)) => quadric.disc.sign().map(|sign| -sign),
                _ => entry.compare(exit),
            };
            match order {
                Some(1) => return Some(None),
                Some(0) => touches = true,
                Some(_) => {}
                None => undecided = true,
            }
        }
    }
    if undecided {
        return None;
    }
    let enter = extreme(entries, 1)?;
    let leave = extreme(exits, -1)?;
    if let Some(hit) = within(enter, ray, frame)? {
        return Some(Some(Hit { root: hit, touches }));
    }
    Some(within(leave, ray, frame)?.map(|root| Hit { root, touches }))
}

/// The last of some roots for 1, the first for -1.
fn extreme<R: Ring>(roots: [Option<Root<R>>; 3], side: i32) -> Option<Root<R>> {
    let mut all = roots.into_iter().flatten();
    let mut best = all.next()?;
    for root in all {
        if root.compare(&best)? == side {
            best = root;
        }
    }
    Some(best)
}

fn within<R: Ring>(root: Root<R>, ray: &Ray, frame: &Frame) -> Option<Option<Root<R>>> {
    let inside = beyond(&root, ray.t_min, frame)? > 0 && beyond(&root, ray.t_max, frame)? < 0;
    Some(inside.then_some(root))
}
