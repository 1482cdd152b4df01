//! Where the samples of a pixel lie, and what colour they make.

use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::judge::{compare, known};
use crate::paste::{Paste, call};
use crate::statistics::{SAMPLES, covers_evenly, pairs};
use glam::{UVec2, Vec2, Vec3, uvec2, vec2, vec3};
use proptest::prelude::*;
use raykata::kit::{FILTER_RADIUS, WeightedColor};
use raykata::random::Stratum;
use raykata::scene::Sampler;

/// The largest random number there is.
pub(super) const LARGEST: f32 = 1.0 - f32::EPSILON / 2.0;

/// A number on a grid of 1/64, which is short to print, or the largest there is.
pub(super) fn unit_number() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![8 => (0..64i32).prop_map(|n| n as f32 / 64.0), 1 => Just(LARGEST)]
}

fn stratum() -> impl Strategy<Value = Stratum> + Clone {
    let grid = (1..=16u32, 1..=16u32);
    let shares = (0.0..1.0f32, 0.0..1.0f32);
    (grid, shares, unit_number(), unit_number()).prop_map(|((columns, rows), (x, y), u, v)| Stratum {
        cell: uvec2((x * columns as f32) as u32, (y * rows as f32) as u32).min(uvec2(columns - 1, rows - 1)),
        grid: uvec2(columns, rows),
        u: vec2(u, v),
    })
}

impl Paste for Stratum {
    fn paste(&self) -> String {
        let whole = |v: UVec2| format!("uvec2({}, {})", v.x, v.y);
        format!(
            "&Stratum {{ cell: {}, grid: {}, u: {} }}",
            whole(self.cell),
            whole(self.grid),
            self.u.paste()
        )
    }
}

pub(super) fn jittered_samples_stay_in_their_cells(trial: &Trial<'_>) -> Outcome {
    trial.forall(2000, stratum(), |queries| {
        compare(queries, trial.kit.jittered(queries), |query, yours| {
            let expected = (query.cell.as_dvec2() + query.u.as_dvec2()) / query.grid.as_dvec2();
            // Two roundings of a number below 1.
            let near = (yours.as_dvec2() - expected).abs().max_element() < 2e-7;
            if near && yours.max_element() < 1.0 {
                return Ok(());
            }
            let diagnosis = match () {
                () if near => {
                    "1 belongs to the next pixel: 3 + 0.99999994 is 4 when rounded, so stay below 1"
                }
                () if (yours - query.u).length() < 1e-6 => "the place in the cell is not scaled to the grid",
                () if (yours - query.u / query.grid.as_vec2()).length() < 1e-6 => {
                    "every cell is the first one"
                }
                () if (yours.as_dvec2() - (query.cell.as_dvec2() + 0.5) / query.grid.as_dvec2()).length()
                    < 1e-6 =>
                {
                    "the middle of the cell: u is not used, and nothing is jittered"
                }
                () => "",
            };
            let input = call("jittered", &[query]);
            Err(Broken::new(input, yours, expected.as_vec2(), "(cell + u) / grid, below 1")
                .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn each_sampler_has_its_places(trial: &Trial<'_>) -> Outcome {
    let samplers = prop_oneof![
        Just(Sampler::Center),
        Just(Sampler::Random),
        Just(Sampler::Jittered),
        Just(Sampler::Gaussian),
        Just(Sampler::LowDiscrepancy)
    ];
    trial.forall(2000, (samplers, stratum()), |queries| {
        compare(queries, trial.kit.pixel_position(queries), |(sampler, stratum), yours| {
            let jittered = (stratum.cell.as_dvec2() + stratum.u.as_dvec2()) / stratum.grid.as_dvec2();
            let expected = match sampler {
                Sampler::Center => glam::DVec2::splat(0.5),
                Sampler::Random | Sampler::LowDiscrepancy => stratum.u.as_dvec2(),
                Sampler::Jittered => jittered,
                Sampler::Gaussian => 0.5 + f64::from(FILTER_RADIUS) * (2.0 * jittered - 1.0),
            };
            // A few roundings of numbers up to 3.
            if (yours.as_dvec2() - expected).abs().max_element() < 1e-6 {
                return Ok(());
            }
            let diagnosis = match sampler {
                Sampler::Gaussian if (yours.as_dvec2() - jittered).length() < 1e-5 => {
                    "only the pixel itself: the bell reaches FILTER_RADIUS from the centre on all sides"
                }
                _ if (yours + 0.5 - expected.as_vec2()).length() < 1e-5 => {
                    "seen from the centre of the pixel, and not from its upper left corner"
                }
                _ => "",
            };
            let input = format!("pixel_position(Sampler::{sampler:?}, {})", stratum.paste());
            Err(Broken::new(input, yours, expected.as_vec2(), "the definition").looks_like(known(diagnosis)))
        })
    })
}

/// The bell along one axis, in double precision.
fn bell(x: f64) -> f64 {
    let radius = f64::from(FILTER_RADIUS);
    ((-2.0 * x * x).exp() - (-2.0 * radius * radius).exp()).max(0.0)
}

pub(super) fn gaussian_weight_is_a_bell_that_ends(trial: &Trial<'_>) -> Outcome {
    let coordinate = (-16..=16i32).prop_map(|eighths| eighths as f32 / 8.0);
    let offsets = (coordinate.clone(), coordinate).prop_map(|(x, y)| vec2(x, y));
    trial.forall(1000, offsets, |queries| {
        compare(queries, trial.kit.gaussian_weight(queries), |offset, yours| {
            let (x, y) = (f64::from(offset.x), f64::from(offset.y));
            let expected = bell(x) * bell(y);
            // The difference of two powers, each rounded: a few units in the last place of 1.
            if (f64::from(yours) - expected).abs() < 1e-6 {
                return Ok(());
            }
            let outside = offset.abs().max_element() >= FILTER_RADIUS;
            let diagnosis = match () {
                () if (f64::from(yours) - (-2.0 * (x * x + y * y)).exp()).abs() < 1e-6 => {
                    "cut off like this the bell ends in a step: take e^(-2R²) off along each axis"
                }
                () if outside && yours > 0.0 => {
                    "two factors below 0 make a weight above 0: each is 0 from FILTER_RADIUS on"
                }
                () if outside && yours < 0.0 => "a weight below 0: each factor is 0 from FILTER_RADIUS on",
                () => "",
            };
            let input = call("gaussian_weight", &[offset]);
            Err(Broken::new(input, yours, expected, "double precision").looks_like(known(diagnosis)))
        })
    })
}

fn paste_samples(samples: &[WeightedColor]) -> String {
    let one = |sample: &WeightedColor| {
        format!("WeightedColor {{ color: {}, weight: {} }}", sample.color.paste(), sample.weight.paste())
    };
    format!("develop(&[{}])", samples.iter().map(one).collect::<Vec<_>>().join(", "))
}

pub(super) fn develop_is_the_weighted_mean(trial: &Trial<'_>) -> Outcome {
    let share = || (0..=16i32).prop_map(|n| n as f32 / 8.0);
    let color = (share(), share(), share()).prop_map(|(r, g, b)| vec3(r, g, b));
    let sample = (color, share()).prop_map(|(color, weight)| WeightedColor { color, weight });
    let samples = prop::collection::vec(sample, 1..8);
    trial.forall(1000, samples, |queries| {
        compare(queries, trial.kit.develop(queries), |samples, yours| {
            let weight: f64 = samples.iter().map(|sample| f64::from(sample.weight)).sum();
            let sum: glam::DVec3 =
                samples.iter().map(|sample| f64::from(sample.weight) * sample.color.as_dvec3()).sum();
            let expected = if weight > 0.0 { sum / weight } else { glam::DVec3::ZERO };
            // Eight additions and a division of numbers up to 16.
            if (yours.as_dvec3() - expected).abs().max_element() < 1e-5 {
                return Ok(());
            }
            let n = samples.len() as f64;
            let plain: glam::DVec3 =
                samples.iter().map(|sample| sample.color.as_dvec3()).sum::<glam::DVec3>() / n;
            let near = |v: glam::DVec3| (yours.as_dvec3() - v).length() < 1e-5;
            let diagnosis = match () {
                () if yours.is_nan() => "0 / 0: without any weight the pixel is black",
                () if near(plain) => "all samples count alike: use the weights",
                () if near(sum / n) => "divided by the number of samples: divide by the sum of their weights",
                () if near(sum) => "a sum: divide by the sum of the weights",
                () => "",
            };
            Err(Broken::new(paste_samples(samples), yours, expected.as_vec3(), "double precision")
                .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn develop_of_nothing_is_black(trial: &Trial<'_>) -> Outcome {
    let nothing = [vec![], vec![WeightedColor { color: Vec3::ONE, weight: 0.0 }; 3]];
    for (samples, yours) in nothing.iter().zip(trial.kit.develop(&nothing)) {
        if yours != Vec3::ZERO {
            let broken = Broken::new(paste_samples(samples), yours, Vec3::ZERO, "the definition");
            return Err(broken.looks_like(yours.is_nan().then_some("0 / 0: nothing weighs anything here")));
        }
    }
    Ok(())
}

pub(super) fn jittered_samples_cover_the_pixel_evenly(trial: &Trial<'_>) -> Outcome {
    // Sixteen cells in turn, each with random numbers of its own.
    let strata: Vec<Stratum> = pairs(trial.seed, SAMPLES)
        .into_iter()
        .enumerate()
        .map(|(index, u)| {
            let cell = index as u32 % 16;
            Stratum { cell: uvec2(cell % 4, cell / 4), grid: uvec2(4, 4), u }
        })
        .collect();
    let places: Vec<(f64, f64)> =
        trial.kit.jittered(&strata).iter().map(|p| (f64::from(p.x), f64::from(p.y))).collect();
    covers_evenly("jittered in each of 4 × 4 cells", &places, ["x", "y"], |_| "")?;
    // One sample a cell, whatever the numbers: that is what jittering is for.
    for (stratum, place) in strata.iter().zip(&places) {
        let cell = (Vec2::new(place.0 as f32, place.1 as f32) * 4.0).as_uvec2();
        if cell != stratum.cell {
            let input = call("jittered", &[stratum]);
            return Err(Broken::new(input, cell, stratum.cell, "the cell it was asked for"));
        }
    }
    Ok(())
}
