//! Submissions that come packed. What an archive says of itself is not believed: sizes are counted as they come, and names
//! decide nothing but which text is whose.

use super::Gathering;
use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

/// What can be unpacked.
pub const ENDINGS: [&str; 4] = [".zip", ".tar.gz", ".tgz", ".tar"];

/// How many bytes of an archive are unpacked. All exercises together have a fifth of a megabyte; a working copy with
/// what cargo has built may have more than this, and is not meant to be handed in.
const MOST_UNPACKED: u64 = 256 << 20;

/// Offers the files of an archive.
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

/// A file of an archive under the path that the archive gives it.
fn offer(path: &str, regular: bool, content: impl Read, gathering: &mut Gathering<'_>) {
    let plain: Vec<&str> = path.split(['/', '\\']).filter(|part| !part.is_empty() && *part != ".").collect();
    let plain = plain.join("/");
    if !gathering.wants(&plain) {
        gathering.ignore(&plain);
    } else if path.starts_with('/') || plain.split('/').any(|part| part == "..") {
        gathering
            .offer(&plain, Err::<io::Empty, _>("was not taken: its path leads out of the archive".into()));
    } else if !regular {
        gathering.offer(&plain, Err::<io::Empty, _>("was not taken: it is no regular file".into()));
    } else {
        gathering.offer(&plain, Ok(content));
    }
}

/// A stream that ends in an error after so many bytes.
struct Bounded<R> {
    stream: R,
    left: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(buffer)?;
        self.left = self.left.checked_sub(read as u64).ok_or_else(|| {
            io::Error::other(format!(
                "it holds more than {} MiB; hand in exercises/src alone",
                MOST_UNPACKED >> 20
            ))
        })?;
        Ok(read)
    }
}
