//! `raykata strip`: one scene at growing depths of recursion (lecture "Example: Reflection", "Example: Refraction"), with
//! each sampler ("Antialiasing", "Generate pixel samples"), or with the levels of its hierarchy, side by side.

use crate::args::{Argument, Given, Misuse, Opt, Spec, names, whole_number};
use crate::caption;
use crate::columns::Columns;
use crate::compare::with_edges;
use crate::kits::Choice;
use crate::picture_file::write_png;
use crate::quality_options::{QualityOptions, ToneOptions};
use crate::report::{Thousands, job, make_folder_of, name_of, render};
use anyhow::{Context, Error, Result};
use raykata::film::Film;
use raykata::kit::kit_error;
use raykata::scene::Sampler;
use raykata::world::camera_for;
use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

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

/// Renders the strip, with the depth, sampler or level below each picture, and prints what each picture cost.
pub fn run(given: &Given) -> Result<ExitCode> {
    let (quality, tone, kit) =
        (QualityOptions::read(given)?, ToneOptions::read(given)?, Choice::read(given)?);
    let scene_file = Path::new(given.required(0)?);
    let shown = shown(given)?;
    let mut scene = quality.load(scene_file)?;
    tone.apply(&mut scene);
    let default = || Ok::<_, Error>(Path::new("out").join(format!("{}-strip.png", name_of(scene_file)?)));
    let out = given.path("--out").map_or_else(default, Ok)?;
    make_folder_of(&out)?;
    let kit = kit.start()?;
    let (width, height, tone) = (scene.film.width, scene.film.height, scene.film.tone);
    let n = shown.len() as u32;
    let mut strip = Film::new(n * width + (n - 1) * GAP, height + caption::HEIGHT);
    const COLUMNS: Columns = Columns("  ", &[15, 14, 14, 14, 9]);
    let heads: [&dyn Display; 5] =
        [&"picture", &"reflected rays", &"refracted rays", &"indirect rays", &"seconds"];
    println!("{}", COLUMNS.row(&heads));
    for (column, shown) in shown.into_iter().enumerate() {
        let mut job = job(scene.clone());
        let (what, level) = match shown {
            Shown::Depth(depth) => {
                job.scene.quality.max_depth = depth;
                (format!("depth {depth}"), None)
            }
            Shown::Sampler(sampler) => {
                job.scene.quality.sampler = sampler;
                (sampler.name().replace('_', "-"), None)
            }
            Shown::Level(level) => (format!("level {level}"), Some(level)),
        };
        let rendering = render(&*kit, &job)?;
        let (counts, seconds) = (rendering.counts, format!("{:.3}", rendering.render_seconds));
        let [reflected, refracted, indirect] =
            [counts.reflection, counts.transmission, counts.indirect].map(Thousands);
        println!("{}", COLUMNS.row(&[&what, &reflected, &refracted, &indirect, &seconds]));
        let left = column as u32 * (width + GAP);
        // Draw the boxes of the level over the picture.
        let mut film = rendering.film.toned(tone);
        if let Some(level) = level {
            film =
                with_edges(&film, &camera_for(&job.scene), &kit_error::catch(|| kit.outlines(&job, level))?);
        }
        paste(&film, &mut strip, left);
        caption::write(&mut strip, &what, [left, height], width);
    }
    write_png(&strip, &out, scene.film.encoding, Some(&*kit))
        .with_context(|| format!("cannot write {}", out.display()))?;
    println!("{}", out.display());
    Ok(ExitCode::SUCCESS)
}

/// What a picture of the strip shows.
enum Shown {
    Depth(u32),
    Sampler(Sampler),
    /// A level of the acceleration structure, which is drawn over the picture.
    Level(u32),
}

/// The pictures that the command line asks for: of depths, of samplers or of levels.
fn shown(given: &Given) -> Result<Vec<Shown>, Misuse> {
    given.exclude("--samplers", "--depths")?;
    given.exclude("--levels", "--depths")?;
    given.exclude("--levels", "--samplers")?;
    let numbers = |option| given.list(option, |text| whole_number(text, &(0..=1000)));
    let (depths, levels) = (numbers("--depths")?, numbers("--levels")?);
    let samplers = given.choices("--samplers", &Sampler::NAMES)?;
    let is_default = depths.is_empty() && levels.is_empty() && samplers.is_empty();
    let depths = if is_default { vec![1, 2, 5, 10] } else { depths };
    let depths = depths.into_iter().map(Shown::Depth);
    let samplers = samplers.into_iter().map(Shown::Sampler);
    Ok(depths.chain(samplers).chain(levels.into_iter().map(Shown::Level)).collect())
}

fn paste(picture: &Film, strip: &mut Film, x: u32) {
    for (row, pixels) in picture.pixels.chunks(picture.width as usize).enumerate() {
        let start = row * strip.width as usize + x as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}
