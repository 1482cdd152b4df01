//! Files as people and exporters write them, and what the reader says about each: the facts of the scene, the warnings or the
//! error, all in full. The cases stand in text files, as a user sees them:
//!
//! ```text
//! === A section, with the files that its cases share. Each case changes the last one.
//! --- m.obj
//! v 0 0 0
//! ...
//!
//! ## A title, if the lines need one
//! f 1 2 3          lines at the end of the file; `- LINE` removes a line, and `+ LINE` adds one in its place
//! = 3v 1t          the facts; an error has none
//! ! m.obj:5:1: a warning or the error
//!   help: its next line
//! ```
//!
//! `3v 1t` stands for three vertices and a triangle; `n`, `uv` and `m` count normals, texture coordinates and material names,
//! `flat` a mesh that asks for flat faces, `groups` its smoothing groups, and `area` is that of all triangles. `diffuse 1 0 0` is a value of the first material of the file that is not the default.

use super::changed::changed;
use super::{CAMERA, showing_all};
use crate::files::scene::{Limits, Loaded, parse_within};
use crate::material::Material;
use crate::scene::{Scene, SceneMesh};
use crate::tests::folder::Folder;
use std::fmt::Write;

#[test]
fn obj_files_give_what_their_cases_say() {
    check("obj", include_str!("obj.txt"));
}

#[test]
fn material_libraries_give_what_their_cases_say() {
    check("mtl", include_str!("mtl.txt"));
}

#[test]
fn ply_files_give_what_their_cases_say() {
    check("ply", include_str!("ply.txt"));
}

#[test]
fn scenes_give_what_their_cases_say() {
    check("scene", include_str!("scene.txt"));
}

/// Checks all cases of such a text.
#[track_caller]
fn check(name: &str, cases: &str) {
    let folder = Folder::new(&format!("cases-{name}"));
    for name in ["wood.png", "my wood.png"] {
        image::RgbImage::new(1, 1).save(folder.path(name)).expect("an image");
    }
    folder.write("wood.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01");
    let mut wrong = String::new();
    for section in cases.split("=== ").skip(1) {
        let (head, cases) = section.split_once("\n\n").expect("a section has cases");
        let mut files = head.split("\n--- ").map(|file| file.split_once('\n').unwrap_or((file, "")));
        let title = files.next().unwrap_or_default().0;
        let files: Vec<(&str, &str)> = files.collect();
        files.iter().for_each(|(name, text)| folder.write(name, text));
        let (name, shared) = *files.last().expect("a section has a file");
        for case in cases.trim().split("\n\n") {
            let lines: Vec<&str> = case.lines().filter(|line| !line.starts_with("## ")).collect();
            let end =
                lines.iter().position(|line| line.starts_with(['=', '!'])).expect("a case has a result");
            let (changes, expected) = lines.split_at(end);
            let got = result(&folder, name, &changed(shared, changes), expected[0].contains("area"));
            if got != expected.join("\n") {
                let _ = writeln!(wrong, "{title}\n\n{case}\n\nis wrong, because the result is\n{got}\n");
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The facts and messages of a scene, or of a scene that shows the mesh in this file.
fn result(folder: &Folder, name: &str, text: &str, with_area: bool) -> String {
    let shown = format!("{CAMERA}meshes.m.file = 'm.{}'\n", if name == "m.ply" { "ply" } else { "obj" });
    folder.write(name, text);
    let scene = &showing_all(if name == "s.toml" { text } else { &shown });
    let (mut lines, messages) = match parse_within(&folder.path("s.toml"), scene, Limits::default()) {
        Ok(Loaded { scene, warnings }) => {
            (format!("= {}", facts(&scene, with_area)).trim_end().to_owned(), warnings)
        }
        Err(error) => {
            let is_in_scene = error.place.is_some() && error.span.end <= scene.len();
            assert!(is_in_scene || error.file != folder.path("s.toml"), "{error:?}");
            (String::new(), vec![error])
        }
    };
    let start = folder.path("").display().to_string();
    for message in messages {
        let _ = write!(lines, "\n! {}", message.to_string().replace(&start, "").replace('\n', "\n  "));
    }
    lines.trim_start().to_owned()
}

/// The facts of a scene.
fn facts(scene: &Scene, with_area: bool) -> String {
    let mut facts: Vec<String> = Vec::new();
    for SceneMesh { mesh, smooth, groups, .. } in &scene.meshes {
        let counts = [
            (mesh.positions.len(), "v"),
            (mesh.triangles.len(), "t"),
            (mesh.normals.len(), "n"),
            (mesh.uvs.len(), "uv"),
            (mesh.material_names.len(), "m"),
        ];
        facts.extend(
            counts.iter().filter(|(count, _)| *count > 0).map(|(count, unit)| format!("{count}{unit}")),
        );
        facts.extend((!smooth).then(|| "flat".into()));
        facts.extend((!groups.is_empty()).then(|| format!("groups {groups:?}")));
        if with_area {
            let corners = (0..mesh.triangles.len()).map(|index| mesh.corners(index));
            let area: f32 = corners.map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum();
            facts.push(format!("area {}", (area * 1e4).round() / 1e4));
        }
    }
    facts.extend(scene.materials.get(1).map(described));
    facts.retain(|fact| !fact.is_empty());
    facts.join(" ")
}

/// The values of a material that are not the default.
fn described(material: &Material) -> String {
    let default = Material::default();
    let colours = [
        ("diffuse", material.diffuse, default.diffuse),
        ("ambient", material.ambient, material.diffuse),
        ("specular", material.specular, default.specular),
        ("transmission", material.transmission, default.transmission),
        ("emission", material.emission, default.emission),
    ];
    let mut words: Vec<String> = colours
        .iter()
        .filter(|(_, value, default)| value != default)
        .map(|(name, value, _)| format!("{name} {} {} {}", value.x, value.y, value.z))
        .collect();
    for (name, value, default) in [
        ("exponent", material.exponent, default.exponent),
        ("index", material.index_of_refraction, default.index_of_refraction),
    ] {
        if value != default {
            words.push(format!("{name} {value}"));
        }
    }
    words.extend((material.fresnel != default.fresnel).then(|| "fresnel".into()));
    words.extend(material.texture.map(|_| "texture".into()));
    words.join(" ")
}
