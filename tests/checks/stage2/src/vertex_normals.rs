//! Normals of the vertices of a mesh.

use checks::all_parts;
use checks::prelude::*;
use raykata::mesh::Mesh;

pub(super) fn octahedron() -> Mesh {
    let corner = |i: u32| [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z][i as usize];
    let triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    Mesh { positions: (0..6).map(corner).collect(), triangles, ..Mesh::default() }
}

/// The sums of all faces around a vertex, each weighted in another way.
#[derive(Default)]
struct Sums {
    faces: Vec<DVec3>,
    plain: DVec3,
    by_area: DVec3,
    by_angle: DVec3,
}

fn sums(mesh: &Mesh, vertex: usize) -> Sums {
    sums_of(mesh, &mesh.triangles, vertex, 3)
}

/// The same for some triangles, which count for the vertices of their first corners only.
fn sums_of(mesh: &Mesh, triangles: &[[u32; 3]], vertex: usize, corners_that_count: usize) -> Sums {
    let mut sums = Sums::default();
    for corners in triangles {
        let counting = &corners[..corners_that_count];
        let Some(place) = counting.iter().position(|&corner| corner as usize == vertex) else { continue };
        let at = |turn: usize| mesh.positions[corners[(place + turn) % 3] as usize].as_dvec3();
        let (u, v) = (at(1) - at(0), at(2) - at(0));
        let cross = u.cross(v);
        let Some(normal) = cross.try_normalize() else { continue };
        sums.faces.push(normal);
        sums.plain += normal;
        sums.by_area += cross;
        sums.by_angle += u.angle_between(v) * normal;
    }
    sums
}

const WRONG_COUNT: &str = "the result has one normal per vertex, not per triangle or corner";

/// The normals of a mesh are judged per vertex. A sum that nearly cancels is judged by its length only.
fn judge(what: &str, mesh: &Mesh, normals: &[Vec3]) -> Judged {
    if normals.len() != mesh.positions.len() {
        let [yours, expected] = [normals.len(), mesh.positions.len()].map(|n| format!("{n} normals"));
        return Err(Broken::with_texts(what, yours, expected, "one per vertex").explained_by([
            (normals.len() == 3 * mesh.triangles.len(), WRONG_COUNT),
            (normals.len() == mesh.triangles.len(), WRONG_COUNT),
        ]));
    }
    all_parts(normals.iter().enumerate().map(|(vertex, &yours)| judge_one(what, mesh, vertex, yours)))
}

const NOT_NORMALIZED: &str = "your normal is not of unit length: normalize the sum";
const ONE_FACE: &str = "you return the normal of one face: add up those of all faces around the vertex";

fn judge_one(what: &str, mesh: &Mesh, vertex: usize, yours: Vec3) -> Judged {
    let sums = sums(mesh, vertex);
    let near = |n: DVec3| (yours.as_dvec3() - n).length() < 1e-5;
    let unit = (yours.length() - 1.0).abs() < 1e-5;
    let cancels = sums.plain.length() < 1e-6;
    let average = sums.plain.normalize_or_zero();
    let right = match (sums.faces.is_empty(), cancels) {
        (true, _) => unit,
        (_, true) => sums.faces.iter().any(|&face| near(face)),
        // The error of a sum of unit vectors grows as the sum becomes shorter.
        _ => unit && (yours.as_dvec3() - average).length() < 1e-5 / sums.plain.length().min(1.0),
    };
    let expected = match sums.faces.first() {
        None => Vec3::Z,
        Some(face) if cancels => face.as_vec3(),
        Some(_) => average.as_vec3(),
    };
    let input = || format!("{what}, vertex {vertex} at {}", mesh.positions[vertex].paste());
    let has_faces = !sums.faces.is_empty();
    let is = |n: DVec3| has_faces && near(n.normalize_or_zero());
    let source = if cancels { "a face, because the sum is 0" } else { "double precision" };
    let broken = || {
        Broken::new(input(), yours, expected, source).explained_by([
        "a sum of 0 has no direction (0/0 is NaN): take the normal of one face, or any unit vector if there is none"
            .when(cancels && (yours.is_nan() || yours.length() < 1e-3)),
        (yours.is_nan(), "you return NaN: a triangle without area has no normal and does not count"),
        (has_faces && !unit && near(sums.plain), NOT_NORMALIZED),
        (has_faces && !unit && near(sums.plain / sums.faces.len() as f64), NOT_NORMALIZED),
        (cancels && has_faces && unit, "the normals cancel, and you return none of them: take the normal of one of the triangles"),
        (is(-sums.plain), "your normal points inwards: is the face normal u × v?"),
    ])
    };
    // Where any direction passes, each formula may give each answer.
    let is_open = right && (cancels || !has_faces);
    // The normal of one face in place of a sum that is shorter than a limit.
    let too_early = [0.05, 0.1, 0.2, 0.25, 0.5, 0.75, 1.0].map(|limit| {
        let gives =
            if sums.plain.length() < limit { sums.faces.iter().any(|&face| near(face)) } else { right };
        "a short sum is taken for one that cancels: normalize it, unless it consists of roundings"
            .when(is_open || gives)
    });
    // With some of the faces. Where they have no sum, any unit vector is possible.
    let adds = |sums: Sums| {
        is_open || if sums.plain.length() < 1e-6 { unit && !cancels } else { near(sums.plain.normalize()) }
    };
    let is_flat = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize].as_dvec3());
        (b - a).cross(c - a) == DVec3::ZERO
    };
    let until_flat = mesh.triangles.iter().position(is_flat).unwrap_or(mesh.triangles.len());
    unless(right, broken).formulas(
        too_early.into_iter().chain([
            "you weight each face by its area: normalize the face normals before you add them"
                .when(is_open || is(sums.by_area)),
            "your sums end at the first triangle without area: it does not count, but those after it do"
                .when(adds(sums_of(mesh, &mesh.triangles[..until_flat], vertex, 3))),
            "you add a face to its first corner only: it counts at all three of its corners"
                .when(adds(sums_of(mesh, &mesh.triangles, vertex, 1))),
            (is_open || is(sums.by_angle), "you weight each face by its angle: each triangle counts once"),
            (is_open || sums.faces.first().is_some_and(|&face| near(face)), ONE_FACE),
            (is_open || sums.faces.last().is_some_and(|&face| near(face)), ONE_FACE),
        ]),
    )
}

fn judge_all(trial: &Trial<'_>, what: &str, meshes: &[Mesh]) -> Vec<CheckResult> {
    compare(meshes, trial.kit.vertex_normals(meshes), |mesh, normals| judge(what, mesh, &normals))
}

/// Faces around vertex 0, with angles and areas that differ. Some of them do not have their neighbour as next one.
fn fans() -> impl Strategy<Value = Mesh> + Clone {
    let faces = prop::collection::vec((0..6u32, 0..6u32, any::<bool>()), 1..6);
    let around = prop::collection::vec(point(2), 6);
    let points = (point(2), around).prop_map(|(tip, around)| [vec![tip], around].concat());
    let differ = |points: &Vec<Vec3>| (1..7).all(|index| !points[..index].contains(&points[index]));
    (points.prop_filter("equal points", differ), faces).prop_map(|(positions, faces)| {
        let triangles = faces
            .into_iter()
            .map(|(p, q, first)| if first { [0, p + 1, q + 1] } else { [q + 1, 0, p + 1] })
            .collect();
        Mesh { positions, triangles, ..Mesh::default() }
    })
}

/// Whether rounding may decide: a thin triangle, whose normal may be lost, or a sum that almost cancels.
fn is_open(mesh: &Mesh) -> bool {
    let thin = mesh.triangles.iter().any(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize].as_dvec3());
        let (u, v) = (b - a, c - a);
        let area = u.cross(v).length();
        area < 0.02 * u.length() * v.length() && u.cross(v) != DVec3::ZERO
    });
    let cancels = |vertex| {
        let sums = sums(mesh, vertex);
        !sums.faces.is_empty() && sums.plain.length() < 0.02 && sums.plain != DVec3::ZERO
    };
    // Edges in the same line are not exactly parallel once each of them is scaled.
    let flat = mesh.triangles.iter().any(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        (b - a).cross(c - a) == Vec3::ZERO && a != b && b != c && c != a
    });
    thin || flat || (0..mesh.positions.len()).any(cancels)
}

pub(super) fn vertex_normals_average_their_faces(trial: &Trial<'_>) -> CheckResult {
    // The average counts each face once, whatever its area: one large face points up, one small face to the side.
    let corner = Mesh {
        positions: vec![Vec3::ZERO, 8.0 * Vec3::X, 8.0 * Vec3::Y, vec3(0.0, 0.0, 0.125), vec3(0.0, 4.0, 0.0)],
        triangles: vec![[0, 1, 2], [0, 4, 3]],
        ..Mesh::default()
    };
    all_hold(
        [
            judge_all(trial, "an octahedron", &[octahedron()]),
            judge_all(trial, "a floor and a thin wall", &[corner]),
        ]
        .concat(),
    )?;
    trial.each(600, fans(), <dyn Kit>::vertex_normals, |mesh, normals| {
        if is_open(mesh) {
            return Ok(().into());
        }
        let positions: Vec<String> = mesh.positions.iter().map(Paste::paste).collect();
        let what = format!("positions [{}], triangles {:?}", positions.join(", "), mesh.triangles);
        judge(&what, mesh, &normals)
    })
}

pub(super) fn vertex_normals_that_cancel_are_still_normals(trial: &Trial<'_>) -> CheckResult {
    // A sheet whose two sides are faces, a face without area, and a vertex without faces.
    let sheet = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, vec3(5.0, 5.0, 5.0)],
        triangles: vec![[0, 1, 2], [0, 2, 1], [0, 1, 1]],
        ..Mesh::default()
    };
    let nothing = Mesh::default();
    let flat = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, 2.0 * Vec3::X],
        triangles: vec![[0, 1, 3], [0, 1, 2], [3, 3, 3]],
        ..Mesh::default()
    };
    let meshes =
        [("a sheet with two sides", sheet), ("a mesh of nothing", nothing), ("a flat triangle", flat)];
    all_hold(meshes.into_iter().flat_map(|(what, mesh)| judge_all(trial, what, &[mesh])).collect())
}
