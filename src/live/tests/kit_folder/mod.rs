//! A kit in a temporary folder, with scripts in place of programs.

use raykata::worker::send;
use raykata_cli::verdicts::{CheckVerdict, Verdict};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

/// The longest time that anything may take on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Whether a process runs.
pub fn runs(id: &str) -> bool {
    nix::sys::signal::kill(nix::unistd::Pid::from_raw(id.parse().unwrap()), None).is_ok()
}

/// A program that ends when the test ends.
pub struct Running(pub Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The folder of the kit. It is removed at the end.
pub struct KitFolder(tempfile::TempDir);

impl KitFolder {
    /// An empty kit with these folders.
    pub fn with(folders: &[&str]) -> KitFolder {
        let kit = KitFolder(tempfile::tempdir().unwrap());
        for folder in folders {
            fs::create_dir_all(kit.path(folder)).unwrap();
        }
        kit
    }

    pub fn root(&self) -> &Path {
        self.0.path()
    }

    pub fn path(&self, path: &str) -> PathBuf {
        self.root().join(path)
    }

    pub fn write(&self, path: &str, text: &str) {
        fs::write(self.path(path), text).unwrap();
    }

    /// Writes a program.
    pub fn script(&self, path: &str, text: &str) {
        let draft = format!("{path}.txt");
        self.write(&draft, text);
        self.program(path, &self.path(&draft));
        fs::set_permissions(self.path(path), fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Writes what the judge sends for stage 1: all checks pass, but for the one with the message of its failure.
    pub fn verdicts(&self, path: &str, failure: Option<(usize, &str)>) {
        let mut bytes = Vec::new();
        for (index, (check, _)) in raykata::rubric::stages()[0].1.in_order().into_iter().enumerate() {
            let message = failure.filter(|(at, _)| *at == index).map(|(_, message)| message.to_owned());
            let verdict = message.map_or(Verdict::Passed, Verdict::Failed);
            send(&mut bytes, &CheckVerdict { check: check.into(), verdict }).unwrap();
        }
        fs::write(self.path(path), bytes).unwrap();
    }

    /// Writes the exercise. The lengths of texts differ, so that the change is seen where times are coarse.
    pub fn save(&self, text: &str) {
        self.write("exercises/src/stage1_shapes.rs", &format!("{text}\n"));
    }

    /// Waits until a file ends with a line, and returns its text.
    pub fn wait_for_file(&self, path: &str) -> String {
        let begin = Instant::now();
        loop {
            match fs::read_to_string(self.path(path)) {
                Ok(text) if text.ends_with('\n') => return text.trim().to_owned(),
                _ => assert!(begin.elapsed() < PATIENCE, "no {path}"),
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Copies a program in a process of its own. While this process writes a program, another test may start a process, which
    /// inherits the open file, and a file that is open for writing cannot be started.
    pub fn program(&self, path: &str, from: &Path) {
        let copied = Command::new("cp").arg(from).arg(self.path(path)).status().unwrap();
        assert!(copied.success());
    }
}
