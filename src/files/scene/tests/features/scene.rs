//! Scenes: how they use meshes, and polygons.

use super::Row;

const OBJ: &str = "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";

/// Lines of a scene from line 2 on, beside a mesh whose library is missing.
const SCENES: &[(&str, &str, &str)] = &[
    (
        "a mesh without its library",
        "[meshes.m]\nfile = 'm.obj'\n",
        "3v 1t 1m | m.obj:1:8: there is no material library | m.obj:5:8: material `red` is not defined; the mesh has",
    ),
    ("a mesh whose materials are not wanted", "[meshes.m]\nfile = 'm.obj'\nmaterials = false\n", "3v 1t 1m"),
    (
        "a mesh whose material the scene defines",
        "[materials.red]\ndiffuse = [1, 0, 0]\n[meshes.m]\nfile = 'm.obj'\n",
        "3v 1t 1m diffuse 1 0 0 | m.obj:1:8: there is no material library",
    ),
    ("a mesh of another format", "[meshes.m]\nfile = 'm.stl'\n", " | s.toml:3:8: there is no file `m.stl`"),
    (
        "a texture in the format JPEG",
        "[textures.t]\nfile = 'wood.jpg'\n",
        " | s.toml:3:8: `wood.jpg` is a JPEG image, and textures are PNG or Radiance HDR files\nhelp: convert it",
    ),
    (
        "a texture that is no image",
        "[textures.t]\nfile = 'm.obj'\n",
        " | s.toml:3:8: cannot use `m.obj` as a texture",
    ),
    (
        "a picture that needs too much memory",
        "[film]\nwidth = 16384\nheight = 16384\n",
        " | s.toml:2:1: a picture of 16384 by 16384 pixels takes about 7.5 GB of memory; the limit is 4.0 GB",
    ),
    (
        "a mesh that is subdivided too often",
        "[film]\nwidth = 5000\nheight = 5000\n[meshes.m]\nfile = 'm.obj'\nmaterials = false\nsubdivide = 12\n",
        " | s.toml:8:13: a surface of 16777216 triangles takes about 3.4 GB, and with 700.0 MB for",
    ),
];

/// Corners of polygons.
const POLYGONS: &[(&str, &str, &str)] = &[
    ("a convex polygon", "[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]", ""),
    ("a concave polygon", "[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]", "4v 2t area 1"),
    ("an L", "[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]", "6v 4t area 3"),
    (
        "a polygon that crosses itself",
        "[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]",
        "4v 2t | s.toml:3:21: the outline of the polygon crosses itself, so its triangles are a guess",
    ),
    (
        "a polygon that is not flat",
        "[0, 0, 0], [1, 0, 0], [1, 1, 1], [0, 1, 0]",
        " | s.toml:3:34: corner 1 does not lie",
    ),
];

pub(super) fn rows() -> Vec<Row> {
    let files = || {
        vec![("m.obj", OBJ.as_bytes().to_vec()), ("wood.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01".to_vec())]
    };
    let row = |feature: &str, scene: String, expected: &str| Row {
        feature: feature.into(),
        files: files(),
        scene,
        expected: expected.into(),
    };
    let scenes = SCENES.iter().map(|(feature, lines, expected)| row(feature, (*lines).into(), expected));
    let polygons = POLYGONS.iter().map(|(feature, corners, expected)| {
        let scene = format!("[[nodes]]\nshape = {{ polygon = {{ corners = [{corners}] }} }}\n");
        row(feature, scene, expected)
    });
    scenes.chain(polygons).collect()
}
