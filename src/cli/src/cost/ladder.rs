//! The parameters that trade accuracy for time, each with a ladder of values, and which of them a scene needs.

use super::called::Called;
use super::parameter::Parameter;
use super::setting::Setting;
use crate::report::Thousands;
use raykata::effects::Effect;
use raykata::scene::load::set;
use raykata::scene::{
    Accelerator, NextEvent, Precision, Quality, Sampler, Scene, SphereMethod, Split, TextureFilter,
    TriangleMethod,
};

/// A series of values of a parameter, from cheap to expensive.
pub struct Ladder {
    pub parameter: Parameter,
    /// The name of the ladder, because a parameter can have several.
    pub name: String,
    /// The name and the setting of each level.
    pub levels: Vec<(String, Setting)>,
    /// Sentences about values that are left out because they would take too long.
    pub left_out: Vec<String>,
}

/// Structures that test most primitives with each ray are measured up to this number of primitives. Above it, one
/// measurement takes minutes.
const MOST_ASKED: u64 = 2_000;

/// The most primitives for a BSP tree: over more it takes more than ten seconds to build, and it is built for
/// every picture.
const MOST_IN_BSP: u64 = 500_000;

/// The depth of paths in the reference, which the ladder of depths reaches at least. Paths of indirect light go on for
/// longer: at an albedo of 0.8 and 32 bounces less than a thousandth of the light is missing.
pub fn least_depth(scene: &Scene) -> u32 {
    if scene.indirect_light { 32 } else { 8 }
}

impl Parameter {
    /// The ladders of the parameter for this scene, or the reason why it changes nothing there.
    pub fn ladders(self, called: &Called<'_>) -> Result<Vec<Ladder>, String> {
        let Called { scene, effects, primitives, most_samples } = called;
        let quality = scene.quality;
        let mirrors = effects.calls_for(Effect::Mirrors) || effects.calls_for(Effect::Transmission);
        let indirect = effects.calls_for(Effect::IndirectLight);
        let hierarchy = quality.accelerator.is_hierarchy();
        let needs = |called_for: bool, why: &str| if called_for { Ok(()) } else { Err(why.to_owned()) };
        let ladder = |levels: Vec<(String, Quality)>| {
            let levels = levels.into_iter().map(|(name, quality)| (name, Setting { quality, smooth: true }));
            Ladder { parameter: self, name: self.name(), levels: levels.collect(), left_out: Vec::new() }
        };
        // A level per value of the setting, read as the command line reads it.
        let levels = |values: &[String]| {
            let level = |value: &String| {
                let mut quality = quality;
                set(&mut quality, self.key(), value).map_err(|error| error.message)?;
                Ok((value.replace('_', " "), quality))
            };
            Ok::<_, String>(vec![ladder(values.iter().map(level).collect::<Result<_, String>>()?)])
        };
        let numbers = |values: Vec<u32>| levels(&values.iter().map(u32::to_string).collect::<Vec<_>>());
        let ladders = match self {
            Parameter::Samples => numbers(doubling(quality.samples_per_pixel, *most_samples))?,
            Parameter::Sampler => {
                let of = |(name, sampler): (&str, Sampler)| {
                    let with = |samples_per_pixel: u32| {
                        (samples_per_pixel.to_string(), Quality { sampler, samples_per_pixel, ..quality })
                    };
                    let counts = doubling(quality.samples_per_pixel, *most_samples);
                    Ladder { name: name.replace('_', " "), ..ladder(counts.into_iter().map(with).collect()) }
                };
                // Without samples in the centre, which never spread.
                Sampler::NAMES.into_iter().filter(|(_, one)| *one != Sampler::Center).map(of).collect()
            }
            Parameter::LightSamples => {
                needs(effects.lights.iter().any(|light| light.area), "no light has an area")?;
                numbers(doubling(quality.light_samples, 16))?
            }
            Parameter::GlossySamples => {
                needs(effects.calls_for(Effect::Glossy), "no rough surface reflects or transmits light")?;
                needs(!indirect, "a path of indirect light continues with one ray per hit")?;
                numbers(doubling(quality.glossy_samples, 16))?
            }
            Parameter::Depth => {
                needs(mirrors || indirect, "no surface reflects or transmits light")?;
                let mut depths = if indirect { vec![1, 2, 4, 8, 16] } else { vec![0, 1, 2, 3, 5] };
                depths.push(least_depth(scene));
                depths.push(quality.max_depth);
                depths.sort_unstable();
                depths.dedup();
                numbers(depths)?
            }
            Parameter::NextEvent => {
                needs(indirect, "the scene has no indirect light")?;
                let all = [
                    ("off: by chance", NextEvent::Off),
                    ("only: by samples", NextEvent::Only),
                    ("on: both, weighted", NextEvent::On),
                ];
                let with =
                    |(name, next_event): (&str, _)| (name.to_owned(), Quality { next_event, ..quality });
                vec![ladder(all.into_iter().map(with).collect())]
            }
            Parameter::Clamp => {
                needs(indirect, "the scene has no indirect light")?;
                let mut limits = vec![1.0, 10.0, 100.0, quality.clamp];
                // No limit, which is 0, comes last.
                limits.sort_by(|a: &f32, b| (*a == 0.0).cmp(&(*b == 0.0)).then(a.total_cmp(b)));
                limits.push(0.0);
                limits.dedup();
                let with = |clamp: f32| {
                    let name = if clamp == 0.0 { "none".to_owned() } else { clamp.to_string() };
                    (name, Quality { clamp, ..quality })
                };
                vec![ladder(limits.into_iter().map(with).collect())]
            }
            Parameter::MinContribution => {
                needs(!indirect, "Russian roulette ends the paths of indirect light")?;
                needs(mirrors, "no surface reflects or transmits light")?;
                let mut least = vec![0.1, 0.03, 0.01, 0.003, 0.001, 0.0003];
                least.push(quality.min_contribution);
                least.sort_by(|a: &f32, b| b.total_cmp(a));
                least.dedup();
                levels(&least.iter().map(f32::to_string).collect::<Vec<_>>())?
            }
            Parameter::TextureFilter => {
                needs(effects.calls_for(Effect::Textures), "no surface shows an image")?;
                levels(&TextureFilter::NAMES.map(|(name, _)| name.to_owned()))?
            }
            Parameter::SmoothNormals => {
                needs(effects.calls_for(Effect::SmoothNormals), "no mesh has smooth normals")?;
                let levels = [("flat", false), ("smooth", true)]
                    .map(|(name, smooth)| (name.to_owned(), Setting { quality, smooth }));
                vec![Ladder { levels: levels.to_vec(), ..ladder(Vec::new()) }]
            }
            Parameter::Intersection => {
                needs(called.shows_triangles(), "there are no triangles")?;
                // With the watertight test last: it is the default, and it takes longest.
                levels(&TriangleMethod::NAMES.map(|(name, _)| name.to_owned()))?
            }
            Parameter::SphereTest => {
                needs(called.shows_spheres(), "there are no spheres")?;
                needs(
                    quality.precision == Precision::Single,
                    "the precision is double, which has one sphere test",
                )?;
                levels(&SphereMethod::NAMES.map(|(name, _)| name.to_owned()))?
            }
            Parameter::Precision => {
                needs(
                    called.shows_triangles() || called.shows_spheres(),
                    "there are no triangles and no spheres, and other shapes have one test each",
                )?;
                levels(&Precision::NAMES.map(|(name, _)| name.to_owned()))?
            }
            Parameter::Accelerator => {
                let most = |one: Accelerator| match one {
                    Accelerator::BruteForce
                    | Accelerator::BoundingBoxes
                    | Accelerator::BoundingSpheres
                    | Accelerator::CachedBoundingBoxes => MOST_ASKED,
                    Accelerator::Bsp | Accelerator::PolygonBsp => MOST_IN_BSP,
                    _ => u64::MAX,
                };
                let name = |one: Accelerator| one.name().replace('_', " ");
                let (offered, dear): (Vec<_>, Vec<_>) =
                    Accelerator::ALL.into_iter().partition(|&one| *primitives <= most(one));
                // The structure that the kit chooses is a value of its own, because it may be the scene's.
                let auto = (quality.accelerator == Accelerator::Auto).then_some(Accelerator::Auto);
                let offered = auto.into_iter().chain(offered);
                let with = |accelerator| (name(accelerator), Quality { accelerator, ..quality });
                let why = |one: Accelerator| {
                    let (name, most) = (name(one), Thousands(most(one)));
                    format!(
                        "accelerator {name}: only for scenes with at most {most} primitives; see `raykata \
                         compare`"
                    )
                };
                let left_out = dear.into_iter().map(why).collect();
                vec![Ladder { left_out, ..ladder(offered.map(with).collect()) }]
            }
            Parameter::Split => {
                needs(hierarchy, "the accelerator is not a hierarchy")?;
                levels(&Split::NAMES.map(|(name, _)| name.to_owned()))?
            }
            Parameter::LeafSize => {
                needs(hierarchy, "the accelerator is not a hierarchy")?;
                numbers(doubling(quality.leaf_size, 16))?
            }
            Parameter::GridResolution => {
                needs(
                    quality.accelerator == Accelerator::Grid,
                    "the accelerator is not a grid (`--accelerator grid` selects one)",
                )?;
                numbers(vec![8, 16, 32, 64, 128])?
            }
        };
        Ok(ladders)
    }
}

/// The numbers 1, 2, 4 … up to `most`, or up to the scene's own value if that is larger, with the scene's own value.
fn doubling(own: u32, most: u32) -> Vec<u32> {
    let last = most.max(own.next_power_of_two());
    let mut values: Vec<u32> = (0..32).map(|power| 1 << power).take_while(|value| *value <= last).collect();
    values.push(own.max(1));
    values.sort_unstable();
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use raykata::effects::Effects;

    #[test]
    fn the_scenes_own_value_is_a_level() {
        assert_eq!(doubling(1, 16), [1, 2, 4, 8, 16]);
        assert_eq!(doubling(6, 16), [1, 2, 4, 6, 8, 16]);
        assert_eq!(doubling(100, 16), [1, 2, 4, 8, 16, 32, 64, 100, 128]);
        assert_eq!(doubling(0, 4), [1, 2, 4]);
    }

    #[test]
    fn a_parameter_that_buys_nothing_says_why() {
        let scene = crate::report::scene_of_kit("stage1");
        let effects = Effects::default();
        let called = Called { scene: &scene, effects: &effects, primitives: 1, most_samples: 64 };
        use Parameter::*;
        for parameter in [Samples, Sampler, Precision, Accelerator, Split] {
            assert!(parameter.ladders(&called).is_ok(), "{parameter:?}");
        }
        for parameter in [LightSamples, GlossySamples, Depth, Intersection, GridResolution, NextEvent, Clamp]
        {
            assert!(parameter.ladders(&called).is_err(), "{parameter:?}");
        }
    }
}
