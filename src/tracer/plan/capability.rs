//! What a frame does not show while exercises are not written yet: a table of its capabilities.

use super::data::Plan;
use super::written::Written;
use crate::kit::{Function, StudentFunctions};
use crate::material::Emitter;
use crate::scene::{Background, Sampler, Scene, SceneMesh};
use crate::shape::Shape;
use crate::tracer::search::intersection::{ShapeTests, SphereTest, TriangleTest};
use glam::Vec3;

/// A capability of frames: "this written, else that".
pub(super) struct Capability {
    /// The functions that it needs. It is missing if one of them is not written; with an empty list, where it is shown.
    needs: &'static [Function],
    /// What the picture then lacks, and why: `{}` stands for the first function that is missing.
    lack: &'static str,
    /// Whether the picture of a scene shows that, so that it gets a note.
    shown: fn(&Plan, &Scene) -> bool,
    /// What is left out in its place.
    instead: fn(&mut Plan),
}

const fn lacks(
    needs: &'static [Function],
    lack: &'static str,
    shown: fn(&Plan, &Scene) -> bool,
) -> Capability {
    Capability { needs, lack, shown, instead: |_| () }
}

impl Capability {
    const fn instead(self, instead: fn(&mut Plan)) -> Capability {
        Capability { instead, ..self }
    }

    /// Leaves the capability out of the plan if it is missing, and notes that if the picture shows it.
    pub(super) fn decide<F: StudentFunctions>(&self, plan: &mut Plan, scene: &Scene, written: &Written<F>) {
        let missing = self.needs.iter().find(|function| !written.has(**function)).map(Function::to_string);
        if missing.is_none() && !self.needs.is_empty() {
            return;
        }
        if (self.shown)(plan, scene) {
            plan.notes.push(self.lack.replace("{}", &missing.unwrap_or_default()) + " not written yet");
        }
        (self.instead)(plan);
    }
}

/// Whether any node that is shown has a shape of this kind; the second argument is whether it moves.
fn shows(scene: &Scene, wanted: impl Fn(&Shape, bool) -> bool) -> bool {
    scene
        .shown()
        .iter()
        .any(|shown| scene.nodes[shown.node].shape.as_ref().is_some_and(|shape| wanted(shape, shown.moves)))
}

fn has_mesh(scene: &Scene, wanted: fn(&SceneMesh) -> bool) -> bool {
    scene.meshes.iter().any(wanted)
}

fn sphere_functions(test: SphereTest) -> &'static [Function] {
    match test {
        SphereTest::Algebraic => &[Function::sphere_algebraic, Function::sphere_normal],
        SphereTest::Geometric => &[Function::sphere_geometric, Function::sphere_normal],
        SphereTest::StableRoots => &[Function::stable_roots, Function::nearest_root, Function::sphere_normal],
        SphereTest::InDouble => &[Function::sphere_in_double, Function::sphere_normal],
    }
}

fn triangle_functions(test: TriangleTest) -> &'static [Function] {
    match test {
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
    }
}

/// All capabilities, in the order of their notes. What a row leaves out counts for the rows below it.
pub(super) fn capabilities(tests: ShapeTests) -> [Capability; 24] {
    use Function as F;
    use Shape::{Bezier, Cone, Cylinder, Disk, Mesh, Nurbs, Plane, PlaneEquation, Sphere, Triangle};
    const NORMALS: &[F] = &[F::shading_normal, F::interpolate];
    [
        lacks(sphere_functions(tests.spheres), "spheres are left out: {} is", |_, scene| {
            shows(scene, |shape, _| matches!(shape, Sphere(_)))
        })
        .instead(|plan| plan.world.spheres = false),
        lacks(&[F::plane], "planes are left out: {} is", |plan, scene| {
            // A plane that moves is tested by a point and a normal, however it is given.
            shows(scene, |shape, moves| match shape {
                PlaneEquation(_) => moves || !plan.world.equations,
                _ => matches!(shape, Plane(_)),
            })
        })
        .instead(|plan| plan.world.planes = false),
        lacks(
            &[F::plane_by_coefficients],
            "planes that coefficients give are tested by a point and a normal: {} is",
            |plan, scene| plan.world.planes && shows(scene, |shape, _| matches!(shape, PlaneEquation(_))),
        ),
        lacks(
            triangle_functions(tests.triangles),
            "triangles and meshes are left out: {} is",
            |plan, scene| {
                shows(scene, |shape, _| match shape {
                    Triangle(_) | Mesh(_) | Bezier { .. } | Nurbs { .. } => true,
                    Sphere(_) | Plane(_) | PlaneEquation(_) => false,
                    _ => plan.world.placement.is_none(),
                })
            },
        )
        .instead(|plan| plan.world.triangles = false),
        lacks(&[F::backfacing], "one-sided meshes are hit from both sides: {} is", |plan, scene| {
            plan.world.triangles && has_mesh(scene, |mesh| mesh.one_sided)
        }),
        lacks(&[F::face_forward], "surfaces that are seen from inside are dark: {} is", |_, _| true),
        lacks(
            &[F::vertex_normals],
            "smooth meshes whose files have no normals are flat: {} is",
            |plan, scene| {
                plan.smooth
                    && has_mesh(scene, |mesh| {
                        mesh.smooth && (mesh.mesh.normals.is_empty() || mesh.subdivisions > 0)
                    })
            },
        ),
        lacks(NORMALS, "smooth meshes are flat: {} is", |_, scene| has_mesh(scene, |mesh| mesh.smooth)),
        lacks(NORMALS, "curved surfaces have flat parts: {} is", |_, scene| scene.has_curved_surface()),
        lacks(
            &[F::scatter, F::spawn_ray],
            "mirrors and glass spawn no secondary rays: stage 5 is",
            |_, scene| scene.materials.iter().any(|m| m.mirror != Vec3::ZERO || m.transmission != Vec3::ZERO),
        )
        .instead(|plan| {
            for material in &mut plan.effects.materials {
                (material.mirror, material.transmission, material.glossy) = (false, false, false);
            }
        }),
        lacks(&[F::fresnel_exact], "clear coats are left out: {} is", |plan, _| plan.coats)
            .instead(|plan| plan.coats = false),
        lacks(&[F::pixel_position], "the samples of a pixel lie anywhere in it: {} is", |_, scene| {
            let sampler = scene.quality.sampler;
            sampler.spreads(scene.quality.samples_per_pixel) && sampler != Sampler::LowDiscrepancy
        }),
        lacks(
            &[F::filter_pixel, F::gaussian_weight],
            "all samples of a pixel have the same weight: `filter_pixel` and `gaussian_weight` of stage 6 are",
            |_, scene| scene.quality.sampler == Sampler::Gaussian,
        ),
        lacks(
            &[F::jittered, F::sample_disk, F::lens_ray],
            "the lens is a pinhole: stage 6 is",
            |_, scene| scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0),
        )
        .instead(|plan| plan.effects.lens = false),
        lacks(
            &[F::jittered, F::sample_rectangle, F::sample_light_disk, F::sample_sphere],
            "area lights shine from their centre: stage 6 is",
            |_, scene| {
                let area = scene.lights.iter().any(|light| matches!(light.emitter, Emitter::Area { .. }));
                area && scene.quality.light_samples > 0
            },
        )
        .instead(|plan| {
            for light in &mut plan.effects.lights {
                (light.samples, light.area) = (light.samples.min(1), false);
            }
        }),
        lacks(
            &[F::jittered, F::sample_phong_lobe],
            "glossy reflection and refraction are sharp: stage 6 is",
            |plan, _| plan.effects.materials.iter().any(|m| m.glossy && (m.mirror || m.transmission)),
        )
        .instead(|plan| plan.effects.materials.iter_mut().for_each(|material| material.glossy = false)),
        lacks(
            &[F::temporal_slot, F::time_in_shutter, F::lerp, F::motion_bounds],
            "moving shapes stand still: stage 6 is",
            |_, scene| scene.shown().iter().any(|shown| shown.moves),
        )
        .instead(|plan| plan.effects.motion = false),
        lacks(&[F::decode_gamma], "gamma 2 is decoded with the sRGB curve: {} is", |_, scene| {
            !scene.gamma2.is_empty()
        }),
        lacks(&[F::texture_color], "the environment map is not interpolated: {} is", |_, scene| {
            matches!(scene.background, Background::Map(_))
        }),
        lacks(&[F::texture_color], "images are left out: {} is", |_, scene| {
            scene.materials.iter().any(|material| material.texture.is_some())
        })
        .instead(|plan| plan.effects.materials.iter_mut().for_each(|material| material.texture = false)),
        lacks(&[], "cylinders, cones and disks are made of triangles: stage 8 is", |plan, scene| {
            let round = |shape: &Shape, _| matches!(shape, Cylinder(_) | Cone(_) | Disk(_));
            plan.world.placement.is_none() && plan.world.triangles && shows(scene, round)
        }),
        lacks(&[F::loop_subdivide], "meshes are not subdivided: {} is", |_, scene| {
            has_mesh(scene, |mesh| mesh.subdivisions > 0)
        }),
        lacks(&[F::bezier_point], "curved surfaces are left out: {} is", |_, scene| {
            shows(scene, |shape, _| matches!(shape, Bezier { .. }))
        }),
        lacks(
            &[F::nurbs_point, F::bspline_basis],
            "B-spline and NURBS surfaces are left out: `nurbs_point` or `bspline_basis` of stage 8 is",
            |_, scene| shows(scene, |shape, _| matches!(shape, Nurbs { .. })),
        ),
    ]
}
