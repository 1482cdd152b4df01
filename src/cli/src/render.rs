//! `raykata render`: renders a scene to a picture, or some rows of it to a piece that `raykata merge-picture` takes.

use crate::args::{Argument, Given, Opt, Spec};
use crate::kits::{Choice, Need, Source, root};
use crate::lock::Lock;
use crate::merge_picture;
use crate::picture_file::{Format, Summary, write_picture};
use crate::piece::{self, Piece, Settings};
use crate::quality_options::{QualityOptions, THREADS, ToneOptions, threads};
use crate::report::{FrameBar, counted, make_folder, make_folder_of, name_of};
use anyhow::{Context, Result, anyhow};
use raykata::kit::{Kit, RenderJob, Rendering, View, kit_error};
use raykata::rows::Rows;
use std::path::Path;
use std::process::ExitCode;

/// `raykata render`.
pub static SPEC: Spec = Spec {
    name: "raykata render",
    about: "Render a scene to a picture.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[Opt::value("--out", "FILE", "The picture: .png, .hdr or .exr [default: out/NAME.png].")
            .short("-o")],
        Choice::OPTIONS,
        THREADS,
        &[
            Opt::value(
                "--rows",
                "A..B",
                "Render only the rows from A up to, but without, B, counted from 0 at the top. They are written to a .piece file \
                 with all digits, and `raykata merge-picture` puts the pieces together. A and B are multiples of 16, or B is the \
                 number of rows [default file: out/NAME.A-B.piece].",
            ),
            Opt::value(
                "--pieces",
                "N",
                "Render the picture in N pieces, and keep the finished ones in a folder beside it, so that a run that is stopped \
                 continues where it was. The picture is the same.",
            ),
            Opt::value("--seed", "N", "Seed of the random numbers [default: 0]."),
            Opt::flag("--normals", "Show normals instead of light."),
            Opt::flag("--no-counts", "Do not count rays and tests; a little faster."),
        ],
        QualityOptions::OPTIONS,
        ToneOptions::OPTIONS,
    ],
};

/// Renders the picture and prints what it cost.
pub fn run(given: &Given) -> Result<ExitCode> {
    // Read the command line and the scene.
    given.exclude("--rows", "--pieces")?;
    let scene_file = Path::new(given.required(0)?);
    let (kit, threads) = (Choice::read(given)?, threads(given)?);
    let rows: Option<Rows> = given.parsed("--rows", str::parse)?;
    let pieces: Option<u32> = given.number("--pieces", 1..=u32::MAX)?;
    let seed = given.number("--seed", 0..=u64::MAX)?.unwrap_or(0);
    let (quality, tone) = (QualityOptions::read(given)?, ToneOptions::read(given)?);
    let mut scene = quality.load(scene_file)?;
    tone.apply(&mut scene);
    if let Some(rows) = rows {
        rows.check(scene.film.height).map_err(|why| anyhow!("`--rows {rows}`: {why}"))?;
        scene.film.rows = Some(rows);
    }
    let name = name_of(scene_file)?;
    let out = match (given.path("--out"), rows) {
        (Some(out), _) => out,
        (None, Some(rows)) => Path::new("out").join(Piece::file_name(&name, rows)),
        (None, None) => Path::new("out").join(name).with_extension("png"),
    };
    let format = if rows.is_some() { Format::of_piece(&out)? } else { Format::of(&out)? };
    make_folder_of(&out)?;

    // Build the kit.
    let root = root()?;
    let source = Source::prepare(&root, kit.or_reference(&root), Need::Frames)?;
    let kit = source.fresh();
    // Render the picture.
    let view = if given.has("--normals") { View::Normals } else { View::Shaded };
    // A structure that was built for one piece is used for the next.
    let (count, reuse) = (!given.has("--no-counts"), pieces.is_some());
    let job = RenderJob { scene, view, seed, threads, count, reuse };
    let rendering = match pieces {
        Some(n) => in_pieces(&*kit, &job, &Settings::new(&job, source.which, &root)?, &out, n)?,
        None => rendered(&*kit, &job, "")?,
    };

    // Write the file, and print what the picture cost.
    let samples = counted(job.scene.quality.samples_per_pixel, "sample");
    let (quality, indirect_light) = (&job.scene.quality, job.scene.indirect_light);
    let (width, height) = (rendering.film.width, job.scene.film.height);
    let size = match rows {
        Some(rows) => format!("rows {rows} of {width} × {height} pixels, {samples} per pixel"),
        None => format!("{width} × {height} pixels, {samples} per pixel"),
    };
    let rendering = if let Some(rows) = rows {
        let piece = Piece { settings: Settings::new(&job, source.which, &root)?, rows, rendering };
        piece.write(&out).with_context(|| format!("cannot write {}", out.display()))?;
        piece.rendering
    } else {
        write_picture(&rendering.film, &out, format, view, &job.scene.film, Some(&*kit))?;
        rendering
    };
    Summary { size, quality, indirect_light, count }.print(&out, &rendering);
    Ok(ExitCode::SUCCESS)
}

fn rendered(kit: &dyn Kit, job: &RenderJob, what: &str) -> Result<Rendering> {
    let bar = FrameBar::new(what);
    let rendering = kit_error::catch(|| kit.render(job, &bar))?.context("the frame was cancelled")?;
    bar.finish();
    Ok(rendering)
}

/// Renders the picture in pieces, and keeps them beside `out` until all are finished. Pieces of an earlier run with the same
/// settings are not rendered again. A piece that cannot be used is.
fn in_pieces(kit: &dyn Kit, job: &RenderJob, settings: &Settings, out: &Path, n: u32) -> Result<Rendering> {
    let folder = out.with_extension("pieces");
    let _lock = Lock::on(&folder)?;
    make_folder(&folder)?;
    let all = Rows::divide(job.scene.film.height, n);
    let mut pieces = Vec::new();
    let mut n_kept = 0;
    for (number, rows) in (1..).zip(&all) {
        let file = folder.join(format!("{}-{}.{}", rows.start, rows.end, piece::ENDING));
        let known =
            Piece::read(&file).ok().filter(|piece| piece.settings == *settings && piece.rows == *rows);
        let piece = match known {
            Some(piece) => {
                n_kept += 1;
                piece
            }
            None => {
                let mut job = job.clone();
                job.scene.film.rows = Some(*rows);
                let rendering = rendered(kit, &job, &format!("piece {number} of {}", all.len()))?;
                let piece = Piece { settings: settings.clone(), rows: *rows, rendering };
                piece.write(&file).with_context(|| {
                    format!(
                        "cannot write {}: the pieces before it are kept, and the next run continues there",
                        file.display()
                    )
                })?;
                piece
            }
        };
        pieces.push((file.display().to_string(), piece));
    }
    if n_kept > 0 {
        println!("continued: {n_kept} of {} pieces were rendered before", all.len());
    }
    let (_, rendering) = merge_picture::merge(pieces)?;
    std::fs::remove_dir_all(&folder).with_context(|| format!("cannot delete {}", folder.display()))?;
    Ok(rendering)
}
