//! The judge's side of a withheld request: it keeps the tables, answers the questions of the searches, and counts them.

use raykata::bvh::Probe;
use raykata::kit::questions::{Call, Question, Response};
use raykata::kit::{
    Answer, CachedQuery, CellsAnswer, CellsProbe, CellsQuery, Costs, KitError, PacketProbe, PacketQuery,
    Request, SearchQuery, ShadeQuery, ShadowProbe, TableProbe, WideQuery, WideTableProbe, kit_error,
};
use raykata::partition::Cells;
use raykata::wide::WideProbe;

/// The most calls of a query. A search that makes more does not end, and its calls would fill the memory of the judge.
const MOST_CALLS: u32 = 1 << 20;

/// The tables of a request, and the calls that the worker has made so far.
pub(super) struct Withheld<'a>(Vec<Asked<'a>>);

/// The calls of one query.
struct Asked<'a> {
    n_calls: u32,
    probe: Kept<'a>,
}

/// A probe with its table.
enum Kept<'a> {
    Table(TableProbe<'a>),
    Cells(CellsProbe<'a>),
    Cached(CellsProbe<'a>, &'a CachedQuery),
    Packet(PacketProbe<'a>),
    Shadows(ShadowProbe<'a>),
    Wide(WideTableProbe<'a>),
}

/// Returns the request without its tables; `None` if it has none.
pub fn withheld(request: &Request) -> Option<Request> {
    let blank = |values: &[f32]| vec![f32::NAN; values.len()];
    let search = |queries: &[SearchQuery]| -> Vec<SearchQuery> {
        queries.iter().map(|query| SearchQuery { table: query.table.withheld(), ..query.clone() }).collect()
    };
    fn cells<S: Clone>(queries: &[CellsQuery<S>]) -> Vec<CellsQuery<S>> {
        let blank = |query: &CellsQuery<S>| CellsQuery {
            cells: query.cells.clone(),
            ray: query.ray,
            hits: vec![f32::NAN; query.hits.len()],
        };
        queries.iter().map(blank).collect()
    }
    let wide = |queries: &[WideQuery]| -> Vec<WideQuery> {
        let blank = |query: &WideQuery| WideQuery {
            tree: query.tree.clone(),
            ray: query.ray,
            entries: vec![[f32::NAN; 8]; query.entries.len()],
            hits: blank(&query.hits),
        };
        queries.iter().map(blank).collect()
    };
    let without_tables = match request {
        Request::BruteForce(queries) => Request::BruteForce(search(queries)),
        Request::ClosestHitBoth(queries) => Request::ClosestHitBoth(search(queries)),
        Request::ClosestHit(queries) => Request::ClosestHit(search(queries)),
        Request::AnyHit(queries) => Request::AnyHit(search(queries)),
        Request::GraphHit(queries) => {
            let mut queries = queries.clone();
            queries.iter_mut().for_each(|query| query.table = query.table.withheld());
            Request::GraphHit(queries)
        }
        Request::CachedGraphHit(queries) => {
            let mut queries = queries.clone();
            queries.iter_mut().for_each(|query| query.search.table = query.search.table.withheld());
            Request::CachedGraphHit(queries)
        }
        Request::GridSearch(queries) => Request::GridSearch(cells(queries)),
        Request::OctreeByCells(queries) => Request::OctreeByCells(cells(queries)),
        Request::OctreeByNeighbours(queries) => Request::OctreeByNeighbours(cells(queries)),
        Request::OctreeSearch(queries) => Request::OctreeSearch(cells(queries)),
        Request::KdSearch(queries) => Request::KdSearch(cells(queries)),
        Request::BspSearch(queries) => Request::BspSearch(cells(queries)),
        Request::PolygonBspSearch(queries) => Request::PolygonBspSearch(cells(queries)),
        Request::CachedSearch(queries) => {
            let blank = |query: &CachedQuery| CachedQuery {
                hits: blank(&query.hits),
                entries: blank(&query.entries),
                ..query.clone()
            };
            Request::CachedSearch(queries.iter().map(blank).collect())
        }
        Request::PacketSearch(queries) => {
            let blank = |query: &PacketQuery| PacketQuery {
                tables: query.tables.iter().map(|table| table.withheld()).collect(),
                ..query.clone()
            };
            Request::PacketSearch(queries.iter().map(blank).collect())
        }
        Request::Shade(queries) => {
            let blank = |query: &ShadeQuery| ShadeQuery {
                visible: vec![false; query.visible.len()],
                ..query.clone()
            };
            Request::Shade(queries.iter().map(blank).collect())
        }
        Request::WideClosestHit(queries) => Request::WideClosestHit(wide(queries)),
        Request::WideAnyHit(queries) => Request::WideAnyHit(wide(queries)),
        _ => return None,
    };
    Some(Request::Withheld(Box::new(without_tables)))
}

impl<'a> Withheld<'a> {
    /// Keeps the tables of `request`, whose worker gets [`withheld`] tables.
    pub(super) fn of(request: &'a Request) -> Withheld<'a> {
        fn cells<S>(queries: &[CellsQuery<S>]) -> Vec<Kept<'_>> {
            queries.iter().map(|query| Kept::Cells(CellsProbe::new(&query.hits))).collect()
        }
        let probes: Vec<Kept<'a>> = match request {
            Request::BruteForce(queries)
            | Request::ClosestHitBoth(queries)
            | Request::ClosestHit(queries)
            | Request::AnyHit(queries) => {
                queries.iter().map(|query| Kept::Table(TableProbe::new(query))).collect()
            }
            Request::GraphHit(queries) => {
                let probe = |table| Kept::Table(TableProbe::without_hierarchy(table));
                queries.iter().map(|query| probe(&query.table)).collect()
            }
            Request::CachedGraphHit(queries) => {
                let probe = |table| Kept::Table(TableProbe::without_hierarchy(table));
                queries.iter().map(|query| probe(&query.search.table)).collect()
            }
            Request::GridSearch(queries) => cells(queries),
            Request::OctreeByCells(queries)
            | Request::OctreeByNeighbours(queries)
            | Request::OctreeSearch(queries) => cells(queries),
            Request::KdSearch(queries) => cells(queries),
            Request::BspSearch(queries) => cells(queries),
            Request::PolygonBspSearch(queries) => cells(queries),
            Request::CachedSearch(queries) => {
                queries.iter().map(|query| Kept::Cached(CellsProbe::new(&query.hits), query)).collect()
            }
            Request::PacketSearch(queries) => {
                queries.iter().map(|query| Kept::Packet(PacketProbe::new(query))).collect()
            }
            Request::Shade(queries) => {
                queries.iter().map(|query| Kept::Shadows(ShadowProbe::new(query))).collect()
            }
            Request::WideClosestHit(queries) | Request::WideAnyHit(queries) => {
                queries.iter().map(|query| Kept::Wide(WideTableProbe::new(query))).collect()
            }
            _ => Vec::new(),
        };
        Withheld(probes.into_iter().map(|probe| Asked { n_calls: 0, probe }).collect())
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
                (Costs::Search(answer), Kept::Table(probe)) => *answer = probe.answer(answer.hit),
                (Costs::Graph(answer), Kept::Table(probe)) => {
                    answer.search = probe.answer(answer.search.hit);
                    answer.asked = probe.asked;
                }
                (Costs::Cells(answer), Kept::Cells(probe) | Kept::Cached(probe, _)) => {
                    *answer = CellsAnswer { hit: answer.hit, ..probe.answer };
                }
                (Costs::Packet(answer), Kept::Packet(probe)) => {
                    answer.opened = probe.answer.opened;
                    answer.counts = probe.answer.counts;
                }
                (Costs::Wide(answer), Kept::Wide(probe)) => *answer = probe.answer(answer.hit, answer.found),
                (Costs::Shade(answer), Kept::Shadows(probe)) => *answer = probe.finish(answer.color),
                // An answer of another kind than its request is refused elsewhere.
                _ => {}
            }
        }
    }
}

impl Kept<'_> {
    fn answer(&mut self, question: &Question) -> Response {
        if let Kept::Cells(probe) | Kept::Cached(probe, _) = self {
            question.visits.iter().for_each(|node| probe.visit(*node));
        }
        match (self, question.call) {
            (Kept::Table(probe), call) => of_nodes(probe, call),
            (Kept::Packet(probe), call) => of_nodes(probe, call),
            (Kept::Cells(probe) | Kept::Cached(probe, _), Call::Hit(primitive, ray)) => {
                Response::T(probe.hit(primitive, &ray))
            }
            (Kept::Cells(_) | Kept::Cached(..), Call::End) => Response::Recorded,
            (Kept::Cached(probe, query), Call::Search(ray)) => Response::Found(query.search(probe, &ray)),
            (Kept::Shadows(probe), Call::Visible(light, ray)) => {
                Response::Visible(probe.visible(light as usize, &ray))
            }
            (Kept::Wide(probe), Call::EnterWide(node, t_max)) => Response::Entered(probe.enter(node, t_max)),
            (Kept::Wide(probe), Call::Candidates(block, n, t_max)) => {
                Response::Lanes(probe.candidates(block, n, t_max))
            }
            (Kept::Wide(probe), Call::HitLane(block, lane, ray)) => {
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
