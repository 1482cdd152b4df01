//! Boxes: bounds of triangles and spheres, union, centroid, surface area.

use checks::generate::{scaled, sphere, triangle};
use checks::prelude::*;
use checks::{double, tree};

const TOO_SMALL: &str = "your box is too small: go one whole radius from the centre to each side";

const ONE_AXIS: &str = "you go one radius from the centre along one axis only: go along each axis";

const CORNERS: &str = "min and max are corners of the triangle in your box: take the smallest and the largest coordinate on each axis";

const MIXED: &str =
    "one side of your box takes min of two corners and max with the third, or the other way round";

pub(super) fn bounds_of_a_triangle_are_tight(trial: &Trial<'_>) -> CheckResult {
    let sized = (triangle(), nasty::any_scale()).prop_map(|(triangle, size)| scaled(triangle, size));
    trial.each(1000, sized, <dyn Kit>::triangle_bounds, |triangle, yours| {
        let corner = |p: Vec3| Aabb::new(p, p);
        let two = |p: Vec3, q: Vec3| tree::around(&[corner(p), corner(q)]);
        let Triangle { a, b, c } = *triangle;
        let expected = tree::around(&[corner(a), corner(b), corner(c)]);
        let pairs = [two(a, b), two(b, c), two(c, a)];
        let absolute = tree::around(&[two(a.abs(), b.abs()), corner(c.abs())]);
        let mut mistakes = Vec::from(
            pairs.map(|pair| (yours == pair, "your box leaves out a corner: it contains only two of them")),
        );
        mistakes.extend([
            "you return a padded box: boxes are closed, so even a flat box needs no padding"
                .when(yours.contains_box(&expected) && !yours.is_empty()),
            "min and max are exchanged: min is the smaller one on each axis"
                .when(yours == Aabb::new(expected.max, expected.min)),
            (yours == absolute, "you take coordinates without their signs"),
            (yours == Aabb::new(a, b), CORNERS),
            (yours == Aabb::new(a, c), CORNERS),
            (yours == Aabb::new(expected.min, a.max(b).min(c)), MIXED),
            (yours == Aabb::new(a.min(b).max(c), expected.max), MIXED),
        ]);
        let one_side = "your box leaves out a corner on one side: min and max need all three";
        mistakes.extend(pairs.map(|pair| (yours == Aabb::new(expected.min, pair.max), one_side)));
        mistakes.extend(pairs.map(|pair| (yours == Aabb::new(pair.min, expected.max), one_side)));
        let broken = || Broken::new(call("triangle_bounds", &[triangle]), yours, expected, "closed form");
        unless(yours == expected, broken).formulas(mistakes)
    })
}

pub(super) fn bounds_of_a_sphere_hold_it(trial: &Trial<'_>) -> CheckResult {
    let spheres =
        (rough_point(100.0), magnitude(-3.0, 3.0)).prop_map(|(center, radius)| Sphere { center, radius });
    let sized = (sphere(), nasty::any_scale())
        .prop_map(|(sphere, size)| Sphere { center: size * sphere.center, radius: size * sphere.radius });
    let spheres = prop_oneof![sphere(), spheres, sized];
    trial.each(1000, spheres, <dyn Kit>::sphere_bounds, |sphere, yours| {
        let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
        // Allow half a float for the rounding and two floats outwards; a float is two roundings at most.
        let slack = (center.abs() + radius) * 5.0 * double::U;
        let near = |yours: Vec3, exact: DVec3| (yours.as_dvec3() - exact).abs().cmple(slack).all();
        // Rounding alone may put a side inside: a float further is too far.
        let [low, high] = [-1.0, 1.0].map(|side| sphere.center + side * sphere.radius);
        let least = Aabb::new(low.max((center - radius).as_vec3()), high.min((center + radius).as_vec3()));
        let is_near = near(yours.min, center - radius) && near(yours.max, center + radius);
        let right = is_near && yours.contains_box(&least);
        let expected = Aabb::new((center - radius).as_vec3(), (center + radius).as_vec3());
        let is = |low: DVec3, high: DVec3| near(yours.min, low) && near(yours.max, high);
        // A box that is larger on each side by the same length, or by the same part of the radius.
        let (low, high) = (center - radius - yours.min.as_dvec3(), yours.max.as_dvec3() - center - radius);
        let pad = DVec3::splat(low.max(high).max_element());
        let is_padded =
            (low - pad).abs().max((high - pad).abs()).cmple(slack.max_element() + 1e-3 * pad).all();
        let broken = || {
            Broken::new(call("sphere_bounds", &[sphere]), yours, expected, "closed form").explained_by([
                "your sides are rounded towards the centre: move them outwards, or not at all".when(is_near),
                "you pad the box: one radius from the centre is enough, up to rounding".when(is_padded),
            ])
        };
        unless(right, broken).formulas(named![
            is(DVec3::splat(-radius), DVec3::splat(radius)) =>
                "your box has the right size but the wrong place: go one radius from the centre",
            is(center - 0.5 * radius, center + 0.5 * radius) => TOO_SMALL,
            is(center - radius / 3f64.sqrt(), center + radius / 3f64.sqrt()) => TOO_SMALL,
            is(center - radius * DVec3::X, center + radius * DVec3::X) => ONE_AXIS,
            is(center - radius * DVec3::Y, center + radius * DVec3::Y) => ONE_AXIS,
            is(center - radius * DVec3::Z, center + radius * DVec3::Z) => ONE_AXIS,
            is(center, center + radius) => "your box begins at the centre: go one radius to each side",
            is(center, center + 2.0 * radius) => "your box begins at the centre: go one radius to each side of it",
            is(center - 2.0 * radius, center + 2.0 * radius) =>
                "your box is too large: go one radius from the centre to each side, not the diameter",
        ])
    })
}

/// Boxes; some of them are flat.
pub(super) fn aabb() -> impl Strategy<Value = Aabb> + Clone {
    (point(4), point(4)).prop_map(|(p, q)| Aabb::new(p.min(q), p.max(q)))
}

pub(super) fn union_holds_both_boxes(trial: &Trial<'_>) -> CheckResult {
    let sized = || (aabb(), nasty::any_scale()).prop_map(|(b, size)| Aabb::new(size * b.min, size * b.max));
    let boxes = || prop_oneof![9 => sized(), 1 => Just(Aabb::EMPTY)];
    let (first, second) = (Aabb::new(Vec3::ONE, 2.0 * Vec3::ONE), Aabb::new(Vec3::ZERO, Vec3::splat(0.5)));
    trial.each_and(
        &[(first, second), (second, first)],
        1000,
        (boxes(), boxes()),
        <dyn Kit>::union,
        |(first, second), yours| {
            let expected = tree::around([first, second]);
            let empty = first.is_empty() || second.is_empty();
            // A right answer for an empty box may come from a case of its own.
            let open = empty && yours == expected;
            let broken = || {
                Broken::new(call("union", &[first, second]), yours, expected, "closed form")
                    .explained_by([(empty, "the empty box (inf, -inf) must change nothing")])
            };
            let shared = Aabb::new(first.min.max(second.min), first.max.min(second.max));
            let least = Aabb::new(expected.min, first.max.min(second.max));
            let most = Aabb::new(first.min.max(second.min), expected.max);
            let origin = Aabb::new(Vec3::ZERO, Vec3::ZERO);
            let or_origin = |b: &Aabb| if b.is_empty() { origin } else { *b };
            unless(yours == expected, broken).formulas(named![
                yours == tree::around([&or_origin(first), &or_origin(second)]) =>
                    "the empty box (inf, -inf) must change nothing: you take it for a box at the origin",
                open || yours == shared => "you return what both boxes share: take the smaller min and the larger max",
                open || yours == least || yours == most => "you take the smaller, or the larger, corner for both sides",
                yours == *first || open => "you return the first box",
                yours == *second || open => "you return the second box",
            ])
        },
    )
}

pub(super) fn centroid_is_the_middle(trial: &Trial<'_>) -> CheckResult {
    let sized = (aabb(), nasty::any_scale()).prop_map(|(b, size)| Aabb::new(size * b.min, size * b.max));
    trial.each(1000, sized, <dyn Kit>::centroid, |bounds, yours| {
        // Exact, because all coordinates are multiples of 1/8 times a power of two.
        let expected = 0.5 * (bounds.min + bounds.max);
        let broken = || Broken::new(call("centroid", &[bounds]), yours, expected, "closed form");
        unless(yours == expected, broken).formulas([
            (yours == bounds.min + bounds.max, "you return min + max, not halved"),
            (yours == 0.5 * (bounds.max - bounds.min), "you return half the size of the box, not its middle"),
            (yours == bounds.max - bounds.min, "you return the size of the box, not its middle"),
            (yours == bounds.min, "you return a corner of the box, not its middle"),
            (yours == bounds.max, "you return a corner of the box, not its middle"),
        ])
    })
}

const FLAT: &str =
    "a flat box has no area in your answer: only the empty box has none, and a flat one has two faces";

const FOUR_FACES: &str = "two of the six faces are left out: a box has two of each pair of axes";

pub(super) fn surface_area_counts_six_faces(trial: &Trial<'_>) -> CheckResult {
    let sized = (aabb(), nasty::scale(-50..=50)).prop_map(|(b, size)| Aabb::new(size * b.min, size * b.max));
    let cube = Aabb::new(Vec3::ZERO, Vec3::new(2.0, 3.0, 5.0));
    let boxes = prop_oneof![9 => sized, 1 => Just(Aabb::EMPTY)];
    trial.each_and(&[cube], 1000, boxes, <dyn Kit>::surface_area, |bounds, yours| {
        // Exact, because the products are multiples of 1/64 times a power of two.
        let expected = 2.0 * tree::half_area(bounds) as f32;
        let empty = "an empty box has no faces: return 0 (its size max - min is -inf)";
        let broken = || {
            Broken::new(call("surface_area", &[bounds]), yours, expected, "closed form")
                .explained_by([(bounds.is_empty(), empty)])
        };
        let size = bounds.max - bounds.min;
        let near =
            |area: f32| bounds.is_empty() || yours == area || (yours - area).abs() <= 1e-6 * area.abs();
        unless(yours == expected, broken).formulas([
            (near(size.element_product()), "you return the volume, not the area"),
            (near(0.5 * expected), "you return half of the area: each face counts twice"),
            (near(2.0 * expected), "you return twice the area: each face counts twice, not four times"),
            (near(size.length_squared()), "you return the squared diagonal, not the area"),
            (near(if size.min_element() == 0.0 { 0.0 } else { expected }), FLAT),
            (near(expected - 2.0 * size.x * size.y), FOUR_FACES),
            (near(expected - 2.0 * size.y * size.z), FOUR_FACES),
            (near(expected - 2.0 * size.z * size.x), FOUR_FACES),
            "you return the area of a cube with the longest edge"
                .when(near(6.0 * size.max_element() * size.max_element())),
            (near(4.0 * size.element_sum()), "you return the length of the edges, not the area"),
        ])
    })
}
