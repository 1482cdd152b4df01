//! Tests the job scripts for Slurm: by a shell in place of Slurm, and on a real Slurm with two nodes, one of which is lost.

mod cluster;

use super::grade::{graded, hand_in, right};
use super::program_runs::{leaves_out_what_takes_long, printed, root};
use super::{grader, grader_succeeds};
use cluster::Cluster;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// Runs a script as a task of an array.
fn task(script: &Path, index: usize) -> Output {
    Command::new(script).env("SLURM_ARRAY_TASK_ID", index.to_string()).output().expect("sh")
}

fn same_bytes(one: &Path, other: &Path, names: &[&str]) {
    for name in names {
        let [one, other] = [one, other].map(|folder| fs::read(folder.join(name)).expect("a report"));
        assert!(one == other, "{name} differs");
    }
}

#[test]
fn scripts_of_a_class_grade_its_parts_and_the_merge_names_a_hole() {
    let folder = tempfile::tempdir().expect("a folder");
    // Slurm and shells read some of these characters.
    let (class, jobs) = (folder.path().join("the class"), folder.path().join("it's $HOME"));
    for number in 0..3 {
        hand_in(&class, &format!("s{number}"), &right().replace("0.5", &format!("0.{number}5")));
    }
    let [class, out] = [&class, &jobs].map(|path| path.to_string_lossy().into_owned());
    let said = grader_succeeds([
        "export", "slurm", &class, "--chunk", "2", "--stages", "1", "--seed", "11", "--out", &out,
    ]);
    assert!(said.contains("3 submissions in 2 parts"), "{said}");
    for script in ["grade.sbatch", "merge.sbatch", "submit.sh"] {
        let text = fs::read_to_string(jobs.join(script)).expect("a script");
        let output = Command::new("sh").arg("-n").arg(jobs.join(script)).output().expect("sh");
        assert!(output.status.success() && text.starts_with("#!/bin/sh\n"), "{}", printed(&output).1);
        for template in ["{out", "{kit", "{parts", "{first", "{options"] {
            assert!(!text.contains(template), "{text}");
        }
    }
    let readme = fs::read_to_string(jobs.join("README.md")).expect("a README");
    assert!(readme.contains("3 submissions") && !readme.contains("{"), "{readme}");

    assert!(task(&jobs.join("grade.sbatch"), 1).status.success());
    let hole = task(&jobs.join("merge.sbatch"), 0);
    assert!(
        !hole.status.success() && printed(&hole).1.contains("part 2 of 2 is missing"),
        "{}",
        printed(&hole).1
    );
    let second = task(&jobs.join("grade.sbatch"), 2);
    assert!(second.status.success(), "{}", printed(&second).1);
    let merge = task(&jobs.join("merge.sbatch"), 0);
    assert!(merge.status.success(), "{}", printed(&merge).1);
    let whole = folder.path().join("whole");
    grader_succeeds(["grade", &class, "--stages", "1", "--seed", "11", "--out", &whole.to_string_lossy()]);
    same_bytes(&whole, &jobs.join("grades"), &["grades.csv", "checks.csv", "results.json", "junit.xml"]);
    // Nothing is written over.
    let again = grader(["export", "slurm", &class, "--out", &out]);
    assert!(printed(&again).1.contains("is not empty"), "{}", printed(&again).1);
}

#[test]
fn scripts_of_a_picture_render_its_pieces() {
    // The tests of the grader do not build this program.
    let program = Path::new(env!("CARGO_BIN_EXE_grader")).with_file_name("raykata");
    if !program.is_file() {
        return println!("SKIPPED: {} is not built", program.display());
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (jobs, whole) = (folder.path().join("jobs"), folder.path().join("whole.png"));
    let scene = root().join("scenes/gamma.toml").to_string_lossy().into_owned();
    let size = ["--size", "60x50", "--seed", "3", "--exposure", "1"];
    let out = jobs.to_string_lossy();
    let export = ["export", "slurm-picture", &scene, "--pieces", "3", "--out", &out];
    grader_succeeds([&export[..], &size].concat());
    assert_eq!(fs::read_to_string(jobs.join("rows.txt")).expect("rows"), "0..16\n16..32\n32..50\n");
    for index in [3, 1, 2, 2] {
        let output = task(&jobs.join("render.sbatch"), index);
        assert!(output.status.success(), "{}", printed(&output).1);
    }
    let merge = task(&jobs.join("merge.sbatch"), 0);
    assert!(merge.status.success(), "{}", printed(&merge).1);
    let mut render = Command::new(&program);
    let render = render.current_dir(root()).args(["render", &scene, "--out"]).arg(&whole).args(size).output();
    assert!(render.expect("the program starts").status.success());
    assert!(fs::read(&whole).expect("a picture") == fs::read(jobs.join("gamma.png")).expect("a picture"));
}

/// Waits until `happened` returns something.
fn wait_for<T>(what: &str, mut happened: impl FnMut() -> Option<T>) -> T {
    let late = Instant::now() + Duration::from_secs(600);
    loop {
        if let Some(found) = happened() {
            return found;
        }
        assert!(Instant::now() < late, "{what} takes longer than ten minutes");
        std::thread::sleep(Duration::from_millis(200));
    }
}

/// The tasks of an array that run on a node, by their numbers in the array.
fn tasks_on(cluster: &Cluster, node: &str) -> Vec<usize> {
    let running = cluster.ask("squeue", &["-h", "-t", "R", "-w", node, "-o", "%K"]);
    running.lines().filter_map(|line| line.trim().parse().ok()).collect()
}

/// Grades 24 submissions in 6 parts on a real Slurm with two nodes, and kills one of the nodes while it grades.
#[test]
fn a_lost_node_changes_no_byte_of_the_grades() {
    if leaves_out_what_takes_long() {
        return;
    }
    let Some(mut cluster) = Cluster::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let (class, whole, jobs) =
        (folder.path().join("class"), folder.path().join("whole"), folder.path().join("jobs"));
    for number in 0..23 {
        hand_in(&class, &format!("student-{number:02}"), &right().replace("0.5", &format!("0.{number:02}5")));
    }
    fs::write(class.join("malformed.zip"), "no zip").expect("written");
    let [class, out] = [&class, &jobs].map(|path| path.to_string_lossy().into_owned());
    let options = ["--stages", "1", "--seed", "11"];
    let begun = Instant::now();
    grader([&["grade", &class, "--out", &whole.to_string_lossy()], &options[..]].concat());
    println!("without Slurm: 24 submissions graded in {:.0} s", begun.elapsed().as_secs_f64());
    let export = ["export", "slurm", &class, "--chunk", "4", "--out", &out];
    print!("{}", grader_succeeds([&export[..], &options].concat()));

    // Submit both jobs, and wait until a task on the second node has stored some of its grades, but not all.
    let begun = Instant::now();
    let submit = cluster.command(jobs.join("submit.sh")).output().expect("sh");
    assert!(submit.status.success(), "{}", printed(&submit).1);
    print!("{}", printed(&submit).0);
    let part = |index: usize| -> PathBuf { jobs.join("parts").join(index.to_string()) };
    let lost = wait_for("a task on the node n2", || {
        tasks_on(&cluster, "n2").into_iter().find(|index| !graded(&part(*index)).is_empty())
    });
    let killed = cluster.lose("n2");
    let stored = graded(&part(lost));
    println!(
        "after {:.0} s: node n2 is lost while it grades part {lost}, of which {} grades are stored; killed processes {killed:?}",
        begun.elapsed().as_secs_f64(),
        stored.len()
    );
    // Wait until both jobs have ended.
    wait_for("the class", || cluster.ask("squeue", &["-h"]).trim().is_empty().then_some(()));
    println!("after {:.0} s: the queue is empty", begun.elapsed().as_secs_f64());
    let tasks = cluster.ask("scontrol", &["show", "job", "-o"]);
    for task in tasks.lines() {
        let wanted = ["ArrayTaskId=", "JobName=", "JobState=", "Restarts=", "ExitCode=", "NodeList=n"];
        println!(
            "  {}",
            task.split(' ')
                .filter(|word| wanted.iter().any(|key| word.starts_with(key)))
                .collect::<Vec<_>>()
                .join(" ")
        );
    }
    let again = tasks.lines().find(|task| task.contains(&format!("ArrayTaskId={lost} ")));
    assert!(again.is_some_and(|task| task.contains(" Restarts=1 ")), "part {lost} was not started again");
    // What was stored before stays, with its milliseconds: no submission was graded twice.
    let after = graded(&part(lost));
    assert!(stored.iter().all(|row| after.contains(row)) && after.len() >= stored.len());
    same_bytes(&whole, &jobs.join("grades"), &["grades.csv", "checks.csv", "results.json", "junit.xml"]);
    let results = fs::read_to_string(jobs.join("grades/results.json")).expect("results");
    let sandbox = results.lines().find(|line| line.contains("\"isolation\"")).unwrap_or_default();
    println!(
        "the grades are equal to those without Slurm, byte for byte; all tasks had the sandbox {}",
        sandbox.trim()
    );

    // What a task costs that does nothing: a part must be so large that this does not matter.
    cluster.ask("scontrol", &["update", "nodename=n1", "state=resume"]);
    let begun = Instant::now();
    let empty = ["--array=1-40", "--output=/dev/null", "--wrap=true"];
    assert!(cluster.ask("sbatch", &empty).contains("Submitted"));
    wait_for("the empty tasks", || cluster.ask("squeue", &["-h"]).trim().is_empty().then_some(()));
    println!("40 empty tasks on one node of 2 processors take {:.0} s", begun.elapsed().as_secs_f64());
    cluster.stop();
}
