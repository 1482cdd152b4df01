//! Tests of refused PLY files and of their messages.

use super::{PLAIN, error, parsed, plain_with};

#[test]
fn a_face_has_three_corners() {
    for length in ["-1", "2.5", "nan", "inf", "4294967296"] {
        let text = error(plain_with("3 0 1 2", &format!("{length} 0 1 2")));
        assert!(text.starts_with("a.ply:13:1: face 0 has a list of length "), "{text}");
    }
}

#[test]
fn a_file_that_is_no_ply_is_recognised() {
    let not = "this is not a PLY file: its first line is not `ply`";
    for (bytes, help) in [
        (&b"solid cube\n"[..], "it looks like an STL file: export the mesh as PLY or OBJ"),
        (b"# made by hand\nv 0 0 0\n", "it looks like an OBJ file: give it the ending `.obj`"),
        (b"PLY\n", "the first line has to be `ply` in small letters"),
        (b"\x1f\x8b\x08\x00", "it is compressed: unpack it with `gunzip` first"),
        (
            b"<!DOCTYPE html>",
            "it looks like a web page, perhaps an error page saved by a download: download the file again",
        ),
        (b"\xff\xd8\xff\xe0", "check that this is the file you meant, and export it as PLY"),
    ] {
        assert_eq!(error(bytes), format!("a.ply:1:1: {not}\nhelp: {help}"));
    }
    assert_eq!(error(" \n"), "a.ply: the file is empty\nhelp: export or download it again");
    let missing = super::super::read(std::path::Path::new("no/such/file.ply")).unwrap_err().to_string();
    assert!(missing.starts_with("no/such/file.ply: there is no such file\nhelp: "), "{missing}");
}

/// A short file that announces four billion vertices is refused before memory is reserved.
#[test]
fn a_count_is_not_believed() {
    for (from, to) in [
        ("vertex 3", "vertex 18446744073709551615"),
        ("face 1", "face 4000000000"),
        ("3 0 1 2", "4000000000 0 1 2"),
        ("float z", "float z\nproperty list uint double fooness"),
    ] {
        let text = plain_with(from, to).replace("1 0 0\n", "1 0 0 4000000000\n");
        for text in [text.clone(), text.replace("ascii", "binary_little_endian")] {
            assert!(parsed(text).is_err());
        }
    }
}

#[test]
fn trouble_in_a_binary_file_is_found_by_its_byte() {
    let header = PLAIN.replace("ascii", "binary_little_endian");
    let mut bytes = header.clone().into_bytes();
    for value in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        bytes.extend(value.to_le_bytes());
    }
    let faces = bytes.len();
    assert_eq!(
        error([&bytes[..], &[3, 0, 0, 0, 0, 9, 0, 0, 0, 2, 0, 0, 0]].concat()),
        format!(
            "a.ply: face 0 names vertex 9, but the vertices are 0 to 2 (property `vertex_indices`, byte {} of the file)\n\
             help: correct the index, or look above it for a row with a number too few or too many",
            faces + 5
        )
    );
    assert_eq!(
        error([&bytes[..], &[1, 0, 0, 0, 0]].concat()),
        format!(
            "a.ply: face 0 has 1 corner (property `vertex_indices`, byte {faces} of the file)\n\
             help: give it at least three corners, or remove it"
        )
    );
    assert_eq!(
        error(&bytes[..faces - 2]),
        format!(
            "a.ply: the file ends early: the header promises 3 of element `vertex`, but `z` of vertex 2 is \
             missing at byte {}, the end\nhelp: export or download the file again, or correct the line \
             `element vertex 3`",
            faces - 2
        )
    );
    let count_bomb = header.replace("uchar int", "uint int").replace("face 1", "face 1000000");
    let bytes = [count_bomb.as_bytes(), &bytes[header.len()..], &[0xff; 40]].concat();
    assert!(error(bytes).contains("`vertex_indices` of face 0 is missing at byte"));
}
