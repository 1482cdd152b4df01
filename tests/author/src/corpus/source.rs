//! A source file as its items: where each function stands, what its parts are, and which names it uses.

use anyhow::{Context, Result, anyhow};
use proc_macro2::{Ident, TokenStream, TokenTree};
use std::collections::BTreeSet;
use std::ops::Range;
use std::str::FromStr;
use syn::spanned::Spanned;

/// A function or a method of a file. All ranges are in bytes of its text.
#[derive(Clone, Debug)]
pub struct Function {
    /// `name`, or `Type::name` for a method.
    pub name: String,
    /// From its doc comment to its closing brace.
    pub whole: Range<usize>,
    /// From its visibility to its opening brace, without it.
    pub head: Range<usize>,
    /// Its identifier in the head.
    pub ident: Range<usize>,
    /// The types of its arguments without `self`.
    pub arguments: Vec<Range<usize>>,
    /// Its arguments between the parentheses.
    pub inputs: Range<usize>,
    /// Its `self`, if it has one.
    pub receiver: Option<Range<usize>>,
    /// The names of its type and const parameters.
    pub generics: Vec<String>,
    /// From its opening to its closing brace.
    pub body: Range<usize>,
    /// Whether it is a `pub fn`.
    pub is_public: bool,
    /// Whether it is a `const fn`.
    pub is_const: bool,
    /// What it belongs to.
    pub owner: Owner,
}

/// What a function belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The file.
    File,
    /// An `impl` block of a type.
    Type,
    /// An `impl` block of a trait, or the trait itself, which cannot get more functions.
    Trait,
}

/// Another item of a file: a constant, a type, an import, or the head of an `impl` block.
#[derive(Clone, Debug)]
pub struct Item {
    /// What it is and how it is called, such as `const MORE`.
    pub name: String,
    /// From its doc comment to its last token.
    pub text: Range<usize>,
    /// Whether other files can use it.
    pub is_public: bool,
    /// Which kind it is.
    pub kind: Kind,
}

/// The kind of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A constant or a static.
    Value,
    /// A `use`.
    Import,
    /// A type, a trait, a macro, or the head of an `impl` block with what is in it besides functions.
    Type,
}

/// The items of a file.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// Its functions and methods, in order.
    pub functions: Vec<Function>,
    /// Its other items, in order.
    pub items: Vec<Item>,
}

impl Source {
    /// Reads a file.
    pub fn parse(text: &str) -> Result<Source> {
        let file = syn::parse_file(text).map_err(|error| {
            let at = error.span().start();
            anyhow!("line {}, column {}: {error}", at.line, at.column + 1)
        })?;
        let mut source = Source::default();
        for item in &file.items {
            source.add(text, item);
        }
        Ok(source)
    }

    /// Returns the function of this name.
    pub fn function(&self, name: &str) -> Result<&Function> {
        let mut found = self.functions.iter().filter(|function| function.name == name);
        let function = found.next().with_context(|| format!("there is no function `{name}`"))?;
        anyhow::ensure!(found.next().is_none(), "there are several functions `{name}`");
        Ok(function)
    }

    fn add(&mut self, text: &str, item: &syn::Item) {
        let is_public = |vis: &syn::Visibility| matches!(vis, syn::Visibility::Public(_));
        let (name, visibility, kind) = match item {
            syn::Item::Fn(function) => {
                let parts = (&function.attrs[..], &function.vis, &function.sig, &*function.block);
                return self.functions.push(of_function(text, None, Owner::File, parts));
            }
            syn::Item::Impl(block) => return self.add_impl(text, block),
            syn::Item::Const(value) => (format!("const {}", value.ident), Some(&value.vis), Kind::Value),
            syn::Item::Static(value) => (format!("static {}", value.ident), Some(&value.vis), Kind::Value),
            syn::Item::Use(import) => ("use".to_owned(), Some(&import.vis), Kind::Import),
            syn::Item::Struct(one) => (format!("struct {}", one.ident), Some(&one.vis), Kind::Type),
            syn::Item::Enum(one) => (format!("enum {}", one.ident), Some(&one.vis), Kind::Type),
            syn::Item::Type(one) => (format!("type {}", one.ident), Some(&one.vis), Kind::Type),
            syn::Item::Trait(one) => (format!("trait {}", one.ident), Some(&one.vis), Kind::Type),
            _ => ("item".to_owned(), None, Kind::Type),
        };
        self.items.push(Item {
            name,
            text: item.span().byte_range(),
            is_public: visibility.is_some_and(is_public),
            kind,
        });
    }

    fn add_impl(&mut self, text: &str, block: &syn::ItemImpl) {
        let head = block.impl_token.span.byte_range().start..block.brace_token.span.open().byte_range().start;
        let owner = if block.trait_.is_some() { Owner::Trait } else { Owner::Type };
        let name = name_of_type(&block.self_ty);
        for item in &block.items {
            if let syn::ImplItem::Fn(function) = item {
                let parts = (&function.attrs[..], &function.vis, &function.sig, &function.block);
                self.functions.push(of_function(text, Some(&name), owner.clone(), parts));
            }
        }
        let name = text[head.clone()].split_whitespace().collect::<Vec<_>>().join(" ");
        self.items.push(Item { name, text: head, is_public: false, kind: Kind::Type });
    }
}

/// The last identifier of the path of a type.
fn name_of_type(of: &syn::Type) -> String {
    match of {
        syn::Type::Path(path) => path.path.segments.last().map(|one| one.ident.to_string()),
        syn::Type::Reference(reference) => Some(name_of_type(&reference.elem)),
        _ => None,
    }
    .unwrap_or_else(|| "type".to_owned())
}

type Parts<'a> = (&'a [syn::Attribute], &'a syn::Visibility, &'a syn::Signature, &'a syn::Block);

fn of_function(text: &str, of: Option<&str>, owner: Owner, (attrs, vis, sig, block): Parts<'_>) -> Function {
    let ident = sig.ident.span().byte_range();
    let body = block.brace_token.span.join().byte_range();
    // The head begins with the visibility, which may be empty, or else with the signature.
    let visible = !matches!(vis, syn::Visibility::Inherited);
    let head = if visible { vis.span() } else { sig.span() };
    let head = head.byte_range().start..body.start;
    let start = attrs.first().map_or(head.start, |attr| attr.span().byte_range().start);
    let inputs =
        sig.paren_token.span.open().byte_range().end..sig.paren_token.span.close().byte_range().start;
    let mut arguments = Vec::new();
    for pair in sig.inputs.pairs() {
        if let syn::FnArg::Typed(typed) = pair.value() {
            let end = pair.punct().map_or(inputs.end, |comma| comma.span.byte_range().start);
            arguments.push(typed.colon_token.span.byte_range().end..end);
        }
    }
    let generics = sig.generics.params.iter().filter_map(|parameter| match parameter {
        syn::GenericParam::Type(parameter) => Some(parameter.ident.to_string()),
        syn::GenericParam::Const(parameter) => Some(parameter.ident.to_string()),
        syn::GenericParam::Lifetime(_) => None,
    });
    let name = of.map_or(sig.ident.to_string(), |of| format!("{of}::{}", sig.ident));
    let line_start = text[..start].rfind('\n').map_or(0, |end| end + 1);
    Function {
        name,
        whole: line_start..body.end,
        head,
        ident,
        arguments,
        receiver: sig.receiver().map(|receiver| receiver.span().byte_range()),
        inputs,
        generics: generics.collect(),
        body,
        is_public: matches!(vis, syn::Visibility::Public(_)),
        is_const: sig.constness.is_some(),
        owner,
    }
}

/// A text as its tokens, by which texts are compared: comments and layout do not count.
pub fn tokens(text: &str) -> String {
    let Ok(tokens) = TokenStream::from_str(text) else { return text.to_owned() };
    let mut tokens = tokens.into_iter().peekable();
    let is_hash = |token: &TokenTree| matches!(token, TokenTree::Punct(punct) if punct.as_char() == '#');
    let is_doc = |token: &TokenTree| match token {
        TokenTree::Group(group) => {
            group.stream().into_iter().next().is_some_and(|word| word.to_string() == "doc")
        }
        _ => false,
    };
    let mut words = String::new();
    while let Some(token) = tokens.next() {
        if !is_hash(&token) || tokens.next_if(is_doc).is_none() {
            words += &format!("{token} ");
        }
    }
    words
}

/// The identifiers in a text.
pub fn names(text: &str) -> BTreeSet<String> {
    fn add(tokens: TokenStream, names: &mut BTreeSet<String>) {
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => _ = names.insert(Ident::to_string(&ident)),
                TokenTree::Group(group) => add(group.stream(), names),
                _ => {}
            }
        }
    }
    let mut found = BTreeSet::new();
    if let Ok(tokens) = TokenStream::from_str(text) {
        add(tokens, &mut found);
    }
    found
}
