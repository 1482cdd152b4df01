//! The error of all file readers: which file cannot be used, where in it, what is wrong, and how to repair
//! it.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A file of the user that cannot be used. It displays as `file:line:column: message`, followed by a line
/// `help: …` if there is advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// Path of the file that cannot be used.
    pub file: PathBuf,
    /// Line and column, both counted from 1 and the column in characters; `None` if the error concerns the
    /// whole file.
    pub place: Option<(usize, usize)>,
    /// The byte range of the file that is wrong, for tools that mark it; empty if there is not a finite number.
    pub span: Range<usize>,
    /// What is wrong, in lower case and without a full stop.
    pub message: String,
    /// How to repair the file, if there is advice.
    pub help: Option<String>,
}

impl LoadError {
    /// An error that concerns the whole `file`, without a place and without advice.
    pub fn new(file: &Path, message: impl Into<String>) -> Self {
        LoadError { file: file.into(), place: None, span: 0..0, message: message.into(), help: None }
    }

    /// An error at the bytes `span` of `text`, the content of `file`. Line and column are those of
    /// `span.start`.
    ///
    /// A byte order mark does not count as a column. A start beyond the end of `text`, or inside of a
    /// character, is placed at the end of `text`.
    pub fn at(file: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        // A byte order mark does not count as a column.
        let column = before[line_start..].trim_start_matches('\u{feff}').chars().count() + 1;
        LoadError { place: Some((line, column)), span, ..LoadError::new(file, message) }
    }

    /// The same error with the advice `help`, which replaces any earlier advice.
    pub fn help(self, help: impl Into<String>) -> Self {
        LoadError { help: Some(help.into()), ..self }
    }
}

/// The warnings about one file. Of a kind that may occur on every line only the first is kept, with the number of all.
#[derive(Debug, Default)]
pub(crate) struct Warnings(Vec<(LoadError, usize)>);

impl Warnings {
    /// Adds a warning with the advice `help`, which also stands for its kind. `warning` is not called for a kind that is
    /// known, because to count the lines above a place takes time.
    pub fn add(&mut self, help: &str, warning: impl FnOnce() -> LoadError) {
        match self.0.iter_mut().find(|(known, _)| known.help.as_deref() == Some(help)) {
            Some((_, count)) => *count += 1,
            None => self.0.push((warning().help(help), 1)),
        }
    }

    /// One warning of each kind, in the order in which they were found.
    pub fn list(self) -> Vec<LoadError> {
        let counted = |(warning, count): (LoadError, usize)| match count {
            1 => warning,
            _ => {
                let message = format!("{} (here first, {count} times in the file)", warning.message);
                LoadError { message, ..warning }
            }
        };
        self.0.into_iter().map(counted).collect()
    }
}

/// `text` with its control characters escaped, except line ends. A message may quote a file that the user did not write, and
/// an escape sequence must not reach the terminal.
pub fn printable(text: &str) -> String {
    let mut printable = String::with_capacity(text.len());
    for character in text.chars() {
        // The characters that change the direction of text could make a message show other words than it has.
        let reorders = matches!(character, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        match reorders || character.is_control() && character != '\n' {
            true => printable.extend(character.escape_default()),
            false => printable.push(character),
        }
    }
    printable
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", printable(&self.file.display().to_string()))?;
        if let Some((line, column)) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        write!(f, ": {}", printable(&self.message))?;
        match &self.help {
            Some(help) => write!(f, "\nhelp: {}", printable(help)),
            None => Ok(()),
        }
    }
}

impl std::error::Error for LoadError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_of_a_file_are_escaped() {
        let error = LoadError::new(Path::new("a\u{1b}[2J.toml"), "no \u{7}")
            .help("did you mean `\u{9b}31m\u{202e}`?\n");
        assert_eq!(
            error.to_string(),
            "a\\u{1b}[2J.toml: no \\u{7}\nhelp: did you mean `\\u{9b}31m\\u{202e}`?\n"
        );
    }
}
