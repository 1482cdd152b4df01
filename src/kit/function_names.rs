//! The names of the student's functions, generated from the list (`list.rs`).

use std::fmt;

macro_rules! names {
    ($($(#[$trait_doc:meta])* $stage:literal trait $Trait:ident {
        $($(#[$doc:meta])* $Message:ident fn $name:ident $([$($generics:tt)*])? ($($argument:ident: $Type:ty),* $(,)?)
            -> $Return:ty = $file:ident::$function:ident; |$query:tt: $Query:ty| -> $Answer:ty $adapter:block)*
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
        }
    };
}

crate::student_functions! { names }

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` of stage {}", self.name(), self.stage())
    }
}
