//! The program from outside, with a small script in place of cargo and one in place of the judge: saves, errors of the
//! compiler, and runs that never end. Once in lines, and once on a screen.

#![cfg(unix)]

mod kit_folder;

use kit_folder::{KitFolder, PATIENCE, Running, runs};
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// The script in place of cargo: the first line of the exercise decides.
const CARGO: &str = r#"#!/bin/sh
case "$(head -n 1 exercises/src/stage1_shapes.rs)" in
    *error*) cat error.json; exit 101 ;;
    *loop*) echo $$ > looping; exec sleep 1000 ;;
esac
echo '{"reason":"compiler-artifact","target":{"name":"exercises-worker"},"executable":"'"$PWD"'/target/debug/exercises-worker"}'
"#;

const ERROR: &str = r#"{"reason":"compiler-message","message":{"level":"error","message":"mismatched types","spans":[{"is_primary":true,"file_name":"exercises/src/stage1_shapes.rs","line_start":1,"column_start":4,"label":"expected f32","text":[{"text":"// error"}]}],"children":[]}}"#;

/// The script in place of the judge: it sends the verdicts for the first line of the exercise.
const JUDGE: &str = r#"#!/bin/sh
[ "$1" = try ] && echo "$4 returns None" && exit 1
case "$(head -n 1 "$2/exercises/src/stage1_shapes.rs")" in
    *right*) cat "$2/right" ;;
    *) cat "$2/wrong" ;;
esac
"#;

/// A kit in a temporary folder.
fn new_kit() -> KitFolder {
    let kit = KitFolder::with(&["exercises/src", "target/debug"]);
    kit.write("error.json", ERROR);
    kit.script("cargo", CARGO);
    kit.script("target/debug/judge", JUDGE);
    kit.program("target/debug/watch", Path::new(env!("CARGO_BIN_EXE_watch")));
    kit.verdicts("right", None);
    let message = "stage 1 · a law\n  slides: a slide\n  input     nearest_root()\n  yours     None\n";
    kit.verdicts("wrong", Some((1, message)));
    save(&kit, "// wrong");
    kit
}

/// Writes the exercise.
fn save(kit: &KitFolder, first: &str) {
    kit.save(&format!("{first}\npub fn nearest_root() {{}}"));
}

fn watch(kit: &KitFolder) -> Command {
    let mut command = Command::new(kit.path("target/debug/watch"));
    command
        .arg(kit.root())
        .arg(kit.path("target/debug/judge"))
        .arg("1")
        .env("CARGO", kit.path("cargo"))
        .env("LANG", "C.UTF-8");
    command.env("TERM", "xterm").env("COLORTERM", "").env_remove("NO_COLOR").env_remove("LC_ALL");
    command
}

/// What a program writes, as it comes.
struct Output {
    pieces: Receiver<Vec<u8>>,
    text: String,
}

impl Output {
    fn of(mut from: impl Read + Send + 'static) -> Output {
        let (sender, pieces) = channel();
        std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(n @ 1..) = from.read(&mut buffer) {
                if sender.send(buffer[..n].to_vec()).is_err() {
                    return;
                }
            }
        });
        Output { pieces, text: String::new() }
    }

    /// Waits for these words, and forgets everything up to them.
    fn wait_for(&mut self, words: &str) {
        let begin = Instant::now();
        while !self.text.contains(words) {
            assert!(begin.elapsed() < PATIENCE, "no `{words}` in:\n{}", self.text);
            if let Ok(piece) = self.pieces.recv_timeout(Duration::from_millis(100)) {
                self.text += &String::from_utf8_lossy(&piece);
            }
        }
        let end = self.text.find(words).unwrap() + words.len();
        self.text.drain(..end);
    }
}

#[test]
fn without_a_terminal_each_save_gives_lines() {
    let kit = new_kit();
    let mut child =
        watch(&kit).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::inherit()).spawn().unwrap();
    let mut output = Output::of(child.stdout.take().unwrap());
    let _running = Running(child);
    output.wait_for("stage 1 · shapes: ");
    output.wait_for("  yours     None");
    save(&kit, "// an error");
    output.wait_for("does not compile: 1 error\n\nmismatched types\n  exercises/src/stage1_shapes.rs:1:4\n");
    // A run that never ends is ended by the next save.
    save(&kit, "// a loop");
    let looping = kit.wait_for_file("looping");
    assert!(runs(&looping));
    save(&kit, "// it is right");
    output.wait_for("Stage 1 is done.");
    assert!(!runs(&looping), "the run before the save is still there");
}

#[test]
fn on_a_screen_keys_change_what_is_shown() {
    let kit = new_kit();
    let size = nix::pty::Winsize { ws_row: 24, ws_col: 80, ws_xpixel: 0, ws_ypixel: 0 };
    let pty = nix::pty::openpty(Some(&size), None).unwrap();
    let side = || Stdio::from(pty.slave.try_clone().unwrap());
    let child = watch(&kit).stdin(side()).stdout(side()).stderr(side()).spawn().unwrap();
    let mut running = Running(child);
    let mut keys = fs::File::from(pty.master.try_clone().unwrap());
    let mut output = Output::of(fs::File::from(pty.master));
    output.wait_for("FAILS: ");
    output.wait_for("  yours     None");
    for (typed, answer) in [
        ("h", "hint 1: "),
        ("t", " returns None"),
        ("\x1b", "FAILS: "),
        ("l/refract", "search: refract_"),
        ("\x1b", "search: \x1b"),
        ("l", "FAILS: "),
    ] {
        keys.write_all(typed.as_bytes()).unwrap();
        output.wait_for(answer);
    }
    save(&kit, "// it is right");
    output.wait_for("Stage 1 is done.");
    // The screen that was there before comes back.
    keys.write_all(b"q").unwrap();
    output.wait_for("\x1b[?1049l");
    assert!(running.0.wait().unwrap().success());
}
