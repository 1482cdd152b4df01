//! The laws of `offset_origin` and `safe_normalize`.

use checks::offset::Start;
use checks::prelude::*;

/// Points with another error on each axis, at all scales, and directions down to 0.001 above the surface on either side.
fn surfaces() -> impl Strategy<Value = OffsetQuery> + Clone {
    (nasty::surface(), nasty::tilt(), any::<bool>()).prop_map(|(surface, (angle, turn), beyond)| {
        let normal = surface.geometric_normal;
        let direction = nasty::tilted(if beyond { -normal } else { normal }, angle, turn);
        OffsetQuery { point: surface.point, error: surface.error, normal, direction }
    })
}

/// Directions exactly perpendicular to the normal. Their scalar product is 0.0, and not -0.0, whose sign says nothing.
fn along_the_surface() -> Vec<OffsetQuery> {
    let (point, error) = (vec3(1.0, -2.0, 3.0), vec3(1e-3, 2e-3, 5e-4));
    let of_normal = |normal: Vec3| {
        let across = [1.0, -1.0].map(|sign| sign * vec3(normal.y, normal.z, normal.x));
        across.map(|direction| OffsetQuery { point, error, normal, direction })
    };
    let all = [Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::NEG_Z].into_iter().flat_map(of_normal);
    all.filter(|query| query.normal.dot(query.direction).is_sign_positive()).collect()
}

/// The start of the ray with this origin, on the side to which the direction goes.
fn start(query: &OffsetQuery, origin: Vec3) -> Start {
    let OffsetQuery { point, error, normal, direction } = *query;
    let side = if normal.as_dvec3().dot(direction.as_dvec3()) < 0.0 { -normal } else { normal };
    let surface = Surface { point, error, geometric_normal: normal, shading_normal: normal };
    Start::new(&surface, side, direction, &Ray::new(origin, direction))
}

/// The known mistakes, each with whether it gives this origin.
fn observations(query: &OffsetQuery, origin: Vec3) -> [(bool, &'static str); 5] {
    let start = start(query, origin);
    let along = query.normal.as_dvec3().dot(query.direction.as_dvec3());
    let (height, point) = (start.height(), query.point.as_dvec3());
    // The distance of two floats at the largest coordinate, at most.
    let one_float = 4.0 * U * point.abs().max_element();
    // A power of ten times the size of the point.
    let relative = [point.length(), point.abs().max_element()]
        .into_iter()
        .any(|size| (1..=7).any(|digits| (height / (size * 10f64.powi(-digits)) - 1.0).abs() < 0.01));
    named![
        along == 0.0 && height < 0.0 => "a direction perpendicular to the normal goes to the side of the normal",
        relative => "your offset is a fixed fraction of the size of the point: move by error·|n|",
        along < 0.0 && start.height() < 0.0 =>
            "the ray starts on the side of the normal, but it goes to the other side: turn the normal to the side of the direction",
        start.height() < 0.0 => "the ray starts on the other side: turn the normal to the side of the direction",
        height <= 0.0 || height < one_float && start.least() > 2.0 * one_float =>
            "the ray starts on the other side, up to rounding: turn the normal to the side of the direction",
    ]
}

/// Judges how far starts are from their points.
fn judge_heights(
    trial: &Trial<'_>,
    queries: &[OffsetQuery],
    is_right: impl Fn(&OffsetQuery, Vec3) -> bool,
    expected: impl Fn(&Start) -> String,
) -> Vec<CheckResult> {
    compare(queries, trial.kit.offset_origin(queries), |query, origin| {
        let start = start(query, origin);
        let broken = || {
            let yours = format!("{:.3e} off the point", start.height());
            Broken::with_texts(query.call("offset_origin"), yours, expected(&start), "closed form")
                .explained_by(observations(query, origin))
        };
        unless(is_right(query, origin), broken).formulas(start.mistakes())
    })
}

pub(super) fn offsets_leave_the_surface_at_any_scale(trial: &Trial<'_>) -> CheckResult {
    let is_right = |query: &OffsetQuery, origin| !start(query, origin).is_too_low();
    let least = |start: &Start| format!("{:.3e} or more, on the side of the direction", start.least());
    let judge = |queries: &[OffsetQuery]| judge_heights(trial, queries, is_right, least);
    trial.forall(4000, surfaces(), judge)?;
    all_hold(judge(&along_the_surface()))
}

pub(super) fn offsets_are_as_small_as_they_can_be(trial: &Trial<'_>) -> CheckResult {
    // The ray must hit objects that are farther away. A point that is not moved at all is not an offset.
    let is_right = |query: &OffsetQuery, origin| {
        let start = start(query, origin);
        !start.is_too_high() && (origin != query.point || start.least() == 0.0)
    };
    let most = |start: &Start| format!("at most {:.3e}, and not the point itself", start.most());
    trial.forall(4000, surfaces(), |queries| judge_heights(trial, queries, is_right, most))
}

/// Whether a cause certainly acts on a vector, and whether it possibly does.
#[derive(Clone, Copy)]
struct Acts {
    certainly: bool,
    possibly: bool,
}

/// Whether the squares of the coordinates underflow in single precision, and whether they overflow.
fn squares_fail(v: Vec3) -> [Acts; 2] {
    let squared = v.length_squared();
    // A sum of squares that is denormal, or has a denormal term, has lost some digits.
    let lost = f32::MIN_POSITIVE * 2f32.powi(24);
    let infinite = squared.is_infinite();
    [
        Acts { certainly: squared == 0.0, possibly: squared < lost },
        Acts { certainly: infinite, possibly: infinite },
    ]
}

pub(super) fn directions_have_length_one_at_every_length(trial: &Trial<'_>) -> CheckResult {
    let vectors = (nasty::unit(), -148..=128i32)
        .prop_map(|(v, exponent)| (v.as_dvec3() * 2f64.powi(exponent)).as_vec3());
    let vectors = vectors.prop_filter("neither 0 nor infinite", |v| *v != Vec3::ZERO && v.is_finite());
    let longest = [Vec3::splat(f32::MAX), vec3(f32::MAX, 1.0, -f32::MAX), Vec3::splat(f32::from_bits(1))];
    // A cause is proven if the answers are wrong exactly where it acts.
    let judge = |query: &Vec3, yours: Option<Vec3>| {
        let expected = query.as_dvec3().normalize();
        let broken = || Broken::new(call("safe_normalize", &[query]), yours, expected, "double precision");
        let [underflow, overflow] = squares_fail(*query);
        // Allow four roundings per coordinate.
        let is_wrong = !yours.is_some_and(|yours| (yours.as_dvec3() - expected).length() < 4.0 * 2.0 * U);
        let (is_none, is_zero) = (yours.is_none(), yours == Some(Vec3::ZERO));
        let infinite = (1.0 / query.abs().max_element()).is_infinite();
        let reciprocal = Acts { certainly: infinite, possibly: infinite };
        let either = Acts {
            certainly: underflow.certainly || overflow.certainly,
            possibly: underflow.possibly || overflow.possibly,
        };
        let of = |acts: Acts, answer: bool| if is_wrong { acts.possibly && answer } else { !acts.certainly };
        let v = query.as_dvec3();
        let is = |value: DVec3| {
            yours.is_some_and(|yours| (yours.as_dvec3() - value).length() <= 1e-6 * value.length())
        };
        let sum = v.abs().element_sum();
        let by_length = "you divide by another length: the length is the root of the sum of the squares";
        let epsilons = [1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3].map(|epsilon| {
            let value = v / (v.length() + epsilon);
            "a number is added to the length: short vectors become shorter than 1"
                .when(is(value) || is_none && value.length() < 1e-30)
        });
        let has_zero = query.to_array().contains(&0.0);
        unless(!is_wrong, broken).formulas(epsilons.into_iter().chain([
            (is(v / v.abs().max_element()), by_length),
            (is(v / sum), by_length),
            (is(v / v.element_sum()), by_length),
            (is(v / v.length_squared()), by_length),
            (is(v), "you return the vector as it is: divide it by its length"),
            "you take the largest coordinate with its sign: take the largest absolute value"
                .when(match v.max_element() {
                    largest if largest <= 0.0 => is_none || largest < 0.0,
                    largest => !is_wrong || largest < v.abs().max_element(),
                }),
            "you return None for a vector with a coordinate of 0: only the zero vector has no direction"
                .when(!is_wrong || is_none && has_zero),
            "you return None for a short vector: the squares underflow, so scale by the largest coordinate first"
                .when(of(underflow, is_none)),
            "you return None for a long vector: the squares overflow, so scale by the largest coordinate first"
                .when(of(overflow, is_none)),
            (of(underflow, true), "the squares underflow: scale by the largest coordinate first"),
            (of(overflow, true), "the squares overflow: scale by the largest coordinate first"),
            (of(either, true), "the squares underflow or overflow: scale by the largest coordinate first"),
            "1 / x is infinite for the smallest x: divide by the largest coordinate, and do not multiply by its reciprocal"
                .when(of(reciprocal, !is_none)),
            "you return None for a short vector: only the zero vector has no direction"
                .when(!is_wrong || (is_none && query.length() < 1.0)),
            "you return 0, as a division by an infinite length does: the squares overflow, so scale by the largest coordinate first"
                .when(!is_wrong || is_zero),
        ]))
    };
    let judge = |queries: &[Vec3]| compare(queries, trial.kit.safe_normalize(queries), judge);
    trial.forall_and(&longest, 4000, vectors, judge)
}

pub(super) fn zero_has_no_direction(trial: &Trial<'_>) -> CheckResult {
    let mut queries = vec![Vec3::ZERO, Vec3::splat(-0.0), vec3(0.0, -0.0, 0.0)];
    for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        queries.extend([
            vec3(number, 1.0, 0.0),
            vec3(0.0, number, -3.0),
            vec3(0.0, 1.0, number),
            Vec3::splat(number),
        ]);
    }
    // Vectors that have a direction.
    queries.extend([vec3(0.0, -2.0, 0.0), vec3(3.0, 0.0, -4.0)]);
    let judge = |query: &Vec3, yours: Option<Vec3>| {
        let has_none = *query == Vec3::ZERO || !query.is_finite();
        if has_none && yours.is_none() {
            return Ok(());
        }
        if !has_none {
            let expected = query.as_dvec3().normalize();
            // Allow four roundings per coordinate, as at every length.
            return match yours {
                Some(yours) if (yours.as_dvec3() - expected).length() < 4.0 * 2.0 * U => Ok(()),
                _ => Err(Broken::new(
                    call("safe_normalize", &[query]),
                    yours,
                    Some(expected),
                    "double precision",
                )),
            };
        }
        Err(Broken::new(call("safe_normalize", &[query]), yours, None::<Vec3>, "the definition")
            .explained_by([
                (*query == Vec3::ZERO, "you return a direction for the zero vector: 0 / 0 is NaN"),
                (!query.is_finite(), "you return a direction for a vector that is not finite"),
                (true, "you return a direction for the zero vector, and for vectors that are not finite"),
            ]))
    };
    all_hold(compare(&queries, trial.kit.safe_normalize(&queries), judge))
}
