//! Whether a disk has room for a build.

use anyhow::Result;
use std::path::Path;

/// Free space that a build needs, in bytes. Most builds write 10 megabytes.
#[cfg(target_os = "linux")]
const ROOM: u64 = 64 << 20;

/// Returns an error with this advice if the disk of a folder is nearly full. A compiler without room fails for any code, so its
/// errors say nothing about the code.
#[cfg(target_os = "linux")]
pub fn has_room(folder: &Path, advice: &str) -> Result<()> {
    use anyhow::{Context, ensure};

    let disk = nix::sys::statvfs::statvfs(folder).with_context(|| folder.display().to_string())?;
    let free = disk.blocks_available().saturating_mul(disk.fragment_size());
    ensure!(
        free >= ROOM,
        "the disk of {} has only {} MB left, and a build needs {} MB: {advice}",
        folder.display(),
        free >> 20,
        ROOM >> 20
    );
    Ok(())
}

/// Other systems are not asked.
#[cfg(not(target_os = "linux"))]
pub fn has_room(_folder: &Path, _advice: &str) -> Result<()> {
    Ok(())
}
