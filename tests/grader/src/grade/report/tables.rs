//! Tables for spreadsheets: `grades.csv`, `checks.csv` and `timings.csv`.

use super::tally::{self, Tally};
use crate::grade::result::{Class, sum};
use anyhow::{Result, anyhow};

/// Writes one row per student: points in total and per stage.
pub(super) fn grades(class: &Class, tallies: &[Tally], pages: &[String]) -> Result<Vec<u8>> {
    let stages = tally::stages(tallies);
    let header = ["name", "points", "of", "percent"].map(str::to_owned).into_iter();
    let header = header.chain(stages.iter().map(|stage| format!("stage{stage}")));
    let mut rows = vec![header.chain(["remarks", "trouble", "page"].map(str::to_owned)).collect()];
    for (student, page) in class.students.iter().zip(pages) {
        let (points, of) = (student.points().0, tally::of(tallies));
        let percent = tally::percent(points, of);
        let mut row = vec![student.student.clone(), points.to_string(), of.to_string(), percent];
        row.extend(stages.iter().map(|&stage| sum(student.of_stage(stage)).0.to_string()));
        row.extend([student.remarks.len().to_string(), student.trouble.clone(), page.clone()]);
        rows.push(row);
    }
    table(rows)
}

/// Writes one row per check of each student.
pub(super) fn checks(class: &Class) -> Result<Vec<u8>> {
    let mut rows =
        vec![["name", "stage", "check", "outcome", "points", "earned"].map(str::to_owned).to_vec()];
    for student in &class.students {
        rows.extend(student.checks.iter().map(|check| {
            let (name, words) = (check.name.clone(), check.outcome.words().to_owned());
            let (points, earned) = (check.points.to_string(), check.earned.to_string());
            vec![student.student.clone(), check.stage.to_string(), name, words, points, earned]
        }));
    }
    table(rows)
}

/// Writes one row per student: the time of grading. It has its own file, because it differs from run to run.
pub(super) fn timings(class: &Class, pages: &[String]) -> Result<Vec<u8>> {
    let mut rows = vec![["name", "cpu_ms", "page"].map(str::to_owned).to_vec()];
    for (student, page) in class.students.iter().zip(pages) {
        rows.push(vec![student.student.clone(), student.cpu_ms.to_string(), page.clone()]);
    }
    table(rows)
}

/// Writes a table. All texts are in quotes, so that no text is divided where `;` or a tab separates cells.
fn table(rows: Vec<Vec<String>>) -> Result<Vec<u8>> {
    let mut writer =
        csv::WriterBuilder::new().quote_style(csv::QuoteStyle::NonNumeric).from_writer(Vec::new());
    for row in rows {
        writer.write_record(row.iter().map(|cell| defused(cell)))?;
    }
    writer.into_inner().map_err(|error| anyhow!("{error}"))
}

/// Returns the cell in a form that no spreadsheet takes for a formula.
fn defused(cell: &str) -> String {
    match cell.trim_start().starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠']) {
        true => format!("'{cell}"),
        false => cell.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_text() -> Result<()> {
        let row = ["=1+1", "+1", "-1", "@SUM(A1)", " =1", "a=1", "12", "a,\"b\"", "x;=1+1", "x\t=1"];
        let bytes = table(vec![row.map(str::to_owned).to_vec()])?;
        let expected = r#""'=1+1","'+1","'-1","'@SUM(A1)","' =1","a=1",12,"a,""b""","x;=1+1","x	=1""#;
        assert_eq!(String::from_utf8_lossy(&bytes), format!("{expected}\n"));
        Ok(())
    }
}
