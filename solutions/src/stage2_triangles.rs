//! Stage 2 · triangles: three ways to meet one, three ways to be inside, and what a mesh makes of it.
//!
//! Slides: "Finding the intersection", "Cramer's Rule", "Ray-triangle intersection precomputations",
//! "Ray-Triangle Intersection" I, II, III, "Smooth Shading", "Normals of Vertices".
//!
//! A hit is `(t, β, γ)` with `o + t d = a + β (b - a) + γ (c - a)`, where `β ≥ 0`, `γ ≥ 0` and `β + γ ≤ 1`: points on
//! an edge belong to the triangle, and either side can be hit. The ray's range decides which `t` count.

use glam::{DVec2, DVec3, Vec3};
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// Ray against triangle by Cramer's rule on `β (a - b) + γ (a - c) + t d = a - o`.
///
/// Where the formula lies: the slide's determinant `D` repeats terms of the numerator of x. It is right for triangles
/// along the axes and loses more than half of all others. Weakness of the method itself: neighbours that share an
/// edge round differently, so one ray in ten that is aimed at the edge slips between them.
pub fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    // The letters of the slide, column by column: a e i | b f j | c g k | d h l.
    let [a, e, i] = (triangle.a - triangle.b).to_array();
    let [b, f, j] = (triangle.a - triangle.c).to_array();
    let [c, g, k] = ray.direction.to_array();
    let [d, h, l] = (triangle.a - ray.origin).to_array();

    // D expands the columns (a e i), (b f j), (c g k); the slide prints (gl - hk) and (hj - fl) here.
    let determinant = a * (f * k - g * j) + b * (g * i - e * k) + c * (e * j - f * i);
    if determinant == 0.0 {
        return None; // The ray runs along the plane, or the triangle has no area.
    }
    let beta = (d * (f * k - g * j) + b * (g * l - h * k) + c * (h * j - f * l)) / determinant;
    let gamma = (a * (h * k - g * l) + d * (g * i - e * k) + c * (e * l - h * i)) / determinant;
    let t = (a * (f * l - h * j) + b * (h * i - e * l) + d * (e * j - f * i)) / determinant;

    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta, gamma })
    // <stub> todo!("solve the three equations for β, γ and t by Cramer's rule")
    // </solution>
}

/// The four numbers of a triangle that the Gram method needs, computed once: `u·v`, `v·v`, `u·u` and
/// `D = (u·v)² - (u·u)(v·v)` for `u = b - a`, `v = c - a`.
///
/// Where the formula lies: for a thin triangle `D` is the difference of two nearly equal numbers, and comes out zero
/// or even positive. It is the same number as `-|u × v|²`.
pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    // <solution>
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    GramScalars { uv: u.dot(v), vv: v.dot(v), uu: u.dot(u), d: -u.cross(v).length_squared() }
    // <stub> todo!("compute u·v, v·v, u·u and D for u = b - a and v = c - a")
    // </solution>
}

/// Ray against triangle the other way: first its plane, then the weights `s` (here β) and `t` (here γ) of the point
/// `I = P - a` from the Gram matrix.
///
/// Where the formula lies: "0 ≤ s + t ≤ 1" alone lets points in with one weight below zero. Weakness of the method
/// itself: the point is rounded before it is tested, so far from the origin the error of `P` decides.
pub fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit> {
    // <solution>
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    let normal = u.cross(v);
    let to_a = triangle.a - ray.origin;
    let t = to_a.dot(normal) / ray.direction.dot(normal);

    // I = o + t d - a, kept relative to the ray's origin: adding o to t d first would round at the size of o.
    let point = t * ray.direction - to_a;
    let (point_u, point_v) = (point.dot(u), point.dot(v));
    let beta = (scalars.uv * point_v - scalars.vv * point_u) / scalars.d;
    let gamma = (scalars.uv * point_u - scalars.uu * point_v) / scalars.d;

    // Each comparison is false for NaN, so a ray along the plane and a triangle without area end here.
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta, gamma })
    // <stub> todo!("meet the plane of the triangle, then find s and t from the Gram scalars")
    // </solution>
}

/// Ray against triangle by a method of your choice. Your pictures are made with this one.
///
/// The reference is watertight: a ray aimed at a shared edge hits at least one of the two triangles, always (Woop,
/// Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013).
pub fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    // In double precision throughout: t, β and γ are then right to the last digit, and sizes from 1e-38 to 1e38 fit. In
    // single precision neighbours agree as well, but a ray may count for the neighbour of the triangle that it meets, and
    // miss the neighbour's box: 7 of 10⁸ rays at edges leaked out of meshes in a hierarchy. The price: a plain frame of
    // 57,600 triangles takes a tenth longer.
    let [o, d, a, b, c] = [ray.origin, ray.direction, triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);

    // See the triangle from the ray: origin at zero, the ray's longest axis as z, sheared so that the ray is (0 0 z).
    let z = longest_axis(ray.direction);
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let shear = DVec2::new(d[x], d[y]) / d[z];
    let project = |corner: DVec3| {
        let corner = corner - o;
        DVec2::new(corner[x], corner[y]) - shear * corner[z]
    };
    let [p, q, r] = [a, b, c].map(project);

    // Three edge functions: each has the sign of the side on which the ray passes that edge. Neighbours compute an
    // edge they share from the same two points, and rounding is monotone, so it cannot turn "inside" into "outside".
    let [alpha, beta, gamma] = [edge(q, r), edge(r, p), edge(p, q)];
    let (least, most) = (alpha.min(beta).min(gamma), alpha.max(beta).max(gamma));
    let sum = alpha + beta + gamma;
    if (least < 0.0 && most > 0.0) || sum == 0.0 || sum.is_nan() {
        return None;
    }

    // The paper takes t from the sheared z of the corners, which loses all digits on a needle seen from inside.
    // The plane does not: t = (a - o)·n / d·n.
    let normal = (b - a).cross(c - a);
    let t = ((a - o).dot(normal) / d.dot(normal)) as f32;
    ray.contains(t).then_some(TriangleHit { t, beta: (beta / sum) as f32, gamma: (gamma / sum) as f32 })
    // <stub> todo!("any method that you like: Möller–Trumbore, Plücker, watertight …")
    // </solution>
}

// <solution>
/// Twice the signed area of the triangle from the origin over `p` to `q`.
fn edge(p: DVec2, q: DVec2) -> f64 {
    p.x * q.y - p.y * q.x
}

/// The axis along which `v` is longest.
pub fn longest_axis(v: Vec3) -> usize {
    let v = v.abs();
    if v.x >= v.y && v.x >= v.z {
        0
    } else if v.y >= v.z {
        1
    } else {
        2
    }
}
// </solution>

/// Inside test I: the plane through the ray's origin and a side of the triangle has `point` on its inner side, for
/// all three sides.
///
/// Where the formula lies: "distance < 0 → outside" holds for one winding only. Accept the point if it lies on the
/// same side of all three planes, whichever that is, and on a plane counts as inside. Normalising changes no sign.
pub fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    // <solution>
    let to_point = point - ray.origin;
    let side = |from: Vec3, to: Vec3| (from - ray.origin).cross(to - ray.origin).dot(to_point);
    same_side([side(triangle.a, triangle.b), side(triangle.b, triangle.c), side(triangle.c, triangle.a)])
    // <stub> todo!("test on which side of the plane through ray.origin and each side the point lies")
    // </solution>
}

/// Inside test II: seen along the ray, `point` lies on the same side of all three sides: the sign of
/// `d · ((T₂ - P) × (T₁ - P))`.
pub fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    // <solution>
    let side = |from: Vec3, to: Vec3| (to - point).cross(from - point).dot(ray.direction);
    same_side([side(triangle.a, triangle.b), side(triangle.b, triangle.c), side(triangle.c, triangle.a)])
    // <stub> todo!("test the sign of d · ((T2 - P) × (T1 - P)) for each side")
    // </solution>
}

// <solution>
/// Whether no two of the signs contradict each other. Zero goes with either; NaN goes with neither.
fn same_side(sides: [f32; 3]) -> bool {
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}
// </solution>

/// Inside test III: the weights `(α, β, γ)` of the corners a, b, c as shares of the area, if `point` is inside.
///
/// Where the formula lies: areas without a sign cannot tell (-0.2, -0.2) from (0.2, 0.2). Measure each area along the
/// normal of the triangle, so that it goes negative outside.
pub fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3> {
    // <solution>
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    let area = |from: Vec3, to: Vec3| (from - point).cross(to - point).dot(normal);
    let weights =
        Vec3::new(area(triangle.b, triangle.c), area(triangle.c, triangle.a), area(triangle.a, triangle.b))
            / normal.length_squared();
    weights.cmpge(Vec3::ZERO).all().then_some(weights)
    // <stub> todo!("return the three signed areas over the area of the triangle, if none is below zero")
    // </solution>
}

/// The value at weights `(α, β, γ)` between values at the three corners.
pub fn interpolate(weights: Vec3, corners: [Vec3; 3]) -> Vec3 {
    // <solution>
    weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2]
    // <stub> todo!("weigh the three corners")
    // </solution>
}

/// The unit normal `u × v / |u × v|` of a triangle, `None` if it has no area.
///
/// Where the formula lies: for edges of 1e-11 the product of two lengths squared underflows, and the "unit" normal is
/// 1 % too long; for 1e-12 it is NaN. Scale the edges first: their lengths do not matter.
pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    // <solution>
    let unit_sized = |edge: Vec3| edge / edge.abs().max_element();
    let normal = unit_sized(triangle.b - triangle.a).cross(unit_sized(triangle.c - triangle.a));
    normal.try_normalize() // None for zero and for NaN
    // <stub> todo!("normalise u × v, and return None for a triangle without area")
    // </solution>
}

/// One unit normal a vertex: the average of the normals of the triangles around it.
///
/// Where the formula lies: opposite normals average to zero, and zero cannot be normalised. Then take the normal of
/// one of the faces. A vertex that no proper face uses may have any unit normal.
pub fn vertex_normals(mesh: &Mesh) -> Vec<Vec3> {
    // <solution>
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    let mut of_one_face = vec![Vec3::Z; mesh.positions.len()];
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|vertex| mesh.positions[vertex as usize]);
        let Some(normal) = face_normal(&Triangle { a, b, c }) else { continue };
        for &vertex in corners {
            sums[vertex as usize] += normal;
            of_one_face[vertex as usize] = normal;
        }
    }
    // Unit normals that do not cancel add up to well over this; what is left below it is rounding.
    let cancelled = |sum: Vec3| sum.length_squared() < 1e-10;
    sums.iter()
        .zip(of_one_face)
        .map(|(&sum, face)| if cancelled(sum) { face } else { sum.normalize() })
        .collect()
    // <stub> todo!("add up the face normals at each vertex and normalise")
    // </solution>
}

/// The closest hit among primitives `0..n_primitives`: ask `probe.hit(primitive, ray)` for each. Of two hits at the
/// same `t` the primitive with the smaller number wins, so that every search agrees with every other.
pub fn brute_force(n_primitives: u32, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    let mut ray = *ray;
    let mut closest = None;
    for primitive in 0..n_primitives {
        if let Some(t) = probe.hit(primitive, &ray) {
            closest = Some(PrimitiveHit { t, primitive });
            ray.t_max = t; // From here on only nearer hits count, and an equal one does not.
        }
    }
    closest
    // <stub> todo!("ask every primitive, and keep the hit with the smallest t")
    // </solution>
}
