//! Changes source files: finds the bodies of functions and replaces them.

use crate::corpus::source::{Function, Owner, Source, tokens};
use anyhow::{Context, Result, bail, ensure};

/// Returns the `pub fn` items at the top level of a file.
pub(super) fn functions(text: &str) -> Result<Vec<Function>> {
    let mut functions = Source::parse(text)?.functions;
    functions.retain(|function| function.is_public && function.owner == Owner::File);
    Ok(functions)
}

/// The return type of a function, as its tokens.
fn returns(text: &str, function: &Function) -> String {
    tokens(&text[function.inputs.end + 1..function.head.end]).replace(' ', "").replacen("->", "", 1)
}

/// Returns the file with the body of the function `name` replaced by `body(name, return type)`, or those of all functions for `*`.
pub(super) fn with_bodies(
    text: &str,
    name: &str,
    body: impl Fn(&str, &str) -> Result<String>,
) -> Result<String> {
    let mut changed = text.to_owned();
    let chosen = functions(text)?.into_iter().filter(|function| name == "*" || function.name == name);
    let chosen: Vec<Function> = chosen.collect();
    ensure!(!chosen.is_empty(), "there is no `pub fn {name}`");
    for function in chosen.iter().rev() {
        changed.replace_range(function.body.clone(), &body(&function.name, &returns(text, function))?);
    }
    Ok(changed)
}

/// Returns the body of the function of this name, with the braces.
pub(super) fn body_of<'a>(text: &'a str, name: &str) -> Result<&'a str> {
    let found = functions(text)?.into_iter().find(|function| function.name == name);
    Ok(&text[found.with_context(|| format!("there is no `pub fn {name}`"))?.body])
}

/// Returns a body whose answer no check accepts, for the function `name` with this return type.
pub(super) fn wrong_body(name: &str, returns: &str) -> Result<String> {
    match returns {
        "Option<f32>" => Ok("{ Some(-1.25) }".into()),
        "f32" => Ok("{ -1.25 }".into()),
        "Vec3" => Ok("{ Vec3::splat(-7.25) }".into()),
        other => bail!("there is no wrong answer for `{name}` of type {other}"),
    }
}

/// Returns the file with a text inserted before its first item, after the file's own doc comment.
pub(super) fn with_top(text: &str, top: &str) -> String {
    let head = |line: &&str| line.starts_with("//!") || line.starts_with("#![") || line.trim().is_empty();
    let end: usize = text.split_inclusive('\n').take_while(head).map(str::len).sum();
    format!("{}{top}\n{}", &text[..end], &text[end..])
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "//! About {.\n\nuse a::b;\n\n/// Not a brace: {\npub fn one(x: [f32; 2]) -> Option<f32> {\n    \
                        if x[0] > 1.0 { None } else { Some('{' as u32 as f32) }\n}\n\nfn hidden() -> Vec3 { todo!() }\n\
                        pub fn two() -> Vec3 { todo!(\"}\") }\n";

    #[test]
    fn bodies_are_found_whatever_stands_in_them() {
        let found = functions(FILE).unwrap();
        let short: Vec<_> = found.iter().map(|one| (one.name.as_str(), returns(FILE, one))).collect();
        assert_eq!(short, [("one", "Option<f32>".to_owned()), ("two", "Vec3".to_owned())]);
        assert_eq!(body_of(FILE, "two").unwrap(), "{ todo!(\"}\") }");
        assert!(body_of(FILE, "one").unwrap().starts_with("{\n    if x[0]"));
        assert!(body_of(FILE, "hidden").unwrap_err().to_string().contains("pub fn hidden"));
    }

    #[test]
    fn bodies_are_replaced_one_or_all() {
        let one = with_bodies(FILE, "two", |_, _| Ok("{ 2 }".into())).unwrap();
        assert!(one.contains("pub fn two() -> Vec3 { 2 }\n") && one.contains("x[0] > 1.0"));
        let all = with_bodies(FILE, "*", wrong_body).unwrap();
        assert!(all.contains("{ Some(-1.25) }") && all.contains("{ Vec3::splat(-7.25) }"));
        assert!(all.contains("fn hidden() -> Vec3 { todo!() }"));
        assert!(with_bodies(FILE, "three", wrong_body).unwrap_err().to_string().contains("pub fn three"));
    }

    #[test]
    fn the_top_is_behind_the_words_about_the_file() {
        assert!(with_top(FILE, "struct S;").starts_with("//! About {.\n\nstruct S;\nuse a::b;"));
        assert_eq!(with_top("fn f() {}", "struct S;"), "struct S;\nfn f() {}");
    }
}
