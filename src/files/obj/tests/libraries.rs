//! Tests of the reader of material libraries.

use super::super::library::parse;
use super::super::{ObjMaterial, read};
use crate::files::error::LoadError;
use crate::tests::folder::Folder;
use glam::Vec3;
use std::path::Path;

fn parsed(text: impl AsRef<[u8]>) -> (Vec<ObjMaterial>, Vec<LoadError>) {
    let mut warnings = Vec::new();
    (parse(Path::new("models/a.mtl"), text.as_ref(), &mut warnings), warnings)
}

#[test]
fn libraries_lie_next_to_the_file_that_names_them() {
    let folder = Folder::new("libraries");
    for (file, text) in [
        (
            "a.obj",
            "mtllib one.mtl two.mtl\nmtllib three of them.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\n",
        ),
        ("one.mtl", "newmtl a\nnewmtl b\nKd 1 0 0\nmap_Kd b.png"),
        ("two.mtl", "newmtl b\nKd 0 1 0\n"),
        ("three of them.mtl", "newmtl c\nmap_Kd c.png\n"),
    ] {
        folder.write(file, text);
    }
    let file = read(&folder.path("a.obj")).unwrap();
    assert_eq!(file.mesh.mesh.material_names, ["b"]);
    assert_eq!(file.mesh.mesh.face_materials, [0]);
    let names: Vec<&str> = file.materials.iter().map(|material| &*material.name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    assert_eq!(file.materials[1].diffuse, Some(Vec3::Y), "the last definition counts");
    assert_eq!(file.materials[2].diffuse_texture, Some(folder.path("c.png")));
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let text =
        "newmtl red\nKa 1 0 0\nKd 1 1 1\nKs .5\nKe 0 0 0\nNs 8\nNi 1.5\nd -halo 1\nmap_Kd -s 1 1 x.png\n";
    crate::files::ply::text::mutations(text.as_bytes(), |bytes| {
        let _ = parsed(bytes);
    });
}
