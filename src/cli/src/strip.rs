//! `raykata strip`: one scene at growing depths of recursion (lecture "Example: Reflection", "Example: Refraction"), with
//! each sampler ("Antialiasing", "Generate pixel samples"), with the levels of its hierarchy, or with the functions of stage 1, of
//! stages 1 and 2, and so on, side by side.

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
use raykata::kit::{RenderJob, View, kit_error};
use raykata::scene::{Accelerator, Quality, Sampler, Scene};
use raykata::world::camera_for;
use std::fmt::Display;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::process::ExitCode;

/// Pixels between two pictures.
const GAP: u32 = 4;

/// What each stage adds, for captions.
const STAGES: &str =
    "spheres,triangles,hierarchy,light,glass,soft shadows,textures,curves,kd-tree,stability,paths,wide nodes";

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
            Opt::flag(
                "--stages",
                "Instead of depths: the scene with the functions of stage 1, of stages 1 and 2, up to all twelve, in three \
                 rows. Below each: primitive tests per ray. Writes each picture and an animated PNG file, too.",
            ),
            Opt::value(
                "--out",
                "FILE",
                "The PNG file [default: out/NAME-strip.png, with --stages out/NAME-stages/strip.png].",
            )
            .short("-o"),
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
    let mut scene = quality.load(scene_file)?;
    tone.apply(&mut scene);
    let pictures = pictures(given, &scene)?;
    let file = if given.has("--stages") { "stages/strip.png" } else { "strip.png" };
    let default = || Ok::<_, Error>(Path::new("out").join(format!("{}-{file}", name_of(scene_file)?)));
    let out = given.path("--out").map_or_else(default, Ok)?;
    make_folder_of(&out)?;
    let kit = kit.start()?;
    let (width, height, tone) = (scene.film.width, scene.film.height, scene.film.tone);
    let rows = if given.has("--stages") { 3 } else { 1 };
    let columns = pictures.len() as u32 / rows;
    let mut strip = Film::new(columns * width + (columns - 1) * GAP, rows * (height + caption::HEIGHT));
    let beside = |name: &str| Ok::<_, Error>(out.with_file_name(format!("{}-{name}.png", name_of(&out)?)));
    let mut frames = Vec::new();
    const COLUMNS: Columns = Columns("  ", &[15, 14, 14, 14, 9]);
    let heads: [&dyn Display; 5] =
        [&"picture", &"reflected rays", &"refracted rays", &"indirect rays", &"seconds"];
    println!("{}", COLUMNS.row(&heads));
    for (index, Picture { mut what, scene, level, view }) in (0..).zip(pictures) {
        let camera = camera_for(&scene);
        let job = RenderJob { view, ..job(scene) };
        let rendering = render(&*kit, &job)?;
        let (counts, seconds) = (rendering.counts, format!("{:.3}", rendering.render_seconds));
        let [reflected, refracted, indirect] =
            [counts.reflection, counts.transmission, counts.indirect].map(Thousands);
        println!("{}", COLUMNS.row(&[&what, &reflected, &refracted, &indirect, &seconds]));
        let left = index % columns * (width + GAP);
        let top = index / columns * (height + caption::HEIGHT);
        // Draw the boxes of the level over the picture.
        let is_light = !matches!(view, View::UpToStage(..4)); // normals are no light
        let mut film = if is_light { rendering.film.toned(tone) } else { rendering.film };
        if let Some(level) = level {
            film = with_edges(&film, &camera, &kit_error::catch(|| kit.outlines(&job, level))?);
        }
        if let View::UpToStage(stage) = view {
            let file = beside(&format!("stage{stage:02}"))?;
            write_png(&film, &file, job.scene.film.encoding, Some(&*kit))?;
            what += &format!(": {:.1}", counts.primitive_tests as f64 / counts.rays() as f64);
            frames.push(film.dithered_srgb());
        }
        paste(&film, &mut strip, [left, top]);
        caption::write(&mut strip, &what, [left, top + height], width);
    }
    if !frames.is_empty() {
        write_animated(&frames, [width, height], &beside("animated")?)?;
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
    view: View,
}

/// The scene once for each depth, sampler, level or stage.
fn pictures(given: &Given, scene: &Scene) -> Result<Vec<Picture>, Misuse> {
    let kinds = ["--depths", "--samplers", "--levels", "--stages"];
    for (index, kind) in kinds.iter().enumerate() {
        kinds[..index].iter().try_for_each(|other| given.exclude(kind, other))?;
    }
    let numbers = |option| given.list(option, |text| whole_number(text, &(0..=1000)));
    let (mut depths, levels) = (numbers("--depths")?, numbers("--levels")?);
    let samplers = given.choices("--samplers", &Sampler::NAMES)?;
    let own = scene.quality;
    let picture = |what: String, quality: Quality| {
        let scene = Scene { quality, ..scene.clone() };
        Picture { what, scene, level: None, view: View::Shaded }
    };
    if given.has("--stages") {
        // Samples of a pixel are an exercise of stage 6, and the kd-tree is one of stage 9.
        let of_stage = |(stage, name): (u8, &str)| {
            let quality = match stage {
                1..=5 => Quality { samples_per_pixel: 1, sampler: Sampler::Center, ..own },
                9 => Quality { accelerator: Accelerator::KdTree, ..own },
                _ => own,
            };
            Picture { view: View::UpToStage(stage), ..picture(format!("{stage} {name}"), quality) }
        };
        return Ok((1..).zip(STAGES.split(',')).map(of_stage).collect());
    }
    if !levels.is_empty() {
        let of_level = |level| Picture { level: Some(level), ..picture(format!("level {level}"), own) };
        return Ok(levels.into_iter().map(of_level).collect());
    }
    if !samplers.is_empty() {
        let of_sampler =
            |sampler: Sampler| picture(sampler.name().replace('_', "-"), Quality { sampler, ..own });
        return Ok(samplers.into_iter().map(of_sampler).collect());
    }
    if depths.is_empty() {
        depths = vec![1, 2, 5, 10];
    }
    let of_depth = |max_depth| picture(format!("depth {max_depth}"), Quality { max_depth, ..own });
    Ok(depths.into_iter().map(of_depth).collect())
}

/// Copies a picture into a strip, with its upper left corner at column `x` and row `y`.
pub fn paste(picture: &Film, strip: &mut Film, [x, y]: [u32; 2]) {
    for (row, pixels) in (y..).zip(picture.pixels.chunks(picture.width as usize)) {
        let start = (row * strip.width + x) as usize;
        strip.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}

/// Writes an animated PNG file that shows each frame, sRGB bytes of `width` by `height` pixels, for a second and a half.
fn write_animated(frames: &[Vec<u8>], [width, height]: [u32; 2], out: &Path) -> Result<()> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(out)?), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_animated(frames.len() as u32, 0)?;
    encoder.set_frame_delay(3, 2)?;
    let mut writer = encoder.write_header()?;
    frames.iter().try_for_each(|frame| writer.write_image_data(frame))?;
    Ok(writer.finish()?)
}
