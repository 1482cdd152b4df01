//! Nothing to do here: what a frame will compute, and what it leaves out while exercises are not written yet.

use crate::search::Search;
use crate::shape_tests::ShapeTests;
use crate::{
    search, stage2_triangles, stage4_shading, stage5_recursion, stage6_distribution, stage7_effects,
    stage8_scene_graph, stage8_solids, stage8_surfaces,
};
use glam::{Affine3A, UVec2, Vec2, Vec3};
use raykata::aabb::Aabb;
use raykata::camera::{Camera, Lens, Shutter};
use raykata::effects::Effects;
use raykata::kit::{Bounce, Child, Limits, Mishap, RenderJob, Surface, View, mishap};
use raykata::material::{Emitter, Light, Material, Texture};
use raykata::mesh::Mesh;
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::{Sampler, Scene};
use raykata::shape::{BezierPatch, Cone, Cuboid, Cylinder, Disk, Polygon, Shape, Sphere};
use raykata::world::Crafts;
use std::sync::Arc;

/// What a frame will compute.
pub struct Plan {
    /// What the scene calls for, as far as it is written.
    pub effects: Effects,
    pub search: Search,
    /// By which functions rays are tested against shapes.
    pub tests: ShapeTests,
    pub view: View,
    /// What the world is made with.
    pub crafts: Crafts,
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
            search: search::choose(&scene.quality, &mut notes),
            tests: ShapeTests::choose(&scene.quality, &mut notes),
            view: choose_view(job.view, &mut notes),
            crafts: crafts(),
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
        plan.leave_out_spaces(scene);
        plan
    }

    fn leave_out_normals(&mut self, scene: &Scene) {
        let mut smooth = scene.meshes.iter().filter(|mesh| mesh.smooth);
        let averaged = smooth.clone().any(|mesh| mesh.mesh.normals.is_empty());
        self.note_if(
            self.smooth && self.crafts.vertex_normals.is_none() && averaged,
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

    fn leave_out_spaces(&mut self, scene: &Scene) {
        let shown = |wanted: fn(&Shape) -> bool| {
            scene.shown().iter().any(|shown| scene.nodes[shown.node].shape.as_ref().is_some_and(wanted))
        };
        self.note_if(
            self.crafts.placement.is_none()
                && shown(|shape| matches!(shape, Shape::Cylinder(_) | Shape::Cone(_) | Shape::Disk(_))),
            "cylinders, cones and disks are made of triangles: stage 8 is not written yet",
        );
        self.note_if(
            self.crafts.subdivide.is_none() && scene.meshes.iter().any(|mesh| mesh.subdivisions > 0),
            "meshes are as coarse as their files: `loop_subdivide` of stage 8 is not written yet",
        );
        self.note_if(
            self.crafts.bezier_point.is_none() && shown(|shape| matches!(shape, Shape::Bezier { .. })),
            "curved surfaces are left out: `bezier_point` of stage 8 is not written yet",
        );
    }

    fn note_if(&mut self, missing: bool, what: &str) {
        if missing {
            self.notes.push(what.into());
        }
    }
}

/// What of the exercises makes worlds, as far as it is written.
fn crafts() -> Crafts {
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    let (unit, flat) = (Cuboid { min: Vec3::ZERO, max: Vec3::ONE }, Vec::new());
    let (base, radius) = (Vec3::ZERO, 1.0);
    let in_spaces = written(|| stage8_scene_graph::placement(&[]))
        && written(|| stage8_scene_graph::ray_to_object(&ray, &Affine3A::IDENTITY))
        && written(|| stage8_scene_graph::normal_to_world(Vec3::Z, &Affine3A::IDENTITY))
        && written(|| stage8_scene_graph::bounds_to_world(&Affine3A::IDENTITY, &Aabb::EMPTY))
        && written(|| stage8_solids::cuboid(&ray, &unit))
        && written(|| stage8_solids::cylinder(&ray, &Cylinder { base, top: Vec3::Y, radius }))
        && written(|| stage8_solids::cone(&ray, &Cone { base, apex: Vec3::Y, radius }))
        && written(|| stage8_solids::disk(&ray, &Disk { center: base, normal: Vec3::Y, radius }))
        && written(|| stage8_solids::polygon(&ray, &Polygon { corners: flat }));
    let point = |patch: &BezierPatch, uv: Vec2| stage8_surfaces::bezier_point(patch, uv);
    let patch = BezierPatch { rows: [[Vec3::ZERO; 4]; 4] };
    Crafts {
        vertex_normals: written(|| stage2_triangles::vertex_normals(&Mesh::default()))
            .then_some(stage2_triangles::vertex_normals),
        placement: in_spaces.then_some(stage8_scene_graph::placement),
        bezier_point: written(|| point(&patch, Vec2::ZERO)).then_some(point),
        subdivide: written(|| stage8_surfaces::loop_subdivide(&Mesh::default()))
            .then_some(stage8_surfaces::loop_subdivide),
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

fn choose_view(wanted: View, notes: &mut Vec<String>) -> View {
    let material = Material::default();
    let shades =
        written(|| stage4_shading::shade(&nowhere(), Vec3::Z, &material, Vec3::ONE, &[], |_, _| false));
    if wanted != View::Normals && !shades {
        notes.push("normals are shown as colours: stage 4 is not written yet".into());
        return View::Normals;
    }
    // What a pixel costs is the same whatever is shown of it.
    if wanted == View::Work { View::Shaded } else { wanted }
}

/// Whether a function does more than say `todo!`.
pub fn written<T>(call: impl FnOnce() -> T) -> bool {
    !matches!(mishap::catch(call), Err(Mishap::NotWritten { .. }))
}
