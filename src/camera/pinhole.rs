//! The camera: a pinhole, a thin lens around it, and a shutter.

use crate::message;
use crate::ray::Ray;
use glam::{Vec2, Vec3};
use thiserror::Error;

/// A thin lens, which adds depth of field to a pinhole camera (stage 6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// The diameter of the aperture in world units, at least 0; with 0 the camera is a pinhole.
    pub aperture: f32,
    /// The distance of the focal plane from the camera along the view direction, in world units, above 0.
    /// Points on that plane are sharp.
    pub focal_distance: f32,
}

message! { Lens { aperture, focal_distance } }

/// The interval of time in which the film receives light; `0..=1` is the time in which nodes move (stage 6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// The time at which the shutter opens, `0 <= open <= 1`.
    pub open: f32,
    /// The time at which the shutter closes, `open <= close <= 1`.
    pub close: f32,
}

message! { Shutter { open, close } }

/// A camera that looks along `towards`; `right` and `up` span the film. The three axes have unit length and
/// are perpendicular to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The centre of projection in world units, where all pinhole rays start.
    pub position: Vec3,
    /// The view direction, of unit length.
    pub towards: Vec3,
    /// The direction of increasing x on the film, of unit length.
    pub right: Vec3,
    /// The direction of decreasing y on the film, of unit length.
    pub up: Vec3,
    /// Half the height of the film at distance 1: the tangent of half the vertical field of view. Of an orthographic camera,
    /// half the height of the film in world units.
    pub half_height: f32,
    /// Whether all rays run along `towards` (orthographic projection), and do not start in one point.
    pub orthographic: bool,
    /// The width of the film divided by its height, above 0.
    pub aspect: f32,
    /// The thin lens; `None` for a pinhole camera.
    pub lens: Option<Lens>,
    /// The shutter; `None` if the picture is taken at time 0.
    pub shutter: Option<Shutter>,
}

message! { Camera { position, towards, right, up, half_height, orthographic, aspect, lens, shutter } }

/// Why [`Camera::new`] cannot build a camera from its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CameraError {
    /// The view direction is zero, for example because position and target are the same.
    #[error("the view direction of the camera has no length")]
    NoDirection,
    /// The up direction is zero, or parallel to the view direction.
    #[error("`up` is parallel to the view direction, so the orientation of the picture is undefined")]
    UpParallel,
    /// The vertical field of view, in degrees, is not above 0 and below 180, or is NaN.
    #[error("the vertical field of view must lie between 0 and 180 degrees, but is {0}")]
    FieldOfView(f32),
    /// The aspect ratio is not above 0, or is infinite or NaN.
    #[error("the aspect ratio must be above zero, but is {0}")]
    Aspect(f32),
    /// A coordinate of the position or of a direction is NaN or infinite.
    #[error("a coordinate of the camera is not a finite number")]
    NotFinite,
}

impl Camera {
    /// A pinhole camera at `position` (world units) that looks along `direction`, with `up` upwards in the
    /// picture. Both directions may have any length but zero, and `up` need not be perpendicular to
    /// `direction`.
    ///
    /// `vertical_fov` is the whole vertical angle in degrees, `0 < vertical_fov < 180`. `aspect` is width
    /// divided by height, above 0 and finite.
    ///
    /// ```
    /// use glam::Vec3;
    /// use raykata::camera::Camera;
    /// let camera = Camera::new(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 90.0, 2.0).unwrap();
    /// assert_eq!(camera.right, Vec3::X);
    /// assert_eq!(camera.ray(0.5, 0.5).direction, Vec3::NEG_Z);
    /// ```
    ///
    /// # Errors
    ///
    /// - [`CameraError::NotFinite`] if a coordinate of `position`, `direction` or `up` is NaN or infinite.
    /// - [`CameraError::FieldOfView`] and [`CameraError::Aspect`] if that number is out of range or NaN.
    /// - [`CameraError::NoDirection`] if `direction` is zero.
    /// - [`CameraError::UpParallel`] if `up` is zero, or if the sine of its angle with `direction` is at most
    ///   1e-6.
    pub fn new(
        position: Vec3,
        direction: Vec3,
        up: Vec3,
        vertical_fov: f32,
        aspect: f32,
    ) -> Result<Camera, CameraError> {
        // Reject invalid arguments.
        if !(position.is_finite() && direction.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if !(0.0 < vertical_fov && vertical_fov < 180.0) {
            return Err(CameraError::FieldOfView(vertical_fov));
        }
        if !(0.0 < aspect && aspect.is_finite()) {
            return Err(CameraError::Aspect(aspect));
        }
        // Normalize in double precision, which keeps the axes at right angles for any scale of the inputs.
        let unit = |v: glam::DVec3| v.try_normalize();
        let towards = unit(direction.as_dvec3()).ok_or(CameraError::NoDirection)?;
        let up = unit(up.as_dvec3()).ok_or(CameraError::UpParallel)?;
        // Reject an `up` along the view: the length of the cross product of unit vectors is the sine of their angle,
        // and below 1e-6 the rounding of the inputs dominates.
        let right = Some(towards.cross(up)).filter(|r| r.length() > 1e-6).ok_or(CameraError::UpParallel)?;
        let right = right.normalize();
        Ok(Camera {
            position,
            towards: towards.as_vec3(),
            right: right.as_vec3(),
            up: right.cross(towards).as_vec3(),
            half_height: ((vertical_fov as f64).to_radians() / 2.0).tan() as f32,
            orthographic: false,
            aspect,
            lens: None,
            shutter: None,
        })
    }

    /// The pinhole ray through film position `(x, y)`: from `position`, of unit direction, for `0 < t < ∞`,
    /// at time 0. Both coordinates are in `0..=1`; `(0, 0)` is the upper left corner of the film and `(1, 1)`
    /// the lower right one.
    ///
    /// The direction is computed from the axes and never as the difference of two far points. So a camera a
    /// million units from the origin has as many distinct directions as one at the origin.
    ///
    /// The ray of an orthographic camera starts at that position of a film around `position`, and runs along `towards`.
    #[inline]
    pub fn ray(&self, x: f32, y: f32) -> Ray {
        let film = Vec2::new((2.0 * x - 1.0) * self.aspect, 1.0 - 2.0 * y) * self.half_height;
        let on_film = film.x * self.right + film.y * self.up;
        match self.orthographic {
            true => Ray::new(self.position + on_film, self.towards),
            false => Ray::new(self.position, (self.towards + on_film).normalize()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_of_an_orthographic_camera_are_parallel() {
        let camera = Camera::new(Vec3::Z, Vec3::NEG_Z, Vec3::Y, 40.0, 2.0).unwrap();
        let camera = Camera { orthographic: true, half_height: 3.0, ..camera };
        let [corner, middle] = [camera.ray(0.0, 0.0), camera.ray(0.5, 0.5)];
        assert_eq!((corner.origin, corner.direction), (Vec3::new(-6.0, 3.0, 1.0), Vec3::NEG_Z));
        assert_eq!((middle.origin, middle.direction), (Vec3::Z, Vec3::NEG_Z));
    }

    #[test]
    fn a_far_camera_sees_640_directions_in_640_pixels() {
        // `normalize(P - P0)` leaves 19 distinct directions at this distance.
        let camera = Camera::new(Vec3::splat(1e6), Vec3::NEG_Z, Vec3::Y, 40.0, 16.0 / 9.0).expect("a camera");
        let mut xs: Vec<u32> =
            (0..640).map(|i| camera.ray((i as f32 + 0.5) / 640.0, 0.5).direction.x.to_bits()).collect();
        xs.dedup();
        assert_eq!(xs.len(), 640);
    }

    #[test]
    fn the_top_of_the_film_lies_half_the_field_of_view_above_the_axis() {
        let camera = Camera::new(Vec3::ZERO, Vec3::X, Vec3::Y, 60.0, 2.0).expect("a camera");
        let angle = camera.ray(0.5, 0.0).direction.angle_between(Vec3::X).to_degrees();
        assert!((angle - 30.0).abs() < 1e-3, "{angle}"); // a few roundings of f32 around 30
        let side = camera.ray(1.0, 0.5).direction;
        assert!((side.z / side.x - 2.0 * 30f32.to_radians().tan()).abs() < 1e-6); // aspect 2, not 1
    }

    #[test]
    fn a_slanted_up_does_not_narrow_the_picture() {
        // `right = towards × up` has unit length only if `up` is perpendicular to `towards`.
        let camera = Camera::new(Vec3::ZERO, Vec3::X, Vec3::new(0.8, 0.6, 0.0), 60.0, 1.0).expect("a camera");
        assert!((camera.right.length() - 1.0).abs() < 1e-6);
        assert!((camera.up - Vec3::Y).length() < 1e-6);
    }

    #[test]
    fn senseless_cameras_are_refused() {
        let new =
            |direction, up, fov, aspect| Camera::new(Vec3::ZERO, direction, up, fov, aspect).unwrap_err();
        assert_eq!(new(Vec3::ZERO, Vec3::Y, 40.0, 1.0), CameraError::NoDirection);
        assert_eq!(new(Vec3::Y, Vec3::NEG_Y, 40.0, 1.0), CameraError::UpParallel);
        assert_eq!(new(Vec3::X, Vec3::ZERO, 40.0, 1.0), CameraError::UpParallel);
        assert_eq!(new(Vec3::X, Vec3::Y, 180.0, 1.0), CameraError::FieldOfView(180.0));
        assert_eq!(new(Vec3::X, Vec3::Y, 40.0, 0.0), CameraError::Aspect(0.0));
        assert_eq!(new(Vec3::NAN, Vec3::Y, 40.0, 1.0), CameraError::NotFinite);
    }
}
