//! Stage 6 by the third hints. The other functions are those of the textbook, which contain the code of their hints.

pub use crate::textbook_distribution::*;
use glam::{Vec2, Vec3};
use raykata::aabb::Aabb;
use raykata::camera::{Camera, Lens, Shutter};
use raykata::kit::{FILTER_RADIUS, WeightedColor};
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::shape::{Disk, Sphere};
use std::f32::consts::TAU;

pub fn jittered(stratum: &Stratum) -> Vec2 {
    let place = (stratum.cell.as_vec2() + stratum.u) / stratum.grid.as_vec2();
    place.min(Vec2::splat(1.0 - f32::EPSILON / 2.0))
}

pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
    if weight > 0.0 { crate::textbook_distribution::filter_pixel(samples) } else { Vec3::ZERO }
}

pub fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray {
    let offset = lens.aperture / 2.0 * (on_lens.x * camera.right + on_lens.y * camera.up);
    if offset == Vec3::ZERO {
        return *pinhole;
    }
    let focus = lens.focal_distance / pinhole.direction.dot(camera.towards) * pinhole.direction;
    Ray { origin: camera.position + offset, direction: (focus - offset).normalize(), ..*pinhole }
}

/// The direction at the angle θ to `axis`, by 1 - cos θ.
fn around(axis: Vec3, below_one: f32, turn: f32) -> Vec3 {
    let (x, y) = axis.any_orthonormal_pair();
    let (sin, cos) = (TAU * turn).sin_cos();
    (1.0 - below_one) * axis + (below_one * (2.0 - below_one)).sqrt() * (cos * x + sin * y)
}

pub fn sample_sphere(sphere: &Sphere, from: Vec3, u: Vec2) -> Vec3 {
    let to_center = sphere.center - from;
    let sin_squared = sphere.radius.powi(2) / to_center.length_squared();
    let below_one = if sin_squared >= 1.0 { 2.0 } else { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) };
    around(to_center.normalize_or(Vec3::Y), u.x * below_one, u.y)
}

pub fn sample_phong_lobe(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3 {
    if roughness == 0.0 {
        return ideal;
    }
    let n = 2.0 / roughness.powi(2) - 2.0;
    let direction = around(ideal, -(u.x.ln() / (n + 1.0)).exp_m1(), u.y);
    let above = direction.dot(normal);
    if above < 0.0 { direction - 2.0 * above * normal } else { direction }
}

pub fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32 {
    let share = ((slot - 1) as f32 + u) / slots as f32;
    (shutter.open + share * (shutter.close - shutter.open)).clamp(shutter.open, shutter.close)
}

pub fn lerp(start: Vec3, end: Vec3, time: f32) -> Vec3 {
    let place = (1.0 - time) * start + time * end;
    place.max(start.min(end)).min(start.max(end))
}

pub fn gaussian_weight(offset: Vec2) -> f32 {
    let bell = |x: f32| ((-2.0 * x * x).exp() - (-2.0 * FILTER_RADIUS * FILTER_RADIUS).exp()).max(0.0);
    bell(offset.x) * bell(offset.y)
}

pub fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3 {
    let (x, y) = disk.normal.normalize().any_orthonormal_pair();
    let place = disk.radius * sample_disk(u);
    disk.center + place.x * x + place.y * y
}

pub fn temporal_slot(x: u32, y: u32) -> u32 {
    const TABLE: [[u32; 4]; 4] = [[7, 11, 3, 14], [4, 15, 13, 9], [16, 1, 8, 12], [6, 10, 5, 2]];
    TABLE[y as usize % 4][x as usize % 4]
}

pub fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb {
    Aabb::new(start.min.min(end.min), start.max.max(end.max))
}
