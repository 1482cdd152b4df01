//! Makes a copy of the kit in which all items are public, so that any function can answer an exercise.

use author::corpus::build_folder::{cut_manifest, write_if_new};
use grader::files_below::files_below;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use syn::{Item, Visibility};

/// The sections of manifests that the copy does not need: targets, and dependencies of tests.
const LEFT_OUT: [&str; 5] = ["dev-dependencies", "[test]", "[bin]", "[example]", "[bench]"];

/// Copies the folders of `root` that the reference and its checks need. Makes all items in the folders `open` public.
pub fn copy(root: &Path, to: &Path, open: &[String]) {
    for folder in ["src", "solutions/src", "tests/checks", "tests/judge", "tests/oracle", "tests/golden"] {
        copy_folder(root, to, folder, open);
    }
    for file in raykata::rubric::files().chain(["Cargo.lock", ".cargo/config.toml"]) {
        write(&to.join(file), &read(&root.join(file)));
    }
    // The test of the reference against its checks, as a program of its own.
    write(&to.join("solutions/tests/stages.rs"), &read(&root.join("solutions/tests/suite/stages.rs")));
    let members = ["solutions", "tests/checks", "tests/checks/all", "tests/checks/stage*", "tests/oracle"];
    write(&to.join("Cargo.toml"), &cut_manifest(&read(&root.join("Cargo.toml")), &LEFT_OUT, &members));
    let mut solutions = cut_manifest(&read(&root.join("solutions/Cargo.toml")), &LEFT_OUT, &[]);
    let mut needed = String::from("[dependencies]\n");
    for name in ["all-checks", "checks", "oracle"].map(str::to_owned).into_iter().chain(stages()) {
        needed += &format!("{name}.workspace = true\n");
    }
    solutions = solutions.replace("[dependencies]\n", &needed);
    write(&to.join("solutions/Cargo.toml"), &solutions);
}

fn stages() -> impl Iterator<Item = String> {
    (1..=12).map(|stage| format!("stage{stage}"))
}

/// Builds the checks with the reference. Returns the path of the program that runs them.
pub fn build(folder: &Path) -> String {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(folder)
        .args(["test", "--quiet", "--package", "solutions", "--test", "stages", "--no-run"])
        .args(["--message-format=json", "--target-dir", "target", "--config", "profile.dev.debug=false"])
        .stdin(Stdio::null())
        .output()
        .expect("cargo");
    let messages: Vec<serde_json::Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect();
    let errors = messages.iter().filter(|message| message["message"]["level"] == "error");
    let errors: Vec<&str> = errors.filter_map(|message| message["message"]["rendered"].as_str()).collect();
    assert!(output.status.success(), "{}\n{}", errors.join("\n"), String::from_utf8_lossy(&output.stderr));
    let program = messages.iter().find(|message| message["target"]["name"] == "stages");
    program.and_then(|program| program["executable"].as_str()).expect("a program").to_owned()
}

/// Returns whether the checks whose names contain `filter` pass with function number `paste` in place of an exercise; 0
/// means no function.
pub fn passes(program: &str, folder: &Path, filter: &str, paste: usize) -> bool {
    let status = Command::new(program)
        .current_dir(folder.join("solutions"))
        .args(["--quiet", filter])
        .env("PASTE", paste.to_string())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.expect("a program").success()
}

/// Puts `code` at the beginning of the body of a function.
pub fn insert(file: &Path, function: &str, code: &str) {
    let text = read(file);
    let syntax = syn::parse_file(&text).expect("Rust");
    let body = syntax.items.iter().find_map(|item| match item {
        Item::Fn(one) if one.sig.ident == function => {
            Some(one.block.brace_token.span.open().byte_range().end)
        }
        _ => None,
    });
    let body = body.unwrap_or_else(|| panic!("{} has no `{function}`", file.display()));
    write(file, &format!("{}{code}{}", &text[..body], &text[body..]));
}

/// Puts `code` at the end of a file.
pub fn append(file: &Path, code: &str) {
    write(file, &(read(file) + code));
}

fn copy_folder(root: &Path, to: &Path, folder: &str, open: &[String]) {
    let is_kept = |path: &str| path != "tests/checks/all/tests";
    for path in files_below(root, folder, &is_kept).unwrap_or_else(|error| panic!("{error:#}")) {
        let source = root.join(&path);
        if path.ends_with(".rs") {
            let text = read(&source);
            let is_open = open.iter().any(|folder| path.starts_with(&format!("{folder}/")));
            write(&to.join(&path), &if is_open { public(&text) } else { text });
        } else if path.ends_with("Cargo.toml") {
            write(&to.join(&path), &cut_manifest(&read(&source), &LEFT_OUT, &[]));
        } else {
            let target = to.join(&path);
            fs::create_dir_all(target.parent().expect("a folder")).expect("a folder");
            fs::copy(source, target).expect("a copy");
        }
    }
}

/// Returns the text with all items public.
fn public(text: &str) -> String {
    let syntax = syn::parse_file(text).expect("Rust");
    let mut changes = Vec::new();
    collect(&syntax.items, &mut changes);
    changes.sort_by_key(|(start, _)| *start);
    let mut changed = text.to_owned();
    for (start, end) in changes.into_iter().rev() {
        changed.replace_range(start..end, "pub ");
    }
    changed
}

/// Adds the ranges of the text where a visibility is replaced or inserted.
fn collect(items: &[Item], changes: &mut Vec<(usize, usize)>) {
    let mut change = |visibility: &Visibility, keyword: proc_macro2::Span| match visibility {
        Visibility::Public(_) => {}
        Visibility::Restricted(one) => {
            changes.push((one.pub_token.span.byte_range().start, keyword.byte_range().start));
        }
        Visibility::Inherited => changes.push((keyword.byte_range().start, keyword.byte_range().start)),
    };
    for item in items {
        match item {
            Item::Fn(one) => change(&one.vis, first(&one.sig)),
            Item::Mod(one) => change(&one.vis, one.mod_token.span),
            Item::Struct(one) => change(&one.vis, one.struct_token.span),
            Item::Enum(one) => change(&one.vis, one.enum_token.span),
            Item::Const(one) => change(&one.vis, one.const_token.span),
            Item::Static(one) => change(&one.vis, one.static_token.span),
            Item::Type(one) => change(&one.vis, one.type_token.span),
            Item::Trait(one) => change(&one.vis, one.trait_token.span),
            Item::Impl(block) if block.trait_.is_none() => {
                for item in &block.items {
                    match item {
                        syn::ImplItem::Fn(one) => change(&one.vis, first(&one.sig)),
                        syn::ImplItem::Const(one) => change(&one.vis, one.const_token.span),
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }
    for item in items {
        if let Item::Mod(one) = item
            && let Some((_, items)) = &one.content
        {
            collect(items, changes);
        }
    }
}

/// Returns the position of the signature's first keyword, such as `const` or `fn`.
fn first(signature: &syn::Signature) -> proc_macro2::Span {
    signature.constness.map_or(signature.fn_token.span, |token| token.span)
}

fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

fn write(file: &Path, text: &str) {
    write_if_new(file, text).unwrap_or_else(|error| panic!("{error:#}"));
}
