//! The picture of stage 6: blurred by a lens, by motion, by a rough surface and by an area light.

use checks::picture::{self, Sampled, Size};
use checks::prelude::*;
use checks::statistics;
use glam::{UVec2, uvec2};
use raykata::camera::{Camera, Lens, Shutter};
use raykata::random::Stratum;
use raykata::scene::Sampler;

/// The size of the picture. It is small, because each pixel has many samples.
const SIZE: Size = Size { width: 36, height: 24 };

/// Samples per pixel: four in each of 4 × 4 cells. There are as many time slots as cells.
const SAMPLES: usize = 64;
const CELLS: usize = 16;
const GRID: UVec2 = uvec2(4, 4);

/// The scene of the picture.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// A far sphere, a glossy one, and one that moves to `end` while the shutter is open.
    spheres: [Sphere; 3],
    end: Vec3,
    roughness: f32,
    lens: Lens,
    /// The corner and the edges of the area light.
    light: (Vec3, (Vec3, Vec3)),
}

const PUBLIC: Place = Place {
    spheres: [
        Sphere { center: vec3(-2.1, 0.9, -2.4), radius: 0.9 },
        Sphere { center: vec3(-0.35, 0.75, 0.4), radius: 0.75 },
        Sphere { center: vec3(1.0, 0.45, 1.0), radius: 0.45 },
    ],
    end: vec3(2.25, 0.45, 0.5),
    roughness: 0.5,
    lens: Lens { aperture: 0.4, focal_distance: 5.2 },
    light: (vec3(0.8, 3.4, 0.2), (vec3(2.6, 0.0, 0.0), vec3(0.0, 0.4, 2.2))),
};

/// The random numbers of one sample, one pair for each purpose. The samples of a pixel lie in all cells of a 4 × 4 grid, in
/// another order for each purpose.
struct Numbers {
    cell: UVec2,
    pixel: Vec2,
    lens: Vec2,
    time: f32,
    light: Vec2,
    lobe: Vec2,
}

fn numbers(count: usize) -> Vec<Numbers> {
    let pairs = statistics::pairs(6, 5 * count);
    let one = |(index, u): (usize, &[Vec2])| {
        let (pixel, sample) = (index / SAMPLES, index % SAMPLES);
        // A step that is odd visits all 16 cells.
        let cell = |step: usize| {
            let number = ((step * sample + 7 * pixel + sample / CELLS) % CELLS) as u32;
            uvec2(number % 4, number / 4)
        };
        let place = |step: usize, u: Vec2| ((cell(step).as_vec2() + u) / 4.0).min(Vec2::splat(0.999_999));
        Numbers {
            cell: uvec2(sample as u32 % 4, sample as u32 / 4 % 4),
            pixel: u[0],
            lens: place(5, u[1]),
            time: u[2].x,
            light: place(11, u[3]),
            lobe: place(13, u[4]),
        }
    };
    pairs.chunks(5).enumerate().map(one).collect()
}

/// The nearest sphere on the way of a ray.
fn nearest(ray: &Ray, spheres: &[Sphere; 3]) -> Option<(f32, usize)> {
    let hits = spheres.iter().enumerate().filter_map(|(index, sphere)| {
        let to_center = sphere.center - ray.origin;
        let middle = to_center.dot(ray.direction);
        let half = sphere.radius * sphere.radius - (to_center - middle * ray.direction).length_squared();
        let t = middle - half.sqrt();
        (half > 0.0 && t > 1e-3).then_some((t, index))
    });
    hits.min_by(|(p, _), (q, _)| p.total_cmp(q))
}

fn sky(direction: Vec3) -> Vec3 {
    vec3(0.62, 0.66, 0.72).lerp(vec3(0.1, 0.2, 0.45), direction.y.clamp(0.0, 1.0))
}

fn floor(point: Vec3) -> Vec3 {
    let squares = 0.5 + 0.5 * (4.0 * (3.0 * point.x).sin() * (3.0 * point.z).sin()).tanh();
    vec3(0.2, 0.26, 0.3).lerp(vec3(0.75, 0.72, 0.66), squares)
}

const COLORS: [Vec3; 3] = [vec3(0.85, 0.45, 0.1), vec3(0.9, 0.92, 0.95), vec3(0.75, 0.12, 0.12)];

/// The samples of all pixels, from the answers of one kit for all samples at once.
fn samples(kit: &dyn Kit, camera: &Camera, pixels: &[(u32, u32)], place: &Place) -> Vec<Vec<Vec3>> {
    let numbers = numbers(SAMPLES * pixels.len());
    let (width, height) = (SIZE.width as f32, SIZE.height as f32);
    // A pinhole ray through each sample of the pixel, and from it a ray from the lens.
    let strata: Vec<(Sampler, Stratum)> = numbers
        .iter()
        .map(|one| (Sampler::Jittered, Stratum { cell: one.cell, grid: GRID, u: one.pixel }))
        .collect();
    let on_lens = kit.sample_disk(&numbers.iter().map(|one| one.lens).collect::<Vec<_>>());
    let lens_queries: Vec<LensQuery> = kit
        .pixel_position(&strata)
        .into_iter()
        .zip(on_lens)
        .enumerate()
        .map(|(index, (at, on_lens))| {
            let (x, y) = pixels[index / SAMPLES];
            let pinhole = camera.ray((x as f32 + at.x) / width, (y as f32 + at.y) / height);
            LensQuery { camera: *camera, pinhole, lens: place.lens, on_lens }
        })
        .collect();
    let rays = kit.lens_ray(&lens_queries);
    // The time of each ray, by the slot of its cell, and where the third sphere is then.
    let slots = kit.temporal_slot(&numbers.iter().map(|one| (one.cell.x, one.cell.y)).collect::<Vec<_>>());
    let times: Vec<TimeQuery> = slots
        .into_iter()
        .zip(&numbers)
        .map(|(slot, one)| TimeQuery {
            shutter: Shutter { open: 0.0, close: 1.0 },
            slot,
            slots: 16,
            u: one.time,
        })
        .collect();
    let moves: Vec<(Vec3, Vec3, f32)> = kit
        .time_in_shutter(&times)
        .into_iter()
        .map(|time| (place.spheres[2].center, place.end, time))
        .collect();
    let centers = kit.lerp(&moves);
    let spheres_at = |index: usize| {
        let [first, second, third] = place.spheres;
        [first, second, Sphere { center: centers[index], ..third }]
    };
    // A point of the area light per ray, and the direction in which the glossy sphere reflects the ray.
    let (corner, edges) = place.light;
    let lights: Vec<RectangleQuery> =
        numbers.iter().map(|one| RectangleQuery { corner, edges, u: one.light }).collect();
    let lights = kit.sample_rectangle(&lights);
    let hits: Vec<_> = rays.iter().enumerate().map(|(index, ray)| nearest(ray, &spheres_at(index))).collect();
    let is_glossy = |index: &usize| hits[*index].is_some_and(|(_, sphere)| sphere == 1);
    let glossy: Vec<usize> = (0..rays.len()).filter(is_glossy).collect();
    let lobes: Vec<PhongLobeQuery> = glossy
        .iter()
        .map(|&index| {
            let (direction, t) = (rays[index].direction, hits[index].map_or(0.0, |(t, _)| t));
            let normal = (rays[index].at(t) - place.spheres[1].center).normalize_or_zero();
            let ideal = (direction - 2.0 * direction.dot(normal) * normal).normalize_or_zero();
            PhongLobeQuery { ideal, normal, roughness: place.roughness, u: numbers[index].lobe }
        })
        .collect();
    let mut lobes = kit.sample_phong_lobe(&lobes).into_iter();
    // The light of a point that scatters light evenly: that of the sky, and that of the area light unless a sphere is between.
    let lit = |index: usize, point: Vec3, normal: Vec3| {
        let to_light = lights[index] - point;
        let distance = to_light.length();
        let shadow = Ray::new(point + 1e-3 * normal, to_light / distance);
        let is_hidden = nearest(&shadow, &spheres_at(index)).is_some_and(|(t, _)| t < distance);
        let cosine = if is_hidden { 0.0 } else { normal.dot(to_light / distance).max(0.0) };
        0.22 + 0.78 * cosine
    };
    let seen = |index: usize, ray: &Ray| match nearest(ray, &spheres_at(index)) {
        Some((t, sphere)) => {
            let point = ray.at(t);
            let normal = (point - spheres_at(index)[sphere].center).normalize_or_zero();
            COLORS[sphere] * lit(index, point, normal)
        }
        None if ray.direction.y < 0.0 => {
            let point = ray.at(-ray.origin.y / ray.direction.y);
            let far = (-0.12 * (point.length() - 3.0).max(0.0)).exp();
            (floor(point) * lit(index, point, Vec3::Y)).lerp(sky(Vec3::X), 1.0 - far)
        }
        None => sky(ray.direction),
    };
    let color = |(index, ray): (usize, &Ray)| match hits[index] {
        Some((t, 1)) => {
            let reflected = Ray::new(ray.at(t), lobes.next().unwrap_or_default());
            COLORS[1] * seen(index, &reflected)
        }
        _ => seen(index, ray),
    };
    let colors: Vec<Vec3> = rays.iter().enumerate().map(color).collect();
    colors.chunks(SAMPLES).map(<[Vec3]>::to_vec).collect()
}

pub(super) fn picture_of_soft_edges(trial: &Trial<'_>) -> CheckResult {
    let shifts = (-0.3..0.3f32, -0.3..0.3f32, 0.0..1f32, 0.2..0.6f32, 0.1..0.3f32);
    let hidden = shifts.prop_map(|(x, z, along, roughness, aperture)| {
        let mut place = Place { roughness, ..PUBLIC };
        place.spheres[1].center += vec3(x, 0.0, z);
        place.end.z -= along;
        place.light.0.x -= 3.0 * along;
        place.lens.aperture = aperture;
        place
    });
    let place = trial.composed(PUBLIC, hidden);
    let camera = picture::camera(SIZE, vec3(0.0, 1.7, 5.6), vec3(-0.1, 0.75, 0.0));
    let pixels: Vec<(u32, u32)> = picture::pixels_of(trial, SIZE).collect();
    let picture = Sampled { name: "stage6_soft_edges", size: SIZE };
    picture.check(trial, |kit| samples(kit, &camera, &pixels, &place))
}
