//! Searches of an octree with one mistake each at its octants. A mistake is named only if its search gives exactly the
//! student's answer.

use super::parts::exactly;
use super::search_mistakes::{Hit, Mistakes, ROOM, Wrong};
use checks::prelude::*;
use raykata::partition::{Cell, Octree, OctreeNode};

/// The hit of a search of an octree that keeps one of several octants with the same entry: the last one, as a map with the
/// entries as keys does, or the first one.
fn one_of_equal_entries(octree: &Octree, ray: &Ray, hits: &[f32], keeps_last: bool) -> Hit {
    fn below(
        octree: &Octree,
        node: u32,
        cell: &Cell,
        (ray, hits, keeps_last): (&Ray, &[f32], bool),
        best: &mut Hit,
    ) {
        let kept = Wrong::NoRoom;
        let first = match octree.nodes[node as usize] {
            OctreeNode::Leaf { first, count } => {
                return kept.keep(best, kept.of_cell(octree.primitives(first, count), hits, ray));
            }
            OctreeNode::Inner { first } => first,
        };
        let mut entered: Vec<(f64, u32, Cell)> = Vec::new();
        for octant in 0..8 {
            let cell = cell.octant(octant);
            let Some((enter, _)) = exactly(ray, &cell) else { continue };
            let same = entered.iter().position(|(other, ..)| *other == enter);
            match same {
                Some(index) if keeps_last => entered[index] = (enter, first + octant as u32, cell),
                Some(_) => {}
                None => entered.push((enter, first + octant as u32, cell)),
            }
        }
        entered.sort_by(|p, q| p.0.total_cmp(&q.0));
        for (enter, node, cell) in entered {
            if best.is_none_or(|(_, t)| f64::from(t) * (1.0 + ROOM) >= enter) {
                below(octree, node, &cell, (ray, hits, keeps_last), best);
            }
        }
    }
    let mut best = None;
    if !octree.nodes.is_empty() {
        below(octree, 0, &Cell::new(&octree.bounds), (ray, hits, keeps_last), &mut best);
    }
    best
}

/// The known mistakes at octants, each with whether it finds this hit.
pub(super) fn of_octree(octree: &Octree, ray: &Ray, hits: &[f32], found: Hit) -> Mistakes {
    let gives = |keeps_last| one_of_equal_entries(octree, ray, hits, keeps_last) == found;
    vec![
        (gives(true), "of octants that the ray enters at the same t you search only one, the last one"),
        (gives(false), "of octants that the ray enters at the same t you search only one, the first one"),
    ]
}
