//! Inside tests I, II and III.

use super::method::aimed;
use checks::double;
use checks::generate::triangle;
use checks::prelude::*;

/// A point in the plane of a triangle, with its barycentric coordinates `[α, β, γ]`, and whether they are exact.
pub(super) type Case = (InsideQuery, [f64; 3], bool);

/// Points where a ray hits the plane of a triangle, rounded.
fn plane_points() -> impl Strategy<Value = Case> + Clone {
    aimed(triangle(), point(8)).prop_map(|TriangleQuery { ray, triangle }| {
        let hit = double::triangle(&ray, &triangle);
        let point = double::triangle_point(&triangle, hit.beta, hit.gamma).as_vec3();
        (InsideQuery { ray, point, triangle }, [1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma], false)
    })
}

/// Points exactly on an edge, at a corner, inside and outside: triangles whose sides are along two axes, or slanted within
/// their plane, with coordinates that are small integers and with an area that is a power of two. All three tests compute
/// such points without rounding.
fn exact_points() -> impl Strategy<Value = Case> + Clone {
    let slant = prop::sample::select(vec![0.0f32, 4.0, -4.0, 2.0]);
    (nasty::lattice(3), 0..6usize, slant, -1..=5i32, -1..=5i32, nasty::lattice(6), nasty::scale(-8..=8))
        .prop_map(|(a, order, slant, beta, gamma, origin, size)| {
            let (x, y) = (order % 3, (order + 1) % 3);
            let (mut u, mut v) = (Vec3::ZERO, Vec3::ZERO);
            u[x] = 4.0;
            (v[x], v[y]) = (slant, 4.0);
            if order >= 3 {
                std::mem::swap(&mut u, &mut v);
            }
            let (beta, gamma) = (beta as f32 / 4.0, gamma as f32 / 4.0);
            let point = a + beta * u + gamma * v;
            let triangle = Triangle { a: size * a, b: size * (a + u), c: size * (a + v) };
            // The origin is beside the plane of the triangle.
            let mut origin = origin;
            origin[(order + 2) % 3] =
                a[(order + 2) % 3] + if origin[(order + 2) % 3] < 0.0 { -4.0 } else { 4.0 };
            let ray = Ray::new(size * origin, point - origin);
            let [beta, gamma] = [beta, gamma].map(f64::from);
            (InsideQuery { ray, point: size * point, triangle }, [1.0 - beta - gamma, beta, gamma], true)
        })
}

/// Whether the point is inside. `None` if rounding may decide: the point is near a side, the triangle is thin, or
/// the ray is nearly parallel to it.
fn clearly_inside((query, weights, exact): &Case) -> Option<bool> {
    let Triangle { a, b, c } = query.triangle;
    let area = (b - a).cross(c - a).length();
    let thin = (b - a).length() * (c - a).length() / area;
    let facing = query.ray.direction.normalize().dot((b - a).cross(c - a) / area).abs();
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    if *exact {
        return Some(least >= 0.0);
    }
    // A side and the ray's origin span no plane if the origin lies on the line of the side. For a grazing ray it nearly
    // does.
    let sharp = thin < 30.0 && facing > 0.05 && weights.iter().all(|w| w.is_finite());
    (sharp && least.abs() > 1e-3).then_some(least > 0.0)
}

const ONE_ORDER: &str = "for a point inside, all three signs are equal, but they depend on the order of the corners: accept all ≥ 0 or all ≤ 0";

const PRODUCTS: &str =
    "a product of two sides is also 0 if one of them is 0: compare the signs of all three sides";

const PRODUCT_OF_ALL: &str =
    "in a product of all three sides two negative ones cancel: compare the signs of all three sides";

/// Known mistakes in inside tests I and II, each with whether it gives this answer.
fn mistakes(case @ (query, weights, exact): &Case, yours: bool) -> Vec<(bool, &'static str)> {
    // The side opposite of corner a is b c, so the signs of α, β and γ are those of the sides bc, ca and ab.
    let &[bc, ca, ab] = weights;
    let Triangle { a, b, c } = query.triangle;
    let ray = query.ray;
    let normal = (b - a).as_dvec3().cross((c - a).as_dvec3());
    let faces = normal.dot(ray.direction.as_dvec3());
    // Rounding decides the sign of a coordinate near 0, unless all methods compute it without rounding.
    let slack = if *exact { 0.0 } else { 1e-3 };
    let least = |sides: &[f64]| sides.iter().copied().fold(f64::INFINITY, f64::min);
    let all = |sides: &[f64], slack: f64| {
        least(sides) >= -slack || least(&sides.iter().map(|side| -side).collect::<Vec<_>>()) >= -slack
    };
    // Seen edge-on, all sides are 0.
    let is_edge_on = *exact && faces == 0.0;
    let gives = |sides: &[f64]| if yours { is_edge_on || all(sides, slack) } else { !all(sides, -slack) };
    let is_on_a_side = weights.iter().any(|side| side.abs() < slack);
    let product = |is: bool| is_on_a_side || yours == is;
    let strictly = [bc, ca, ab].iter().all(|&s| s > 0.0);
    let inside = all(&[bc, ca, ab], 0.0);
    // The planes through o with another vector than P - o.
    let [o, p] = [ray.origin, query.point].map(Vec3::as_dvec3);
    let of_planes = |vector: DVec3| {
        let side = |from: Vec3, to: Vec3| (from.as_dvec3() - o).cross(to.as_dvec3() - o).dot(vector);
        let sides = [side(a, b), side(b, c), side(c, a)];
        // A side so much smaller than the largest one has no sign in single precision.
        let size = sides.iter().fold(0.0, |size: f64, side| size.max(side.abs()));
        sides.iter().any(|side| side.abs() < 1e-5 * size) || yours == all(&sides, 0.0)
    };
    // Test I with normals of unit length, in single precision: NaN makes every comparison false.
    let normalized = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let normal = (from - ray.origin).cross(to - ray.origin).normalize();
        normal.dot(query.point - ray.origin)
    });
    let of_normalized = normalized.iter().all(|&s| s >= 0.0) || normalized.iter().all(|&s| s <= 0.0);
    let is_line = |from: Vec3, to: Vec3| (from.as_dvec3() - o).cross(to.as_dvec3() - o) == DVec3::ZERO;
    let on_the_line = is_line(a, b) || is_line(b, c) || is_line(c, a);
    // Where rounding decides, each test may give each answer: this one refutes none.
    let Some(right) = clearly_inside(case) else { return Vec::new() };
    vec![
        "the ray's origin is on the line of a side: accept its 0, and do not normalize (0/0)"
            .when(yours == right || (on_the_line && !yours && inside)),
        "do not normalize: that rounds points off an edge, and is 0/0 if the ray's origin is on the line of a side"
            .when(yours == of_normalized),
        (
            // The normal of the slide is (T₂ - P₀) × (T₁ - P₀), which is the other way round.
            yours == normalized.iter().all(|&s| !(-s < 0.0)),
            "this is the slide, distance < 0 → outside: the signs depend on the order of the corners\nand: do not normalize, which rounds points off an edge and is 0/0 if the ray's origin is on the line of a side",
        ),
        (yours == strictly, "points on an edge are inside: compare with ≥ and ≤, not with > and <"),
        (yours == (inside && faces <= 0.0), ONE_ORDER),
        (yours == (inside && faces >= 0.0), ONE_ORDER),
        (product(ab * bc >= 0.0 && bc * ca >= 0.0), PRODUCTS),
        (product(bc * ca >= 0.0 && ca * ab >= 0.0), PRODUCTS),
        (product(ca * ab >= 0.0 && ab * bc >= 0.0), PRODUCTS),
        (product(faces * ab * bc * ca >= 0.0), PRODUCT_OF_ALL),
        (product(faces * ab * bc * ca <= 0.0), PRODUCT_OF_ALL),
        (normal.z == 0.0 || yours == inside, "you take z of the cross product, and so look along z: the ray looks along d, so take the dot product with d"),
        (gives(&[bc, ca]), "a side left out, a b: test all three sides"),
        (gives(&[ca, ab]), "a side left out, b c: test all three sides"),
        (gives(&[bc, ab]), "a side left out, c a: test all three sides"),
        (gives(&[-bc, ca, ab]), "the side b c is turned around: go from a to b, from b to c and from c to a"),
        (gives(&[bc, -ca, ab]), "the side c a is turned around: go from a to b, from b to c and from c to a"),
        (gives(&[bc, ca, -ab]), "the side a b is turned around: go from a to b, from b to c and from c to a"),
        "is P0 subtracted twice? the plane goes through P0 = o, so the distance is n·(P - o)"
            // SignedDistance(p, P - P0) for a plane through P0 = o.
            .when(of_planes(p - 2.0 * o)),
        (of_planes(p), "the planes go through o, and you do not subtract it from P: the distance is n·(P - o)"),
    ]
}

pub(super) fn judge_inside(
    trial: &Trial<'_>,
    name: &'static str,
    ask: fn(&dyn Kit, &[InsideQuery]) -> Vec<bool>,
    chosen: &[Case],
) -> CheckResult {
    let inputs = prop_oneof![3 => plane_points(), 1 => exact_points()];
    trial.forall_and(chosen, 4000, inputs, |cases| {
        let queries: Vec<InsideQuery> = cases.iter().map(|case| case.0).collect();
        let judge = |case: &Case, yours| match clearly_inside(case) {
            Some(inside) if inside != yours => {
                Err(Broken::new(case.0.call(name), yours, inside, "double precision"))
            }
            _ => Ok(()),
        };
        compare_formulas(cases, ask(trial.kit, &queries), judge, |case, yours| mistakes(case, *yours))
    })
}

pub(super) fn inside_by_planes_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    // The ray's origin lies on the line of a side, so that plane's normal is 0, and normalizing it gives NaN.
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(4.0, 0.0, 0.0), c: vec3(0.0, 4.0, 0.0) };
    let ray = Ray::new(vec3(-4.0, 0.0, 0.0), vec3(5.0, 0.0, 0.0));
    let on_the_line = (InsideQuery { ray, point: vec3(1.0, 0.0, 0.0), triangle }, [0.75, 0.25, 0.0], true);
    judge_inside(trial, "inside_by_planes", |kit, queries| kit.inside_by_planes(queries), &[on_the_line])
}

const WRONG_SUM: &str = "your coordinates do not add up to 1: |u × v| is twice the area of the triangle";
const UNSIGNED_AREAS: &str = "areas without a sign cannot tell inside from outside: use signed areas";

const OTHER_CORNERS: &str =
    "your values belong to other corners: α to a, β to b, γ to c (the slide has γ, β and α in this order)";

/// Known mistakes in inside test III, each with whether it gives this answer.
fn area_mistakes(case @ (query, weights, _): &Case, yours: Option<Vec3>) -> Vec<(bool, &'static str)> {
    let &[alpha, beta, gamma] = weights;
    let [a, b, c] = weights.map(f64::abs);
    let near = |expected: [f64; 3]| {
        let difference = |yours: Vec3| (yours.as_dvec3() - DVec3::from_array(expected)).abs();
        yours.is_some_and(|yours| difference(yours).max_element() < 1e-3)
    };
    // Where rounding decides, also about a wrong test, each formula may give each answer.
    let is_open = clearly_inside(case).is_none();
    let is = |values: [f64; 3], margin: f64| {
        let is_given = if margin >= 0.0 { near(values) } else { yours.is_none() };
        is_open || is_given || (margin.abs() < 1e-6 && (near(values) || yours.is_none()))
    };
    let least = alpha.min(beta).min(gamma);
    let sum = a + b + c;
    let [of_a, of_b, of_c] = [query.triangle.a, query.triangle.b, query.triangle.c].map(Vec3::as_dvec3);
    let normal = (of_b - of_a).cross(of_c - of_a).length();
    let mut all = named![
        is(weights.map(|weight| 0.5 * weight), least) => WRONG_SUM,
        is(weights.map(|weight| 2.0 * weight), least) => WRONG_SUM,
        is(weights.map(|weight| weight * normal), least) => "you divide by |n| once, which leaves areas: divide by n·n",
        is(*weights, 1.0 - alpha.max(beta).max(gamma)) =>
            "a coordinate below 0 passes: test the three for ≥ 0, not for ≤ 1",
        is([a, b, c], 1.0 - a - b) => UNSIGNED_AREAS,
        is([a, b, c], 1.0 - a.max(b).max(c)) => UNSIGNED_AREAS,
        is([a, b, c], 1.0) => UNSIGNED_AREAS,
        is([a / sum, b / sum, c / sum], 1.0) => UNSIGNED_AREAS,
        is([a, b, 1.0 - a - b], 1.0 - a - b) => UNSIGNED_AREAS,
        is([1.0 - b - c, b, c], 1.0 - b - c) => UNSIGNED_AREAS,
        is([c, b, 1.0 - c - b], 1.0 - b - c) =>
            "this is the slide: its areas have no sign, so points outside pass, and its α belongs to corner c",
        is(*weights, 1.0) => "you return coordinates for a point outside: None if one of them is negative",
        is(*weights, if least > 0.0 { 1.0 } else { -1.0 }) =>
            "points on an edge are inside: compare with ≥, not with >",
        is(*weights, beta.min(gamma)) => "one of the three coordinates is not tested: α",
        is(*weights, alpha.min(gamma)) => "one of the three coordinates is not tested: β",
        is(*weights, alpha.min(beta)) => "one of the three coordinates is not tested: γ",
    ].to_vec();
    let orders = [
        [gamma, beta, alpha],
        [beta, gamma, alpha],
        [gamma, alpha, beta],
        [alpha, gamma, beta],
        [beta, alpha, gamma],
    ];
    all.extend(orders.map(|values| (is(values, least), OTHER_CORNERS)));
    all
}

fn judge_areas(case @ (query, weights, _): &Case, yours: Option<Vec3>) -> Judged {
    let Some(inside) = clearly_inside(case) else { return Ok(().into()) };
    let coordinates = DVec3::from_array(*weights);
    // The point is rounded at its own size. A thin triangle magnifies this error, here up to 30 times.
    let near = yours.is_none_or(|yours| (yours.as_dvec3() - coordinates).abs().max_element() < 1e-3);
    let expected = inside.then_some(coordinates.as_vec3());
    let input = || call("inside_by_areas", &[&query.point, &query.triangle]);
    let broken = || Broken::new(input(), yours, expected, "double precision");
    unless(yours.is_some() == inside && near, broken).formulas(area_mistakes(case, yours))
}

pub(super) fn inside_by_areas_gives_barycentric_coordinates(trial: &Trial<'_>) -> CheckResult {
    let inputs = prop_oneof![3 => plane_points(), 1 => exact_points()];
    trial.forall(4000, inputs, |cases| {
        let queries: Vec<InsideQuery> = cases.iter().map(|case| case.0).collect();
        compare(cases, trial.kit.inside_by_areas(&queries), judge_areas)
    })?;
    // A triangle without area gives None; the same query with an area does not.
    let ray = Ray::new(Vec3::Z, Vec3::NEG_Z);
    let query = |point, a, b, c| InsideQuery { ray, point, triangle: Triangle { a, b, c } };
    let p = vec3(0.25, 0.5, 0.0);
    // Both other coordinates are at least 0 and their sum is rounded to 1, but 1 - β - γ is -2⁻²⁵.
    let beyond = vec3(0.75, 0.25f32.next_up(), 0.0);
    // The coordinates of this point, (1/2 + 2⁻¹⁷, 1/2, -2⁻¹⁷), are exact.
    let outside = query(vec3(0.5, -(2f32.powi(-17)), 0.0), Vec3::ZERO, Vec3::X, Vec3::Y);
    let cases = [
        (query(p, Vec3::ZERO, Vec3::X, Vec3::Y), true),
        (outside, false),
        (query(p, p, p, p), false),
        (query(p, Vec3::ZERO, p, 2.0 * p), false),
        (query(beyond, Vec3::ZERO, Vec3::X, Vec3::Y), true),
    ];
    let answers = trial.kit.inside_by_areas(&cases.map(|case| case.0));
    let judged = cases.iter().zip(answers).map(|((query, has_area), yours)| {
        let negative = yours.is_some_and(|yours| !(yours.min_element() >= 0.0));
        let right = match has_area {
            // Rounding decides whether the point beyond the side is inside.
            true => !negative && (yours.is_some() || query.point == beyond),
            false => yours.is_none(),
        };
        if right {
            return Ok(());
        }
        let input = call("inside_by_areas", &[&query.point, &query.triangle]);
        let expected = if *has_area { "coordinates of at least 0" } else { "None" };
        let is_outside = query.point == outside.point;
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "the definition").explained_by(named![
            is_outside && yours.is_some() =>
                "you accept points just outside of an edge: test the signs, without a tolerance",
            !has_area && !is_outside && yours.is_some() =>
                "a triangle without area gives None: 0 / 0 is NaN, so compare so that NaN fails",
            *has_area && yours.is_some_and(|yours| yours.min_element() < 0.0 && yours.min_element() > -1e-6) =>
                "1 - β - γ may be slightly negative, although β + γ is rounded to 1: test it or clamp it to 0",
        ]))
    });
    all_hold(judged.collect())
}
