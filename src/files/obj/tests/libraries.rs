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

/// Checks the only warning about a material with this line, which is line 2, and returns the material.
#[track_caller]
fn check(line: &str, expected: &str) -> ObjMaterial {
    let (materials, warnings) = parsed(format!("newmtl red\n{line}\n"));
    let messages: Vec<String> = warnings.iter().map(LoadError::to_string).collect();
    assert_eq!(messages, [format!("models/a.mtl:2:{expected}")]);
    materials.into_iter().next().expect("a material")
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
    let (materials, warnings) = parsed(text);
    assert_eq!(warnings, []);
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
fn a_line_that_cannot_be_used_is_left_out_with_a_warning() {
    check(
        "Kd 1 0",
        "1: `Kd` needs 3 numbers, but has 2; the line is ignored\nhelp: write them on the same line",
    );
    check("Ka", "1: `Ka` needs 3 numbers, but has 0; the line is ignored\nhelp: write them on the same line");
    check(
        "Ns #",
        "1: `Ns` needs 1 number, but has 0; the line is ignored\nhelp: write them on the same line",
    );
    let number = "help: replace it by a number, with a decimal point and not a comma";
    let red = check("Kd 1 0 x", &format!("8: `x` is not a number; the line is ignored\n{number}"));
    assert_eq!(red, ObjMaterial { name: "red".into(), ..ObjMaterial::default() });
    check("Ni inf", &format!("4: `inf` is not a number; the line is ignored\n{number}"));
    check(
        "Kd spectral red.rfl",
        "4: a colour as `spectral` is not supported; the line is ignored\n\
         help: write red, green and blue, as in `Kd 0.8 0.2 0.2`",
    );
    check("newmtl", "1: `newmtl` without a name; the line is ignored\nhelp: give it one, as in `newmtl red`");
    check(
        "map_Kd -clamp on",
        "1: `map_Kd` without a name; the line is ignored\nhelp: name an image, as in `map_Kd wood.png`",
    );
    let (materials, warnings) = parsed("Kd 1 0 0\n");
    assert_eq!(materials, []);
    assert_eq!(
        warnings[0].to_string(),
        "models/a.mtl:1:1: `Kd` before the first `newmtl`; the line is ignored\n\
         help: put `newmtl` and a name above the values of each material"
    );
}

#[test]
fn a_number_out_of_range_is_replaced_with_a_warning() {
    let red = check("Ns -10", "4: `Ns` is -10; 0 is used\nhelp: write a number of at least 0");
    assert_eq!(red.shininess, Some(0.0));
    let red = check("d 1.5", "3: `d` is 1.5; 1 is used\nhelp: write a number from 0 to 1");
    assert_eq!(red.dissolve, Some(1.0));
    let red =
        check("Kd 1 -2 0", "6: `Kd` has the component -2; 0 is used\nhelp: write a number of at least 0");
    assert_eq!(red.diffuse, Some(Vec3::X));
    let red = check(
        "Ni 0",
        "4: `Ni` is 0, which is no index of refraction; 1 is used\n\
         help: write `Ni 1.5` for glass, or `Ni 1` for an opaque material",
    );
    assert_eq!(red.index_of_refraction, Some(1.0));
}

#[test]
fn transparency_is_one_minus_opacity_unless_that_is_given() {
    for (lines, dissolve) in [("Tr 0.25", 0.75), ("d 1\nTr 1", 1.0), ("Tr 1\nd 0.5", 0.5)] {
        let (materials, warnings) = parsed(format!("newmtl red\n{lines}\n"));
        assert_eq!((materials[0].dissolve, warnings), (Some(dissolve), vec![]), "{lines}");
    }
}

#[test]
fn an_illumination_model_that_is_not_rendered_gives_one_warning() {
    let mirrors = "newmtl a\nillum 3\nnewmtl b\nillum 3\n";
    let (_, warnings) = parsed(mirrors);
    assert_eq!(
        warnings.iter().map(LoadError::to_string).collect::<Vec<_>>(),
        [
            "models/a.mtl:2:7: `illum 3` asks for reflections, which MTL files have no value for; none are rendered\n\
          help: define a material of the same name in the scene, for example with `mirror`"
        ]
    );
    for (lines, count) in
        [("illum 2", 0), ("illum 1\nKs 0 0 0", 0), ("illum 1\nKs 1", 1), ("illum 0", 1), ("illum x", 0)]
    {
        assert_eq!(parsed(format!("newmtl red\n{lines}")).1.len(), count, "{lines}");
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
    assert_eq!(file.mesh.material_names, ["b"]);
    assert_eq!(file.mesh.face_materials, [0]);
    let names: Vec<&str> = file.materials.iter().map(|material| &*material.name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    assert_eq!(file.materials[1].diffuse, Some(Vec3::Y), "the last definition counts");
    assert_eq!(file.materials[2].diffuse_texture, Some(directory.0.join("c.png")));
}

#[test]
fn a_missing_library_gives_a_warning_with_the_place_where_it_was_looked_for() {
    let text = "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    let file = super::super::parse(Path::new("models/a.obj"), text.as_bytes()).unwrap();
    assert_eq!(
        file.warnings.iter().map(LoadError::to_string).collect::<Vec<_>>(),
        [format!(
            "models/a.obj:1:8: there is no material library `no.mtl`\n\
             help: looked for {}: put the library there, or remove the `mtllib` line",
            Path::new("models").join("no.mtl").display()
        )]
    );
    let (name, warning) = &file.undefined[0];
    assert_eq!((name.as_str(), warning.place), ("red", Some((5, 8))));
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let text =
        "newmtl red\nKa 1 0 0\nKd 1 1 1\nKs .5\nKe 0 0 0\nNs 8\nNi 1.5\nd -halo 1\nmap_Kd -s 1 1 x.png\n";
    crate::files::ply::text::mutations(text.as_bytes(), |bytes| {
        let _ = parsed(bytes);
    });
}
