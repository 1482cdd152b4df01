//! `raykata check`, `raykata try` and `raykata gauntlet`: start the judge, the program that contains the checks and the exact oracle. It is built when it is
//! needed, so that a picture does not wait for that.

use crate::args::{Argument, Given, Misuse, Opt, Spec};
use crate::kits::{Choice, Need, Program, Which, build, root, run_program};
use crate::list;
use anyhow::{Context, Result};
use raykata::message::Message;
use raykata::worker::{child, receive, send};
use std::ffi::OsStr;
use std::path::Path;
use std::process::{Child, ExitCode, Stdio};

/// `raykata check`.
pub static CHECK: Spec = Spec {
    name: "raykata check",
    about: "Grade your exercises and print the scorecard.",
    arguments: &[Argument::optional("STAGE", "One stage only, such as 3 or stage3; with --pixel, a check.")],
    options: &[PIXEL, Choice::OPTIONS],
};

const PIXEL: &[Opt] = &[Opt::value(
    "--pixel",
    "X,Y",
    "Ask for one pixel of the picture of a check again, and print each call with its input and your answer.",
)];

/// Runs the checks of a stage or of all, or asks for one pixel again; returns the exit code of the judge.
pub fn check(given: &Given) -> Result<ExitCode> {
    let which = Choice::read(given)?.or_exercises();
    if let Some(pixel) = given.path("--pixel") {
        let check = given.required(0).map_err(|_| {
            Misuse::new("`--pixel` needs the name of a check, as in `raykata check CHECK --pixel 12,7`")
        })?;
        return judge("pixel", which, &[check, pixel.as_os_str()]);
    }
    judge("check", which, list::stage(given)?.map(|stage| stage.to_string()).as_slice())
}

/// `raykata try`.
pub static TRY: Spec = Spec {
    name: "raykata try",
    about: "Call your function again with the input of a failing check, alone, and show what it prints: println!, dbg! and panics.",
    arguments: &[Argument::required("CHECK", "Its name, as `raykata list` and failing tests print it.")],
    options: &[Choice::OPTIONS],
};

/// Calls the function of a failing check again; returns the exit code of the judge.
pub fn try_again(given: &Given) -> Result<ExitCode> {
    judge("try", Choice::read(given)?.or_exercises(), &[given.required(0)?])
}

/// `raykata gauntlet`.
pub static GAUNTLET: Spec = Spec {
    name: "raykata gauntlet",
    about: "Measure the accuracy of your ray/triangle tests on hard inputs, against exact arithmetic.",
    arguments: &[],
    options: &[
        &[
            Opt::value(
                "--inputs",
                "N",
                "Inputs per distribution, and rays per closed mesh [default: 20000].",
            ),
            Opt::value("--seed", "N", "Seed of the inputs [default: 1]."),
        ],
        Choice::OPTIONS,
    ],
};

/// Runs the gauntlet; returns the exit code of the judge.
pub fn gauntlet(given: &Given) -> Result<ExitCode> {
    let inputs = given.number("--inputs", 100..=u64::MAX)?.unwrap_or(20_000).to_string();
    let seed = given.number("--seed", 0..=u64::MAX)?.unwrap_or(1).to_string();
    judge("gauntlet", Choice::read(given)?.or_exercises(), &[inputs, seed])
}

/// Shows the points of the exercises and the next step; returns the exit code of the judge.
pub fn status() -> Result<ExitCode> {
    judge::<&str>("status", Which::Exercises, &[])
}

/// Runs the judge with a command such as `check` on a kit, and returns its exit code.
fn judge<S: AsRef<OsStr>>(what: &str, which: Which, more: &[S]) -> Result<ExitCode> {
    let root = root()?;
    let whose = match which {
        Which::Exercises => "your exercises and their judge",
        Which::Solutions => "the solutions and their judge",
    };
    let [judge, worker] = build(&root, whose, [Program::JUDGE, Program::worker(which, Need::Checks)])?;
    let words = [OsStr::new(what), root.as_os_str(), worker.as_os_str()];
    run_program(&judge, words.into_iter().chain(more.iter().map(AsRef::as_ref)))
}

/// A judge that gets requests through its standard input and answers through its standard output.
pub struct Judge(Child);

impl Judge {
    /// Starts the judge with this command.
    pub fn start(root: &Path, what: &str) -> Result<Judge> {
        let [program] = build(root, "the judge of your exercises", [Program::JUDGE])?;
        let child = child(&program).arg(what).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        Ok(Judge(child.with_context(|| format!("{} cannot be started", program.display()))?))
    }

    /// Sends a message to the judge.
    pub fn send<T: Message>(&mut self, message: &T) -> Result<()> {
        let pipe = self.0.stdin.as_mut().context("the judge has no standard input")?;
        send(pipe, message).context("the judge accepts no message")
    }

    /// The next message of the judge.
    pub fn receive<T: Message>(&mut self) -> Result<T> {
        let pipe = self.0.stdout.as_mut().context("the judge has no standard output")?;
        receive(pipe).context("the judge does not answer")
    }
}

impl Drop for Judge {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
