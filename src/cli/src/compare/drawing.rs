//! Pictures: the boxes or cells of a structure over the scene, and the cost of each pixel.

use super::measure::Measured;
use crate::args::wrapped;
use crate::report::{Thousands, job, render};
use anyhow::{Context, Result};
use glam::{Vec2, Vec3};
use raykata::camera::Camera;
use raykata::film::{Film, encode_srgb};
use raykata::kit::{Kit, RenderJob, View, kit_error};
use raykata::scene::Scene;
use raykata::world::camera_for;
use std::path::Path;

/// The most edges that are drawn: with more, the picture is a blot.
const MOST_EDGES: usize = 200_000;

/// Writes `cells-ROW.png` for rows that have cells, and `tests-ROW.png` for all, in the same colours.
pub fn write(out: &Path, kit: &dyn Kit, scene: &Scene, rows: &[Measured], depth: u32) -> Result<()> {
    let mut works = Vec::new();
    for row in rows {
        let mut scene = scene.clone();
        scene.quality = row.row.quality;
        (scene.film.width, scene.film.height) = (row.film.width, row.film.height);
        let file = |what: &str| out.join(format!("{what}-{}.png", file_name(&row.name)));
        let job = RenderJob { view: View::Work, reuse: false, ..job(scene) };
        let edges = kit_error::catch(|| kit.outlines(&job, depth))?;
        if !edges.is_empty() {
            save(&with_edges(&row.film, &camera_for(&job.scene), &edges), &file("cells"))?;
        }
        works.push((file("tests"), render(kit, &job)?.film));
    }
    // Scale all pictures by the most expensive pixel of all, so that they can be compared.
    let most = works.iter().flat_map(|(_, film)| &film.pixels).map(|p| p.element_sum()).fold(1.0, f32::max);
    for (file, film) in &works {
        let mut heat = Film::new(film.width, film.height);
        heat.pixels = film.pixels.iter().map(|pixel| heat_color(pixel.element_sum(), most)).collect();
        save(&heat, file)?;
    }
    let scale = format!(
        "tests-*.png: visits, box tests and primitive tests of all rays of a pixel; black is 1, white is {}, \
         and the scale is logarithmic; the work of a packet is counted at one of its pixels",
        Thousands(most as u64)
    );
    println!("\n{}", wrapped(&scale, 2));
    Ok(())
}

fn save(film: &Film, file: &Path) -> Result<()> {
    film.write_png(file, encode_srgb).with_context(|| format!("cannot write {}", file.display()))
}

fn file_name(row: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    let name: String = row.chars().map(plain).collect();
    name.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

/// A colour from black over violet, red and yellow to white, on a logarithmic scale.
pub fn heat_color(tests: f32, most: f32) -> Vec3 {
    const COLORS: [Vec3; 5] = [
        Vec3::new(0.0, 0.0, 0.02),
        Vec3::new(0.18, 0.01, 0.3),
        Vec3::new(0.7, 0.06, 0.1),
        Vec3::new(0.98, 0.55, 0.05),
        Vec3::new(1.0, 1.0, 0.9),
    ];
    let share = (tests.max(1.0).ln() / most.max(2.0).ln()).clamp(0.0, 1.0) * (COLORS.len() - 1) as f32;
    let step = (share as usize).min(COLORS.len() - 2);
    COLORS[step].lerp(COLORS[step + 1], share - step as f32)
}

/// The picture, darker, with edges drawn over it.
pub fn with_edges(film: &Film, camera: &Camera, edges: &[[Vec3; 2]]) -> Film {
    let mut drawn = Film::new(film.width, film.height);
    drawn.pixels = film.pixels.iter().map(|pixel| 0.25 * pixel.clamp(Vec3::ZERO, Vec3::ONE)).collect();
    for edge in edges.iter().take(MOST_EDGES) {
        if let Some([p, q]) = projected(camera, (drawn.width, drawn.height), *edge) {
            line(&mut drawn, p, q);
        }
    }
    drawn
}

/// The ends of an edge in a film of this width and height, in pixels from the upper left; `None` if the edge lies behind the
/// camera.
pub fn projected(camera: &Camera, (width, height): (u32, u32), ends: [Vec3; 2]) -> Option<[Vec2; 2]> {
    let seen = ends.map(|end| {
        let way = end - camera.position;
        Vec3::new(way.dot(camera.right), way.dot(camera.up), way.dot(camera.towards))
    });
    // Clip the part behind the camera at a plane a little in front of it.
    let near = 1e-3 * seen[0].z.abs().max(seen[1].z.abs()).max(1e-6);
    let cut = |from: Vec3, to: Vec3| {
        if from.z >= near { from } else { from.lerp(to, (near - from.z) / (to.z - from.z)) }
    };
    if seen.iter().all(|end| end.z < near) {
        return None;
    }
    let flat = [cut(seen[0], seen[1]), cut(seen[1], seen[0])].map(|end| {
        let depth = if camera.orthographic { 1.0 } else { end.z };
        let x = 0.5 + end.x / (2.0 * depth * camera.half_height * camera.aspect);
        let y = 0.5 - end.y / (2.0 * depth * camera.half_height);
        Vec2::new(x * width as f32, y * height as f32)
    });
    let limit = 16.0 * width.max(height) as f32;
    flat.iter().all(|p| p.is_finite() && p.abs().max_element() < limit).then_some(flat)
}

/// A line of one pixel's width, drawn in steps of a pixel.
fn line(film: &mut Film, from: Vec2, to: Vec2) {
    const COLOR: Vec3 = Vec3::new(0.2, 0.75, 0.3);
    let steps = (to - from).abs().max_element().ceil().max(1.0) as u32;
    for step in 0..=steps {
        let at = from.lerp(to, step as f32 / steps as f32);
        if at.x >= 0.0 && at.y >= 0.0 && at.x < film.width as f32 && at.y < film.height as f32 {
            let pixel = &mut film.pixels[at.y as usize * film.width as usize + at.x as usize];
            // Blend the colour with the picture, so that what lies behind the lines remains visible.
            *pixel = pixel.lerp(COLOR, 0.35);
        }
    }
}
