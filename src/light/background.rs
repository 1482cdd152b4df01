//! What rays see that hit nothing: one colour, a gradient, or an environment map.

use crate::message;
use crate::shape::{around_sphere, between_poles};
use glam::{Quat, Vec2, Vec3};

/// The radiance of rays that hit nothing. Camera rays, reflected and refracted rays see it, and diffuse rays in a scene
/// with indirect light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One colour in all directions, in linear radiance.
    Color(Vec3),
    /// A vertical gradient.
    Gradient(Gradient),
    /// An image around the scene.
    Map(EnvironmentMap),
}

message! { enum Background { Color(a), Gradient(a), Map(a) } }

impl Background {
    /// Whether the radiance is 0 in all directions. An environment map is not black: one without light is read as a colour.
    pub fn is_black(&self) -> bool {
        match self {
            Background::Color(color) => *color == Vec3::ZERO,
            Background::Gradient(Gradient { zenith, horizon, nadir }) => {
                [zenith, horizon, nadir].iter().all(|color| **color == Vec3::ZERO)
            }
            Background::Map(_) => false,
        }
    }
}

/// A vertical gradient, for example a sky. Up is +y. All colours are linear radiance, at least 0 in each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// The colour straight up.
    pub zenith: Vec3,
    /// The colour in horizontal directions.
    pub horizon: Vec3,
    /// The colour straight down.
    pub nadir: Vec3,
}

message! { Gradient { zenith, horizon, nadir } }

impl Gradient {
    /// The colour in `direction`, which may have any length: interpolated linearly over the sine of the elevation, from
    /// `horizon` to `zenith` above and to `nadir` below. A direction without a length counts as up.
    pub fn color(&self, direction: Vec3) -> Vec3 {
        // Squares of lengths below 1e-19 and above 1e19 do not fit single precision.
        let sine = direction.as_dvec3().try_normalize().map_or(1.0, |unit| unit.y as f32);
        let end = if sine > 0.0 { self.zenith } else { self.nadir };
        self.horizon.lerp(end, sine.abs())
    }
}

/// An equirectangular image around the scene, infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// Index into [`crate::scene::Scene::textures`].
    pub texture: usize,
    /// The angle in radians by which the map is turned around +y, anticlockwise seen from above.
    pub rotation: f32,
    /// The factor on the colours of the image, at least 0.
    pub scale: f32,
}

message! { EnvironmentMap { texture, rotation, scale } }

impl EnvironmentMap {
    /// The texture coordinates in `direction`, which may have any length, for an image with `rows` rows.
    ///
    /// Without rotation, the middle of the image lies at -z, so that a camera that looks along -z sees it upright and not
    /// mirrored: +x at u = 0.75, and +y at the upper edge. The image repeats along u, and not along v, see
    /// [`between_poles`].
    pub fn texture_coordinates(&self, direction: Vec3, rows: u32) -> Vec2 {
        // Turn the direction back instead of the map. A sphere shows its image to a viewer outside, who sees it mirrored.
        let own = Quat::from_rotation_y(-self.rotation) * direction;
        between_poles(around_sphere(own.with_z(-own.z)), rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    #[test]
    fn a_gradient_meets_its_three_colours() {
        let gradient = Gradient { zenith: Vec3::X, horizon: Vec3::Y, nadir: Vec3::Z };
        assert_eq!(gradient.color(3.0 * Vec3::Y), Vec3::X);
        assert_eq!(gradient.color(-1e30 * Vec3::Y), Vec3::Z);
        assert_eq!(gradient.color(Vec3::X), Vec3::Y);
        // At an elevation of 30 degrees the sine is one half.
        let half = gradient.color(Vec3::new(3f32.sqrt(), -1.0, 0.0));
        assert!((half - Vec3::new(0.0, 0.5, 0.5)).length() < 1e-6, "{half}");
    }

    #[test]
    fn an_environment_map_is_upright_and_not_mirrored() {
        let map = EnvironmentMap { texture: 0, rotation: 0.0, scale: 1.0 };
        let at = |map: &EnvironmentMap, direction: Vec3| map.texture_coordinates(direction, 1000);
        assert_eq!(at(&map, Vec3::NEG_Z), vec2(0.5, 0.5));
        assert_eq!(at(&map, 2.0 * Vec3::X), vec2(0.75, 0.5));
        assert_eq!(at(&map, Vec3::NEG_X), vec2(0.25, 0.5));
        assert_eq!((at(&map, Vec3::Y).y, at(&map, Vec3::NEG_Y).y), (1.0 - 0.0005, 0.0005));
        // Turned anticlockwise by a quarter, the middle of the image lies at -x.
        let turned = EnvironmentMap { rotation: std::f32::consts::FRAC_PI_2, ..map };
        assert!((at(&turned, Vec3::NEG_X) - vec2(0.5, 0.5)).length() < 1e-6);
    }
}
