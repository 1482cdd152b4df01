//! Checks of `placement`.

use crate::spaces::{determinant, transform};
use checks::prelude::*;
use glam::{Affine3A, DAffine3, DMat3, Mat3};
use raykata::graph::Placement;

pub(super) fn placement_multiplies_in_the_right_order(trial: &Trial<'_>) -> CheckResult {
    let paths = prop::collection::vec(transform(-8..=8), 1..5);
    trial.each_and(&[Vec::new()], 1000, paths, <dyn Kit>::placement, judge_placement)
}

/// Whether a matrix and a translation are those of `right`, each compared with its own largest entry. The tolerance is a
/// fraction of this entry.
fn is_transform(yours: &Affine3A, right: &DAffine3, tolerance: f64) -> bool {
    let (yours, right) = (yours.as_daffine3().to_cols_array(), right.to_cols_array());
    let near = |entries: std::ops::Range<usize>, least: f64| {
        let size = right[entries.clone()].iter().fold(least, |largest, entry| largest.max(entry.abs()));
        entries.into_iter().all(|i| (yours[i] - right[i]).abs() <= tolerance * size)
    };
    // A translation is a sum of products of the matrices with others, which may cancel.
    let matrix_size = right[..9].iter().fold(0.0f64, |largest, entry| largest.max(entry.abs()));
    near(0..9, 0.0) && near(9..12, 4.0 * matrix_size)
}

const OWN_ONLY: &str = "you use the node's own transform only: multiply all transforms of the path";
const ROOT_ONLY: &str = "you use the root's transform only: multiply all transforms of the path";
const FROM_THE_NODE: &str =
    "you multiply from the node up to the root: the root's transform is the first factor";

fn judge_placement(path: &Vec<Affine3A>, yours: Option<Placement>) -> Judged {
    let product =
        |path: &mut dyn Iterator<Item = DAffine3>| path.fold(DAffine3::IDENTITY, |all, one| all * one);
    let all = || path.iter().map(Affine3A::as_daffine3);
    let exact = product(&mut all());
    let input = || format!("placement(&{})", list(path));
    let Some(yours) = yours else {
        let broken = Broken::with_texts(input(), "None", "Some", "each transform has an inverse");
        return Err(broken.explained_by([
            (path.is_empty(), "you return None for an empty path: it is the identity"),
            "you return None, but no determinant is 0: a negative one belongs to a reflection"
                .when(path.iter().any(|one| determinant(one) < 0.0)),
        ]));
    };
    // A few rounding errors, which an inverse of the product multiplies by its condition number.
    let size = |matrix: DMat3| matrix.to_cols_array().iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    let condition: f64 = all().map(|one| size(one.matrix3) * size(one.matrix3.inverse())).product();
    let tolerance = (32.0 * U * condition).clamp(1e-4, 0.05);
    let near = |yours: &Affine3A, right: &DAffine3| is_transform(yours, right, tolerance);
    let (up, down) = (near(&yours.to_world, &exact), near(&yours.to_object, &exact.inverse()));
    let turned = product(&mut all().rev());
    let transposed = (yours.to_object.as_daffine3().matrix3 - exact.matrix3.transpose())
        .to_cols_array()
        .iter()
        .all(|off| off.abs() <= 1e-5 * size(exact.matrix3));
    let added = DAffine3 { translation: all().map(|one| one.translation).sum(), ..exact };
    let ends = product(&mut all().take(1).chain(all().skip(1).last()));
    let own = all().next_back().unwrap_or(DAffine3::IDENTITY);
    let root = all().next().unwrap_or(DAffine3::IDENTITY);
    let is = |world: &DAffine3, object: &DAffine3| {
        near(&yours.to_world, world) && near(&yours.to_object, &object.inverse())
    };
    let (got, right) = if up { (yours.to_object, exact.inverse()) } else { (yours.to_world, exact) };
    let which = if up { "to_object" } else { "to_world" };
    let describe = |transform: DAffine3| format!("{which} {:.3?}", transform.to_cols_array());
    unless(up && down, || {
        let [yours, expected] = [got.as_daffine3(), right].map(describe);
        Broken::with_texts(input(), yours, expected, "double precision")
    })
    .formulas([
        (up && near(&yours.to_object, &exact), "you return to_world as to_object, without the inverse"),
        (up && transposed, "you take the transpose for the inverse: this is right for rotations only"),
        // Each of these in to_world alone, or in both matrices.
        (is(&own, &exact), OWN_ONLY),
        (is(&own, &own), OWN_ONLY),
        (is(&root, &exact), ROOT_ONLY),
        (is(&root, &root), ROOT_ONLY),
        "you add the translations: each is turned and scaled by the transforms before it"
            .when(is(&added, &added) || is(&added, &exact)),
        (is(&ends, &ends), "you use the first and the last transform of the path only: multiply all of them"),
        (is(&turned, &exact), FROM_THE_NODE),
        (is(&turned, &turned), FROM_THE_NODE),
        "you multiply the inverses in the order of the transforms: the order must be reversed"
            .when(up && near(&yours.to_object, &turned.inverse())),
        "you exchange to_world and to_object"
            .when(near(&yours.to_world, &exact.inverse()) && near(&yours.to_object, &exact)),
    ])
}

/// Transforms without an inverse: two columns are equal, a column is 0, or a number is NaN or infinite. The determinant of
/// the first two is exactly 0 by any formula.
fn singular(kinds: std::ops::Range<i32>) -> impl Strategy<Value = Affine3A> + Clone {
    (transform(0..=0), kinds, 0..3usize).prop_map(|(transform, kind, axis)| {
        let mut columns = [0, 1, 2].map(|column| Vec3::from(transform.matrix3.col(column)));
        let mut translation = Vec3::from(transform.translation);
        match kind {
            0 => columns[axis] = Vec3::ZERO,
            1 => columns[axis] = columns[(axis + 1) % 3],
            2 => columns[axis][axis] = f32::NAN,
            _ => translation[axis] = f32::INFINITY,
        }
        Affine3A::from_mat3_translation(
            Mat3::from_cols_array_2d(&columns.map(|column| column.to_array())),
            translation,
        )
    })
}

pub(super) fn placement_refuses_what_cannot_be_undone(trial: &Trial<'_>) -> CheckResult {
    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let line = Affine3A::from_mat3(Mat3::from_cols(Vec3::ONE, Vec3::ONE, 2.0 * Vec3::ONE));
    let turn = Affine3A::from_rotation_y(0.5);
    // Scales by very small and very large numbers have inverses.
    let small =
        vec![Affine3A::from_scale(Vec3::splat(1e-4)), Affine3A::from_scale(Vec3::new(1e-3, 1e3, -1.0))];
    let chosen = [vec![flat], vec![turn, line], vec![flat, turn, turn], small];
    // Half of the paths have a transform without an inverse. The determinants of the others go down to 2⁻⁹⁰, which single
    // precision does not round to 0.
    let paths = |singular| {
        (prop::collection::vec(transform(-30..=30), 1..4), singular, 0..6usize).prop_map(
            |(mut path, singular, place)| {
                if place < 3 {
                    path.insert(place.min(path.len()), singular);
                }
                path
            },
        )
    };
    trial.each_and(&chosen, 400, paths(singular(0..2)), <dyn Kit>::placement, judge_refusal)?;
    trial.each(100, paths(singular(2..4)), <dyn Kit>::placement, judge_refusal)
}

fn judge_refusal(path: &Vec<Affine3A>, yours: Option<Placement>) -> CheckResult {
    let is_finite = |one: &&Affine3A| one.is_finite();
    let has_inverse = path.iter().all(|one| one.is_finite() && determinant(one) != 0.0);
    let input = format!("placement(&{})", list(path));
    let flat = path.iter().filter(is_finite).any(|one| determinant(one) == 0.0);
    match (yours, has_inverse) {
        (Some(_), false) => Err(Broken::with_texts(input, "Some", "None", "a transform has no inverse").explained_by(named![
            flat => "you accept a path with a singular transform: if one factor has no inverse, the product has none",
            !flat => "you accept a transform with NaN or infinite numbers: its inverse is not finite",
            true => "you accept a path with a transform that has no inverse: if one has none, the product has none",
        ])),
        (None, true) => {
            let small = path.iter().any(|one| determinant(one).abs() < 1e-2);
            let signed = path.iter().any(|one| determinant(one) < 1e-2);
            let negative = path.iter().any(|one| determinant(one) < 0.0);
            Err(Broken::with_texts(input, "None", "Some", "the definition").explained_by([
                (negative, "you refuse a negative determinant: it belongs to a reflection"),
                (small, "you refuse a small determinant: do not compare the determinant with a fixed limit, because it is small \
                         when the object is small"),
                (signed, "you refuse determinants below a limit, also negative ones: do not compare the determinant with a fixed limit"),
            ]))
        }
        _ => Ok(()),
    }
}
