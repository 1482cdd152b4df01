//! The program that `raykata view` starts: `view ROOT [SCENE]`. It serves a page to browsers of this machine, on which a picture
//! appears tile by tile while the exercises render it, again after each save.
//!
//! `secret` (port and token) · `http` (which requests are answered) · `server` (what the answers are) · `events` (messages to
//! pages) · `studio` (what is shown at the moment) · `run` (compile and render; a save cancels it) · `pixel` (rays and boxes
//! of a pixel) · `quick_tree` (the structure of the first pictures) · `reference` (the picture to compare with) · `reports` (those of `cost` and `compare`) · `page.html`

mod events;
mod http;
mod pixel;
mod quick_tree;
mod reference;
mod reports;
mod run;
mod secret;
mod server;
mod studio;

use anyhow::{Context, Result, bail};
use live::files::names_in;
use raykata_cli::program::ended;
use raykata_cli::report::say;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use studio::Studio;

fn main() -> ExitCode {
    ended(view().map(|()| true))
}

fn view() -> Result<()> {
    let words: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let (root, scene) = match &words[..] {
        [root] => (root.clone(), first_scene(root)),
        [root, scene] => (root.clone(), scene.clone()),
        _ => bail!("`raykata view` starts this program. It is not started by hand"),
    };
    let secret = secret::Secret::of(&root)?;
    let listener = listen(secret.port)?;
    let port = listener.local_addr().context("the port is unknown")?.port();
    // The token is part of the address, so the page stays open when this program is started again.
    secret.keep(&root, port)?;
    let studio = Arc::new(Studio::new(root, scene));
    // A second Ctrl-C ends the program at once, if the first one could not.
    let stopped = studio.clone();
    ctrlc::set_handler(move || {
        stopped.stop();
        std::process::exit(0);
    })
    .context("Ctrl-C cannot be handled")?;
    say(format_args!(
        "open this page in a browser: http://127.0.0.1:{port}/{}/\n\
         It follows your saves in exercises/src. Ctrl-C ends it.\n",
        secret.token
    ));
    let follower = studio.clone();
    std::thread::spawn(move || follower.follow());
    server::serve(&listener, port, &secret.token, &studio);
    Ok(())
}

/// Listens on this port, or on another one if it is in use; only for programs of this machine.
fn listen(port: u16) -> Result<TcpListener> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .or_else(|_| TcpListener::bind((Ipv4Addr::LOCALHOST, 0)))
        .context("no port of 127.0.0.1 can be used")
}

/// The scene of the first stage of the course in which a function is not written; the showcase if all are.
fn first_scene(root: &Path) -> PathBuf {
    let asked = raykata::rubric::stages();
    let folder = live::exercises(root);
    let open =
        |name: &String| std::fs::read_to_string(folder.join(name)).is_ok_and(|text| text.contains("todo!("));
    let stage = |name: String| name.strip_prefix("stage")?.split('_').next()?.parse().ok();
    let stages = names_in(&folder).into_iter().filter(open).filter_map(stage);
    let first = stages.filter(|stage| asked.iter().any(|(number, _)| number == stage)).min();
    raykata_cli::finish::scene_of(root, first.unwrap_or(u8::MAX))
}
