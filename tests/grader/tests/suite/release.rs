//! Tests the archives of a release, and that they build where there is no network.

use super::program_runs::{leaves_out_what_takes_long, root};
use super::{grader, grader_succeeds, said_by};
use checks::rubric::entry;
use flate2::read::GzDecoder;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn archive(folder: &Path, kind: &str) -> PathBuf {
    folder.join(format!("raykata-{kind}-{}-draft.tar.gz", env!("CARGO_PKG_VERSION")))
}

/// Unpacks an archive and returns its one folder.
fn unpacked(archive: &Path, into: &Path) -> PathBuf {
    let mut tar = tar::Archive::new(GzDecoder::new(fs::File::open(archive).expect("an archive")));
    tar.unpack(into).expect("unpacked");
    let name = archive.file_name().expect("a name").to_string_lossy();
    into.join(name.trim_end_matches(".tar.gz"))
}

/// Three releases take a quarter of a minute, so they are made only with `CI_LONG=1`.
#[test]
fn a_release_has_the_same_bytes_each_time_and_no_answer_for_students() {
    if leaves_out_what_takes_long() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for out in ["one", "two"] {
        grader_succeeds(["release", "--draft", "--out", &at(out).to_string_lossy()]);
    }
    let sums = fs::read_to_string(at("one/SHA256SUMS")).unwrap();
    assert_eq!(sums, fs::read_to_string(at("two/SHA256SUMS")).unwrap());
    for kind in ["course", "grader"] {
        let [one, two] = ["one", "two"].map(|out| fs::read(archive(&at(out), kind)).unwrap());
        assert!(one == two, "{kind}: other bytes");
        assert!(sums.contains(&format!("  raykata-{kind}-")));
    }
    let course = unpacked(&archive(&at("one"), "course"), &at("course"));
    assert!(course.join("exercises/src/stage1_shapes.rs").is_file() && !course.join("solutions").exists());
    let kit = unpacked(&archive(&at("one"), "grader"), &at("kit"));
    for file in
        ["solutions/src/stage1_shapes.rs", "tests/grader/README.md", "CHANGELOG.md", "slides/README.md"]
    {
        assert!(kit.join(file).is_file(), "{file}");
    }
    assert!(!kit.join("target").exists() && !kit.join("tests/grader/target").exists());
    // A release needs a chapter in the changelog. The test is true before and after the chapter is written.
    let has_chapter = fs::read_to_string(root().join("CHANGELOG.md"))
        .unwrap()
        .contains(&format!("\n## {}", env!("CARGO_PKG_VERSION")));
    let output = grader(["release", "--out", &at("final").to_string_lossy()]);
    assert_eq!(output.status.success(), has_chapter, "{}", said_by(&output));
    assert!(has_chapter || said_by(&output).contains("CHANGELOG.md has no chapter"), "{}", said_by(&output));
}

/// The archives leave out no file of the repository that a build or a test reads.
#[test]
fn the_grader_archive_contains_each_file_of_the_repository() {
    let listed = Command::new("git").current_dir(root()).args(["ls-files", "-z"]).output();
    let Some(listed) = listed.ok().filter(|listed| listed.status.success() && !listed.stdout.is_empty())
    else {
        return println!("SKIPPED: this is no working copy of git");
    };
    let folder = tempfile::tempdir().unwrap();
    grader_succeeds(["release", "--draft", "--out", &folder.path().to_string_lossy()]);
    let kit = unpacked(&archive(folder.path(), "grader"), folder.path());
    let listed = String::from_utf8(listed.stdout).unwrap();
    let missing: BTreeSet<&str> =
        listed.split('\0').filter(|path| !path.is_empty() && !kit.join(path).exists()).collect();
    // Files that were deleted and not committed yet are in neither.
    let missing: Vec<&&str> = missing.iter().filter(|path| root().join(path).exists()).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// Runs cargo in an empty home with only the toolchain in its path; as root, without a network.
fn offline(folder: &Path, home: &Path, arguments: &[&str]) -> Output {
    let sysroot = Command::new("rustc").args(["--print", "sysroot"]).output().expect("rustc starts");
    let tools = PathBuf::from(String::from_utf8_lossy(&sysroot.stdout).trim()).join("bin");
    let without = Command::new("unshare").args(["--net", "true"]).output();
    let has_namespaces = without.is_ok_and(|output| output.status.success());
    let mut command = if has_namespaces {
        let mut command = Command::new("unshare");
        command.arg("--net").arg(tools.join("cargo"));
        command
    } else {
        println!("this user may not take the network away, so cargo gets the option to work offline");
        Command::new(tools.join("cargo"))
    };
    command.current_dir(folder).args(arguments).env_clear();
    command.env("HOME", home).env("PATH", format!("{}:/usr/bin:/bin", tools.display()));
    if !has_namespaces {
        command.env("CARGO_NET_OFFLINE", "true");
    }
    command.output().expect("cargo starts")
}

/// Builds both archives as a classroom without internet does. This takes many minutes, so it runs only with `CI_LONG=1`.
#[test]
fn vendored_archives_build_in_an_empty_home_without_a_network() {
    if std::env::var_os("CI_LONG").is_none() {
        return println!("built only with CI_LONG=1");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("release");
    let output = grader(["release", "--draft", "--vendor", "--out", &out.to_string_lossy()]);
    if said_by(&output).contains("`cargo vendor` failed") {
        return println!("SKIPPED: the packages cannot be downloaded here: {}", said_by(&output));
    }
    assert!(output.status.success(), "{}", said_by(&output));
    println!("{}", said_by(&output));
    let home = folder.path().join("home");
    fs::create_dir(&home).unwrap();
    let course = unpacked(&archive(&out, "course"), folder.path());
    let output = offline(&course, &home, &["test", "--locked", "--test", "stage1"]);
    assert!(said_by(&output).contains("not written yet: exercises/src/stage1"), "{}", said_by(&output));
    fs::remove_dir_all(course.join("target")).unwrap();
    let kit = unpacked(&archive(&out, "grader"), folder.path());
    let grade = "run --locked -p grader -- grade-one exercises --stages 1 --gradescope result.json";
    let output = offline(&kit, &home, &grade.split(' ').collect::<Vec<_>>());
    let of: u32 = all_checks::of_stage(1).iter().map(|check| entry(1, check.name).points).sum();
    let said = said_by(&output);
    assert!(output.status.success() && said.contains(&format!("0 of {of} points")), "{said}");
}
