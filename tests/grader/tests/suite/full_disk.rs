//! A full disk is an error that names the file and loses nothing that was finished.

use super::grade::{hand_in, right};
use super::program_runs::{leaves_out_what_takes_long, printed, root, small_disk};
use super::{grader_succeeds, said_by};
use std::fs;
use std::path::{Path, PathBuf};

/// A command whose result is on a small disk.
struct FullDiskRun {
    program: PathBuf,
    /// The command. `DISK` is the small disk.
    command: String,
    /// What must be added so that it continues.
    resume: &'static str,
    /// The size of the disk while it is small, as `mount` reads it.
    size: &'static str,
    /// A part of the name of a file with finished work, which is kept.
    keeps: Option<&'static str>,
    /// A file of the result, below the disk, which is the same as without the small disk; empty if each run gives other bytes.
    result: &'static str,
}

impl FullDiskRun {
    /// Runs the command on the small disk, and once more with room.
    fn holds(&self) -> bool {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        for name in ["disk", "whole"] {
            fs::create_dir(at(name)).unwrap();
        }
        let compare = match self.result {
            "" => String::new(),
            result => format!("cmp {}/{result} {}/{result}", at("disk"), at("whole")),
        };
        let on = |disk: &str| format!("{} {}", self.program.display(), self.command.replace("DISK", disk));
        let script = format!(
            "cd {folder}\n\
             mount -t tmpfs -o size={size} tmpfs {disk}\n\
             {small} && echo 'ended well' || echo 'ended badly'\n\
             echo '--- left'\n\
             find {disk} -type f\n\
             echo '--- room'\n\
             mount -o remount,size=400m {disk}\n\
             {small} {resume} && echo 'ended well' || echo 'ended badly'\n\
             {whole} >/dev/null\n\
             {compare}\n\
             echo 'the same'\n",
            folder = folder.path().display(),
            size = self.size,
            disk = at("disk"),
            small = on(&at("disk")),
            resume = self.resume,
            whole = on(&at("whole")),
        );
        let Some(mut shell) = small_disk(&script) else { return false };
        let output = shell.output().unwrap();
        let text = format!("{}\n{}", self.command, said_by(&output));
        let (said, complained) = printed(&output);
        let (small, rest) = said.split_once("--- left").expect(&text);
        let (left, room) = rest.split_once("--- room").expect(&text);
        assert!(small.contains("ended badly"), "{text}");
        // The message names a file or a folder of the disk, and the reason.
        let is_full = complained.contains("No space left") || complained.contains("disk is full");
        assert!(complained.contains(&at("disk")) && is_full, "{text}");
        // No half-written file is left.
        assert!(!left.contains(".part"), "{text}");
        assert!(self.keeps.is_none_or(|kept| left.contains(kept)), "{text}");
        assert!(room.contains("ended well") && room.contains("the same"), "{text}");
        true
    }
}

fn try_all(cases: &[FullDiskRun]) {
    if !cases.iter().all(FullDiskRun::holds) {
        println!("SKIPPED: this user may not mount a small disk, so a full disk is not tried");
    }
}

/// Grades a class of four in two parts. Returns the folders of the class and of the parts.
fn parts_of_a_class(around: &Path) -> [String; 3] {
    let class = around.join("class");
    for number in 0..4 {
        hand_in(&class, &format!("student-{number}"), &right().replace("0.5", &format!("0.5{number}")));
    }
    let class = class.to_string_lossy().into_owned();
    let [one, other] = ["1/2", "2/2"].map(|part| {
        let out = around.join(&part[..1]).to_string_lossy().into_owned();
        grader_succeeds(["grade", &class, "--stages", "1", "--seed", "5", "--shard", part, "--out", &out]);
        out
    });
    [class, one, other]
}

fn case(program: &Path, command: &str, size: &'static str, result: &'static str) -> FullDiskRun {
    let (program, command) = (program.to_owned(), command.to_owned());
    FullDiskRun { program, command, resume: "", size, keeps: None, result }
}

#[test]
fn a_picture_that_does_not_fit_on_the_disk_is_rendered_when_there_is_room() {
    let raykata = Path::new(env!("CARGO_BIN_EXE_grader")).with_file_name("raykata");
    if !raykata.is_file() {
        // The tests of the grader do not build this program.
        return println!("SKIPPED: {} is not built", raykata.display());
    }
    let gamma = root().join("scenes/gamma.toml").to_string_lossy().into_owned();
    let render = format!("render {gamma} --size 200x150 --spp 2 --out DISK/picture.hdr");
    let in_pieces = case(&raykata, &format!("{render} --pieces 6"), "160k", "picture.hdr");
    try_all(&[
        case(&raykata, &render, "16k", "picture.hdr"),
        FullDiskRun { keeps: Some(".piece"), ..in_pieces },
    ]);
}

/// These take a minute, so they run only with `CI_LONG=1`.
#[test]
fn every_command_names_the_file_on_a_full_disk_and_continues_with_room() {
    if leaves_out_what_takes_long() {
        return;
    }
    let around = tempfile::tempdir().unwrap();
    let [class, one, other] = parts_of_a_class(around.path());
    let grader = PathBuf::from(env!("CARGO_BIN_EXE_grader"));
    let grade = format!("grade {class} --stages 1 --seed 5 --jobs 1 --out DISK/grades");
    let grading = case(&grader, &grade, "200k", "grades/grades.csv");
    try_all(&[
        FullDiskRun { resume: "--resume", keeps: Some("grades/grades.sqlite"), ..grading },
        case(&grader, &format!("merge {one} {other} --out DISK/merged"), "40k", "merged/grades.csv"),
        case(&grader, "export gradescope --out DISK/autograder.zip", "100k", ""),
        case(&grader, "handout DISK/course", "500k", "course/exercises/src/lib.rs"),
        case(&grader, "release --draft --out DISK/release", "500k", "release/SHA256SUMS"),
    ]);
}

#[test]
fn a_measurement_continues_after_a_full_disk() {
    let shadows = root().join("scenes/soft_shadows.toml");
    let cost = format!(
        "cost {} --full --size 16x12 --rounds 1 --reference 128 --parameter samples_per_pixel --out DISK/cost",
        shadows.display()
    );
    let program = Path::new(env!("CARGO_BIN_EXE_grader")).with_file_name("raykata");
    // All files contain measured times.
    try_all(&[FullDiskRun { keeps: Some("cost/unfinished.jsonl"), ..case(&program, &cost, "16k", "") }]);
}
