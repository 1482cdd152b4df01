//! Finds the functions that fit an exercise: their parameter and return types are the same except for order, references,
//! precision and the kind of list.

use grader::files_below::files_below;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use syn::{FnArg, GenericParam, Generics, ImplItem, Item, ReturnType, Signature, Type, TypeParamBound};

/// A function, with its place and its types.
pub struct Function {
    /// The file, from the root of the kit.
    pub file: String,
    /// Its path for other crates: `checks::tree::around`.
    pub path: String,
    /// Whether only tests of its own crate can call it.
    pub is_test: bool,
    /// Whether it is a method of a trait.
    pub of_trait: bool,
    /// The type of `self`, if it is a method.
    pub self_type: Option<Type>,
    /// The signature as written.
    pub signature: Signature,
    /// The generics of the `impl` block around it.
    pub outer: Generics,
    /// Its types without order, references and precision.
    pub key: Key,
    /// Whether its body is `todo!(…)`.
    pub is_exercise: bool,
}

/// Types that are replaced by their fields: per name of a type its module, and the names and types of the fields. So
/// `query: &SphereQuery` counts as a ray, a centre and a radius.
pub type Bundles = BTreeMap<String, Bundle>;

/// The module of a type, and its fields.
type Bundle = (&'static str, Vec<(String, Type)>);

/// Returns the query types of the kit's interface, and the shapes that some exercises take whole and others as fields.
pub fn bundles(root: &Path) -> Bundles {
    let mut bundles = Bundles::new();
    for file in rust_files(root, "src/kit").into_iter().chain(["src/geometry/shape.rs".to_owned()]) {
        let text = fs::read_to_string(root.join(&file)).expect("a readable file");
        for item in parse(&file, &text).items {
            let Item::Struct(one) = item else { continue };
            let name = one.ident.to_string();
            let place = match name.as_str() {
                "Sphere" | "Plane" => "raykata::shape",
                name if name.ends_with("Query") => "raykata::kit",
                _ => continue,
            };
            let field = |field: syn::Field| Some((field.ident?.to_string(), field.ty));
            let fields: Option<Vec<(String, Type)>> = one.fields.into_iter().map(field).collect();
            if let (true, Some(fields)) = (one.generics.params.is_empty(), fields) {
                bundles.insert(name, (place, fields));
            }
        }
    }
    let list = fs::read_to_string(root.join("src/kit/list.rs")).expect("the list of functions");
    bundles.extend(list.split(" fn ").filter_map(listed_query));
    bundles
}

/// The query that an entry of the list of functions defines, `name(arguments) -> Answer = file::name; [Query …`.
fn listed_query(entry: &str) -> Option<(String, Bundle)> {
    let (signature, rest) = entry.split_once("= stage")?;
    let (_, how) = rest.split_once(';')?;
    let name = how.trim_start().trim_start_matches("{ ").strip_prefix('[')?;
    let name = name.split([' ', ']']).next()?;
    let signature = format!("fn f{}", &signature[signature.find('(')?..]);
    let signature: Signature = syn::parse_str(&signature).unwrap_or_else(|error| panic!("{name}: {error}"));
    let field = |argument: FnArg| {
        let FnArg::Typed(argument) = argument else { return None };
        // A borrowed argument is an owned field, and a slice is a list.
        let owned = match *argument.ty {
            Type::Reference(reference) => match *reference.elem {
                Type::Slice(slice) => {
                    let item = slice.elem;
                    syn::parse_quote!(Vec<#item>)
                }
                whole => whole,
            },
            whole => whole,
        };
        let syn::Pat::Ident(name) = *argument.pat else { return None };
        Some((name.ident.to_string(), owned))
    };
    Some((name.to_owned(), ("raykata::kit", signature.inputs.into_iter().map(field).collect::<Option<_>>()?)))
}

/// The types of the parameters, sorted, and the type of the result.
pub type Key = (Vec<String>, String);

/// Returns all functions of a crate with the sources in `folder` and the name `name`.
pub fn functions(root: &Path, folder: &str, name: &str, bundles: &Bundles) -> Vec<Function> {
    let mut parsed = Vec::new();
    for file in rust_files(root, folder) {
        let text = fs::read_to_string(root.join(&file)).expect("a readable file");
        let inside = Path::new(&file).strip_prefix(folder).expect("a file of the folder");
        parsed.push((file.clone(), module(name, inside), parse(&file, &text)));
    }
    let mut aliases = BTreeMap::new();
    parsed.iter().for_each(|(.., syntax)| collect_aliases(&syntax.items, &mut aliases));
    let (mut found, known) = (Vec::new(), Known { aliases: &aliases, bundles });
    for (file, module, syntax) in &parsed {
        let is_test = module.split("::").any(|part| part == "tests");
        collect(file, module, is_test, &syntax.items, known, &mut found);
    }
    found
}

/// Returns the functions of one text.
pub fn functions_of(file: &str, module: &str, text: &str, bundles: &Bundles) -> Vec<Function> {
    let syntax = parse(file, text);
    let (mut aliases, mut found) = (BTreeMap::new(), Vec::new());
    collect_aliases(&syntax.items, &mut aliases);
    let known = Known { aliases: &aliases, bundles };
    collect(file, module, false, &syntax.items, known, &mut found);
    found
}

/// Returns whether a function calls those of the student, of which it has a type parameter.
fn calls_the_student(function: &Function) -> bool {
    let generics = function.signature.generics.params.iter().chain(&function.outer.params);
    let bounds = generics.filter_map(|parameter| match parameter {
        GenericParam::Type(parameter) => Some(&parameter.bounds),
        _ => None,
    });
    bounds.flatten().any(|bound| match bound {
        TypeParamBound::Trait(bound) => bound.path.is_ident("StudentFunctions"),
        _ => false,
    })
}

/// Returns the functions that fit each exercise. One that calls the student's functions answers with what they return, so it
/// fits none.
pub fn candidates<'a>(exercises: &'a [Function], all: &'a [Function]) -> Vec<(&'a Function, &'a Function)> {
    let mut by_key: BTreeMap<&Key, Vec<&Function>> = BTreeMap::new();
    let answering = all.iter().filter(|function| !calls_the_student(function));
    answering.for_each(|function| by_key.entry(&function.key).or_default().push(function));
    let fitting = |exercise: &'a Function| {
        let found = by_key.get(&exercise.key).into_iter().flatten();
        found.map(move |function| (exercise, *function)).collect::<Vec<_>>()
    };
    exercises.iter().flat_map(fitting).collect()
}

fn parse(file: &str, text: &str) -> syn::File {
    syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// Returns the Rust files below a folder, by their paths from the root. A folder with a manifest is a separate crate.
fn rust_files(root: &Path, folder: &str) -> Vec<String> {
    let is_kept = |path: &str| !root.join(path).join("Cargo.toml").exists();
    let mut files = files_below(root, folder, &is_kept).unwrap_or_else(|error| panic!("{error:#}"));
    files.retain(|path| path.ends_with(".rs"));
    files
}

/// Returns the module path of a file: `checks::tree::search` for `tree/search.rs`.
fn module(name: &str, file: &Path) -> String {
    let mut module = name.to_owned();
    for part in file.with_extension("").iter().map(|part| part.to_string_lossy()) {
        if !matches!(&*part, "lib" | "mod") {
            module = format!("{module}::{part}");
        }
    }
    module
}

fn collect_aliases(items: &[Item], aliases: &mut BTreeMap<String, Type>) {
    for item in items {
        match item {
            Item::Type(alias) if alias.generics.params.is_empty() => {
                aliases.insert(alias.ident.to_string(), (*alias.ty).clone());
            }
            Item::Mod(module) => {
                module.content.iter().for_each(|(_, items)| collect_aliases(items, aliases));
            }
            _ => {}
        }
    }
}

/// The meaning of type names in a whole crate.
#[derive(Clone, Copy)]
struct Known<'a> {
    aliases: &'a BTreeMap<String, Type>,
    bundles: &'a Bundles,
}

fn collect(
    file: &str,
    module: &str,
    is_test: bool,
    items: &[Item],
    known: Known<'_>,
    found: &mut Vec<Function>,
) {
    let mut add = |path: String,
                   of_trait: bool,
                   self_type: Option<&Type>,
                   signature: &Signature,
                   outer: &Generics,
                   block: &syn::Block| {
        let generics = [outer, &signature.generics];
        let names = Names { aliases: known.aliases, generics, self_type, depth: 0 };
        found.push(Function {
            file: file.to_owned(),
            path,
            is_test,
            of_trait,
            self_type: self_type.cloned(),
            signature: signature.clone(),
            outer: outer.clone(),
            key: names.key(signature, known.bundles),
            is_exercise: is_todo(block),
        });
    };
    for item in items {
        match item {
            Item::Fn(function) => {
                let path = format!("{module}::{}", function.sig.ident);
                add(path, false, None, &function.sig, &Generics::default(), &function.block);
            }
            Item::Impl(block) => {
                for item in &block.items {
                    let ImplItem::Fn(method) = item else { continue };
                    let path = format!("{module}::{}::{}", base(&block.self_ty), method.sig.ident);
                    let of_trait = block.trait_.is_some();
                    add(path, of_trait, Some(&block.self_ty), &method.sig, &block.generics, &method.block);
                }
            }
            _ => {}
        }
    }
    for item in items {
        if let Item::Mod(inner) = item
            && let Some((_, items)) = &inner.content
        {
            let for_tests = is_test || inner.ident == "tests";
            collect(file, &format!("{module}::{}", inner.ident), for_tests, items, known, found);
        }
    }
}

fn is_todo(block: &syn::Block) -> bool {
    let [statement] = &block.stmts[..] else { return false };
    match statement {
        syn::Stmt::Macro(one) => one.mac.path.is_ident("todo"),
        syn::Stmt::Expr(syn::Expr::Macro(one), _) => one.mac.path.is_ident("todo"),
        _ => false,
    }
}

/// Returns the last name of a path type.
pub fn base(ty: &Type) -> String {
    match ty {
        Type::Path(path) => path.path.segments.last().map_or_else(String::new, |last| last.ident.to_string()),
        Type::Reference(inner) => base(&inner.elem),
        Type::Paren(inner) => base(&inner.elem),
        Type::Group(inner) => base(&inner.elem),
        _ => String::new(),
    }
}

/// Returns a type of a function without references, precision and the kind of list.
pub fn plain(function: &Function, ty: &Type) -> String {
    let (self_type, aliases) = (function.self_type.as_ref(), BTreeMap::new());
    let generics = [&function.outer, &function.signature.generics];
    Names { aliases: &aliases, generics, self_type, depth: 0 }.plain(ty)
}

/// Returns the fields of a type that is replaced by its fields.
pub fn bundle<'a>(ty: &Type, bundles: &'a Bundles) -> Option<&'a (&'static str, Vec<(String, Type)>)> {
    match ty {
        Type::Reference(inner) => bundle(&inner.elem, bundles),
        Type::Path(_) => bundles.get(&base(ty)),
        _ => None,
    }
}

/// The meaning of type names in a function.
struct Names<'a> {
    aliases: &'a BTreeMap<String, Type>,
    generics: [&'a Generics; 2],
    self_type: Option<&'a Type>,
    depth: u32,
}

impl Names<'_> {
    fn key(&self, signature: &Signature, bundles: &Bundles) -> Key {
        let mut parameters = Vec::new();
        for input in &signature.inputs {
            match (input, self.self_type) {
                (FnArg::Receiver(_), Some(ty)) => self.leaves(ty, bundles, &mut parameters),
                (FnArg::Receiver(_), None) => {}
                (FnArg::Typed(typed), _) => self.leaves(&typed.ty, bundles, &mut parameters),
            }
        }
        parameters.sort();
        let result = match &signature.output {
            ReturnType::Default => "()".into(),
            ReturnType::Type(_, ty) => self.plain(ty),
        };
        (parameters, result)
    }

    /// Adds the types of which a parameter of this type consists.
    fn leaves(&self, ty: &Type, bundles: &Bundles, leaves: &mut Vec<String>) {
        match bundle(ty, bundles) {
            Some((_, fields)) => fields.iter().for_each(|(_, ty)| self.leaves(ty, bundles, leaves)),
            None => leaves.push(self.plain(ty)),
        }
    }

    /// Returns a type without references, precision and the kind of list.
    fn plain(&self, ty: &Type) -> String {
        match ty {
            Type::Reference(inner) => self.plain(&inner.elem),
            Type::Paren(inner) => self.plain(&inner.elem),
            Type::Group(inner) => self.plain(&inner.elem),
            Type::Slice(list) => format!("[{}]", self.plain(&list.elem)),
            Type::Array(list) => format!("[{}]", self.plain(&list.elem)),
            Type::Tuple(tuple) => {
                let parts: Vec<String> = tuple.elems.iter().map(|part| self.plain(part)).collect();
                format!("({})", parts.join(", "))
            }
            Type::ImplTrait(one) => self.bound(one.bounds.iter()),
            Type::TraitObject(one) => self.bound(one.bounds.iter()),
            Type::Path(path) => self.named(path),
            _ => "?".into(),
        }
    }

    fn named(&self, path: &syn::TypePath) -> String {
        let Some(last) = path.path.segments.last() else { return "?".into() };
        let name = last.ident.to_string();
        if let (Some(alias), true) = (self.aliases.get(&name), self.depth < 8) {
            return Names { depth: self.depth + 1, ..*self }.plain(alias);
        }
        if let (Some(ty), true, "Self") = (self.self_type, self.depth < 8, name.as_str()) {
            return Names { depth: self.depth + 1, ..*self }.plain(ty);
        }
        for parameter in self.generics.iter().flat_map(|generics| &generics.params) {
            if let GenericParam::Type(parameter) = parameter
                && parameter.ident == name
            {
                return self.bound(parameter.bounds.iter());
            }
        }
        let inside: Vec<String> = match &last.arguments {
            syn::PathArguments::AngleBracketed(inside) => {
                let types = inside.args.iter().filter_map(|argument| match argument {
                    syn::GenericArgument::Type(ty) => Some(self.plain(ty)),
                    _ => None,
                });
                types.collect()
            }
            _ => Vec::new(),
        };
        match (name.as_str(), &inside[..]) {
            ("f64", _) => "f32".into(),
            ("DVec2" | "DVec3" | "DVec4" | "DMat3" | "DAffine3", _) => name[1..].to_owned(),
            ("usize" | "u32" | "u64" | "i32" | "i64", _) => "whole".into(),
            ("Vec", [one]) => format!("[{one}]"),
            ("Box" | "Arc", [one]) => one.clone(),
            (_, []) => name,
            (_, parts) => format!("{name}<{}>", parts.join(", ")),
        }
    }

    fn bound<'b>(&self, mut bounds: impl Iterator<Item = &'b TypeParamBound>) -> String {
        let first = bounds.find_map(|bound| match bound {
            TypeParamBound::Trait(one) => one.path.segments.last().map(|last| last.ident.to_string()),
            _ => None,
        });
        format!("impl {}", first.unwrap_or_default())
    }
}
