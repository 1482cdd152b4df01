//! Pictures of shadow acne: spheres on a floor, traced with the kit's own functions, whose shadow rays start in three ways.

use crate::pictures::{crop, load, magnified, panels, rays_of};
use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use raykata::camera::Camera;
use raykata::film::{Film, Tone, ToneCurve};
use raykata::kit::{
    Kit, LightSample, OffsetQuery, PlaneQuery, ShadeQuery, ShadowQuery, SphereQuery, Surface,
};
use raykata::material::{Emitter, Light, Material};
use raykata::ray::Ray;
use raykata::rounding::gamma;
use raykata::scene::Background;
use raykata::shape::{Plane, Shape, Sphere};
use raykata::world::camera_for;
use std::path::Path;

/// Where a shadow ray starts.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// At the computed point.
    AtPoint,
    /// This far along the normal.
    Fixed(f32),
    /// Where `shadow_ray` starts it.
    ShadowRay,
    /// Where `offset_origin` starts it.
    OffsetOrigin,
}

/// Spheres on the floor y = 0, under lights without area.
struct Place {
    spheres: Vec<(Sphere, Material)>,
    floor: Material,
    lights: Vec<Light>,
    ambient: Vec3,
    background: Vec3,
}

/// The number of roundings that bounds the error of a point: those of `t` and of `origin + t direction`.
const ROUNDINGS: u32 = 32;

const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

impl Place {
    /// For each ray the first surface that it meets: its number, the floor last, and the distance.
    fn first_hits(&self, kit: &dyn Kit, rays: &[Ray]) -> Vec<Option<(usize, f32)>> {
        let floor = self.spheres.len();
        let queries: Vec<_> = rays.iter().map(|&ray| PlaneQuery { ray, plane: FLOOR }).collect();
        let mut first: Vec<Option<(usize, f32)>> =
            kit.plane(&queries).into_iter().map(|t| t.map(|t| (floor, t))).collect();
        for (index, (sphere, _)) in self.spheres.iter().enumerate() {
            let queries: Vec<_> = rays.iter().map(|&ray| SphereQuery { ray, sphere: *sphere }).collect();
            for (first, t) in first.iter_mut().zip(kit.sphere_algebraic(&queries)) {
                *first = match (*first, t) {
                    (Some((_, before)), Some(t)) if before <= t => *first,
                    (_, Some(t)) => Some((index, t)),
                    _ => *first,
                };
            }
        }
        first
    }

    /// The surfaces that rays meet: for each hit the pixel of its ray, the number of the surface, and the surface.
    fn surfaces(&self, kit: &dyn Kit, rays: &[Ray]) -> Vec<(usize, usize, Surface)> {
        let hits = self.first_hits(kit, rays);
        let found: Vec<(usize, usize, f32)> = hits
            .into_iter()
            .enumerate()
            .filter_map(|(pixel, hit)| hit.map(|(index, t)| (pixel, index, t)))
            .collect();
        // The floor is asked for the normal of some sphere, too, so that there is one answer per hit.
        let some = self.spheres[0].0;
        let sphere = |index: usize| self.spheres.get(index).map_or(some, |(sphere, _)| *sphere);
        let queries: Vec<(Sphere, Vec3)> =
            found.iter().map(|&(pixel, index, t)| (sphere(index), rays[pixel].at(t))).collect();
        let of_spheres = kit.sphere_normal(&queries);
        let normals: Vec<(Vec3, Vec3)> = found
            .iter()
            .zip(of_spheres)
            .map(|(&(pixel, index, _), normal)| {
                (if index == self.spheres.len() { Vec3::Y } else { normal }, rays[pixel].direction)
            })
            .collect();
        let normals = kit.face_forward(&normals);
        let surface = |((pixel, index, t), normal): ((usize, usize, f32), Vec3)| {
            let ray = &rays[pixel];
            let error = gamma(ROUNDINGS) * (ray.origin.abs() + (t * ray.direction).abs());
            let point = ray.at(t);
            (pixel, index, Surface { point, error, geometric_normal: normal, shading_normal: normal })
        };
        found.into_iter().zip(normals).map(surface).collect()
    }

    /// The colours along rays, and the share of the shadow rays that hit the surface from which they start.
    fn colors(&self, kit: &dyn Kit, rays: &[Ray], start: Start) -> (Vec<Vec3>, f64) {
        let found = self.surfaces(kit, rays);
        // Ask for all shadow rays, and let them start as `start` says.
        let mut asked = Vec::new();
        for (place, (_, _, surface)) in found.iter().enumerate() {
            for (light, sample) in self.lights.iter().map(|light| sample(light, surface.point)).enumerate() {
                asked.push((place, light, ShadowQuery { surface: *surface, light: sample }));
            }
        }
        let queries: Vec<ShadowQuery> = asked.iter().map(|(.., query)| *query).collect();
        let shadow_rays: Vec<(usize, usize, Ray)> = asked
            .iter()
            .zip(kit.shadow_ray(&queries))
            .filter_map(|((place, light, _), ray)| Some((*place, *light, ray?)))
            .collect();
        let origins = started(kit, &found, &shadow_rays, start);
        let shadow_rays: Vec<(usize, usize, Ray)> = shadow_rays
            .into_iter()
            .zip(origins)
            .map(|((place, light, ray), origin)| (place, light, Ray { origin, ..ray }))
            .collect();
        // Find what they hit. A convex surface that faces the light cannot hide it from itself.
        let only_rays: Vec<Ray> = shadow_rays.iter().map(|(.., ray)| *ray).collect();
        let mut visible = vec![vec![true; self.lights.len()]; found.len()];
        let mut own = 0;
        for ((place, light, _), hit) in shadow_rays.iter().zip(self.first_hits(kit, &only_rays)) {
            visible[*place][*light] = hit.is_none();
            own += usize::from(hit.is_some_and(|(index, _)| index == found[*place].1));
        }
        let material = |index: usize| self.spheres.get(index).map_or(&self.floor, |(_, material)| material);
        let queries: Vec<ShadeQuery> = found
            .iter()
            .zip(visible)
            .map(|((pixel, index, surface), visible)| ShadeQuery {
                surface: *surface,
                to_viewer: -rays[*pixel].direction.normalize(),
                material: material(*index).clone(),
                ambient: self.ambient,
                lights: self.lights.iter().map(|light| sample(light, surface.point)).collect(),
                visible,
            })
            .collect();
        let mut colors = vec![self.background; rays.len()];
        for ((pixel, ..), answer) in found.iter().zip(kit.shade(&queries)) {
            colors[*pixel] = answer.color;
        }
        (colors, own as f64 / shadow_rays.len().max(1) as f64)
    }
}

/// The light that arrives at a point, without occlusion.
fn sample(light: &Light, point: Vec3) -> LightSample {
    let radiance = light.radiance();
    match &light.emitter {
        Emitter::Point { position, .. } => {
            let to_light = *position - point;
            LightSample { direction: to_light.normalize(), distance: to_light.length(), radiance }
        }
        Emitter::Directional { direction } => {
            LightSample { direction: -direction.normalize(), distance: f32::INFINITY, radiance }
        }
        Emitter::Area { .. } => LightSample { direction: Vec3::Y, distance: 0.0, radiance: Vec3::ZERO },
    }
}

/// Where each shadow ray starts.
fn started(
    kit: &dyn Kit,
    found: &[(usize, usize, Surface)],
    rays: &[(usize, usize, Ray)],
    start: Start,
) -> Vec<Vec3> {
    let surface = |place: &usize| found[*place].2;
    match start {
        Start::AtPoint => rays.iter().map(|(place, ..)| surface(place).point).collect(),
        Start::Fixed(distance) => rays
            .iter()
            .map(|(place, ..)| surface(place).point + distance * surface(place).geometric_normal)
            .collect(),
        Start::ShadowRay => rays.iter().map(|(.., ray)| ray.origin).collect(),
        Start::OffsetOrigin => {
            let query = |(place, _, ray): &(usize, usize, Ray)| {
                let Surface { point, error, geometric_normal: normal, .. } = surface(place);
                OffsetQuery { point, error, normal, direction: ray.direction }
            };
            kit.offset_origin(&rays.iter().map(query).collect::<Vec<_>>())
        }
    }
}

/// scenes/stage4.toml with shadow rays that start at the computed point, and with those of `shadow_ray`.
pub fn shadow_acne(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let scene = load(root, "stage4.toml")?;
    let material = |index: Option<usize>| scene.materials[index.unwrap_or(0)].clone();
    let mut place = Place {
        spheres: Vec::new(),
        floor: Material::default(),
        lights: scene.lights.clone(),
        ambient: scene.ambient,
        background: match scene.background {
            Background::Gradient(gradient) => gradient.horizon,
            _ => Vec3::ZERO,
        },
    };
    for node in &scene.nodes {
        match &node.shape {
            Some(Shape::Sphere(sphere)) => place.spheres.push((*sphere, material(node.material))),
            Some(Shape::Plane(_)) => place.floor = material(node.material),
            _ => anyhow::bail!("scenes/stage4.toml has another shape than a sphere or the floor"),
        }
    }
    let size = [scene.film.width, scene.film.height];
    let rays: Vec<Ray> = rays_of(&camera_for(&scene), size);
    let mut parts = Vec::new();
    for (start, name) in [(Start::AtPoint, "at the point"), (Start::ShadowRay, "shadow_ray")] {
        let (pixels, own) = place.colors(kit, &rays, start);
        let film = Film { width: size[0], height: size[1], pixels }.toned(scene.film.tone);
        let text = format!("{name}: {:.0} % in their own shadow", 100.0 * own);
        parts.push((magnified(&crop(&film, CROP, [250, 210]), 2), text));
    }
    panels(&parts, 2)
}

/// Where the dull sphere stands on the floor of scenes/stage4.toml.
const CROP: [u32; 2] = [330, 130];

/// A sphere on a floor at three sizes, with shadow rays that start in three ways.
pub fn offset_strip(kit: &dyn Kit, _root: &Path) -> Result<Vec<u8>> {
    const SIZE: [u32; 2] = [240, 150];
    let mut parts = Vec::new();
    for (start, row) in [
        (Start::AtPoint, "no offset"),
        (Start::Fixed(1e-4), "0.0001"),
        (Start::OffsetOrigin, "offset_origin"),
    ] {
        for size in [0.001f32, 1.0, 1000.0] {
            let material = |diffuse: Vec3| Material { diffuse, ambient: diffuse, ..Material::default() };
            let sphere = Sphere { center: size * vec3(0.0, 0.7, 0.0), radius: size * 0.6 };
            let emitter =
                Emitter::Point { position: size * vec3(1.9, 3.1, 1.7), falloff: Default::default() };
            let light = Light { emitter, color: Vec3::ONE, intensity: 0.85, shadows: true, cone: None };
            let place = Place {
                spheres: vec![(sphere, material(vec3(0.85, 0.45, 0.15)))],
                floor: material(vec3(0.55, 0.62, 0.70)),
                lights: vec![light],
                ambient: Vec3::splat(0.08),
                background: vec3(0.04, 0.07, 0.14),
            };
            let position = size * vec3(0.3, 1.9, 4.1);
            let aspect = SIZE[0] as f32 / SIZE[1] as f32;
            let camera =
                Camera::new(position, size * vec3(-0.1, 0.5, 0.0) - position, Vec3::Y, 30.0, aspect)?;
            let (pixels, _) = place.colors(kit, &rays_of(&camera, SIZE), start);
            let film = Film { width: SIZE[0], height: SIZE[1], pixels };
            let film = film.toned(Tone { exposure: 0.0, curve: ToneCurve::Clamp });
            parts.push((film, format!("{row}, size {size}")));
        }
    }
    panels(&parts, 3).context("the strip cannot be drawn")
}
