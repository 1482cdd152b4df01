//! Measures the wide tree of the reference against published crates, on one thread: `cargo run --release` in this folder,
//! with `-- SCENE …` for some of the scenes, and `-- terrain-12m` for the largest.
//!
//! The contestants trace the same rays in turn. Each figure is the median over rounds of the ratio of processor times of one
//! round: above 1 the reference is faster. Camera rays come in tiles of 16 × 16 pixels, as in frames; diffuse rays leave their
//! hits in random directions; shadow rays go from the hits to a light.
//!
//! `-- --steps SCENE …` prints what each step of stage 12 changes, in counts. `-- --alone SCENE …` leaves out the crates.
//! `-- --scaling SCENE …` builds the binary tree on one and on two threads in turn.
//! `-- --dump FOLDER SCENE …` writes triangles and rays as binary files of `f32`, for programs that are not Rust crates.

mod crates;
mod reference;
mod scaling;
mod scenes;
mod steps;

use cpu_time::ThreadTime;
use crates::{Bvh, Contestant, Obvhs2, ObvhsWide, Parry};
use raykata::ray::Ray;
use reference::{Search, Wide};
use scenes::{Random, Scene};
use std::time::Duration;

const SIDE: u32 = 256;
const ROUNDS: usize = 7;

fn main() {
    let mut words = std::env::args().skip(1).peekable();
    let option = words.next_if(|word| word.starts_with("--"));
    let option = option.as_deref();
    let folder = if option == Some("--dump") { words.next() } else { None };
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = scenes::NAMES.map(String::from).into();
    }
    for name in names {
        let Some(scene) = scenes::by_name(&name) else {
            fail(&format!("no scene `{name}`; there are {:?} and \"terrain-12m\"", scenes::NAMES));
        };
        match option {
            None | Some("--alone" | "--dump") => {
                measure(&scene, folder.as_deref(), option == Some("--alone"))
            }
            Some("--scaling") => println!("{name}: {}", scaling::measured(&scene.triangles)),
            Some("--steps") => {
                println!("{name}: {} triangles", scene.triangles.len());
                let [camera, ..] = rays(&scene, &Wide::build(&scene.triangles, true));
                steps::print(&scene.triangles, &camera);
            }
            Some(other) => {
                fail(&format!("no option `{other}`; there are --alone, --steps, --scaling and --dump FOLDER"))
            }
        }
    }
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
    wide.closest(&primary, &mut found);
    let mut random = Random(3);
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

fn dump(folder: &str, scene: &Scene, rays: &[Vec<Ray>; 3]) {
    let write = |name: &str, numbers: Vec<f32>| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        std::fs::write(format!("{folder}/{}-{name}.bin", scene.name), bytes)
            .expect("a folder that can be written");
    };
    write(
        "triangles",
        scene.triangles.iter().flat_map(|t| [t.a, t.b, t.c]).flat_map(|p| p.to_array()).collect(),
    );
    for (name, rays) in ["primary", "diffuse", "shadow"].iter().zip(rays) {
        let numbers = |ray: &Ray| {
            [ray.origin.to_array(), ray.direction.to_array()]
                .concat()
                .into_iter()
                .chain([ray.t_max])
                .collect::<Vec<_>>()
        };
        write(name, rays.iter().flat_map(numbers).collect());
    }
}

fn measure(scene: &Scene, folder: Option<&str>, alone: bool) {
    let triangles = scene.triangles.as_slice();
    let (wide, build) = timed(|| Wide::build(triangles, false));
    let rays = rays(scene, &wide);
    println!(
        "{}: {} triangles, {:.1} bytes per triangle, built in {:.3} s",
        scene.name,
        triangles.len(),
        wide.bytes() as f64 / triangles.len() as f64,
        build.as_secs_f64()
    );
    for (name, rays) in ["primary", "diffuse", "shadow"].iter().zip(&rays) {
        let per_ray = wide
            .counts(rays, if *name == "shadow" { Search::Any } else { Search::Closest })
            .map(|count| count as f64 / rays.len() as f64);
        println!(
            "  {name}: {:.2} nodes, {:.2} blocks, {:.2} exact tests per ray",
            per_ray[0], per_ray[1], per_ray[2]
        );
    }
    if let Some(folder) = folder {
        dump(folder, scene, &rays);
    }
    let mut contestants: Vec<(&str, Box<dyn Contestant>, Duration)> =
        vec![("reference", Box::new(wide), build)];
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
    compare(&contestants, &rays);
}

/// Prints one line per contestant.
fn compare(contestants: &[(&str, Box<dyn Contestant>, Duration)], rays: &[Vec<Ray>; 3]) {
    let n = contestants.len();
    let most = rays.iter().map(Vec::len).max().unwrap_or(0);
    let (mut closest, mut any) = (vec![0.0f32; most], vec![false; most]);
    // times[contestant][kind][round], and the number of answers that differ from the reference's.
    let mut times = vec![[const { Vec::new() }; 3]; n];
    let mut differ = vec![[0usize; 3]; n];
    let mut expected: Vec<Vec<f32>> = Vec::new();
    for round in 0..=ROUNDS {
        for (i, (_, contestant, _)) in contestants.iter().enumerate() {
            for (kind, rays) in rays.iter().enumerate() {
                let (answers, time) = if kind < 2 {
                    let ((), time) = timed(|| contestant.closest(rays, &mut closest[..rays.len()]));
                    (closest[..rays.len()].to_vec(), time)
                } else {
                    let ((), time) = timed(|| contestant.any(rays, &mut any[..rays.len()]));
                    (any[..rays.len()].iter().map(|&hit| if hit { 1.0 } else { 0.0 }).collect(), time)
                };
                // The first round fills the caches, and its answers are compared.
                if round > 0 {
                    times[i][kind].push(time.as_secs_f64());
                } else if i == 0 {
                    expected.push(answers);
                } else {
                    let close = |p: f32, q: f32| p == q || (p - q).abs() <= 1e-3 * p.abs();
                    differ[i][kind] =
                        answers.iter().zip(&expected[kind]).filter(|&(&p, &q)| !close(p, q)).count();
                }
            }
        }
    }
    println!(
        "  {:<16} {:>8}   {:^29}   {:^23}   {:^17}",
        "", "build s", "million rays per second", "the reference is faster", "other answers"
    );
    for (i, (name, _, build)) in contestants.iter().enumerate() {
        let rate = |kind: usize| rays[kind].len() as f64 / median(times[i][kind].clone()) / 1e6;
        let ratio = |kind: usize| {
            median(times[i][kind].iter().zip(&times[0][kind]).map(|(t, own)| t / own).collect())
        };
        println!(
            "  {name:<16} {:>8.3}   {:>9.3} {:>9.3} {:>9.3}   {:>7.2} {:>7.2} {:>7.2}   {:>5} {:>5} {:>5}",
            build.as_secs_f64(),
            rate(0),
            rate(1),
            rate(2),
            ratio(0),
            ratio(1),
            ratio(2),
            differ[i][0],
            differ[i][1],
            differ[i][2],
        );
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
