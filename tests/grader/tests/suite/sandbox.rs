//! Tests that a sandboxed program cannot leave its sandbox.

use grader::sandbox::{
    self, Confinement, Ended, How, Purpose, ResourceLimits, Sandbox, got_through, run, this_program,
};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Time limit per command. The tests need far less; the limit only matters on a very slow machine.
const PATIENCE: Duration = Duration::from_secs(60);
const CAP: usize = 1 << 20;

fn probe(sandbox: &Sandbox, what: &str) -> Ended {
    let mut command = sandbox.command(&this_program());
    command.args(["--probe-the-sandbox", what]);
    run(command, b"", PATIENCE, CAP).expect("it runs")
}

fn said(ended: &Ended) -> String {
    format!(
        "{:?}: {}{}",
        ended.how,
        String::from_utf8_lossy(&ended.stdout),
        String::from_utf8_lossy(&ended.stderr)
    )
}

#[test]
fn this_machine_contains_submissions() {
    let started = Instant::now();
    let level = sandbox::self_test().expect("contained");
    assert!(level.starts_with("Landlock ABI ") && level.contains("seccomp"), "{level}");
    eprintln!("{level}, tested in {:?}", started.elapsed());
}

#[test]
fn each_purpose_lets_through_what_it_is_for_and_nothing_else() {
    for (purpose, through) in [
        (Purpose::Worker, &[][..]),
        (Purpose::Reader, &[]),
        (Purpose::Compiler, &["start a thread"]),
        (Purpose::Linker, &["make a pair of sockets", "start a process", "start a thread"]),
    ] {
        assert_eq!(got_through(&Sandbox::new(purpose)).expect("probed"), through, "{purpose:?}");
    }
}

#[test]
fn what_is_not_asked_for_is_not_there() {
    let scratch = tempfile::tempdir().expect("a folder");
    let worker = Sandbox::new(Purpose::Worker);
    let compiler = Sandbox { writable: vec![scratch.path().into()], ..Sandbox::new(Purpose::Compiler) };
    assert_eq!(said(&probe(&worker, "environment")), "Exited(0): []\n");
    let environment = said(&probe(&compiler, "environment"));
    assert_eq!(environment, format!("Exited(0): [(\"TMPDIR\", {:?})]\n", scratch.path()));
    assert_eq!(said(&probe(&worker, "descriptors")), "Exited(0): 0\n");
}

/// The sandbox with `--insecure` on a kernel without Landlock or seccomp.
#[test]
fn without_walls_limits_still_hold() {
    let open = Sandbox::with(Confinement::LimitsOnly, Purpose::Worker);
    let all = probe(&open, "all");
    let said = String::from_utf8_lossy(&all.stdout).into_owned();
    assert!(said.contains("through: read a file of the system"), "{said}");
    // A worker may not write a single byte to a file, so the test that writes one ends it (SIGXFSZ).
    assert_eq!(all.how, How::Signalled(25), "{said}");
    let brief = Sandbox { limits: ResourceLimits { cpu_seconds: 1, ..open.limits }, ..open };
    assert_eq!(probe(&brief, "spin").how, How::UsedUpCpu);
}

#[test]
fn an_open_file_of_the_judge_is_not_inherited() {
    // A file opened by a shell redirection stays open on exec, unlike files that Rust opens. The shell is the launcher's
    // parent.
    let script = "exec 7</etc/passwd 9</etc/passwd
        launcher=$1 word=$2; shift 3
        \"$launcher\" \"$word\" $$ \"$@\"; exit $?";
    let sandboxed = Sandbox::new(Purpose::Worker).command(&this_program());
    let mut command = Command::new("/bin/sh");
    command.args(["-c", script, "sh"]).arg(sandboxed.get_program()).args(sandboxed.get_args());
    command.args(["--probe-the-sandbox", "descriptors"]);
    assert_eq!(said(&run(command, b"", PATIENCE, CAP).expect("it runs")), "Exited(0): 0\n");
}

#[test]
fn endless_work_output_and_sleep_end() {
    let sandbox = Sandbox::new(Purpose::Worker);
    let brief = Sandbox { limits: ResourceLimits { cpu_seconds: 1, ..sandbox.limits }, ..sandbox.clone() };
    let spun = probe(&brief, "spin");
    assert_eq!(spun.how, How::UsedUpCpu);
    assert!(spun.cpu >= Duration::from_millis(900), "{:?}", spun.cpu);
    let flooded = probe(&sandbox, "flood");
    assert_eq!((flooded.how, flooded.stdout.len()), (How::WroteTooMuch, CAP));
    let mut command = sandbox.command(&this_program());
    command.args(["--probe-the-sandbox", "sleep"]);
    let ended = run(command, b"", Duration::from_millis(200), CAP).expect("it runs");
    assert_eq!(ended.how, How::TookTooLong);
}

/// The text of this file of each process.
fn of_processes(file: &str) -> impl Iterator<Item = String> {
    let entries = std::fs::read_dir("/proc").expect("/proc");
    let texts = entries.filter_map(move |entry| std::fs::read(entry.ok()?.path().join(file)).ok());
    texts.map(|text| String::from_utf8_lossy(&text).replace('\0', " "))
}

/// Returns the processes whose command line contains `word`.
fn running(word: &str) -> Vec<String> {
    of_processes("cmdline").filter(|line| line.contains(word)).collect()
}

/// Counts the children of this process that have ended and were not waited for.
fn zombies() -> usize {
    let myself = format!(" Z {} ", std::process::id());
    of_processes("stat").filter(|line| line.contains(&myself)).count()
}

fn shell(script: &str) -> Command {
    let mut command = Sandbox::new(Purpose::Linker).command(Path::new("/bin/sh"));
    command.args(["-c", script]);
    command
}

#[test]
fn nothing_is_left_of_a_tree_of_processes() {
    // Use numbers of seconds that no other process on the machine has in its command line.
    let script = "sleep 7261 & (sleep 7262 & (sleep 7263 & sleep 7264) & sleep 7265) & wait";
    let ended = run(shell(script), b"", Duration::from_millis(500), CAP).expect("it runs");
    assert_eq!(ended.how, How::TookTooLong, "{}", said(&ended));
    assert_eq!(running("sleep 726"), Vec::<String>::new());
    // Test a process that ends by itself and leaves others behind.
    let ended = run(shell("sleep 7361 & sleep 7362 & exit 3"), b"", PATIENCE, CAP).expect("it runs");
    assert_eq!(ended.how, How::Exited(3), "{}", said(&ended));
    assert_eq!(running("sleep 736"), Vec::<String>::new());
    // Other tests run at the same time. Their processes are waited for soon.
    let until = Instant::now() + PATIENCE;
    while zombies() > 0 {
        assert!(Instant::now() < until, "no process was waited for in time");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_crowd_of_processes_is_ended() {
    let script = "i=0; while [ $i -lt 200 ]; do sleep 7461 & i=$((i+1)); done; wait";
    let ended = run(shell(script), b"", PATIENCE, CAP).expect("it runs");
    assert_eq!(ended.how, How::TooManyProcesses, "{}", said(&ended));
    assert_eq!(running("sleep 7461"), Vec::<String>::new());
}

#[test]
fn what_cannot_be_sandboxed_does_not_run() {
    let missing = Sandbox { readable: vec!["/no/such/folder".into()], ..Sandbox::new(Purpose::Worker) };
    let ended = probe(&missing, "environment");
    assert_eq!(ended.how, How::Exited(sandbox::NOT_LAUNCHED));
    assert!(
        said(&ended).contains("the sandbox: /no/such/folder cannot be made accessible"),
        "{}",
        said(&ended)
    );
    let writes = Sandbox { writable: vec!["/tmp".into()], ..Sandbox::new(Purpose::Worker) };
    assert!(said(&probe(&writes, "environment")).contains("a worker must not write"));
    let command = Sandbox::new(Purpose::Worker).command(Path::new("/no/such/program"));
    let ended = run(command, b"", PATIENCE, CAP).expect("it runs");
    assert!(said(&ended).contains("the sandbox: /no/such/program"), "{}", said(&ended));
}

fn toolchain() -> PathBuf {
    let found = Command::new("rustc").args(["--print", "sysroot"]).output().expect("rustc");
    String::from_utf8(found.stdout).expect("a path").trim().into()
}

fn compile(purpose: Purpose, scratch: &Path, source: &str, arguments: &[&str]) -> Ended {
    let file = scratch.join("source.rs");
    std::fs::write(&file, source).expect("written");
    let toolchain = toolchain();
    let sandbox = Sandbox {
        readable: vec![toolchain.clone()],
        writable: vec![scratch.into()],
        ..Sandbox::new(purpose)
    };
    let mut command = sandbox.command(&toolchain.join("bin/rustc"));
    command.arg(file).args(["--edition", "2024"]).args(arguments);
    run(command, b"", PATIENCE, CAP).expect("it runs")
}

#[test]
fn a_library_is_compiled_and_a_file_of_the_system_is_not_included() {
    let scratch = tempfile::tempdir().expect("a folder");
    let library = ["--crate-type", "rlib", "-o", "libhello.rlib"];
    let ended = compile(Purpose::Compiler, scratch.path(), "pub fn hello() -> u8 { 7 }", &library);
    assert_eq!(said(&ended), "Exited(0): ");
    assert!(scratch.path().join("libhello.rlib").is_file());
    for macro_name in ["include_str", "include_bytes"] {
        let source = format!("pub fn leak() {{ {macro_name}!(\"/etc/passwd\"); }}");
        let ended = compile(Purpose::Compiler, scratch.path(), &source, &library);
        assert_eq!(ended.how, How::Exited(1));
        assert!(said(&ended).contains("couldn't read `/etc/passwd`: Permission denied"), "{}", said(&ended));
    }
    let elsewhere = ["--crate-type", "rlib", "-o", "/tmp/libleaked.rlib"];
    assert_ne!(compile(Purpose::Compiler, scratch.path(), "", &elsewhere).how, How::Exited(0));
    assert!(!Path::new("/tmp/libleaked.rlib").exists());
}

#[test]
fn a_program_is_linked_and_a_recursion_as_deep_as_a_worker_may_go_returns() {
    let scratch = tempfile::tempdir().expect("a folder");
    // 100,000 calls of about five hundred bytes each.
    let source = "use std::hint::black_box;
        fn deep(n: u32) -> u32 { let room = black_box([n; 100]); if n == 0 { 0 } else { 1 + deep(n - 1) + room[9] - n } }
        fn main() { println!(\"{}\", deep(100_000)); }";
    assert_eq!(said(&compile(Purpose::Linker, scratch.path(), source, &["-O", "-o", "deep"])), "Exited(0): ");
    let command = Sandbox::new(Purpose::Worker).command(&scratch.path().join("deep"));
    assert_eq!(said(&run(command, b"", PATIENCE, CAP).expect("it runs")), "Exited(0): 100000\n");
}

/// Runs native code, as a bug in the compiler would allow it.
#[test]
#[cfg(target_arch = "x86_64")]
fn code_beyond_the_rules_of_rust_gets_no_further() {
    let scratch = tempfile::tempdir().expect("a folder");
    let source = include_str!("hostile/native.rs");
    let ended = compile(Purpose::Linker, scratch.path(), source, &["-O", "-o", "native"]);
    assert_eq!(said(&ended), "Exited(0): ");
    for purpose in [Purpose::Worker, Purpose::Reader] {
        let sandbox = Sandbox::new(purpose);
        let command = sandbox.command(&scratch.path().join("native"));
        assert_eq!(said(&run(command, b"", PATIENCE, CAP).expect("it runs")), "Exited(0): tried\n");
        let mut command = sandbox.command(&scratch.path().join("native"));
        command.arg("other-architecture");
        // Signal 31 is SIGSYS.
        assert_eq!(said(&run(command, b"", PATIENCE, CAP).expect("it runs")), "Signalled(31): ");
    }
}
