//! Tests of accepted PLY files.

use super::{CORNERS, PLAIN, mesh};
use glam::{Vec2, Vec3};

fn plain() -> crate::mesh::Mesh {
    mesh(format!("{PLAIN}{CORNERS}3 0 1 2\n"))
}

#[test]
fn line_ends_and_blanks_carry_no_meaning() {
    let text = format!("{PLAIN}{CORNERS}3 0 1 2\n");
    for variant in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace('\n', " \t\n"),
        text.replace(' ', "\t"),
        text.replace("\nelement", "\n\nelement"),
        text.trim_end().into(),
        format!("\u{feff}{text}"),
        format!("{PLAIN}0 0 0 1 0 0\n\n0 1\n0 3\n0 1\n2\n\n"),
        format!("{PLAIN}\n  0 0 0 1 0 0 0 1 0 3 0 1 2"),
    ] {
        assert_eq!(mesh(&variant), plain(), "{variant:?}");
    }
}

#[test]
fn comments_may_hold_any_bytes() {
    let text = format!("{PLAIN}{CORNERS}3 0 1 2\n");
    let mut bytes = b"ply\ncomment caf\xE9 \xFF end_header\nobj_info num_cols 512\ncomment\n".to_vec();
    bytes.extend(&text.as_bytes()[4..]);
    assert_eq!(mesh(bytes), plain());
}

#[test]
fn numbers_are_spelt_in_many_ways() {
    let mesh = mesh(format!("{PLAIN}.5 1e-3 +1\n-.25 2. 1E2\n0 -0 7\n3 +0 1.0 2e0"));
    let expected = [Vec3::new(0.5, 0.001, 1.0), Vec3::new(-0.25, 2.0, 100.0), Vec3::new(0.0, 0.0, 7.0)];
    assert_eq!(mesh.positions, expected);
}

/// Decimals become the nearest `f32`, also where the nearest `f64` lies half-way between two `f32`.
#[test]
fn a_float_is_rounded_once() {
    let decimal = "1.00000017881393432617187499";
    assert_ne!(decimal.parse::<f32>().unwrap(), decimal.parse::<f64>().unwrap() as f32);
    let mesh = mesh(format!("{PLAIN}{decimal} 0 0\n1 0 0\n0 1 0\n3 0 1 2"));
    assert_eq!(mesh.positions[0].x, decimal.parse::<f32>().unwrap());
}

#[test]
fn unknown_properties_and_elements_are_passed_over() {
    let text = "ply\nformat ascii 1.0\nelement camera 1\nproperty float view\nproperty list uchar float lens\n\
                element vertex 3\nproperty double fooness\nproperty float x\nproperty list int short tags\n\
                property float y\nproperty float z\nproperty uchar barness\nelement nothing 4000000000\n\
                element face 1\nproperty list uchar uchar colour\nproperty list uint uint vertex_index\n\
                property int flags\nelement edge 2\nproperty int a\nproperty int b\nend_header\n\
                inf 2 .1 .2\nnan 0 2 7 8 0 0 1\n1 1 0 0 0 2\nwhat 0 1 9 1 0 3\n2 255 0 3 0 1 2 -1\n0 1\n1 2\n";
    assert_eq!(mesh(text), plain());
}

#[test]
fn concave_faces_are_covered_also_before_their_vertices() {
    // An L of area 3.
    let outline = "0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0";
    let header = PLAIN.replace("vertex 3", "vertex 6");
    let (vertices, faces) = (header.find("element vertex"), header.find("element face"));
    let (vertices, faces, end) = (vertices.unwrap(), faces.unwrap(), header.find("end_header").unwrap());
    let swapped = format!("{}{}{}", &header[..vertices], &header[faces..end], &header[vertices..faces]);
    for text in [
        format!("{header}{outline}\n6 0 1 2 3 4 5"),
        format!("{swapped}end_header\n6 5 4 3 2 1 0\n{outline}"),
    ] {
        let mesh = mesh(text);
        let areas = (0..4).map(|i| {
            let [a, b, c] = mesh.corners(i);
            (b - a).cross(c - a).z / 2.0
        });
        assert_eq!((mesh.triangles.len(), areas.clone().sum::<f32>().abs()), (4, 3.0));
        assert_eq!(areas.map(f32::abs).sum::<f32>(), 3.0);
    }
}

/// From the lecture "Additional Data".
#[test]
fn vertices_may_have_normals_and_texture_coordinates() {
    for [u, v] in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]] {
        let more = format!(
            "property float nx\nproperty float ny\nproperty float nz\nproperty float {u}\nproperty float {v}\n\
             property float fooness\nelement face"
        );
        let text = PLAIN.replace("element face", &more);
        let rows = "0 0 0 0 0 2 0 .5 9\n1 0 0 0 3 4 1 0 9\n0 1 0 -1 0 0 1 1 9\n3 0 1 2";
        let mesh = mesh(format!("{text}{rows}"));
        assert_eq!(mesh.normals, [Vec3::Z, Vec3::new(0.0, 0.6, 0.8), Vec3::NEG_X]);
        assert_eq!(mesh.uvs, [Vec2::new(0.0, 0.5), Vec2::X, Vec2::ONE]);
    }
}

#[test]
fn a_normal_without_a_direction_is_that_of_the_face() {
    let more = "property float nx\nproperty float ny\nproperty float nz\nelement face";
    for bad in ["0 0 0", "nan 0 1", "-nan(ind) 0 0", "inf 0 0"] {
        let text = PLAIN.replace("element face", more);
        let mesh = mesh(format!("{text}0 0 0 0 1 0\n1 0 0 {bad}\n0 1 0 0 1 0\n3 0 1 2"));
        assert_eq!(mesh.normals, [Vec3::Y, Vec3::Z, Vec3::Y], "{bad}");
    }
}

/// A file repeats a vertex where its texture coordinates or normals differ.
#[test]
fn vertices_at_one_position_share_a_place() {
    let places = |more: &str, row: &str| {
        let header =
            PLAIN.replace("element face", &format!("{more}element face")).replace("vertex 3", "vertex 4");
        let text = format!("{header}0 0 0{row}\n1 0 0{row}\n0 1 0{row}\n-0 0 0{row}\n3 0 1 2");
        super::parse(std::path::Path::new("a.ply"), text.as_bytes()).unwrap().mesh.places
    };
    assert_eq!(places("property float u\nproperty float v\n", " 0 1"), [0, 1, 2, 0]);
    assert_eq!(places("", ""), []);
}

#[test]
fn two_components_make_no_normal() {
    let text =
        PLAIN.replace("element face", "property float nx\nproperty float nz\nproperty float u\nelement face");
    let mesh = mesh(format!("{text}0 0 0 0 1 0\n1 0 0 0 1 0\n0 1 0 0 1 0\n3 0 1 2"));
    assert!(mesh.normals.is_empty() && mesh.uvs.is_empty());
}

/// Bytes of an integer in the given type and order.
fn encode(value: i32, type_name: &str, big: bool) -> Vec<u8> {
    let mut bytes = match type_name {
        "char" | "int8" | "uchar" | "uint8" => vec![value as u8],
        "short" | "int16" | "ushort" | "uint16" => (value as u16).to_le_bytes().to_vec(),
        "int" | "int32" | "uint" | "uint32" => value.to_le_bytes().to_vec(),
        "float" | "float32" => (value as f32).to_le_bytes().to_vec(),
        "double" | "float64" => f64::from(value).to_le_bytes().to_vec(),
        _ => unreachable!("{type_name}"),
    };
    if big {
        bytes.reverse();
    }
    bytes
}

const TYPES: [&str; 16] = [
    "char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8", "int16", "uint16",
    "int32", "uint32", "float32", "float64",
];

#[test]
fn every_type_serves_everywhere_in_either_byte_order() {
    let ascii = format!("{PLAIN}{CORNERS}3 0 1 2\n");
    for type_name in TYPES {
        let types = ascii.replace("float", type_name).replace(" int ", &format!(" {type_name} "));
        assert_eq!(mesh(types), plain(), "{type_name}");
        for big in [false, true] {
            let order = if big { "big" } else { "little" };
            let header = PLAIN
                .replace("ascii", &format!("binary_{order}_endian"))
                .replace("float", type_name)
                .replace("uchar int", &format!("{type_name} {type_name}"))
                .replace(" z", &format!(" z\nproperty list {type_name} {type_name} fooness"));
            for header in [header.clone(), header.replace('\n', "\r\n")] {
                let mut bytes = header.into_bytes();
                let mut put = |values: &[i32]| {
                    values.iter().for_each(|&value| bytes.extend(encode(value, type_name, big)));
                };
                put(&[10, 100, 7, 0]);
                put(&[1, 0, 0, 2, 13, 10]);
                put(&[0, 1, 0, 1, 32]);
                put(&[3, 0, 1, 2]);
                let mesh = mesh(bytes);
                assert_eq!(mesh.positions, [Vec3::new(10.0, 100.0, 7.0), Vec3::X, Vec3::Y], "{type_name}");
                assert_eq!(mesh.triangles, [[0, 1, 2]]);
            }
        }
    }
}

#[test]
fn signs_survive_in_binary_files() {
    for type_name in ["char", "short", "int", "float", "double"] {
        let header = PLAIN.replace("ascii", "binary_big_endian").replace("float", type_name);
        let mut bytes = header.into_bytes();
        for value in [-1, -2, -3, 1, 0, 0, 0, 1, 0] {
            bytes.extend(encode(value, type_name, true));
        }
        bytes.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
        assert_eq!(mesh(bytes).positions[0], Vec3::new(-1.0, -2.0, -3.0), "{type_name}");
    }
}

#[test]
fn bytes_after_a_binary_mesh_are_padding() {
    let mut bytes = PLAIN.replace("ascii", "binary_little_endian").into_bytes();
    for value in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0]);
    assert_eq!(mesh(bytes), plain());
}
