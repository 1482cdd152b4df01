//! A piece of a picture in a file: some of its rows, the settings that the whole picture was rendered with, and what the piece
//! cost. `raykata render --rows` writes it, and `raykata merge-picture` puts pieces together.
//!
//! The file has a line that says what it is, a line of JSON, and the components of all pixels as little-endian numbers of four
//! bytes, row by row from the top. So the numbers of a picture stay the same to the last bit, NaN included.

use crate::fingerprint;
use crate::kits::Which;
use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;
use raykata::film::write_atomically;
use raykata::kit::{RenderJob, Rendering, View};
use raykata::rows::Rows;
use raykata::scene::{FilmSettings, Quality};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The first line of the file.
const FIRST_LINE: &[u8] = b"raykata piece 1\n";

/// The ending of the names of such files.
pub const ENDING: &str = "piece";

/// Everything that decides the pixels and counts of a picture. The number of threads does not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// A fingerprint of the scene without film and quality.
    pub scene: String,
    /// A fingerprint of the source code that rendered it.
    pub code: String,
    /// The kit that rendered it, by the name of its package.
    pub kit: String,
    /// What the pixels show.
    pub view: View,
    /// The seed of the random numbers.
    pub seed: u64,
    /// Whether work was counted.
    pub count: bool,
    /// Whether the scene asks for indirect light.
    pub indirect_light: bool,
    /// The film of the whole picture.
    pub film: FilmSettings,
    /// Sampling, accuracy and acceleration structure.
    pub quality: Quality,
}

impl Settings {
    /// The settings of a job that the kit `which` in the folder `root` renders.
    pub fn new(job: &RenderJob, which: Which, root: &Path) -> Result<Settings> {
        let scene = &job.scene;
        let film = FilmSettings { rows: None, ..scene.film };
        Ok(Settings {
            scene: fingerprint::of_scene(scene),
            code: code(root, which)?,
            kit: which.package().to_owned(),
            view: job.view,
            seed: job.seed,
            count: job.count,
            indirect_light: scene.indirect_light,
            film,
            quality: scene.quality,
        })
    }

    /// The kit that rendered the picture; `None` if this version has no such kit.
    pub fn which(&self) -> Option<Which> {
        Which::NAMES.into_iter().map(|(_, which)| which).find(|which| which.package() == self.kit)
    }
}

/// A fingerprint of the source code of the renderer and of the kit. Pictures do not depend on the machine that builds it.
fn code(root: &Path, which: Which) -> Result<String> {
    let mut files = vec![root.join("Cargo.lock")];
    let mut folders = vec![root.join("src"), root.join(which.package()).join("src")];
    while let Some(folder) = folders.pop() {
        let entries =
            std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
        for entry in entries {
            let path = entry?.path();
            // The programs around the renderer change no pixel.
            if path.is_dir() && !path.join("Cargo.toml").exists() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    fingerprint::of_files(files)
}

/// Some rows of a picture. The second line of the file is a piece whose film has no pixels; they follow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// The settings of the whole picture.
    pub settings: Settings,
    /// The rows that the piece has.
    pub rows: Rows,
    /// The pixels of these rows, and their cost.
    pub rendering: Rendering,
}

impl Piece {
    /// The name of the file for these rows of a picture that is called `name`.
    pub fn file_name(name: &str, rows: Rows) -> PathBuf {
        PathBuf::from(format!("{name}.{}-{}.{ENDING}", rows.start, rows.end))
    }

    /// Writes the file; it is complete or absent.
    pub fn write(&self, file: &Path) -> Result<()> {
        let mut head = self.clone();
        let pixels = std::mem::take(&mut head.rendering.film.pixels);
        let head = serde_json::to_string(&head).context("the settings cannot be written as JSON")?;
        write_atomically(file, |out| {
            out.write_all(FIRST_LINE)?;
            writeln!(out, "{head}")?;
            let mut components = pixels.iter().flat_map(|pixel| pixel.to_array());
            components.try_for_each(|component| out.write_all(&component.to_le_bytes()))
        })?;
        Ok(())
    }

    /// Reads the file, and makes sure that it is complete.
    pub fn read(file: &Path) -> Result<Piece> {
        let bytes = std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        let Some(rest) = bytes.strip_prefix(FIRST_LINE) else {
            bail!(
                "{} is not a piece of a picture: `raykata render --rows` writes such files",
                file.display()
            );
        };
        let end = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
        let (head, numbers) = rest.split_at(end);
        let head = serde_json::from_slice(head);
        let mut piece: Piece =
            head.with_context(|| format!("{} is from another version: render it again", file.display()))?;
        let (rows, whole, film) = (piece.rows, &piece.settings.film, &mut piece.rendering.film);
        let fits =
            rows.check(whole.height).is_ok() && (film.width, film.height) == (whole.width, rows.n_rows());
        let (components, more) = numbers.get(1..).unwrap_or_default().as_chunks::<4>();
        let n_components = 3 * u64::from(film.width) * u64::from(film.height);
        ensure!(
            fits && more.is_empty() && components.len() as u64 == n_components,
            "{} is incomplete: render rows {rows} again",
            file.display()
        );
        let components: Vec<f32> = components.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        film.pixels = components.as_chunks::<3>().0.iter().map(|pixel| Vec3::from_array(*pixel)).collect();
        Ok(piece)
    }
}
