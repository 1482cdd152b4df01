//! Builds all entries of the corpus as one program, and starts it as one of them.

use super::FOLDER;
use super::build_folder::{BuildFolder, Built, Product};
use super::entry::{Entry, Original};
use super::schemata::{self, Form, Schema};
use anyhow::{Context, Result, bail};
use checks::Check;
use grader::files_below::files_below;
use grader::kits::{Need, Source as Kits, Which};
use grader::queue;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The switch, at the end of the library of the program.
const SWITCH: &str = r#"
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

static CHOSEN: AtomicU32 = AtomicU32::new(0);
static RECORDS: AtomicBool = AtomicBool::new(false);

/// The number of the entry that this program is; 0 is the reference. `function` asks for it.
#[inline(always)]
pub fn chosen(function: &'static str) -> u32 {
    if RECORDS.load(Ordering::Relaxed) {
        record(function);
    }
    CHOSEN.load(Ordering::Relaxed)
}

/// Takes the number from the name by which the program was started.
pub fn choose() {
    let name = program();
    let name = name.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
    let number = name.strip_prefix("entry-").and_then(|number| number.parse().ok());
    CHOSEN.store(number.unwrap_or(0), Ordering::Relaxed);
    RECORDS.store(name.starts_with("record-"), Ordering::Relaxed);
}

fn program() -> std::path::PathBuf {
    std::env::args_os().next().unwrap_or_default().into()
}

/// Adds the function to a file beside the program.
#[cold]
fn record(function: &'static str) {
    use std::io::Write;
    static KNOWN: std::sync::Mutex<std::collections::BTreeSet<&str>> = std::sync::Mutex::new(std::collections::BTreeSet::new());
    if KNOWN.lock().unwrap().insert(function) {
        let file = program().with_extension("reached");
        let mut file = std::fs::OpenOptions::new().create(true).append(true).open(file).unwrap();
        file.write_all(format!("{function}\n").as_bytes()).unwrap();
    }
}
"#;

/// The programs of the entries.
pub struct Program {
    /// The folder with one name of the program for each entry.
    folder: tempfile::TempDir,
    /// How each entry is built, and the switches that it uses.
    built: BTreeMap<String, (Form, BTreeSet<String>)>,
}

impl Program {
    /// Builds the program of these entries of the kit at `root`. An error names the entries that do not fit or do not compile.
    pub fn build(root: &Path, entries: &[Entry]) -> Result<Program> {
        let (mut texts, mut built) = (Vec::new(), BTreeMap::new());
        let mut alone = Vec::new();
        let mut modules = String::new();
        let mut complaints = Vec::new();
        for file in stage_files(root)? {
            let original = Original::read(root, &file)?;
            // Apply the entries of this file.
            let mut changed: Vec<(&Entry, String)> = Vec::new();
            for entry in entries.iter().filter(|entry| entry.file == file) {
                match entry.apply(&original) {
                    Ok(text) => changed.push((entry, text)),
                    Err(error) => complaints.push(format!("{error:#}")),
                }
            }
            let of_file: Vec<&Entry> = changed.iter().map(|(entry, _)| *entry).collect();
            let whole: Vec<String> = changed.iter().map(|(_, text)| text.clone()).collect();
            let Schema { text, modules: beside, forms, changed } = schemata::schema(&original, changed)?;
            for (number, entry) in of_file.into_iter().enumerate() {
                built.insert(entry.to_string(), (forms[number], changed[number].clone()));
                if forms[number] == Form::Alone {
                    alone.push((entry, whole[number].clone()));
                }
            }
            texts.push((file, text));
            for (name, text) in beside {
                modules += &format!("pub mod {name};\n");
                texts.push((format!("solutions/src/{name}.rs"), text));
            }
        }
        if !complaints.is_empty() {
            bail!("{}", complaints.join("\n\n"));
        }
        let folder = root.join(FOLDER);
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        let program = Program { folder: tempfile::tempdir_in(&folder)?, built };
        program.build_all(root, &mut texts, &modules)?;
        program.build_alone(root, &alone)?;
        for entry in entries.iter().filter(|entry| program.form(entry) != Form::Alone) {
            fs::hard_link(program.path(0), program.path(schemata::number(entry)))?;
        }
        Ok(program)
    }

    /// Builds the entries that share a program.
    fn build_all(&self, root: &Path, texts: &mut Vec<(String, String)>, modules: &str) -> Result<()> {
        let build_folder = BuildFolder::open(root, "all", Product::Worker(Need::Checks))?;
        let library = "solutions/src/lib.rs";
        let text = build_folder.original(library)?;
        texts.push((library.to_owned(), format!("#![allow(warnings)]\n{text}\n{modules}{SWITCH}")));
        let main = "solutions/src/worker.rs";
        let text = build_folder.original(main)?.replacen(
            "fn main() {\n",
            "fn main() {\n    solutions::choose();\n",
            1,
        );
        texts.push((main.to_owned(), text));
        match build_folder.build_with(texts)? {
            Built::Program(worker) => {
                fs::hard_link(worker, self.path(0))?;
                Ok(())
            }
            Built::DoesNotCompile(error) => bail!(
                "the entries do not compile as one program (the names of functions end with the names of their entries):\n{error}"
            ),
        }
    }

    /// Builds the entries that need a program of their own.
    fn build_alone(&self, root: &Path, alone: &[(&Entry, String)]) -> Result<()> {
        if alone.is_empty() {
            return Ok(());
        }
        let build_folder = BuildFolder::open(root, "alone", Product::Worker(Need::Checks))?;
        for (entry, text) in alone {
            match build_folder.build_with(&[(&entry.file, text)])? {
                Built::Program(worker) => {
                    fs::copy(worker, self.path(schemata::number(entry)))?;
                }
                Built::DoesNotCompile(error) => bail!("{} does not compile:\n{error}", entry.with_file()),
            }
        }
        Ok(())
    }

    fn path(&self, number: u32) -> PathBuf {
        self.folder.path().join(format!("entry-{number}{}", std::env::consts::EXE_SUFFIX))
    }

    /// The kit of the reference.
    pub fn reference(&self) -> Kits {
        Kits { which: Which::Solutions, program: self.path(0) }
    }

    /// The kit of an entry.
    pub fn kit(&self, entry: &Entry) -> Kits {
        Kits { which: Which::Solutions, program: self.path(schemata::number(entry)) }
    }

    /// How an entry is built.
    pub fn form(&self, entry: &Entry) -> Form {
        self.built.get(&entry.to_string()).map_or(Form::Alone, |(form, _)| *form)
    }

    /// Returns the functions with a switch that each check reaches when it tries the reference. No other function can change the
    /// verdict of the check.
    pub fn reached(&self, checks: &[&'static Check], jobs: usize) -> Result<Reached> {
        let reached = queue::run(&vec![(); jobs], checks, |(), &check| {
            let program =
                self.folder.path().join(format!("record-{}{}", check.name, std::env::consts::EXE_SUFFIX));
            fs::hard_link(self.path(0), &program)?;
            checks::passes(check, &Kits { which: Which::Solutions, program: program.clone() }.fresh(), 0);
            let functions = fs::read_to_string(program.with_extension("reached")).unwrap_or_default();
            Ok((check.name, functions.lines().map(str::to_owned).collect()))
        })?;
        Ok(Reached(reached.into_iter().collect()))
    }

    /// Returns whether a check reaches a function that an entry changes.
    pub fn is_reached(&self, entry: &Entry, check: &Check, reached: &Reached) -> bool {
        match self.built.get(&entry.to_string()) {
            Some((Form::Functions | Form::Module, changed)) => {
                reached.0.get(check.name).is_none_or(|reached| !reached.is_disjoint(changed))
            }
            _ => true,
        }
    }
}

/// The functions with a switch that each check reaches, by the name of the check.
pub struct Reached(BTreeMap<&'static str, BTreeSet<String>>);

/// The stage files of the solutions, from the root of the kit.
pub fn stage_files(root: &Path) -> Result<Vec<String>> {
    let is_stage = |path: &str| path.starts_with("solutions/src/stage") && path.ends_with(".rs");
    files_below(root, "solutions/src", &is_stage)
}
