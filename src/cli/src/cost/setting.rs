//! A setting: the values of all parameters.

use super::parameter::Parameter;
use glam::Vec3;
use raykata::effects::Effect;
use raykata::material::Fresnel;
use raykata::scene::{Quality, Scene};
use raykata::shape::Shape;
use std::collections::BTreeMap;

/// A change of the scene itself, for parameters that are no setting of its quality.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Meshes lose their smooth normals.
    Flat,
    /// Curved surfaces have 2^-k times as many steps, and meshes are subdivided k times less.
    Coarser(u32),
    /// All surfaces with transmission or with a formula of Fresnel have this formula.
    Fresnel(Fresnel),
    /// Ambient light of this brightness in place of indirect light.
    Ambient(f32),
}

/// The values of all parameters for one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    pub quality: Quality,
    /// What is changed in the scene, by its parameter.
    pub changes: BTreeMap<Parameter, Change>,
}

impl Setting {
    /// The scene's own setting.
    pub fn of(scene: &Scene) -> Setting {
        Setting { quality: scene.quality, changes: BTreeMap::new() }
    }

    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        scene.quality = self.quality;
        for change in self.changes.values() {
            change.apply(&mut scene);
        }
        scene
    }

    /// The same setting with the value of one parameter taken from `to`.
    pub fn turned(&self, parameter: Parameter, to: &Setting) -> Setting {
        let mut turned = self.clone();
        turned.quality.take(parameter.key(), &to.quality);
        match to.changes.get(&parameter) {
            Some(change) => turned.changes.insert(parameter, change.clone()),
            None => turned.changes.remove(&parameter),
        };
        turned
    }

    /// The names of the parameters in which two settings differ.
    pub fn differences(&self, other: &Setting) -> Vec<&'static str> {
        let mut keys = self.quality.differences(&other.quality);
        let differs = |parameter: &Parameter| self.changes.get(parameter) != other.changes.get(parameter);
        keys.extend(
            Parameter::NAMES.map(|(_, one)| one).iter().filter(|one| differs(one)).map(|one| one.key()),
        );
        keys
    }
}

impl Change {
    fn apply(&self, scene: &mut Scene) {
        match *self {
            Change::Flat => *scene = Effect::SmoothNormals.removed_from(scene),
            Change::Coarser(k) => {
                for node in &mut scene.nodes {
                    if let Some(Shape::Bezier { steps, .. } | Shape::Nurbs { steps, .. }) = &mut node.shape {
                        *steps = (*steps >> k).max(1);
                    }
                }
                for mesh in &mut scene.meshes {
                    mesh.subdivisions = mesh.subdivisions.saturating_sub(k);
                }
            }
            Change::Fresnel(formula) => {
                let has = |material: &&mut raykata::material::Material| {
                    material.transmission != Vec3::ZERO || material.fresnel != Fresnel::None
                };
                scene.materials.iter_mut().filter(has).for_each(|material| material.fresnel = formula);
            }
            Change::Ambient(light) => {
                scene.indirect_light = false;
                scene.ambient = Vec3::splat(light);
            }
        }
    }
}
