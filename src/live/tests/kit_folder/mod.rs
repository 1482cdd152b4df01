//! A kit in a temporary folder, with scripts in place of programs.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

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

    /// Copies a program in a process of its own. While this process writes a program, another test may start a process, which
    /// inherits the open file, and a file that is open for writing cannot be started.
    pub fn program(&self, path: &str, from: &Path) {
        let copied = Command::new("cp").arg(from).arg(self.path(path)).status().unwrap();
        assert!(copied.success());
    }
}
