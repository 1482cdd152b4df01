//! The measured pictures of a run that was stopped. They lie beside the report until it is written, so that the next run with the
//! same code measures only the others. Times of both runs count: measure on an idle machine in both.

use crate::fingerprint::{self, fingerprint};
use crate::journal::Journal;
use crate::queue::lock;
use anyhow::{Context, Result};
use glam::Vec3;
use raykata::film::Film;
use raykata::kit::{RenderJob, Rendering};
use raykata::scene::Scene;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Mutex;

/// A picture as it is kept. JSON has no NaN, so the numbers of the pixels are written as bits.
#[derive(Serialize, Deserialize)]
struct Picture {
    /// The rendering without its pixels.
    rendering: Rendering,
    pixels: Vec<[u32; 3]>,
}

/// The kept pictures.
pub struct KeptPictures {
    journal: Mutex<Journal<Picture>>,
    /// The scene of the last job, and its fingerprint. Most jobs of a run have the same scene with other settings, and the
    /// fingerprint of a large one takes longer than a picture.
    scene: Mutex<Option<(Scene, String)>>,
}

impl KeptPictures {
    /// Opens the file in the folder of a report. Pictures of other code are forgotten.
    pub fn open(out: &Path, code: &str) -> Result<KeptPictures> {
        let file = out.join("unfinished.jsonl");
        let about = format!("pictures by the program {code}");
        let journal: Journal<Picture> = Journal::open(&file, &about)?;
        let (n_kept, place) = (journal.kept().count(), file.display());
        if n_kept > 0 {
            println!("continues a run that was stopped: {n_kept} measured pictures are in {place}");
        }
        Ok(KeptPictures { journal: Mutex::new(journal), scene: Mutex::default() })
    }

    /// A name for a job: jobs that differ in anything have different names, and so have those of the kit and of the reference.
    pub fn name(&self, job: &RenderJob, is_reference: bool) -> Result<String> {
        let RenderJob { scene, view, seed, threads, count, reuse } = job;
        let settings = (scene.film, &scene.quality, view, seed, threads, count, reuse, is_reference);
        let settings = serde_json::to_vec(&settings).context("the settings cannot be serialised")?;
        Ok(fingerprint([self.fingerprint_of(scene).as_bytes(), &settings]))
    }

    /// The fingerprint of a scene without its film and quality.
    fn fingerprint_of(&self, scene: &Scene) -> String {
        let mut last = lock(&self.scene);
        let is_same = |(known, _): &&(Scene, String)| {
            Scene { film: known.film, quality: known.quality, ..scene.clone() } == *known
        };
        if let Some((_, name)) = last.as_ref().filter(is_same) {
            return name.clone();
        }
        let name = fingerprint::of_scene(scene);
        *last = Some((scene.clone(), name.clone()));
        name
    }

    /// Takes a picture of the stopped run. Each is taken once: a job that is measured twice has two.
    pub fn take(&self, name: &str) -> Option<Rendering> {
        let Picture { mut rendering, pixels } = lock(&self.journal).take(name)?;
        rendering.film.pixels =
            pixels.into_iter().map(|pixel| Vec3::from_array(pixel.map(f32::from_bits))).collect();
        Some(rendering)
    }

    /// Keeps a picture.
    pub fn add(&self, name: &str, frame: &Rendering) -> Result<()> {
        let Film { width, height, .. } = frame.film;
        let rendering = Rendering { film: Film { width, height, pixels: Vec::new() }, ..frame.clone() };
        let pixels = frame.film.pixels.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect();
        lock(&self.journal).add(name, &Picture { rendering, pixels })
    }

    /// Deletes the file, because the report is written.
    pub fn finish(&self) -> Result<()> {
        lock(&self.journal).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_come_back_to_the_last_bit_once_each() {
        let folder = tempfile::tempdir().unwrap();
        let film = Film { width: 1, height: 2, pixels: vec![Vec3::new(0.1, -0.0, f32::INFINITY), Vec3::NAN] };
        let frame = Rendering {
            film,
            counts: Default::default(),
            primitives: 3,
            accelerator: None,
            structure: None,
            bytes_of_parts: 0,
            build_seconds: 0.25,
            render_seconds: 1.0 / 3.0,
            processor_seconds: None,
            notes: vec!["x".into()],
        };
        let kept = KeptPictures::open(folder.path(), "a").unwrap();
        kept.add("one", &frame).unwrap();
        assert!(kept.take("one").is_none(), "only pictures of an earlier run are taken");
        drop(kept);
        let kept = KeptPictures::open(folder.path(), "a").unwrap();
        let back = kept.take("one").unwrap();
        let bits = |film: &Film| -> Vec<[u32; 3]> {
            film.pixels.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect()
        };
        assert_eq!(bits(&back.film), bits(&frame.film));
        assert_eq!((back.render_seconds, back.notes), (frame.render_seconds, frame.notes));
        assert!(kept.take("one").is_none());
        drop(kept);
        assert!(KeptPictures::open(folder.path(), "other code").unwrap().take("one").is_none());
    }
}
