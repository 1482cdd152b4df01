//! The boxes of primitives as the binned builder sees them, and its bins.

use crate::aabb::Aabb;
use crate::message;
use glam::{Vec3A, Vec4};

/// A primitive as the binned builder sees it: its number and its box, in 32 bytes.
///
/// Each corner of the box is a vector of four numbers, so that one instruction takes the minimum of all coordinates. The
/// fourth number of `low` holds the number of the primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct PrimitiveBox {
    /// The smallest coordinates, and the bits of the number.
    pub low: [f32; 4],
    /// The largest coordinates, and 0.
    pub high: [f32; 4],
}

message! { PrimitiveBox { low, high } }

/// The bits of a number are those of `2.0` plus the index, which never makes a NaN, an infinity or a subnormal number: with
/// these some instructions are slow.
const ID_BITS: u32 = 0x4000_0000;

impl PrimitiveBox {
    /// The largest number of a primitive.
    pub const MAX_ID: u32 = 0x3f7f_ffff;

    /// The primitive with this number and box. An empty box, and a box with NaN, becomes [`Aabb::EMPTY`], which changes no
    /// union.
    ///
    /// # Panics
    ///
    /// If `id` is above [`PrimitiveBox::MAX_ID`].
    #[inline]
    pub fn new(id: u32, bounds: &Aabb) -> Self {
        assert!(id <= Self::MAX_ID, "a hierarchy over more than a billion primitives");
        let bounds = if bounds.is_empty() { &Aabb::EMPTY } else { bounds };
        let [low, high] = [bounds.min, bounds.max];
        PrimitiveBox { low: low.extend(f32::from_bits(id | ID_BITS)).into(), high: high.extend(0.0).into() }
    }

    /// The number of the primitive.
    #[inline]
    pub fn id(&self) -> u32 {
        self.low[3].to_bits() & !ID_BITS
    }

    /// The corner of the box with the smallest coordinates, in world units; +∞ for an empty box.
    #[inline(always)]
    pub fn low(&self) -> Vec3A {
        Vec3A::from_vec4(Vec4::from_array(self.low))
    }

    /// The corner of the box with the largest coordinates, in world units; -∞ for an empty box.
    #[inline(always)]
    pub fn high(&self) -> Vec3A {
        Vec3A::from_vec4(Vec4::from_array(self.high))
    }

    /// Twice the centre of the box, by which primitives are sorted into bins; NaN for an empty box. The builder does not
    /// halve it, because that would change no bin.
    #[inline(always)]
    pub fn twice_centroid(&self) -> Vec3A {
        self.low() + self.high()
    }
}

/// A box whose corners are in registers of four numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxA {
    /// The corner with the smallest coordinate on each axis.
    pub low: Vec3A,
    /// The corner with the largest coordinate on each axis.
    pub high: Vec3A,
}

message! { BoxA { low, high } }

impl BoxA {
    /// The box that contains no point; the neutral element of union.
    pub const EMPTY: BoxA = BoxA { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };
}

/// The largest number of bins along each axis.
pub const MAX_BINS: usize = 32;

/// Where the bins of a node lie: `n_bins` equal bins along each axis, over the box around twice the centroids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BinGrid {
    /// The smallest value of twice the centroid, on each axis.
    pub low: Vec3A,
    /// The number of bins per unit, on each axis; 0 on an axis along which all centroids are equal.
    pub scale: Vec3A,
    /// The number of bins along each axis, `2..=MAX_BINS`.
    pub n_bins: u32,
}

message! { BinGrid { low, scale, n_bins } }

/// One bin: the primitives whose centroid lies in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The box around the boxes of these primitives.
    pub bounds: BoxA,
    /// The number of these primitives.
    pub count: u32,
}

message! { Bin { bounds, count } }

impl Bin {
    /// A bin without primitives.
    pub const EMPTY: Bin = Bin { bounds: BoxA::EMPTY, count: 0 };
}

/// The bins of a node: `bins[axis][i]`. Bins from `n_bins` on are empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bins(pub [[Bin; MAX_BINS]; 3]);

message! { Bins { 0 } }

impl Bins {
    /// Bins without primitives.
    pub const EMPTY: Bins = Bins([[Bin::EMPTY; MAX_BINS]; 3]);
}

/// A division of the primitives of a node: those in bins before `bin` along `axis` go to the left side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BinSplit {
    /// 0 for x, 1 for y, 2 for z.
    pub axis: u32,
    /// The first bin of the right side, at least 1.
    pub bin: u32,
    /// The cost of both sides by the surface area heuristic: `A(L) c(L) + A(R) c(R)` with the cost `c` of a leaf's blocks and
    /// half the surface area `A` of the box of a side, in square world units.
    pub cost: f32,
}

message! { BinSplit { axis, bin, cost } }
