//! Compares the exact oracle with big integers on many cases, and measures its speed.
//!
//! `cargo run --release -p oracle --example oracle -- --cases 1000000 --seed 1` compares, for every case, all
//! tiers of the oracle with the plain implementation in `reference/`: verdict, rounding of `t`, and the order
//! of two hits of triangles. With `--every K` only every K-th case is compared with big integers, and the
//! tiers are compared with each other on all cases. A disagreement prints its seed and case and ends with 1.
//! `--bench` measures checks per second instead.

mod cases;
mod reference;

use cases::ComparedCase;
use oracle::exact::{Body, Contact, Tier, aabb, meet, meet_with, order, triangle, verdict};
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let (mut n_cases, mut seed, mut every, mut bench) = (1_000_000, 1, 1, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|text| text.parse().ok());
        let target = match argument.as_str() {
            "--cases" => &mut n_cases,
            "--seed" => &mut seed,
            "--every" => &mut every,
            "--bench" => {
                bench = true;
                continue;
            }
            other => return usage(other),
        };
        match number() {
            Some(value) if value > 0 => *target = value,
            _ => return usage(&argument),
        }
    }
    if bench {
        measure(seed);
        return ExitCode::SUCCESS;
    }
    long_run(n_cases, seed, every)
}

fn usage(argument: &str) -> ExitCode {
    eprintln!("{argument}? oracle [--cases N] [--seed S] [--every K] [--bench]");
    ExitCode::from(2)
}

/// The number of comparisons, by kind.
#[derive(Default)]
struct Tally {
    answers: u64,
    big: u64,
    undecided: u64,
    verdicts: [u64; 3],
}

fn long_run(n_cases: u64, seed: u64, every: u64) -> ExitCode {
    println!(
        "seed {seed}, 8 questions per case: tiers on every case (the widest forced in one of \
         {WIDEST_EVERY}), big integers in one case of {every}."
    );
    let start = Instant::now();
    let mut tally = Tally::default();
    for case in 0..n_cases {
        let inputs = cases::any(seed, case);
        if let Err(what) =
            compare(&inputs, case.is_multiple_of(every), case.is_multiple_of(WIDEST_EVERY), &mut tally)
        {
            println!("\nDISAGREEMENT, seed {seed}, case {case}: {what}\n{inputs:#?}");
            return ExitCode::FAILURE;
        }
        if (case + 1) % (1 << 16) == 0 || case + 1 == n_cases {
            let seconds = start.elapsed().as_secs_f64();
            let rate = (case + 1) as f64 / seconds;
            print!("\r{}/{n_cases} cases, {rate:.0} per second, no disagreement ", case + 1);
            let _ = std::io::Write::flush(&mut std::io::stdout());
        }
    }
    let Tally { answers, big, undecided, verdicts: [missed, touched, hit] } = tally;
    println!("\n{answers} answers of tiers ({undecided} undecided), {big} of them checked by big integers");
    println!("verdicts: {hit} in, {touched} on, {missed} out; no disagreement");
    ExitCode::SUCCESS
}

/// The widest integers are forced in some cases only, because they are slow; answers that need them use them anyway.
const WIDEST_EVERY: u64 = 16;

fn tiers(with_widest: bool) -> impl Iterator<Item = Tier> {
    Tier::ALL.into_iter().filter(move |&tier| with_widest || tier != Tier::Widest)
}

/// A shape, and the function that answers for it with big integers.
type TestedBody = (Body, fn(&ComparedCase) -> reference::Answer);

fn compare(case: &ComparedCase, with_big: bool, with_widest: bool, tally: &mut Tally) -> Result<(), String> {
    let ray = &case.ray;
    let bodies: [TestedBody; 7] = [
        (Body::Triangle(case.triangle), |c| reference::triangle(&c.ray, &c.triangle)),
        (Body::Plane(case.plane), |c| reference::plane(&c.ray, &c.plane)),
        (Body::Disk(case.disk), |c| reference::disk(&c.ray, &c.disk)),
        (Body::Sphere(case.sphere), |c| reference::sphere(&c.ray, &c.sphere)),
        (Body::Cuboid(case.cuboid), |c| reference::cuboid(&c.ray, &c.cuboid)),
        (Body::Cylinder(case.cylinder), |c| reference::cylinder(&c.ray, &c.cylinder)),
        (Body::Cone(case.cone), |c| reference::cone(&c.ray, &c.cone)),
    ];
    for (body, slow) in bodies {
        let truth = meet_with(Tier::Auto, ray, body).ok_or(format!("no answer for {body:?}"))?;
        let words = [Contact::Out, Contact::On, Contact::In];
        let place = words.iter().position(|&word| word == truth.verdict).unwrap_or(0);
        tally.verdicts[place] += 1;
        for tier in tiers(with_widest) {
            tally.answers += 1;
            match meet_with(tier, ray, body) {
                None if matches!(tier, Tier::Auto | Tier::Widest) => {
                    return Err(format!("{tier:?} does not answer for {body:?}"));
                }
                None => tally.undecided += 1,
                Some(answer) if answer != truth => {
                    return Err(format!("{tier:?} says {answer:?}, not {truth:?} for {body:?}"));
                }
                Some(_) => {}
            }
        }
        if verdict(ray, body) != Some(truth.verdict) {
            return Err(format!("the verdict alone is not {truth:?} for {body:?}"));
        }
        if with_big {
            tally.big += 1;
            let (word, time) = slow(case);
            let rounds = match (&time, truth.t) {
                (None, None) => true,
                (Some(time), Some(t)) => time.rounds_to(t),
                _ => false,
            };
            if usize::from(word) != place || !rounds {
                return Err(format!("big integers say {word} at {time:?}, not {truth:?} for {body:?}"));
            }
        }
    }
    compare_boxes(case, with_big, with_widest, tally)?;
    if with_big {
        compare_orders(case, tally)?;
    }
    if with_big && with_widest { compare_surds(case, tally) } else { Ok(()) }
}

fn compare_boxes(
    case: &ComparedCase,
    with_big: bool,
    with_widest: bool,
    tally: &mut Tally,
) -> Result<(), String> {
    let bounds = Aabb::new(case.cuboid.min, case.cuboid.max);
    let truth = aabb::verdict(&case.ray, &bounds).ok_or("no answer for a box")?;
    for tier in tiers(with_widest) {
        tally.answers += 1;
        match aabb::verdict_with(tier, &case.ray, &bounds) {
            None if matches!(tier, Tier::Auto | Tier::Widest) => {
                return Err(format!("{tier:?} leaves a box open"));
            }
            None => tally.undecided += 1,
            Some(verdict) if verdict != truth => {
                return Err(format!("{tier:?}: {verdict:?}, not {truth:?} for a box"));
            }
            Some(_) => {}
        }
    }
    if with_big {
        tally.big += 1;
        if reference::overlaps(&case.ray, &bounds) != truth.is_hit() {
            return Err(format!("big integers deny {truth:?} for a box"));
        }
    }
    Ok(())
}

/// The triangle against every other shape that is hit.
fn compare_orders(case: &ComparedCase, tally: &mut Tally) -> Result<(), String> {
    let ray = &case.ray;
    let (_, Some(time)) = reference::triangle(ray, &case.triangle) else {
        return Ok(());
    };
    let one = Body::Triangle(case.triangle);
    let others = [
        (Body::Plane(case.plane), reference::plane(ray, &case.plane)),
        (Body::Sphere(case.sphere), reference::sphere(ray, &case.sphere)),
        (Body::Cuboid(case.cuboid), reference::cuboid(ray, &case.cuboid)),
        (Body::Cylinder(case.cylinder), reference::cylinder(ray, &case.cylinder)),
        (Body::Cone(case.cone), reference::cone(ray, &case.cone)),
    ];
    for (other, (_, theirs)) in others {
        let Some(theirs) = theirs else { continue };
        tally.big += 1;
        if order(ray, one, other) != Some(time.cmp(&theirs)) {
            return Err(format!("order of {one:?} and {other:?} is not {:?}", time.cmp(&theirs)));
        }
    }
    Ok(())
}

/// Two shapes whose hits are roots of different quadratics. It runs in few cases, because the plain
/// comparison is slow.
fn compare_surds(case: &ComparedCase, tally: &mut Tally) -> Result<(), String> {
    let ray = &case.ray;
    let hits = [reference::sphere(ray, &case.sphere).1, reference::cylinder(ray, &case.cylinder).1];
    let [Some(one), Some(two)] = &hits else {
        return Ok(());
    };
    if hits.iter().flatten().any(|time| time.cmp_double(1e30).is_gt() || time.cmp_double(-1e30).is_lt()) {
        return Ok(());
    }
    tally.big += 1;
    let (sphere, cylinder) = (Body::Sphere(case.sphere), Body::Cylinder(case.cylinder));
    match order(ray, sphere, cylinder) {
        // The widest integers are too narrow for the order of two surds of extreme scales.
        None => tally.undecided += 1,
        Some(answer) if answer != one.cmp_any(two) => {
            return Err(format!("{sphere:?} and {cylinder:?}: {answer:?}"));
        }
        Some(_) => {}
    }
    Ok(())
}

/// Makes the cases of a measurement.
type Make = fn(u64, u64) -> ComparedCase;

/// Measures the answers per second of each predicate, on numbers of size one, on lattices with many ties, and
/// on all scales.
fn measure(seed: u64) {
    let kinds: [(&str, Make); 4] = [
        ("typical", cases::typical),
        ("ties, whole numbers to 16", cases::tied),
        ("ties, whole numbers to 2 million", cases::finely_tied),
        ("scales from 2^-100 to 2^100", cases::of_all_scales),
    ];
    for (name, make) in kinds {
        let all: Vec<ComparedCase> = (0..20_000).map(|case| make(seed, case)).collect();
        let on =
            all.iter().filter(|c| verdict(&c.ray, Body::Triangle(c.triangle)) == Some(Contact::On)).count();
        println!("{name}: {on} of {} triangles are met on an edge or corner", all.len());
        rate("triangle, verdict", &all, |c| verdict(&c.ray, Body::Triangle(c.triangle)));
        rate("triangle, verdict and t", &all, |c| meet(&c.ray, Body::Triangle(c.triangle)));
        rate("triangle, margin", &all, |c| triangle::margin(&c.ray, &c.triangle));
        rate("triangle, barycentric", &all, |c| triangle::weights(&c.ray, &c.triangle));
        rate("box, verdict", &all, |c| aabb::verdict(&c.ray, &Aabb::new(c.cuboid.min, c.cuboid.max)));
        rate("plane, verdict and t", &all, |c| meet(&c.ray, Body::Plane(c.plane)));
        rate("disk, verdict", &all, |c| verdict(&c.ray, Body::Disk(c.disk)));
        rate("disk, verdict and t", &all, |c| meet(&c.ray, Body::Disk(c.disk)));
        rate("sphere, verdict", &all, |c| verdict(&c.ray, Body::Sphere(c.sphere)));
        rate("sphere, verdict and t", &all, |c| meet(&c.ray, Body::Sphere(c.sphere)));
        rate("cylinder, verdict", &all, |c| verdict(&c.ray, Body::Cylinder(c.cylinder)));
        rate("cylinder, verdict and t", &all, |c| meet(&c.ray, Body::Cylinder(c.cylinder)));
        rate("cone, verdict", &all, |c| verdict(&c.ray, Body::Cone(c.cone)));
        rate("cone, verdict and t", &all, |c| meet(&c.ray, Body::Cone(c.cone)));
    }
}

/// The best of five runs over all cases.
fn rate<A>(name: &str, all: &[ComparedCase], question: impl Fn(&ComparedCase) -> A) {
    let best = (0..5)
        .map(|_| {
            let start = Instant::now();
            for case in all {
                black_box(question(black_box(case)));
            }
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    println!("  {name:26} {:8.2} million per second", all.len() as f64 / best / 1e6);
}
