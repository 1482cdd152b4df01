//! Stage 4 as on the slides on local illumination, with an epsilon from a book.

use glam::Vec3;
use raykata::kit::{LightSample, Surface};
use raykata::material::Material;
use raykata::ray::Ray;

pub fn shading_normal(geometric: Vec3, interpolated: Option<Vec3>, direction: Vec3) -> Vec3 {
    let facing = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
    let smooth = interpolated.map_or(facing, Vec3::normalize);
    if smooth.dot(facing) < 0.0 { -smooth } else { smooth }
}

pub fn diffuse_term(normal: Vec3, to_light: Vec3) -> f32 {
    normal.dot(to_light).max(0.0)
}

pub fn specular_term(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32 {
    let reflected = 2.0 * normal.dot(to_light) * normal - to_light;
    if normal.dot(to_light) > 0.0 && reflected.dot(to_viewer) > 0.0 {
        reflected.dot(to_viewer).powf(exponent)
    } else {
        0.0
    }
}

pub fn shadow_ray(surface: &Surface, light: &LightSample) -> Option<Ray> {
    if surface.geometric_normal.dot(light.direction) <= 0.0 {
        return None;
    }
    let origin = surface.point + 1e-3 * surface.geometric_normal;
    Some(Ray::new(origin, light.direction).with_range(0.0, 0.999 * light.distance))
}

pub fn shade(
    surface: &Surface,
    to_viewer: Vec3,
    material: &Material,
    ambient: Vec3,
    lights: &[LightSample],
    mut visible: impl FnMut(usize, &Ray) -> bool,
) -> Vec3 {
    let (normal, exponent) = (surface.shading_normal, material.exponent);
    let mut color = ambient * material.ambient;
    for (i, light) in lights.iter().enumerate() {
        let Some(ray) = crate::stage4_shading::shadow_ray(surface, light) else { continue };
        let specular = specular_term(normal, light.direction, to_viewer, exponent);
        let added = light.radiance
            * (material.diffuse * diffuse_term(normal, light.direction) + material.specular * specular);
        if added != Vec3::ZERO && visible(i, &ray) {
            color += added;
        }
    }
    color
}

pub fn encode_gamma(linear: f32) -> u8 {
    (255.0 * linear.sqrt()).round() as u8
}

pub fn decode_gamma(byte: u8) -> f32 {
    (f32::from(byte) / 255.0).powi(2)
}
