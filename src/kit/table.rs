//! Stage 3, bounding volume hierarchies: queries and answers. A search is graded against a table of answers,
//! so that a broken intersection test of an earlier stage costs no points here.

use crate::aabb::Aabb;
use crate::bvh::{Bvh, Contents, Node, PrimitiveHit, PrimitiveRef, Probe};
use crate::count::{Counts, Event, Tally};
use crate::kit::questions::{Asker, Call};
use crate::message;
use crate::ray::Ray;
use crate::scene::Split;

/// Asks where `ray` enters and leaves `bounds`; the answer is two `t` if it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabQuery {
    /// The ray; its range limits the answer.
    pub ray: Ray,
    /// The closed box, in world units.
    pub bounds: Aabb,
}

message! { SlabQuery { ray, bounds } }

/// Asks into which two groups `primitives` are divided; the answer is a [`SplitAnswer`].
#[derive(Clone, Debug, PartialEq)]
pub struct SplitQuery {
    /// The rule by which they are divided.
    pub split: Split,
    /// Two or more primitives that are divided.
    pub primitives: Vec<PrimitiveRef>,
}

message! { SplitQuery { split, primitives } }

/// The two groups into which primitives were divided.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SplitAnswer {
    /// The ids of the primitives in their new order.
    pub order: Vec<u32>,
    /// The primitives `order[..middle]` go left and the others right; `None` asks for a leaf.
    pub middle: Option<usize>,
    /// The number of calls of `union` through `counted`.
    pub unions: u64,
}

message! { SplitAnswer { order, middle, unions } }

/// The answers to all tests of one ray: the interval of `t` in each box and the nearest hit with each
/// primitive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// For each node the `t` at which the ray, without limits, enters and leaves its box; `(inf, -inf)` if it
    /// misses.
    pub boxes: Vec<(f32, f32)>,
    /// For each primitive the `t` of its nearest hit; `inf` if there is none.
    pub primitives: Vec<f32>,
}

message! { Table { boxes, primitives } }

impl Table {
    /// The `t` at which `ray` enters the box of `node`, at least `ray.t_min`. `None` if the ray misses the
    /// box or does not enter it before `ray.t_max`.
    ///
    /// # Panics
    ///
    /// If the table has no box for `node`.
    pub fn enter(&self, node: u32, ray: &Ray) -> Option<f32> {
        let (near, far) = self.boxes[node as usize];
        let enter = near.max(ray.t_min);
        (enter <= far && enter < ray.t_max).then_some(enter)
    }

    /// The `t` at which `ray` hits `primitive`; `None` if that is not in the range of the ray.
    ///
    /// # Panics
    ///
    /// If the table has no such primitive.
    pub fn hit(&self, primitive: u32, ray: &Ray) -> Option<f32> {
        let t = self.primitives[primitive as usize];
        ray.contains(t).then_some(t)
    }

    /// A table of the same size in which every answer is NaN, for a worker that must ask the judge.
    pub fn withheld(&self) -> Table {
        Table {
            boxes: vec![(f32::NAN, f32::NAN); self.boxes.len()],
            primitives: vec![f32::NAN; self.primitives.len()],
        }
    }
}

/// Asks for a hit in `bvh`, with a table that has the answer to every call of the search. The answer is a
/// [`SearchAnswer`].
#[derive(Clone, Debug, PartialEq)]
pub struct SearchQuery {
    /// The hierarchy that is searched; it has no nodes for a search of all primitives.
    pub bvh: Bvh,
    /// The ray, whose range says which hits count. Its origin and direction play no role, because the table
    /// answers.
    pub ray: Ray,
    /// The answers to all box tests and primitive tests.
    pub table: Table,
}

message! { SearchQuery { bvh, ray, table } }

/// The result of a search and the calls that it made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchAnswer {
    /// The hit that the search returned; `None` if there is none, and for a search for any hit.
    pub hit: Option<PrimitiveHit>,
    /// The number of node visits, box tests and primitive tests.
    pub counts: Counts,
    /// The number of primitive tests after one had reported a hit.
    pub tests_after_hit: u64,
}

message! { SearchAnswer { hit, counts, tests_after_hit } }

/// Answers a search from a [`Table`] and counts its calls.
///
/// A search learns of a node from its parent and of a primitive from its leaf. A call for one whose parent or
/// leaf has not been opened counts a visit of each node above it that has not been opened.
///
/// # Panics
///
/// A call with a node or primitive that does not exist panics.
pub struct TableProbe<'a> {
    nodes: &'a [Node],
    table: &'a Table,
    /// The number of calls so far, by kind.
    pub counts: Counts,
    /// The last hit that was reported to the search.
    pub last_hit: Option<PrimitiveHit>,
    /// The number of primitive tests after the first reported hit.
    pub tests_after_hit: u64,
    /// The numbers of the primitives that were tested, in order.
    pub asked: Vec<u32>,
    /// The nodes that have been opened.
    known: Known,
    /// Asks the judge, which has the table.
    asker: Option<Asker>,
}

impl<'a> TableProbe<'a> {
    /// A probe that answers from the hierarchy and the table of `query`.
    pub fn new(query: &'a SearchQuery) -> Self {
        let known = Known::new(&query.bvh);
        TableProbe { nodes: &query.bvh.nodes, known, ..TableProbe::without_hierarchy(&query.table) }
    }

    /// A probe without nodes, for a search that keeps its nodes itself: `open` panics.
    pub fn without_hierarchy(table: &'a Table) -> Self {
        TableProbe {
            nodes: &[],
            table,
            counts: Counts::default(),
            last_hit: None,
            tests_after_hit: 0,
            asked: Vec::new(),
            known: Known::default(),
            asker: Asker::for_next_query(),
        }
    }

    /// The answer of a search that returned `hit`, with the calls that it made.
    pub fn answer(&self, hit: Option<PrimitiveHit>) -> SearchAnswer {
        SearchAnswer { hit, counts: self.counts, tests_after_hit: self.tests_after_hit }
    }
}

impl Probe for TableProbe<'_> {
    fn open(&mut self, node: u32) -> Contents {
        if let Some(asker) = &mut self.asker {
            return asker.contents(Call::Open(node));
        }
        self.counts.node_visits += 1 + self.known.open_above(node).len() as u64;
        self.known.open(node);
        self.nodes[node as usize].contents
    }

    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        if let Some(asker) = &mut self.asker {
            return asker.t(Call::Enter(node, *ray));
        }
        self.counts.note(Event::BoxTest);
        self.counts.node_visits += self.known.open_above(node).len() as u64;
        self.table.enter(node, ray)
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        if let Some(asker) = &mut self.asker {
            return asker.t(Call::Hit(primitive, *ray));
        }
        self.counts.note(Event::PrimitiveTest);
        self.counts.node_visits += self.known.open_leaf_of(primitive).len() as u64;
        self.asked.push(primitive);
        self.tests_after_hit += u64::from(self.last_hit.is_some());
        let t = self.table.hit(primitive, ray)?;
        self.last_hit = Some(PrimitiveHit { t, primitive });
        Some(t)
    }
}

/// The nodes of a hierarchy that a search has opened.
#[derive(Default)]
pub(super) struct Known {
    /// For each node its parent; the root has none.
    parent: Vec<Option<u32>>,
    /// For each primitive the leaf that contains it.
    leaf: Vec<Option<u32>>,
    is_open: Vec<bool>,
}

impl Known {
    /// No node of `bvh` has been opened yet.
    ///
    /// # Panics
    ///
    /// If a node refers to a node or a primitive that does not exist.
    pub(super) fn new(bvh: &Bvh) -> Known {
        let mut parent = vec![None; bvh.nodes.len()];
        let mut leaf = vec![None; bvh.order.len()];
        for (index, node) in (0..).zip(&bvh.nodes) {
            let (above, below) = match node.contents {
                Contents::Inner { left, right } => (&mut parent, &[left, right][..]),
                Contents::Leaf { first, count } => (&mut leaf, bvh.primitives(first, count)),
            };
            for entry in below {
                above[*entry as usize] = Some(index);
            }
        }
        Known { is_open: vec![false; bvh.nodes.len()], parent, leaf }
    }

    /// Opens `node`. Its index may be out of range.
    pub(super) fn open(&mut self, node: u32) {
        if let Some(is_open) = self.is_open.get_mut(node as usize) {
            *is_open = true;
        }
    }

    /// Opens all nodes above `node`; returns those that were not open.
    pub(super) fn open_above(&mut self, node: u32) -> Vec<u32> {
        let mut opened = Vec::new();
        let mut above = self.parent.get(node as usize).copied().flatten();
        while let Some(node) = above.filter(|node| !self.is_open[*node as usize]) {
            self.open(node);
            opened.push(node);
            above = self.parent[node as usize];
        }
        opened
    }

    /// Opens the leaf of `primitive` and all nodes above it; returns those that were not open.
    pub(super) fn open_leaf_of(&mut self, primitive: u32) -> Vec<u32> {
        let leaf = self.leaf.get(primitive as usize).copied().flatten();
        let Some(leaf) = leaf.filter(|leaf| !self.is_open[*leaf as usize]) else { return Vec::new() };
        let mut opened = self.open_above(leaf);
        self.open(leaf);
        opened.push(leaf);
        opened
    }
}
