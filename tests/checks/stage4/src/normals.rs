//! The shading normal.

use checks::prelude::*;

type Query = (Vec3, Option<Vec3>, Vec3);

pub(super) fn paste_normal_query((geometric, interpolated, direction): &Query) -> String {
    call("shading_normal", &[geometric, interpolated, direction])
}

/// Pairs of normals at an angle below 1, seen from all directions. The interpolated normal has any length and either sign.
fn queries() -> impl Strategy<Value = Query> + Clone {
    let scale = prop_oneof![3 => fractions(1..=8, 4.0), 1 => nasty::scale(-59..=59)];
    (nasty::normals(), nasty::unit(), any::<bool>(), nasty::sign(), scale).prop_map(
        |((geometric, shading), direction, smooth, sign, length)| {
            (geometric, smooth.then_some(sign * length * shading), direction)
        },
    )
}

pub(super) fn shading_normal_faces_the_viewer(trial: &Trial<'_>) -> CheckResult {
    trial.each(2000, queries(), <dyn Kit>::shading_normal, judge_normal)
}

fn judge_normal(query: &Query, yours: Vec3) -> Judged {
    let (geometric, interpolated, direction) = *query;
    let facing = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
    // Normalize in double precision, because the square of a length of 1e18 has few digits left in single precision.
    let smooth = interpolated.map(|normal| normal.as_dvec3().normalize().as_vec3());
    let turned = |normal: Vec3, against: Vec3| if normal.dot(against) > 0.0 { -normal } else { normal };
    let expected = smooth.map_or(facing, |smooth| turned(smooth, -facing));
    // A geometric normal at right angles to the ray may have either sign.
    let grazing = geometric.dot(direction).abs() < 1e-6;
    let same = |n: Vec3| (yours - n).length() < 1e-5;
    let unnormalized = interpolated.map(|normal| turned(normal, -facing));
    let is = |normal: Option<Vec3>| {
        normal.is_some_and(|normal| (yours - normal).length() <= 1e-5 * normal.length())
    };
    let right = same(expected) || (grazing && same(-expected));
    let broken = || {
        Broken::new(paste_normal_query(query), yours, expected, "closed form").explained_by([
            (same(-expected), "your normal points away from the viewer: negate it"),
            (is(unnormalized), "your normal does not have unit length: normalize the interpolated normal"),
            "you leave out an interpolated normal because it is short: only one of length 0 has no direction"
                .when(same(facing) && interpolated.is_some_and(|normal| normal.length() < 0.1)),
            "you leave out an interpolated normal because it is long: only one of length 0 has no direction"
                .when(same(facing) && interpolated.is_some_and(|normal| normal.length() > 10.0)),
        ])
    };
    let mean = smooth.map_or(facing, |smooth| (turned(smooth, -facing) + facing).normalize());
    unless(right, broken).formulas(named![
        same(mean) => "you return the mean of both normals: the interpolated one alone shades a smooth surface",
        smooth.map_or(right, |smooth| same(turned(smooth, direction))) =>
            "you turn the interpolated normal by `direction`: turn it to the side of the geometric normal",
        same(facing) || (grazing && same(-facing)) => "you return the geometric normal where there is an interpolated one",
    ])
}

pub(super) fn shading_normal_falls_back_to_flat(trial: &Trial<'_>) -> CheckResult {
    // Of six interpolated normals two have no direction. Two others are good, and two are missing.
    let inputs = (queries(), 0..3i32).prop_map(|((geometric, good, direction), which)| {
        (geometric, if which == 0 { Some(Vec3::ZERO) } else { good }, direction)
    });
    trial.each_and(
        &[(Vec3::Y, Some(Vec3::ZERO), Vec3::Y)],
        500,
        inputs,
        <dyn Kit>::shading_normal,
        |query, yours| {
            let (geometric, interpolated, direction) = *query;
            // Another check judges good normals. Here the answer must be one of the two normals, with either sign.
            if let Some(normal) = interpolated.filter(|normal| normal.length_squared() > 0.0) {
                let (n, unit) = (normal.as_dvec3().normalize(), yours.as_dvec3().normalize());
                let parallel =
                    n.cross(unit).length() < 1e-4 || unit.cross(geometric.as_dvec3()).length() < 1e-4;
                let broken = || Broken::new(paste_normal_query(query), yours, n.as_vec3(), "closed form");
                return if parallel { Ok(()) } else { Err(broken()) };
            }
            let expected = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
            let grazing = geometric.dot(direction).abs() < 1e-6;
            if interpolated.is_none() || yours == expected || (grazing && yours == -expected) {
                return Ok(());
            }
            let source = "the geometric normal, turned to the viewer";
            Err(Broken::new(paste_normal_query(query), yours, expected, source).explained_by([
                "a normal of length 0 has no direction: return the geometric normal"
                    .when(yours.is_nan() || yours == Vec3::ZERO),
                (yours == -expected, "your geometric normal points away from the viewer: negate it"),
            ]))
        },
    )
}
