//! Things that a scene calls by name.

use super::reader::Value;
use crate::scene::error::LoadError;
use std::collections::BTreeMap;

/// The names of all things of one kind, each with an index.
pub(super) struct Names<'a> {
    what: &'static str,
    indices: BTreeMap<&'a str, usize>,
}

impl<'a> Names<'a> {
    /// No names yet; `what` is what messages call such a thing.
    pub fn new(what: &'static str) -> Self {
        Names { what, indices: BTreeMap::new() }
    }

    /// Gives `name` to the thing with this index. Says whether the name was still free.
    pub fn insert(&mut self, name: &'a str, index: usize) -> bool {
        self.indices.insert(name, index).is_none()
    }

    /// The index behind `name`, if anything has it.
    pub fn get(&self, name: &str) -> Option<usize> {
        self.indices.get(name).copied()
    }

    /// The index of the thing that `value` names.
    pub fn find(&self, value: Value) -> Result<usize, LoadError> {
        let name = value.text()?;
        self.get(name).ok_or_else(|| {
            let known: Vec<&str> = self.indices.keys().copied().collect();
            value.source.unknown(value.span(), self.what, name, &known)
        })
    }
}
