//! Stage 12, bonus: queries and answers of the search for the place of a subtree, and of searches with many rays.

use crate::bvh::PrimitiveHit;
use crate::kit::questions::{Asker, Call};
use crate::ray::Ray;
use crate::wide::{
    Child, Entered, FlatTree, LastFetch, NO_PRIMITIVE, OpenedNode, PlaceProbe, StreamProbe, SubtreePlace,
    WideTree,
};
use serde::{Deserialize, Serialize};

/// Asks for the cheapest place of a subtree in a tree whose areas are a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceQuery {
    /// The nodes.
    pub nodes: Vec<OpenedNode>,
    /// The index of the root.
    pub root: u32,
    /// The area of the subtree's box.
    pub area: f64,
}

/// The place of a subtree, and what it cost to find it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceAnswer {
    /// The place.
    pub place: SubtreePlace,
    /// The nodes that were opened, in order.
    pub opened: Vec<u32>,
}

/// The probe that answers from the table of a [`PlaceQuery`] and lists all calls. Where a judge keeps the table, it asks the judge.
pub struct PlaceTableProbe<'a> {
    query: &'a PlaceQuery,
    opened: Vec<u32>,
    asker: Option<Asker>,
}

impl<'a> PlaceTableProbe<'a> {
    /// A probe without calls.
    pub fn new(query: &'a PlaceQuery) -> Self {
        PlaceTableProbe { query, opened: Vec::new(), asker: Asker::for_next_query() }
    }

    /// The answer with the list of all calls.
    pub fn answer(self, place: SubtreePlace) -> PlaceAnswer {
        PlaceAnswer { place, opened: self.opened }
    }
}

impl PlaceProbe for PlaceTableProbe<'_> {
    fn open(&mut self, node: u32) -> OpenedNode {
        if let Some(asker) = &mut self.asker {
            return asker.open_place(node);
        }
        self.opened.push(node);
        self.query.nodes[node as usize]
    }
}

/// Asks to improve a tree by moves of subtrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReinsertQuery {
    /// The tree.
    pub tree: FlatTree,
    /// The largest number of moves.
    pub most_moves: u32,
}

/// Asks for the hits of several rays in a wide tree whose boxes and primitives are tables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StreamQuery {
    /// The tree. Its boxes are not read.
    pub tree: WideTree,
    /// The rays, at most [`STREAM`](crate::wide::STREAM).
    pub rays: Vec<Ray>,
    /// For each ray and node the `t` at which the ray enters each child, not negative; ∞ for a child that it misses.
    pub entries: Vec<Vec<[f32; 8]>>,
    /// For each ray and primitive the `t` of the hit; ∞ for a miss.
    pub hits: Vec<Vec<f32>>,
}

/// The hits of several rays, and what they cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StreamAnswer {
    /// The hit of each ray.
    pub hits: Vec<Option<PrimitiveHit>>,
    /// The nodes that were fetched, in order.
    pub nodes: Vec<u32>,
    /// The blocks that were fetched, in order.
    pub blocks: Vec<u32>,
    /// The rays whose entries into a node were tested, each with the node, in order.
    pub entered: Vec<(u32, u32)>,
    /// The number of calls of all kinds.
    pub n_calls: u32,
}

/// The probe that answers from the tables of a [`StreamQuery`] and lists all fetches. Where a judge keeps the tables, it asks the
/// judge, which counts.
pub struct StreamTableProbe<'a> {
    query: &'a StreamQuery,
    /// The calls so far.
    calls: StreamAnswer,
    last: LastFetch,
    asker: Option<Asker>,
}

impl<'a> StreamTableProbe<'a> {
    /// A probe without calls.
    pub fn new(query: &'a StreamQuery) -> Self {
        StreamTableProbe {
            query,
            calls: StreamAnswer::default(),
            last: LastFetch::default(),
            asker: Asker::for_next_query(),
        }
    }

    /// The answer with the lists of all fetches.
    pub fn answer(self, hits: Vec<Option<PrimitiveHit>>) -> StreamAnswer {
        StreamAnswer { hits, ..self.calls }
    }

    /// Counts a call, and the fetch of a node or block unless the last call was about the same one.
    fn note(&mut self, is_block: bool, index: u32) {
        self.calls.n_calls += 1;
        if self.last.fetches(is_block, index) {
            let list = if is_block { &mut self.calls.blocks } else { &mut self.calls.nodes };
            list.push(index);
        }
    }

    /// The `t` of the hit of a ray with the primitive in a lane, and the number of the primitive.
    #[track_caller]
    fn lane(&self, ray: u32, block: u32, lane: u32) -> (f32, u32) {
        let id = self.query.tree.blocks[block as usize][lane as usize];
        assert!(
            id != NO_PRIMITIVE,
            "lane {lane} of block {block} is free: ask only for the primitives of the leaf"
        );
        (self.query.hits[ray as usize][id as usize], id)
    }
}

impl StreamProbe for StreamTableProbe<'_> {
    fn enter(&mut self, ray: u32, node: u32, t_max: f32) -> Entered {
        if let Some(asker) = &mut self.asker {
            return asker.entered(Call::EnterWideOf(ray, node, t_max));
        }
        let t = self.query.entries[ray as usize][node as usize];
        self.note(false, node);
        self.calls.entered.push((ray, node));
        let entered = |i: &usize| t[*i] < f32::INFINITY && t[*i] <= t_max;
        Entered { mask: (0..8).filter(entered).map(|i| 1 << i).sum(), t }
    }

    fn children(&self, node: u32) -> &[Child; 8] {
        &self.query.tree.nodes[node as usize].children
    }

    fn candidates(&mut self, ray: u32, block: u32, n: u32, t_max: f32) -> u32 {
        if let Some(asker) = &mut self.asker {
            return asker.lanes(Call::CandidatesOf(ray, block, n, t_max));
        }
        let may_hit = |lane: &u32| self.lane(ray, block, *lane).0 < t_max;
        let lanes = (0..n).filter(may_hit).map(|lane| 1 << lane).sum();
        self.note(true, block);
        lanes
    }

    fn hit(&mut self, ray: u32, block: u32, lane: u32, shortened: &Ray) -> Option<PrimitiveHit> {
        if let Some(asker) = &mut self.asker {
            return asker.found(Call::HitLaneOf(ray, block, lane, *shortened));
        }
        let (t, primitive) = self.lane(ray, block, lane);
        self.note(true, block);
        shortened.contains(t).then_some(PrimitiveHit { t, primitive })
    }
}
