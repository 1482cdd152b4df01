//! A table of hits and a picture, both compared with references.

use super::method::{CHOICE, CRAMER, GRAM};
use super::vertex_normals::octahedron;
use checks::broken::CheckResult;
use checks::{Trial, golden, picture};
use glam::{Vec3, vec3};
use raykata::kit::{InterpolateQuery, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The hits of each method on a fan of 25 rays, to four digits, because the methods differ in later digits.
pub(super) fn hit_table_of_a_fan(trial: &Trial<'_>) -> CheckResult {
    let triangle = Triangle { a: vec3(-1.0, -1.0, 0.0), b: vec3(2.0, -0.5, 0.5), c: vec3(0.0, 2.0, -0.5) };
    let eye = vec3(0.3, 0.2, 4.0);
    let rays: Vec<TriangleQuery> = (0..25)
        .map(|i| {
            let target = vec3(-1.05 + 0.7 * (i % 5) as f32, -1.15 + 0.7 * (i / 5) as f32, 0.0);
            TriangleQuery { ray: Ray::new(eye, target - eye), triangle }
        })
        .collect();
    for method in [CRAMER, GRAM, CHOICE] {
        let lines: Vec<String> = rays
            .iter()
            .zip((method.ask)(trial.kit, &rays))
            .map(|(query, hit)| {
                let target = query.ray.at(1.0);
                let hit =
                    hit.map_or("-".into(), |hit| format!("{:.4} {:.4} {:.4}", hit.t, hit.beta, hit.gamma));
                format!("({:.2} {:.2})  {hit}", target.x, target.y)
            })
            .collect();
        golden::compare(
            "stage2_hit_table",
            &format!("{} on a fan of 25 rays from {eye}", method.name),
            &lines.join("\n"),
        )?;
    }
    Ok(())
}

pub(super) fn picture_of_an_octahedron(trial: &Trial<'_>) -> CheckResult {
    let mesh = octahedron();
    let rays = picture::rays(trial, vec3(1.2, 1.6, 2.4), Vec3::ZERO);
    let mut nearest: Vec<(f32, Vec3)> = vec![(f32::INFINITY, Vec3::ZERO); rays.len()];
    let normals = trial.kit.vertex_normals(std::slice::from_ref(&mesh)).remove(0);
    for (face, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(face);
        let queries: Vec<TriangleQuery> =
            rays.iter().map(|&ray| TriangleQuery { ray, triangle: Triangle { a, b, c } }).collect();
        let hits = trial.kit.triangle_choice(&queries);
        let weights: Vec<InterpolateQuery> = hits
            .iter()
            .map(|hit| hit.map_or(Vec3::ZERO, |hit| vec3(1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma)))
            .map(|barycentric| InterpolateQuery {
                barycentric,
                corners: corners.map(|corner| normals[corner as usize]),
            })
            .collect();
        for ((pixel, hit), normal) in nearest.iter_mut().zip(hits).zip(trial.kit.interpolate(&weights)) {
            if let Some(hit) = hit.filter(|hit| hit.t < pixel.0) {
                *pixel = (hit.t, picture::normal_color(normal.normalize_or_zero()));
            }
        }
    }
    // The outline crosses about 120 of 4800 pixels. There rounding decides whether a ray hits or misses.
    let film = picture::film_of(nearest.into_iter().map(|(_, color)| color).collect());
    picture::compare(trial, "stage2_octahedron", &film, &rays, 0.002)
}
