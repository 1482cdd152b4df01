//! Which student functions a frame may use.

use crate::kit::{Function, StudentFunctions, is_written};
use std::marker::PhantomData;

/// The functions that are written, less those that a frame has found unfinished on its way.
pub struct Written<F> {
    left_out: Vec<Function>,
    functions: PhantomData<F>,
}

impl<F: StudentFunctions> Written<F> {
    /// All that answer the simplest question.
    pub fn all() -> Self {
        Written { left_out: Vec::new(), functions: PhantomData }
    }

    /// Whether a frame may use `function`.
    pub fn has(&self, function: Function) -> bool {
        !self.left_out.contains(&function) && is_written::<F>(function)
    }

    /// Whether a frame may use all of them.
    pub fn has_all(&self, functions: &[Function]) -> bool {
        functions.iter().all(|&function| self.has(function))
    }

    /// Does without `function` from now on; `false` if that was so before.
    pub fn leave_out(&mut self, function: Function) -> bool {
        let new = !self.left_out.contains(&function);
        self.left_out.push(function);
        new
    }
}
