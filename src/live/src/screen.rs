//! The rows of the screen, from the state of the program. Meaning is never in the colour alone.

use crate::app::{App, Page, Phase};
use live::compiler::CompilerError;
use live::course::Check;
use raykata_cli::finish::{Picture, next_step};
use raykata_cli::half_blocks::{Look, Rgb, cells};
use raykata_cli::report::{counted, wrapped};
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

/// The sign of a check: passed, failed, not written, not known.
fn sign(look: Look, check: &Check) -> char {
    match (&check.verdict, look.has_unicode) {
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
fn plain(look: Look, text: &str) -> String {
    if look.has_unicode {
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
    rows.extend(body(app, look, room).into_iter().take(room));
    rows.truncate(height.saturating_sub(foot.len()));
    while rows.len() + foot.len() < height {
        rows.push(Row::Words(Tone::Plain, String::new()));
    }
    rows.extend(foot.into_iter().map(|line| Row::Words(Tone::Quiet, line)));
    let fitted = |row| match row {
        Row::Words(tone, text) => Row::Words(tone, clipped(&plain(look, &text), columns, look)),
        Row::Pixels(cells) => Row::Pixels(cells.into_iter().take(columns).collect()),
    };
    rows.into_iter().take(height).map(fitted).collect()
}

/// The middle of the screen, for which there is room in so many rows.
pub fn body(app: &App, look: Look, room: usize) -> Vec<Row> {
    let columns = app.size.0;
    match (&app.phase, &app.page) {
        (_, Page::List { word, is_typing, at }) => list(app, look, word, *is_typing, *at, room),
        (_, Page::Reset { file, name }) => question(file, name),
        (Phase::Errors(errors), _) => compiler(errors),
        (_, Page::Picture { picture, is_finish }) => shown(app, look, picture.as_ref(), *is_finish, room),
        (Phase::Broken(why), _) => lines(Tone::Bad, why, columns),
        (_, Page::Tried(text)) => lines(Tone::Plain, text, columns),
        (_, Page::Check { hints, unfolded }) => check(app, *hints, *unfolded, columns),
    }
}

/// The stage, its points, and a sign for each check.
fn head(app: &App, look: Look) -> Vec<Row> {
    let stage = app.stage();
    let (checks, points) = stage.earned();
    let name = format!("stage {} · {}", stage.number, stage.entry.title);
    let head = wrapped(&format!("{name:<34}  {checks}   {points}"), app.size.0);
    let signs = stage.checks.iter().enumerate().map(|(index, check)| match index == app.check {
        true => format!("[{}]", sign(look, check)),
        false => sign(look, check).to_string(),
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
        rows.push(Row::Words(Tone::Quiet, format!("  slides: {}", check.entry.taught())));
    };
    match &check.verdict {
        None => law(Tone::Plain, "? no verdict yet"),
        Some(Verdict::Passed) => {
            law(Tone::Good, "passes");
            let stage = app.stage();
            if stage.is_done() {
                rows.push(plain(String::new()));
                rows.push(Row::Words(Tone::Good, format!("Stage {} is done.", stage.number)));
                rows.extend(wrapped(&next_step(stage.number), columns).into_iter().map(plain));
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

/// The picture, or why there is none, and what it cost; also what comes next, if it is shown because the stage is done.
fn shown(app: &App, look: Look, picture: Option<&Picture>, is_finish: bool, room: usize) -> Vec<Row> {
    let columns = app.size.0;
    let stage = app.stage().number;
    let done = is_finish.then(|| Row::Words(Tone::Good, format!("Stage {stage} is done.")));
    let next = is_finish.then(|| next_step(stage));
    let lines = picture.map_or(&[][..], |picture| &picture.lines);
    let text = lines.iter().chain(&next).flat_map(|line| wrapped(line, columns));
    let text: Vec<Row> = text.map(|line| Row::Words(Tone::Plain, line)).collect();
    let room = room.saturating_sub(text.len() + usize::from(is_finish));
    let middle = match (&app.phase, picture) {
        (Phase::Broken(why), _) => self::lines(Tone::Bad, why, columns),
        (_, None) => vec![Row::Words(Tone::Quiet, "the picture is being rendered …".into())],
        (_, Some(picture)) if look.shows_pictures() => {
            cells(&picture.rgb, picture.width, columns, room).into_iter().map(Row::Pixels).collect()
        }
        _ => Vec::new(),
    };
    done.into_iter().chain(middle).chain(text).collect()
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
    let count = counted(errors.len() as u64, "error");
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
        rows.push(Row::Words(tone, format!("{mark} {number:>2} {} {}", sign(look, check), check.name)));
    }
    rows
}

/// The lines above the keys: how far the run has come, and what the last key or event did.
fn foot(app: &App, columns: usize) -> Vec<String> {
    let run = match &app.phase {
        // The first picture waits for the renderer.
        Phase::Compiling if matches!(app.page, Page::Picture { picture: None, .. }) => {
            "compiling with optimisation …".to_owned()
        }
        Phase::Compiling => "compiling …".to_owned(),
        Phase::Working if matches!(app.page, Page::Picture { .. }) => "rendering …".to_owned(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::Action;
    use crate::run::Event;
    use crossterm::event::KeyCode;
    use raykata_cli::verdicts::CheckVerdict;
    use std::time::Duration;

    const LOOK: Look = Look { has_unicode: true, has_colours: true, has_true_colour: true };

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
    fn a_stage_that_is_done_shows_its_picture_or_where_it_is() {
        let mut app = app();
        let checks: Vec<String> = app.stage().checks.iter().map(|check| check.name.to_owned()).collect();
        for check in checks {
            app.event(Event::Verdict(CheckVerdict { check, verdict: Verdict::Passed }));
        }
        let action = app.event(Event::Checked(1, Duration::from_millis(310)));
        assert!(matches!(action, Action::Start(_)));
        let lines =
            vec!["9 primitives.".to_owned(), "The picture is kept in out/album/stage1.png.".to_owned()];
        let rgb = vec![0; 3 * 64 * 40];
        app.event(Event::Picture(Picture { rgb, width: 64, lines, notes: Vec::new() }));
        insta::assert_snapshot!("finish", text(&app, LOOK));
        app.size = (40, 24);
        insta::assert_snapshot!("finish_without_pictures", text(&app, Look { has_colours: false, ..LOOK }));
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
            assert!(text(&app, Look { has_unicode: false, ..LOOK }).is_ascii());
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
}
