//! Queries that consist of the arguments of one function, and what the list of functions says about the others.
//!
//! After the signature of a function, an entry of the list says how a query becomes a call:
//!
//! - `[RefractQuery Copy]`: the query is a struct of this name with one field per argument, which is defined here. A borrowed
//!   argument is an owned field, and a slice is a `Vec`.
//! - `(TriangleQuery)`: the fields of a query of another function that has the same arguments.
//! - `()`: the argument itself, or a tuple of all arguments.
//! - `{ |q: SphereQuery| -> Option<f32> { … } }`: the type of the query, the type of the answer if it is not what the function
//!   returns, and the expression that makes one of the other, in which `F` is the student's code. With `[BspQuery]` before it,
//!   the query is defined here, too.

use super::example::{Example, example};
use super::types::*;
use crate::message;

/// The type of a query.
macro_rules! query_type {
    ([$Query:ident $($Copy:ident)?] $arguments:tt) => { $Query };
    (($Query:ident) $arguments:tt) => { $Query };
    (() $arguments:tt) => { crate::kit::queries::owned_type!(() $arguments) };
    ({ $([$($own:tt)*])? |$pattern:tt: $Query:ty| -> $Answer:ty $adapter:block } $arguments:tt) => { $Query };
}

/// The type of the answer to a query.
macro_rules! answer_type {
    ({ $([$($own:tt)*])? |$pattern:tt: $Query:ty| -> $Answer:ty $adapter:block } $Return:ty) => {
        $Answer
    };
    ($how:tt $Return:ty) => {
        $Return
    };
}

/// The owned type of an argument, or the tuple of those of several.
macro_rules! owned_type {
    ((, $Type:ty) ()) => { $Type };
    (($(, $Type:ty)*) ()) => { ($($Type),*) };
    (($($done:tt)*) ($name:ident: &[$Type:ty] $(, $($rest:tt)*)?)) => {
        crate::kit::queries::owned_type!(($($done)*, Vec<$Type>) ($($($rest)*)?))
    };
    (($($done:tt)*) ($name:ident: &$Type:ty $(, $($rest:tt)*)?)) => {
        crate::kit::queries::owned_type!(($($done)*, $Type) ($($($rest)*)?))
    };
    (($($done:tt)*) ($name:ident: $Type:ty $(, $($rest:tt)*)?)) => {
        crate::kit::queries::owned_type!(($($done)*, $Type) ($($($rest)*)?))
    };
}

/// The answer of the function `$name` of `F` to `$query`, which is a reference to a query.
macro_rules! answer {
    ($query:ident $name:ident { $([$($own:tt)*])? |$pattern:tt: $Query:ty| -> $Answer:ty $adapter:block } $arguments:tt) => {{
        let $pattern = $query;
        $adapter
    }};
    ($query:ident $name:ident $how:tt $arguments:tt) => {{
        crate::kit::queries::bind!($query $how $arguments);
        crate::kit::queries::call!($name () $arguments)
    }};
}

/// Binds each argument to a reference to its value in a query.
macro_rules! bind {
    ($query:ident [$Query:ident $($Copy:ident)?] $arguments:tt) => {
        crate::kit::queries::bind!($query ($Query) $arguments)
    };
    ($query:ident ($Query:ident) ($($argument:ident: $Type:ty),* $(,)?)) => {
        let $Query { $($argument),*, .. } = $query;
    };
    ($query:ident () ($argument:ident: $Type:ty)) => { let $argument = $query; };
    ($query:ident () ($($argument:ident: $Type:ty),*)) => { let ($($argument),*) = $query; };
}

/// Calls the function `$name` of `F` with bound arguments.
macro_rules! call {
    ($name:ident ($($done:tt)*) ()) => { F::$name($($done)*) };
    ($name:ident ($($done:tt)*) ($argument:ident: &$Type:ty $(, $($rest:tt)*)?)) => {
        crate::kit::queries::call!($name ($($done)* $argument,) ($($($rest)*)?))
    };
    ($name:ident ($($done:tt)*) ($argument:ident: $Type:ty $(, $($rest:tt)*)?)) => {
        crate::kit::queries::call!($name ($($done)* *$argument,) ($($($rest)*)?))
    };
}

pub(super) use {answer, answer_type, bind, call, owned_type, query_type};

/// Defines the query of an entry, if the entry says so.
macro_rules! query {
    ([$Query:ident $($Copy:ident)?] $name:ident $arguments:tt) => {
        query! { @ ($Query $name $($Copy)?) () $arguments }
    };
    ({ [$Query:ident $($Copy:ident)?] $($rest:tt)* } $name:ident $arguments:tt) => {
        query! { @ ($Query $name $($Copy)?) () $arguments }
    };
    (@ ($Query:ident $name:ident $($Copy:ident)?) ($($argument:ident: $Type:ty,)*) ()) => {
        #[doc = concat!("The arguments of [`", stringify!($name), "`](StudentFunctions::", stringify!($name), ").")]
        #[allow(missing_docs)]
        #[derive(Clone, Debug, PartialEq $(, $Copy)?)]
        pub struct $Query {
            $(pub $argument: $Type,)*
        }

        message! { $Query { $($argument),* } }

        impl Example for $Query {
            fn example() -> Self {
                $Query { $($argument: example(),)* }
            }
        }
    };
    (@ $head:tt ($($done:tt)*) ($argument:ident: &[$Type:ty] $(, $($rest:tt)*)?)) => {
        query! { @ $head ($($done)* $argument: Vec<$Type>,) ($($($rest)*)?) }
    };
    (@ $head:tt ($($done:tt)*) ($argument:ident: &$Type:ty $(, $($rest:tt)*)?)) => {
        query! { @ $head ($($done)* $argument: $Type,) ($($($rest)*)?) }
    };
    (@ $head:tt ($($done:tt)*) ($argument:ident: $Type:ty $(, $($rest:tt)*)?)) => {
        query! { @ $head ($($done)* $argument: $Type,) ($($($rest)*)?) }
    };
    ($how:tt $name:ident $arguments:tt) => {};
}

macro_rules! queries {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($arguments:tt)*)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        $($(query! { $how $name ($($arguments)*) })*)*
    };
}

crate::student_functions! { queries }
