//! What commands print, kept in `slides/printed` for the numbers and quotations in documents.
//!
//! The first line of a file is its command, as one types it, perhaps with ` | head -8` for its first lines; the other lines are
//! what it prints, without times.
//! `author sync --printed` runs all commands again. A comment names a number of a file: `3.5<!--=stage3: per ray #2-->` is the
//! second number of the first line that begins with `per ray` or else contains these words, and
//! `9,721<!--=cells_stage9: octree / nodes-->` stands in the row `octree` of the column `nodes`. A block of text below
//! `<!-- from: COMMAND -->` quotes lines of the file with this command.

use crate::corpus::verdict::one_line;
use anyhow::{Context, Result, bail, ensure};
use grader::files_below::files_below;
use grader::grade::Shard;
use grader::report::write_file;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// The folder of the files.
const FOLDER: &str = "slides/printed";

/// Headings of columns that hold times, which differ from run to run.
const TIMES: [&str; 10] =
    ["build s", "ns/ray", "ns", "share of time", "seconds", "ms", "times", "build", "frame", "brute force"];

/// Units of times.
const UNITS: [&str; 7] = ["ns", "µs", "ms", "s", "min", "h", "days"];

/// What a command printed.
pub struct Printed {
    /// The file without its ending.
    name: String,
    command: String,
    text: String,
}

/// Reads all files.
pub fn read_all(root: &Path) -> Result<Vec<Printed>> {
    let folder = root.join(FOLDER);
    let mut files = if folder.is_dir() { files_below(&folder, "", &|_| true)? } else { Vec::new() };
    files.sort();
    let read = |file: &String| {
        let all =
            fs::read_to_string(folder.join(file)).with_context(|| format!("cannot read {FOLDER}/{file}"))?;
        let (command, text) = all.split_once('\n').unwrap_or((&all, ""));
        let name =
            file.strip_suffix(".txt").with_context(|| format!("{FOLDER}/{file} must end with .txt"))?;
        Ok(Printed { name: name.to_owned(), command: command.trim().to_owned(), text: text.to_owned() })
    };
    files.iter().map(read).collect()
}

/// Runs the command of each file. Returns a line for each file that differs; with `keep`, writes no file.
///
/// # Errors
///
/// If a command fails.
pub fn run_all(root: &Path, keep: bool, shard: Option<Shard>) -> Result<Vec<String>> {
    let mut different = Vec::new();
    // With a part, run each command whose number belongs to it.
    for (number, Printed { name, command, text }) in read_all(root)?.into_iter().enumerate() {
        if shard.is_some_and(|shard| number % shard.of as usize + 1 != shard.index as usize) {
            continue;
        }
        // Keep the first lines only, if the command ends so.
        let (run, most_lines) = command.split_once(" | head -").unwrap_or((&command, "1000000"));
        let most_lines =
            most_lines.parse().with_context(|| format!("{FOLDER}/{name}.txt: `head -{most_lines}`"))?;
        let words = run.strip_prefix("cargo run ");
        let words = words
            .with_context(|| format!("{FOLDER}/{name}.txt: the first line is no `cargo run` command"))?;
        let output = Command::new(env!("CARGO"))
            .args(["run", "--quiet"])
            .args(words.split_whitespace())
            .current_dir(root)
            .stdin(Stdio::null())
            .output()
            .context("cargo cannot be started")?;
        let said = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "{FOLDER}/{name}.txt: `{command}` fails:\n{}", said.trim_end());
        let now = String::from_utf8_lossy(&output.stdout);
        let now = without_times(&now.lines().take(most_lines).collect::<Vec<_>>().join("\n"));
        // Widths of columns depend on times as well.
        if one_line(&now) == one_line(&text) {
            continue;
        }
        let lines = |text: &str| text.lines().map(one_line).collect::<Vec<_>>();
        let (yours, expected) = (lines(&text), lines(&now));
        let same = yours.iter().zip(&expected).take_while(|(yours, expected)| yours == expected).count();
        let line = |lines: Vec<String>| lines.into_iter().nth(same).unwrap_or_default();
        different.push(format!(
            "  {FOLDER}/{name}.txt:{}: yours `{}`, expected `{}`",
            same + 2,
            line(yours),
            line(expected),
        ));
        if !keep {
            let file = root.join(FOLDER).join(format!("{name}.txt"));
            write_file(&file, format!("{command}\n{now}").as_bytes())?;
        }
    }
    Ok(different)
}

/// The number with a name such as `stage3: per ray #2`.
pub fn number(all: &[Printed], file: &str, words: &str) -> Result<String> {
    let printed = all.iter().find(|printed| printed.name == file);
    let printed = printed.with_context(|| format!("there is no {FOLDER}/{file}.txt"))?;
    let (place, nth) = match words.rsplit_once(" #") {
        Some((place, nth)) => {
            (place, nth.parse::<usize>().ok().filter(|nth| *nth > 0).context("a number follows `#`")?)
        }
        None => (words, 1),
    };
    let found = match place.split_once(" / ") {
        Some((row, column)) => cell(&printed.text, row, column),
        None => line(&printed.text, place).map(|line| line.replacen(&one_line(place), "", 1)),
    };
    let found = found
        .with_context(|| format!("{FOLDER}/{file}.txt has no `{place}`; `{}` makes it", printed.command))?;
    let number = numbers(&found).into_iter().nth(nth - 1);
    number.with_context(|| {
        format!("{FOLDER}/{file}.txt: `{found}` has fewer than {nth} numbers that are no times")
    })
}

/// Returns the text in which blocks below `<!-- from: cargo … -->` have the lines of the files.
///
/// # Errors
///
/// If no file has this command, or if it prints no such line.
pub fn quote(path: &str, text: &str, all: &[Printed]) -> Result<String> {
    let mut quoted = String::new();
    let mut source: Option<(&Printed, usize)> = None;
    let mut command = None;
    for (line, number) in text.lines().zip(1..) {
        match (command.take(), line) {
            (_, "```") => source = None,
            (Some(command), "```text") => {
                let printed = all.iter().find(|printed| printed.command == command);
                let printed = printed.with_context(|| {
                    format!("{path}:{number}: no file of {FOLDER} begins with `{command}`: write one with this line")
                })?;
                source = Some((printed, 0));
            }
            _ => {}
        }
        let mut line = line;
        command = line.strip_prefix("<!-- from: ").and_then(|rest| rest.strip_suffix(" -->"));
        command = command.filter(|command| command.starts_with("cargo "));
        if let Some((printed, from)) = &mut source
            && line != "```text"
            && !line.is_empty()
        {
            let rest = printed.text.lines().skip(*from);
            let Some((skipped, found)) =
                rest.enumerate().find(|(_, other)| has_shape(line, other) || is_shortened(line, other))
            else {
                bail!(
                    "{path}:{number}: `{}` prints no line like `{line}`, or not in this order",
                    printed.command
                );
            };
            *from += skipped + 1;
            // A line that was shortened stays, if it is right.
            if has_shape(line, found) && one_line(found) != one_line(line) {
                line = found;
            }
        }
        quoted += line;
        quoted.push('\n');
    }
    Ok(quoted)
}

/// Whether two lines differ at most in numbers, in times that are left out, and in spaces.
fn has_shape(quoted: &str, printed: &str) -> bool {
    let of_number = |letter: char| letter.is_ascii_digit() || ",.-…".contains(letter);
    let shape = |line: &str| -> Vec<String> {
        let words = line.split_whitespace().map(|word| {
            match word.contains(of_number) && !word.contains(char::is_alphabetic) {
                true => "#".to_owned() + word.trim_matches(of_number),
                false => word.to_owned(),
            }
        });
        words.collect()
    };
    shape(quoted) == shape(printed)
}

/// Whether a quoted line is `printed` with `…` in place of some of its text.
fn is_shortened(quoted: &str, printed: &str) -> bool {
    let (quoted, printed) = (one_line(quoted), one_line(printed));
    let mut parts = quoted.split('…');
    let mut rest = parts.next().and_then(|first| printed.strip_prefix(first.trim_end()));
    for part in parts {
        rest = rest.and_then(|rest| rest.find(part.trim()).map(|at| &rest[at..]));
    }
    rest.is_some() && quoted.contains('…')
}

/// The first line that begins with `words`, or else the first that contains them, with single spaces.
fn line(text: &str, words: &str) -> Option<String> {
    let words = one_line(words);
    let lines = || text.lines().map(one_line);
    lines().find(|line| line.starts_with(&words)).or_else(|| lines().find(|line| line.contains(&words)))
}

/// The cell of a row below the heading of a column.
fn cell(text: &str, row: &str, column: &str) -> Option<String> {
    let mut lines = text.lines();
    let end = lines.find_map(|line| parts(line).into_iter().find(|part| part.text == column))?.end;
    // A long name stands on a line of its own, above its numbers.
    let named = lines.skip_while(|line| parts(line).first().is_none_or(|part| part.text != row));
    let mut cells = named.take(2).flat_map(parts);
    cells.find(|part| part.end == end).map(|part| part.text)
}

/// A part of a line, with the columns of its first letter and behind its last one.
struct Part {
    text: String,
    start: usize,
    end: usize,
}

/// The parts of a line: words with single spaces between them. A wide number in a table also begins a part one space behind
/// the number or the unit `B` of the column before. A `*` at the end, which marks the best value, does not count.
fn parts(line: &str) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut at = 0;
    for word in line.split(' ') {
        let (start, end) = (at, at + word.chars().count());
        at = end + 1;
        match parts.last_mut() {
            _ if word.is_empty() => {}
            Some(last)
                if last.end + 1 == start && !(begins_number(word) && last.text.ends_with(is_end_of_cell)) =>
            {
                last.text += &format!(" {word}");
                last.end = end;
            }
            _ => parts.push(Part { text: word.to_owned(), start, end }),
        }
    }
    for part in &mut parts {
        if part.text.ends_with('*') {
            part.text.pop();
            part.end -= 1;
        }
    }
    parts
}

fn is_end_of_cell(letter: char) -> bool {
    letter.is_ascii_digit() || letter == '*' || letter == 'B'
}

fn begins_number(word: &str) -> bool {
    word.trim_start_matches('-').starts_with(|first: char| first.is_ascii_digit())
}

/// The numbers of a text in their order, such as `1,234`, `3.5` and `−2`.
fn numbers(text: &str) -> Vec<String> {
    let is_part = |letter: char| letter.is_ascii_digit() || letter == ',' || letter == '.';
    let words = text.split(|letter: char| !is_part(letter) && letter != '-');
    let number = |word: &str| {
        let digits = word
            .trim_start_matches('-')
            .trim_matches(|letter| letter == ',' || letter == '.' || letter == '-');
        let sign = if word.starts_with('-') { "−" } else { "" };
        digits.starts_with(|first: char| first.is_ascii_digit()).then(|| format!("{sign}{digits}"))
    };
    words.filter_map(number).collect()
}

/// What a command printed with `…` in place of each time.
fn without_times(text: &str) -> String {
    let mut times = Vec::new();
    let mut clean = String::new();
    for line in text.lines() {
        if line.is_empty() {
            times.clear();
        }
        let mut letters: Vec<char> = line.trim_end().chars().collect();
        let mut blank = |start: usize, end: usize| {
            for letter in &mut letters[start..end] {
                *letter = ' ';
            }
            letters[end - 1] = '…';
            // A mark of the best time.
            if letters.get(end) == Some(&'*') {
                letters[end] = ' ';
            }
        };
        let cells = parts(line);
        for cell in cells.iter().filter(|cell| times.contains(&cell.end) && begins_number(&cell.text)) {
            blank(cell.start, cell.end);
        }
        // `1e-14` may be a heading.
        if !line.split(' ').any(|word| begins_number(word) && !word.contains('e')) {
            times.extend(TIMES.iter().flat_map(|heading| ends(line, heading)));
        }
        // A number before a unit of time.
        let mut at = 0;
        let words: Vec<&str> = line.split(' ').collect();
        for (index, word) in words.iter().enumerate() {
            let end = at + word.chars().count();
            let unit = words.get(index + 1).map_or("", |unit| unit.trim_end_matches([',', '.', ';', ')']));
            if begins_number(word.trim_start_matches('('))
                && UNITS.contains(&unit)
                && !times.contains(&(end + 1 + unit.len()))
            {
                blank(at, end);
            }
            at = end + 1;
        }
        clean.extend(letters);
        clean.push('\n');
    }
    clean
}

/// The columns behind `words` in a line.
fn ends(line: &str, words: &str) -> Vec<usize> {
    let is_edge = |letter: Option<char>| letter.is_none_or(|letter| letter == ' ');
    let found = line.match_indices(words).map(|(at, _)| (&line[..at], &line[at + words.len()..]));
    let whole =
        found.filter(|(before, behind)| is_edge(before.chars().last()) && is_edge(behind.chars().next()));
    whole.map(|(before, _)| before.chars().count() + words.chars().count()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "stage9.toml
                     build s   memory     nodes  ns/ray
grid                   0.002*  167 kB*   17,689  34,399
a long name of a row
                       0.010  12.3 MB 1,245,184 354,234*

costs                  its rays    share of time
  motion                 -1,518             38 %
  per ray          5.7 box tests, 169 ns (all threads)
";

    fn printed() -> Vec<Printed> {
        let text = without_times(TABLE);
        vec![Printed { name: "a".to_owned(), command: "cargo run -- a".to_owned(), text }]
    }

    #[test]
    fn numbers_are_found_by_row_and_column_or_by_words_and_times_are_none() {
        for (words, expected) in [
            ("grid / nodes", "17,689"),
            ("grid / memory", "167"),
            ("a long name of a row / nodes", "1,245,184"),
            ("motion / its rays", "−1,518"),
            ("per ray", "5.7"),
            ("box tests", "5.7"),
        ] {
            assert_eq!(number(&printed(), "a", words).unwrap(), expected, "{words}");
        }
        for words in [
            "grid / ns/ray",
            "grid / build s",
            "motion / share of time",
            "per ray #2",
            "grids",
            "grid / cells",
            "grid #0",
        ] {
            assert!(number(&printed(), "a", words).is_err(), "{words}");
        }
        let slower =
            TABLE.replace("0.002* ", "0.013  ").replace("354,234*", "  9,234 ").replace("38 %", " 5 %");
        assert_eq!(one_line(&without_times(&slower)), one_line(&printed()[0].text));
    }

    #[test]
    fn a_stale_quotation_is_written_again_and_another_line_is_refused() {
        let quoted = |line: &str| format!("a\n<!-- from: cargo run -- a -->\n```text\n{line}\n```\n{line}\n");
        let synced = |line: &str| quote("a.md", &quoted(line), &printed()).map_err(|why| why.to_string());
        let right = "  motion                 -1,518                …";
        assert_eq!(synced(right).unwrap(), quoted(right));
        let stale = synced("  motion   -1,517  …").unwrap();
        assert!(stale.contains(&format!("text\n{right}\n```\n  motion   -1,517")), "{stale}");
        assert_eq!(synced("motion …").unwrap(), quoted("motion …"));
        let refused = synced("  lens  7  …").unwrap_err();
        assert!(refused.starts_with("a.md:4: `cargo run -- a` prints no line like"), "{refused}");
    }
}
