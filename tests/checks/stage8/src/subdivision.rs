//! Loop's subdivision: what belongs to what, and where it goes.

use super::quarters::triangles_are_quarters;
use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::known;
use glam::{DVec3, Vec3, vec2, vec3};
use raykata::mesh::Mesh;
use std::collections::{BTreeMap, BTreeSet};

fn tetrahedron() -> Mesh {
    Mesh {
        positions: vec![
            vec3(1.0, 1.0, 1.0),
            vec3(-1.0, -1.0, 1.0),
            vec3(-1.0, 1.0, -1.0),
            vec3(1.0, -1.0, -1.0),
        ],
        triangles: vec![[0, 1, 3], [0, 2, 1], [0, 3, 2], [1, 2, 3]],
        ..Mesh::default()
    }
}

/// Six corners with four neighbours each.
fn octahedron() -> Mesh {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    Mesh {
        positions: vec![x, y, z, -x, -y, -z],
        triangles: vec![
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ],
        ..Mesh::default()
    }
}

/// A sheet of `n` by `n` squares, bent up, with texture coordinates and two materials.
fn sheet(n: u32) -> Mesh {
    let side = n + 1;
    let at = |i: u32| vec2((i % side) as f32, (i / side) as f32);
    let square = |row: u32, column: u32| {
        let a = row * side + column;
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    };
    let triangles: Vec<[u32; 3]> =
        (0..n).flat_map(|row| (0..n).flat_map(move |column| square(row, column))).collect();
    Mesh {
        positions: (0..side * side).map(|i| vec3(at(i).x, at(i).y, at(i).x * at(i).y / 4.0)).collect(),
        uvs: (0..side * side).map(|i| at(i) / n as f32).collect(),
        face_materials: (0..triangles.len() as u32).map(|face| face % 2).collect(),
        material_names: vec!["warp".into(), "weft".into()],
        triangles,
        ..Mesh::default()
    }
}

/// By name, with what it is for.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let round = octahedron();
    let round = Mesh { normals: round.positions.clone(), ..round };
    let mut lonely = tetrahedron();
    lonely.positions.push(vec3(5.0, 5.0, 5.0));
    vec![
        ("a tetrahedron", tetrahedron()),
        ("an octahedron with normals", round),
        ("a single triangle", Mesh { triangles: vec![[0, 1, 2]], face_materials: vec![1], ..sheet(1) }),
        ("a sheet of 3 by 3 squares", sheet(3)),
        ("a tetrahedron and a vertex of no triangle", lonely),
    ]
}

/// The edges, the smaller end first, each with the third corners of its triangles.
fn edges(mesh: &Mesh) -> BTreeMap<(u32, u32), Vec<u32>> {
    let mut edges: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (p, q, r) in [(a, b, c), (b, c, a), (c, a, b)] {
            edges.entry((p.min(q), p.max(q))).or_default().push(r);
        }
    }
    edges
}

/// Where the vertices belong: the old ones by number, the new ones by edge.
fn places(mesh: &Mesh) -> (Vec<DVec3>, BTreeMap<(u32, u32), DVec3>) {
    let at = |vertex: u32| mesh.positions[vertex as usize].as_dvec3();
    let edges = edges(mesh);
    let on_edge = |(&(p, q), opposite): (&(u32, u32), &Vec<u32>)| {
        let place = match opposite[..] {
            [r, s] => 0.375 * (at(p) + at(q)) + 0.125 * (at(r) + at(s)),
            _ => 0.5 * (at(p) + at(q)),
        };
        ((p, q), place)
    };
    let moved = |vertex: u32| {
        let around: Vec<(u32, bool)> = edges
            .iter()
            .filter(|((p, q), _)| *p == vertex || *q == vertex)
            .map(|((p, q), opposite)| (p + q - vertex, opposite.len() == 1))
            .collect();
        let border: Vec<u32> = around.iter().filter(|(_, border)| *border).map(|(other, _)| *other).collect();
        match (border[..].len(), around.len()) {
            (_, 0) => at(vertex),
            (0, n) => {
                let beta = if n == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * n as f64) };
                let sum: DVec3 = around.iter().map(|(other, _)| at(*other)).sum();
                (1.0 - n as f64 * beta) * at(vertex) + beta * sum
            }
            _ => 0.75 * at(vertex) + 0.125 * (at(border[0]) + at(border[1])),
        }
    };
    ((0..mesh.positions.len() as u32).map(moved).collect(), edges.iter().map(on_edge).collect())
}

/// What came back, what should have, and what that looks like.
pub(super) type Unlike = (String, String, &'static str);

/// Judges one thing of every mesh.
fn judge(trial: &Trial<'_>, law: impl Fn(&Mesh, &Mesh) -> Result<(), Unlike>) -> Outcome {
    let meshes = meshes();
    let queries: Vec<Mesh> = meshes.iter().map(|(_, mesh)| mesh.clone()).collect();
    let pairs: Vec<_> = meshes.iter().zip(trial.kit.loop_subdivide(&queries)).collect();
    pairs.iter().try_for_each(|((name, mesh), yours)| {
        law(mesh, yours).map_err(|(got, expected, diagnosis)| {
            Broken::told(format!("loop_subdivide of {name}"), got, expected, "the rule")
                .looks_like(known(diagnosis))
        })
    })
}

pub(super) fn loop_makes_four_triangles_of_each(trial: &Trial<'_>) -> Outcome {
    judge(trial, |mesh, yours| {
        let (n_old, n_edges) = (mesh.positions.len(), edges(mesh).len());
        let told =
            |mesh: &Mesh| format!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
        let (vertices, triangles) = (n_old + n_edges, 4 * mesh.triangles.len());
        if (yours.positions.len(), yours.triangles.len()) != (vertices, triangles) {
            let diagnosis = match yours.positions.len() {
                n if n > vertices => {
                    "one vertex an edge, not two: triangles on both sides share it, or cracks open"
                }
                _ if yours.triangles.len() != triangles => {
                    "each triangle becomes four: three at its corners and one in the middle"
                }
                _ => "",
            };
            return Err((told(yours), format!("{vertices} vertices, {triangles} triangles"), diagnosis));
        }
        if !yours.normals.is_empty() {
            let told = format!("{} normals", yours.normals.len());
            return Err((told, "none".into(), "normals are dropped: the surface is another one"));
        }
        let lengths = [
            (mesh.uvs.len(), yours.uvs.len(), vertices, "texture coordinates: each vertex has its own"),
            (
                mesh.face_materials.len(),
                yours.face_materials.len(),
                triangles,
                "the four take the material of the one",
            ),
        ];
        for (before, yours, each, diagnosis) in lengths {
            let right = if before == 0 { 0 } else { each };
            if yours != right {
                let what = diagnosis.split(':').next().filter(|_| each == vertices).unwrap_or("materials");
                return Err((format!("{yours} {what}"), format!("{right}"), diagnosis));
            }
        }
        yours.validate().map_err(|message| (message, "a sound mesh".into(), ""))?;
        triangles_are_quarters(mesh, yours)
    })
}

const BORDER: &str = "a border depends on its own vertices only, or two sheets side by side would part";
const FROM_BEFORE: &str = "all places are from before the step: what has moved already pulls others too far";

/// Where a vertex of an edge belongs if the old ones had moved before.
fn between_moved_ones(mesh: &Mesh, yours: &Mesh, edge: (u32, u32)) -> DVec3 {
    let n_old = mesh.positions.len();
    let moved = Mesh { positions: yours.positions[..n_old].to_vec(), ..mesh.clone() };
    places(&moved).1[&edge]
}

/// What has gone wrong with an old vertex.
fn of_an_old_vertex(mesh: &Mesh, yours: &Mesh, vertex: usize, border: bool) -> &'static str {
    let near = |right: DVec3| (yours.positions[vertex].as_dvec3() - right).length() <= 1e-5;
    let mut half_moved = mesh.clone();
    half_moved.positions[..vertex].copy_from_slice(&yours.positions[..vertex]);
    let neighbours: BTreeSet<usize> = mesh
        .triangles
        .iter()
        .filter(|triangle| triangle.contains(&(vertex as u32)))
        .flat_map(|triangle| triangle.map(|other| other as usize))
        .filter(|&other| other != vertex)
        .collect();
    let (old, n) = (mesh.positions[vertex].as_dvec3(), neighbours.len() as f64);
    let beta = if neighbours.len() == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * n) };
    let sum: DVec3 = neighbours.iter().map(|&other| mesh.positions[other].as_dvec3()).sum();
    match () {
        () if neighbours.is_empty() => "a vertex of no triangle stays where it is",
        () if near(old) => "old vertices move, too",
        () if near(places(&half_moved).0[vertex]) => FROM_BEFORE,
        () if border && near((1.0 - n * beta) * old + beta * sum) => BORDER,
        () if border => "3/4 of itself and 1/8 of either neighbour along the border",
        () if near((1.0 - beta) * old + beta * sum) => {
            "the weights must add up to 1: each of the n neighbours takes β, and 1 - n β is left"
        }
        () => "β is 3/16 for three neighbours, and 3/8 divided by their number otherwise",
    }
}

/// The vertices of edges, each found as the nearest of the new ones.
fn compare_places(mesh: &Mesh, yours: &Mesh, border: bool) -> Result<(), Unlike> {
    let (old, new) = places(mesh);
    let edges = edges(mesh);
    let on_border: BTreeSet<u32> =
        edges.iter().filter(|(_, opposite)| opposite.len() == 1).flat_map(|((p, q), _)| [*p, *q]).collect();
    // Sums of a handful of numbers up to 9.
    let near = |yours: Vec3, right: DVec3| (yours.as_dvec3() - right).length() <= 1e-5;
    for (vertex, right) in
        old.iter().enumerate().filter(|(vertex, _)| on_border.contains(&(*vertex as u32)) == border)
    {
        let Some(&place) = yours.positions.get(vertex) else { break };
        if !near(place, *right) {
            let diagnosis = of_an_old_vertex(mesh, yours, vertex, border);
            return Err((format!("vertex {vertex} at {place}"), format!("{}", right.as_vec3()), diagnosis));
        }
    }
    for (edge, right) in new.iter().filter(|(edge, _)| (edges[*edge].len() == 1) == border) {
        let fresh = yours.positions.get(mesh.positions.len()..).unwrap_or_default();
        if !fresh.iter().any(|&place| near(place, *right)) {
            let middle = 0.5 * (mesh.positions[edge.0 as usize] + mesh.positions[edge.1 as usize]);
            let at_middle = fresh.iter().any(|&place| near(place, middle.as_dvec3()));
            let moved = between_moved_ones(mesh, yours, *edge);
            let diagnosis = match () {
                () if fresh.iter().any(|&place| near(place, moved)) => FROM_BEFORE,
                () if border => BORDER,
                () if at_middle => "the middle of the edge is for borders: inside, the third corners pull",
                () => "3/8 of both ends and 1/8 of both third corners",
            };
            return Err((
                format!("no new vertex for the edge {} {}", edge.0, edge.1),
                format!("one at {}", right.as_vec3()),
                diagnosis,
            ));
        }
    }
    Ok(())
}

pub(super) fn loop_places_vertices_by_the_rule(trial: &Trial<'_>) -> Outcome {
    judge(trial, |mesh, yours| compare_places(mesh, yours, false))
}

pub(super) fn loop_borders_depend_on_borders(trial: &Trial<'_>) -> Outcome {
    judge(trial, |mesh, yours| compare_places(mesh, yours, true))
}
