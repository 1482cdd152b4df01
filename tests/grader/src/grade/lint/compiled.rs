//! Leaves out items that are compiled only for tests.

use super::{is, plain};
use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Returns the tokens of a file without its items under `#[cfg(test)]`. Only items at the top level are left out: a macro may
/// give other tokens another meaning.
pub(super) fn compiled(tokens: TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut kept = Vec::new();
    let mut index = 0;
    while index < tokens.len() {
        let rest = &tokens[index..];
        match is_test_attribute(rest).then(|| item_length(&rest[2..])).flatten() {
            Some(length) => index += 2 + length,
            None => {
                kept.push(tokens[index].clone());
                index += 1;
            }
        }
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

/// Returns the number of tokens of the item at the beginning, up to its `;` or its `{…}`; `None` if it is no item.
fn item_length(tokens: &[TokenTree]) -> Option<usize> {
    const ITEMS: [&str; 10] =
        ["mod", "fn", "use", "impl", "struct", "enum", "const", "static", "trait", "type"];
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        token => is(Some(token), ';'),
    };
    let end = tokens.iter().position(is_end)?;
    let names_an_item =
        |token: &TokenTree| matches!(token, TokenTree::Ident(word) if ITEMS.contains(&plain(word).as_str()));
    tokens[..end].iter().any(names_an_item).then_some(end + 1)
}
