//! What `attack.toml` says of a step.

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
    /// Puts text before the first item of `path`, stage 1 if none is named.
    Top,
    /// Puts text at the end of `path`.
    Append,
    /// Gives `function` of `path` another body, or all for `*`. `@right@` is the body of the reference, `@wrong@` a wrong
    /// one.
    Body,
    /// Takes `path` away, a file or a folder.
    Remove,
    /// Saves `path` again in another `encoding`.
    Encode,
    /// Makes `path` a link that leads `to` somewhere.
    Link,
    /// Makes `path` a named pipe.
    Pipe,
    /// Makes folders in each other, `times` of them, each called `path`.
    Deep,
    /// Gives `path` the age of 1970.
    Old,
    /// Writes the file `path` outside of the submission.
    Beside,
    /// Writes `path` such that it knows the answers to all known inputs of these `functions`, and none other.
    Remember,
    /// Packs what is there, and `entries`, into an archive of this `format`.
    Pack,
    /// The submission is one file of this `format`, whatever is in it.
    Raw,
}

/// How a file is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Encoding {
    /// With a byte order mark and the line ends of Windows.
    Windows,
    /// In UTF-16.
    Utf16,
}

/// Text or bytes: one of `text`, `fragment` (a file beside attack.toml), `solution` (a file of the reference) and `hex`,
/// `times` times, between `before` and `after`. `@n@` counts from 0.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Content {
    pub(super) text: Option<String>,
    pub(super) fragment: Option<String>,
    pub(super) solution: Option<String>,
    pub(super) hex: Option<String>,
    pub(super) times: Option<usize>,
    pub(super) before: Option<String>,
    pub(super) after: Option<String>,
}

/// One step. What it does not need it may not have.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    #[serde(rename = "do")]
    pub(super) act: Act,
    pub(super) path: Option<String>,
    /// The last part of the path, in bytes that are no text.
    pub(super) path_hex: Option<String>,
    pub(super) to: Option<String>,
    pub(super) function: Option<String>,
    pub(super) functions: Option<Vec<String>>,
    pub(super) encoding: Option<Encoding>,
    pub(super) times: Option<usize>,
    pub(super) content: Option<Content>,
    /// Short for a content that is nothing but text.
    pub(super) text: Option<String>,
    /// Short for a content that is nothing but a file beside attack.toml.
    pub(super) fragment: Option<String>,
    pub(super) format: Option<Format>,
    /// What stands before the names of packed files.
    pub(super) prefix: Option<String>,
    pub(super) entries: Option<Vec<Packed>>,
    /// Only `entries` are packed.
    pub(super) alone: Option<bool>,
    /// So many bytes are missing at the end of the archive.
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
    /// Mebibytes of zeros behind the content.
    pub(super) zeros: Option<u64>,
    /// The size that is stated, in bytes.
    pub(super) stated: Option<u64>,
    #[serde(default)]
    pub(super) encrypted: bool,
    /// So many of them; `@n@` in the name counts from 0.
    pub(super) times: Option<usize>,
}

/// The value, which the step must have.
pub(super) fn need<T>(value: Option<T>, name: &str) -> Result<T> {
    value.with_context(|| format!("`{name}` is missing"))
}

/// The path of a step.
pub(super) fn path_of(step: &mut Step) -> Result<PathBuf> {
    let mut path = PathBuf::from(step.path.take().unwrap_or_default());
    if let Some(hex) = step.path_hex.take() {
        path.push(OsString::from_vec(bytes_of(&hex)?));
    }
    ensure!(path.is_relative() && path.components().next().is_some(), "`path` is missing");
    Ok(path)
}

/// The bytes of hexadecimal digits, in which spaces do not matter.
pub(super) fn bytes_of(hex: &str) -> Result<Vec<u8>> {
    let digits: Vec<u8> = hex.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let pair = |pair: &[u8]| {
        let text = std::str::from_utf8(pair)?;
        u8::from_str_radix(text, 16).with_context(|| format!("`{text}` is no byte in hexadecimal"))
    };
    digits.chunks(2).map(pair).collect()
}
