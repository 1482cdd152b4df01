//! Brings a new version of an exercise file into a student's file. What the student has written stays as it is.

use anyhow::Result;
use live::functions::{documented_span, name_in, replaced, span};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The functions of a file before they are written, by name.
pub type StubsOfFile = BTreeMap<String, String>;

/// A student's file with what is new in the kit.
#[derive(Debug, Default, PartialEq)]
pub struct Merged {
    pub text: String,
    /// The functions that the student has written.
    pub kept: Vec<String>,
    /// The functions that were added.
    pub added: Vec<String>,
    /// What the student has to look at.
    pub notes: Vec<String>,
}

/// Brings the file `new`, in which no function is written, into `yours`. The functions of the two kits before they were written are
/// `old_stubs` and `new_stubs`.
pub fn merge(yours: &str, old_stubs: &StubsOfFile, new: &str, new_stubs: &StubsOfFile) -> Result<Merged> {
    // Take the new file as a whole if nothing of the student's is in it.
    let given = beside_unwritten(new, new_stubs).unwrap_or_default();
    if beside_unwritten(yours, old_stubs).is_some_and(|beside| beside.is_empty() || beside == given) {
        let added = new_stubs.keys().filter(|name| !old_stubs.contains_key(*name)).cloned().collect();
        return Ok(Merged { text: new.to_owned(), added, ..Merged::default() });
    }
    let mut merged = Merged { text: yours.to_owned(), ..Merged::default() };
    let mut needs_imports = false;
    let new_lines: Vec<&str> = new.split_inclusive('\n').collect();
    for name in new_lines.iter().filter_map(|line| name_in(line)) {
        let block = new_lines[documented_span(&new_lines, name)?].concat();
        let text = merged.text.clone();
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        // Add a function that the file lacks.
        if !lines.iter().any(|line| name_in(line) == Some(name)) {
            let end = if text.ends_with('\n') { "" } else { "\n" };
            merged.text += &format!("{end}\n{block}");
            merged.added.push(name.to_owned());
            needs_imports = true;
            continue;
        }
        let old_stub = old_stubs.get(name);
        let is_unwritten = span(&lines, name)
            .is_ok_and(|function| old_stub.is_some_and(|stub| same(stub, &lines[function].concat())));
        if is_unwritten {
            // Replace a function that is not written yet, with its doc comment.
            let place = documented_span(&lines, name)?;
            merged.text = replaced(&lines, place, &block);
            needs_imports |= !old_stub.is_some_and(|stub| block.contains(stub.as_str()));
        } else {
            // Leave a function that is written, and say if it no longer fits.
            merged.kept.push(name.to_owned());
            let [before, after] =
                [old_stub, new_stubs.get(name)].map(|stub| stub.map(|stub| signature(stub)));
            if let (Some(before), Some(after)) = (before, after)
                && before != after
            {
                merged.notes.push(format!("`{name}` has another signature now: `{after}`"));
            }
        }
    }
    let gone = old_stubs.keys().filter(|name| !new_stubs.contains_key(*name));
    let in_yours = |name: &&String| yours.lines().any(|line| name_in(line) == Some(name));
    merged
        .notes
        .extend(gone.filter(in_yours).map(|name| format!("`{name}` is no exercise any more; it is kept")));
    if let Some(line) = given.iter().find(|given| !yours.lines().any(|line| line.trim() == *given)) {
        merged.notes.push(format!("the new file has the line `{line}`, and yours does not"));
    }
    if needs_imports {
        import(&mut merged, new);
    }
    Ok(merged)
}

/// The lines of code beside functions and imports, such as types that are given; `None` if a function is written.
pub fn beside_unwritten(text: &str, stubs: &StubsOfFile) -> Option<Vec<String>> {
    let mut rest = text.to_owned();
    for (name, stub) in stubs {
        let lines: Vec<&str> = rest.split_inclusive('\n').collect();
        let function = span(&lines, name).ok()?;
        if !same(stub, &lines[function].concat()) {
            return None;
        }
        rest = replaced(&lines, documented_span(&lines, name).ok()?, "");
    }
    for statement in imports(&rest).into_iter().rev() {
        rest.replace_range(statement, "");
    }
    let lines = rest.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//"));
    Some(lines.map(str::to_owned).collect())
}

/// Whether two texts are equal except for white space.
fn same(a: &str, b: &str) -> bool {
    a.split_whitespace().eq(b.split_whitespace())
}

/// The head of a function on one line, without the brace.
fn signature(function: &str) -> String {
    let head = function.split("{\n").next().unwrap_or(function);
    head.split_whitespace().collect::<Vec<_>>().join(" ").replace("( ", "(").replace(", )", ")")
}

/// Where the `use` statements at the beginning of a line stand, with the ends of their lines.
fn imports(text: &str) -> Vec<Range<usize>> {
    let begins = text.match_indices("use ").filter(|(at, _)| *at == 0 || text[..*at].ends_with('\n'));
    begins.filter_map(|(at, _)| text[at..].find(";\n").map(|end| at..at + end + 2)).collect()
}

/// The paths that a file imports, one by one.
fn imported(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for statement in imports(text) {
        let tree = text[statement].trim_start_matches("use ").trim_end().trim_end_matches(';');
        expand("", tree.trim(), &mut found);
    }
    found
}

/// Adds the paths of `tree` below `before`, such as `a::b` and `a::c` of `a::{b, c}`.
fn expand(before: &str, tree: &str, found: &mut Vec<String>) {
    let Some((head, inside)) =
        tree.split_once('{').and_then(|(head, rest)| Some((head, rest.strip_suffix('}')?)))
    else {
        return found.push(format!("{before}{tree}"));
    };
    // Divide at the commas that stand in no inner braces.
    let (mut depth, mut start) = (0_i32, 0);
    for (at, sign) in inside.char_indices().chain([(inside.len(), ',')]) {
        match sign {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                let part = inside[start..at].trim();
                if !part.is_empty() {
                    expand(&format!("{before}{head}"), part, found);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// The name that an import gives to what it brings in.
fn name_of(path: &str) -> &str {
    path.rsplit([':', ' ']).next().unwrap_or(path)
}

/// Adds the imports of `new` that the file lacks, after its last import.
fn import(merged: &mut Merged, new: &str) {
    let here: BTreeSet<String> = imported(&merged.text).into_iter().collect();
    let mut lines = String::new();
    for path in imported(new).into_iter().filter(|path| !here.contains(path)) {
        if here.iter().any(|other| name_of(other) == name_of(&path)) {
            merged.notes.push(format!(
                "new functions need `use {path};`, but the file has another `{}`",
                name_of(&path)
            ));
        } else {
            lines += &format!("use {path};\n");
        }
    }
    let place = imports(&merged.text).pop().map(|last| last.end).unwrap_or_else(|| {
        // Without imports they stand after the comment at the top of the file.
        merged.text.split_inclusive('\n').take_while(|line| line.starts_with("//!")).map(str::len).sum()
    });
    merged.text.insert_str(place, &lines);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stubs(functions: &[(&str, &str)]) -> StubsOfFile {
        functions.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    }

    const ONE: &str = "pub fn one(a: f32) -> f32 {\n    todo!(\"the first\")\n}\n";
    const TWO: &str = "pub fn two() -> f32 {\n    todo!(\"the second\")\n}\n";
    const NEW_TWO: &str = "pub fn two(\n    v: Vec3,\n) -> f32 {\n    todo!(\"the second\")\n}\n";
    const THREE: &str = "pub fn three(v: Vec2) -> Vec3 {\n    todo!(\"the third\")\n}\n";

    fn old() -> (String, StubsOfFile) {
        let text = format!("//! Stage.\n\nuse glam::Vec3;\n\n/// One.\n{ONE}\n/// Two.\n{TWO}");
        (text, stubs(&[("one", ONE), ("two", TWO)]))
    }

    fn new() -> (String, StubsOfFile) {
        let text = format!(
            "//! Stage, better.\n\nuse glam::{{Vec2, Vec3}};\nuse raykata::{{\n    a::{{B, C as D}},\n    e,\n}};\n\n/// \
             One, better.\n{ONE}\n/// Two.\n{NEW_TWO}\n/// Three.\n#[must_use]\n{THREE}"
        );
        (text, stubs(&[("one", ONE), ("two", NEW_TWO), ("three", THREE)]))
    }

    #[test]
    fn an_untouched_file_becomes_the_new_one() {
        let ((old, old_stubs), (new, new_stubs)) = (old(), new());
        let merged = merge(&old, &old_stubs, &new, &new_stubs).unwrap();
        assert_eq!(merged.text, new);
        assert_eq!((merged.kept.len(), merged.added), (0, vec!["three".to_owned()]));
    }

    #[test]
    fn written_functions_and_helpers_stay_and_the_rest_is_new() {
        let ((old, old_stubs), (new, new_stubs)) = (old(), new());
        let written = old.replace("todo!(\"the second\")", "half(2.0)")
            + "\nfn half(a: f32) -> f32 {\n    a / 2.0\n}\n";
        let merged = merge(&written, &old_stubs, &new, &new_stubs).unwrap();
        let expected = format!(
            "//! Stage.\n\nuse glam::Vec3;\nuse glam::Vec2;\nuse raykata::a::B;\nuse raykata::a::C as D;\nuse raykata::e;\n\n/// \
             One, better.\n{ONE}\n/// Two.\n{}\nfn half(a: f32) -> f32 {{\n    a / 2.0\n}}\n\n/// \
             Three.\n#[must_use]\n{THREE}",
            TWO.replace("todo!(\"the second\")", "half(2.0)")
        );
        assert_eq!(merged.text, expected);
        assert_eq!(merged.kept, ["two"]);
        assert_eq!(merged.added, ["three"]);
        assert_eq!(merged.notes, ["`two` has another signature now: `pub fn two(v: Vec3) -> f32`"]);
        // A second update changes nothing.
        let again = merge(&merged.text, &new_stubs, &new, &new_stubs).unwrap();
        assert_eq!((again.text, again.added.len(), again.notes.len()), (merged.text, 0, 0));
    }

    #[test]
    fn a_function_that_is_no_exercise_any_more_stays() {
        let ((old, old_stubs), (new, new_stubs)) = (old(), new());
        let written = new.replace("todo!(\"the third\")", "v.extend(0.0)");
        let merged = merge(&written, &new_stubs, &old, &old_stubs).unwrap();
        assert!(merged.text.contains("v.extend(0.0)"));
        assert_eq!(merged.notes, ["`three` is no exercise any more; it is kept"]);
    }

    #[test]
    fn a_name_that_is_imported_from_elsewhere_is_left_to_the_student() {
        let ((old, old_stubs), (new, new_stubs)) = (old(), new());
        let written = old
            .replace("use glam::Vec3;\n", "use glam::Vec3;\nuse mine::Vec2;\n")
            .replace("todo!(\"the first\")", "a");
        let merged = merge(&written, &old_stubs, &new, &new_stubs).unwrap();
        assert_eq!(merged.notes, ["new functions need `use glam::Vec2;`, but the file has another `Vec2`"]);
        assert!(!merged.text.contains("use glam::Vec2;"));
    }

    #[test]
    fn lines_beside_unwritten_functions_are_code() {
        let (old, stubs) = old();
        let beside = |text: &str| beside_unwritten(text, &stubs);
        assert_eq!(beside(&old), Some(vec![]));
        assert_eq!(beside(&old.replace("\n\n", "\n\n\n")), Some(vec![]));
        assert_eq!(beside(&old.replace("pub fn one", "#[inline]\npub fn one")), Some(vec![]));
        let line = "const A: f32 = 1.0;";
        assert_eq!(beside(&format!("{old}{line}\n")), Some(vec![line.to_owned()]));
        assert_eq!(beside(&old.replace("todo!(\"the first\")", "a")), None);
        assert_eq!(beside(&old.replace("pub fn one", "fn one")), None);
    }

    #[test]
    fn code_that_is_given_is_no_work_of_the_student() {
        let ((old, old_stubs), (new, new_stubs)) = (old(), new());
        let [old, new] = [old, new].map(|text| text + "\n/// Given.\npub const A: f32 = 1.0;\n");
        assert_eq!(merge(&old, &old_stubs, &new, &new_stubs).unwrap().text, new);
        // If it changes, the student's text stays, and a note says so.
        let changed = new.replace("1.0", "2.0");
        let merged = merge(&old, &old_stubs, &changed, &new_stubs).unwrap();
        assert!(merged.text.contains("1.0;") && !merged.text.contains("2.0;"));
        assert_eq!(merged.notes, ["the new file has the line `pub const A: f32 = 2.0;`, and yours does not"]);
    }
}
