//! `raykata render`: renders a scene to a picture, or some rows of it to a piece that `raykata merge-picture` takes.

use crate::args::{Argument, Given, Misuse, Opt, Spec};
use crate::kits::{Choice, Need, Source, root};
use crate::lock::Lock;
use crate::merge_picture;
use crate::piece::{self, Piece, Settings};
use crate::quality_options::{QualityOptions, Threads, ToneOptions};
use crate::report::{Bytes, FrameBar, Thousands, load_scene, make_folder, make_folder_of};
use anyhow::{Context, Result, anyhow, bail, ensure};
use raykata::film::{Film, encode_srgb};
use raykata::kit::{Kit, RenderJob, Rendering, View, kit_error};
use raykata::rows::Rows;
use raykata::scene::{Encoding, FilmSettings, Quality};
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

/// The file format of a picture.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    Hdr,
    Exr,
    /// Some rows of a picture, for `raykata merge-picture`.
    Piece,
}

impl Format {
    /// The format of a whole picture, by the name of its file.
    pub(crate) fn of(file: &Path) -> Result<Format> {
        let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "png" => Ok(Format::Png),
            "hdr" => Ok(Format::Hdr),
            "exr" if cfg!(feature = "exr") => Ok(Format::Exr),
            "exr" => bail!(
                "this program was built without OpenEXR; `cargo run --features exr -- render …` builds it with OpenEXR"
            ),
            piece::ENDING => {
                bail!("{}: a piece has some rows of a picture: give them by --rows", file.display())
            }
            _ => bail!("the format of {} is unknown: let it end in .png, .hdr or .exr", file.display()),
        }
    }

    /// The format of some rows of a picture.
    fn of_piece(file: &Path) -> Result<Format> {
        let is_piece = file.extension().is_some_and(|ending| ending == piece::ENDING);
        ensure!(is_piece, "{}: with --rows the file must end in .{}", file.display(), piece::ENDING);
        Ok(Format::Piece)
    }

    /// Whether the components of the file are bytes.
    pub(crate) fn is_8_bit(self) -> bool {
        self == Format::Png
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

/// Writes a whole picture. A PNG file with gamma 2 needs the kit.
pub(crate) fn write_picture(
    picture: &Film,
    out: &Path,
    format: Format,
    view: View,
    film: &FilmSettings,
    kit: Option<&dyn Kit>,
) -> Result<()> {
    let write = match format {
        // Normals are no light, so they have no exposure.
        Format::Png if view == View::Normals => write_png(picture, out, film.encoding, kit),
        Format::Png => write_png(&picture.toned(film.tone), out, film.encoding, kit),
        Format::Hdr => picture.write_hdr(out).map_err(Into::into),
        Format::Exr => write_exr(picture, out),
        Format::Piece => Err(anyhow!("it is not a whole picture")),
    };
    write.with_context(|| format!("cannot write {}", out.display()))
}

/// Writes a PNG file. The kit that rendered the picture encodes it, because gamma 2 is an exercise.
pub(crate) fn write_png(film: &Film, out: &Path, encoding: Encoding, kit: Option<&dyn Kit>) -> Result<()> {
    match encoding {
        Encoding::Srgb => film.write_png(out, encode_srgb)?,
        Encoding::Gamma2 => {
            let kit = kit.context("gamma 2 needs a kit")?;
            let components: Vec<f32> = film.pixels.iter().flat_map(|pixel| pixel.to_array()).collect();
            let bytes = kit_error::catch(|| kit.encode_gamma(&components))?;
            film.write_png_bytes(out, &bytes)?;
        }
    }
    Ok(())
}

#[cfg(not(feature = "exr"))]
fn write_exr(_: &Film, _: &Path) -> Result<()> {
    bail!("this program was built without OpenEXR")
}

#[cfg(feature = "exr")]
fn write_exr(film: &Film, out: &Path) -> Result<()> {
    use exr::prelude::{SpecificChannels, WritableImage};
    let channels = SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
        let pixel = film.at(at.x() as u32, at.y() as u32);
        (pixel.x, pixel.y, pixel.z)
    });
    let picture = exr::prelude::Image::from_channels((film.width as usize, film.height as usize), channels);
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write().to_buffered(&mut bytes)?;
    raykata::film::write_atomically(out, |file| std::io::Write::write_all(file, bytes.get_ref()))?;
    Ok(())
}

/// What is printed about a picture besides its rendering.
pub(crate) struct Summary<'a> {
    /// The size of the picture, for the first line.
    pub(crate) size: String,
    pub(crate) quality: &'a Quality,
    pub(crate) indirect_light: bool,
    /// Whether work was counted.
    pub(crate) count: bool,
}

impl Summary<'_> {
    /// Prints the name of the file, the size of the picture, and what it cost.
    pub(crate) fn print(&self, out: &Path, rendering: &Rendering) {
        let Summary { size, quality, indirect_light, count } = self;
        let Rendering { film, counts, .. } = rendering;
        println!("{}  {size}", out.display());
        println!("  primitives       {}", Thousands(rendering.primitives));
        if let Some(size) = rendering.structure {
            let used = rendering.accelerator.unwrap_or(quality.accelerator);
            let how = match used {
                one if one.is_hierarchy() => {
                    format!(", {:?}, leaves of {} or fewer", quality.split, quality.leaf_size)
                }
                _ => format!(", {} references", Thousands(size.references)),
            };
            println!(
                "  {:<16} {} nodes, {} levels{how}, {}",
                used.name().replace('_', " "),
                Thousands(size.nodes),
                size.levels,
                Bytes(size.bytes)
            );
        }
        if rendering.bytes_of_parts > 0 {
            println!("  shared meshes    {}", Bytes(rendering.bytes_of_parts));
        }
        println!("  build            {:.3} s", rendering.build_seconds);
        println!("  render           {:.3} s", rendering.render_seconds);
        if *count {
            println!("  primary rays     {}", Thousands(counts.primary));
            println!("  shadow rays      {}", Thousands(counts.shadow));
            println!("  reflected rays   {}", Thousands(counts.reflection));
            println!("  refracted rays   {}", Thousands(counts.transmission));
            if *indirect_light {
                println!("  indirect rays    {}", Thousands(counts.indirect));
                println!("  absorbed paths   {}", Thousands(counts.absorbed));
            }
            println!("  hits             {}", Thousands(counts.hits));
            println!("  random numbers   {}", Thousands(counts.random_numbers));
            println!("  image reads      {}", Thousands(counts.texture_reads));
            println!("  node visits      {}", Thousands(counts.node_visits));
            println!("  box tests        {}", Thousands(counts.box_tests));
            println!("  primitive tests  {}", Thousands(counts.primitive_tests));
            let rays = counts.rays().max(1) as f64;
            println!(
                "  per ray          {:.1} box tests, {:.1} primitive tests, {:.0} ns (all threads)",
                counts.box_tests as f64 / rays,
                counts.primitive_tests as f64 / rays,
                1e9 * rendering.render_seconds / rays
            );
        }
        for note in &rendering.notes {
            for (line, words) in crate::list::lines(note, 80 - 19).into_iter().enumerate() {
                println!("  {:<15}  {words}", if line == 0 { "note" } else { "" });
            }
        }
        match film.not_a_number() {
            0 => {}
            n => println!("  warning          {} pixels are NaN; they are magenta", Thousands(n as u64)),
        }
        match film.infinite() {
            0 => {}
            n => println!(
                "  warning          {} pixels are infinite; they are as bright as the file format allows",
                Thousands(n as u64)
            ),
        }
    }
}
