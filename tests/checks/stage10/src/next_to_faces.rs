//! Rays that start so near to a face of a closed mesh that rounding errors decide on which side of the face they start.

use super::triangles::judge_hit_point;
use checks::prelude::*;
use oracle::exact::{Body, verdict};
use oracle::splitmix::Random;

/// Vectors of whole numbers, which are exact.
type Whole = [i128; 3];

fn plus(factor: i128, v: Whole, w: Whole) -> Whole {
    [0, 1, 2].map(|axis| factor * v[axis] + w[axis])
}

fn dot(v: Whole, w: Whole) -> i128 {
    (0..3).map(|axis| v[axis] * w[axis]).sum()
}

fn cross(v: Whole, w: Whole) -> Whole {
    [0, 1, 2].map(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        v[next] * w[last] - v[last] * w[next]
    })
}

/// The vector in single precision, scaled by a power of two to an ordinary size.
fn place(v: Whole) -> Vec3 {
    Vec3::from_array(v.map(|x| x as f32)) * (-21f32).exp2()
}

/// `(g, x, y)` with `p x + q y = g`, the greatest common divisor of `p` and `q` up to its sign.
fn common_divisor(p: i128, q: i128) -> (i128, i128, i128) {
    if q == 0 {
        return (p, 1, 0);
    }
    let (g, x, y) = common_divisor(q, p % q);
    (g, y, x - p / q * y)
}

/// A step from `a` to a point above the triangle with the edges `e` and `f`, as near to its plane as whole numbers allow, but
/// not in the plane. `None` if the point is not well inside the triangle.
fn next_to(e: Whole, f: Whole) -> Option<Whole> {
    let normal = cross(e, f);
    // Solve normal · step = g, the greatest common divisor of its coordinates: the smallest possible product.
    let (two, x, _) = common_divisor(normal[0], normal[1]);
    let (_, both, z) = common_divisor(two, normal[2]);
    if normal[1] == 0 {
        return None;
    }
    // Both products with the first two coordinates have the sum `both · two`. Take the smallest first coordinate.
    let x = (both * x).rem_euclid(normal[1] / two);
    let step = [x, (both * two - normal[0] * x) / normal[1], z];
    // Subtract multiples of the edges, which do not change the product, until the point is above the triangle.
    let square = dot(normal, normal);
    if square == 0 {
        return None;
    }
    let (beta, gamma) = (dot(cross(step, f), normal), dot(cross(e, step), normal));
    let step = plus(-beta.div_euclid(square), e, plus(-gamma.div_euclid(square), f, step));
    let [beta, gamma] = [beta, gamma].map(|weight| weight.rem_euclid(square) as f64 / square as f64);
    (beta.min(gamma).min(1.0 - beta - gamma) > 0.05).then_some(step)
}

/// A tetrahedron, and a ray from its inside through its first face. The ray starts less than 1e-15 sizes from this face. The edge
/// from the first corner to the second one passes through the origin of the world.
fn tetrahedron(random: &mut Random) -> ([Vec3; 4], Ray) {
    loop {
        // Single precision keeps whole numbers below 2²⁴.
        let mut corner = || [(); 3].map(|()| random.below(1 << 22) as i128 - (1 << 21));
        let (a, c, apex) = (corner(), corner(), corner());
        let b = a.map(|x| -x);
        let (e, f) = (plus(-1, a, b), plus(-1, a, c));
        let Some(step) = next_to(e, f) else { continue };
        let start = plus(1, step, a);
        // Put the apex on that side of the face on which the ray starts.
        let height = dot(cross(e, f), plus(-1, a, apex));
        let is_same_side = (height > 0) == (dot(cross(e, f), step) > 0);
        let apex = if is_same_side { apex } else { plus(-1, apex, plus(1, a, a)) };
        let away = plus(-1, apex, start);
        if height == 0 || apex.iter().chain(&away).any(|x| x.abs() >= 1 << 24) {
            continue;
        }
        return ([a, b, c, apex].map(place), Ray::new(place(start), place(away)));
    }
}

pub(super) fn starts_next_to_a_face(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 29);
    let cases: Vec<(Ray, [Triangle; 4])> = (0..300)
        .map(|index| {
            let ([a, b, c, apex], ray) = tetrahedron(&mut random);
            // Each corner comes first, second and third.
            let [p, q, r] = [[a, b, c], [a, c, b], [b, c, a], [c, a, b]][index % 4];
            let face = |a: Vec3, b: Vec3, c: Vec3| Triangle { a, b, c };
            (ray, [face(p, q, r), face(p, q, apex), face(q, r, apex), face(r, p, apex)])
        })
        .collect();
    let query = |ray: &Ray, triangle: &Triangle| TriangleQuery { ray: *ray, triangle: *triangle };
    let queries: Vec<TriangleQuery> =
        cases.iter().flat_map(|(ray, faces)| faces.iter().map(move |face| query(ray, face))).collect();
    let answers = trial.kit.watertight(&queries);
    let judge = |((ray, faces), answers): (&(Ray, [Triangle; 4]), &[Option<_>])| {
        assert!(verdict(ray, Body::Triangle(faces[0])).is_some_and(|verdict| verdict.is_hit()), "{ray:?}");
        if answers.iter().any(Option::is_some) {
            return Ok(());
        }
        let infinite = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
        let line = trial.kit.watertight(&[query(&infinite, &faces[0])]).remove(0);
        let (hit, about) =
            (query(ray, &faces[0]), "a face of a tetrahedron, from inside; no other face is hit");
        let input = format!("{}\n{about}", hit.call("watertight"));
        let broken = Broken::with_texts(input, "no hit", "a hit", "the mesh is closed")
            .explained_by(["t has the wrong sign: the ray starts so near to the triangle that rounding errors decide on which side it starts. Compute the determinants exactly there"
                .when(line.is_some_and(|hit| hit.t <= 0.0))]);
        Err(broken.in_call(Request::Watertight(vec![hit])))
    };
    all_hold(cases.iter().zip(answers.chunks(4)).map(judge).collect())
}

/// Triangles seen edge-on from the origin of the world, found by a search for small determinants of whole numbers. On the way to
/// the second corner, double precision loses the sign of the determinant, but not that of the distance.
const CORNERS: [[[i32; 3]; 3]; 3] = [
    [[-79901, -54540, 137825], [-7945579, 7727471, 798180], [-219053, 7525521, -7155049]],
    [[-48248, -18708, -190529], [-5529899, -6277445, -7531181], [2786749, 6017523, -6083264]],
    [[-45972, 27707, 79193], [2216769, -6412465, -7659052], [6934301, 7440082, -3155143]],
];

pub(super) fn hits_a_corner_seen_edge_on(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 37);
    let queries: Vec<TriangleQuery> = (0..48)
        .map(|index| {
            // Each axis comes first, on both sides of 0 and at any size.
            let (axis, size) = (random.below(3) as usize, 2f32.powi(random.below(41) as i32 - 20));
            let size = if index % 2 == 0 { size } else { -size };
            let [a, b, c] = CORNERS[index % 3].map(|p| [0, 1, 2].map(|i| p[(axis + i) % 3] as f32));
            let [a, b, c] = [a, b, c].map(|corner| size * Vec3::from_array(corner));
            TriangleQuery { ray: Ray::new(Vec3::ZERO, b), triangle: Triangle { a, b, c } }
        })
        .collect();
    let expected = "a hit of the second corner at t = 1";
    all_hold(compare(&queries, trial.kit.watertight(&queries), |query, yours| match yours {
        // Another check judges the digits of t.
        Some(hit) if (hit.t - 1.0).abs() < 1e-3 => Ok(()),
        _ => Err(Broken::new(query.call("watertight"), yours, expected, "exactly")),
    }))
}

/// Rays that are so nearly parallel to a triangle that rounding errors decide all signs, and that cross its plane one size of
/// the triangle beside it. A hit must not have barycentric coordinates outside of the triangle.
pub(super) fn passes_beside_a_triangle_seen_edge_on(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 31);
    let mut query = |index: usize| loop {
        let mut corner = || [(); 3].map(|()| random.below(1 << 22) as i128 - (1 << 21));
        let (a, b, c) = (corner(), corner(), corner());
        let (e, f) = (plus(-1, a, b), plus(-1, a, c));
        // The ray crosses the plane at a + e - f, at t = 1: α = 1, β = 1 and γ = -1.
        let Some(direction) = next_to(e, f) else { continue };
        let start = plus(-1, direction, plus(-1, f, plus(1, e, a)));
        if start.iter().chain(&direction).any(|x| x.abs() >= 1 << 24) {
            continue;
        }
        let [a, b, c] = [[a, b, c], [b, c, a], [c, a, b]][index % 3].map(place);
        return TriangleQuery {
            ray: Ray::new(place(start), place(direction)),
            triangle: Triangle { a, b, c },
        };
    };
    let queries: Vec<TriangleQuery> = (0..300).map(&mut query).collect();
    all_hold(compare(&queries, trial.kit.watertight(&queries), judge_hit_point))
}
