//! What is shown, and what keys, saves and events do to it.

use crate::reset::{function_at, reset};
use crate::run::{Event, Task};
use crossterm::event::KeyCode;
use live::compiler::CompilerError;
use live::course::{Check, Stage, keep, stages};
use live::files::names_in;
use raykata_cli::finish::{Picture, file_of};
use raykata_cli::verdicts::{CheckVerdict, Verdict};
use std::path::Path;
use std::time::Duration;

/// What must be done next.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    Nothing,
    Quit,
    /// Starts a run in place of the one before.
    Start(Task),
    /// Opens the shown function in the student's editor.
    Edit,
    /// Asks whether the shown function is to be reset.
    AskReset,
    /// Resets the function of the page.
    Reset,
}

/// How far the last run has come.
#[derive(Debug, PartialEq)]
pub enum Phase {
    /// The exercises are being compiled.
    Compiling,
    /// The checks run, or the picture is rendered.
    Working,
    /// The run has ended, after these times of the compiler and of the checks.
    Ended { compiled: Duration, checked: Duration },
    /// The exercises do not compile.
    Errors(Vec<CompilerError>),
    /// The run could not go on, for this reason.
    Broken(String),
}

/// What the middle of the screen shows.
#[derive(Debug, PartialEq)]
pub enum Page {
    /// A check, with this many of its hints, and with its long lines in full or not.
    Check { hints: usize, unfolded: bool },
    /// All checks whose name or title contains a word, of which one is chosen. Keys may change the word.
    List { word: String, is_typing: bool, at: usize },
    /// The picture of the stage, when it is rendered. It is shown at the finish if the last check of the stage passes now. The next
    /// save then leads back to the checks.
    Picture { picture: Option<Picture>, is_finish: bool },
    /// The call of the check alone, when it has answered.
    Tried(String),
    /// A question: shall this function, in this file from the root of the kit, be reset?
    Reset { file: String, name: String },
}

impl Page {
    const CHECK: Page = Page::Check { hints: 0, unfolded: false };
}

/// The state of the program.
pub struct App {
    /// The stages of the course, with the last verdicts.
    pub stages: Vec<Stage>,
    /// The index of the stage.
    pub stage: usize,
    /// The index of the check that is shown, in its stage.
    pub check: usize,
    /// Whether the student has chosen this check. Otherwise it is the first one that does not pass.
    is_chosen: bool,
    /// Whether stages that are done are passed over. That is so at the beginning.
    is_searching: bool,
    /// The time of the compiler in this run.
    compiled: Duration,
    /// How far the last run has come.
    pub phase: Phase,
    /// What is shown.
    pub page: Page,
    /// What the last key or event did, in words.
    pub note: String,
    /// The columns and rows of the terminal.
    pub size: (usize, usize),
}

impl App {
    /// Begins with this stage, or with the first one that is not done, and returns the first action.
    pub fn new(stage: Option<u8>, size: (usize, usize)) -> (App, Action) {
        let stages = stages();
        let index = stage.and_then(|stage| stages.iter().position(|one| one.number == stage));
        let mut app = App {
            stages,
            stage: index.unwrap_or(0),
            check: 0,
            is_chosen: false,
            is_searching: index.is_none(),
            compiled: Duration::ZERO,
            phase: Phase::Compiling,
            page: Page::CHECK,
            note: String::new(),
            size,
        };
        let action = app.run();
        (app, action)
    }

    /// The stage that is shown.
    pub fn stage(&self) -> &Stage {
        &self.stages[self.stage]
    }

    /// The check that is shown.
    pub fn check(&self) -> &Check {
        &self.stage().checks[self.check]
    }

    /// The checks of the list, as the indices of their stage and of the check in it.
    pub fn listed(&self, word: &str) -> Vec<(usize, usize)> {
        let word = word.to_lowercase();
        let fits =
            |check: &Check| check.name.contains(&word) || check.entry.title.to_lowercase().contains(&word);
        let of_stage = |(index, stage): (usize, &Stage)| -> Vec<(usize, usize)> {
            let checks = stage.checks.iter().enumerate();
            checks.filter(|(_, check)| fits(check)).map(|(check, _)| (index, check)).collect()
        };
        self.stages.iter().enumerate().flat_map(of_stage).collect()
    }

    /// A file of the student has changed.
    pub fn saved(&mut self) -> Action {
        self.note.clear();
        if matches!(self.page, Page::Picture { is_finish: true, .. }) {
            self.page = Page::CHECK;
        }
        self.run()
    }

    /// The stages that are checked after the stage that is shown, because an edit may break what was done.
    fn others(&self) -> impl Iterator<Item = &Stage> {
        let is_other = |(index, stage): &(usize, &Stage)| {
            *index != self.stage && (*index < self.stage || stage.was_done) && !self.is_searching
        };
        self.stages.iter().enumerate().filter(is_other).map(|(_, stage)| stage)
    }

    /// Starts a run for what is shown.
    fn run(&mut self) -> Action {
        self.phase = Phase::Compiling;
        let stage = self.stage().number;
        Action::Start(match self.page {
            Page::Picture { .. } => Task::Render(stage, file_of(stage, self.stage().is_done())),
            Page::Tried(_) => Task::Try(self.check().name),
            _ => Task::Check([stage].into_iter().chain(self.others().map(|other| other.number)).collect()),
        })
    }

    /// In words: the first check that fails of a stage that was done before, other than the stage that is shown.
    pub fn regression(&self) -> Option<String> {
        let stage = self.others().find(|stage| stage.was_done && !stage.is_done())?;
        let check = stage.checks.iter().find(|check| check.entry.is_asked_for() && !check.passes())?;
        Some(format!("stage {} was done, and now fails {} (l lists the checks)", stage.number, check.name))
    }

    /// Keeps a verdict. Shows a failure at once if it comes before the check that is shown: others may wait for the same endless loop.
    fn judged(&mut self, verdict: CheckVerdict) {
        let failed = matches!(verdict.verdict, Verdict::Failed(_));
        let at = self.stage().checks.iter().position(|check| check.name == verdict.check);
        keep(&mut self.stages, verdict);
        if let Some(at) =
            at.filter(|&at| failed && !self.is_chosen && (at < self.check || self.check().passes()))
        {
            self.show(at);
        }
    }

    /// Shows a check of the stage, unless another page is open.
    fn show(&mut self, check: usize) {
        if check != self.check && matches!(self.page, Page::Check { .. }) {
            self.page = Page::CHECK;
        }
        self.check = check;
    }

    /// Goes to a check.
    fn go(&mut self, stage: usize, check: usize) -> Action {
        let is_other = stage != self.stage;
        (self.stage, self.check, self.is_chosen, self.is_searching) = (stage, check, true, false);
        self.page = Page::CHECK;
        if is_other { self.run() } else { Action::Nothing }
    }

    /// A run reports.
    pub fn event(&mut self, event: Event) -> Action {
        match event {
            Event::Compiled(time) => (self.compiled, self.phase) = (time, Phase::Working),
            Event::Errors(errors) => self.phase = Phase::Errors(errors),
            Event::Broken(why) => self.phase = Phase::Broken(why),
            Event::Verdict(verdict) => self.judged(verdict),
            Event::Progress(words) => self.note = words,
            Event::Tried(text) => {
                self.phase = Phase::Ended { compiled: self.compiled, checked: Duration::ZERO };
                self.page = Page::Tried(text);
            }
            Event::Picture(new) => {
                self.phase = Phase::Ended { compiled: self.compiled, checked: Duration::ZERO };
                self.note.clear();
                if let Page::Picture { picture, .. } = &mut self.page {
                    *picture = Some(new);
                }
            }
            Event::Checked(number, checked) => {
                let is_finished = self.stage().was_open && !self.stage().was_done && self.stage().is_done();
                for stage in self.stages.iter_mut().filter(|stage| stage.number == number) {
                    stage.was_done |= stage.is_done();
                    stage.was_open |= !stage.is_done();
                }
                if number == self.stage().number {
                    self.phase = Phase::Ended { compiled: self.compiled, checked };
                    let action = self.checked();
                    if is_finished && matches!(self.page, Page::Check { .. }) {
                        self.page = Page::Picture { picture: None, is_finish: true };
                        return self.run();
                    }
                    return action;
                }
            }
        }
        Action::Nothing
    }

    /// All checks of the stage have a verdict: shows what comes next.
    fn checked(&mut self) -> Action {
        let is_last = self.stage + 1 == self.stages.len();
        if self.is_searching && self.stage().is_done() && !is_last {
            self.stage += 1;
            self.check = 0;
            return self.run();
        }
        self.is_searching = false;
        if self.is_chosen && self.check().passes() {
            self.note = format!("passes now: {}", self.check().entry.title);
            self.is_chosen = false;
        }
        if !self.is_chosen {
            self.show(self.stage().next_open(0, true).unwrap_or(self.check));
        }
        Action::Nothing
    }

    /// A key was pressed.
    pub fn key(&mut self, key: KeyCode) -> Action {
        self.note.clear();
        match self.page {
            Page::List { .. } => return self.key_in_list(key),
            Page::Reset { .. } if key == KeyCode::Char('y') => return Action::Reset,
            Page::Reset { .. } => return self.back(),
            _ => {}
        }
        match key {
            KeyCode::Char('q') => return Action::Quit,
            KeyCode::Char('n') | KeyCode::Down => return self.next(),
            KeyCode::Char('p') | KeyCode::Up => {
                if let Some(previous) = self.stage().previous_open(self.check) {
                    return self.go(self.stage, previous);
                }
            }
            KeyCode::Char('l') => {
                let all = self.listed("");
                let at = all.iter().position(|place| *place == (self.stage, self.check)).unwrap_or(0);
                self.page = Page::List { word: String::new(), is_typing: false, at };
            }
            KeyCode::Char('o') => return Action::Edit,
            KeyCode::Char('r') => return Action::AskReset,
            KeyCode::Char('v') => {
                self.page = match self.page {
                    Page::Picture { .. } => Page::CHECK,
                    _ => Page::Picture { picture: None, is_finish: false },
                };
                return self.run();
            }
            KeyCode::Char('t') => {
                self.page = Page::Tried(String::new());
                return self.run();
            }
            KeyCode::Char('h') => {
                let hints = match self.page {
                    Page::Check { hints, .. } => hints % 3 + 1,
                    _ => 1,
                };
                self.page = Page::Check { hints, unfolded: false };
            }
            KeyCode::Char('e') => {
                let unfolded = !matches!(self.page, Page::Check { unfolded: true, .. });
                self.page = Page::Check { hints: 0, unfolded };
            }
            KeyCode::Esc => self.page = Page::CHECK,
            _ => {}
        }
        Action::Nothing
    }

    /// The next check that does not pass, or the next stage if this one is done.
    fn next(&mut self) -> Action {
        match self.stage().next_open(self.check, false) {
            Some(next) => self.go(self.stage, next),
            None if self.stage + 1 < self.stages.len() => {
                let action = self.go(self.stage + 1, 0);
                self.is_chosen = false;
                action
            }
            None => Action::Nothing,
        }
    }

    /// Shows the check again.
    fn back(&mut self) -> Action {
        self.page = Page::CHECK;
        Action::Nothing
    }

    fn key_in_list(&mut self, key: KeyCode) -> Action {
        let Page::List { word, is_typing, at } = &self.page else { return Action::Nothing };
        let (mut word, mut is_typing, mut at) = (word.clone(), *is_typing, *at);
        let listed = self.listed(&word);
        match key {
            KeyCode::Enter => {
                if let Some(&(stage, check)) = listed.get(at) {
                    return self.go(stage, check);
                }
            }
            KeyCode::Esc if is_typing => (word, is_typing) = (String::new(), false),
            KeyCode::Char(sign) if is_typing => {
                word.push(sign);
                at = 0;
            }
            KeyCode::Backspace if is_typing => {
                word.pop();
                at = 0;
            }
            KeyCode::Up | KeyCode::Char('p') => at = at.saturating_sub(1),
            KeyCode::Down | KeyCode::Char('n') => at = (at + 1).min(listed.len().saturating_sub(1)),
            KeyCode::Char('/') => is_typing = true,
            KeyCode::Esc | KeyCode::Char('l') => return self.back(),
            KeyCode::Char('q') => return Action::Quit,
            _ => {}
        }
        self.page = Page::List { word, is_typing, at };
        Action::Nothing
    }

    /// Asks whether the function of the shown check, or of the first error, is to be reset.
    pub fn ask_reset(&mut self, root: &Path) {
        let (file, line) = self.place(root);
        let text = std::fs::read_to_string(root.join(&file)).unwrap_or_default();
        match function_at(&text, line) {
            Some(name) => self.page = Page::Reset { file, name },
            None => {
                // The compiler points at the module of a file that is gone.
                let module = text.lines().nth(line.saturating_sub(1) as usize);
                let name = module.and_then(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
                self.note = name.map_or("there is no function to reset here".into(), |name| {
                    format!("exercises/src/{name}.rs is gone: copy it from your hand-out or a backup")
                });
            }
        }
    }

    /// Resets the function of the question.
    pub fn reset(&mut self, root: &Path) {
        if let Page::Reset { file, name } = std::mem::replace(&mut self.page, Page::CHECK) {
            self.note = match reset(root, &file, &name) {
                Ok(kept) => format!("the old text: {}", kept.strip_prefix(root).unwrap_or(&kept).display()),
                Err(error) => format!("{error:#}"),
            };
        }
    }

    /// The file and the line of what the shown check waits for: an error of the compiler, the gap, or the function that the
    /// message names.
    pub fn place(&self, root: &Path) -> (String, u32) {
        let split = |place: &str| -> Option<(String, u32)> {
            let mut parts = place.split(':');
            Some((parts.next().filter(|file| !file.is_empty())?.to_owned(), parts.next()?.parse().ok()?))
        };
        let in_error = match &self.phase {
            Phase::Errors(errors) => errors.iter().find_map(|error| split(&error.place)),
            _ => None,
        };
        let in_verdict = || match self.check().verdict.as_ref()? {
            Verdict::NotWritten { place, .. } => split(place),
            Verdict::Failed(message) => function_in(message, root, self.stage().number),
            Verdict::Passed => None,
        };
        let in_error = in_error.map(|(file, line)| {
            // The compiler names files from the folder of their package.
            let file = if file.starts_with("src/") { format!("exercises/{file}") } else { file };
            (file, line)
        });
        in_error.or_else(in_verdict).unwrap_or_else(|| {
            let first = files_of(root, self.stage().number).into_iter().next().unwrap_or_default();
            (first, 1)
        })
    }
}

/// The files of a stage, from the root of the kit.
fn files_of(root: &Path, stage: u8) -> Vec<String> {
    let mut names = names_in(&live::exercises(root));
    names.retain(|name| name.starts_with(&format!("stage{stage}_")));
    names.sort();
    names.into_iter().map(|name| format!("exercises/src/{name}")).collect()
}

/// The function that the input of a message calls, with its file and line.
fn function_in(message: &str, root: &Path, stage: u8) -> Option<(String, u32)> {
    let input = message.lines().find_map(|line| line.trim_start().strip_prefix("input "))?;
    let name: String =
        input.trim().chars().take_while(|sign| sign.is_alphanumeric() || *sign == '_').collect();
    let head = format!("pub fn {name}");
    files_of(root, stage).into_iter().find_map(|file| {
        let text = std::fs::read_to_string(root.join(&file)).ok()?;
        let is_head = |line: &str| line.strip_prefix(&head).is_some_and(|rest| rest.starts_with(['(', '<']));
        let line = text.lines().position(is_head)?;
        Some((file, line as u32 + 1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tell(app: &mut App, check: usize, verdict: Verdict) {
        let name = app.stage().checks[check].name.to_owned();
        app.event(Event::Verdict(CheckVerdict { check: name, verdict }));
    }

    fn end(app: &mut App) -> Action {
        app.event(Event::Checked(app.stage().number, Duration::from_millis(300)))
    }

    fn failed() -> Verdict {
        Verdict::Failed("a message".into())
    }

    fn all(app: &mut App, verdict: &Verdict) {
        (0..app.stage().checks.len()).for_each(|check| tell(app, check, verdict.clone()));
    }

    #[test]
    fn it_begins_at_the_first_check_that_does_not_pass() {
        let (mut app, action) = App::new(None, (80, 24));
        assert_eq!(action, Action::Start(Task::Check(vec![1])));
        all(&mut app, &Verdict::Passed);
        assert_eq!(end(&mut app), Action::Start(Task::Check(vec![2])), "stage 1 is done");
        all(&mut app, &Verdict::Passed);
        tell(&mut app, 3, failed());
        assert_eq!(end(&mut app), Action::Nothing);
        assert_eq!((app.stage().number, app.check), (2, 3));
        app.saved();
        tell(&mut app, 1, failed());
        assert_eq!(app.check, 1, "a failure is shown before the other checks have a verdict");
    }

    #[test]
    fn a_save_tells_what_fails_in_a_stage_that_was_done() {
        let (mut app, _) = App::new(None, (80, 24));
        all(&mut app, &Verdict::Passed);
        end(&mut app);
        all(&mut app, &failed());
        end(&mut app);
        assert_eq!(app.saved(), Action::Start(Task::Check(vec![2, 1])));
        let check = app.stages[0].checks[3].name;
        app.event(Event::Verdict(CheckVerdict { check: check.into(), verdict: failed() }));
        let line = app.regression().expect("stage 1 was done");
        assert_eq!(line, format!("stage 1 was done, and now fails {check} (l lists the checks)"));
        app.event(Event::Verdict(CheckVerdict { check: check.into(), verdict: Verdict::Passed }));
        assert_eq!(app.regression(), None);
    }

    #[test]
    fn next_and_previous_visit_only_what_does_not_pass() {
        let (mut app, _) = App::new(Some(1), (80, 24));
        all(&mut app, &Verdict::Passed);
        for check in [1, 4, 6] {
            tell(&mut app, check, failed());
        }
        end(&mut app);
        let mut visited = vec![app.check];
        for key in "nnnpp".chars() {
            app.key(KeyCode::Char(key));
            visited.push(app.check);
        }
        assert_eq!(visited, [1, 4, 6, 1, 6, 4]);
    }

    #[test]
    fn a_chosen_check_stays_until_it_passes() {
        let (mut app, _) = App::new(Some(1), (80, 24));
        all(&mut app, &failed());
        end(&mut app);
        app.key(KeyCode::Char('n'));
        assert_eq!(app.saved(), Action::Start(Task::Check(vec![1])));
        end(&mut app);
        assert_eq!(app.check, 1, "it still fails");
        tell(&mut app, 1, Verdict::Passed);
        end(&mut app);
        assert_eq!(app.check, 0, "it passes, so the first one that does not comes next");
        assert!(app.note.starts_with("passes now: "), "{}", app.note);
    }

    #[test]
    fn next_goes_on_to_the_next_stage_when_a_stage_is_done() {
        let (mut app, _) = App::new(Some(1), (80, 24));
        all(&mut app, &Verdict::Passed);
        assert_eq!(end(&mut app), Action::Nothing, "a stage that was asked for stays");
        assert_eq!(app.key(KeyCode::Char('n')), Action::Start(Task::Check(vec![2, 1])));
    }

    #[test]
    fn the_last_check_of_a_stage_leads_to_its_picture_once() {
        let (mut app, _) = App::new(Some(1), (80, 24));
        all(&mut app, &Verdict::Passed);
        tell(&mut app, 2, failed());
        assert_eq!(end(&mut app), Action::Nothing);
        tell(&mut app, 2, Verdict::Passed);
        assert_eq!(end(&mut app), Action::Start(Task::Render(1, "out/album/stage1.png".into())));
        app.event(Event::Picture(Picture::default()));
        assert!(matches!(app.page, Page::Picture { picture: Some(_), is_finish: true }));
        assert_eq!(app.saved(), Action::Start(Task::Check(vec![1])), "a save leads back to the checks");
        assert_eq!(end(&mut app), Action::Nothing, "it was done before");
        assert_eq!(app.key(KeyCode::Char('n')), Action::Start(Task::Check(vec![2, 1])));
    }

    #[test]
    fn the_list_is_searched_and_leads_to_a_check() {
        let (mut app, _) = App::new(Some(1), (80, 24));
        app.key(KeyCode::Char('l'));
        app.key(KeyCode::Char('/'));
        "refract".chars().for_each(|sign| _ = app.key(KeyCode::Char(sign)));
        let found = app.listed("refract");
        assert!(!found.is_empty() && found.len() < 40, "{}", found.len());
        app.key(KeyCode::Down);
        let action = app.key(KeyCode::Enter);
        assert_eq!((app.stage, app.check), found[1]);
        assert!(matches!(action, Action::Start(Task::Check(stages)) if stages[0] == app.stage().number));
        assert_eq!(app.page, Page::CHECK);
    }

    #[test]
    fn hints_come_one_at_a_time() {
        let (mut app, _) = App::new(Some(1), (80, 24));
        for hints in [1, 2, 3, 1] {
            app.key(KeyCode::Char('h'));
            assert_eq!(app.page, Page::Check { hints, unfolded: false });
        }
    }

    #[test]
    fn the_picture_is_rendered_again_at_each_save() {
        let (mut app, _) = App::new(Some(4), (80, 24));
        let render = Action::Start(Task::Render(4, "out/watch.png".into()));
        assert_eq!(app.key(KeyCode::Char('v')), render);
        assert_eq!(app.saved(), render);
        app.event(Event::Picture(Picture::default()));
        assert!(matches!(app.page, Page::Picture { picture: Some(_), .. }));
        assert_eq!(
            app.key(KeyCode::Char('v')),
            Action::Start(Task::Check(vec![4, 1, 2, 3])),
            "back to the checks"
        );
    }

    #[test]
    fn the_editor_opens_the_error_the_gap_or_the_function() {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(root.path().join("exercises/src")).unwrap();
        let file = root.path().join("exercises/src/stage1_shapes.rs");
        std::fs::write(file, "\n\npub fn sphere_geometric(\n").unwrap();
        let (mut app, _) = App::new(Some(1), (80, 24));
        assert_eq!(app.place(root.path()), ("exercises/src/stage1_shapes.rs".into(), 1));
        let place = "exercises/src/stage1_shapes.rs:23".to_owned();
        tell(&mut app, 0, Verdict::NotWritten { task: "write it".into(), place });
        assert_eq!(app.place(root.path()), ("exercises/src/stage1_shapes.rs".into(), 23));
        let message = "stage 1 · a law\n  input     sphere_geometric(&Ray::new())\n";
        tell(&mut app, 0, Verdict::Failed(message.into()));
        assert_eq!(app.place(root.path()), ("exercises/src/stage1_shapes.rs".into(), 3));
        let (what, code, notes) = ("wrong".to_owned(), String::new(), Vec::new());
        let place = "src/stage1_shapes.rs:7:9".to_owned();
        app.event(Event::Errors(vec![CompilerError { place, what, code, notes }]));
        assert_eq!(app.place(root.path()), ("exercises/src/stage1_shapes.rs".into(), 7));
    }

    #[test]
    fn a_function_is_reset_only_after_a_yes() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        std::fs::create_dir_all(at("exercises/src")).unwrap();
        std::fs::create_dir_all(at("tests")).unwrap();
        let file = at("exercises/src/stage1_shapes.rs");
        std::fs::write(&file, "pub fn nearest_root() -> u8 {\n    1\n}\n").unwrap();
        let stub = "pub fn nearest_root() -> u8 {\n    todo!()\n}\n";
        std::fs::write(at("tests/stubs.toml"), format!("[stage1_shapes]\nnearest_root = '''\n{stub}'''\n"))
            .unwrap();
        let (mut app, _) = App::new(Some(1), (80, 24));
        tell(&mut app, 0, Verdict::Failed("stage 1\n  input     nearest_root()\n".into()));
        for (key, action) in [('n', Action::Nothing), ('y', Action::Reset)] {
            assert_eq!(app.key(KeyCode::Char('r')), Action::AskReset);
            app.ask_reset(root.path());
            assert!(
                matches!(&app.page, Page::Reset { name, .. } if name == "nearest_root"),
                "{:?}",
                app.page
            );
            assert_eq!(app.key(KeyCode::Char(key)), action);
        }
        app.reset(root.path());
        assert_eq!(std::fs::read_to_string(file).unwrap(), stub);
        assert_eq!(app.note, "the old text: out/before-reset-1/stage1_shapes.rs");
    }
}
