//! Stage 9 in plain data. As in stage 3 a search is graded against a table of answers; here the cells themselves are
//! geometry, so the ray counts as well.

use crate::aabb::Aabb;
use crate::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use crate::count::{Counts, Event, Tally};
use crate::kit::Table;
use crate::partition::{Cells, KdHeuristics};
use crate::ray::Ray;
use glam::{UVec3, Vec3};
use serde::{Deserialize, Serialize};

/// How fine shall a grid be?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResolutionQuery {
    /// The box to be divided.
    pub bounds: Aabb,
    /// How many primitives lie in it.
    pub n_primitives: usize,
    /// How many cells there shall be for each.
    pub density: f32,
}

/// Put these boxes into a grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GridQuery {
    /// One box a primitive.
    pub bounds: Vec<Aabb>,
    /// How many cells along each axis.
    pub resolution: UVec3,
}

/// Build an octree over these boxes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OctreeQuery {
    /// One box a primitive.
    pub bounds: Vec<Aabb>,
    /// So few primitives are not divided.
    pub leaf_size: usize,
    /// The depth below which nothing is divided; the root is at depth 0.
    pub max_depth: usize,
}

/// Build a kd-tree over these boxes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KdQuery {
    /// One box a primitive.
    pub bounds: Vec<Aabb>,
    /// By which rules.
    pub heuristics: KdHeuristics,
    /// So few primitives are not divided.
    pub leaf_size: usize,
}

/// Build a BSP tree over these hulls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BspQuery {
    /// For each primitive the corners of a polygon, or the eight of a box.
    pub hulls: Vec<Vec<Vec3>>,
    /// So few primitives are not divided.
    pub leaf_size: usize,
    /// The depth below which nothing is divided; the root is at depth 0.
    pub max_depth: usize,
}

/// Find the closest hit in `cells`, given the answers to every question that the search may ask.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellsQuery<S> {
    /// What is to be searched.
    pub cells: S,
    /// The ray.
    pub ray: Ray,
    /// For each primitive the `t` of its nearest hit; `inf` if there is none.
    pub hits: Vec<f32>,
}

/// What a search of cells found, and what it did.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CellsAnswer {
    /// The closest hit, if any.
    pub hit: Option<PrimitiveHit>,
    /// The nodes or cells that were visited, in order.
    pub visits: Vec<u32>,
    /// The primitives that were tested, in order.
    pub tests: Vec<u32>,
}

/// Find the closest hit, knowing what the ray before met first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CachedQuery {
    /// The primitive that the ray before met first.
    pub last: Option<u32>,
    /// The ray.
    pub ray: Ray,
    /// For each primitive the `t` of its nearest hit; `inf` if there is none.
    pub hits: Vec<f32>,
    /// For each primitive the `t` at which the ray enters its box.
    pub entries: Vec<f32>,
}

impl CachedQuery {
    /// The search that is made faster: it tests all whose boxes are entered before the ray ends, and visits a box for
    /// each. Its answer does not come from these tests: it is the smallest `t` of the table.
    pub fn search(&self, probe: &mut CellsProbe<'_>, ray: &Ray) -> Option<PrimitiveHit> {
        for (primitive, _) in (0..).zip(&self.entries).filter(|(_, entry)| **entry < ray.t_max) {
            probe.visit(primitive);
            probe.hit(primitive, ray);
        }
        let t = self.hits.iter().copied().filter(|t| ray.contains(*t)).min_by(f32::total_cmp)?;
        let primitive = self.hits.iter().position(|hit| *hit == t)? as u32;
        Some(PrimitiveHit { t, primitive })
    }
}

/// Find the closest hits of several rays in one go.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PacketQuery {
    /// The hierarchy to search.
    pub bvh: Bvh,
    /// The rays. Where they start and go tells them apart; the tables answer.
    pub rays: Vec<Ray>,
    /// The answers, a table a ray.
    pub tables: Vec<Table>,
}

/// What a packet found and what it asked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PacketAnswer {
    /// The closest hit of each ray.
    pub hits: Vec<Option<PrimitiveHit>>,
    /// The nodes that were opened, in order.
    pub opened: Vec<u32>,
    /// Nodes, boxes and primitives that were asked about.
    pub counts: Counts,
}

/// Answers from a table of hits, and keeps what was asked.
pub struct CellsProbe<'a> {
    hits: &'a [f32],
    /// The answer so far.
    pub answer: CellsAnswer,
}

/// A search that asks more often than this is lost in a loop.
const MOST_VISITS: usize = 1 << 20;

impl<'a> CellsProbe<'a> {
    /// A probe that answers from `hits`.
    pub fn new(hits: &'a [f32]) -> Self {
        CellsProbe { hits, answer: CellsAnswer::default() }
    }
}

impl Cells for CellsProbe<'_> {
    #[track_caller]
    fn visit(&mut self, node: u32) {
        assert!(
            self.answer.visits.len() < MOST_VISITS,
            "the search goes on for ever: does every step get ahead?"
        );
        self.answer.visits.push(node);
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.answer.tests.push(primitive);
        let t = self.hits[primitive as usize];
        ray.contains(t).then_some(t)
    }
}

/// Answers from the tables of several rays, which it tells apart by where they start and go.
pub struct PacketProbe<'a> {
    query: &'a PacketQuery,
    /// The answer so far.
    pub answer: PacketAnswer,
}

impl<'a> PacketProbe<'a> {
    /// A probe that answers for `query`.
    pub fn new(query: &'a PacketQuery) -> Self {
        PacketProbe { query, answer: PacketAnswer::default() }
    }

    #[track_caller]
    fn table(&self, ray: &Ray) -> &'a Table {
        let same = |one: &Ray| (one.origin, one.dir, one.t_min) == (ray.origin, ray.dir, ray.t_min);
        match self.query.rays.iter().position(same) {
            Some(index) => &self.query.tables[index],
            None => panic!("a ray that is not of the packet: only t_max may change"),
        }
    }
}

impl Probe for PacketProbe<'_> {
    fn open(&mut self, node: u32) -> Contents {
        self.answer.counts.note(Event::NodeVisit);
        self.answer.opened.push(node);
        self.query.bvh.nodes[node as usize].contents
    }

    #[track_caller]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.answer.counts.note(Event::BoxTest);
        self.table(ray).enter(node, ray)
    }

    #[track_caller]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.answer.counts.note(Event::PrimitiveTest);
        self.table(ray).hit(primitive, ray)
    }
}
