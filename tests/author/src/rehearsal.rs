//! `author rehearse`: generates a class of submissions with known grades (right solutions and mistakes of the corpus,
//! attacks, untouched files), grades it, and compares every grade with the known one.

use crate::attacks::{self, Attack, AttackFolders};
use crate::corpus::entry::{self, Claim, Entry, Original};
use crate::corpus::records::Matrix;
use anyhow::{Context, Result, bail, ensure};
use grader::exercises::{answer, stage_of};
use grader::grade::result::{CheckResult, Class, Graded, Outcome};
use grader::grade::{self, Store};
use grader::kits::root;
use raykata_cli::args::{Given, Opt, Read, Spec};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::time::Instant;

/// `author rehearse`.
pub static SPEC: Spec = Spec {
    name: "author rehearse",
    about: "Grade a generated class with known grades, and compare.",
    arguments: &[],
    options: &[&[
        Opt::value("--students", "N", "The number of students [default: 200]."),
        Opt::value("--out", "FOLDER", "The folder for the grades [default: a temporary one]."),
        Opt::value("--jobs", "N", "How many submissions to grade at the same time [default: one per core]."),
        Opt::flag("--honest", "Leave out the attacks."),
    ]],
};

/// The stages of the class: the first part of the course.
const STAGES_OF_CLASS: [u8; 4] = [1, 2, 3, 4];

/// Attacks with a longer time limit than this, in seconds, are left to `author attacks`.
const MOST_SECONDS: u64 = 60;

/// The kind of a student's submission.
#[derive(Clone)]
enum Role {
    /// One file is that of this corpus entry, all others are right.
    Entry(Entry),
    /// The first stages up to this one are right, the later ones are untouched.
    Begun(u8),
    /// An attack.
    Attack(Box<Attack>),
}

/// Grades the class. Returns `Ok(true)` if every grade is right.
pub fn run(given: &Given) -> Result<bool> {
    let n_students = given.number("--students", 0..=usize::MAX)?.unwrap_or(200);
    let jobs = given.number("--jobs", 1..=u16::MAX)?;
    let root = &root()?;
    let place = tempfile::tempdir()?;
    let class = place.path().join("class");
    fs::create_dir(&class)?;
    // Generate the submissions.
    let roles = roles(root, n_students, given.has("--honest"))?;
    let mut students: BTreeMap<String, Role> = BTreeMap::new();
    for (number, role) in roles.into_iter().enumerate() {
        let student = hand_in(root, &class, number, &role)?;
        students.insert(student, role);
    }
    // Grade the class and measure the time.
    let temporary = tempfile::tempdir()?;
    let out = given.path("--out").unwrap_or_else(|| temporary.path().to_owned());
    let started = Instant::now();
    grade::run(&grade_options(&class, &out, jobs)?)?;
    let seconds = started.elapsed().as_secs_f64();
    // Compare the grades with the known ones.
    let graded = Store::open(&out)?.class()?;
    let complaints = compare(root, &students, &graded);
    complaints.iter().for_each(|complaint| println!("{complaint}"));
    let n = students.len();
    println!("{n} submissions in {seconds:.0} s, {:.2} s each", seconds / n as f64);
    println!("{} of {n} grades are wrong", complaints.len());
    Ok(complaints.is_empty())
}

/// The options of `grader grade` for this class.
fn grade_options(class: &Path, out: &Path, jobs: Option<u16>) -> Result<Given> {
    let mut words: Vec<OsString> = vec![class.into(), "--out".into(), out.into()];
    words.extend(["--stages".into(), STAGES_OF_CLASS.map(|stage| stage.to_string()).join(",").into()]);
    words.extend(jobs.iter().flat_map(|jobs| ["--jobs".into(), jobs.to_string().into()]));
    match grade::SPEC.read(words)? {
        Read::Given(given) => Ok(given),
        Read::Help(help) => bail!("{help}"),
    }
}

/// Returns the kind of each submission. The kinds alternate, so that a class of any size contains all of them.
fn roles(root: &Path, n_students: usize, all_honest: bool) -> Result<Vec<Role>> {
    // The class has not written later stages, so leave out solutions that call them.
    let is_later = |line: &str| (5..=12).any(|stage| line.contains(&format!("stage{stage}_")));
    let calls_later =
        |entry: &Entry| entry.changes.iter().flat_map(|change| &change.lines).any(|(_, line)| is_later(line));
    let of_class = |entry: &Entry| STAGES_OF_CLASS.contains(&entry.stage) && !calls_later(entry);
    let (right, wrong): (Vec<Entry>, Vec<Entry>) =
        entry::read_all(root)?.into_iter().filter(of_class).partition(|entry| entry.claim == Claim::Right);
    let tame = |attack: &Attack| {
        attack.most_seconds <= MOST_SECONDS
            && attack.stages.iter().all(|stage| STAGES_OF_CLASS.contains(stage))
    };
    let attacks: Vec<Attack> = attacks::load(root)?.into_iter().filter(tame).collect();
    let mut lists: Vec<Vec<Role>> = vec![
        right.into_iter().map(Role::Entry).collect(),
        wrong.into_iter().map(Role::Entry).collect(),
        (0..=4).map(Role::Begun).collect(),
    ];
    if !all_honest {
        lists.push(attacks.into_iter().map(|attack| Role::Attack(Box::new(attack))).collect());
    }
    let kinds = lists.len();
    let of_kind = n_students.div_ceil(kinds);
    let role = |student: usize| {
        let (list, turn) = (&lists[student % kinds], student / kinds);
        ensure!(!list.is_empty(), "the corpus is empty");
        // Spread the class evenly over a longer list; repeat a shorter one.
        let index = if list.len() > of_kind { turn * list.len() / of_kind } else { turn % list.len() };
        Ok(list[index].clone())
    };
    (0..n_students).map(role).collect()
}

/// Writes a submission into the folder of the class and returns its name.
fn hand_in(root: &Path, class: &Path, number: usize, role: &Role) -> Result<String> {
    let student = format!("student-{number:04}");
    if let Role::Attack(attack) = role {
        // The files that an attack must not reach lie beside the class.
        let folder = class.with_extension(format!("attack-{number}"));
        fs::create_dir_all(&folder).with_context(|| format!("cannot write {}", folder.display()))?;
        let made = attacks::make(attack, &AttackFolders { root, folder: &folder })?;
        let name = made.file_name().context("a submission without a name")?;
        let ending =
            made.extension().filter(|_| made.is_file()).map(|ending| ending.to_string_lossy().into_owned());
        let to = match ending {
            Some(ending) if name.to_string_lossy().ends_with(".tar.gz") => format!("{student}.tar.{ending}"),
            Some(ending) => format!("{student}.{ending}"),
            None => student.clone(),
        };
        fs::rename(&made, class.join(to))?;
    } else {
        let folder = class.join(&student).join("exercises/src");
        for (name, text) in texts(root, role)? {
            let file = folder.join(name);
            fs::create_dir_all(&folder)
                .and_then(|()| fs::write(&file, text))
                .with_context(|| format!("cannot write {}", file.display()))?;
        }
    }
    Ok(student)
}

/// Returns the files of an honest submission.
fn texts(root: &Path, role: &Role) -> Result<BTreeMap<String, String>> {
    let mut texts = grader::exercises::pristine(root)?;
    texts.retain(|name, _| stage_of(name).is_some());
    let last = if let Role::Begun(last) = role { *last } else { 4 };
    for (name, text) in &mut texts {
        if stage_of(name).is_some_and(|stage| stage <= last) {
            let file = format!("solutions/src/{name}");
            let solution = Original::read(root, &file)?;
            let changed = match role {
                Role::Entry(entry) if entry.file == file => entry.apply(&solution)?,
                _ => solution.text,
            };
            *text = answer(&changed, Path::new(&file))?;
        }
    }
    Ok(texts)
}

/// Describes the wrong grades, in one sentence per student.
fn compare(root: &Path, students: &BTreeMap<String, Role>, class: &Class) -> Vec<String> {
    let matrix = Matrix::read(root);
    let mut complaints = Vec::new();
    for (student, role) in students {
        let found = match class.students.iter().find(|graded| graded.student == *student) {
            None => vec!["is not graded".into()],
            Some(graded) => faults(role, &matrix, graded),
        };
        complaints.extend(found.first().map(|what| format!("{student}, {}: {what}", named(role))));
    }
    complaints
}

fn named(role: &Role) -> String {
    match role {
        Role::Entry(entry) => entry.to_string(),
        Role::Begun(stages) => format!("{stages} stages done"),
        Role::Attack(attack) => format!("attack {}", attack.name),
    }
}

fn faults(role: &Role, matrix: &Matrix, graded: &Graded) -> Vec<String> {
    let failed = |stage: u8, name: &str| {
        graded.of_stage(stage).any(|check| check.name == name && check.outcome != Outcome::Passed)
    };
    let ended = |check: &CheckResult| format!("{} is {}", check.name, check.outcome.words());
    match role {
        Role::Attack(attack) => {
            let mut of_attack = graded.clone();
            of_attack.checks.retain(|check| attack.is_judged(check.stage, &check.name));
            attacks::complaints(attack, &attack.expect, &of_attack)
        }
        Role::Begun(stages) => {
            let right = |check: &&CheckResult| (check.outcome == Outcome::Passed) == (check.stage <= *stages);
            let wrong = graded.checks.iter().find(|check| !right(check));
            wrong.map(ended).into_iter().collect()
        }
        Role::Entry(entry) => {
            let row = matrix.0.get(&entry.to_string()).map_or("", String::as_str);
            let expected: Vec<&str> =
                row.split(' ').map(|name| name.trim_start_matches('=')).filter(|name| *name != "-").collect();
            let missed = expected.iter().find(|name| !failed(entry.stage, name));
            // Hidden inputs may fail more checks of the same stage than the public ones, but no checks of another stage.
            let unfair = graded.checks.iter().find(|check| {
                let elsewhere = check.stage != entry.stage || entry.claim == Claim::Right;
                check.outcome != Outcome::Passed && elsewhere
            });
            let missed = missed.map(|name| format!("{name} passes"));
            missed.into_iter().chain(unfair.map(ended)).collect()
        }
    }
}
