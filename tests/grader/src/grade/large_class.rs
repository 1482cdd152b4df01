//! A simulation: invented grades of a class of any size, merged from parts and reported as `grader merge` does.
//!
//! `RAYKATA_STUDENTS=100000 cargo test --release -p grader --lib large_class -- --nocapture` prints time, memory and sizes.

use super::merge;
use super::result::{CheckResult, Graded, Outcome, Picture, Session};
use super::shard::{Part, Shard};
use super::store::Store;
use all_checks::STAGES;
use base64::Engine;
use checks::rubric;
use oracle::splitmix::Random;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The number of submissions of a part.
const CHUNK: usize = 200;

/// A submission of stages 1 to `last_stage`, with messages and pictures as long as those of real ones.
fn student(number: usize, last_stage: u8, png: &str, random: &mut Random) -> Graded {
    let ability = random.unit();
    let mut check = |stage: u8, name: &str| {
        let entry = rubric::entry(stage, name);
        let outcome = match random.unit() {
            x if x < 0.3 + 0.7 * ability => Outcome::Passed,
            x if x < 0.9 => Outcome::NotWritten,
            x if x < 0.998 => Outcome::Wrong,
            _ => Outcome::Crashed,
        };
        let wrong = outcome == Outcome::Wrong;
        let message = if wrong {
            format!("{}{}", entry.header(), "  input     Ray::new(…)\n".repeat(12))
        } else {
            String::new()
        };
        let picture = (wrong && name.contains("picture"))
            .then(|| Picture { caption: "reference | yours | difference".into(), png: png.to_owned() });
        CheckResult { picture, ..CheckResult::new(stage, name, outcome, message) }
    };
    let checks = STAGES.iter().filter(|(stage, _)| *stage <= last_stage);
    let checks = checks.flat_map(|(stage, checks)| checks.iter().map(|one| (*stage, one.name)));
    let checks = checks.map(|(stage, name)| check(stage, name)).collect();
    let trouble =
        if number % 1000 == 999 { "cannot be unpacked: no zip archive".to_owned() } else { String::new() };
    Graded {
        student: format!("student-{number:07}"),
        content: format!("{number:064x}"),
        checks,
        remarks: Vec::new(),
        compiler: String::new(),
        trouble,
        cpu_ms: 400 + (number * 7919 % 1000) as u64,
        handed_in: String::new(),
    }
}

/// Writes the folders of all parts.
fn parts(folder: &Path, n_students: usize, last_stage: u8) -> Vec<PathBuf> {
    let mut random = Random::new(4, 0);
    let png =
        fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../golden/stage1_sphere_on_a_plane.png")).unwrap();
    let png = base64::engine::general_purpose::STANDARD.encode(png);
    let session = Session {
        kit: "1".into(),
        stages: (1..=last_stage).collect(),
        seed: 7,
        isolation: "none".into(),
        ..Session::default()
    };
    let of = n_students.div_ceil(CHUNK);
    let part = |index: usize| {
        let path = folder.join(index.to_string());
        fs::create_dir_all(&path).unwrap();
        let store = Store::open(&path).unwrap();
        store.begin(&session).unwrap();
        let shard = Shard { index: index as u64, of: of as u64 };
        store
            .begin_part(Some(&Part { shard, submissions: n_students, class: "c".into(), finished: false }))
            .unwrap();
        let numbers = (index - 1) * CHUNK..(index * CHUNK).min(n_students);
        let students: Vec<Graded> =
            numbers.map(|number| student(number, last_stage, &png, &mut random)).collect();
        store.keep_all(&students).unwrap();
        store.finish_part().unwrap();
        path
    };
    (1..=of).map(part).collect()
}

/// The largest amount of memory that this process has used so far, in megabytes.
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<u64>().ok()).map_or(0, |kb| kb / 1024)
}

fn size(file: &Path) -> u64 {
    fs::metadata(file).map_or(0, |metadata| metadata.len())
}

/// The number of files in a folder and its folders, their bytes together, and the bytes of the largest one.
fn sizes(folder: &Path) -> (usize, u64, u64) {
    let mut all = (0, 0, 0);
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let (n, bytes, largest) = match path.is_dir() {
            true => sizes(&path),
            false => (1, size(&path), size(&path)),
        };
        all = (all.0 + n, all.1 + bytes, all.2.max(largest));
    }
    all
}

#[test]
fn a_large_class_has_small_pages_and_needs_little_memory() {
    // Without the variable, one stage and a class that just needs pages are enough.
    let wanted = std::env::var("RAYKATA_STUDENTS").ok().and_then(|text| text.parse().ok());
    let (n_students, last_stage) = wanted.map_or((1100, 1), |n| (n, 4));
    let folder = tempfile::tempdir().unwrap();
    let begun = Instant::now();
    let parts = parts(&folder.path().join("parts"), n_students, last_stage);
    println!(
        "{} parts of {n_students} students written in {:.0} s",
        parts.len(),
        begun.elapsed().as_secs_f64()
    );

    let out = folder.path().join("class");
    let before = peak_memory();
    let begun = Instant::now();
    let all_graded = merge::run(&merge::Options { parts, out: out.clone() }).unwrap();
    assert_eq!(all_graded, n_students < 1000);
    println!(
        "merged and reported in {:.0} s; memory at most {} MB ({before} MB before)",
        begun.elapsed().as_secs_f64(),
        peak_memory()
    );

    for name in ["grades.sqlite", "results.json", "junit.xml", "checks.csv", "grades.csv", "index.html"] {
        println!("  {name:<14} {:>9.2} MB", size(&out.join(name)) as f64 / 1e6);
    }
    for name in ["lists", "students", "gradescope", "classroom"] {
        let (n, bytes, largest) = sizes(&out.join(name));
        println!(
            "  {name:<14} {:>9.2} MB in {n} files, the largest has {:.0} kB",
            bytes as f64 / 1e6,
            largest as f64 / 1e3
        );
    }
    // The list of the students is divided, and every student is in it once, with a link that works.
    let lists = sizes(&out.join("lists"));
    assert_eq!(lists.0, n_students.div_ceil(1000));
    assert!(lists.2 < 1_000_000 && size(&out.join("index.html")) < 1_000_000);
    let index = fs::read_to_string(out.join("index.html")).unwrap();
    assert!((1..=lists.0).all(|number| index.contains(&format!("href=\"lists/{number}.html\""))));
    let last = fs::read_to_string(out.join(format!("lists/{}.html", lists.0))).unwrap();
    let page = format!("students/student-{:07}.html", n_students - 1);
    assert!(last.contains(&format!("href=\"../{page}\"")) && out.join(page).is_file());
    // One submission is in memory at a time, and a line of each.
    assert!(peak_memory() < before + 200, "{} MB", peak_memory());
}
