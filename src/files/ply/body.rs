//! The numbers after the header of a PLY file, read one at a time. The caller knows from the header which
//! type comes next.

use super::header::{Element, Encoding, Header, Kind, Property};
use super::scalar::Scalar;
use super::text::{readable, trouble_at};
use crate::files::error::LoadError;
use crate::files::words::quoted;
use std::ops::Range;
use std::path::Path;

/// The numbers of a PLY file, with the position of the next one.
pub(super) struct Body<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    encoding: Encoding,
    /// The offset of the byte after the number that was read last.
    at: usize,
    /// The byte range of that number, for error messages.
    last: Range<usize>,
}

/// The number that is being read, for messages.
#[derive(Clone, Copy)]
pub(super) struct NumberLocation<'a> {
    /// The kind of element, as the header declares it.
    pub element: &'a Element,
    /// Which element of that kind, counted from 0.
    pub number: usize,
    /// The property of that element.
    pub property: &'a Property,
}

impl<'a> Body<'a> {
    /// A reader of `bytes` that stands at the end of `header`.
    pub fn new(file: &'a Path, bytes: &'a [u8], header: &Header) -> Self {
        Body { file, bytes, encoding: header.encoding, at: header.end, last: header.end..header.end }
    }

    /// Reads the next number, which is of type `scalar`, as an `f64`; it may be NaN or infinite. Fails at the
    /// end of the file and at a word that is not a number.
    pub fn value(&mut self, scalar: Scalar, place: NumberLocation) -> Result<f64, LoadError> {
        self.advance(scalar, place)?;
        let bytes = &self.bytes[self.last.clone()];
        match self.encoding {
            Encoding::Ascii => scalar.parse(bytes).ok_or_else(|| self.not_a_number(place)),
            Encoding::Binary(order) => Ok(scalar.decode(bytes, order)),
        }
    }

    /// The byte of the file at which the number that was read last starts.
    pub fn last_byte(&self) -> usize {
        self.last.start
    }

    /// Reads the next number as the length of a list; fails if it is not a whole number in `0..=u32::MAX`.
    pub fn length(&mut self, scalar: Scalar, place: NumberLocation) -> Result<usize, LoadError> {
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

    /// Skips a property that is not needed. Fails at the end of the file; apart from the length of a list,
    /// the numbers are not parsed.
    pub fn skip(&mut self, place: NumberLocation) -> Result<(), LoadError> {
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

    /// Skips all elements of a kind that is not needed; fails at the end of the file.
    pub fn skip_element(&mut self, element: &Element) -> Result<(), LoadError> {
        if element.properties.is_empty() {
            return Ok(()); // without a loop over up to four billion elements
        }
        for number in 0..element.count {
            for property in &element.properties {
                self.skip(NumberLocation { element, number, property })?;
            }
        }
        Ok(())
    }

    /// The smaller of `promised` and an upper bound for the number of items that the rest of the file can
    /// hold, if an item has `numbers` numbers. The header may promise any number, and memory is reserved only
    /// for items that can follow.
    pub fn at_most(&self, promised: usize, numbers: usize) -> usize {
        // A word and the blank after it take two bytes; one byte is the smallest number of a binary file.
        let smallest = if self.encoding == Encoding::Ascii { 2 } else { 1 };
        promised.min((self.bytes.len() - self.at) / (smallest * numbers.max(1)) + 1)
    }

    /// Fails if a binary file ends before `length` more numbers of type `item`. One comparison with the file
    /// size avoids a long loop over a length that cannot be right. An ASCII file always passes.
    pub fn check_left(&self, length: usize, item: Scalar, place: NumberLocation) -> Result<(), LoadError> {
        let left = (self.bytes.len() - self.at) / item.size();
        if self.encoding != Encoding::Ascii && length > left { Err(self.ends_early(place)) } else { Ok(()) }
    }

    /// Fails if an ASCII file has a word after its last element. Binary files always pass, because some
    /// writers pad them.
    pub fn finish(&mut self) -> Result<(), LoadError> {
        if self.encoding != Encoding::Ascii || !self.next_word() {
            return Ok(());
        }
        Err(trouble_at(self.file, self.bytes, self.last.clone(), "the file continues after its last element")
            .help("a count in the header is too small, or a row has a number too many"))
    }

    /// An error at the number that was read last: by line and column in an ASCII file, by property and byte
    /// offset in a binary file.
    pub fn trouble(&self, place: NumberLocation, message: String) -> LoadError {
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

    /// An error at a byte of the file: by line and column in an ASCII file.
    pub fn trouble_at(&self, byte: usize, message: String) -> LoadError {
        match self.encoding {
            Encoding::Ascii => trouble_at(self.file, self.bytes, byte..byte + 1, message),
            Encoding::Binary(_) => LoadError::new(self.file, format!("{message} (byte {byte} of the file)")),
        }
    }

    /// Skips the next number and remembers its byte range.
    fn advance(&mut self, scalar: Scalar, place: NumberLocation) -> Result<(), LoadError> {
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

    /// Skips the next word, if there is one. Line ends count as blanks: several vertices in one row and a
    /// vertex over several rows are read in the same way.
    fn next_word(&mut self) -> bool {
        let rest = &self.bytes[self.at..];
        let Some(blanks) = rest.iter().position(|byte| !byte.is_ascii_whitespace()) else { return false };
        let word = &rest[blanks..];
        let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        self.last = self.at + blanks..self.at + blanks + length;
        self.at = self.last.end;
        true
    }

    fn not_a_number(&self, place: NumberLocation) -> LoadError {
        let word = readable(&self.bytes[self.last.clone()]);
        let (element, property) = (&place.element.name, &place.property.name);
        let message = format!(
            "{} is not a number; `{property}` of {element} {} should be here",
            quoted(&word),
            place.number
        );
        self.trouble(place, message).help(if word.contains(',') {
            "write a decimal point, not a comma, and blanks between numbers"
        } else {
            "replace it by a number, or look above it for a row with a number too few or too many"
        })
    }

    fn ends_early(&self, place: NumberLocation) -> LoadError {
        let NumberLocation { element, number, property } = place;
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
        error.help(format!("export or download the file again, or correct the line `element {name} {count}`"))
    }
}
