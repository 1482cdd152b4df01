//! Checks of `loop_subdivide`: the triangles and the positions of their vertices.

use super::quarters::triangles_are_quarters;
use checks::prelude::*;
use raykata::mesh::Mesh;

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
        // Squares, because all means of coordinates that grow evenly are equal.
        uvs: (0..side * side).map(|i| (at(i) / n as f32).powf(2.0)).collect(),
        face_materials: (0..triangles.len() as u32).map(|face| face % 2).collect(),
        material_names: vec!["warp".into(), "weft".into()],
        triangles,
        ..Mesh::default()
    }
}

/// Two pyramids of `n` sides on a common base: the apexes have `n` neighbours.
fn bipyramid(n: u32) -> Mesh {
    let corner = |i: u32| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / n as f32).sin_cos();
        vec3(2.0 * cos, 0.25 * (i % 2) as f32, 2.0 * sin)
    };
    let sides = |i: u32| [[n, i, (i + 1) % n], [n + 1, (i + 1) % n, i]];
    Mesh {
        positions: (0..n).map(corner).chain([vec3(0.25, -2.0, 0.0), vec3(0.0, 2.0, 0.5)]).collect(),
        triangles: (0..n).flat_map(sides).collect(),
        ..Mesh::default()
    }
}

/// Two triangles whose edges lie upon each other, but which have no common vertex: both edges are borders.
fn seam() -> Mesh {
    let (a, b) = (vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0));
    Mesh {
        positions: vec![a, b, vec3(1.0, 2.0, 0.0), b, a, vec3(1.0, -2.0, 1.0)],
        triangles: vec![[0, 1, 2], [3, 4, 5]],
        ..Mesh::default()
    }
}

/// The meshes of the checks, with their names.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let round = octahedron();
    let round = Mesh { normals: round.positions.clone(), ..round };
    let mut lonely = tetrahedron();
    lonely.positions.push(vec3(5.0, 5.0, 5.0));
    vec![
        ("an octahedron with normals", round),
        ("a tetrahedron", tetrahedron()),
        ("a single triangle", Mesh { triangles: vec![[0, 1, 2]], face_materials: vec![1], ..sheet(1) }),
        ("a sheet of 3 by 3 squares", sheet(3)),
        ("a tetrahedron and a vertex of no triangle", lonely),
        ("two pyramids of 5 sides on a common base", bipyramid(5)),
        ("two pyramids of 7 sides on a common base", bipyramid(7)),
        ("two triangles that touch and have no common vertex", seam()),
    ]
}

/// The edges, the smaller end first: all pairs of vertices that belong to a common triangle.
pub(super) fn edges(mesh: &Mesh) -> Vec<(u32, u32)> {
    let n = mesh.positions.len() as u32;
    let pairs = (0..n).flat_map(|q| (0..q).map(move |p| (p, q)));
    pairs.filter(|&edge| !opposite(mesh, edge).is_empty()).collect()
}

/// The third corners of the triangles to which both vertices belong.
pub(super) fn opposite(mesh: &Mesh, (p, q): (u32, u32)) -> Vec<u32> {
    let both = mesh.triangles.iter().filter(|triangle| triangle.contains(&p) && triangle.contains(&q));
    both.flat_map(|triangle| triangle.iter().copied().filter(|&vertex| vertex != p && vertex != q)).collect()
}

/// A broken law of a mesh. [`judge`] adds the name of the mesh.
pub(super) fn unlike(got: impl Into<String>, expected: impl Into<String>) -> Broken {
    Broken::with_texts("", got, expected, "the rule")
}

/// Judges some laws for every mesh.
pub(super) fn judge(trial: &Trial<'_>, laws: impl Fn(&Mesh, &Mesh) -> Vec<CheckResult>) -> CheckResult {
    let meshes = meshes();
    judge_meshes(trial, &meshes, &laws)?;
    // The same meshes with other numbers of their vertices.
    let orders: Vec<_> = meshes.iter().map(|(_, mesh)| (0..mesh.positions.len()).collect()).collect();
    let orders = orders.into_iter().map(|order: Vec<usize>| Just(order).prop_shuffle());
    trial.forall(1, orders.collect::<Vec<_>>(), |drawn| {
        let judge_orders = |orders: &Vec<Vec<usize>>| {
            let meshes = meshes.iter().zip(orders);
            let renumbered = meshes.map(|((name, mesh), order)| (*name, renumbered(mesh, order)));
            judge_meshes(trial, &renumbered.collect::<Vec<_>>(), &laws)
        };
        drawn.iter().map(judge_orders).collect()
    })
}

/// The same mesh, in which vertex `i` has the number `order[i]`.
fn renumbered(mesh: &Mesh, order: &[usize]) -> Mesh {
    fn placed<T: Copy + Default>(values: &[T], order: &[usize]) -> Vec<T> {
        let mut placed = vec![T::default(); values.len()];
        values.iter().zip(order).for_each(|(value, place)| placed[*place] = *value);
        placed
    }
    let triangle = |triangle: &[u32; 3]| triangle.map(|vertex| order[vertex as usize] as u32);
    Mesh {
        positions: placed(&mesh.positions, order),
        normals: placed(&mesh.normals, order),
        uvs: placed(&mesh.uvs, order),
        triangles: mesh.triangles.iter().map(triangle).collect(),
        ..mesh.clone()
    }
}

fn judge_meshes(
    trial: &Trial<'_>,
    meshes: &[(&'static str, Mesh)],
    laws: &impl Fn(&Mesh, &Mesh) -> Vec<CheckResult>,
) -> CheckResult {
    let queries: Vec<Mesh> = meshes.iter().map(|(_, mesh)| mesh.clone()).collect();
    let pairs = meshes.iter().zip(trial.kit.loop_subdivide(&queries));
    let judge_mesh = |((name, mesh), yours): (&(&str, Mesh), Mesh)| -> Vec<CheckResult> {
        let of_mesh = |broken: Broken| Broken { input: format!("loop_subdivide of {name}"), ..broken };
        laws(mesh, &yours).into_iter().map(|law| law.map_err(of_mesh)).collect()
    };
    all_hold(pairs.flat_map(judge_mesh).collect())
}

pub(super) fn loop_makes_four_triangles_of_each(trial: &Trial<'_>) -> CheckResult {
    judge(trial, |mesh, yours| {
        vec![judge_counts(mesh, yours).and_then(|()| triangles_are_quarters(mesh, yours))]
    })
}

/// Judges the numbers of vertices, triangles, normals, texture coordinates and materials.
fn judge_counts(mesh: &Mesh, yours: &Mesh) -> CheckResult {
    let (n_old, n_edges) = (mesh.positions.len(), edges(mesh).len());
    let describe =
        |mesh: &Mesh| format!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    let (vertices, triangles) = (n_old + n_edges, 4 * mesh.triangles.len());
    let (n, n_triangles) = (yours.positions.len(), yours.triangles.len());
    if (n, n_triangles) != (vertices, triangles) {
        let right = format!("{vertices} vertices, {triangles} triangles");
        return Err(unlike(describe(yours), right).explained_by([
            "you make more than one new vertex per edge: the triangles on both sides share it"
                .when(n == n_old + 3 * mesh.triangles.len() && n > vertices),
            "you do not make four triangles of each: three at its corners and one in the middle"
                .when(n_triangles != triangles),
            (n < vertices, "you make too few new vertices: there is one per edge, after the old ones"),
        ]));
    }
    if !yours.normals.is_empty() {
        let describe = format!("{} normals", yours.normals.len());
        return Err(unlike(describe, "none").because("normals are dropped, because the surface changes"));
    }
    let lengths = [
        (
            mesh.uvs.len(),
            yours.uvs.len(),
            vertices,
            "texture coordinates",
            "texture coordinates: there is one pair per vertex, or none if the mesh has none",
        ),
        (
            mesh.face_materials.len(),
            yours.face_materials.len(),
            triangles,
            "materials",
            "the four triangles take the material of the old triangle; a mesh without materials gets none",
        ),
    ];
    for (before, yours, each, what, mistake) in lengths {
        let right = if before == 0 { 0 } else { each };
        if yours != right {
            return Err(unlike(format!("{yours} {what}"), format!("{right}")).because(mistake));
        }
    }
    yours.validate().map_err(|message| unlike(message, "a valid mesh"))
}
