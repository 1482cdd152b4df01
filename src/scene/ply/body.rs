//! The numbers after the header, one at a time. Whoever asks knows from the header which kind comes next.

use super::header::{Element, Encoding, Header, Kind, Property};
use super::scalar::Scalar;
use super::text::{quote, readable, trouble_at};
use crate::scene::error::LoadError;
use std::ops::Range;
use std::path::Path;

/// The rest of the file behind a cursor.
pub(super) struct Body<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    encoding: Encoding,
    /// The byte after the number that was read last.
    at: usize,
    /// Where that number stands, to point at if it makes no sense.
    last: Range<usize>,
}

/// What is being read, for messages: a property of the element with this number, counted from 0.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub element: &'a Element,
    pub number: usize,
    pub property: &'a Property,
}

impl<'a> Body<'a> {
    pub fn new(file: &'a Path, bytes: &'a [u8], header: &Header) -> Self {
        Body { file, bytes, encoding: header.encoding, at: header.end, last: header.end..header.end }
    }

    /// The next number.
    pub fn value(&mut self, scalar: Scalar, place: Place) -> Result<f64, LoadError> {
        self.advance(scalar, place)?;
        let bytes = &self.bytes[self.last.clone()];
        match self.encoding {
            Encoding::Ascii => scalar.parse(bytes).ok_or_else(|| self.not_a_number(place)),
            Encoding::Binary(order) => Ok(scalar.decode(bytes, order)),
        }
    }

    /// The next number, which says how long a list is.
    pub fn length(&mut self, scalar: Scalar, place: Place) -> Result<usize, LoadError> {
        let length = self.value(scalar, place)?;
        // Also false for a NaN. The bound is the largest `uint`, so that the number fits into a `usize`.
        if (0.0..=f64::from(u32::MAX)).contains(&length) && length.fract() == 0.0 {
            return Ok(length as usize);
        }
        let message = format!("{} {} has a list of length {length}", place.element.name, place.number);
        Err(self.trouble(place, message).help(
            "a list starts with its length, a whole number from 0; look for a number too few or too many",
        ))
    }

    /// Passes over a property that nobody wants. Its numbers are not even parsed.
    pub fn skip(&mut self, place: Place) -> Result<(), LoadError> {
        match (place.property.kind, self.encoding) {
            (Kind::One(scalar), _) => self.advance(scalar, place),
            (Kind::List { length, item }, Encoding::Ascii) => {
                let length = self.length(length, place)?;
                (0..length).try_for_each(|_| self.advance(item, place))
            }
            (Kind::List { length, item }, Encoding::Binary(_)) => {
                let length = self.length(length, place)?;
                self.check_left(length, item, place)?;
                self.at += length * item.size();
                Ok(())
            }
        }
    }

    /// Passes over all elements of a kind that nobody wants.
    pub fn skip_element(&mut self, element: &Element) -> Result<(), LoadError> {
        if element.properties.is_empty() {
            return Ok(()); // and do not count to four billion for it
        }
        for number in 0..element.count {
            for property in &element.properties {
                self.skip(Place { element, number, property })?;
            }
        }
        Ok(())
    }

    /// The most items of `size` numbers that the rest of the file can hold. The header may promise any number,
    /// and memory is set aside only for what can come.
    pub fn at_most(&self, promised: usize, numbers: usize) -> usize {
        // A word and the blank after it take two bytes; one byte is the smallest number of a binary file.
        let smallest = if self.encoding == Encoding::Ascii { 2 } else { 1 };
        promised.min((self.bytes.len() - self.at) / (smallest * numbers.max(1)) + 1)
    }

    /// A binary file must still hold `length` numbers: one look at its size, before anything is done for each.
    pub fn check_left(&self, length: usize, item: Scalar, place: Place) -> Result<(), LoadError> {
        let left = (self.bytes.len() - self.at) / item.size();
        if self.encoding != Encoding::Ascii && length > left { Err(self.ends_early(place)) } else { Ok(()) }
    }

    /// Nothing may follow the last element of an ASCII file. Binary files are left in peace, since some writers
    /// pad them.
    pub fn finish(&mut self) -> Result<(), LoadError> {
        if self.encoding != Encoding::Ascii || !self.next_word() {
            return Ok(());
        }
        Err(trouble_at(self.file, self.bytes, self.last.clone(), "the file goes on after its last element")
            .help("a count in the header is too small, or a row has a number too many"))
    }

    /// Trouble with the number that was read last.
    pub fn trouble(&self, place: Place, message: String) -> LoadError {
        match self.encoding {
            Encoding::Ascii => trouble_at(self.file, self.bytes, self.last.clone(), message),
            Encoding::Binary(_) => {
                let (property, byte) = (&place.property.name, self.last.start);
                LoadError::new(
                    self.file,
                    format!("{message} (property `{property}`, byte {byte} of the file)"),
                )
            }
        }
    }

    /// Moves past the next number and remembers where it stands.
    fn advance(&mut self, scalar: Scalar, place: Place) -> Result<(), LoadError> {
        match self.encoding {
            Encoding::Ascii => {
                if self.next_word() {
                    Ok(())
                } else {
                    Err(self.ends_early(place))
                }
            }
            Encoding::Binary(_) => {
                self.check_left(1, scalar, place)?;
                self.last = self.at..self.at + scalar.size();
                self.at = self.last.end;
                Ok(())
            }
        }
    }

    /// Moves past the next word, if there is one. Line ends are blanks like any other: a row of several vertices
    /// and a vertex of several rows read the same.
    fn next_word(&mut self) -> bool {
        let rest = &self.bytes[self.at..];
        let Some(blanks) = rest.iter().position(|byte| !byte.is_ascii_whitespace()) else { return false };
        let word = &rest[blanks..];
        let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        self.last = self.at + blanks..self.at + blanks + length;
        self.at = self.last.end;
        true
    }

    fn not_a_number(&self, place: Place) -> LoadError {
        let word = readable(&self.bytes[self.last.clone()]);
        let (element, property) = (&place.element.name, &place.property.name);
        let message = format!(
            "{} is no number; `{property}` of {element} {} should be here",
            quote(&word),
            place.number
        );
        self.trouble(place, message).help(if word.contains(',') {
            "write a decimal point, not a comma, and blanks between numbers"
        } else {
            "replace it by a number, or look above it for a row with a number too few or too many"
        })
    }

    fn ends_early(&self, place: Place) -> LoadError {
        let Place { element, number, property } = place;
        let (name, count) = (&element.name, element.count);
        let message = format!(
            "the file ends early: the header promises {count} of element `{name}`, but `{}` of {name} {number} is missing",
            property.name
        );
        let end = self.bytes.len();
        let error = match self.encoding {
            Encoding::Ascii => trouble_at(self.file, self.bytes, end..end, message),
            Encoding::Binary(_) => LoadError::new(self.file, format!("{message} at byte {end}, the end")),
        };
        error.help(format!("export or fetch the file again, or correct the line `element {name} {count}`"))
    }
}
