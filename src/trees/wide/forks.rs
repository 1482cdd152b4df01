//! Work in parallel, with a log from which work and span follow.

use super::PrimitiveBox;
use crate::aabb::Aabb;
use crate::message;
use rayon::prelude::*;

/// A place in a parallel build where two pieces of work may run at the same time.
///
/// The primitives of the forked node identify it: no two nodes of a tree with two children each have the same range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fork {
    /// The position of the node's first primitive in the order of the finished tree.
    pub first: u32,
    /// The number of the node's primitives.
    pub count: u32,
    /// What is done in parallel.
    pub kind: ForkKind,
}

message! { Fork { first, count, kind } }

/// What is done in parallel at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForkKind {
    /// The trees below its two children are built in parallel.
    Children,
    /// Its primitives are sorted into bins in this number of equal pieces, in parallel.
    Binning {
        /// The number of pieces, at least 2.
        pieces: u32,
    },
}

message! { enum ForkKind { Children, Binning { pieces } } }

/// Runs pieces of work in parallel, and keeps a log of them.
///
/// The log is the same for every number of threads, because it is in the order of the tree and not of time.
#[derive(Debug)]
pub struct Forks {
    in_parallel: bool,
    log: Vec<Fork>,
}

impl Forks {
    /// An empty log. If `in_parallel` is false, forks are logged, and this thread does all the work.
    pub fn new(in_parallel: bool) -> Forks {
        Forks { in_parallel, log: Vec::new() }
    }

    /// The primitives with these boxes, as the binned builder sees them: primitive `i` has the box `bounds[i]`. They are made in
    /// parallel if threads are free, which is not logged.
    ///
    /// # Panics
    ///
    /// If there are more than a billion boxes.
    pub fn boxes(&self, bounds: &[Aabb]) -> Vec<PrimitiveBox> {
        let numbered = |(id, bounds): (usize, &Aabb)| PrimitiveBox::new(id as u32, bounds);
        if self.in_parallel {
            bounds.par_iter().enumerate().map(numbered).collect()
        } else {
            bounds.iter().enumerate().map(numbered).collect()
        }
    }

    /// The log so far.
    pub fn into_log(self) -> Vec<Fork> {
        self.log
    }

    /// Sorts the primitives of a node into bins in pieces: logs the node, from position `first` of the order of the finished tree on,
    /// with [`ForkKind::Binning`], and runs `work` for all `pieces` at the same time if threads are free. The results are in the
    /// order of the pieces.
    pub fn each<P: Send, A: Send>(
        &mut self,
        first: u32,
        count: u32,
        pieces: Vec<P>,
        work: impl Fn(P) -> A + Sync + Send,
    ) -> Vec<A> {
        self.log.push(Fork { first, count, kind: ForkKind::Binning { pieces: pieces.len() as u32 } });
        if self.in_parallel {
            pieces.into_par_iter().map(work).collect()
        } else {
            pieces.into_iter().map(work).collect()
        }
    }

    /// Logs `fork`, and runs `left` and `right` at the same time if a thread is free. Each gets a log of its own, which is
    /// then appended to this one, that of `left` first.
    pub fn join<A: Send, B: Send>(
        &mut self,
        fork: Fork,
        left: impl FnOnce(&mut Forks) -> A + Send,
        right: impl FnOnce(&mut Forks) -> B + Send,
    ) -> (A, B) {
        self.log.push(fork);
        if !self.in_parallel {
            return (left(self), right(self));
        }
        let [mut log_left, mut log_right] = [true, true].map(Forks::new);
        let results = rayon::join(|| left(&mut log_left), || right(&mut log_right));
        self.log.append(&mut log_left.log);
        self.log.append(&mut log_right.log);
        results
    }
}
