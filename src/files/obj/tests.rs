//! Tests of the OBJ reader.

mod libraries;

use super::{ObjFile, parse};
use crate::files::error::LoadError;
use crate::mesh::Mesh;
use glam::{Vec2, Vec3};
use std::path::Path;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn parsed(text: impl AsRef<[u8]>) -> Result<ObjFile, LoadError> {
    parse(Path::new("a.obj"), text.as_ref())
}

#[track_caller]
fn mesh(text: impl AsRef<[u8]>) -> Mesh {
    parsed(text).unwrap_or_else(|error| panic!("{error}")).mesh.mesh.as_ref().clone()
}

/// The corners of all triangles, whatever the order of the vertices.
fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    (0..mesh.triangles.len()).map(|index| mesh.corners(index)).collect()
}

#[test]
fn spelling_carries_no_meaning() {
    let plain = mesh(format!("{SQUARE}f 1 2 3 4\n"));
    for variant in [
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', " \r\n\r\n"),
        format!("{SQUARE}f 1 2 3 4\n").replace(' ', "\t"),
        format!("\u{feff}{SQUARE}f 1 2 3 4"),
        format!("{SQUARE}f -4 -3 -2 -1"),
        format!("{SQUARE}f 1 2 \\\n 3\\\r\n 4\n"),
        format!("{SQUARE}f 1// 2 3/ 4 # a comment\n"),
        format!("{SQUARE}f 1 2 3 4 \\"),
        format!(
            "# C:\\mesh\\\n#usemtl red\n  o square\n g\n{SQUARE}s off\nf 1 2 3 4\nl 1 2 3\np 1\nusemap none\n"
        ),
        SQUARE.replace(" 0\n", " 0 1.0\n") + "f 1 2 3 4",
        SQUARE.replace("v 1 0 0\n", "v 1 0 0 0.5 0.5 1\n") + "f 1 2 3 4",
    ] {
        assert_eq!(mesh(&variant), plain, "{variant:?}");
    }
    let latin = [b"# caf\xE9\nusemtl gr\xFCn\n", SQUARE.as_bytes(), b"f 1 2 3 4"].concat();
    assert_eq!(mesh(latin).material_names, ["gr?n"]);
    let of_3ds_max = "# 3ds Max Wavefront OBJ Exporter\r\n\r\n#\r\n# object Box\r\n#\r\n\r\nv  0 0 0\r\nv  1 0 0\r\n\
                      v  0 1 0\r\n# 3 vertices\r\n\r\ng Box\r\nf 1 2 3 \r\n# 1 polygons\r\n";
    assert_eq!(corners(&mesh(of_3ds_max)), [[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    let file = parsed(format!("{SQUARE}mtllib \u{1b}[31m\nf 1 2 3\n")).unwrap();
    let warning = file.warnings[0].to_string();
    assert!(warning.starts_with("a.obj:5:8: there is no material library `\\u{1b}[31m`"), "{warning}");
}

#[test]
fn each_combination_of_indices_is_a_vertex() {
    let tables = format!("{SQUARE}vt 0 0\nvt 1 .5 7\nvt 2\nvn 0 0 2\nvn 3 4 0\n");
    let all = mesh(format!("{tables}f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/1/2"));
    assert_eq!(all.positions.len(), 4);
    assert_eq!(all.normals, [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::new(0.6, 0.8, 0.0)]);
    assert_eq!(all.uvs, [Vec2::ZERO, Vec2::new(1.0, 0.5), Vec2::new(2.0, 0.0), Vec2::ZERO]);

    let hard_edge = mesh(format!("{tables}f 1//1 2//1 3//1\nf 1//2 3//2 4//-1"));
    assert_eq!((hard_edge.positions.len(), hard_edge.normals.len(), hard_edge.uvs.len()), (6, 6, 0));
}

#[test]
fn a_part_without_texture_coordinates_shows_the_middle() {
    let mixed = mesh(format!("{SQUARE}vt 0 1\nf 1/1 2/1 3/1\nusemtl plain\nf 1 3 4\n"));
    assert_eq!(mixed.uvs, [[Vec2::Y; 3], [Vec2::splat(0.5); 3]].concat());
}

/// Only the corner without a usable normal gets that of its face.
#[test]
fn a_corner_without_a_normal_has_that_of_its_face() {
    let tables = format!("{SQUARE}vn 0 3 4\nvn 0 0 0\nvn -nan(ind) 0 1\nf 1//1 2//1 4//1\n");
    let given = Vec3::new(0.0, 0.6, 0.8);
    for face in ["f 4//1 2//1 3\n", "f 4//1 2//1 3//2\n", "f 4//1 2//1 3//3", "f 4//1 2//1 3//4"] {
        let mesh = mesh(format!("{tables}{face}"));
        let normals = mesh.triangles[1].map(|vertex| mesh.normals[vertex as usize]);
        assert_eq!(normals, [given, given, Vec3::Z], "{face}");
    }
    assert!(mesh(format!("{SQUARE}vn 0 0 0\nf 1//1 2//1 3//1\n")).normals.is_empty());
}

/// The places and groups of a mesh.
#[test]
fn corners_at_one_position_share_a_place_and_faces_have_groups() {
    let tables = format!("{SQUARE}vt 0 0\nvt 1 0\n");
    let seam = parsed(format!("{tables}s 4\nf 1/1 2/1 3/1\ns off\nf 1/2 3/2 4/2\n")).unwrap().mesh;
    assert_eq!((seam.places, seam.groups), (vec![0, 1, 2, 0, 2, 3], vec![2, 0]));
    assert!(seam.smooth);
    let flat = parsed(format!("{SQUARE}s 0\nf 1 2 3\nf 1 3 4\n")).unwrap().mesh;
    assert_eq!((flat.smooth, flat.places, flat.groups), (false, vec![], vec![]));
    let given = parsed(format!("{SQUARE}vn 0 0 1\ns 0\nf 1//1 2//1 3//1\ns 1\nf 1//1 3//1 4//1")).unwrap();
    assert!(given.mesh.smooth && given.mesh.groups.is_empty());
}

/// A millimetre is kept in map coordinates, where single precision has steps of half a metre.
#[test]
fn positions_far_away_are_counted_from_an_origin() {
    let text = "v 500000.001 5000000.002 10\nv 500000.5 5000000 10\nv 500000 5000000.25 10\nf 1 2 3\n";
    let mesh = parsed(text).unwrap().mesh;
    let expected =
        [[500000.001, 5000000.002, 10.0], [500000.5, 5000000.0, 10.0], [500000.0, 5000000.25, 10.0]];
    for (position, expected) in mesh.mesh.positions.iter().zip(expected) {
        let error = mesh.origin.as_dvec3() + position.as_dvec3() - glam::DVec3::from(expected);
        // The origin is a multiple of a power of two, and the rest is rounded once: 24 bits of the size.
        assert!(error.length() < 1e-6, "{error}");
    }
    assert_eq!(parsed(format!("{SQUARE}f 1 2 3")).unwrap().mesh.origin, Vec3::ZERO);
}

#[test]
fn materials_are_numbered_in_order_of_first_use() {
    let named = mesh(format!(
        "{SQUARE}usemtl unused\nusemtl dark red\nf 1 2 3 4\no more\nf 1 2 3\nusemtl blue\nf 1 2 3\nusemtl dark red\nf 1 2 3"
    ));
    assert_eq!(named.material_names, ["dark red", "blue"]);
    assert_eq!(named.face_materials, [0, 0, 0, 1, 0]);

    let half = mesh(format!("{SQUARE}f 1 2 3\nusemtl red\nf 1 2 3"));
    assert_eq!(
        (half.material_names, half.face_materials),
        (vec!["default".into(), "red".into()], vec![0, 1])
    );
    assert!(mesh(format!("{SQUARE}f 1 2 3\nusemtl red\n")).material_names.is_empty());
}

/// For any bytes, the result is a valid mesh or an error.
#[test]
fn no_bytes_make_the_reader_panic() {
    let text = format!(
        "mtllib no\n{SQUARE}vt 0 1\nvt 1 1\nvn 0 0 1\ng x\nusemtl red\nf 1/1/1 2//1 3/2 4\nl 1 2\nf -1 -2 -3\n"
    );
    for original in [&text[10..], &text] {
        crate::files::ply::text::mutations(original.as_bytes(), |bytes| {
            if let Ok(file) = parsed(bytes) {
                file.mesh.mesh.validate().expect("an accepted mesh is valid");
            }
        });
    }
}
