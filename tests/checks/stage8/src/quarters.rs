//! Checks the triangles of a subdivision step by their connections, not by their positions.

use super::subdivision::unlike;
use checks::prelude::*;
use raykata::mesh::Mesh;
use std::collections::BTreeSet;

/// Names a vertex: a new one by the two ends of its edge, an old one by its own number twice.
type Label = (u32, u32);

/// The labels of all vertices. A new vertex belongs to the edge between the two old vertices with which it shares
/// triangles. `None` if some new vertex shares triangles with fewer or more than two old ones.
fn labels(mesh: &Mesh, yours: &Mesh) -> Option<Vec<Label>> {
    let n_old = mesh.positions.len() as u32;
    let mut old_ones = vec![BTreeSet::new(); yours.positions.len()];
    for triangle in &yours.triangles {
        for &vertex in triangle {
            old_ones[vertex as usize].extend(triangle.iter().filter(|&&other| other < n_old));
        }
    }
    let label = |(vertex, old_ones): (usize, &BTreeSet<u32>)| match vertex < n_old as usize {
        true => Some((vertex as u32, vertex as u32)),
        false if old_ones.len() == 2 => Some((*old_ones.first()?, *old_ones.last()?)),
        false => None,
    };
    old_ones.iter().enumerate().map(label).collect()
}

/// The same triangle, rotated so that its smallest corner comes first.
fn begun_anew([a, b, c]: [Label; 3]) -> [Label; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or([a, b, c])
}

/// Compares the triangles by labels, so that the order of edges and triangles and the positions do not matter.
pub(super) fn triangles_are_quarters(mesh: &Mesh, yours: &Mesh) -> CheckResult {
    let material = |mesh: &Mesh, face: usize| mesh.face_materials.get(face).copied();
    let quarters = |(face, &[a, b, c]): (usize, &[u32; 3])| {
        let edge = |p: u32, q: u32| (p.min(q), p.max(q));
        let ([ab, bc, ca], [a, b, c]) = ([edge(a, b), edge(b, c), edge(c, a)], [(a, a), (b, b), (c, c)]);
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            .map(|quarter| (begun_anew(quarter), material(mesh, face)))
    };
    let mut expected: Vec<_> = mesh.triangles.iter().enumerate().flat_map(quarters).collect();
    expected.sort_unstable();
    let wiring = "your triangles have wrong corners: three consist of an old vertex and the new ones of its \
        two edges, one of the three new ones";
    let wrong = || unlike("other triangles", "the four quarters of each triangle").because(wiring);
    let Some(labels) = labels(mesh, yours) else { return Err(wrong()) };
    let faces = yours.triangles.iter().enumerate();
    let mut got: Vec<_> = faces
        .map(|(face, corners)| (begun_anew(corners.map(|v| labels[v as usize])), material(yours, face)))
        .collect();
    got.sort_unstable();

    let corners = |faces: &[([Label; 3], Option<u32>)]| faces.iter().map(|face| face.0).collect::<Vec<_>>();
    let unturned = |faces: &[([Label; 3], Option<u32>)]| {
        let mut faces = corners(faces);
        faces.iter_mut().for_each(|face| face.sort_unstable());
        faces.sort_unstable();
        faces
    };
    if corners(&got) != corners(&expected) {
        if unturned(&got) != unturned(&expected) {
            return Err(wrong());
        }
        let (got, expected) =
            ("triangles with corners in the opposite order", "corners in the order of the old triangle");
        return Err(unlike(got, expected).explained_by([
            "you reverse the corners of some triangles: all four keep the order of the old triangle"
                .when(true),
            (true, wiring),
        ]));
    }
    if got != expected {
        let (got, expected) =
            ("triangles with the material of another face", "the material of the old triangle for each");
        let mistake = "the four triangles take the material of the old triangle";
        return Err(unlike(got, expected).because(mistake));
    }
    for (vertex, &(p, q)) in labels.iter().enumerate().take(yours.uvs.len()) {
        let right = 0.5 * (mesh.uvs[p as usize] + mesh.uvs[q as usize]);
        // The tolerance covers the rounding of halves of numbers up to 1.
        if (yours.uvs[vertex] - right).length() > 1e-6 {
            let mistake = if p == q {
                "the texture coordinates of an old vertex stay"
            } else {
                "the texture coordinates of a new vertex are the mean of those at the ends of its edge"
            };
            let got =
                format!("texture coordinates {} at vertex {vertex}, of edge {p} {q}", yours.uvs[vertex]);
            return Err(unlike(got, format!("{right}")).because(mistake));
        }
    }
    Ok(())
}
