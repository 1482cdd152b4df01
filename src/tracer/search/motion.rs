//! Positions of moving shapes at the time of a ray.

use crate::kit::StudentFunctions;
use crate::shape::{Plane, Sphere, Triangle};
use crate::world::{Geometry, InfinitePlane, Primitive, World};
use glam::Vec3;

/// The geometry of `primitive` at shutter time `time`, `0..=1`, interpolated linearly between its two ends;
/// the geometry itself if it does not move.
#[inline]
pub fn geometry_at<F: StudentFunctions>(world: &World, primitive: &Primitive, time: f32) -> Geometry {
    match primitive.end.get() {
        None => primitive.geometry,
        Some(end) => moved::<F>(&primitive.geometry, &world.ends[end], time),
    }
}

#[cold]
fn moved<F: StudentFunctions>(start: &Geometry, end: &Geometry, time: f32) -> Geometry {
    match (start, end) {
        (Geometry::Sphere(start), Geometry::Sphere(end)) => Geometry::Sphere(Sphere {
            center: F::lerp(start.center, end.center, time),
            radius: F::lerp(Vec3::splat(start.radius), Vec3::splat(end.radius), time).x,
        }),
        (Geometry::Triangle(start), Geometry::Triangle(end)) => {
            Geometry::Triangle(triangle_at::<F>(start, end, time))
        }
        (Geometry::OneSided(start), Geometry::OneSided(end)) => {
            Geometry::OneSided(triangle_at::<F>(start, end, time))
        }
        _ => *start, // a primitive does not change its kind, and solids do not move
    }
}

fn triangle_at<F: StudentFunctions>(start: &Triangle, end: &Triangle, time: f32) -> Triangle {
    Triangle {
        a: F::lerp(start.a, end.a, time),
        b: F::lerp(start.b, end.b, time),
        c: F::lerp(start.c, end.c, time),
    }
}

/// The infinite plane at shutter time `time`, `0..=1`, and the axes of its texture there, both in world
/// space.
pub fn plane_at<F: StudentFunctions>(plane: &InfinitePlane, time: f32) -> (Plane, [Vec3; 2]) {
    match &plane.motion {
        None => (plane.plane, plane.axes),
        Some([start, end]) => {
            let Triangle { a, b, c } = triangle_at::<F>(start, end, time);
            let axes = [b - a, c - a];
            (Plane { point: a, normal: axes[0].cross(axes[1]).normalize() }, axes)
        }
    }
}
