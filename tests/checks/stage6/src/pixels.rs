//! Where the samples of a pixel lie, and what colour they make.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use checks::paste::{Paste, call};
use checks::statistics::{SAMPLES, covers_evenly, pairs};
use glam::{DVec2, Vec2, Vec2Swizzles, Vec3, uvec2, vec2, vec3};
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

/// A cell in which all mistakes give different places.
const DRAWN: Stratum = Stratum { cell: uvec2(2, 1), grid: uvec2(4, 3), u: vec2(0.25, 0.625) };

pub(super) fn jittered_samples_stay_in_their_cells(trial: &Trial<'_>) -> Outcome {
    let judge = |queries: &[Stratum]| {
        compare(queries, trial.kit.jittered(queries), |query, yours| {
            let [cell, grid, u] = [query.cell.as_dvec2(), query.grid.as_dvec2(), query.u.as_dvec2()];
            let expected = (cell + u) / grid;
            // Two roundings of a number below 1.
            let near = |place: DVec2| (yours.as_dvec2() - place).abs().max_element() < 2e-7;
            if near(expected) && yours.max_element() < 1.0 {
                return Ok(());
            }
            let diagnosis = match () {
                () if near(expected) => {
                    "1 belongs to the next pixel: 3 + 0.99999994 is 4 when rounded, so stay below 1"
                }
                () if near(u) => "the place in the cell is not scaled to the grid",
                () if near(u / grid) => "every cell is the first one",
                () if near((cell + 0.5) / grid) || near(cell / grid) => {
                    "u is not used, and nothing is jittered"
                }
                () if near((cell + u) / grid.yx())
                    || near((cell + u) / grid.x)
                    || near((cell + u) / grid.y) =>
                {
                    "x goes by the columns of the grid, y by its rows"
                }
                () if near((cell + u.xx()) / grid) || near((cell + u.yy()) / grid) => {
                    "one random number for both axes"
                }
                () => "",
            };
            let input = call("jittered", &[query]);
            Err(Broken::new(input, yours, expected.as_vec2(), "(cell + u) / grid, below 1")
                .looks_like(known(diagnosis)))
        })
    };
    judge(&[DRAWN]).into_iter().collect::<Outcome>()?;
    trial.forall(2000, stratum(), judge)
}

pub(super) fn each_sampler_has_its_places(trial: &Trial<'_>) -> Outcome {
    let samplers = prop_oneof![
        Just(Sampler::Center),
        Just(Sampler::Random),
        Just(Sampler::Jittered),
        Just(Sampler::Gaussian),
        Just(Sampler::LowDiscrepancy)
    ];
    let judge = |queries: &[(Sampler, Stratum)]| {
        compare(queries, trial.kit.pixel_position(queries), |(sampler, stratum), yours| {
            let (u, radius) = (stratum.u.as_dvec2(), f64::from(FILTER_RADIUS));
            let jittered = (stratum.cell.as_dvec2() + u) / stratum.grid.as_dvec2();
            let expected = match sampler {
                Sampler::Center => DVec2::splat(0.5),
                Sampler::Random | Sampler::LowDiscrepancy => u,
                Sampler::Jittered => jittered,
                Sampler::Gaussian => 0.5 + radius * (2.0 * jittered - 1.0),
            };
            // A few roundings of numbers up to 3.
            let near = |place: DVec2| (yours.as_dvec2() - place).abs().max_element() < 1e-6;
            if near(expected) {
                return Ok(());
            }
            let diagnosis = match sampler {
                _ if near(expected - 0.5) => {
                    "seen from the centre of the pixel, and not from its upper left corner"
                }
                Sampler::Gaussian if near(jittered) => {
                    "only the pixel itself: the bell reaches FILTER_RADIUS from the centre on all sides"
                }
                Sampler::Gaussian if near(0.5 + radius * (jittered - 0.5)) => {
                    "half as wide: it reaches from -FILTER_RADIUS to FILTER_RADIUS, twice as far as FILTER_RADIUS"
                }
                Sampler::Gaussian if near(0.5 + radius * jittered) => {
                    "to the right and downwards only: the bell reaches FILTER_RADIUS on all sides"
                }
                Sampler::Jittered | Sampler::Gaussian if near(u) => {
                    "random: take jittered(stratum), which knows its cell"
                }
                Sampler::Random | Sampler::LowDiscrepancy if near(jittered) => {
                    "jittered, but u is all: low discrepancy numbers are spread already, random ones are not to be"
                }
                _ => "",
            };
            let input = format!("pixel_position(Sampler::{sampler:?}, {})", stratum.paste());
            Err(Broken::new(input, yours, expected.as_vec2(), "the definition").looks_like(known(diagnosis)))
        })
    };
    let drawn =
        [Sampler::Center, Sampler::Random, Sampler::LowDiscrepancy, Sampler::Jittered, Sampler::Gaussian];
    judge(&drawn.map(|sampler| (sampler, DRAWN))).into_iter().collect::<Outcome>()?;
    trial.forall(2000, (samplers, stratum()), judge)
}

/// The bell along one axis, in double precision.
fn bell(x: f64) -> f64 {
    let radius = f64::from(FILTER_RADIUS);
    ((-2.0 * x * x).exp() - (-2.0 * radius * radius).exp()).max(0.0)
}

pub(super) fn gaussian_weight_is_a_bell_that_ends(trial: &Trial<'_>) -> Outcome {
    let coordinate = (-16..=16i32).prop_map(|eighths| eighths as f32 / 8.0);
    let offsets = (coordinate.clone(), coordinate).prop_map(|(x, y)| vec2(x, y));
    let judge = |queries: &[Vec2]| {
        compare(queries, trial.kit.gaussian_weight(queries), |offset, yours| {
            let (x, y) = (f64::from(offset.x), f64::from(offset.y));
            let expected = bell(x) * bell(y);
            // The difference of two powers, each rounded: a few units in the last place of 1.
            let near = |weight: f64| (f64::from(yours) - weight).abs() < 1e-6;
            if near(expected) {
                return Ok(());
            }
            let outside = offset.abs().max_element() >= FILTER_RADIUS;
            let other = |power: fn(f64) -> f64| {
                let factor = |x: f64| (power(x).exp() - power(f64::from(FILTER_RADIUS)).exp()).max(0.0);
                factor(x) * factor(y)
            };
            let diagnosis = match () {
                () if near((-2.0 * (x * x + y * y)).exp()) => {
                    "cut off like this the bell ends in a step: take e^(-2R²) off along each axis"
                }
                () if near(bell(x.hypot(y))) => {
                    "a round bell: one along x times one along y ends in a square"
                }
                () if near(other(|x| -x * x)) => "too wide: e^(-2x²), not e^(-x²)",
                () if near(other(|x| -2.0 * x.abs())) => "x is not squared: e^(-2x²)",
                () if near(bell(x) + bell(y)) => "the sum of two bells: one times the other",
                () if near(bell(x)) => "y has no part in it: a bell along x times a bell along y",
                () if near(bell(y)) => "x has no part in it: a bell along x times a bell along y",
                // The area of e^(-2x²) is √(π / 2).
                () if near(expected * std::f64::consts::FRAC_2_PI)
                    || near(expected * std::f64::consts::FRAC_2_PI.sqrt()) =>
                {
                    "a factor on all weights: filter_pixel divides by their sum, so none is needed"
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
    };
    // A slanted offset first: in the middle and on the axes, several mistakes give one answer.
    judge(&[vec2(0.5, -0.25)]).into_iter().collect::<Outcome>()?;
    trial.forall(1000, offsets, judge)
}

fn paste_samples(samples: &[WeightedColor]) -> String {
    let one = |sample: &WeightedColor| {
        format!("WeightedColor {{ color: {}, weight: {} }}", sample.color.paste(), sample.weight.paste())
    };
    format!("filter_pixel(&[{}])", samples.iter().map(one).collect::<Vec<_>>().join(", "))
}

pub(super) fn filter_pixel_is_the_weighted_mean(trial: &Trial<'_>) -> Outcome {
    let share = || (0..=16i32).prop_map(|n| n as f32 / 8.0);
    let color = (share(), share(), share()).prop_map(|(r, g, b)| vec3(r, g, b));
    let sample = (color, share()).prop_map(|(color, weight)| WeightedColor { color, weight });
    let samples = prop::collection::vec(sample, 1..8);
    let judge = |queries: &[Vec<WeightedColor>]| {
        compare(queries, trial.kit.filter_pixel(queries), |samples, yours| {
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
                () if near(plain * n / weight) => "the colours are not weighted, only the divisor is",
                () if near(expected.min(glam::DVec3::ONE)) => {
                    "what is brighter than 1 is cut off: leave that to the film"
                }
                () => "",
            };
            Err(Broken::new(paste_samples(samples), yours, expected.as_vec3(), "double precision")
                .looks_like(known(diagnosis)))
        })
    };
    // Two unlike samples first: of one alone, or of alike ones, several mistakes make one colour.
    let drawn = [(vec3(0.25, 0.5, 2.5), 0.5), (vec3(1.0, 0.0, 2.25), 1.75)];
    judge(&[drawn.map(|(color, weight)| WeightedColor { color, weight }).to_vec()])
        .into_iter()
        .collect::<Outcome>()?;
    trial.forall(1000, samples, judge)
}

pub(super) fn filter_pixel_of_nothing_is_black(trial: &Trial<'_>) -> Outcome {
    let nothing = [vec![], vec![WeightedColor { color: Vec3::ONE, weight: 0.0 }; 3]];
    for (samples, yours) in nothing.iter().zip(trial.kit.filter_pixel(&nothing)) {
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
    let in_cells: Vec<(f64, f64)> =
        places.iter().map(|(x, y)| ((4.0 * x).fract(), (4.0 * y).fract())).collect();
    covers_evenly("jittered in 4 × 4 cells", &in_cells, ["x in its cell", "y in its cell"], |_| "")?;
    covers_evenly("jittered in 4 × 4 cells", &places, ["x", "y"], |_| "")?;
    // One sample a cell, whatever the numbers: that is what jittering is for. Two roundings of a number below 1 may carry a
    // sample onto the side of its cell that is the next one's.
    for (stratum, &(x, y)) in strata.iter().zip(&places) {
        let (place, corner) = (4.0 * DVec2::new(x, y), stratum.cell.as_dvec2());
        let slack = 4.0 * 2e-7;
        if place.cmplt(corner - slack).any() || place.cmpgt(corner + 1.0 + slack).any() {
            let cell = place.as_uvec2();
            let input = call("jittered", &[stratum]);
            return Err(Broken::new(input, cell, stratum.cell, "the cell it was asked for"));
        }
    }
    Ok(())
}
