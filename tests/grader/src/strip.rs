//! `raykata strip`: one scene at growing depths of recursion, side by side (lecture "Example: Reflection", "Example:
//! Refraction").

use crate::kits::{Source, Which};
use crate::render::write_png;
use crate::report::{Thousands, load_scene};
use anyhow::{Context, Result};
use clap::Args;
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{RenderJob, View, mishap};
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
    /// Where the PNG goes [default: out/NAME-strip.png].
    #[arg(long, short)]
    out: Option<PathBuf>,
    /// Whose code makes it.
    #[arg(long, value_enum, default_value_t = Which::Solutions)]
    kit: Which,
}

/// Renders the strip and tells what each picture took.
pub fn run(options: &Options) -> Result<()> {
    let scene = load_scene(&options.scene)?;
    let name = options.scene.file_stem().context("the scene has no name")?.to_string_lossy();
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-strip.png")));
    if let Some(folder) = out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let source = Source::here(options.kit)?;
    let kit = source.fresh();
    let (width, height) = (scene.film.width, scene.film.height);
    let n = options.depths.len() as u32;
    let mut strip = Film::new(n * width + (n - 1) * GAP, height);
    println!("{:>6}  {:>14}  {:>14}  {:>9}", "depth", "reflected rays", "refracted rays", "seconds");
    for (column, &depth) in options.depths.iter().enumerate() {
        let mut scene = scene.clone();
        scene.quality.max_depth = depth;
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: 0, count: true };
        let rendering = mishap::catch(|| kit.render(&job, &Unwatched))?.context("the frame was cancelled")?;
        let (counts, seconds) = (rendering.counts, rendering.render_seconds);
        println!(
            "{depth:>6}  {:>14}  {:>14}  {seconds:>9.3}",
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

fn paste(picture: &Film, strip: &mut Film, x: u32) {
    for (row, pixels) in picture.pixels.chunks(picture.width as usize).enumerate() {
        let start = row * strip.width as usize + x as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}
