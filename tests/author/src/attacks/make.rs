//! Makes the submission of an attack: first its base files, then one step after the other.

use super::step::{Act, Content, Encoding, Step, bytes_of, need, path_of};
use super::{Attack, Base, remember, source};
use anyhow::{Context, Result, bail, ensure};
use grader::exercises::{answer, stage_of};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

mod archives;

/// The folder of the exercise files.
const SOURCES: &str = "exercises/src";

/// The file that most attacks change.
const SHAPES: &str = "exercises/src/stage1_shapes.rs";

/// The content of a secret file beside every submission. No report may contain it.
pub const CANARY: &str = "canary-7c1e-of-somebody-else";

/// The folders in which a submission is made.
pub struct AttackFolders<'a> {
    /// The root of the kit.
    pub root: &'a Path,
    /// An empty folder. The submission goes into `submissions`, and the files that it must not reach into `beside`.
    pub folder: &'a Path,
}

/// Makes the submission of an attack and returns its path.
pub fn make(attack: &Attack, place: &AttackFolders<'_>) -> Result<PathBuf> {
    let name = match (&attack.student, &attack.student_hex) {
        (Some(name), None) => name.into(),
        (None, Some(hex)) => OsString::from_vec(bytes_of(hex)?),
        (None, None) => attack.name.clone().into(),
        _ => bail!("{}: use either `student` or `student_hex`", attack.name),
    };
    let beside = place.folder.join("beside");
    fs::create_dir_all(&beside)?;
    fs::write(beside.join("secret.txt"), CANARY)?;
    let mut maker = Maker { attack, place, submission: place.folder.join("submissions").join(name) };
    fs::create_dir_all(&maker.submission).context("the folder of the submission cannot be made")?;
    for (name, text) in maker.base()? {
        maker.write(&Path::new(SOURCES).join(name), text.as_bytes())?;
    }
    for (index, step) in attack.step.iter().enumerate() {
        maker.take(step.clone()).with_context(|| format!("{}: step {}", attack.name, index + 1))?;
    }
    Ok(maker.submission)
}

struct Maker<'a> {
    attack: &'a Attack,
    place: &'a AttackFolders<'a>,
    submission: PathBuf,
}

impl Maker<'_> {
    /// Returns the exercise files before the first step.
    fn base(&self) -> Result<BTreeMap<String, String>> {
        let mut files = match self.attack.base {
            Base::Nothing => BTreeMap::new(),
            _ => grader::exercises::pristine(self.place.root)?,
        };
        files.retain(|name, _| stage_of(name).is_some());
        let last = self.attack.stages.iter().max();
        for (name, text) in &mut files {
            let stage = stage_of(name);
            match self.attack.base {
                // A later stage may use helpers of an earlier one.
                Base::Solutions if stage.as_ref() <= last => *text = self.solution(name)?,
                Base::Wrong if stage.is_some_and(|stage| self.attack.stages.contains(&stage)) => {
                    *text = source::with_bodies(&self.solution(name)?, "*", source::wrong_body)?;
                }
                _ => {}
            }
        }
        Ok(files)
    }

    fn solution(&self, name: &str) -> Result<String> {
        let path = self.place.root.join("solutions/src").join(name);
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        answer(&text, &path)
    }

    fn take(&mut self, mut step: Step) -> Result<()> {
        let act = step.act;
        match act {
            Act::Write => {
                let path = path_of(&mut step)?;
                self.write(&path, &self.content(&mut step)?)?;
            }
            Act::Many => {
                let path = need(step.path.take(), "path")?;
                let (n, content) = (need(step.times.take(), "times")?, self.content(&mut step)?);
                for index in 0..n {
                    self.write(Path::new(&path.replace("@n@", &index.to_string())), &content)?;
                }
            }
            Act::Top | Act::Append => {
                let path = step.path.take().unwrap_or_else(|| SHAPES.into());
                let added = String::from_utf8(self.content(&mut step)?)?;
                let change = |text: String| match act {
                    Act::Top => Ok(source::with_top(&text, &added)),
                    _ => Ok(text + &added),
                };
                self.change(&path, change)?;
            }
            Act::Body => self.body(&mut step)?,
            Act::Remove => {
                let path = self.submission.join(path_of(&mut step)?);
                if path.is_dir() { fs::remove_dir_all(path)? } else { fs::remove_file(path)? }
            }
            Act::Encode => self.encode(&mut step)?,
            Act::Link => {
                let (path, to) = (path_of(&mut step)?, self.filled(&need(step.to.take(), "to")?));
                symlink(to, self.fresh(&path)?)?;
            }
            Act::Pipe => {
                let path = path_of(&mut step)?;
                nix::unistd::mkfifo(&self.fresh(&path)?, nix::sys::stat::Mode::S_IRWXU)?;
            }
            Act::Deep => {
                let (path, n) = (need(step.path.take(), "path")?, need(step.times.take(), "times")?);
                fs::create_dir_all(self.submission.join(vec![path; n].join("/")))?;
            }
            Act::Old => {
                let file =
                    fs::File::options().append(true).open(self.submission.join(path_of(&mut step)?))?;
                file.set_modified(SystemTime::UNIX_EPOCH)?;
            }
            Act::Beside => {
                let path = self.place.folder.join("beside").join(path_of(&mut step)?);
                let content = self.content(&mut step)?;
                fs::create_dir_all(path.parent().unwrap_or(&path))?;
                fs::write(path, content)?;
            }
            Act::Remember => {
                let path = step.path.take().unwrap_or_else(|| SHAPES.into());
                let functions = need(step.functions.take(), "functions")?;
                let otherwise = step.text.take();
                self.change(&path, |text| remember::by_heart(&text, &functions, otherwise.as_deref()))?;
            }
            Act::Pack => self.pack(&mut step)?,
            Act::Raw => {
                let (format, content) = (need(step.format.take(), "format")?, self.content(&mut step)?);
                self.become_archive(format, &content)?;
            }
        }
        ensure!(step == Step { act, ..Step::default() }, "the step has keys that it does not need: {step:?}");
        Ok(())
    }

    fn body(&mut self, step: &mut Step) -> Result<()> {
        let path = step.path.take().unwrap_or_else(|| SHAPES.into());
        let name = need(step.function.take(), "function")?;
        let body = String::from_utf8(self.content(step)?)?;
        let solution = self.solution(path.rsplit('/').next().unwrap_or(&path))?;
        self.change(&path, |text| {
            source::with_bodies(&text, &name, |function, returns| {
                let mut body = format!("{{\n    {}\n}}", body.trim());
                if body.contains("@right@") {
                    body = body.replace("@right@", source::body_of(&solution, function)?);
                }
                if body.contains("@wrong@") {
                    body = body.replace("@wrong@", &source::wrong_body(function, returns)?);
                }
                Ok(body)
            })
        })
    }

    fn encode(&self, step: &mut Step) -> Result<()> {
        let path = path_of(step)?;
        let text = fs::read_to_string(self.submission.join(&path))?;
        let bytes = match need(step.encoding.take(), "encoding")? {
            Encoding::Windows => format!("\u{feff}{}", text.replace('\n', "\r\n")).into_bytes(),
            Encoding::Old => text.replace('\n', "\r").into_bytes(),
            Encoding::Utf16 => format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect(),
        };
        self.write(&path, &bytes)
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<()> {
        fs::write(self.fresh(path)?, bytes).with_context(|| path.display().to_string())
    }

    fn change(&self, path: &str, change: impl FnOnce(String) -> Result<String>) -> Result<()> {
        let text = fs::read_to_string(self.submission.join(path)).with_context(|| path.to_owned())?;
        self.write(Path::new(path), change(text)?.as_bytes())
    }

    /// Returns the absolute path. Its folder exists, and there is no file at the path.
    fn fresh(&self, path: &Path) -> Result<PathBuf> {
        let path = self.submission.join(path);
        fs::create_dir_all(path.parent().unwrap_or(&path))?;
        // Do not write through a link of an earlier step.
        if fs::symlink_metadata(&path).is_ok_and(|metadata| !metadata.is_dir()) {
            fs::remove_file(&path)?;
        }
        Ok(path)
    }

    /// Returns the text with the paths of kit, neighbour folder and secret filled in.
    fn filled(&self, text: &str) -> String {
        let beside = self.place.folder.join("beside");
        let shown = |path: &Path| path.display().to_string();
        text.replace("@root@", &shown(self.place.root))
            .replace("@secret@", &shown(&beside.join("secret.txt")))
            .replace("@beside@", &shown(&beside))
    }

    /// Returns the bytes that a step writes.
    fn content(&self, step: &mut Step) -> Result<Vec<u8>> {
        let content = match (step.content.take(), step.text.take(), step.fragment.take()) {
            (Some(content), None, None) => content,
            (None, None, None) => bail!("`text`, `fragment` or `content` is missing"),
            (None, text @ Some(_), None) => Content { text, ..Content::default() },
            (None, None, Some(name)) => {
                let text = self.attack.fragments.get(&name).cloned();
                let text = text.with_context(|| format!("no file of attacks has a fragment `{name}`"))?;
                Content { text: Some(text), ..Content::default() }
            }
            _ => bail!("use only one of `content`, `text` and `fragment`"),
        };
        self.bytes(content)
    }

    fn bytes(&self, content: Content) -> Result<Vec<u8>> {
        let filled = |text: Option<String>| text.map_or_else(String::new, |text| self.filled(&text));
        let (n, before, after) = (content.times.unwrap_or(1), filled(content.before), filled(content.after));
        let text = match (content.text, content.solution, content.hex) {
            (text, None, None) => filled(text),
            (None, Some(solution), None) => self.solution(&solution)?,
            (None, None, Some(hex)) => return Ok(bytes_of(&hex)?.repeat(n)),
            _ => bail!("use only one of `text`, `solution` and `hex`"),
        };
        let repeated: String = match text.contains("@n@") {
            true => (0..n).map(|index| text.replace("@n@", &index.to_string())).collect(),
            false => text.repeat(n),
        };
        Ok((before + &repeated + &after).into_bytes())
    }
}
