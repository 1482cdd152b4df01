//! A small typed reader over TOML values. Each value knows its place in the file, so that every message uses
//! the words of scenes and points at the text that is wrong. `numbers` reads the numbers.

use super::limits::{Budget, Limits};
use crate::files::error::LoadError;
use crate::files::words::{listed, nearest, one_line, quoted};
use crate::scene::{Encoding, Gamma2};
use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The TOML file that is being read, mostly a scene, for error messages.
pub(crate) struct Source<'a> {
    /// The path of the file, which names it in messages and from whose folder other files are searched.
    pub file: &'a Path,
    /// The content of the file.
    pub text: &'a str,
    /// What was ignored or replaced so far, in this file and in those that it names.
    pub warnings: RefCell<Vec<LoadError>>,
    /// How colours that are written as text are encoded.
    pub encoding: Cell<Encoding>,
    /// The colours and images that a frame has to decode with gamma 2.
    pub gamma2: RefCell<Gamma2>,
    /// The memory that the scene may still use, in bytes.
    pub budget: Budget,
}

impl<'a> Source<'a> {
    /// The file of this path and content.
    pub fn new(file: &'a Path, text: &'a str, limits: Limits) -> Source<'a> {
        Source {
            file,
            text,
            warnings: RefCell::default(),
            encoding: Cell::default(),
            gamma2: RefCell::default(),
            budget: Budget::new(limits),
        }
    }

    /// All tables of the file; fails if the text is not TOML.
    pub fn document(&self) -> Result<DeTable<'a>, LoadError> {
        DeTable::parse(self.text).map(Spanned::into_inner).map_err(|error| explain(self, &error))
    }

    /// An error at the bytes `span` of the file.
    pub fn error(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    /// The error for a name that is not among `known`, with the name that was probably meant; `what` is the
    /// kind of name that was expected.
    pub fn unknown(&self, span: Range<usize>, what: &str, word: &str, known: &[&str]) -> LoadError {
        let message = format!("unknown {what} {}", quoted(word));
        match nearest(word, known.iter().copied()) {
            Some(meant) => self.error(span, format!("{message}; did you mean {}?", quoted(meant))),
            None if known.is_empty() => self.error(span, message).help("the scene defines none"),
            None => {
                self.error(span, message).help(format!("known names are {}", listed(known.iter().copied())))
            }
        }
    }
}

/// A table whose keys are all known.
pub(crate) struct Table<'a> {
    source: &'a Source<'a>,
    name: String,
    entries: &'a DeTable<'a>,
    span: Range<usize>,
}

impl<'a> Table<'a> {
    /// The table of the whole file, which messages call `name`; fails if it has a key that is not among `known`.
    pub fn root(
        source: &'a Source<'a>,
        name: &str,
        entries: &'a DeTable<'a>,
        known: &[&str],
    ) -> Result<Self, LoadError> {
        Table { source, name: name.into(), entries, span: 0..0 }.with_keys(known)
    }

    /// The same table; fails if it has a key that is not among `known`.
    pub fn with_keys(self, known: &[&str]) -> Result<Self, LoadError> {
        for value in self.values() {
            if !known.contains(&value.key) {
                return Err(self.source.unknown(self.key_span(value.key), "key", value.key, known));
            }
        }
        Ok(self)
    }

    /// The value of `key`, or `None` if the table has no such key.
    pub fn get(&self, key: &str) -> Option<Value<'a>> {
        let (key, item) = self.entries.get_key_value(key)?;
        Some(Value { source: self.source, key: key.get_ref(), place: None, item })
    }

    /// The value of `key`; fails if the table has no such key. `example` is a value for the advice.
    pub fn need(&self, key: &str, example: &str) -> Result<Value<'a>, LoadError> {
        self.get(key).ok_or_else(|| {
            self.error(format!("{} lacks `{key}`", self.name))
                .help(format!("add it, for example `{key} = {example}`"))
        })
    }

    /// The value of the one key among `keys` that the table has; fails if it has none of them, or several.
    pub fn one_of(&self, keys: &[&str]) -> Result<Value<'a>, LoadError> {
        let given: Vec<Value> = keys.iter().filter_map(|key| self.get(key)).collect();
        let all = listed(keys.iter().copied());
        match given[..] {
            [value] => Ok(value),
            [] => Err(self.error(format!("{} needs one of {all}, but has none", self.name))),
            [first, second, ..] => {
                let message = format!("{} has both `{}` and `{}`", self.name, first.key, second.key);
                Err(self.source.error(self.key_span(second.key), message).help("delete one of the two"))
            }
        }
    }

    /// All values of the table, in the order of the file.
    pub fn values(&self) -> Vec<Value<'a>> {
        let mut entries: Vec<_> = self.entries.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let value = |(key, item): (&'a Spanned<_>, _)| {
            let key: &'a std::borrow::Cow<str> = key.get_ref();
            Value { source: self.source, key, place: None, item }
        };
        entries.into_iter().map(value).collect()
    }

    /// The byte range of `key` in the file; that of the table if it has no such key.
    pub fn key_span(&self, key: &str) -> Range<usize> {
        self.entries.get_key_value(key).map_or(self.span.clone(), |(key, _)| key.span())
    }

    /// An error at the table as a whole.
    pub fn error(&self, message: impl Into<String>) -> LoadError {
        self.source.error(self.span.clone(), message)
    }
}

/// A value, its key and, in a list, its index.
#[derive(Clone, Copy)]
pub(crate) struct Value<'a> {
    /// The file that the value stands in.
    pub source: &'a Source<'a>,
    /// The key of the value or, in a list, of the list.
    pub key: &'a str,
    place: Option<usize>,
    item: &'a Spanned<DeValue<'a>>,
}

impl<'a> Value<'a> {
    /// The value of a source that holds nothing else.
    pub fn alone(source: &'a Source<'a>, key: &'a str, item: &'a Spanned<DeValue<'a>>) -> Value<'a> {
        Value { source, key, place: None, item }
    }

    /// The TOML value without its place in the file.
    pub fn item(&self) -> &'a DeValue<'a> {
        self.item.get_ref()
    }

    /// The name of the value in messages: its key between backticks or, in a list, also its number, counted
    /// from 1.
    pub fn name(&self) -> String {
        self.place.map_or(quoted(self.key), |place| format!("entry {} of {}", place + 1, quoted(self.key)))
    }

    /// The byte range of the value in the file.
    pub fn span(&self) -> Range<usize> {
        self.item.span()
    }

    /// The value as it is written in the file, on one line and shortened to 60 characters.
    pub fn spelled(&self) -> String {
        one_line(self.source.text.get(self.item.span()).unwrap_or_default())
    }

    /// An error at this value.
    pub fn error(&self, message: impl Into<String>) -> LoadError {
        self.source.error(self.item.span(), message)
    }

    /// Adds a warning about something that this value leads to.
    pub fn warn(&self, warning: LoadError) {
        self.source.warnings.borrow_mut().push(warning);
    }

    /// The error that the value must be `wanted` but is something else.
    pub fn wrong(&self, wanted: &str) -> LoadError {
        let found = match self.item() {
            DeValue::String(_) => "text".into(),
            DeValue::Integer(_) | DeValue::Float(_) | DeValue::Boolean(_) => self.spelled(),
            DeValue::Datetime(_) => "a date".into(),
            DeValue::Array(_) => "a list".into(),
            DeValue::Table(_) => "a table".into(),
        };
        self.error(format!("{} must be {wanted}, but is {found}", self.name()))
    }

    /// The value as a table; fails if it is not a table or has a key that is not among `known`.
    pub fn table(&self, known: &[&str]) -> Result<Table<'a>, LoadError> {
        self.any_table()?.with_keys(known)
    }

    /// The value as a table with any keys, for example names that the scene gives; fails if it is not a
    /// table.
    pub fn any_table(&self) -> Result<Table<'a>, LoadError> {
        match self.item() {
            DeValue::Table(entries) => {
                Ok(Table { source: self.source, name: self.name(), entries, span: self.item.span() })
            }
            _ => Err(self.wrong("a table")),
        }
    }

    /// The items of the value as a list; fails if it is not a list. `wanted` says in the message what is
    /// expected.
    pub fn list(&self, wanted: &str) -> Result<Vec<Value<'a>>, LoadError> {
        let DeValue::Array(items) = self.item() else { return Err(self.wrong(wanted)) };
        Ok(items
            .iter()
            .enumerate()
            .map(|(place, item)| Value { place: Some(place), item, ..*self })
            .collect())
    }

    /// The value as a text; fails if it is not a text.
    pub fn text(&self) -> Result<&'a str, LoadError> {
        self.item().as_str().ok_or_else(|| self.wrong("text between quotes"))
    }

    /// The value as a `bool`; fails if it is neither `true` nor `false`.
    pub fn truth(&self) -> Result<bool, LoadError> {
        self.item().as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    /// The choice whose word is the value; fails if the value is not one of these words.
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

/// The advice for paths with backslashes.
pub(super) const NO_BACKSLASHES: &str =
    "write a path with `/`, or between single quotes, as in `'meshes\\bunny.obj'`";

/// The parser's `error` as a [`LoadError`]. Common mistakes get a message and advice of their own; other
/// errors keep the message of the parser.
fn explain(source: &Source, error: &toml::de::Error) -> LoadError {
    let end = source.text.len();
    let span = error.span().map_or(end..end, |span| span.start.min(end)..span.end.min(end));
    let blamed = source.text.get(span.clone()).unwrap_or_default();
    let starts_a_number = blamed.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let (message, help) = match error.message() {
        "duplicate key" => (format!("{} is given twice", quoted(blamed)), "delete one of the two"),
        message if message.starts_with("string values must be quoted") && starts_a_number => {
            (format!("{} is not a number", quoted(blamed)), "put commas between numbers, as in `[0, 1, 5]`")
        }
        message if message.starts_with("string values must be quoted") && blamed.trim().is_empty() => {
            ("a value is missing after `=`".into(), "write it, as in `width = 640`")
        }
        message if message.starts_with("string values must be quoted") => {
            (format!("{} has no quotes", quoted(blamed)), "put text between quotes, as in `\"red\"`")
        }
        message if message.starts_with("invalid mantissa") || message.starts_with("invalid fraction") => {
            ("a number has no digits on one side of its point".into(), "write `0.5` and `5.0`")
        }
        message if message.starts_with("unexpected key or value") => {
            ("the line continues after its value".into(), "put lists between brackets, as in `[0, 1, 5]`")
        }
        message if message.starts_with("key with no value") => {
            ("a key has no value".into(), "write the key, `=` and the value")
        }
        message if message.contains("escape") || message.contains("unicode") => {
            ("a backslash between double quotes begins an escape, such as `\\n`".into(), NO_BACKSLASHES)
        }
        "recursion limit" => {
            ("brackets are nested too deep".into(), "a scene needs only a few levels of brackets")
        }
        message => return source.error(span, format!("this is not TOML: {}", one_line(message))),
    };
    source.error(span, message).help(help)
}
