//! Pictures in a terminal: each character is the upper half of a cell, and shows two pixels in the colours of its foreground and of
//! its background.

use std::env;
use std::fmt::Write;
use std::io::{IsTerminal, stdout};

/// A colour of the screen.
pub type Rgb = [u8; 3];

/// What the terminal can show.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Whether it shows more than ASCII.
    pub has_unicode: bool,
    /// Whether it shows colours.
    pub has_colours: bool,
    /// Whether it shows 24-bit colours. Otherwise pictures have the 216 colours that every terminal with colours has.
    pub has_true_colour: bool,
}

impl Look {
    /// Asks the variables of the environment by which terminals and users say what they can show.
    pub fn of_environment() -> Look {
        let value = |name: &str| env::var(name).unwrap_or_default().to_lowercase();
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].map(value).into_iter().find(|name| !name.is_empty());
        let is_utf8 = locale.is_some_and(|name| name.contains("utf-8") || name.contains("utf8"));
        Look {
            has_unicode: is_utf8 || cfg!(windows),
            has_colours: env::var_os("NO_COLOR").is_none()
                && value("TERM") != "dumb"
                && stdout().is_terminal(),
            has_true_colour: ["truecolor", "24bit"].contains(&value("COLORTERM").as_str()),
        }
    }

    /// Whether it shows pictures.
    pub fn shows_pictures(self) -> bool {
        self.has_colours && self.has_unicode
    }

    /// The codes of a colour: 38 for the character or 48 for its background, then the colour itself, or the nearest one of the
    /// cube of 6 × 6 × 6 colours of a terminal with 256.
    fn code(self, ground: u8, [r, g, b]: Rgb) -> String {
        let level = |channel: u8| (channel / 51) + u8::from(channel % 51 > 25);
        match self.has_true_colour {
            true => format!("{ground};2;{r};{g};{b}"),
            false => format!("{ground};5;{}", 16 + 36 * level(r) + 6 * level(g) + level(b)),
        }
    }

    /// A row of cells as text for the terminal, each with the colours of its upper and its lower half.
    pub fn line(self, cells: &[(Rgb, Rgb)]) -> String {
        let mut line = String::new();
        for &(upper, lower) in cells {
            let _ = write!(line, "\u{1b}[{};{}m▀", self.code(38, upper), self.code(48, lower));
        }
        line + "\u{1b}[0m"
    }
}

/// The rows of cells that show a picture of `width` pixels per row in at most `columns` columns and `rows` rows. They never enlarge.
pub fn cells(rgb: &[u8], width: usize, columns: usize, rows: usize) -> Vec<Vec<(Rgb, Rgb)>> {
    let (width, height) = (width.max(1), rgb.len() / 3 / width.max(1));
    let columns = columns.min(2 * rows * width / height.max(1)).clamp(1, width);
    let n_rows = (height * columns / width).max(1);
    // The mean colour of one of the equal parts of the picture. A last odd row is black below.
    let part = |index: usize, parts: usize, size: usize| {
        let begin = index * size / parts;
        begin..((index + 1) * size / parts).max(begin + 1).min(size)
    };
    let mean = |x, y| {
        let mut sum = [0; 4];
        for at in part(y, n_rows, height).flat_map(|y| part(x, columns, width).map(move |x| y * width + x)) {
            (0..3).for_each(|channel| sum[channel] += usize::from(rgb[3 * at + channel]));
            sum[3] += 1;
        }
        if y < n_rows { [0, 1, 2].map(|channel| (sum[channel] / sum[3].max(1)) as u8) } else { [0; 3] }
    };
    let row = |y| (0..columns).map(|x| (mean(x, y), mean(x, y + 1))).collect();
    (0..n_rows).step_by(2).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_character_has_two_pixels_one_above_the_other() {
        let rgb: Vec<u8> = (0..3).flat_map(|y| (0..2).flat_map(move |x| [x, y, 7])).collect();
        let rows = cells(&rgb, 2, 80, 24);
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0], [([0, 0, 7], [0, 1, 7]), ([1, 0, 7], [1, 1, 7])]);
        assert_eq!(
            rows[1],
            [([0, 2, 7], [0; 3]), ([1, 2, 7], [0; 3])],
            "there is nothing below the last row"
        );
    }

    #[test]
    fn a_large_picture_is_averaged_and_fits() {
        let rgb: Vec<u8> = (0..1600).flat_map(|index| [if index % 2 == 0 { 100 } else { 50 }; 3]).collect();
        for (columns, rows, expected) in [(10, 24, (5, 10)), (40, 5, (5, 10)), (1, 1, (1, 1))] {
            let cells = cells(&rgb, 40, columns, rows);
            assert_eq!((cells.len(), cells[0].len()), expected);
            assert!(columns == 1 || cells.iter().flatten().all(|cell| *cell == ([75; 3], [75; 3])));
        }
    }

    #[test]
    fn a_terminal_without_24_bit_colours_gets_the_nearest_of_216() {
        let look = Look { has_unicode: true, has_colours: true, has_true_colour: false };
        let cell = [([255, 0, 60], [0, 0, 0])];
        assert_eq!(look.line(&cell), "\u{1b}[38;5;197;48;5;16m▀\u{1b}[0m");
        let look = Look { has_true_colour: true, ..look };
        assert_eq!(look.line(&cell), "\u{1b}[38;2;255;0;60;48;2;0;0;0m▀\u{1b}[0m");
    }
}
