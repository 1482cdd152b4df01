//! The names that a scene gives to its materials, textures, meshes and nodes.

use super::reader::Value;
use crate::files::error::LoadError;
use std::collections::BTreeMap;

/// The names of all things of one kind, each with an index into their list.
pub(super) struct Names<'a> {
    what: &'static str,
    indices: BTreeMap<&'a str, usize>,
}

impl<'a> Names<'a> {
    /// A table without names; `what` is the word for such a thing in messages, for example "material".
    pub fn new(what: &'static str) -> Self {
        Names { what, indices: BTreeMap::new() }
    }

    /// Adds `name` with this index and returns whether the name is new. An earlier index of the same name is
    /// replaced.
    pub fn insert(&mut self, name: &'a str, index: usize) -> bool {
        self.indices.insert(name, index).is_none()
    }

    /// The index with the name `name`, or `None` if nothing has this name.
    pub fn get(&self, name: &str) -> Option<usize> {
        self.indices.get(name).copied()
    }

    /// The index with the name that `value` holds; fails if the value is not a text or the name is unknown.
    pub fn find(&self, value: Value) -> Result<usize, LoadError> {
        let name = value.text()?;
        self.get(name).ok_or_else(|| {
            let known: Vec<&str> = self.indices.keys().copied().collect();
            value.source.unknown(value.span(), self.what, name, &known)
        })
    }
}
