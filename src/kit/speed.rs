//! Stage 12, speed: queries and answers.

use crate::bvh::PrimitiveHit;
use crate::kit::questions::{Asker, Call};
use crate::message;
use crate::ray::Ray;
use crate::wide::{
    BinGrid, BinSplit, Bins, Child, Entered, NO_PRIMITIVE, PrimitiveBox, TriangleBlock, WideNode, WideProbe,
    WideTree,
};

/// Asks for the cheapest split between bins.
#[derive(Clone, Debug, PartialEq)]
pub struct BinSplitQuery {
    /// The bins of all three axes.
    pub bins: Box<Bins>,
    /// The number of bins per axis that are in use, `2..=MAX_BINS`.
    pub n_bins: u32,
}

message! { BinSplitQuery { bins, n_bins } }

/// Asks for the two sides of a split.
#[derive(Clone, Debug, PartialEq)]
pub struct PartitionQuery {
    /// The primitives.
    pub primitives: Vec<PrimitiveBox>,
    /// Where the bins lie.
    pub grid: BinGrid,
    /// Which bins belong to the left side.
    pub split: BinSplit,
}

message! { PartitionQuery { primitives, grid, split } }

/// Asks which boxes of a node a ray enters.
#[derive(Clone, Debug, PartialEq)]
pub struct WideBoxesQuery {
    /// The node.
    pub node: Box<WideNode>,
    /// The ray, with `t_min >= 0`.
    pub ray: Ray,
}

message! { WideBoxesQuery { node, ray } }

/// Asks which triangles of a block a ray may hit.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockQuery {
    /// The triangles.
    pub block: Box<TriangleBlock>,
    /// The ray, with `t_min >= 0`.
    pub ray: Ray,
}

message! { BlockQuery { block, ray } }

/// Asks for a hit in a wide tree whose boxes and primitives are a table.
#[derive(Clone, Debug, PartialEq)]
pub struct WideQuery {
    /// The tree. Its boxes are not read.
    pub tree: WideTree,
    /// The ray.
    pub ray: Ray,
    /// For each node the `t` at which the ray enters each child, not negative; ∞ for a child that it misses.
    pub entries: Vec<[f32; 8]>,
    /// For each primitive the `t` of the hit; ∞ for a miss.
    pub hits: Vec<f32>,
}

message! { WideQuery { tree, ray, entries, hits } }

/// The hit of a search in a wide tree, and what it cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WideAnswer {
    /// The hit.
    pub hit: Option<PrimitiveHit>,
    /// Whether anything was hit.
    pub found: bool,
    /// The nodes whose boxes were tested, in order.
    pub nodes: Vec<u32>,
    /// The blocks that were tested, in order.
    pub blocks: Vec<u32>,
    /// The primitives that were tested exactly, in order.
    pub primitives: Vec<u32>,
    /// The number of calls after the first hit.
    pub calls_after_hit: u32,
}

message! { WideAnswer { hit, found, nodes, blocks, primitives, calls_after_hit } }

/// The probe that answers from the table of a [`WideQuery`] and lists all calls. Where a judge keeps the tables, it asks the
/// judge, which lists the calls.
pub struct WideTableProbe<'a> {
    query: &'a WideQuery,
    /// The calls so far.
    calls: WideAnswer,
    /// Whether a call has returned a hit.
    has_hit: bool,
    asker: Option<Asker>,
}

impl<'a> WideTableProbe<'a> {
    /// A probe without calls.
    pub fn new(query: &'a WideQuery) -> Self {
        WideTableProbe { query, calls: WideAnswer::default(), has_hit: false, asker: Asker::for_next_query() }
    }

    /// The answer with the lists of all calls.
    pub fn answer(self, hit: Option<PrimitiveHit>, found: bool) -> WideAnswer {
        WideAnswer { hit, found, ..self.calls }
    }

    /// The primitive in a lane.
    #[track_caller]
    fn primitive(&self, block: u32, lane: u32) -> u32 {
        let id = self.query.tree.blocks[block as usize][lane as usize];
        assert!(
            id != NO_PRIMITIVE,
            "lane {lane} of block {block} is free: ask only for the primitives of the leaf"
        );
        id
    }

    /// Counts a call.
    fn note(&mut self) {
        self.calls.calls_after_hit += u32::from(self.has_hit);
    }
}

impl WideProbe for WideTableProbe<'_> {
    fn enter(&mut self, node: u32, t_max: f32) -> Entered {
        if let Some(asker) = &mut self.asker {
            return asker.entered(Call::EnterWide(node, t_max));
        }
        self.note();
        self.calls.nodes.push(node);
        let t = self.query.entries[node as usize];
        let entered = |i: &usize| t[*i] < f32::INFINITY && t[*i] <= t_max;
        Entered { mask: (0..8).filter(entered).map(|i| 1 << i).sum(), t }
    }

    fn children(&self, node: u32) -> &[Child; 8] {
        &self.query.tree.nodes[node as usize].children
    }

    fn candidates(&mut self, block: u32, n: u32, t_max: f32) -> u32 {
        if let Some(asker) = &mut self.asker {
            return asker.lanes(Call::Candidates(block, n, t_max));
        }
        self.note();
        self.calls.blocks.push(block);
        let may_hit = |lane: &u32| self.query.hits[self.primitive(block, *lane) as usize] < t_max;
        (0..n).filter(may_hit).map(|lane| 1 << lane).sum()
    }

    fn hit(&mut self, block: u32, lane: u32, ray: &Ray) -> Option<PrimitiveHit> {
        if let Some(asker) = &mut self.asker {
            return asker.found(Call::HitLane(block, lane, *ray));
        }
        self.note();
        let primitive = self.primitive(block, lane);
        self.calls.primitives.push(primitive);
        let t = self.query.hits[primitive as usize];
        let hit = ray.contains(t).then_some(PrimitiveHit { t, primitive });
        self.has_hit |= hit.is_some();
        hit
    }
}
