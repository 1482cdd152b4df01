//! Inputs that were drawn before, for a judge who puts the same checks to many kits.

use std::any::Any;
use std::collections::HashMap;
use std::panic::Location;
use std::sync::{Arc, Mutex, PoisonError};

/// Which inputs: the check, the seed, and which of its draws. No draw depends on an answer.
pub(crate) type Key = (&'static str, u64, &'static Location<'static>, u32);

/// The inputs of each draw, kept. Drawing them takes as long as judging the answers.
#[derive(Default)]
pub struct Drawn(Mutex<HashMap<Key, Arc<dyn Any + Send + Sync>>>);

impl Drawn {
    /// Those of `key`, which `draw` draws if nobody has yet.
    pub(crate) fn get<T: Send + Sync + 'static>(
        &self,
        key: Key,
        draw: impl FnOnce() -> Vec<T>,
    ) -> Arc<Vec<T>> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = lock().get(&key).cloned();
        if let Some(Ok(known)) = known.map(Arc::downcast) {
            return known;
        }
        let drawn = Arc::new(draw());
        lock().insert(key, drawn.clone());
        drawn
    }
}
