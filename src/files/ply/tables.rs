//! From the elements `vertex` and `face` to the tables of a mesh.

use super::body::{Body, NumberLocation};
use super::header::{Element, Header, Kind, Property};
use super::scalar::Scalar;
use super::text::trouble_at;
use crate::files::error::{LoadError, Warnings};
use crate::files::words::nearest;
use crate::geometry::triangulate::{self, Cut};
use crate::mesh::Mesh;
use glam::{DVec2, DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::path::Path;

/// What has been read of a mesh.
#[derive(Default)]
pub(super) struct Tables {
    /// Triangles, normals and texture coordinates. A normal of zero stands for one without a direction.
    pub mesh: Mesh,
    /// The position of each vertex; it may be NaN or infinite.
    pub positions: Vec<DVec3>,
    /// The faces with more than three corners, which were read as fans.
    polygons: Vec<Polygon>,
    pub warnings: Warnings,
    /// Why the first face or vertex that is left out cannot be used.
    pub refused: Option<LoadError>,
    /// The same for the first vertex that is not at a finite position.
    infinite_vertex: Option<LoadError>,
}

/// The positions in the file of the numbers that make a mesh. All other numbers are skipped.
pub(super) struct Layout {
    /// The number of vertices that the header promises. Faces may come before vertices, and their indices are
    /// checked against this number.
    pub vertex_count: usize,
    /// For each property of a vertex its number's place in the row `x y z nx ny nz u v`, if it has one there.
    row: Vec<Option<usize>>,
    has_normals: bool,
    has_uvs: bool,
    /// The property of a face that lists its corners.
    corners: usize,
}

/// The names of texture coordinates: one pair for each tool that writes PLY files.
const UV_NAMES: [[&str; 2]; 3] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]];
const CORNER_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];

impl Layout {
    /// Finds the properties of vertices and faces in the header; fails if an element, a coordinate or the
    /// list of vertex indices is missing, or if there are more vertices than `u32::MAX`.
    ///
    /// Warns of colours and of texture coordinates of faces, which are ignored.
    pub fn of(
        file: &Path,
        bytes: &[u8],
        header: &Header,
        warnings: &mut Warnings,
    ) -> Result<Layout, LoadError> {
        let missing = Missing { file, bytes, header };
        let vertex =
            missing.element("vertex", "a mesh needs a line `element vertex` with its number of vertices")?;
        let face = missing.element(
            "face",
            if header.elements.iter().any(|e| e.name == "tristrips") {
                "triangle strips are not read: export the mesh with faces"
            } else {
                "vertices alone are a cloud of points: export the mesh with faces"
            },
        )?;
        if vertex.count > u32::MAX as usize {
            let message = format!("{} vertices are more than a mesh can number", vertex.count);
            return Err(missing
                .trouble(vertex.span.clone(), message)
                .help("divide the mesh into several files"));
        }

        const IGNORED: [(&str, &str, &str); 2] = [
            ("red", "colours are ignored", "give the shape a material with a `texture`, which is shown"),
            (
                "texcoord",
                "the texture coordinates of faces are ignored",
                "export the mesh with texture coordinates of vertices, `s` and `t`",
            ),
        ];
        for (name, message, help) in IGNORED {
            let mut properties = vertex.properties.iter().chain(&face.properties);
            // Some tools write `diffuse_red`.
            if let Some(property) = properties.find(|property| property.name.ends_with(name)) {
                warnings.add(help, || missing.trouble(property.span.clone(), message.into()));
            }
        }

        let names_number = |name: &str| {
            let known = vertex.properties.iter().find(|property| property.name == name);
            known.is_some_and(|property| matches!(property.kind, Kind::One(_)))
        };
        for axis in ["x", "y", "z"] {
            if !names_number(axis) {
                return Err(missing.axis(vertex, axis));
            }
        }
        let has_normals = ["nx", "ny", "nz"].into_iter().all(names_number);
        let uvs = UV_NAMES.into_iter().find(|pair| pair.iter().all(|name| names_number(name)));
        let [u, v] = uvs.unwrap_or(["u", "v"]);
        let columns = ["x", "y", "z", "nx", "ny", "nz", u, v];
        Ok(Layout {
            vertex_count: vertex.count,
            row: vertex
                .properties
                .iter()
                .map(|property| match property.kind {
                    Kind::One(_) => columns.iter().position(|column| *column == property.name),
                    Kind::List { .. } => None,
                })
                .collect(),
            has_normals,
            has_uvs: uvs.is_some(),
            corners: missing.corners(face)?,
        })
    }

    /// Reads all vertices of `element` into the positions, normals and texture coordinates of `tables`; fails if a number
    /// is missing or malformed.
    pub fn vertices(&self, body: &mut Body, element: &Element, tables: &mut Tables) -> Result<(), LoadError> {
        let expected = body.at_most(element.count, element.properties.len());
        tables.positions.reserve(expected);
        tables.mesh.normals.reserve(if self.has_normals { expected } else { 0 });
        tables.mesh.uvs.reserve(if self.has_uvs { expected } else { 0 });

        let Some(property) = element.properties.last() else { return Ok(()) };
        let mut row = [0.0; 8];
        for number in 0..element.count {
            for (property, column) in element.properties.iter().zip(&self.row) {
                let place = NumberLocation { element, number, property };
                match (*column, property.kind) {
                    (Some(column), Kind::One(scalar)) => row[column] = body.value(scalar, place)?,
                    _ => body.skip(place)?,
                }
            }

            let [x, y, z, nx, ny, nz, u, v] = row;
            let place = NumberLocation { element, number, property };
            let position = DVec3::new(x, y, z);
            if !position.as_vec3().is_finite() {
                tables.infinite_vertex.get_or_insert_with(|| {
                    body.trouble(
                        place,
                        format!("vertex {number} is at {}, which is not finite", position.as_vec3()),
                    )
                    .help("export the mesh again: each x, y and z has to be a number below 3e38")
                });
            }
            tables.positions.push(position);
            if self.has_normals {
                let unit = DVec3::new(nx, ny, nz).try_normalize();
                if unit.is_none() {
                    let help = "export the mesh with normals of unit length, or without normals";
                    let message =
                        format!("the normal of vertex {number} has no direction; faces have their own");
                    tables.warnings.add(help, || body.trouble(place, message));
                }
                tables.mesh.normals.push(unit.unwrap_or_default().as_vec3());
            }
            if self.has_uvs {
                let uv = DVec2::new(u, v).as_vec2();
                if !uv.is_finite() {
                    let help = "write finite numbers for the texture coordinates";
                    let message =
                        format!("vertex {number} has texture coordinates that are not finite; 0.5 is used");
                    tables.warnings.add(help, || body.trouble(place, message));
                }
                tables.mesh.uvs.push(if uv.is_finite() { uv } else { Vec2::splat(0.5) });
            }
        }
        Ok(())
    }

    /// Reads all faces of `element` into the triangles of `tables`; a face with more than three corners becomes
    /// a fan of triangles around its first corner. A face with fewer than three corners, or with an index that names no
    /// vertex, is left out.
    pub fn faces(&self, body: &mut Body, element: &Element, tables: &mut Tables) -> Result<(), LoadError> {
        tables.mesh.triangles.reserve(body.at_most(element.count, 4 * element.properties.len()));
        for number in 0..element.count {
            for (index, property) in element.properties.iter().enumerate() {
                let place = NumberLocation { element, number, property };
                match property.kind {
                    Kind::List { length, item } if index == self.corners => {
                        self.face(body, place, length, item, tables)?;
                    }
                    _ => body.skip(place)?,
                }
            }
        }
        Ok(())
    }

    /// Reads one face as a fan.
    fn face(
        &self,
        body: &mut Body,
        place: NumberLocation,
        length: Scalar,
        item: Scalar,
        tables: &mut Tables,
    ) -> Result<(), LoadError> {
        let corners = body.length(length, place)?;
        let byte = body.last_byte();
        if corners < 3 {
            let noun = if corners == 1 { "corner" } else { "corners" };
            let message = format!("face {} has {corners} {noun}", place.number);
            tables.leave_out("give it at least three corners, or remove it", || body.trouble(place, message));
        }
        body.check_left(corners, item, place)?;

        // Cut the face into a fan: the first corner makes a triangle with each edge that does not touch it.
        let first = tables.mesh.triangles.len();
        let (mut start, mut previous, mut is_whole) = (0, 0, true);
        for corner in 0..corners {
            let Some(next) = self.corner(body, place, item, tables)? else {
                is_whole = false;
                continue;
            };
            match corner {
                0 => start = next,
                1 => {}
                _ => tables.mesh.triangles.push([start, previous, next]),
            }
            previous = next;
        }
        if !is_whole {
            tables.mesh.triangles.truncate(first);
        }
        let triangles = tables.mesh.triangles.len() - first;
        if triangles > 1 {
            tables.polygons.push(Polygon { first, triangles, number: place.number, byte });
        }
        Ok(())
    }

    /// One index of a vertex; `None` if there is no such vertex, so that the face is left out.
    fn corner(
        &self,
        body: &mut Body,
        place: NumberLocation,
        item: Scalar,
        tables: &mut Tables,
    ) -> Result<Option<u32>, LoadError> {
        let index = body.value(item, place)?;
        // Accept indices that are written as floats, if they are whole numbers in range. The test is false for NaN.
        if 0.0 <= index && index < self.vertex_count as f64 && index.fract() == 0.0 {
            return Ok(Some(index as u32));
        }
        let error = || {
            let there_are = match self.vertex_count {
                0 => "there are no vertices".into(),
                1 => "there is only vertex 0".into(),
                count => format!("the vertices are 0 to {}", count - 1),
            };
            body.trouble(place, format!("face {} names vertex {index}, but {there_are}", place.number))
        };
        let help = if index == self.vertex_count as f64 {
            "vertices count from 0 here; if the face was written by hand, subtract 1 from each of its indices"
        } else {
            "correct the index, or look above it for a row with a number too few or too many"
        };
        tables.leave_out(help, error);
        Ok(None)
    }
}

/// A face with more than three corners, which was read as a fan.
struct Polygon {
    /// The index of its first triangle in the mesh.
    first: usize,
    /// The number of its triangles.
    triangles: usize,
    /// Which face it is, counted from 0.
    number: usize,
    /// The byte of the file at which it starts.
    byte: usize,
}

impl Tables {
    /// Adds a warning that a face is left out.
    fn leave_out(&mut self, help: &str, error: impl FnOnce() -> LoadError) {
        let refused = &mut self.refused;
        self.warnings.add(help, || {
            let error = error();
            refused.get_or_insert_with(|| error.clone().help(help));
            LoadError { message: format!("{}; the face is left out", error.message), ..error }
        });
    }

    /// Replaces the fans of concave polygons by triangles that cover the polygon, now that all vertices are known: faces may
    /// come before vertices. Warns if the outline of a polygon crosses itself.
    pub fn cut_polygons(&mut self, body: &Body) {
        for polygon in &self.polygons {
            let fan = &mut self.mesh.triangles[polygon.first..][..polygon.triangles];
            let last_corners = fan.iter().skip(1).map(|last| last[2]);
            let outline: Vec<u32> = fan[0].into_iter().chain(last_corners).collect();
            // Compute from the first corner, because positions may be far away.
            let first = self.positions[outline[0] as usize];
            let positions: Vec<Vec3> =
                outline.iter().map(|&vertex| (self.positions[vertex as usize] - first).as_vec3()).collect();
            match triangulate::cut(&positions) {
                Cut::Triangles(triangles) => {
                    for (old, new) in fan.iter_mut().zip(triangles) {
                        *old = new.map(|corner| outline[corner]);
                    }
                }
                Cut::Fan => {}
                Cut::Crossed => {
                    let number = polygon.number;
                    let message =
                        format!("the outline of face {number} crosses itself, so its triangles are a guess");
                    let help = "list the corners of each face in order around it, or export triangles";
                    self.warnings.add(help, || body.trouble_at(polygon.byte, message));
                }
            }
        }
    }

    /// Leaves out triangles with a corner that is not at a finite position, with a warning.
    pub fn leave_out_infinite_faces(&mut self) {
        let Some(error) = self.infinite_vertex.take() else { return };
        let before = self.mesh.triangles.len();
        let is_finite = |vertex: &u32| self.positions[*vertex as usize].as_vec3().is_finite();
        self.mesh.triangles.retain(|triangle| triangle.iter().all(is_finite));
        if self.mesh.triangles.len() < before {
            let message = format!("{}; its faces are left out", error.message);
            let help = error.help.clone().unwrap_or_default();
            self.warnings.add(&help, || LoadError { message, ..error.clone() });
            self.refused.get_or_insert(error);
        }
    }

    /// For each vertex the number of its position, if the file has normals or texture coordinates: then vertices at the
    /// same position are repeated because of them.
    pub fn places(&self) -> Vec<u32> {
        if self.mesh.normals.is_empty() && self.mesh.uvs.is_empty() {
            return Vec::new();
        }
        let mut numbers = HashMap::new();
        // The sum turns -0 into 0.
        let key = |position: &DVec3| (*position + 0.0).to_array().map(f64::to_bits);
        let place = |(vertex, position)| *numbers.entry(key(position)).or_insert(vertex as u32);
        self.positions.iter().enumerate().map(place).collect()
    }
}

/// Makes the errors for a header that lacks something.
struct Missing<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    header: &'a Header,
}

impl<'a> Missing<'a> {
    fn trouble(&self, span: std::ops::Range<usize>, message: String) -> LoadError {
        trouble_at(self.file, self.bytes, span, message)
    }

    fn element(&self, name: &'static str, help: &str) -> Result<&'a Element, LoadError> {
        let elements = &self.header.elements;
        if let Some(element) = elements.iter().find(|element| element.name == name) {
            return Ok(element);
        }
        let message = format!("the header declares no element `{name}`");
        let near = elements.iter().find(|element| nearest(&element.name, [name]).is_some());
        Err(match near {
            Some(element) => {
                self.trouble(element.span.clone(), message).help(format!("did you mean `{name}`?"))
            }
            None => LoadError::new(self.file, message).help(help),
        })
    }

    fn axis(&self, vertex: &Element, axis: &str) -> LoadError {
        let property = vertex.properties.iter().find(|property| property.name.eq_ignore_ascii_case(axis));
        let (span, help) = match property {
            Some(Property { kind: Kind::List { .. }, span, .. }) => {
                (span, format!("make `{axis}` a number, not a list"))
            }
            Some(Property { name, span, .. }) => {
                (span, format!("did you mean `{axis}` instead of `{name}`?"))
            }
            None => {
                (&vertex.span, format!("add a line `property float {axis}` and the number to each vertex"))
            }
        };
        self.trouble(span.clone(), format!("a vertex has no number `{axis}`")).help(help)
    }

    fn corners(&self, face: &Element) -> Result<usize, LoadError> {
        let known = CORNER_NAMES.iter().find_map(|name| face.properties.iter().position(|p| p.name == *name));
        let near = || face.properties.iter().position(|p| nearest(&p.name, CORNER_NAMES).is_some());
        let (span, help) = match (known, near()) {
            (Some(index), _) if matches!(face.properties[index].kind, Kind::List { .. }) => return Ok(index),
            (Some(index), _) => (
                &face.properties[index].span,
                "make it a list, as in `property list uchar int vertex_indices`",
            ),
            (None, Some(index)) => (&face.properties[index].span, "did you mean `vertex_indices`?"),
            (None, None) => (&face.span, "add a line `property list uchar int vertex_indices` to the faces"),
        };
        Err(self.trouble(span.clone(), "a face has no list `vertex_indices`".into()).help(help))
    }
}
