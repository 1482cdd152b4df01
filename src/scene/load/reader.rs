//! A small typed reader over TOML values. It knows where each value stands, so that every message is in the words of
//! scenes and points at what is to blame. Numbers are read in `numbers`.

use super::syntax;
use super::words::{listed, nearest, one_line, quoted};
use crate::scene::error::LoadError;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The file under examination.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub text: &'a str,
}

impl<'a> Source<'a> {
    /// All tables of the file.
    pub fn document(&self) -> Result<DeTable<'a>, LoadError> {
        DeTable::parse(self.text).map(Spanned::into_inner).map_err(|error| syntax::explain(self, &error))
    }

    /// Trouble at the bytes `span`.
    pub fn error(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    /// A name that nothing has; `what` says what sort of thing was sought.
    pub fn unknown(&self, span: Range<usize>, what: &str, word: &str, known: &[&str]) -> LoadError {
        let message = format!("unknown {what} {}", quoted(word));
        match nearest(word, known.iter().copied()) {
            Some(meant) => self.error(span, format!("{message}; did you mean {}?", quoted(meant))),
            None if known.is_empty() => self.error(span, message).help("the scene defines none"),
            None => self.error(span, message).help(format!("known are {}", listed(known.iter().copied()))),
        }
    }
}

/// A table whose keys are all known.
pub(super) struct Table<'a> {
    source: &'a Source<'a>,
    name: String,
    entries: &'a DeTable<'a>,
    span: Range<usize>,
}

impl<'a> Table<'a> {
    /// The whole file, which may hold the keys `known`.
    pub fn root(source: &'a Source<'a>, entries: &'a DeTable<'a>, known: &[&str]) -> Result<Self, LoadError> {
        Table { source, name: "the scene".into(), entries, span: 0..0 }.knowing(known)
    }

    /// The same table, once it is certain that it holds no other keys than `known`.
    pub fn knowing(self, known: &[&str]) -> Result<Self, LoadError> {
        for value in self.values() {
            if !known.contains(&value.key) {
                return Err(self.source.unknown(self.key_span(value.key), "key", value.key, known));
            }
        }
        Ok(self)
    }

    /// The value of `key`, if there is one.
    pub fn get(&self, key: &str) -> Option<Value<'a>> {
        let (key, item) = self.entries.get_key_value(key)?;
        Some(Value { source: self.source, key: key.get_ref(), place: None, item })
    }

    /// The value of `key`, which must be there; `example` is what one would write.
    pub fn need(&self, key: &str, example: &str) -> Result<Value<'a>, LoadError> {
        self.get(key).ok_or_else(|| {
            self.error(format!("{} lacks `{key}`", self.name))
                .help(format!("add it, for example `{key} = {example}`"))
        })
    }

    /// The value of the one key among `keys` that is there.
    pub fn one_of(&self, keys: &[&str]) -> Result<Value<'a>, LoadError> {
        let given: Vec<Value> = keys.iter().filter_map(|key| self.get(key)).collect();
        let all = listed(keys.iter().copied());
        match given[..] {
            [value] => Ok(value),
            [] => Err(self.error(format!("{} needs one of {all}, and has none", self.name))),
            [first, second, ..] => {
                let message = format!("{} has both `{}` and `{}`", self.name, first.key, second.key);
                Err(self.source.error(self.key_span(second.key), message).help("delete one of the two"))
            }
        }
    }

    /// All values, in the order of the file.
    pub fn values(&self) -> Vec<Value<'a>> {
        let mut entries: Vec<_> = self.entries.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let value = |(key, item): (&'a Spanned<_>, _)| {
            let key: &'a std::borrow::Cow<str> = key.get_ref();
            Value { source: self.source, key, place: None, item }
        };
        entries.into_iter().map(value).collect()
    }

    /// Where `key` is written.
    pub fn key_span(&self, key: &str) -> Range<usize> {
        self.entries.get_key_value(key).map_or(self.span.clone(), |(key, _)| key.span())
    }

    /// Trouble with the table as a whole.
    pub fn error(&self, message: impl Into<String>) -> LoadError {
        self.source.error(self.span.clone(), message)
    }
}

/// A value, the key under which it stands and, within a list, its place.
#[derive(Clone, Copy)]
pub(super) struct Value<'a> {
    pub source: &'a Source<'a>,
    pub key: &'a str,
    place: Option<usize>,
    item: &'a Spanned<DeValue<'a>>,
}

impl<'a> Value<'a> {
    /// The bare TOML value.
    pub fn item(&self) -> &'a DeValue<'a> {
        self.item.get_ref()
    }

    /// How messages call the value.
    pub fn name(&self) -> String {
        match self.place {
            Some(place) => format!("entry {} of {}", place + 1, quoted(self.key)),
            None => quoted(self.key),
        }
    }

    /// Where the value is written.
    pub fn span(&self) -> Range<usize> {
        self.item.span()
    }

    /// The value as the file spells it.
    pub fn spelled(&self) -> String {
        one_line(self.source.text.get(self.item.span()).unwrap_or_default())
    }

    /// Trouble with this value.
    pub fn error(&self, message: impl Into<String>) -> LoadError {
        self.source.error(self.item.span(), message)
    }

    /// The value is not `wanted` but something else.
    pub fn wrong(&self, wanted: &str) -> LoadError {
        let found = match self.item() {
            DeValue::String(_) => "text".into(),
            DeValue::Integer(_) | DeValue::Float(_) | DeValue::Boolean(_) => self.spelled(),
            DeValue::Datetime(_) => "a date".into(),
            DeValue::Array(_) => "a list".into(),
            DeValue::Table(_) => "a table".into(),
        };
        self.error(format!("{} must be {wanted}, and is {found}", self.name()))
    }

    /// A table with no other keys than `known`.
    pub fn table(&self, known: &[&str]) -> Result<Table<'a>, LoadError> {
        self.any_table()?.knowing(known)
    }

    /// A table whose keys are names that the scene gives.
    pub fn any_table(&self) -> Result<Table<'a>, LoadError> {
        match self.item() {
            DeValue::Table(entries) => {
                Ok(Table { source: self.source, name: self.name(), entries, span: self.item.span() })
            }
            _ => Err(self.wrong("a table")),
        }
    }

    /// A list of `wanted`.
    pub fn list(&self, wanted: &str) -> Result<Vec<Value<'a>>, LoadError> {
        let DeValue::Array(items) = self.item() else { return Err(self.wrong(wanted)) };
        Ok(items
            .iter()
            .enumerate()
            .map(|(place, item)| Value { place: Some(place), item, ..*self })
            .collect())
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, LoadError> {
        self.item().as_str().ok_or_else(|| self.wrong("text between quotes"))
    }

    /// `true` or `false`.
    pub fn truth(&self) -> Result<bool, LoadError> {
        self.item().as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    /// One of a few words.
    pub fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, LoadError> {
        let word = self.text()?;
        let words: Vec<&str> = choices.iter().map(|(word, _)| *word).collect();
        match choices.iter().find(|(choice, _)| *choice == word) {
            Some((_, value)) => Ok(*value),
            None => {
                let what = format!("value of {}:", self.name());
                Err(self.source.unknown(self.item.span(), &what, word, &words))
            }
        }
    }
}
