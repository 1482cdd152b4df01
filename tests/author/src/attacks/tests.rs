use super::*;
use all_checks::STAGES;
use grader::grade::result::{CheckResult, Graded, Outcome, Remark};
use grader::queue;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Mutex;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn attack(text: &str) -> Attack {
    let head = "name = \"ann\"\ntitle = \"a\"\nwhat = \"b\"\n";
    let mut attack: Attack = toml::from_str(&format!("{head}{text}\n[expect]\nearned = \"none\"\n")).unwrap();
    attack.fragments = Arc::new(BTreeMap::from([("shared".to_owned(), "// of several".to_owned())]));
    attack
}

/// A graded submission with these outcomes in stage 1.
fn graded(outcome: impl Fn(&str) -> Outcome) -> Graded {
    let stage = STAGES.iter().find(|(stage, _)| *stage == 1).unwrap();
    let result = |check: &checks::Check| {
        let outcome = outcome(check.name);
        let message = match outcome {
            Outcome::Passed => String::new(),
            other => format!("it is {}", other.words()),
        };
        CheckResult::new(1, check.name, outcome, message)
    };
    Graded {
        student: "ann".into(),
        checks: stage.1.iter().map(result).collect(),
        remarks: vec![Remark { file: "build.rs".into(), what: "was ignored".into() }],
        ..Graded::default()
    }
}

fn message(expected: &str, graded: &Graded) -> Vec<String> {
    complaints(&attack(""), &toml::from_str(expected).unwrap(), graded)
}

#[test]
fn every_attack_can_be_read_and_made() {
    let attacks = load(&root()).unwrap();
    assert!(attacks.len() >= 200, "{}", attacks.len());
    // Most files are those of the exercises: parse each text once.
    let parsed = Mutex::new(BTreeSet::new());
    let made = queue::run(&queue::one_a_core(), &attacks, |(), attack| {
        let folder = tempfile::tempdir()?;
        let path = make(attack, &AttackFolders { root: &root(), folder: folder.path() })?;
        ensure!(fs::symlink_metadata(&path).is_ok(), "{}: there is no submission", attack.name);
        ensure!(!attack.title.is_empty() && attack.what.ends_with('.'), "{}: words are missing", attack.name);
        // Files that are meant to compile must be valid Rust. Files that attack the compiler would also break this test.
        let rust = !matches!(attack.family, Family::Compiling | Family::Packing);
        for entry in fs::read_dir(path.join("exercises/src")).into_iter().flatten().filter(|_| rust) {
            let file = entry?.path();
            if file.is_dir() {
                continue;
            }
            let text = fs::read_to_string(&file)?;
            if parsed.lock().unwrap().insert(text.clone()) {
                let parsed = syn::parse_file(&text);
                ensure!(parsed.is_ok(), "{}: {}: {:?}", attack.name, file.display(), parsed.err());
            }
        }
        Ok(())
    });
    made.unwrap();
}

#[test]
fn what_is_expected_names_checks_that_there_are() {
    for attack in load(&root()).unwrap() {
        let stages = STAGES.iter().filter(|(stage, _)| attack.stages.contains(stage));
        let names: Vec<&str> = stages.flat_map(|(_, checks)| *checks).map(|check| check.name).collect();
        for expected in [Some(&attack.expect), attack.without_lint.as_ref()].into_iter().flatten() {
            let (Earned::AllBut(patterns) | Earned::AtLeastAllBut(patterns) | Earned::AtMost(patterns)) =
                &expected.earned
            else {
                continue;
            };
            for pattern in patterns {
                let known = names.iter().any(|name| super::verdict::is_like(name, pattern));
                assert!(known, "{}: no check is called {pattern}", attack.name);
            }
        }
        assert!(attack.expect.allow.is_empty(), "{}: `allow` is for [without_lint]", attack.name);
        assert!(attack.without_lint.is_none_or(|expected| !expected.allow.is_empty()), "{}", attack.name);
    }
}

#[test]
fn attacks_of_every_family_are_there() {
    let families: BTreeSet<Family> = load(&root()).unwrap().iter().map(|attack| attack.family).collect();
    assert_eq!(families.len(), 13, "{families:?}");
}

#[test]
fn five_parts_hold_every_attack_once() {
    let all = load(&root()).unwrap();
    let parts: Vec<Vec<Attack>> = (1..=5).map(|index| part(all.clone(), Shard { index, of: 5 })).collect();
    let sum = |part: &Vec<Attack>| part.iter().map(|attack| attack.most_seconds).sum::<u64>();
    let (sums, mean) = (parts.iter().map(sum).collect::<Vec<_>>(), sum(&all) / 5);
    assert!(sums.iter().all(|sum| sum.abs_diff(mean) < mean / 10), "{sums:?}");
    let mut names: Vec<String> = parts.into_iter().flatten().map(|attack| attack.name).collect();
    names.sort();
    assert_eq!(names, all.into_iter().map(|attack| attack.name).collect::<Vec<_>>());
}

#[test]
fn points_that_are_not_earned_are_complained_about_and_points_that_are_not_given() {
    let fine = graded(|_| Outcome::Passed);
    assert_eq!(message("earned = \"all\"", &fine), [""; 0]);
    assert_eq!(message("earned = \"none\"", &fine).len(), 27);
    let normal =
        graded(|name| if name.starts_with("sphere_normal") { Outcome::TooLong } else { Outcome::Passed });
    assert_eq!(message("earned = { all_but = [\"sphere_normal_*\"] }", &normal), [""; 0]);
    assert_eq!(
        message("earned = { at_least_all_but = [\"sphere_normal_*\", \"plane_*\"] }", &normal),
        [""; 0]
    );
    let both = message("earned = { all_but = [\"sphere_normal_*\", \"face_*\"] }", &normal);
    assert!(both.len() == 1 && both[0].contains("face_forward_turns") && both[0].contains("not earned"));
    let none = message("earned = { at_least_all_but = [\"plane_*\"] }", &normal);
    assert!(none.len() == 1 && none[0].contains("should pass and is: too long"), "{none:?}");
    assert_eq!(message("earned = { at_most = [\"plane_*\"] }", &normal).len(), 19);
    let outcome = message("earned = { all_but = [\"sphere_normal_*\"] }\noutcomes = [\"crashed\"]", &normal);
    assert!(outcome[0].ends_with("is: too long, not: crashed"), "{outcome:?}");
}

#[test]
fn words_are_looked_for_in_every_message() {
    let wrong = graded(|_| Outcome::Wrong);
    assert_eq!(message("earned = \"none\"\nsays = [\"it is wrong\", \"was   ignored\"]", &wrong), [""; 0]);
    let missing =
        message("earned = \"none\"\nsays = [\"sorry\"]\nnever_says = [\"build.rs\"]\ntrouble = true", &wrong);
    assert!(missing.iter().any(|one| one == "no message says `sorry`"), "{missing:?}");
    assert!(missing.iter().any(|one| one == "a message says `build.rs`"), "{missing:?}");
    assert!(missing.iter().any(|one| one.contains("there is no reason")), "{missing:?}");
}

#[test]
fn reports_that_leak_obey_or_are_endless_are_complained_about() {
    let with = |change: fn(&mut Graded)| {
        let mut graded = graded(|_| Outcome::Wrong);
        change(&mut graded);
        message("earned = \"none\"", &graded)
    };
    assert_eq!(with(|_| ()), [""; 0]);
    type Spoil = fn(&mut Graded);
    let cases: [(Spoil, &str); 7] = [
        (|graded| graded.checks[3].message = format!("found {CANARY}"), "a message says"),
        (|graded| graded.remarks[0].file = "\u{1b}[2J".into(), "control characters"),
        (|graded| graded.compiler = "\u{202e}".into(), "control characters"),
        (|graded| graded.compiler = "x".repeat(2 << 20), "the report has"),
        (|graded| graded.checks[3].message.clear(), "without a message"),
        (|graded| graded.checks[3].earned = 1, "earned 1 of"),
        (|graded| drop(graded.checks.pop()), "checks were graded"),
    ];
    for (change, says) in cases {
        let text = with(change);
        assert!(text.iter().any(|one| one.contains(says)), "{says}: {text:?}");
    }
}

#[test]
fn a_run_names_what_went_wrong_and_what_was_changed() {
    let names = ["const_loop".to_owned(), "honest_solution".to_owned()];
    let run = |grade: &(dyn Fn(&Path, &[String]) -> Result<Graded> + Sync)| {
        let chosen = choose(load(&root()).unwrap(), &names).unwrap();
        run_all(&root(), chosen, |path, _, allowed| grade(path, allowed), |_| ()).unwrap()
    };
    let fine = run(&|path, _| {
        let honest = path.ends_with("honest_solution");
        Ok(graded(|_| if honest { Outcome::Passed } else { Outcome::Wrong }))
    });
    assert_eq!(fine[1].complaints, [""; 0]);
    let text = &fine[0].complaints;
    assert!(text.iter().any(|one| one.starts_with("without the syntax check: ")), "{text:?}");
    let broken = run(&|_, allowed| bail!("out of paper with {} rule", allowed.len()));
    let text = &broken[0].complaints;
    assert!(text.iter().any(|one| one.contains("failed: out of paper with 1 rule")), "{text:?}");
    let harmful = run(&|path, _| {
        fs::write(path.join("../../beside/secret.txt"), "gone")?;
        Ok(graded(|_| Outcome::Passed))
    });
    let text = &harmful[1].complaints;
    assert!(text.iter().any(|one| one.starts_with("the attack changed ") && one.ends_with("secret.txt")));
    assert!(choose(load(&root()).unwrap(), &["nobody".into()]).is_err());
}
