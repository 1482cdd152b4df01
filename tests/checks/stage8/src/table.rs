//! The table of stage 8: points of a Bézier patch, and a subdivided mesh.

use checks::golden::{Table, digits};
use checks::prelude::*;
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;

/// An open mesh of three triangles around a vertex and two beside them. Its vertices have different x, so that the new ones can
/// be sorted. All rules agree about a vertex with three neighbours.
fn mesh(shift: Vec3) -> Mesh {
    let positions = [
        vec3(0.15, 0.6, 1.0),
        vec3(1.3, 0.1, 0.2),
        vec3(0.4, 1.5, -0.1),
        vec3(-1.2, 0.3, 0.3),
        vec3(-0.35, -1.4, 0.1),
        vec3(2.0, 1.7, -0.6),
    ];
    Mesh {
        positions: positions.iter().map(|position| *position + position.x * shift).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 4], [1, 5, 2]],
        ..Mesh::default()
    }
}

fn patch(height: f32, shift: Vec3) -> BezierPatch {
    let point = |row: usize, column: usize| {
        let (x, y) = (column as f32 - 1.5, row as f32 - 1.5);
        vec3(x, y, height * (x * y).cos() + 0.2 * x) + (0.3 * y) * shift
    };
    BezierPatch { rows: std::array::from_fn(|row| std::array::from_fn(|column| point(row, column))) }
}

fn lines(kit: &dyn Kit, height: f32, shift: Vec3) -> String {
    let vector = |v: Vec3| v.to_array().map(|x| digits(x, 4)).join(" ");
    let parameters: Vec<_> = (0..25).map(|i| vec2((i % 5) as f32, (i / 5) as f32) / 4.0).collect();
    let patch = patch(height, shift);
    let points = kit.bezier_point(&parameters.iter().map(|&uv| PatchQuery { patch, uv }).collect::<Vec<_>>());
    let mut lines: Vec<String> = parameters
        .iter()
        .zip(points)
        .map(|(uv, point)| format!("bezier_point {:.2} {:.2}  {}", uv.x, uv.y, vector(point)))
        .collect();
    let fine = kit.loop_subdivide(&[mesh(shift)]).remove(0);
    lines.push(format!("loop_subdivide {} triangles", fine.triangles.len()));
    let mut vertices = fine.positions;
    vertices.sort_by(|p, q| p.x.total_cmp(&q.x));
    lines.extend(vertices.into_iter().map(|vertex| format!("vertex {}", vector(vertex))));
    lines.join("\n")
}

pub(super) fn table_of_curved_surfaces(trial: &Trial<'_>) -> CheckResult {
    let shifts =
        (0.3..1.5f32, -0.2..0.2f32, 0.1..0.5f32).prop_map(|(height, y, z)| (height, vec3(0.0, y, z)));
    let (height, shift) = trial.composed((0.8, Vec3::ZERO), shifts);
    let input = "25 points of a Bézier patch, and five triangles after one step of Loop subdivision";
    Table { name: "stage8_curved_surfaces", input }.check(trial, |kit| lines(kit, height, shift))
}
