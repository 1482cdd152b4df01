//! Rows of a picture: a frame can be rendered in pieces, each by another process or on another machine.

use crate::message;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display};
use std::str::FromStr;

/// The side of a tile in pixels: small enough to share the work out evenly, large enough that neighbours
/// share caches.
pub const TILE: u32 = 16;

/// Consecutive rows of a picture: `start <= row < end`, counted from 0 at the top.
///
/// A frame counts rays and tests per tile of 16 by 16 pixels, and each tile starts with empty caches. So pieces have the same
/// counts as the whole picture only if no piece ends within a tile: see [`Rows::check`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Rows {
    /// The first row.
    pub start: u32,
    /// The row after the last one.
    pub end: u32,
}

message! { Rows { start, end } }

impl Rows {
    /// All rows of a picture of this height.
    pub fn all(height: u32) -> Rows {
        Rows { start: 0, end: height }
    }

    /// The number of rows; 0 if `end` is not greater than `start`.
    pub fn n_rows(self) -> u32 {
        self.end.saturating_sub(self.start)
    }

    /// Divides the rows of a picture of this height into `pieces` pieces of nearly equal size, from the top. If the picture has
    /// fewer rows of tiles than that, each row of tiles is a piece.
    pub fn divide(height: u32, pieces: u32) -> Vec<Rows> {
        let tiles = u64::from(height.div_ceil(TILE));
        let n = u64::from(pieces).min(tiles);
        // Both factors are smaller than 2^32, so no product overflows.
        let border =
            |index: u64| u32::try_from(index * tiles / n * u64::from(TILE)).unwrap_or(height).min(height);
        (0..n).map(|index| Rows { start: border(index), end: border(index + 1) }).collect()
    }

    /// Whether these rows can be rendered as a piece of a picture of this height: there is at least one, and they begin and end
    /// at multiples of 16 or at the last row.
    ///
    /// # Errors
    ///
    /// A sentence that says what is wrong and which rows are near.
    pub fn check(self, height: u32) -> Result<(), String> {
        if self.n_rows() == 0 {
            return Err(format!("{self} contains no row: the second number is the row after the last one"));
        }
        if self.end > height {
            return Err(format!("the picture has {height} rows: the last piece ends at {height}"));
        }
        let fits = |row: u32| row.is_multiple_of(TILE) || row == height;
        if fits(self.start) && fits(self.end) {
            return Ok(());
        }
        let near = Rows {
            start: self.start / TILE * TILE,
            end: self.end.checked_next_multiple_of(TILE).unwrap_or(height).min(height),
        };
        Err(format!("a piece begins and ends at multiples of {TILE} or at the last row, as {near}"))
    }
}

impl Display for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.start, self.end)
    }
}

impl FromStr for Rows {
    type Err = String;

    fn from_str(text: &str) -> Result<Rows, String> {
        let number = |text: &str| text.parse().ok();
        let rows = text
            .split_once("..")
            .and_then(|(start, end)| Some(Rows { start: number(start)?, end: number(end)? }));
        rows.ok_or_else(|| {
            "rows are written as 0..32: the first row, and the row after the last one".to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cover_each_row_once() {
        for height in [1, 15, 16, 17, 100, 600, 65_536] {
            for n in [1, 2, 3, 7, 64, u32::MAX] {
                let pieces = Rows::divide(height, n);
                assert!(pieces.len() <= n as usize && !pieces.is_empty());
                assert_eq!((pieces[0].start, pieces[pieces.len() - 1].end), (0, height));
                assert!(pieces.windows(2).all(|pair| pair[0].end == pair[1].start));
                assert!(pieces.iter().all(|rows| rows.check(height).is_ok()));
            }
        }
        assert_eq!(Rows::divide(600, 64).len(), 38);
        assert_eq!(Rows::divide(100, 2), [Rows { start: 0, end: 48 }, Rows { start: 48, end: 100 }]);
    }

    #[test]
    fn rows_are_read_as_they_are_written() {
        let rows = Rows { start: 16, end: 48 };
        assert_eq!(rows.to_string().parse(), Ok(rows));
        for wrong in ["", "3", "3-4", "..", "1..", "..7", "-1..4", "1..2..3"] {
            assert!(wrong.parse::<Rows>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_piece_that_cannot_be_is_refused_with_the_rows_to_take() {
        let check = |text: &str| text.parse::<Rows>().and_then(|rows| rows.check(100)).unwrap_err();
        assert!(check("16..16").contains("contains no row"));
        assert!(check("32..16").contains("contains no row"));
        assert!(check("96..112").contains("the picture has 100 rows"));
        assert!(check("10..40").contains("as 0..48"));
        assert!(check("90..99").contains("as 80..100"));
        assert!(Rows::all(100).check(100).is_ok());
    }
}
