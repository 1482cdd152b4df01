//! Whether two pictures are the same up to rounding.

use glam::Vec3;
use raykata::film::Film;

/// The largest difference of a component that is no mistake: this, and this share of the smaller of both.
const ABSOLUTE: f32 = 0.002;
const RELATIVE: f32 = 0.01;

/// One pixel in this number may differ: at the edges of shapes, two right tests may round to different sides.
const TOLERABLE: usize = 1000;

/// The number of pixels of two pictures of the same size that differ by more than rounding explains.
pub fn different_pixels(one: &Film, other: &Film) -> usize {
    if (one.width, one.height) != (other.width, other.height) {
        return one.pixels.len().max(other.pixels.len());
    }
    one.pixels.iter().zip(&other.pixels).filter(|(p, q)| differ(**p, **q)).count()
}

fn differ(p: Vec3, q: Vec3) -> bool {
    // The comparison is false for a NaN, which differs from everything but a NaN.
    let close = |p: f32, q: f32| {
        p == q || (p - q).abs() <= ABSOLUTE + RELATIVE * p.abs().min(q.abs()) || (p.is_nan() && q.is_nan())
    };
    !(0..3).all(|i| close(p[i], q[i]))
}

/// Whether a picture of `pixels` pixels with this number of different ones counts as the same picture.
pub fn is_tolerable(different: usize, pixels: usize) -> bool {
    different <= pixels / TOLERABLE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(pixels: Vec<Vec3>) -> Film {
        Film { width: pixels.len() as u32, height: 1, pixels }
    }

    #[test]
    fn rounding_is_no_difference_and_a_mistake_is_one() {
        let right = film(vec![Vec3::ZERO, Vec3::ONE, Vec3::splat(100.0), Vec3::NAN, Vec3::INFINITY]);
        let rounded =
            film(vec![Vec3::splat(0.001), Vec3::splat(0.995), Vec3::splat(100.9), Vec3::NAN, Vec3::INFINITY]);
        assert_eq!(different_pixels(&right, &rounded), 0);
        let wrong = film(vec![
            Vec3::new(0.0, 0.0, 0.01),
            Vec3::splat(0.9),
            Vec3::NAN,
            Vec3::ZERO,
            Vec3::splat(f32::MAX),
        ]);
        assert_eq!(different_pixels(&right, &wrong), 5);
        assert_eq!(different_pixels(&right, &film(vec![Vec3::ZERO; 4])), 5);
    }

    #[test]
    fn a_pixel_in_a_thousand_may_differ() {
        assert!(is_tolerable(0, 10) && !is_tolerable(1, 999));
        assert!(is_tolerable(64, 64_000) && !is_tolerable(65, 64_000));
    }
}
