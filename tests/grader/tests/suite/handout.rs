//! Tests the content of the student's repository.

use super::program_runs::{leaves_out_what_takes_long, printed, root};
use super::{grader, grader_succeeds};
use grader::files_below::files_below;
use grader::handout::{answers, leaks};
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;

/// A hand-out that all tests read and none changes: the folder `kit`, alone in a folder.
fn handed_out() -> &'static Path {
    static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| handed_out_in("handout"));
    &FOLDER
}

/// A kit that is handed out again, alone in this folder.
fn handed_out_in(around: &str) -> PathBuf {
    let around = Path::new(env!("CARGO_TARGET_TMPDIR")).join(around);
    // The first run has nothing to remove. What cannot be removed makes `handout` fail, because it does not overwrite.
    let _ = fs::remove_dir_all(&around);
    let folder = around.join("kit");
    grader_succeeds(["handout", &folder.to_string_lossy()]);
    folder
}

/// The paths of all files of a folder.
fn paths(folder: &Path, below: &str) -> BTreeSet<String> {
    files_below(folder, below, &|_| true).expect("a folder").into_iter().collect()
}

#[test]
fn nothing_is_handed_out_but_what_is_listed_and_no_answer_is_in_it() {
    let folder = handed_out();
    let around = folder.parent().expect("the folder around it");
    assert_eq!(fs::read_dir(around).expect("a folder").count(), 1, "no draft is left");

    let listed: Vec<String> = paths(folder, "").into_iter().collect();
    insta::with_settings!({ snapshot_path => "handout", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("files", listed.join("\n"));
    });

    assert_eq!(leaks(&root(), folder).expect("readable files"), Vec::<String>::new());
    // The search finds most answers, in every file that has any.
    let answers = answers(&root()).expect("readable solutions");
    assert!(answers.len() >= 17, "{:?}", answers.keys());
    for (file, lines) in answers.iter().filter(|(file, _)| file.starts_with("stage")) {
        assert!(lines.len() >= 15, "{file}: only {} lines identify its answers", lines.len());
        let text = fs::read_to_string(folder.join("exercises/src").join(file)).expect("its exercise");
        assert!(text.contains("todo!("), "{file}");
    }
}

#[test]
fn an_answer_and_the_canary_are_found_wherever_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let answers = answers(&root()).expect("readable solutions");
    let answer = answers["stage1_shapes.rs"].first().expect("an answer");
    fs::write(folder.path().join("a.bin"), format!("\u{0}x {answer}")).expect("written");
    fs::copy(root().join("solutions/src/lib.rs"), folder.path().join("b.rs")).expect("copied");
    let found = leaks(&root(), folder.path()).expect("readable files");
    assert!(found[0].starts_with("a.bin: ") && found[1] == "b.rs: the canary", "{found:?}");
    // The rest are lines of the copy.
    assert!(found[2..].iter().all(|line| line.starts_with("b.rs: `")), "{found:?}");
}

#[test]
fn manifests_name_nothing_that_is_missing() {
    let folder = handed_out();
    let manifest = |path: &str| -> toml::Table {
        let text = fs::read_to_string(folder.join(path)).unwrap_or_else(|_| panic!("there is no {path}"));
        toml::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
    };
    let workspace = manifest("Cargo.toml");
    let shared = workspace["workspace"]["dependencies"].as_table().expect("a table");
    for (name, dependency) in shared {
        if let Some(path) = dependency.get("path").and_then(|path| path.as_str()) {
            assert!(folder.join(path).join("Cargo.toml").is_file(), "{name}");
        }
    }
    for name in ["rusqlite", "syn", "landlock", "solutions", "zip", "seccompiler", "sha2"] {
        assert!(!shared.contains_key(name), "{name} is useless for students");
    }
    let members = workspace["workspace"]["members"].as_array().expect("members");
    let mut packages = paths(folder, "");
    packages.retain(|path| path.ends_with("/Cargo.toml"));
    let is_member = |package: &&String| {
        members.iter().filter_map(|member| member.as_str()).any(|member| {
            let (start, _) = member.split_once('*').unwrap_or((member, ""));
            package.starts_with(start)
        })
    };
    assert!(packages.len() >= 4 && packages.iter().all(|package| is_member(&package)), "{packages:?}");
    for member in packages.iter().map(|package| package.trim_end_matches("/Cargo.toml")).chain(["."]) {
        let package = manifest(&Path::new(member).join("Cargo.toml").to_string_lossy());
        for kind in ["bin", "test", "bench", "example"] {
            for target in package.get(kind).and_then(|targets| targets.as_array()).into_iter().flatten() {
                let name = target["name"].as_str().expect("a name");
                let path = target.get("path").and_then(|path| path.as_str()).map(str::to_owned);
                let path = path.unwrap_or_else(|| format!("{kind}s/{name}.rs"));
                assert!(folder.join(member).join(&path).is_file(), "{member}: {path}");
            }
        }
        for kind in ["dependencies", "dev-dependencies"] {
            for (name, _) in package.get(kind).and_then(|table| table.as_table()).into_iter().flatten() {
                assert!(shared.contains_key(name), "{member}: {name}");
            }
        }
    }
}

/// All texts that students read: documents, doc comments of exercises, hints, and comments of scenes.
fn texts() -> Vec<(String, String)> {
    let folder = handed_out();
    let is_text = |path: &&String| {
        let is_read =
            path.ends_with(".md") || path.ends_with(".toml") || path.starts_with("exercises/src/stage");
        // The manifests of cargo, and the files of the course, which lecturers write.
        is_read && !["Cargo.toml", "course.toml", "language.toml"].iter().any(|end| path.ends_with(end))
    };
    let text = |path: &String| (path.clone(), fs::read_to_string(folder.join(path)).expect("a text"));
    paths(folder, "").iter().filter(is_text).map(text).collect()
}

/// The commands of a student's program.
static COMMANDS: LazyLock<BTreeSet<String>> = LazyLock::new(|| {
    let files = paths(handed_out(), "src/cli/src");
    let text: String =
        files.iter().filter_map(|file| fs::read_to_string(handed_out().join(file)).ok()).collect();
    let names = text.split("name: \"raykata ").skip(1).filter_map(|rest| rest.split('"').next());
    // Figures are made by the reference.
    names.filter(|name| *name != "figures").map(str::to_owned).collect()
});

/// What a text names that is not in the hand-out: links, paths, commands, and parts of the kit that only authors have.
fn dead(path: &str, text: &str) -> Vec<String> {
    let (folder, mut dead) = (handed_out(), Vec::new());
    let mut demand = |kind, name: &str, is_there: bool| {
        if !is_there {
            dead.push(format!("{kind} {name}"));
        }
    };
    let is_there = |path: &str| {
        folder.join(path).exists() || ["*", "…", "stageN", "NAME"].iter().any(|any| path.contains(any))
    };
    if path.ends_with(".md") {
        let beside = folder.join(path).parent().expect("a folder").to_owned();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            demand("link", link, link.contains("://") || beside.join(link).exists());
        }
    }
    // Names of files in code, and commands, which end at the end of the line or of the code.
    for code in text.lines().flat_map(|line| line.split('`')) {
        let name = code.split([' ', ':']).next().unwrap_or_default();
        let tops = ["exercises/", "scenes/", "slides/", "src/", "tests/"];
        demand("path", name, is_there(name) || !tops.iter().any(|top| code.starts_with(top)));
        for command in code.split("cargo run ").skip(1).filter_map(|rest| rest.split("-- ").nth(1)) {
            let word = command.split([' ', '"']).next().unwrap_or_default();
            demand("command", word, COMMANDS.contains(word) || ["COMMAND", "…"].contains(&word));
            let is_scene = |word: &&str| word.starts_with("scenes/") && word.ends_with(".toml");
            command.split(' ').filter(is_scene).for_each(|scene| demand("scene", scene, is_there(scene)));
        }
        for word in ["-p author", "-p grader", "-p solutions", "solutions/", "cases.toml", "CONTRIBUTING"] {
            demand("word", word, !code.contains(word));
        }
    }
    dead
}

/// Each text of a hand-out names only what is there.
#[test]
fn texts_name_only_what_is_there() {
    let readme = fs::read_to_string(handed_out().join("README.md")).expect("a README");
    assert!(readme.starts_with("# Raykata\n"));
    for word in ["--kit", "solutions", "corpus", "{student}", "{greeting}", "--workspace"] {
        assert!(!readme.contains(word), "{word}");
    }
    let all: Vec<String> = texts()
        .iter()
        .flat_map(|(path, text)| dead(path, text).into_iter().map(move |what| format!("{path}: {what}")))
        .collect();
    assert!(all.is_empty(), "{all:#?}");
    // What is not there is found.
    let planted = "[a](b.md), `scenes/c.toml`, `cargo run -- renders scenes/plane.toml`, `cargo run -p author -- sync`\n";
    let found = dead("slides/x.md", planted);
    for what in
        ["link b.md", "path scenes/c.toml", "command renders", "scene scenes/plane.toml", "word -p author"]
    {
        assert!(found.iter().any(|one| one == what), "{what}: {found:?}");
    }
}

#[test]
fn what_is_there_is_not_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("mine"), "").expect("written");
    let output = grader(["handout", &folder.path().to_string_lossy()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(printed(&output).1.contains("is not empty"), "{}", printed(&output).1);
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    // An empty folder is allowed.
    fs::remove_file(folder.path().join("mine")).expect("removed");
    assert!(grader(["handout", &folder.path().to_string_lossy()]).status.success());
    assert!(folder.path().join("Cargo.toml").is_file());
}

/// Runs cargo in a kit.
fn cargo_in(kit: &Path, target: &Path, arguments: &[&str]) -> Output {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(kit).env("CARGO_TARGET_DIR", target).env("CARGO_NET_OFFLINE", "true");
    cargo.args(arguments).output().expect("cargo starts")
}

/// Builds the hand-out as a student does. This takes minutes, so it runs only with `CI_LONG=1`.
#[test]
fn a_student_can_begin() {
    if leaves_out_what_takes_long() {
        return;
    }
    // Not the one that other tests list, because `render` writes into it.
    let folder = &handed_out_in("begun");
    let target = root().join("target/handout");
    let cargo = |arguments: &[&str]| cargo_in(folder, &target, arguments);
    let lock = fs::read(folder.join("Cargo.lock")).expect("a lock");
    let tested = cargo(&["test", "--test", "stage1"]);
    let (said, complained) = printed(&tested);
    assert!(
        said.contains("not written yet") || complained.contains("not written yet"),
        "{said}\n{complained}"
    );
    assert!(!complained.contains("warning"), "{complained}");
    assert!(!tested.status.success());
    assert!(lock == fs::read(folder.join("Cargo.lock")).expect("a lock"), "cargo has changed Cargo.lock");

    view_shows_a_picture_beside_its_record(folder, &target, &cargo);

    let check = "sphere_geometric_starts_inside";
    for (arguments, success, words) in [
        (&["run"][..], true, "Next: exercises/src/stage1_shapes.rs"),
        (&["run", "--", "list"], true, check),
        (&["run", "--", "hint", check], true, "still stuck"),
        (&["run", "--", "check"], false, "0 passed"),
        (&["run", "--", "try", check], false, "not written yet"),
        (
            &["run", "--", "check", "picture_of_a_sphere_on_a_plane", "--pixel", "40,30"],
            false,
            "(the golden picture)",
        ),
        (
            &["run", "--", "render", "scenes/stage1.toml", "--size", "32x20"],
            true,
            "spheres are left out: `sphere_algebraic` of stage 1 is not written yet",
        ),
        (
            &["run", "--", "render", "scenes/stage1.toml", "--kit", "solutions"],
            false,
            "there are no solutions",
        ),
        (&["run", "--", "sync"], false, "there is no command `sync`"),
        (&["fmt", "--all", "--check"], true, ""),
        (&["test", "--workspace"], true, "test result: ok"),
    ] {
        let output = cargo(arguments);
        let (said, complained) = printed(&output);
        assert_eq!(output.status.success(), success, "{arguments:?}: {said}\n{complained}");
        // Reports break lines between words.
        let is_said = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ").contains(words);
        assert!(is_said(&said) || is_said(&complained), "{arguments:?}: {said}\n{complained}");
        assert!(!complained.contains("warning: "), "{arguments:?}: {complained}");
    }
    a_half_written_kit_is_updated(folder, &target);
}

/// A student of an older version has written a function. The update keeps it and adds what is new, and everything compiles.
fn a_half_written_kit_is_updated(new: &Path, target: &Path) {
    let around = tempfile::tempdir().expect("a folder");
    let old = around.path().join("kit");
    for path in paths(new, "") {
        let copy = old.join(&path);
        fs::create_dir_all(copy.parent().expect("a folder")).expect("made");
        fs::copy(new.join(path), copy).expect("copied");
    }
    let edit = |path: &str, from: &str, to: &str| {
        let text = fs::read_to_string(old.join(path)).expect("text");
        assert!(text.contains(from), "{path} lacks {from}");
        fs::write(old.join(path), text.replace(from, to)).expect("written");
    };
    // The older version has another scene, a file less and a file more, and lacks a function and a stage.
    edit("scenes/stage1.toml", "[camera]", "# An older scene.\n[camera]");
    fs::remove_file(old.join("exercises/src/stage12_wide.rs")).expect("removed");
    edit("exercises/src/lib.rs", "pub mod stage12_wide;\n", "pub mod mine;\n");
    fs::write(old.join("exercises/src/mine.rs"), "//! Mine.\n").expect("written");
    fs::write(old.join("src/gone.rs"), "").expect("written");
    edit("tests/kit.toml", "files = [\n", "files = [\n    \"src/gone.rs\",\n");
    let version = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    edit("tests/kit.toml", &version, "version = \"0.0.9\"");
    let file = "exercises/src/stage1_shapes.rs";
    let text = fs::read_to_string(old.join(file)).expect("an exercise");
    let start = text.find("pub fn face_forward").expect("a function");
    fs::write(old.join(file), &text[..text[..start].rfind("\n\n").expect("a gap") + 1]).expect("written");
    // The student has written a function with a function of its own.
    let text = fs::read_to_string(old.join(file)).expect("an exercise");
    let (before, stub) = text.split_once("pub fn sphere_normal").expect("a function");
    let (head, rest) = stub.split_once("{\n").expect("its body");
    let (_, after) = rest.split_once("\n}\n").expect("its end");
    let written = format!(
        "{before}pub fn sphere_normal{head}{{\n    my_own(point - center)\n}}\n{after}\n\nfn my_own(v: Vec3) -> Vec3 {{\n    \
         v.normalize()\n}}\n"
    );
    fs::write(old.join(file), written).expect("written");
    // The program of the older kit is that of the new one here. It is built where it compiles.
    let update = target.join("debug/update");
    let run = |arguments: &[&str]| {
        let mut update = Command::new(&update);
        printed(&update.arg(&old).arg(new).args(arguments).output().expect("update starts"))
    };
    let (said, complained) = run(&["--dry-run"]);
    assert!(said.contains("Nothing was changed, because of --dry-run."), "{said}{complained}");
    assert!(old.join("src/gone.rs").exists());
    let (said, complained) = run(&[]);
    assert!(said.starts_with("raykata 0.0.9 → "), "{said}{complained}");
    for line in [
        "exercises/src/stage1_shapes.rs: the function that you have written stays; new: `face_forward`",
        "exercises/src/stage12_wide.rs: new",
        "out/before-update-1",
    ] {
        assert!(said.contains(line), "{line}: {said}{complained}");
    }
    let text = fs::read_to_string(old.join(file)).expect("an exercise");
    assert!(text.contains("my_own(point - center)") && text.contains("pub fn face_forward"), "{text}");
    assert!(!old.join("src/gone.rs").exists() && old.join("out/before-update-1/src/gone.rs").exists());
    let kept = fs::read_to_string(old.join("out/before-update-1/scenes/stage1.toml")).expect("the old scene");
    assert!(kept.contains("# An older scene."));
    let (said, complained) = printed(&cargo_in(&old, target, &["test", "--test", "stage1"]));
    assert!(said.contains("test sphere_normal") && said.contains(" ok\n"), "{said}{complained}");
    let (said, _) = run(&[]);
    assert!(said.contains("Everything is as in the new kit."), "{said}");
}

/// The page shows a picture of the untouched exercises beside the recorded reference.
fn view_shows_a_picture_beside_its_record(folder: &Path, target: &Path, cargo: &dyn Fn(&[&str]) -> Output) {
    let built = cargo(&["build", "--package", "live"]);
    assert!(built.status.success(), "{}", printed(&built).1);
    let mut view = Command::new(target.join("debug/view"));
    view.arg(folder)
        .arg(folder.join("scenes/stage1.toml"))
        .env("CARGO", env!("CARGO"))
        .stdout(Stdio::piped());
    let mut view = view.env("CARGO_NET_OFFLINE", "true").spawn().expect("view starts");
    let mut line = String::new();
    BufReader::new(view.stdout.take().expect("its output")).read_line(&mut line).expect("its address");
    let address = line.trim().rsplit("http://").next().expect("an address");
    let (host, path) = address.split_once('/').expect("a path");
    let mut stream = TcpStream::connect(host).expect("the server");
    write!(stream, "GET /{path}events HTTP/1.1\r\nHost: {host}\r\n\r\n").expect("a request");
    let messages = BufReader::new(stream).lines().map_while(Result::ok);
    let until_done: Vec<String> = messages.take_while(|line| !line.contains("\"phase\":\"done\"")).collect();
    let _ = view.kill();
    let _ = view.wait();
    let has = |words: &str| until_done.iter().any(|line| line.contains(words));
    assert!(has("\"source\":\"recorded from the solutions\""), "{line}");
    assert!(has("\"pass\":\"all samples\"") && has("spheres are left out"), "{line}");
}
