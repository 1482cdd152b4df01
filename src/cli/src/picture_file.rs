//! Pictures in files: their formats, how they are written, and what is printed about them.

use crate::args::wrapped;
use crate::piece;
use crate::report::{Bytes, Thousands};
use anyhow::{Context, Result, anyhow, bail, ensure};
use raykata::film::Film;
use raykata::kit::{Kit, Rendering, View, kit_error};
use raykata::scene::{Encoding, FilmSettings, Quality};
use std::path::Path;

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
    pub(crate) fn of_piece(file: &Path) -> Result<Format> {
        let is_piece = file.extension().is_some_and(|ending| ending == piece::ENDING);
        ensure!(is_piece, "{}: with --rows the file must end in .{}", file.display(), piece::ENDING);
        Ok(Format::Piece)
    }
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
        Encoding::Srgb => film.write_png_bytes(out, &film.dithered_srgb())?,
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
            // Each number with the condition under which it says something.
            let has_offset = quality.ray_offset > 0.0;
            let numbers = [
                ("primary rays", counts.primary, true),
                ("shadow rays", counts.shadow, true),
                ("reflected rays", counts.reflection, true),
                ("refracted rays", counts.transmission, true),
                ("indirect rays", counts.indirect, *indirect_light),
                ("absorbed paths", counts.absorbed, *indirect_light),
                ("hits", counts.hits, true),
                ("random numbers", counts.random_numbers, true),
                ("image reads", counts.texture_reads, true),
                ("node visits", counts.node_visits, true),
                ("box tests", counts.box_tests, true),
                ("primitive tests", counts.primitive_tests, true),
                ("shadow acne", counts.shadow_acne, has_offset),
                ("light leaks", counts.light_leaks, has_offset),
            ];
            for (name, number, _) in numbers.into_iter().filter(|(.., is_shown)| *is_shown) {
                println!("  {name:<15}  {}", Thousands(number));
            }
            let rays = counts.rays().max(1) as f64;
            println!(
                "  exact tests      {} ({:.3} per ray)",
                Thousands(counts.exact_tests),
                counts.exact_tests as f64 / rays
            );
            println!(
                "  per ray          {:.1} box tests, {:.1} primitive tests, {:.0} ns (all threads)",
                counts.box_tests as f64 / rays,
                counts.primitive_tests as f64 / rays,
                1e9 * rendering.render_seconds / rays
            );
        }
        for note in &rendering.notes {
            println!("  {:<15}  {}", "note", wrapped(note, 19));
        }
        for (n, words) in [
            (film.not_a_number(), "NaN; they are magenta"),
            (film.infinite(), "infinite; they are as bright as the file format allows"),
        ] {
            if n > 0 {
                println!("  warning          {} pixels are {words}", Thousands(n as u64));
            }
        }
    }
}
