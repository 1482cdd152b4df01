//! The syntax check: lists constructs that no exercise needs, each with line and reason. The grader refuses files with some of
//! them, and `raykata check` warns in time.
//!
//! It gives early and clear messages but no security. Safe Rust can avoid it, and only the sandbox stops such code. The
//! check reads tokens instead of syntax trees, so that it also sees the contents of macros, but no words that a macro puts
//! together. It leaves out what stands under `#[cfg(test)]`, which is not compiled. The compiler reports files that are not valid
//! Rust.

mod compiled;
mod rules;

use compiled::compiled;
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use rules::{ATTRIBUTES, LEFT_TO_SANDBOX, LINTS, MACROS, MODULES, STDIN};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::str::FromStr;

/// A construct that no exercise needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// The name of the rule, as `--allow` takes it.
    pub rule: String,
    /// The line of the file, from 1.
    pub line: usize,
    /// The construct, and why it is refused.
    pub why: String,
}

impl Finding {
    /// Whether the file is graded all the same, because the sandbox stops the construct or its own function alone suffers.
    pub fn is_left_to_sandbox(&self) -> bool {
        LEFT_TO_SANDBOX.contains(&self.rule.as_str())
    }
}

/// The result of the syntax check of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// Whether the tokens of the file cannot be read, so that no rule was applied.
    pub is_unreadable: bool,
    /// The constructs that no exercise needs.
    pub findings: Vec<Finding>,
    /// Whether a function may store earlier questions between calls. Only statics and thread-local variables can, if the
    /// file has no findings.
    pub may_remember: bool,
}

/// Checks the text of a file. The findings are sorted by line.
pub fn read(text: &str) -> Reading {
    // The compiler explains unbalanced tokens better.
    let Ok(tokens) = TokenStream::from_str(text) else {
        return Reading { is_unreadable: true, findings: Vec::new(), may_remember: true };
    };
    let tokens = compiled(tokens);
    let mut search = Search { own: declared(tokens.clone()), findings: Vec::new() };
    search.look(tokens.clone(), false);
    let mut findings = search.findings;
    findings.sort_by_key(|finding| finding.line);
    findings.dedup();
    Reading { is_unreadable: false, findings, may_remember: keeps(tokens) }
}

/// Returns the names of the modules and types that the tokens declare.
fn declared(tokens: TokenStream) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut declares = false;
    for token in tokens {
        match &token {
            TokenTree::Ident(word) if declares => drop(names.insert(plain(word))),
            TokenTree::Group(group) => names.extend(declared(group.stream())),
            _ => {}
        }
        let keywords = ["mod", "struct", "enum", "trait", "type"];
        declares = matches!(&token, TokenTree::Ident(word) if keywords.contains(&word.to_string().as_str()));
    }
    names
}

/// Returns whether the tokens contain a static or a thread-local variable. `'static` is a lifetime and does not count.
fn keeps(tokens: TokenStream) -> bool {
    let mut after_tick = false;
    tokens.into_iter().any(|token| {
        let found = match &token {
            TokenTree::Ident(word) => {
                let word = plain(word);
                word == "thread_local" || word == "static" && !after_tick
            }
            TokenTree::Group(group) => keeps(group.stream()),
            _ => false,
        };
        after_tick = is(Some(&token), '\'');
        found
    })
}

/// A search for constructs that no exercise needs.
struct Search {
    /// Names of the file's own modules and types.
    own: BTreeSet<String>,
    findings: Vec<Finding>,
}

impl Search {
    /// Looks at tokens. `in_use` says whether they are in the braces of a `use` declaration.
    fn look(&mut self, tokens: TokenStream, mut in_use: bool) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        for (index, token) in tokens.iter().enumerate() {
            in_use = match token {
                TokenTree::Ident(word) if word == "use" => true,
                token => in_use && !is(Some(token), ';'),
            };
            let rest = &tokens[index + 1..];
            let line = token.span().start().line;
            let mut say = |rule: &str, what: String, why: &str| {
                self.findings.push(Finding { rule: rule.into(), line, why: format!("{what}: {why}") });
            };
            match token {
                TokenTree::Ident(word) => match plain(word).as_str() {
                    "unsafe" => say("unsafe", "`unsafe`".into(), "unsafe code is not part of any exercise"),
                    "extern" => say("linkage", "`extern`".into(), "an exercise must not call foreign code"),
                    "stdin" if in_use || is_empty_group(rest.first()) => {
                        say("input", "`stdin`".into(), STDIN);
                    }
                    root @ ("std" | "core" | "alloc") if is_crate(root, &tokens[..index], &self.own) => {
                        if in_use && matches!(rest.first(), Some(TokenTree::Ident(word)) if word == "as") {
                            say("system", format!("`{root} as …`"), "a renamed import hides what is used");
                        }
                        for (rule, what, why) in of_root(root, rest) {
                            say(rule, what, why);
                        }
                    }
                    name if is(rest.first(), '!') => {
                        for (rule, _, why) in MACROS.iter().filter(|(_, banned, _)| *banned == name) {
                            say(rule, format!("`{name}!`"), why);
                        }
                    }
                    _ => {}
                },
                TokenTree::Punct(mark) if mark.as_char() == '#' => {
                    let attribute = if is(rest.first(), '!') { rest.get(1) } else { rest.first() };
                    if let Some(TokenTree::Group(group)) = attribute
                        && group.delimiter() == Delimiter::Bracket
                    {
                        let words = words(group.stream());
                        for (rule, name, why) in ATTRIBUTES {
                            if words.iter().any(|word| word == name) {
                                say(rule, format!("`#[{name}]`"), why);
                            }
                        }
                        // `#[cfg(feature = "…")]` is another word.
                        if has_arguments(group.stream(), "feature") {
                            say(
                                "linkage",
                                "`#![feature(…)]`".into(),
                                "exercises are built with a stable compiler",
                            );
                        }
                        for (level, name, why) in LINTS {
                            if [level, name].iter().all(|one| words.iter().any(|word| word == one)) {
                                say("linkage", format!("`#[{level}({name})]`"), why);
                            }
                        }
                    }
                }
                _ => {}
            }
            if let TokenTree::Group(group) = token {
                self.look(group.stream(), in_use);
            }
        }
    }
}

/// Returns whether `std`, `core` or `alloc` names the crate. After the tokens `before`, or beside `own` modules and types of
/// this name, it may name something else.
fn is_crate(root: &str, before: &[TokenTree], own: &BTreeSet<String>) -> bool {
    match before {
        [.., parent, first, second] if is(Some(first), ':') && is(Some(second), ':') => {
            // `crate::core` is a module of the submission, `::core` is the crate.
            !matches!(parent, TokenTree::Ident(word) if ["crate", "self", "super"].contains(&plain(word).as_str()))
        }
        [first, second] if is(Some(first), ':') && is(Some(second), ':') => true,
        _ => !own.contains(root),
    }
}

/// Returns whether `name` is followed by `(…)`, at any depth.
fn has_arguments(tokens: TokenStream, name: &str) -> bool {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    tokens.iter().enumerate().any(|(index, token)| match (token, tokens.get(index + 1)) {
        (TokenTree::Ident(word), Some(TokenTree::Group(_))) if word == name => true,
        (TokenTree::Group(group), _) => has_arguments(group.stream(), name),
        _ => false,
    })
}

/// Returns the findings about the tokens after `std`, `core` or `alloc`, each as rule, construct and reason.
fn of_root(root: &str, rest: &[TokenTree]) -> Vec<(&'static str, String, &'static str)> {
    if !(is(rest.first(), ':') && is(rest.get(1), ':')) {
        return Vec::new();
    }
    let firsts: Vec<String> = match rest.get(2) {
        Some(TokenTree::Ident(word)) => vec![plain(word)],
        Some(TokenTree::Group(group)) => firsts(group.stream()),
        Some(TokenTree::Punct(star)) if star.as_char() == '*' => vec!["*".into()],
        _ => Vec::new(),
    };
    let banned = |first: &String| {
        if first == "*" || first == "self" {
            let why = "it also imports names that no exercise needs";
            return vec![("system", format!("`{root}::{first}`"), why)];
        }
        // A macro can be imported under another name, so an import counts as a use.
        let named = MODULES.iter().chain(&MACROS).filter(|(_, module, _)| module == first);
        named.map(|(rule, module, why)| (*rule, format!("`{root}::{module}`"), *why)).collect()
    };
    firsts.iter().flat_map(banned).collect()
}

/// Returns the first words of the paths in `{…}` after `use std::`.
fn firsts(group: TokenStream) -> Vec<String> {
    let (mut firsts, mut at_start) = (Vec::new(), true);
    for token in group {
        match &token {
            TokenTree::Ident(word) if at_start => firsts.push(plain(word)),
            TokenTree::Punct(mark) if at_start && mark.as_char() == '*' => firsts.push("*".into()),
            TokenTree::Group(inner) if at_start => firsts.extend(self::firsts(inner.stream())),
            _ => {}
        }
        at_start = is(Some(&token), ',');
    }
    firsts
}

/// Returns all words, at any depth.
fn words(tokens: TokenStream) -> Vec<String> {
    let words = tokens.into_iter().flat_map(|token| match token {
        TokenTree::Ident(word) => vec![plain(&word)],
        TokenTree::Group(group) => words(group.stream()),
        _ => Vec::new(),
    });
    words.collect()
}

/// Returns the word without the prefix of a raw identifier: `r#process` means `process`.
fn plain(word: &Ident) -> String {
    let text = word.to_string();
    text.strip_prefix("r#").map_or(text.clone(), str::to_owned)
}

fn is_empty_group(token: Option<&TokenTree>) -> bool {
    matches!(token, Some(TokenTree::Group(group)) if group.stream().is_empty())
}

fn is(token: Option<&TokenTree>, mark: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
}

#[cfg(test)]
mod tests {
    use super::read;

    fn rules(text: &str) -> Vec<(String, usize)> {
        read(text).findings.into_iter().map(|finding| (finding.rule, finding.line)).collect()
    }

    #[test]
    fn what_no_exercise_needs_is_found_with_its_line() {
        let cases = [
            ("fn f() {\n    std::process::exit(0)\n}", "process", 2),
            ("use std::{f32::consts::PI,\n fs};", "files", 1),
            ("use std::{{net}};", "network", 1),
            ("use ::std::env;", "environment", 1),
            ("use std::*;", "system", 1),
            ("use std::{self};", "system", 1),
            ("extern crate std as other;", "linkage", 1),
            ("use std as other;", "system", 1),
            ("fn f() { core::arch::x86_64::_mm_pause() }", "intrinsics", 1),
            ("const S: &str = include_str!(\"/etc/passwd\");", "include", 1),
            ("const S: Option<&str> = option_env!(\"HOME\");", "environment", 1),
            ("#[path = \"/x.rs\"]\nmod x;", "include", 1),
            ("#[cfg_attr(all(), path = \"/x.rs\")]\nmod x;", "include", 1),
            ("#![allow(unsafe_code)]", "linkage", 1),
            ("#[unsafe(no_mangle)] pub fn f() {}", "unsafe", 1),
            ("macro_rules! m { () => {\n unsafe { 1 } } }", "unsafe", 2),
            ("fn f() {\n\n unsafe {} }", "unsafe", 3),
            ("extern \"C\" { fn exit(code: i32); }", "linkage", 1),
            ("static A: [fn(); 1] = [f]; #[used] static B: u8 = 0;", "linkage", 1),
            ("fn f() { std::r#process::exit(0) }", "process", 1),
            ("use core::include_str as text;", "include", 1),
            ("fn f() { std::thread::spawn(|| ()); }", "threads", 1),
            ("fn f() { std::panic::set_hook(todo!()) }", "panics", 1),
            ("use {std as other};", "system", 1),
            ("use ::std as other;", "system", 1),
            ("#![feature(portable_simd)]", "linkage", 1),
            ("#![cfg_attr(all(), feature(asm))]", "linkage", 1),
            ("#[expect(unsafe_code)] fn f() {}", "linkage", 1),
            ("mod core { } fn f() { ::core::arch::x(); }", "intrinsics", 1),
            ("m! { #[cfg(test)] mod a { use std::fs; } }", "files", 1),
            ("fn f() { match x { #[cfg(test)] 1 => std::process::exit(0), _ => {} } }", "process", 1),
            ("#[cfg(not(test))] use std::fs;", "files", 1),
            (
                "fn f() { let s = S { #[cfg(test)] x: a as fn(u8), y: { std::process::exit(0) } }; }",
                "process",
                1,
            ),
            ("fn f() { g(#[cfg(test)] 1, std::process::exit(0)); }", "process", 1),
            ("macro_rules! m { () => { #[cfg(test)] use std::fs; } }", "files", 1),
            ("fn f() { std::io::stdin().read_line(&mut s); }", "input", 1),
            ("use std::io::{self, stdin as typed};", "input", 1),
            ("#![warn(long_running_const_eval)]", "linkage", 1),
        ];
        for (text, rule, line) in cases {
            assert!(rules(text).contains(&(rule.into(), line)), "{text}: {:?}", rules(text));
        }
    }

    #[test]
    fn what_may_remember_is_seen() {
        for remembers in [
            "static CALLS: AtomicU32 = AtomicU32::new(0);",
            "fn f() { static mut N: u32 = 0; }",
            "std::thread_local! { pub static X: u8 = 1 }",
            "macro_rules! m { () => { static A: u8 = 1; } }",
            "m! { #[cfg(test)] static A: u8 = 1; }",
            "fn f<'a>(x: &'a u8) { { static A: u8 = 1; } }",
            "fn broken( {",
        ] {
            assert!(read(remembers).may_remember, "{remembers}");
        }
        for forgets in [
            "const NAMES: &'static str = \"static\"; // static",
            "fn f<T: 'static>(x: &'static T) {}",
            "fn f() { let r#statics = 1; }",
            "#[cfg(test)] mod tests { static A: u8 = 1; }",
        ] {
            assert!(!read(forgets).may_remember, "{forgets}");
        }
    }

    #[test]
    fn honest_code_is_left_alone() {
        let honest = [
            "use std::f32::consts::PI; fn f(env: f32) -> f32 { env * PI }",
            "fn process(path: f32) -> f32 { let thread = path; thread.max(0.0) }",
            "use std::{cmp::Ordering, mem, f32};",
            "/// include_str!(\"x\") and unsafe in a comment\nfn f() { let s = \"std::process::exit\"; }",
            "#[derive(Clone)] #[inline] #[allow(dead_code)] struct S; fn f() { println!(\"{:?}\", 1) }",
            "fn f() { let used = 1; let link = used; todo!(\"path\") }",
            "fn broken( {",
            "#![forbid(unsafe_code)] #![deny(long_running_const_eval)]",
            "fn f() -> f64 { let std = 2.0f32; let core = std as f64; core }",
            "#[cfg(feature = \"fast\")] fn f() {}",
            "#[cfg(test)]\nmod tests { use std::{fs, thread}; #[test] fn f() { std::env::args(); } }",
            "#[cfg(test)] use std::time::Instant; #[cfg(test)] #[allow(unused)] use std::fs;",
            "mod core { pub fn env() {} } fn f() { core::env(); self::core::env(); crate::core::env() }",
            "use crate::core::thread; use super::std::process;",
            "mod a { #[cfg(test)] mod tests { use std::fs; } } #[cfg(test)] pub(crate) const fn f() { std::env::args() }",
            "impl S { #[cfg(test)] #[inline] pub fn f() { std::process::exit(0) } fn g() {} }",
            "fn f() { #[cfg(test)] std::thread::sleep(x); #[cfg(test)] let y = { std::env::args() }; #[cfg(test)] { std::env::vars() } }",
            "#![warn(unsafe_code)] fn stdin(x: &str) { let stdin = \"std::fs, unsafe, #[path]\"; stdin.len(); }",
        ];
        for text in honest {
            assert_eq!(rules(text), [], "{text}");
        }
    }
}
