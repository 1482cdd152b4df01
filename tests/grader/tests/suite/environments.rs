//! A hand-out is used as cargo is set up on a student's machine: with another target, another target folder, denied warnings, from
//! another folder, by nextest, and as a copied program. Each builds the kit again, so it runs only with `CI_LONG=1`.

use super::grader_succeeds;
use super::program_runs::{leaves_out_what_takes_long, printed, root};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// The triple of the machine, which the compiler prints.
fn host() -> String {
    let output = Command::new("rustc").arg("-vV").output().expect("rustc starts");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    printed.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host").to_owned()
}

/// Renders and checks as a student does. The only message is that functions are not written yet.
fn works(what: &str, kit: &Path, run: &dyn Fn(&[&str]) -> Output) {
    let rendered = run(&["render", "scenes/stage1.toml", "--size", "16x12"]);
    assert!(rendered.status.success(), "{what}: {}", printed(&rendered).1);
    assert!(kit.join("out/stage1.png").is_file(), "{what}: no picture");
    fs::remove_file(kit.join("out/stage1.png")).expect("a picture");
    let checked = printed(&run(&["check", "1"])).0;
    assert!(checked.contains("0 passed") && checked.contains("not written yet"), "{what}: {checked}");
}

#[test]
fn programs_are_found_wherever_cargo_puts_them() {
    if leaves_out_what_takes_long() {
        return;
    }
    let around = root().join("target/environments");
    if around.join("kit").exists() {
        fs::remove_dir_all(around.join("kit")).expect("the hand-out of the last run can be removed");
    }
    fs::create_dir_all(around.join(".cargo")).expect("a folder");
    let config = around.join(".cargo/config.toml");
    fs::write(&config, "").expect("written");
    let kit = around.join("kit");
    grader_succeeds(["handout", &kit.to_string_lossy()]);
    let cargo = |environment: &[(&str, &str)], from: &Path, words: &[&str]| -> Output {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.current_dir(from).env_remove("CARGO_TARGET_DIR").env_remove("RUSTFLAGS");
        cargo.envs(environment.iter().copied()).env("CARGO_NET_OFFLINE", "true");
        cargo.args(words).output().expect("cargo starts")
    };
    let run = |environment: &[(&str, &str)], words: &[&str]| {
        cargo(environment, &kit, &[&["run", "--"], words].concat())
    };

    // Another target, by the environment variable and by a setting of a folder above.
    let target_folder = around.join("target").display().to_string();
    let host = host();
    let environment = [("CARGO_TARGET_DIR", target_folder.as_str()), ("CARGO_BUILD_TARGET", host.as_str())];
    works("CARGO_BUILD_TARGET and CARGO_TARGET_DIR", &kit, &|words| run(&environment, words));
    fs::write(&config, format!("[build]\ntarget = \"{host}\"\n")).expect("written");
    works("build.target", &kit, &|words| run(&environment[..1], words));
    fs::write(&config, "").expect("written");

    // Denied warnings, from another folder, with the manifest by its path.
    let environment = [("CARGO_TARGET_DIR", target_folder.as_str()), ("RUSTFLAGS", "-D warnings")];
    let manifest = kit.join("Cargo.toml").display().to_string();
    works("RUSTFLAGS", &kit, &|words| run(&environment, words));
    let elsewhere = tempfile::tempdir().expect("a folder");
    let test = |update: &str, words: &[&str]| {
        let environment = [&environment[..], &[("INSTA_UPDATE", update)]].concat();
        cargo(&environment, elsewhere.path(), words)
    };
    let golden = fs::read_dir(kit.join("tests/golden")).expect("golden files").count();
    for update in ["always", "new", "auto"] {
        let words = ["test", "--manifest-path", &manifest, "--test", "stage1"];
        let (said, complained) = printed(&test(update, &words));
        assert!(format!("{said}{complained}").contains("not written yet"), "{said}\n{complained}");
    }
    let now = fs::read_dir(kit.join("tests/golden")).expect("golden files").count();
    assert_eq!(now, golden, "a student's run has written a golden file");
    let nextest = test("auto", &["nextest", "run", "--manifest-path", &manifest, "--test", "stage1"]);
    let (said, complained) = printed(&nextest);
    match complained.contains("no such command") {
        true => println!("SKIPPED: nextest is not installed here"),
        false => assert!(format!("{said}{complained}").contains("not written yet"), "{said}\n{complained}"),
    }

    // A program that was copied out of the target folder.
    let name = format!("raykata{}", std::env::consts::EXE_SUFFIX);
    let copy = elsewhere.path().join(&name);
    fs::copy(Path::new(&target_folder).join("debug").join(&name), &copy).expect("a copy");
    works("a copied program", &kit, &|words| {
        let mut copied = Command::new(&copy);
        copied.current_dir(&kit).envs(environment).args(words).output().expect("the copy starts")
    });
}
