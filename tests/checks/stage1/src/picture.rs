//! The picture of stage 1.

use checks::broken::CheckResult;
use checks::{Trial, picture};
use glam::Vec3;
use raykata::kit::{PlaneQuery, SphereQuery};
use raykata::shape::{Plane, Sphere};

pub(super) fn picture_of_a_sphere_on_a_plane(trial: &Trial<'_>) -> CheckResult {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let sphere = Sphere { center: Vec3::Y, radius: 1.0 };
    let rays = picture::rays(trial, Vec3::new(2.0, 2.5, 5.0), 0.8 * Vec3::Y);
    let on_floor =
        trial.kit.plane(&rays.iter().map(|&ray| PlaneQuery { ray, plane: floor }).collect::<Vec<_>>());
    let to_sphere: Vec<SphereQuery> = rays.iter().map(|&ray| SphereQuery { ray, sphere }).collect();
    let on_sphere = trial.kit.sphere_geometric(&to_sphere);
    let points: Vec<(Sphere, Vec3)> =
        rays.iter().zip(&on_sphere).map(|(ray, t)| (sphere, ray.at(t.unwrap_or(0.0)))).collect();
    let outwards = trial.kit.sphere_normal(&points);
    let normals: Vec<(Vec3, Vec3)> = rays
        .iter()
        .zip(&on_sphere)
        .zip(outwards)
        .map(|((ray, t), out)| (t.map_or(Vec3::Y, |_| out), ray.direction))
        .collect();
    let facing = trial.kit.face_forward(&normals);
    // Where a ray hits both, it hits the sphere first, because the sphere stands between the floor and the camera.
    let hit = on_floor.iter().zip(&on_sphere).map(|(floor, sphere)| floor.is_some() || sphere.is_some());
    let colors =
        hit.zip(facing).map(|(hit, normal)| if hit { picture::normal_color(normal) } else { Vec3::ZERO });
    // The outline of the sphere crosses about 60 of 4800 pixels. There rounding decides whether a ray hits or misses.
    picture::compare(trial, "stage1_sphere_on_a_plane", &picture::film_of(colors.collect()), &rays, 0.001)
}
