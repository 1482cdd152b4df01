//! Tests of refused PLY files and of their messages.

use super::{PLAIN, error, parsed, plain_with};

/// Checks the whole message for the plain mesh with one change.
#[track_caller]
fn check(from: &str, to: &str, expected: &str) {
    assert_eq!(error(plain_with(from, to)), format!("a.ply:{expected}"));
}

#[test]
fn misspelt_words_of_the_header_are_named() {
    let types = "the types are char, uchar, short, ushort, int, uint, float and double, or int8, uint8, int16, \
                 uint16, int32, uint32, float32 and float64";
    let keywords = "the keywords are format, comment, obj_info, element, property and end_header";
    let formats = "the formats are ascii, binary_little_endian and binary_big_endian";
    check(
        "float y",
        "flaot y",
        &format!("5:10: `flaot` is not a type of PLY files\nhelp: did you mean `float`? {types}"),
    );
    check("uchar int", "uchar vec3f", &format!("8:21: `vec3f` is not a type of PLY files\nhelp: {types}"));
    check(
        "end_header",
        "end header",
        &format!("9:1: `end` is not a keyword of PLY headers\nhelp: did you mean `end_header`? {keywords}"),
    );
    check(
        "element vertex",
        "elemnt vertex",
        &format!("3:1: `elemnt` is not a keyword of PLY headers\nhelp: did you mean `element`? {keywords}"),
    );
    check(
        "ascii",
        "binary_litle_endian",
        &format!(
            "2:8: `binary_litle_endian` is not a format of PLY files\nhelp: did you mean \
             `binary_little_endian`? {formats}"
        ),
    );
    check("ascii", "binary", &format!("2:8: `binary` is not a format of PLY files\nhelp: {formats}"));
}

#[test]
fn a_header_has_rules() {
    check(
        "ascii 1.0",
        "ascii 1.1",
        "2:14: version `1.1` of the format is unknown\nhelp: the only version is 1.0: write `1.0` if the \
         file follows it",
    );
    check(
        "ascii 1.0",
        "ascii",
        "2:1: this `format` line has 2 words\nhelp: write it with 3 words, as in `format ascii 1.0`",
    );
    check(
        "format ascii 1.0\n",
        "",
        "8:1: the header ends without a `format` line\nhelp: write `format ascii 1.0` below `ply` if the numbers are readable text",
    );
    check(
        "1.0\n",
        "1.0\nformat ascii 1.0\n",
        "3:1: a second `format` line\nhelp: a file has one format: remove the line that does not fit the numbers",
    );
    check(
        "vertex 3",
        "vertex -3",
        "3:16: `-3` is not a number of elements\nhelp: write how many there are, as in `element vertex 8`",
    );
    check(
        "list uchar int vertex_indices",
        "list uchar vertex_indices",
        "8:1: this `property` line has 4 words\nhelp: write it with 5 words, as in `property list uchar int vertex_indices`",
    );
    check(
        "float z",
        "float y",
        "6:16: element `vertex` has two properties `y`\nhelp: give each property of an element its own name",
    );
    check(
        "element face",
        "element vertex",
        "7:9: element `vertex` is declared twice\nhelp: declare each element once, with all of its properties below it",
    );
    check(
        "1.0\n",
        "1.0\nproperty float x\n",
        "3:1: a property before the first element\nhelp: put a line such as `element vertex 8` above the properties of a vertex",
    );
    check(
        "end_header\n",
        "",
        "9:1: numbers before the end of the header\nhelp: put a line `end_header` between the header and the \
         numbers",
    );
    assert_eq!(
        error(PLAIN.replace("end_header\n", "")),
        "a.ply:9:1: the file ends before its header does\nhelp: put a line `end_header` between the header and the numbers"
    );
}

#[test]
fn a_mesh_needs_vertices_with_a_place_and_faces_with_corners() {
    check(
        "element vertex",
        "element vertx",
        "3:9: the header declares no element `vertex`\nhelp: did you mean `vertex`?",
    );
    assert_eq!(
        error(PLAIN.replace("element vertex", "element thing")),
        "a.ply: the header declares no element `vertex`\nhelp: a mesh needs a line `element vertex` with its number of vertices"
    );
    assert_eq!(
        error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0"),
        "a.ply: the header declares no element `face`\nhelp: vertices alone are a cloud of points: export the mesh with faces"
    );
    assert_eq!(
        error(PLAIN.replace("face", "tristrips")),
        "a.ply: the header declares no element `face`\nhelp: triangle strips are not read: export the mesh with faces"
    );
    check("float y", "float Y", "5:16: a vertex has no number `y`\nhelp: did you mean `y` instead of `Y`?");
    check(
        "property float z\n",
        "",
        "3:9: a vertex has no number `z`\nhelp: add a line `property float z` and the number to each vertex",
    );
    check(
        "property float x",
        "property list uchar float x",
        "4:27: a vertex has no number `x`\nhelp: make `x` a number, not a list",
    );
    check(
        "vertex_indices",
        "vertex_indicies",
        "8:25: a face has no list `vertex_indices`\nhelp: did you mean `vertex_indices`?",
    );
    check(
        "list uchar int vertex_indices",
        "int vertex_indices",
        "8:14: a face has no list `vertex_indices`\nhelp: make it a list, as in `property list uchar int vertex_indices`",
    );
    assert_eq!(
        error(plain_with("face 1", "face 0").replace("3 0 1 2\n", "")),
        "a.ply: the mesh has no triangles\nhelp: export the mesh with faces: without faces there is nothing \
         to render"
    );
}

#[test]
fn every_index_is_checked() {
    let look = "help: correct the index, or look above it for a row with a number too few or too many";
    let by_hand = "help: vertices count from 0 here; if the face was written by hand, subtract 1 from each of its indices";
    check(
        "3 0 1 2",
        "3 0 -1 2",
        &format!("13:5: face 0 names vertex -1, but the vertices are 0 to 2\n{look}"),
    );
    check(
        "3 0 1 2",
        "3 1 2 3",
        &format!("13:7: face 0 names vertex 3, but the vertices are 0 to 2\n{by_hand}"),
    );
    check(
        "3 0 1 2",
        "3 0 1.5 2",
        &format!("13:5: face 0 names vertex 1.5, but the vertices are 0 to 2\n{look}"),
    );
    check(
        "3 0 1 2",
        "3 0 nan 2",
        &format!("13:5: face 0 names vertex NaN, but the vertices are 0 to 2\n{look}"),
    );
    check(
        "3 0 1 2",
        "4 0 1 2 4294967296",
        &format!("13:9: face 0 names vertex 4294967296, but the vertices are 0 to 2\n{look}"),
    );
}

#[test]
fn a_face_has_three_corners() {
    check(
        "3 0 1 2",
        "2 0 1",
        "13:1: face 0 has 2 corners\nhelp: give it at least three corners, or remove it",
    );
    for length in ["-1", "2.5", "nan", "inf", "4294967296"] {
        let text = error(plain_with("3 0 1 2", &format!("{length} 0 1 2")));
        assert!(text.starts_with("a.ply:13:1: face 0 has a list of length "), "{text}");
    }
}

#[test]
fn a_position_is_finite() {
    let help = "help: export the mesh again: each x, y and z has to be a number below 3e38";
    for (word, shown) in [("nan", "NaN"), ("-inf", "-inf"), ("1e39", "inf")] {
        let expected = format!("a.ply: vertex 1 is at [{shown}, 0, 0], which is not finite\n{help}");
        assert_eq!(error(plain_with("1 0 0", &format!("{word} 0 0"))), expected);
    }
}

#[test]
fn words_are_not_numbers() {
    let row = "help: replace it by a number, or look above it for a row with a number too few or too many";
    check("1 0 0", "...", &format!("11:1: `...` is not a number; `x` of vertex 1 should be here\n{row}"));
    check(
        "1 0 0",
        "1 0,5 0",
        "11:3: `0,5` is not a number; `y` of vertex 1 should be here\nhelp: write a decimal point, not a \
         comma, and blanks between numbers",
    );
    check(
        "3 0 1 2",
        "3 0 1 2 0",
        "13:9: the file continues after its last element\nhelp: a count in the header is too small, or a row \
         has a number too many",
    );
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
    check(
        "vertex 3",
        "vertex 4000000000",
        "14:1: the file ends early: the header promises 4000000000 of element `vertex`, but `y` of vertex 4 is missing\n\
         help: export or download the file again, or correct the line `element vertex 4000000000`",
    );
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
