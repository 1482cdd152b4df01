//! The environment map as a light: directions are sampled where the map is bright.

use crate::emitter::EmitterSample;
use crate::material::Texture;
use crate::scene::EnvironmentMap;
use glam::{Quat, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// A table from which directions to an environment map are sampled: piecewise constant, one value per pixel of the map.
///
/// A pixel is chosen in proportion to its solid angle times its mean luminance, and then a direction in the pixel uniformly
/// by solid angle. So the density per steradian is constant within a pixel, also at the poles. The mean is that of the map
/// as it is interpolated, so that a density is above 0 wherever the map is not black.
///
/// "Physically Based Rendering", "Piecewise-Constant 2D Distributions" and "Image Infinite Lights".
#[derive(Debug)]
pub struct EnvironmentTable {
    width: u32,
    height: u32,
    /// The angle by which the map is turned around +y.
    rotation: f32,
    /// For each row from the top the sum of the weights up to it and of its own. The last one is 1.
    rows: Vec<f64>,
    /// For each pixel the sum of the weights in its row up to it and of its own. The last one of each row is 1.
    columns: Vec<f32>,
}

impl EnvironmentTable {
    /// The table of `map`, whose image is `image`; `None` if the map is black.
    pub fn new(map: &EnvironmentMap, image: &Texture) -> Option<EnvironmentTable> {
        let (width, height) = (image.width, image.height);
        let luminance = smoothed(image);
        let (mut rows, mut columns) = (Vec::new(), Vec::with_capacity(luminance.len()));
        let mut all = 0.0;
        for (row, values) in (0..height).zip(luminance.chunks(width as usize)) {
            let sum: f64 = values.iter().sum();
            // A row that is black is never chosen; its pixels count as equal, so that no sum is divided by 0.
            let share = |value: f64| if sum > 0.0 { value / sum } else { 1.0 / f64::from(width) };
            let mut so_far = 0.0;
            columns.extend(values.iter().map(|&value| {
                so_far += share(value);
                so_far as f32
            }));
            if let Some(last) = columns.last_mut() {
                *last = 1.0;
            }
            all += sum * solid_angle_of_row(row, height) / f64::from(width);
            rows.push(all);
        }
        if !(all > 0.0 && all.is_finite() && map.scale > 0.0) {
            return None;
        }
        rows.iter_mut().for_each(|sum| *sum /= all);
        Some(EnvironmentTable { width, height, rotation: map.rotation, rows, columns })
    }

    /// A direction to the map for two random numbers, `0 <= u < 1` each. Its distance is infinite, and its `radiance` is left
    /// at 0 for the caller, who reads it from the map.
    pub fn sample(&self, u: Vec2) -> Option<EmitterSample> {
        // Choose a row, then a pixel of the row. What is left of each number is uniform within the row or pixel.
        let (row, down) = choose(self.height as usize, f64::from(u.y), |row| self.rows[row]);
        let of_row = row * self.width as usize;
        let (column, along) =
            choose(self.width as usize, f64::from(u.x), |column| f64::from(self.columns[of_row + column]));
        // Place the direction in the pixel: uniform in the longitude, and in the cosine of the angle to +y.
        let [top, bottom] = cosines_of_row(row as u32, self.height);
        let cos_theta = top + down * (bottom - top);
        let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt();
        let longitude = TAU * ((column as f64 + along) / f64::from(self.width) - 0.5);
        let (sin, cos) = longitude.sin_cos();
        let own = glam::dvec3(sin_theta * sin, cos_theta, -sin_theta * cos).as_vec3();
        let direction = Quat::from_rotation_y(self.rotation) * own;
        let pdf = self.pdf_of_pixel(row, column);
        let (direction, distance, radiance) = (direction.normalize(), f32::INFINITY, Vec3::ZERO);
        (pdf > 0.0).then_some(EmitterSample { direction, distance, radiance, pdf })
    }

    /// The density per steradian with which [`EnvironmentTable::sample`] samples `direction`, which may have any length.
    pub fn pdf(&self, direction: Vec3) -> f32 {
        let own = (Quat::from_rotation_y(-self.rotation) * direction).as_dvec3().normalize_or(glam::DVec3::Y);
        let column = (0.5 + own.x.atan2(-own.z) / TAU) * f64::from(self.width);
        let row = own.y.clamp(-1.0, 1.0).acos() / PI * f64::from(self.height);
        let last = |count: u32| count as usize - 1;
        self.pdf_of_pixel((row as usize).min(last(self.height)), (column as usize).min(last(self.width)))
    }

    fn pdf_of_pixel(&self, row: usize, column: usize) -> f32 {
        let before = |sums: &dyn Fn(usize) -> f64, index: usize| index.checked_sub(1).map_or(0.0, sums);
        let of_row = |row: usize| self.rows[row];
        let of_column = |column: usize| f64::from(self.columns[row * self.width as usize + column]);
        let in_row = of_row(row) - before(&of_row, row);
        let in_column = of_column(column) - before(&of_column, column);
        let solid_angle = solid_angle_of_row(row as u32, self.height) / f64::from(self.width);
        (in_row * in_column / solid_angle) as f32
    }
}

/// The index that `u`, `0 <= u < 1`, chooses by these sums, of which the last one is 1, and the position of `u` in the
/// interval of that index, in `0..=1`.
fn choose(count: usize, u: f64, sum: impl Fn(usize) -> f64) -> (usize, f64) {
    // Search the first sum above u by bisection.
    let (mut low, mut high) = (0, count - 1);
    while low < high {
        let middle = (low + high) / 2;
        if sum(middle) <= u { low = middle + 1 } else { high = middle }
    }
    let before = if low == 0 { 0.0 } else { sum(low - 1) };
    (low, ((u - before) / (sum(low) - before)).clamp(0.0, 1.0))
}

/// The cosines of the angles between +y and the upper and lower edge of a row.
fn cosines_of_row(row: u32, rows: u32) -> [f64; 2] {
    [row, row + 1].map(|edge| (PI * f64::from(edge) / f64::from(rows)).cos())
}

/// The solid angle of a row of pixels, in steradians; all rows have 4π.
fn solid_angle_of_row(row: u32, rows: u32) -> f64 {
    let [top, bottom] = cosines_of_row(row, rows);
    TAU * (top - bottom)
}

/// The mean luminance of each pixel, from the upper left one on, if the map is interpolated between the centres of four
/// pixels: the integral of a linear interpolation over a pixel is 3/4 of its own value and 1/8 of that of each neighbour.
/// The image repeats from left to right; beyond its upper and lower edge the border continues.
fn smoothed(image: &Texture) -> Vec<f64> {
    let (width, height) = (image.width as usize, image.height as usize);
    let luminance = |column: usize, row: usize| {
        // The weights are those of the primaries of sRGB, ITU-R BT.709.
        let color = image.pixels[row * width + column].as_dvec3().max(glam::DVec3::ZERO);
        let sum = color.dot(glam::dvec3(0.2126, 0.7152, 0.0722));
        if sum.is_finite() { sum } else { 0.0 }
    };
    let along = |column: usize, row: usize| {
        let (left, right) = ((column + width - 1) % width, (column + 1) % width);
        0.75 * luminance(column, row) + 0.125 * (luminance(left, row) + luminance(right, row))
    };
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    pixels
        .map(|(column, row)| {
            let (above, below) = (row.saturating_sub(1), (row + 1).min(height - 1));
            0.75 * along(column, row) + 0.125 * (along(column, above) + along(column, below))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Wrap;
    use std::sync::Arc;

    /// A map with a bright spot, a dark half and a coloured band.
    fn sky() -> (EnvironmentMap, Texture) {
        let (width, height) = (16, 8);
        let pixels = (0..width * height).map(|index| match (index % width, index / width) {
            (3, 1) => Vec3::splat(50.0),
            (_, row) if row >= 5 => Vec3::ZERO,
            (column, row) => Vec3::new(0.2, 0.1 * column as f32, 0.3 * row as f32),
        });
        let texture = Texture { width, height, pixels: Arc::new(pixels.collect()), wrap: Wrap::Repeat };
        (EnvironmentMap { texture: 0, rotation: 0.7, scale: 2.0 }, texture)
    }

    /// Directions through the middles of equal parts of the sphere of directions: each has 4π / count steradians.
    fn directions(rows: u32) -> impl Iterator<Item = Vec3> {
        (0..rows).flat_map(move |row| {
            (0..2 * rows).map(move |column| {
                let y = 1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(rows);
                let (sin, cos) = (TAU * (f64::from(column) + 0.5) / f64::from(2 * rows)).sin_cos();
                let flat = (1.0 - y * y).sqrt();
                glam::dvec3(flat * sin, y, flat * cos).as_vec3()
            })
        })
    }

    #[test]
    fn the_density_integrates_to_one() {
        let (map, image) = sky();
        let table = EnvironmentTable::new(&map, &image).expect("a map with light");
        let rows = 1500;
        let sum: f64 = directions(rows).map(|direction| f64::from(table.pdf(direction))).sum();
        let integral = sum * 4.0 * PI / f64::from(2 * rows * rows);
        // The midpoint rule errs by at most half a line at each edge of a pixel. The pixels of the second row, with the bright
        // spot, have 162 rows and 187 columns of directions each: 1/162 + 1/187 < 0.012.
        assert!((integral - 1.0).abs() < 0.012, "{integral}");
    }

    #[test]
    fn samples_follow_the_density_and_know_it() {
        let (map, image) = sky();
        let table = EnvironmentTable::new(&map, &image).expect("a map with light");
        // Count samples per pixel over a fine grid of random numbers, whose shares are exact up to one line of the grid.
        let n = 1024;
        let mut counts = vec![0u32; 128];
        for index in 0..n * n {
            let u = Vec2::new((index % n) as f32 + 0.5, (index / n) as f32 + 0.5) / n as f32;
            let sample = table.sample(u).expect("every u gives a sample");
            assert!((sample.direction.length() - 1.0).abs() < 1e-6 && sample.distance == f32::INFINITY);
            let uv = map.texture_coordinates(sample.direction, 1 << 20);
            let (column, row) = ((uv.x * 16.0) as usize % 16, ((1.0 - uv.y) * 8.0).min(7.0) as usize);
            counts[row * 16 + column] += 1;
            // Directions on an edge of a pixel may belong to either side.
            let away = |x: f32| (x - x.round()).abs() > 1e-4;
            if away(uv.x * 16.0) && away(uv.y * 8.0) {
                let pdf = table.pdf(sample.direction);
                assert!((sample.pdf - pdf).abs() <= 1e-4 * pdf, "{} {pdf} at {uv}", sample.pdf);
            }
        }
        for (pixel, &count) in counts.iter().enumerate() {
            let (row, column) = (pixel / 16, pixel % 16);
            let solid_angle = solid_angle_of_row(row as u32, 8) / 16.0;
            let expected = f64::from(table.pdf_of_pixel(row, column)) * solid_angle;
            let found = f64::from(count) / f64::from(n * n);
            // A row or column of the grid on either edge: 4 lines of 1,024 at most in each direction.
            assert!((found - expected).abs() <= 4.0 / f64::from(n), "{found} {expected} in {row} {column}");
        }
        // The bright spot gets more samples than any other pixel.
        assert_eq!(counts.iter().max(), Some(&counts[16 + 3]));
    }

    #[test]
    fn a_pixel_that_is_bright_only_by_interpolation_is_sampled() {
        let (map, image) = sky();
        let table = EnvironmentTable::new(&map, &image).expect("a map with light");
        // Row 5 is black, but its upper half is interpolated towards row 4. Row 7 is black altogether.
        assert!(table.pdf_of_pixel(5, 9) > 0.0 && table.pdf_of_pixel(7, 9) == 0.0);
    }

    #[test]
    fn a_black_map_has_no_table() {
        let (map, image) = sky();
        let black = Texture { pixels: Arc::new(vec![Vec3::ZERO; 128]), ..image.clone() };
        assert!(EnvironmentTable::new(&map, &black).is_none());
        assert!(EnvironmentTable::new(&EnvironmentMap { scale: 0.0, ..map }, &image).is_none());
    }
}
