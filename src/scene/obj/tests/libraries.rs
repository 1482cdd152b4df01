//! Tests of the reader of material libraries.

use super::super::library::parse;
use super::super::{ObjMaterial, read};
use crate::scene::error::LoadError;
use glam::Vec3;
use std::path::{Path, PathBuf};

fn parsed(text: impl AsRef<[u8]>) -> Result<Vec<ObjMaterial>, LoadError> {
    parse(Path::new("models/a.mtl"), text.as_ref())
}

/// Checks the whole message for a material with this line, which is line 2.
#[track_caller]
fn check(line: &str, expected: &str) {
    let error = parsed(format!("newmtl red\n{line}\n")).expect_err("the library should be refused");
    assert_eq!(error.to_string(), format!("models/a.mtl:2:{expected}"));
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
fn a_material_has_colours_and_numbers() {
    let text = "# a comment\nnewmtl dark red\n\tKa 0.1 0.1 0.1\nKd .5 0 0 # red\nKs 0.25\nKe 1 2 3\nNs 32\nNi 1.5\n\
                d 0.5\nillum two\nTf xyz 1\nmap_Kd -clamp on -s 2 2 my textures\\wood.png\nnewmtl plain\r\nd -halo 1\r\n";
    let materials = parsed(text).unwrap();
    let red = ObjMaterial {
        name: "dark red".into(),
        ambient: Some(Vec3::splat(0.1)),
        diffuse: Some(Vec3::new(0.5, 0.0, 0.0)),
        specular: Some(Vec3::splat(0.25)),
        shininess: Some(32.0),
        index_of_refraction: Some(1.5),
        dissolve: Some(0.5),
        diffuse_texture: Some("models/my textures/wood.png".into()),
        emission: Some(Vec3::new(1.0, 2.0, 3.0)),
    };
    let plain = ObjMaterial { name: "plain".into(), dissolve: Some(1.0), ..Default::default() };
    assert_eq!(materials, [red, plain]);
}

#[test]
fn a_line_that_makes_no_sense_is_named() {
    check("Kd 1 0", "1: `Kd` needs 3 numbers, but has 2\nhelp: write them on the same line");
    check("Ka", "1: `Ka` needs 3 numbers, but has 0\nhelp: write them on the same line");
    check("Ns #", "1: `Ns` needs 1 number, but has 0\nhelp: write them on the same line");
    check(
        "Kd 1 0 x",
        "8: `x` is not a number\nhelp: replace it by a number, with a decimal point and not a comma",
    );
    check(
        "Ni inf",
        "4: `inf` is not a number\nhelp: replace it by a number, with a decimal point and not a comma",
    );
    check(
        "Kd spectral red.rfl",
        "4: a colour as `spectral` is not supported\nhelp: write red, green and blue, as in `Kd 0.8 0.2 0.2`",
    );
    check("newmtl", "1: `newmtl` without a name\nhelp: give it one, as in `newmtl red`");
    check("map_Kd -clamp on", "1: `map_Kd` without a name\nhelp: name an image, as in `map_Kd wood.png`");
    assert_eq!(
        parsed("Kd 1 0 0\n").unwrap_err().to_string(),
        "models/a.mtl:1:1: `Kd` before the first `newmtl`\nhelp: put `newmtl` and a name above the values of each material"
    );
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
    assert_eq!(file.mesh.material_names, ["b"]);
    assert_eq!(file.mesh.face_materials, [0]);
    let names: Vec<&str> = file.materials.iter().map(|material| &*material.name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    assert_eq!(file.materials[1].diffuse, Some(Vec3::Y), "the last definition counts");
    assert_eq!(file.materials[2].diffuse_texture, Some(directory.0.join("c.png")));
}

#[test]
fn a_missing_library_is_named_with_the_place_where_it_was_looked_for() {
    let text = "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let error = super::super::parse(Path::new("models/a.obj"), text.as_bytes()).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!(
            "models/a.obj:1:8: there is no material library `no.mtl`\n\
             help: looked for {}: put the library there, or remove the `mtllib` line",
            Path::new("models").join("no.mtl").display()
        )
    );
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let text =
        "newmtl red\nKa 1 0 0\nKd 1 1 1\nKs .5\nKe 0 0 0\nNs 8\nNi 1.5\nd -halo 1\nmap_Kd -s 1 1 x.png\n";
    crate::scene::ply::text::mutations(text.as_bytes(), |bytes| {
        let _ = parsed(bytes);
    });
}
