//! Known mistakes in the intersection of a ray and a sphere, each with the answer that it gives.

use crate::sphere_method::{Accepts, Quadratic};
use checks::prelude::*;

/// A part of the line along the ray, without its ends.
#[derive(Clone, Copy)]
struct Within(f64, f64);

impl Within {
    /// The first of these roots that lies in the range.
    fn first(self, roots: [f64; 2]) -> Option<f64> {
        let [near, far] = [roots[0].min(roots[1]), roots[0].max(roots[1])];
        [near, far].into_iter().find(|&t| self.0 < t && t < self.1)
    }
}

/// Whether a method gives this answer, up to the rounding of the formula on the slide. `roots` computes its roots from the
/// square root of the discriminant, and `choose` returns one of them.
fn gives(
    yours: Option<f32>,
    quadratic: &Quadratic,
    roots: impl Fn(f64) -> [f64; 2],
    choose: impl Fn([f64; 2]) -> Option<f64>,
) -> bool {
    // The discriminant and each root may be off by their rounding errors. A discriminant of exactly 0 is exact.
    let slack = if quadratic.discriminant == 0.0 { 0.0 } else { quadratic.slack };
    let tolerance = Quadratic { slack, ..*quadratic }.tolerance();
    let discriminants = [0.0, -slack, slack].map(|error| quadratic.discriminant + error);
    let answers = discriminants.into_iter().flat_map(|discriminant| {
        let at = (discriminant >= 0.0).then(|| roots(discriminant.sqrt()));
        [0.0, -tolerance, tolerance].map(|shift| choose(at?.map(|root| root + shift)))
    });
    let mut answers = answers;
    answers.any(|answer| match (yours, answer) {
        (Some(yours), Some(t)) => (f64::from(yours) - t).abs() <= 4.0 * tolerance + 1e-6 * t.abs(),
        (yours, answer) => yours.is_none() && answer.is_none(),
    })
}

/// The limits of `t` below which hits are lost.
pub(super) const EPSILONS: [f64; 5] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

pub(super) const DROPS_NEAR_HITS: &str =
    "you drop hits with a small t: compare with t_min, not with a fixed epsilon";

/// All known mistakes, each with whether it gives this answer.
pub(super) fn mistakes(
    query: &SphereQuery,
    yours: Option<f32>,
    accepts: Accepts,
) -> Vec<(bool, &'static str)> {
    let quadratic = match accepts {
        Accepts::TheFormula => Quadratic::of(query),
        Accepts::FewRoundings => Quadratic::stable(query),
    };
    let mut all = of_choices(query, yours, &quadratic);
    all.extend(of_formulas(query, yours, &quadratic));
    if accepts == Accepts::FewRoundings {
        all.extend(of_cancellation(query, yours));
    }
    all
}

const ALGEBRAIC: &str = "b² - a c cancels for a distant or small sphere: use r² - |f⊥|²";
const GEOMETRIC: &str = "L·L - t_ca² cancels for a distant or small sphere: use |L - t_ca d|²";

/// The formulas of the slides in single precision, which cancel for a distant or small sphere.
fn of_cancellation(query: &SphereQuery, yours: Option<f32>) -> Vec<(bool, &'static str)> {
    let SphereQuery { ray, sphere } = query;
    let (d, r_squared) = (ray.direction, sphere.radius * sphere.radius);
    let f = ray.origin - sphere.center;
    let (a, b, c) = (d.dot(d), -f.dot(d), f.dot(f) - r_squared);
    let is = |discriminant: f32, roots: &dyn Fn(f32) -> [f32; 2]| {
        let [first, second] = roots(discriminant.sqrt());
        let found = [first.min(second), first.max(second)].into_iter().find(|&t| ray.contains(t));
        match (yours, found.filter(|_| discriminant >= 0.0)) {
            (Some(yours), Some(t)) => (yours - t).abs() <= 1e-6 * t.abs(),
            (yours, found) => yours.is_none() && found.is_none(),
        }
    };
    let twice = 2.0 * b;
    let mut all = vec![
        (is(b * b - a * c, &|root| [(b - root) / a, (b + root) / a]), ALGEBRAIC),
        (is(b * b - a * c, &|root| [c / (b + root.copysign(b)), (b + root.copysign(b)) / a]), ALGEBRAIC),
        ALGEBRAIC.when(is(twice * twice - 4.0 * a * c, &|root| {
            [(twice - root) / (2.0 * a), (twice + root) / (2.0 * a)]
        })),
        (is(twice * twice - 4.0 * c, &|root| [(twice - root) / 2.0, (twice + root) / 2.0]), ALGEBRAIC),
        (is(r_squared - (f.dot(f) - b * b), &|t_hc| [b - t_hc, b + t_hc]), GEOMETRIC),
    ];
    let t_ca = b / a;
    for squared in [
        r_squared - (f.dot(f) - t_ca * t_ca * a),
        r_squared - (f.dot(f) - b * t_ca),
        r_squared - (f.dot(f) - t_ca * t_ca),
    ] {
        let far = |t_hc: f32| t_ca + (t_hc / a.sqrt()).copysign(t_ca);
        all.extend([
            (is(squared, &|t_hc| [t_ca - t_hc / a.sqrt(), t_ca + t_hc / a.sqrt()]), GEOMETRIC),
            (is(squared / a, &|t_hc| [t_ca - t_hc, t_ca + t_hc]), GEOMETRIC),
            (is(squared, &|t_hc| [c / a / far(t_hc), far(t_hc)]), GEOMETRIC),
        ]);
    }
    // The same for a direction that is normalized first, with t divided by its length.
    let length = d.length();
    let t_ca = -f.dot(d / length);
    let squared = r_squared - (f.dot(f) - t_ca * t_ca);
    all.push((is(squared, &|t_hc| [(t_ca - t_hc) / length, (t_ca + t_hc) / length]), GEOMETRIC));
    all
}

/// Mistakes that a wrong answer alone shows.
pub(super) fn observations(query: &SphereQuery, yours: Option<f32>) -> [(bool, &'static str); 3] {
    let touches = Quadratic::of(query).discriminant == 0.0;
    [
        (yours.is_some_and(f32::is_nan), "you return NaN: compare so that NaN fails"),
        "the range is open: a hit at t_min or at t_max does not count (t = 0 for a ray that starts on the sphere)"
            .when(yours.is_some_and(|t| t == query.ray.t_min || t == query.ray.t_max)),
        "you return None for a ray that touches the sphere: a discriminant of exactly 0 is a hit"
            .when(yours.is_none() && touches),
    ]
}

/// Right roots of which the wrong one is returned.
fn of_choices(query: &SphereQuery, yours: Option<f32>, quadratic: &Quadratic) -> Vec<(bool, &'static str)> {
    let Quadratic { a, b, .. } = *quadratic;
    let roots = |root: f64| [(b - root) / a, (b + root) / a];
    let (t_min, t_max) = (f64::from(query.ray.t_min), f64::from(query.ray.t_max));
    let range = Within(t_min, t_max);
    let is = |choose: &dyn Fn([f64; 2]) -> Option<f64>| gives(yours, quadratic, roots, choose);
    let one = |t: f64, range: Within| range.first([t, t]);
    let forward = Within(0.0, f64::INFINITY);
    let mut all = named![
        is(&|[_, far]| one(far, range)) => "you return the far root",
        is(&|roots| if b < 0.0 { None } else { range.first(roots) }) =>
            "t_ca < 0 is not a miss: a ray that starts inside still hits the far side",
        is(&|[near, _]| one(near, range)) =>
            "you only try the near root: if the ray starts inside, it is behind the ray, and the far one counts",
        is(&|roots| Within(t_min, f64::INFINITY).first(roots)) => "you return a t beyond t_max: ask ray.contains(t)",
        is(&|roots| Within(0.0, t_max).first(roots)) => "you return a t before t_min: ask ray.contains(t)",
        is(&|roots| forward.first(roots)) => "you ask t > 0 and not ray.contains(t): t_min and t_max count",
        is(&|[near, _]| Some(near)) => "you return the near root in any case: ask ray.contains(t)",
        is(&|[near, far]| forward.first([near, far]).filter(|&t| t_min < t && t < t_max)) =>
            "you choose a root before you ask ray.contains(t): if the near root does not count, the far one may",
        is(&|[near, far]| range.first([near, far].map(|t| if t < t_max { t } else { t_max }))) =>
            "you return t_max for a hit beyond it: that is a miss",
        is(&|[near, far]| range.first([-near, -far])) => "the sign of b (or of t_ca) is wrong: both roots are negated",
        is(&|_| one(b / a, range)) => "you return the t of the point nearest to the centre: half the chord is missing",
    ].to_vec();
    // The limit replaces t_min, or is asked before or after the root is chosen.
    all.extend(EPSILONS.into_iter().flat_map(|epsilon| {
        let text = DROPS_NEAR_HITS;
        [
            (is(&|roots| Within(epsilon, t_max).first(roots)), text),
            (is(&|roots| Within(t_min.max(epsilon), t_max).first(roots)), text),
            (is(&|roots| range.first(roots).filter(|&t| t > epsilon)), text),
        ]
    }));
    all
}

const CHORD: &str =
    "half of the chord and t_ca have different units: divide both by the length of direction, or none";
const UNSQUARED: &str = "the distance of the ray's line stands where its square belongs";
const ADDED: &str = "r² is added and not taken away: it is |o - center|² - r²";
const A_IS_ONE: &str = "direction is not a unit vector here: you take a = d·d for 1";

/// Wrong roots.
fn of_formulas(query: &SphereQuery, yours: Option<f32>, quadratic: &Quadratic) -> Vec<(bool, &'static str)> {
    let Quadratic { a, b, .. } = *quadratic;
    let range = Within(f64::from(query.ray.t_min), f64::from(query.ray.t_max));
    let first = |roots| range.first(roots);
    let of = |quadratic: &Quadratic, scale: f64| {
        let Quadratic { a, b, .. } = *quadratic;
        gives(yours, quadratic, |root| [scale * (b - root) / a, scale * (b + root) / a], first)
    };
    // Without a = d·d: in the quadratic, or in the vector from the centre to the ray's nearest point.
    let f = query.ray.origin.as_dvec3() - query.sphere.center.as_dvec3();
    let radius = f64::from(query.sphere.radius);
    let squared = radius * radius;
    let c = f.length_squared() - squared;
    let a_is_one = Quadratic { a: 1.0, discriminant: b * b - c, ..*quadratic };
    // The square of the vector from the centre to the ray's nearest point, with this in place of t_ca.
    let away = |t_ca: f64| (f + t_ca * query.ray.direction.as_dvec3()).length_squared();
    let chord = Quadratic { a: 1.0, discriminant: squared - away(b), ..*quadratic };
    let q = |root: f64| b + root.copysign(b);
    let by_product = |root: f64| [c / q(root), q(root)];
    // One root by the product of both. Where the discriminant is wrong, c may be right, and the other way round.
    let with = |discriminant: f64| Quadratic { discriminant, ..*quadratic };
    let by_power = |discriminant: f64, c: f64| {
        gives(yours, &with(discriminant), |root| [c / q(root), q(root) / a], first)
    };
    let right = quadratic.discriminant;
    let added = f.length_squared() + squared;
    // One root with half of the chord in world units, and the other one by the product of both.
    let by_chord = |root: f64| {
        let away = b / a + (root / a.sqrt()).copysign(b);
        [c / a / away, away]
    };
    // t_ca = L·d, and all else with a.
    let by_length_of_one = |root: f64| {
        let away = b + (root / a.sqrt()).copysign(b);
        [c / a / away, away]
    };
    // One root by the product of both, in which the power of the point is divided by |d| alone.
    let by_length = |root: f64| [a.sqrt() * c / q(root), q(root) / a];
    // A wrong discriminant, with both roots by the formula or one of them by the product of both.
    let discriminants = named![
        right / a => CHORD,
        a * (squared - away(b)) => A_IS_ONE,
        a * (radius - away(b / a)) => "r stands where r² belongs",
        a * (squared - away(b / a).sqrt()) => UNSQUARED,
        b * b - a * added => ADDED,
        a * (squared + away(b / a)) => "by Pythagoras, the square of half the chord is r² minus the squared distance, not plus",
        4.0 * right => "the square root is doubled: with b = -f·d the discriminant is b² - a c, without a factor 4",
        a * (squared - away(-b / a)) => "the vector from the centre to the nearest point has a wrong sign: it is o + t_ca d - center",
        a * (squared - away(b / a / a.sqrt())) => "t_ca counts lengths of direction: multiply it by direction, not by a unit vector",
    ];
    let of_discriminants = discriminants
        .into_iter()
        .flat_map(|(wrong, text)| [(of(&with(wrong), 1.0), text), (by_power(wrong, c), text)]);
    named![
        of(quadratic, a.sqrt()) =>
            "your t counts world units; it must count lengths of direction (which is no unit vector here)",
        of(quadratic, a) => "direction is not a unit vector here: divide by a = d·d",
        gives(yours, quadratic, by_product, first) => "one of the roots is not divided by a = d·d",
        gives(yours, quadratic, |root| [(b - root * a.sqrt()) / a, (b + root * a.sqrt()) / a], first) => CHORD,
        gives(yours, quadratic, by_chord, first) => CHORD,
        gives(yours, quadratic, by_length, first) =>
            "|o - center|² - r² is divided by |d|: the product of both roots has d·d",
        gives(yours, quadratic, |root| [(b * a.sqrt() - root) / a, (b * a.sqrt() + root) / a], first) => CHORD,
        of(quadratic, 0.5) => "both roots are halved: with b = -f·d they are divided by a alone",
        of(quadratic, 2.0) => "both roots are doubled: they are divided by a",
        of(&Quadratic::with_radius(query, 0.5 * radius), 1.0) => "you take the radius for a diameter",
        of(&Quadratic::with_radius(query, 2.0 * radius), 1.0) => "you take the diameter for the radius",
        of(&Quadratic::with_radius(query, 0.0), 1.0) => "the radius is left out: c = f·f - r²",
        of(&a_is_one, 1.0) => A_IS_ONE,
        gives(yours, &chord, by_product, first) => A_IS_ONE,
        gives(yours, &chord, by_length_of_one, first) => A_IS_ONE,
        gives(yours, &a_is_one, |root| [b - root, b + root], |roots| first(roots).filter(|_| b >= 0.0)) =>
            "t_ca < 0 is not a miss: a ray that starts inside still hits the far side\nand: direction is not a unit vector here: you take a = d·d for 1",
        of(&Quadratic::with_radius(query, radius.sqrt()), 1.0) => "r stands where r² belongs",
        by_power(right, f.length_squared() - radius) => "r stands where r² belongs",
        by_power(right, a * c) => "|o - center|² - r² is not divided by d·d",
        by_power(right, added) => ADDED,
        by_power(b * b - a * added, added) => ADDED,
    ]
    .into_iter()
    .chain(of_discriminants)
    .collect()
}
