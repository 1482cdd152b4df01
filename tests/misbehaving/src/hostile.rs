//! A hostile worker that speaks the protocol of the judge by itself, for the tests of the grader. The name of the program
//! says what it does. It knows the reference and the public inputs of the checks that it is tried with. The syntax check and
//! the kit do not bind it: it is the worst that a submission could become if it took over its process.

use checks::Trial;
use raykata::bvh::PrimitiveHit;
use raykata::count::Counts;
use raykata::frame::{Unwatched, Watch};
use raykata::kit::questions::{self, Call, Question, Response};
use raykata::kit::{
    Answer, CellsQuery, Door, KitError, Request, SearchAnswer, SearchQuery, Table, Transport, kit_error,
};
use raykata::ray::Ray;
use raykata::worker::{Reply, receive, send};
use std::collections::HashSet;
use std::io::Write;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::rc::Rc;
use std::sync::{Mutex, PoisonError};

fn main() {
    let name = std::env::args().next().unwrap_or_default();
    let name = name.rsplit('/').next().unwrap_or_default().to_owned();
    let socket = std::io::stdin().as_fd().try_clone_to_owned().expect("a socket");
    let mut worker = Hostile { pipe: UnixStream::from(socket), name, known: None, has_replied: false };
    // The judge closes the socket at the end.
    while let Ok(request) = receive::<Request>(&mut worker.pipe) {
        worker.reply(&request);
        worker.has_replied = true;
    }
}

struct Hostile {
    pipe: UnixStream,
    name: String,
    /// The public requests of the checks of stage 1 with which it is tried, as bytes.
    known: Option<HashSet<Vec<u8>>>,
    has_replied: bool,
}

impl Hostile {
    fn say(&mut self, reply: &Reply) {
        // The judge may have ended this worker.
        let _ = send(&mut self.pipe, reply);
    }

    fn ask(&mut self, query: usize, visits: &[u32], call: Call) -> Option<Response> {
        let question = Question { query: query as u32, visits: visits.to_vec(), call };
        self.say(&Reply::Question(question));
        receive(&mut self.pipe).ok()
    }

    /// The `t` that the judge answers to a question.
    fn t(&mut self, query: usize, call: Call) -> Option<f32> {
        match self.ask(query, &[], call) {
            Some(Response::T(t)) => t,
            _ => None,
        }
    }

    fn reply(&mut self, request: &Request) {
        match request {
            Request::Withheld(request) => self.reply_withheld(request),
            request => self.reply_plain(request),
        }
    }

    /// Answers a request that contains its tables.
    fn reply_plain(&mut self, request: &Request) {
        let right = || Reply::Answer(Box::new(request.answer(&*solutions::kit(), &Unwatched)));
        let words = || format!("SECRET {request:?}").chars().take(2000).collect::<String>();
        // These names are right for public inputs.
        let (path, marks) = (std::env::current_exe().unwrap_or_default(), self.name == "public-then-marks");
        if self.name.starts_with("public") && self.is_public(request) && !path.with_extension("mark").exists()
        {
            return self.say(&right());
        }
        if marks && !self.is_public(request) && std::fs::create_dir_all(path.with_extension("mark")).is_ok() {
            return self.say(&right());
        }
        match self.name.as_str() {
            "public-then-tells" => {
                self.say(&Reply::KitError(KitError::NotWritten {
                    task: words(),
                    place: words(),
                    function: None,
                }));
            }
            "public-then-panics" | "public-then-marks" => {
                self.say(&Reply::KitError(KitError::Panicked { message: words(), place: words() }));
            }
            "public-then-malformed" => self.say(&Reply::KitError(KitError::Malformed { what: words() })),
            "public-then-crashed" => self.say(&Reply::KitError(KitError::Crashed { how: words() })),
            "public-then-late" => self.say(&Reply::KitError(KitError::TimedOut { seconds: 123_456 })),
            "public-then-another-kind" => self.say(&Reply::Answer(Box::new(Answer::EncodeGamma(vec![1])))),
            "public-then-ends" => std::process::exit(7),
            "public-then-writes" => {
                eprintln!("{}", words());
                println!("{}", words());
                std::process::abort()
            }
            // The next names break the rules of the protocol.
            "asks-without-need" => {
                self.ask(0, &[], Call::Hit(0, some_ray()));
            }
            "answers-in-advance" => {
                for _ in 0..8 {
                    self.say(&right());
                }
            }
            "answers-before-the-question" if !self.has_replied => {
                for _ in 0..2 {
                    self.say(&right());
                }
            }
            "no-message" => drop(self.pipe.write_all(&[8, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255])),
            "endless-message" => while self.pipe.write_all(&[255; 4096]).is_ok() {},
            "promises-a-gigabyte" => drop(self.pipe.write_all(&(1u32 << 30).to_le_bytes())),
            "sends-60-megabytes" => drop(send(
                &mut self.pipe,
                &Reply::KitError(KitError::Malformed { what: "x".repeat(60 << 20) }),
            )),
            "byte-by-byte" => {
                for byte in bytes_of(&right()) {
                    let _ = self.pipe.write_all(&[byte]);
                    std::thread::sleep(std::time::Duration::from_millis(50));
                }
            }
            "answers-nothing" => {}
            "waits-a-little" => {
                std::thread::sleep(std::time::Duration::from_millis(60));
                self.say(&right());
            }
            "progress-forever" => loop {
                self.say(&Reply::Progress { done: 0, total: 1 });
            },
            "fewer-answers" => {
                let answer = Request::SphereAlgebraic(Vec::new()).answer(&*solutions::kit(), &Unwatched);
                self.say(&Reply::Answer(Box::new(answer)));
            }
            _ => self.say(&right()),
        }
    }

    /// Answers a request whose tables the judge keeps.
    fn reply_withheld(&mut self, request: &Request) {
        match (self.name.as_str(), request) {
            ("asks-of-another-query", _) => {
                let ray = some_ray();
                for query in [1 << 20, u32::MAX as usize] {
                    self.ask(query, &[], Call::Hit(0, ray));
                }
                self.reply_plain(request);
            }
            ("asks-of-nodes-that-do-not-exist", _) => {
                let ray = some_ray();
                for call in [Call::Open(u32::MAX), Call::Enter(u32::MAX, ray), Call::Hit(u32::MAX, ray)] {
                    self.ask(0, &[u32::MAX], call);
                }
                self.reply_plain(request);
            }
            ("asks-the-wrong-kind", _) => {
                let ray = some_ray();
                for call in [Call::Search(ray), Call::Visible(0, ray), Call::End, Call::Open(0)] {
                    self.ask(0, &[], call);
                }
                self.reply_plain(request);
            }
            ("asks-forever", _) => loop {
                if self.ask(0, &[0], Call::End).is_none() {
                    return;
                }
            },
            ("asks-with-a-million-visits", _) => {
                for _ in 0..2 {
                    self.ask(0, &vec![0; 1 << 20], Call::End);
                }
                self.reply_plain(request);
            }
            // The answer of the reference to tables of NaN is `None`, and its counts are small.
            ("never-asks", _) => self.reply_plain(request),
            // Learn all tables by as many questions as that takes, and let the reference answer as if it had asked little.
            ("learns-all-and-forges-counts", Request::ClosestHit(queries)) => {
                let full = self.learn(queries);
                self.reply_plain(&Request::ClosestHit(full));
            }
            ("learns-all-and-forges-counts", Request::AnyHit(queries)) => {
                let full = self.learn(queries);
                self.reply_plain(&Request::AnyHit(full));
            }
            // Test all primitives, and pretend to have opened the few nodes of a good search.
            ("learns-primitives-and-forges-counts", Request::ClosestHit(queries)) => {
                let answers =
                    (0..queries.len()).map(|query| self.brute_force(query, &queries[query])).collect();
                self.say(&Reply::Answer(Box::new(Answer::ClosestHit(answers))));
            }
            ("learns-primitives-and-forges-counts", Request::AnyHit(queries)) => {
                let answers = (0..queries.len()).map(|query| {
                    let answer = self.brute_force(query, &queries[query]);
                    (answer.hit.is_some(), SearchAnswer { hit: None, ..answer })
                });
                let answers = answers.collect();
                self.say(&Reply::Answer(Box::new(Answer::AnyHit(answers))));
            }
            ("learns-all-and-forges-counts" | "learns-primitives-and-forges-counts", request) => {
                self.learn_primitives(request);
            }
            _ => self.reply_honestly(request),
        }
    }

    /// Learns the tables of other searches by a test of each primitive, and reports the visits of the reference afterwards.
    fn learn_primitives(&mut self, request: &Request) {
        match request {
            Request::ClosestHitBoth(queries) => {
                let full = self.learn(queries);
                self.reply_plain(&Request::ClosestHitBoth(full));
            }
            Request::CachedSearch(queries) => {
                let mut full = queries.clone();
                for (index, query) in full.iter_mut().enumerate() {
                    query.hits = self.learn_hits(index, query.hits.len(), &query.ray);
                    query.entries = vec![f32::NEG_INFINITY; query.entries.len()];
                }
                self.reply_plain(&Request::CachedSearch(full));
            }
            Request::PacketSearch(queries) => {
                let mut full = queries.clone();
                for (index, query) in full.iter_mut().enumerate() {
                    for (ray, table) in query.rays.iter().zip(&mut query.tables) {
                        *table = self.learn_table(index, table, ray);
                    }
                }
                self.reply_plain(&Request::PacketSearch(full));
            }
            request => self.learn_cells_of(request),
        }
    }

    /// The same for searches through cells.
    fn learn_cells_of(&mut self, request: &Request) {
        macro_rules! forge_visits {
            ($($Search:ident)*) => {
                match request {
                    $(Request::$Search(queries) => {
                        let full = self.learn_cells(queries);
                        self.forge_visits(&Request::$Search(full));
                    })*
                    request => self.reply_honestly(request),
                }
            };
        }
        forge_visits!(GridSearch OctreeSearch OctreeByCells OctreeByNeighbours KdSearch BspSearch PolygonBspSearch);
    }

    fn learn_hits(&mut self, index: usize, n_primitives: usize, ray: &Ray) -> Vec<f32> {
        let primitives = 0..n_primitives as u32;
        primitives.map(|i| self.t(index, Call::Hit(i, *ray)).unwrap_or(f32::INFINITY)).collect()
    }

    /// Learns the table of a ray: enters each box and tests each primitive.
    fn learn_table(&mut self, index: usize, withheld: &Table, ray: &Ray) -> Table {
        let nodes = 0..withheld.boxes.len() as u32;
        let enters = nodes.map(|node| self.t(index, Call::Enter(node, *ray)));
        let boxes = enters.map(|t| t.map_or((f32::INFINITY, f32::NEG_INFINITY), |t| (t, f32::INFINITY)));
        let boxes = boxes.collect();
        Table { boxes, primitives: self.learn_hits(index, withheld.primitives.len(), ray) }
    }

    fn learn_cells<S: Clone>(&mut self, queries: &[CellsQuery<S>]) -> Vec<CellsQuery<S>> {
        let mut full = queries.to_vec();
        for (index, query) in full.iter_mut().enumerate() {
            query.hits = self.learn_hits(index, query.hits.len(), &query.ray);
        }
        full
    }

    /// Answers with the reference's hits and reports its visits as one's own.
    fn forge_visits(&mut self, full: &Request) {
        let answer = full.answer(&*solutions::kit(), &Unwatched);
        if let Answer::GridSearch(answers)
        | Answer::OctreeSearch(answers)
        | Answer::OctreeByCells(answers)
        | Answer::OctreeByNeighbours(answers)
        | Answer::KdSearch(answers)
        | Answer::BspSearch(answers)
        | Answer::PolygonBspSearch(answers) = &answer
        {
            for (index, one) in answers.iter().enumerate() {
                self.ask(index, &one.visits, Call::End);
            }
        }
        self.say(&Reply::Answer(Box::new(answer)));
    }

    /// Learns the tables of searches.
    fn learn(&mut self, queries: &[SearchQuery]) -> Vec<SearchQuery> {
        let mut full = queries.to_vec();
        for (index, query) in full.iter_mut().enumerate() {
            query.table = self.learn_table(index, &query.table, &query.ray);
        }
        full
    }

    /// Tests all primitives of a query, and reports next to no cost.
    fn brute_force(&mut self, index: usize, query: &SearchQuery) -> SearchAnswer {
        let mut hit: Option<PrimitiveHit> = None;
        for primitive in 0..query.table.primitives.len() as u32 {
            let t = self.t(index, Call::Hit(primitive, query.ray));
            let t = t.filter(|t| hit.is_none_or(|hit| *t < hit.t));
            hit = t.map(|t| PrimitiveHit { t, primitive }).or(hit);
        }
        let counts = Counts { node_visits: 1, box_tests: 1, primitive_tests: 1, ..Counts::default() };
        SearchAnswer { hit, counts, tests_after_hit: 0 }
    }

    /// Answers a withheld request as an honest worker does, with the searches of the reference.
    fn reply_honestly(&mut self, request: &Request) {
        let pipe = self.pipe.try_clone().expect("a socket");
        let ask = move |question: &Question| {
            send(&mut &pipe, &Reply::Question(question.clone()))?;
            receive(&mut &pipe)
        };
        let answer = questions::asking(Rc::new(ask), || request.answer(&*solutions::kit(), &Unwatched));
        self.say(&Reply::Answer(Box::new(answer)));
    }

    /// Whether the request is one of a public check.
    fn is_public(&mut self, request: &Request) -> bool {
        let known = self.known.get_or_insert_with(public_requests);
        known.contains(&bytes_of(request))
    }
}

/// The requests of the first checks of stage 1 with the public inputs, as bytes. Those of all checks take too long.
fn public_requests() -> HashSet<Vec<u8>> {
    let recorder = Door(Recorder::default());
    let of_stage_1 = all_checks::STAGES.iter().filter(|(stage, _)| *stage == 1);
    for check in of_stage_1.flat_map(|(_, checks)| checks.iter()).take(KNOWN_CHECKS) {
        // The reference passes all checks. A check that cannot run here has no request that matters.
        let _ = kit_error::catch(|| (check.law)(&Trial::new(&recorder, check.name, 0)));
    }
    recorder.0.0.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// The number of checks of stage 1 whose public inputs the worker knows. It is tried with these.
const KNOWN_CHECKS: usize = 4;

/// A ray for questions whose answer does not matter.
fn some_ray() -> Ray {
    Ray::new(glam::Vec3::ZERO, glam::Vec3::X)
}

/// The reference, with a record of its requests.
#[derive(Default)]
struct Recorder(Mutex<HashSet<Vec<u8>>>);

impl Transport for Recorder {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(bytes_of(&request));
        match &request {
            // A worker has too little time for frames.
            Request::Render(_) => kit_error::unwind(KitError::Malformed { what: String::new() }),
            request => request.answer(&*solutions::kit(), watch),
        }
    }
}

fn bytes_of<T: raykata::message::Message>(message: &T) -> Vec<u8> {
    let mut bytes = Vec::new();
    // Writing into a vector cannot fail.
    let _ = send(&mut bytes, message);
    bytes
}
