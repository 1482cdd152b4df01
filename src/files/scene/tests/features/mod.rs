//! What exporters write, one row per feature: a generated file, and the mesh, the warnings or the error that it gives.
//!
//! Expectations are short. `4v 2t` stands for four vertices and two triangles; `3n`, `3uv` and `2m` for normals, texture
//! coordinates and material names, `area 3` for the area of all triangles. `diffuse 1 0 0` stands for a value of the first
//! material of the file that is not the default. After each ` | ` follows the beginning of a warning. An error is
//! ` | ` and the beginning of its message.

mod mtl;
mod obj;
mod ply;
mod scene;

use super::CAMERA;
use super::files::Folder;
use crate::files::scene::{Limits, Loaded, parse_within};
use crate::material::Material;
use crate::scene::Scene;
use std::fmt::Write;

/// A feature, its generated files with their names, the lines of the scene, and the expectation.
struct Row {
    feature: String,
    files: Vec<(&'static str, Vec<u8>)>,
    scene: String,
    expected: String,
}

impl Row {
    /// A row for one mesh file, which the scene shows.
    fn mesh(feature: &str, name: &'static str, bytes: impl AsRef<[u8]>, expected: &str) -> Row {
        Row {
            feature: feature.into(),
            files: vec![(name, bytes.as_ref().to_vec())],
            scene: format!("meshes.m.file = '{name}'\n"),
            expected: expected.into(),
        }
    }
}

#[test]
fn real_files_give_what_the_table_says() {
    let rows: Vec<Row> =
        [obj::rows(), mtl::rows(), ply::rows(), scene::rows()].into_iter().flatten().collect();
    assert!(rows.len() >= 200, "the table has only {} rows", rows.len());
    let folder = Folder::new("features");
    let mut wrong = String::new();
    for Row { feature, files, scene, expected } in rows {
        files.iter().for_each(|(name, bytes)| folder.write(name, bytes));
        let text = format!("{CAMERA}{scene}");
        let (facts, messages) = match parse_within(&folder.path("s.toml"), &text, Limits::default()) {
            Ok(Loaded { scene, warnings }) => {
                (facts(&scene, &expected), warnings.iter().map(ToString::to_string).collect())
            }
            Err(error) => (String::new(), vec![error.to_string()]),
        };
        let start = folder.path("").display().to_string();
        let messages: Vec<String> = messages.iter().map(|message| message.replace(&start, "")).collect();
        let mut wanted = expected.split(" | ");
        let as_expected = wanted.next().is_some_and(|wanted| wanted.trim() == facts)
            && wanted.clone().count() == messages.len()
            && wanted.zip(&messages).all(|(wanted, message)| message.starts_with(wanted));
        if !as_expected {
            let _ = writeln!(
                wrong,
                "{feature}\n  expected {expected}\n  got      {facts} | {}",
                messages.join(" | ")
            );
        }
        files.iter().for_each(|(name, _)| drop(std::fs::remove_file(folder.path(name))));
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The facts of a scene, in the words of the expectations.
fn facts(scene: &Scene, expected: &str) -> String {
    let mut facts: Vec<String> = Vec::new();
    for mesh in &scene.meshes {
        let mesh = &mesh.mesh;
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
        if expected.contains("area") {
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
    words.extend(material.texture.map(|_| "texture".into()));
    words.join(" ")
}
