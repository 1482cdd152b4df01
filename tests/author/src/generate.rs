//! `author generate`: makes the mesh of the showcase (a ribbed torus knot of 57,600 triangles), a tree, a field of
//! spheres, and the images of the scenes. So the repository contains no foreign meshes or images.

mod images;
mod spheres;
mod tree;

use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use grader::report::{make_folder, write_file};
use raykata_cli::args::{Argument, Given, Spec};
use std::f32::consts::TAU;
use std::path::Path;

/// `author generate`.
pub static SPEC: Spec = Spec {
    name: "author generate",
    about: "Generate the meshes and images of the scenes.",
    arguments: &[Argument::optional("SCENES", "The folder for meshes/ and images/ [default: scenes].")],
    options: &[],
};

/// The number of points along the knot and around its tube.
const ALONG: usize = 960;
const AROUND: usize = 30;

/// Writes the knot as a binary PLY file with normals, and the images, into folders of `scenes`.
pub fn run(given: &Given) -> Result<bool> {
    let scenes = Path::new(given.argument(0).unwrap_or("scenes".as_ref()));
    make_folder(&scenes.join("meshes"))?;
    make_folder(&scenes.join("images"))?;
    let knot = scenes.join("meshes/knot.ply");
    write_file(&knot, &ply())?;
    println!("wrote {}: {} triangles", knot.display(), 2 * ALONG * AROUND);
    let (tree, text) = (scenes.join("meshes/tree.obj"), tree::obj());
    write_file(&tree, text.as_bytes())?;
    let n_triangles = text.lines().filter(|line| line.starts_with('f')).count();
    println!("wrote {}: {n_triangles} triangles", tree.display());
    let field = scenes.join("spheres.toml");
    write_file(&field, spheres::toml().as_bytes())?;
    println!("wrote {}", field.display());
    for (name, picture) in images::all() {
        let out = scenes.join("images").join(name);
        let written = if name.ends_with(".hdr") {
            picture.write_hdr(&out)
        } else {
            picture.write_png(&out, raykata::film::encode_srgb)
        };
        written.with_context(|| format!("cannot write {}", out.display()))?;
        println!("wrote {}: {} × {} pixels", out.display(), picture.width, picture.height);
    }
    Ok(true)
}

/// Returns a point of the centre line of a (2, 3) torus knot.
fn center_line(s: f32) -> Vec3 {
    let (around, along) = (3.0 * s, 2.0 * s);
    let reach = 1.0 + 0.42 * around.cos();
    vec3(reach * along.cos(), 0.42 * around.sin(), reach * along.sin())
}

/// Returns a point of the tube. A twisted rib makes its radius vary.
fn surface(along: f32, around: f32) -> Vec3 {
    let step = 1e-2;
    let tangent = (center_line(along + step) - center_line(along - step)).normalize();
    let aside = tangent.cross(center_line(along)).normalize();
    let up = aside.cross(tangent);
    let radius = 0.19 * (1.0 + 0.12 * (5.0 * around + 40.0 * along).sin());
    center_line(along) + radius * (around.cos() * aside + around.sin() * up)
}

fn vertex(i: usize, j: usize) -> (Vec3, Vec3) {
    let (along, around) = (TAU * i as f32 / ALONG as f32, TAU * j as f32 / AROUND as f32);
    let step = 2e-3;
    let d_along = surface(along + step, around) - surface(along - step, around);
    let d_around = surface(along, around + step) - surface(along, around - step);
    (surface(along, around), d_around.cross(d_along).normalize())
}

fn ply() -> Vec<u8> {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment a torus knot, made by raykata generate; CC0\nelement vertex {}\n\
         property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        ALONG * AROUND,
        ALONG * AROUND
    );
    let mut bytes = header.into_bytes();
    for i in 0..ALONG {
        for j in 0..AROUND {
            let (point, normal) = vertex(i, j);
            point.to_array().into_iter().chain(normal.to_array()).for_each(|x| bytes.extend(x.to_le_bytes()));
        }
    }
    let index = |i: usize, j: usize| (i % ALONG * AROUND + j % AROUND) as i32;
    for i in 0..ALONG {
        for j in 0..AROUND {
            bytes.push(4);
            let quad = [index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)];
            quad.into_iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        }
    }
    bytes
}
