//! The judge's side of a withheld request: it keeps the tables, answers the questions of the searches, and counts them.

use raykata::bvh::Probe;
use raykata::kit::questions::{Call, Question, Response};
use raykata::kit::{
    Answer, CachedQuery, CellsAnswer, CellsProbe, CellsQuery, Costs, KitError, PacketProbe, Request,
    SearchQuery, ShadowProbe, TableProbe, WideQuery, WideTableProbe, kit_error,
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

/// Returns the request without its tables; `None` if it has none.
pub fn withheld(request: &Request) -> Option<Request> {
    fn search(queries: &mut [SearchQuery]) {
        queries.iter_mut().for_each(|query| query.table = query.table.withheld());
    }
    fn cells<S>(queries: &mut [CellsQuery<S>]) {
        queries.iter_mut().for_each(|query| query.hits.fill(f32::NAN));
    }
    fn wide(queries: &mut [WideQuery]) {
        for query in queries {
            query.entries.fill([f32::NAN; 8]);
            query.hits.fill(f32::NAN);
        }
    }
    // A job for a picture has no tables, and its scene may be large.
    if request.frame().is_some() {
        return None;
    }
    let mut request = request.clone();
    match &mut request {
        Request::BruteForce(queries)
        | Request::ClosestHitBoth(queries)
        | Request::ClosestHit(queries)
        | Request::AnyHit(queries) => search(queries),
        Request::GraphHit(queries) => {
            queries.iter_mut().for_each(|query| query.table = query.table.withheld());
        }
        Request::CachedGraphHit(queries) => {
            queries.iter_mut().for_each(|query| query.search.table = query.search.table.withheld());
        }
        Request::GridSearch(queries) => cells(queries),
        Request::OctreeByCells(queries)
        | Request::OctreeByNeighbours(queries)
        | Request::OctreeSearch(queries) => cells(queries),
        Request::KdSearch(queries) => cells(queries),
        Request::BspSearch(queries) => cells(queries),
        Request::PolygonBspSearch(queries) => cells(queries),
        Request::CachedSearch(queries) => {
            for query in queries {
                query.hits.fill(f32::NAN);
                query.entries.fill(f32::NAN);
            }
        }
        Request::PacketSearch(queries) => {
            for table in queries.iter_mut().flat_map(|query| &mut query.tables) {
                *table = table.withheld();
            }
        }
        Request::Shade(queries) => queries.iter_mut().for_each(|query| query.visible.fill(false)),
        Request::WideClosestHit(queries) | Request::WideAnyHit(queries) => wide(queries),
        _ => return None,
    }
    Some(Request::Withheld(Box::new(request)))
}

impl<'a> Withheld<'a> {
    /// Keeps the tables of `request`, whose worker gets [`withheld`] tables.
    pub(super) fn of(request: &'a Request) -> Withheld<'a> {
        fn cells<S>(queries: &[CellsQuery<S>]) -> Vec<ProbeOfQuery<'_>> {
            queries.iter().map(|query| ProbeOfQuery::Cells(CellsProbe::new(&query.hits))).collect()
        }
        let probes: Vec<ProbeOfQuery<'a>> = match request {
            Request::BruteForce(queries)
            | Request::ClosestHitBoth(queries)
            | Request::ClosestHit(queries)
            | Request::AnyHit(queries) => {
                queries.iter().map(|query| ProbeOfQuery::Table(TableProbe::new(query))).collect()
            }
            Request::GraphHit(queries) => {
                let probe = |table| ProbeOfQuery::Table(TableProbe::without_hierarchy(table));
                queries.iter().map(|query| probe(&query.table)).collect()
            }
            Request::CachedGraphHit(queries) => {
                let probe = |table| ProbeOfQuery::Table(TableProbe::without_hierarchy(table));
                queries.iter().map(|query| probe(&query.search.table)).collect()
            }
            Request::GridSearch(queries) => cells(queries),
            Request::OctreeByCells(queries)
            | Request::OctreeByNeighbours(queries)
            | Request::OctreeSearch(queries) => cells(queries),
            Request::KdSearch(queries) => cells(queries),
            Request::BspSearch(queries) => cells(queries),
            Request::PolygonBspSearch(queries) => cells(queries),
            Request::CachedSearch(queries) => queries
                .iter()
                .map(|query| ProbeOfQuery::Cached(CellsProbe::new(&query.hits), query))
                .collect(),
            Request::PacketSearch(queries) => {
                queries.iter().map(|query| ProbeOfQuery::Packet(PacketProbe::new(query))).collect()
            }
            Request::Shade(queries) => {
                queries.iter().map(|query| ProbeOfQuery::Shadows(ShadowProbe::new(query))).collect()
            }
            Request::WideClosestHit(queries) | Request::WideAnyHit(queries) => {
                queries.iter().map(|query| ProbeOfQuery::Wide(WideTableProbe::new(query))).collect()
            }
            _ => Vec::new(),
        };
        Withheld(probes.into_iter().map(|probe| QueryCalls { n_calls: 0, probe }).collect())
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
