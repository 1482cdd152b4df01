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
    /// All parameters by their names on the command line: the keys of their settings.
    pub const NAMES: [(&str, Parameter); 17] = [
        ("samples_per_pixel", Parameter::Samples),
        ("sampler", Parameter::Sampler),
        ("light_samples", Parameter::LightSamples),
        ("glossy_samples", Parameter::GlossySamples),
        ("max_depth", Parameter::Depth),
        ("min_contribution", Parameter::MinContribution),
        ("next_event", Parameter::NextEvent),
        ("clamp", Parameter::Clamp),
        ("texture_filter", Parameter::TextureFilter),
        ("smooth_normals", Parameter::SmoothNormals),
        ("triangle_method", Parameter::Intersection),
        ("sphere_method", Parameter::SphereTest),
        ("precision", Parameter::Precision),
        ("accelerator", Parameter::Accelerator),
        ("split", Parameter::Split),
        ("leaf_size", Parameter::LeafSize),
        ("grid_resolution", Parameter::GridResolution),
    ];

    /// The key of the setting; `smooth_normals`, which the meshes of a scene have, is none.
    pub fn key(self) -> &'static str {
        Parameter::NAMES.iter().find(|(_, one)| *one == self).map_or("", |(key, _)| key)
    }

    /// The name in reports.
    pub fn name(self) -> String {
        match self {
            Parameter::Depth => "depth".into(),
            Parameter::MinContribution => "minimum contribution".into(),
            Parameter::NextEvent => "next-event estimation".into(),
            Parameter::Clamp => "clamp of samples".into(),
            Parameter::Intersection => "intersection".into(),
            Parameter::SphereTest => "sphere test".into(),
            other => other.key().replace('_', " "),
        }
    }

    /// Whether the parameter decides only how hits are found: if all tests are right, all values make the
    /// same picture. The parameters that change it come first.
    pub fn is_geometric(self) -> bool {
        self >= Parameter::Intersection
    }

    /// Whether `--equal-time` measures the parameter, if it names `turned`: samples and samplers have times of their own, and
    /// structures and tests, which do not change the picture, are measured only if they are named.
    pub fn has_equal_time(self, turned: &[Parameter]) -> bool {
        let is_about_samples = matches!(self, Parameter::Samples | Parameter::Sampler);
        !is_about_samples && (!self.is_geometric() || turned.contains(&self))
    }
}
