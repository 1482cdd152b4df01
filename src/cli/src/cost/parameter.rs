//! The parameters that trade accuracy for time, and their names.

use serde::Serialize;

/// A parameter that trades accuracy for time.
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

/// A parameter: its name on the command line, which is the key of its setting; its name in reports; and what it trades, in a
/// sentence. Those without a setting change the scene: `smooth_normals`, `tessellation`, `fresnel` and `indirect_light`.
type Row = (Parameter, &'static str, &'static str, &'static str);

/// All parameters. Those that change the picture come first.
const ROWS: [Row; 24] = [
    (
        Parameter::Samples,
        "samples_per_pixel",
        "samples per pixel",
        "More samples cost time and remove noise and jagged edges.",
    ),
    (
        Parameter::Sampler,
        "sampler",
        "sampler",
        "Positions that spread evenly take about as long as random ones and leave less noise.",
    ),
    (
        Parameter::LightSamples,
        "light_samples",
        "light samples",
        "Shadow rays per area light: 0 takes its centre and gives hard shadows, more remove noise in soft ones.",
    ),
    (
        Parameter::GlossySamples,
        "glossy_samples",
        "glossy samples",
        "Rays per rough surface: more remove noise from its reflections.",
    ),
    (Parameter::Depth, "max_depth", "depth", "Longer paths show more reflections of reflections."),
    (
        Parameter::MinContribution,
        "min_contribution",
        "minimum contribution",
        "Rays below this weight are not traced: their light is missing, and their time is saved.",
    ),
    (
        Parameter::NextEvent,
        "next_event",
        "next-event estimation",
        "Samples of the lights cost shadow rays and remove the noise of finding them by chance.",
    ),
    (Parameter::Clamp, "clamp", "clamp of samples", "A limit removes bright specks, and light with them."),
    (
        Parameter::IndirectLight,
        "indirect_light",
        "indirect light",
        "A constant ambient light costs nothing and stands for light that bounces, which takes paths.",
    ),
    (
        Parameter::Fresnel,
        "fresnel",
        "Fresnel",
        "Formulas for the reflectance of glass; the error is against the scene's own formula.",
    ),
    (
        Parameter::TextureFilter,
        "texture_filter",
        "texture filter",
        "Filtering reads an image more often, so that it does not sparkle.",
    ),
    (
        Parameter::SmoothNormals,
        "smooth_normals",
        "smooth normals",
        "Interpolated normals hide the edges of triangles at a small cost per hit.",
    ),
    (
        Parameter::Tessellation,
        "tessellation",
        "tessellation",
        "Fewer triangles per curve or subdivided mesh are built and searched faster; the error is against the scene's own number.",
    ),
    (
        Parameter::RayOffset,
        "ray_offset",
        "ray offset",
        "Rays that start too low hit their own surface (acne), those that start too high pass through close ones (leaks); the error bound does neither and costs a few operations per ray.",
    ),
    (
        Parameter::Intersection,
        "triangle_method",
        "triangle test",
        "A test that lets no ray through an edge computes more per triangle.",
    ),
    (Parameter::SphereTest, "sphere_method", "sphere test", "Formulas that round differently."),
    (Parameter::Precision, "precision", "precision", "Double precision rounds less and takes longer."),
    (
        Parameter::Accelerator,
        "accelerator",
        "accelerator",
        "Structures that take longer to build test fewer primitives per ray.",
    ),
    (
        Parameter::Split,
        "split",
        "split",
        "A split that looks at areas takes longer to build and tests fewer boxes per ray.",
    ),
    (
        Parameter::LeafSize,
        "leaf_size",
        "leaf size",
        "Large leaves save nodes and box tests and cost primitive tests.",
    ),
    (
        Parameter::GridResolution,
        "grid_resolution",
        "grid resolution",
        "Small cells cost steps, and large cells cost primitive tests.",
    ),
    (
        Parameter::KdHeuristics,
        "kd_heuristics",
        "kd heuristics",
        "Each rule of the builder costs build time; without it, rays do more.",
    ),
    (
        Parameter::Savings,
        "savings",
        "graph optimisations",
        "Each of them tests something first, to visit fewer nodes of the scene graph.",
    ),
    (
        Parameter::Copies,
        "copies",
        "copies",
        "A mesh that is copied for each instance needs its memory again and saves transforms of rays.",
    ),
];

impl Parameter {
    /// All parameters by their names on the command line.
    pub const NAMES: [(&str, Parameter); ROWS.len()] = {
        let mut names = [("", Parameter::Samples); ROWS.len()];
        let mut i = 0;
        while i < ROWS.len() {
            names[i] = (ROWS[i].1, ROWS[i].0);
            i += 1;
        }
        names
    };

    fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The name on the command line, which is the key of the setting if there is one.
    pub fn key(self) -> &'static str {
        self.row().1
    }

    /// The name in reports.
    pub fn name(self) -> &'static str {
        self.row().2
    }

    /// What the parameter trades, in a sentence.
    pub fn trade(self) -> &'static str {
        self.row().3
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
    use super::{Parameter, ROWS};

    #[test]
    fn a_row_stands_at_the_place_of_its_parameter() {
        for (place, (parameter, ..)) in ROWS.iter().enumerate() {
            assert_eq!(*parameter as usize, place);
        }
        assert_eq!(Parameter::Copies.key(), "copies");
    }
}
