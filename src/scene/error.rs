//! What a reader of files says when it cannot go on: what, where, and what to do about it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A file of the user's that cannot be used. Nothing has been written when this is returned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The file.
    pub file: PathBuf,
    /// Line and column, both from 1, if the trouble sits at a place in the file.
    pub place: Option<(usize, usize)>,
    /// Bytes of the file that are to blame, for tools that draw the line; empty if there is no place.
    pub span: Range<usize>,
    /// What is wrong, lower case, without a full stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl LoadError {
    /// Trouble with a whole file.
    pub fn new(file: &Path, message: impl Into<String>) -> Self {
        LoadError { file: file.into(), place: None, span: 0..0, message: message.into(), help: None }
    }

    /// Trouble at the bytes `span` of `text`, which is what the file holds.
    pub fn at(file: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        // A byte order mark takes room in the file and none on the screen.
        let column = before[line_start..].trim_start_matches('\u{feff}').chars().count() + 1;
        LoadError { place: Some((line, column)), span, ..LoadError::new(file, message) }
    }

    /// The same error with a remedy.
    pub fn help(self, help: impl Into<String>) -> Self {
        LoadError { help: Some(help.into()), ..self }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some((line, column)) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": {}", self.message)?;
        match &self.help {
            Some(help) => write!(f, "\nhelp: {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for LoadError {}
