//! What a frame computes, and what it leaves out while exercises are not written yet.

mod accelerator;
mod capability;
mod data;
pub mod written;

use crate::effects::Effects;
use crate::kit::{Function, RenderJob, StudentFunctions, View};
use crate::light_path::PathEffects;
use crate::scene::{Background, Precision, Quality, Scene, SphereMethod, TextureFilter, TriangleMethod};
use crate::tracer::search::intersection::{ShapeTests, SphereTest, TriangleTest};
use crate::world::WorldFunctions;
use accelerator::choose_accelerator;
use capability::capabilities;
pub use data::{Plan, WidePlan};
use glam::Vec3;
use written::Written;

impl Plan {
    /// The plan of `job`, if only the functions of `written` may be called.
    pub fn new<F: StudentFunctions>(job: &RenderJob, written: &Written<F>) -> Plan {
        let scene = &job.scene;
        let mut notes = Vec::new();
        // Without stage 7, assume that the scene needs every effect: the picture is the same and costs more.
        let effects =
            if written.has(Function::effects) { F::effects(scene) } else { Effects::everything(scene) };
        // Choose what replaces functions that are not written.
        let mut plan = Plan {
            accelerator: choose_accelerator(&scene.quality, written, &mut notes),
            tests: choose_tests(&scene.quality, written, &mut notes),
            // The functions of stage 10 replace earlier ones as soon as they are written.
            conservative: written.has(Function::conservative_slab),
            offsets: written.has(Function::offset_origin),
            safe_units: written.has(Function::safe_normalize),
            wide: WidePlan {
                parallel: written.has(Function::build_parallel),
                binned: written.has(Function::build_binned),
                may_hit: written.has(Function::may_hit),
            },
            view: choose_view(job.view, written, &mut notes),
            world: WorldFunctions::of::<F>(&|function| written.has(function)),
            smooth: written.has_all(&[Function::shading_normal, Function::interpolate]),
            facing: written.has(Function::face_forward),
            positions: written.has(Function::pixel_position),
            weights: written.has_all(&[Function::filter_pixel, Function::gaussian_weight]),
            visible_lights: (0..scene.lights.len())
                .map(|light| scene.visible_lights.iter().any(|visible| visible.light == light))
                .collect(),
            images: written.has(Function::texture_color),
            mipmaps: false,
            coats: scene.materials.iter().any(|material| material.coat != 1.0),
            emission: !scene.emitters().is_empty(),
            ambient: scene.ambient,
            paths: None,
            jittered: written.has(Function::jittered),
            effects,
            notes,
        };
        // Leave out effects and shapes whose functions are not written, and note that.
        for capability in capabilities(plan.tests) {
            capability.decide(&mut plan, scene, written);
        }
        plan.leave_out_indirect_light(scene, written);
        let images = plan.effects.materials.iter().any(|material| material.texture);
        plan.mipmaps = images && scene.quality.texture_filter == TextureFilter::Mipmap;
        plan
    }

    /// Decides whether paths compute indirect light.
    fn leave_out_indirect_light<F: StudentFunctions>(&mut self, scene: &Scene, written: &Written<F>) {
        if !self.effects.indirect_light {
            return;
        }
        // Paths need the student's step, and the functions that start their rays.
        let spawns: &[Function] = if self.offsets { &[] } else { &[Function::spawn_ray] };
        let needed = [&[Function::step, Function::shadow_ray], spawns].concat();
        if let Some(missing) = needed.into_iter().find(|&function| !written.has(function)) {
            let note = format!("indirect light is left out: {missing} is not written yet");
            return self.notes.push(note);
        }
        // Without the analysis, assume that the paths need everything: the picture is the same and costs more.
        let mut paths = match written.has(Function::paths_called_for) {
            true => F::paths_called_for(scene),
            false => PathEffects {
                diffuse: vec![true; scene.materials.len()],
                sampled: vec![true; scene.materials.len()],
                environment: true,
            },
        };
        let is_sampled = paths.environment && matches!(scene.background, Background::Map(_));
        if is_sampled && !written.has(Function::emitted_contribution) {
            let missing = Function::emitted_contribution;
            self.notes.push(format!("the environment map is found by chance: {missing} is not written yet"));
            paths.environment = false;
        }
        self.ambient = Vec3::ZERO;
        self.paths = paths.bounces().then_some(paths);
    }
}

fn choose_view<F: StudentFunctions>(wanted: View, written: &Written<F>, notes: &mut Vec<String>) -> View {
    if wanted != View::Normals && !written.has(Function::shade) {
        notes.push("normals are shown as colours: stage 4 is not written yet".into());
        return View::Normals;
    }
    wanted
}

/// The tests that the scene requests, as far as they are written.
fn choose_tests<F: StudentFunctions>(
    quality: &Quality,
    written: &Written<F>,
    notes: &mut Vec<String>,
) -> ShapeTests {
    let triangles = match quality.triangle_method {
        // Until the watertight method is written, use the method of the student's choice.
        TriangleMethod::Watertight if written.has(Function::watertight) => TriangleTest::Watertight,
        TriangleMethod::Watertight | TriangleMethod::Choice => TriangleTest::Choice,
        TriangleMethod::Cramer => TriangleTest::Cramer,
        TriangleMethod::Gram => TriangleTest::Gram,
        TriangleMethod::InsideByPlanes => TriangleTest::InsideByPlanes,
        TriangleMethod::InsideByDirection => TriangleTest::InsideByDirection,
        TriangleMethod::InsideByAreas => TriangleTest::InsideByAreas,
    };
    let spheres = match quality.sphere_method {
        SphereMethod::Algebraic => SphereTest::Algebraic,
        SphereMethod::Geometric => SphereTest::Geometric,
        SphereMethod::StableRoots => SphereTest::StableRoots,
    };
    let single = ShapeTests { triangles, spheres };
    if quality.precision == Precision::Single {
        return single;
    }
    // Double precision needs both tests; without one, fall back to single precision.
    let triangles = written.has(Function::triangle_in_double);
    let missing = match (triangles, written.has(Function::sphere_in_double)) {
        (true, true) => {
            return ShapeTests { triangles: TriangleTest::InDouble, spheres: SphereTest::InDouble };
        }
        (false, true) => "`triangle_in_double` of stage 10 is",
        (true, false) => "`sphere_in_double` of stage 10 is",
        (false, false) => "`triangle_in_double` and `sphere_in_double` of stage 10 are",
    };
    notes.push(format!("rays are tested in single precision: {missing} not written yet"));
    single
}
