//! Messages between programs: values as bytes, without names.
//!
//! The format has no description of itself; both sides have the same types.
//!
//! | value | bytes |
//! |---|---|
//! | `u8`, `u32`, `u64`, `i64`, `f32`, `f64` | 1, 4 or 8, little-endian; a floating-point number by its bits |
//! | `usize` | as `u64` |
//! | `bool` | one byte, 0 or 1 |
//! | a vector of `glam` | its components |
//! | a transform of `glam` | its four columns |
//! | a structure, an array, a tuple | its parts, in the order of the definition |
//! | a variant of an enumeration | one byte with its number, from 0, then its parts |
//! | `Option` | one byte, 0 for `None` or 1, then the value |
//! | `Vec`, `String` | the number of items or bytes of UTF-8, four bytes, then the items |
//! | `PathBuf` | as `String` |
//! | `Box`, `Arc` | the value |
//!
//! Each type has one function that writes it and one that reads it. A format with serializers, deserializers and visitors for
//! each type took more than half of the time in which this crate was compiled.

use glam::{Affine3A, DVec3, UVec2, UVec3, Vec2, Vec3, Vec3A};
use std::path::PathBuf;
use std::sync::Arc;

/// A value that can be sent to another program.
pub trait Message {
    /// Appends the value to `bytes`.
    fn write(&self, bytes: &mut Vec<u8>);

    /// Takes the value from the start of what is left. Memory grows with the bytes that are there, and not with an announced
    /// length. If a value of this type does not begin there, the reader remembers the error, and the value means nothing.
    fn read(bytes: &mut Reader) -> Self
    where
        Self: Sized;

    /// The value as a Rust expression with all digits, to paste into a test. The names are those of
    /// [`types`](crate::kit::types) and of `glam`.
    fn rust(&self) -> String;
}

/// The expressions of `n` values between two brackets, such as `vec3(` and `)`. It is compiled once for all types.
fn listed<'a>(open: &str, n: usize, value: &dyn Fn(usize) -> &'a dyn Message, close: &str) -> String {
    let values: Vec<String> = (0..n).map(|index| value(index).rust()).collect();
    format!("{open}{}{close}", values.join(", "))
}

fn each<T: Message>(open: &str, items: &[T], close: &str) -> String {
    listed(open, items.len(), &|index| &items[index], close)
}

/// The parts of a tuple between brackets.
#[doc(hidden)]
pub fn parts(name: &str, parts: &[&dyn Message]) -> String {
    listed(&format!("{name}("), parts.len(), &|index| parts[index], ")")
}

/// The fields of a structure with their values.
#[doc(hidden)]
pub fn fields(name: &str, fields: &[(&str, &dyn Message)]) -> String {
    let fields: Vec<String> =
        fields.iter().map(|(name, value)| format!("{name}: {}", value.rust())).collect();
    format!("{name} {{ {} }}", fields.join(", "))
}

/// The value of a field that is not sent.
#[doc(hidden)]
pub struct Unsent;

impl Message for Unsent {
    fn write(&self, _bytes: &mut Vec<u8>) {}

    fn read(_bytes: &mut Reader) -> Self {
        Unsent
    }

    fn rust(&self) -> String {
        "Default::default()".into()
    }
}

/// Bytes that are no message, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Malformed(&'static str);

/// The value that consists of all of `bytes`.
///
/// # Errors
///
/// If the bytes are not exactly one value of this type.
pub fn from_bytes<T: Message>(bytes: &[u8]) -> Result<T, Malformed> {
    let mut reader = Reader { bytes, error: None };
    let value = T::read(&mut reader);
    if !reader.bytes.is_empty() {
        reader.fail("bytes are left after its end");
    }
    reader.error.map_or(Ok(value), Err)
}

/// Bytes that are not read yet. After an error they are all zero and have no end, so that only [`from_bytes`] and lists ask for it.
#[derive(Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
    error: Option<Malformed>,
}

impl Reader<'_> {
    #[doc(hidden)]
    pub fn fail(&mut self, why: &'static str) {
        self.error.get_or_insert(Malformed(why));
        self.bytes = &[];
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        if let Some((first, rest)) = self.bytes.split_first_chunk() {
            self.bytes = rest;
            return *first;
        }
        self.fail("it ends too early");
        [0; N]
    }
}

/// The bytes of a value.
pub fn to_bytes(value: &impl Message) -> Vec<u8> {
    let mut bytes = Vec::new();
    value.write(&mut bytes);
    bytes
}

macro_rules! numbers {
    ($($Type:ty)*) => {
        $(impl Message for $Type {
            fn write(&self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }

            fn read(bytes: &mut Reader) -> Self {
                <$Type>::from_le_bytes(bytes.take())
            }

            fn rust(&self) -> String {
                let digits = format!("{self:?}");
                match &*digits {
                    "NaN" => concat!(stringify!($Type), "::NAN").into(),
                    "inf" => concat!(stringify!($Type), "::INFINITY").into(),
                    "-inf" => concat!(stringify!($Type), "::NEG_INFINITY").into(),
                    _ => digits,
                }
            }
        })*
    };
}

numbers! { u8 u32 u64 i64 f32 f64 }

/// Types that are written as another one.
macro_rules! like {
    ($($Type:ty: |$value:ident| $to:expr, $Other:ty, |$other:ident, $bytes:ident| $from:expr, $rust:expr;)*) => {
        $(impl Message for $Type {
            fn write(&self, bytes: &mut Vec<u8>) {
                let $value = self;
                $to.write(bytes);
            }

            fn read($bytes: &mut Reader) -> Self {
                let $other = <$Other>::read($bytes);
                $from
            }

            fn rust(&self) -> String {
                let $value = self;
                $rust
            }
        })*
    };
}

like! {
    usize: |n| (*n as u64), u64, |n, bytes| n.try_into().unwrap_or_else(|_| {
        bytes.fail("a number is too large");
        0
    }), n.to_string();
    bool: |truth| u8::from(*truth), u8, |byte, bytes| {
        if byte > 1 {
            bytes.fail("a truth value is neither 0 nor 1");
        }
        byte == 1
    }, truth.to_string();
    Vec2: |v| v.to_array(), [f32; 2], |v, bytes| v.into(), each("vec2(", &v.to_array(), ")");
    Vec3: |v| v.to_array(), [f32; 3], |v, bytes| v.into(), each("vec3(", &v.to_array(), ")");
    Vec3A: |v| v.to_array(), [f32; 3], |v, bytes| v.into(), each("vec3a(", &v.to_array(), ")");
    DVec3: |v| v.to_array(), [f64; 3], |v, bytes| v.into(), each("dvec3(", &v.to_array(), ")");
    UVec2: |v| v.to_array(), [u32; 2], |v, bytes| v.into(), each("uvec2(", &v.to_array(), ")");
    UVec3: |v| v.to_array(), [u32; 3], |v, bytes| v.into(), each("uvec3(", &v.to_array(), ")");
    PathBuf: |path| path.to_string_lossy().into_owned(), String, |path, bytes| path.into(), format!("{path:?}.into()");
    Affine3A: |transform| transform.to_cols_array(), [f32; 12], |columns, bytes| Affine3A::from_cols_array(&columns), {
        let columns = [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis];
        each("Affine3A::from_cols(", &[&columns[..], &[transform.translation]].concat(), ")")
    };
}

impl Message for String {
    fn write(&self, bytes: &mut Vec<u8>) {
        write_length(self.len(), bytes);
        bytes.extend_from_slice(self.as_bytes());
    }

    fn read(bytes: &mut Reader) -> Self {
        String::from_utf8(Vec::read(bytes)).unwrap_or_else(|_| {
            bytes.fail("a text is not UTF-8");
            String::new()
        })
    }

    fn rust(&self) -> String {
        format!("{self:?}.into()")
    }
}

/// A list of more than `u32::MAX` items makes a message that is too long to be sent.
fn write_length(length: usize, bytes: &mut Vec<u8>) {
    u32::try_from(length).unwrap_or(u32::MAX).write(bytes);
}

impl<T: Message> Message for Vec<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        write_length(self.len(), bytes);
        for item in self {
            item.write(bytes);
        }
    }

    fn read(bytes: &mut Reader) -> Self {
        let length = u32::read(bytes) as usize;
        // Most items have about as many bytes in a message as in memory.
        let mut items = Vec::with_capacity(length.min(bytes.bytes.len() / size_of::<T>().max(1)));
        while items.len() < length && bytes.error.is_none() {
            items.push(T::read(bytes));
        }
        items
    }

    fn rust(&self) -> String {
        each("vec![", self, "]")
    }
}

impl<T: Message> Message for Option<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.is_some().write(bytes);
        if let Some(value) = self {
            value.write(bytes);
        }
    }

    fn read(bytes: &mut Reader) -> Self {
        bool::read(bytes).then(|| T::read(bytes))
    }

    fn rust(&self) -> String {
        self.as_ref().map_or("None".into(), |value| format!("Some({})", value.rust()))
    }
}

macro_rules! pointers {
    ($($Pointer:ident)*) => {
        $(impl<T: Message> Message for $Pointer<T> {
            fn write(&self, bytes: &mut Vec<u8>) {
                (**self).write(bytes);
            }

            fn read(bytes: &mut Reader) -> Self {
                $Pointer::new(T::read(bytes))
            }

            fn rust(&self) -> String {
                format!(concat!(stringify!($Pointer), "::new({})"), (**self).rust())
            }
        })*
    };
}

pointers! { Box Arc }

impl<T: Message, const N: usize> Message for [T; N] {
    fn write(&self, bytes: &mut Vec<u8>) {
        for part in self {
            part.write(bytes);
        }
    }

    fn read(bytes: &mut Reader) -> Self {
        std::array::from_fn(|_| T::read(bytes))
    }

    fn rust(&self) -> String {
        each("[", self, "]")
    }
}

macro_rules! tuples {
    ($(($($T:ident $part:tt),*))*) => {
        $(impl<$($T: Message),*> Message for ($($T,)*) {
            fn write(&self, bytes: &mut Vec<u8>) {
                $(self.$part.write(bytes);)*
            }

            fn read(bytes: &mut Reader) -> Self {
                ($($T::read(bytes),)*)
            }

            fn rust(&self) -> String {
                parts("", &[$(&self.$part),*])
            }
        })*
    };
}

tuples! { (A 0, B 1) (A 0, B 1, C 2) (A 0, B 1, C 2, D 3) }

/// Implements [`Message`] for a structure, `Ray { origin, direction }` or `Child { 0 }` for one without names of fields, or for
/// an enumeration, `enum Shape { Sphere(sphere), Box { min, max }, Nothing }`. The order is that of the bytes. A field after a
/// semicolon is not sent, and read as its default. `Cone as SpotCone { … }` has another name in [`Message::rust`], because two
/// types share a name.
#[macro_export]
#[doc(hidden)]
macro_rules! message {
    (enum $Name:ident {
        $($Variant:ident $(($($part:ident),+))? $({ $($field:ident),+ $(; $unsent:ident)? })?),* $(,)?
    }) => {
        impl $crate::message::Message for $Name {
            #[allow(unused_assignments, reason = "the number after the last variant")]
            fn write(&self, bytes: &mut Vec<u8>) {
                match self {
                    $($Name::$Variant { .. } => {})* // The compiler misses none.
                }
                let mut number = 0;
                $(
                    if let $Name::$Variant $(($($part),+))? $({ $($field,)+ .. })? = self {
                        bytes.push(number);
                        $($($crate::message::Message::write($part, bytes);)+)?
                        $($($crate::message::Message::write($field, bytes);)+)?
                        return;
                    }
                    number += 1;
                )*
            }

            #[allow(unused_assignments, reason = "the number after the last variant")]
            fn read(bytes: &mut $crate::message::Reader) -> Self {
                let variant = <u8 as $crate::message::Message>::read(bytes);
                let mut number = 0;
                $(
                    if variant == number {
                        $($(let $part = $crate::message::Message::read(bytes);)+)?
                        $($(let $field = $crate::message::Message::read(bytes);)+)?
                        return $Name::$Variant $(($($part),+))? $({ $($field,)+ $($unsent: Default::default())? })?;
                    }
                    number += 1;
                )*
                // Only zeros follow an error, so this returns the first variant.
                bytes.fail("there is no variant of this number");
                <Self as $crate::message::Message>::read(bytes)
            }

            fn rust(&self) -> String {
                $(
                    if let $Name::$Variant $(($($part),+))? $({ $($field,)+ .. })? = self {
                        let name = concat!(stringify!($Name), "::", stringify!($Variant));
                        $(return $crate::message::parts(name, &[$($part as &dyn $crate::message::Message),+]);)?
                        $(return $crate::message::fields(name, &[
                            $((stringify!($field), $field as &dyn $crate::message::Message),)+
                            $((stringify!($unsent), &$crate::message::Unsent))?
                        ]);)?
                        #[allow(unreachable_code, reason = "a variant with parts has returned")]
                        return name.into();
                    }
                )*
                String::new()
            }
        }
    };
    ($Name:ident $(as $Rust:ident)? $(<$T:ident>)? { $($field:tt),* $(,)? }) => {
        impl$(<$T: $crate::message::Message>)? $crate::message::Message for $Name$(<$T>)? {
            fn write(&self, bytes: &mut Vec<u8>) {
                $($crate::message::Message::write(&self.$field, bytes);)*
            }

            fn read(bytes: &mut $crate::message::Reader) -> Self {
                $Name { $($field: $crate::message::Message::read(bytes)),* }
            }

            fn rust(&self) -> String {
                let names = [stringify!($Name) $(, stringify!($Rust))?];
                let fields = [$((stringify!($field), &self.$field as &dyn $crate::message::Message)),*];
                $crate::message::fields(names[names.len() - 1], &fields)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Debug, PartialEq)]
    enum Shape {
        Dot,
        Disk(f32, bool),
        Named { name: String, at: Option<Vec3>, cost: usize },
    }

    crate::message! { enum Shape { Dot, Disk(radius, filled), Named { name, at; cost } } }

    #[test]
    fn values_come_back_and_no_prefix_of_them_does() {
        let shapes = vec![
            Shape::Dot,
            Shape::Disk(f32::NEG_INFINITY, true),
            Shape::Named { name: "größer".into(), at: Some(Vec3::new(0.1, -0.0, 3.0)), cost: 0 },
        ];
        let bytes = to_bytes(&(shapes.clone(), [1u8, 2, 3], Box::new(7usize)));
        let back: (Vec<Shape>, [u8; 3], Box<usize>) = from_bytes(&bytes).expect("a message");
        assert_eq!(back, (shapes, [1, 2, 3], Box::new(7)));
        for end in 0..bytes.len() {
            assert!(from_bytes::<(Vec<Shape>, [u8; 3], Box<usize>)>(&bytes[..end]).is_err(), "{end} bytes");
        }
        assert!(from_bytes::<u8>(&[1, 2]).is_err());
    }

    #[test]
    fn what_is_no_value_is_an_error() {
        assert!(from_bytes::<Shape>(&[3]).is_err());
        assert!(from_bytes::<bool>(&[2]).is_err());
        assert!(from_bytes::<String>(&[1, 0, 0, 0, 0xff]).is_err());
        // A length that nothing follows allocates nothing.
        assert!(from_bytes::<Vec<u64>>(&u32::MAX.to_le_bytes()).is_err());
    }

    #[test]
    fn unsent_fields_get_their_default() {
        let bytes = to_bytes(&Shape::Named { name: String::new(), at: None, cost: 9 });
        assert_eq!(from_bytes(&bytes), Ok(Shape::Named { name: String::new(), at: None, cost: 0 }));
    }
}
