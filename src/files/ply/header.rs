//! The header of a PLY file: which elements follow, how many of each, and which numbers make one element.

use super::scalar::{ByteOrder, Scalar};
use super::text::{Word, guess, readable, trouble_at, words};
use crate::files::error::{LoadError, Warnings};
use crate::files::words::{nearest, quoted};
use std::ops::Range;
use std::path::Path;

/// How the numbers after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As words, separated by blanks and line ends.
    Ascii,
    /// As bytes in this order, without separators.
    Binary(ByteOrder),
}

/// The value of one property: a number, or a list of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// One number of this type.
    One(Scalar),
    /// A number of type `length`, and that many numbers of type `item`.
    List { length: Scalar, item: Scalar },
}

/// A property of an element, from a line such as `property float x`.
#[derive(Clone, Debug)]
pub(super) struct Property {
    /// The name of the property, for example `x`.
    pub name: String,
    /// Whether it is a number or a list, and of which type.
    pub kind: Kind,
    /// The byte range of the name in the header.
    pub span: Range<usize>,
}

/// A kind of element, from a line such as `element vertex 8`, with the properties in the lines below it.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// The name of the element, for example `vertex`.
    pub name: String,
    /// The number of elements that the header promises; the file may hold fewer.
    pub count: usize,
    /// The properties in the order of their numbers in the file, each name once.
    pub properties: Vec<Property>,
    /// The byte range of the name in the header.
    pub span: Range<usize>,
}

/// Everything that stands above the numbers of a PLY file.
#[derive(Clone, Debug)]
pub(super) struct Header {
    /// Whether the numbers are ASCII or binary, and in which byte order.
    pub encoding: Encoding,
    /// The kinds of elements in the order of the file, each name once.
    pub elements: Vec<Element>,
    /// The offset of the byte after the line `end_header`, where the numbers start.
    pub end: usize,
}

const ENCODINGS: [(&str, Encoding); 3] = [
    ("ascii", Encoding::Ascii),
    ("binary_little_endian", Encoding::Binary(ByteOrder::LittleEndian)),
    ("binary_big_endian", Encoding::Binary(ByteOrder::BigEndian)),
];
const KEYWORDS: [&str; 6] = ["format", "comment", "obj_info", "element", "property", "end_header"];
const TYPES: &str = "the types are char, uchar, short, ushort, int, uint, float and double, or int8, uint8, int16, \
                     uint16, int32, uint32, float32 and float64";

/// Reads the header at the start of `bytes`; fails at the first line that is malformed, and if `ply`,
/// `format` or `end_header` is missing.
pub(super) fn read(file: &Path, bytes: &[u8], warnings: &mut Warnings) -> Result<Header, LoadError> {
    let mut lines = Lines::new(bytes);
    let mut draft = Draft { file, bytes, encoding: None, elements: Vec::new(), warnings };
    let first = lines.next().unwrap_or(0..0);
    if bytes[first.clone()].trim_ascii_end() != b"ply" {
        return Err(draft.not_a_ply(first));
    }

    while let Some(line) = lines.next() {
        let text = readable(&bytes[line.clone()]);
        let words = words(&text, line.start);
        let Some(keyword) = words.first() else { continue };
        match keyword.text {
            "comment" if words.get(1).is_some_and(|word| word.text == "TextureFile") => {
                let help = "name the image as `texture` of a material in the scene";
                let span = words[1].span.clone();
                draft
                    .warnings
                    .add(help, || trouble_at(file, bytes, span, "the image of the file is ignored"));
            }
            "comment" | "obj_info" => {}
            "format" => draft.format(&words)?,
            "element" => draft.element(&words)?,
            "property" => draft.property(&words)?,
            "end_header" => {
                let encoding = draft.encoding.ok_or_else(|| draft.without_format(keyword))?;
                return Ok(Header { encoding, elements: draft.elements, end: lines.at });
            }
            _ => draft.unknown_keyword(keyword, &text)?,
        }
    }
    Err(draft.trouble(bytes.len()..bytes.len(), "the file ends before its header does").help(END_HEADER))
}

const END_HEADER: &str = "put a line `end_header` between the header and the numbers";

/// The lines of a header, as places in the file.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    newline: u8,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        // Some text editors begin every file with a byte order mark.
        let at = if bytes.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 };
        // Find out from the first line how lines end: "\n" and "\r\n" both end in a newline, because blanks
        // at the end of a line are ignored; the earliest PLY files have "\r" alone.
        let end = bytes.iter().position(|byte| b"\r\n".contains(byte));
        let newline = match end.map(|end| &bytes[end..]) {
            Some([b'\r', next, ..]) if *next != b'\n' => b'\r',
            _ => b'\n',
        };
        Lines { bytes, at, newline }
    }
}

impl Iterator for Lines<'_> {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        let start = self.at;
        let rest = self.bytes.get(start..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&byte| byte == self.newline).unwrap_or(rest.len());
        self.at = (start + length + 1).min(self.bytes.len());
        Some(start..start + length)
    }
}

/// The header as far as it has been read.
struct Draft<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    encoding: Option<Encoding>,
    elements: Vec<Element>,
    warnings: &'a mut Warnings,
}

impl Draft<'_> {
    fn trouble(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        trouble_at(self.file, self.bytes, span, message)
    }

    /// `format ascii 1.0`
    fn format(&mut self, words: &[Word]) -> Result<(), LoadError> {
        let [_, name, version] = words else { return Err(self.malformed(words, "format ascii 1.0")) };
        if self.encoding.is_some() {
            return Err(self
                .trouble(words[0].span.clone(), "a second `format` line")
                .help("a file has one format: remove the line that does not fit the numbers"));
        }
        let Some((_, encoding)) = ENCODINGS.iter().find(|(known, _)| *known == name.text) else {
            return Err(self
                .trouble(name.span.clone(), format!("{} is not a format of PLY files", quoted(name.text)))
                .help(did_you_mean(
                    nearest(name.text, ENCODINGS.map(|(known, _)| known)),
                    "the formats are ascii, binary_little_endian and binary_big_endian",
                )));
        };
        if version.text != "1.0" {
            let message = format!("version {} of the format is unknown", quoted(version.text));
            return Err(self
                .trouble(version.span.clone(), message)
                .help("the only version is 1.0: write `1.0` if the file follows it"));
        }
        self.encoding = Some(*encoding);
        Ok(())
    }

    /// `element vertex 8`
    fn element(&mut self, words: &[Word]) -> Result<(), LoadError> {
        let [_, name, count] = words else { return Err(self.malformed(words, "element vertex 8")) };
        let Ok(number) = count.text.parse() else {
            let message = format!("{} is not a number of elements", quoted(count.text));
            return Err(self
                .trouble(count.span.clone(), message)
                .help(format!("write how many there are, as in `element {} 8`", name.text)));
        };
        if self.elements.iter().any(|element| element.name == name.text) {
            return Err(self
                .trouble(name.span.clone(), format!("element {} is declared twice", quoted(name.text)))
                .help("declare each element once, with all of its properties below it"));
        }
        self.elements.push(Element {
            name: name.text.into(),
            count: number,
            properties: Vec::new(),
            span: name.span.clone(),
        });
        Ok(())
    }

    /// `property float x` or `property list uchar int vertex_indices`
    fn property(&mut self, words: &[Word]) -> Result<(), LoadError> {
        let (kind, name) = match words {
            [_, list, length, item, name] if list.text == "list" => {
                (Kind::List { length: self.scalar(length)?, item: self.scalar(item)? }, name)
            }
            [_, list, ..] if list.text == "list" => {
                return Err(self.malformed(words, "property list uchar int vertex_indices"));
            }
            [_, scalar, name] => (Kind::One(self.scalar(scalar)?), name),
            _ => return Err(self.malformed(words, "property float x")),
        };
        let property = Property { name: name.text.into(), kind, span: name.span.clone() };

        let Some(element) = self.elements.last_mut() else {
            return Err(self
                .trouble(words[0].span.clone(), "a property before the first element")
                .help("put a line such as `element vertex 8` above the properties of a vertex"));
        };
        if element.properties.iter().any(|earlier| earlier.name == property.name) {
            let message = format!("element `{}` has two properties {}", element.name, quoted(name.text));
            return Err(self
                .trouble(property.span, message)
                .help("give each property of an element its own name"));
        }
        element.properties.push(property);
        Ok(())
    }

    /// The type with this name. The numbers of an ASCII file are read without their types.
    fn scalar(&mut self, word: &Word) -> Result<Scalar, LoadError> {
        if let Some(scalar) = Scalar::named(word.text) {
            return Ok(scalar);
        }
        let error =
            self.trouble(word.span.clone(), format!("{} is not a type of PLY files", quoted(word.text)));
        let help = did_you_mean(nearest(word.text, Scalar::NAMES.map(|(name, _)| name)), TYPES);
        if self.encoding != Some(Encoding::Ascii) {
            return Err(error.help(help));
        }
        let message = format!("{}; the numbers are read as `double`", error.message);
        self.warnings.add(&help, || LoadError { message, ..error });
        Ok(Scalar::Float64)
    }

    fn malformed(&self, words: &[Word], example: &str) -> LoadError {
        let span = words[0].span.start..words[words.len() - 1].span.end;
        self.trouble(span, format!("this `{}` line has {} words", words[0].text, words.len()))
            .help(format!("write it with {} words, as in `{example}`", example.split(' ').count()))
    }

    /// A line that begins with no keyword, perhaps a comment without `comment`, is left out with a warning. Fails if it
    /// looks like a misspelt keyword or like data.
    fn unknown_keyword(&mut self, keyword: &Word, line: &str) -> Result<(), LoadError> {
        // A number in the header is probably the first number of the data.
        if keyword.text.parse::<f64>().is_ok() {
            let error = self.trouble(keyword.span.clone(), "numbers before the end of the header");
            return Err(error.help(END_HEADER));
        }
        let error = self.trouble(
            keyword.span.clone(),
            format!("{} is not a keyword of PLY headers", quoted(keyword.text)),
        );
        let all = "the keywords are format, comment, obj_info, element, property and end_header";
        // Compare the whole line as well, because `end header` is `end_header` without its underscore.
        if let Some(meant) = nearest(line.trim(), KEYWORDS).or_else(|| nearest(keyword.text, KEYWORDS)) {
            return Err(error.help(did_you_mean(Some(meant), all)));
        }
        let message = format!("{}; the line is ignored", error.message);
        self.warnings.add(all, || LoadError { message, ..error });
        Ok(())
    }

    fn without_format(&self, end_header: &Word) -> LoadError {
        self.trouble(end_header.span.clone(), "the header ends without a `format` line")
            .help("write `format ascii 1.0` below `ply` if the numbers are readable text")
    }

    fn not_a_ply(&self, first: Range<usize>) -> LoadError {
        if self.bytes.trim_ascii().is_empty() {
            return LoadError::new(self.file, "the file is empty").help("export or download it again");
        }
        let first = first.start..first.end.min(first.start + 40);
        self.trouble(first, "this is not a PLY file: its first line is not `ply`")
            .help(guess(self.bytes).unwrap_or("check that this is the file you meant, and export it as PLY"))
    }
}

fn did_you_mean(meant: Option<&str>, all: &str) -> String {
    match meant {
        Some(meant) => format!("did you mean `{meant}`? {all}"),
        None => all.into(),
    }
}
