//! PLY files.

use super::Row;

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const FACE: &str = "element face 1\nproperty list uchar int vertex_indices\n";
const END: &str = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Changes of a file with one triangle: the text that is replaced, and its replacement.
const CHANGES: &[(&str, &str, &str, &str)] = &[
    ("a triangle", "", "", "3v 1t area 0.5"),
    ("a comment in the header", "element vertex", "comment made by hand\nelement vertex", "3v 1t"),
    ("a comment between properties", "property float y", "comment height\nproperty float y", "3v 1t"),
    ("a comment above the format", "format ascii", "comment first\nformat ascii", "3v 1t"),
    ("a comment without text", "element vertex", "comment\nelement vertex", "3v 1t"),
    ("an obj_info line", "element vertex", "obj_info num_cols 512\nelement vertex", "3v 1t"),
    ("the name of a texture", "element vertex", "comment TextureFile wood.png\nelement vertex", "3v 1t"),
    ("an empty line in the header", "element vertex", "\nelement vertex", "3v 1t"),
    ("blanks at the end of a header line", "element vertex 3", "element vertex 3  ", "3v 1t"),
    ("tabs in the header", "property float x", "property\tfloat\tx", "3v 1t"),
    ("an index list called vertex_index", "vertex_indices", "vertex_index", "3v 1t"),
    (
        "a list that the rows lack",
        "property float z\n",
        "property float z\nproperty list uchar uchar colours\n",
        " | m.ply:15:1: the file ends early",
    ),
    ("lengths as uint8", "list uchar int", "list uint8 int32", "3v 1t"),
    ("lengths as int", "list uchar int", "list int int", "3v 1t"),
    ("lengths and indices as uint", "list uchar int", "list uint uint", "3v 1t"),
    ("indices as ushort", "list uchar int", "list uchar ushort", "3v 1t"),
    ("indices as floats", "3 0 1 2\n", "3 0.0 1.0 2.0\n", "3v 1t"),
    (
        "a vertex that is missing",
        "3\nproperty float x",
        "4\nproperty float x",
        " | m.ply:13:7: face 0 has 2 corners",
    ),
    ("several vertices in one row", "0 0 0\n1 0 0\n0 1 0\n", "0 0 0 1 0 0 0 1 0\n", "3v 1t"),
    ("a vertex in several rows", "1 0 0\n", "1\n0\n0\n", "3v 1t"),
    ("empty lines between rows", "1 0 0\n", "\n1 0 0\n\n", "3v 1t"),
    ("blanks at the start of a row", "1 0 0\n", "   1 0 0\n", "3v 1t"),
    ("tabs between numbers", "1 0 0\n", "1\t0\t0\n", "3v 1t"),
    ("numbers in scientific notation", "1 0 0\n", "1e0 0E5 -0.0\n", "3v 1t"),
    ("numbers without a leading zero", "1 0 0\n", "1. .0 -.0\n", "3v 1t"),
    ("no line end at the end of the file", "3 0 1 2\n", "3 0 1 2", "3v 1t"),
    (
        "a number below the last element",
        "3 0 1 2\n",
        "3 0 1 2\n7\n",
        " | m.ply:14:1: the file continues after its last",
    ),
    ("an element without properties", "element face", "element nothing 4000000000\nelement face", "3v 1t"),
    (
        "an edge element",
        FACE,
        "element face 1\nproperty list uchar int vertex_indices\nelement edge 0\nproperty int vertex1\n",
        "3v 1t",
    ),
    (
        "a material element",
        FACE,
        "element face 1\nproperty list uchar int vertex_indices\nelement material 0\nproperty uchar red\n",
        "3v 1t",
    ),
    ("a value of each face", "3 0 1 2\n", "3 0 1 2 7\n", " | m.ply:13:9: the file continues"),
    (
        "an index that is too large",
        "3 0 1 2\n",
        "3 0 1 3\n",
        " | m.ply:13:7: face 0 names vertex 3, but the vertices are 0 to 2",
    ),
    ("a negative index", "3 0 1 2\n", "3 0 1 -1\n", " | m.ply:13:7: face 0 names vertex -1"),
    ("a face of two corners", "3 0 1 2\n", "2 0 1\n", " | m.ply:13:1: face 0 has 2 corners"),
    ("a face that is missing", "3 0 1 2\n", "", " | m.ply:13:1: the file ends early"),
    ("a word that is no number", "1 0 0\n", "1 zero 0\n", " | m.ply:11:3: `zero` is not a number"),
    ("a decimal comma", "1 0 0\n", "0,5 0 0\n", " | m.ply:11:1: `0,5` is not a number"),
    (
        "a vertex that is NaN",
        "1 0 0\n",
        "nan 0 0\n",
        " | m.ply: vertex 1 is at [NaN, 0, 0], which is not finite",
    ),
    (
        "a vertex at infinity",
        "1 0 0\n",
        "inf 0 0\n",
        " | m.ply: vertex 1 is at [inf, 0, 0], which is not finite",
    ),
    ("no end of the header", "end_header\n", "", " | m.ply:9:1: "),
    ("no format", "format ascii 1.0\n", "", " | m.ply:8:1: the header ends without a `format` line"),
    ("an unknown format", "format ascii 1.0", "format text 1.0", " | m.ply:2:8: "),
    ("an unknown type", "property float y", "property real y", " | m.ply:5:10: "),
    ("a cloud of points", FACE, "", " | m.ply: the header declares no element `face`"),
    (
        "triangle strips",
        "element face 1",
        "element tristrips 1",
        " | m.ply: the header declares no element `face`",
    ),
    ("a vertex without z", "property float z\n", "", " | m.ply:3:9: a vertex has no number `z`"),
    (
        "capital letters for coordinates",
        "property float x",
        "property float X",
        " | m.ply:4:16: a vertex has no number `x`",
    ),
    (
        "a misspelt list of indices",
        "vertex_indices",
        "vertex_indicies",
        " | m.ply:8:25: a face has no list `vertex_indices`",
    ),
];

/// Properties of a vertex after its position, their values, and the expectation.
const PROPERTIES: &[(&str, &str, &str, &str)] = &[
    ("colours in bytes after the position", "uchar red,uchar green,uchar blue", "255 128 0", "3v 1t"),
    ("colours with alpha", "uchar red,uchar green,uchar blue,uchar alpha", "255 128 0 255", "3v 1t"),
    ("colours as floats", "float red,float green,float blue", "1 0.5 0", "3v 1t"),
    (
        "colours of diffuse light",
        "uchar diffuse_red,uchar diffuse_green,uchar diffuse_blue",
        "1 2 3",
        "3v 1t",
    ),
    ("normals", "float nx,float ny,float nz", "0 0 1", "3v 1t 3n"),
    ("normals of any length", "float nx,float ny,float nz", "0 3 4", "3v 1t 3n"),
    ("normals of length 0", "float nx,float ny,float nz", "0 0 0", "3v 1t"),
    ("normals that are NaN", "float nx,float ny,float nz", "nan nan nan", "3v 1t"),
    ("normals without z", "float nx,float ny", "0 1", "3v 1t"),
    ("normals in double precision", "double nx,double ny,double nz", "0 0 1", "3v 1t 3n"),
    ("texture coordinates u, v", "float u,float v", "0.5 0.5", "3v 1t 3uv"),
    ("texture coordinates s, t", "float s,float t", "0.5 0.5", "3v 1t 3uv"),
    ("texture coordinates texture_u, texture_v", "float texture_u,float texture_v", "0.5 0.5", "3v 1t 3uv"),
    ("texture coordinates that are NaN", "float u,float v", "nan 0", "3v 1t"),
    ("a single texture coordinate", "float u", "0.5", "3v 1t"),
    (
        "normals and texture coordinates",
        "float nx,float ny,float nz,float s,float t",
        "0 0 1 0 0",
        "3v 1t 3n 3uv",
    ),
    ("confidence and intensity", "float confidence,float intensity", "0.9 0.5", "3v 1t"),
    ("a quality", "float quality", "0.9", "3v 1t"),
    ("a radius and a curvature", "double radius,double curvature", "0.9 -1", "3v 1t"),
    ("flags", "int flags", "-7", "3v 1t"),
    ("a list per vertex", "list uchar int neighbours", "2 7 8", "3v 1t"),
    ("an empty list per vertex", "list uchar int neighbours", "0", "3v 1t"),
    ("a value of another program", "float fooness", "1e30", "3v 1t"),
];

/// Polygons with their vertices.
const POLYGONS: &[(&str, &str, &str)] = &[
    ("a convex quad", "0 0 0,1 0 0,1 1 0,0 1 0", "4v 2t area 1"),
    ("a concave quad", "0 0 0,1 0 0,.25 .25 0,0 1 0", "4v 2t area 0.25"),
    ("an L", "0 0 0,2 0 0,2 1 0,1 1 0,1 2 0,0 2 0", "6v 4t area 3"),
    ("an L in clockwise order", "0 2 0,1 2 0,1 1 0,2 1 0,2 0 0,0 0 0", "6v 4t area 3"),
    ("an upright L", "0 0 0,2 0 0,2 0 1,1 0 1,1 0 2,0 0 2", "6v 4t area 3"),
    ("a U", "0 0 0,3 0 0,3 3 0,2 3 0,2 1 0,1 1 0,1 3 0,0 3 0", "8v 6t area 7"),
    ("a far away L", "1000 0 0,1002 0 0,1002 1 0,1001 1 0,1001 2 0,1000 2 0", "6v 4t area 3"),
    ("a tiny L", "0 0 0,.02 0 0,.02 .01 0,.01 .01 0,.01 .02 0,0 .02 0", "6v 4t area 0.0003"),
    ("an L with straight corners", "0 0 0,1 0 0,2 0 0,2 1 0,1 1 0,1 2 0,0 2 0,0 1 0", "8v 6t area 3"),
    ("a hexagon", "2 0 0,1 1 0,-1 1 0,-2 0 0,-1 -1 0,1 -1 0", "6v 4t area 6"),
    ("a ring with a bridge", "0 0 0,4 0 0,4 4 0,0 4 0,0 0 0,1 1 0,1 3 0,3 3 0,3 1 0,1 1 0", "10v 8t area 12"),
    ("a polygon on a line", "0 0 0,1 0 0,2 0 0,3 0 0", "4v 2t area 0"),
    ("a bow tie", "0 0 0,1 1 0,1 0 0,0 1 0", "4v 2t | m.ply:14:1: the outline of face 0 crosses itself"),
    (
        "a five-pointed star",
        "0 10 0,6 -8 0,-10 3 0,10 3 0,-6 -8 0",
        "5v 3t | m.ply:15:1: the outline of face 0 crosses itself",
    ),
];

/// The types of the format with both of their names.
const TYPES: [&str; 16] = [
    "char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32", "uint", "uint32",
    "float", "float32", "double", "float64",
];

/// A number of a binary file.
fn bytes(number: f64, name: &str, big: bool) -> Vec<u8> {
    let mut bytes = match name {
        "char" | "int8" | "uchar" | "uint8" => vec![number as u8],
        "short" | "int16" | "ushort" | "uint16" => (number as u16).to_le_bytes().to_vec(),
        "int" | "int32" | "uint" | "uint32" => (number as u32).to_le_bytes().to_vec(),
        "float" | "float32" => (number as f32).to_le_bytes().to_vec(),
        _ => number.to_le_bytes().to_vec(),
    };
    if big {
        bytes.reverse();
    }
    bytes
}

/// A binary triangle with coordinates and indices of these types, and with its faces above its vertices if asked for.
fn binary(big: bool, coordinate: &str, index: &str, faces_first: bool) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let vertices = format!("element vertex 3\n{}", XYZ.replace("float", coordinate));
    let faces = FACE.replace(" int ", &format!(" {index} "));
    let elements = if faces_first { faces + &vertices } else { vertices + &faces };
    let mut file = format!("ply\nformat binary_{order}_endian 1.0\n{elements}end_header\n").into_bytes();
    let positions =
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(|number| bytes(number, coordinate, big)).concat();
    let indices = [vec![3], [0.0, 1.0, 2.0].map(|number| bytes(number, index, big)).concat()].concat();
    file.extend(if faces_first { [indices, positions].concat() } else { [positions, indices].concat() });
    file
}

pub(super) fn rows() -> Vec<Row> {
    let head = "ply\nformat ascii 1.0\n";
    let plain = format!("{head}element vertex 3\n{XYZ}{FACE}{END}");
    let mut rows: Vec<Row> = Vec::new();
    for (feature, from, to, expected) in CHANGES {
        assert!(plain.contains(from), "{feature}");
        rows.push(Row::mesh(feature, "m.ply", plain.replacen(from, to, 1), expected));
    }
    for (feature, properties, values, expected) in PROPERTIES {
        let properties: String =
            properties.split(',').map(|property| format!("property {property}\n")).collect();
        let vertices = format!("0 0 0 {values}\n1 0 0 {values}\n0 1 0 {values}\n");
        let text = format!("{head}element vertex 3\n{XYZ}{properties}{FACE}end_header\n{vertices}3 0 1 2\n");
        rows.push(Row::mesh(feature, "m.ply", text, expected));
    }
    for (feature, corners, expected) in POLYGONS {
        let count = corners.split(',').count();
        let indices: String = (0..count).map(|index| format!(" {index}")).collect();
        let corners = corners.replace(',', "\n");
        let text =
            format!("{head}element vertex {count}\n{XYZ}{FACE}end_header\n{corners}\n{count}{indices}\n");
        rows.push(Row::mesh(feature, "m.ply", text, expected));
    }
    rows.push(Row::mesh("line ends of Windows", "m.ply", plain.replace('\n', "\r\n"), "3v 1t"));
    rows.push(Row::mesh("line ends of the first Macs", "m.ply", plain.replace('\n', "\r"), "3v 1t"));
    rows.push(Row::mesh("a byte order mark", "m.ply", format!("\u{feff}{plain}"), "3v 1t"));
    let first = format!("{head}{FACE}element vertex 3\n{XYZ}end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
    rows.push(Row::mesh("faces above vertices", "m.ply", first, "3v 1t"));
    for name in TYPES {
        let ascii = plain.replace("float", name);
        rows.push(Row::mesh(&format!("coordinates of type {name}"), "m.ply", ascii, "3v 1t area 0.5"));
        let index = plain.replace(" int ", &format!(" {name} "));
        rows.push(Row::mesh(&format!("indices of type {name}"), "m.ply", index, "3v 1t area 0.5"));
        for big in [false, true] {
            let order = if big { "big endian" } else { "little endian" };
            let feature = format!("binary coordinates of type {name}, {order}");
            rows.push(Row::mesh(&feature, "m.ply", binary(big, name, "int", false), "3v 1t area 0.5"));
            let feature = format!("binary indices of type {name}, {order}, faces first");
            rows.push(Row::mesh(&feature, "m.ply", binary(big, "float", name, true), "3v 1t area 0.5"));
        }
    }
    let cut = binary(false, "float", "int", false);
    rows.push(Row::mesh(
        "a binary file that was cut",
        "m.ply",
        &cut[..cut.len() - 1],
        " | m.ply: the file ends early",
    ));
    rows.push(Row::mesh("padding after a binary file", "m.ply", [&cut[..], &[0; 3]].concat(), "3v 1t"));
    rows
}
