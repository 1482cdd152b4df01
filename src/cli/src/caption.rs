//! Text in pictures: a caption below each picture of a strip.

use glam::Vec3;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use raykata::film::Film;

/// The height of a caption in pixels: a line of text, with a gap above and below it.
pub const HEIGHT: u32 = TEXT.val() as u32 + 2 * MARGIN;

/// The height of a line of text.
const TEXT: RasterHeight = RasterHeight::Size20;

/// Pixels between the text and the ends of its band.
const MARGIN: u32 = 2;

/// Writes `text` in white into the band of `HEIGHT` rows that begins at pixel (x, y) and is `width` pixels wide. Text that
/// is too wide is shortened to its last word, and then to the characters that fit. Characters outside of ASCII become `?`.
pub fn write(film: &mut Film, text: &str, [x, y]: [u32; 2], width: u32) {
    let advance = get_raster_width(FontWeight::Regular, TEXT) as u32;
    let room = (width.saturating_sub(MARGIN) / advance) as usize;
    let last_word = text.rsplit(' ').next().unwrap_or(text);
    let text = if text.chars().count() <= room { text } else { last_word };
    for (index, character) in text.chars().take(room).enumerate() {
        let raster = |character| get_raster(character, FontWeight::Regular, TEXT);
        let Some(picture) = raster(character).or_else(|| raster('?')) else { continue };
        let left = x + MARGIN + index as u32 * advance;
        for (row, levels) in picture.rows().enumerate() {
            let start = ((y + MARGIN + row as u32) * film.width + left) as usize;
            for (pixel, &level) in film.pixels[start..].iter_mut().zip(levels) {
                *pixel = Vec3::splat(f32::from(level) / 255.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of pixels that are not black.
    fn lit(film: &Film) -> usize {
        film.pixels.iter().filter(|pixel| **pixel != Vec3::ZERO).count()
    }

    #[test]
    fn text_stays_in_its_band() {
        let mut film = Film::new(100, 2 * HEIGHT);
        write(&mut film, "depth 10, with more than fits", [20, HEIGHT], 60);
        let inside = |index: usize| (20..80).contains(&(index % 100)) && index / 100 >= HEIGHT as usize;
        assert!(lit(&film) > 50);
        assert!(film.pixels.iter().enumerate().all(|(index, pixel)| *pixel == Vec3::ZERO || inside(index)));
    }

    #[test]
    fn each_character_has_a_picture() {
        for character in (' '..='~').skip(1).chain(['·']) {
            let mut film = Film::new(20, HEIGHT);
            write(&mut film, &character.to_string(), [0, 0], 20);
            assert!(lit(&film) > 0, "{character}");
        }
    }

    #[test]
    fn a_picture_without_room_gets_no_text() {
        let mut film = Film::new(5, HEIGHT);
        write(&mut film, "depth 1", [0, 0], 5);
        assert_eq!(lit(&film), 0);
    }
}
