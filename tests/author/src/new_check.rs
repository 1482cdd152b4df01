//! `author new-check`: writes what a new check needs, with blanks, and says which blanks are left.
//!
//! Each blank is an error of an existing test: `todo!` in the check, empty texts in the rubric, entries of the corpus without
//! lines. So a forgotten one cannot stay.

use crate::corpus::entry::{FOLDER, corpus_file};
use all_checks::STAGES;
use anyhow::{Context, Result, bail, ensure};
use grader::exercises;
use raykata::kit::Function;
use raykata::rubric::CheckEntry;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec, did_you_mean};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
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

/// What a skeleton needs to know about a student's function.
struct Asked {
    function: Function,
    /// Its name in the kit.
    name: &'static str,
    /// The type of a query.
    query: &'static str,
    /// The type of an answer.
    answer: &'static str,
}

macro_rules! all_asked {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($argument:ident: $Type:ty),* $(,)?)
            -> $Return:ty = $file:ident::$function:ident; |$query:tt: $Query:ty| -> $Answer:ty $adapter:block)*
    })*) => {
        const ALL: &[Asked] = &[$($(Asked {
            function: Function::$name,
            name: stringify!($name),
            query: stringify!($Query),
            answer: stringify!($Answer),
        }),*),*];
    };
}

raykata::student_functions! { all_asked }

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
        false => println!(
            "\nStill missing:\n{}",
            missing.iter().map(|blank| format!("  {blank}\n")).collect::<String>()
        ),
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
    Some((module, rest.split(':').next().unwrap_or(rest)))
}

/// Writes the check, its line in the list, its entry in the rubric and its entries in the corpus.
fn write(root: &Path, stage: &StageFiles, options: &NewCheckOptions) -> Result<()> {
    // Find the function, the check before and the module.
    if let Some((stage, _)) =
        STAGES.iter().find(|(_, checks)| checks.iter().any(|check| check.name == options.name))
    {
        bail!("`{}` is a check of stage {stage}: each check has a name of its own", options.name);
    }
    let asked = function(options)?;
    let listed = stage.listed();
    let known: Vec<&str> = listed.iter().map(|(_, name)| *name).collect();
    let begins = |name: &str| name.starts_with(&format!("{}_", asked.function.name()));
    let before = match &options.after {
        Some(after) => match known.contains(&after.as_str()) {
            true => Some(after.clone()),
            false => bail!("stage {} has no check `{after}`{}", options.stage, did_you_mean(after, &known)),
        },
        None => known.iter().rev().find(|name| begins(name)).map(|name| (*name).to_owned()),
    };
    let module_of = |check: &String| {
        listed.iter().find(|(_, name)| name == check).map(|(module, _)| (*module).to_owned())
    };
    let module = options.module.clone().or_else(|| before.as_ref().and_then(module_of));
    let module =
        module.context("no check before it shows the module: add `--module NAME` or `--after CHECK`")?;

    // Add the function at the end of its module, before the module's tests.
    let path = format!("{}/src/{module}.rs", stage.folder);
    let skeleton = skeleton(&options.name, asked);
    let text = match root.join(&path).exists() {
        true => {
            let text = read(root, &path)?;
            let end = text.find("\n#[cfg(test)]").unwrap_or(text.len());
            format!("{}\n{skeleton}{}", &text[..end], &text[end..])
        }
        false => format!("//! Checks of `{}`.\n\n{skeleton}", asked.function.name()),
    };

    // Add the module, if it is new, and the line of the list behind the check before, or at the end.
    let mut list = match root.join(&path).exists() {
        true => stage.list.clone(),
        false => with_module(&stage.list, &module)?,
    };
    let is_before = |line: &str| checked(line).is_some_and(|(_, name)| Some(name) == before.as_deref());
    let place = after_line(&list, is_before).or_else(|| Some(list.find(END_OF_LIST)? + 1));
    list.insert_str(place.context("the list has no end")?, &format!("    {module}::{}\n", options.name));

    // Write all files, after all has been found.
    let rubric = with_entry(&stage.rubric, options, before.as_deref())?;
    save(root, &path, &text)?;
    save(root, &format!("{}/src/lib.rs", stage.folder), &list)?;
    save(root, &format!("{}/rubric.toml", stage.folder), &rubric)?;
    write_entries(root, asked, &options.name)
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

/// Writes a mistake and another correct solution into the corpus, among those of the same function.
fn write_entries(root: &Path, asked: &Asked, name: &str) -> Result<()> {
    let path = corpus_file(&format!("solutions/src/{}.rs", asked.function.file()));
    let mut text = if root.join(&path).exists() { read(root, &path)? } else { String::new() };
    // Find the entries of the function.
    let heading = format!("\n=== {} ===\n", asked.function.name());
    if !text.contains(&heading) {
        text += &heading;
    }
    let begin = text.find(&heading).map_or(text.len(), |start| start + heading.len());
    let end = text[begin..].find("\n=== ").map_or(text.len(), |length| begin + length);
    let mut entries = text[begin..end].to_owned();
    // Insert the new ones in their order: mistakes first, then by name.
    let blanks = [
        ("wrong", format!("wrong {name}: {BLANK}\ncaught_by: {name}\nsays: {BLANK}\n")),
        ("right", format!("right {name}: {BLANK}\n")),
    ];
    for (kind, blank) in blanks {
        let mut at = 0;
        let later = entries.split_inclusive('\n').find_map(|line| {
            let start = at;
            at += line.len();
            let head = line.split_once(' ').filter(|(kind, _)| ["wrong", "right"].contains(kind))?;
            let is_later = (head.0 == "right", head.1) > (kind == "right", &format!("{name}:"));
            is_later.then_some(start)
        });
        match later {
            Some(start) => entries.insert_str(start, &format!("{blank}\n")),
            None => entries += &format!("\n{blank}"),
        }
    }
    text.replace_range(begin..end, &entries);
    save(root, &path, &text)
}

/// The function that the check asks.
fn function(options: &NewCheckOptions) -> Result<&'static Asked> {
    let of_stage = || ALL.iter().filter(|asked| asked.function.stage() == options.stage);
    let is = |asked: &&Asked, name: &str| asked.function.name() == name || asked.name == name;
    if let Some(name) = &options.function {
        let known: Vec<&str> = of_stage().map(|asked| asked.function.name()).collect();
        return of_stage().find(|asked| is(asked, name)).with_context(|| {
            format!("stage {} has no function `{name}`{}", options.stage, did_you_mean(name, &known))
        });
    }
    let begins = of_stage().filter(|asked| options.name.starts_with(&format!("{}_", asked.function.name())));
    begins.max_by_key(|asked| asked.function.name().len()).with_context(|| {
        let known: Vec<&str> = of_stage().map(|asked| asked.function.name()).collect();
        format!(
            "`{}` does not begin with the name of a function of stage {}: add `--function NAME`, one of {}",
            options.name,
            options.stage,
            known.join(", ")
        )
    })
}

/// A check with blanks. It names all paths in full, because it must compile in any module.
fn skeleton(name: &str, asked: &Asked) -> String {
    let (method, function) = (asked.name, asked.function.name());
    let [query, answer] = [asked.query, asked.answer].map(|text| text.replace(" < ", "<").replace(" >", ">"));
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
            if is_right(query, &yours) {{
                return Ok(());
            }}
            // Name a mistake only if it gives exactly this answer to this query.
            let expected = || -> String {{ todo!("state the expected answer, and its source behind it") }};
            let (input, yours) = (format!("{function}({{query:?}})"), format!("{{yours:?}}"));
            let broken = checks::Broken::with_texts(input, yours, expected(), "double precision");
            Err(broken.explained_by([]))
        }})
    }})
}}
"#
    )
}

/// The text of a crate with one module more, in alphabetical order.
fn with_module(text: &str, module: &str) -> Result<String> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let module_of = |line: &String| {
        Some(line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';')?.to_owned())
    };
    let last =
        lines.iter().rposition(|line| module_of(line).is_some()).context("the crate has no modules")?;
    let later = lines.iter().position(|line| module_of(line).is_some_and(|name| name.as_str() > module));
    lines.insert(later.unwrap_or(last + 1), format!("mod {module};"));
    Ok(lines.join("\n") + "\n")
}

/// The position behind the first line of which `is` holds.
fn after_line(text: &str, is: impl Fn(&str) -> bool) -> Option<usize> {
    let mut end = 0;
    text.split_inclusive('\n').find_map(|line| {
        end += line.len();
        is(line).then_some(end)
    })
}

/// A stage of the rubric, as far as this command reads it.
#[derive(Deserialize)]
struct Rubric {
    checks: BTreeMap<String, CheckEntry>,
}

/// The blanks that are left, each with its place.
fn missing(root: &Path, options: &NewCheckOptions) -> Result<Vec<String>> {
    let (mut missing, name) = (Vec::new(), &options.name);
    let stage = StageFiles::read(root, options.stage)?;
    let listed = stage.listed();
    let (module, _) =
        listed.iter().find(|(_, listed)| listed == name).context("the check is not in the list")?;
    // Find the `todo!` in the function.
    let path = format!("{}/src/{module}.rs", stage.folder);
    let text = read(root, &path)?;
    let head = format!("fn {name}(");
    let mut lines = text.lines().zip(1..).skip_while(|(line, _)| !line.contains(&head));
    ensure!(lines.clone().next().is_some(), "{path} has no function `{name}`");
    for (line, number) in lines.by_ref().take_while(|(line, _)| *line != "}") {
        if let Some((_, blank)) = line.split_once("todo!(\"") {
            missing.push(format!("{path}:{number}: {}", blank.split('"').next().unwrap_or_default()));
        }
    }
    // Find the empty texts in the rubric.
    let path = format!("{}/rubric.toml", stage.folder);
    let mut rubric: BTreeMap<String, Rubric> = toml::from_str(&stage.rubric).with_context(|| path.clone())?;
    let entry =
        rubric.remove(&format!("stage{}", options.stage)).and_then(|mut rubric| rubric.checks.remove(name));
    let entry = entry.with_context(|| format!("{path} has no entry `{name}`"))?;
    let table = format!("[stage{}.checks.{name}]", options.stage);
    let line = stage.rubric.lines().position(|line| line == table).unwrap_or_default() + 1;
    let hints = entry.hints.iter().any(|hint| hint.trim().is_empty());
    let blanks = [
        (entry.points == 0, "points"),
        (
            entry.title.trim().is_empty(),
            "title: the law in plain words, which is also a heading of the message",
        ),
        (entry.slide.trim().is_empty(), "slide: the lecture and the slide that teach it"),
        (hints, "hints: a question, the formula, and nearly the code"),
    ];
    missing.extend(
        blanks.iter().filter(|(is_blank, _)| *is_blank).map(|(_, what)| format!("{path}:{line}: {what}")),
    );
    missing.extend(missing_entries(root, options)?);
    Ok(missing)
}

/// The blanks of the corpus: of each mistake that the check must catch, and of the correct solution with its name.
fn missing_entries(root: &Path, options: &NewCheckOptions) -> Result<Vec<String>> {
    let (mut missing, mut is_caught, name) = (Vec::new(), false, options.name.as_str());
    let mut files: Vec<String> = Vec::new();
    for file in fs::read_dir(root.join(FOLDER)).with_context(|| format!("cannot read {FOLDER}"))? {
        files.push(file?.file_name().to_string_lossy().into_owned());
    }
    files.retain(|file| file.starts_with(&format!("stage{}_", options.stage)) && file.ends_with(".corpus"));
    files.sort();
    for path in files.iter().map(|file| format!("{FOLDER}/{file}")) {
        let text = read(root, &path)?;
        let mut number = 1;
        for entry in text.split_inclusive("\n\n") {
            let catches = entry.lines().any(|line| line.strip_prefix("caught_by: ") == Some(name));
            if catches || entry.starts_with(&format!("right {name}: ")) {
                let kind = entry.split(' ').next().unwrap_or_default();
                let is_blank = |line: &str| line.ends_with(&format!(": {BLANK}"));
                let blanks = [
                    (entry.lines().next().is_some_and(is_blank), "the mistake or the method, in a sentence"),
                    (
                        entry.lines().skip(1).any(is_blank),
                        "words of the message, or `diagnosis: none` in place of `says:`",
                    ),
                    (
                        !entry.contains("\n-") && !entry.contains("\n+"),
                        "the lines that go (`-`) and come (`+`)",
                    ),
                ];
                let blanks = blanks.iter().filter(|(is_blank, _)| *is_blank);
                missing.extend(blanks.map(|(_, what)| format!("{path}:{number}: {kind}: {what}")));
            }
            is_caught |= catches;
            number += entry.matches('\n').count();
        }
    }
    if !is_caught {
        missing.push(format!("{FOLDER}: no mistake of stage {} has `caught_by: {name}`", options.stage));
    }
    Ok(missing)
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
            blanks[0].starts_with("tests/checks/stage3/src/slabs.rs:")
                && blanks[0].ends_with(": draw a query")
        );
        assert!(blanks[3].starts_with(&format!("{rubric}:")), "{blanks:?}");

        let corpus = format!("{FOLDER}/stage3_boxes.corpus");
        assert!(read(root, &corpus).unwrap().contains("says: …\n\nwrong two: it is\n"));
        assert_eq!(blanks[9], format!("{corpus}:18: right: the mistake or the method, in a sentence"));

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
        assert!(list.contains("mod picture;\nmod quick;\nmod search_mistakes;\n"), "{list}");
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
