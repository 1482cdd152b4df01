//! Random choices on the path of a ray, by the functions of stage 6: a point of an area light, a direction
//! from a rough surface.

use crate::emitter::EmitterShape;
use crate::kit::{Bounce, LightSample, SecondaryRay, StudentFunctions, Surface};
use crate::material::{AreaShape, Emitter, Light};
use crate::random::{Points, Purpose};
use crate::rounding::gamma;
use glam::{DVec3, Vec3};

/// Sample `part` of `parts` of the area light `light`, number `index` in the scene, with outline `shape`: the
/// light that arrives at `surface` from a random point of it, divided by `parts`.
#[inline(always)]
pub fn sample_area_light<F: StudentFunctions>(
    (index, light, shape): (usize, &Light, &AreaShape),
    surface: &Surface,
    points: &Points,
    (part, parts): (u32, u32),
) -> LightSample {
    let u = F::jittered(&points.stratum(Purpose::Light(index as u32), part, parts));
    let at = surface.point;
    let sample = match shape {
        AreaShape::Rectangle { corner, edges } => {
            light.sample_at(F::sample_rectangle(*corner, *edges, u), at)
        }
        AreaShape::Disk(disk) => light.sample_at(F::sample_light_disk(disk, u), at),
        AreaShape::Sphere(sphere) => light.sample_toward_sphere(sphere, F::sample_sphere(sphere, at, u), at),
    };
    LightSample { radiance: sample.radiance / parts as f32, ..sample }
}

/// The sample of a visible light at `point`, ending before the surface that shows the light.
#[cold]
pub fn shortened_to_surface(sample: LightSample, shape: &AreaShape, point: Vec3) -> LightSample {
    let normal = match shape {
        AreaShape::Rectangle { edges, .. } => edges.0.as_dvec3().cross(edges.1.as_dvec3()),
        AreaShape::Disk(disk) => disk.normal.as_dvec3(),
        // A ray ends at the near side of a sphere. Less than one in a million of the directions to it is so grazing.
        AreaShape::Sphere(_) => return sample,
    };
    LightSample {
        distance: distance_before_plane(normal, sample.direction, sample.distance, point),
        ..sample
    }
}

/// The distance from `point` in `direction` up to just before `emitter`, which is at `distance`.
pub fn distance_before_emitter(emitter: &EmitterShape, direction: Vec3, distance: f32, point: Vec3) -> f32 {
    let edges = match emitter {
        EmitterShape::Sphere(_) => return distance,
        EmitterShape::Triangle(triangle) => (triangle.b - triangle.a, triangle.c - triangle.a),
        EmitterShape::Parallelogram { edges, .. } => *edges,
    };
    distance_before_plane(edges.0.as_dvec3().cross(edges.1.as_dvec3()), direction, distance, point)
}

/// The distance from `point` in `direction` up to just before a flat light, which is at `distance` and has a `normal` of any
/// length.
///
/// A shadow ray ends a little before its light. Where it runs almost along a flat light, that is less than the rounding error
/// of its hit with the light, which would block its own light. The end moves by that error: some roundings of the
/// coordinates, divided by the cosine at the light. It stays in the second half of the distance.
fn distance_before_plane(normal: DVec3, direction: Vec3, distance: f32, point: Vec3) -> f32 {
    let cosine = normal.normalize_or_zero().as_vec3().dot(direction).abs();
    let reach = point.abs().max_element() + distance;
    let error = gamma(16) * reach / cosine;
    (distance - error).max(0.5 * distance)
}

/// The outline of an area light; `None` for point lights and directional lights.
pub fn area_of(light: &Light) -> Option<&AreaShape> {
    match &light.emitter {
        Emitter::Area { shape, .. } => Some(shape),
        Emitter::Point { .. } | Emitter::Directional { .. } => None,
    }
}

/// Ray `part` of `parts` that a surface of `roughness` `0..=1` makes of the ideal secondary ray `child`: in a
/// random direction around it, with its weight divided by `parts`.
pub fn sample_rough_surface<F: StudentFunctions>(
    child: &SecondaryRay,
    surface: &Surface,
    roughness: f32,
    points: &Points,
    (part, parts): (u32, u32),
) -> SecondaryRay {
    let u = F::jittered(&points.stratum(Purpose::Glossy(child.bounce), part, parts));
    let side = match child.bounce {
        Bounce::Reflection => surface.geometric_normal,
        Bounce::Transmission => -surface.geometric_normal,
    };
    let direction = F::sample_phong_lobe(child.direction, side, roughness, u);
    SecondaryRay { direction, weight: child.weight / parts as f32, ..*child }
}
