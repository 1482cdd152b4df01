//! Attributes of a mesh: interpolation, face normals and vertex normals.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::U;
use checks::generate::{point, triangle};
use checks::judge::{compare, known};
use checks::paste::{Paste, call};
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::InterpolateQuery;
use raykata::mesh::Mesh;
use raykata::shape::Triangle;

pub(super) fn interpolation_weighs_the_corners(trial: &Trial<'_>) -> CheckResult {
    let inputs = (0..=8i32, 0..=8i32, point(4), point(4), point(4)).prop_map(|(beta, gamma, a, b, c)| {
        let (beta, gamma) = if beta + gamma > 8 { (8 - beta, 8 - gamma) } else { (beta, gamma) };
        let (beta, gamma) = (beta as f32 / 8.0, gamma as f32 / 8.0);
        InterpolateQuery { barycentric: vec3(1.0 - beta - gamma, beta, gamma), corners: [a, b, c] }
    });
    trial.forall(1000, inputs, |queries| {
        compare(queries, trial.kit.interpolate(queries), |query, yours| {
            let [a, b, c] = query.corners;
            // All numbers are multiples of 1/64, so the sum is exact in single precision.
            let expected = query.barycentric.x * a + query.barycentric.y * b + query.barycentric.z * c;
            let input = format!(
                "interpolate({}, [{}, {}, {}])",
                query.barycentric.paste(),
                a.paste(),
                b.paste(),
                c.paste()
            );
            let diagnosis = if (yours.normalize_or_zero() - expected.normalize_or_zero()).length() < 1e-6 {
                "your value is normalized: return the weighted sum as it is"
            } else {
                "multiply the corners a, b, c by α, β, γ in this order"
            };
            if yours == expected {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(Some(diagnosis)))
            }
        })
    })
}

pub(super) fn face_normal_has_unit_length_at_any_size(trial: &Trial<'_>) -> CheckResult {
    let inputs = (triangle(), -60..=40i32).prop_map(|(t, power)| {
        let factor = 2f32.powi(power);
        Triangle { a: factor * t.a, b: factor * t.b, c: factor * t.c }
    });
    let judge = |triangles: &[Triangle]| {
        compare(triangles, trial.kit.face_normal(triangles), |triangle, yours| {
            let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);
            let (u, v) = (b - a, c - a);
            let cross = u.cross(v);
            let expected = cross.try_normalize().filter(|_| cross != DVec3::ZERO).map(|n| n.as_vec3());
            // Corners are multiples of 1/8 times the factor, so edges are exact. Scaling them rounds, and the cross
            // product of a thin triangle is a small difference of large products: allow sixteen roundings of |u| |v|.
            let slack = (16.0 * U * u.length() * v.length() / cross.length()).max(1e-5);
            let unit = |normal: Vec3| (normal.length() - 1.0).abs() < 1e-5;
            // By the same roundings, collinear edges may have an area, unless they are parallel to an axis.
            let slanting =
                [u, v].iter().all(|edge| edge.to_array().iter().filter(|x| **x != 0.0).count() > 1);
            let right = match (yours, expected) {
                (Some(yours), Some(expected)) => {
                    unit(yours) && f64::from((yours - expected).length()) < slack
                }
                (Some(yours), None) => unit(yours) && slanting,
                (None, expected) => expected.is_none(),
            };
            let diagnosis = match (yours, expected) {
                (Some(yours), _) if yours.is_nan() => {
                    "you return NaN (0/0): a triangle without area has no normal"
                }
                (Some(yours), Some(expected)) if (yours + expected).length() < 1e-5 => {
                    "your normal points the other way: compute u × v, not v × u"
                }
                (Some(yours), Some(expected)) if (yours.normalize_or_zero() - expected).length() < 1e-3 => {
                    "your normal is not of length 1: |u × v|² underflows for tiny edges; scale u and v first"
                }
                (None, Some(_)) => {
                    "you return None for a small triangle: scale u and v before the cross product"
                }
                _ => "",
            };
            let input = call("face_normal", &[triangle]);
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "double precision").looks_like(known(diagnosis)))
            }
        })
    };
    // Three corners on a line, two corners in one point, three corners in one point.
    let flat = [(Vec3::X, 2.0 * Vec3::X), (Vec3::X, Vec3::ZERO), (Vec3::ZERO, Vec3::ZERO)]
        .map(|(b, c)| Triangle { a: Vec3::ZERO, b, c });
    judge(&flat).into_iter().collect::<CheckResult>()?;
    trial.forall(2000, inputs, judge)
}

pub(super) fn octahedron() -> Mesh {
    let corner = |i: u32| [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z][i as usize];
    let triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    Mesh { positions: (0..6).map(corner).collect(), triangles, ..Mesh::default() }
}

pub(super) fn judge_normals(
    trial: &Trial<'_>,
    input: &str,
    mesh: &Mesh,
    accept: impl Fn(usize, Vec3) -> Option<Vec3>,
) -> CheckResult {
    let answers = trial.kit.vertex_normals(std::slice::from_ref(mesh));
    let normals = &answers[0];
    if normals.len() != mesh.positions.len() {
        let (yours, expected) =
            (format!("{} normals", normals.len()), format!("{} normals", mesh.positions.len()));
        return Err(Broken::with_texts(input, yours, expected, "one per vertex"));
    }
    for (vertex, &yours) in normals.iter().enumerate() {
        if let Some(expected) = accept(vertex, yours) {
            let input = format!("{input}, vertex {vertex} at {}", mesh.positions[vertex].paste());
            let around = mesh.triangles.iter().filter(|corners| corners.contains(&(vertex as u32)));
            let weighed: Vec<Vec3> = around
                .map(|corners| corners.map(|corner| mesh.positions[corner as usize]))
                .map(|[a, b, c]| (b - a).cross(c - a))
                .collect();
            let same = |n: Vec3| (yours - n.normalize_or_zero()).length() < 1e-4;
            let diagnosis = match () {
                () if yours.is_nan() => {
                    "you return NaN (0/0): normals that cancel have no average; take the normal of one face"
                }
                () if (yours.length() - 1.0).abs() > 1e-4 => "your normal is not of unit length",
                () if (yours + expected).length() < 1e-3 => "your normal points inwards",
                () if same(weighed.iter().sum()) => {
                    "you weight each face by its area: normalize the face normals before you add them"
                }
                () if weighed.iter().any(|&face| same(face)) => {
                    "you return the normal of one face: add up those of all faces around the vertex"
                }
                () => "",
            };
            return Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)));
        }
    }
    Ok(())
}

pub(super) fn vertex_normals_average_their_faces(trial: &Trial<'_>) -> CheckResult {
    let octahedron = octahedron();
    let differs = |yours: Vec3, expected: Vec3| ((yours - expected).length() > 1e-5).then_some(expected);
    judge_normals(trial, "an octahedron", &octahedron, |vertex, yours| {
        differs(yours, octahedron.positions[vertex])
    })?;
    // The average counts each face once, whatever its area: one large face points up, one small face to the side.
    let corner = Mesh {
        positions: vec![Vec3::ZERO, 8.0 * Vec3::X, 8.0 * Vec3::Y, vec3(0.0, 0.0, 0.125), vec3(0.0, 4.0, 0.0)],
        triangles: vec![[0, 1, 2], [0, 4, 3]],
        ..Mesh::default()
    };
    let both = (Vec3::Z + Vec3::X).normalize();
    judge_normals(trial, "a floor and a thin wall", &corner, |vertex, yours| match vertex {
        0 => differs(yours, both),
        1 | 2 => differs(yours, Vec3::Z),
        _ => differs(yours, Vec3::X),
    })
}

pub(super) fn vertex_normals_that_cancel_are_still_normals(trial: &Trial<'_>) -> CheckResult {
    // T14: a sheet whose two sides are faces, a face without area, and a vertex without faces.
    let sheet = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, vec3(5.0, 5.0, 5.0)],
        triangles: vec![[0, 1, 2], [0, 2, 1], [0, 1, 1]],
        ..Mesh::default()
    };
    judge_normals(trial, "a sheet with two sides", &sheet, |vertex, yours| match vertex {
        3 => (!((yours.length() - 1.0).abs() < 1e-4)).then_some(Vec3::Z),
        _ => (!((yours.abs() - Vec3::Z).length() < 1e-5)).then_some(Vec3::Z),
    })
}
