//! The command line of a program with many commands: `raykata`, `grader` and `author`.

use crate::args::{Given, Misuse, Read, Spec, did_you_mean, entry};
use crate::report::{lost, say};
use anyhow::Result;
use std::ffi::OsString;
use std::process::ExitCode;

/// A command and its function.
pub type Command<T> = (&'static Spec, fn(&Given) -> Result<T>);

/// A program whose commands return a `T`.
pub struct Program<T: 'static> {
    /// The word that starts it.
    pub name: &'static str,
    /// The first paragraphs of the help.
    pub about: &'static str,
    /// What `--help` of a command does, for the last line of the help.
    pub help_explains: &'static str,
    /// All commands, in the order of the help. A name of two words is a subcommand or a command in a group.
    pub commands: &'static [Command<T>],
    /// Groups: words that begin the names of commands but are not commands themselves, with descriptions.
    pub groups: &'static [(&'static str, &'static str)],
    /// What the program does without a command; `None` if that is an error.
    pub without_command: Option<fn() -> Result<ExitCode>>,
    /// For a word that is no command: where that command is, as the end of the message, or as the whole message.
    pub elsewhere: fn(&str) -> Result<String, Misuse>,
    /// The exit code for the result of a command.
    pub ends: fn(T) -> ExitCode,
}

/// The exit code of a command that has succeeded or not.
pub fn exit_code(succeeded: bool) -> ExitCode {
    if succeeded { ExitCode::SUCCESS } else { ExitCode::from(1) }
}

/// The main function of a program without commands, whose result is an error or success.
pub fn ended(result: Result<bool>) -> ExitCode {
    match result {
        Ok(succeeded) => exit_code(succeeded),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(1)
        }
    }
}

/// Returns the words that start a command, without the name of the program.
fn words_of(spec: &Spec) -> &'static str {
    spec.name.split_once(' ').map_or(spec.name, |(_, words)| words)
}

impl<T> Program<T> {
    /// The main function of the program.
    pub fn main(&self) -> ExitCode {
        let result = self.run(std::env::args_os().skip(1).collect());
        if let Some(error) = lost() {
            eprintln!("error: the output cannot be written: {error}");
            return ExitCode::from(1);
        }
        match result {
            Ok(code) => code,
            Err(error) => {
                eprintln!("error: {error:#}");
                ExitCode::from(if error.is::<Misuse>() { 2 } else { 1 })
            }
        }
    }

    fn run(&self, words: Vec<OsString>) -> Result<ExitCode> {
        let Some((first, rest)) = words.split_first() else {
            return match self.without_command {
                Some(work) => work(),
                None => {
                    let message = format!("a command is missing\n\n{}", self.help().trim_end());
                    Err(Misuse::new(message).into())
                }
            };
        };
        let asks_for_help = |word: &OsString| ["help", "--help", "-h"].iter().any(|help| word == help);
        match (&*first.to_string_lossy(), rest) {
            ("--help" | "-h", _) | ("help", []) => say(format_args!("{}", self.help())),
            ("--version" | "-V", _) => say(format_args!("{} {}\n", self.name, env!("CARGO_PKG_VERSION"))),
            ("help", words) => say(format_args!("{}", self.help_for(words)?)),
            (name, [second, rest @ ..]) if asks_for_help(second) && self.has_commands(name) => {
                let words: Vec<OsString> = [first].into_iter().chain(rest).cloned().collect();
                say(format_args!("{}", self.help_for(&words)?));
            }
            _ => {
                let ((spec, work), rest) = self.find(&words)?;
                match spec.read(rest.iter().cloned())? {
                    Read::Help(help) => say(format_args!("{help}")),
                    Read::Given(given) => return work(&given).map(self.ends),
                }
            }
        }
        Ok(ExitCode::SUCCESS)
    }

    /// Returns the subcommands of this command, with their second words.
    fn below(&self, name: &str) -> impl Iterator<Item = (&'static str, &'static Command<T>)> {
        let second = move |command: &'static Command<T>| {
            let (first, second) = words_of(command.0).split_once(' ')?;
            (first == name).then_some((second, command))
        };
        self.commands.iter().filter_map(second)
    }

    fn has_commands(&self, name: &str) -> bool {
        self.below(name).next().is_some()
    }

    /// Returns the command with which a line begins, and the rest of the line.
    fn find<'l>(&self, line: &'l [OsString]) -> Result<(&'static Command<T>, &'l [OsString]), Misuse> {
        let word = |place: usize| line.get(place).map_or("".into(), |word| word.to_string_lossy());
        let (first, second) = (word(0), word(1));
        if let Some((_, command)) = self.below(&first).find(|(name, _)| *name == second) {
            return Ok((command, &line[2..]));
        }
        if let Some(command) = self.commands.iter().find(|(spec, _)| words_of(spec) == first) {
            return Ok((command, &line[1..]));
        }
        let elsewhere = (self.elsewhere)(&first)?;
        let (name, unknown, known): (String, _, Vec<&str>) = if self.has_commands(&first) {
            (format!("{} {first}", self.name), second, self.below(&first).map(|(name, _)| name).collect())
        } else {
            let commands = self.commands.iter().map(|(spec, _)| words_of(spec));
            let groups = self.groups.iter().map(|(name, _)| *name);
            (self.name.into(), first, commands.chain(groups).collect())
        };
        let wrong = match unknown.is_empty() {
            true => format!("a command is missing; the commands are {}", known.join(", ")),
            false => format!("there is no command `{unknown}`{}{elsewhere}", did_you_mean(&unknown, &known)),
        };
        Err(Misuse::new(format!(
            "{wrong}\n\nUsage: {name} {}\n\nFor more information, try `{name} --help`.",
            self.command_word()
        )))
    }

    /// Returns the help of a command or of a group.
    fn help_for(&self, words: &[OsString]) -> Result<String, Misuse> {
        let first = words.first().map_or("".into(), |word| word.to_string_lossy());
        let group = self.groups.iter().find(|(name, _)| *name == first && words.len() == 1);
        let text = match group {
            Some((name, about)) => format!("{about}\n\nUsage: {} {name} COMMAND\n", self.name),
            None => self.find(words)?.0.0.help(),
        };
        let commands: String = match words.len() {
            1 => self.below(&first).map(|(name, (spec, _))| entry(name, spec.about)).collect(),
            _ => String::new(),
        };
        Ok(if commands.is_empty() { text } else { format!("{text}\nCommands:\n{commands}") })
    }

    fn command_word(&self) -> &'static str {
        if self.without_command.is_some() { "[COMMAND]" } else { "COMMAND" }
    }

    fn help(&self) -> String {
        let commands: String =
            self.commands.iter().map(|(spec, _)| entry(words_of(spec), spec.about)).collect();
        let Program { name, about, help_explains, .. } = self;
        format!(
            "{about}\n\nUsage: {name} {}\n\nCommands:\n{commands}\nOptions:\n{}{}\n`{name} COMMAND --help` \
             {help_explains}\n",
            self.command_word(),
            entry("-h, --help", "Print this help."),
            entry("-V, --version", "Print the version.")
        )
    }
}
