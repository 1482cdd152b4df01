//! The command line of a program with many commands: `grader` and `author`.

use crate::kits::root;
use anyhow::Result;
use raykata_cli::args::{Given, Misuse, Read, Spec, did_you_mean, entry};
use raykata_cli::report::say;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

/// A command and its function, which returns whether it succeeded.
pub type Command = (&'static Spec, fn(&Given) -> Result<bool>);

/// A program.
pub struct Program {
    /// The word that starts it.
    pub name: &'static str,
    /// The first paragraph of the help.
    pub about: &'static str,
    /// All commands, in the order of the help. A name of two words is a subcommand or a command in a group.
    pub commands: &'static [Command],
    /// Groups: words that begin the names of commands but are not commands themselves, with descriptions.
    pub groups: &'static [(&'static str, &'static str)],
    /// Commands that another program has now, and that program.
    pub moved: (&'static [&'static str], &'static str),
}

/// Runs a command in the kit around the working folder. Errors of the command line are reported first, even outside of a
/// kit.
pub fn in_kit<T, R>(options: Result<T, Misuse>, work: impl FnOnce(&Path, &T) -> Result<R>) -> Result<R> {
    let options = options?;
    work(&root()?, &options)
}

/// The result of a command that always succeeds if there is no error.
pub fn done(result: Result<()>) -> Result<bool> {
    result.map(|()| true)
}

/// Returns the words that start a command, without the name of the program.
fn words_of(spec: &Spec) -> &'static str {
    spec.name.split_once(' ').map_or(spec.name, |(_, words)| words)
}

impl Program {
    /// The main function of the program.
    pub fn main(&self) -> ExitCode {
        // If this process was started as a launcher of untrusted code or as the syntax check, it does only that.
        #[cfg(target_os = "linux")]
        {
            crate::sandbox::launch_if_asked();
            crate::grade::lint_if_asked();
        }
        match self.run(std::env::args_os().skip(1).collect()) {
            Ok(true) => ExitCode::SUCCESS,
            Ok(false) => ExitCode::from(1),
            Err(error) => {
                eprintln!("error: {error:#}");
                ExitCode::from(if error.is::<Misuse>() { 2 } else { 1 })
            }
        }
    }

    /// Runs the command line. Returns whether the command succeeded.
    fn run(&self, words: Vec<OsString>) -> Result<bool> {
        let Some((first, rest)) = words.split_first() else {
            return Err(Misuse::new(format!("a command is missing\n\n{}", self.help().trim_end())).into());
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
                    Read::Given(given) => return work(&given),
                }
            }
        }
        Ok(true)
    }

    /// Returns the subcommands of this command, with their second words.
    fn below(&self, name: &str) -> impl Iterator<Item = (&'static str, &'static Command)> {
        let second = move |command: &'static Command| {
            let (first, second) = words_of(command.0).split_once(' ')?;
            (first == name).then_some((second, command))
        };
        self.commands.iter().filter_map(second)
    }

    fn has_commands(&self, name: &str) -> bool {
        self.below(name).next().is_some()
    }

    /// Returns the command with which a line begins, and the rest of the line.
    fn find<'l>(&self, line: &'l [OsString]) -> Result<(&'static Command, &'l [OsString]), Misuse> {
        let word = |place: usize| line.get(place).map_or("".into(), |word| word.to_string_lossy());
        let (first, second) = (word(0), word(1));
        if let Some((_, command)) = self.below(&first).find(|(name, _)| *name == second) {
            return Ok((command, &line[2..]));
        }
        if let Some(command) = self.commands.iter().find(|(spec, _)| words_of(spec) == first) {
            return Ok((command, &line[1..]));
        }
        let (moved, to) = self.moved;
        if moved.contains(&&*first) {
            return Err(Misuse::new(format!("this command moved: cargo run -p {to} -- {first}")));
        }
        let (usage, unknown, known): (String, _, Vec<&str>) = if self.has_commands(&first) {
            (format!("{} {first}", self.name), second, self.below(&first).map(|(name, _)| name).collect())
        } else {
            let groups = self.groups.iter().map(|(name, _)| *name);
            (
                self.name.into(),
                first,
                self.commands.iter().map(|(spec, _)| words_of(spec)).chain(groups).collect(),
            )
        };
        let wrong = match unknown.is_empty() {
            true => format!("a command is missing; the commands are {}", known.join(", ")),
            false => format!("there is no command `{unknown}`{}", did_you_mean(&unknown, &known)),
        };
        Err(Misuse::new(format!(
            "{wrong}\n\nUsage: {usage} COMMAND\n\nFor more information, try `{usage} --help`."
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

    fn help(&self) -> String {
        let commands: String =
            self.commands.iter().map(|(spec, _)| entry(words_of(spec), spec.about)).collect();
        let (name, about) = (self.name, self.about);
        format!(
            "{about}

Exit codes: 0 success; 1 failure, for example a submission could not be graded
or files differ; 2 the command line is wrong.

Usage: {name} COMMAND

Commands:
{commands}
Options:
{}{}
`{name} COMMAND --help` explains a command.
",
            entry("-h, --help", "Print this help."),
            entry("-V, --version", "Print the version.")
        )
    }
}
