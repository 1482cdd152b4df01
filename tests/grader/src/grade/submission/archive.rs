//! Reads submissions in archives. The grader does not trust stated sizes: it counts bytes while it unpacks. Names only
//! decide which file is which exercise; nothing is written to the disk.

use super::Gathering;
use std::cell::Cell;
use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

/// Extensions of the archives that can be unpacked.
pub const ENDINGS: [&str; 4] = [".zip", ".tar.gz", ".tgz", ".tar"];

/// Extensions of archives that are submissions but cannot be unpacked.
pub const UNREADABLE: [&str; 9] =
    [".tar.xz", ".txz", ".tar.bz2", ".tbz2", ".tar.zst", ".7z", ".rar", ".gz", ".xz"];

/// Most bytes that are unpacked from an archive. All exercises together have a fifth of a megabyte. A working copy with its
/// target folder may be larger than this limit; students should not hand that in.
const MOST_UNPACKED: u64 = 256 << 20;

/// Offers the files of an archive to `gathering`.
pub fn gather(path: &Path, gathering: &mut Gathering<'_>) -> io::Result<()> {
    let file = BufReader::new(super::open(path).map_err(io::Error::other)?);
    let name = path.to_string_lossy().to_lowercase();
    let is = |ending: &&str| name.ends_with(*ending);
    let unpacked = match () {
        () if is(&".zip") => zip(file, gathering),
        () if is(&".tar") => tar(file, gathering),
        () if is(&".tar.gz") || is(&".tgz") => tar(flate2::read::MultiGzDecoder::new(file), gathering),
        () => {
            let ending = UNREADABLE.iter().find(|ending| is(ending)).unwrap_or(&"");
            return Err(io::Error::other(format!(
                "cannot be unpacked: {ending} is not read here; unpack it, and hand in the folder, .zip or .tar.gz"
            )));
        }
    };
    unpacked.map_err(|error| {
        let help = match error.kind() {
            io::ErrorKind::FileTooLarge => "",
            _ => "; it may be cut off: download it again, or hand in a new .zip or .tar.gz of exercises/src",
        };
        io::Error::other(format!("cannot be unpacked: {error}{help}"))
    })
}

fn zip(file: impl Read + Seek, gathering: &mut Gathering<'_>) -> io::Result<()> {
    let mut archive = zip::ZipArchive::new(file)?;
    let left = Cell::new(MOST_UNPACKED);
    for index in 0..archive.len() {
        gathering.count()?;
        let entry = archive.by_index(index)?;
        let path = entry.name().to_owned();
        let regular = entry.is_file() && !entry.is_symlink();
        offer(&path, regular, Bounded { stream: entry, left: &left }, gathering);
        // A file above the limit for one file ends early, and so does one above the limit for all.
        if left.get() == 0 {
            return Err(too_much());
        }
    }
    Ok(())
}

fn tar(stream: impl Read, gathering: &mut Gathering<'_>) -> io::Result<()> {
    let left = Cell::new(MOST_UNPACKED);
    let mut archive = tar::Archive::new(Bounded { stream, left: &left });
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

/// A stream that returns an error when no bytes are left. Several streams can share a number of bytes.
struct Bounded<'a, R> {
    stream: R,
    left: &'a Cell<u64>,
}

impl<R: Read> Read for Bounded<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(buffer)?;
        self.left.set(self.left.get().saturating_sub(read as u64));
        if self.left.get() == 0 {
            return Err(too_much());
        }
        Ok(read)
    }
}

fn too_much() -> io::Error {
    let most = MOST_UNPACKED >> 20;
    io::Error::new(
        io::ErrorKind::FileTooLarge,
        format!("it contains more than {most} MiB; hand in only exercises/src"),
    )
}
