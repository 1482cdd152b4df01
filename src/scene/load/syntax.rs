//! Errors of the TOML parser, explained in plain words.

use super::reader::Source;
use super::words::{one_line, quoted};
use crate::scene::error::LoadError;

/// The parser's `error` as a [`LoadError`]. Common mistakes get a message and advice of their own; other
/// errors keep the message of the parser.
pub(super) fn explain(source: &Source, error: &toml::de::Error) -> LoadError {
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
        "recursion limit" => {
            ("brackets are nested too deep".into(), "a scene needs only a few levels of brackets")
        }
        message => return source.error(span, format!("this is not TOML: {}", one_line(message))),
    };
    source.error(span, message).help(help)
}
