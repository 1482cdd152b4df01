//! `raykata view`: builds and starts the program that shows a picture in a browser while your exercises render it. It is built
//! when it is needed, so that a picture does not wait for that.

use crate::args::{Argument, Given, Spec};
use crate::kits::{Program, build, root};
use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::{Command, ExitCode};

/// `raykata view`.
pub static SPEC: Spec = Spec {
    name: "raykata view",
    about: "Show the picture of a scene in a browser while your exercises render it, again at each save.",
    arguments: &[Argument::optional(
        "SCENE",
        "The scene, a TOML file [default: that of the first stage that is not finished].",
    )],
    options: &[],
};

/// Starts the program, and returns its exit code.
pub fn run(given: &Given) -> Result<ExitCode> {
    let root = root()?;
    let mut words = vec![root.clone()];
    if let Some(scene) = given.argument(0).map(Path::new) {
        // The program watches this file, so its path must not depend on a folder.
        let path = scene.canonicalize();
        words.push(path.with_context(|| format!("the scene {} cannot be read", scene.display()))?);
    }
    let programs = build(&root, "the page", &[Program::VIEW])?;
    let [view] = &programs[..] else { bail!("the program was not built") };
    let status = Command::new(view).args(words).status();
    let status = status.with_context(|| format!("{} cannot be started", view.display()))?;
    // After Ctrl-C the program ends by itself.
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}
