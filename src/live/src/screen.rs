//! The rows of the screen, from the state of the program. Meaning is never in the colour alone.

use crate::app::{App, Page, Phase};
use crate::course::Check;
use crate::pixels::Rgb;
use crossterm::style::Color;
use live::compiler::CompilerError;
use raykata_cli::verdicts::Verdict;

/// The colour of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tone {
    /// The colour of the terminal.
    Plain,
    /// Something passes.
    Good,
    /// Something fails.
    Bad,
    /// Something beside the point.
    Quiet,
}

/// A row of the screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Row {
    /// Words.
    Words(Tone, String),
    /// A row of a picture, each character with the colours of its upper and its lower half.
    Pixels(Vec<(Rgb, Rgb)>),
}

/// What the terminal can show.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Whether it shows more than ASCII.
    pub has_unicode: bool,
    /// Whether it shows 24-bit colours. Otherwise pictures have the 216 colours that every terminal with colours has.
    pub has_true_colour: bool,
}

impl Look {
    /// Asks the variables of the environment by which terminals and users say what they can show.
    pub fn of_environment() -> Look {
        let value = |name: &str| std::env::var(name).unwrap_or_default().to_lowercase();
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].map(value).into_iter().find(|name| !name.is_empty());
        let is_utf8 = locale.is_some_and(|name| name.contains("utf-8") || name.contains("utf8"));
        let has_colours = ["truecolor", "24bit"].contains(&value("COLORTERM").as_str());
        Look { has_unicode: is_utf8 || cfg!(windows), has_true_colour: has_colours }
    }

    /// The colour of a pixel, or the nearest one of the cube of 6 × 6 × 6 colours of a terminal with 256.
    pub fn colour(self, [r, g, b]: Rgb) -> Color {
        let level = |channel: u8| (channel / 51) + u8::from(channel % 51 > 25);
        match self.has_true_colour {
            true => Color::Rgb { r, g, b },
            false => Color::AnsiValue(16 + 36 * level(r) + 6 * level(g) + level(b)),
        }
    }

    /// The sign of a check: passed, failed, not written, not known.
    fn sign(self, check: &Check) -> char {
        match (&check.verdict, self.has_unicode) {
            (Some(Verdict::Passed), true) => '✓',
            (Some(Verdict::Passed), false) => '+',
            (Some(Verdict::Failed(_)), true) => '✗',
            (Some(Verdict::Failed(_)), false) => 'x',
            (Some(Verdict::NotWritten { .. }), true) => '·',
            (Some(Verdict::NotWritten { .. }), false) => '.',
            (None, _) => '?',
        }
    }

    /// The text in signs that the terminal has. What has no other sign becomes a question mark.
    fn plain(self, text: &str) -> String {
        if self.has_unicode {
            return text.to_owned();
        }
        let other = |sign: char| match sign {
            '·' | '×' => '*',
            '≤' | '⟨' => '<',
            '≥' | '⟩' => '>',
            '…' => '.',
            '–' | '—' | '−' => '-',
            '±' => '~',
            '²' => '2',
            '³' => '3',
            'θ' => 't',
            'γ' => 'g',
            'β' => 'b',
            'π' => 'p',
            _ if sign.is_ascii() => sign,
            _ => '?',
        };
        text.chars().map(other).collect()
    }
}

/// The keys of a check and of the picture.
const KEYS: &str = "h hint  t try  n next  p previous  l list  o open  r reset  e more  v picture  q quit";
/// The keys of the list.
const LIST_KEYS: &str = "enter go there  / search  n next  p previous  esc back  q quit";

/// The keys while a word is typed.
const TYPING_KEYS: &str = "type a part of a name or of a title  up/down choose  enter go there  esc back";

/// The rows of the screen, at most as many as the terminal has.
pub fn rows(app: &App, look: Look) -> Vec<Row> {
    let (columns, height) = app.size;
    let mut rows = head(app, look);
    let keys = match app.page {
        Page::List { is_typing: true, .. } => TYPING_KEYS,
        Page::List { .. } => LIST_KEYS,
        _ => KEYS,
    };
    let foot = [foot(app, columns), wrapped(keys, columns)].concat();
    let room = height.saturating_sub(rows.len() + foot.len() + 1);
    let body = match (&app.phase, &app.page) {
        (_, Page::List { word, is_typing, at }) => list(app, look, word, *is_typing, *at, room),
        (_, Page::Reset { file, name }) => question(file, name),
        (Phase::Errors(errors), _) => compiler(errors),
        (Phase::Broken(why), _) => lines(Tone::Bad, why, columns),
        (_, Page::Picture(Some(pixels))) => pixels.0.iter().cloned().map(Row::Pixels).collect(),
        (_, Page::Picture(None)) => vec![Row::Words(Tone::Quiet, "the picture is being rendered …".into())],
        (_, Page::Tried(text)) => lines(Tone::Plain, text, columns),
        (_, Page::Check { hints, unfolded }) => check(app, *hints, *unfolded, columns),
    };
    rows.extend(body.into_iter().take(room));
    rows.truncate(height.saturating_sub(foot.len()));
    while rows.len() + foot.len() < height {
        rows.push(Row::Words(Tone::Plain, String::new()));
    }
    rows.extend(foot.into_iter().map(|line| Row::Words(Tone::Quiet, line)));
    let fitted = |row| match row {
        Row::Words(tone, text) => Row::Words(tone, clipped(&look.plain(&text), columns, look)),
        Row::Pixels(cells) => Row::Pixels(cells.into_iter().take(columns).collect()),
    };
    rows.into_iter().take(height).map(fitted).collect()
}

/// The stage, its points, and a sign for each check.
fn head(app: &App, look: Look) -> Vec<Row> {
    let stage = app.stage();
    let (checks, points) = stage.earned();
    let name = format!("stage {} · {}", stage.number, stage.entry.title);
    let head = wrapped(&format!("{name:<38}  {checks}   {points}"), app.size.0);
    let signs = stage.checks.iter().enumerate().map(|(index, check)| match index == app.check {
        true => format!("[{}]", look.sign(check)),
        false => look.sign(check).to_string(),
    });
    let tone = if stage.is_done() { Tone::Good } else { Tone::Plain };
    let signs = [signs.collect(), String::new()].map(|line| Row::Words(Tone::Plain, line));
    head.into_iter().map(|line| Row::Words(tone, line)).chain(signs).collect()
}

/// The check: its law, its message, and the hints that were asked for.
fn check(app: &App, hints: usize, unfolded: bool, columns: usize) -> Vec<Row> {
    let check = app.check();
    let plain = |text: String| Row::Words(Tone::Plain, text);
    let mut rows = Vec::new();
    let mut law = |tone, word: &str| {
        let title = wrapped(&format!("{word}: {} ({})", check.entry.title, check.entry.worth()), columns);
        rows.extend(title.into_iter().map(|line| Row::Words(tone, line)));
        rows.push(Row::Words(Tone::Quiet, format!("  slides: {}", check.entry.slide)));
    };
    match &check.verdict {
        None => law(Tone::Plain, "? no verdict yet"),
        Some(Verdict::Passed) => {
            law(Tone::Good, "passes");
            let stage = app.stage();
            if stage.is_done() {
                rows.push(plain(String::new()));
                rows.push(Row::Words(Tone::Good, format!("Stage {} is done.", stage.number)));
                rows.push(plain(match app.stages.get(app.stage + 1) {
                    Some(next) => format!("n goes on to stage {}: {}", next.number, next.entry.file),
                    None => "It was the last stage.".into(),
                }));
                rows.push(plain("v shows the picture.".into()));
            }
        }
        Some(Verdict::NotWritten { task, place }) => {
            law(Tone::Plain, "not written yet");
            rows.push(plain(String::new()));
            rows.push(plain(place.clone()));
            rows.extend(wrapped(&format!("  {task}"), columns).into_iter().map(plain));
        }
        Some(Verdict::Failed(message)) => {
            law(Tone::Bad, "FAILS");
            // The head of the message is shown above, and its last lines are commands, for which there are keys.
            let is_key = |line: &str| {
                ["again:", "print:", "stuck:"].iter().any(|word| line.trim_start().starts_with(word))
            };
            for line in message.lines().skip(2).filter(|line| !is_key(line)) {
                match unfolded {
                    true => rows.extend(wrapped(line, columns).into_iter().map(plain)),
                    false => rows.push(plain(line.to_owned())),
                }
            }
        }
    }
    for (level, hint) in check.entry.hints.iter().enumerate().take(hints) {
        rows.push(plain(String::new()));
        let text = wrapped(&format!("hint {}: {hint}", level + 1), columns);
        rows.extend(text.into_iter().map(plain));
    }
    rows
}

/// The question before a reset.
fn question(file: &str, name: &str) -> Vec<Row> {
    let words = |text: String| Row::Words(Tone::Plain, text);
    vec![
        words(format!("Reset {name} in {file}?")),
        words(String::new()),
        words("It becomes the gap that it was before. The file as it is now is kept in out/.".into()),
        words("y resets it; any other key does not.".into()),
    ]
}

/// The errors of the compiler.
fn compiler(errors: &[CompilerError]) -> Vec<Row> {
    let count = if errors.len() == 1 { "1 error".into() } else { format!("{} errors", errors.len()) };
    let mut rows = vec![Row::Words(Tone::Bad, format!("does not compile: {count}"))];
    for error in errors {
        rows.push(Row::Words(Tone::Plain, String::new()));
        rows.push(Row::Words(Tone::Plain, error.what.clone()));
        rows.push(Row::Words(Tone::Plain, format!("  {}", error.place)));
        rows.push(Row::Words(Tone::Plain, format!("    {}", error.code)));
        rows.extend(error.notes.iter().map(|note| Row::Words(Tone::Quiet, format!("  {note}"))));
    }
    rows
}

fn lines(tone: Tone, text: &str, columns: usize) -> Vec<Row> {
    text.lines().flat_map(|line| wrapped(line, columns)).map(|line| Row::Words(tone, line)).collect()
}

/// The list of checks, with the chosen one in sight.
fn list(app: &App, look: Look, word: &str, is_typing: bool, at: usize, room: usize) -> Vec<Row> {
    let listed = app.listed(word);
    let room = room.saturating_sub(2).max(1);
    let first = at.saturating_sub(room / 2).min(listed.len().saturating_sub(room));
    let cursor = if is_typing { "_" } else { "" };
    let mut rows = vec![Row::Words(Tone::Plain, format!("{} checks   search: {word}{cursor}", listed.len()))];
    // Names are unique, and titles say more.
    let chosen = listed.get(at).map(|&(stage, check)| app.stages[stage].checks[check].entry.title.clone());
    rows.push(Row::Words(Tone::Quiet, chosen.unwrap_or_default()));
    for (index, &(stage, check)) in listed.iter().enumerate().skip(first).take(room) {
        let (number, check) = (app.stages[stage].number, &app.stages[stage].checks[check]);
        let mark = if index == at { '>' } else { ' ' };
        let tone = if index == at { Tone::Plain } else { Tone::Quiet };
        rows.push(Row::Words(tone, format!("{mark} {number:>2} {} {}", look.sign(check), check.name)));
    }
    rows
}

/// The lines above the keys: how far the run has come, and what the last key or event did.
fn foot(app: &App, columns: usize) -> Vec<String> {
    let run = match &app.phase {
        // The first picture waits for the renderer.
        Phase::Compiling if matches!(app.page, Page::Picture(None)) => {
            "compiling with optimisation … (about a minute)".to_owned()
        }
        Phase::Compiling => "compiling …".to_owned(),
        Phase::Working if matches!(app.page, Page::Picture(_)) => "rendering …".to_owned(),
        Phase::Working => "checking …".to_owned(),
        Phase::Ended { compiled, checked } if checked.is_zero() => {
            format!("compiled in {:.1} s", compiled.as_secs_f64())
        }
        Phase::Ended { compiled, checked } => {
            format!("compiled in {:.1} s, checked in {:.1} s", compiled.as_secs_f64(), checked.as_secs_f64())
        }
        Phase::Errors(_) => "waiting for a save; o opens the place".to_owned(),
        Phase::Broken(_) => "waiting for a save".to_owned(),
    };
    let line = if app.note.is_empty() { run.clone() } else { format!("{run}   {}", app.note) };
    let fits = line.chars().count() <= columns;
    let lines = if fits { vec![line] } else { [wrapped(&app.note, columns), vec![run]].concat() };
    let regression = app.regression().map(|words| wrapped(&words, columns));
    regression.into_iter().flatten().chain(lines).collect()
}

/// The text in at most `columns` columns. Signs of the kit's texts are one column wide.
fn clipped(text: &str, columns: usize, look: Look) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let end = if look.has_unicode { "…" } else { "." };
    text.chars().take(columns.saturating_sub(1)).chain(end.chars()).collect()
}

/// The text in lines of at most `columns` columns. Later lines are indented like the first one, and two columns more.
fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let indent = text.len() - text.trim_start().len();
    let mut lines = vec![String::new()];
    let columns = columns.max(indent + 12);
    for word in text.split_inclusive(' ') {
        let last = lines.last_mut().map_or(0, |line| line.chars().count());
        let length = word.trim_end().chars().count();
        if last > indent && last + length > columns {
            lines.push(" ".repeat(indent + 2));
        }
        // Cut a word that is longer than a line.
        for sign in word.chars() {
            if lines.last().map_or(0, |line| line.chars().count()) == columns && sign != ' ' {
                lines.push(" ".repeat(indent + 2));
            }
            if let Some(line) = lines.last_mut().filter(|line| line.chars().count() < columns) {
                line.push(sign);
            }
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::Action;
    use crate::run::Event;
    use crossterm::event::KeyCode;
    use raykata_cli::verdicts::CheckVerdict;
    use std::time::Duration;

    const LOOK: Look = Look { has_unicode: true, has_true_colour: true };

    fn text(app: &App, look: Look) -> String {
        let words = |row| match row {
            Row::Words(_, text) => text,
            Row::Pixels(cells) => format!("{} half blocks", cells.len()),
        };
        rows(app, look).into_iter().map(words).collect::<Vec<_>>().join("\n")
    }

    /// Stage 1 with two checks that pass, one that fails, and gaps.
    fn app() -> App {
        let (mut app, action) = App::new(Some(1), (80, 24));
        assert_ne!(action, Action::Nothing);
        app.event(Event::Compiled(Duration::from_millis(640)));
        let names: Vec<String> = app.stage().checks.iter().map(|check| check.name.to_owned()).collect();
        for (index, check) in names.into_iter().enumerate() {
            let verdict = match index {
                0 | 1 => Verdict::Passed,
                2 => Verdict::Failed(
                    "stage 1 · a law\n  slides: a slide\n  input     sphere_geometric(&Ray::new(vec3(0.0140625, 0.0, \
                     0.0), vec3(1.0, 0.0, 0.0)), vec3(0.0, 0.0, 0.0), 0.125)\n  yours     None\n  expected  \
                     Some(0.11093750037252903) ± 2.7e-7 (double precision)\n  looks like: the ray starts inside\n  \
                     again: cargo test --test stage1 one\n  stuck: cargo run -- hint one\n"
                        .into(),
                ),
                _ => Verdict::NotWritten {
                    task: "find the roots".into(),
                    place: "exercises/src/stage1_shapes.rs:23".into(),
                },
            };
            app.event(Event::Verdict(CheckVerdict { check, verdict }));
        }
        app.event(Event::Checked(1, Duration::from_millis(310)));
        app
    }

    #[test]
    fn the_screen_fits_and_shows_the_check_that_comes_next() {
        let mut app = app();
        for (keys, name) in [("", "fails"), ("h", "hint"), ("e", "unfolded"), ("n", "gap"), ("l", "list")] {
            keys.chars().for_each(|key| _ = app.key(KeyCode::Char(key)));
            let shown = text(&app, LOOK);
            assert_eq!(shown.lines().count(), 24, "{shown}");
            assert!(shown.lines().all(|line| line.chars().count() <= 80), "{shown}");
            // The number of all checks grows with the kit.
            let all = format!("{} checks   search", app.listed("").len());
            insta::assert_snapshot!(name, shown.replace(&all, "all checks   search"));
        }
    }

    #[test]
    fn a_low_and_narrow_terminal_shows_less_and_never_fails() {
        let mut app = app();
        for (columns, height) in [(1, 1), (10, 3), (20, 6), (40, 12), (200, 60)] {
            app.size = (columns, height);
            for key in ['h', 'e', 'l', 'l', 'v', 'v', 't'] {
                app.key(KeyCode::Char(key));
                let rows = rows(&app, LOOK);
                assert!(rows.len() <= height, "{columns} × {height}");
            }
        }
    }

    #[test]
    fn without_unicode_every_sign_is_ascii() {
        let mut app = app();
        for key in ['h', 'h', 'h', 'e', 'l'] {
            app.key(KeyCode::Char(key));
            assert!(text(&app, Look { has_unicode: false, has_true_colour: false }).is_ascii());
        }
    }

    #[test]
    fn errors_of_the_compiler_take_a_few_lines() {
        let mut app = app();
        app.event(Event::Errors(vec![CompilerError {
            place: "exercises/src/stage1_shapes.rs:23:5".into(),
            what: "mismatched types".into(),
            code: "t_near".into(),
            notes: vec!["expected `Option<f32>`, found `f32`".into()],
        }]));
        insta::assert_snapshot!("compiler", text(&app, LOOK));
    }

    #[test]
    fn long_words_are_cut_and_lines_are_indented() {
        assert_eq!(wrapped("  ab cd efgh", 14), ["  ab cd efgh"]);
        assert_eq!(wrapped("aaaa bbbb cccc dddd", 12), ["aaaa bbbb", "  cccc dddd"]);
        assert_eq!(wrapped(&"x".repeat(15), 12), ["x".repeat(12), format!("  {}", "x".repeat(3))]);
    }
}
