//! The program from outside, with a small script in place of cargo and one in place of the judge: saves, errors of the
//! compiler, and runs that never end. Once in lines, and once on a screen.

#![cfg(unix)]

mod kit_folder;

use kit_folder::KitFolder;
use raykata::worker::send;
use raykata_cli::verdicts::{CheckVerdict, Verdict};
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// The longest time that anything may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// The script in place of cargo: the first line of the exercise decides.
const CARGO: &str = r#"#!/bin/sh
case "$(head -n 1 exercises/src/stage1_shapes.rs)" in
    *error*) cat error.json; exit 101 ;;
    *loop*) echo $$ > looping; exec sleep 1000 ;;
esac
"#;

const ERROR: &str = r#"{"reason":"compiler-message","message":{"level":"error","message":"mismatched types","spans":[{"is_primary":true,"file_name":"exercises/src/stage1_shapes.rs","line_start":1,"column_start":4,"label":"expected f32","text":[{"text":"// error"}]}],"children":[]}}"#;

/// The script in place of the judge: it sends the verdicts for the first line of the exercise.
const JUDGE: &str = r#"#!/bin/sh
case "$(head -n 1 "$2/exercises/src/stage1_shapes.rs")" in
    *right*) cat "$2/right" ;;
    *) cat "$2/wrong" ;;
esac
"#;

/// A kit in a temporary folder.
struct Kit(KitFolder);

impl std::ops::Deref for Kit {
    type Target = KitFolder;

    fn deref(&self) -> &KitFolder {
        &self.0
    }
}

impl Kit {
    fn new() -> Kit {
        let kit = Kit(KitFolder::with(&["exercises/src", "target/debug"]));
        kit.write("error.json", ERROR);
        kit.script("cargo", CARGO);
        kit.script("target/debug/judge", JUDGE);
        kit.program("target/debug/watch", Path::new(env!("CARGO_BIN_EXE_watch")));
        // One verdict for each check of stage 1: all pass, or the second one fails.
        let stage = raykata::rubric::stages().into_iter().next().unwrap().1;
        for file in ["right", "wrong"] {
            let mut bytes = Vec::new();
            for (index, (check, _)) in stage.in_order().into_iter().enumerate() {
                let message =
                    "stage 1 · a law\n  slides: a slide\n  input     nearest_root()\n  yours     None\n";
                let fails = file == "wrong" && index == 1;
                let verdict = if fails { Verdict::Failed(message.into()) } else { Verdict::Passed };
                send(&mut bytes, &CheckVerdict { check: check.into(), verdict }).unwrap();
            }
            fs::write(kit.path(file), bytes).unwrap();
        }
        kit.save("// wrong");
        kit
    }

    /// Writes the exercise. The lengths differ, so that the change is seen where times are coarse.
    fn save(&self, first: &str) {
        self.write("exercises/src/stage1_shapes.rs", &format!("{first}\npub fn nearest_root() {{}}\n"));
    }

    fn watch(&self) -> Command {
        let mut command = Command::new(self.path("target/debug/watch"));
        command.arg(self.root()).arg("1").env("CARGO", self.path("cargo")).env("LANG", "C.UTF-8");
        command.env("TERM", "xterm").env("COLORTERM", "").env_remove("NO_COLOR").env_remove("LC_ALL");
        command
    }
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
            if begin.elapsed() > PATIENCE {
                let end: String =
                    self.text.chars().rev().take(3000).collect::<Vec<_>>().into_iter().rev().collect();
                panic!("no `{words}` at the end of:\n{end}");
            }
            if let Ok(piece) = self.pieces.recv_timeout(Duration::from_millis(100)) {
                self.text += &String::from_utf8_lossy(&piece);
            }
        }
        let end = self.text.find(words).unwrap() + words.len();
        self.text.drain(..end);
    }
}

/// Waits until a file exists, and returns its text.
fn wait_for_file(file: &Path) -> String {
    let begin = Instant::now();
    loop {
        match fs::read_to_string(file) {
            Ok(text) if text.ends_with('\n') => return text,
            _ => assert!(begin.elapsed() < PATIENCE, "no {}", file.display()),
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Whether a process runs.
fn runs(id: &str) -> bool {
    let id = id.trim().parse().unwrap();
    nix::sys::signal::kill(nix::unistd::Pid::from_raw(id), None).is_ok()
}

/// Ends a program when the test ends.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn without_a_terminal_each_save_gives_lines() {
    let kit = Kit::new();
    let mut child =
        kit.watch().stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::inherit()).spawn().unwrap();
    let mut output = Output::of(child.stdout.take().unwrap());
    let _running = Running(child);
    output.wait_for("stage 1 · shapes: ");
    output.wait_for("  yours     None");
    kit.save("// an error");
    output.wait_for("does not compile\nexercises/src/stage1_shapes.rs:1:4\n  mismatched types");
    // A run that never ends is ended by the next save.
    kit.save("// a loop");
    let looping = wait_for_file(&kit.path("looping"));
    assert!(runs(&looping));
    kit.save("// it is right");
    output.wait_for("Stage 1 is done.");
    assert!(!runs(&looping), "the run before the save is still there");
}

#[test]
fn on_a_screen_keys_change_what_is_shown() {
    let kit = Kit::new();
    let size = nix::pty::Winsize { ws_row: 24, ws_col: 80, ws_xpixel: 0, ws_ypixel: 0 };
    let pty = nix::pty::openpty(Some(&size), None).unwrap();
    let side = || Stdio::from(pty.slave.try_clone().unwrap());
    let child = kit.watch().stdin(side()).stdout(side()).stderr(side()).spawn().unwrap();
    let mut running = Running(child);
    let mut keys = fs::File::from(pty.master.try_clone().unwrap());
    let mut output = Output::of(fs::File::from(pty.master));
    output.wait_for("FAILS: ");
    output.wait_for("  yours     None");
    keys.write_all(b"h").unwrap();
    output.wait_for("hint 1: ");
    keys.write_all(b"l/refract").unwrap();
    output.wait_for("search: refract_");
    keys.write_all(b"\x1b").unwrap();
    output.wait_for("search: \x1b");
    keys.write_all(b"l").unwrap();
    output.wait_for("FAILS: ");
    kit.save("// it is right");
    output.wait_for("Stage 1 is done.");
    // The screen that was there before comes back.
    keys.write_all(b"q").unwrap();
    output.wait_for("\x1b[?1049l");
    assert!(running.0.wait().unwrap().success());
}
