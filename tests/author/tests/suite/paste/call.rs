//! Calls one function with the parameters of another, in any order and precision.

use super::collect::{Bundles, Function, base, bundle, plain};
use syn::{FnArg, GenericArgument, Pat, PathArguments, ReturnType, Type};

/// Most orders of parameters of the same type that are tried.
const MOST_ORDERS: usize = 24;

/// Returns expressions for the body of `exercise` that call `function` with the exercise's parameters, one per order of the
/// parameters of the same type. The list is empty if other crates cannot call the function.
pub fn calls(exercise: &Function, function: &Function, bundles: &Bundles) -> Vec<String> {
    if function.is_test || function.of_trait {
        return Vec::new();
    }
    let mut given = Vec::new();
    for input in &exercise.signature.inputs {
        if let FnArg::Typed(typed) = input
            && let Pat::Ident(name) = &*typed.pat
        {
            take_apart(name.ident.to_string(), &typed.ty, (exercise, bundles), &mut given);
        }
    }
    let parameters = function.signature.inputs.iter().filter_map(|input| match input {
        FnArg::Typed(typed) => Some(&*typed.ty),
        FnArg::Receiver(_) => function.self_type.as_ref(),
    });
    let parameters: Vec<&Type> = parameters.collect();
    let mut wanted = Vec::new();
    parameters.iter().for_each(|ty| take_apart(String::new(), ty, (function, bundles), &mut wanted));
    let mut orders = Vec::new();
    assign(&given, &wanted, &mut Vec::new(), &mut orders);
    let result = |signature: &syn::Signature| match &signature.output {
        ReturnType::Default => None,
        ReturnType::Type(_, ty) => Some((**ty).clone()),
    };
    let call = |order: &Vec<usize>| {
        let mut leaves = order.iter().map(|&index| &given[index]);
        let arguments: Vec<String> =
            parameters.iter().map(|ty| put_together(ty, bundles, &mut leaves)).collect();
        let is_method = function.signature.inputs.iter().any(|input| matches!(input, FnArg::Receiver(_)));
        let call = match (is_method, &arguments[..]) {
            // A method takes `self` as it needs it.
            (true, [this, rest @ ..]) => {
                format!("({this}).{}({})", function.signature.ident, rest.join(", "))
            }
            _ => format!("{}({})", function.path, arguments.join(", ")),
        };
        match (result(&function.signature), result(&exercise.signature)) {
            (Some(from), Some(to)) => converted(&call, &from, &to),
            _ => call,
        }
    };
    orders.iter().map(call).collect()
}

/// A value: the expression, its type, and the type without precision and the like.
type Leaf = (String, Type, String);

/// Adds the values of which a parameter consists.
fn take_apart(value: String, ty: &Type, (of, bundles): (&Function, &Bundles), leaves: &mut Vec<Leaf>) {
    match bundle(ty, bundles) {
        Some((_, fields)) => {
            for (name, ty) in fields {
                take_apart(format!("{value}.{name}"), ty, (of, bundles), leaves);
            }
        }
        None => leaves.push((value, ty.clone(), plain(of, ty))),
    }
}

/// Returns an argument of type `to`, built from the next values.
fn put_together<'a>(to: &Type, bundles: &Bundles, leaves: &mut impl Iterator<Item = &'a Leaf>) -> String {
    match (bundle(to, bundles), to) {
        (Some(_), Type::Reference(to)) => format!("&{}", put_together(&to.elem, bundles, leaves)),
        (Some((place, fields)), _) => {
            let field =
                |(name, ty): &(String, Type)| format!("{name}: {}", put_together(ty, bundles, leaves));
            let fields: Vec<String> = fields.iter().map(field).collect();
            format!("{place}::{} {{ {} }}", base(to), fields.join(", "))
        }
        (None, _) => leaves.next().map_or_else(String::new, |leaf| argument(leaf, to)),
    }
}

/// Adds all ways to assign a given parameter of the same type to each wanted one.
fn assign(given: &[Leaf], wanted: &[Leaf], order: &mut Vec<usize>, orders: &mut Vec<Vec<usize>>) {
    let Some((.., key)) = wanted.get(order.len()) else {
        return orders.push(order.clone());
    };
    for index in 0..given.len() {
        if given[index].2 == *key && !order.contains(&index) && orders.len() < MOST_ORDERS {
            order.push(index);
            assign(given, wanted, order, orders);
            order.pop();
        }
    }
}

fn argument((name, from, _): &Leaf, to: &Type) -> String {
    if let (Type::Reference(from), Type::Reference(to)) = (from, to)
        && from.mutability.is_some()
        && to.mutability.is_some()
    {
        return name.clone();
    }
    let value = match from {
        Type::Reference(inner) if matches!(*inner.elem, Type::Slice(_)) => format!("{name}.to_vec()"),
        Type::Reference(_) => format!("(*{name}).clone()"),
        Type::ImplTrait(_) => name.clone(),
        _ => format!("{name}.clone()"),
    };
    let inner = match from {
        Type::Reference(from) => &*from.elem,
        from => from,
    };
    match to {
        Type::Reference(to) => format!("&{}", converted(&value, inner, &to.elem)),
        to => converted(&value, inner, to),
    }
}

/// Returns an expression that converts `value` from type `from` to type `to`.
fn converted(value: &str, from: &Type, to: &Type) -> String {
    match (from, to) {
        (Type::Reference(from), to) => return converted(&format!("(*{value}).clone()"), &from.elem, to),
        (Type::Tuple(from), Type::Tuple(to)) => {
            let names: Vec<String> = (0..from.elems.len()).map(|index| format!("part{index}")).collect();
            let parts = names.iter().zip(from.elems.iter().zip(&to.elems));
            let parts: Vec<String> = parts.map(|(name, (from, to))| converted(name, from, to)).collect();
            return format!("{{ let ({}) = {value}; ({}) }}", names.join(", "), parts.join(", "));
        }
        _ => {}
    }
    match (&*base(from), &*base(to)) {
        ("f64", "f32") => return format!("({value} as f32)"),
        ("f32", "f64") => return format!("f64::from({value})"),
        ("DVec3", "Vec3") => return format!("{value}.as_vec3()"),
        ("Vec3", "DVec3") => return format!("{value}.as_dvec3()"),
        ("DVec2", "Vec2") => return format!("{value}.as_vec2()"),
        ("Vec2", "DVec2") => return format!("{value}.as_dvec2()"),
        ("usize" | "u32" | "u64" | "i32" | "i64", to @ ("usize" | "u32" | "u64" | "i32" | "i64")) => {
            return format!("({value} as {to})");
        }
        ("Option", "Option") => {
            if let (Some(from), Some(to)) = (inside(from), inside(to)) {
                return format!("{value}.map(|one| {})", converted("one", from, to));
            }
        }
        _ => {}
    }
    match (element(from), element(to)) {
        (Some(from), Some(inner)) => {
            let list = format!("{value}.into_iter().map(|one| {})", converted("one", from, inner));
            let array = if let Type::Array(_) = to { ".try_into().expect(\"as many\")" } else { "" };
            format!("{list}.collect::<Vec<_>>(){array}")
        }
        _ => value.to_owned(),
    }
}

fn element(ty: &Type) -> Option<&Type> {
    match ty {
        Type::Slice(list) => Some(&list.elem),
        Type::Array(list) => Some(&list.elem),
        Type::Path(_) if base(ty) == "Vec" => inside(ty),
        _ => None,
    }
}

/// Returns the type inside of `Option<…>` or `Vec<…>`.
fn inside(ty: &Type) -> Option<&Type> {
    let Type::Path(path) = ty else { return None };
    let PathArguments::AngleBracketed(inside) = &path.path.segments.last()?.arguments else { return None };
    inside.args.iter().find_map(|argument| match argument {
        GenericArgument::Type(ty) => Some(ty),
        _ => None,
    })
}
