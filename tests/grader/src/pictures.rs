//! All scenes of the kit as small pictures, with what they cost: what a change to the way from scene to frame must not
//! touch unnoticed.

use anyhow::{Context, Result};
use raykata::count::Counts;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, TracedRay, View, mishap};
use raykata::scene::{Scene, load};
use std::path::Path;

/// Width and height: small, because hundreds of kits are asked for them.
const SIZE: (u32, u32) = (24, 16);

/// Scenes of more triangles than this take longer to build than all others together.
const MOST_TRIANGLES: usize = 20_000;

/// The scenes, each with its name.
pub struct Scenes(Vec<(String, Scene)>);

/// What a kit shows of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The name of the scene's file.
    pub scene: String,
    /// The pixels, bit by bit, or what went wrong.
    pub pixels: Result<Vec<[u32; 3]>, String>,
    /// What it cost.
    pub counts: Counts,
    /// The rays behind two pixels.
    pub rays: Vec<TracedRay>,
}

impl Scenes {
    /// Reads the scenes of the kit at `root`, smallest samples first.
    pub fn read(root: &Path) -> Result<Scenes> {
        let mut files: Vec<_> = std::fs::read_dir(root.join("scenes"))?
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|file| file.extension().is_some_and(|extension| extension == "toml"))
            .collect();
        files.sort();
        let mut scenes = Vec::new();
        for file in files {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let mut scene = load::load(&file).map_err(|error| anyhow::anyhow!("{error}"))?;
            if scene.meshes.iter().map(|mesh| mesh.mesh.triangles.len()).sum::<usize>() > MOST_TRIANGLES {
                continue;
            }
            (scene.film.width, scene.film.height) = SIZE;
            scene.quality.samples_per_pixel = scene.quality.samples_per_pixel.min(4);
            scenes.push((name, scene));
        }
        scenes.first().context("the kit has no scenes")?;
        Ok(Scenes(scenes))
    }

    /// What a kit shows of them all.
    pub fn shown_by(&self, kit: &dyn Kit) -> Vec<Shown> {
        self.0.iter().map(|(name, scene)| shown(name, scene, kit)).collect()
    }

    /// The first scene of which this kit shows something else.
    pub fn first_difference(&self, kit: &dyn Kit, expected: &[Shown]) -> Option<String> {
        let differs =
            |((name, scene), expected): &(&(String, Scene), &Shown)| shown(name, scene, kit) != **expected;
        self.0.iter().zip(expected).find(differs).map(|((name, _), _)| name.clone())
    }
}

fn shown(name: &str, scene: &Scene, kit: &dyn Kit) -> Shown {
    let job = RenderJob { scene: scene.clone(), view: View::Shaded, seed: 1, threads: 1, count: true };
    let frame = mishap::catch(|| kit.render(&job, &Unwatched));
    let counts =
        frame.as_ref().ok().and_then(Option::as_ref).map_or_else(Counts::default, |frame| frame.counts);
    let pixels = match frame {
        Ok(Some(frame)) => Ok(frame.film.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect()),
        Ok(None) => Err("cancelled".into()),
        Err(mishap) => Err(mishap.to_string()),
    };
    let rays = [(SIZE.0 / 2, SIZE.1 / 2), (5, 12)];
    let rays = rays.iter().flat_map(|&(x, y)| mishap::catch(|| kit.trace(&job, x, y)).unwrap_or_default());
    Shown { scene: name.into(), pixels, counts, rays: rays.collect() }
}
