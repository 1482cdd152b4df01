//! The parameters that trade accuracy for time, and their names.

use serde::Serialize;

/// A parameter that trades accuracy for time. Those that change the picture come first. `parameters.txt` has their names and what
/// they trade, in the same order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    Samples,
    Sampler,
    LightSamples,
    GlossySamples,
    Depth,
    MinContribution,
    NextEvent,
    Clamp,
    IndirectLight,
    Fresnel,
    TextureFilter,
    SmoothNormals,
    Tessellation,
    RayOffset,
    Intersection,
    SphereTest,
    Precision,
    Accelerator,
    Split,
    LeafSize,
    GridResolution,
    KdHeuristics,
    Savings,
    Copies,
}

impl Parameter {
    /// All parameters by their names on the command line: the keys of their settings. Four have none and change the scene:
    /// `indirect_light`, `fresnel`, `smooth_normals` and `tessellation`.
    pub const NAMES: [(&str, Parameter); 24] = [
        ("samples_per_pixel", Parameter::Samples),
        ("sampler", Parameter::Sampler),
        ("light_samples", Parameter::LightSamples),
        ("glossy_samples", Parameter::GlossySamples),
        ("max_depth", Parameter::Depth),
        ("min_contribution", Parameter::MinContribution),
        ("next_event", Parameter::NextEvent),
        ("clamp", Parameter::Clamp),
        ("indirect_light", Parameter::IndirectLight),
        ("fresnel", Parameter::Fresnel),
        ("texture_filter", Parameter::TextureFilter),
        ("smooth_normals", Parameter::SmoothNormals),
        ("tessellation", Parameter::Tessellation),
        ("ray_offset", Parameter::RayOffset),
        ("triangle_method", Parameter::Intersection),
        ("sphere_method", Parameter::SphereTest),
        ("precision", Parameter::Precision),
        ("accelerator", Parameter::Accelerator),
        ("split", Parameter::Split),
        ("leaf_size", Parameter::LeafSize),
        ("grid_resolution", Parameter::GridResolution),
        ("kd_heuristics", Parameter::KdHeuristics),
        ("savings", Parameter::Savings),
        ("copies", Parameter::Copies),
    ];

    /// The name on the command line, which is the key of the setting if there is one.
    pub fn key(self) -> &'static str {
        Parameter::NAMES[self as usize].0
    }

    /// The name in reports.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// What the parameter trades, in a sentence.
    pub fn trade(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        let line = include_str!("parameters.txt").lines().nth(self as usize);
        line.and_then(|line| line.split_once(": ")).unwrap_or_default()
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

#[cfg(test)]
mod tests {
    use super::Parameter;

    #[test]
    fn every_parameter_has_a_name_and_a_trade() {
        for (place, (key, parameter)) in Parameter::NAMES.into_iter().enumerate() {
            assert_eq!(parameter as usize, place, "{key}");
            assert!(!parameter.name().is_empty() && parameter.trade().ends_with('.'), "{key}");
        }
        assert_eq!(Parameter::Copies.name(), "copies");
    }
}
