//! The table of the lectures names every function of the exercises, and commands that work.

use super::program_runs::{is_understood, printed, raykata, root};
use raykata::kit::Function;
use std::process::{Command, Output};

/// The rows of the table: their names and commands.
fn rows() -> Vec<(String, String)> {
    let named = |line: &&str| line.starts_with("| ") && !line.starts_with("| row");
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [name, _, _, command] = cells[..] else { panic!("four cells: {line}") };
        (name.to_owned(), command.trim_matches('`').to_owned())
    };
    table().lines().filter(named).map(row).collect()
}

fn table() -> String {
    std::fs::read_to_string(root().join("slides/curriculum.md")).expect("the table")
}

/// Runs a command of the table.
fn run(command: &str) -> Output {
    match command.strip_prefix("cargo ") {
        Some(arguments) => {
            let mut cargo = Command::new(env!("CARGO"));
            cargo.current_dir(root()).args(arguments.split_whitespace()).output().expect("cargo starts")
        }
        None => raykata(command),
    }
}

#[test]
fn the_table_names_every_system_and_every_function_of_the_exercises() {
    let rows: Vec<String> = rows().into_iter().map(|(name, _)| name).collect();
    let systems = [('R', 10), ('X', 15), ('M', 8), ('C', 12)];
    let expected = systems.iter().flat_map(|&(part, n)| (1..=n).map(move |row| format!("{part}{row}")));
    assert_eq!(rows, expected.collect::<Vec<_>>());
    let table = table();
    let missing = Function::ALL.iter().map(|one| format!("`{}::{}`", one.file(), one.name()));
    assert_eq!(missing.filter(|name| !table.contains(name)).collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn the_commands_of_the_table_are_understood() {
    for (row, command) in rows().iter().filter(|(_, command)| !command.starts_with("cargo ")) {
        is_understood(row, command);
    }
}

/// Runs all commands. This takes minutes, so it runs only with `CI_LONG=1`.
#[test]
fn the_commands_of_the_table_work() {
    if std::env::var_os("CI_LONG").is_none() {
        return println!("run only with CI_LONG=1");
    }
    for (row, command) in rows() {
        let output = run(&command);
        assert!(output.status.success(), "{row}: {command}\n{}", printed(&output).1);
    }
}
