//! The lines of an OBJ file, checked one by one.

use crate::scene::error::LoadError;
use crate::scene::ply::text::{Word, nearest, quote, words};
use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;

/// The content of an OBJ file, all of whose lines are correct.
#[derive(Debug, Default)]
pub(super) struct Lines {
    /// The lines that `tobj` needs, each in a form that it reads correctly.
    pub clean: String,
    /// Number of `v` lines in the file.
    pub vertices: usize,
    /// Number of `f` lines in the file, before polygons are cut into triangles.
    pub faces: usize,
    /// The names after `usemtl`, each once and in order of first use.
    pub material_names: Vec<String>,
    /// Byte ranges of the text after each `mtllib`, which is one file name or several.
    pub libraries: Vec<Range<usize>>,
    texture_coordinates: usize,
    normals: usize,
}

/// The keywords that are long enough to be misspelt, and the similar keywords of the format.
const LONG_KEYWORDS: [&str; 4] = ["usemtl", "mtllib", "usemap", "maplib"];

/// Checks all lines of `text` and returns their content; fails at the first line that is malformed or that
/// names a vertex, texture coordinate or normal that is not above it.
pub(super) fn read(file: &Path, text: &str) -> Result<Lines, LoadError> {
    let mut reader = Reader { file, text, lines: Lines::default(), names: HashSet::new() };
    // `tobj` gets one library, which stands for all names of materials.
    reader.lines.clean.push_str("mtllib all\n");
    for line in logical_lines(text) {
        reader.line(line)?;
    }
    Ok(reader.lines)
}

/// The byte ranges of the lines of a file. A line that ends in a backslash continues in the next one, unless
/// it is a comment: comments often end in the name of a Windows directory.
fn logical_lines(text: &str) -> impl Iterator<Item = Range<usize>> {
    let mut start = if text.starts_with('\u{feff}') { 3 } else { 0 };
    std::iter::from_fn(move || {
        let from = start;
        if from >= text.len() {
            return None;
        }
        let mut end = from;
        loop {
            end = text[end..].find('\n').map_or(text.len(), |length| end + length);
            start = end + 1;
            let line = text[from..end].trim_ascii();
            if end == text.len() || line.starts_with('#') || !line.ends_with('\\') {
                return Some(from..end);
            }
            end += 1;
        }
    })
}

struct Reader<'a> {
    file: &'a Path,
    text: &'a str,
    lines: Lines,
    names: HashSet<&'a str>,
}

impl<'a> Reader<'a> {
    fn trouble(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    fn line(&mut self, line: Range<usize>) -> Result<(), LoadError> {
        let mut words = words(&self.text[line.clone()], line.start);
        for word in &mut words {
            word.text = word.text.trim_end_matches('\\');
        }
        words.retain(|word| !word.text.is_empty());
        let Some(keyword) = words.first().cloned() else { return Ok(()) };
        let comment = words.iter().position(|word| word.text.starts_with('#'));
        let values = &words[1..comment.unwrap_or(words.len()).max(1)];
        match keyword.text {
            // A fourth number is the weight for free-form surfaces, and more numbers are a colour; a mesh has
            // neither.
            "v" => {
                self.numbers(&keyword, values, 3)?;
                self.lines.vertices += 1;
            }
            "vt" => {
                self.numbers(&keyword, values, 2)?;
                self.lines.texture_coordinates += 1;
            }
            "vn" => {
                self.numbers(&keyword, values, 3)?;
                self.lines.normals += 1;
            }
            "f" => self.face(&keyword, values)?,
            "usemtl" => self.use_material(&keyword, line.end)?,
            "mtllib" => {
                let names = self.rest(&keyword, line.end, "name a file, as in `mtllib box.mtl`")?;
                self.lines.libraries.push(names);
            }
            // Points and lines have no surface; objects, groups and smoothing do not affect one set of triangles.
            _ => self.check_keyword(&keyword)?,
        }
        Ok(())
    }

    /// Copies the numbers of a `v`, `vt` or `vn` line.
    fn numbers(&mut self, keyword: &Word, values: &[Word], count: usize) -> Result<(), LoadError> {
        self.lines.clean.push_str(keyword.text);
        for index in 0..count {
            let number = match values.get(index) {
                Some(word) => self.number(keyword, word)?,
                // The second texture coordinate may be left out.
                None if keyword.text == "vt" && index == 1 => 0.0,
                None => {
                    let message =
                        format!("`{}` needs {count} numbers, but has {}", keyword.text, values.len());
                    return Err(self
                        .trouble(keyword.span.clone(), message)
                        .help(format!("write them on the same line, as in `{} 0 0.5 1`", keyword.text)));
                }
            };
            self.lines.clean.push_str(&format!(" {number:?}"));
        }
        self.lines.clean.push('\n');
        Ok(())
    }

    fn number(&self, keyword: &Word, word: &Word) -> Result<f32, LoadError> {
        let number = word.text.parse::<f32>();
        // Accept a normal without a direction: all normals of the mesh are dropped later.
        if let Ok(number) = number
            && (number.is_finite() || keyword.text == "vn")
        {
            return Ok(number);
        }
        let message = match number {
            Ok(_) => format!("{} is not a finite number", quote(word.text)),
            Err(_) => format!("{} is not a number", quote(word.text)),
        };
        Err(self.trouble(word.span.clone(), message).help(if word.text.contains(',') {
            "write a decimal point, not a comma, and blanks between numbers"
        } else {
            "replace it by a number below 3e38"
        }))
    }

    /// Checks and copies `f 1/1/1 2/2/1 3/3/1`.
    fn face(&mut self, keyword: &Word, corners: &[Word]) -> Result<(), LoadError> {
        if corners.len() < 3 {
            let noun = if corners.len() == 1 { "corner" } else { "corners" };
            return Err(self
                .trouble(keyword.span.clone(), format!("a face with {} {noun}", corners.len()))
                .help("name at least three vertices, as in `f 1 2 3`, or remove the line"));
        }
        self.lines.clean.push('f');
        for corner in corners {
            self.corner(corner)?;
            self.lines.clean.push(' ');
            self.lines.clean.push_str(corner.text);
        }
        self.lines.clean.push('\n');
        self.lines.faces += 1;
        Ok(())
    }

    /// Checks `1`, `1/2`, `1//3` or `1/2/3`.
    fn corner(&self, corner: &Word) -> Result<(), LoadError> {
        let tables = [
            ("vertex", "vertices", self.lines.vertices),
            ("texture coordinate", "texture coordinates", self.lines.texture_coordinates),
            ("normal", "normals", self.lines.normals),
        ];
        let malformed = || {
            self.trouble(corner.span.clone(), format!("{} is not a corner of a face", quote(corner.text)))
                .help(
                    "write a corner as `1`, `1/2`, `1//3` or `1/2/3`: vertex, texture coordinate and normal",
                )
        };
        let parts: Vec<&str> = corner.text.split('/').collect();
        if parts.len() > tables.len() || parts[0].is_empty() {
            return Err(malformed());
        }

        let mut start = corner.span.start;
        for (part, (one, many, count)) in parts.into_iter().zip(tables) {
            let span = start..start + part.len();
            start = span.end + 1;
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| malformed())?;
            let count = count as i64;
            // Negative indices count back from the line of the face: -1 is the last vertex above it.
            if (1..=count).contains(&index) || (-count..=-1).contains(&index) {
                continue;
            }
            let message = match count {
                0 => format!("the face names {one} {index}, but there are no {many} above it"),
                1 => format!("the face names {one} {index}, but there is only {one} 1 above it"),
                _ => format!("the face names {one} {index}, but the {many} above it are 1 to {count}"),
            };
            return Err(self.trouble(span, message).help(match index {
                0 => "indices count from 1 here: add 1 to each if they were counted from 0".into(),
                _ => format!("correct the index, or move the {many} above the faces that name them"),
            }));
        }
        Ok(())
    }

    fn use_material(&mut self, keyword: &Word, end: usize) -> Result<(), LoadError> {
        let span = self.rest(keyword, end, "name a material, as in `usemtl red`")?;
        let name = &self.text[span];
        if self.names.insert(name) {
            self.lines.material_names.push(one_line(name));
        }
        self.lines.clean.push_str(&format!("usemtl {}\n", one_line(name)));
        Ok(())
    }

    /// The byte range of everything after a keyword. Names may contain blanks.
    fn rest(&self, keyword: &Word, end: usize, help: &str) -> Result<Range<usize>, LoadError> {
        let rest = &self.text[keyword.span.end..end];
        let start = keyword.span.end + (rest.len() - rest.trim_start().len());
        if rest.trim().is_empty() {
            let message = format!("`{}` without a name", keyword.text);
            return Err(self.trouble(keyword.span.clone(), message).help(help));
        }
        Ok(start..start + rest.trim().len())
    }

    /// Fails only if a keyword looks like a misspelt one, because the format has many keywords that a mesh
    /// does not need.
    fn check_keyword(&self, keyword: &Word) -> Result<(), LoadError> {
        match nearest(keyword.text, LONG_KEYWORDS) {
            Some(meant) if meant != keyword.text && !keyword.text.starts_with('#') => Err(self
                .trouble(
                    keyword.span.clone(),
                    format!("{} is not a keyword of OBJ files", quote(keyword.text)),
                )
                .help(format!("did you mean `{meant}`?"))),
            _ => Ok(()),
        }
    }
}

/// A name without line breaks, which only a backslash can bring in and which would end its line for `tobj`.
fn one_line(name: &str) -> String {
    name.replace(['\n', '\r'], " ")
}
