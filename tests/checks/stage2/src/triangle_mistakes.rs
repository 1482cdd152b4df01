//! Known mistakes in the intersection of a ray and a triangle, each with the answer that it gives.

use checks::double::LIMITS;
use checks::prelude::*;

/// The intersection of the line along a ray with the plane of a triangle, in double precision.
struct Line {
    u: DVec3,
    v: DVec3,
    t: f64,
    alpha: f64,
    beta: f64,
    gamma: f64,
    /// The determinant of Cramer's rule, `-d·(u × v)`.
    determinant: f64,
    /// The largest error of the coordinates by the rounding of differences, and by the rounding of a point in the world.
    tolerance: f64,
    in_the_world: f64,
    /// The largest error of `t` divided by that of the coordinates.
    t_per_tolerance: f64,
}

impl Line {
    fn of(query: &TriangleQuery) -> Line {
        let (ray, triangle) = (&query.ray, &query.triangle);
        let [a, b, c, o, d] =
            [triangle.a, triangle.b, triangle.c, ray.origin, ray.direction].map(Vec3::as_dvec3);
        let (u, v, s) = (b - a, c - a, o - a);
        let normal = u.cross(v);
        let determinant = -d.dot(normal);
        let t = s.dot(normal) / determinant;
        let beta = -d.dot(s.cross(v)) / determinant;
        let gamma = -d.dot(u.cross(s)) / determinant;
        // The same bound as that of `double::triangle`, with the size of the differences or of the coordinates.
        let thin = u.length() * v.length() / normal.length();
        let steep = d.length() * normal.length() / determinant.abs();
        let reach = s.length().max(t.abs() * d.length()) + u.length().max(v.length());
        let size = u.length().min(v.length());
        let far = [a, b, c, o].map(|p| p.length()).into_iter().fold(0.0, f64::max);
        let relative = |reach: f64| 64.0 * U * thin * thin * steep * (1.0 + reach / size);
        Line {
            u,
            v,
            t,
            alpha: 1.0 - beta - gamma,
            beta,
            gamma,
            determinant,
            tolerance: relative(reach),
            in_the_world: relative(far + reach),
            t_per_tolerance: size / d.length(),
        }
    }
}

/// An answer, compared with those of wrong methods.
struct Answer<'a> {
    query: &'a TriangleQuery,
    yours: Option<TriangleHit>,
    is_right: bool,
    tolerance: f64,
    t_tolerance: f64,
}

impl Answer<'_> {
    /// Whether a method gives this answer that computes `[t, β, γ]` and accepts it if `accepted`.
    fn is(&self, [t, beta, gamma]: [f64; 3], accepted: bool) -> bool {
        let near = |value: f32, exact: f64| (f64::from(value) - exact).abs() <= self.tolerance;
        match self.yours {
            None => !accepted,
            Some(hit) => {
                let close = (f64::from(hit.t) - t).abs() <= self.t_tolerance + 1e-5 * t.abs();
                accepted && close && near(hit.beta, beta) && near(hit.gamma, gamma)
            }
        }
    }

    /// The same for a method that accepts a hit in the range of the ray with these coordinates, each at least 0. If a
    /// rounding error decides that, both answers are possible.
    fn is_inside(&self, hit: [f64; 3], least: f64) -> bool {
        let counts = self.counts(hit[0]);
        let open = least.abs() <= self.tolerance;
        (open && (self.is(hit, counts) || self.yours.is_none())) || self.is(hit, counts && least >= 0.0)
    }

    fn counts(&self, t: f64) -> bool {
        f64::from(self.query.ray.t_min) < t && t < f64::from(self.query.ray.t_max)
    }
}

/// Fixed limits for `t`.
const EPSILONS: [f64; 5] = [f32::EPSILON as f64, 1e-6, 1e-5, 1e-4, 1e-3];

/// All known mistakes, each with whether it gives this answer.
pub(super) fn mistakes(
    query: &TriangleQuery,
    yours: Option<TriangleHit>,
    is_right: bool,
) -> Vec<(bool, &'static str)> {
    let line = Line::of(query);
    // A wrong method may round in another way, so allow twice the tolerance of a right one.
    let tolerance = 2.0 * line.tolerance;
    let answer = Answer { query, yours, is_right, tolerance, t_tolerance: tolerance * line.t_per_tolerance };
    let mut all = of_tests(&answer, &line);
    all.extend(of_values(&answer, &line));
    // One of the three products of a determinant has a wrong sign, for each vector by which it can be written out.
    let (s, d) = (query.ray.origin - query.triangle.a, query.ray.direction);
    let (s, minus_d, u, v) = (s.as_dvec3(), -d.as_dvec3(), line.u, line.v);
    for (value, [p, q, r]) in [[s, u, v], [minus_d, s, v], [minus_d, u, s]].into_iter().enumerate() {
        let products = [p * q.cross(r), q * r.cross(p), r * p.cross(q)].map(|products| products.to_array());
        all.extend(products.as_flattened().iter().map(|product| {
            let mut hit = [line.t, line.beta, line.gamma];
            hit[value] -= 2.0 * product / line.determinant;
            let least = hit[1].min(hit[2]).min(1.0 - hit[1] - hit[2]);
            (answer.is_inside(hit, least), "one product in the numerator of t, β or γ has a wrong sign")
        }));
    }
    all
}

/// Mistakes that a wrong answer alone shows.
pub(super) fn observations(query: &TriangleQuery, yours: Option<TriangleHit>) -> [(bool, &'static str); 5] {
    let ray = &query.ray;
    let line = Line::of(query);
    let on_an_edge = line.alpha.min(line.beta).min(line.gamma) == 0.0;
    [
        "a triangle without area, or a ray along its plane, divides by 0: that is a miss, and so is a NaN"
            .when(yours.is_some() && line.determinant == 0.0),
        "you return NaN or infinity: compare so that NaN fails"
            .when(yours.is_some_and(|hit| ![hit.t, hit.beta, hit.gamma].into_iter().all(f32::is_finite))),
        "points on an edge belong to the triangle: compare with ≥ and ≤, not with > and <"
            .when(yours.is_none() && on_an_edge && line.determinant != 0.0),
        "the range is open: a hit at t_min or t_max does not count (t = 0 for a ray that starts in the triangle)"
            .when(yours.is_some_and(|hit| hit.t == ray.t_min || hit.t == ray.t_max)),
        "you accept a point slightly outside: test β ≥ 0, γ ≥ 0 and β + γ ≤ 1 without a tolerance"
            .when(yours.is_some_and(|TriangleHit { beta, gamma, .. }| {
                (-0.01..0.0).contains(&beta.min(gamma).min(1.0 - beta - gamma))
            })
            ),
    ]
}

/// Right coordinates with a wrong test.
fn of_tests(answer: &Answer<'_>, line: &Line) -> Vec<(bool, &'static str)> {
    let &Line { t, alpha, beta, gamma, determinant, .. } = line;
    let ray = &answer.query.ray;
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let hit = [t, beta, gamma];
    let inside = alpha >= -answer.tolerance && beta >= -answer.tolerance && gamma >= -answer.tolerance;
    let (is_hit, is_right) = (answer.yours.is_some(), answer.is_right);
    let lost_if = |lost: bool| if lost { !is_hit } else { is_right };
    let tests = |least: f64| answer.is_inside(hit, least);
    let within = |counts: bool| answer.is(hit, counts && inside);
    let mut all = named![
        within(t_min < t) => "you return a hit beyond t_max: ask ray.contains(t)",
        within(t < t_max) => "you return a hit behind the ray or before t_min: ask ray.contains(t)",
        within(0.0 < t) => "you ask t > 0 and not ray.contains(t): t_min and t_max count",
        within(true) => "you do not ask ray.contains(t)",
        tests(beta.min(gamma).min(1.0 - beta).min(1.0 - gamma)) =>
            "you test β ≤ 1 and γ ≤ 1, which makes a parallelogram: β + γ ≤ 1 is not tested",
        tests(beta.min(gamma)) => "you accept a point beyond the side b c: β + γ ≤ 1 is not tested",
        tests(beta.min(alpha)) => "you accept a γ below 0: γ ≥ 0 is not tested",
        tests(gamma.min(alpha)) => "you accept a β below 0: β ≥ 0 is not tested",
        tests((beta + gamma).min(alpha)) =>
            "you accept a β or γ below 0: 0 ≤ β + γ ≤ 1 is not enough, test β ≥ 0 and γ ≥ 0 as well",
        tests(1.0) => "you do not test whether the point is inside the triangle",
        lost_if(determinant < 0.0) => "you test the triangle from one side only: it is hit from the back as well",
        lost_if(determinant > 0.0) => "you test the triangle from one side only: it is hit from the front as well",
    ].to_vec();
    // Rounding decides about a determinant next to the limit. That of Gram is |u × v|².
    let gram = line.u.cross(line.v).length_squared();
    all.extend([determinant.abs(), gram].into_iter().flat_map(|size| {
        LIMITS.map(|limit| {
            let is_lost = (size / limit - 1.0).abs() < 1e-3 || lost_if(size < limit);
            (is_lost, "you take a small |det| for 0, but a fixed limit rejects small triangles")
        })
    }));
    // With the range of the ray, with its end, or with neither.
    let ranges = |epsilon: f64| [(t_min.max(epsilon), t_max), (epsilon, t_max), (epsilon, f64::INFINITY)];
    all.extend(EPSILONS.into_iter().flat_map(ranges).map(|(start, end)| {
        (within(start < t && t < end), "you drop hits with a small t: ask ray.contains(t), not a fixed limit")
    }));
    all
}

const UNSIGNED_AREAS: &str = "areas without a sign accept a β or γ below 0: measure them along the normal";

/// Wrong values of `t`, β and γ.
fn of_values(answer: &Answer<'_>, line: &Line) -> Vec<(bool, &'static str)> {
    let &Line { t, alpha, beta, gamma, .. } = line;
    let least = alpha.min(beta).min(gamma);
    let sum = alpha.abs() + beta.abs() + gamma.abs();
    let length = answer.query.ray.direction.as_dvec3().length();
    let in_the_world = line.in_the_world;
    let of_a_point = |accepts: &dyn Fn(&TriangleHit) -> bool| {
        answer.yours.map_or(least.abs() <= in_the_world, |hit| {
            let near = |value: f32, exact: f64| (f64::from(value) - exact).abs() <= in_the_world;
            // Gram's coordinates do not depend on t as long as the point is in the plane, but t may be off as well.
            let is_near_t = (f64::from(hit.t) - t).abs() <= in_the_world * line.t_per_tolerance;
            near(hit.beta, beta)
                && near(hit.gamma, gamma)
                && is_near_t
                && answer.query.ray.contains(hit.t)
                && accepts(&hit)
        })
    };
    // Gram's numerators, with u·u and v·v exchanged.
    let (uu, uv, vv) = (line.u.length_squared(), line.u.dot(line.v), line.v.length_squared());
    let (point_u, point_v) = (beta * uu + gamma * uv, beta * uv + gamma * vv);
    let exchanged =
        [uv * point_v - uu * point_u, uv * point_u - vv * point_v].map(|x| x / (uv * uv - uu * vv));
    let squares = |beta: f64, gamma: f64| {
        let text = "u·u and v·v are exchanged: β has v·v, and γ has u·u";
        (answer.is_inside([t, beta, gamma], beta.min(gamma).min(1.0 - beta - gamma)), text)
    };
    // Gram's coordinates of the point at a t that counts world units.
    let far = (t * length - t) * answer.query.ray.direction.as_dvec3();
    let (far_u, far_v) = (point_u + far.dot(line.u), point_v + far.dot(line.v));
    let [far_beta, far_gamma] =
        [uv * far_v - vv * far_u, uv * far_u - uu * far_v].map(|x| x / (uv * uv - uu * vv));
    let is_in_sum = |hit: &TriangleHit| (0.0..=1.0).contains(&(hit.beta + hit.gamma));
    vec![
        "you use the determinant as the slide prints it; it must be a(fk - gj) + b(gi - ek) + c(ej - fi)"
            .when(slide_determinant(answer.query).map_or(answer.is_right, |factor| {
                let hit = [t, beta, gamma].map(|value| factor * value);
                answer.is_inside(hit, hit[1].min(hit[2]).min(1.0 - hit[1] - hit[2]))
            })
            ),
        squares(exchanged[0], exchanged[1]),
        squares(exchanged[0], gamma),
        squares(beta, exchanged[1]),
        (answer.is_inside([t, gamma, beta], least), "β and γ look swapped"),
        "you return (α, γ) with α, a weight of corner a: β belongs to b and γ to c"
            .when(answer.is_inside([t, alpha, gamma], least)),
        "you return (β, α) with α, a weight of corner a: β belongs to b and γ to c"
            .when(answer.is_inside([t, beta, alpha], least)),
        "you return (α, β) with α, a weight of corner a: β belongs to b and γ to c"
            .when(answer.is_inside([t, alpha, beta], least)),
        "you return (γ, α) with α, a weight of corner a: β belongs to b and γ to c"
            .when(answer.is_inside([t, gamma, alpha], least)),
        "the right side a - o is turned around: t, β and γ have the wrong sign"
            .when(answer.is_inside([-t, -beta, -gamma], (-beta).min(-gamma).min(1.0 + beta + gamma))),
        (answer.is_inside([-t, beta, gamma], least), "the sign of t is wrong"),
        "your t counts world units; it must count lengths of direction"
            .when(answer.is_inside([t * length, beta, gamma], least)),
        "your t counts world units; it must count lengths of direction"
            .when(answer.is_inside([t * length, far_beta, far_gamma], far_beta.min(far_gamma).min(1.0 - far_beta - far_gamma))),
        (answer.is_inside([t, beta.abs() / sum, gamma.abs() / sum], 1.0), UNSIGNED_AREAS),
        (answer.is_inside([t, beta.abs(), gamma.abs()], 1.0 - beta.abs() - gamma.abs()), UNSIGNED_AREAS),
        "your answer is off by the rounding of o + t d or of n·o, far from the origin: subtract o first"
            .when(answer.is_right || of_a_point(&|hit| hit.beta.min(hit.gamma) >= 0.0)),
        "you accept a β or γ below 0: 0 ≤ β + γ ≤ 1 is not enough, test β ≥ 0 and γ ≥ 0 as well\nand: your answer is off by the rounding of o + t d or of n·o, far from the origin: subtract o first"
            .when(answer.is_right || of_a_point(&is_in_sum)),
    ]
}

/// The factor by which the determinant that the slide prints changes `t`, β and γ; `None` if it is right for this query.
fn slide_determinant(query: &TriangleQuery) -> Option<f64> {
    let triangle = query.triangle;
    let [a, b, c, o, z] =
        [triangle.a, triangle.b, triangle.c, query.ray.origin, query.ray.direction].map(Vec3::as_dvec3);
    let (x, y, s): (DVec3, DVec3, DVec3) = (a - b, a - c, a - o);
    let slide = x.x * (y.y * z.z - z.y * y.z) + y.x * (z.y * s.z - s.y * z.z) + z.x * (s.y * y.z - y.y * s.z);
    let right = x.dot(y.cross(z));
    // A determinant of 0 gives infinity or NaN, which is a miss.
    let factor = if slide == 0.0 { f64::NAN } else { right / slide };
    ((factor - 1.0).abs() > 1e-3 || factor.is_nan()).then_some(factor)
}
