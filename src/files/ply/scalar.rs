//! The number types of PLY files.

use super::text::number;

/// A number type of a PLY file: a signed or unsigned integer of 8, 16, 32 or 64 bits, or a float of 32 or 64
/// bits. The format has no integers of 64 bits, but libraries write them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Float32,
    Float64,
    /// Another type that takes this many bytes; its numbers can only be skipped in a binary file.
    Other(usize),
}

/// The byte order of a binary file: whether the least (little-endian) or the most significant byte comes
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    LittleEndian,
    BigEndian,
}

impl Scalar {
    /// Both names of each type: that of the first PLY files, and the later one that gives the number of bits.
    pub const NAMES: [(&str, Scalar); 18] = [
        ("char", Scalar::Int8),
        ("uchar", Scalar::Uint8),
        ("short", Scalar::Int16),
        ("ushort", Scalar::Uint16),
        ("int", Scalar::Int32),
        ("uint", Scalar::Uint32),
        ("float", Scalar::Float32),
        ("double", Scalar::Float64),
        ("int8", Scalar::Int8),
        ("uint8", Scalar::Uint8),
        ("int16", Scalar::Int16),
        ("uint16", Scalar::Uint16),
        ("int32", Scalar::Int32),
        ("uint32", Scalar::Uint32),
        ("int64", Scalar::Int64),
        ("uint64", Scalar::Uint64),
        ("float32", Scalar::Float32),
        ("float64", Scalar::Float64),
    ];

    /// The type with this name in a header, if there is one; case matters. A name that ends in a number of bits, such as
    /// `float16`, gives the size of a type that is not known.
    pub fn named(name: &str) -> Option<Scalar> {
        if let Some(&(_, scalar)) = Self::NAMES.iter().find(|(known, _)| *known == name) {
            return Some(scalar);
        }
        let bits: usize = name.trim_start_matches(|letter: char| letter.is_ascii_lowercase()).parse().ok()?;
        matches!(bits, 8 | 16 | 32 | 64 | 128).then_some(Scalar::Other(bits / 8))
    }

    /// The number of bytes of this type in a binary file.
    pub fn size(self) -> usize {
        match self {
            Scalar::Int8 | Scalar::Uint8 => 1,
            Scalar::Int16 | Scalar::Uint16 => 2,
            Scalar::Int32 | Scalar::Uint32 | Scalar::Float32 => 4,
            Scalar::Int64 | Scalar::Uint64 | Scalar::Float64 => 8,
            Scalar::Other(size) => size,
        }
    }

    /// The value of `bytes`, which must be [`Scalar::size`] bytes in byte order `order`. An `f64` represents
    /// each value exactly, except integers beyond 2^53; a number of another type is NaN.
    pub fn decode(self, bytes: &[u8], order: ByteOrder) -> f64 {
        if let Scalar::Other(_) = self {
            return f64::NAN;
        }
        // Reverse the bytes of a big-endian number, so that all numbers are decoded as little-endian.
        let mut little = [0; 8];
        let used = &mut little[..bytes.len()];
        used.copy_from_slice(bytes);
        if order == ByteOrder::BigEndian {
            used.reverse();
        }

        let [b0, b1, b2, b3, ..] = little;
        match self {
            Scalar::Int8 => i8::from_le_bytes([b0]).into(),
            Scalar::Uint8 => b0.into(),
            Scalar::Int16 => i16::from_le_bytes([b0, b1]).into(),
            Scalar::Uint16 => u16::from_le_bytes([b0, b1]).into(),
            Scalar::Int32 => i32::from_le_bytes([b0, b1, b2, b3]).into(),
            Scalar::Uint32 => u32::from_le_bytes([b0, b1, b2, b3]).into(),
            Scalar::Float32 => f32::from_le_bytes([b0, b1, b2, b3]).into(),
            Scalar::Int64 => i64::from_le_bytes(little) as f64,
            Scalar::Uint64 => u64::from_le_bytes(little) as f64,
            Scalar::Float64 | Scalar::Other(_) => f64::from_le_bytes(little),
        }
    }

    /// The number that `word` spells in an ASCII file, if it spells one; it may be NaN or infinite. The range
    /// of an integer type is not checked: 300 is accepted as a `uchar`, because no byte has to hold it.
    pub fn parse(self, word: &[u8]) -> Option<f64> {
        let word = std::str::from_utf8(word).ok()?;
        let double = number(word)?;
        // A number may have more digits than its type `float` holds; they are kept. But an `f64` that lies half-way between two
        // `f32` may be rounded to the wrong one: then take the `f32`.
        match word.parse::<f32>() {
            Ok(single) if self == Scalar::Float32 && single != double as f32 => Some(single.into()),
            _ => Some(double),
        }
    }
}
