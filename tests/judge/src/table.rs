//! Tables of results, printed for a terminal of 80 columns.

/// A table with a name for each row and each column.
pub struct Table {
    /// What the numbers are.
    pub title: String,
    /// The names of the columns.
    pub heads: Vec<String>,
    /// The name and the cells of each row.
    pub rows: Vec<(String, Vec<String>)>,
    /// Sentences that explain the table.
    pub notes: Vec<String>,
}

/// The width of a terminal.
const WIDTH: usize = 80;

/// The space between two columns.
const GAP: usize = 2;

impl Table {
    /// The table as text. Columns that do not fit into a terminal follow below, with the names of the rows again.
    pub fn text(&self) -> String {
        let length = |text: &String| text.chars().count();
        let names = self.rows.iter().map(|(name, _)| length(name)).max().unwrap_or(0);
        // The width of each column is that of its widest cell.
        let width = |column: usize| {
            let cells = self.rows.iter().filter_map(|(_, cells)| cells.get(column));
            GAP + cells.chain([&self.heads[column]]).map(length).max().unwrap_or(0)
        };
        let mut text = format!("{}\n", self.title);
        let mut first = 0;
        while first < self.heads.len() {
            // Take as many columns as fit, and at least one.
            let mut last = first + 1;
            let mut taken = names + width(first);
            while last < self.heads.len() && taken + width(last) <= WIDTH {
                taken += width(last);
                last += 1;
            }
            let line = |name: &str, cells: &[String]| {
                let columns = (first..last).map(|column| {
                    let cell = cells.get(column).map_or("", String::as_str);
                    format!("{cell:>width$}", width = width(column))
                });
                format!("{name:names$}{}", columns.collect::<String>()).trim_end().to_owned() + "\n"
            };
            text += &line("", &self.heads);
            self.rows.iter().for_each(|(name, cells)| text += &line(name, cells));
            text.push('\n');
            first = last;
        }
        for note in &self.notes {
            text += &format!("{note}\n");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_follows_below() {
        let wide = Table {
            title: "numbers <1".into(),
            heads: (0..20).map(|n| format!("head {n}")).collect(),
            rows: vec![("a row".into(), (0..20).map(|n| n.to_string()).collect())],
            notes: vec!["A note.".into()],
        };
        let text = wide.text();
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert!((0..20).all(|n| text.contains(&format!("head {n}"))), "{text}");
        assert_eq!(text.matches("a row").count(), 3);
        assert!(text.ends_with("A note.\n"));
    }
}
