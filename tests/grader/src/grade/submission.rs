//! Reads the stage files of a submission as text, and the modules that belong to them. Links are not followed. A remark names
//! renamed and ignored files that a student may wonder about.

use super::result::Remark;
use anyhow::Context;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashMap};
use std::fs::{self, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

mod archive;
pub(super) mod helpers;
mod names;

/// Most bytes of source files, one or all of a submission together. The reference has a third of this. Files of many megabytes
/// compile slowly, and have room for tables of answers.
const MOST_BYTES: u64 = 1 << 20;

/// Most files and folders of a submission. A working copy with its target folder has thousands.
const MOST_ENTRIES: usize = 50_000;

/// Folders that contain no code of a student: output of cargo and git, the reference, and foreign packages. They are read
/// only if no exercise is found elsewhere, because any folder may have such a name.
const PASSED_OVER: [&str; 4] = ["target", ".git", "solutions", "node_modules"];

/// Most Rust files beside the exercises that are read: any of them may be a module. A working copy of the whole kit without
/// its folders `target` and `tests` has about 120.
const MOST_OTHERS: usize = 256;

/// Most remarks about ignored files. A working copy may have thousands of such files.
const MOST_REMARKS: usize = 50;

/// A submission on the disk.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Submission {
    /// The name of the folder, or of the archive without its extension. Different submissions have different names.
    pub student: String,
    /// The path of the folder or archive.
    pub path: PathBuf,
}

/// The files of a submission that will be graded.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct SubmittedFiles {
    /// Texts by file name.
    pub files: BTreeMap<String, String>,
    /// Files that were ignored or changed, and why.
    pub remarks: Vec<Remark>,
    /// The reason if nothing could be read.
    pub trouble: Option<String>,
}

impl SubmittedFiles {
    /// Returns the SHA-256 of everything that the grade depends on.
    pub fn content(&self) -> String {
        let mut hash = Sha256::new();
        for part in self.files.iter().flat_map(|(name, text)| [name, text]).chain(&self.trouble) {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Returns the submissions in a folder, sorted by name, and the other entries of the folder.
pub fn find(folder: &Path) -> Result<(Vec<Submission>, Vec<PathBuf>), anyhow::Error> {
    let cannot = || format!("cannot read the folder {}", folder.display());
    let (mut found, mut others) = (Vec::new(), Vec::new());
    for entry in fs::read_dir(folder).with_context(cannot)? {
        let entry = entry.with_context(cannot)?;
        let path = entry.path();
        let name = path.file_name().unwrap_or_default();
        // Most file systems know this from the list of the folder, without a look at each entry. A link is neither.
        let kind = entry.file_type();
        let is = |of: fn(&fs::FileType) -> bool| kind.as_ref().is_ok_and(of);
        let student = match names::archive_stem(name) {
            _ if name.as_encoded_bytes().starts_with(b".") => None,
            Some(stem) if is(fs::FileType::is_file) => Some(stem),
            _ => is(fs::FileType::is_dir).then_some(name),
        };
        match student.map(names::of_student) {
            Some(student) => found.push(Submission { student, path }),
            None => others.push(path),
        }
    }
    found.sort();
    others.sort();
    // If there is a folder `ann` and an archive `ann.zip`, both use their full names.
    let mut n_of_name: HashMap<String, usize> = HashMap::new();
    found.iter().for_each(|one| *n_of_name.entry(one.student.clone()).or_default() += 1);
    for one in &mut found {
        if n_of_name.get(&one.student).is_some_and(|n| *n > 1) {
            one.student = names::of_student(one.path.file_name().unwrap_or_default());
        }
    }
    Ok((found, others))
}

/// Reads the files of these names, and the modules that belong to them, from a folder or an archive. The absence of a file in
/// `expected` gets a remark.
pub fn take(path: &Path, wanted: &[String], expected: &[String]) -> SubmittedFiles {
    let gather = |passes_over| {
        let mut gathering = Gathering { wanted, passes_over, ..Gathering::default() };
        let trouble =
            if path.is_dir() { gathering.folder(path) } else { archive::gather(path, &mut gathering) };
        (gathering, trouble)
    };
    let (mut gathering, mut trouble) = gather(true);
    if trouble.is_ok() && gathering.best.is_empty() {
        (gathering, trouble) = gather(false);
    }
    // Keep the best file of each name, and the modules beside them.
    let mut taken = SubmittedFiles::default();
    let likeliest = gathering.best.values().min_by_key(|candidate| candidate.rank);
    let folder = likeliest.and_then(|candidate| Some(candidate.path.rsplit_once('/')?.0.to_owned()));
    let folder = folder.unwrap_or_default();
    for (name, candidate) in gathering.best {
        match candidate.text {
            Ok((text, remarks)) => {
                taken.files.insert(name, text);
                taken.remarks.extend(remarks.map(|what| Remark { file: candidate.path, what }));
            }
            Err(what) => taken.remarks.push(Remark { file: candidate.path, what }),
        }
    }
    let modules = helpers::modules(&gathering.others, &folder, wanted);
    for path in gathering.others.keys().filter(|path| !path.ends_with("/lib.rs") && *path != "lib.rs") {
        let remark = |what: &str| Remark { file: path.clone(), what: what.into() };
        if helpers::inside(path, &folder).is_some_and(|inside| modules.contains_key(inside)) {
            taken.remarks.push(remark("was taken as a module"));
        } else {
            let what = "was ignored: no exercise file has this name, and `mod` in lib.rs does not name it";
            gathering.ignored.push(remark(what));
        }
    }
    taken.files.extend(modules);
    // Add remarks about missing and ignored files.
    for name in expected.iter().filter(|name| !taken.files.contains_key(*name)) {
        let what = "is missing; the empty exercise replaces it";
        taken.remarks.push(Remark { file: name.clone(), what: what.into() });
    }
    gathering.ignored.sort();
    let more = gathering.ignored.len().saturating_sub(MOST_REMARKS);
    gathering.ignored.truncate(MOST_REMARKS);
    taken.remarks.extend(gathering.ignored);
    if more > 0 {
        taken.remarks.push(Remark { file: "…".into(), what: format!("{more} more files were ignored") });
    }
    // Name the reason if there is no file at all.
    taken.trouble = match trouble {
        Err(error) => Some(error.to_string()),
        Ok(()) if taken.files.values().map(String::len).sum::<usize>() as u64 > MOST_BYTES => Some(format!(
            "has source files of more than {} KiB together, and no solution needs that much: hand in without tables of \
             numbers and without files that no exercise uses",
            MOST_BYTES / 1024
        )),
        Ok(()) if taken.files.is_empty() => Some(format!(
            "contains none of the exercise files ({} …): is it the right folder?",
            wanted.first().map_or("", String::as_str)
        )),
        Ok(()) => None,
    };
    taken
}

/// A file that may be the student's version of an exercise.
struct Candidate {
    path: String,
    /// How likely this is the file that the student edits; the smallest rank wins. Files that cannot be read come last, and
    /// renamed ones behind those with the right name.
    rank: (bool, bool, usize, usize),
    /// The text with a remark about changes to it, or the reason why there is no text.
    text: Result<(String, Option<String>), String>,
}

/// The files that have been found so far.
#[derive(Default)]
struct Gathering<'a> {
    wanted: &'a [String],
    /// Whether folders of [`PASSED_OVER`] are left out.
    passes_over: bool,
    best: BTreeMap<String, Candidate>,
    /// Texts of other Rust files, by path.
    others: BTreeMap<String, String>,
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
                    if !(self.passes_over && PASSED_OVER.iter().any(|name| entry.file_name() == *name)) {
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

    /// Counts one more file or folder. Returns an error above the limit.
    fn count(&mut self) -> io::Result<()> {
        self.entries += 1;
        if self.entries > MOST_ENTRIES {
            let why =
                format!("contains more than {MOST_ENTRIES} files and folders; hand in only exercises/src");
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, why));
        }
        Ok(())
    }

    /// Returns whether the file with this path is read: an exercise, or another Rust file that may be a module.
    fn wants(&self, path: &str) -> bool {
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
        let mut parts = folder.split('/');
        if self.passes_over && parts.clone().any(|part| PASSED_OVER.contains(&part)) {
            return false;
        }
        let may_be_module = name.ends_with(".rs") && name != "build.rs" && !parts.any(|part| part == "tests");
        names::of_exercise(name, self.wanted).is_some() || (may_be_module && self.others.len() < MOST_OTHERS)
    }

    /// Keeps a wanted file unless a file with the same name and a better rank is known.
    fn offer(&mut self, path: &str, content: Result<impl Read, String>) {
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
        let content = content.and_then(text);
        let Some((exercise, is_exact)) = names::of_exercise(name, self.wanted) else {
            match content {
                Ok((text, _)) => drop(self.others.insert(path.to_owned(), text)),
                Err(what) => self.ignored.push(Remark { file: path.to_owned(), what }),
            }
            return;
        };
        // Rank the file by its folder and its depth.
        let place = match folder {
            _ if folder == "exercises/src" || folder.ends_with("/exercises/src") => 0,
            _ if folder == "src" || folder.ends_with("/src") => 1,
            "" => 2,
            _ => 3,
        };
        let rank = (content.is_err(), !is_exact, place, path.split('/').count());
        // Ignore it if a better file is known.
        if let Some(other) = self.best.get(exercise)
            && (other.rank, &other.path) <= (rank, &path.to_owned())
        {
            let what =
                format!("was ignored: {} is graded; if that is the wrong one, hand in only one", other.path);
            self.ignored.push(Remark { file: path.to_owned(), what });
            return;
        }
        // Otherwise keep it, and ignore the earlier one.
        let text = content.map(|(text, changed)| {
            let renamed = (!is_exact).then(|| format!("was read as {exercise}"));
            let remarks: Vec<String> = renamed.into_iter().chain(changed).collect();
            (text, (!remarks.is_empty()).then(|| remarks.join("; ")))
        });
        let candidate = Candidate { path: path.to_owned(), rank, text };
        if let Some(other) = self.best.insert(exercise.to_owned(), candidate) {
            let what = format!("was ignored: {path} is graded; if that is the wrong one, hand in only one");
            self.ignored.push(Remark { file: other.path, what });
        }
    }

    /// Adds a remark that a file was ignored. Only Rust files, tests and cargo's files get one; other files, such as
    /// slides, are expected in a working copy.
    fn ignore(&mut self, path: &str) {
        let what = match path.rsplit('/').next().unwrap_or(path) {
            "build.rs" | "Cargo.toml" | "Cargo.lock" | "rust-toolchain" | "rust-toolchain.toml" => {
                "was ignored: submissions are built without cargo, with the kit's own settings"
            }
            _ if path.contains(".cargo/") => {
                "was ignored: submissions are built without cargo, so its configuration has no effect"
            }
            _ if path.contains("tests/") || path.ends_with(".snap") => {
                "was ignored: the kit's own checks are used"
            }
            _ if path.ends_with(".rs") => "was ignored: there are too many Rust files",
            name if names::archive_stem(name.as_ref()).is_some() => {
                "was ignored: an archive within a submission is not unpacked; hand in its files"
            }
            _ => return,
        };
        self.ignored.push(Remark { file: path.to_owned(), what: what.to_owned() });
    }
}

/// Returns the path as printable text, with `/` between its parts.
fn shown(path: &Path) -> String {
    let parts: Vec<String> =
        path.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.join("/")
}

/// Opens a regular file. It does not follow links and does not wait for pipes or devices.
fn open(path: &Path) -> Result<fs::File, String> {
    let flags = nix::fcntl::OFlag::O_NOFOLLOW | nix::fcntl::OFlag::O_NONBLOCK;
    let refused = |why: &str| format!("was ignored: {why}; hand in the file itself");
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
        _ => Err(refused("it is not a regular file")),
    }
}

/// Reads a source file. Returns its text without byte order mark and with LF line ends, and a remark if that changed it.
fn text(content: impl Read) -> Result<(String, Option<String>), String> {
    let mut bytes = Vec::new();
    let read = content.take(MOST_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| format!("was ignored: it cannot be read ({error})"))?;
    if bytes.len() as u64 > MOST_BYTES {
        let most = MOST_BYTES / 1024;
        return Err(format!("was ignored: it is longer than {most} KiB, and no exercise needs that much"));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("was ignored: it is in UTF-16; save it as UTF-8".into());
    }
    // Remove the byte order mark, decode the text and convert line ends.
    let without_mark = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let text = std::str::from_utf8(without_mark).map_err(|error| {
        format!("was ignored: byte {} is not valid UTF-8; save it as UTF-8", error.valid_up_to())
    })?;
    let changed = without_mark.len() < bytes.len() || text.contains('\r');
    let remark = changed.then(|| "was read without its byte order mark and with LF line ends".to_owned());
    // Old systems end lines with a single CR.
    Ok((text.replace("\r\n", "\n").replace('\r', "\n"), remark))
}

#[cfg(test)]
mod tests;
