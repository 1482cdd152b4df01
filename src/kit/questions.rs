//! The calls of a search as messages. A judge that does not trust the counts of a worker keeps the tables of a
//! request: each probe in the worker then asks the judge, and the judge counts.

use crate::bvh::{Contents, PrimitiveHit};
use crate::message;
use crate::ray::Ray;
use crate::wide::Entered;
use std::cell::RefCell;
use std::io;
use std::rc::Rc;

/// A call that only the judge can answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The index of the query in its request.
    pub query: u32,
    /// The cells that were visited since the last question about this query, in order.
    pub visits: Vec<u32>,
    /// The call.
    pub call: Call,
}

message! { Question { query, visits, call } }

/// A call of a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Call {
    /// Asks for the contents of a node.
    Open(u32),
    /// Asks for the `t` at which a ray enters the box of a node.
    Enter(u32, Ray),
    /// Asks for the `t` at which a ray hits a primitive.
    Hit(u32, Ray),
    /// Asks for the closest hit of a whole search.
    Search(Ray),
    /// Asks whether the shadow ray to a light is not occluded.
    Visible(u32, Ray),
    /// Asks which children of a wide node a ray enters at this `t_max` or before.
    EnterWide(u32, f32),
    /// Asks which of the first `n` lanes of a block may be hit before this `t_max`: block, `n`, `t_max`.
    Candidates(u32, u32, f32),
    /// Asks for the hit with the primitive in a lane of a block: block, lane, ray.
    HitLane(u32, u32, Ray),
    /// Asks nothing: reports the last visits.
    End,
}

message! { enum Call {
    Open(a), Enter(a, b), Hit(a, b), Search(a), Visible(a, b), EnterWide(a, b), Candidates(a, b, c),
    HitLane(a, b, c), End
} }

/// The answer to a [`Question`].
#[derive(Clone, Debug, PartialEq)]
pub enum Response {
    /// The contents of a node.
    Contents(Contents),
    /// The `t` of an entry or a hit; `None` if there is none.
    T(Option<f32>),
    /// The result of a whole search, or of the test of one lane.
    Found(Option<PrimitiveHit>),
    /// Whether a shadow ray is not occluded.
    Visible(bool),
    /// Which children of a wide node are entered.
    Entered(Entered),
    /// The lanes of a block that may be hit, as bits.
    Lanes(u32),
    /// The visits were recorded.
    Recorded,
    /// The call is not allowed. The text is the message of the panic that it causes.
    Refused(String),
}

message! { enum Response { Contents(a), T(a), Found(a), Visible(a), Entered(a), Lanes(a), Recorded, Refused(a) } }

/// Carries questions to the judge.
pub type Ask = Rc<dyn Fn(&Question) -> io::Result<Response>>;

thread_local! {
    /// How probes ask, and the index of the next query; `None` if they answer from their own tables.
    static ASK: RefCell<Option<(Ask, u32)>> = const { RefCell::new(None) };
}

/// Runs `work`, in which all new probes ask instead of reading their own tables.
pub fn asking<T>(ask: Ask, work: impl FnOnce() -> T) -> T {
    struct Reset;
    impl Drop for Reset {
        fn drop(&mut self) {
            ASK.set(None);
        }
    }
    ASK.set(Some((ask, 0)));
    let _reset = Reset;
    work()
}

/// Asks about one query.
pub(super) struct Asker {
    ask: Ask,
    query: u32,
    visits: Vec<u32>,
}

/// Defines methods that ask for a [`Response`] of one kind.
macro_rules! asks {
    ($($name:ident: $Kind:ident($Value:ty);)*) => {
        $(#[track_caller]
        pub(super) fn $name(&mut self, call: Call) -> $Value {
            match self.ask(call) {
                Response::$Kind(value) => value,
                other => panic!("the judge answers another question: {other:?}"),
            }
        })*
    };
}

impl Asker {
    /// The asker for the next query of the request; `None` if probes answer from their own tables.
    pub(super) fn for_next_query() -> Option<Asker> {
        ASK.with_borrow_mut(|ask| {
            let (ask, next) = ask.as_mut()?;
            let query = *next;
            *next += 1;
            Some(Asker { ask: ask.clone(), query, visits: Vec::new() })
        })
    }

    /// Keeps a visit for the next question.
    pub(super) fn note_visit(&mut self, node: u32) {
        self.visits.push(node);
    }

    asks! {
        contents: Contents(Contents);
        t: T(Option<f32>);
        found: Found(Option<PrimitiveHit>);
        visible: Visible(bool);
        entered: Entered(Entered);
        lanes: Lanes(u32);
    }

    /// Reports the visits after the last question.
    pub(super) fn end(&mut self) {
        if !self.visits.is_empty() {
            self.ask(Call::End);
        }
    }

    #[track_caller]
    fn ask(&mut self, call: Call) -> Response {
        let visits = std::mem::take(&mut self.visits);
        match (self.ask)(&Question { query: self.query, visits, call }) {
            Ok(Response::Refused(why)) => panic!("{why}"),
            Ok(response) => response,
            Err(error) => panic!("the judge does not answer: {error}"),
        }
    }
}
