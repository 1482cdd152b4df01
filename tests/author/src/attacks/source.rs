//! Changes source files: finds the bodies of functions and replaces them.

use anyhow::{Context, Result, anyhow, bail, ensure};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::ops::Range;
use std::str::FromStr;

/// A public function.
#[derive(Debug, PartialEq)]
pub(super) struct Function {
    /// Its name.
    pub name: String,
    /// The byte range of its body, with the braces.
    pub body: Range<usize>,
    /// Its return type, as the compiler would print it.
    pub returns: String,
}

/// Returns the `pub fn` items at the top level of a file.
pub(super) fn functions(text: &str) -> Result<Vec<Function>> {
    let tokens = TokenStream::from_str(text).map_err(|error| anyhow!("it is not valid Rust: {error}"))?;
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is = |at: usize, word: &str| tokens.get(at).is_some_and(|token| token.to_string() == word);
    let mut functions = Vec::new();
    for at in 0..tokens.len() {
        if !(is(at, "pub") && is(at + 1, "fn")) {
            continue;
        }
        let (Some(name), rest) = (tokens.get(at + 2), &tokens[at + 3..]) else { continue };
        let body = rest.iter().enumerate().find_map(|(index, token)| match token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => Some((index, group)),
            _ => None,
        });
        let (index, body) = body.with_context(|| format!("{name} has no body"))?;
        let arrow = rest[..index]
            .windows(2)
            .position(|pair| pair[0].to_string() == "-" && pair[1].to_string() == ">");
        let returns = arrow.map_or(&[][..], |arrow| &rest[arrow + 2..index]);
        functions.push(Function {
            name: name.to_string(),
            body: body.span_open().byte_range().start..body.span_close().byte_range().end,
            returns: returns.iter().map(ToString::to_string).collect(),
        });
    }
    Ok(functions)
}

/// Returns the file with the body of the function `name` replaced by `body`, or those of all functions for `*`.
pub(super) fn with_bodies(
    text: &str,
    name: &str,
    body: impl Fn(&Function) -> Result<String>,
) -> Result<String> {
    let mut changed = text.to_owned();
    let chosen = functions(text)?.into_iter().filter(|function| name == "*" || function.name == name);
    let chosen: Vec<Function> = chosen.collect();
    ensure!(!chosen.is_empty(), "there is no `pub fn {name}`");
    for function in chosen.iter().rev() {
        changed.replace_range(function.body.clone(), &body(function)?);
    }
    Ok(changed)
}

/// Returns the body of the function of this name, with the braces.
pub(super) fn body_of<'a>(text: &'a str, name: &str) -> Result<&'a str> {
    let found = functions(text)?.into_iter().find(|function| function.name == name);
    Ok(&text[found.with_context(|| format!("there is no `pub fn {name}`"))?.body])
}

/// Returns a body whose answer no check accepts.
pub(super) fn wrong_body(function: &Function) -> Result<String> {
    match function.returns.as_str() {
        "Option<f32>" => Ok("{ Some(-1.25) }".into()),
        "f32" => Ok("{ -1.25 }".into()),
        "Vec3" => Ok("{ Vec3::splat(-7.25) }".into()),
        other => bail!("there is no wrong answer for `{}` of type {other}", function.name),
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
        let short: Vec<_> = found.iter().map(|one| (one.name.as_str(), one.returns.as_str())).collect();
        assert_eq!(short, [("one", "Option<f32>"), ("two", "Vec3")]);
        assert_eq!(body_of(FILE, "two").unwrap(), "{ todo!(\"}\") }");
        assert!(body_of(FILE, "one").unwrap().starts_with("{\n    if x[0]"));
        assert!(body_of(FILE, "hidden").unwrap_err().to_string().contains("pub fn hidden"));
    }

    #[test]
    fn bodies_are_replaced_one_or_all() {
        let one = with_bodies(FILE, "two", |_| Ok("{ 2 }".into())).unwrap();
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
