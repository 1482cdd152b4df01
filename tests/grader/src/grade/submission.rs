//! What is taken from a submission: the files in which students write, as text. Nothing else is read, whatever it is
//! called and wherever it points; it is named in a remark.

use super::result::Remark;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

mod archive;

/// The longest file of the reference has 20 KiB; compilers take long for files of many megabytes.
const LONGEST_FILE: u64 = 512 * 1024;

/// How many files and folders of a submission are looked at. A working copy with its target folder has thousands.
const MOST_ENTRIES: usize = 50_000;

/// Folders that hold nothing of a student's: what cargo and git make, and other people's crates.
const PASSED_OVER: [&str; 4] = ["target", ".git", "solutions", "node_modules"];

/// How many remarks about ignored files are kept; a working copy may hold thousands.
const MOST_REMARKS: usize = 50;

/// A submission as it lies there.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Submission {
    /// Name of the folder or archive, without its ending.
    pub student: String,
    /// Where it is.
    pub path: PathBuf,
}

/// What was taken.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// Texts by file name.
    pub files: BTreeMap<String, String>,
    /// What was not, and why.
    pub remarks: Vec<Remark>,
    /// Why nothing could be, if nothing could.
    pub trouble: Option<String>,
}

impl Taken {
    /// SHA-256 of all that the verdict depends on.
    pub fn content(&self) -> String {
        let mut hash = Sha256::new();
        for part in self.files.iter().flat_map(|(name, text)| [name, text]).chain(&self.trouble) {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The submissions in a folder, by name, and what else is there.
pub fn find(folder: &Path) -> io::Result<(Vec<Submission>, Vec<PathBuf>)> {
    let (mut found, mut others) = (Vec::new(), Vec::new());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is = |of: fn(&fs::FileType) -> bool| {
            fs::symlink_metadata(&path).is_ok_and(|metadata| of(&metadata.file_type()))
        };
        let ending = archive::ENDINGS.iter().find_map(|ending| name.strip_suffix(ending));
        match ending {
            _ if name.starts_with('.') => others.push(path),
            Some(student) if is(fs::FileType::is_file) => {
                found.push(Submission { student: student.to_owned(), path });
            }
            _ if is(fs::FileType::is_dir) => found.push(Submission { student: name, path }),
            _ => others.push(path),
        }
    }
    found.sort();
    others.sort();
    // A folder `ann` beside an archive `ann.zip` go by their full names.
    let short: Vec<String> = found.iter().map(|one| one.student.clone()).collect();
    for one in &mut found {
        if short.iter().filter(|name| **name == one.student).count() > 1 {
            one.student = one.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        }
    }
    // Names that are no text may still look alike.
    let full: Vec<String> = found.iter().map(|one| one.student.clone()).collect();
    for (index, one) in found.iter_mut().enumerate() {
        let earlier = full[..index].iter().filter(|name| **name == one.student).count();
        if earlier > 0 {
            one.student = format!("{} ({})", one.student, earlier + 1);
        }
    }
    Ok((found, others))
}

/// Takes the files of these names from a folder or an archive.
pub fn take(path: &Path, wanted: &[String]) -> Taken {
    let mut gathering = Gathering { wanted, best: BTreeMap::new(), entries: 0, ignored: Vec::new() };
    let trouble = if path.is_dir() { gathering.folder(path) } else { archive::gather(path, &mut gathering) };
    let mut taken = Taken::default();
    for (name, candidate) in gathering.best {
        match candidate.text {
            Ok((text, remarks)) => {
                taken.files.insert(name, text);
                taken.remarks.extend(remarks.map(|what| Remark { file: candidate.path, what }));
            }
            Err(what) => taken.remarks.push(Remark { file: candidate.path, what }),
        }
    }
    for name in wanted.iter().filter(|name| !taken.files.contains_key(*name)) {
        let what = "is missing; the empty exercise was put in its place";
        taken.remarks.push(Remark { file: name.clone(), what: what.into() });
    }
    gathering.ignored.sort();
    let more = gathering.ignored.len().saturating_sub(MOST_REMARKS);
    gathering.ignored.truncate(MOST_REMARKS);
    taken.remarks.extend(gathering.ignored);
    if more > 0 {
        taken
            .remarks
            .push(Remark { file: "…".into(), what: format!("{more} other files were ignored as well") });
    }
    taken.trouble = match trouble {
        Err(error) => Some(error.to_string()),
        Ok(()) if taken.files.is_empty() => Some(format!(
            "holds none of the files that students write ({} …): is it the right folder?",
            wanted.first().map_or("", String::as_str)
        )),
        Ok(()) => None,
    };
    taken
}

/// A file that could be taken.
struct Candidate {
    path: String,
    /// The smaller, the better: how sure it is that this is where the student writes.
    rank: (usize, usize),
    /// The text and what was done to it, or why there is none.
    text: Result<(String, Option<String>), String>,
}

/// What has been found so far.
struct Gathering<'a> {
    wanted: &'a [String],
    best: BTreeMap<String, Candidate>,
    entries: usize,
    ignored: Vec<Remark>,
}

impl Gathering<'_> {
    fn folder(&mut self, root: &Path) -> io::Result<()> {
        let mut waiting = vec![root.to_owned()];
        while let Some(folder) = waiting.pop() {
            let mut entries: Vec<_> = fs::read_dir(&folder)?.collect::<Result<_, _>>()?;
            entries.sort_by_key(fs::DirEntry::file_name);
            for entry in entries {
                self.count()?;
                let path = entry.path();
                let shown = shown(path.strip_prefix(root).unwrap_or(&path));
                let kind = entry.file_type()?;
                if kind.is_dir() {
                    if !PASSED_OVER.iter().any(|name| entry.file_name() == *name) {
                        waiting.push(path);
                    }
                } else if self.wants(&shown) {
                    self.offer(&shown, open(&path));
                } else {
                    self.ignore(&shown);
                }
            }
        }
        Ok(())
    }

    /// One more file or folder.
    fn count(&mut self) -> io::Result<()> {
        self.entries += 1;
        if self.entries > MOST_ENTRIES {
            return Err(io::Error::other(format!(
                "holds more than {MOST_ENTRIES} files and folders; hand in exercises/src alone"
            )));
        }
        Ok(())
    }

    /// Whether a file of this path may be one in which the student writes.
    fn wants(&self, path: &str) -> bool {
        let name = path.rsplit('/').next().unwrap_or(path);
        self.wanted.iter().any(|wanted| wanted == name)
            && !path.split('/').any(|part| PASSED_OVER.contains(&part))
    }

    /// Takes a file that is wanted, unless a better one of the name was there.
    fn offer(&mut self, path: &str, content: Result<impl Read, String>) {
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
        let place = match folder {
            _ if folder == "exercises/src" || folder.ends_with("/exercises/src") => 0,
            _ if folder == "src" || folder.ends_with("/src") => 1,
            "" => 2,
            _ => 3,
        };
        let rank = (place, path.split('/').count());
        if let Some(other) = self.best.get(name)
            && (other.rank, &other.path) <= (rank, &path.to_owned())
        {
            let what = format!("was ignored: {} was taken", other.path);
            self.ignored.push(Remark { file: path.to_owned(), what });
            return;
        }
        let candidate = Candidate { path: path.to_owned(), rank, text: content.and_then(text) };
        if let Some(other) = self.best.insert(name.to_owned(), candidate) {
            let what = format!("was ignored: {path} was taken");
            self.ignored.push(Remark { file: other.path, what });
        }
    }

    /// Remarks that a file was ignored. Source files of the kit are expected in a working copy and not worth a word.
    fn ignore(&mut self, path: &str) {
        let what = match path.rsplit('/').next().unwrap_or(path) {
            "build.rs" | "Cargo.toml" | "Cargo.lock" | "rust-toolchain" | "rust-toolchain.toml" => {
                "was ignored: submissions are built without cargo, by the kit's own settings"
            }
            _ if path.contains(".cargo/") => {
                "was ignored: cargo is not asked, whatever its configuration says"
            }
            _ if path.contains("tests/") || path.ends_with(".snap") => {
                "was ignored: the kit's own checks were used"
            }
            _ if path.ends_with(".rs") => "was ignored: no file that students write has this name",
            _ => return,
        };
        self.ignored.push(Remark { file: path.to_owned(), what: what.to_owned() });
    }
}

/// The path as text that prints, with `/` between its parts.
fn shown(path: &Path) -> String {
    let parts: Vec<String> =
        path.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.join("/")
}

/// Opens a regular file. A link is not followed, and a pipe or device is not waited for.
fn open(path: &Path) -> Result<fs::File, String> {
    let flags = nix::fcntl::OFlag::O_NOFOLLOW | nix::fcntl::OFlag::O_NONBLOCK;
    let refused = |why: &str| format!("was not taken: {why}; hand in the file itself");
    if fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink()) {
        return Err(refused("it is a link to another place"));
    }
    let file = OpenOptions::new()
        .read(true)
        .custom_flags(flags.bits())
        .open(path)
        .map_err(|error| refused(&error.to_string()))?;
    match file.metadata() {
        Ok(metadata) if metadata.is_file() => Ok(file),
        _ => Err(refused("it is no regular file")),
    }
}

/// Reads a source file as people's editors write them, and says what was done to it.
fn text(content: impl Read) -> Result<(String, Option<String>), String> {
    let mut bytes = Vec::new();
    let read = content.take(LONGEST_FILE + 1).read_to_end(&mut bytes);
    read.map_err(|error| format!("was not taken: it cannot be read ({error})"))?;
    if bytes.len() as u64 > LONGEST_FILE {
        let most = LONGEST_FILE / 1024;
        return Err(format!("was not taken: it is longer than {most} KiB, and no exercise needs as much"));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("was not taken: it is in UTF-16; save it as UTF-8".into());
    }
    let without_mark = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let text = std::str::from_utf8(without_mark).map_err(|error| {
        format!("was not taken: byte {} is no UTF-8; save it as UTF-8", error.valid_up_to())
    })?;
    let changed = without_mark.len() < bytes.len() || text.contains('\r');
    let remark = changed.then(|| "was taken without its byte order mark and with plain line ends".to_owned());
    Ok((text.replace("\r\n", "\n"), remark))
}

#[cfg(test)]
mod tests;
