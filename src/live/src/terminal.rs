//! The screen of a terminal: draws the rows, and reads the keys.

use crate::app::{Action, App};
use crate::editor;
use crate::run::{PAUSE, Paths, Run};
use crate::screen::{Row, Tone, rows};
use anyhow::Result;
use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::event::{Event, KeyCode, KeyEventKind, KeyModifiers, poll, read};
use crossterm::style::{Color, Print, ResetColor, SetForegroundColor};
use crossterm::terminal::{self, Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen};
use crossterm::{execute, queue};
use live::files::Files;
use raykata_cli::half_blocks::Look;
use std::io::{Write, stdout};

/// The screen of the program, in place of what the terminal showed before. That comes back when this is dropped, also after
/// an error.
struct Screen;

impl Screen {
    fn enter() -> Result<Screen> {
        terminal::enable_raw_mode()?;
        execute!(stdout(), EnterAlternateScreen, Hide)?;
        Ok(Screen)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = execute!(stdout(), ResetColor, Show, LeaveAlternateScreen);
        let _ = terminal::disable_raw_mode();
    }
}

/// Follows the files until the student ends it.
pub fn watch(paths: &Paths, stage: Option<u8>) -> Result<()> {
    let root = &paths.root;
    let look = Look::of_environment();
    let mut files = Files::new(live::exercises(root));
    let (mut app, mut action) = App::new(stage, size());
    let mut run = None;
    let mut shown = Vec::new();
    let mut screen = Screen::enter()?;
    loop {
        // Do what the last key, save or event asked for.
        match std::mem::replace(&mut action, Action::Nothing) {
            Action::Nothing => {}
            Action::Quit => break,
            Action::Start(task) => {
                // End the run before this one first, because both use the same files.
                drop(run.take());
                run = Some(Run::start(paths.clone(), task));
            }
            Action::AskReset => app.ask_reset(root),
            Action::Reset => app.reset(root),
            Action::Edit => {
                let (file, line) = app.place(root);
                drop(screen);
                let opened = editor::open(root, &file, line);
                screen = Screen::enter()?;
                shown.clear();
                app.note = opened.err().map_or(String::new(), |error| format!("{error:#}"));
            }
        }
        if action != Action::Nothing {
            continue;
        }
        // Draw only what is new, because a screen reader may read each drawing aloud.
        let new = rows(&app, look);
        if new != shown {
            draw(&new, look)?;
            shown = new;
        }
        // Wait for a key, and look at the files and the reports in between.
        if poll(PAUSE)? {
            match read()? {
                Event::Key(key) if key.kind != KeyEventKind::Release => {
                    let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
                    action = match key.code {
                        KeyCode::Char('c' | 'd') if is_control => Action::Quit,
                        code => app.key(code),
                    };
                }
                Event::Resize(columns, rows) => {
                    app.size = (columns.into(), rows.into());
                    shown.clear();
                }
                _ => {}
            }
        } else if files.have_changed() {
            action = app.saved();
        } else {
            for event in run.iter().flat_map(|run: &Run| run.events.try_iter()) {
                action = app.event(event);
                if action != Action::Nothing {
                    break;
                }
            }
        }
    }
    drop(screen);
    Ok(())
}

fn size() -> (usize, usize) {
    let (columns, rows) = terminal::size().unwrap_or((80, 24));
    (columns.into(), rows.into())
}

/// Draws all rows. Each one is overwritten and not cleared first, so that nothing flickers.
fn draw(rows: &[Row], look: Look) -> Result<()> {
    let mut out = stdout().lock();
    for (y, row) in rows.iter().enumerate() {
        queue!(out, MoveTo(0, y as u16))?;
        match row {
            Row::Words(tone, text) => {
                if let Some(colour) = colour(*tone).filter(|_| look.has_colours) {
                    queue!(out, SetForegroundColor(colour))?;
                }
                queue!(out, Print(text))?;
            }
            Row::Pixels(cells) => queue!(out, Print(look.line(cells)))?,
        }
        queue!(out, ResetColor, Clear(ClearType::UntilNewLine))?;
    }
    queue!(out, Clear(ClearType::FromCursorDown))?;
    out.flush()?;
    Ok(())
}

fn colour(tone: Tone) -> Option<Color> {
    match tone {
        Tone::Plain => None,
        Tone::Good => Some(Color::Green),
        Tone::Bad => Some(Color::Red),
        Tone::Quiet => Some(Color::DarkGrey),
    }
}
