//! Pictures in the terminal: each character is the upper half of a cell, and shows two pixels in the colours of its
//! foreground and of its background.

use image::RgbImage;

/// A colour of the screen.
pub type Rgb = [u8; 3];

/// Rows of characters, each with the colours of its upper and its lower half.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels(pub Vec<Vec<(Rgb, Rgb)>>);

impl Pixels {
    /// Shows a picture `columns` wide. It never enlarges.
    pub fn of(picture: &RgbImage, columns: u32) -> Pixels {
        let (width, height) = picture.dimensions();
        let columns = columns.clamp(1, width.max(1));
        let rows = (u64::from(height) * u64::from(columns) / u64::from(width.max(1))).max(1) as u32;
        // A last odd row is black below.
        let cell = |x, y| if y < rows { mean(picture, (x, y), (columns, rows)) } else { [0; 3] };
        let line = |y| (0..columns).map(|x| (cell(x, y), cell(x, y + 1))).collect();
        Pixels((0..rows).step_by(2).map(line).collect())
    }
}

/// The mean colour of one of `columns × rows` equal parts of a picture.
fn mean(picture: &RgbImage, (x, y): (u32, u32), (columns, rows): (u32, u32)) -> Rgb {
    let (width, height) = picture.dimensions();
    let part = |index: u32, parts: u32, size: u32| {
        let begin = (u64::from(index) * u64::from(size) / u64::from(parts)) as u32;
        let end = (u64::from(index + 1) * u64::from(size) / u64::from(parts)) as u32;
        begin..end.max(begin + 1).min(size)
    };
    let (mut sum, mut count) = ([0_u64; 3], 0);
    for y in part(y, rows, height) {
        for x in part(x, columns, width) {
            for (sum, channel) in sum.iter_mut().zip(picture.get_pixel(x, y).0) {
                *sum += u64::from(channel);
            }
            count += 1;
        }
    }
    sum.map(|sum| (sum / count.max(1)) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb as Pixel;

    #[test]
    fn a_character_has_two_pixels_one_above_the_other() {
        let picture = RgbImage::from_fn(2, 3, |x, y| Pixel([x as u8, y as u8, 7]));
        let rows = Pixels::of(&picture, 80).0;
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0], [([0, 0, 7], [0, 1, 7]), ([1, 0, 7], [1, 1, 7])]);
        assert_eq!(
            rows[1],
            [([0, 2, 7], [0; 3]), ([1, 2, 7], [0; 3])],
            "there is nothing below the last row"
        );
    }

    #[test]
    fn a_large_picture_is_averaged() {
        let picture = RgbImage::from_fn(40, 40, |x, _| Pixel([if x % 2 == 0 { 100 } else { 50 }; 3]));
        let rows = Pixels::of(&picture, 10).0;
        assert_eq!((rows.len(), rows[0].len()), (5, 10));
        assert!(rows.iter().flatten().all(|cell| *cell == ([75; 3], [75; 3])));
    }
}
