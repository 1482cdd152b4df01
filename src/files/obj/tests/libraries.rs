//! Tests of the reader of material libraries.

use super::super::library::parse;
use super::super::{ObjMaterial, read};
use crate::files::error::LoadError;
use glam::Vec3;
use std::path::{Path, PathBuf};

fn parsed(text: impl AsRef<[u8]>) -> (Vec<ObjMaterial>, Vec<LoadError>) {
    let mut warnings = Vec::new();
    (parse(Path::new("models/a.mtl"), text.as_ref(), &mut warnings), warnings)
}

/// A directory that is removed when the value is dropped.
struct Directory(PathBuf);

impl Directory {
    fn with(name: &str, files: &[(&str, &str)]) -> Directory {
        let path = std::env::temp_dir().join(format!("raykata-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        for (file, text) in files {
            std::fs::write(path.join(file), text).unwrap();
        }
        Directory(path)
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn libraries_lie_next_to_the_file_that_names_them() {
    let directory = Directory::with(
        "libraries",
        &[
            (
                "a.obj",
                "mtllib one.mtl two.mtl\nmtllib three of them.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\n",
            ),
            ("one.mtl", "newmtl a\nnewmtl b\nKd 1 0 0\nmap_Kd b.png"),
            ("two.mtl", "newmtl b\nKd 0 1 0\n"),
            ("three of them.mtl", "newmtl c\nmap_Kd c.png\n"),
        ],
    );
    let file = read(&directory.0.join("a.obj")).unwrap();
    assert_eq!(file.mesh.mesh.material_names, ["b"]);
    assert_eq!(file.mesh.mesh.face_materials, [0]);
    let names: Vec<&str> = file.materials.iter().map(|material| &*material.name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    assert_eq!(file.materials[1].diffuse, Some(Vec3::Y), "the last definition counts");
    assert_eq!(file.materials[2].diffuse_texture, Some(directory.0.join("c.png")));
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let text =
        "newmtl red\nKa 1 0 0\nKd 1 1 1\nKs .5\nKe 0 0 0\nNs 8\nNi 1.5\nd -halo 1\nmap_Kd -s 1 1 x.png\n";
    crate::files::ply::text::mutations(text.as_bytes(), |bytes| {
        let _ = parsed(bytes);
    });
}
