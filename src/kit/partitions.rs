//! Stage 9, partitions of space: queries and answers. As in stage 3 a search is graded against a table of
//! answers; here the cells themselves are geometry, so the ray matters as well.

use crate::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use crate::count::{Counts, Event, Tally};
use crate::kit::Table;
use crate::kit::questions::{Asker, Call};
use crate::kit::table::Known;
use crate::message;
use crate::partition::Cells;
use crate::ray::Ray;

/// Asks for the closest hit in `cells`, with a table that has the answer to every primitive test.
#[derive(Clone, Debug, PartialEq)]
pub struct CellsQuery<S> {
    /// The grid or the tree that is searched.
    pub cells: S,
    /// The ray, in world units; its range says which hits count.
    pub ray: Ray,
    /// For each primitive the `t` of its nearest hit; `inf` if there is none.
    pub hits: Vec<f32>,
}

message! { CellsQuery<S> { cells, ray, hits } }

/// The result of a search of cells, and the calls that it made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellsAnswer {
    /// The closest hit; `None` if nothing is hit.
    pub hit: Option<PrimitiveHit>,
    /// The numbers of the nodes or cells that were visited, in order.
    pub visits: Vec<u32>,
    /// The numbers of the primitives that were tested, in order.
    pub tests: Vec<u32>,
}

message! { CellsAnswer { hit, visits, tests } }

/// Asks for the closest hit of a ray, given the first hit of the previous ray.
#[derive(Clone, Debug, PartialEq)]
pub struct CachedQuery {
    /// The number of the primitive that the previous ray hit first; `None` if it hit nothing.
    pub last: Option<u32>,
    /// The ray; its range says which hits count, and its origin and direction play no role.
    pub ray: Ray,
    /// For each primitive the `t` of its nearest hit; `inf` if there is none.
    pub hits: Vec<f32>,
    /// For each primitive the `t` at which the ray enters its box.
    pub entries: Vec<f32>,
}

message! { CachedQuery { last, ray, hits, entries } }

impl CachedQuery {
    /// The search that the cache speeds up: it visits and tests every primitive whose box is entered before
    /// `ray.t_max`. Its answer is the smallest `t` of the table and does not depend on these tests.
    ///
    /// # Panics
    ///
    /// If `hits` is shorter than `entries`.
    pub fn search(&self, probe: &mut CellsProbe<'_>, ray: &Ray) -> Option<PrimitiveHit> {
        if let Some(asker) = &mut probe.asker {
            return asker.found(Call::Search(*ray));
        }
        for (primitive, _) in (0..).zip(&self.entries).filter(|(_, entry)| **entry < ray.t_max) {
            probe.visit(primitive);
            probe.hit(primitive, ray);
        }
        let t = self.hits.iter().copied().filter(|t| ray.contains(*t)).min_by(f32::total_cmp)?;
        let primitive = self.hits.iter().position(|hit| *hit == t)? as u32;
        Some(PrimitiveHit { t, primitive })
    }
}

/// Asks for the closest hits of several rays at once.
#[derive(Clone, Debug, PartialEq)]
pub struct PacketQuery {
    /// The hierarchy that is searched.
    pub bvh: Bvh,
    /// The rays. The probe tells them apart by `origin`, `direction` and `t_min`; all answers come from the tables.
    pub rays: Vec<Ray>,
    /// The answers: one table per ray, in the same order.
    pub tables: Vec<Table>,
}

message! { PacketQuery { bvh, rays, tables } }

/// The result of a search with a packet of rays, and the calls that it made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PacketAnswer {
    /// The closest hit of each ray; `None` if it hits nothing.
    pub hits: Vec<Option<PrimitiveHit>>,
    /// The indices of the nodes that were opened, in order.
    pub opened: Vec<u32>,
    /// The number of node visits, box tests and primitive tests.
    pub counts: Counts,
}

message! { PacketAnswer { hits, opened, counts } }

/// Answers a search of cells from a table of hits, and records its calls.
///
/// # Panics
///
/// `visit` panics after 2²⁰ visits, and `hit` if the table has no such primitive.
pub struct CellsProbe<'a> {
    hits: &'a [f32],
    /// The calls so far; its `hit` remains `None`.
    pub answer: CellsAnswer,
    /// Asks the judge, which has the table.
    asker: Option<Asker>,
}

/// A search with more visits does not end by itself.
const MOST_VISITS: usize = 1 << 20;

impl<'a> CellsProbe<'a> {
    /// A probe that answers from `hits`: for each primitive the `t` of its nearest hit, `inf` if there is
    /// none.
    pub fn new(hits: &'a [f32]) -> Self {
        CellsProbe { hits, answer: CellsAnswer::default(), asker: Asker::for_next_query() }
    }

    /// The answer of a search that returned `hit`, with the calls that it made.
    pub fn finish(mut self, hit: Option<PrimitiveHit>) -> CellsAnswer {
        if let Some(asker) = &mut self.asker {
            asker.end();
        }
        CellsAnswer { hit, ..self.answer }
    }
}

impl Cells for CellsProbe<'_> {
    #[track_caller]
    fn visit(&mut self, node: u32) {
        assert!(self.answer.visits.len() < MOST_VISITS, "the search does not end: does every step advance?");
        self.answer.visits.push(node);
        if let Some(asker) = &mut self.asker {
            asker.note_visit(node);
        }
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        if let Some(asker) = &mut self.asker {
            return asker.t(Call::Hit(primitive, *ray));
        }
        self.answer.tests.push(primitive);
        let t = self.hits[primitive as usize];
        ray.contains(t).then_some(t)
    }
}

/// Answers a packet search from the tables of several rays, and counts its calls. A ray is recognised by its
/// `origin`, `direction` and `t_min`. As in [`TableProbe`](super::TableProbe), a call for a node or a primitive
/// opens the nodes above it.
///
/// # Panics
///
/// `enter` and `hit` panic for a ray that is not in the packet, and every call for a node or primitive that
/// does not exist.
pub struct PacketProbe<'a> {
    query: &'a PacketQuery,
    /// The calls so far; its `hits` remain empty.
    pub answer: PacketAnswer,
    /// The nodes that have been opened.
    known: Known,
    /// Asks the judge, which has the tables.
    asker: Option<Asker>,
}

impl<'a> PacketProbe<'a> {
    /// A probe that answers from the hierarchy and the tables of `query`.
    pub fn new(query: &'a PacketQuery) -> Self {
        let known = Known::new(&query.bvh);
        PacketProbe { query, answer: PacketAnswer::default(), known, asker: Asker::for_next_query() }
    }

    fn note_visits(&mut self, nodes: impl IntoIterator<Item = u32>) {
        for node in nodes {
            self.answer.counts.note(Event::NodeVisit);
            self.answer.opened.push(node);
        }
    }

    #[track_caller]
    fn table(&self, ray: &Ray) -> &'a Table {
        let same =
            |one: &Ray| (one.origin, one.direction, one.t_min) == (ray.origin, ray.direction, ray.t_min);
        match self.query.rays.iter().position(same) {
            Some(index) => &self.query.tables[index],
            None => panic!("a ray that is not in the packet: only t_max may change"),
        }
    }
}

impl Probe for PacketProbe<'_> {
    fn open(&mut self, node: u32) -> Contents {
        if let Some(asker) = &mut self.asker {
            return asker.contents(Call::Open(node));
        }
        let above = self.known.open_above(node);
        self.known.open(node);
        self.note_visits(above.into_iter().chain([node]));
        self.query.bvh.nodes[node as usize].contents
    }

    #[track_caller]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        if let Some(asker) = &mut self.asker {
            return asker.t(Call::Enter(node, *ray));
        }
        self.answer.counts.note(Event::BoxTest);
        let above = self.known.open_above(node);
        self.note_visits(above);
        self.table(ray).enter(node, ray)
    }

    #[track_caller]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        if let Some(asker) = &mut self.asker {
            return asker.t(Call::Hit(primitive, *ray));
        }
        self.answer.counts.note(Event::PrimitiveTest);
        let above = self.known.open_leaf_of(primitive);
        self.note_visits(above);
        self.table(ray).hit(primitive, ray)
    }
}
