//! Reads course files and language files. Every error says where in the file it is, and what to do.

use super::score::Level;
use super::stage::{CheckEntry, PLAIN, Stage};
use super::{CheckChange, Course, Moment, StageChange, TEXTS};
use crate::files::error::LoadError;
use crate::files::scene::Limits;
use crate::files::scene::reader::{Source, Table, Value};
use std::path::Path;
use toml::de::DeValue;

/// Most points of a check or a stage.
const MOST_POINTS: u32 = 10_000;

/// Reads a course file. The texts of its language are not in it: see [`parse_language`].
///
/// # Errors
///
/// If the text is not TOML, if a key or a check is unknown, or if a value is wrong. The error names line and column.
pub fn parse(file: &Path, text: &str) -> Result<Course, LoadError> {
    read(file, text, false)
}

/// Reads a language file: the titles, slides, hints and texts of another language.
///
/// # Errors
///
/// As in [`parse`].
pub fn parse_language(file: &Path, text: &str) -> Result<Course, LoadError> {
    read(file, text, true)
}

fn read(file: &Path, text: &str, is_language: bool) -> Result<Course, LoadError> {
    let source = Source::new(file, text, Limits::default());
    let document = source.document()?;
    let mut known: Vec<&str> = PLAIN.keys().map(String::as_str).collect();
    known.extend(if is_language { &["texts"][..] } else { &["title", "stages", "core_only", "language"] });
    let name = if is_language { "the language file" } else { "the course file" };
    let root = Table::root(&source, name, &document, &known)?;

    let mut course = Course::default();
    for value in root.values() {
        match value.key {
            "title" => course.title = line(value)?,
            "stages" => course.stages = stages_of(value.text()?).map_err(|why| value.error(why))?,
            "core_only" => course.core_only = value.truth()?,
            "language" => course.language = Some(file_name(value)?),
            "texts" => {
                let keys: Vec<&str> = TEXTS.iter().map(|(key, _)| *key).collect();
                for value in value.table(&keys)?.values() {
                    course.texts.insert(value.key.to_owned(), value.text()?.trim_end().to_owned());
                }
            }
            name => {
                let Some(stage) = PLAIN.get(name) else { continue };
                let number = name.trim_start_matches("stage").parse().unwrap_or_default();
                course
                    .changes
                    .insert(name.to_owned(), stage_change(value, number, stage, &course, is_language)?);
                if let Some(due) = value.any_table()?.get("due") {
                    course.due.insert(number, moment(due)?);
                }
            }
        }
    }
    Ok(course)
}

/// Reads a list of stages such as `1-4,10`, as `--stages` does.
///
/// # Errors
///
/// If it is not such a list, or if a stage does not exist.
pub fn stages_of(text: &str) -> Result<Vec<u8>, String> {
    let mut stages = Vec::new();
    for part in text.split(',') {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let ends = [first, last].map(|text| (text, text.trim().parse::<u8>()));
        if let Some((text, _)) = ends.iter().find(|(_, number)| number.is_err()) {
            return Err(format!("`{}` is not a stage number", text.trim()));
        }
        let [first, last] = ends.map(|(_, number)| number.unwrap_or_default());
        stages.extend(first..=last);
    }
    stages.sort_unstable();
    stages.dedup();
    if stages.is_empty() {
        return Err(format!("`{text}` names no stage"));
    }
    match stages.iter().find(|stage| !PLAIN.contains_key(&format!("stage{stage}"))) {
        Some(unknown) => Err(format!("there is no stage {unknown}; there are stages 1 to {}", PLAIN.len())),
        None => Ok(stages),
    }
}

fn stage_change(
    value: Value<'_>,
    number: u8,
    stage: &Stage,
    course: &Course,
    is_language: bool,
) -> Result<StageChange, LoadError> {
    let known: &[&str] =
        if is_language { &["title", "checks"] } else { &["title", "points", "due", "checks"] };
    let mut change = StageChange::default();
    let mut points = None;
    for value in value.table(known)?.values() {
        match value.key {
            "title" => change.title = Some(line(value)?),
            "points" => points = Some((value, value.whole(0..=MOST_POINTS)?)),
            "checks" => {
                let names: Vec<&str> = stage.checks.keys().map(String::as_str).collect();
                for value in value.any_table()?.values() {
                    if !names.contains(&value.key) {
                        let what = format!("check of stage {number}");
                        let help = format!("`cargo run -- list {number}` shows the names of the checks");
                        return Err(value.source.unknown(value.span(), &what, value.key, &names).help(help));
                    }
                    change.checks.insert(value.key.to_owned(), check_change(value, is_language)?);
                }
            }
            _ => {}
        }
    }
    // Each check that counts keeps a point of the stage's.
    if let Some((value, points)) = points {
        let counts = |(name, check): &(&String, &CheckEntry)| {
            let points = if course.counts(check) { check.points } else { 0 };
            check.level() != Level::Bonus
                && change.checks.get(*name).and_then(|check| check.points).unwrap_or(points) > 0
        };
        let n = stage.checks.iter().filter(counts).count();
        if n == 0 {
            return Err(
                value.error("no check of the stage has points, so the points of the stage cannot be divided")
            );
        }
        if (points as usize) < n {
            return Err(value.error(format!("{points} points cannot be divided among {n} checks")).help(
                format!("give {n} points or more, or set `points = 0` for checks that must not count"),
            ));
        }
        change.points = Some(points);
    }
    Ok(change)
}

fn check_change(value: Value<'_>, is_language: bool) -> Result<CheckChange, LoadError> {
    let known: &[&str] =
        if is_language { &["title", "slide", "hints"] } else { &["points", "title", "slide", "hints"] };
    let mut change = CheckChange::default();
    for value in value.table(known)?.values() {
        match value.key {
            "points" => change.points = Some(value.whole(0..=MOST_POINTS)?),
            "title" => change.title = Some(line(value)?),
            "slide" => change.slide = Some(line(value)?),
            _ => {
                let wanted = "a list of three hints; an empty one stays English";
                let hints = value.list(wanted)?;
                let [first, second, third] = hints[..] else { return Err(value.wrong(wanted)) };
                for (hint, value) in change.hints.iter_mut().zip([first, second, third]) {
                    *hint = Some(value.text()?.trim().to_owned()).filter(|text| !text.is_empty());
                }
            }
        }
    }
    Ok(change)
}

/// A text of one line that is not empty.
fn line(value: Value<'_>) -> Result<String, LoadError> {
    let text = value.text()?.trim();
    match text.is_empty() || text.contains(char::is_control) {
        true => Err(value.error(format!("{} must be one line of text", value.name()))),
        false => Ok(text.to_owned()),
    }
}

/// The name of a file in the folder of the course file.
fn file_name(value: Value<'_>) -> Result<String, LoadError> {
    let name = line(value)?;
    let is_plain = !name.contains(['/', '\\']) && !name.starts_with('.') && name.ends_with(".toml");
    if !is_plain {
        let message =
            format!("{} must be the name of a file such as \"german.toml\", without a folder", value.name());
        return Err(value.error(message).help("put the language file beside the course file"));
    }
    Ok(name)
}

fn moment(value: Value<'_>) -> Result<Moment, LoadError> {
    let wanted =
        "a date without quotes, such as 2026-11-02 (the end of that day) or 2026-11-02T23:59:00+01:00";
    match value.item() {
        DeValue::Datetime(datetime) => Moment::new(datetime).ok_or_else(|| value.wrong(wanted)),
        _ => Err(value.wrong(wanted)),
    }
}
