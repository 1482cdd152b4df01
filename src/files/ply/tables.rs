//! From the elements `vertex` and `face` to the tables of a mesh.

use super::body::{Body, NumberLocation};
use super::header::{Element, Encoding, Header, Kind, Property};
use super::scalar::Scalar;
use super::text::{nearest, trouble_at};
use crate::files::error::LoadError;
use crate::geometry::triangulate::{self, Cut};
use crate::mesh::Mesh;
use glam::{Vec2, Vec3};
use std::path::Path;

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
    pub fn of(file: &Path, bytes: &[u8], header: &Header) -> Result<Layout, LoadError> {
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

    /// Reads all vertices of `element` into the positions, normals and texture coordinates of `mesh`, rounded
    /// to `f32`; fails if a number is missing or malformed.
    pub fn vertices(&self, body: &mut Body, element: &Element, mesh: &mut Mesh) -> Result<(), LoadError> {
        let expected = body.at_most(element.count, element.properties.len());
        mesh.positions.reserve(expected);
        mesh.normals.reserve(if self.has_normals { expected } else { 0 });
        mesh.uvs.reserve(if self.has_uvs { expected } else { 0 });

        let mut row = [0.0; 8];
        for number in 0..element.count {
            for (property, column) in element.properties.iter().zip(&self.row) {
                let place = NumberLocation { element, number, property };
                match (*column, property.kind) {
                    (Some(column), Kind::One(scalar)) => row[column] = body.value(scalar, place)? as f32,
                    _ => body.skip(place)?,
                }
            }

            let [x, y, z, nx, ny, nz, u, v] = row;
            mesh.positions.push(Vec3::new(x, y, z));
            if self.has_normals {
                mesh.normals.push(Vec3::new(nx, ny, nz));
            }
            if self.has_uvs {
                mesh.uvs.push(Vec2::new(u, v));
            }
        }
        Ok(())
    }

    /// Reads all faces of `element` into the triangles of `mesh`; a face with more than three corners becomes
    /// a fan of triangles around its first corner, and is added to `polygons`. Fails if a face has fewer than three
    /// corners or an index names no vertex.
    pub fn faces(
        &self,
        body: &mut Body,
        element: &Element,
        mesh: &mut Mesh,
        polygons: &mut Vec<Polygon>,
    ) -> Result<(), LoadError> {
        mesh.triangles.reserve(body.at_most(element.count, 4 * element.properties.len()));
        for number in 0..element.count {
            for (index, property) in element.properties.iter().enumerate() {
                let place = NumberLocation { element, number, property };
                match property.kind {
                    Kind::List { length, item } if index == self.corners => {
                        let first = mesh.triangles.len();
                        let byte = self.face(body, place, length, item, mesh)?;
                        let triangles = mesh.triangles.len() - first;
                        if triangles > 1 {
                            polygons.push(Polygon { first, triangles, number, byte });
                        }
                    }
                    _ => body.skip(place)?,
                }
            }
        }
        Ok(())
    }

    /// Reads one face as a fan, and returns the byte of the file at which it starts.
    fn face(
        &self,
        body: &mut Body,
        place: NumberLocation,
        length: Scalar,
        item: Scalar,
        mesh: &mut Mesh,
    ) -> Result<usize, LoadError> {
        let corners = body.length(length, place)?;
        let byte = body.last_byte();
        if corners < 3 {
            let noun = if corners == 1 { "corner" } else { "corners" };
            let message = format!("face {} has {corners} {noun}", place.number);
            return Err(body.trouble(place, message).help("give it at least three corners, or remove it"));
        }
        body.check_left(corners, item, place)?;

        // Cut the face into a fan: the first corner makes a triangle with each edge that does not touch it.
        let first = self.corner(body, place, item)?;
        let mut previous = self.corner(body, place, item)?;
        for _ in 2..corners {
            let next = self.corner(body, place, item)?;
            mesh.triangles.push([first, previous, next]);
            previous = next;
        }
        Ok(byte)
    }

    /// One index of a vertex; fails if there is no such vertex.
    fn corner(&self, body: &mut Body, place: NumberLocation, item: Scalar) -> Result<u32, LoadError> {
        let index = body.value(item, place)?;
        // Accept indices that are written as floats, if they are whole numbers in range. The test is false for NaN.
        if 0.0 <= index && index < self.vertex_count as f64 && index.fract() == 0.0 {
            return Ok(index as u32);
        }
        let there_are = match self.vertex_count {
            0 => "there are no vertices".into(),
            1 => "there is only vertex 0".into(),
            count => format!("the vertices are 0 to {}", count - 1),
        };
        let message = format!("face {} names vertex {index}, but {there_are}", place.number);
        Err(body.trouble(place, message).help(if index == self.vertex_count as f64 {
            "vertices count from 0 here; if the face was written by hand, subtract 1 from each of its indices"
        } else {
            "correct the index, or look above it for a row with a number too few or too many"
        }))
    }
}

/// A face with more than three corners, which was read as a fan.
pub(super) struct Polygon {
    /// The index of its first triangle in the mesh.
    first: usize,
    /// The number of its triangles.
    triangles: usize,
    /// Which face it is, counted from 0.
    number: usize,
    /// The byte of the file at which it starts.
    byte: usize,
}

/// Replaces the fans of concave polygons by triangles that cover the polygon, now that all vertices are known: faces may
/// come before vertices. Returns a warning if the outline of a polygon crosses itself.
pub(super) fn cut_polygons(
    file: &Path,
    bytes: &[u8],
    header: &Header,
    mesh: &mut Mesh,
    polygons: &[Polygon],
) -> Vec<LoadError> {
    let mut crossed: Vec<&Polygon> = Vec::new();
    for polygon in polygons {
        let fan = &mut mesh.triangles[polygon.first..][..polygon.triangles];
        let outline: Vec<u32> = fan
            .first()
            .into_iter()
            .flatten()
            .copied()
            .chain(fan.iter().skip(1).map(|last| last[2]))
            .collect();
        let positions: Option<Vec<Vec3>> =
            outline.iter().map(|&vertex| mesh.positions.get(vertex as usize).copied()).collect();
        match triangulate::cut(&positions.unwrap_or_default()) {
            Cut::Triangles(triangles) => {
                for (old, new) in fan.iter_mut().zip(triangles) {
                    *old = new.map(|corner| outline[corner]);
                }
            }
            Cut::Fan => {}
            Cut::Crossed => crossed.push(polygon),
        }
    }

    let Some(first) = crossed.first() else { return Vec::new() };
    let more = match crossed.len() {
        1 => String::new(),
        count => format!(" (this one first, {count} faces in the file)"),
    };
    let message =
        format!("the outline of face {} crosses itself, so its triangles are a guess{more}", first.number);
    let warning = match header.encoding {
        Encoding::Ascii => trouble_at(file, bytes, first.byte..first.byte + 1, message),
        Encoding::Binary(_) => LoadError::new(file, format!("{message} (byte {} of the file)", first.byte)),
    };
    vec![warning.help("list the corners of each face in order around it, or export triangles")]
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
