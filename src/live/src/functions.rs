//! The functions of an exercise file. They are found by the layout that the formatter gives them: a function begins with
//! `pub fn` and ends with `}`, both at the beginning of a line.

use anyhow::{Context, Result, anyhow, bail};
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::Path;

/// The functions of the exercises before they are written, by file (without its extension) and name.
pub type Stubs = BTreeMap<String, BTreeMap<String, String>>;

/// Reads the functions that `root` hands out, from `tests/stubs.toml`.
pub fn stubs(root: &Path) -> Result<Stubs> {
    let file = root.join("tests/stubs.toml");
    let text = fs::read_to_string(&file).with_context(|| format!("{} cannot be read", file.display()))?;
    toml::from_str(&text).with_context(|| format!("{} is malformed", file.display()))
}

/// The name of the function that begins in this line.
#[must_use]
pub fn name_in(line: &str) -> Option<&str> {
    let head = line.strip_prefix("pub fn ")?;
    let end = head.find(|sign: char| !sign.is_ascii_alphanumeric() && sign != '_')?;
    Some(&head[..end])
}

/// The lines of the function `name`, without its doc comment.
/// An error if there is no such function, or if its end is not sure.
pub fn span(lines: &[&str], name: &str) -> Result<Range<usize>> {
    let begin = lines.iter().position(|line| name_in(line) == Some(name));
    let begin = begin.ok_or_else(|| anyhow!("there is no `pub fn {name}` at the beginning of a line"))?;
    let ends = |line: &&str| line.trim_end() == "}";
    // An item that begins before the end belongs to something else.
    let is_item = |line: &&str| {
        ["pub ", "fn ", "///", "impl ", "struct ", "#["].iter().any(|head| line.starts_with(head))
    };
    let body = &lines[begin + 1..];
    match (body.iter().position(ends), body.iter().position(is_item)) {
        (Some(end), item) if item.is_none_or(|item| end < item) => Ok(begin..begin + end + 2),
        _ => bail!("the end of `{name}` is not found: it is a `}}` at the beginning of a line"),
    }
}

/// The lines of the function `name` with the doc comment and the attributes above it.
pub fn documented_span(lines: &[&str], name: &str) -> Result<Range<usize>> {
    let function = span(lines, name)?;
    let is_above = |line: &&&str| line.starts_with("///") || line.starts_with("#[");
    let above = lines[..function.start].iter().rev().take_while(is_above).count();
    Ok(function.start - above..function.end)
}

/// The text of `lines` with `new` in place of those in `range`.
#[must_use]
pub fn replaced(lines: &[&str], range: Range<usize>, new: &str) -> String {
    lines[..range.start].iter().chain([&new]).chain(&lines[range.end..]).copied().collect()
}
