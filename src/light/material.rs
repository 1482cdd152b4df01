//! What surfaces do with light, and where light comes from, as data.

use crate::message;
use crate::shape::{Polygon, Shape};
use glam::{Vec2, Vec3};
use std::f64::consts::PI;
use std::sync::Arc;

/// The optical properties of a surface, by the Phong model with reflection and refraction (Whitted):
///
/// `A·ka + Σ (I·kd·cosθ + I·ks·cosⁿφ) + Ks·reflection + Kr·refraction`
///
/// Colours are linear red, green and blue, at least 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// `ka`, the ambient reflectance: the fraction of the scene's ambient light that is reflected. A scene
    /// file that does not name it gets the value of `diffuse`.
    pub ambient: Vec3,
    /// `kd`, the diffuse reflectance: the fraction of light that is scattered evenly (Lambertian).
    pub diffuse: Vec3,
    /// `ks`, the strength of the specular highlight.
    pub specular: Vec3,
    /// `n`, the Phong exponent, at least 0: the larger it is, the smaller is the highlight.
    pub exponent: f32,
    /// `Ks`, the weight of the light along the reflected ray (stage 5).
    pub mirror: Vec3,
    /// `Kr`, the weight of the light along the refracted ray (stage 5).
    pub transmission: Vec3,
    /// The index of refraction inside, divided by the one outside, above 0; with 1 light is not bent (stage 5).
    pub index_of_refraction: f32,
    /// How reflection and transmission depend on the angle (stage 5).
    pub fresnel: Fresnel,
    /// The roughness of glossy reflection and refraction, `0..=1`; 0 is a perfectly smooth surface (stage 6).
    pub roughness: f32,
    /// The radiance that the surface emits by itself, on both sides and evenly in all directions. Camera rays, reflected
    /// and refracted rays see it. It lights other surfaces only in a scene with indirect light.
    pub emission: Vec3,
    /// Whether only the front emits light: the side to which the outward normal points.
    pub one_sided_emission: bool,
    /// The index of refraction of a clear coat, above 0; 1 is no coat. From outside the coat reflects the fraction of light
    /// that Fresnel's equations give at this angle, and what lies below gets the rest.
    pub coat: f32,
    /// The index in [`crate::scene::Scene::textures`] of an image that multiplies `diffuse` and `ambient`
    /// (stage 7).
    pub texture: Option<usize>,
}

message! { Material {
    ambient, diffuse, specular, exponent, mirror, transmission, index_of_refraction, fresnel, roughness,
    emission, one_sided_emission, coat, texture
} }

impl Default for Material {
    /// A dull light grey.
    fn default() -> Self {
        Material {
            ambient: Vec3::splat(0.8),
            diffuse: Vec3::splat(0.8),
            specular: Vec3::ZERO,
            exponent: 32.0,
            mirror: Vec3::ZERO,
            transmission: Vec3::ZERO,
            index_of_refraction: 1.0,
            fresnel: Fresnel::None,
            roughness: 0.0,
            emission: Vec3::ZERO,
            one_sided_emission: false,
            coat: 1.0,
            texture: None,
        }
    }
}

/// By which formula the reflected fraction of light depends on the angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fresnel {
    /// No dependence: constant weights, as in the lecture notes.
    #[default]
    None,
    /// The approximation of Schlick.
    Schlick,
    /// Fresnel's equations for unpolarised light.
    Exact,
}

message! { enum Fresnel { None, Schlick, Exact } }

/// What an image shows at texture coordinates outside of `0..=1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The colours at the border continue.
    Clamp,
    /// The image repeats, and every other repetition is mirrored.
    Mirror,
}

message! { enum Wrap { Repeat, Clamp, Mirror } }

/// An image in linear light, stored row by row from the top, each row from the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The number of pixels per row, at least 1.
    pub width: u32,
    /// The number of rows, at least 1.
    pub height: u32,
    /// The `width * height` colours, red, green and blue in linear light.
    pub pixels: Arc<Vec<Vec3>>,
    /// What the image shows at coordinates outside of `0..=1`.
    pub wrap: Wrap,
}

message! { Texture { width, height, pixels, wrap } }

impl Texture {
    /// The colour of the pixel in which `uv` lies, both in `0..=1`; `(0, 0)` is the lower left corner.
    pub(crate) fn pixel_at(&self, uv: Vec2) -> Vec3 {
        let index = |share: f32, count: u32| ((share * count as f32) as u32).min(count - 1) as usize;
        let (column, row) = (index(uv.x, self.width), index(1.0 - uv.y, self.height));
        self.pixels[row * self.width as usize + column]
    }
}

/// How light from a point or area light depends on the distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Falloff {
    /// No dependence, as in the lecture notes.
    #[default]
    None,
    /// It falls with the square of the distance, which is the physical law.
    InverseSquare,
}

message! { enum Falloff { None, InverseSquare } }

/// The position and extent of a light.
#[derive(Clone, Debug, PartialEq)]
pub enum Emitter {
    /// A point light.
    Point {
        /// The position of the light, in world units.
        position: Vec3,
        /// How the light depends on the distance.
        falloff: Falloff,
    },
    /// An infinitely distant light, whose rays are all parallel.
    Directional {
        /// The direction from the light to the scene, of unit length.
        direction: Vec3,
    },
    /// An area light, which casts soft shadows (stage 6).
    Area {
        /// The shape of the light.
        shape: AreaShape,
        /// How the light depends on the distance.
        falloff: Falloff,
    },
}

message! { enum Emitter { Point { position, falloff }, Directional { direction }, Area { shape, falloff } } }

/// The shape of an area light, in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaShape {
    /// The parallelogram of all `corner + u * edges.0 + v * edges.1` with `u` and `v` in `0..=1`.
    Rectangle {
        /// A corner, in world units.
        corner: Vec3,
        /// The two edges from that corner, in world units.
        edges: (Vec3, Vec3),
    },
    /// A flat disk.
    Disk(crate::shape::Disk),
    /// The surface of a sphere.
    Sphere(crate::shape::Sphere),
}

message! { enum AreaShape { Rectangle { corner, edges }, Disk(a), Sphere(a) } }

impl AreaShape {
    /// The area that the light shows from straight ahead: that of its disk for a sphere.
    fn frontal_area(&self) -> f64 {
        let disk = |radius: f32| PI * f64::from(radius) * f64::from(radius);
        match self {
            AreaShape::Rectangle { edges, .. } => edges.0.as_dvec3().cross(edges.1.as_dvec3()).length(),
            AreaShape::Disk(light) => disk(light.radius),
            AreaShape::Sphere(sphere) => disk(sphere.radius),
        }
    }

    /// The light as a shape of the scene.
    pub fn to_shape(&self) -> Shape {
        match self {
            AreaShape::Rectangle { corner, edges: (u, v) } => {
                let corners = vec![*corner, corner + u, corner + u + v, corner + v];
                Shape::Polygon(Polygon { corners })
            }
            AreaShape::Disk(disk) => Shape::Disk(*disk),
            AreaShape::Sphere(sphere) => Shape::Sphere(*sphere),
        }
    }

    /// The centre of the light, in world units.
    pub fn center(&self) -> Vec3 {
        match self {
            AreaShape::Rectangle { corner, edges } => *corner + 0.5 * (edges.0 + edges.1),
            AreaShape::Disk(disk) => disk.center,
            AreaShape::Sphere(sphere) => sphere.center,
        }
    }
}

/// The cone of a spot light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The axis, of unit length.
    pub axis: Vec3,
    /// The cosine of the angle to the axis up to which the light is full.
    pub full: f32,
    /// The cosine of the angle from which on there is no light, at most `full`.
    pub none: f32,
}

message! { Cone as SpotCone { axis, full, none } }

impl Cone {
    /// The share of the light that is sent in the unit vector `direction`, `0..=1`. Between the two angles it follows a cubic
    /// without a kink at either end.
    pub fn share(&self, direction: Vec3) -> f32 {
        let share = match direction.dot(self.axis) {
            cosine if cosine >= self.full => 1.0,
            cosine => ((cosine - self.none) / (self.full - self.none)).clamp(0.0, 1.0),
        };
        share * share * (3.0 - 2.0 * share)
    }
}

/// A light. Its colour is `intensity * color`.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Where the light comes from: a point, a direction or an area.
    pub emitter: Emitter,
    /// Red, green and blue in linear light, at least 0 each.
    pub color: Vec3,
    /// A factor for the colour, at least 0.
    pub intensity: f32,
    /// Whether the light casts shadows. Without, it reaches every surface that faces it.
    pub shadows: bool,
    /// The cone into which a point light shines; `None` for a light that shines in all directions.
    pub cone: Option<Cone>,
}

message! { Light { emitter, color, intensity, shadows, cone } }

impl Light {
    /// `intensity * color`, in linear light. With [`Falloff::InverseSquare`] that is the light that arrives
    /// at a distance of one world unit (for a point light its radiant intensity); otherwise it arrives at any
    /// distance.
    pub fn radiance(&self) -> Vec3 {
        self.intensity * self.color
    }

    /// The radiance that a ray sees which hits the light, if the light is visible; zero for point lights and directional
    /// lights, which no ray can hit.
    ///
    /// With [`Falloff::InverseSquare`] it is `π I / A` with `I` of [`Light::radiance`] and the area `A` that the light shows
    /// from straight ahead: `π R²` for a sphere or a disk of radius `R`, so that `I = L R²`. A spherical light then gives
    /// exactly the light of a sphere that emits this radiance. Samples of rectangles and disks have no cosine at the light,
    /// so these agree straight ahead, and give `1 / cos θ` times as much light at an angle θ from there.
    ///
    /// With [`Falloff::None`] no radiance agrees with the light at all distances. Then it is `I`, as on Heckbert's business
    /// card: the light looks as bright as a white surface that faces it.
    pub fn visible_radiance(&self) -> Vec3 {
        let Emitter::Area { shape, falloff } = &self.emitter else { return Vec3::ZERO };
        match falloff {
            Falloff::None => self.radiance(),
            // Use double precision, in which no square of an `f32` overflows or vanishes.
            Falloff::InverseSquare => (PI / shape.frontal_area() * self.radiance().as_dvec3()).as_vec3(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Disk, Sphere};

    fn light(shape: AreaShape, falloff: Falloff) -> Light {
        Light {
            emitter: Emitter::Area { shape, falloff },
            color: Vec3::X,
            intensity: 8.0,
            shadows: true,
            cone: None,
        }
    }

    #[test]
    fn a_visible_light_is_as_bright_as_the_light_that_it_gives() {
        let sphere = AreaShape::Sphere(Sphere { center: Vec3::ZERO, radius: 2.0 });
        let disk = AreaShape::Disk(Disk { center: Vec3::ZERO, normal: Vec3::Y, radius: 2.0 });
        let rectangle =
            AreaShape::Rectangle { corner: Vec3::ZERO, edges: (Vec3::X, 2.0 * Vec3::Y + Vec3::X) };
        // I = L R² for sphere and disk; a rectangle of area 2 has π · 8 / 2.
        for (shape, radiance) in [(sphere, 2.0), (disk, 2.0), (rectangle, 4.0 * std::f32::consts::PI)] {
            let seen = light(shape.clone(), Falloff::InverseSquare).visible_radiance();
            assert!((seen - radiance * Vec3::X).length() < 1e-6 * radiance, "{seen} of {shape:?}");
            assert_eq!(light(shape, Falloff::None).visible_radiance(), 8.0 * Vec3::X);
        }
    }
}
