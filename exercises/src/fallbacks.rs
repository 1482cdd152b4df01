//! Nothing to do here: what a picture leaves out while exercises are not written yet.

use crate::{stage2_triangles, stage3_bvh, stage4_shading, stage5_recursion};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Probe};
use raykata::kit::{Limits, Mishap, Surface, View, mishap};
use raykata::material::Material;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality};
use raykata::world::World;

/// How the closest hit is sought.
#[derive(Clone, Copy, PartialEq)]
pub enum Search {
    Hierarchy,
    BruteForce,
    /// The last primitive that the ray meets, near or far.
    Painter,
}

pub fn choose_search(quality: &Quality, notes: &mut Vec<String>) -> Search {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let hierarchy = written(|| stage3_bvh::build(&[], quality.split, 1))
        && written(|| stage3_bvh::closest_hit(&Bvh::default(), &mut Nothing, &ray))
        && written(|| stage3_bvh::any_hit(&Bvh::default(), &mut Nothing, &ray))
        && written(|| stage3_bvh::slab(&ray, Vec3::X, &Aabb::EMPTY));
    let brute_force = written(|| stage2_triangles::brute_force(0, &mut Nothing, &ray));
    match quality.accelerator {
        Accelerator::BruteForce | Accelerator::Bvh => {}
        other => notes.push(format!("a hierarchy stands in for {other:?}: stage 9, not built yet")),
    }
    if quality.accelerator != Accelerator::BruteForce && hierarchy {
        return Search::Hierarchy;
    }
    if quality.accelerator != Accelerator::BruteForce {
        notes.push("every ray tests every primitive: stage 3 is not written yet".into());
    }
    if brute_force {
        return Search::BruteForce;
    }
    notes.push(
        "later shapes are painted over earlier ones, near or far: `brute_force` of stage 2 is not written yet".into(),
    );
    Search::Painter
}

pub fn choose_view(wanted: View, notes: &mut Vec<String>) -> View {
    let nowhere =
        Surface { point: Vec3::ZERO, error: Vec3::ZERO, geometric_normal: Vec3::Z, shading_normal: Vec3::Z };
    let material = Material::default();
    let shades =
        written(|| stage4_shading::shade(&nowhere, Vec3::Z, &material, Vec3::ONE, &[], |_, _| false));
    if wanted == View::Shaded && !shades {
        notes.push("normals are shown as colours: stage 4 is not written yet".into());
        return View::Normals;
    }
    wanted
}

/// Whether mirrors and glass send rays on; says so if the scene has any and they do not.
pub fn follows_mirrors(world: &mut World) -> bool {
    let wanted = world.materials.iter().any(|m| m.mirror != Vec3::ZERO || m.transmission != Vec3::ZERO);
    let limits = Limits { max_depth: 0, min_contribution: 0.0 };
    let material = Material::default();
    let follows =
        written(|| stage5_recursion::children(Vec3::NEG_Z, Vec3::Z, true, &material, Vec3::ONE, 0, &limits));
    if wanted && !follows {
        world.notes.push("mirrors and glass send no ray on: stage 5 is not written yet".into());
    }
    follows
}

/// Whether a function does more than say `todo!`.
pub fn written<T>(call: impl FnOnce() -> T) -> bool {
    !matches!(mishap::catch(call), Err(Mishap::NotWritten { .. }))
}

/// A world without anything in it.
struct Nothing;

impl Probe for Nothing {
    fn open(&mut self, _: u32) -> Contents {
        Contents::Leaf { first: 0, count: 0 }
    }
    fn enter(&mut self, _: u32, _: &Ray) -> Option<f32> {
        None
    }
    fn hit(&mut self, _: u32, _: &Ray) -> Option<f32> {
        None
    }
}
