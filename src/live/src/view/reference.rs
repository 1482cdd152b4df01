//! The picture to compare with: rendered by the solutions where there are any, or else recorded in `scenes/reference`, or else the small one of
//! the gallery.

use anyhow::{Result, ensure};
use raykata::film::{Film, Tone, encode_srgb};
use raykata::scene::Scene;
use std::path::Path;

/// Where a reference comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Origin {
    /// The solutions have rendered it now.
    Rendered,
    /// The solutions have rendered it when it was recorded.
    Recorded,
    /// It is the small picture of the gallery, whose pixels are samples of their own and not means of blocks.
    Thumbnail,
}

/// A reference picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The number of pixels per row.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
    /// The number of pixels of the picture that one pixel of the reference covers in each direction.
    pub scale: u32,
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
    /// Where it comes from.
    pub origin: Origin,
}

/// The comparison of a picture with its reference.
pub struct Difference {
    /// Four times the difference of each component.
    pub rgb: Vec<u8>,
    /// The pixel of the picture that differs most: column and row.
    pub worst: [u32; 2],
    /// Its colour, as it is shown.
    pub yours: [u8; 3],
    /// The colour of the reference there.
    pub expected: [u8; 3],
    /// The number of pixels in which a component differs by more than 2 of 255.
    pub differ: usize,
}

impl Reference {
    /// The picture that was recorded for the scene of this name; `None` if there is none that fits to the scene.
    pub fn recorded(root: &Path, name: &str, scene: &Scene) -> Option<Reference> {
        let folder = root.join("scenes");
        // The picture of the showcase in the README has the size of its scene.
        let places = [
            (folder.join("reference"), Origin::Recorded),
            (folder.clone(), Origin::Recorded),
            (folder.join("images/gallery"), Origin::Thumbnail),
        ];
        let (picture, origin) = places.into_iter().find_map(|(folder, origin)| {
            Some((image::open(folder.join(format!("{name}.png"))).ok()?.into_rgb8(), origin))
        })?;
        let (width, height) = picture.dimensions();
        let scale = scene.film.width.checked_div(width)?;
        let fits = scale > 0 && scene.film.width == width * scale && scene.film.height == height * scale;
        fits.then(|| Reference { width, height, scale, rgb: picture.into_raw(), origin })
    }

    /// Where it comes from, in words.
    pub fn source(&self) -> &'static str {
        match self.origin {
            Origin::Rendered => "rendered by the solutions",
            Origin::Recorded => "recorded from the solutions",
            Origin::Thumbnail => "the small picture of the gallery, too coarse for an exact difference",
        }
    }

    /// Compares a picture with this one. `film` is the picture in linear light, and `rgb` as it is shown.
    pub fn difference(&self, tone: Tone, film: &Film, rgb: &[u8]) -> Result<Difference> {
        // Take the mean of the pixels that one pixel of the reference covers, in linear light as it is shown.
        let means = (self.scale > 1).then(|| film.toned(tone).means(self.scale).to_bytes(encode_srgb).rgb);
        let yours = means.as_deref().unwrap_or(rgb);
        ensure!(yours.len() == self.rgb.len(), "the picture has another size than its reference");
        // Find the pixel that differs most.
        let off = |index: usize| {
            let (a, b) = (&yours[3 * index..3 * index + 3], &self.rgb[3 * index..3 * index + 3]);
            a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
        };
        let n_pixels = self.rgb.len() / 3;
        let worst = (0..n_pixels).rev().max_by_key(|&index| off(index)).unwrap_or(0);
        let color = |bytes: &[u8]| [bytes[3 * worst], bytes[3 * worst + 1], bytes[3 * worst + 2]];
        let place = [worst as u32 % self.width, worst as u32 / self.width];
        Ok(Difference {
            rgb: yours.iter().zip(&self.rgb).map(|(a, b)| a.abs_diff(*b).saturating_mul(4)).collect(),
            worst: place.map(|at| at * self.scale + self.scale / 2),
            yours: color(yours),
            expected: color(&self.rgb),
            differ: (0..n_pixels).filter(|&index| off(index) > 2).count(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn the_worst_pixel_is_found_and_small_differences_are_not_counted() {
        let film = Film::new(2, 2);
        let rgb = vec![10, 10, 10, 20, 20, 20, 0, 0, 0, 5, 9, 5];
        let mut expected = rgb.clone();
        (expected[0], expected[10]) = (12, 99);
        let reference = Reference { width: 2, height: 2, scale: 1, rgb: expected, origin: Origin::Rendered };
        let difference = reference.difference(Tone::default(), &film, &rgb).unwrap();
        assert_eq!((difference.worst, difference.differ), ([1, 1], 1));
        assert_eq!((difference.yours, difference.expected), ([5, 9, 5], [5, 99, 5]));
        assert_eq!((difference.rgb[0], difference.rgb[10]), (8, 255));
        assert!(reference.difference(Tone::default(), &film, &rgb[..6]).is_err());
    }

    #[test]
    fn a_recorded_pixel_is_compared_with_the_mean_of_its_block() {
        let mut film = Film::new(2, 2);
        film.pixels[3] = Vec3::splat(4.0 * 0.5);
        // Components above 1 are shown as 1, so the mean is a quarter.
        let reference = Reference {
            width: 1,
            height: 1,
            scale: 2,
            rgb: vec![encode_srgb(0.25); 3],
            origin: Origin::Recorded,
        };
        let difference = reference.difference(Tone::default(), &film, &[0; 12]).unwrap();
        assert_eq!((difference.differ, difference.worst), (0, [1, 1]));
    }
}
