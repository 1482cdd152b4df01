//! Which student functions a frame may call.

use crate::kit::{Function, StudentFunctions, View, is_written};
use std::marker::PhantomData;

/// The student functions that are written, except those that a frame has found unfinished.
pub struct Written<F> {
    left_out: Vec<Function>,
    functions: PhantomData<F>,
}

impl<F: StudentFunctions> Written<F> {
    /// All functions that do more than `todo!` for the simplest input, of the stages that `view` allows.
    pub fn of(view: View) -> Self {
        let last = if let View::UpToStage(stage) = view { stage } else { u8::MAX };
        let later = Function::ALL.iter().copied().filter(|function| function.stage() > last);
        Written { left_out: later.collect(), functions: PhantomData }
    }

    /// Whether a frame may call `function`: it is written and has not been left out.
    pub fn has(&self, function: Function) -> bool {
        !self.left_out.contains(&function) && is_written::<F>(function)
    }

    /// Whether a frame may call each of `functions`; true for an empty list.
    pub fn has_all(&self, functions: &[Function]) -> bool {
        functions.iter().all(|&function| self.has(function))
    }

    /// The functions that have been excluded.
    pub fn left_out(&self) -> &[Function] {
        &self.left_out
    }

    /// Excludes `function` from now on; returns `false` if it was excluded before.
    pub fn leave_out(&mut self, function: Function) -> bool {
        let new = !self.left_out.contains(&function);
        self.left_out.push(function);
        new
    }
}
