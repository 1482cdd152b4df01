//! The lines of an OBJ file, checked one by one.

use super::DEFAULT_MATERIAL;
use crate::files::error::{LoadError, Warnings};
use crate::files::ply::text::{Word, number, words};
use crate::files::words::{nearest, quoted};
use crate::geometry::triangulate::{self, Cut};
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

/// The content of an OBJ file, without the lines that were left out.
#[derive(Debug, Default)]
pub(super) struct Lines {
    /// All `v` lines. A position that is not finite is named by no triangle.
    pub positions: Vec<DVec3>,
    /// All `vt` lines, without a third number. Those that are not finite are named by no triangle.
    pub uvs: Vec<Vec2>,
    /// All `vn` lines, of unit length. Zeros stand for normals without a direction, which are named by no triangle.
    pub normals: Vec<Vec3>,
    /// All faces, cut into triangles.
    pub triangles: Vec<Triangle>,
    /// The names after `usemtl`, each once and in order of first use.
    pub material_names: Vec<String>,
    /// The byte range of each of these names, where it stands first.
    pub material_spans: Vec<Range<usize>>,
    /// Byte ranges of the text after each `mtllib`: file names, and perhaps a comment.
    pub libraries: Vec<Range<usize>>,
}

/// A triangle of a face.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    /// The corners in the order of the face.
    pub corners: [Corner; 3],
    /// The index of its material in [`Lines::material_names`], if a `usemtl` line stands above it.
    pub material: Option<u32>,
    /// The number of its smoothing group: 0 for a flat face, 1 if no `s` line stands above it, and from 2 the groups of the
    /// file in order of first use.
    pub group: u32,
}

/// Indices into the tables of [`Lines`], counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub position: u32,
    pub uv: Option<u32>,
    pub normal: Option<u32>,
}

/// The keywords that are long enough to be misspelt, and the similar keywords of the format.
const LONG_KEYWORDS: [&str; 4] = ["usemtl", "mtllib", "usemap", "maplib"];

/// Checks all lines of `text` and returns their content. What cannot be used and is not needed is left out, with a
/// warning. Fails at the first line that is malformed, and if no face is left.
pub(super) fn read(file: &Path, text: &str, warnings: &mut Warnings) -> Result<Lines, LoadError> {
    let mut reader = Reader {
        file,
        text,
        lines: Lines::default(),
        warnings,
        names: HashMap::new(),
        groups: HashMap::new(),
        material: None,
        group: 1,
        bare_corner: None,
        refused: None,
    };
    for line in logical_lines(text) {
        reader.line(line)?;
    }
    if reader.lines.triangles.is_empty()
        && let Some(error) = reader.refused
    {
        return Err(error);
    }
    reader.warn_of_bare_corners();
    Ok(reader.lines)
}

/// The byte ranges of the lines of a file. A line that ends in a backslash continues in the next one, unless
/// it is a comment or a name: these may end in the name of a Windows directory.
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
            let is_name = ["#", "o ", "g ", "usemtl "].iter().any(|start| line.starts_with(start));
            if end == text.len() || is_name || !line.ends_with('\\') {
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
    warnings: &'a mut Warnings,
    /// The number of each name after `usemtl`.
    names: HashMap<String, u32>,
    /// The number of each name after `s`.
    groups: HashMap<&'a str, u32>,
    /// The material and the smoothing group of the faces below.
    material: Option<u32>,
    group: u32,
    /// The first corner that names no normal.
    bare_corner: Option<Range<usize>>,
    /// Why the first face that was left out cannot be used.
    refused: Option<LoadError>,
}

impl<'a> Reader<'a> {
    fn trouble(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    fn warn(&mut self, span: Range<usize>, message: &str, help: &str) {
        self.warnings.add(help, || LoadError::at(self.file, self.text, span, message));
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
            // A fourth number is the weight for free-form surfaces.
            "v" => {
                let position = self.numbers(&keyword, values, 3)?;
                if values.len() >= 6 {
                    let help = "give the faces a material with a `map_Kd` image, which is shown";
                    self.warn(values[3].span.clone(), "the colours of vertices are ignored", help);
                }
                self.lines.positions.push(position);
            }
            "vt" => {
                let uv = self.numbers(&keyword, values, 2)?.truncate().as_vec2();
                if !uv.is_finite() {
                    let help = "write a finite number";
                    let message = "a texture coordinate that is not finite is ignored";
                    self.warn(keyword.span, message, help);
                }
                self.lines.uvs.push(uv);
            }
            "vn" => {
                let unit = self.numbers(&keyword, values, 3)?.try_normalize();
                if unit.is_none() {
                    let help = "export the mesh with normals of unit length, or without normals";
                    let message = "a normal without a direction is ignored, as if its corners had none";
                    self.warn(keyword.span, message, help);
                }
                self.lines.normals.push(unit.unwrap_or_default().as_vec3());
            }
            "f" => self.face(&keyword, values)?,
            "s" => self.group = values.first().map_or(self.group, |name| self.smoothing_group(name)),
            "usemtl" => self.use_material(&keyword, line.end),
            "mtllib" => match name(self.text, keyword.span.end..line.end) {
                Some(name) => self.lines.libraries.push(name.start..line.end),
                None => self.warn(
                    keyword.span,
                    "`mtllib` without a name; the line is ignored",
                    "name a file, as in `mtllib box.mtl`",
                ),
            },
            // Points and lines have no surface; objects and groups do not affect one set of triangles.
            _ => self.check_keyword(&keyword)?,
        }
        Ok(())
    }

    /// The numbers of a `v`, `vt` or `vn` line, at most three; they may be NaN or infinite.
    fn numbers(&self, keyword: &Word, values: &[Word], count: usize) -> Result<DVec3, LoadError> {
        // The second texture coordinate may be left out.
        if values.len() < count && (keyword.text, values.len()) != ("vt", 1) {
            let message = format!("`{}` needs {count} numbers, but has {}", keyword.text, values.len());
            return Err(self
                .trouble(keyword.span.clone(), message)
                .help(format!("write them on the same line, as in `{} 0 0.5 1`", keyword.text)));
        }
        let mut numbers = DVec3::ZERO;
        for (index, word) in values.iter().take(count).enumerate() {
            numbers[index] = number(word.text).ok_or_else(|| {
                let error = self.trouble(word.span.clone(), format!("{} is not a number", quoted(word.text)));
                error.help(if word.text.contains(',') {
                    "write a decimal point, not a comma, and blanks between numbers"
                } else {
                    "replace it by a number below 3e38"
                })
            })?;
        }
        Ok(numbers)
    }

    /// The number of a smoothing group: 0 for `off` and `0`.
    fn smoothing_group(&mut self, name: &Word<'a>) -> u32 {
        let next = self.groups.len() as u32 + 2;
        match name.text {
            "off" | "0" => 0,
            name => *self.groups.entry(name).or_insert(next),
        }
    }

    /// Checks `f 1/1/1 2/2/1 3/3/1` and cuts it into triangles. A face that cannot be used is left out.
    fn face(&mut self, keyword: &Word, words: &[Word]) -> Result<(), LoadError> {
        if words.len() < 3 {
            let noun = if words.len() == 1 { "corner" } else { "corners" };
            self.leave_out(
                keyword.span.clone(),
                format!("a face with {} {noun}", words.len()),
                "name at least three vertices, as in `f 1 2 3`, or remove the line",
            );
            return Ok(());
        }
        let mut corners = Vec::with_capacity(words.len());
        for word in words {
            match self.corner(word)? {
                Some(corner) => corners.push(corner),
                None => return Ok(()),
            }
        }
        // Compute from the first corner, because positions may be far away.
        let positions = corners.iter().map(|corner| self.lines.positions[corner.position as usize]);
        let first = self.lines.positions[corners[0].position as usize];
        let outline: Vec<Vec3> = positions.map(|position| (position - first).as_vec3()).collect();
        let triangles = match triangulate::cut(&outline) {
            Cut::Triangles(triangles) => triangles,
            Cut::Fan => triangulate::fan(corners.len()).collect(),
            Cut::Crossed => {
                let help = "list the corners of each face in order around it, or export triangles";
                let message = "the outline of a face crosses itself, so its triangles are a guess";
                self.warn(keyword.span.clone(), message, help);
                triangulate::fan(corners.len()).collect()
            }
        };
        let (material, group) = (self.material, self.group);
        let triangle =
            |indices: [usize; 3]| Triangle { corners: indices.map(|i| corners[i]), material, group };
        self.lines.triangles.extend(triangles.into_iter().map(triangle));
        Ok(())
    }

    /// Leaves out a face, with a warning.
    fn leave_out(&mut self, span: Range<usize>, message: String, help: &str) {
        self.refused.get_or_insert_with(|| {
            LoadError::at(self.file, self.text, span.clone(), message.clone()).help(help)
        });
        self.warn(span, &format!("{message}; the face is left out"), help);
    }

    /// Checks `1`, `1/2`, `1//3` or `1/2/3`. `None` if the face has to be left out, because there is no such position.
    fn corner(&mut self, corner: &Word) -> Result<Option<Corner>, LoadError> {
        let tables = [
            ("vertex", "vertices", self.lines.positions.len()),
            ("texture coordinate", "texture coordinates", self.lines.uvs.len()),
            ("normal", "normals", self.lines.normals.len()),
        ];
        let malformed = |reader: &Self| {
            reader
                .trouble(corner.span.clone(), format!("{} is not a corner of a face", quoted(corner.text)))
                .help(
                    "write a corner as `1`, `1/2`, `1//3` or `1/2/3`: vertex, texture coordinate and normal",
                )
        };
        let parts: Vec<&str> = corner.text.split('/').collect();
        if parts.len() > tables.len() || parts[0].is_empty() {
            return Err(malformed(self));
        }

        let mut indices = [None; 3];
        let mut start = corner.span.start;
        for (place, (part, (one, many, count))) in parts.into_iter().zip(tables).enumerate() {
            let span = start..start + part.len();
            start = span.end + 1;
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| malformed(self))?;
            let count = count as i64;
            // Negative indices count back from the line of the face: -1 is the last vertex above it.
            match index {
                _ if (1..=count).contains(&index) => indices[place] = Some((index - 1) as u32),
                _ if (-count..=-1).contains(&index) => indices[place] = Some((count + index) as u32),
                _ if place > 0 => {
                    let help = format!("export the mesh with {many}, or without their indices");
                    let message = format!("{}; the index is ignored", no_such_index(index, count, one, many));
                    self.warn(span, &message, &help);
                }
                // All other indices of such a file are off by one as well, so nothing can be shown.
                0 => {
                    let help = "indices count from 1 here: add 1 to each if they were counted from 0";
                    return Err(self.trouble(span, no_such_index(index, count, one, many)).help(help));
                }
                _ => {
                    let help = "correct the index, or move the vertices above the faces that name them";
                    self.leave_out(span, no_such_index(index, count, one, many), help);
                    return Ok(None);
                }
            }
        }
        let [Some(position), uv, normal] = indices else { return Err(malformed(self)) };
        if !self.lines.positions[position as usize].as_vec3().is_finite() {
            let message = format!("the position of vertex {} is not finite", position + 1);
            self.leave_out(corner.span.clone(), message, "replace it by numbers below 3e38");
            return Ok(None);
        }
        if corner.text.split('/').nth(2).is_none_or(str::is_empty) {
            self.bare_corner.get_or_insert(corner.span.clone());
        }
        let uv = uv.filter(|&uv| self.lines.uvs[uv as usize].is_finite());
        let normal = normal.filter(|&normal| self.lines.normals[normal as usize] != Vec3::ZERO);
        Ok(Some(Corner { position, uv, normal }))
    }

    fn use_material(&mut self, keyword: &Word, end: usize) {
        let (name, span) = match name(self.text, keyword.span.end..end) {
            Some(span) => (self.text[span.clone()].to_owned(), span),
            None => {
                let message = "`usemtl` without a name; the faces below it get the material `default`";
                self.warn(keyword.span.clone(), message, "name a material, as in `usemtl red`");
                // Above the first name, the faces have no material anyway.
                if self.lines.material_names.is_empty() {
                    return;
                }
                (DEFAULT_MATERIAL.to_owned(), keyword.span.clone())
            }
        };
        let next = self.lines.material_names.len() as u32;
        let number = *self.names.entry(name.clone()).or_insert(next);
        if number == next {
            self.lines.material_names.push(name);
            self.lines.material_spans.push(span);
        }
        self.material = Some(number);
    }

    /// Warns if some corners have normals and others name none.
    fn warn_of_bare_corners(&mut self) {
        let mut corners = self.lines.triangles.iter().flat_map(|triangle| triangle.corners);
        if let Some(first) = self.bare_corner.take()
            && corners.any(|corner| corner.normal.is_some())
        {
            let message = "this corner has no normal, but others have; it has the normal of its face";
            self.warn(first, message, "export the mesh with normals for all faces, or without normals");
        }
    }

    /// Fails only if a keyword looks like a misspelt one, because the format has many keywords that a mesh
    /// does not need.
    fn check_keyword(&self, keyword: &Word) -> Result<(), LoadError> {
        match nearest(keyword.text, LONG_KEYWORDS) {
            Some(meant) if meant != keyword.text && !keyword.text.starts_with('#') => Err(self
                .trouble(
                    keyword.span.clone(),
                    format!("{} is not a keyword of OBJ files", quoted(keyword.text)),
                )
                .help(format!("did you mean `{meant}`?"))),
            _ => Ok(()),
        }
    }
}

fn no_such_index(index: i64, count: i64, one: &str, many: &str) -> String {
    match count {
        0 => format!("the face names {one} {index}, but there are no {many} above it"),
        1 => format!("the face names {one} {index}, but there is only {one} 1 above it"),
        _ => format!("the face names {one} {index}, but the {many} above it are 1 to {count}"),
    }
}

/// The place of a name, which may contain blanks and ends at a comment. `None` if there is none.
///
/// `#` begins a comment at the start of a word, except before digits: 3ds Max calls materials `Material #25`.
pub(super) fn name(text: &str, place: Range<usize>) -> Option<Range<usize>> {
    let is_comment = |word: &Word| {
        let number = word.text.strip_prefix('#');
        number.is_some_and(|number| number.is_empty() || !number.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let words = words(&text[place.clone()], place.start);
    let n_words = words.iter().position(is_comment).unwrap_or(words.len());
    let (first, last) = (words[..n_words].first()?, words[..n_words].last()?);
    Some(first.span.start..last.span.end)
}
