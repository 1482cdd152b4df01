//! The parameters that trade accuracy for time, each with a ladder of values, and which of them a scene needs.

use super::called::Called;
use super::parameter::Parameter;
use super::setting::{Change, Setting};
use crate::report::Thousands;
use raykata::effects::Effect;
use raykata::material::{Emitter, Fresnel, Light};
use raykata::scene::load::set;
use raykata::scene::{
    Accelerator, Field, NextEvent, Precision, Quality, Sampler, Scene, SphereMethod, Split, TextureFilter,
    TriangleMethod,
};
use std::collections::BTreeSet;

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
    /// The ladders of the parameter for this scene, or the reason why it changes nothing there. The scene names a structure,
    /// not [`Accelerator::Auto`], which would choose another one for another split or leaf size. So the levels of a ladder
    /// differ in this parameter alone.
    pub fn ladders(self, called: &Called<'_>) -> Result<Vec<Ladder>, String> {
        let Called { scene, effects, primitives, most_samples, shares_meshes } = called;
        let mut quality = scene.quality;
        let mirrors = effects.calls_for(Effect::Mirrors) || effects.calls_for(Effect::Transmission);
        let indirect = effects.calls_for(Effect::IndirectLight);
        let needs = |called_for: bool, why: &str| if called_for { Ok(()) } else { Err(why.to_owned()) };
        let mut name = self.name().to_owned();
        if matches!(self, Parameter::Split | Parameter::LeafSize) {
            needs(
                quality.accelerator.is_hierarchy() || quality.accelerator.is_wide(),
                "the accelerator is not a hierarchy",
            )?;
            // A wide tree is built by stage 12, which has neither.
            if quality.accelerator.is_wide() {
                quality.accelerator = Accelerator::Bvh;
                name += ", in a bvh";
            }
        }
        let ladder = |levels: Vec<(String, Quality)>| {
            let setting = |quality| Setting { quality, ..Setting::of(scene) };
            let levels = levels.into_iter().map(|(name, quality)| (name, setting(quality))).collect();
            Ladder { parameter: self, name: name.clone(), levels, left_out: Vec::new() }
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
        let named = |levels: Vec<(&str, Quality)>| {
            let levels = levels.into_iter().map(|(name, quality)| (name.to_owned(), quality));
            Ok(vec![ladder(levels.collect())])
        };
        // A level per change of the scene; the scene itself is one of them.
        let changed = |changes: Vec<(String, Option<Change>)>| {
            let level = |(name, change): (String, Option<Change>)| {
                let changes = change.map(|change| (self, change)).into_iter().collect();
                (name, Setting { changes, ..Setting::of(scene) })
            };
            Ok(vec![Ladder { levels: changes.into_iter().map(level).collect(), ..ladder(Vec::new()) }])
        };
        match self {
            Parameter::Samples => numbers(doubling(quality.samples_per_pixel, *most_samples)),
            Parameter::Sampler => {
                let of = |(name, sampler): (&str, Sampler)| {
                    let with = |samples_per_pixel: u32| {
                        (samples_per_pixel.to_string(), Quality { sampler, samples_per_pixel, ..quality })
                    };
                    // Samples in the centre never spread, so one of them shows what more show.
                    let counts = match sampler {
                        Sampler::Center => vec![1],
                        _ => doubling(quality.samples_per_pixel, *most_samples),
                    };
                    Ladder { name: name.replace('_', " "), ..ladder(counts.into_iter().map(with).collect()) }
                };
                Ok(Sampler::NAMES.into_iter().map(of).collect())
            }
            Parameter::LightSamples => {
                let is_area = |light: &Light| matches!(light.emitter, Emitter::Area { .. });
                let is_off = quality.light_samples == 0 && scene.lights.iter().any(is_area);
                needs(is_off || effects.lights.iter().any(|light| light.area), "no light has an area")?;
                numbers([vec![0], doubling(quality.light_samples, 16)].concat())
            }
            Parameter::GlossySamples => {
                needs(effects.calls_for(Effect::Glossy), "no rough surface reflects or transmits light")?;
                needs(!indirect, "a path of indirect light continues with one ray per hit")?;
                numbers(doubling(quality.glossy_samples, 16))
            }
            Parameter::Depth => {
                needs(mirrors || indirect, "no surface reflects or transmits light")?;
                let depths = if indirect { [1, 2, 4, 8, 16] } else { [0, 1, 2, 3, 5] };
                numbers(ascending(depths.into_iter().chain([least_depth(scene), quality.max_depth])))
            }
            Parameter::NextEvent => {
                needs(indirect, "the scene has no indirect light")?;
                named(vec![
                    ("off: by chance", Quality { next_event: NextEvent::Off, ..quality }),
                    ("only: by samples", Quality { next_event: NextEvent::Only, ..quality }),
                    ("on: both, weighted", Quality { next_event: NextEvent::On, ..quality }),
                ])
            }
            Parameter::Clamp => {
                needs(indirect, "the scene has no indirect light")?;
                let own = Some(quality.clamp).filter(|own| *own > 0.0);
                let limits = falling([1.0, 10.0, 100.0].into_iter().chain(own));
                let with = |clamp: f32| (clamp.to_string(), Quality { clamp, ..quality });
                let none = ("none".to_owned(), Quality { clamp: 0.0, ..quality });
                Ok(vec![ladder(limits.into_iter().rev().map(with).chain([none]).collect())])
            }
            Parameter::IndirectLight => {
                needs(indirect, "the scene has no indirect light")?;
                let ambient = |light: f32| (format!("ambient {light}"), Some(Change::Ambient(light)));
                let without = [0.0, 0.05, 0.2].map(ambient);
                changed(without.into_iter().chain([("paths".to_owned(), None)]).collect())
            }
            Parameter::Fresnel => {
                let own = |formula| Setting {
                    changes: [(self, Change::Fresnel(formula))].into(),
                    ..Setting::of(scene)
                };
                let is_own = |formula| own(formula).apply(scene).materials == scene.materials;
                let has_one = !(is_own(Fresnel::None) && is_own(Fresnel::Exact));
                needs(has_one && effects.calls_for(Effect::Transmission), "no surface transmits light")?;
                let formulas =
                    [("none", Fresnel::None), ("schlick", Fresnel::Schlick), ("exact", Fresnel::Exact)];
                let level = |(name, formula): (&str, Fresnel)| {
                    (name.to_owned(), (!is_own(formula)).then_some(Change::Fresnel(formula)))
                };
                let mixed = formulas.iter().all(|(_, formula)| !is_own(*formula));
                let mixed = mixed.then(|| ("as in the scene".to_owned(), None));
                changed(formulas.map(level).into_iter().chain(mixed).collect())
            }
            Parameter::MinContribution => {
                needs(!indirect, "Russian roulette ends the paths of indirect light")?;
                needs(mirrors, "no surface reflects or transmits light")?;
                let least = falling([0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, quality.min_contribution]);
                levels(&least.iter().map(f32::to_string).collect::<Vec<_>>())
            }
            Parameter::TextureFilter => {
                needs(effects.calls_for(Effect::Textures), "no surface shows an image")?;
                levels(&TextureFilter::NAMES.map(|(name, _)| name.to_owned()))
            }
            Parameter::SmoothNormals => {
                needs(effects.calls_for(Effect::SmoothNormals), "no mesh has smooth normals")?;
                changed(vec![("flat".to_owned(), Some(Change::Flat)), ("smooth".to_owned(), None)])
            }
            Parameter::Tessellation => {
                let halvings = called.tessellation();
                needs(halvings > 0, "there is no curved surface of several steps and no subdivided mesh")?;
                let level = |k: u32| match k {
                    0 => ("the scene's steps".to_owned(), None),
                    _ => (format!("1/{} of the steps", 1 << k), Some(Change::Coarser(k))),
                };
                changed((0..=halvings.min(4)).rev().map(level).collect())
            }
            Parameter::RayOffset => {
                needs(mirrors || indirect || effects.calls_for(Effect::Shadows), "no ray leaves a surface")?;
                let own = Some(quality.ray_offset).filter(|own| *own > 0.0);
                let offsets = falling((2..=7).map(|power| 10f32.powi(-power)).chain(own));
                let with = |ray_offset| (format!("{ray_offset:e}"), Quality { ray_offset, ..quality });
                let bound = ("error bound".to_owned(), Quality { ray_offset: 0.0, ..quality });
                Ok(vec![ladder(offsets.into_iter().map(with).chain([bound]).collect())])
            }
            Parameter::Intersection => {
                needs(called.shows_triangles(), "there are no triangles")?;
                needs(quality.precision == Precision::Single, DOUBLE)?;
                // With the watertight test last: it is the default, and it takes longest.
                levels(&TriangleMethod::NAMES.map(|(name, _)| name.to_owned()))
            }
            Parameter::SphereTest => {
                needs(called.shows_spheres(), "there are no spheres")?;
                needs(quality.precision == Precision::Single, DOUBLE)?;
                levels(&SphereMethod::NAMES.map(|(name, _)| name.to_owned()))
            }
            Parameter::Precision => {
                needs(
                    called.shows_triangles() || called.shows_spheres(),
                    "there are no triangles and no spheres, and other shapes have one test each",
                )?;
                levels(&Precision::NAMES.map(|(name, _)| name.to_owned()))
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
                let with = |accelerator| (name(accelerator), Quality { accelerator, ..quality });
                let why = |one: Accelerator| {
                    let (name, most) = (name(one), Thousands(most(one)));
                    format!(
                        "accelerator {name}: only for scenes with at most {most} primitives; see `raykata \
                         compare`"
                    )
                };
                let left_out = dear.into_iter().map(why).collect();
                Ok(vec![Ladder { left_out, ..ladder(offered.into_iter().map(with).collect()) }])
            }
            Parameter::Split => levels(&Split::NAMES.map(|(name, _)| name.to_owned())),
            Parameter::LeafSize => numbers(doubling(quality.leaf_size, 16)),
            Parameter::GridResolution => {
                needs(
                    quality.accelerator == Accelerator::Grid,
                    "the accelerator is not a grid (`--accelerator grid` selects one)",
                )?;
                let cells = ascending([0, 8, 16, 32, 64, 128, quality.grid_resolution]);
                let name = |n: u32| if n == 0 { "formula".to_owned() } else { n.to_string() };
                let with = |grid_resolution| (name(grid_resolution), Quality { grid_resolution, ..quality });
                Ok(vec![ladder(cells.into_iter().map(with).collect())])
            }
            Parameter::KdHeuristics => {
                needs(
                    quality.accelerator == Accelerator::KdTree,
                    "the accelerator is not a kd-tree (`--accelerator kd_tree` selects one)",
                )?;
                Ok(vec![ladder(switched(&quality, self.key()))])
            }
            Parameter::Savings => {
                needs(
                    called.searches_the_graph(),
                    "the scene graph is not searched (`--accelerator bounding_boxes` searches it)",
                )?;
                Ok(vec![ladder(switched(&quality, self.key()))])
            }
            Parameter::Copies => {
                needs(*shares_meshes, "no mesh has several instances")?;
                named(vec![
                    ("instances", Quality { copies: false, ..quality }),
                    ("copies", Quality { copies: true, ..quality }),
                ])
            }
        }
    }
}

/// Why a parameter of single precision is not offered.
const DOUBLE: &str = "the precision is double, which has one test per shape";

/// A level with all switches as they are, and one per switch in which it is turned.
fn switched(own: &Quality, key: &str) -> Vec<(String, Quality)> {
    let mut levels = vec![("as in the scene".to_owned(), *own)];
    for index in 0.. {
        let mut quality = *own;
        let Some(Field::Switches(switches)) = quality.field(key) else { break };
        let Some((name, is_on)) = switches.switches().into_iter().nth(index) else { break };
        *is_on = !*is_on;
        let with = if *is_on { "with" } else { "without" };
        let name = format!("{with} {}", name.replace('_', " "));
        levels.push((name, quality));
    }
    levels
}

/// The numbers 1, 2, 4 … up to `most`, or up to the scene's own value if that is larger, with the scene's own value.
fn doubling(own: u32, most: u32) -> Vec<u32> {
    let last = most.max(own.next_power_of_two());
    let powers = (0..32).map(|power| 1 << power).take_while(|value| *value <= last);
    ascending(powers.chain([own.max(1)]))
}

/// The values from the smallest on, each once.
fn ascending(values: impl IntoIterator<Item = u32>) -> Vec<u32> {
    BTreeSet::from_iter(values).into_iter().collect()
}

/// The values from the largest on, each once.
fn falling(values: impl IntoIterator<Item = f32>) -> Vec<f32> {
    let mut values = Vec::from_iter(values);
    values.sort_by(|a, b| b.total_cmp(a));
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kits::{Need, Source, Which, root};
    use crate::report::load_scene;
    use raykata::effects::Effects;
    use raykata::kit::Kit;
    use raykata::scene::load::Limits;
    use std::collections::HashMap;
    use std::sync::Arc;

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
        use Parameter::*;
        for parameter in [Samples, Sampler, Precision, Accelerator] {
            assert!(parameter.ladders(&called(&scene, &effects)).is_ok(), "{parameter:?}");
        }
        for parameter in [
            LightSamples,
            GlossySamples,
            Depth,
            Intersection,
            GridResolution,
            NextEvent,
            Clamp,
            RayOffset,
            Copies,
        ] {
            assert!(parameter.ladders(&called(&scene, &effects)).is_err(), "{parameter:?}");
        }
    }

    fn called<'a>(scene: &'a Scene, effects: &'a Effects) -> Called<'a> {
        Called { scene, effects, primitives: 1, most_samples: 64, shares_meshes: effects.indirect_light }
    }

    /// The structure by which the reference renders with each setting that decides it.
    struct Plans {
        kit: Arc<dyn Kit + Send + Sync>,
        known: HashMap<(&'static str, Split, u32), Accelerator>,
    }

    impl Plans {
        fn accelerator(&mut self, quality: &Quality) -> Accelerator {
            let Quality { accelerator, split, leaf_size, .. } = *quality;
            *self.known.entry((accelerator.name(), split, leaf_size)).or_insert_with(|| {
                let mut scene = crate::report::scene_of_kit("stage2");
                (scene.film.width, scene.film.height) = (1, 1);
                scene.quality = Quality { accelerator, split, leaf_size, ..scene.quality };
                let frame = crate::report::render(&*self.kit, &crate::report::job(scene)).expect("renders");
                frame.accelerator.expect("the reference has a structure")
            })
        }
    }

    /// The levels of each ladder of each scene, in the scene's own structure and in those that have ladders of their own, differ
    /// in the plan in the parameter of the ladder and in nothing else.
    #[test]
    fn levels_of_a_ladder_differ_in_one_parameter_of_the_plan() {
        let root = root().expect("the kit");
        if !root.join("solutions").is_dir() {
            return println!("a hand-out has no reference, whose plans have every parameter");
        }
        let source = Source::prepare(&root, Which::Solutions, Need::Frames).expect("the solutions");
        let mut plans = Plans { kit: source.fresh(), known: HashMap::new() };
        let mut seen = BTreeSet::new();
        for file in std::fs::read_dir(root.join("scenes")).expect("scenes").flatten() {
            let path = file.path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let scene = load_scene(&path, Limits::default()).unwrap_or_else(|error| panic!("{error}"));
            let own = plans.accelerator(&scene.quality);
            // Some ladders are for scenes with indirect light and some for those without.
            for (accelerator, indirect_light) in [
                (own, false),
                (own, true),
                (Accelerator::Grid, false),
                (Accelerator::KdTree, false),
                (Accelerator::BoundingBoxes, false),
            ] {
                let mut scene = scene.clone();
                scene.quality.accelerator = accelerator;
                let effects = Effects { indirect_light, ..Effects::everything(&scene) };
                for (_, parameter) in Parameter::NAMES {
                    let Ok(ladders) = parameter.ladders(&called(&scene, &effects)) else { continue };
                    seen.insert(parameter);
                    // Each sampler has a ladder of samples.
                    let key =
                        if parameter == Parameter::Sampler { "samples_per_pixel" } else { parameter.key() };
                    for ladder in ladders {
                        let plan = |(name, setting): &(String, Setting)| {
                            let mut setting = setting.clone();
                            let used = plans.accelerator(&setting.quality);
                            // Only the builder of stage 3 has splits and leaf sizes.
                            let has_both = used.is_hierarchy() && used != Accelerator::Auto;
                            assert!(has_both || !["split", "leaf_size"].contains(&key), "{}", ladder.name);
                            setting.quality.accelerator = used;
                            (name.clone(), setting)
                        };
                        let levels: Vec<_> = ladder.levels.iter().map(plan).collect();
                        for (i, (one, plan)) in levels.iter().enumerate() {
                            for (other, second) in &levels[i + 1..] {
                                let place = format!("{}: {} {one} and {other}", path.display(), ladder.name);
                                assert_eq!(plan.differences(second), [key], "{place}");
                            }
                        }
                    }
                }
            }
        }
        let never: Vec<_> = Parameter::NAMES.iter().filter(|(_, one)| !seen.contains(one)).collect();
        assert!(never.is_empty(), "no scene has a ladder of {never:?}");
    }
}
