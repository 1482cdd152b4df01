//! A table of hits and a picture, both compared with references.

use super::method::{CHOICE, CRAMER, GRAM};
use super::vertex_normals::octahedron;
use checks::golden::Table;
use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;
use glam::Quat;
use raykata::mesh::Mesh;

/// The hits of each method on a fan of 25 rays, to four digits, because the methods differ in later digits.
pub(super) fn hit_table_of_a_fan(trial: &Trial<'_>) -> CheckResult {
    let shift = || (-0.2..0.2f32, -0.2..0.2f32, -0.5..0.5f32).prop_map(Vec3::from);
    let public = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, vec3(0.3, 0.2, 4.0));
    let (a, b, c, eye) = trial.composed(
        public,
        (shift(), shift(), shift(), shift().prop_map(|shift| vec3(0.3, 0.2, 4.0) + 2.0 * shift)),
    );
    let triangle =
        Triangle { a: a + vec3(-1.0, -1.0, 0.0), b: b + vec3(2.0, -0.5, 0.5), c: c + vec3(0.0, 2.0, -0.5) };
    let rays: Vec<TriangleQuery> = (0..25)
        .map(|i| {
            let target = vec3(-1.05 + 0.7 * (i % 5) as f32, -1.15 + 0.7 * (i / 5) as f32, 0.0);
            TriangleQuery { ray: Ray::new(eye, target - eye), triangle }
        })
        .collect();
    let lines = |kit: &dyn Kit| {
        let hits = [CRAMER, GRAM, CHOICE].map(|method| (method.name, (method.ask)(kit, &rays)));
        let line = |(index, query): (usize, &TriangleQuery)| {
            let hit = |(name, hits): &(&str, Vec<Option<TriangleHit>>)| {
                let hit = hits[index];
                let hit =
                    hit.map_or("-".into(), |hit| format!("{:.4} {:.4} {:.4}", hit.t, hit.beta, hit.gamma));
                format!("  {name} {hit}")
            };
            let target = query.ray.at(1.0);
            format!("({:.2} {:.2})", target.x, target.y) + &hits.each_ref().map(hit).concat()
        };
        rays.iter().enumerate().map(line).collect::<Vec<String>>().join("\n")
    };
    let input = format!("a fan of 25 rays from {eye}");
    Table { name: "stage2_hit_table", input: &input }.check(trial, lines)
}

fn colors(kit: &dyn Kit, rays: &[Ray], mesh: &Mesh) -> Vec<Vec3> {
    let mut nearest: Vec<(f32, Vec3)> = vec![(f32::INFINITY, Vec3::ZERO); rays.len()];
    let normals = kit.vertex_normals(std::slice::from_ref(mesh)).remove(0);
    for (face, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(face);
        let queries: Vec<TriangleQuery> =
            rays.iter().map(|&ray| TriangleQuery { ray, triangle: Triangle { a, b, c } }).collect();
        let hits = kit.triangle_choice(&queries);
        let weights: Vec<InterpolateQuery> = hits
            .iter()
            .map(|hit| hit.map_or(Vec3::ZERO, |hit| vec3(1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma)))
            .map(|barycentric| InterpolateQuery {
                barycentric,
                corners: corners.map(|corner| normals[corner as usize]),
            })
            .collect();
        for ((pixel, hit), normal) in nearest.iter_mut().zip(hits).zip(kit.interpolate(&weights)) {
            if let Some(hit) = hit.filter(|hit| hit.t < pixel.0) {
                *pixel = (hit.t, picture::normal_color(normal.normalize_or_zero()));
            }
        }
    }
    nearest.into_iter().map(|(_, color)| color).collect()
}

pub(super) fn picture_of_an_octahedron(trial: &Trial<'_>) -> CheckResult {
    let turns = (-1.0..1f32, -0.5..0.5f32, 0.7..1f32);
    let (turn, tilt, size) = trial.composed((0.0, 0.0, 1.0), turns);
    let turn = Quat::from_rotation_x(tilt) * Quat::from_rotation_y(turn);
    let mut mesh = octahedron();
    mesh.positions.iter_mut().for_each(|position| *position = size * (turn * *position));
    let rays = picture::rays(trial, LARGE, vec3(1.2, 1.6, 2.4), Vec3::ZERO);
    // The outline crosses about 120 of 4800 pixels. There rounding decides whether a ray hits or misses.
    let composed = Composed { name: "stage2_octahedron", size: LARGE, rays: &rays, may_differ: 0.002 };
    composed.check(trial, |kit| colors(kit, &rays, &mesh))
}
