//! `raykata merge-picture`: puts the pieces of a picture together. The result is equal to the picture that is rendered at once,
//! to the last bit, because each pixel depends on its own samples only.

use crate::args::{Argument, Given, Opt, Spec};
use crate::kits::{Need, Source, root};
use crate::picture_file::{Format, Summary, write_picture};
use crate::piece::{Piece, Settings};
use crate::report::make_folder_of;
use anyhow::{Context, Error, Result, bail};
use raykata::kit::Rendering;
use raykata::rows::Rows;
use raykata::scene::Encoding;
use serde_json::Value;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

/// `raykata merge-picture`.
pub static SPEC: Spec = Spec {
    name: "raykata merge-picture",
    about: "Put together the pieces of a picture that `render --rows` has written.",
    arguments: &[Argument::required("PIECE", "The files of all pieces, in any order.").many()],
    options: &[&[Opt::value("--out", "FILE", "The picture: .png, .hdr or .exr.").short("-o").required()]],
};

/// Merges the pieces, writes the picture, and prints what it cost.
pub fn run(given: &Given) -> Result<ExitCode> {
    given.required(0)?;
    let out = given.required_path("--out")?;
    let format = Format::of(&out)?;
    let read = |file: &OsString| Ok((file.display().to_string(), Piece::read(Path::new(file))?));
    let pieces: Vec<(String, Piece)> = given.arguments(0).iter().map(read).collect::<Result<_>>()?;
    let n_pieces = pieces.len();
    let (settings, rendering) = merge(pieces)?;
    make_folder_of(&out)?;
    // Gamma 2 is an exercise, so the kit that rendered the pieces encodes the picture.
    let kit = if format == Format::Png && settings.film.encoding == Encoding::Gamma2 {
        let which = settings.which().with_context(|| format!("there is no kit `{}`", settings.kit))?;
        Some(Source::prepare(&root()?, which, Need::Frames)?.fresh())
    } else {
        None
    };
    let film = &rendering.film;
    write_picture(film, &out, format, settings.view, &settings.film, kit.as_deref().map(|kit| kit as _))?;
    let size = format!("{} × {} pixels from {n_pieces} pieces", film.width, film.height);
    let Settings { quality, indirect_light, count, .. } = &settings;
    Summary { size, quality, indirect_light: *indirect_light, count: *count }.print(&out, &rendering);
    Ok(ExitCode::SUCCESS)
}

/// The whole picture of these pieces, each with the name of its file, and its settings.
/// An error if they are not of one picture, if one overlaps another, or if rows are missing: it names all of them.
pub fn merge(mut pieces: Vec<(String, Piece)>) -> Result<(Settings, Rendering)> {
    let Some((first_name, first)) = pieces.first() else { bail!("there are no pieces") };
    let settings = first.settings.clone();
    // Compare all pieces with the first one.
    let mut faults: Vec<String> = Vec::new();
    for (name, piece) in &pieces[1..] {
        let differences = differences(first, piece)?;
        if !differences.is_empty() {
            let fault =
                format!("{name} is a piece of another picture than {first_name}: {}", differences.join(", "));
            faults.push(fault);
        }
    }
    if !faults.is_empty() {
        bail!("{}\nhelp: render these pieces again, with the settings of the others", faults.join("\n"));
    }

    // Look for overlaps and gaps from the top.
    pieces.sort_by_key(|(_, piece)| piece.rows);
    let mut next = 0;
    let mut above = "";
    for (name, piece) in &pieces {
        let Rows { start, end } = piece.rows;
        if start < next {
            let both = Rows { start, end: end.min(next) };
            faults.push(format!("rows {both} are in {above} and in {name}: leave one of them out"));
        } else if start > next {
            faults.push(missing(Rows { start: next, end: start }));
        }
        if end > next {
            (next, above) = (end, name);
        }
    }
    let height = settings.film.height;
    if next < height {
        faults.push(missing(Rows { start: next, end: height }));
    }
    if !faults.is_empty() {
        bail!("the pieces do not make a picture\n{}", faults.join("\n"));
    }
    let mut renderings = pieces.into_iter().map(|(_, piece)| piece.rendering);
    let top = renderings.next().context("there are no pieces")?;
    Ok((settings, joined(top, renderings)))
}

fn missing(rows: Rows) -> String {
    format!("rows {rows} are missing: render them by `raykata render SCENE --rows {rows}`")
}

/// The picture whose upper rows are `whole`, with those of the other pieces below.
fn joined(mut whole: Rendering, others: impl Iterator<Item = Rendering>) -> Rendering {
    for piece in others {
        whole.film.height += piece.film.height;
        whole.film.pixels.extend(piece.film.pixels);
        whole.counts += piece.counts;
        whole.build_seconds += piece.build_seconds;
        whole.render_seconds += piece.render_seconds;
    }
    whole
}

/// What differs between the settings of two pieces, and what else must be equal in all pieces of a picture.
fn differences(first: &Piece, piece: &Piece) -> Result<Vec<String>> {
    let [ours, theirs] = [first, piece].map(|piece| {
        let Rendering { primitives, accelerator, structure, bytes_of_parts, notes, .. } = &piece.rendering;
        let structure = serde_json::to_value((primitives, accelerator, structure, bytes_of_parts))?;
        // A half-written kit leaves out a function that only some of the rows reach.
        Ok::<_, Error>([serde_json::to_value(&piece.settings)?, structure, notes.join("; ").into()])
    });
    let mut found = Vec::new();
    for (name, (ours, theirs)) in ["", "structure", "notes"].into_iter().zip(ours?.iter().zip(&theirs?)) {
        compare(name, ours, theirs, &mut found);
    }
    Ok(found)
}

/// Describes each number and word of `theirs` that differs from the one at the same place in `ours`. `name` leads to both.
fn compare(name: &str, ours: &Value, theirs: &Value, found: &mut Vec<String>) {
    match theirs {
        Value::Object(fields) => {
            for (key, value) in fields {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                compare(&name, &ours[key], value, found);
            }
        }
        _ if ours == theirs => {}
        _ => found.push(match name {
            "scene" => "another scene".to_owned(),
            "code" => "other source code".to_owned(),
            "structure" => "another structure".to_owned(),
            _ => format!("{name} {theirs} instead of {ours}"),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use raykata::count::Counts;
    use raykata::film::Film;
    use raykata::kit::View;
    use raykata::scene::{FilmSettings, Quality};

    /// A piece of a picture with 2 columns and 40 rows, in which no two pixels are equal.
    fn piece(name: &str, start: u32, end: u32) -> (String, Piece) {
        let (width, height) = (2, 40);
        let settings = Settings {
            scene: "s".into(),
            code: "c".into(),
            kit: "solutions".into(),
            view: View::Shaded,
            seed: 1,
            count: true,
            indirect_light: false,
            film: FilmSettings { width, height, ..FilmSettings::default() },
            quality: Quality::default(),
        };
        let pixels = (2 * start..2 * end).map(|index| Vec3::new(index as f32, f32::INFINITY, -0.1));
        let rendering = Rendering {
            film: Film { width, height: end - start, pixels: pixels.collect() },
            counts: Counts { primary: u64::from(2 * (end - start)), ..Counts::default() },
            primitives: 1,
            accelerator: None,
            structure: None,
            bytes_of_parts: 0,
            build_seconds: 0.0,
            render_seconds: 0.0,
            processor_seconds: None,
            notes: Vec::new(),
        };
        (name.to_owned(), Piece { settings, rows: Rows { start, end }, rendering })
    }

    fn refused(pieces: Vec<(String, Piece)>) -> String {
        merge(pieces).unwrap_err().to_string()
    }

    #[test]
    fn pieces_in_any_order_make_the_picture() {
        let whole = merge(vec![piece("all", 0, 40)]).unwrap();
        let merged = merge(vec![piece("b", 16, 32), piece("c", 32, 40), piece("a", 0, 16)]).unwrap();
        assert_eq!(merged, whole);
        assert_eq!((whole.1.film.pixels.len(), whole.1.counts.primary), (80, 80));
    }

    #[test]
    fn gaps_and_overlaps_are_all_named() {
        let error = refused(vec![piece("a", 16, 32)]);
        assert!(
            error.contains("rows 0..16 are missing: render them by `raykata render SCENE --rows 0..16`"),
            "{error}"
        );
        assert!(error.contains("rows 32..40 are missing"), "{error}");
        let error = refused(vec![piece("a", 0, 32), piece("b", 16, 40), piece("c", 32, 40)]);
        assert!(error.contains("rows 16..32 are in a and in b"), "{error}");
        assert!(error.contains("rows 32..40 are in b and in c") && !error.contains("missing"), "{error}");
        assert!(refused(Vec::new()).contains("no pieces"));
    }

    #[test]
    fn pieces_of_other_pictures_are_named_with_what_differs() {
        let change = |change: &dyn Fn(&mut Piece)| {
            let (name, mut other) = piece("b", 16, 40);
            change(&mut other);
            refused(vec![piece("a", 0, 16), (name, other)])
        };
        let other = "b is a piece of another picture than a: ";
        for (error, words) in [
            (change(&|piece| piece.settings.seed = 2), "seed 2 instead of 1"),
            (change(&|piece| piece.settings.scene = "t".into()), "another scene"),
            (change(&|piece| piece.settings.code = "d".into()), "other source code"),
            (change(&|piece| piece.settings.film.width = 3), "film.width 3 instead of 2"),
            (change(&|piece| piece.settings.quality.max_depth = 9), "quality.max_depth 9 instead of 5"),
            (
                change(&|piece| piece.rendering.notes.push("no hits".into())),
                "notes \"no hits\" instead of \"\"",
            ),
            (change(&|piece| piece.rendering.primitives = 7), "another structure"),
        ] {
            assert!(error.contains(&format!("{other}{words}")), "{error}");
        }
    }

    #[test]
    fn a_piece_comes_back_from_its_file_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(Piece::file_name("scene", Rows { start: 16, end: 40 }));
        assert!(file.ends_with("scene.16-40.piece"));
        let (_, mut whole) = piece("a", 16, 40);
        whole.rendering.film.pixels[3] = Vec3::new(1.0 / 3.0, f32::NAN, -0.0);
        whole.write(&file).unwrap();
        let bits = |piece: &Piece| -> Vec<[u32; 3]> {
            piece.rendering.film.pixels.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect()
        };
        let back = Piece::read(&file).unwrap();
        assert_eq!(bits(&back), bits(&whole));
        assert_eq!((&back.settings, back.rows), (&whole.settings, whole.rows));
        // A file that was not copied completely, and one that is something else.
        let bytes = std::fs::read(&file).unwrap();
        for (end, words) in [(bytes.len() - 1, "incomplete: render rows 16..40 again"), (9, "not a piece")] {
            std::fs::write(&file, &bytes[..end]).unwrap();
            let error = format!("{:#}", Piece::read(&file).unwrap_err());
            assert!(error.contains(words), "{error}");
        }
    }
}
