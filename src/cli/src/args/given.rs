//! The values of a command line, as what the command needs: numbers in a range, choices, files.

use super::{Misuse, Opt, Spec, did_you_mean};
use std::ffi::{OsStr, OsString};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;

/// The values of a command line.
#[derive(Debug)]
pub struct Given {
    pub(super) spec: &'static Spec,
    pub(super) arguments: Vec<OsString>,
    pub(super) options: Vec<(&'static Opt, OsString)>,
}

impl Given {
    /// Whether a flag was given, or an option with a value.
    pub fn has(&self, long: &str) -> bool {
        self.values(long).next().is_some()
    }

    fn values(&self, long: &str) -> impl Iterator<Item = &OsStr> {
        debug_assert!(self.spec.all_options().any(|option| option.long == long), "no option {long}");
        self.options.iter().filter(move |(option, _)| option.long == long).map(|(_, value)| value.as_os_str())
    }

    /// The options as they were given, for the command line of another program, without those of these names.
    pub fn words_without(&self, left_out: &[&str]) -> Vec<OsString> {
        let given = self.options.iter().filter(|(option, _)| !left_out.contains(&option.long));
        let words = given.flat_map(|(option, value)| {
            [Some(OsString::from(option.long)), option.value.map(|_| value.clone())]
        });
        words.flatten().collect()
    }

    /// The value of an option that names a file or a folder.
    pub fn path(&self, long: &str) -> Option<PathBuf> {
        self.values(long).next().map(PathBuf::from)
    }

    /// The value of an option that the command needs and that names a file or a folder.
    pub fn required_path(&self, long: &str) -> Result<PathBuf, Misuse> {
        self.path(long).ok_or_else(|| self.misuse(format!("`{long}` is missing")))
    }

    /// The value of an option, as `parse` understands it.
    pub fn parsed<T, E: Display>(
        &self,
        long: &str,
        parse: impl Fn(&str) -> Result<T, E>,
    ) -> Result<Option<T>, Misuse> {
        self.values(long).next().map(|value| self.one(long, &value.to_string_lossy(), parse)).transpose()
    }

    /// The values of an option that can be repeated. A comma is part of the value.
    pub fn repeated<T, E: Display>(
        &self,
        long: &str,
        parse: impl Fn(&str) -> Result<T, E>,
    ) -> Result<Vec<T>, Misuse> {
        self.values(long).map(|value| self.one(long, &value.to_string_lossy(), &parse)).collect()
    }

    /// The values of an option that can have several, separated by commas.
    pub fn list<T, E: Display>(
        &self,
        long: &str,
        parse: impl Fn(&str) -> Result<T, E>,
    ) -> Result<Vec<T>, Misuse> {
        let texts: Vec<String> =
            self.values(long).map(|value| value.to_string_lossy().into_owned()).collect();
        let parts = texts.iter().flat_map(|text| text.split(','));
        parts.map(|part| self.one(long, part, &parse)).collect()
    }

    fn one<T, E: Display>(
        &self,
        long: &str,
        text: &str,
        parse: impl Fn(&str) -> Result<T, E>,
    ) -> Result<T, Misuse> {
        parse(text).map_err(|why| self.spec.misuse(format!("`{long} {text}`: {why}")))
    }

    /// A whole number within a range.
    pub fn number<T: FromStr + PartialOrd + Display>(
        &self,
        long: &str,
        range: RangeInclusive<T>,
    ) -> Result<Option<T>, Misuse> {
        self.parsed(long, |text| whole_number(text, &range))
    }

    /// The value of an option with a fixed list of names; `named` lists each name with its value.
    pub fn choice<T: Copy>(&self, long: &str, named: &[(&str, T)]) -> Result<Option<T>, Misuse> {
        self.parsed(long, |text| chosen(text, named))
    }

    /// The same for an option that can have several.
    pub fn choices<T: Copy>(&self, long: &str, named: &[(&str, T)]) -> Result<Vec<T>, Misuse> {
        self.list(long, |text| chosen(text, named))
    }

    /// The argument at this index, counted from 0.
    pub fn argument(&self, place: usize) -> Option<&OsStr> {
        self.arguments.get(place).map(OsString::as_os_str)
    }

    /// All arguments from this index on.
    pub fn arguments(&self, place: usize) -> &[OsString] {
        self.arguments.get(place..).unwrap_or_default()
    }

    /// All arguments from this index on, as text.
    pub fn texts(&self, place: usize) -> Vec<String> {
        self.arguments(place).iter().map(|word| word.to_string_lossy().into_owned()).collect()
    }

    /// The argument at this index; an error if it is missing.
    pub fn required(&self, place: usize) -> Result<&OsStr, Misuse> {
        self.argument(place).ok_or_else(|| {
            let name = self.spec.arguments.get(place).map_or("", |argument| argument.name);
            self.spec.misuse(format!("{name} is missing"))
        })
    }

    /// The argument at this index, as `parse` understands it.
    pub fn parsed_argument<T, E: Display>(
        &self,
        place: usize,
        parse: impl Fn(&str) -> Result<T, E>,
    ) -> Result<Option<T>, Misuse> {
        let parse = |text: &OsStr| {
            let text = text.to_string_lossy();
            parse(&text).map_err(|why| self.misuse(format!("`{text}`: {why}")))
        };
        self.argument(place).map(parse).transpose()
    }

    /// An error for options that exclude each other.
    pub fn exclude(&self, one: &str, other: &str) -> Result<(), Misuse> {
        self.refuse(self.has(one) && self.has(other), format!("`{one}` cannot be used with `{other}`"))
    }

    /// An error for an option that was given without another one that it needs.
    pub fn require(&self, one: &str, other: &str) -> Result<(), Misuse> {
        self.refuse(self.has(one) && !self.has(other), format!("`{one}` needs `{other}`"))
    }

    /// An error with this message if the command line is wrong.
    pub fn refuse(&self, is_wrong: bool, message: impl Into<String>) -> Result<(), Misuse> {
        if is_wrong { Err(self.misuse(message)) } else { Ok(()) }
    }

    /// An error about this command.
    pub fn misuse(&self, message: impl Into<String>) -> Misuse {
        self.spec.misuse(message.into())
    }
}

/// A whole number within a range.
pub fn whole_number<T: FromStr + PartialOrd + Display>(
    text: &str,
    range: &RangeInclusive<T>,
) -> Result<T, String> {
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("a whole number from {} to {} is wanted", range.start(), range.end()))
}

/// The value of this name, in which `-` and `_` are the same.
pub fn chosen<T: Copy>(text: &str, named: &[(&str, T)]) -> Result<T, String> {
    let found = named.iter().find(|(name, _)| name.replace('-', "_") == text.replace('-', "_"));
    found.map(|(_, meaning)| *meaning).ok_or_else(|| {
        let names: Vec<&str> = named.iter().map(|(name, _)| *name).collect();
        format!("known are {}{}", names.join(", "), did_you_mean(text, &names))
    })
}

/// The names of a list of choices.
pub const fn names<T, const N: usize>(named: &[(&'static str, T); N]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut at = 0;
    while at < N {
        names[at] = named[at].0;
        at += 1;
    }
    names
}
