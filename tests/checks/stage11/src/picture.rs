//! The picture of stage 11: a sphere on a floor under two area lights that are seen, with next event estimation and
//! multiple importance sampling.

use checks::picture::{self, Sampled, Size};
use checks::prelude::*;
use checks::statistics;
use raykata::camera::Camera;
use raykata::emitter::{AreaEmitter, EmitterShape};

/// The size of the picture. It is small, because each pixel has many samples.
const SIZE: Size = Size { width: 36, height: 24 };
/// The number of samples per pixel.
const SAMPLES: usize = 48;

/// The scene of the picture: a floor at height 0, a sphere, a parallelogram that emits light downwards, and a small sphere
/// that emits light.
#[derive(Clone, Copy, Debug)]
struct Place {
    sphere: Sphere,
    color: Vec3,
    emitters: [AreaEmitter; 2],
}

/// What a ray hits.
#[derive(Clone, Copy)]
enum Hit {
    Sky,
    Emitter(usize),
    /// A point, the normal and the diffuse reflectance.
    Surface(Vec3, Vec3, Vec3),
}

impl Place {
    fn new(sphere: Sphere, color: Vec3, small: Vec3, turn: f32) -> Place {
        let parallelogram = EmitterShape::Parallelogram {
            corner: vec3(-1.6, 2.4, -0.6),
            edges: (vec3(1.4, turn, 0.0), vec3(0.2, 0.0, 1.1)),
        };
        let small = EmitterShape::Sphere(Sphere { center: small, radius: 0.22 });
        let emitter = |shape, radiance| AreaEmitter { shape, radiance, two_sided: false };
        Place {
            sphere,
            color,
            emitters: [emitter(parallelogram, vec3(12.0, 11.0, 9.5)), emitter(small, vec3(3.4, 4.2, 5.6))],
        }
    }

    /// What a ray hits first, beyond the rounding of its origin.
    fn hit(&self, ray: &Ray) -> Hit {
        let mut nearest = (f32::INFINITY, Hit::Sky);
        let mut offer = |t: f32, hit: &dyn Fn(Vec3) -> Hit| {
            if t > 1e-3 && t < nearest.0 {
                nearest = (t, hit(ray.at(t)));
            }
        };
        offer(-ray.origin.y / ray.direction.y, &|point| {
            // The floor ends before the horizon, which is dark.
            let squares = (point.x.floor() + point.z.floor()).rem_euclid(2.0);
            let albedo = vec3(0.35, 0.38, 0.42).lerp(vec3(0.75, 0.73, 0.7), squares);
            if point.length() < 12.0 { Hit::Surface(point, Vec3::Y, albedo) } else { Hit::Sky }
        });
        let sphere = |sphere: &Sphere| {
            let to_center = sphere.center - ray.origin;
            let middle = to_center.dot(ray.direction);
            let half = sphere.radius * sphere.radius - (to_center - middle * ray.direction).length_squared();
            middle - half.sqrt()
        };
        let Sphere { center, radius } = self.sphere;
        offer(sphere(&self.sphere), &|point| Hit::Surface(point, (point - center) / radius, self.color));
        for (index, emitter) in self.emitters.iter().enumerate() {
            match emitter.shape {
                EmitterShape::Sphere(light) => offer(sphere(&light), &|_| Hit::Emitter(index)),
                EmitterShape::Parallelogram { corner, edges } => {
                    // Two planes through the origin of the ray contain two opposite edges each.
                    let (first, second) = edges;
                    let normal = first.cross(second);
                    let t = (corner - ray.origin).dot(normal) / ray.direction.dot(normal);
                    let from_corner = ray.at(t) - corner;
                    let share = |axis: Vec3, other: Vec3| {
                        let across = other.cross(normal);
                        from_corner.dot(across) / axis.dot(across)
                    };
                    let shares = [share(first, second), share(second, first)];
                    if shares.iter().all(|share| (0.0..=1.0).contains(share)) {
                        // The back is black.
                        let front = ray.direction.dot(normal) < 0.0;
                        let back = Hit::Surface(Vec3::ZERO, Vec3::Y, Vec3::ZERO);
                        offer(t, &|_| if front { Hit::Emitter(index) } else { back });
                    }
                }
                EmitterShape::Triangle(_) => {}
            }
        }
        nearest.1
    }
}

/// The samples of all pixels, from the answers of one kit for all samples at once.
fn samples(kit: &dyn Kit, camera: &Camera, pixels: &[(u32, u32)], place: &Place) -> Vec<Vec<Vec3>> {
    let numbers = statistics::pairs(11, 4 * SAMPLES * pixels.len());
    let (width, height) = (SIZE.width as f32, SIZE.height as f32);
    let hits: Vec<Hit> = numbers
        .chunks(4)
        .enumerate()
        .map(|(index, u)| {
            let (x, y) = pixels[index / SAMPLES];
            place.hit(&camera.ray((x as f32 + u[0].x) / width, (y as f32 + u[0].y) / height))
        })
        .collect();
    // The surfaces that are seen, with the number of their sample.
    let surfaces: Vec<(usize, Vec3, Vec3, Vec3)> = hits
        .iter()
        .enumerate()
        .filter_map(|(index, hit)| match hit {
            Hit::Surface(point, normal, albedo) => Some((index, *point, *normal, *albedo)),
            _ => None,
        })
        .collect();
    let mut colors: Vec<Vec3> = hits
        .iter()
        .map(|hit| match hit {
            Hit::Emitter(index) => place.emitters[*index].radiance.min(Vec3::ONE),
            _ => Vec3::ZERO,
        })
        .collect();
    // Next event estimation: a point of each emitter, weighted against the direction that is found by chance.
    let u = |sample: usize, purpose: usize| -> Vec2 { numbers[4 * sample + purpose] };
    for (index, emitter) in place.emitters.iter().enumerate() {
        let queries: Vec<EmitterQuery> = surfaces
            .iter()
            .map(|(sample, point, ..)| EmitterQuery {
                emitter: *emitter,
                from: *point,
                u: u(*sample, 1 + index),
            })
            .collect();
        let lights: Vec<_> = surfaces
            .iter()
            .zip(kit.sample_light(&queries))
            .filter_map(|(surface, light)| Some((surface, light?)))
            .filter(|((_, point, normal, _), light)| {
                let ray = Ray::new(*point, light.direction);
                light.direction.dot(*normal) > 0.0
                    && matches!(place.hit(&ray), Hit::Emitter(found) if found == index)
            })
            .collect();
        let directions: Vec<(Vec3, Vec3)> =
            lights.iter().map(|((_, _, normal, _), light)| (*normal, light.direction)).collect();
        let densities: Vec<(f32, f32)> = lights
            .iter()
            .zip(kit.cosine_pdf(&directions))
            .map(|((_, light), pdf)| (light.pdf, pdf))
            .collect();
        for (((sample, _, normal, albedo), light), weight) in lights.iter().zip(kit.mis_weight(&densities)) {
            let cosine = light.direction.dot(*normal);
            let share = weight * cosine / (std::f32::consts::PI * light.pdf);
            colors[*sample] += share * *albedo * light.radiance;
        }
    }
    // A direction by chance, weighted against the point of the emitter that it finds.
    let queries: Vec<(Vec3, Vec2)> =
        surfaces.iter().map(|(sample, _, normal, _)| (*normal, u(*sample, 3))).collect();
    let found: Vec<_> = surfaces
        .iter()
        .zip(kit.cosine_direction(&queries))
        .filter_map(|(surface, direction)| match place.hit(&Ray::new(surface.1, direction)) {
            Hit::Emitter(index) => Some((surface, direction, place.emitters[index])),
            _ => None,
        })
        .collect();
    let directions: Vec<(Vec3, Vec3)> =
        found.iter().map(|((_, _, normal, _), direction, _)| (*normal, *direction)).collect();
    let queries: Vec<EmitterPdfQuery> = found
        .iter()
        .map(|((_, point, ..), direction, emitter)| EmitterPdfQuery {
            emitter: *emitter,
            from: *point,
            direction: *direction,
        })
        .collect();
    let densities: Vec<(f32, f32)> =
        kit.cosine_pdf(&directions).into_iter().zip(kit.light_pdf(&queries)).collect();
    for (((sample, _, _, albedo), _, emitter), weight) in found.iter().zip(kit.mis_weight(&densities)) {
        colors[*sample] += weight * *albedo * emitter.radiance;
    }
    colors.chunks(SAMPLES).map(<[Vec3]>::to_vec).collect()
}

pub(super) fn picture_of_a_sphere_and_its_light(trial: &Trial<'_>) -> CheckResult {
    let sphere = Sphere { center: vec3(0.1, 0.75, 0.0), radius: 0.75 };
    let public = Place::new(sphere, vec3(0.8, 0.5, 0.35), vec3(1.35, 0.5, 0.9), 0.0);
    let shifts = (-0.3..0.3f32, 0.6..0.8f32, 0.0..0.3f32, -0.3..0.3f32, 0.3..0.8f32);
    let hidden = shifts.prop_map(|(x, radius, turn, z, color)| {
        let sphere = Sphere { center: vec3(x, radius, z), radius };
        Place::new(sphere, vec3(0.8, color, 0.35), vec3(1.35, 0.4 + turn, 0.9 + z), turn)
    });
    let place = trial.composed(public, hidden);
    let camera = picture::camera(SIZE, vec3(0.0, 1.7, 5.4), vec3(0.0, 0.95, 0.0));
    let pixels: Vec<(u32, u32)> = picture::pixels_of(trial, SIZE).collect();
    let picture = Sampled { name: "stage11_sphere_and_its_light", size: SIZE };
    picture.check(trial, |kit| samples(kit, &camera, &pixels, &place))
}
