//! Leaves out items and statements that are compiled only for tests.

use super::{is, plain};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

/// Returns the tokens without items and statements under `#[cfg(test)]`, at any depth. The arguments and the definition of a
/// macro are left as they are: it may give them another meaning.
pub(super) fn compiled(tokens: TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut kept = Vec::new();
    let mut index = 0;
    while index < tokens.len() {
        let rest = &tokens[index..];
        if let Some(length) = is_test_attribute(rest).then(|| length(&rest[2..])).flatten() {
            index += 2 + length;
            continue;
        }
        kept.push(match &rest[0] {
            TokenTree::Group(group) if !is_of_macro(&tokens[..index]) => {
                let mut inside = Group::new(group.delimiter(), compiled(group.stream()));
                inside.set_span(group.span());
                inside.into()
            }
            token => token.clone(),
        });
        index += 1;
    }
    kept.into_iter().collect()
}

fn is_test_attribute(tokens: &[TokenTree]) -> bool {
    match tokens {
        [hash, TokenTree::Group(group), ..] if is(Some(hash), '#') => {
            group.delimiter() == Delimiter::Bracket && group.to_string().replace(' ', "") == "[cfg(test)]"
        }
        _ => false,
    }
}

/// Whether a group after these tokens belongs to `name! {…}` or `macro_rules! name {…}`.
fn is_of_macro(before: &[TokenTree]) -> bool {
    match before {
        [.., mark] if is(Some(mark), '!') => true,
        [.., TokenTree::Ident(word), mark, TokenTree::Ident(_)] => {
            word == "macro_rules" && is(Some(mark), '!')
        }
        _ => false,
    }
}

/// Returns the number of tokens of the item or statement at the beginning, up to its `;` or its `{…}`; `None` if it is neither,
/// but an arm, a field or an argument, which ends with a comma.
fn length(tokens: &[TokenTree]) -> Option<usize> {
    const BEFORE_ITEMS: [&str; 6] = ["pub", "async", "unsafe", "extern", "default", "const"];
    const WITH_BLOCK: [&str; 7] = ["mod", "fn", "impl", "struct", "enum", "union", "trait"];
    const WITHOUT: [&str; 4] = ["use", "let", "static", "type"];
    let words = tokens.iter().map_while(|token| match token {
        TokenTree::Ident(word) => Some(plain(word)),
        // Attributes, `pub(crate)` and `extern "C"`.
        TokenTree::Group(group) if group.delimiter() != Delimiter::Brace => Some("pub".into()),
        TokenTree::Literal(_) => Some("pub".into()),
        token => is(Some(token), '#').then(|| "pub".into()),
    });
    let words: Vec<String> = words.collect();
    let keyword = words.iter().find(|word| !BEFORE_ITEMS.contains(&word.as_str()));
    let begins_with = |of: &[&str]| keyword.is_some_and(|word| of.contains(&word.as_str()));
    let has_block = begins_with(&WITH_BLOCK);
    let is_item = has_block || begins_with(&WITHOUT) || words.iter().any(|word| word == "const");
    let is_block =
        |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
    let ends = |token: &TokenTree| {
        is(Some(token), ';')
            || has_block && is_block(token)
            || !is_item && (is(Some(token), ',') || is(Some(token), '>'))
    };
    if tokens.first().is_some_and(is_block) {
        return Some(1);
    }
    let end = tokens.iter().position(ends)?;
    (is_item || is(tokens.get(end), ';')).then_some(end + 1)
}
