//! `raykata render`: renders a scene to a picture, or some rows of it to a piece that `raykata merge-picture` takes.

use crate::args::{Argument, Given, Misuse, Opt, Spec};
use crate::kits::{Choice, Need, Source, root};
use crate::lock::Lock;
use crate::merge_picture;
use crate::picture_file::{Format, Summary, write_picture};
use crate::piece::{self, Piece, Settings};
use crate::quality_options::{QualityOptions, Threads, ToneOptions};
use crate::report::{FrameBar, load_scene, make_folder, make_folder_of};
use anyhow::{Context, Result, anyhow};
use raykata::kit::{Kit, RenderJob, Rendering, View, kit_error};
use raykata::rows::Rows;
use std::path::{Path, PathBuf};

/// `raykata render`.
pub static SPEC: Spec = Spec {
    name: "raykata render",
    about: "Render a scene to a picture.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[Opt::value("--out", "FILE", "The picture: .png, .hdr or .exr [default: out/NAME.png].")
            .short("-o")],
        Choice::OPTIONS,
        Threads::OPTIONS,
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

/// The scene, and how to render it.
pub struct Options {
    scene: PathBuf,
    out: Option<PathBuf>,
    kit: Choice,
    threads: Threads,
    rows: Option<Rows>,
    pieces: Option<u32>,
    seed: u64,
    quality: QualityOptions,
    tone: ToneOptions,
    normals: bool,
    no_counts: bool,
}

impl Options {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--rows", "--pieces")?;
        Ok(Options {
            scene: given.required(0)?.into(),
            out: given.path("--out"),
            kit: Choice::read(given)?,
            threads: Threads::read(given)?,
            rows: given.parsed("--rows", str::parse)?,
            pieces: given.number("--pieces", 1..=u32::MAX)?,
            seed: given.number("--seed", 0..=u64::MAX)?.unwrap_or(0),
            quality: QualityOptions::read(given)?,
            tone: ToneOptions::read(given)?,
            normals: given.has("--normals"),
            no_counts: given.has("--no-counts"),
        })
    }
}

/// Renders the picture and prints what it cost.
pub fn run(options: &Options) -> Result<()> {
    let mut scene = load_scene(&options.scene, options.quality.limits())?;
    options.quality.apply(&mut scene)?;
    options.tone.apply(&mut scene);
    let height = scene.film.height;
    if let Some(rows) = options.rows {
        rows.check(height).map_err(|why| anyhow!("`--rows {rows}`: {why}"))?;
        scene.film.rows = Some(rows);
    }
    let name = options.scene.file_stem().context("the scene has no name")?;
    let out = match (&options.out, options.rows) {
        (Some(out), _) => out.clone(),
        (None, Some(rows)) => Path::new("out").join(Piece::file_name(&name.to_string_lossy(), rows)),
        (None, None) => Path::new("out").join(name).with_extension("png"),
    };
    let format = if options.rows.is_some() { Format::of_piece(&out)? } else { Format::of(&out)? };
    make_folder_of(&out)?;

    // Build the kit.
    let root = root()?;
    let source = Source::prepare(&root, options.kit.or_reference(&root), Need::Frames)?;
    let kit = source.fresh();
    // Render the picture.
    let view = if options.normals { View::Normals } else { View::Shaded };
    let job = RenderJob {
        scene,
        view,
        seed: options.seed,
        threads: options.threads.count(),
        count: !options.no_counts,
        // A structure that was built for one piece is used for the next.
        reuse: options.pieces.is_some(),
    };
    let rendering = match options.pieces {
        Some(n) => in_pieces(&*kit, &job, &Settings::new(&job, source.which, &root)?, &out, n)?,
        None => rendered(&*kit, &job, "")?,
    };

    // Write the file, and print what the picture cost.
    let samples = match job.scene.quality.samples_per_pixel {
        1 => "1 sample per pixel".to_owned(),
        n => format!("{n} samples per pixel"),
    };
    let (quality, indirect_light, count) = (&job.scene.quality, job.scene.indirect_light, job.count);
    let width = rendering.film.width;
    let size = match options.rows {
        Some(rows) => format!("rows {rows} of {width} × {height} pixels, {samples}"),
        None => format!("{width} × {height} pixels, {samples}"),
    };
    let rendering = if let Some(rows) = options.rows {
        let piece = Piece { settings: Settings::new(&job, source.which, &root)?, rows, rendering };
        piece.write(&out).with_context(|| format!("cannot write {}", out.display()))?;
        piece.rendering
    } else {
        write_picture(&rendering.film, &out, format, view, &job.scene.film, Some(&*kit))?;
        rendering
    };
    Summary { size, quality, indirect_light, count }.print(&out, &rendering);
    Ok(())
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
