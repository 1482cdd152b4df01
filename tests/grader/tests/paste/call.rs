//! Calls one function with the parameters of another, whatever their order and precision.

use crate::collect::{Function, base, plain};
use syn::{FnArg, GenericArgument, Pat, PathArguments, ReturnType, Type};

/// More orders than this of parameters that are alike are not tried.
const MOST_ORDERS: usize = 24;

/// Expressions in the body of `exercise` that return what `function` makes of its parameters: one for each order of the
/// parameters that are alike. None, if nobody else can call the function.
pub fn calls(exercise: &Function, function: &Function) -> Vec<String> {
    if function.is_test || function.of_trait {
        return Vec::new();
    }
    let given: Vec<(String, &Type, String)> = exercise
        .signature
        .inputs
        .iter()
        .filter_map(|input| match input {
            FnArg::Typed(typed) => match &*typed.pat {
                Pat::Ident(name) => Some((name.ident.to_string(), &*typed.ty, plain(exercise, &typed.ty))),
                // A parameter that is taken apart at once gets a name in the copy.
                _ => None,
            },
            FnArg::Receiver(_) => None,
        })
        .collect();
    let mut wanted: Vec<(&Type, String)> = Vec::new();
    for (index, input) in function.signature.inputs.iter().enumerate() {
        match (input, &function.bundle) {
            (_, Some(bundle)) if bundle.index == index => {
                wanted.extend(bundle.fields.iter().map(|(_, ty)| (ty, plain(function, ty))));
            }
            (FnArg::Typed(typed), _) => wanted.push((&typed.ty, plain(function, &typed.ty))),
            (FnArg::Receiver(_), _) => {
                wanted.extend(function.self_type.as_ref().map(|ty| (ty, plain(function, ty))));
            }
        }
    }
    let mut orders = Vec::new();
    assign(&given, &wanted, &mut Vec::new(), &mut orders);
    let result = |signature: &syn::Signature| match &signature.output {
        ReturnType::Default => None,
        ReturnType::Type(_, ty) => Some((**ty).clone()),
    };
    let call = |order: &Vec<usize>| {
        let arguments = order.iter().zip(&wanted).map(|(&index, (to, _))| argument(&given[index], to));
        let mut arguments: Vec<String> = arguments.collect();
        if let Some(bundle) = &function.bundle {
            let fields = bundle.index..bundle.index + bundle.fields.len();
            let values = bundle.fields.iter().zip(&arguments[fields.clone()]);
            let values: Vec<String> = values.map(|((name, _), value)| format!("{name}: {value}")).collect();
            let message = format!("&raykata::kit::{} {{ {} }}", bundle.name, values.join(", "));
            arguments.splice(fields, [message]);
        }
        let is_method = function.signature.inputs.iter().any(|input| matches!(input, FnArg::Receiver(_)));
        let call = match (is_method, &arguments[..]) {
            // A method takes `self` as it needs it.
            (true, [this, rest @ ..]) => format!("{this}.{}({})", function.signature.ident, rest.join(", ")),
            _ => format!("{}({})", function.path, arguments.join(", ")),
        };
        match (result(&function.signature), result(&exercise.signature)) {
            (Some(from), Some(to)) => converted(&call, &from, &to),
            _ => call,
        }
    };
    orders.iter().map(call).collect()
}

/// All ways to give each wanted parameter a given one of its type.
fn assign(
    given: &[(String, &Type, String)],
    wanted: &[(&Type, String)],
    order: &mut Vec<usize>,
    orders: &mut Vec<Vec<usize>>,
) {
    let Some((_, key)) = wanted.get(order.len()) else {
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

fn argument((name, from, _): &(String, &Type, String), to: &Type) -> String {
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

/// `value`, of type `from`, as `to`.
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
            match to {
                Type::Array(_) => {
                    format!("{list}.collect::<Vec<_>>().try_into().expect(\"as many\")")
                }
                // A slice is lent, a list is given.
                _ => format!("{list}.collect::<Vec<_>>()"),
            }
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

/// The type inside of `Option<…>` or `Vec<…>`.
fn inside(ty: &Type) -> Option<&Type> {
    let Type::Path(path) = ty else { return None };
    let PathArguments::AngleBracketed(inside) = &path.path.segments.last()?.arguments else { return None };
    inside.args.iter().find_map(|argument| match argument {
        GenericArgument::Type(ty) => Some(ty),
        _ => None,
    })
}
