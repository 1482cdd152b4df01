//! Renders all scenes of the kit as small pictures and records their cost, so that every change of the renderer is noticed.

use anyhow::{Context, Result, anyhow};
use grader::files_below::{files_below, last_part};
use raykata::camera::Lens;
use raykata::count::Counts;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, Rendering, TracedRay, View, kit_error};
use raykata::material::Fresnel;
use raykata::scene::{
    Accelerator, Precision, Quality, Sampler, Scene, SphereMethod, Split, TextureFilter, TriangleMethod, load,
};
use sha2::{Digest, Sha256};
use std::fmt;
use std::path::Path;

/// Width and height in pixels. They are small, because hundreds of kits render the pictures.
const SIZE: (u32, u32) = (24, 16);

/// Most primitives of a scene. Without optimisation, larger scenes take longer to build than all others together.
const MOST_PRIMITIVES: usize = 4_000;

/// A scene that uses most features. It is also rendered with each parameter changed.
const TURNED: &str = "effects";

/// A scene of a few shapes. It is also rendered with each accelerator.
const SEARCHED: &str = "stage5";

/// The scenes, each with its name.
pub struct Scenes(Vec<(String, Scene)>);

/// The results of a kit for one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The name of the scene's file.
    pub scene: String,
    /// The bits of the pixels, or the error.
    pub pixels: Result<Vec<[u32; 3]>, String>,
    /// The same for the picture of normals.
    pub normals: Option<Vec<[u32; 3]>>,
    /// The number of primitives, and the number of nodes and the depth of the structure.
    pub made_of: Option<(u64, Option<(u64, u64)>)>,
    /// Notes about the parts that the picture lacks.
    pub notes: Vec<String>,
    /// The cost of the picture.
    pub counts: Counts,
    /// The traced rays of two pixels.
    pub rays: Vec<TracedRay>,
}

impl Scenes {
    /// Reads the scenes of the kit at `root`, sorted by the number of primitives that `reference` makes of them.
    pub fn read(root: &Path, reference: &dyn Kit) -> Result<Scenes> {
        let mut scenes = Vec::new();
        for file in files_below(root, "scenes", &|path| path.ends_with(".toml"))? {
            let name = last_part(&file).trim_end_matches(".toml").to_owned();
            let mut scene = load::load(&root.join(&file)).map_err(|error| anyhow!("{error}"))?;
            (scene.film.width, scene.film.height) = SIZE;
            scene.quality.samples_per_pixel = scene.quality.samples_per_pixel.min(4);
            let primitives = primitives_of(&scene, reference)? as usize;
            if primitives <= MOST_PRIMITIVES {
                scenes.push((primitives, name, scene));
            }
        }
        let corners = load::parse(&root.join("scenes/corners.toml"), include_str!("pictures.toml"));
        scenes.push((MOST_PRIMITIVES, "corners".into(), corners.map_err(|error| anyhow!("{error}"))?));
        scenes.sort_by_key(|(primitives, ..)| *primitives);
        let mut scenes: Vec<(String, Scene)> =
            scenes.into_iter().map(|(_, name, scene)| (name, scene)).collect();
        let turned = scenes.iter().find(|(name, _)| name == TURNED).map(|(_, scene)| scene.clone());
        scenes.extend(turned.iter().flat_map(turn_each_parameter));
        let searched = scenes.iter().find(|(name, _)| name == SEARCHED).map(|(_, scene)| scene.clone());
        scenes.extend(searched.iter().flat_map(|scene| with_each_accelerator(SEARCHED, scene)));
        scenes.first().context("the kit has no scenes")?;
        Ok(Scenes(scenes))
    }

    /// Returns scenes that together call every function of the exercises.
    pub fn of_gaps(&self) -> Scenes {
        let asked = [
            "stage2",
            "effects",
            "effects, Gaussian",
            "effects, Random",
            "effects, lights from the middle",
            "effects, Double",
            "effects, Cramer",
            "effects, Gram",
            "effects, InsideByPlanes",
            "effects, InsideByDirection",
            "effects, Choice",
            "effects, StableRoots",
            "effects, ObjectMedian",
            "effects, SpatialMedian",
            "methods",
            "one_sided",
            "nurbs",
            "effects, no lens, all smooth",
            "effects, Schlick",
            "stage8",
            "cornell",
        ];
        let is_asked = |name: &str| asked.contains(&name) || name.starts_with(&format!("{SEARCHED}, "));
        Scenes(self.0.iter().filter(|(name, _)| is_asked(name)).cloned().collect())
    }

    /// Renders all scenes with a kit.
    pub fn shown_by(&self, kit: &dyn Kit) -> Vec<Shown> {
        self.0.iter().map(|(name, scene)| shown(name, scene, kit)).collect()
    }
}

/// Counts the primitives that the reference makes of a scene.
fn primitives_of(scene: &Scene, reference: &dyn Kit) -> Result<u64> {
    let mut scene = scene.clone();
    (scene.film.width, scene.film.height) = (1, 1);
    let job = RenderJob { scene, view: View::Normals, seed: 0, threads: 1, count: false, reuse: false };
    let frame = kit_error::catch(|| reference.render(&job, &Unwatched))?;
    Ok(frame.context("the frame is not cancelled")?.primitives)
}

/// Returns the scene with each accelerator; the scene itself lets the kit choose.
fn with_each_accelerator(name: &str, scene: &Scene) -> Vec<(String, Scene)> {
    let by = |accelerator: Accelerator| {
        let mut scene = scene.clone();
        scene.quality.accelerator = accelerator;
        (format!("{name}, {}", accelerator.name().replace('_', " ")), scene)
    };
    Accelerator::ALL.map(by).to_vec()
}

/// Returns the scene with one setting changed at a time.
fn turn_each_parameter(scene: &Scene) -> Vec<(String, Scene)> {
    let with = |name: &str, change: &dyn Fn(&mut Quality)| {
        let mut scene = scene.clone();
        change(&mut scene.quality);
        (format!("{TURNED}, {name}"), scene)
    };
    let mut turned = vec![
        with("leaves of 1", &|quality| quality.leaf_size = 1),
        with("depth 0", &|quality| quality.max_depth = 0),
        with("depth 1", &|quality| quality.max_depth = 1),
        with("large contributions", &|quality| quality.min_contribution = 0.3),
        with("lights from the middle", &|quality| quality.light_samples = 0),
        with("three samples per light", &|quality| quality.light_samples = 3),
        with("three glossy rays", &|quality| quality.glossy_samples = 3),
        with("filtered images", &|quality| quality.texture_filter = TextureFilter::Mipmap),
        with("one Gaussian sample", &|quality| {
            (quality.sampler, quality.samples_per_pixel) = (Sampler::Gaussian, 1);
        }),
    ];
    turned.extend(with_each_accelerator(TURNED, scene));
    turned.push(with("a grid of 9", &|quality| {
        (quality.accelerator, quality.grid_resolution) = (Accelerator::Grid, 9);
    }));
    turned.extend(Split::ALL.map(|split| with(&format!("{split:?}"), &|quality| quality.split = split)));
    let methods =
        TriangleMethod::NAMES.into_iter().filter(|(_, one)| *one != Quality::default().triangle_method);
    turned.extend(
        methods.map(|(_, method)| with(&format!("{method:?}"), &|quality| quality.triangle_method = method)),
    );
    let methods = SphereMethod::NAMES.into_iter().filter(|(_, one)| *one != Quality::default().sphere_method);
    turned.extend(
        methods.map(|(_, method)| with(&format!("{method:?}"), &|quality| quality.sphere_method = method)),
    );
    turned.push(with("Double", &|quality| quality.precision = Precision::Double));
    let samplers = [Sampler::Center, Sampler::Random, Sampler::Jittered, Sampler::Gaussian];
    turned
        .extend(samplers.map(|sampler| with(&format!("{sampler:?}"), &|quality| quality.sampler = sampler)));
    // Features that are present without an effect must not be noted as missing.
    let mut idle = scene.clone();
    idle.camera.lens = idle.camera.lens.map(|lens| Lens { aperture: 0.0, ..lens });
    idle.materials.iter_mut().for_each(|material| material.roughness = 0.0);
    turned.push((format!("{TURNED}, no lens, all smooth"), idle));
    let mut schlick = scene.clone();
    schlick.materials.iter_mut().for_each(|material| material.fresnel = Fresnel::Schlick);
    turned.push((format!("{TURNED}, Schlick"), schlick));
    turned
}

fn shown(name: &str, scene: &Scene, kit: &dyn Kit) -> Shown {
    let job = RenderJob {
        scene: scene.clone(),
        view: View::Shaded,
        seed: 1,
        threads: 1,
        count: true,
        reuse: false,
    };
    let normals = RenderJob { view: View::Normals, count: false, ..job.clone() };
    let normals =
        kit_error::catch(|| kit.render(&normals, &Unwatched)).ok().flatten().map(|frame| bits(&frame));
    let frame = kit_error::catch(|| kit.render(&job, &Unwatched));
    let seen = frame.as_ref().ok().and_then(Option::as_ref);
    let made_of = seen.map(|frame| (frame.primitives, frame.structure.map(|size| (size.nodes, size.levels))));
    let notes = seen.map_or_else(Vec::new, |frame| frame.notes.clone());
    let counts = seen.map_or_else(Counts::default, |frame| frame.counts);
    let pixels = match frame {
        Ok(Some(frame)) => Ok(bits(&frame)),
        Ok(None) => Err("cancelled".into()),
        Err(error) => Err(error.to_string()),
    };
    let rays = [(SIZE.0 / 2, SIZE.1 / 2), (5, 12)];
    let rays = rays.iter().flat_map(|&(x, y)| kit_error::catch(|| kit.trace(&job, x, y)).unwrap_or_default());
    Shown { scene: name.into(), pixels, normals, made_of, notes, counts, rays: rays.collect() }
}

impl Shown {
    /// Returns eight hexadecimal digits of a hash of all results. Counts of indirect light and of exact tests that are 0 are left
    /// out, so that the hash of a scene without them is that from before there were any.
    pub fn hash(&self) -> String {
        let all = format!("{self:?}").replace("indirect: 0, absorbed: 0, ", "");
        let hash = Sha256::digest(all.replace("exact_tests: 0, ", ""));
        hash[..4].iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl fmt::Display for Shown {
    /// Writes one line: the mean colour, the cost, and a hash of all results.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pixels = self.pixels.as_deref().unwrap_or_default();
        let mean = |channel: usize| {
            let sum: f64 = pixels.iter().map(|pixel| f64::from(f32::from_bits(pixel[channel]))).sum();
            sum / pixels.len().max(1) as f64
        };
        let Counts { hits, box_tests, primitive_tests, .. } = self.counts;
        write!(
            f,
            "{:<36} {:.3} {:.3} {:.3}  {:>6} rays {hits:>6} hits {box_tests:>7} boxes {primitive_tests:>7} primitives  {}",
            self.scene,
            mean(0),
            mean(1),
            mean(2),
            self.counts.rays(),
            self.hash()
        )
    }
}

fn bits(frame: &Rendering) -> Vec<[u32; 3]> {
    frame.film.pixels.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect()
}
