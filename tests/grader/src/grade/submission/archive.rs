//! Reads submissions in archives. The grader does not trust stated sizes: it counts bytes while it unpacks. Names only
//! decide which file is which exercise; nothing is written to the disk.

use super::Gathering;
use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

/// Extensions of the archives that can be unpacked.
pub const ENDINGS: [&str; 4] = [".zip", ".tar.gz", ".tgz", ".tar"];

/// Most bytes that are unpacked from an archive. All exercises together have a fifth of a megabyte. A working copy with its
/// target folder may be larger than this limit; students should not hand that in.
const MOST_UNPACKED: u64 = 256 << 20;

/// Offers the files of an archive to `gathering`.
pub fn gather(path: &Path, gathering: &mut Gathering<'_>) -> io::Result<()> {
    let file = BufReader::new(super::open(path).map_err(io::Error::other)?);
    let name = path.to_string_lossy();
    let unpacked = if name.ends_with(".zip") {
        zip(file, gathering)
    } else if name.ends_with(".tar") {
        tar(file, gathering)
    } else {
        tar(flate2::read::MultiGzDecoder::new(file), gathering)
    };
    unpacked.map_err(|error| io::Error::other(format!("cannot be unpacked: {error}")))
}

fn zip(file: impl Read + Seek, gathering: &mut Gathering<'_>) -> io::Result<()> {
    let mut archive = zip::ZipArchive::new(file)?;
    for index in 0..archive.len() {
        gathering.count()?;
        let entry = archive.by_index(index)?;
        let path = entry.name().to_owned();
        let regular = entry.is_file() && !entry.is_symlink();
        offer(&path, regular, entry, gathering);
    }
    Ok(())
}

fn tar(stream: impl Read, gathering: &mut Gathering<'_>) -> io::Result<()> {
    let mut archive = tar::Archive::new(Bounded { stream, left: MOST_UNPACKED });
    for entry in archive.entries()? {
        gathering.count()?;
        let entry = entry?;
        let path = entry.path_bytes();
        let path = String::from_utf8_lossy(&path).into_owned();
        let kind = entry.header().entry_type();
        if !kind.is_dir() {
            offer(&path, kind.is_file(), entry, gathering);
        }
    }
    Ok(())
}

/// Offers one file of an archive under the path that the archive gives it.
fn offer(path: &str, regular: bool, content: impl Read, gathering: &mut Gathering<'_>) {
    let plain: Vec<&str> = path.split(['/', '\\']).filter(|part| !part.is_empty() && *part != ".").collect();
    let plain = plain.join("/");
    if !gathering.wants(&plain) {
        gathering.ignore(&plain);
    } else if path.starts_with('/') || plain.split('/').any(|part| part == "..") {
        gathering.offer(&plain, Err::<io::Empty, _>("was ignored: its path leads out of the archive".into()));
    } else if !regular {
        gathering.offer(&plain, Err::<io::Empty, _>("was ignored: it is not a regular file".into()));
    } else {
        gathering.offer(&plain, Ok(content));
    }
}

/// A stream that returns an error after a given number of bytes.
struct Bounded<R> {
    stream: R,
    left: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(buffer)?;
        self.left = self.left.checked_sub(read as u64).ok_or_else(|| {
            io::Error::other(format!(
                "it contains more than {} MiB; hand in only exercises/src",
                MOST_UNPACKED >> 20
            ))
        })?;
        Ok(read)
    }
}
