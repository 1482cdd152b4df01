//! The eight number types of PLY files.

/// A number type of a PLY file: a signed or unsigned integer of 8, 16 or 32 bits, or a float of 32 or 64
/// bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64,
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
    pub const NAMES: [(&str, Scalar); 16] = [
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
        ("float32", Scalar::Float32),
        ("float64", Scalar::Float64),
    ];

    /// The type with this name in a header, if there is one; case matters.
    pub fn named(name: &str) -> Option<Scalar> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|&(_, scalar)| scalar)
    }

    /// The number of bytes of this type in a binary file.
    pub fn size(self) -> usize {
        match self {
            Scalar::Int8 | Scalar::Uint8 => 1,
            Scalar::Int16 | Scalar::Uint16 => 2,
            Scalar::Int32 | Scalar::Uint32 | Scalar::Float32 => 4,
            Scalar::Float64 => 8,
        }
    }

    /// The value of `bytes`, which must be [`Scalar::size`] bytes in byte order `order`. An `f64` represents
    /// each value of the eight types exactly.
    ///
    /// # Panics
    ///
    /// If there are more than eight bytes.
    pub fn decode(self, bytes: &[u8], order: ByteOrder) -> f64 {
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
            Scalar::Float64 => f64::from_le_bytes(little),
        }
    }

    /// The number that `word` spells in an ASCII file, if it spells one; it may be NaN or infinite. The range
    /// of an integer type is not checked: 300 is accepted as a `uchar`, because no byte has to hold it.
    pub fn parse(self, word: &[u8]) -> Option<f64> {
        let word = std::str::from_utf8(word).ok()?;
        match self {
            // Parse as `f32` directly, because by way of `f64` a number is rounded twice, and can be one step off.
            Scalar::Float32 => word.parse::<f32>().ok().map(f64::from),
            _ => word.parse().ok(),
        }
    }
}
