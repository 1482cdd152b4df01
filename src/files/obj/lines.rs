//! The lines of an OBJ file, checked one by one.

use super::DEFAULT_MATERIAL;
use crate::files::error::LoadError;
use crate::files::ply::text::{Word, nearest, quote, words};
use crate::geometry::triangulate::{self, Cut};
use glam::Vec3;
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
    /// The byte range of each of these names, where it stands first.
    pub material_spans: Vec<Range<usize>>,
    /// Byte ranges of the text after each `mtllib`, which is one file name or several.
    pub libraries: Vec<Range<usize>>,
    /// What was ignored or guessed, each kind once with its first place.
    pub warnings: Vec<LoadError>,
    texture_coordinates: usize,
    normals: usize,
}

/// The keywords that are long enough to be misspelt, and the similar keywords of the format.
const LONG_KEYWORDS: [&str; 4] = ["usemtl", "mtllib", "usemap", "maplib"];

/// Checks all lines of `text` and returns their content; fails at the first line that is malformed or that
/// names a vertex, texture coordinate or normal that is not above it.
pub(super) fn read(file: &Path, text: &str) -> Result<Lines, LoadError> {
    let mut reader = Reader {
        file,
        text,
        lines: Lines::default(),
        names: HashSet::new(),
        without_uv: Repeated::default(),
        without_normal: Repeated::default(),
        unnamed: Repeated::default(),
        crossed: Repeated::default(),
        positions: Vec::new(),
    };
    // `tobj` gets one library, which stands for all names of materials.
    reader.lines.clean.push_str("mtllib all\n");
    for line in logical_lines(text) {
        reader.line(line)?;
    }
    reader.warn_of_repeated();
    Ok(reader.lines)
}

/// Something that may be wrong on every line: one warning at its first place says how often.
#[derive(Default)]
struct Repeated {
    first: Option<Range<usize>>,
    count: usize,
}

impl Repeated {
    fn add(&mut self, span: Range<usize>) {
        self.first.get_or_insert(span);
        self.count += 1;
    }
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
    without_uv: Repeated,
    without_normal: Repeated,
    unnamed: Repeated,
    crossed: Repeated,
    positions: Vec<Vec3>,
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
                let position = self.numbers(&keyword, values, 3)?;
                self.positions.push(position);
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
            "usemtl" => self.use_material(&keyword, line.end),
            "mtllib" => match self.rest(&keyword, line.end) {
                Some(names) => self.lines.libraries.push(names),
                None => {
                    let warning = self
                        .trouble(keyword.span.clone(), "`mtllib` without a name; the line is ignored")
                        .help("name a file, as in `mtllib box.mtl`");
                    self.lines.warnings.push(warning);
                }
            },
            // Points and lines have no surface; objects, groups and smoothing do not affect one set of triangles.
            _ => self.check_keyword(&keyword)?,
        }
        Ok(())
    }

    /// Copies and returns the numbers of a `v`, `vt` or `vn` line, at most three.
    fn numbers(&mut self, keyword: &Word, values: &[Word], count: usize) -> Result<Vec3, LoadError> {
        let mut numbers = Vec3::ZERO;
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
            numbers[index] = number;
        }
        self.lines.clean.push('\n');
        Ok(numbers)
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
        let checked: Vec<(usize, String)> =
            corners.iter().map(|corner| self.corner(corner)).collect::<Result<_, _>>()?;
        // Cut the polygon here, because `tobj` cuts concave ones into a fan as well.
        let outline: Vec<Vec3> = checked.iter().map(|(vertex, _)| self.positions[*vertex]).collect();
        match triangulate::cut(&outline) {
            Cut::Triangles(triangles) => {
                triangles.iter().for_each(|triangle| self.push_face(triangle.iter().map(|&i| &checked[i])));
            }
            Cut::Fan => self.push_face(checked.iter()),
            Cut::Crossed => {
                self.crossed.add(keyword.span.clone());
                self.push_face(checked.iter());
            }
        }
        self.lines.faces += 1;
        Ok(())
    }

    fn push_face<'c>(&mut self, corners: impl Iterator<Item = &'c (usize, String)>) {
        self.lines.clean.push('f');
        for (_, corner) in corners {
            self.lines.clean.push(' ');
            self.lines.clean.push_str(corner);
        }
        self.lines.clean.push('\n');
    }

    /// Checks `1`, `1/2`, `1//3` or `1/2/3`. Returns the index of the vertex, counted from 0, and the corner without
    /// indices into tables that the file does not have.
    fn corner(&mut self, corner: &Word) -> Result<(usize, String), LoadError> {
        let tables = [
            ("vertex", "vertices", self.lines.vertices),
            ("texture coordinate", "texture coordinates", self.lines.texture_coordinates),
            ("normal", "normals", self.lines.normals),
        ];
        let malformed = |reader: &Self| {
            reader
                .trouble(corner.span.clone(), format!("{} is not a corner of a face", quote(corner.text)))
                .help(
                    "write a corner as `1`, `1/2`, `1//3` or `1/2/3`: vertex, texture coordinate and normal",
                )
        };
        let parts: Vec<&str> = corner.text.split('/').collect();
        if parts.len() > tables.len() || parts[0].is_empty() {
            return Err(malformed(self));
        }

        let (mut vertex, mut clean) = (0, String::with_capacity(corner.text.len()));
        let mut start = corner.span.start;
        for (place, (part, (one, many, count))) in parts.into_iter().zip(tables).enumerate() {
            let span = start..start + part.len();
            start = span.end + 1;
            if place > 0 {
                clean.push('/');
            }
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| malformed(self))?;
            let count = count as i64;
            // Negative indices count back from the line of the face: -1 is the last vertex above it.
            if (1..=count).contains(&index) || (-count..=-1).contains(&index) {
                clean.push_str(part);
                if place == 0 {
                    vertex = if index > 0 { index - 1 } else { count + index } as usize;
                }
                continue;
            }
            match place {
                1 if count == 0 => self.without_uv.add(span),
                2 if count == 0 => self.without_normal.add(span),
                _ => return Err(self.no_such_index(span, index, count, one, many)),
            }
        }
        Ok((vertex, clean))
    }

    fn no_such_index(&self, span: Range<usize>, index: i64, count: i64, one: &str, many: &str) -> LoadError {
        let message = match count {
            0 => format!("the face names {one} {index}, but there are no {many} above it"),
            1 => format!("the face names {one} {index}, but there is only {one} 1 above it"),
            _ => format!("the face names {one} {index}, but the {many} above it are 1 to {count}"),
        };
        self.trouble(span, message).help(match index {
            0 => "indices count from 1 here: add 1 to each if they were counted from 0".into(),
            _ => format!("correct the index, or move the {many} above the faces that name them"),
        })
    }

    fn use_material(&mut self, keyword: &Word, end: usize) {
        let (name, span) = match self.rest(keyword, end) {
            Some(span) => (&self.text[span.clone()], span),
            None => {
                self.unnamed.add(keyword.span.clone());
                // Above the first name, the faces have no material anyway.
                if self.lines.material_names.is_empty() {
                    return;
                }
                (DEFAULT_MATERIAL, keyword.span.clone())
            }
        };
        if self.names.insert(name) {
            self.lines.material_names.push(one_line(name));
            self.lines.material_spans.push(span);
        }
        self.lines.clean.push_str(&format!("usemtl {}\n", one_line(name)));
    }

    /// Turns what was counted into one warning of each kind.
    fn warn_of_repeated(&mut self) {
        let indices = |what: &str| {
            (
                format!("a face names a {what}, but there are no {what}s above it; the index is ignored"),
                format!("export the mesh with {what}s, or without their indices"),
            )
        };
        let crossed = "the outline of a face crosses itself, so its triangles are a guess".to_owned();
        let crossed_help = "list the corners of each face in order around it, or export triangles".to_owned();
        let (uv, uv_help) = indices("texture coordinate");
        let (normal, normal_help) = indices("normal");
        let unnamed = "`usemtl` without a name; the faces below it get the material `default`".to_owned();
        let unnamed_help = "name a material, as in `usemtl red`".to_owned();
        for (repeated, message, help) in [
            (std::mem::take(&mut self.without_uv), uv, uv_help),
            (std::mem::take(&mut self.without_normal), normal, normal_help),
            (std::mem::take(&mut self.unnamed), unnamed, unnamed_help),
            (std::mem::take(&mut self.crossed), crossed, crossed_help),
        ] {
            let Some(first) = repeated.first else { continue };
            let more = match repeated.count {
                1 => String::new(),
                count => format!(" (here first, {count} times in the file)"),
            };
            let warning = self.trouble(first, format!("{message}{more}")).help(help);
            self.lines.warnings.push(warning);
        }
    }

    /// The byte range of everything after a keyword, if there is anything. Names may contain blanks.
    fn rest(&self, keyword: &Word, end: usize) -> Option<Range<usize>> {
        let rest = &self.text[keyword.span.end..end];
        let start = keyword.span.end + (rest.len() - rest.trim_start().len());
        (!rest.trim().is_empty()).then(|| start..start + rest.trim().len())
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
