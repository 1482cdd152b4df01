//! Writes the reports of an invented class as a preview: `cargo run -p grader --example report_preview FOLDER`.

use anyhow::{Context, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use checks::rubric;
use grader::grade::report;
use grader::grade::result::{CheckResult, Class, Graded, Outcome, Picture, Remark, Session};
use oracle::splitmix::Random;
use std::path::PathBuf;

const N_STUDENTS: usize = 60;

fn main() -> Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).context("name the folder to write into")?);
    let mut random = Random::new(4, 0);
    let students = (0..N_STUDENTS).map(|i| student(i, &mut random)).collect();
    let session = Session {
        kit: "0.1.0 · checks 3f9a2c71".to_owned(),
        stages: vec![1, 2, 3, 4],
        seed: 4,
        isolation: "own user, Landlock, seccomp, limits of memory, time and processes".to_owned(),
        ..Session::default()
    };
    report::write_all(&Class { session, students }, &folder)?;
    println!("{}", folder.join("index.html").display());
    Ok(())
}

/// Makes a student of random ability. A few students are special cases.
fn student(i: usize, random: &mut Random) -> Graded {
    let ability = (random.unit() * 1.3).min(1.0);
    let reached = 1 + (4.0 * (ability + 0.3 * random.unit()).min(0.99)) as u8;
    let mut graded = Graded {
        student: name(i),
        content: format!("{i:064x}"),
        checks: Vec::new(),
        remarks: Vec::new(),
        compiler: String::new(),
        trouble: String::new(),
        cpu_ms: 400 + (random.unit().powi(6) * 40_000.0) as u64,
        handed_in: String::new(),
    };
    if i == 17 {
        graded.trouble = "the archive cannot be read: invalid Zip archive: Could not find EOCD".to_owned();
        return graded;
    }
    if i % 9 == 4 {
        let what = "ignored: only the files of exercises/src count".to_owned();
        graded.remarks.push(Remark { file: "exercises/Cargo.toml".to_owned(), what });
    }
    let compiles = i % 13 != 5;
    if !compiles {
        graded.compiler = "error[E0308]: mismatched types\n  --> exercises/src/stage3_boxes.rs:41:9\n   |\n41 |         None\n   |         ^^^^ expected `usize`, found `Option<_>`\n".to_owned();
    }
    for (stage, checks) in all_checks::STAGES.iter().filter(|(stage, _)| *stage <= 4) {
        for check in *checks {
            let outcome = match *stage {
                3 if !compiles => Outcome::DoesNotCompile,
                2 if i % 29 == 7 => Outcome::Refused,
                4 if i == 50 => Outcome::NotTried,
                _ if *stage > reached => Outcome::NotWritten,
                _ => outcome(ability, check.name, random),
            };
            graded.checks.push(result(*stage, check.name, outcome));
        }
    }
    graded
}

fn outcome(ability: f32, check: &str, random: &mut Random) -> Outcome {
    // Some checks are harder than others: derive a difficulty between 0 and 1 from the name.
    let hard =
        f32::from(check.bytes().fold(7u8, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte))) / 255.0;
    if random.unit() < 0.35 + 0.65 * ability - 0.3 * hard * hard {
        return Outcome::Passed;
    }
    match (random.unit() * 200.0) as u32 {
        0..140 => Outcome::Wrong,
        140..195 => Outcome::WrongOnHidden,
        195..198 => Outcome::TooLong,
        _ => Outcome::Crashed,
    }
}

fn result(stage: u8, name: &str, outcome: Outcome) -> CheckResult {
    let entry = rubric::entry(stage, name);
    let message = match outcome {
        Outcome::Wrong => format!(
            "{}  input     sphere.hit(&Ray::new(vec3(0.25, -1.5, 4.0), vec3(0.0, 0.0, -1.0), 0.001..1000.0))\n  yours     Some(6.5)\n  expected  Some(1.5) (double precision)\n  looks like: the far root\n  again: cargo test --test stage{stage} {name}\n  stuck: cargo run -- hint {name}\n",
            entry.header()
        ),
        _ => String::new(),
    };
    let picture = (outcome == Outcome::Wrong && name.contains("picture")).then(picture).flatten();
    CheckResult { picture, ..CheckResult::new(stage, name, outcome, message) }
}

/// Uses a golden picture in place of a picture of differences.
fn picture() -> Option<Picture> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../golden/stage1_sphere_on_a_plane.png");
    let png = BASE64.encode(std::fs::read(file).ok()?);
    Some(Picture { caption: "reference | yours | difference".to_owned(), png })
}

fn name(i: usize) -> String {
    let names = [
        "Ada", "Blaise", "Chiara", "Dörte", "Emmy", "Fatma", "Grete", "Hypatia", "Ibn", "José", "Kōwa",
        "Łucja",
    ];
    match i {
        23 => "=cmd|' /C calc'!A0".to_owned(),
        31 => "<script>alert(1)</script>".to_owned(),
        44 => "a very long name of an archive that holds the submission of a group of several students"
            .to_owned(),
        _ => format!("{}.{:02}", names[i % names.len()], i),
    }
}
