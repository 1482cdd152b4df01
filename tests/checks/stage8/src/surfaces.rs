//! Checks of `bezier_point`.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::point;
use checks::judge::{compare, known};
use checks::paste::{Paste, list};
use glam::{DVec3, Vec3, vec2};
use proptest::prelude::*;
use raykata::kit::PatchQuery;
use raykata::shape::BezierPatch;

fn patch() -> impl Strategy<Value = BezierPatch> + Clone {
    prop::collection::vec(point(4), 16).prop_map(|points| {
        let row = |row: usize| [0, 1, 2, 3].map(|column| points[4 * row + column]);
        BezierPatch { rows: [0, 1, 2, 3].map(row) }
    })
}

fn describe(query: &PatchQuery) -> String {
    // Write two rows per line, because a message shows three lines of the input.
    let [a, b, c, d] = query.patch.rows.map(|row| list(&row));
    format!("bezier_point(&BezierPatch {{ rows: [{a}, {b},\n{c}, {d}] }},\n{})", query.uv.paste())
}

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
            let diagnosis = match () {
                () if yours == query.patch.rows[column][row] => {
                    "you exchange u and v: u runs along the rows, v along the columns"
                }
                () if yours == opposite => "you exchange t and 1 - t",
                () if (yours - corner).length() < 1e-5 => {
                    "you compute p + t (q - p), which is not exactly q at t = 1, so neighbouring patches \
                     have gaps: use (1 - t) p + t q"
                }
                () => "",
            };
            match yours == corner {
                true => Ok(()),
                false => Err(Broken::new(describe(query), yours, corner, "the corner of the control net")
                    .looks_like(known(diagnosis))),
            }
        };
        queries
            .iter()
            .enumerate()
            .map(judge)
            .collect::<Vec<CheckResult>>()
            .chunks(4)
            .map(|four| four.iter().cloned().collect())
            .collect()
    })
}

pub(super) fn bezier_point_is_the_mean_of_its_net(trial: &Trial<'_>) -> CheckResult {
    // First test a net whose points all differ, so that the answer shows which mistake was made.
    let heights = [[0, 1, 0, -1], [2, -1, 1, 0], [1, 3, 0, 2], [0, -2, 1, 1]];
    let row = |row: usize| [0, 1, 2, 3].map(|i| Vec3::new(i as f32, row as f32, heights[row][i] as f32));
    let hilly = PatchQuery { patch: BezierPatch { rows: [0, 1, 2, 3].map(row) }, uv: vec2(0.25, 0.625) };
    judge_points(trial, &[hilly]).into_iter().collect::<CheckResult>()?;
    let inputs = (patch(), 0..=8u32, 0..=8u32)
        .prop_map(|(patch, u, v)| PatchQuery { patch, uv: vec2(u as f32, v as f32) / 8.0 });
    trial.forall(1000, inputs, |queries| judge_points(trial, queries))
}

fn judge_points(trial: &Trial<'_>, queries: &[PatchQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.bezier_point(queries), |query, yours| {
        let at = |[u, v]: [f32; 2], weights: fn(f64) -> [f64; 4]| -> DVec3 {
            let [across, along] = [u, v].map(|t| weights(f64::from(t)));
            let terms =
                (0..16).map(|i| across[i % 4] * along[i / 4] * query.patch.rows[i / 4][i % 4].as_dvec3());
            terms.sum()
        };
        let [u, v] = query.uv.to_array();
        let right = at([u, v], bernstein);
        // Allow two rounding errors for each of six nested interpolations of numbers up to 4.
        let near =
            |right: DVec3| (yours.as_dvec3() - right).abs().max_element() <= 16.0 * checks::double::U * 4.0;
        let diagnosis = match () {
            () if near(at([v, u], bernstein)) => {
                "you exchange u and v: u runs along the rows, v along the columns"
            }
            () if near(at([1.0 - u, 1.0 - v], bernstein)) => "you exchange t and 1 - t",
            () if near(at([u, u], bernstein)) || near(at([v, v], bernstein)) => {
                "you use one parameter twice: u runs along the rows, v along the columns"
            }
            () if near(at([u, v], |t| [1.0 - t, 0.0, 0.0, t])) => {
                "you use only the corners: the control points between them have weights, too"
            }
            () if near(at([u, v], |t| [(1.0 - t) * (1.0 - t), t * (1.0 - t), t * (1.0 - t), t * t])) => {
                "you interpolate twice along a curve: four points need three rounds, 4, 3, 2, 1"
            }
            () if near(at([u, v], without_factors)) => {
                "your weights do not add up to 1: their factors are 1, 3, 3 and 1"
            }
            () if near(at([u, v], interpolating)) => {
                "your surface passes through all control points: a Bézier patch passes only through its \
                 corners in general"
            }
            () => "",
        };
        match near(right) {
            true => Ok(()),
            false => {
                Err(Broken::new(describe(query), yours, right.as_vec3(), "Bernstein polynomials in double")
                    .looks_like(known(diagnosis)))
            }
        }
    })
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
