//! Stage 6 by the formulas of the slides, and of "Physically Based Rendering" for samples of the disk and of the sphere.

pub use exercises::stage6_distribution::{
    gaussian_weight, lerp, motion_bounds, sample_light_disk, sample_phong_lobe, sample_sphere, temporal_slot,
    time_in_shutter,
};
use glam::{Vec2, Vec3, vec2};
use raykata::camera::{Camera, Lens};
use raykata::kit::{FILTER_RADIUS, WeightedColor};
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::Sampler;
use std::f32::consts::TAU;

pub fn jittered(stratum: &Stratum) -> Vec2 {
    (stratum.cell.as_vec2() + stratum.u) / stratum.grid.as_vec2()
}

pub fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2 {
    match sampler {
        Sampler::Center => Vec2::splat(0.5),
        Sampler::Random | Sampler::LowDiscrepancy => stratum.u,
        Sampler::Jittered => crate::stage6_distribution::jittered(stratum),
        Sampler::Gaussian => {
            0.5 + FILTER_RADIUS * (2.0 * crate::stage6_distribution::jittered(stratum) - 1.0)
        }
    }
}

pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    let color: Vec3 = samples.iter().map(|sample| sample.weight * sample.color).sum();
    let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
    color / weight
}

pub fn sample_disk(u: Vec2) -> Vec2 {
    u.x.sqrt() * vec2((TAU * u.y).cos(), (TAU * u.y).sin())
}

pub fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray {
    let offset = lens.aperture / 2.0 * (on_lens.x * camera.right + on_lens.y * camera.up);
    let t = lens.focal_distance / pinhole.direction.dot(camera.towards);
    let origin = camera.position + offset;
    let focus = camera.position + t * pinhole.direction;
    Ray { origin, direction: (focus - origin).normalize(), ..*pinhole }
}

pub fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3 {
    corner + u.x * edges.0 + u.y * edges.1
}
