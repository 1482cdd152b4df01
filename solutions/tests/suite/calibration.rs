//! Calibrates the statistical checks of stages 6 and 11. Each check runs with many seeds on the reference, which it
//! may reject once in 10 million tests, and on wrong distributions, each of which it must reject with 99 % of
//! the seeds.
//!
//! It uses 2 seeds by default and 1,000 with `CI_LONG=1`. To print the table: `CI_LONG=1 cargo test --release
//! -p solutions --test suite -- calibration --nocapture`; with `--release` it takes about a quarter of the time.

mod wrong;

use checks::statistics::FALSE_ALARMS;
use checks::{Check, Trial};
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, Request, Transport};
use std::thread;
use wrong::WRONG;

/// The number of seeds.
fn seeds() -> u64 {
    if std::env::var_os("CI_LONG").is_some() { 1000 } else { 2 }
}

/// The percentage of seeds with which a wrong distribution must be rejected.
const CAUGHT: u64 = 99;

/// The statistical checks, and how many tests each makes.
const STATISTICAL: [(&str, u32); 23] = [
    ("jittered_samples_cover_the_pixel_evenly", 1),
    ("places_on_the_disk_are_even", 1),
    ("places_on_a_rectangle_are_even", 1),
    ("places_on_a_round_light_are_even", 1),
    ("directions_to_a_sphere_are_even", 1),
    ("a_far_sphere_is_still_a_sphere", 2),
    ("from_inside_a_sphere_it_is_everywhere", 1),
    ("half_a_sphere_makes_half_a_shadow", 4),
    ("phong_lobe_falls_with_the_power_of_the_cosine", 3),
    ("slightly_rough_is_not_a_few_angles", 1),
    ("times_are_even", 1),
    ("cosine_directions_have_their_density", 1),
    ("light_samples_have_their_density", 4),
    ("polygon_lights_give_lamberts_irradiance", 4),
    ("sphere_lights_give_their_irradiance", 2),
    ("paths_in_an_integrating_sphere_find_its_light", 1),
    ("diffuse_samples_use_fresh_numbers", 3),
    ("paths_in_a_furnace_find_all_light", 2),
    ("paths_in_a_corner_find_its_sky", 4),
    ("steps_in_an_integrating_sphere_find_its_light", 1),
    ("steps_count_sampled_light_once", 2),
    ("steps_find_light_in_a_mirror", 2),
    ("steps_in_an_empty_cornell_box_agree_with_radiosity", 2),
];

/// The reference, except for the answers of one function.
struct Twisted(fn(&Request) -> Option<Answer>);

impl Transport for Twisted {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        (self.0)(&request).unwrap_or_else(|| request.answer(&*solutions::kit(), watch))
    }
}

fn check(name: &str) -> &'static Check {
    let mut checks = stage6_checks::CHECKS.iter().chain(stage11_checks::CHECKS);
    checks.find(|check| check.name == name).expect("a check of stage 6 or 11")
}

/// The seeds with which `check` rejects `kit`.
fn rejections(check: &'static Check, kit: &(dyn Kit + Sync)) -> usize {
    let half = |seeds: std::ops::Range<u64>| {
        seeds.filter(|&seed| (check.law)(&Trial::new(kit, check.name, seed)).is_err()).count()
    };
    thread::scope(|scope| {
        let first = scope.spawn(move || half(0..seeds() / 2));
        half(seeds() / 2..seeds()) + first.join().expect("checks do not panic on answers")
    })
}

/// The highest probability that any test rejects a correct submission: one in 100,000.
const UNFAIR: f64 = 1e-5;

#[test]
fn the_reference_is_rejected_as_rarely_as_stated() {
    let laws: u32 = STATISTICAL.iter().map(|(_, laws)| laws).sum();
    assert!(f64::from(laws) * FALSE_ALARMS < UNFAIR, "{laws} tests");
    let (mut tests, mut alarms) = (0, 0);
    for (name, laws) in STATISTICAL {
        let rejected = rejections(check(name), &*solutions::kit());
        println!("{rejected:>4} of {} seeds rejected, {laws} tests each: {name}", seeds());
        tests += seeds() * u64::from(laws);
        alarms += rejected;
    }
    let expected = tests as f64 * FALSE_ALARMS;
    println!("{alarms} false alarms in {tests} tests; stated: {expected:.1}");
    // A Poisson number exceeds its mean by four standard deviations once in some thousand times.
    assert!((alarms as f64) <= expected + 4.0 * expected.sqrt(), "{alarms} false alarms, stated {expected}");
}

/// The parts of the unit square in which deviations are stated: the columns of the table. 1 is a mean.
const PARTS: [f64; 6] = [0.125, 1.0 / 32.0, 1.0 / 64.0, 1.0 / 512.0, 1.0 / 4096.0, 1.0];

#[test]
fn the_smallest_deviations_that_are_found_stand_in_the_table() {
    let mut table = String::new();
    for (name, _) in STATISTICAL {
        let power = checks::statistics::power_of(|| {
            assert!((check(name).law)(&Trial::new(&*solutions::kit(), name, 0)).is_ok(), "{name}");
        });
        let cells = PARTS.map(|part| {
            let of_part = power.iter().filter(|(other, _)| (other - part).abs() < 1e-9);
            let most = of_part.map(|(_, deviation)| 100.0 * deviation).fold(0.0, f64::max);
            if most == 0.0 { "–".to_owned() } else { format!("{most:.2}") }
        });
        table += &format!("| `{name}` | {} |\n", cells.join(" | "));
    }
    let documented = include_str!("../../../CONTRIBUTING.md");
    assert!(documented.contains(&table), "the table in CONTRIBUTING.md must have these rows:\n{table}");
}

#[test]
fn wrong_distributions_are_caught() {
    let mut missed = Vec::new();
    for &(what, name, answers) in WRONG {
        let caught = rejections(check(name), &Door(Twisted(answers)));
        println!("{caught:>4} of {} seeds catch it: {what} ({name})", seeds());
        if (caught as u64) * 100 < CAUGHT * seeds() {
            missed.push(what);
        }
    }
    assert!(missed.is_empty(), "caught with less than {CAUGHT} % of the seeds: {missed:?}");
}
