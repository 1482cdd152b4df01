//! The picture of stage 1.

use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;

fn colors(kit: &dyn Kit, rays: &[Ray], sphere: Sphere) -> Vec<Vec3> {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let on_floor = kit.plane(&rays.iter().map(|&ray| PlaneQuery { ray, plane: floor }).collect::<Vec<_>>());
    let to_sphere: Vec<SphereQuery> = rays.iter().map(|&ray| SphereQuery { ray, sphere }).collect();
    let on_sphere = kit.sphere_geometric(&to_sphere);
    let points: Vec<(Sphere, Vec3)> =
        rays.iter().zip(&on_sphere).map(|(ray, t)| (sphere, ray.at(t.unwrap_or(0.0)))).collect();
    let outwards = kit.sphere_normal(&points);
    let normals: Vec<(Vec3, Vec3)> = rays
        .iter()
        .zip(&on_sphere)
        .zip(outwards)
        .map(|((ray, t), out)| (t.map_or(Vec3::Y, |_| out), ray.direction))
        .collect();
    let facing = kit.face_forward(&normals);
    // Where a ray hits both, it hits the sphere first, because the sphere stands between the floor and the camera.
    let hit = on_floor.iter().zip(&on_sphere).map(|(floor, sphere)| floor.is_some() || sphere.is_some());
    hit.zip(facing)
        .map(|(hit, normal)| if hit { picture::normal_color(normal) } else { Vec3::ZERO })
        .collect()
}

pub(super) fn picture_of_a_sphere_on_a_plane(trial: &Trial<'_>) -> CheckResult {
    let hidden = (-0.8..0.8f32, -0.8..0.8f32, 0.5..1.2f32);
    let (x, z, radius) = trial.composed((0.0, 0.0, 1.0), hidden);
    let sphere = Sphere { center: vec3(x, radius, z), radius };
    let rays = picture::rays(trial, LARGE, vec3(2.0, 2.5, 5.0), 0.8 * Vec3::Y);
    // The outline of the sphere crosses about 60 of 4800 pixels. There rounding decides whether a ray hits or misses.
    let composed = Composed { name: "stage1_sphere_on_a_plane", size: LARGE, rays: &rays, may_differ: 0.001 };
    composed.check(trial, |kit| colors(kit, &rays, sphere))
}
