//! Patches and subdivision.

use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::generate::point;
use crate::judge::{compare, known};
use crate::paste::{Paste, list};
use glam::{DVec3, Vec2, Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::kit::PatchQuery;
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;
use std::collections::{BTreeMap, BTreeSet};

fn patch() -> impl Strategy<Value = BezierPatch> + Clone {
    prop::collection::vec(point(4), 16).prop_map(|points| {
        let row = |row: usize| [0, 1, 2, 3].map(|column| points[4 * row + column]);
        BezierPatch { rows: [0, 1, 2, 3].map(row) }
    })
}

fn told(query: &PatchQuery) -> String {
    let rows: Vec<String> = query.patch.rows.iter().map(list).collect();
    format!("bezier_point(&BezierPatch {{ rows: [{}] }}, {})", rows.join(",\n"), query.uv.paste())
}

pub(super) fn bezier_starts_and_ends_at_its_corners(trial: &Trial<'_>) -> Outcome {
    let rough = patch().prop_map(|mut patch| {
        // Thirds, which no formula that adds differences gives back exactly.
        patch.rows.iter_mut().flatten().for_each(|point| *point /= 3.0);
        patch
    });
    trial.forall(200, rough, |patches| {
        let corners = [(0.0, 0.0, 0, 0), (1.0, 0.0, 0, 3), (0.0, 1.0, 3, 0), (1.0, 1.0, 3, 3)];
        let queries: Vec<PatchQuery> = patches
            .iter()
            .flat_map(|patch| corners.map(|(u, v, ..)| PatchQuery { patch: *patch, uv: vec2(u, v) }))
            .collect();
        let answers = trial.kit.bezier_point(&queries);
        let judge = |(i, query): (usize, &PatchQuery)| {
            let (.., row, column) = corners[i % 4];
            let (yours, corner) = (answers[i], query.patch.rows[row][column]);
            let diagnosis = match () {
                () if yours == query.patch.rows[column][row] => "u runs along the rows, v along the columns",
                () if (yours - corner).length() < 1e-5 => {
                    "p + t (q - p) is not q at t = 1: two patches side by side would not meet; blend with 1 - t and t"
                }
                () => "",
            };
            match yours == corner {
                true => Ok(()),
                false => Err(Broken::new(told(query), yours, corner, "the corner of the net")
                    .looks_like(known(diagnosis))),
            }
        };
        queries.iter().enumerate().map(judge).collect::<Vec<Outcome>>().chunks(4).map(|four| four.iter().cloned().collect()).collect()
    })
}

pub(super) fn bezier_point_is_the_mean_of_its_net(trial: &Trial<'_>) -> Outcome {
    let inputs = (patch(), 0..=8u32, 0..=8u32)
        .prop_map(|(patch, u, v)| PatchQuery { patch, uv: vec2(u as f32, v as f32) / 8.0 });
    trial.forall(1000, inputs, |queries| {
        compare(queries, trial.kit.bezier_point(queries), |query, yours| {
            let at = |uv: Vec2| -> DVec3 {
                let [across, along] = [uv.x, uv.y].map(|t| bernstein(f64::from(t)));
                let terms =
                    (0..16).map(|i| across[i % 4] * along[i / 4] * query.patch.rows[i / 4][i % 4].as_dvec3());
                terms.sum()
            };
            let right = at(query.uv);
            // Six blends, one on the other, of numbers up to 4: each is off by two roundings.
            let near = |right: DVec3| {
                (yours.as_dvec3() - right).abs().max_element() <= 16.0 * crate::double::U * 4.0
            };
            let diagnosis = match () {
                () if near(at(query.uv.yx())) => "u runs along the rows, v along the columns",
                () if near(at(Vec2::ONE - query.uv)) => "t and 1 - t are exchanged",
                () => "",
            };
            match near(right) {
                true => Ok(()),
                false => {
                    Err(Broken::new(told(query), yours, right.as_vec3(), "Bernstein polynomials in double")
                        .looks_like(known(diagnosis)))
                }
            }
        })
    })
}

fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

use glam::Vec2Swizzles;

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
    let mut lonely = tetrahedron();
    lonely.positions.push(vec3(5.0, 5.0, 5.0));
    vec![
        ("a tetrahedron", tetrahedron()),
        ("an octahedron", octahedron()),
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

/// Judges one thing of every mesh.
fn judge(
    trial: &Trial<'_>,
    law: impl Fn(&Mesh, &Mesh) -> Result<(), (String, String, &'static str)>,
) -> Outcome {
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
                _ => "",
            };
            return Err((told(yours), format!("{vertices} vertices, {triangles} triangles"), diagnosis));
        }
        yours.validate().map_err(|message| (message, "a sound mesh".into(), ""))?;
        // Around each old vertex and in the middle: by the numbers of the edges' vertices, which are found by their place.
        let directed: BTreeSet<(u32, u32)> =
            yours.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        if directed.len() != 3 * triangles {
            return Err((
                "triangles that share an edge run along it the same way".into(),
                "opposite ways".into(),
                "corners must stay anticlockwise in all four triangles",
            ));
        }
        let border = |mesh: &Mesh| edges(mesh).values().filter(|opposite| opposite.len() == 1).count();
        if border(yours) != 2 * border(mesh) {
            return Err((
                format!("{} edges of one triangle only", border(yours)),
                format!("{}", 2 * border(mesh)),
                "triangles do not share the vertices of their edges",
            ));
        }
        let count =
            |mesh: &Mesh, material: u32| mesh.face_materials.iter().filter(|&&one| one == material).count();
        if !mesh.face_materials.is_empty()
            && [0, 1].map(|m| 4 * count(mesh, m)) != [0, 1].map(|m| count(yours, m))
        {
            return Err((
                "materials of faces".into(),
                "each four times".into(),
                "the four take the material of the one",
            ));
        }
        if yours.uvs.len() != if mesh.uvs.is_empty() { 0 } else { vertices } {
            return Err((format!("{} texture coordinates", yours.uvs.len()), "one a vertex".into(), ""));
        }
        if !yours.normals.is_empty() {
            return Err(("normals".into(), "none: the surface is another one".into(), ""));
        }
        Ok(())
    })
}

/// The vertices of edges, each found as the nearest of the new ones.
fn compare_places(mesh: &Mesh, yours: &Mesh, border: bool) -> Result<(), (String, String, &'static str)> {
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
            let stays = place == mesh.positions[vertex];
            let diagnosis = match () {
                () if stays => "old vertices move, too",
                () if border => {
                    "a border depends on its own vertices only, or two sheets side by side would part"
                }
                () => "β is 3/16 for three neighbours, and 3/8 divided by their number otherwise",
            };
            return Err((format!("vertex {vertex} at {place}"), format!("{}", right.as_vec3()), diagnosis));
        }
    }
    for (edge, right) in new.iter().filter(|(edge, _)| (edges[*edge].len() == 1) == border) {
        let fresh = yours.positions.get(mesh.positions.len()..).unwrap_or_default();
        if !fresh.iter().any(|&place| near(place, *right)) {
            let middle = 0.5 * (mesh.positions[edge.0 as usize] + mesh.positions[edge.1 as usize]);
            let flat = !border && fresh.iter().any(|&place| near(place, middle.as_dvec3()));
            let diagnosis = if flat {
                "the middle of the edge is for borders: inside, the third corners pull"
            } else {
                ""
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
