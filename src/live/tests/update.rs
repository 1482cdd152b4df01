//! `update` in small kits: what it changes, keeps and refuses. Old and new kits have a few files each.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

const STUB: &str = "pub fn one() -> f32 {\n    todo!(\"one\")\n}\n";

/// Writes a kit of these files, with the list of its files.
fn kit(root: &Path, version: &str, files: &[(&str, &str)]) {
    let files: BTreeMap<&str, &str> = files.iter().copied().collect();
    let list: Vec<&str> = files.keys().copied().collect();
    let write = |path: &str, text: &str| {
        fs::create_dir_all(root.join(path).parent().unwrap()).unwrap();
        fs::write(root.join(path), text).unwrap();
    };
    write("tests/stubs.toml", &format!("[stage1_a]\none = '''\n{STUB}'''\n"));
    write("tests/kit.toml", &format!("version = {version:?}\nfiles = {list:?}\n"));
    for (path, text) in files {
        write(path, text);
    }
}

/// The output of `update`, and whether it succeeded.
fn update(root: &Path, folder: &Path) -> (String, bool) {
    let output = Command::new(env!("CARGO_BIN_EXE_update")).arg(root).arg(folder).output().unwrap();
    let text = [output.stdout, output.stderr].concat();
    (String::from_utf8(text).unwrap(), output.status.success())
}

fn read(root: &Path, path: &str) -> Option<String> {
    fs::read_to_string(root.join(path)).ok()
}

#[test]
fn files_of_the_kit_change_and_those_of_the_student_stay() {
    let folder = tempfile::tempdir().unwrap();
    let [old, new] = ["old", "new"].map(|name| folder.path().join(name));
    let written = STUB.replace("todo!(\"one\")", "1.0");
    kit(&old, "0.9.0", &[("src/a.rs", "a"), ("src/b.rs", "b"), ("exercises/src/stage1_a.rs", &written)]);
    fs::write(old.join("src/mine.toml"), "mine").unwrap();
    let added = "/// New.\npub fn two() -> f32 {\n    todo!(\"two\")\n}\n";
    kit(
        &new,
        "0.10.0",
        &[
            ("src/a.rs", "better"),
            ("src/c.rs", "c"),
            ("exercises/src/stage1_a.rs", &(STUB.to_owned() + "\n" + added)),
        ],
    );
    let two = added.split_once('\n').unwrap().1;
    fs::write(
        new.join("tests/stubs.toml"),
        format!("[stage1_a]\none = '''\n{STUB}'''\ntwo = '''\n{two}'''\n"),
    )
    .unwrap();

    let (said, success) = update(&old, &new);
    assert!(success, "{said}");
    assert!(
        said.starts_with("raykata 0.9.0 → 0.10.0\n  files of the kit: 1 changed, 1 new, 1 removed\n"),
        "{said}"
    );
    assert!(
        said.contains("exercises/src/stage1_a.rs: the function that you have written stays; new: `two`"),
        "{said}"
    );
    assert_eq!(read(&old, "src/a.rs").as_deref(), Some("better"));
    assert_eq!(read(&old, "src/b.rs"), None);
    assert_eq!(read(&old, "src/c.rs").as_deref(), Some("c"));
    assert_eq!(read(&old, "src/mine.toml").as_deref(), Some("mine"));
    assert_eq!(read(&old, "exercises/src/stage1_a.rs"), Some(written.clone() + "\n" + added));
    let kept = |path: &str| read(&old.join("out/before-update-1"), path);
    assert_eq!((kept("src/a.rs").as_deref(), kept("src/b.rs").as_deref()), (Some("a"), Some("b")));
    assert_eq!(kept("exercises/src/stage1_a.rs"), Some(written));
}

#[test]
fn what_is_no_newer_hand_out_is_refused_and_nothing_changes() {
    let folder = tempfile::tempdir().unwrap();
    let [old, new] = ["old", "new"].map(|name| folder.path().join(name));
    let exercise = ("exercises/src/stage1_a.rs", STUB);
    kit(&old, "1.0.0", &[("src/a.rs", "a"), exercise]);
    let refused = |words: &str| {
        let (said, success) = update(&old, &new);
        assert!(!success && said.starts_with("error: ") && said.contains(words), "{said}");
        assert_eq!(read(&old, "src/a.rs").as_deref(), Some("a"));
        assert!(!old.join("out").exists());
    };
    refused("is no hand-out of this kit");
    kit(&new, "0.9.0", &[("src/a.rs", "b"), exercise]);
    refused("is older than yours, 1.0.0");
    kit(&new, "1.0.1", &[("src/a.rs", "b"), (exercise.0, &STUB.replace("todo!(\"one\")", "1.0"))]);
    refused("functions of exercises/src/stage1_a.rs are written in it");
    kit(&new, "1.0.1", &[("src/a.rs", "b"), exercise]);
    fs::remove_file(new.join("src/a.rs")).unwrap();
    refused("it lacks src/a.rs");
    fs::write(new.join("tests/kit.toml"), "version = \"1.0.1\"\nfiles = [\"../a\"]\n").unwrap();
    refused("`../a` is no path below the kit");
    fs::write(new.join("tests/kit.toml"), "version = \"1.0\"\nfiles = []\n").unwrap();
    refused("`1.0` is no version such as 1.2.3");
    fs::create_dir(old.join("solutions")).unwrap();
    refused("is the complete kit");
}

/// In the complete kit no exercise is written, so `update` must find its files untouched. Students may have written theirs.
#[test]
fn the_kits_own_exercises_are_untouched() {
    let kit_root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if !kit_root.join("solutions").is_dir() {
        return println!("only in the complete kit");
    }
    let exercises = fs::read_dir(kit_root.join("exercises/src")).unwrap();
    let names = exercises.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let paths: Vec<String> = names.map(|name| format!("exercises/src/{name}")).collect();
    let texts: Vec<String> = paths.iter().map(|path| read(&kit_root, path).unwrap()).collect();
    let files: Vec<(&str, &str)> =
        paths.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
    let folder = tempfile::tempdir().unwrap();
    let [old, new] = ["old", "new"].map(|name| folder.path().join(name));
    for root in [&old, &new] {
        kit(root, "1.0.0", &files);
        fs::copy(kit_root.join("tests/stubs.toml"), root.join("tests/stubs.toml")).unwrap();
    }
    let (said, success) = update(&old, &new);
    assert!(success && said.contains("Everything is as in the new kit."), "{said}");
}
