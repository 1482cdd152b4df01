//! The parameters that trade accuracy for time, and their names.

use serde::Serialize;

/// A parameter that trades accuracy for time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Samples per pixel; lens and time are sampled with them.
    Samples,
    /// The positions of the samples in the pixel.
    Sampler,
    /// Samples per area light and hit.
    LightSamples,
    /// Secondary rays per glossy reflection or refraction.
    GlossySamples,
    /// The most reflections and refractions on a path.
    Depth,
    /// The weight below which rays are not traced.
    MinContribution,
    /// How paths find emitters.
    NextEvent,
    /// The number of bounces from which on Russian roulette ends paths.
    RouletteFrom,
    /// The largest channel of the light of a sample.
    Clamp,
    /// How images are read.
    TextureFilter,
    /// Whether normals are interpolated over triangles.
    SmoothNormals,
    /// The ray/triangle test.
    Intersection,
    /// The ray/sphere test.
    SphereTest,
    /// The precision of ray/shape tests.
    Precision,
    /// The acceleration structure.
    Accelerator,
    /// The split strategy of a hierarchy.
    Split,
    /// The most primitives in a leaf.
    LeafSize,
    /// Cells of a grid along its longest side.
    GridResolution,
}

impl Parameter {
    /// All parameters by their names on the command line.
    pub const NAMES: [(&str, Parameter); 18] = [
        ("samples", Parameter::Samples),
        ("sampler", Parameter::Sampler),
        ("light-samples", Parameter::LightSamples),
        ("glossy-samples", Parameter::GlossySamples),
        ("depth", Parameter::Depth),
        ("min-contribution", Parameter::MinContribution),
        ("next-event", Parameter::NextEvent),
        ("roulette-from", Parameter::RouletteFrom),
        ("clamp", Parameter::Clamp),
        ("texture-filter", Parameter::TextureFilter),
        ("smooth-normals", Parameter::SmoothNormals),
        ("intersection", Parameter::Intersection),
        ("sphere-test", Parameter::SphereTest),
        ("precision", Parameter::Precision),
        ("accelerator", Parameter::Accelerator),
        ("split", Parameter::Split),
        ("leaf-size", Parameter::LeafSize),
        ("grid-resolution", Parameter::GridResolution),
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Parameter::Samples => "samples per pixel",
            Parameter::Sampler => "sampler",
            Parameter::LightSamples => "light samples",
            Parameter::GlossySamples => "glossy samples",
            Parameter::Depth => "depth",
            Parameter::MinContribution => "minimum contribution",
            Parameter::NextEvent => "next-event estimation",
            Parameter::RouletteFrom => "roulette from bounce",
            Parameter::Clamp => "clamp of samples",
            Parameter::TextureFilter => "texture filter",
            Parameter::SmoothNormals => "smooth normals",
            Parameter::Intersection => "intersection",
            Parameter::SphereTest => "sphere test",
            Parameter::Precision => "precision",
            Parameter::Accelerator => "accelerator",
            Parameter::Split => "split",
            Parameter::LeafSize => "leaf size",
            Parameter::GridResolution => "grid resolution",
        }
    }

    /// Whether the parameter decides only how hits are found: if all tests are right, all values make the
    /// same picture.
    pub fn is_geometric(self) -> bool {
        !matches!(
            self,
            Parameter::Samples
                | Parameter::Sampler
                | Parameter::LightSamples
                | Parameter::GlossySamples
                | Parameter::Depth
                | Parameter::MinContribution
                | Parameter::NextEvent
                | Parameter::RouletteFrom
                | Parameter::Clamp
                | Parameter::TextureFilter
                | Parameter::SmoothNormals
        )
    }

    /// Whether `--equal-time` measures the parameter, if it names `turned`: samples and samplers have times of their own, and
    /// structures and tests, which do not change the picture, are measured only if they are named.
    pub fn has_equal_time(self, turned: &[Parameter]) -> bool {
        let is_about_samples = matches!(self, Parameter::Samples | Parameter::Sampler);
        !is_about_samples && (!self.is_geometric() || turned.contains(&self))
    }
}
