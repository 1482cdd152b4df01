//! The knobs of a scene on the command line, the same for all commands that render.

use clap::{Args, ValueEnum};
use raykata::scene::{Accelerator, Precision, Quality, Sampler, Scene, Split, TriangleMethod};

/// How many threads render, the same for all commands.
#[derive(Args)]
pub struct Threads {
    /// Threads; 0 takes one a core.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,
}

impl Threads {
    /// As a job takes it.
    pub fn count(&self) -> usize {
        usize::from(self.threads)
    }
}

/// Accuracy against time; what is not named stays as the scene says.
#[derive(Args)]
pub struct Knobs {
    /// Size in pixels, such as 640x360 [default: the scene's].
    #[arg(long, value_parser = parse_size)]
    size: Option<(u32, u32)>,
    /// Samples a pixel [default: the scene's].
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    spp: Option<u32>,
    /// Where the samples of a pixel lie [default: the scene's].
    #[arg(long, value_enum)]
    sampler: Option<SamplerName>,
    /// Places on an area light that a hit asks about [default: the scene's].
    #[arg(long, value_parser = clap::value_parser!(u32).range(0..=65_536))]
    light_samples: Option<u32>,
    /// Rays that go on from a rough surface [default: the scene's].
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    gloss_samples: Option<u32>,
    /// How often a ray may be mirrored or refracted [default: the scene's].
    #[arg(long, value_parser = clap::value_parser!(u32).range(0..=1000))]
    depth: Option<u32>,
    /// Split strategy of the hierarchy [default: the scene's].
    #[arg(long, value_enum)]
    split: Option<SplitName>,
    /// Most primitives in a leaf [default: the scene's].
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    leaf_size: Option<u32>,
    /// What finds the closest hit: brute-force, bounding-boxes, bounding-spheres, bvh, cached-bvh, packet-bvh, grid, octree,
    /// octree-by-cells, kd-tree or bsp [default: the scene's].
    #[arg(long, value_parser = parse_accelerator)]
    accelerator: Option<Accelerator>,
    /// Cells of a grid along its longest side; 0 takes the formula's number [default: the scene's].
    #[arg(long, value_parser = clap::value_parser!(u32).range(0..=1024))]
    grid_resolution: Option<u32>,
    /// Ray/triangle test [default: the scene's].
    #[arg(long, value_enum)]
    triangles: Option<TriangleName>,
    /// Digits of ray/shape tests [default: the scene's].
    #[arg(long, value_enum)]
    precision: Option<PrecisionName>,
    /// Rays of less weight are not traced, 0 to 1 [default: the scene's].
    #[arg(long, value_parser = parse_share)]
    min_contribution: Option<f32>,
}

impl Knobs {
    /// Whether the picture has a size that somebody asked for.
    pub fn names_a_size(&self) -> bool {
        self.size.is_some()
    }

    /// Turns the knobs of the scene that were named.
    pub fn apply(&self, scene: &mut Scene) {
        if let Some((width, height)) = self.size {
            (scene.film.width, scene.film.height) = (width, height);
        }
        let quality = &mut scene.quality;
        quality.samples_per_pixel = self.spp.unwrap_or(quality.samples_per_pixel);
        quality.sampler = self.sampler.map_or(quality.sampler, Sampler::from);
        quality.light_samples = self.light_samples.unwrap_or(quality.light_samples);
        quality.gloss_samples = self.gloss_samples.unwrap_or(quality.gloss_samples);
        quality.max_depth = self.depth.unwrap_or(quality.max_depth);
        quality.leaf_size = self.leaf_size.unwrap_or(quality.leaf_size);
        quality.split = self.split.map_or(quality.split, |split| match split {
            SplitName::ObjectMedian => Split::ObjectMedian,
            SplitName::SpatialMedian => Split::SpatialMedian,
            SplitName::SurfaceArea => Split::SurfaceArea,
        });
        quality.accelerator = self.accelerator.unwrap_or(quality.accelerator);
        quality.grid_resolution = self.grid_resolution.unwrap_or(quality.grid_resolution);
        quality.triangle_method = self.triangles.map_or(quality.triangle_method, |method| match method {
            TriangleName::Cramer => TriangleMethod::Cramer,
            TriangleName::Gram => TriangleMethod::Gram,
            TriangleName::Watertight => TriangleMethod::Watertight,
        });
        quality.precision = self.precision.map_or(quality.precision, |precision| match precision {
            PrecisionName::Single => Precision::Single,
            PrecisionName::Double => Precision::Double,
        });
        quality.min_contribution = self.min_contribution.unwrap_or(quality.min_contribution);
    }
}

/// The arguments that turn the knobs of `own` to where `wanted` has them, as far as they differ.
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
            ("--gloss-samples", quality.gloss_samples.to_string()),
            ("--depth", quality.max_depth.to_string()),
            ("--min-contribution", quality.min_contribution.to_string()),
            ("--triangles", named(serde_json::to_value(quality.triangle_method))),
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

/// A sampler by the name that scene files use, with `-` for `_`.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum SamplerName {
    Center,
    Random,
    Jittered,
    Gaussian,
    LowDiscrepancy,
}

impl From<SamplerName> for Sampler {
    fn from(name: SamplerName) -> Sampler {
        match name {
            SamplerName::Center => Sampler::Center,
            SamplerName::Random => Sampler::Random,
            SamplerName::Jittered => Sampler::Jittered,
            SamplerName::Gaussian => Sampler::Gaussian,
            SamplerName::LowDiscrepancy => Sampler::LowDiscrepancy,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum SplitName {
    ObjectMedian,
    SpatialMedian,
    SurfaceArea,
}

/// An accelerator by the name that scene files use, with `-` for `_`.
pub(crate) fn parse_accelerator(text: &str) -> Result<Accelerator, String> {
    let name = text.replace('-', "_");
    Accelerator::ALL.into_iter().find(|one| one.name() == name).ok_or_else(|| {
        let known: Vec<String> = Accelerator::ALL.map(|one| one.name().replace('_', "-")).to_vec();
        format!("known are {}", known.join(", "))
    })
}

#[derive(Clone, Copy, ValueEnum)]
enum PrecisionName {
    Single,
    Double,
}

fn parse_share(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "a weight is a number from 0 to 1, such as 0.001".into())
}

#[derive(Clone, Copy, ValueEnum)]
enum TriangleName {
    Cramer,
    Gram,
    Watertight,
}

/// As in scene files: 2²⁸, three gigabytes of film.
const MOST_PIXELS: u64 = 1 << 28;

pub(crate) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let parsed: Option<(u32, u32)> =
        text.split_once(['x', '×']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match parsed {
        Some((width, height)) if (1..=MOST_PIXELS).contains(&(u64::from(width) * u64::from(height))) => {
            Ok((width, height))
        }
        _ => Err("a size is two whole numbers with an x between them, such as 640x360, and at most 268,435,456 pixels".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        knobs: Knobs,
    }

    #[test]
    fn arguments_turn_every_knob() {
        let mut scene = crate::report::load_scene(std::path::Path::new("../../scenes/stage1.toml")).unwrap();
        let own = scene.quality;
        let wanted = Quality {
            samples_per_pixel: 343,
            sampler: Sampler::Jittered,
            light_samples: 7,
            gloss_samples: 3,
            max_depth: 9,
            min_contribution: 0.03,
            triangle_method: TriangleMethod::Gram,
            precision: Precision::Double,
            accelerator: Accelerator::OctreeByCells,
            split: Split::SpatialMedian,
            leaf_size: 8,
            grid_resolution: 64,
            ..own
        };
        let line = arguments(&own, &wanted);
        assert!(line.starts_with(" --spp 343 --sampler jittered --light-samples 7"), "{line}");
        Line::try_parse_from(format!("render{line}").split(' ')).unwrap().knobs.apply(&mut scene);
        assert_eq!(scene.quality, wanted);
        assert_eq!(arguments(&own, &own), "");
        assert!(parse_share("1.5").is_err() && parse_share("NaN").is_err() && parse_share("some").is_err());
    }
}
