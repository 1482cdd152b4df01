//! Measures the wide tree of the reference against Embree and published crates, on one thread: `cargo run --release` in this
//! folder, with `-- SCENE …` for some of the scenes, and `-- terrain-12m` for the largest. `-- --embree FILE` names the
//! library of Embree.
//!
//! The contestants trace the same rays in turn. Each figure is the median over rounds of the ratio of processor times of one
//! round. Camera rays come in tiles of 16 × 16 pixels, as in frames; diffuse rays leave their hits in random directions; shadow
//! rays go from the hits to a light.
//!
//! `-- --alone SCENE …` leaves out the crates. `-- --compare N` compares the hits of N rays with those of the binary tree.
//! `-- --scale SVG` shows how the cost grows with the number of triangles, also on two threads, and draws a plot.

mod compare;
mod crates;
mod embree;
mod reference;
mod scale;
mod scenes;

use cpu_time::ThreadTime;
use crates::{Bvh, Contestant, Obvhs2, ObvhsWide, Parry};
use embree::Embree;
use oracle::splitmix::Random;
use raykata::ray::Ray;
use reference::Wide;
use scenes::Scene;
use std::time::Duration;

const SIDE: u32 = 256;
const ROUNDS: usize = 9;

fn main() {
    let mut words = std::env::args().skip(1);
    let (mut library, mut alone, mut names) = (String::from("libembree4.so.4"), false, Vec::new());
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| fail(&format!("{word} needs a value")));
        match word.as_str() {
            "--embree" => library = value(),
            "--alone" => alone = true,
            "--compare" => {
                let n = value().parse().unwrap_or_else(|_| fail("--compare needs a number of rays"));
                std::process::exit(i32::from(!compare::run(n)));
            }
            "--memory" => {
                let side = value().parse().unwrap_or_else(|_| fail("--memory needs a number"));
                return println!("{}", scale::memory_of_build(side));
            }
            "--scale" => return scale::run(&library, &value()),
            option if option.starts_with("--") => fail(&format!(
                "no option `{option}`; there are --alone, --embree FILE, --compare N and --scale SVG"
            )),
            _ => names.push(word),
        }
    }
    if names.is_empty() {
        names = scenes::NAMES.map(String::from).into();
    }
    let mut table = Vec::new();
    for name in names {
        let Some(scene) = scenes::by_name(&name) else {
            fail(&format!("no scene `{name}`; there are {:?} and \"terrain-12m\"", scenes::NAMES));
        };
        table.push((name, on_threads(1, || measure(&scene, &library, alone))));
    }
    // Print a table for `README.md`, with the date and the processor.
    let Some((_, first)) = table.first() else { return };
    println!("\n{}, one thread:\n", date_and_machine());
    print_row(["scene"].into_iter().chain(first.iter().map(|one| one.name)).map(String::from).collect());
    print_row(vec!["---".into(); first.len() + 1]);
    for (scene, speeds) in &table {
        let cell = |Speed { ratio: [p, d, s], .. }: &Speed| format!("{p:.2}, {d:.2}, {s:.2}");
        print_row([scene.clone()].into_iter().chain(speeds.iter().map(cell)).collect());
    }
}

/// Does work whose parallel parts run on so many threads.
fn on_threads<R: Send>(n: usize, work: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
    pool.unwrap_or_else(|error| fail(&error.to_string())).install(work)
}

/// The speed of a contestant, for camera, diffuse and shadow rays.
struct Speed {
    name: &'static str,
    /// In relation to Embree's fast mode.
    ratio: [f64; 3],
    /// The microseconds per ray.
    microseconds: [f64; 3],
}

/// The date and the processor, whose name alone may hide its generation.
fn date_and_machine() -> String {
    let date =
        std::process::Command::new("date").arg("-I").output().map(|date| date.stdout).unwrap_or_default();
    let machine = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name| {
        let mut fields = machine.lines().filter_map(|line| line.split_once(':'));
        fields.find(|(field, _)| field.trim() == name).map_or("unknown", |(_, value)| value.trim())
    };
    let [family, model, name] = ["cpu family", "model", "model name"].map(field);
    format!("{}, {name} (family {family}, model {model})", String::from_utf8_lossy(&date).trim())
}

fn print_row(cells: Vec<String>) {
    println!("| {} |", cells.join(" | "));
}

fn fail(message: &str) -> ! {
    eprintln!("error: {message}");
    std::process::exit(2);
}

fn timed<R>(work: impl FnOnce() -> R) -> (R, Duration) {
    let started = ThreadTime::now();
    let result = work();
    (result, started.elapsed())
}

/// Camera rays in tiles, diffuse rays from their hits, and shadow rays to the light.
fn rays(scene: &Scene, wide: &Wide) -> [Vec<Ray>; 3] {
    let forward = (scene.target - scene.eye).normalize();
    let right = forward.cross(glam::Vec3::Y).normalize();
    let up = right.cross(forward);
    let extent = (0.5 * scene.field.to_radians()).tan();
    let mut primary = Vec::new();
    for tile in 0..(SIDE / 16) * (SIDE / 16) {
        for pixel in 0..256 {
            let x = tile % (SIDE / 16) * 16 + pixel % 16;
            let y = tile / (SIDE / 16) * 16 + pixel / 16;
            let at = |i: u32| (i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
            let direction = forward + extent * (at(x) * right - at(y) * up);
            primary.push(Ray::new(scene.eye, direction.normalize()));
        }
    }
    let mut found = vec![0.0; primary.len()];
    wide.trace(&primary, false, &mut found);
    let mut random = Random::new(3, 0);
    let (mut diffuse, mut shadow) = (Vec::new(), Vec::new());
    for (ray, &t) in primary.iter().zip(&found).filter(|(_, t)| t.is_finite()) {
        // Directions on the side of the camera stand for those around the normal.
        let away = -ray.direction;
        let origin = reference::off_surface(ray, t, away);
        let direction = (away + random.direction()).normalize_or(away);
        diffuse.push(Ray::new(origin, direction));
        let to_light = scene.light - origin;
        shadow.push(Ray::new(origin, to_light.normalize()).with_range(0.0, to_light.length()));
    }
    [primary, diffuse, shadow]
}

fn measure(scene: &Scene, library: &str, alone: bool) -> Vec<Speed> {
    let triangles = scene.triangles.as_slice();
    let (wide, build) = timed(|| Wide::build(triangles));
    let rays = rays(scene, &wide);
    println!(
        "{}: {} triangles, {:.1} bytes per triangle, built in {:.3} s",
        scene.name,
        triangles.len(),
        wide.bytes() as f64 / triangles.len() as f64,
        build.as_secs_f64()
    );
    for (name, rays) in ["primary", "diffuse", "shadow"].iter().zip(&rays) {
        let [nodes, blocks, tests] =
            wide.counts(rays, *name == "shadow").map(|count| count as f64 / rays.len() as f64);
        println!("  {name}: {nodes:.2} nodes, {blocks:.2} blocks, {tests:.2} exact tests per ray");
    }
    let mut contestants: Vec<(&'static str, Box<dyn Contestant>, Duration)> =
        vec![("reference", Box::new(wide), build)];
    for (name, robust) in [("Embree", false), ("Embree robust", true)] {
        let (embree, build) = timed(|| Embree::build(library, triangles, robust, 1));
        match embree {
            Some(embree) => contestants.push((name, Box::new(embree), build)),
            None => println!("{}", embree::HOW_TO_GET),
        }
    }
    if !alone {
        fn boxed<C: Contestant + 'static>((built, time): (C, Duration)) -> (Box<dyn Contestant>, Duration) {
            (Box::new(built), time)
        }
        for (name, (built, time)) in [
            ("obvhs, binary", boxed(timed(|| Obvhs2::build(triangles)))),
            ("obvhs, wide", boxed(timed(|| ObvhsWide::build(triangles)))),
            ("parry3d", boxed(timed(|| Parry::build(triangles)))),
            ("bvh", boxed(timed(|| Bvh::build(triangles)))),
        ] {
            contestants.push((name, built, time));
        }
    }
    compare(&contestants, &rays)
}

/// Prints one line per contestant, and returns the speeds relative to that of Embree, or of the reference without Embree.
fn compare(
    contestants: &[(&'static str, Box<dyn Contestant>, Duration)],
    rays: &[Vec<Ray>; 3],
) -> Vec<Speed> {
    let base = contestants.iter().position(|one| one.0 == "Embree").unwrap_or(0);
    let n = contestants.len();
    let most = rays.iter().map(Vec::len).max().unwrap_or(0);
    let mut found = vec![0.0f32; most];
    // times[contestant][kind][round], and the number of answers that differ from the reference's.
    let mut times = vec![[const { Vec::new() }; 3]; n];
    let mut differ = vec![[0usize; 3]; n];
    let mut expected: Vec<Vec<f32>> = Vec::new();
    for round in 0..=ROUNDS {
        for (i, (_, contestant, _)) in contestants.iter().enumerate() {
            for (kind, rays) in rays.iter().enumerate() {
                let answers = &mut found[..rays.len()];
                let ((), time) = timed(|| contestant.trace(rays, kind == 2, answers));
                // The first round fills the caches, and its answers are compared.
                if round > 0 {
                    times[i][kind].push(time.as_secs_f64());
                } else if i == 0 {
                    expected.push(answers.to_vec());
                } else {
                    let close = |p: f32, q: f32| p == q || (p - q).abs() <= 1e-3 * p.abs();
                    differ[i][kind] =
                        answers.iter().zip(&expected[kind]).filter(|&(&p, &q)| !close(p, q)).count();
                }
            }
        }
    }
    println!(
        "  {:<16} {:>8}   {:^29}   speed / that of {:<9} {:>17}",
        "", "build s", "million rays per second", contestants[base].0, "other answers"
    );
    let mut ratios = Vec::new();
    for (i, &(name, _, build)) in contestants.iter().enumerate() {
        let rates = [0, 1, 2].map(|kind| rays[kind].len() as f64 / median(times[i][kind].clone()) / 1e6);
        let ratio = [0, 1, 2].map(|kind: usize| {
            median(times[base][kind].iter().zip(&times[i][kind]).map(|(base, own)| base / own).collect())
        });
        let ([r0, r1, r2], [q0, q1, q2]) = (rates, ratio);
        println!(
            "  {name:<16} {:>8.3}   {r0:>9.3} {r1:>9.3} {r2:>9.3}   {q0:>7.2} {q1:>7.2} {q2:>7.2}   {:?}",
            build.as_secs_f64(),
            differ[i],
        );
        ratios.push(Speed { name, ratio, microseconds: rates.map(|rate| 1.0 / rate) });
    }
    ratios
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
