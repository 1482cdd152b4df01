//! Tables as CSV and as a page.

use anyhow::Result;
use judge::table::Table;
use raykata_cli::html::{around, csv_line, element, escape};
use raykata_cli::report::{make_folder, write_file};
use std::path::Path;

/// The style of the page. Tables scroll in narrow windows.
const STYLE: &str = "body{font:16px/1.5 sans-serif;margin:2rem auto;max-width:80rem;padding:0 1rem}\
table{border-collapse:collapse;display:block;overflow-x:auto;font-variant-numeric:tabular-nums}\
th,td{padding:.15rem .6rem;text-align:right;border-bottom:1px solid #8884;white-space:pre}\
th[scope=row]{text-align:left;font-weight:normal}:root{color-scheme:light dark}";

/// Writes `tables` to the folder `out`: a page `index.html`, and `NAME.csv` with a line per cell.
pub fn write(out: &Path, name: &str, tables: &[Table]) -> Result<()> {
    make_folder(out)?;
    let body: String = tables.iter().map(html).collect();
    let title = element("title", name);
    let page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">{title}<style>{STYLE}</style></head>\
         <body>{}{body}</body></html>\n",
        element("h1", name)
    );
    let mut csv = csv_line(&["table", "row", "column", "value"].map(str::to_owned));
    for table in tables {
        let mut family = "";
        for (row, cells) in &table.rows {
            // An indented row is a variant of the last row that is not.
            let name = row.strip_prefix("  ").map_or(row.clone(), |variant| format!("{family}: {variant}"));
            family = if row.starts_with(' ') { family } else { row };
            for (head, cell) in table.heads.iter().zip(cells) {
                csv += &csv_line(&[&table.title, &name, head, cell].map(String::clone));
            }
        }
    }
    for (file, text) in [("index.html".to_owned(), page), (format!("{name}.csv"), csv)] {
        write_file(&out.join(file), text.as_bytes())?;
    }
    Ok(())
}

fn html(table: &Table) -> String {
    let head: String = table.heads.iter().map(|head| element("th", head)).collect();
    let rows = table.rows.iter().map(|(name, cells)| {
        let cells: String = cells.iter().map(|cell| element("td", cell)).collect();
        around("tr", "", &(around("th", "scope=\"row\"", &escape(name)) + &cells))
    });
    let cells = around("tr", "", &(element("td", "") + &head)) + &rows.collect::<String>();
    let notes: String = table.notes.iter().map(|note| element("p", note)).collect();
    element("h2", &table.title) + &around("table", "", &cells) + &notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_hold_every_cell() {
        let table = Table {
            title: "numbers <1".into(),
            heads: vec!["one".into(), "two".into()],
            rows: vec![("a".into(), vec!["1".into()]), ("  b, c".into(), vec!["2".into(), "3".into()])],
            notes: vec!["A note.".into()],
        };
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "numbers", &[table]).unwrap();
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        assert_eq!(
            read("numbers.csv"),
            "table,row,column,value\nnumbers <1,a,one,1\nnumbers <1,\"a: b, c\",one,2\nnumbers <1,\"a: b, c\",two,3\n"
        );
        assert!(read("index.html").contains("<h2>numbers &lt;1</h2>"));
        assert_eq!(read("index.html").matches("<td>").count(), 4);
    }
}
