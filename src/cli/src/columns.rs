//! The printer of aligned tables.

use std::fmt::Display;

/// The columns of a table: what stands between two of them, and the width of each in characters. Numbers end at the right of
/// their column; a negative width is that of a column whose text begins at the left.
pub struct Columns(pub &'static str, pub &'static [isize]);

impl Columns {
    /// A row with these cells. A cell that is wider than its column moves those after it.
    pub fn row(&self, cells: &[&dyn Display]) -> String {
        let Columns(between, widths) = self;
        let cells: Vec<String> =
            cells.iter().zip(*widths).map(|(cell, &width)| aligned(cell, width)).collect();
        cells.join(between)
    }
}

/// A cell, filled with spaces to its width.
pub fn aligned(cell: impl Display, width: isize) -> String {
    let (text, n) = (cell.to_string(), width.unsigned_abs());
    if width < 0 { format!("{text:<n$}") } else { format!("{text:>n$}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_begin_at_the_same_character() {
        let columns = Columns("  ", &[-8, 5, -3]);
        assert_eq!(columns.row(&[&"größe", &1.5, &"µ"]), "größe       1.5  µ  ");
        assert_eq!(columns.row(&[&"n", &12345, &"ab"]), "n         12345  ab ");
        assert_eq!(columns.row(&[&"too long a name", &7]), "too long a name      7");
    }
}
