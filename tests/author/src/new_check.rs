//! `author new-check`: writes what a new check needs, with blanks, and says which blanks are left.
//!
//! Each blank is an error of an existing test: `todo!` in the check, empty texts in the rubric, entries of the corpus without
//! lines. So a forgotten one cannot stay.

use crate::corpus::entry::{FOLDER, corpus_file};
use all_checks::STAGES;
use anyhow::{Context, Result, bail, ensure};
use grader::exercises;
use raykata::kit::Function;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec, did_you_mean};
use std::fs;
use std::ops::Range;
use std::path::Path;

/// `author new-check`.
pub static SPEC: Spec = Spec {
    name: "author new-check",
    about: "Write a new check with blanks, its entry in the rubric and two in the corpus, and say which blanks are left. Run it \
            again to see what is still missing.",
    arguments: &[Argument::required("NAME", "The law in snake case, such as slab_respects_the_range.")],
    options: &[&[
        Opt::value("--stage", "N", "The stage of the check.").required(),
        Opt::value("--function", "NAME", "The student's function [default: the one with which NAME begins]."),
        Opt::value(
            "--module",
            "NAME",
            "The module that holds it, which may be new [default: that of the check before].",
        ),
        Opt::value("--after", "CHECK", "The check before it [default: the last one of the function]."),
    ]],
};

/// The options of `author new-check`.
pub struct NewCheckOptions {
    name: String,
    stage: u8,
    function: Option<String>,
    module: Option<String>,
    after: Option<String>,
}

impl NewCheckOptions {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<NewCheckOptions, Misuse> {
        let name = |text: &str| {
            let is_name = text.starts_with(|letter: char| letter.is_ascii_lowercase())
                && text.chars().all(|letter| matches!(letter, 'a'..='z' | '0'..='9' | '_'));
            if is_name { Ok(text.to_owned()) } else { Err("a name consists of a-z, 0-9 and _") }
        };
        Ok(NewCheckOptions {
            name: given.parsed_argument(0, name)?.unwrap_or_default(),
            stage: given.parsed("--stage", |text| text.parse::<u8>())?.unwrap_or_default(),
            function: given.parsed("--function", name)?,
            module: given.parsed("--module", name)?,
            after: given.parsed("--after", name)?,
        })
    }
}

/// Writes what the check lacks, and says what is missing. Returns whether nothing is, or whether something was written.
pub fn run(root: &Path, options: &NewCheckOptions) -> Result<bool> {
    let stage = StageFiles::read(root, options.stage)?;
    let is_new = !stage.listed().iter().any(|(_, name)| *name == options.name);
    if is_new {
        write(root, &stage, options)?;
    }
    let missing = missing(root, options)?;
    match missing.is_empty() {
        true => println!("no blank is left in `{}`", options.name),
        false => println!("\nStill missing:\n  {}\n", missing.join("\n  ")),
    }
    println!("Then:\n{}", next_steps(options).trim_end());
    Ok(is_new || missing.is_empty())
}

/// The files of a stage that name its checks.
struct StageFiles {
    folder: String,
    list: String,
    rubric: String,
}

/// The text of a blank in the corpus.
const BLANK: &str = "…";

/// The last line of the list of a stage.
const END_OF_LIST: &str = "\n] }\n";

impl StageFiles {
    fn read(root: &Path, stage: u8) -> Result<StageFiles> {
        let folder = format!("tests/checks/stage{stage}");
        ensure!(
            root.join(&folder).is_dir(),
            "there is no stage {stage}: the checks of stage N are in tests/checks/stageN"
        );
        let list = read(root, &format!("{folder}/src/lib.rs"))?;
        ensure!(
            list.contains("checks::stage! {") && list.contains(END_OF_LIST),
            "{folder}/src/lib.rs has no list `checks::stage! {{ … ] }}`"
        );
        Ok(StageFiles { list, rubric: read(root, &format!("{folder}/rubric.toml"))?, folder })
    }

    /// The checks in the list, each with its module.
    fn listed(&self) -> Vec<(&str, &str)> {
        let list = self.list.split_once("checks::stage! {").map_or("", |(_, list)| list);
        list.lines().filter_map(checked).collect()
    }
}

/// The module and the check of a line of the list, such as `slabs::slab_of_a_flat_box_is_hit: turned`.
fn checked(line: &str) -> Option<(&str, &str)> {
    let (module, rest) = line.trim().split_once("::")?;
    Some((module, rest.split([':', ' ']).next().unwrap_or(rest)))
}

/// Writes the check, its line in the list, its entry in the rubric and its entries in the corpus.
fn write(root: &Path, stage: &StageFiles, options: &NewCheckOptions) -> Result<()> {
    // Find the function, the check before and the module.
    let name = &options.name;
    if let Some((stage, _)) = STAGES.iter().find(|(_, checks)| checks.iter().any(|check| check.name == name))
    {
        bail!("`{name}` is a check of stage {stage}: each check has a name of its own");
    }
    let asked = function(options)?;
    let listed = stage.listed();
    let begins = format!("{}_", asked.name());
    let before = match &options.after {
        Some(after) => {
            let known: Vec<&str> = listed.iter().map(|(_, name)| *name).collect();
            let found = listed.iter().find(|(_, name)| name == after);
            let unknown =
                || format!("stage {} has no check `{after}`{}", options.stage, did_you_mean(after, &known));
            Some(found.with_context(unknown)?)
        }
        None => listed.iter().rev().find(|(_, name)| name.starts_with(&begins)),
    };
    let module = options.module.as_deref().or(before.map(|(module, _)| *module));
    let module =
        module.context("no check before it shows the module: add `--module NAME` or `--after CHECK`")?;

    // Add the function at the end of its module, before the module's tests, and a new module beside the first one: `cargo fmt`
    // sorts them.
    let path = format!("{}/src/{module}.rs", stage.folder);
    let skeleton = skeleton(name, asked);
    let (text, mut list) = match root.join(&path).exists() {
        true => {
            let text = read(root, &path)?;
            let end = text.find("\n#[cfg(test)]").unwrap_or(text.len());
            (format!("{}\n{skeleton}{}", &text[..end], &text[end..]), stage.list.clone())
        }
        false => (
            format!("//! Checks of `{}`.\n\n{skeleton}", asked.name()),
            stage.list.replacen("\nmod ", &format!("\nmod {module};\nmod "), 1),
        ),
    };

    // Add the line of the list behind that of the check before, or at the end.
    let after = before.and_then(|(module, name)| list.find(&format!("    {module}::{name}")));
    let place = after.or(list.find(END_OF_LIST)).context("the list has no end")?;
    let place = place + list[place..].find('\n').map_or(0, |end| end + 1);
    list.insert_str(place, &format!("    {module}::{name}\n"));

    // Write all files, after all has been found.
    let rubric = with_entry(&stage.rubric, options, before.map(|(_, name)| *name))?;
    save(root, &path, &text)?;
    save(root, &format!("{}/src/lib.rs", stage.folder), &list)?;
    save(root, &format!("{}/rubric.toml", stage.folder), &rubric)?;
    // The mistake and the correct solution stand at the end of the corpus: `corpus --bless` sorts them.
    let path = corpus_file(&format!("solutions/src/{}.rs", asked.file()));
    let text = if root.join(&path).exists() { read(root, &path)? } else { String::new() };
    let entries = format!(
        "\n=== {} ===\n\nwrong {name}: {BLANK}\ncaught_by: {name}\nsays: {BLANK}\n\nright {name}: {BLANK}\n",
        asked.name()
    );
    save(root, &path, &(text + &entries))
}

/// The text of a rubric with a blank entry behind that of the check before, with the same slide, or at the end.
fn with_entry(rubric: &str, options: &NewCheckOptions, before: Option<&str>) -> Result<String> {
    let table = |check: &str| format!("[stage{}.checks.{check}]\n", options.stage);
    let (end, slide) = match before {
        Some(before) => {
            let start =
                rubric.find(&table(before)).with_context(|| format!("the rubric has no entry `{before}`"))?;
            let entry = &rubric[start..];
            let length = entry.find("\n\n").map_or(entry.len(), |end| end + 1);
            let slide = entry[..length].lines().find_map(|line| line.strip_prefix("slide = "));
            (start + length, slide.unwrap_or("\"\""))
        }
        None => (rubric.len(), "\"\""),
    };
    let hints = "hints = [\n    \"\",\n    \"\",\n    \"\",\n]\n";
    let entry = format!("\n{}points = 0\ntitle = \"\"\nslide = {slide}\n{hints}", table(&options.name));
    Ok(format!("{}{entry}{}", &rubric[..end], &rubric[end..]))
}

/// The function that the check asks.
fn function(options: &NewCheckOptions) -> Result<Function> {
    let of_stage = || Function::ALL.iter().copied().filter(|asked| asked.stage() == options.stage);
    let is = |asked: &Function, name: &str| asked.name() == name || format!("{asked:?}") == name;
    if let Some(name) = &options.function {
        let known: Vec<&str> = of_stage().map(|asked| asked.name()).collect();
        return of_stage().find(|asked| is(asked, name)).with_context(|| {
            format!("stage {} has no function `{name}`{}", options.stage, did_you_mean(name, &known))
        });
    }
    let begins = of_stage().filter(|asked| options.name.starts_with(&format!("{}_", asked.name())));
    begins.max_by_key(|asked| asked.name().len()).with_context(|| {
        let known: Vec<&str> = of_stage().map(|asked| asked.name()).collect();
        format!(
            "`{}` does not begin with the name of a function of stage {}: add `--function NAME`, one of {}",
            options.name,
            options.stage,
            known.join(", ")
        )
    })
}

/// A check with blanks. It names all paths in full, because it must compile in any module.
fn skeleton(name: &str, asked: Function) -> String {
    let (method, function) = (format!("{asked:?}"), asked.name());
    let [query, answer] = asked.types();
    // Types of the language need no import.
    let types = format!("{query} {answer}");
    let mut words = types.split(|letter: char| !letter.is_alphanumeric());
    let is_of_kit = |word: &str| word.starts_with(char::is_uppercase) && !["Option", "Vec"].contains(&word);
    let imports = if words.any(is_of_kit) { "\n    use raykata::kit::types::*;" } else { "" };
    format!(
        r#"pub(super) fn {name}(trial: &checks::Trial<'_>) -> checks::CheckResult {{
    use proptest::prelude::*;{imports}
    // Draw inputs that are not special: `checks::nasty` has their frames, scales and errors.
    let inputs = any::<u64>().prop_map(|_| -> {query} {{ todo!("draw a query") }});
    trial.forall(1000, inputs, |queries| {{
        checks::judge::compare(queries, trial.kit.{method}(queries), |query, yours| {{
            // Verify the answer by exact arithmetic, in double precision or by a law. Do not compute it as the exercise does.
            let is_right = |_: &{query}, _: &{answer}| -> bool {{ todo!("judge an answer") }};
            let expected = || -> String {{ todo!("state the expected answer, and its source behind it") }};
            let (input, answer) = (format!("{function}({{query:?}})"), format!("{{yours:?}}"));
            let broken = || checks::Broken::with_texts(input, answer, expected(), "double precision");
            // List wrong formulas, each with whether it gives exactly this answer to this query.
            checks::judge::unless(is_right(query, &yours), broken).formulas([])
        }})
    }})
}}
"#
    )
}

/// The blanks that are left: the lines with one, each with its place.
fn missing(root: &Path, options: &NewCheckOptions) -> Result<Vec<String>> {
    let (mut missing, name) = (Vec::new(), options.name.as_str());
    let stage = StageFiles::read(root, options.stage)?;
    let listed = stage.listed();
    let (module, _) =
        listed.iter().find(|(_, listed)| *listed == name).context("the check is not in the list")?;
    // Find the `todo!` in the function, and the empty texts in the rubric.
    let code = format!("{}/src/{module}.rs", stage.folder);
    let text = read(root, &code)?;
    let (head, end) = (format!("fn {name}("), "\n}\n");
    let function = part(&text, &head, end).with_context(|| format!("{code} has no function `{name}`"))?;
    missing.extend(blanks(&code, &text, function, |line| line.contains("todo!(")));
    let rubric = format!("{}/rubric.toml", stage.folder);
    let head = format!("[stage{}.checks.{name}]\n", options.stage);
    let entry =
        part(&stage.rubric, &head, "\n\n").with_context(|| format!("{rubric} has no entry `{name}`"))?;
    let is_blank = |line: &str| line.contains("\"\"") || line == "points = 0";
    missing.extend(blanks(&rubric, &stage.rubric, entry, is_blank));
    // Find the blanks of each mistake that the check must catch, and of the correct solution with its name.
    let mut is_caught = false;
    for (file, corpus) in corpus_of_stage(root, options.stage)? {
        let mut start = 0;
        for entry in corpus.split_inclusive("\n\n") {
            let catches = entry.lines().any(|line| line.strip_prefix("caught_by: ") == Some(name));
            is_caught |= catches;
            if catches || entry.starts_with(&format!("right {name}: ")) {
                let has_lines = entry.contains("\n-") || entry.contains("\n+");
                let is_blank = |line: &str| {
                    line.ends_with(&format!(": {BLANK}")) || (!has_lines && entry.starts_with(line))
                };
                missing.extend(blanks(&file, &corpus, start..start + entry.trim_end().len(), is_blank));
            }
            start += entry.len();
        }
    }
    if !is_caught {
        missing.push(format!("{FOLDER}: no mistake of stage {} has `caught_by: {name}`", options.stage));
    }
    Ok(missing)
}

/// The files of the corpus about a stage, with their texts.
fn corpus_of_stage(root: &Path, stage: u8) -> Result<Vec<(String, String)>> {
    let mut files: Vec<String> = Vec::new();
    for file in fs::read_dir(root.join(FOLDER)).with_context(|| format!("cannot read {FOLDER}"))? {
        files.push(format!("{FOLDER}/{}", file?.file_name().to_string_lossy()));
    }
    files.retain(|file| file.starts_with(&format!("{FOLDER}/stage{stage}_")) && file.ends_with(".corpus"));
    files.sort();
    files.into_iter().map(|file| Ok((file.clone(), read(root, &file)?))).collect()
}

/// The bytes from `head` to the first `end` behind it, or to the end of the text.
fn part(text: &str, head: &str, end: &str) -> Option<Range<usize>> {
    let start = text.find(head)?;
    Some(start..text[start..].find(end).map_or(text.len(), |length| start + length))
}

/// The blank lines within a part of a file, each with its place.
fn blanks(path: &str, text: &str, part: Range<usize>, is_blank: impl Fn(&str) -> bool) -> Vec<String> {
    let first = text[..part.start].matches('\n').count() + 1;
    let lines = text[part].lines().zip(first..).filter(|(line, _)| is_blank(line));
    lines.map(|(line, number)| format!("{path}:{number}: {}", line.trim())).collect()
}

/// What to run when no blank is left.
fn next_steps(options: &NewCheckOptions) -> String {
    let NewCheckOptions { name, stage, .. } = options;
    let steps = [
        ("the code has its format", "cargo fmt --all".to_owned()),
        ("the reference passes", format!("cargo test -p solutions --test suite {name}")),
        ("the gap of an exercise is named", format!("cargo test --test stage{stage} {name}")),
        ("constants earn nothing", "cargo test -p all-checks".to_owned()),
        ("hidden inputs are not the public ones", "cargo test -p grader --lib every_check".to_owned()),
        ("the mistake is caught and named", format!("cargo run -p author -- corpus {name}")),
        ("its results are stored", format!("cargo run -p author -- corpus --stage {stage} --bless")),
        ("numbers in documents are right", "cargo run -p author -- sync".to_owned()),
    ];
    steps.iter().map(|(why, command)| format!("  {why:<38} {command}\n")).collect()
}

fn read(root: &Path, path: &str) -> Result<String> {
    fs::read_to_string(root.join(path)).with_context(|| format!("cannot read {path}"))
}

fn save(root: &Path, path: &str, text: &str) -> Result<()> {
    exercises::write(&root.join(path), text)?;
    println!("wrote {path}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus::entry::CorpusFile;

    /// A copy of the checks of stage 3.
    fn copy() -> tempfile::TempDir {
        let (root, copy) = (grader::kits::root().unwrap(), tempfile::tempdir().unwrap());
        let folder = "tests/checks/stage3";
        fs::create_dir_all(copy.path().join(folder).join("src")).unwrap();
        for file in ["rubric.toml", "src/lib.rs", "src/slabs.rs"] {
            fs::copy(root.join(folder).join(file), copy.path().join(folder).join(file)).unwrap();
        }
        fs::create_dir(copy.path().join(FOLDER)).unwrap();
        let entry = "caught_by: slab_of_a_flat_box_is_hit\nsays: flat\n-    1\n";
        let corpus = format!(
            "\n=== slab ===\n\nwrong one: it is\n{entry}\nwrong two: it is\n{entry}\n=== union ===\n\nwrong three: it is\n{entry}"
        );
        fs::write(copy.path().join(FOLDER).join("stage3_boxes.corpus"), corpus).unwrap();
        copy
    }

    fn options(name: &str) -> NewCheckOptions {
        NewCheckOptions { name: name.to_owned(), stage: 3, function: None, module: None, after: None }
    }

    fn change(root: &Path, path: &str, old: &str, new: &str) {
        let text = read(root, path).unwrap();
        assert!(text.contains(old), "{path}: {old}");
        save(root, path, &text.replace(old, new)).unwrap();
    }

    #[test]
    fn a_new_check_is_listed_behind_the_last_of_its_function_and_its_blanks_are_found() {
        let (copy, options) = (copy(), options("slab_is_quick"));
        let root = copy.path();
        let [list, slabs, rubric] =
            ["src/lib.rs", "src/slabs.rs", "rubric.toml"].map(|file| format!("tests/checks/stage3/{file}"));
        assert!(run(root, &options).unwrap());
        assert!(read(root, &list).unwrap().contains("aimed_at\n    slabs::slab_is_quick\n    splits::"));
        assert!(read(root, &rubric).unwrap().contains("]\n\n[stage3.checks.slab_is_quick]\npoints = 0\n"));
        assert!(read(root, &slabs).unwrap().contains("trial.kit.slab(queries)"));
        assert!(!run(root, &options).unwrap(), "the second run finds blanks");
        let blanks = missing(root, &options).unwrap();
        assert_eq!(blanks.len(), 11, "{blanks:?}");
        assert!(
            blanks[0].starts_with("tests/checks/stage3/src/slabs.rs:") && blanks[0].contains("draw a query")
        );
        assert!(blanks[3].starts_with(&format!("{rubric}:")), "{blanks:?}");

        let corpus = format!("{FOLDER}/stage3_boxes.corpus");
        assert!(read(root, &corpus).unwrap().ends_with("says: …\n\nright slab_is_quick: …\n"));
        assert_eq!(blanks[10], format!("{corpus}:27: right slab_is_quick: …"));

        let parsed = || CorpusFile::parse("stage3_boxes", &read(root, &corpus).unwrap());
        assert!(format!("{:#}", parsed().unwrap_err()).ends_with("changes no line (`-` or `+`)"));

        change(root, &corpus, "says: …\n", "says: slow\n-    1\n+    2\n");
        change(root, &corpus, "right slab_is_quick: …\n", "right slab_is_quick: …\n-    1\n+    3\n");
        change(root, &corpus, ": …", ": a sentence");
        change(root, &slabs, "todo!", "unwrap_or_default!");
        change(root, &rubric, "points = 0", "points = 2");
        change(root, &rubric, "\"\"", "\"a text\"");
        assert!(run(root, &options).unwrap(), "no blank is left");
        assert_eq!(parsed().unwrap().entries.len(), 5);
    }

    #[test]
    fn a_new_module_is_declared() {
        let copy = copy();
        let options = NewCheckOptions { module: Some("quick".to_owned()), ..options("slab_is_quick") };
        run(copy.path(), &options).unwrap();
        let list = read(copy.path(), "tests/checks/stage3/src/lib.rs").unwrap();
        assert!(list.contains("\nmod quick;\n"), "{list}");
        assert!(list.contains("    quick::slab_is_quick\n"));
        assert!(
            read(copy.path(), "tests/checks/stage3/src/quick.rs")
                .unwrap()
                .starts_with("//! Checks of `slab`.\n\npub(super) fn")
        );
    }

    #[test]
    fn errors_say_what_to_add() {
        let copy = copy();
        let error = |options: NewCheckOptions| format!("{:#}", run(copy.path(), &options).unwrap_err());
        assert!(error(options("boxes_are_quick")).contains("add `--function NAME`, one of "));
        assert!(error(options("nearest_root_of_nan_is_the_other_one")).contains("is a check of stage 1"));
        assert!(
            error(NewCheckOptions { after: Some("slab_is".to_owned()), ..options("slab_is_quick") })
                .contains("no check `slab_is`")
        );
        assert!(
            error(NewCheckOptions { stage: 13, ..options("slab_is_quick") }).contains("there is no stage 13")
        );
    }
}
