//! The command line: the commands and their options, their help, and the values that were given. It is
//! written by hand, because a general command line parser takes longer to build than the rest of this
//! program.

mod given;

pub use given::{Given, chosen, names, whole_number};
use std::ffi::OsString;
use std::fmt::{self, Display, Write};

/// The width of the help text, in columns.
const WIDTH: usize = 80;

/// The column at which the explanation of an option begins.
const HELP_COLUMN: usize = 26;

/// A command.
#[derive(Debug)]
pub struct Spec {
    /// The words that start it, such as `raykata render`.
    pub name: &'static str,
    /// What it does, in one sentence.
    pub about: &'static str,
    /// The arguments without a name, in their order.
    pub arguments: &'static [Argument],
    /// The options; commands share some of these lists.
    pub options: &'static [&'static [Opt]],
}

/// A value without a name.
#[derive(Debug)]
pub struct Argument {
    /// Its name in the help.
    pub name: &'static str,
    /// Whether the command needs it.
    pub required: bool,
    /// Whether it can be repeated; only the last argument can.
    pub many: bool,
    /// The explanation in the help.
    pub help: &'static str,
}

/// An option: a flag, or a name with a value.
#[derive(Debug)]
pub struct Opt {
    long: &'static str,
    short: Option<&'static str>,
    value: Option<&'static str>,
    choices: &'static [&'static str],
    many: bool,
    required: bool,
    earlier: Option<fn(&str, &str) -> Option<String>>,
    help: &'static str,
}

impl Argument {
    /// A value that must be given.
    pub const fn required(name: &'static str, help: &'static str) -> Argument {
        Argument { name, required: true, many: false, help }
    }

    /// A value that may be given.
    pub const fn optional(name: &'static str, help: &'static str) -> Argument {
        Argument { name, required: false, many: false, help }
    }

    /// The same, but it can be repeated.
    pub const fn many(self) -> Argument {
        Argument { many: true, ..self }
    }
}

impl Opt {
    /// An option without a value; `long` begins with two dashes.
    pub const fn flag(long: &'static str, help: &'static str) -> Opt {
        Opt {
            long,
            short: None,
            value: None,
            choices: &[],
            many: false,
            required: false,
            earlier: None,
            help,
        }
    }

    /// An option with a value, which the help calls `value`.
    pub const fn value(long: &'static str, value: &'static str, help: &'static str) -> Opt {
        Opt { value: Some(value), ..Opt::flag(long, help) }
    }

    /// The same with a short name, such as `-o`.
    pub const fn short(self, short: &'static str) -> Opt {
        Opt { short: Some(short), ..self }
    }

    /// The same with the list of its possible values.
    pub const fn choices(self, choices: &'static [&'static str]) -> Opt {
        Opt { choices, ..self }
    }

    /// The same with several values: it can be repeated, and [`Given::list`] splits values at commas.
    pub const fn many(self) -> Opt {
        Opt { many: true, ..self }
    }

    /// The same, but the command needs it: see [`Given::required_path`].
    pub const fn required(self) -> Opt {
        Opt { required: true, ..self }
    }

    /// The same with the answer to an unknown option and its value: `None`, or what replaces an option of an earlier version.
    pub const fn earlier(self, answer: fn(&str, &str) -> Option<String>) -> Opt {
        Opt { earlier: Some(answer), ..self }
    }

    fn is(&self, name: &str) -> bool {
        self.long == name || self.short == Some(name)
    }
}

/// A command line that was not understood: the program prints the reason and ends with code 2.
#[derive(Debug)]
pub struct Misuse(String);

impl Misuse {
    /// An error with this message.
    pub fn new(message: impl Into<String>) -> Misuse {
        Misuse(message.into())
    }
}

impl Display for Misuse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Misuse {}

/// The result of reading a command line.
#[derive(Debug)]
pub enum Read {
    /// The help of the command was requested.
    Help(String),
    /// The values that were given.
    Given(Given),
}

impl Spec {
    fn all_options(&self) -> impl Iterator<Item = &'static Opt> {
        self.options.iter().flat_map(|options| options.iter())
    }

    /// Sorts the words of a command line into arguments and options.
    pub fn read(&'static self, words: impl IntoIterator<Item = OsString>) -> Result<Read, Misuse> {
        let mut given = Given { spec: self, arguments: Vec::new(), options: Vec::new() };
        let mut words = words.into_iter();
        let mut only_arguments = false;
        while let Some(word) = words.next() {
            let text = word.to_string_lossy().into_owned();
            if only_arguments || !text.starts_with('-') || text == "-" {
                let repeats = self.arguments.last().is_some_and(|last| last.many);
                if given.arguments.len() >= self.arguments.len() && !repeats {
                    return Err(self.misuse(format!("unexpected argument `{text}`")));
                }
                given.arguments.push(word);
                continue;
            }
            if text == "--" {
                only_arguments = true;
                continue;
            }
            if text == "--help" || text == "-h" {
                return Ok(Read::Help(self.help()));
            }
            let (name, joined) = match text.split_once('=') {
                Some((name, value)) => (name, Some(OsString::from(value))),
                None => (text.as_str(), None),
            };
            let Some(option) = self.all_options().find(|option| option.is(name)) else {
                let value = joined.or_else(|| words.next()).map(|value| value.to_string_lossy().into_owned());
                let value = value.filter(|value| !value.starts_with("--")).unwrap_or("VALUE".into());
                return Err(self.unknown(name, &value));
            };
            let name = option.long;
            if !option.many && given.options.iter().any(|(known, _)| known.long == name) {
                return Err(self.misuse(format!("`{name}` is given twice")));
            }
            let value = match (option.value, joined) {
                (None, None) => OsString::new(),
                (None, Some(_)) => return Err(self.misuse(format!("`{name}` takes no value"))),
                (Some(_), Some(value)) => value,
                (Some(what), None) => match words.next() {
                    Some(value) if !value.to_string_lossy().starts_with("--") => value,
                    _ => return Err(self.misuse(format!("`{name}` needs a value: {name} {what}"))),
                },
            };
            given.options.push((option, value));
        }
        Ok(Read::Given(given))
    }

    fn unknown(&self, name: &str, value: &str) -> Misuse {
        if let Some(answer) = self.all_options().find_map(|option| option.earlier?(name, value)) {
            return Misuse(answer);
        }
        let known: Vec<&str> = self.all_options().map(|option| option.long).collect();
        self.misuse(format!("unexpected option `{name}`{}", did_you_mean(name, &known)))
    }

    fn misuse(&self, message: String) -> Misuse {
        Misuse(format!("{message}\n\n{}\n\nFor more information, try `{} --help`.", self.usage(), self.name))
    }

    fn usage(&self) -> String {
        let mut usage = format!("Usage: {}", self.name);
        if self.all_options().any(|option| !option.required) {
            usage += " [OPTIONS]";
        }
        for option in self.all_options().filter(|option| option.required) {
            usage += &format!(" {} {}", option.long, option.value.unwrap_or_default());
        }
        for argument in self.arguments {
            let name = argument.name;
            usage += &if argument.required { format!(" {name}") } else { format!(" [{name}]") };
            usage += if argument.many { "..." } else { "" };
        }
        usage
    }

    /// The help: all arguments and options with explanations.
    pub fn help(&self) -> String {
        let mut help = format!("{}\n\n{}\n", wrapped(self.about, 0), self.usage());
        if !self.arguments.is_empty() {
            help += "\nArguments:\n";
            for argument in self.arguments {
                help += &entry(argument.name, argument.help);
            }
        }
        help += "\nOptions:\n";
        for option in self.all_options() {
            let short = option.short.map_or(String::new(), |short| format!("{short}, "));
            let value = option.value.map_or(String::new(), |value| format!(" {value}"));
            let mut words = option.help.to_owned();
            if !option.choices.is_empty() {
                let _ = write!(words, " [one of: {}]", option.choices.join(", "));
            }
            help += &entry(&format!("{short}{}{value}", option.long), &words);
        }
        help + &entry("-h, --help", "Print this help.")
    }
}

/// One entry of the help: a command or option, and what it does.
pub fn entry(head: &str, words: &str) -> String {
    let head = format!("  {head}");
    let words = wrapped(words, HELP_COLUMN);
    if head.chars().count() + 2 > HELP_COLUMN {
        format!("{head}\n{:HELP_COLUMN$}{words}\n", "")
    } else {
        format!("{head:<HELP_COLUMN$}{words}\n")
    }
}

/// `words` wrapped to lines that end before column 80; all lines but the first begin at `column`.
pub fn wrapped(words: &str, column: usize) -> String {
    crate::report::lines(words, WIDTH - column, 0).join(&format!("\n{:column$}", ""))
}

/// `; did you mean …?`, if a known name is close.
pub fn did_you_mean(name: &str, known: &[&str]) -> String {
    let close = |known: &&&str| strsim::jaro_winkler(known, name) > 0.8;
    let by = |known: &&str| strsim::jaro_winkler(known, name);
    let best = known.iter().filter(close).max_by(|a, b| by(a).total_cmp(&by(b)));
    best.map_or(String::new(), |best| format!("; did you mean `{best}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    const COLOURS: [(&str, u8); 2] = [("red", 1), ("green", 2)];

    static SPEC: Spec = Spec {
        name: "tool paint",
        about: "Paint something.",
        arguments: &[Argument::required("WALL", "What to paint."), Argument::optional("COAT", "How thick.")],
        options: &[
            &[
                Opt::flag("--twice", "Paint it twice."),
                Opt::value("--out", "FILE", "Where it goes.").short("-o"),
            ],
            &[
                Opt::value("--colour", "NAME", "The colours.").choices(&names(&COLOURS)).many(),
                Opt::value(
                    "--width",
                    "N",
                    "How wide it is, from here to there and back, which takes a while to say.",
                ),
            ],
        ],
    };

    fn read(words: &[&str]) -> Result<Given, Misuse> {
        match SPEC.read(words.iter().map(OsString::from))? {
            Read::Given(given) => Ok(given),
            Read::Help(help) => Err(Misuse(help)),
        }
    }

    #[test]
    fn words_become_values() {
        let given = read(&["wall", "--colour", "red,green", "-o", "a b", "--twice", "--width=7"]).unwrap();
        assert_eq!(given.required(0).unwrap(), "wall");
        assert_eq!(given.argument(1), None);
        assert_eq!(given.choices("--colour", &COLOURS).unwrap(), [1, 2]);
        assert_eq!(given.path("--out"), Some("a b".into()));
        assert_eq!(given.number("--width", 1..=9u32).unwrap(), Some(7));
        assert!(given.has("--twice") && given.exclude("--twice", "--out").is_err());
        let given = read(&["--", "--twice"]).unwrap();
        assert!(given.required(0).unwrap() == "--twice" && !given.has("--twice"));
    }

    #[test]
    fn what_is_wrong_is_said_with_what_would_be_right() {
        let why = |words: &[&str]| read(words).map(|_| ()).unwrap_err().to_string();
        assert!(why(&["--color", "red"]).contains("unexpected option `--color`; did you mean `--colour`?"));
        assert!(why(&["a", "b", "c"]).contains("unexpected argument `c`"));
        assert!(why(&["--out"]).contains("`--out` needs a value: --out FILE"));
        assert!(why(&["--out", "--twice"]).contains("needs a value"));
        assert!(why(&["--twice=1"]).contains("takes no value"));
        assert!(why(&["--twice", "--twice"]).contains("twice"));
        assert!(why(&["-x"]).ends_with("For more information, try `tool paint --help`."));
        let given = read(&["--colour", "gren", "--width", "0"]).unwrap();
        let colour = given.choices("--colour", &COLOURS).unwrap_err().to_string();
        assert!(
            colour.starts_with("`--colour gren`: known are red, green; did you mean `green`?"),
            "{colour}"
        );
        assert!(given.number("--width", 1..=9u32).unwrap_err().to_string().contains("from 1 to 9"));
        assert!(given.required(0).unwrap_err().to_string().starts_with("WALL is missing"));
    }

    #[test]
    fn what_repeats_and_what_is_required() {
        static MIX: Spec = Spec {
            name: "tool mix",
            about: "Mix colours.",
            arguments: &[Argument::required("TIN", "The colours.").many()],
            options: &[&[
                Opt::value("--out", "FILE", "Where it goes.").required(),
                Opt::value("--rule", "OLD=NEW", "What becomes of a colour.").many(),
                Opt::flag("--dry", "Use no water."),
            ]],
        };
        let read = |words: &[&str]| match MIX.read(words.iter().map(OsString::from)) {
            Ok(Read::Given(given)) => given,
            other => panic!("{other:?}"),
        };
        let given = read(&["a", "--rule", "b=c,d", "e", "--rule=f=g", "--out", "h"]);
        assert_eq!(given.arguments(0), ["a", "e"]);
        assert_eq!(given.arguments(2), [""; 0]);
        let rules = given.repeated("--rule", |text| Ok::<_, String>(text.to_owned())).unwrap();
        assert_eq!(rules, ["b=c,d", "f=g"]);
        assert_eq!(given.required_path("--out").unwrap(), PathBuf::from("h"));
        assert!(given.require("--rule", "--out").is_ok() && given.require("--dry", "--rule").is_ok());
        assert!(
            given.require("--rule", "--dry").unwrap_err().to_string().starts_with("`--rule` needs `--dry`")
        );
        let missing = read(&["a"]).required_path("--out").unwrap_err().to_string();
        assert!(
            missing.starts_with("`--out` is missing\n\nUsage: tool mix [OPTIONS] --out FILE TIN...\n"),
            "{missing}"
        );
        assert!(read(&[]).required(0).unwrap_err().to_string().starts_with("TIN is missing"));
    }

    #[test]
    fn help_fits_a_terminal() {
        let help = read(&["--help"]).map(|_| ()).unwrap_err().to_string();
        assert!(help.lines().all(|line| line.chars().count() <= WIDTH), "{help}");
        for line in ["Usage: tool paint [OPTIONS] WALL [COAT]", "  -o, --out FILE          Where it goes."] {
            assert!(help.lines().any(|one| one == line), "no `{line}` in\n{help}");
        }
        assert!(help.contains("[one of: red, green]"), "{help}");
    }
}
