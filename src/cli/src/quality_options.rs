//! The quality parameters of a scene as options, the same for all commands that render.

use crate::args::{Given, Misuse, Opt, names};
use anyhow::{Result, anyhow};
use raykata::film::ToneCurve;
use raykata::scene::load::Limits;
use raykata::scene::{
    Accelerator, NextEvent, Precision, Quality, Sampler, Scene, SphereMethod, Split, TextureFilter,
    TriangleMethod,
};

/// The number of threads that render, the same for all commands.
pub struct Threads(u16);

impl Threads {
    /// The option.
    pub const OPTIONS: &[Opt] =
        &[Opt::value("--threads", "N", "Threads; 0 takes one per core [default: 0].")];

    /// Reads the options.
    pub fn read(given: &Given) -> Result<Threads, Misuse> {
        Ok(Threads(given.number("--threads", 0..=1024)?.unwrap_or(0)))
    }

    /// The number of threads for a job.
    pub fn count(&self) -> usize {
        usize::from(self.0)
    }
}

/// The memory that a scene may use, the same for all commands that read one.
#[derive(Clone, Copy, Default)]
pub struct Memory(Limits);

impl Memory {
    const OPTION: Opt =
        Opt::value("--memory", "GB", "The most memory for film, textures and triangles [default: 4].");

    /// The option.
    pub const OPTIONS: &[Opt] = &[Memory::OPTION];

    /// Reads the option.
    pub fn read(given: &Given) -> Result<Memory, Misuse> {
        let gigabytes: Option<u64> = given.number("--memory", 1..=1_000_000)?;
        Ok(Memory(gigabytes.map_or(Limits::default(), |n| Limits { memory: n * 1_000_000_000 })))
    }

    /// The limits for a scene.
    pub fn limits(self) -> Limits {
        self.0
    }
}

/// How bright a picture file is, the same for all commands that write a picture of a scene.
#[derive(Clone, Copy, Default)]
pub struct ToneOptions {
    exposure: Option<f32>,
    curve: Option<ToneCurve>,
}

impl ToneOptions {
    /// The options.
    pub const OPTIONS: &[Opt] = &[
        Opt::value(
            "--exposure",
            "STOPS",
            "Of the PNG file: each stop doubles the light [default: the scene's, as for --tone].",
        ),
        Opt::value("--tone", "NAME", "How the PNG file shows light above 1.")
            .choices(&names(&ToneCurve::ALL)),
    ];

    /// Reads the options.
    pub fn read(given: &Given) -> Result<ToneOptions, Misuse> {
        Ok(ToneOptions {
            exposure: given.parsed("--exposure", parse_exposure)?,
            curve: given.choice("--tone", &ToneCurve::ALL)?,
        })
    }

    /// Sets the given options in the scene.
    pub fn apply(self, scene: &mut Scene) {
        let tone = &mut scene.film.tone;
        tone.exposure = self.exposure.unwrap_or(tone.exposure);
        tone.curve = self.curve.unwrap_or(tone.curve);
    }
}

/// Parameters that trade accuracy for time. Those that are not given keep the value of the scene.
#[derive(Default)]
pub struct QualityOptions {
    size: Option<(u32, u32)>,
    spp: Option<u32>,
    sampler: Option<Sampler>,
    light_samples: Option<u32>,
    glossy_samples: Option<u32>,
    texture_filter: Option<TextureFilter>,
    depth: Option<u32>,
    split: Option<Split>,
    leaf_size: Option<u32>,
    accelerator: Option<Accelerator>,
    grid_resolution: Option<u32>,
    triangles: Option<TriangleMethod>,
    spheres: Option<SphereMethod>,
    precision: Option<Precision>,
    min_contribution: Option<f32>,
    next_event: Option<NextEvent>,
    roulette_from: Option<u32>,
    clamp: Option<f32>,
    memory: Memory,
}

/// The samplers by the names of scene files, with `-` in place of `_`. The other lists use the same names.
pub(crate) const SAMPLERS: [(&str, Sampler); 5] = [
    ("center", Sampler::Center),
    ("random", Sampler::Random),
    ("jittered", Sampler::Jittered),
    ("gaussian", Sampler::Gaussian),
    ("low-discrepancy", Sampler::LowDiscrepancy),
];

const SPLITS: [(&str, Split); 3] = [
    ("object-median", Split::ObjectMedian),
    ("spatial-median", Split::SpatialMedian),
    ("surface-area", Split::SurfaceArea),
];

pub(crate) const ACCELERATORS: [(&str, Accelerator); 19] = [
    ("auto", Accelerator::Auto),
    ("brute-force", Accelerator::BruteForce),
    ("bounding-boxes", Accelerator::BoundingBoxes),
    ("bounding-spheres", Accelerator::BoundingSpheres),
    ("cached-bounding-boxes", Accelerator::CachedBoundingBoxes),
    ("bvh", Accelerator::Bvh),
    ("bvh-both-children", Accelerator::BvhBothChildren),
    ("cached-bvh", Accelerator::CachedBvh),
    ("packet-bvh", Accelerator::PacketBvh),
    ("wide-bvh", Accelerator::WideBvh),
    ("reinserted-bvh", Accelerator::ReinsertedBvh),
    ("stream-bvh", Accelerator::StreamBvh),
    ("grid", Accelerator::Grid),
    ("octree", Accelerator::Octree),
    ("octree-by-cells", Accelerator::OctreeByCells),
    ("octree-by-neighbours", Accelerator::OctreeByNeighbours),
    ("kd-tree", Accelerator::KdTree),
    ("bsp", Accelerator::Bsp),
    ("polygon-bsp", Accelerator::PolygonBsp),
];

const TRIANGLES: [(&str, TriangleMethod); 7] = [
    ("cramer", TriangleMethod::Cramer),
    ("gram", TriangleMethod::Gram),
    ("inside-by-planes", TriangleMethod::InsideByPlanes),
    ("inside-by-direction", TriangleMethod::InsideByDirection),
    ("inside-by-areas", TriangleMethod::InsideByAreas),
    ("choice", TriangleMethod::Choice),
    ("watertight", TriangleMethod::Watertight),
];

const SPHERES: [(&str, SphereMethod); 3] = [
    ("algebraic", SphereMethod::Algebraic),
    ("geometric", SphereMethod::Geometric),
    ("stable-roots", SphereMethod::StableRoots),
];

const PRECISIONS: [(&str, Precision); 2] = [("single", Precision::Single), ("double", Precision::Double)];

impl QualityOptions {
    /// The accelerator, if one is given.
    pub fn accelerator(&self) -> Option<Accelerator> {
        self.accelerator
    }

    /// The options.
    pub const OPTIONS: &[Opt] = &[
        Opt::value(
            "--size",
            "WxH",
            "Size in pixels, such as 640x360 [default: the scene's, as for all below].",
        ),
        Opt::value("--spp", "N", "Samples per pixel."),
        Opt::value("--sampler", "NAME", "Positions of the samples in a pixel.").choices(&names(&SAMPLERS)),
        Opt::value("--light-samples", "N", "Samples per area light and hit."),
        Opt::value("--glossy-samples", "N", "Rays per glossy reflection or refraction."),
        Opt::value("--texture-filter", "NAME", "How images are read.").choices(&names(&TextureFilter::NAMES)),
        Opt::value("--depth", "N", "The most reflections and refractions on a path."),
        Opt::value("--split", "NAME", "Split strategy of the hierarchy.").choices(&names(&SPLITS)),
        Opt::value("--leaf-size", "N", "The most primitives in a leaf."),
        Opt::value("--accelerator", "NAME", "Acceleration structure.").choices(&names(&ACCELERATORS)),
        Opt::value(
            "--grid-resolution",
            "N",
            "Cells of a grid along its longest side; 0 takes the number of the formula.",
        ),
        Opt::value("--triangles", "NAME", "Ray/triangle test.").choices(&names(&TRIANGLES)),
        Opt::value("--spheres", "NAME", "Ray/sphere test.").choices(&names(&SPHERES)),
        Opt::value("--precision", "NAME", "Precision of ray/shape tests.").choices(&names(&PRECISIONS)),
        Opt::value("--min-contribution", "X", "Weight below which rays are not traced, 0 to 1."),
        Opt::value(
            "--next-event",
            "NAME",
            "Whether paths of indirect light find emitters by chance, by samples only, or by both with weights.",
        )
        .choices(&names(&NextEvent::NAMES)),
        Opt::value("--roulette-from", "N", "Bounces from which on Russian roulette ends paths."),
        Opt::value("--clamp", "X", "The largest channel of a sample of indirect light; 0 sets no limit."),
        Memory::OPTION,
    ];

    /// Reads the options.
    pub fn read(given: &Given) -> Result<QualityOptions, Misuse> {
        Ok(QualityOptions {
            size: given.parsed("--size", parse_size)?,
            spp: given.number("--spp", 1..=65_536)?,
            sampler: given.choice("--sampler", &SAMPLERS)?,
            light_samples: given.number("--light-samples", 0..=65_536)?,
            glossy_samples: given.number("--glossy-samples", 1..=65_536)?,
            texture_filter: given.choice("--texture-filter", &TextureFilter::NAMES)?,
            depth: given.number("--depth", 0..=1000)?,
            split: given.choice("--split", &SPLITS)?,
            leaf_size: given.number("--leaf-size", 1..=u32::MAX)?,
            accelerator: given.choice("--accelerator", &ACCELERATORS)?,
            grid_resolution: given.number("--grid-resolution", 0..=1024)?,
            triangles: given.choice("--triangles", &TRIANGLES)?,
            spheres: given.choice("--spheres", &SPHERES)?,
            precision: given.choice("--precision", &PRECISIONS)?,
            min_contribution: given.parsed("--min-contribution", parse_share)?,
            next_event: given.choice("--next-event", &NextEvent::NAMES)?,
            roulette_from: given.number("--roulette-from", 2..=1000)?,
            clamp: given.parsed("--clamp", parse_clamp)?,
            memory: Memory::read(given)?,
        })
    }

    /// The limits for a scene.
    pub fn limits(&self) -> Limits {
        self.memory.limits()
    }

    /// Whether a size was given.
    pub fn names_a_size(&self) -> bool {
        self.size.is_some()
    }

    /// Whether a number of samples per pixel was given.
    pub fn names_samples(&self) -> bool {
        self.spp.is_some()
    }

    /// Sets the given parameters in the scene. Fails if a picture of the given size needs more memory than the limit.
    pub fn apply(&self, scene: &mut Scene) -> Result<()> {
        if let Some((width, height)) = self.size {
            self.limits().check_film(width, height).map_err(|message| anyhow!(message))?;
            (scene.film.width, scene.film.height) = (width, height);
        }
        let quality = &mut scene.quality;
        quality.samples_per_pixel = self.spp.unwrap_or(quality.samples_per_pixel);
        quality.sampler = self.sampler.unwrap_or(quality.sampler);
        quality.light_samples = self.light_samples.unwrap_or(quality.light_samples);
        quality.glossy_samples = self.glossy_samples.unwrap_or(quality.glossy_samples);
        quality.texture_filter = self.texture_filter.unwrap_or(quality.texture_filter);
        quality.max_depth = self.depth.unwrap_or(quality.max_depth);
        quality.leaf_size = self.leaf_size.unwrap_or(quality.leaf_size);
        quality.split = self.split.unwrap_or(quality.split);
        quality.accelerator = self.accelerator.unwrap_or(quality.accelerator);
        quality.grid_resolution = self.grid_resolution.unwrap_or(quality.grid_resolution);
        quality.triangle_method = self.triangles.unwrap_or(quality.triangle_method);
        quality.sphere_method = self.spheres.unwrap_or(quality.sphere_method);
        quality.precision = self.precision.unwrap_or(quality.precision);
        quality.min_contribution = self.min_contribution.unwrap_or(quality.min_contribution);
        quality.next_event = self.next_event.unwrap_or(quality.next_event);
        quality.roulette_from = self.roulette_from.unwrap_or(quality.roulette_from);
        quality.clamp = self.clamp.unwrap_or(quality.clamp);
        Ok(())
    }
}

/// The options that change `own` to `wanted`, for the parameters that differ.
pub fn arguments(own: &Quality, wanted: &Quality) -> String {
    let values = |quality: &Quality| {
        let named = |value: serde_json::Result<serde_json::Value>| {
            let value = value.unwrap_or_default();
            value.as_str().map_or_else(|| value.to_string(), |name| name.replace('_', "-"))
        };
        [
            ("--spp", quality.samples_per_pixel.to_string()),
            ("--sampler", named(serde_json::to_value(quality.sampler))),
            ("--light-samples", quality.light_samples.to_string()),
            ("--glossy-samples", quality.glossy_samples.to_string()),
            ("--texture-filter", named(serde_json::to_value(quality.texture_filter))),
            ("--depth", quality.max_depth.to_string()),
            ("--min-contribution", quality.min_contribution.to_string()),
            ("--next-event", named(serde_json::to_value(quality.next_event))),
            ("--roulette-from", quality.roulette_from.to_string()),
            ("--clamp", quality.clamp.to_string()),
            ("--triangles", named(serde_json::to_value(quality.triangle_method))),
            ("--spheres", named(serde_json::to_value(quality.sphere_method))),
            ("--precision", named(serde_json::to_value(quality.precision))),
            ("--accelerator", named(serde_json::to_value(quality.accelerator))),
            ("--split", named(serde_json::to_value(quality.split))),
            ("--leaf-size", quality.leaf_size.to_string()),
            ("--grid-resolution", quality.grid_resolution.to_string()),
        ]
    };
    let differ = values(own).into_iter().zip(values(wanted)).filter(|(own, wanted)| own != wanted);
    differ.map(|(_, (name, value))| format!(" {name} {value}")).collect()
}

fn parse_exposure(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops| (-100.0..=100.0).contains(stops));
    stops.ok_or_else(|| "an exposure is a number of stops from -100 to 100, such as -0.5".into())
}

fn parse_clamp(text: &str) -> Result<f32, String> {
    let limit = text.parse().ok().filter(|limit: &f32| limit.is_finite() && *limit >= 0.0);
    limit.ok_or_else(|| "a limit of light is a number of at least 0, such as 10".into())
}

fn parse_share(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "a weight is a number from 0 to 1, such as 0.001".into())
}

/// The longest side of a picture, as in scene files.
const MAX_SIDE: u32 = 65_536;

pub(crate) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let parsed: Option<(u32, u32)> =
        text.split_once(['x', '×']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match parsed {
        Some((width, height)) if (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height) => {
            Ok((width, height))
        }
        _ => {
            Err("a size is two whole numbers from 1 to 65536 with an x between them, such as 640x360".into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Read, Spec};
    use std::ffi::OsString;

    static LINE: Spec =
        Spec { name: "render", about: "", arguments: &[], options: &[QualityOptions::OPTIONS] };

    #[test]
    fn every_accelerator_has_the_name_of_scene_files() {
        let named = ACCELERATORS.map(|(name, accelerator)| (name.replace('-', "_"), accelerator));
        assert_eq!(named, Accelerator::NAMES.map(|(name, accelerator)| (name.to_owned(), accelerator)));
    }

    #[test]
    fn every_method_has_the_name_of_scene_files() {
        assert_eq!(
            TRIANGLES.map(|(name, method)| (name.replace('-', "_"), method)),
            owned(TriangleMethod::NAMES)
        );
        assert_eq!(
            SPHERES.map(|(name, method)| (name.replace('-', "_"), method)),
            owned(SphereMethod::NAMES)
        );
    }

    fn owned<T: Copy, const N: usize>(all: [(&str, T); N]) -> [(String, T); N] {
        all.map(|(name, one)| (name.to_owned(), one))
    }

    #[test]
    fn arguments_turn_every_parameter() {
        let mut scene =
            crate::report::load_scene(std::path::Path::new("../../scenes/stage1.toml"), Limits::default())
                .unwrap();
        let own = scene.quality;
        let wanted = Quality {
            samples_per_pixel: 343,
            sampler: Sampler::Jittered,
            light_samples: 7,
            glossy_samples: 3,
            texture_filter: TextureFilter::Mipmap,
            max_depth: 9,
            min_contribution: 0.03,
            next_event: NextEvent::Only,
            roulette_from: 8,
            clamp: 10.0,
            triangle_method: TriangleMethod::InsideByDirection,
            sphere_method: SphereMethod::StableRoots,
            precision: Precision::Double,
            accelerator: Accelerator::OctreeByCells,
            split: Split::SpatialMedian,
            leaf_size: 8,
            grid_resolution: 64,
            ..own
        };
        let line = arguments(&own, &wanted);
        assert!(line.starts_with(" --spp 343 --sampler jittered --light-samples 7"), "{line}");
        let Read::Given(given) = LINE.read(line.split_whitespace().map(OsString::from)).unwrap() else {
            panic!("help was requested");
        };
        QualityOptions::read(&given).unwrap().apply(&mut scene).unwrap();
        assert_eq!(scene.quality, wanted);
        assert_eq!(arguments(&own, &own), "");
        assert!(parse_share("1.5").is_err() && parse_share("NaN").is_err() && parse_share("some").is_err());
    }
}
