//! The names of the student's functions, generated from the list (`list.rs`).

use super::queries::{answer_type, query_type};
use super::types::*;
use std::any::type_name;
use std::fmt;

macro_rules! names {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($arguments:tt)*)
            -> $Return:ty = $file:ident::$function:ident; $how:tt)*
    })*) => {
        /// The name of a student function, as in the list.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Function {
            $($($(#[$doc])* $name,)*)*
        }

        impl Function {
            /// All student functions, in the order of the stages.
            pub const ALL: &'static [Function] = &[$($(Function::$name),*),*];

            /// The number of the stage to which the function belongs, `1..=12`.
            pub fn stage(self) -> u8 {
                match self {
                    $($(Function::$name)|* => $stage,)*
                }
            }

            /// The name of the function in the student's file.
            pub fn name(self) -> &'static str {
                match self {
                    $($(Function::$name => stringify!($function),)*)*
                }
            }

            /// The name of the student's file that contains the function, without `.rs`.
            pub fn file(self) -> &'static str {
                match self {
                    $($(Function::$name => stringify!($file),)*)*
                }
            }

            /// The types of a query and of its answer, without paths.
            pub fn types(self) -> [String; 2] {
                match self {
                    $($(Function::$name => {
                        [type_name::<query_type!($how ($($arguments)*))>(), type_name::<answer_type!($how $Return)>()]
                    })*)*
                }
                .map(without_paths)
            }
        }
    };
}

crate::student_functions! { names }

/// A type such as `core::option::Option<glam::Vec3>` as `Option<Vec3>`.
fn without_paths(name: &str) -> String {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let parts = name.split_inclusive(|c| !is_part(c)).map(|part| part.rsplit("::").next().unwrap_or(part));
    // The compiler names what an alias stands for.
    let aliases =
        [("CellTree<KdNode>", "KdTree"), ("CellTree<OctreeNode>", "Octree"), ("Tree<BspNode>", "Bsp")];
    aliases.iter().fold(parts.collect(), |name: String, (full, alias)| name.replace(full, alias))
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` of stage {}", self.name(), self.stage())
    }
}
