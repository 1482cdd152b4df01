//! The same in lines, one after the other: for screen readers, pipes and terminals without a screen. It ends when the
//! program is interrupted.

use crate::app::{Action, App, Page};
use crate::run::{Event, PAUSE, Paths, Run};
use crate::screen::{Row, body};
use anyhow::Result;
use live::files::Files;
use raykata_cli::half_blocks::Look;
use raykata_cli::report::say;

/// Follows the files until the program is interrupted.
pub fn watch(paths: &Paths, stage: Option<u8>) -> Result<()> {
    let mut files = Files::new(live::exercises(&paths.root));
    let (mut app, mut action) = App::new(stage, (80, 24));
    let mut run = None;
    say(format_args!("watching exercises/src; Ctrl-C ends it\n"));
    loop {
        if let Action::Start(task) = action {
            drop(run.take());
            run = Some(Run::start(paths.clone(), task));
        }
        let event = run.as_ref().map(|run: &Run| run.events.recv_timeout(PAUSE));
        action = match event {
            Some(Ok(event)) => {
                let has_ended = match &event {
                    Event::Verdict(_) | Event::Compiled(_) | Event::Progress(_) => false,
                    Event::Checked(number, _) => *number == app.stage().number,
                    _ => true,
                };
                let before = app.regression();
                let action = app.event(event);
                let is_finish = matches!(app.page, Page::Picture { is_finish: true, .. });
                if has_ended && (action == Action::Nothing || is_finish) {
                    say(format_args!("{}\n", lines(&app)));
                }
                if let Some(words) = app.regression().filter(|words| before.as_ref() != Some(words)) {
                    say(format_args!("{words}\n"));
                }
                action
            }
            _ if files.have_changed() => app.saved(),
            _ => Action::Nothing,
        };
    }
}

/// The result of a run, in lines.
fn lines(app: &App) -> String {
    let stage = app.stage();
    let (checks, points) = stage.earned();
    let head = format!("\nstage {} · {}: {checks} pass, {points}\n", stage.number, stage.entry.title);
    let look = Look { has_colours: false, ..Look::of_environment() };
    let line = |row| if let Row::Words(_, text) = row { text + "\n" } else { String::new() };
    head + &body(app, look, usize::MAX).into_iter().map(line).collect::<String>()
}
