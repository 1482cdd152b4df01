//! Filtered images by cone tracing: a ray stands for a narrow cone, and the part of an image that the cone covers is read
//! from a smaller copy of the image (mip level).
//!
//! One read per hit sees single pixels of a distant image, which sparkle from pixel to pixel and from picture to picture.
//! The cone has the width of a pixel, so the part that it covers is what the pixel should show. On a surface that is seen
//! at a grazing angle this part is long and narrow. It is then read at several points along its longer axis, so that
//! the image stays sharp along the shorter one.
//!
//! Sources: Amanatides, "Ray tracing with cones", 1984; Williams, "Pyramidal parametrics", 1983 (mip levels);
//! Akenine-Möller et al., "Texture level of detail strategies for real-time ray tracing", Ray Tracing Gems, 2019 (ray cones);
//! McCormack et al., "Feline: fast elliptical lines for anisotropic texture mapping", 1999 (several reads along the longer axis).

use super::interaction::{SurfaceInteraction, from_center, inside};
use crate::count::{Event, Tally};
use crate::effects::Effects;
use crate::kit::StudentFunctions;
use crate::material::Texture;
use crate::ray::Ray;
use crate::rounding::floor;
use crate::shape::{Triangle, around_sphere, between_poles};
use crate::tracer::search::hit::{Hit, Target};
use crate::tracer::search::motion::{geometry_at, plane_at};
use crate::world::{Geometry, World};
use glam::{Vec2, Vec3, vec2};
use std::sync::Arc;

/// The cone around a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cone {
    /// The diameter at the origin of the ray, in world units.
    pub width: f32,
    /// The growth of the diameter per world unit along the ray.
    pub spread: f32,
}

impl Cone {
    /// The diameter at `distance` from the origin of the ray.
    pub fn width_at(&self, distance: f32) -> f32 {
        self.width + self.spread * distance
    }

    /// The cone of a ray that leaves the surface at `distance`. The `curvature` of the surface is 1 / radius. Across the cone
    /// the normal turns by the angle `curvature * width`, and the direction of the ray by `turn` times as much: 2 for
    /// reflection, `|n1 / n2 - 1|` for refraction.
    pub fn beyond(&self, distance: f32, curvature: f32, turn: f32) -> Cone {
        let width = self.width_at(distance);
        Cone { width, spread: self.spread + turn * curvature * width }
    }
}

/// The smaller copies of all images of a scene.
pub struct Pyramids(Vec<Vec<Texture>>);

impl Pyramids {
    /// The copies of those images that a material of `effects` needs. Each has half as many columns and rows as the one
    /// before, down to a single pixel; together they have a third of the pixels of the image.
    pub fn new(world: &World, effects: &Effects) -> Pyramids {
        let needed = |texture: usize| {
            let mut materials = world.materials.iter().zip(&effects.materials);
            materials.any(|(material, takes)| takes.texture && material.texture == Some(texture))
        };
        let levels = |(index, image): (usize, &Texture)| {
            let smaller = |image: &Texture| (image.width.max(image.height) > 1).then(|| halved(image));
            if needed(index) { std::iter::successors(smaller(image), smaller).collect() } else { Vec::new() }
        };
        Pyramids(world.textures.iter().enumerate().map(levels).collect())
    }

    /// The mean colour of the image `index` of `world` over a parallelogram around `uv` with the sides `axes`, in texture
    /// coordinates: a single read where it is smaller than a pixel of the image. If the image is that of a sphere, it does not
    /// repeat at the poles.
    pub fn color<F: StudentFunctions, T: Tally>(
        &self,
        world: &World,
        (index, on_sphere): (usize, bool),
        uv: Vec2,
        axes: [Vec2; 2],
        tally: &mut T,
    ) -> Vec3 {
        let (image, smaller) = (&world.textures[index], &self.0[index]);
        let mut read = |level: usize, uv: Vec2| {
            tally.note(Event::TextureRead);
            let image = if level == 0 { image } else { &smaller[level - 1] };
            F::texture_color(image, if on_sphere { between_poles(uv, image.height) } else { uv })
        };
        // Measure the sides in pixels of the image.
        let size = vec2(image.width as f32, image.height as f32);
        let [a, b] = axes.map(|axis| (axis * size).length());
        let (axis, longer, shorter) = if a >= b { (axes[0], a, b) } else { (axes[1], b, a) };
        if longer <= 1.0 {
            return read(0, uv);
        }
        // The horizon of a plane covers the whole image.
        if !(longer < LARGEST) {
            return read(smaller.len(), uv);
        }
        // Choose the level whose pixels are as wide as the shorter side, and the number of points along the longer one.
        let width = shorter.max(longer / MOST_POINTS).max(1.0);
        // Rounded up.
        let points = (-floor(-longer / width)).max(1.0);
        let level = width.log2().min(smaller.len() as f32);
        let (level, blend) = (level as usize, level - floor(level));
        // Read all points, each between two levels, so that no border between levels is seen.
        let mut sum = Vec3::ZERO;
        for point in 0..points as u32 {
            let uv = uv + ((point as f32 + 0.5) / points - 0.5) * axis;
            let color = read(level, uv);
            sum += if blend > 0.0 { color.lerp(read(level + 1, uv), blend) } else { color };
        }
        sum / points
    }
}

/// The most points that are read along the longer axis. A surface that is seen at a more grazing angle than 1 : 16 is
/// blurred along the shorter axis as well.
const MOST_POINTS: f32 = 16.0;

/// A longer side, in pixels of the image, is beyond the precision of texture coordinates.
const LARGEST: f32 = 1e7;

/// The image with half as many columns and rows, but at least one of each. Each pixel is the mean of the part of the image
/// that it covers: of two by two pixels, or a little more if the number of columns or rows is odd.
fn halved(image: &Texture) -> Texture {
    let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
    let (columns, rows) = (parts(image.width, width), parts(image.height, height));
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for row in &rows {
        for column in &columns {
            let mut mean = Vec3::ZERO;
            for &(y, part_of_row) in row {
                for &(x, part_of_column) in column {
                    mean += part_of_row * part_of_column * image.pixels[y * image.width as usize + x];
                }
            }
            pixels.push(mean);
        }
    }
    Texture { width, height, pixels: Arc::new(pixels), wrap: image.wrap }
}

/// For each of `count` equal parts of a row of `size` pixels: the pixels that it covers, each with its fraction of the part.
fn parts(size: u32, count: u32) -> Vec<Vec<(usize, f32)>> {
    let length = f64::from(size) / f64::from(count);
    let part = |part: u32| {
        let (start, end) = (f64::from(part) * length, f64::from(part + 1) * length);
        let covered = |pixel: u32| (end.min(f64::from(pixel + 1)) - start.max(f64::from(pixel))) / length;
        let pixels = (start.floor() as u32..size).take_while(|&pixel| f64::from(pixel) < end);
        pixels.map(|pixel| (pixel as usize, covered(pixel) as f32)).collect()
    };
    (0..count).map(part).collect()
}

/// The axes of the part of a surface that a cone of this `width` covers: vectors along the surface in world units. The first
/// is along the ray, and longer the more grazing the ray is.
pub fn footprint(direction: Vec3, normal: Vec3, width: f32) -> [Vec3; 2] {
    let direction = direction.normalize_or(-normal);
    let cosine = direction.dot(normal).abs();
    let along = direction - direction.dot(normal) * normal;
    match along.try_normalize() {
        Some(along) => [width / cosine * along, width * normal.cross(along)],
        // The ray meets the surface at a right angle, so the cone covers a disk, and any axis is its longest.
        None => {
            let (x, y) = normal.any_orthonormal_pair();
            [width * x, width * y]
        }
    }
}

/// The change of the texture coordinates along `offset`, a vector along the surface in world units, around the hit `at` of
/// `ray`; zero for shapes that show the middle of their image everywhere. Panics if `hit` does not belong to `world`.
pub fn uv_change<F: StudentFunctions>(
    world: &World,
    ray: &Ray,
    hit: &Hit,
    at: &SurfaceInteraction,
    offset: Vec3,
) -> Vec2 {
    let point = at.surface.point;
    match hit.target {
        Target::Plane(index) => {
            let (_, axes) = plane_at::<F>(&world.planes[index as usize], ray.time);
            let along = |axis: Vec3| offset.dot(axis) / axis.length_squared();
            vec2(along(axes[0]), along(axes[1]))
        }
        Target::Primitive(index) => {
            let primitive = &world.primitives[index as usize];
            if let Geometry::Solid(index) = primitive.geometry {
                let solid = &world.solids[index as usize];
                let to_object = &solid.placement.to_object;
                let (own, step) =
                    (to_object.transform_point3(point), to_object.transform_vector3(0.5 * offset));
                let normal = solid.placement.to_world.matrix3.transpose()
                    * glam::Vec3A::from(at.surface.geometric_normal);
                let uv = |own: Vec3| solid.shape.texture_coordinates(own, normal.into());
                return around_the_seam(uv(own + step) - uv(own - step));
            }
            let Some(image) = primitive.image.get() else { return Vec2::ZERO };
            match geometry_at::<F>(world, primitive, ray.time) {
                Geometry::Sphere(sphere) => {
                    let own = from_center(ray, hit.t, &sphere);
                    let uv = |own: Vec3| around_sphere(world.sphere_axes[image] * own);
                    around_the_seam(uv(own + 0.5 * offset) - uv(own - 0.5 * offset))
                }
                Geometry::Triangle(triangle) | Geometry::OneSided(triangle) => {
                    on_triangle(&triangle, world.uvs[image], offset)
                }
                Geometry::Solid(_) | Geometry::Instance(_) => Vec2::ZERO,
            }
        }
        Target::Instance(outer, inner) => {
            let (instance, primitive, _) = inside(world, outer, inner);
            match (primitive.image.get(), primitive.geometry.triangle()) {
                (Some(image), Some(triangle)) => {
                    let own = instance.placement.to_object.transform_vector3(offset);
                    on_triangle(triangle, world.uvs[image], own)
                }
                _ => Vec2::ZERO,
            }
        }
    }
}

/// A change of u by more than half of an image leads across its seam, and is shorter the other way.
fn around_the_seam(change: Vec2) -> Vec2 {
    vec2(change.x - change.x.round(), change.y)
}

/// The change of the texture coordinates of a triangle along `offset`. They are linear, so it is the sum of the changes along
/// the normal of two edges: each is 0 along its edge.
fn on_triangle(&Triangle { a, b, c }: &Triangle, uvs: [Vec2; 3], offset: Vec3) -> Vec2 {
    let [a, b, c, offset] = [a, b, c, offset].map(Vec3::as_dvec3);
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let per_length = 1.0 / normal.length_squared();
    let toward_b = ac.cross(normal).dot(offset) * per_length;
    let toward_c = normal.cross(ab).dot(offset) * per_length;
    let change = toward_b * (uvs[1] - uvs[0]).as_dvec2() + toward_c * (uvs[2] - uvs[0]).as_dvec2();
    change.as_vec2()
}

/// The curvature, 1 / radius, of the surface that is hit; 0 for all shapes but spheres.
pub fn curvature<F: StudentFunctions>(world: &World, ray: &Ray, hit: &Hit) -> f32 {
    let Target::Primitive(index) = hit.target else { return 0.0 };
    match geometry_at::<F>(world, &world.primitives[index as usize], ray.time) {
        Geometry::Sphere(sphere) => 1.0 / sphere.radius,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Wrap;

    fn image(width: u32, height: u32, color: impl Fn(u32, u32) -> f32) -> Texture {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| Vec3::splat(color(x, y))).collect();
        Texture { width, height, pixels: Arc::new(pixels), wrap: Wrap::Repeat }
    }

    #[test]
    fn a_smaller_copy_has_the_means_of_its_parts() {
        let small = halved(&image(4, 2, |x, y| (x + 4 * y) as f32));
        assert_eq!((small.width, small.height), (2, 1));
        assert_eq!(small.pixels[..], [2.5, 4.5].map(Vec3::splat));
        // Of an odd number each part covers 2.5 pixels: (0 + 1 + 0.5 · 2) / 2.5 and (0.5 · 2 + 3 + 4) / 2.5.
        let odd = halved(&image(5, 1, |x, _| x as f32));
        assert_eq!((odd.width, odd.height), (2, 1));
        assert!((odd.pixels[0].x - 0.8).abs() < 1e-6 && (odd.pixels[1].x - 3.2).abs() < 1e-6);
        // Down to one pixel the mean of the whole image stays.
        let mut one = image(13, 7, |x, y| ((x * 7 + y * 3) % 5) as f32);
        let mean = |image: &Texture| {
            image.pixels.iter().map(|pixel| pixel.x).sum::<f32>() / image.pixels.len() as f32
        };
        let expected = mean(&one);
        while one.width * one.height > 1 {
            one = halved(&one);
            assert!((mean(&one) - expected).abs() < 1e-5, "{} by {}", one.width, one.height);
        }
    }

    #[test]
    fn a_footprint_grows_along_the_ray() {
        // At 60 degrees from the normal the cosine is one half.
        let direction = Vec3::new(3f32.sqrt(), -1.0, 0.0);
        let [along, across] = footprint(direction, Vec3::Y, 0.5);
        assert!((along - Vec3::X).length() < 1e-6, "{along}");
        assert!((across.abs() - 0.5 * Vec3::Z).length() < 1e-6, "{across}");
        let [x, y] = footprint(-2.0 * Vec3::Y, Vec3::Y, 0.5);
        assert!((x.length() - 0.5).abs() < 1e-6 && (y.length() - 0.5).abs() < 1e-6 && x.dot(y) == 0.0);
    }

    #[test]
    fn coordinates_of_a_triangle_change_linearly() {
        let triangle = Triangle { a: Vec3::ZERO, b: 2.0 * Vec3::X, c: Vec3::new(1.0, 3.0, 0.0) };
        let uvs = [vec2(0.1, 0.2), vec2(0.5, 0.0), vec2(0.0, 0.9)];
        let along = |offset: Vec3| on_triangle(&triangle, uvs, offset);
        assert!((along(triangle.b) - (uvs[1] - uvs[0])).length() < 1e-6);
        assert!((along(0.5 * triangle.c) - 0.5 * (uvs[2] - uvs[0])).length() < 1e-6);
        assert!(along(Vec3::Z).length() < 1e-6);
    }

    #[test]
    fn a_cone_widens_with_the_distance_and_on_curved_mirrors() {
        // Powers of two, so that no product is rounded.
        let cone = Cone { width: 0.0, spread: 0.0625 };
        assert_eq!(cone.width_at(8.0), 0.5);
        assert_eq!(cone.beyond(8.0, 0.0, 2.0), Cone { width: 0.5, spread: 0.0625 });
        assert_eq!(cone.beyond(8.0, 0.5, 2.0), Cone { width: 0.5, spread: 0.5625 });
    }
}
