//! Nothing to do here: what a picture leaves out while exercises are not written yet.

use crate::{stage2_triangles, stage3_bvh, stage4_shading};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Probe};
use raykata::kit::{Mishap, Surface, View, mishap};
use raykata::material::Material;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality};

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
