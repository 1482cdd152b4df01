//! `raykata strip`: one scene at growing depths of recursion (lecture "Example: Reflection", "Example: Refraction"), or
//! with each way to place samples ("Antialiasing", "Generate pixel samples"), side by side.

use crate::kits::{Choice, Source};
use crate::knobs::{Knobs, SamplerName};
use crate::render::write_png;
use crate::report::{Thousands, load_scene, make_folder_of};
use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{RenderJob, View, mishap};
use raykata::scene::{Quality, Scene};
use std::path::{Path, PathBuf};

/// Pixels between two pictures.
const GAP: u32 = 4;

/// Which scene, how deep.
#[derive(Args)]
pub struct Options {
    /// The scene, a TOML file.
    scene: PathBuf,
    /// How often rays may be mirrored or refracted, one picture each.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2, 5, 10], value_parser = clap::value_parser!(u32).range(0..=1000))]
    depths: Vec<u32>,
    /// Instead of depths: where the samples of a pixel lie, one picture each.
    #[arg(long, value_delimiter = ',', value_enum, conflicts_with = "depths")]
    samplers: Vec<SamplerName>,
    #[command(flatten)]
    knobs: Knobs,
    /// Where the PNG goes [default: out/NAME-strip.png].
    #[arg(long, short)]
    out: Option<PathBuf>,
    #[command(flatten)]
    kit: Choice,
}

/// Renders the strip and tells what each picture took.
pub fn run(options: &Options) -> Result<()> {
    let mut scene = load_scene(&options.scene)?;
    options.knobs.apply(&mut scene);
    let name = options.scene.file_stem().context("the scene has no name")?.to_string_lossy();
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-strip.png")));
    make_folder_of(&out)?;
    let source = Source::here(options.kit.or_reference())?;
    let kit = source.fresh();
    let pictures = pictures(options, &scene);
    let (width, height) = (scene.film.width, scene.film.height);
    let n = pictures.len() as u32;
    let mut strip = Film::new(n * width + (n - 1) * GAP, height);
    println!("{:>15}  {:>14}  {:>14}  {:>9}", "picture", "reflected rays", "refracted rays", "seconds");
    for (column, (what, scene)) in pictures.into_iter().enumerate() {
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: 0, count: true };
        let rendering = mishap::catch(|| kit.render(&job, &Unwatched))?.context("the frame was cancelled")?;
        let (counts, seconds) = (rendering.counts, rendering.render_seconds);
        println!(
            "{what:>15}  {:>14}  {:>14}  {seconds:>9.3}",
            Thousands(counts.reflection),
            Thousands(counts.transmission)
        );
        paste(&rendering.film, &mut strip, column as u32 * (width + GAP));
    }
    write_png(&strip, &out, scene.film.encoding, &*kit)
        .with_context(|| format!("cannot write {}", out.display()))?;
    println!("{}", out.display());
    Ok(())
}

/// The scene once for each depth or sampler, with its name.
fn pictures(options: &Options, scene: &Scene) -> Vec<(String, Scene)> {
    let with = |change: &dyn Fn(&mut Quality)| {
        let mut scene = scene.clone();
        change(&mut scene.quality);
        scene
    };
    if options.samplers.is_empty() {
        let depths = options.depths.iter();
        return depths.map(|&n| (format!("depth {n}"), with(&|quality| quality.max_depth = n))).collect();
    }
    let named = |sampler: &SamplerName| {
        let name = sampler.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
        (name, with(&|quality| quality.sampler = (*sampler).into()))
    };
    options.samplers.iter().map(named).collect()
}

fn paste(picture: &Film, strip: &mut Film, x: u32) {
    for (row, pixels) in picture.pixels.chunks(picture.width as usize).enumerate() {
        let start = row * strip.width as usize + x as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}
