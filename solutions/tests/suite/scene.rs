//! Scenes that tests write as text or take from `scenes`, and frames of them.

use raykata::count::Counts;
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{RayKind, RenderJob, Rendering, TracedRay, View};
use raykata::scene::{Accelerator, Scene, load};
use std::path::{Path, PathBuf};

/// The path of a scene in `scenes`.
pub fn path(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes")).join(name).with_extension("toml")
}

/// The scene in `text`, as if it were a file in `scenes`.
pub fn scene(text: &str) -> Scene {
    load::parse(&path("test"), text).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene of this name in `scenes`.
pub fn whole(name: &str) -> Scene {
    load::load(&path(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene of this name in a picture of this size, with one sample per pixel.
pub fn small(name: &str, width: u32, height: u32) -> Scene {
    let mut scene = whole(name);
    (scene.film.width, scene.film.height, scene.quality.samples_per_pixel) = (width, height, 1);
    scene
}

/// A frame on one thread, with counts.
pub fn job(scene: &Scene) -> RenderJob {
    RenderJob { scene: scene.clone(), view: View::Shaded, seed: 1, threads: 1, count: true, reuse: false }
}

pub fn rendered(job: &RenderJob) -> Rendering {
    solutions::kit().render(job, &Unwatched).expect("not cancelled")
}

pub fn render(scene: &Scene) -> Rendering {
    rendered(&job(scene))
}

pub fn render_by(scene: &Scene, accelerator: Accelerator) -> Rendering {
    let mut scene = scene.clone();
    scene.quality.accelerator = accelerator;
    render(&scene)
}

/// The rays behind each pixel of a frame.
pub fn traced(job: &RenderJob) -> Vec<Vec<TracedRay>> {
    let film = job.scene.film;
    let pixels = (0..film.height).flat_map(|y| (0..film.width).map(move |x| (x, y)));
    pixels.map(|(x, y)| solutions::kit().trace(job, x, y)).collect()
}

/// The counts of rays are those of the rays behind all pixels.
#[track_caller]
pub fn assert_counted(counts: &Counts, trees: &[Vec<TracedRay>], case: &str) {
    let of_kind = |kind| trees.iter().flatten().filter(|ray| ray.kind == kind).count() as u64;
    assert_eq!(counts.primary, of_kind(RayKind::Primary), "{case}");
    assert_eq!(counts.shadow, of_kind(RayKind::Shadow), "{case}");
    assert_eq!(counts.reflection, of_kind(RayKind::Reflection), "{case}");
    assert_eq!(counts.transmission, of_kind(RayKind::Transmission), "{case}");
    assert_eq!(counts.indirect, of_kind(RayKind::Indirect), "{case}");
}

/// How many pixels differ by more than `most` in a channel.
pub fn differing(one: &Film, other: &Film, most: f32) -> usize {
    let pairs = one.pixels.iter().zip(&other.pixels);
    pairs.filter(|(p, q)| (**p - **q).abs().max_element() > most).count()
}
