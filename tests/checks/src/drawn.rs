//! A cache of random inputs, for a judge that runs the same checks on many kits.

use std::any::Any;
use std::collections::HashMap;
use std::panic::Location;
use std::sync::{Arc, Mutex, PoisonError};

/// The key of the inputs: the check, the seed, the caller and the number of the draw. No draw depends on an answer.
pub(crate) type Key = (&'static str, u64, &'static Location<'static>, u32);

/// A `Vec` of inputs, for code that does not know their type.
pub(crate) type Values = Arc<dyn Any + Send + Sync>;

/// The inputs of each draw. They are kept, because drawing them takes as long as judging the answers.
#[derive(Default)]
pub struct Drawn(Mutex<HashMap<Key, Values>>);

impl Drawn {
    /// The inputs of `key`. `draw` draws them if they are not in the cache yet.
    pub(crate) fn get(&self, key: Key, draw: &dyn Fn() -> Values) -> Values {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&key).cloned() {
            return known;
        }
        let drawn = draw();
        lock().insert(key, drawn.clone());
        drawn
    }
}
