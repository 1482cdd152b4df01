//! A step that makes a submission.

use super::pack::{Format, Kind};
use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt;
use std::path::PathBuf;

/// What a step does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Act {
    /// Writes the file `path`.
    #[default]
    Write,
    /// Writes `times` files `path`, in which `@n@` counts from 0.
    Many,
    /// Puts text before the first item of `path` (default: the file of stage 1).
    Top,
    /// Puts text at the end of `path`.
    Append,
    /// Replaces the body of `function` of `path`, or of all functions for `*`. `@right@` is the body of the reference,
    /// `@wrong@` a wrong one.
    Body,
    /// Removes the file or folder `path`.
    Remove,
    /// Saves `path` again in another `encoding`.
    Encode,
    /// Makes `path` a link that leads `to` a place.
    Link,
    /// Makes `path` a named pipe.
    Pipe,
    /// Makes `times` nested folders, each called `path`.
    Deep,
    /// Sets the modification time of `path` to 1970.
    Old,
    /// Writes the file `path` outside of the submission.
    Beside,
    /// Gives these `functions` of `path` a table with the answers to all public inputs, and to no others.
    Remember,
    /// Packs the exercise files, and `entries`, into an archive of this `format`.
    Pack,
    /// Makes the submission one file with the extension of this `format` and any content.
    Raw,
}

/// The encoding of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Encoding {
    /// With a byte order mark and the line ends of Windows.
    Windows,
    /// With the line ends of systems before 2001.
    Old,
    /// In UTF-16.
    Utf16,
}

/// Text or bytes: one of `text`, `solution` (a file of the reference) and `hex`. It is repeated `times` times, between
/// `before` and `after`. `@n@` counts from 0.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Content {
    pub(super) text: Option<String>,
    pub(super) solution: Option<String>,
    pub(super) hex: Option<String>,
    pub(super) times: Option<usize>,
    pub(super) before: Option<String>,
    pub(super) after: Option<String>,
}

/// One step. A key that its act does not need is an error.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    #[serde(rename = "do")]
    pub(super) act: Act,
    pub(super) path: Option<String>,
    /// The last part of the path as hexadecimal bytes, for names that are not valid UTF-8.
    pub(super) path_hex: Option<String>,
    pub(super) to: Option<String>,
    pub(super) function: Option<String>,
    pub(super) functions: Option<Vec<String>>,
    pub(super) encoding: Option<Encoding>,
    pub(super) times: Option<usize>,
    pub(super) content: Option<Content>,
    /// Short for a content of only text.
    pub(super) text: Option<String>,
    /// Short for a content of only the text of this name in `[fragments]`.
    pub(super) fragment: Option<String>,
    pub(super) format: Option<Format>,
    /// The prefix of the names of packed files.
    pub(super) prefix: Option<String>,
    pub(super) entries: Option<Vec<Packed>>,
    /// Whether only `entries` are packed.
    pub(super) alone: Option<bool>,
    /// The number of bytes that are missing at the end of the archive.
    pub(super) cut: Option<usize>,
}

/// An entry of an archive.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Packed {
    pub(super) name: Option<String>,
    pub(super) name_hex: Option<String>,
    #[serde(default)]
    pub(super) kind: Kind,
    #[serde(default)]
    pub(super) content: Content,
    pub(super) to: Option<String>,
    /// Mebibytes of zeros after the content.
    pub(super) zeros: Option<u64>,
    /// The stated size, in bytes.
    pub(super) stated: Option<u64>,
    #[serde(default)]
    pub(super) encrypted: bool,
    /// The number of such entries; `@n@` in the name counts from 0.
    pub(super) times: Option<usize>,
}

/// Returns the value, or an error if the step lacks it.
pub(super) fn need<T>(value: Option<T>, name: &str) -> Result<T> {
    value.with_context(|| format!("`{name}` is missing"))
}

/// Returns the path of a step.
pub(super) fn path_of(step: &mut Step) -> Result<PathBuf> {
    let mut path = PathBuf::from(step.path.take().unwrap_or_default());
    if let Some(hex) = step.path_hex.take() {
        path.push(OsString::from_vec(bytes_of(&hex)?));
    }
    ensure!(path.is_relative() && path.components().next().is_some(), "`path` is missing");
    Ok(path)
}

/// Decodes hexadecimal digits. Spaces are ignored.
pub(super) fn bytes_of(hex: &str) -> Result<Vec<u8>> {
    let digits: Vec<u8> = hex.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let pair = |pair: &[u8]| {
        let text = std::str::from_utf8(pair)?;
        u8::from_str_radix(text, 16).with_context(|| format!("`{text}` is not a byte in hexadecimal"))
    };
    digits.chunks(2).map(pair).collect()
}
