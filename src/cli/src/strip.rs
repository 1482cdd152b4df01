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
use raykata::scene::{Quality, Sampler, Scene};
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
    let chosen = Chosen::read(given)?;
    let mut scene = quality.load(scene_file)?;
    tone.apply(&mut scene);
    let default = || Ok::<_, Error>(Path::new("out").join(format!("{}-strip.png", name_of(scene_file)?)));
    let out = given.path("--out").map_or_else(default, Ok)?;
    make_folder_of(&out)?;
    let kit = kit.start()?;
    let pictures = chosen.pictures(&scene);
    let (width, height, tone) = (scene.film.width, scene.film.height, scene.film.tone);
    let n = pictures.len() as u32;
    let mut strip = Film::new(n * width + (n - 1) * GAP, height + caption::HEIGHT);
    const COLUMNS: Columns = Columns("  ", &[15, 14, 14, 14, 9]);
    let heads: [&dyn Display; 5] =
        [&"picture", &"reflected rays", &"refracted rays", &"indirect rays", &"seconds"];
    println!("{}", COLUMNS.row(&heads));
    for (column, Picture { what, scene, level }) in pictures.into_iter().enumerate() {
        let camera = camera_for(&scene);
        let job = job(scene);
        let rendering = render(&*kit, &job)?;
        let (counts, seconds) = (rendering.counts, format!("{:.3}", rendering.render_seconds));
        let [reflected, refracted, indirect] =
            [counts.reflection, counts.transmission, counts.indirect].map(Thousands);
        println!("{}", COLUMNS.row(&[&what, &reflected, &refracted, &indirect, &seconds]));
        let left = column as u32 * (width + GAP);
        // Draw the boxes of the level over the picture.
        let mut film = rendering.film.toned(tone);
        if let Some(level) = level {
            film = with_edges(&film, &camera, &kit_error::catch(|| kit.outlines(&job, level))?);
        }
        paste(&film, &mut strip, left);
        caption::write(&mut strip, &what, [left, height], width);
    }
    write_png(&strip, &out, scene.film.encoding, Some(&*kit))
        .with_context(|| format!("cannot write {}", out.display()))?;
    println!("{}", out.display());
    Ok(ExitCode::SUCCESS)
}

/// A picture of the strip.
struct Picture {
    /// Its caption.
    what: String,
    scene: Scene,
    /// The level of the acceleration structure that is drawn over it.
    level: Option<u32>,
}

/// What the pictures of a strip differ in.
enum Chosen {
    Depths(Vec<u32>),
    Samplers(Vec<Sampler>),
    Levels(Vec<u32>),
}

impl Chosen {
    fn read(given: &Given) -> Result<Chosen, Misuse> {
        given.exclude("--samplers", "--depths")?;
        given.exclude("--levels", "--depths")?;
        given.exclude("--levels", "--samplers")?;
        let numbers = |option| given.list(option, |text| whole_number(text, &(0..=1000)));
        let (depths, levels) = (numbers("--depths")?, numbers("--levels")?);
        let samplers = given.choices("--samplers", &Sampler::NAMES)?;
        Ok(match (levels.is_empty(), samplers.is_empty()) {
            (false, _) => Chosen::Levels(levels),
            (_, false) => Chosen::Samplers(samplers),
            _ if depths.is_empty() => Chosen::Depths(vec![1, 2, 5, 10]),
            _ => Chosen::Depths(depths),
        })
    }

    /// The scene once for each depth, sampler or level.
    fn pictures(&self, scene: &Scene) -> Vec<Picture> {
        let picture = |what: String, quality: Quality, level: Option<u32>| Picture {
            what,
            scene: Scene { quality, ..scene.clone() },
            level,
        };
        let own = scene.quality;
        let of_depth = |max_depth| picture(format!("depth {max_depth}"), Quality { max_depth, ..own }, None);
        let of_level = |level| picture(format!("level {level}"), own, Some(level));
        let of_sampler =
            |sampler: Sampler| picture(sampler.name().replace('_', "-"), Quality { sampler, ..own }, None);
        match self {
            Chosen::Depths(depths) => depths.iter().copied().map(of_depth).collect(),
            Chosen::Samplers(samplers) => samplers.iter().copied().map(of_sampler).collect(),
            Chosen::Levels(levels) => levels.iter().copied().map(of_level).collect(),
        }
    }
}

fn paste(picture: &Film, strip: &mut Film, x: u32) {
    for (row, pixels) in picture.pixels.chunks(picture.width as usize).enumerate() {
        let start = row * strip.width as usize + x as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}
