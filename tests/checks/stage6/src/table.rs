//! The table of stage 6: the samples of one pixel.

use checks::golden::{Table, digits};
use checks::prelude::*;
use checks::statistics;
use glam::uvec2;
use raykata::camera::Shutter;
use raykata::random::Stratum;
use raykata::scene::Sampler;

/// The random numbers of the samples, and the way of a point while the shutter is open.
type Inputs = (u64, Shutter, Vec3, Vec3);

fn lines(kit: &dyn Kit, (seed, shutter, start, end): &Inputs) -> String {
    let numbers = statistics::pairs(*seed, 16);
    let stratum = |index: u32| Stratum {
        cell: uvec2(index % 4, index / 4),
        grid: uvec2(4, 4),
        u: numbers[index as usize],
    };
    let strata: Vec<Stratum> = (0..16).map(stratum).collect();
    let at = |sampler: Sampler| {
        kit.pixel_position(&strata.iter().map(|stratum| (sampler, *stratum)).collect::<Vec<_>>())
    };
    let (jittered, gaussian) = (at(Sampler::Jittered), at(Sampler::Gaussian));
    let offsets: Vec<Vec2> = gaussian.iter().map(|at| *at - 0.5).collect();
    let weights = kit.gaussian_weight(&offsets);
    let slots = kit.temporal_slot(&strata.iter().map(|s| (s.cell.x, s.cell.y)).collect::<Vec<_>>());
    let queries = slots.iter().zip(&numbers);
    let queries: Vec<TimeQuery> =
        queries.map(|(&slot, u)| TimeQuery { shutter: *shutter, slot, slots: 16, u: u.y }).collect();
    let times = kit.time_in_shutter(&queries);
    let places = kit.lerp(&times.iter().map(|&time| (*start, *end, time)).collect::<Vec<_>>());
    let vector = |v: &[f32]| v.iter().map(|x| digits(*x, 3)).collect::<Vec<_>>().join(" ");
    let mut lines: Vec<String> = (0..16)
        .map(|i| {
            format!(
                "cell {} {}  jittered {}  gaussian {} gaussian_weight {}  temporal_slot {} time_in_shutter {}  \
                 lerp {}",
                i % 4,
                i / 4,
                vector(&jittered[i].to_array()),
                vector(&gaussian[i].to_array()),
                digits(weights[i], 3),
                slots[i],
                digits(times[i], 3),
                vector(&places[i].to_array()),
            )
        })
        .collect();
    // The colour of a pixel whose samples show the places.
    let weighted = places.iter().zip(&weights);
    let samples: Vec<WeightedColor> =
        weighted.map(|(place, weight)| WeightedColor { color: place.abs(), weight: *weight }).collect();
    let pixel = kit.filter_pixel(&[samples]).remove(0);
    lines.push(format!("filter_pixel {}", vector(&pixel.to_array())));
    lines.join("\n")
}

pub(super) fn table_of_the_samples_of_a_pixel(trial: &Trial<'_>) -> CheckResult {
    let public = (1, Shutter { open: 0.25, close: 0.75 }, vec3(0.1, 0.9, -0.4), vec3(1.3, -0.2, 0.6));
    let point = || (-2.0..2f32, -2.0..2f32, -2.0..2f32).prop_map(Vec3::from);
    let hidden = (any::<u64>(), 0.0..0.4f32, 0.6..1f32, point(), point())
        .prop_map(|(seed, open, close, start, end)| (seed, Shutter { open, close }, start, end));
    let inputs = trial.composed(public, hidden);
    let input = "the 16 samples of a pixel";
    Table { name: "stage6_samples_of_a_pixel", input }.check(trial, |kit| lines(kit, &inputs))
}
