//! Stage 3 in plain data. A search is graded against a table of answers, so that a broken intersection routine of an
//! earlier stage costs nothing here.

use crate::aabb::Aabb;
use crate::bvh::{Bvh, Contents, Node, PrimitiveHit, PrimitiveRef, Probe};
use crate::count::{Counts, Event, Tally};
use crate::ray::Ray;
use crate::scene::Split;
use serde::{Deserialize, Serialize};

/// Where does `ray` enter and leave `bounds`?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlabQuery {
    /// The ray.
    pub ray: Ray,
    /// The box.
    pub bounds: Aabb,
}

/// Divide `primitives`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SplitQuery {
    /// By which rule.
    pub split: Split,
    /// What is to be divided, two primitives or more.
    pub primitives: Vec<PrimitiveRef>,
}

/// How primitives were divided.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SplitAnswer {
    /// Ids in their new order.
    pub order: Vec<u32>,
    /// `order[..middle]` goes left and the rest right; `None` asks for a leaf.
    pub middle: Option<usize>,
}

/// Build a hierarchy over `bounds`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BuildQuery {
    /// One box a primitive.
    pub bounds: Vec<Aabb>,
    /// How to divide them.
    pub split: Split,
    /// The most primitives in a leaf, at least 1.
    pub leaf_size: usize,
}

/// What one ray meets: intervals for all boxes and distances for all primitives, worked out beforehand.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// For each node the `t` at which the endless ray enters and leaves its box; `(inf, -inf)` if it misses.
    pub boxes: Vec<(f32, f32)>,
    /// For each primitive the `t` of its nearest hit; `inf` if there is none.
    pub primitives: Vec<f32>,
}

impl Table {
    /// Where `ray` enters the box of `node`, if it does before `t_max`.
    pub fn enter(&self, node: u32, ray: &Ray) -> Option<f32> {
        let (near, far) = self.boxes[node as usize];
        let enter = near.max(ray.t_min);
        (enter <= far && enter < ray.t_max).then_some(enter)
    }

    /// Where `ray` hits `primitive`, if it does within its range.
    pub fn hit(&self, primitive: u32, ray: &Ray) -> Option<f32> {
        let t = self.primitives[primitive as usize];
        ray.contains(t).then_some(t)
    }
}

/// Find a hit in `bvh`, given the answers to every question that the search may ask.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchQuery {
    /// The hierarchy to search; without nodes for a search of all primitives.
    pub bvh: Bvh,
    /// Which `t` count. Its origin and direction play no part: the table answers.
    pub ray: Ray,
    /// The answers.
    pub table: Table,
}

/// What a search found and what it asked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SearchAnswer {
    /// The hit, if any. For a search of any hit: the last one that the search was told of.
    pub hit: Option<PrimitiveHit>,
    /// Nodes, boxes and primitives that were asked about.
    pub counts: Counts,
    /// How many primitives were asked about after one had been reported as hit.
    pub tests_after_hit: u64,
}

/// Answers from a [`Table`] and counts the questions.
pub struct TableProbe<'a> {
    nodes: &'a [Node],
    table: &'a Table,
    /// What was asked so far.
    pub counts: Counts,
    /// The last primitive that was reported as hit.
    pub last_hit: Option<PrimitiveHit>,
    /// Primitives that were asked about after the first hit.
    pub tests_after_hit: u64,
    /// The primitives that were asked about, in this order.
    pub asked: Vec<u32>,
}

impl<'a> TableProbe<'a> {
    /// A probe that answers for `query`.
    pub fn new(query: &'a SearchQuery) -> Self {
        TableProbe { nodes: &query.bvh.nodes, ..TableProbe::without_hierarchy(&query.table) }
    }

    /// A probe for a search that keeps its nodes itself.
    pub fn without_hierarchy(table: &'a Table) -> Self {
        let counts = Counts::default();
        TableProbe { nodes: &[], table, counts, last_hit: None, tests_after_hit: 0, asked: Vec::new() }
    }

    /// What the search has found and asked.
    pub fn answer(&self, hit: Option<PrimitiveHit>) -> SearchAnswer {
        SearchAnswer { hit, counts: self.counts, tests_after_hit: self.tests_after_hit }
    }
}

impl Probe for TableProbe<'_> {
    fn open(&mut self, node: u32) -> Contents {
        self.counts.note(Event::NodeVisit);
        self.nodes[node as usize].contents
    }

    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.counts.note(Event::BoxTest);
        self.table.enter(node, ray)
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.counts.note(Event::PrimitiveTest);
        self.asked.push(primitive);
        self.tests_after_hit += u64::from(self.last_hit.is_some());
        let t = self.table.hit(primitive, ray)?;
        self.last_hit = Some(PrimitiveHit { t, primitive });
        Some(t)
    }
}
