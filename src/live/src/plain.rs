//! The same in lines, one after the other: for screen readers, pipes and terminals without a screen. It ends when the
//! program is interrupted.

use crate::app::{Action, App, Page, Phase};
use crate::run::{Event, Paths, Run};
use anyhow::Result;
use live::files::Files;
use raykata_cli::finish::next_step;
use raykata_cli::report::say;
use raykata_cli::verdicts::Verdict;
use std::time::Duration;

/// The time between two looks at the files.
const PAUSE: Duration = Duration::from_millis(150);

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
    let body = match (&app.phase, &app.check().verdict) {
        (Phase::Errors(errors), _) => {
            let error = |error: &live::compiler::CompilerError| {
                let notes: String = error.notes.iter().map(|note| format!("  {note}\n")).collect();
                format!("{}\n  {}\n  {}\n{notes}", error.place, error.what, error.code)
            };
            return format!("\ndoes not compile\n{}", errors.iter().map(error).collect::<String>());
        }
        (Phase::Broken(why), _) => return format!("\n{why}\n"),
        (_, Some(Verdict::NotWritten { task, place })) => format!("not written yet: {place}\n  {task}\n"),
        (_, Some(Verdict::Failed(message))) => message.clone(),
        (_, Some(Verdict::Passed)) if stage.is_done() => format!("Stage {} is done.\n", stage.number),
        _ => String::new(),
    };
    let lines = match &app.page {
        Page::Picture { picture: Some(picture), .. } => {
            picture.lines.iter().chain([&next_step(stage.number)]).map(|line| format!("{line}\n")).collect()
        }
        Page::Picture { picture: None, .. } => "its picture is being rendered …\n".to_owned(),
        _ => String::new(),
    };
    head + &body + &lines
}
