//! Puts many entries into one program (mutant schemata): each function that entries change stands in it once for each of them,
//! and a switch chooses the entry when the program starts.
//!
//! ```text
//! pub fn slab(a0: &Ray, …) -> … {
//!     match crate::chosen("stage3_boxes slab") {
//!         1830472 => slab__wrong_swaps(a0, …),
//!         …
//!         _ => slab__unchanged(a0, …),
//!     }
//! }
//! ```
//!
//! Items that an entry adds or changes besides functions stand inside of its functions. An entry that changes a type gets a copy of
//! its whole module. One that changes what other files see is built alone.

use super::entry::{Entry, Original};
use super::source::{Function, Kind, Owner, Source, names, tokens};
use anyhow::{Context, Result, ensure};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// How an entry is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Form {
    /// Its functions stand beside those of all other entries.
    Functions,
    /// It has a copy of its module.
    Module,
    /// It has a program of its own.
    Alone,
}

/// A file of the solutions with its entries.
pub struct Schema {
    /// Its text with a switch in each function that entries change.
    pub text: String,
    /// The names and texts of the modules that stand beside it.
    pub modules: Vec<(String, String)>,
    /// How each entry is built, in the order of the entries.
    pub forms: Vec<Form>,
    /// The switches that each entry uses, by the names of their functions.
    pub changed: Vec<BTreeSet<String>>,
}

/// The number by which the switch knows an entry. It depends on the name only, so that a new entry does not change the code of
/// others.
pub fn number(entry: &Entry) -> u32 {
    let name = entry.to_string();
    name.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)).max(1)
}

/// The name of an entry as part of an identifier.
fn suffix(entry: &Entry) -> String {
    format!("{}_{}", entry.kind(), entry.name)
}

/// What one entry changes in a file.
struct Difference {
    text: String,
    source: Source,
    /// The functions that get a variant: the index in the original, and that in the changed source.
    variants: Vec<(usize, usize)>,
    /// Items that stand inside of the variants.
    inside: String,
    form: Form,
}

impl Difference {
    fn of(original: &Original, text: String) -> Result<Difference> {
        let source = Source::parse(&text)?;
        let (old, old_text) = (&original.source, &original.text);
        let (new, new_text) = (&source, &text);
        let uses = |text: &str, hidden: &BTreeSet<&str>| {
            names(text).iter().any(|name| hidden.contains(name.as_str()))
        };
        let has_fixed_body = |text: &str, function: &Function| {
            function.owner == Owner::Trait || function.is_const || returns_impl(text, function)
        };
        let mut form = Form::Functions;
        let mut inside: Vec<&str> = Vec::new();
        let mut changed: BTreeSet<usize> = BTreeSet::new();
        // The names of items of the file that have another meaning inside of the variants.
        let mut hidden: BTreeSet<&str> = BTreeSet::new();
        // Compare the functions.
        for (index, function) in new.functions.iter().enumerate() {
            let before =
                old.functions.iter().find(|one| one.name == function.name && one.owner == function.owner);
            let Some(before) = before else {
                match function.owner {
                    Owner::File => inside.push(&new_text[function.whole.clone()]),
                    Owner::Type | Owner::Trait => form = form.max(Form::Module),
                }
                continue;
            };
            if is_same(
                &old_text[before.head.start..before.body.end],
                &new_text[function.head.start..function.body.end],
            ) {
                continue;
            }
            let is_same_shape = shape(old_text, before) == shape(new_text, function);
            if has_fixed_body(old_text, before) {
                form = form.max(Form::Module);
            } else if is_same_shape {
                changed.insert(index);
            } else if before.is_public {
                form = Form::Alone;
            } else if before.owner == Owner::File {
                inside.push(&new_text[function.whole.clone()]);
                hidden.insert(&function.name);
            } else {
                form = form.max(Form::Module);
            }
        }
        // Compare the other items.
        for item in &new.items {
            let is_it = |other: &super::source::Item| {
                other.name == item.name
                    && is_same(&old_text[other.text.clone()], &new_text[item.text.clone()])
            };
            if old.items.iter().any(is_it) {
                continue;
            }
            let is_known = old.items.iter().any(|other| other.name == item.name);
            match item.kind {
                Kind::Import => inside.push(&new_text[item.text.clone()]),
                Kind::Value if is_known && item.is_public => form = Form::Alone,
                Kind::Value => {
                    inside.push(&new_text[item.text.clone()]);
                    if is_known {
                        hidden.extend(item.name.split(' ').nth(1));
                    }
                }
                Kind::Type if item.is_public => form = Form::Alone,
                Kind::Type => form = form.max(Form::Module),
            }
        }
        // A constant that uses a changed one changes as well.
        loop {
            let value = |item: &&super::source::Item| {
                item.kind == Kind::Value
                    && item.name.split(' ').nth(1).is_some_and(|name| !hidden.contains(name))
                    && uses(&new_text[item.text.clone()], &hidden)
            };
            let Some(item) = new.items.iter().find(value) else { break };
            inside.push(&new_text[item.text.clone()]);
            hidden.extend(item.name.split(' ').nth(1));
            if item.is_public {
                form = Form::Alone;
            }
        }
        // A function that uses a changed item changes as well.
        for (index, function) in new.functions.iter().enumerate() {
            let text = &new_text[function.head.start..function.body.end];
            let is_inside = function.owner == Owner::File && hidden.contains(function.name.as_str());
            if hidden.is_empty() || is_inside || !uses(text, &hidden) {
                continue;
            }
            if has_fixed_body(new_text, function) {
                form = form.max(Form::Module);
            } else {
                changed.insert(index);
            }
        }
        // A copy of a module has types of its own, which other files must not see.
        let has_public_type = old
            .items
            .iter()
            .any(|item| item.is_public && (item.name.starts_with("struct") || item.name.starts_with("enum")));
        if changed.is_empty() {
            form = form.max(Form::Module);
        }
        if form == Form::Module && has_public_type {
            form = Form::Alone;
        }
        let place = |name: &str, owner: &Owner| {
            old.functions.iter().position(|one| one.name == name && one.owner == *owner)
        };
        let variants = changed.iter().filter_map(|&index| {
            let function = &new.functions[index];
            Some((place(&function.name, &function.owner)?, index))
        });
        let (variants, inside) = (variants.collect(), inside.join("\n"));
        Ok(Difference { text, source, variants, inside, form })
    }
}

/// Whether two texts have the same tokens. Most are the same letter by letter, which is quicker to see.
fn is_same(one: &str, other: &str) -> bool {
    one == other || tokens(one) == tokens(other)
}

/// The types of a function: what its callers depend on.
fn shape(text: &str, function: &Function) -> String {
    let of_arguments: Vec<String> =
        function.arguments.iter().map(|range| tokens(&text[range.clone()])).collect();
    let receiver = function.receiver.clone().map_or(String::new(), |range| tokens(&text[range]));
    format!(
        "{} {receiver} {} {}",
        tokens(&text[function.ident.end..function.inputs.start - 1]),
        of_arguments.join(", "),
        // The closing parenthesis stands between the two.
        tokens(&text[function.inputs.end + 1..function.head.end]),
    )
}

/// Whether a function returns a type that its body decides.
fn returns_impl(text: &str, function: &Function) -> bool {
    names(&text[function.inputs.end + 1..function.head.end]).contains("impl")
}

/// Puts entries into their file. Each comes with the changed text of the file.
pub fn schema(original: &Original, entries: Vec<(&Entry, String)>) -> Result<Schema> {
    let mut differences = Vec::new();
    for (entry, text) in entries {
        let difference =
            Difference::of(original, text).with_context(|| format!("{entry} is not valid Rust"))?;
        differences.push((entry, difference));
    }
    let numbers: BTreeSet<u32> = differences.iter().map(|(entry, _)| number(entry)).collect();
    ensure!(numbers.len() == differences.len(), "{}: two entries have the same number", original.file);
    let functions = &original.source.functions;
    // The arms of the switch of each function, and the functions that they call.
    let mut arms: BTreeMap<usize, (String, String)> = BTreeMap::new();
    let mut modules = Vec::new();
    let module = original.file.trim_start_matches("solutions/src/").trim_end_matches(".rs").to_owned();
    let mut changed = vec![BTreeSet::new(); differences.len()];
    for ((entry, difference), changed) in differences.iter().zip(&mut changed) {
        let mut use_switch = |function: &Function| _ = changed.insert(switch_name(&module, &function.name));
        match difference.form {
            Form::Functions => {
                for &(old, new) in &difference.variants {
                    let (arms, beside) = arms.entry(old).or_default();
                    let variant = &difference.source.functions[new];
                    let name = format!("{}__{}", last(&variant.name), suffix(entry));
                    use_switch(&functions[old]);
                    let _ = writeln!(
                        arms,
                        "        {} => {},",
                        number(entry),
                        call(&functions[old], &own(&functions[old], &name))
                    );
                    let inside = format!("\n{}\n", difference.inside);
                    *beside += &renamed(&difference.text, variant, &name, &inside);
                }
            }
            Form::Module => {
                let name = format!("{module}__{}", suffix(entry));
                for (index, function) in functions.iter().enumerate() {
                    if function.is_public && function.owner == Owner::File {
                        let path = format!("crate::{name}::{}", function.name);
                        use_switch(function);
                        let (arms, _) = arms.entry(index).or_default();
                        let _ = writeln!(arms, "        {} => {},", number(entry), call(function, &path));
                    }
                }
                modules.push((name, difference.text.clone()));
            }
            Form::Alone => {}
        }
    }
    // Replace each of these functions by its switch.
    let mut text = original.text.clone();
    for (index, (arms, beside)) in arms.into_iter().rev() {
        let function = &functions[index];
        let unchanged = format!("{}__unchanged", last(&function.name));
        let head = switch_head(&original.text, function);
        let switch = format!(
            "{head}{{\n    match crate::chosen({:?}) {{\n{arms}        _ => {},\n    }}\n}}\n{}{beside}",
            switch_name(&module, &function.name),
            call(function, &own(function, &unchanged)),
            renamed(&original.text, function, &unchanged, ""),
        );
        text.replace_range(function.head.start..function.body.end, &switch);
    }
    let forms = differences.iter().map(|(_, difference)| difference.form).collect();
    Ok(Schema { text, modules, forms, changed })
}

/// The name of the switch in a function of a module.
fn switch_name(module: &str, function: &str) -> String {
    format!("{module} {function}")
}

/// The last part of the name of a method.
fn last(name: &str) -> &str {
    name.rsplit("::").next().unwrap_or(name)
}

/// The path by which a function calls another one beside it.
fn own(function: &Function, name: &str) -> String {
    if function.owner == Owner::File { name.to_owned() } else { format!("Self::{name}") }
}

/// A call of a function with the arguments of `function`.
fn call(function: &Function, path: &str) -> String {
    let generics = match &function.generics[..] {
        [] => String::new(),
        generics => format!("::<{}>", generics.join(", ")),
    };
    let receiver = function.receiver.iter().map(|_| "self".to_owned());
    let arguments = (0..function.arguments.len()).map(|index| format!("a{index}"));
    format!("{path}{generics}({})", receiver.chain(arguments).collect::<Vec<_>>().join(", "))
}

/// The head of a function with plain names of its arguments.
fn switch_head(text: &str, function: &Function) -> String {
    let receiver = function.receiver.iter().map(|range| text[range.clone()].to_owned());
    let arguments = function.arguments.iter().enumerate();
    let arguments = arguments.map(|(index, range)| format!("a{index}: {}", text[range.clone()].trim()));
    format!(
        "{}{}{}",
        &text[function.head.start..function.inputs.start],
        receiver.chain(arguments).collect::<Vec<_>>().join(", "),
        &text[function.inputs.end..function.head.end],
    )
}

/// A function with another name, and with items at the beginning of its body.
fn renamed(text: &str, function: &Function, name: &str, inside: &str) -> String {
    format!(
        "{}{name}{}{{{inside}{}\n",
        &text[function.head.start..function.ident.start],
        &text[function.ident.end..function.head.end],
        &text[function.body.start + 1..function.body.end],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus::entry::CorpusFile;

    const FILE: &str = "const A: u32 = 1;\n\n/// About one.\npub fn one(&(x, y): &(u32, u32)) -> u32 {\n    x + y + A\n}\n\n\
                        fn two<const N: usize>(x: [u32; N]) -> u32 {\n    x[0]\n}\n\nstruct S;\n\nimpl S {\n    fn three(&self, x: u32) -> u32 {\n        x\n    }\n}\n";

    fn put(entries: &str) -> Schema {
        let original = Original::new("solutions/src/stage1_a.rs", FILE.to_owned()).unwrap();
        let corpus = CorpusFile::parse("stage1_a", entries).unwrap();
        let texts = corpus.entries.iter().map(|entry| (entry, entry.apply(&original).unwrap())).collect();
        let schema = schema(&original, texts).unwrap();
        assert!(Source::parse(&schema.text).is_ok(), "{}", schema.text);
        schema
    }

    fn has(schema: &Schema, text: &str) {
        assert!(schema.text.contains(text), "{}", schema.text);
    }

    #[test]
    fn a_changed_function_stands_beside_the_unchanged_one() {
        let schema = put("=== one ===\n\nright r: r\n-    x + y + A\n+    y + x + A\n");
        assert_eq!(schema.forms, [Form::Functions]);
        let head = "/// About one.\npub fn one(a0: &(u32, u32)) -> u32 {\n    match crate::chosen(\"stage1_a one\") {\n";
        has(&schema, head);
        has(&schema, " => one__right_r(a0),\n        _ => one__unchanged(a0),\n");
        has(&schema, "pub fn one__right_r(&(x, y): &(u32, u32)) -> u32 {\n\n\n    y + x + A\n}\n");
    }

    #[test]
    fn methods_and_generic_functions_are_called_with_what_they_need() {
        let schema = put(
            "=== two ===\n\nright r: r\n-    x[0]\n+    x[0] + 0\n@ S::three\n-        x\n+        x + 0\n",
        );
        assert_eq!(schema.forms, [Form::Functions]);
        has(&schema, "=> two__right_r::<N>(a0),");
        has(&schema, "=> Self::three__right_r(self, a0),");
    }

    #[test]
    fn a_changed_constant_stands_inside_of_the_functions_that_use_it() {
        let schema = put("=== * ===\n\nright r: r\n-const A: u32 = 1;\n+const A: u32 = 2;\n");
        assert_eq!(schema.forms, [Form::Functions]);
        has(&schema, "one__right_r(&(x, y): &(u32, u32)) -> u32 {\nconst A: u32 = 2;\n");
        assert!(!schema.text.contains("two__right_r"));
    }

    #[test]
    fn a_changed_type_needs_a_copy_of_the_module() {
        let schema = put("=== * ===\n\nright r: r\n-struct S;\n+struct S(u32);\n");
        assert_eq!(schema.forms, [Form::Module]);
        assert_eq!(schema.modules[0].0, "stage1_a__right_r");
        has(&schema, "=> crate::stage1_a__right_r::one(a0),");
    }

    #[test]
    fn a_function_that_other_files_call_otherwise_is_built_alone() {
        let entry = "=== one ===\n\nright r: r\n-pub fn one(&(x, y): &(u32, u32)) -> u32 {\n+pub fn one(x: u32, y: u32) -> u32 {\n";
        assert_eq!(put(entry).forms, [Form::Alone]);
    }
}
