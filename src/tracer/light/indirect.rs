//! What the paths of indirect light sample: the emitters and the environment map of a scene.

use super::emitters::Emitters;
use super::environment::EnvironmentTable;
use crate::light_path::{ChosenEmitter, PathEffects};
use crate::scene::{Background, EnvironmentMap, NextEvent, Scene};
use crate::tracer::search::hit::Hit;
use crate::world::World;
use glam::Vec3;

/// What the paths of a frame sample. It is built once and shared by all threads.
pub struct IndirectLight {
    /// The surfaces that are sampled; none without next-event estimation.
    pub(super) emitters: Emitters,
    /// The environment map with the table from which it is sampled, and the probability of the choice to sample it.
    pub(super) environment: Option<(EnvironmentMap, EnvironmentTable, f32)>,
    /// For each material whether diffuse rays leave its surfaces.
    pub(super) diffuse: Vec<bool>,
    /// For each material whether it is that of a visible light, which `shade` samples.
    pub(super) is_light: Vec<bool>,
    /// Whether light that is sampled is never added when a ray finds it by chance.
    pub(super) samples_only: bool,
}

impl IndirectLight {
    /// Collects what the paths of `scene`, flattened to `world`, sample as far as `paths` calls for it.
    pub fn new(scene: &Scene, world: &World, paths: &PathEffects) -> IndirectLight {
        let mut is_light = vec![false; scene.materials.len()];
        for visible in &scene.visible_lights {
            is_light[visible.material] = true;
        }
        let samples = scene.quality.next_event != NextEvent::Off;
        let is_sampled =
            |material: usize| samples && paths.sampled.get(material) == Some(&true) && !is_light[material];
        let emitters = Emitters::new(world, is_sampled);
        let environment = match scene.background {
            Background::Map(map) if samples && paths.environment => {
                let table = EnvironmentTable::new(&map, &world.textures[map.texture]);
                // The map has no power that could be compared with that of emitters: its distance is infinite.
                table.map(|table| (map, table, if emitters.is_empty() { 1.0 } else { 0.5 }))
            }
            _ => None,
        };
        IndirectLight {
            emitters,
            environment,
            diffuse: paths.diffuse.clone(),
            is_light,
            samples_only: scene.quality.next_event == NextEvent::Only,
        }
    }

    /// The probability with which a vertex samples the environment map and not an emitter.
    pub(super) fn share_of_environment(&self) -> f32 {
        self.environment.as_ref().map_or(0.0, |(_, _, share)| *share)
    }

    /// The emitter to which `point` of the surface that is hit belongs; `None` if it is not sampled.
    #[cold]
    pub(super) fn emitter_at(&self, hit: &Hit, point: Vec3) -> Option<ChosenEmitter> {
        let mut chosen = self.emitters.at(hit.target, point)?;
        chosen.probability *= 1.0 - self.share_of_environment();
        Some(chosen)
    }

    /// Whether anything is sampled.
    pub(super) fn samples(&self) -> bool {
        !self.emitters.is_empty() || self.environment.is_some()
    }

    /// Whether there is more than one light to choose from.
    pub(super) fn has_choice(&self) -> bool {
        self.emitters.len() + usize::from(self.environment.is_some()) > 1
    }
}
