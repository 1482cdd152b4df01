//! The table of stage 11: the light that paths find in closed rooms.

use checks::golden::{Table, digits};
use checks::prelude::*;

/// The numbers of bounces of the columns.
const BOUNCES: [u32; 6] = [0, 1, 2, 4, 8, 16];
/// The errors of the last columns.
const ERRORS: [f32; 3] = [0.2, 0.02, 0.002];

fn lines(kit: &dyn Kit, albedos: &[f32; 8]) -> String {
    let line = |albedo: &f32| {
        let missing = kit.cut_off(&BOUNCES.map(|bounces| (*albedo, bounces)));
        let enough = kit.bounces_for_error(&ERRORS.map(|error| (*albedo, error)));
        let missing: Vec<String> = missing.iter().map(|share| digits(*share, 4)).collect();
        let enough: Vec<String> = enough.iter().map(u32::to_string).collect();
        // The density of a direction whose cosine is the albedo.
        let direction = Vec3::new((1.0 - albedo * albedo).max(0.0).sqrt(), 0.0, *albedo);
        let pdf = kit.cosine_pdf(&[(Vec3::Z, direction)])[0];
        format!(
            "albedo {}  missing {}  enough {}  pdf {}",
            digits(*albedo, 4),
            missing.join(" "),
            enough.join(" "),
            digits(pdf, 4)
        )
    };
    albedos.iter().map(line).collect::<Vec<_>>().join("\n")
}

pub(super) fn table_of_closed_rooms(trial: &Trial<'_>) -> CheckResult {
    let public = [0.0, 0.1, 0.25, 0.5, 0.7, 0.8, 0.9, 1.0];
    let hidden = prop::array::uniform8((1..200i32).prop_map(|n| n as f32 / 201.0));
    let albedos = trial.composed(public, hidden);
    let input = "closed rooms of eight albedos";
    Table { name: "stage11_closed_rooms", input }.check(trial, |kit| lines(kit, &albedos))
}
