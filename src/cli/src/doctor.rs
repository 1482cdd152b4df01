//! `raykata doctor`: looks for what the kit needs on this machine, and says what to install.

use crate::args::{Given, Spec};
use crate::half_blocks::Look;
use crate::kits::root;
use crate::program::exit_code;
use crate::report::Bytes;
use anyhow::Result;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// `raykata doctor`.
pub static SPEC: Spec = Spec {
    name: "raykata doctor",
    about: "Look for compiler, linker, disk space, terminal and browser, and say what to install.",
    arguments: &[],
    options: &[],
};

/// The disk space that the builds of all commands take.
const DISK: u64 = 6 << 30;

/// What was found.
#[derive(Clone, Debug, PartialEq)]
enum Finding {
    /// It is there, with these details.
    Good(String),
    /// It is missing or too old, but only some commands need it: what is wrong, and what to do.
    Optional(String, String),
    /// It is missing or too old, and nothing works without it: what is wrong, and what to do.
    Needed(String, String),
}

fn good(what: impl Into<String>) -> Finding {
    Finding::Good(what.into())
}

fn optional(what: impl Into<String>, help: impl Into<String>) -> Finding {
    Finding::Optional(what.into(), help.into())
}

fn needed(what: impl Into<String>, help: impl Into<String>) -> Finding {
    Finding::Needed(what.into(), help.into())
}

/// Prints what was found. It succeeds if nothing that is needed is missing.
pub fn run(_: &Given) -> Result<ExitCode> {
    let root = root().ok();
    let findings = [
        ("kit", kit(root.as_deref())),
        ("compiler", compiler(said("rustc", &["--version"]).as_deref(), needed_rust())),
        ("formatter", formatter()),
        ("linker", linker()),
        ("disk", disk(root.as_deref().unwrap_or(Path::new(".")))),
        ("terminal", terminal()),
        ("editor", editor()),
        ("browser", browser()),
        ("Node.js", node()),
    ];
    for (name, finding) in &findings {
        match finding {
            Finding::Good(what) => println!("ok        {name:<10} {what}"),
            Finding::Optional(what, help) => println!("optional  {name:<10} {what}\n{:21}{help}", ""),
            Finding::Needed(what, help) => println!("MISSING   {name:<10} {what}\n{:21}{help}", ""),
        }
    }
    let missing = findings.iter().filter(|(_, finding)| matches!(finding, Finding::Needed(..))).count();
    match missing {
        0 => println!("\nEverything that the kit needs is there. `cargo run` shows the next step."),
        _ => println!("\n{missing} missing: install what is named above, and run this again."),
    }
    Ok(exit_code(missing == 0))
}

/// What a program writes to standard output, if it can be started and succeeds.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).stdin(Stdio::null()).stderr(Stdio::null()).output();
    let output = output.ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The path of a program in `PATH`.
fn find(program: &str) -> Option<PathBuf> {
    let name = format!("{program}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&std::env::var_os("PATH")?)
        .map(|folder| folder.join(&name))
        .find(|file| file.is_file())
}

/// The text for this system.
fn for_system(linux: &str, macos: &str, windows: &str) -> String {
    match std::env::consts::OS {
        "macos" => macos,
        "windows" => windows,
        _ => linux,
    }
    .to_owned()
}

fn kit(root: Option<&Path>) -> Finding {
    match root {
        Some(root) => good(root.display().to_string()),
        None => {
            needed("there is no kit in this folder or above it", "go to the folder that holds exercises/")
        }
    }
}

/// The oldest Rust that compiles the kit, as two numbers.
fn needed_rust() -> (u32, u32) {
    version(env!("CARGO_PKG_RUST_VERSION")).unwrap_or_default()
}

/// The first two numbers of a version, such as 1.89 in `rustc 1.89.0 (29483883e 2025-08-04)`.
fn version(text: &str) -> Option<(u32, u32)> {
    let word = text.split_whitespace().find(|word| word.starts_with(|sign: char| sign.is_ascii_digit()))?;
    let mut numbers = word.split('.').map(str::parse);
    Some((numbers.next()?.ok()?, numbers.next()?.ok()?))
}

fn compiler(said: Option<&str>, oldest: (u32, u32)) -> Finding {
    let help = |words: &str| format!("{words} (https://rustup.rs explains it)");
    match said.map(|said| (said, version(said))) {
        None => needed("there is no rustc", help("install Rust with rustup")),
        Some((said, Some(found))) if found >= oldest => good(said.to_owned()),
        Some((said, _)) => needed(
            format!("{said} is too old: the kit needs {}.{}", oldest.0, oldest.1),
            help("run `rustup update`"),
        ),
    }
}

fn formatter() -> Finding {
    let said = said("cargo", &["fmt", "--version"]);
    said.map_or_else(|| optional("there is no rustfmt", "run `rustup component add rustfmt`"), good)
}

fn linker() -> Finding {
    let names: &[&str] = if cfg!(windows) { &["link", "lld-link"] } else { &["cc", "clang", "gcc"] };
    match names.iter().find_map(|name| find(name)) {
        Some(file) => good(file.display().to_string()),
        // On Windows the compiler finds the linker without `PATH`.
        None if cfg!(windows) => optional(
            "there is none in PATH; the compiler may find it",
            "if builds fail: the Build Tools for Visual Studio",
        ),
        None => needed(
            "there is no C compiler, which links programs",
            for_system("sudo apt install build-essential (Fedora: dnf: gcc)", "xcode-select --install", ""),
        ),
    }
}

fn disk(folder: &Path) -> Finding {
    // The standard library does not say how much is free, and `df` does on every Unix.
    let table = said("df", &["-Pk", &folder.display().to_string()]);
    match table.as_deref().and_then(free_in) {
        None => optional("the free space is unknown", format!("all commands together need {}", Bytes(DISK))),
        Some(free) if free >= DISK => good(format!("{} free", Bytes(free))),
        Some(free) => optional(
            format!("only {} free; all builds take {}", Bytes(free), Bytes(DISK)),
            "free some space; `cargo clean` removes the builds of this kit",
        ),
    }
}

/// The free bytes in the table of `df -Pk`.
fn free_in(table: &str) -> Option<u64> {
    let row = table.lines().nth(1)?;
    // The name of the file system may contain spaces; the fourth number from the right may not.
    let columns: Vec<&str> = row.split_whitespace().collect();
    let share = columns.iter().position(|column| column.ends_with('%'))?;
    columns.get(share.checked_sub(1)?)?.parse::<u64>().ok().map(|blocks| blocks << 10)
}

/// The advice to set a variable of the environment, in the language of the system's shell.
fn set(why: &str, name: &str, value: &str) -> String {
    let sh = format!("{why} `export {name}={value}`");
    for_system(&sh, &sh, &format!("{why} `$env:{name} = \"{value}\"`"))
}

fn terminal() -> Finding {
    if !std::io::stdout().is_terminal() {
        return optional("the output is no terminal", "`raykata watch` prints lines there, and no screen");
    }
    let look = Look::of_environment();
    match (look.has_unicode, look.has_true_colour) {
        (true, true) => good("Unicode and 24-bit colours"),
        (true, false) => optional(
            "it names no 24-bit colours: pictures have 216 colours",
            set("if it has them, run", "COLORTERM", "truecolor"),
        ),
        (false, _) => {
            optional("it names no Unicode: `watch` writes ASCII", set("if it has it, run", "LANG", "C.UTF-8"))
        }
    }
}

fn editor() -> Finding {
    let mut chosen = ["VISUAL", "EDITOR"].iter().filter_map(|name| std::env::var(name).ok());
    match chosen.find(|editor| !editor.is_empty()) {
        Some(editor) => good(editor),
        None => optional(
            "none is chosen for the key `o` of `raykata watch`",
            set("for example", "EDITOR", if cfg!(windows) { "code" } else { "nano" }),
        ),
    }
}

fn browser() -> Finding {
    let programs = ["chromium", "google-chrome", "firefox", "microsoft-edge", "brave-browser", "xdg-open"];
    let found = programs.iter().find_map(|name| find(name)).map(|file| file.display().to_string());
    // These systems always have one.
    let found =
        found.or_else(|| (cfg!(windows) || cfg!(target_os = "macos")).then(|| "that of the system".into()));
    let none =
        || optional("there is none for `raykata view`, reports and slides", "sudo apt install firefox");
    found.map_or_else(none, good)
}

fn node() -> Finding {
    match said("node", &["--version"]) {
        Some(version) => good(version),
        None => optional(
            "there is none; only `raykata slides` needs it",
            for_system(
                "sudo apt install nodejs npm   (or see https://nodejs.org)",
                "brew install node   (or see https://nodejs.org)",
                "winget install OpenJS.NodeJS   (or see https://nodejs.org)",
            ),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_old_or_missing_compiler_is_named() {
        let good = "rustc 1.89.0 (29483883e 2025-08-04)";
        assert_eq!(compiler(Some(good), (1, 89)), Finding::Good(good.into()));
        assert!(matches!(compiler(Some("rustc 2.0.0-nightly"), (1, 89)), Finding::Good(_)));
        for said in [None, Some("rustc 1.88.0 (6b00bc388 2025-06-23)"), Some("rustc of another kind")] {
            assert!(matches!(compiler(said, (1, 89)), Finding::Needed(..)), "{said:?}");
        }
        assert!(needed_rust() >= (1, 89));
    }

    #[test]
    fn the_free_space_is_read_also_after_names_with_spaces() {
        let head = "Filesystem     1024-blocks      Used Available Capacity Mounted on\n";
        let row = "/dev/vda1        264107136  44000000 206000000      18% /\n";
        assert_eq!(free_in(&format!("{head}{row}")), Some(206_000_000 << 10));
        let row = "map auto home            100        40        60      40% /System/Volumes/Data home\n";
        assert_eq!(free_in(&format!("{head}{row}")), Some(60 << 10));
        assert_eq!(free_in(head), None);
        assert_eq!(free_in("one line\nand another line\n"), None);
    }
}
