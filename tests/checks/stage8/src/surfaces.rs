//! Checks of `bezier_point`.

use super::bounding_spheres::reach;
use checks::prelude::*;
use raykata::shape::BezierPatch;

fn patch() -> impl Strategy<Value = BezierPatch> + Clone {
    (prop::collection::vec(point(4), 16), nasty::any_scale()).prop_map(|(points, scale)| {
        let row = |row: usize| [0, 1, 2, 3].map(|column| scale * points[4 * row + column]);
        BezierPatch { rows: [0, 1, 2, 3].map(row) }
    })
}

fn describe(query: &PatchQuery) -> String {
    format!("bezier_point of a patch at {}", query.uv.paste())
}

const BY_DIFFERENCES: &str = "you compute p + t (q - p), which is not exactly q at t = 1, so neighbouring patches \
                              have gaps: use (1 - t) p + t q";

pub(super) fn bezier_starts_and_ends_at_its_corners(trial: &Trial<'_>) -> CheckResult {
    let rough = patch().prop_map(|mut patch| {
        // Use thirds: p + t (q - p) does not return them exactly at t = 1.
        patch.rows.iter_mut().flatten().for_each(|point| *point /= 3.0);
        patch
    });
    trial.forall(200, rough, |patches| {
        let corners = [(0.0, 0.0, 0, 0), (1.0, 0.0, 0, 3), (0.0, 1.0, 3, 0), (1.0, 1.0, 3, 3)];
        let queries: Vec<PatchQuery> = patches
            .iter()
            .flat_map(|patch| corners.map(|(u, v, ..)| PatchQuery { patch: *patch, uv: vec2(u, v) }))
            .collect();
        let answers = trial.kit.bezier_point(&queries);
        let judge = |(i, query): (usize, &PatchQuery)| {
            let (.., row, column) = corners[i % 4];
            let (yours, corner) = (answers[i], query.patch.rows[row][column]);
            let opposite = query.patch.rows[3 - row][3 - column];
            // The result of p + t (q - p) along the row, and then along the column.
            let blend = |t: f32| move |p: Vec3, q: Vec3| p + t * (q - p);
            let along = |[p, q, r, s]: [Vec3; 4], t: f32| {
                let of = blend(t);
                of(of(of(p, q), of(q, r)), of(of(q, r), of(r, s)))
            };
            let rows_first = along(query.patch.rows.map(|row| along(row, query.uv.x)), query.uv.y);
            let columns_first = along(
                [0, 1, 2, 3].map(|column| along(query.patch.rows.map(|row| row[column]), query.uv.y)),
                query.uv.x,
            );
            // Some round in another order, so their error at t = 1 has another size.
            let off = |place: Vec3| (place.as_dvec3() - corner.as_dvec3()).length();
            let is = |wrong: Vec3| off(yours) <= 8.0 * off(wrong);
            unless(yours == corner, || {
                Broken::new(describe(query), yours, corner, "the corner of the control net")
            })
            .formulas([
                "you exchange u and v: u runs along the rows, v along the columns"
                    .when(yours == query.patch.rows[column][row]),
                (yours == opposite, "you exchange t and 1 - t"),
                (is(rows_first), BY_DIFFERENCES),
                (is(columns_first), BY_DIFFERENCES),
            ])
        };
        proven(queries.iter().enumerate().map(judge)).chunks(4).map(|four| all_hold(four.to_vec())).collect()
    })
}

pub(super) fn bezier_point_is_the_mean_of_its_net(trial: &Trial<'_>) -> CheckResult {
    // First test a net whose points all differ, so that the answer shows which mistake was made.
    let heights = [[0, 1, 0, -1], [2, -1, 1, 0], [1, 3, 0, 2], [0, -2, 1, 1]];
    let row = |row: usize| [0, 1, 2, 3].map(|i| Vec3::new(i as f32, row as f32, heights[row][i] as f32));
    let hilly = PatchQuery { patch: BezierPatch { rows: [0, 1, 2, 3].map(row) }, uv: vec2(0.25, 0.625) };
    let grid = (0..=8u32, 0..=8u32).prop_map(|(u, v)| vec2(u as f32, v as f32) / 8.0);
    let any = (0.0..1.0f32, 0.0..1.0f32).prop_map(|(u, v)| vec2(u, v));
    let inputs = (patch(), prop_oneof![grid, any]).prop_map(|(patch, uv)| PatchQuery { patch, uv });
    trial.each_and(&[hilly], 1000, inputs, <dyn Kit>::bezier_point, judge_points)
}

fn judge_points(query: &PatchQuery, yours: Vec3) -> Judged {
    let at = |[u, v]: [f32; 2], weights: fn(f64) -> [f64; 4]| -> DVec3 {
        let [across, along] = [u, v].map(|t| weights(f64::from(t)));
        let terms = (0..16).map(|i| across[i % 4] * along[i / 4] * query.patch.rows[i / 4][i % 4].as_dvec3());
        terms.sum()
    };
    let [u, v] = query.uv.to_array();
    let right = at([u, v], bernstein);
    // Allow two rounding errors for each of six nested interpolations of these numbers, and some more for Bernstein
    // polynomials.
    let room = 16.0 * U * reach(query.patch.rows.iter().flatten());
    let near = |right: DVec3| (yours.as_dvec3() - right).abs().max_element() <= room;
    let once = |t: f64| [(1.0 - t) * (1.0 - t), t * (1.0 - t), t * (1.0 - t), t * t];
    unless(near(right), || {
        Broken::new(describe(query), yours, right.as_vec3(), "Bernstein polynomials in double")
    })
    .formulas(named![
        near(at([v, u], bernstein)) => "you exchange u and v: u runs along the rows, v along the columns",
        near(at([1.0 - u, 1.0 - v], bernstein)) => "you exchange t and 1 - t",
        near(at([1.0 - u, v], bernstein)) => "you exchange u and 1 - u",
        near(at([u, 1.0 - v], bernstein)) => "you exchange v and 1 - v",
        near(at([u, u], bernstein)) => "you use one parameter twice, u: u runs along the rows, v along the columns",
        near(at([v, v], bernstein)) => "you use one parameter twice, v: u runs along the rows, v along the columns",
        near(at([u, v], |t| [1.0 - t, 0.0, 0.0, t])) =>
            "you use only the corners: the control points between them have weights, too",
        near(at([u, v], once)) => "you interpolate twice along a curve: four points need three rounds, 4, 3, 2, 1",
        near(at([u, v], without_factors)) => "your weights do not add up to 1: their factors are 1, 3, 3 and 1",
        near(at([u, v], interpolating)) =>
            "your surface passes through all control points: a Bézier patch passes only through its corners in general",
    ])
}

fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn without_factors(t: f64) -> [f64; 4] {
    let [a, b, c, d] = bernstein(t);
    [a, b / 3.0, c / 3.0, d]
}

/// The weights of the curve that passes through its four points at t = 0, 1/3, 2/3 and 1.
fn interpolating(t: f64) -> [f64; 4] {
    let weight = |i: usize| {
        let others = (0..4).filter(|&j| j != i);
        others.map(|j| (3.0 * t - j as f64) / (i as f64 - j as f64)).product()
    };
    [weight(0), weight(1), weight(2), weight(3)]
}
