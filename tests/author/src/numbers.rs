//! Numbers in documents. `author sync` writes them, so that no document has a stale one.
//!
//! A comment directly after a number gives it a name, and no reader of the page sees it: `417<!--=checks-->`. With numbers of
//! stages, `105<!--=points 1-->` or `605<!--=points 1-6-->`, only these stages count. A comment on a line of its own names the
//! table below it, up to the next blank line. A name with a colon is a number that a command [prints](printed).

use crate::corpus::entry::{self, Claim, Entry};
use crate::printed::{self, Printed};
use all_checks::STAGES;
use anyhow::{Context, Result, bail, ensure};
use checks::Check;
use checks::rubric::{self, Level};
use grader::exercises::{self, Exercise};
use grader::files_below::{files_below, last_part};
use raykata_cli::slides::decks;
use std::cell::OnceCell;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The beginning of a comment that names a number or a table.
const MARK: &str = "<!--=";

impl Document {
    /// A line for each line of the document whose numbers are stale: file, line, what stands there and what should.
    pub fn stale(&self) -> Vec<String> {
        let mut stale = Vec::new();
        for ((yours, expected), line) in self.present.lines().zip(self.synced.lines()).zip(1..) {
            if yours == expected {
                continue;
            }
            // The words that differ are those between the common beginning and the common end.
            let (yours, expected): (Vec<&str>, Vec<&str>) =
                (yours.split(' ').collect(), expected.split(' ').collect());
            let same = yours.iter().zip(&expected).take_while(|(yours, expected)| yours == expected).count();
            let word = |words: &[&str]| {
                words.get(same).map_or("", |word| word.split("<!--").next().unwrap_or(word)).to_owned()
            };
            let [yours, expected] = [word(&yours), word(&expected)];
            stale.push(format!("  {}:{line}: yours `{yours}`, expected `{expected}`", self.path.display()));
        }
        if stale.is_empty() && self.present != self.synced {
            stale.push(format!("  {}", self.path.display()));
        }
        stale
    }
}

/// The beginning of a comment that names the command of a quotation.
const QUOTE: &str = "<!-- from: cargo ";

/// Folders without documents that name numbers.
const SKIPPED: [&str; 4] = ["corpus", "node_modules", "out", "target"];

/// A document that names numbers.
pub struct Document {
    /// Its path below the root of the kit.
    pub path: PathBuf,
    /// Its current text.
    pub present: String,
    /// The text with the numbers as they are now.
    pub synced: String,
}

/// Returns all documents of the kit at `root` that name numbers: Markdown files in folders that are not hidden.
///
/// # Errors
///
/// If a name is unknown, or if its comment follows no number. The error says file and line.
pub fn documents(root: &Path) -> Result<Vec<Document>> {
    let keeps = |path: &str| !last_part(path).starts_with('.') && !SKIPPED.contains(&last_part(path));
    let mut paths: Vec<PathBuf> = files_below(root, "", &keeps)?.into_iter().map(PathBuf::from).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "md"));
    paths.sort();
    let values = Values { root, corpus: OnceCell::new(), printed: printed::read_all(root)? };
    let mut documents = Vec::new();
    for path in paths {
        let file = root.join(&path);
        let present = fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        if present.contains(MARK) || present.contains(QUOTE) {
            let name = path.display().to_string();
            let synced = rewrite(&name, &present, |name| values.get(name))?;
            let synced = printed::quote(&name, &synced, &values.printed)?;
            documents.push(Document { path, present, synced });
        }
    }
    Ok(documents)
}

/// Returns the text with each named number or table replaced by its value.
fn rewrite(path: &str, text: &str, value: impl Fn(&str) -> Result<String>) -> Result<String> {
    let (mut synced, mut rest) = (String::new(), text);
    while let Some(start) = rest.find(MARK) {
        let (before, marked) = rest.split_at(start);
        let line = text[..text.len() - marked.len()].matches('\n').count() + 1;
        let place = || format!("{path}:{line}");
        // Find the value of the name.
        let end = marked.find("-->").with_context(|| format!("{}: `{MARK}` is never closed", place()))?;
        let value = value(marked[MARK.len()..end].trim()).with_context(place)?;
        let (mark, after) = marked.split_at(end + "-->".len());
        let is_alone = (before.is_empty() || before.ends_with('\n')) && after.starts_with('\n');
        if is_alone {
            // Replace the lines below, up to the first blank line.
            let old = after.find("\n\n").unwrap_or(after.trim_end().len());
            write!(synced, "{before}{mark}\n{}", value.trim_end())?;
            rest = &after[old..];
        } else {
            // Replace the number before the comment.
            let words = before
                .trim_end_matches(|letter: char| letter.is_ascii_digit() || letter == ',' || letter == '.');
            ensure!(words.len() < before.len(), "{}: {mark} must directly follow a number", place());
            let words = words.strip_suffix('−').unwrap_or(words);
            write!(synced, "{words}{value}{mark}")?;
            rest = after;
        }
    }
    Ok(synced + rest)
}

/// The values of all names.
struct Values<'a> {
    root: &'a Path,
    corpus: OnceCell<Vec<Entry>>,
    printed: Vec<Printed>,
}

impl Values<'_> {
    /// The value of a name, such as `checks` or `points 1-6`.
    fn get(&self, name: &str) -> Result<String> {
        if name == "decks" {
            return self.decks();
        }
        if let Some((file, words)) = name.split_once(": ") {
            return printed::number(&self.printed, file, words);
        }
        // Divide `points 1-6` into its words and its stages.
        let numbered =
            name.rsplit_once(' ').filter(|(_, last)| last.starts_with(|one: char| one.is_ascii_digit()));
        let (words, stages) = match numbered {
            Some((words, stages)) => {
                (words, raykata::course::stages_of(stages).map_err(|why| anyhow::anyhow!("{name:?}: {why}"))?)
            }
            None => (name, STAGES.iter().map(|(stage, _)| *stage).collect()),
        };
        let asked = |stage: u8| stages.contains(&stage);
        let checks = || STAGES.iter().filter(|(stage, _)| asked(*stage)).flat_map(|(_, checks)| *checks);
        let is_bonus = |check: &&Check| entry_of(check).level() == Level::Bonus;
        let is_core = |check: &&Check| entry_of(check).level() == Level::Core;
        let points = |check: &Check| entry_of(check).points as usize;
        let entries = |keep: fn(&Claim) -> bool| -> Result<usize> {
            Ok(self.corpus()?.iter().filter(|entry| asked(entry.stage) && keep(&entry.claim)).count())
        };
        let value = match words {
            "stages" => stages.len(),
            "functions" => self.functions(asked)?,
            "core functions" => self.core_functions()?,
            // What a course counts, and what it counts apart.
            "checks" => checks().filter(|check| !is_bonus(check)).count(),
            "points" => checks().filter(|check| !is_bonus(check)).map(points).sum(),
            "bonus checks" => checks().filter(is_bonus).count(),
            "bonus points" => checks().filter(is_bonus).map(points).sum(),
            "core checks" => checks().filter(is_core).count(),
            "core points" => checks().filter(is_core).map(points).sum(),
            "lines" => self.effort(asked)?[0],
            "words" => self.effort(asked)?[1],
            "hours" => hours(self.effort(asked)?),
            "all checks" => checks().count(),
            // The checks whose hidden inputs are the public ones in another frame.
            "turned checks" => checks().filter(is_turned).count(),
            "turned points" => checks().filter(is_turned).filter(|check| !is_bonus(check)).map(points).sum(),
            "turned bonus points" => checks().filter(is_turned).filter(is_bonus).map(points).sum(),
            // The corpus.
            "mistakes" => entries(|claim| matches!(claim, Claim::Wrong { .. }))?,
            "unnamed mistakes" => entries(|claim| matches!(claim, Claim::Wrong { is_unknown: true, .. }))?,
            "correct solutions" => entries(|claim| *claim == Claim::Right)?,
            #[cfg(target_os = "linux")]
            "attacks" => crate::attacks::load(self.root)?.len(),
            _ => bail!("no number has the name {words:?}; the names are in tests/author/src/numbers.rs"),
        };
        Ok(thousands(value))
    }

    /// The files of these stages.
    fn exercises(&self, asked: impl Fn(u8) -> bool) -> Result<Vec<Exercise>> {
        let mut exercises = exercises::exercises(self.root)?;
        exercises.retain(|exercise| {
            let file = exercise.path.file_stem().unwrap_or_default().to_string_lossy();
            exercises::stage_of(&file).is_some_and(&asked)
        });
        Ok(exercises)
    }

    /// The number of functions that students write in these stages: those whose stub is a `todo!`.
    fn functions(&self, asked: impl Fn(u8) -> bool) -> Result<usize> {
        let exercises = self.exercises(asked)?;
        let stubs = exercises.iter().flat_map(|exercise| exercise.stub.lines());
        Ok(stubs.filter(|line| line.trim_start().starts_with("todo!(")).count())
    }

    /// The number of functions that the core of stages 1 to 6 needs: the textbook of the tests writes them, and no others.
    fn core_functions(&self) -> Result<usize> {
        let mut functions = 0;
        for file in fs::read_dir(self.root.join("solutions/tests/textbook"))? {
            let text = fs::read_to_string(file?.path())?;
            functions += text.lines().filter(|line| line.starts_with("pub fn ")).count();
        }
        Ok(functions)
    }

    /// The lines of code of the reference in these stages, and the words of the doc comments that students read.
    fn effort(&self, asked: impl Fn(u8) -> bool) -> Result<[usize; 2]> {
        let (mut lines, mut words) = (0, 0);
        for exercise in self.exercises(asked)? {
            words += doc_words(&exercise.stub);
            let solution =
                self.root.join("solutions/src").join(exercise.path.file_name().unwrap_or_default());
            lines += code_lines(&fs::read_to_string(solution)?);
        }
        Ok([lines, words])
    }

    fn corpus(&self) -> Result<&[Entry]> {
        if self.corpus.get().is_none() {
            let _ = self.corpus.set(entry::read_all(self.root)?);
        }
        Ok(self.corpus.get().map_or(&[], Vec::as_slice))
    }

    /// The table of all decks, with their sums: the minutes from the first lines of each deck, the rest from the stage.
    fn decks(&self) -> Result<String> {
        let mut table =
            "| deck | minutes | students write | checks, and bonus | points, and bonus | of the core | lines | hours |\n\
                         |---|---|---|---|---|---|---|---|\n"
                .to_owned();
        let mut minutes = 0;
        for deck in decks(&self.root.join("slides"))? {
            let its_minutes = deck.minutes().with_context(|| format!("{} has no `minutes`", deck.name))?;
            minutes += its_minutes;
            let of_stage = match deck.stage().filter(|stage| *stage > 0) {
                Some(stage) => self.of_stages(&format!(" {stage}"))?,
                None => Default::default(),
            };
            table += &row(format!("[{}]({}.md)", deck.title(), deck.name), its_minutes, of_stage);
        }
        Ok(table + &row("**all**".to_owned(), minutes, self.of_stages("")?))
    }

    /// The cells of the table of decks for some stages: functions, checks, points, those of the core, lines and hours.
    fn of_stages(&self, stages: &str) -> Result<[String; 6]> {
        let with_bonus = |what: &str| -> Result<String> {
            let bonus = self.get(&format!("bonus {what}{stages}"))?;
            let bonus = if bonus == "0" { String::new() } else { format!(", and {bonus}") };
            Ok(self.get(&format!("{what}{stages}"))? + &bonus)
        };
        let [functions, core, lines, hours] =
            ["functions", "core points", "lines", "hours"].map(|what| self.get(&format!("{what}{stages}")));
        let functions = format!("{} functions", functions?);
        Ok([functions, with_bonus("checks")?, with_bonus("points")?, core?, lines?, hours?])
    }
}

/// The lines of code before the tests, without comments and imports.
fn code_lines(text: &str) -> usize {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default().lines().map(str::trim_start);
    code.filter(|line| !line.is_empty() && !line.starts_with("//") && !line.starts_with("use ")).count()
}

/// The words of the doc comments.
fn doc_words(text: &str) -> usize {
    let lines = text.lines().map(str::trim_start);
    let docs = lines.filter_map(|line| line.strip_prefix("///").or_else(|| line.strip_prefix("//!")));
    docs.map(|line| line.split_whitespace().count()).sum()
}

/// The hours that exercises take, by two assumptions: 1,500 words are read, and 30 lines of the reference written, in an hour.
fn hours([lines, words]: [usize; 2]) -> usize {
    (50 * lines + words).div_ceil(1500)
}

fn entry_of(check: &Check) -> rubric::CheckEntry {
    rubric::entry(check.stage, check.name)
}

fn is_turned(check: &&Check) -> bool {
    check.symmetries.turn_public_inputs()
}

/// A row of a table.
fn row(title: String, minutes: usize, of_stage: [String; 6]) -> String {
    let cells = [title, thousands(minutes)].into_iter().chain(of_stage);
    let cells = cells.map(|cell| if cell.is_empty() { "| ".to_owned() } else { format!("| {cell} ") });
    cells.collect::<String>() + "|\n"
}

/// A number with commas between its thousands: `1,569`.
fn thousands(number: usize) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", thousands(number / 1000), number % 1000),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn synced(text: &str) -> Result<String> {
        rewrite("a.md", text, |name| match name {
            "all" => Ok("1,234".to_owned()),
            "table" => Ok("| a |\n|---|\n".to_owned()),
            _ => bail!("no number has the name {name:?}"),
        })
    }

    #[test]
    fn a_named_number_is_written_and_other_text_stays() {
        assert_eq!(
            synced("of 7<!--=all--> and 1,111<!--=all-->, 8\n").unwrap(),
            "of 1,234<!--=all--> and 1,234<!--=all-->, 8\n"
        );
        let current = "**1,234<!--=all--> a**\n\n<!--=table-->\n| a |\n|---|\n\nend 5 <!-- a note -->\n";
        assert_eq!(synced(current).unwrap(), current);
        assert_eq!(synced(&current.replace("| a |\n", "| b |\n| c |\n")).unwrap(), current);
        assert_eq!(synced("<!--=table-->\n\nend\n").unwrap(), "<!--=table-->\n| a |\n|---|\n\nend\n");
        assert_eq!(synced("<!--=table-->\n| b |\n").unwrap(), "<!--=table-->\n| a |\n|---|\n");
    }

    #[test]
    fn errors_say_file_and_line() {
        let error = |text: &str| format!("{:#}", synced(text).unwrap_err());
        assert_eq!(error("\n\n7<!--=al-->"), "a.md:3: no number has the name \"al\"");
        assert_eq!(error("\nseven <!--=all-->"), "a.md:2: <!--=all--> must directly follow a number");
        assert_eq!(error("7<!--=all"), "a.md:1: `<!--=` is never closed");
    }

    /// No stage has more than twice as many points per line of the reference as another one.
    #[test]
    fn points_follow_the_lines_of_the_reference() {
        let root = grader::kits::root().unwrap();
        let values = Values { root: &root, corpus: OnceCell::new(), printed: Vec::new() };
        let get =
            |what: &str, stage: u8| values.get(&format!("{what} {stage}")).unwrap().parse::<f64>().unwrap();
        let per_line: Vec<f64> =
            STAGES.iter().map(|(stage, _)| get("points", *stage) / get("lines", *stage)).collect();
        let least = per_line.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(per_line.iter().all(|points| *points <= 2.0 * least), "{per_line:.2?}");
    }

    #[test]
    fn numbers_of_stages_add_up() {
        let root = grader::kits::root().unwrap();
        let values = Values { root: &root, corpus: OnceCell::new(), printed: Vec::new() };
        let get = |name: &str| -> usize { values.get(name).unwrap().replace(',', "").parse().unwrap() };
        for name in [
            "checks",
            "points",
            "functions",
            "bonus points",
            "mistakes",
            "correct solutions",
            "turned points",
        ] {
            assert_eq!(get(&format!("{name} 1-5")) + get(&format!("{name} 6-12")), get(name), "{name}");
        }
        assert_eq!(get("checks") + get("bonus checks"), get("all checks"));
        assert!(get("turned checks") < get("all checks"));
        let error = |name: &str| format!("{:#}", values.get(name).unwrap_err());
        assert!(error("points 13").contains("there is no stage 13"), "{}", error("points 13"));
        assert!(error("pints").contains("no number has the name \"pints\""));
    }
}
