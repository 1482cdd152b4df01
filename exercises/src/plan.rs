//! Nothing to do here: what a frame will compute, and what it leaves out while exercises are not written yet.

use crate::{
    stage2_triangles, stage3_bvh, stage4_shading, stage5_recursion, stage6_distribution, stage7_effects,
};
use glam::{UVec2, Vec2, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Probe};
use raykata::camera::{Camera, Lens, Shutter};
use raykata::effects::Effects;
use raykata::kit::{Bounce, Child, Limits, Mishap, RenderJob, Surface, View, mishap};
use raykata::material::{Emitter, Light, Material, Texture};
use raykata::mesh::Mesh;
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality, Sampler, Scene};
use raykata::shape::{Disk, Sphere};
use std::sync::Arc;

/// How the closest hit is sought.
#[derive(Clone, Copy, PartialEq)]
pub enum Search {
    Hierarchy,
    BruteForce,
    /// The last primitive that the ray meets, near or far.
    Painter,
}

/// What a frame will compute.
pub struct Plan {
    /// What the scene calls for, as far as it is written.
    pub effects: Effects,
    pub search: Search,
    pub view: View,
    /// Whether normals of vertices can be averaged.
    pub averages_normals: bool,
    /// Whether normals are interpolated over smooth meshes.
    pub smooth: bool,
    /// Whether samples have places of their own in the pixel.
    pub positions: bool,
    /// Whether the samples of a pixel are weighted.
    pub weights: bool,
    /// What the picture will lack, one sentence each.
    pub notes: Vec<String>,
}

impl Plan {
    pub fn new(job: &RenderJob) -> Plan {
        let scene = &job.scene;
        let mut notes = Vec::new();
        // Without stage 7 the picture is the same and costs more.
        let looks = written(|| stage7_effects::effects(&nothing()));
        let effects = if looks { stage7_effects::effects(scene) } else { Effects::everything(scene) };
        let mut plan = Plan {
            search: choose_search(&scene.quality, &mut notes),
            view: choose_view(job.view, &mut notes),
            averages_normals: written(|| stage2_triangles::vertex_normals(&Mesh::default())),
            smooth: written(|| stage4_shading::shading_normal(Vec3::X, None, Vec3::X)),
            positions: written(|| stage6_distribution::pixel_position(scene.quality.sampler, &ANYWHERE)),
            weights: written(|| stage6_distribution::develop(&[]))
                && written(|| stage6_distribution::gaussian_weight(Vec2::ZERO)),
            effects,
            notes,
        };
        plan.leave_out_normals(scene);
        plan.leave_out_mirrors(scene);
        plan.leave_out_distribution(scene);
        plan.leave_out_images(scene);
        plan
    }

    fn leave_out_normals(&mut self, scene: &Scene) {
        let mut smooth = scene.meshes.iter().filter(|mesh| mesh.smooth);
        let averaged = smooth.clone().any(|mesh| mesh.mesh.normals.is_empty());
        self.note_if(
            self.smooth && !self.averages_normals && averaged,
            "smooth meshes whose files have no normals are flat: `vertex_normals` of stage 2 is not written yet",
        );
        self.note_if(
            !self.smooth && smooth.next().is_some(),
            "smooth meshes are flat: `shading_normal` of stage 4 is not written yet",
        );
    }

    fn leave_out_mirrors(&mut self, scene: &Scene) {
        let limits = Limits { max_depth: 0, min_contribution: 0.0 };
        let material = Material::default();
        let child = Child { bounce: Bounce::Reflection, direction: Vec3::Z, weight: Vec3::ONE };
        let children = written(|| {
            stage5_recursion::children(Vec3::NEG_Z, Vec3::Z, true, &material, Vec3::ONE, 0, &limits)
        });
        if children && written(|| stage5_recursion::leave(&nowhere(), &child)) {
            return;
        }
        let wanted = |m: &Material| m.mirror != Vec3::ZERO || m.transmission != Vec3::ZERO;
        self.note_if(
            scene.materials.iter().any(wanted),
            "mirrors and glass send no ray on: stage 5 is not written yet",
        );
        for material in &mut self.effects.materials {
            (material.mirror, material.transmission, material.gloss) = (false, false, false);
        }
    }

    fn leave_out_distribution(&mut self, scene: &Scene) {
        let quality = &scene.quality;
        let spreads = quality.sampler.spreads(quality.samples_per_pixel);
        self.note_if(
            spreads && !self.positions && quality.sampler != Sampler::LowDiscrepancy,
            "the samples of a pixel lie anywhere in it: `pixel_position` of stage 6 is not written yet",
        );
        self.note_if(
            quality.sampler == Sampler::Gaussian && !self.weights,
            "all samples of a pixel count alike: `develop` and `gaussian_weight` of stage 6 are not written yet",
        );
        let jittered = written(|| stage6_distribution::jittered(&ANYWHERE));
        if !(jittered && lens_is_written()) {
            let lens = scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0);
            self.note_if(lens, "the lens is a pinhole: stage 6 is not written yet");
            self.effects.lens = false;
        }
        if !(jittered && lamps_are_written()) {
            let area = |light: &Light| matches!(light.emitter, Emitter::Area { .. });
            self.note_if(
                scene.lights.iter().any(area) && quality.light_samples > 0,
                "area lights shine from their middle: stage 6 is not written yet",
            );
            for light in &mut self.effects.lights {
                (light.samples, light.area) = (light.samples.min(1), false);
            }
        }
        if !(jittered && written(|| stage6_distribution::gloss(Vec3::Y, Vec3::Y, 0.0, Vec2::ZERO))) {
            let gloss = self.effects.materials.iter().any(|m| m.gloss && (m.mirror || m.transmission));
            self.note_if(gloss, "rough mirrors and glass are sharp: stage 6 is not written yet");
            for material in &mut self.effects.materials {
                material.gloss = false;
            }
        }
        if !motion_is_written() {
            self.note_if(
                scene.shown().iter().any(|shown| shown.moves),
                "what moves stands still: stage 6 is not written yet",
            );
            self.effects.motion = false;
        }
    }

    fn leave_out_images(&mut self, scene: &Scene) {
        let one = Texture {
            width: 1,
            height: 1,
            pixels: Arc::new(vec![Vec3::ONE]),
            wrap: raykata::material::Wrap::Repeat,
        };
        if written(|| stage7_effects::texture_color(&one, Vec2::ZERO)) {
            return;
        }
        self.note_if(
            scene.materials.iter().any(|material| material.texture.is_some()),
            "images are left out: `texture_color` of stage 7 is not written yet",
        );
        for material in &mut self.effects.materials {
            material.texture = false;
        }
    }

    fn note_if(&mut self, missing: bool, what: &str) {
        if missing {
            self.notes.push(what.into());
        }
    }
}

const ANYWHERE: Stratum = Stratum { cell: UVec2::ZERO, grid: UVec2::ONE, u: Vec2::ZERO };

fn nothing() -> Scene {
    Scene::empty(Camera::new(Vec3::ZERO, Vec3::Z, Vec3::Y, 40.0, 1.0).expect("a camera that looks along z"))
}

fn nowhere() -> Surface {
    Surface { point: Vec3::ZERO, error: Vec3::ZERO, geometric_normal: Vec3::Z, shading_normal: Vec3::Z }
}

fn lens_is_written() -> bool {
    let camera = nothing().camera;
    let (ray, lens) = (camera.ray(0.5, 0.5), Lens { aperture: 0.0, focal_distance: 1.0 });
    written(|| stage6_distribution::on_disk(Vec2::ZERO))
        && written(|| stage6_distribution::lens_ray(&camera, &ray, &lens, Vec2::ZERO))
}

fn lamps_are_written() -> bool {
    let disk = Disk { center: Vec3::ZERO, normal: Vec3::Y, radius: 1.0 };
    let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
    written(|| stage6_distribution::on_rectangle(Vec3::ZERO, (Vec3::X, Vec3::Y), Vec2::ZERO))
        && written(|| stage6_distribution::on_lamp_disk(&disk, Vec2::ZERO))
        && written(|| stage6_distribution::toward_ball(&ball, 2.0 * Vec3::Y, Vec2::ZERO))
}

fn motion_is_written() -> bool {
    let shutter = Shutter { open: 0.0, close: 1.0 };
    written(|| stage6_distribution::temporal_slot(0, 0))
        && written(|| stage6_distribution::time_in_shutter(&shutter, 1, 1, 0.0))
        && written(|| stage6_distribution::between(Vec3::ZERO, Vec3::ZERO, 0.0))
        && written(|| stage6_distribution::sweep(&Aabb::EMPTY, &Aabb::EMPTY))
}

fn choose_search(quality: &Quality, notes: &mut Vec<String>) -> Search {
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

fn choose_view(wanted: View, notes: &mut Vec<String>) -> View {
    let material = Material::default();
    let shades =
        written(|| stage4_shading::shade(&nowhere(), Vec3::Z, &material, Vec3::ONE, &[], |_, _| false));
    if wanted == View::Shaded && !shades {
        notes.push("normals are shown as colours: stage 4 is not written yet".into());
        return View::Normals;
    }
    wanted
}

/// Whether a function does more than say `todo!`.
fn written<T>(call: impl FnOnce() -> T) -> bool {
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
