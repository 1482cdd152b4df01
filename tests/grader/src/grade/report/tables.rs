//! Tables for spreadsheets: `grades.csv`, `checks.csv` and `timings.csv`.

use super::Each;
use super::line::Line;
use super::tally::{self, Tally};
use crate::grade::result::Session;
use anyhow::{Result, anyhow};
use std::io::Write;

/// Returns one row per student: points in total and per stage, bonus points, the core, and what is late if the course has dates.
pub(super) fn grades(lines: &[Line], tallies: &[Tally], session: &Session) -> Result<Vec<u8>> {
    let (stages, of, core) = (tally::stages(tallies), tally::of(tallies), tally::of_core(tallies));
    let mut table = Table::new(Vec::new());
    let header = ["name", "points", "of", "percent"].map(str::to_owned).into_iter();
    let header = header.chain(stages.iter().map(|stage| format!("stage{stage}")));
    let header = header.chain(["bonus".to_owned()]);
    let dates: &[&str] = if session.due.is_empty() { &[] } else { &["handed_in", "late_stages"] };
    let header = header.chain(dates.iter().map(|&name| name.to_owned()));
    table.row(
        header.chain(["remarks", "trouble", "page", "added", "note", "core", "core_of"].map(str::to_owned)),
    )?;
    for line in lines {
        let percent = tally::percent(line.points, of);
        let [points, of, core, of_core] = [line.points, of, line.core, core].map(|points| points.to_string());
        let row = [line.student.clone(), points, of, percent].into_iter();
        let row = row.chain(stages.iter().map(|&stage| line.of_stage(stage).to_string()));
        let row = row.chain([line.bonus.to_string()]);
        let late: Vec<String> = line.late.iter().map(u8::to_string).collect();
        let row = row.chain([line.handed_in.clone(), late.join(" ")].into_iter().take(dates.len()));
        let remarks = [line.n_remarks.to_string(), line.trouble.clone(), line.page.clone()];
        let added = line
            .note
            .as_ref()
            .map_or([String::new(), String::new()], |note| [note.points.to_string(), note.text.clone()]);
        table.row(row.chain(remarks).chain(added).chain([core, of_core]))?;
    }
    table.finish()
}

/// Writes one row per check of each student.
pub(super) fn checks(each: &Each<'_>, out: &mut dyn Write) -> Result<()> {
    let mut table = Table::new(out);
    table.row(["name", "stage", "check", "outcome", "points", "earned", "level"].map(str::to_owned))?;
    each(&mut |graded| {
        graded.checks.iter().try_for_each(|check| {
            let (name, words) = (check.name.clone(), check.outcome.words().to_owned());
            let [points, earned] = [check.points, check.earned].map(|points| points.to_string());
            let level = check.level.word().to_owned();
            table.row([graded.student.clone(), check.stage.to_string(), name, words, points, earned, level])
        })
    })?;
    table.finish().map(drop)
}

/// Returns one row per student: the time of grading. It has its own file, because it differs from run to run.
pub(super) fn timings(lines: &[Line]) -> Result<Vec<u8>> {
    let mut table = Table::new(Vec::new());
    table.row(["name", "cpu_ms", "page"].map(str::to_owned))?;
    for line in lines {
        table.row([line.student.clone(), line.cpu_ms.to_string(), line.page.clone()])?;
    }
    table.finish()
}

/// A table. All texts are in quotes, so that no text is divided where `;` or a tab separates cells.
struct Table<W: Write>(csv::Writer<W>);

impl<W: Write> Table<W> {
    fn new(out: W) -> Table<W> {
        Table(csv::WriterBuilder::new().quote_style(csv::QuoteStyle::NonNumeric).from_writer(out))
    }

    fn row(&mut self, cells: impl IntoIterator<Item = String>) -> Result<()> {
        Ok(self.0.write_record(cells.into_iter().map(|cell| defused(&cell)))?)
    }

    fn finish(self) -> Result<W> {
        self.0.into_inner().map_err(|error| anyhow!("{error}"))
    }
}

/// Returns the cell in a form that no spreadsheet takes for a formula.
fn defused(cell: &str) -> String {
    let may_be_formula = cell.trim_start().starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠']);
    match may_be_formula && cell.parse::<i64>().is_err() {
        true => format!("'{cell}"),
        false => cell.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_text() -> Result<()> {
        let row = ["=1+1", "+1 ", "-1", "@SUM(A1)", " =1", "a=1", "12", "a,\"b\"", "x;=1+1", "x\t=1"];
        let mut table = Table::new(Vec::new());
        table.row(row.map(str::to_owned))?;
        let bytes = table.finish()?;
        let expected = r#""'=1+1","'+1 ",-1,"'@SUM(A1)","' =1","a=1",12,"a,""b""","x;=1+1","x	=1""#;
        assert_eq!(String::from_utf8_lossy(&bytes), format!("{expected}\n"));
        Ok(())
    }
}
