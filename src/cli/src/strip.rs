//! `raykata strip`: one scene at growing depths of recursion (lecture "Example: Reflection", "Example: Refraction"), or
//! with each sampler ("Antialiasing", "Generate pixel samples"), side by side.

use crate::args::{Argument, Given, Misuse, Opt, Spec, names, whole_number};
use crate::caption;
use crate::kits::{Choice, Need, Source, root};
use crate::quality_options::{QualityOptions, SAMPLERS, ToneOptions};
use crate::render::write_png;
use crate::report::{Thousands, load_scene, make_folder_of};
use anyhow::{Context, Result};
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{RenderJob, View, kit_error};
use raykata::scene::{Quality, Sampler, Scene};
use std::path::{Path, PathBuf};

/// Pixels between two pictures.
const GAP: u32 = 4;

/// `raykata strip`.
pub static SPEC: Spec = Spec {
    name: "raykata strip",
    about: "Render a scene at growing depths of recursion, or with each sampler, side by side.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[
            Opt::value(
                "--depths",
                "LIST",
                "The most reflections and refractions on a path, one picture each [default: 1,2,5,10].",
            )
            .many(),
            Opt::value("--samplers", "LIST", "Instead of depths: the samplers, one picture each.")
                .choices(&names(&SAMPLERS))
                .many(),
            Opt::value("--out", "FILE", "The PNG file [default: out/NAME-strip.png].").short("-o"),
        ],
        Choice::OPTIONS,
        QualityOptions::OPTIONS,
        ToneOptions::OPTIONS,
    ],
};

/// The scene, and the depths or samplers.
pub struct Options {
    scene: PathBuf,
    depths: Vec<u32>,
    samplers: Vec<Sampler>,
    quality: QualityOptions,
    tone: ToneOptions,
    out: Option<PathBuf>,
    kit: Choice,
}

impl Options {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--samplers", "--depths")?;
        let mut depths = given.list("--depths", |text| whole_number(text, &(0..=1000)))?;
        if depths.is_empty() {
            depths = vec![1, 2, 5, 10];
        }
        Ok(Options {
            scene: given.required(0)?.into(),
            depths,
            samplers: given.choices("--samplers", &SAMPLERS)?,
            quality: QualityOptions::read(given)?,
            tone: ToneOptions::read(given)?,
            out: given.path("--out"),
            kit: Choice::read(given)?,
        })
    }
}

/// Renders the strip, with the depth or sampler below each picture, and prints what each picture cost.
pub fn run(options: &Options) -> Result<()> {
    let mut scene = load_scene(&options.scene, options.quality.limits())?;
    options.quality.apply(&mut scene)?;
    options.tone.apply(&mut scene);
    let name = options.scene.file_stem().context("the scene has no name")?.to_string_lossy();
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-strip.png")));
    make_folder_of(&out)?;
    let root = root()?;
    let source = Source::prepare(&root, options.kit.or_reference(&root), Need::Frames)?;
    let kit = source.fresh();
    let pictures = pictures(options, &scene);
    let (width, height) = (scene.film.width, scene.film.height);
    let n = pictures.len() as u32;
    let mut strip = Film::new(n * width + (n - 1) * GAP, height + caption::HEIGHT);
    println!(
        "{:>15}  {:>14}  {:>14}  {:>14}  {:>9}",
        "picture", "reflected rays", "refracted rays", "indirect rays", "seconds"
    );
    for (column, (what, scene)) in pictures.into_iter().enumerate() {
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: 0, count: true, reuse: true };
        let rendering =
            kit_error::catch(|| kit.render(&job, &Unwatched))?.context("the frame was cancelled")?;
        let (counts, seconds) = (rendering.counts, rendering.render_seconds);
        println!(
            "{what:>15}  {:>14}  {:>14}  {:>14}  {seconds:>9.3}",
            Thousands(counts.reflection),
            Thousands(counts.transmission),
            Thousands(counts.indirect)
        );
        let left = column as u32 * (width + GAP);
        paste(&rendering.film, &mut strip, left);
        caption::write(&mut strip, &what, [left, height], width);
    }
    write_png(&strip.toned(scene.film.tone), &out, scene.film.encoding, &*kit)
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
    let named = |sampler: &Sampler| {
        let name = SAMPLERS.iter().find(|(_, one)| one == sampler).map_or("", |(name, _)| name);
        (name.to_owned(), with(&|quality| quality.sampler = *sampler))
    };
    options.samplers.iter().map(named).collect()
}

fn paste(picture: &Film, strip: &mut Film, x: u32) {
    for (row, pixels) in picture.pixels.chunks(picture.width as usize).enumerate() {
        let start = row * strip.width as usize + x as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}
