//! An entry of the corpus: the solutions with one difference, and the required result.
//!
//! The entries that change a file of `solutions/src` stand in one file, `tests/corpus/NAME.corpus`:
//!
//! ```text
//! === any_hit ===
//!
//! wrong any_beyond_t_max: a hit anywhere along the line counts
//! breaks: any_hit.1
//! caught_by: any_hit_agrees_with_brute_force
//! says: beyond t_max
//! +    let ray = &ray.with_range(ray.t_min, f32::INFINITY);
//!      bvh.root().is_some_and(|root| any_below(root, bvh, probe, ray))
//! ```
//!
//! A heading names the function that the entries below it change first. A mistake (`wrong`) names the one item of a contract
//! that it breaks (`any_hit.1` is the first below `Exactly:`, and `any_hit` the sentence above), the check that must catch it, and
//! either words that the check's message must contain, or `diagnosis: none`. The lines below are found by their text within
//! the function: `-` goes, `+` comes, and a line with a space stays and only marks the place. `@` begins another place of the
//! same function, `@ NAME` a place in another function, and `@ *` a place anywhere in the file.

use super::records::write;
use super::source::Source;
use anyhow::{Context, Result, anyhow, bail, ensure};
use grader::files_below::{files_below, last_part};
use std::fmt::{self, Write};
use std::ops::Range;
use std::path::Path;

/// The folder of the corpus, below the root of the kit.
pub const FOLDER: &str = "tests/corpus";

/// The name of the function of a change that stands outside of functions, or in several.
pub const ANYWHERE: &str = "*";

/// The required result of an entry.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// A mistake, which a check must find and name.
    Wrong {
        /// The item of a contract that it breaks: `FUNCTION` or `FUNCTION.N`.
        breaks: String,
        /// The check that must catch it.
        caught_by: String,
        /// Words that must appear in the message of that check.
        says: Vec<String>,
        /// Whether the message must name no mistake, because the checks do not know this one (`diagnosis: none`).
        is_unknown: bool,
    },
    /// Another right solution, which every check must accept.
    Right,
}

/// The solutions with one difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The stage whose checks it must pass or fail.
    pub stage: u8,
    /// Its name, which no other mistake (or right solution) of the stage has.
    pub name: String,
    /// The mistake or the method, in a sentence.
    pub title: String,
    /// The required result.
    pub claim: Claim,
    /// The file it changes, from the root of the kit: `solutions/src/…`.
    pub file: String,
    /// The difference.
    pub changes: Vec<Change>,
}

/// A change of one place.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The function in which the lines are found, or [`ANYWHERE`].
    pub function: String,
    /// The lines, in order.
    pub lines: Vec<(Sign, String)>,
}

/// What happens to a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// It goes.
    Goes,
    /// It comes.
    Comes,
    /// It stays. It only marks the place.
    Stays,
}

impl Sign {
    const ALL: [(char, Sign); 3] = [('-', Sign::Goes), ('+', Sign::Comes), (' ', Sign::Stays)];

    /// Reads a line of a difference.
    pub(super) fn of(line: &str) -> Option<(Sign, &str)> {
        Sign::ALL.into_iter().find_map(|(letter, sign)| Some((sign, line.strip_prefix(letter)?)))
    }

    fn letter(self) -> char {
        Sign::ALL.into_iter().find(|(_, sign)| *sign == self).map_or(' ', |(letter, _)| letter)
    }
}

/// A file of the solutions.
#[derive(Clone, Debug)]
pub struct Original {
    /// Its path from the root of the kit.
    pub file: String,
    /// Its text.
    pub text: String,
    /// Its items.
    pub source: Source,
}

impl Original {
    /// Reads a file of the kit at `root`.
    pub fn read(root: &Path, file: &str) -> Result<Original> {
        let text = std::fs::read_to_string(root.join(file)).with_context(|| file.to_owned())?;
        Original::new(file, text)
    }

    /// The file of this path, with this text.
    pub fn new(file: &str, text: String) -> Result<Original> {
        let source = Source::parse(&text).with_context(|| file.to_owned())?;
        Ok(Original { file: file.to_owned(), text, source })
    }

    /// Returns the bytes in which the lines of a change are found.
    pub fn place(&self, function: &str) -> Result<Range<usize>> {
        match function {
            ANYWHERE => Ok(0..self.text.len()),
            _ => Ok(self.source.function(function)?.whole.clone()),
        }
    }

    /// Returns the bytes at which these whole lines stand within `place`, once for each occurrence.
    pub fn occurrences(&self, place: Range<usize>, lines: &[&str]) -> Vec<Range<usize>> {
        let text = &self.text[place.clone()];
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1));
        let end_of = |start: usize| {
            let mut at = start;
            for line in lines {
                let rest = text[at..].strip_prefix(line)?;
                // The last line of the place may have its end behind the place.
                at = text.len() - rest.len();
                match rest.strip_prefix('\n') {
                    Some(_) => at += 1,
                    None if rest.is_empty() => {}
                    None => return None,
                }
            }
            Some(at)
        };
        starts.filter_map(|start| Some(place.start + start..place.start + end_of(start)?)).collect()
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/stage{}/{}", self.kind(), self.stage, self.name)
    }
}

impl Entry {
    /// Returns `wrong` or `right`.
    pub fn kind(&self) -> &'static str {
        if self.claim == Claim::Right { "right" } else { "wrong" }
    }

    /// Its name and the file of the corpus in which it stands.
    pub(super) fn with_file(&self) -> String {
        format!("{} `{}` in {}", self.kind(), self.name, corpus_file(&self.file))
    }

    /// Returns whether it is a mistake that the checks must name.
    pub fn has_a_known_mistake(&self) -> bool {
        matches!(self.claim, Claim::Wrong { is_unknown: false, .. })
    }

    /// Returns the check that must catch the mistake.
    pub fn caught_by(&self) -> Option<&str> {
        match &self.claim {
            Claim::Wrong { caught_by, .. } => Some(caught_by),
            Claim::Right => None,
        }
    }

    /// Returns whether it changes this function.
    pub fn changes_function(&self, function: &str) -> bool {
        let is_it = |name: &str| name == function || name.rsplit("::").next() == Some(function);
        self.changes.iter().any(|change| is_it(&change.function))
    }

    /// Returns the text of the file with the difference applied.
    pub fn apply(&self, original: &Original) -> Result<String> {
        let mut replaced = Vec::new();
        for change in &self.changes {
            let place = change.place(original);
            replaced.push(place.with_context(|| format!("{} does not fit {}", self.with_file(), self.file))?);
        }
        replaced.sort_by_key(|(range, _)| range.start);
        ensure!(
            replaced.windows(2).all(|pair| pair[0].0.end <= pair[1].0.start),
            "{self}: two of its places overlap"
        );
        let mut text = original.text.clone();
        for (range, new) in replaced.into_iter().rev() {
            text.replace_range(range, &new);
        }
        ensure!(text != original.text, "{self}: it changes nothing in {}", self.file);
        Ok(text)
    }
}

impl Change {
    /// Returns where the lines stand, and what replaces them.
    fn place(&self, original: &Original) -> Result<(Range<usize>, String)> {
        let with = |wanted: &[Sign]| -> Vec<&str> {
            let lines = self.lines.iter().filter(|(sign, _)| wanted.contains(sign));
            lines.map(|(_, line)| line.as_str()).collect()
        };
        let old = with(&[Sign::Goes, Sign::Stays]);
        ensure!(
            !old.is_empty(),
            "a place needs a line that is there already: add one that begins with a space"
        );
        let place = original.place(&self.function)?;
        let found = original.occurrences(place, &old);
        let shown = || old.iter().fold(String::new(), |text, line| text + "\n    " + line);
        match &found[..] {
            [] => bail!("`{}` does not contain these lines:{}", self.function, shown()),
            [one] => {
                let new = with(&[Sign::Comes, Sign::Stays]);
                let mut text = new.join("\n");
                if !new.is_empty() && original.text[one.clone()].ends_with('\n') {
                    text.push('\n');
                }
                Ok((one.clone(), text))
            }
            _ => bail!(
                "`{}` contains these lines {} times (add a line before or behind them that begins with a space):{}",
                self.function,
                found.len(),
                shown()
            ),
        }
    }
}

/// The file of the corpus with the entries that change a file of the solutions.
pub fn corpus_file(file: &str) -> String {
    let name = file.trim_start_matches("solutions/src/").trim_end_matches(".rs");
    format!("{FOLDER}/{name}.corpus")
}

/// A file of the corpus.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CorpusFile {
    /// The lines before the first heading.
    pub about: String,
    /// The entries, in the order of the file.
    pub entries: Vec<Entry>,
}

impl CorpusFile {
    /// Reads the text of `tests/corpus/NAME.corpus`. An error names its line.
    pub fn parse(name: &str, text: &str) -> Result<CorpusFile> {
        let stage = name.strip_prefix("stage").and_then(|rest| rest.split('_').next()?.parse().ok());
        let stage = stage.with_context(|| format!("{name} is not the name of a file stageN_….rs"))?;
        let file = format!("solutions/src/{name}.rs");
        let mut reader = Reader { stage, file, ..Reader::default() };
        let lines: Vec<&str> = text.lines().collect();
        for (number, line) in lines.iter().enumerate() {
            reader
                .line(line, &lines[number + 1..])
                .with_context(|| format!("line {} of {FOLDER}/{name}.corpus", number + 1))?;
        }
        reader.end().with_context(|| format!("the end of {FOLDER}/{name}.corpus"))?;
        Ok(reader.corpus)
    }

    /// Sorts the entries as a reader of the solutions looks for them: by function, mistakes first, then by name.
    pub fn sort(&mut self, original: &Original) {
        let place = |function: &str| {
            original.source.functions.iter().position(|one| one.name == function).unwrap_or(usize::MAX)
        };
        self.entries.sort_by_cached_key(|entry| {
            let function = entry.changes.first().map_or("", |change| change.function.as_str());
            (place(function), entry.claim == Claim::Right, entry.name.clone())
        });
    }

    /// Returns the text of the file.
    pub fn text(&self) -> String {
        let mut text = self.about.clone();
        let mut heading = "";
        for entry in &self.entries {
            let first = entry.changes.first().map_or(ANYWHERE, |change| change.function.as_str());
            if first != heading {
                let _ = write!(text, "\n=== {first} ===\n");
                heading = first;
            }
            let _ = write!(text, "\n{} {}: {}\n", entry.kind(), entry.name, entry.title);
            if let Claim::Wrong { breaks, caught_by, says, is_unknown } = &entry.claim {
                if !breaks.is_empty() {
                    let _ = writeln!(text, "breaks: {breaks}");
                }
                let _ = writeln!(text, "caught_by: {caught_by}");
                says.iter().for_each(|words| _ = writeln!(text, "says: {words}"));
                if *is_unknown {
                    text += "diagnosis: none\n";
                }
            }
            let mut function = first;
            for (number, change) in entry.changes.iter().enumerate() {
                if change.function != function {
                    let _ = writeln!(text, "@ {}", change.function);
                } else if number > 0 {
                    text += "@\n";
                }
                function = &change.function;
                for (sign, line) in &change.lines {
                    let _ = writeln!(text, "{}", format!("{}{line}", sign.letter()).trim_end());
                }
            }
        }
        text
    }
}

/// Reads a file of the corpus line by line.
#[derive(Default)]
struct Reader {
    stage: u8,
    file: String,
    /// The function of the last heading.
    function: Option<String>,
    /// The entry that is being read.
    draft: Option<Draft>,
    corpus: CorpusFile,
}

#[derive(Default)]
struct Draft {
    kind: &'static str,
    name: String,
    title: String,
    breaks: Option<String>,
    caught_by: Option<String>,
    says: Vec<String>,
    is_unknown: bool,
    changes: Vec<Change>,
}

impl Reader {
    fn line(&mut self, line: &str, rest: &[&str]) -> Result<()> {
        let is_first = self.function.is_none() && self.draft.is_none();
        if let Some(function) = line.strip_prefix("=== ").and_then(|rest| rest.strip_suffix(" ===")) {
            self.end()?;
            self.function = Some(function.to_owned());
            return Ok(());
        }
        for kind in ["wrong", "right"] {
            if let Some(rest) = line.strip_prefix(kind).and_then(|rest| rest.strip_prefix(' ')) {
                self.end()?;
                let (name, title) = rest
                    .split_once(": ")
                    .with_context(|| format!("`{line}` is not `{kind} NAME: a sentence`"))?;
                let function =
                    self.function.clone().context("there is no heading `=== FUNCTION ===` before")?;
                self.draft = Some(Draft {
                    kind,
                    name: name.to_owned(),
                    title: title.to_owned(),
                    changes: vec![Change { function, lines: Vec::new() }],
                    ..Draft::default()
                });
                return Ok(());
            }
        }
        let Some(draft) = &mut self.draft else {
            if is_first && (line.is_empty() || line.starts_with('#')) {
                if !line.is_empty() {
                    self.corpus.about += line;
                    self.corpus.about.push('\n');
                }
                return Ok(());
            }
            ensure!(line.is_empty(), "`{line}` belongs to no entry");
            return Ok(());
        };
        let change = draft.changes.last_mut().context("a place")?;
        if let Some(function) = line.strip_prefix('@') {
            let function = function.trim();
            let function = if function.is_empty() { change.function.clone() } else { function.to_owned() };
            // The first place may be another one than that of the heading.
            if change.lines.is_empty() {
                change.function = function;
            } else {
                draft.changes.push(Change { function, lines: Vec::new() });
            }
        } else if let Some((sign, text)) = Sign::of(line) {
            change.lines.push((sign, text.to_owned()));
        } else if line.is_empty() {
            // An empty line ends the entry, except between lines of code.
            let next = rest.iter().find(|line| !line.is_empty());
            if next.is_some_and(|next| Sign::of(next).is_some()) {
                change.lines.push((Sign::Stays, String::new()));
            } else {
                self.end()?;
            }
        } else {
            draft.key(line)?;
        }
        Ok(())
    }

    /// Ends the entry that is being read.
    fn end(&mut self) -> Result<()> {
        let Some(draft) = self.draft.take() else { return Ok(()) };
        let entry = draft.entry(self.stage, &self.file)?;
        let is_known = |other: &Entry| other.name == entry.name && other.kind() == entry.kind();
        ensure!(
            !self.corpus.entries.iter().any(is_known),
            "there are two entries `{} {}`",
            entry.kind(),
            entry.name
        );
        self.corpus.entries.push(entry);
        Ok(())
    }
}

impl Draft {
    fn key(&mut self, line: &str) -> Result<()> {
        ensure!(
            self.changes.len() == 1 && self.changes[0].lines.is_empty(),
            "`{line}` is no line of code: those begin with `-`, `+` or a space"
        );
        let pair = line.split_once(':').map(|(key, value)| (key.trim(), value.trim()));
        match pair.filter(|(_, value)| !value.is_empty()) {
            Some(("caught_by", check)) if self.caught_by.is_none() => self.caught_by = Some(check.to_owned()),
            Some(("breaks", item)) if self.breaks.is_none() => self.breaks = Some(item.to_owned()),
            Some(("says", words)) => self.says.push(words.to_owned()),
            Some(("diagnosis", "none")) => self.is_unknown = true,
            Some(("diagnosis", _)) => {
                bail!("`diagnosis:` must be `none`; for words of a diagnosis write `says:`")
            }
            Some((key @ ("caught_by" | "breaks"), _)) => bail!("`{}` has two lines `{key}: …`", self.name),
            _ => bail!(
                "`{line}` is not `breaks: ITEM`, `caught_by: CHECK`, `says: WORDS` or `diagnosis: none`"
            ),
        }
        Ok(())
    }

    fn entry(self, stage: u8, file: &str) -> Result<Entry> {
        let Draft { kind, name, title, breaks, caught_by, says, is_unknown, changes } = self;
        let claim = match kind {
            "right" => {
                ensure!(
                    breaks.is_none() && caught_by.is_none() && says.is_empty() && !is_unknown,
                    "right `{name}` is no mistake: no check catches it or names it"
                );
                Claim::Right
            }
            _ => {
                let caught_by =
                    caught_by.ok_or_else(|| anyhow!("wrong `{name}` lacks `caught_by: CHECK`"))?;
                ensure!(
                    !says.is_empty() || is_unknown,
                    "wrong `{name}` lacks `says: WORDS OF THE MESSAGE` or `diagnosis: none`"
                );
                Claim::Wrong { breaks: breaks.unwrap_or_default(), caught_by, says, is_unknown }
            }
        };
        let is_change = |change: &Change| change.lines.iter().any(|(sign, _)| *sign != Sign::Stays);
        ensure!(changes.iter().all(is_change), "{kind} `{name}` changes no line (`-` or `+`)");
        Ok(Entry { stage, name, title, claim, file: file.to_owned(), changes })
    }
}

/// Reads all files of the corpus of the kit at `root`, by their names without `.corpus`.
pub fn read_files(root: &Path) -> Result<Vec<(String, CorpusFile)>> {
    let read = |file: String| {
        let text = std::fs::read_to_string(root.join(&file)).with_context(|| file.clone())?;
        let name = last_part(&file).trim_end_matches(".corpus").to_owned();
        let corpus = CorpusFile::parse(&name, &text)?;
        Ok((name, corpus))
    };
    files_below(root, FOLDER, &|path| path.ends_with(".corpus"))?.into_iter().map(read).collect()
}

/// Writes a file of the corpus of the kit at `root`, sorted.
pub fn write_file(root: &Path, name: &str, corpus: &mut CorpusFile) -> Result<()> {
    corpus.sort(&Original::read(root, &format!("solutions/src/{name}.rs"))?);
    write(&root.join(FOLDER).join(format!("{name}.corpus")), &corpus.text())
}

/// Reads all entries of the kit at `root`, sorted by stage, then wrong before right, then by name.
pub fn read_all(root: &Path) -> Result<Vec<Entry>> {
    let mut entries: Vec<Entry> =
        read_files(root)?.into_iter().flat_map(|(_, corpus)| corpus.entries).collect();
    entries.sort_by_cached_key(|entry| (entry.stage, entry.claim == Claim::Right, entry.name.clone()));
    if let Some(pair) = entries.windows(2).find(|pair| pair[0].to_string() == pair[1].to_string()) {
        bail!("{} stands in {} and in {}", pair[0], corpus_file(&pair[0].file), corpus_file(&pair[1].file));
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "/// About one.\npub fn one() -> u32 {\n    let a = 1;\n    a\n}\n\npub fn two() -> u32 {\n    let a = 1;\n    a + 1\n}\n";

    const CORPUS: &str = "# About.\n\n=== one ===\n\nwrong counts: it counts\ncaught_by: a_check\nsays: too many\n-    let a = 1;\n\
                          +    let a = 2;\n@ two\n+    let b = 1;\n     a + 1\n\nright other: another way\n-    a\n+    a.max(0)\n";

    fn parse(text: &str) -> Result<CorpusFile> {
        CorpusFile::parse("stage1_a", text)
    }

    #[test]
    fn entries_are_read_applied_and_written() {
        let corpus = parse(CORPUS).unwrap();
        assert_eq!(corpus.text(), CORPUS);
        let [wrong, right] = &corpus.entries[..] else { panic!("{corpus:?}") };
        assert_eq!(
            (wrong.to_string(), wrong.caught_by()),
            ("wrong/stage1/counts".to_owned(), Some("a_check"))
        );
        assert!(
            right.claim == Claim::Right && right.changes_function("one") && !right.changes_function("two")
        );
        let original = Original::new("solutions/src/stage1_a.rs", FILE.to_owned()).unwrap();
        let changed = wrong.apply(&original).unwrap();
        assert!(
            changed.starts_with("/// About one.\npub fn one() -> u32 {\n    let a = 2;\n    a\n}\n"),
            "{changed}"
        );
        assert!(changed.ends_with("{\n    let a = 1;\n    let b = 1;\n    a + 1\n}\n"), "{changed}");
        assert!(right.apply(&original).unwrap().contains("    a.max(0)\n"));
    }

    #[test]
    fn a_place_that_is_not_there_or_there_twice_is_an_error() {
        let original = Original::new("solutions/src/stage1_a.rs", FILE.to_owned()).unwrap();
        let error = |text: &str| {
            let text = format!("=== {text}");
            let corpus = parse(&text.replacen('|', "===\nright r: r\n", 1)).unwrap();
            format!("{:#}", corpus.entries[0].apply(&original).unwrap_err())
        };
        assert!(error("one |-    b\n").contains("`one` does not contain these lines:\n        b"));
        assert!(error("* |-    let a = 1;\n").contains("2 times"));
        assert!(error("three |-    a\n").contains("no function `three`"));
        assert!(error("one |+    b\n").contains("add one that begins with a space"));
        assert!(error("one |-    a\n+    a\n").contains("changes nothing"));
    }

    #[test]
    fn a_line_that_is_wrong_is_named() {
        let error = |entry: &str| format!("{:#}", parse(&format!("=== f ===\n{entry}")).unwrap_err());
        assert!(
            error("wrong m\n-a\n").starts_with("line 2 of tests/corpus/stage1_a.corpus: `wrong m` is not")
        );
        assert!(error("wrong m: m\nsays: s\n-a\n").contains("lacks `caught_by"));
        assert!(error("wrong m: m\ncaught_by: c\n-a\n").contains("lacks `says"));
        assert!(error("wrong m: m\ncaught_by: c\nsays: s\ntarp: S3\n-a\n").contains("`tarp: S3` is not"));
        assert!(error("wrong m: m\ncaught_by: c\ndiagnosis: some\n-a\n").contains("must be `none`"));
        assert!(error("right m: m\ncaught_by: c\n-a\n").contains("is no mistake"));
        assert!(error("right m: m\n a\n").contains("changes no line"));
        assert!(error("right m: m\n-a\n\nright m: m\n-b\n").contains("two entries `right m`"));
        assert!(format!("{:#}", parse("right m: m\n").unwrap_err()).contains("no heading"));
    }
}
