//! A folder for the files of a test.

use std::path::PathBuf;

/// A folder that is removed when the value is dropped.
pub struct Folder(PathBuf);

impl Folder {
    /// An empty folder of this process. Each test has another name.
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("raykata-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder for the test");
        Folder(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("a file for the test");
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
