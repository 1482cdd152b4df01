//! The lobe of directions in which a rough mirror reflects. With its density, light in a rough mirror is found in two ways, as
//! diffuse light is: by a sample of a light, and by the reflected ray.

use crate::kit::Surface;
use glam::Vec3;
use std::f32::consts::TAU;

/// Phong's lobe around the ideal reflected direction, folded at the surface, as `sample_phong_lobe` of stage 6 samples it.
#[derive(Clone, Copy, Debug)]
pub struct RoughLobe {
    /// The direction of reflection of a smooth surface, of unit length.
    pub ideal: Vec3,
    /// The fraction of light per channel that is reflected.
    pub reflectance: Vec3,
    /// The roughness of the surface, above 0 and at most 1.
    pub roughness: f32,
    /// The normals of the surface, of unit length, on the side of the lobe.
    pub geometric_normal: Vec3,
    pub shading_normal: Vec3,
}

impl RoughLobe {
    /// The lobe at `surface`.
    pub fn new(surface: &Surface, ideal: Vec3, reflectance: Vec3, roughness: f32) -> RoughLobe {
        let Surface { geometric_normal, shading_normal, .. } = *surface;
        RoughLobe { ideal, reflectance, roughness, geometric_normal, shading_normal }
    }

    /// The density per steradian of reflected rays in `direction`, a unit vector. `None` if it is not above both normals:
    /// no shadow ray starts in such a direction, so only reflected rays find light there.
    pub fn pdf(&self, direction: Vec3) -> Option<f32> {
        let above = self.geometric_normal.dot(direction);
        if above <= 0.0 || self.shading_normal.dot(direction) <= 0.0 {
            return None;
        }
        // A direction is sampled as it is, or below the surface and then reflected.
        let below = direction - 2.0 * above * self.geometric_normal;
        Some(self.pdf_before_reflection(direction) + self.pdf_before_reflection(below))
    }

    /// The density before directions below the surface are reflected: `(n + 1) / 2π · cosⁿ θ` with `n = 2 / roughness² - 2`.
    fn pdf_before_reflection(&self, direction: Vec3) -> f32 {
        // With unit vectors, 1 - cos θ is half of the squared distance of their ends, which keeps its digits for small θ.
        let one_minus_cos = 0.5 * (direction - self.ideal).length_squared();
        if one_minus_cos >= 1.0 {
            return 0.0;
        }
        let exponent = 2.0 / (self.roughness * self.roughness) - 2.0;
        (exponent + 1.0) / TAU * (exponent * (-one_minus_cos).ln_1p()).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lobe of a surface whose normal is +y, around the direction at this angle to the normal.
    fn lobe(degrees: f32, roughness: f32) -> RoughLobe {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let ideal = Vec3::new(sin, cos, 0.0);
        let (geometric_normal, shading_normal) = (Vec3::Y, Vec3::Y);
        RoughLobe { ideal, reflectance: Vec3::ONE, roughness, geometric_normal, shading_normal }
    }

    #[test]
    fn the_density_integrates_to_one_over_the_hemisphere() {
        for degrees in [0.0, 40.0, 75.0, 89.0] {
            for roughness in [0.2, 0.5, 1.0] {
                // The midpoint rule over cos θ and φ, whose cells have equal solid angles. The narrowest lobe, cos^48 θ, falls by
                // 48/700 of its value in a cell at its peak. The square of this bounds the relative error of the rule.
                let (rows, columns) = (700, 1_400);
                let mut sum = 0.0;
                for row in 0..rows {
                    let cos = (row as f32 + 0.5) / rows as f32;
                    let sin = (1.0 - cos * cos).sqrt();
                    for column in 0..columns {
                        let (y, x) = (TAU * (column as f32 + 0.5) / columns as f32).sin_cos();
                        let pdf = lobe(degrees, roughness).pdf(Vec3::new(sin * x, cos, sin * y));
                        sum += f64::from(pdf.unwrap_or(0.0));
                    }
                }
                let integral = sum * f64::from(TAU) / f64::from(rows * columns);
                assert!((integral - 1.0).abs() < 1e-2, "{degrees} {roughness}: {integral}");
            }
        }
    }

    #[test]
    fn no_density_below_a_normal() {
        let leaning = RoughLobe { shading_normal: Vec3::X, ..lobe(10.0, 0.5) };
        assert_eq!(leaning.pdf(Vec3::new(-0.6, 0.8, 0.0)), None);
        assert_eq!(leaning.pdf(Vec3::new(0.6, -0.8, 0.0)), None);
        assert!(leaning.pdf(Vec3::new(0.6, 0.8, 0.0)).is_some());
    }
}
