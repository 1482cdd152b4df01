//! What a frame computes, and what it leaves out while exercises are not written yet.

mod accelerator;
pub mod written;

use crate::effects::Effects;
use crate::kit::{Function, RenderJob, StudentFunctions, View};
use crate::light_path::PathEffects;
use crate::material::{Emitter, Light, Material};
use crate::scene::{
    Accelerator, Background, Node, Precision, Quality, Sampler, Scene, SphereMethod, TextureFilter,
    TriangleMethod,
};
use crate::shape::Shape;
use crate::tracer::search::intersection::{ShapeTests, SphereTest, TriangleTest};
use crate::world::WorldFunctions;
use accelerator::choose_accelerator;
use glam::Vec3;
use written::Written;

/// What a frame computes: the effects of the scene, as far as the student functions for them are written.
pub struct Plan {
    /// The effects that the scene asks for and that are written.
    pub effects: Effects,
    /// The acceleration structure, never [`Accelerator::Auto`]; `None` if no search is written, not even brute force.
    pub accelerator: Option<Accelerator>,
    /// Which student functions test rays against triangles and spheres.
    pub tests: ShapeTests,
    /// Whether `conservative_slab` of stage 10 tests the boxes of hierarchies; otherwise `slab` of stage 3.
    pub conservative: bool,
    /// Whether `offset_origin` of stage 10 moves the origins of rays that leave a surface; otherwise the functions of
    /// stages 4 and 5 that make these rays.
    pub offsets: bool,
    /// Whether `safe_normalize` of stage 10 normalizes the directions of rays.
    pub safe_units: bool,
    /// Which functions of stage 12 a wide tree uses.
    pub wide: WidePlan,
    /// What a pixel shows: light, normals or work. If `shade` is not written, it shows normals.
    pub view: View,
    /// The student functions that the world is made with, and the kinds of shapes that are shown.
    pub world: WorldFunctions,
    /// Whether normals are interpolated over the triangles of smooth meshes.
    pub smooth: bool,
    /// Whether normals are turned to the side from which the ray comes.
    pub facing: bool,
    /// Whether `pixel_position` is written; otherwise samples lie anywhere in the pixel.
    pub positions: bool,
    /// Whether the filter functions are written; otherwise all samples of a pixel have the same weight.
    pub weights: bool,
    /// For each light of the scene whether it is visible.
    pub visible_lights: Vec<bool>,
    /// Whether `texture_color` is written, which reads images.
    pub images: bool,
    /// Whether images are filtered, because the scene asks for it and a surface that is shown has an image.
    pub mipmaps: bool,
    /// Whether a material that is shown emits light. Without any, no emission is added at a hit.
    pub emission: bool,
    /// The ambient light that surfaces reflect: that of the scene, or none where indirect light is computed, for which it
    /// stands.
    pub ambient: Vec3,
    /// What paths of indirect light need; `None` if no path bounces off a diffuse surface, or if it is left out.
    pub paths: Option<PathEffects>,
    /// Whether `jittered` of stage 6 is written; otherwise the random numbers of paths are not stratified.
    pub jittered: bool,
    /// What the picture will lack, one sentence each; empty if nothing.
    pub notes: Vec<String>,
}

/// Which functions of stage 12 are written, beside those without which there is no wide tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WidePlan {
    /// Whether `build_parallel` is written.
    pub parallel: bool,
    /// Whether `build_binned` is written. Without both, the tree of stage 3 is flattened.
    pub binned: bool,
    /// Whether `may_hit` is written; otherwise each triangle of a leaf is tested.
    pub may_hit: bool,
}

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
            emission: !scene.emitters().is_empty(),
            ambient: scene.ambient,
            paths: None,
            jittered: written.has(Function::jittered),
            effects,
            notes,
        };
        // Leave out effects and shapes whose functions are not written, and note that.
        plan.leave_out_shapes(scene, written);
        plan.leave_out_normals(scene, written);
        plan.leave_out_mirrors(scene, written);
        plan.leave_out_distribution(scene, written);
        plan.leave_out_images(scene, written);
        plan.leave_out_spaces(scene);
        plan.leave_out_indirect_light(scene, written);
        let images = plan.effects.materials.iter().any(|material| material.texture);
        plan.mipmaps = images && scene.quality.texture_filter == TextureFilter::Mipmap;
        plan
    }

    fn leave_out_shapes<F: StudentFunctions>(&mut self, scene: &Scene, written: &Written<F>) {
        let spheres: &[Function] = match self.tests.spheres {
            SphereTest::Algebraic => &[Function::sphere_algebraic],
            SphereTest::Geometric => &[Function::sphere_geometric],
            SphereTest::StableRoots => &[Function::stable_roots, Function::nearest_root],
            SphereTest::InDouble => &[Function::sphere_in_double],
        };
        let is_sphere = |shape: &Shape| matches!(shape, Shape::Sphere(_));
        let has_equation = |shape: &Shape| matches!(shape, Shape::PlaneEquation(_));
        let is_plane = |shape: &Shape| matches!(shape, Shape::Plane(_)) || has_equation(shape);
        for &function in spheres.iter().chain(&[Function::sphere_normal]) {
            if self.world.spheres && !written.has(function) {
                self.world.spheres = false;
                self.note_if(
                    shows(scene, is_sphere),
                    &format!("spheres are left out: {function} is not written yet"),
                );
            }
        }
        if !written.has(Function::plane) {
            self.world.planes = false;
            // A plane that moves is tested by a point and a normal, however it is given.
            let tested = |shape: &Shape, moves: bool| self.world.equations && has_equation(shape) && !moves;
            let left_out = scene.shown().iter().any(|shown| {
                let shape = scene.nodes[shown.node].shape.as_ref();
                shape.is_some_and(|shape| is_plane(shape) && !tested(shape, shown.moves))
            });
            self.note_if(left_out, &format!("planes are left out: {} is not written yet", Function::plane));
        }
        self.note_if(
            self.world.planes && !self.world.equations && shows(scene, has_equation),
            &format!(
                "planes that coefficients give are tested by a point and a normal: {} is not written yet",
                Function::plane_by_coefficients
            ),
        );
        let functions: &[Function] = match self.tests.triangles {
            TriangleTest::Watertight => &[Function::watertight],
            TriangleTest::Choice => &[Function::triangle_choice],
            TriangleTest::Cramer => &[Function::triangle_cramer],
            TriangleTest::Gram => &[Function::gram_scalars, Function::triangle_gram],
            TriangleTest::InsideByPlanes => {
                &[Function::plane, Function::inside_by_planes, Function::inside_by_areas]
            }
            TriangleTest::InsideByDirection => {
                &[Function::plane, Function::inside_by_direction, Function::inside_by_areas]
            }
            TriangleTest::InsideByAreas => &[Function::plane, Function::inside_by_areas],
            TriangleTest::InDouble => &[Function::triangle_in_double],
        };
        if let Some(missing) = functions.iter().find(|&&function| !written.has(function)) {
            self.world.triangles = false;
            let in_triangles = |shape: &Shape| {
                matches!(
                    shape,
                    Shape::Triangle(_) | Shape::Mesh(_) | Shape::Bezier { .. } | Shape::Nurbs { .. }
                ) || (self.world.placement.is_none() && !is_sphere(shape) && !is_plane(shape))
            };
            let shown = shows(scene, in_triangles);
            self.note_if(shown, &format!("triangles and meshes are left out: {missing} is not written yet"));
        }
        self.note_if(
            self.world.triangles && !self.world.one_sided && scene.meshes.iter().any(|mesh| mesh.one_sided),
            &format!("one-sided meshes are hit from both sides: {} is not written yet", Function::backfacing),
        );
        self.note_if(
            !self.facing,
            "surfaces that are seen from inside are dark: `face_forward` of stage 1 is not written yet",
        );
    }

    fn leave_out_normals<F: StudentFunctions>(&mut self, scene: &Scene, written: &Written<F>) {
        let mut smooth = scene.meshes.iter().filter(|mesh| mesh.smooth);
        let averaged = smooth.clone().any(|mesh| mesh.mesh.normals.is_empty());
        let is_curved = |node: &Node| matches!(node.shape, Some(Shape::Bezier { .. } | Shape::Nurbs { .. }));
        let curved = scene.nodes.iter().any(is_curved);
        let is_missing = self.smooth && self.world.vertex_normals.is_none();
        self.note_if(
            is_missing && averaged,
            "smooth meshes whose files have no normals are flat: `vertex_normals` of stage 2 is not written yet",
        );
        self.note_if(
            is_missing && curved,
            "curved surfaces have flat parts: `vertex_normals` of stage 2 is not written yet",
        );
        let missing = [Function::shading_normal, Function::interpolate];
        if let Some(missing) = missing.into_iter().find(|&function| !written.has(function)) {
            self.note_if(
                smooth.next().is_some(),
                &format!("smooth meshes are flat: {missing} is not written yet"),
            );
            self.note_if(curved, &format!("curved surfaces have flat parts: {missing} is not written yet"));
        }
    }

    fn leave_out_mirrors<F: StudentFunctions>(&mut self, scene: &Scene, written: &Written<F>) {
        if written.has_all(&[Function::scatter, Function::spawn_ray]) {
            return;
        }
        let wanted = |m: &Material| m.mirror != Vec3::ZERO || m.transmission != Vec3::ZERO;
        self.note_if(
            scene.materials.iter().any(wanted),
            "mirrors and glass spawn no secondary rays: stage 5 is not written yet",
        );
        for material in &mut self.effects.materials {
            (material.mirror, material.transmission, material.glossy) = (false, false, false);
        }
    }

    fn leave_out_distribution<F: StudentFunctions>(&mut self, scene: &Scene, written: &Written<F>) {
        let quality = &scene.quality;
        let spreads = quality.sampler.spreads(quality.samples_per_pixel);
        self.note_if(
            spreads && !self.positions && quality.sampler != Sampler::LowDiscrepancy,
            "the samples of a pixel lie anywhere in it: `pixel_position` of stage 6 is not written yet",
        );
        self.note_if(
            quality.sampler == Sampler::Gaussian && !self.weights,
            "all samples of a pixel have the same weight: `filter_pixel` and `gaussian_weight` of stage 6 \
             are not written yet",
        );
        let jittered = written.has(Function::jittered);
        if !(jittered && written.has_all(&[Function::sample_disk, Function::lens_ray])) {
            let lens = scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0);
            self.note_if(lens, "the lens is a pinhole: stage 6 is not written yet");
            self.effects.lens = false;
        }
        let area_lights = [Function::sample_rectangle, Function::sample_light_disk, Function::sample_sphere];
        if !(jittered && written.has_all(&area_lights)) {
            let area = |light: &Light| matches!(light.emitter, Emitter::Area { .. });
            self.note_if(
                scene.lights.iter().any(area) && quality.light_samples > 0,
                "area lights shine from their centre: stage 6 is not written yet",
            );
            for light in &mut self.effects.lights {
                (light.samples, light.area) = (light.samples.min(1), false);
            }
        }
        if !(jittered && written.has(Function::sample_phong_lobe)) {
            let glossy = self.effects.materials.iter().any(|m| m.glossy && (m.mirror || m.transmission));
            self.note_if(glossy, "glossy reflection and refraction are sharp: stage 6 is not written yet");
            for material in &mut self.effects.materials {
                material.glossy = false;
            }
        }
        let motion =
            [Function::temporal_slot, Function::time_in_shutter, Function::lerp, Function::motion_bounds];
        if !written.has_all(&motion) {
            self.note_if(
                scene.shown().iter().any(|shown| shown.moves),
                "moving shapes stand still: stage 6 is not written yet",
            );
            self.effects.motion = false;
        }
    }

    fn leave_out_images<F: StudentFunctions>(&mut self, scene: &Scene, written: &Written<F>) {
        self.note_if(
            !scene.gamma2.is_empty() && !written.has(Function::decode_gamma),
            "gamma 2 is decoded with the sRGB curve: `decode_gamma` of stage 4 is not written yet",
        );
        if self.images {
            return;
        }
        self.note_if(
            matches!(scene.background, Background::Map(_)),
            "the environment map is not interpolated: `texture_color` of stage 7 is not written yet",
        );
        self.note_if(
            scene.materials.iter().any(|material| material.texture.is_some()),
            "images are left out: `texture_color` of stage 7 is not written yet",
        );
        for material in &mut self.effects.materials {
            material.texture = false;
        }
    }

    fn leave_out_spaces(&mut self, scene: &Scene) {
        let round = |shape: &Shape| matches!(shape, Shape::Cylinder(_) | Shape::Cone(_) | Shape::Disk(_));
        self.note_if(
            self.world.placement.is_none() && self.world.triangles && shows(scene, round),
            "cylinders, cones and disks are made of triangles: stage 8 is not written yet",
        );
        self.note_if(
            self.world.subdivide.is_none() && scene.meshes.iter().any(|mesh| mesh.subdivisions > 0),
            "meshes are not subdivided: `loop_subdivide` of stage 8 is not written yet",
        );
        self.note_if(
            self.world.bezier_point.is_none() && shows(scene, |shape| matches!(shape, Shape::Bezier { .. })),
            "curved surfaces are left out: `bezier_point` of stage 8 is not written yet",
        );
        self.note_if(
            self.world.nurbs_point.is_none() && shows(scene, |shape| matches!(shape, Shape::Nurbs { .. })),
            "B-spline and NURBS surfaces are left out: `nurbs_point` or `bspline_basis` of stage 8 is not written yet",
        );
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

    fn note_if(&mut self, missing: bool, what: &str) {
        if missing {
            self.notes.push(what.into());
        }
    }
}

/// Whether any node that is shown has a shape of this kind.
fn shows(scene: &Scene, wanted: impl Fn(&Shape) -> bool) -> bool {
    scene.shown().iter().any(|shown| scene.nodes[shown.node].shape.as_ref().is_some_and(&wanted))
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
