//! `raykata strip`: one scene at growing depths of recursion (lecture "Example: Reflection", "Example: Refraction"), with
//! each sampler ("Antialiasing", "Generate pixel samples"), or with the levels of its hierarchy, side by side.

use crate::args::{Argument, Given, Misuse, Opt, Spec, names, whole_number};
use crate::caption;
use crate::compare::with_edges;
use crate::kits::{Choice, Need, Source, root};
use crate::picture_file::write_png;
use crate::quality_options::{QualityOptions, ToneOptions};
use crate::report::{Thousands, load_scene, make_folder_of};
use anyhow::{Context, Result};
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{RenderJob, View, kit_error};
use raykata::scene::{Quality, Sampler, Scene};
use raykata::world::camera_for;
use std::path::{Path, PathBuf};

/// Pixels between two pictures.
const GAP: u32 = 4;

/// `raykata strip`.
pub static SPEC: Spec = Spec {
    name: "raykata strip",
    about: "Render a scene at growing depths of recursion, with each sampler, or with the boxes of its acceleration \
            structure, side by side.",
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
                .choices(&names(&Sampler::NAMES))
                .many(),
            Opt::value(
                "--levels",
                "LIST",
                "Instead of depths: levels of the acceleration structure, whose boxes or cells are drawn over one \
                 picture each. Level 0 is the root.",
            )
            .many(),
            Opt::value("--out", "FILE", "The PNG file [default: out/NAME-strip.png].").short("-o"),
        ],
        Choice::OPTIONS,
        QualityOptions::OPTIONS,
        ToneOptions::OPTIONS,
    ],
};

/// The scene, and the depths, samplers or levels.
pub struct Options {
    scene: PathBuf,
    depths: Vec<u32>,
    samplers: Vec<Sampler>,
    levels: Vec<u32>,
    quality: QualityOptions,
    tone: ToneOptions,
    out: Option<PathBuf>,
    kit: Choice,
}

impl Options {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--samplers", "--depths")?;
        given.exclude("--levels", "--depths")?;
        given.exclude("--levels", "--samplers")?;
        let mut depths = given.list("--depths", |text| whole_number(text, &(0..=1000)))?;
        if depths.is_empty() {
            depths = vec![1, 2, 5, 10];
        }
        Ok(Options {
            scene: given.required(0)?.into(),
            depths,
            samplers: given.choices("--samplers", &Sampler::NAMES)?,
            levels: given.list("--levels", |text| whole_number(text, &(0..=1000)))?,
            quality: QualityOptions::read(given)?,
            tone: ToneOptions::read(given)?,
            out: given.path("--out"),
            kit: Choice::read(given)?,
        })
    }
}

/// Renders the strip, with the depth, sampler or level below each picture, and prints what each picture cost.
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
    let (width, height, tone) = (scene.film.width, scene.film.height, scene.film.tone);
    let n = pictures.len() as u32;
    let mut strip = Film::new(n * width + (n - 1) * GAP, height + caption::HEIGHT);
    println!(
        "{:>15}  {:>14}  {:>14}  {:>14}  {:>9}",
        "picture", "reflected rays", "refracted rays", "indirect rays", "seconds"
    );
    for (column, Picture { what, scene, level }) in pictures.into_iter().enumerate() {
        let camera = camera_for(&scene);
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
        // Draw the boxes of the level over the picture.
        let film = match level {
            Some(level) => with_edges(
                &rendering.film.toned(tone),
                &camera,
                &kit_error::catch(|| kit.outlines(&job, level))?,
            ),
            None => rendering.film.toned(tone),
        };
        paste(&film, &mut strip, left);
        caption::write(&mut strip, &what, [left, height], width);
    }
    write_png(&strip, &out, scene.film.encoding, Some(&*kit))
        .with_context(|| format!("cannot write {}", out.display()))?;
    println!("{}", out.display());
    Ok(())
}

/// A picture of the strip.
struct Picture {
    /// Its caption.
    what: String,
    scene: Scene,
    /// The level of the acceleration structure that is drawn over it.
    level: Option<u32>,
}

/// The scene once for each depth, sampler or level.
fn pictures(options: &Options, scene: &Scene) -> Vec<Picture> {
    let with = |change: &dyn Fn(&mut Quality)| {
        let mut scene = scene.clone();
        change(&mut scene.quality);
        scene
    };
    if !options.levels.is_empty() {
        let of = |&level: &u32| Picture {
            what: format!("level {level}"),
            scene: scene.clone(),
            level: Some(level),
        };
        return options.levels.iter().map(of).collect();
    }
    let picture = |what: String, scene: Scene| Picture { what, scene, level: None };
    if options.samplers.is_empty() {
        let of = |&depth: &u32| picture(format!("depth {depth}"), with(&|quality| quality.max_depth = depth));
        return options.depths.iter().map(of).collect();
    }
    let named = |sampler: &Sampler| {
        picture(sampler.name().replace('_', "-"), with(&|quality| quality.sampler = *sampler))
    };
    options.samplers.iter().map(named).collect()
}

fn paste(picture: &Film, strip: &mut Film, x: u32) {
    for (row, pixels) in picture.pixels.chunks(picture.width as usize).enumerate() {
        let start = row * strip.width as usize + x as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}
