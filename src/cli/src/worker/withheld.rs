//! The judge's side of a withheld request: it keeps the tables, answers the questions of the searches, and counts them.

use raykata::bvh::Probe;
use raykata::kit::questions::{Call, Question, Response};
use raykata::kit::{
    Answer, CachedGraphQuery, CachedQuery, CellsAnswer, CellsProbe, CellsQuery, Costs, GraphQuery, KitError,
    PacketProbe, PacketQuery, Request, SearchQuery, ShadeQuery, ShadowProbe, TableProbe, WideQuery,
    WideTableProbe, kit_error,
};
use raykata::partition::Cells;
use raykata::wide::WideProbe;

/// The most calls of a query. A search that makes more does not end, and its calls would fill the memory of the judge.
const MOST_CALLS: u32 = 1 << 20;

/// The tables of a request, and the calls that the worker has made so far.
pub(super) struct Withheld<'a>(Vec<QueryCalls<'a>>);

/// The calls of one query.
struct QueryCalls<'a> {
    n_calls: u32,
    probe: ProbeOfQuery<'a>,
}

/// A probe with its table.
enum ProbeOfQuery<'a> {
    Table(TableProbe<'a>),
    Cells(CellsProbe<'a>),
    Cached(CellsProbe<'a>, &'a CachedQuery),
    Packet(PacketProbe<'a>),
    Shadows(ShadowProbe<'a>),
    Wide(WideTableProbe<'a>),
}

/// A query with a table that the judge can keep.
trait Tabled: Clone {
    /// Replaces every number of the table by one that says nothing.
    fn withhold(&mut self);

    /// A probe with the table.
    fn probe(&self) -> ProbeOfQuery<'_>;
}

macro_rules! tabled {
    ($(($($generics:tt)*) $Query:ty: |$query:ident| $withhold:expr, $probe:expr;)*) => {
        $(impl $($generics)* Tabled for $Query {
            fn withhold(&mut self) {
                let $query = self;
                $withhold;
            }

            fn probe(&self) -> ProbeOfQuery<'_> {
                let $query = self;
                $probe
            }
        })*
    };
}

tabled! {
    () SearchQuery: |q| q.table = q.table.withheld(), ProbeOfQuery::Table(TableProbe::new(q));
    () GraphQuery: |q| q.table = q.table.withheld(), ProbeOfQuery::Table(TableProbe::without_hierarchy(&q.table));
    () CachedGraphQuery: |q| q.search.withhold(), q.search.probe();
    (<S: Clone>) CellsQuery<S>: |q| q.hits.fill(f32::NAN), ProbeOfQuery::Cells(CellsProbe::new(&q.hits));
    () CachedQuery: |q| (q.hits.fill(f32::NAN), q.entries.fill(f32::NAN)),
        ProbeOfQuery::Cached(CellsProbe::new(&q.hits), q);
    () PacketQuery: |q| q.tables.iter_mut().for_each(|table| *table = table.withheld()),
        ProbeOfQuery::Packet(PacketProbe::new(q));
    () ShadeQuery: |q| q.visible.fill(false), ProbeOfQuery::Shadows(ShadowProbe::new(q));
    () WideQuery: |q| (q.entries.fill([f32::NAN; 8]), q.hits.fill(f32::NAN)),
        ProbeOfQuery::Wide(WideTableProbe::new(q));
}

/// The requests whose queries have tables.
macro_rules! requests {
    ($($Message:ident)*) => {
        /// Returns the request without its tables; `None` if it has none.
        pub fn withheld(request: &Request) -> Option<Request> {
            let without_tables = match request {
                $(Request::$Message(queries) => {
                    let mut queries = queries.clone();
                    queries.iter_mut().for_each(Tabled::withhold);
                    Request::$Message(queries)
                })*
                _ => return None,
            };
            Some(Request::Withheld(Box::new(without_tables)))
        }

        /// A probe for each query; none for a request without tables.
        fn probes(request: &Request) -> Vec<ProbeOfQuery<'_>> {
            match request {
                $(Request::$Message(queries) => queries.iter().map(Tabled::probe).collect(),)*
                _ => Vec::new(),
            }
        }
    };
}

requests! {
    BruteForce ClosestHitBoth ClosestHit AnyHit Shade GraphHit CachedGraphHit CachedSearch PacketSearch
    GridSearch OctreeByCells OctreeByNeighbours OctreeSearch KdSearch BspSearch PolygonBspSearch
    WideClosestHit WideAnyHit
}

impl<'a> Withheld<'a> {
    /// Keeps the tables of `request`, whose worker gets [`withheld`] tables.
    pub(super) fn of(request: &'a Request) -> Withheld<'a> {
        let asked = |probe| QueryCalls { n_calls: 0, probe };
        Withheld(probes(request).into_iter().map(asked).collect())
    }

    /// Answers a question, and counts it. A call that the probe does not allow is refused with the message of its panic.
    pub(super) fn answer(&mut self, question: &Question) -> Response {
        let Some(asked) = self.0.get_mut(question.query as usize) else {
            return Response::Refused("there is no such query".into());
        };
        let n_calls = u32::try_from(question.visits.len()).unwrap_or(MOST_CALLS).saturating_add(1);
        asked.n_calls = asked.n_calls.saturating_add(n_calls);
        if asked.n_calls > MOST_CALLS {
            return Response::Refused("the search does not end: does every step advance?".into());
        }
        match kit_error::catch(|| asked.probe.answer(question)) {
            Ok(response) => response,
            Err(KitError::Panicked { message, .. }) => Response::Refused(message),
            Err(error) => Response::Refused(error.to_string()),
        }
    }

    /// Replaces the counts in an answer by those of the judge.
    pub(super) fn correct(self, answer: &mut Answer) {
        for (costs, asked) in answer.costs().into_iter().zip(self.0) {
            match (costs, asked.probe) {
                (Costs::Search(answer), ProbeOfQuery::Table(probe)) => *answer = probe.answer(answer.hit),
                (Costs::Graph(answer), ProbeOfQuery::Table(probe)) => {
                    answer.search = probe.answer(answer.search.hit);
                    answer.asked = probe.asked;
                }
                (Costs::Cells(answer), ProbeOfQuery::Cells(probe) | ProbeOfQuery::Cached(probe, _)) => {
                    *answer = CellsAnswer { hit: answer.hit, ..probe.answer };
                }
                (Costs::Packet(answer), ProbeOfQuery::Packet(probe)) => {
                    answer.opened = probe.answer.opened;
                    answer.counts = probe.answer.counts;
                }
                (Costs::Wide(answer), ProbeOfQuery::Wide(probe)) => {
                    *answer = probe.answer(answer.hit, answer.found)
                }
                (Costs::Shade(answer), ProbeOfQuery::Shadows(probe)) => *answer = probe.finish(answer.color),
                // An answer of another kind than its request is refused elsewhere.
                _ => {}
            }
        }
    }
}

impl ProbeOfQuery<'_> {
    fn answer(&mut self, question: &Question) -> Response {
        if let ProbeOfQuery::Cells(probe) | ProbeOfQuery::Cached(probe, _) = self {
            question.visits.iter().for_each(|node| probe.visit(*node));
        }
        match (self, question.call) {
            (ProbeOfQuery::Table(probe), call) => of_nodes(probe, call),
            (ProbeOfQuery::Packet(probe), call) => of_nodes(probe, call),
            (ProbeOfQuery::Cells(probe) | ProbeOfQuery::Cached(probe, _), Call::Hit(primitive, ray)) => {
                Response::T(probe.hit(primitive, &ray))
            }
            (ProbeOfQuery::Cells(_) | ProbeOfQuery::Cached(..), Call::End) => Response::Recorded,
            (ProbeOfQuery::Cached(probe, query), Call::Search(ray)) => {
                Response::Found(query.search(probe, &ray))
            }
            (ProbeOfQuery::Shadows(probe), Call::Visible(light, ray)) => {
                Response::Visible(probe.visible(light as usize, &ray))
            }
            (ProbeOfQuery::Wide(probe), Call::EnterWide(node, t_max)) => {
                Response::Entered(probe.enter(node, t_max))
            }
            (ProbeOfQuery::Wide(probe), Call::Candidates(block, n, t_max)) => {
                Response::Lanes(probe.candidates(block, n, t_max))
            }
            (ProbeOfQuery::Wide(probe), Call::HitLane(block, lane, ray)) => {
                Response::Found(probe.hit(block, lane, &ray))
            }
            _ => other_kind(),
        }
    }
}

/// Answers a call of a probe of a hierarchy.
fn of_nodes(probe: &mut impl Probe, call: Call) -> Response {
    match call {
        Call::Open(node) => Response::Contents(probe.open(node)),
        Call::Enter(node, ray) => Response::T(probe.enter(node, &ray)),
        Call::Hit(primitive, ray) => Response::T(probe.hit(primitive, &ray)),
        _ => other_kind(),
    }
}

fn other_kind() -> Response {
    Response::Refused("the call does not fit the request".into())
}
