//! The finish of a stage: its picture, rendered by the student's own functions and kept in the album, its counts in one sentence,
//! and what comes next.

use crate::half_blocks::{Look, cells};
use crate::kits::{Need, Source, Which};
use crate::report::{FrameBar, Thousands, job, make_folder_of, read_scene, with_at_most, wrapped};
use anyhow::{Context, Result};
use raykata::count::Counts;
use raykata::film::{Film, encode_srgb};
use raykata::frame::Watch;
use raykata::kit::{Function, Kit, Rendering, kit_error};
use raykata::rubric;
use raykata::scene::{Encoding, Scene};
use std::path::{Path, PathBuf};

/// The folder of the pictures of finished stages, from the root of the kit.
pub const ALBUM: &str = "out/album";

/// The most pixels, and the most samples per pixel, with which the picture of each stage takes seconds.
const PIXELS: f64 = 60_000.0;
const SAMPLES: u32 = 16;

/// The most columns of the picture in the terminal, so that it and the text below it fit on a screen.
const MOST_COLUMNS: usize = 64;

/// The picture of a stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
    /// The number of pixels per row.
    pub width: usize,
    /// What it cost, and where it is kept.
    pub lines: Vec<String>,
    /// What it lacks.
    pub notes: Vec<String>,
}

/// The scene that shows what a stage adds.
pub fn scene_of(root: &Path, stage: u8) -> PathBuf {
    let own = root.join(format!("scenes/stage{stage}.toml"));
    let file = match stage {
        _ if own.is_file() => return own,
        11 => "cornell.toml",
        _ => "showcase.toml",
    };
    root.join("scenes").join(file)
}

/// The path of the picture of a stage, from the root of the kit. Only those of finished stages are in the album.
pub fn file_of(stage: u8, is_done: bool) -> String {
    if is_done { format!("{ALBUM}/stage{stage}.png") } else { "out/watch.png".to_owned() }
}

/// Renders the picture of a stage with this kit, and writes it to `file`, a path from the root.
pub fn render(root: &Path, stage: u8, file: &str, kit: &dyn Kit, watch: &dyn Watch) -> Result<Picture> {
    let mut scene = with_at_most(PIXELS, &read_scene(&scene_of(root, stage))?);
    scene.quality.samples_per_pixel = scene.quality.samples_per_pixel.min(SAMPLES);
    let rendering = kit_error::catch(|| kit.render(&job(scene.clone()), watch))?;
    keep(root, file, &scene, &rendering.context("the frame was cancelled")?, kit)
}

/// Writes the picture of a frame to `file`, a path from the root.
pub fn keep(root: &Path, file: &str, scene: &Scene, rendering: &Rendering, kit: &dyn Kit) -> Result<Picture> {
    let (film, rgb) = (&rendering.film, encoded(scene, &rendering.film, kit));
    let path = root.join(file);
    make_folder_of(&path)?;
    film.write_png_bytes(&path, &rgb).with_context(|| format!("{} cannot be written", path.display()))?;
    let counts = sentence(rendering.primitives, &rendering.counts, rendering.structure.is_some());
    let (lines, notes) = (vec![counts, format!("The picture is kept in {file}.")], rendering.notes.clone());
    Ok(Picture { width: film.width as usize, rgb, lines, notes })
}

/// The colours as they are shown. Without a written `encode_gamma`, a scene with gamma 2 is shown in sRGB.
pub fn encoded(scene: &Scene, film: &Film, kit: &dyn Kit) -> Vec<u8> {
    let toned = film.toned(scene.film.tone);
    let srgb = toned.to_bytes(encode_srgb).rgb;
    if scene.film.encoding == Encoding::Srgb {
        return srgb;
    }
    let components: Vec<f32> = toned.pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
    kit_error::catch(|| kit.encode_gamma(&components)).unwrap_or(srgb)
}

/// What a frame of so many primitives cost, in one sentence.
fn sentence(primitives: u64, counts: &Counts, has_structure: bool) -> String {
    let kinds = [
        ("primary", counts.primary),
        ("shadow", counts.shadow),
        ("reflected", counts.reflection),
        ("refracted", counts.transmission),
        ("indirect", counts.indirect),
    ];
    let rays = kinds.iter().filter(|(_, n)| *n > 0).map(|(kind, n)| format!("{} {kind} rays", Thousands(*n)));
    let mut rays = rays.collect::<Vec<_>>().join(", ");
    if let Some(last) = rays.rfind(", ") {
        rays.replace_range(last..last + 1, " and");
    }
    let per_ray = counts.primitive_tests as f64 / counts.rays().max(1) as f64;
    let saves = has_structure && per_ray < primitives as f64;
    let instead = if saves { format!(" instead of {}", Thousands(primitives)) } else { String::new() };
    format!("{} primitives, {per_ray:.1} primitive tests per ray{instead}: {rays}.", Thousands(primitives))
}

/// What comes after a stage.
pub fn next_step(stage: u8) -> String {
    let Some((next, about)) = rubric::stages().into_iter().find(|(number, _)| *number > stage) else {
        return format!(
            "Stage {stage} is the last stage of the course: it is finished when all stages are done."
        );
    };
    let first = Function::ALL.iter().find(|function| function.stage() == next);
    let begin = first.map_or_else(
        || about.file.clone(),
        |function| format!("`{}` in exercises/src/{}.rs", function.name(), function.file()),
    );
    let word = rubric::course().text("next");
    format!("{word}: stage {next} · {}. Read {}, then write {begin}.", about.title, rubric::deck(next))
}

/// Prints the finish of a stage for a terminal of `columns` columns.
pub fn show(root: &Path, which: Which, stage: u8, columns: usize) -> Result<()> {
    let kit = Source::prepare(root, which, Need::Frames)?.fresh();
    let bar = FrameBar::new(&format!("the picture of stage {stage}"));
    let picture = render(root, stage, &file_of(stage, true), &*kit, &bar);
    bar.finish();
    let picture = picture.with_context(|| format!("stage {stage} is done, but its picture fails"))?;
    println!("\nStage {stage} is done.\n");
    let look = Look::of_environment();
    if look.shows_pictures() {
        for row in cells(&picture.rgb, picture.width, columns.min(MOST_COLUMNS), columns) {
            println!("{}", look.line(&row));
        }
    }
    let notes = picture.notes.iter().map(|note| format!("note: {note}"));
    let lines = picture.lines.iter().cloned().chain(notes).chain([next_step(stage)]);
    lines.flat_map(|line| wrapped(&line, columns)).for_each(|line| println!("{line}"));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn each_stage_leads_to_the_next_and_the_last_one_to_the_end() {
        let stages = rubric::stages();
        for pair in stages.windows(2) {
            let (stage, next) = (pair[0].0, pair[1].0);
            let words = next_step(stage);
            assert!(
                words.starts_with(&format!("Next: stage {next} · {}. Read slides/stage", pair[1].1.title))
            );
            assert!(words.contains(&format!(" in exercises/src/stage{next}_")), "{words}");
        }
        let last = stages.last().expect("a course has stages").0;
        assert!(next_step(last).contains("is the last stage of the course"));
        assert!(next_step(2).ends_with("then write `triangle_bounds` in exercises/src/stage3_boxes.rs."));
    }

    #[test]
    fn the_sentence_has_the_counts_of_its_frame() {
        let counts = Counts { primary: 1200, shadow: 800, primitive_tests: 7000, ..Counts::default() };
        for (has_structure, instead) in [(true, " instead of 352,801"), (false, "")] {
            assert_eq!(
                sentence(352_801, &counts, has_structure),
                format!(
                    "352,801 primitives, 3.5 primitive tests per ray{instead}: 1,200 primary rays and 800 shadow rays."
                )
            );
        }
    }
}
