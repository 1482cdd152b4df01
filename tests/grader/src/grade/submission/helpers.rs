//! Modules that a student has added: files beside the exercises that `lib.rs` declares, and files in a folder with the name of
//! an exercise.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::str::FromStr;

/// Returns the modules of a submission, by their path in `exercises/src`. `files` are the Rust files that are no exercises, by
/// their path in the submission; `folder` is that of the exercises.
pub fn modules(
    files: &BTreeMap<String, String>,
    folder: &str,
    wanted: &[String],
) -> BTreeMap<String, String> {
    let inside: BTreeMap<&str, &String> =
        files.iter().filter_map(|(path, text)| Some((inside(path, folder)?, text))).collect();
    let declared = inside.get("lib.rs").map_or_else(Vec::new, |text| declarations(text));
    let is_module = |path: &str| {
        let top = path.split('/').next().unwrap_or(path);
        let stem = top.strip_suffix(".rs").unwrap_or(top);
        let of_exercise = wanted.iter().any(|wanted| wanted.strip_suffix(".rs") == Some(top));
        of_exercise || declared.iter().any(|name| name == stem)
    };
    let taken = inside.into_iter().filter(|(path, _)| is_module(path) && is_plain(path));
    taken.map(|(path, text)| (path.to_owned(), text.clone())).collect()
}

/// Returns the rest of a path in `folder`; the empty name stands for the top of the submission.
pub fn inside<'a>(path: &'a str, folder: &str) -> Option<&'a str> {
    match folder {
        "" => Some(path),
        _ => path.strip_prefix(folder)?.strip_prefix('/'),
    }
}

/// Returns the modules that a file declares by `mod name;` at its top level.
fn declarations(text: &str) -> Vec<String> {
    // The compiler never sees `lib.rs` of a submission, so one that is not valid Rust declares nothing.
    let tokens: Vec<TokenTree> = TokenStream::from_str(text).into_iter().flatten().collect();
    let declared = tokens.windows(3).filter_map(|three| match three {
        [TokenTree::Ident(word), TokenTree::Ident(name), TokenTree::Punct(end)]
            if word == "mod" && end.as_char() == ';' =>
        {
            Some(name.to_string())
        }
        _ => None,
    });
    declared.collect()
}

/// Returns the lines that declare the modules in `lib.rs`. Those in the folder of an exercise are declared there.
pub fn lines<'a>(files: impl Iterator<Item = &'a String>) -> String {
    let top = files.filter_map(|path| match path.split_once('/') {
        None => path.strip_suffix(".rs"),
        Some((top, "mod.rs")) => Some(top),
        Some(_) => None,
    });
    top.map(|name| format!("pub mod {name};\n")).collect()
}

/// Returns whether a path consists of names of modules, so that it stays in its folder.
fn is_plain(path: &str) -> bool {
    let is_name =
        |name: &str| !name.is_empty() && name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_');
    path.strip_suffix(".rs").is_some_and(|path| path.split('/').all(is_name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declared_modules_and_those_of_an_exercise_are_taken() {
        let text = |path: &str| (path.to_owned(), format!("// {path}"));
        let mut files: BTreeMap<String, String> = [
            "a/src/helper.rs",
            "a/src/stray.rs",
            "a/src/deep/mod.rs",
            "a/src/deep/er.rs",
            "a/src/stage1_shapes/roots.rs",
            "a/src/../etc.rs",
            "b/src/helper.rs",
        ]
        .map(text)
        .into();
        files.insert(
            "a/src/lib.rs".into(),
            "pub mod stage1_shapes;\n  mod helper;\npub(crate) mod deep ;\n".into(),
        );
        let taken = modules(&files, "a/src", &["stage1_shapes.rs".into()]);
        let paths: Vec<&str> = taken.keys().map(String::as_str).collect();
        assert_eq!(paths, ["deep/er.rs", "deep/mod.rs", "helper.rs", "stage1_shapes/roots.rs"]);
        assert_eq!(lines(taken.keys()), "pub mod deep;\npub mod helper;\n");
    }
}
