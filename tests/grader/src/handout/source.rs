//! The student's part of the tool: its source without what the feature `author` gates, and without modules that nothing
//! names then.

use anyhow::{Context, Result, anyhow, bail};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Where the tool's source is.
const FOLDER: &str = "tests/grader/src";

/// What stands before that which is not handed out, and before what takes its place.
const AUTHOR: &str = "cfg(feature=\"author\")";
const STUDENT: &str = "cfg(not(feature=\"author\"))";

/// The files of the tool, by their paths.
pub(super) fn tool(root: &Path) -> Result<BTreeMap<String, String>> {
    let mut files = BTreeMap::new();
    for start in ["main.rs", "lib.rs"] {
        follow(root, &Path::new(FOLDER).join(start), Path::new(FOLDER), &mut files)?;
    }
    Ok(files)
}

/// Takes a file, what it includes and the modules that it names; `inside` is the folder in which they are.
fn follow(root: &Path, file: &Path, inside: &Path, files: &mut BTreeMap<String, String>) -> Result<()> {
    let shown = file.display().to_string();
    let text = cut(&super::text(root, &shown)?).with_context(|| shown.clone())?;
    for item in syn::parse_file(&text).with_context(|| shown.clone())?.items {
        let syn::Item::Mod(module) = item else { continue };
        if module.content.is_some() {
            continue;
        }
        let name = module.ident.to_string();
        let elsewhere = module.attrs.iter().find_map(path_of);
        let candidates = match &elsewhere {
            Some(path) => vec![file.with_file_name(path)],
            None => vec![inside.join(format!("{name}.rs")), inside.join(&name).join("mod.rs")],
        };
        let found: Option<&PathBuf> = candidates.iter().find(|candidate| root.join(candidate).is_file());
        let found = found.with_context(|| format!("{shown}: no file for `mod {name}`"))?;
        follow(root, found, &inside.join(&name), files)?;
    }
    for part in text.split("include_str!(\"").skip(1) {
        let name = part.split('"').next().unwrap_or_default();
        let included = file.with_file_name(name).display().to_string();
        files.insert(included.clone(), super::text(root, &included)?);
    }
    files.insert(shown, text);
    Ok(())
}

/// `x.rs` of `#[path = "x.rs"]`.
fn path_of(attribute: &syn::Attribute) -> Option<String> {
    let syn::Meta::NameValue(meta) = &attribute.meta else { return None };
    match &meta.value {
        syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) if meta.path.is_ident("path") => {
            Some(text.value())
        }
        _ => None,
    }
}

/// Source without what is for authors, whole lines at a time.
fn cut(text: &str) -> Result<String> {
    let tokens: TokenStream = text.parse().map_err(|error| anyhow!("{error}"))?;
    let mut gone = BTreeSet::new();
    find(tokens, &mut gone)?;
    let lines: Vec<&str> = text.lines().collect();
    // A comment belongs to what is below it.
    for number in gone.clone() {
        let comments = (1..number).rev().take_while(|above| lines[above - 1].trim_start().starts_with("// "));
        gone.extend(comments.collect::<Vec<_>>());
    }
    let mut kept: Vec<String> = Vec::new();
    for (index, line) in lines.iter().enumerate().filter(|(index, _)| !gone.contains(&(index + 1))) {
        let follows_cut = gone.contains(&index);
        match kept.last_mut() {
            // Two blank lines, or braces with nothing between them.
            Some(last) if follows_cut && line.is_empty() && last.is_empty() => {}
            Some(last) if follows_cut && last.ends_with('{') && line.trim_start().starts_with('}') => {
                last.push_str(line.trim_start());
            }
            _ => kept.push((*line).to_owned()),
        }
    }
    Ok(kept.join("\n") + "\n")
}

/// Notes the lines of what is gated, and of the gates of what stays.
fn find(tokens: TokenStream, gone: &mut BTreeSet<usize>) -> Result<()> {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        let attributes = attributes(&tokens[at..]);
        let start = at;
        at += 2 * attributes.len();
        if attributes.iter().any(|(text, _)| text == AUTHOR) {
            let end = end_of(&tokens, at)?;
            gone.extend(line(&tokens[start])..=tokens[end].span().end().line);
            at = end + 1;
            continue;
        }
        attributes.into_iter().filter(|(text, _)| text == STUDENT).for_each(|(_, lines)| gone.extend(lines));
        if let Some(TokenTree::Group(group)) = tokens.get(at) {
            find(group.stream(), gone)?;
        }
        // An inner attribute has a `!`, so it is passed token by token.
        at += 1;
    }
    Ok(())
}

/// The attributes at the beginning, without spaces, and their lines.
fn attributes(tokens: &[TokenTree]) -> Vec<(String, RangeInclusive<usize>)> {
    let pairs = tokens.chunks_exact(2).map_while(|pair| match pair {
        [TokenTree::Punct(hash), TokenTree::Group(group)]
            if hash.as_char() == '#' && group.delimiter() == Delimiter::Bracket =>
        {
            let text = group.stream().to_string().replace(' ', "");
            Some((text, line(&pair[0])..=group.span().end().line))
        }
        _ => None,
    });
    pairs.collect()
}

fn line(token: &TokenTree) -> usize {
    token.span().start().line
}

/// Where that ends which begins at `at`: an item, a statement, a field, a variant or an arm. A comma ends what does not
/// begin as an item does; braces end all but `use`, `const` and `static`.
fn end_of(tokens: &[TokenTree], at: usize) -> Result<usize> {
    let word = |index: usize| tokens.get(index).map(ToString::to_string).unwrap_or_default();
    let first = if word(at) == "pub" { word(at + 1) } else { word(at) };
    let is_item = ["enum", "fn", "impl", "mod", "struct", "trait", "type"].contains(&first.as_str());
    let is_long = ["use", "const", "static", "let"].contains(&first.as_str());
    for (index, token) in tokens.iter().enumerate().skip(at) {
        match token {
            TokenTree::Punct(mark) if mark.as_char() == ';' => return Ok(index),
            TokenTree::Punct(mark) if mark.as_char() == ',' && !is_item && !is_long => return Ok(index),
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace && !is_long => {
                return Ok(if word(index + 1) == "," { index + 1 } else { index });
            }
            _ => {}
        }
    }
    bail!("what begins in line {} with `{}` has no end", tokens.get(at).map_or(0, line), word(at))
}

#[cfg(test)]
mod tests {
    use super::cut;

    #[test]
    fn what_is_gated_goes_with_its_documentation_and_gates_of_what_stays_go_alone() {
        let source = r#"//! A tool.

#[cfg(feature = "author")]
use a::{b, c};
use d::e;

/// What to do.
enum Command {
    /// Stays.
    Stay(Options),
    /// Goes.
    #[cfg(feature = "author")]
    #[cfg(target_os = "linux")]
    Go {
        /// A flag.
        flag: bool,
    },
    /// Stays, with less.
    List {
        /// Goes.
        #[cfg(feature = "author")]
        #[arg(long)]
        cases: bool,
    },
}

// Gone as well.
#[cfg(feature = "author")]
const WORD: &str = "a";

#[cfg(not(feature = "author"))]
const WORD: &str = "b";

fn main() {
    // About the next line.
    #[cfg(feature = "author")]
    f(1, 2);
    match command {
        Command::Stay(options) => stay(&options),
        #[cfg(feature = "author")]
        Command::Go { flag } => return go(flag, 1),
        Command::List { .. } => {}
    }
}
"#;
        let expected = r#"//! A tool.

use d::e;

/// What to do.
enum Command {
    /// Stays.
    Stay(Options),
    /// Stays, with less.
    List {},
}

const WORD: &str = "b";

fn main() {
    match command {
        Command::Stay(options) => stay(&options),
        Command::List { .. } => {}
    }
}
"#;
        assert_eq!(cut(source).unwrap(), expected);
    }
}
