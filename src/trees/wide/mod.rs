//! Bounding volume hierarchies as fast rays need them (stage 12), as data: nodes of 32 bytes in one array, nodes with eight
//! children whose boxes one instruction tests at once, and blocks of eight triangles.
//!
//! Building and searching them are exercises.

mod boxes;
mod forks;
pub mod simd;

pub use boxes::{Bin, BinGrid, BinSplit, Bins, BoxA, MAX_BINS, PrimitiveBox};
pub use forks::{Fork, ForkKind, Forks};

use crate::aabb::Aabb;
use crate::bvh::PrimitiveHit;
use crate::message;
use crate::ray::Ray;
use crate::rounding::UNIT_ROUNDOFF;
use crate::shape::Triangle;
use glam::{DVec3, Vec3, Vec3A};

/// A node of a flat tree: its box, and its two children or its primitives, in 32 bytes. Two nodes fill a line of the cache.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct FlatNode {
    /// The corner of the box with the smallest coordinates, in world units.
    pub low: Vec3,
    /// For an inner node the index of its first child in [`FlatTree::nodes`]; the second child follows. For a leaf the index of
    /// its first primitive in [`FlatTree::order`].
    pub first: u32,
    /// The corner of the box with the largest coordinates, in world units.
    pub high: Vec3,
    /// The number of primitives of a leaf; 0 for an inner node.
    pub count: u32,
}

message! { FlatNode { low, first, high, count } }

impl FlatNode {
    /// Whether the node is a leaf.
    #[inline]
    pub fn is_leaf(&self) -> bool {
        self.count > 0
    }

    /// The box of the node.
    #[inline]
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.low, self.high)
    }
}

/// A binary bounding volume hierarchy in one array. Node 0 is the root, and a parent comes before its children. The two children
/// of a node are neighbours, and the nodes below the first child come before those below the second (depth first). So there is
/// one order of the nodes. A tree over no primitives has no nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatTree {
    /// All nodes.
    pub nodes: Vec<FlatNode>,
    /// The numbers of all primitives, each exactly once. The primitives of a leaf are adjacent.
    pub order: Vec<u32>,
}

message! { FlatTree { nodes, order } }

/// What a parallel build returns: the tree, and where it forked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForkedTree {
    /// The tree, the same as without forks.
    pub tree: FlatTree,
    /// The forks, in the order of [`Forks::into_log`].
    pub forks: Vec<Fork>,
}

message! { ForkedTree { tree, forks } }

/// The cost of visiting an inner node of a binary tree, in the surface area heuristic of stage 12.
pub const NODE_COST: f32 = 0.25;

/// The cost of visiting a node of a wide tree over triangles, in the surface area heuristic of stage 12; measured.
pub const WIDE_NODE_COST: f32 = 6.0;

/// The cost of visiting a node of a wide tree over objects, which are tested one by one. With that of triangles, a frame of
/// `scenes/forest.toml` took half as long again.
pub const WIDE_NODE_COST_OF_OBJECTS: f32 = 1.0;

/// The cost of testing a block of eight triangles, in the surface area heuristic of stage 12.
pub const BLOCK_COST: f32 = 1.0;

/// The number of triangles in a block.
pub const BLOCK: usize = 8;

/// The largest number of primitives that a leaf of a wide tree can hold.
pub const MAX_LEAF: usize = 32;

/// What one of the eight places of a wide node holds, in 32 bits.
///
/// A leaf is its first block of triangles and its number of primitives, which fill the blocks in order: only the last block
/// may have free lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Child(pub u32);

message! { Child { 0 } }

/// What a [`Child`] means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChildContents {
    /// The index of a node in [`WideTree::nodes`].
    Inner(u32),
    /// The primitives of a leaf.
    Leaf {
        /// The index of the first block in [`WideTree::blocks`].
        block: u32,
        /// The number of primitives, at least 1.
        count: u32,
    },
}

impl Child {
    const LEAF: u32 = 1 << 31;
    const BLOCK_BITS: u32 = 26;

    /// The root of a wide tree.
    pub const ROOT: Child = Child(0);

    /// A place that holds nothing. Its box is [`Aabb::EMPTY`]. The root is never a child, so its index is free.
    pub const EMPTY: Child = Child(0);

    /// An inner node.
    ///
    /// # Panics
    ///
    /// If the index is 2³¹ or more.
    pub fn inner(node: u32) -> Child {
        assert!(node < Self::LEAF, "a wide tree with too many nodes");
        Child(node)
    }

    /// A leaf.
    ///
    /// # Panics
    ///
    /// If `count` is 0 or above [`MAX_LEAF`], or if `block` is 2²⁶ or more.
    pub fn leaf(block: u32, count: u32) -> Child {
        assert!(0 < count && count as usize <= MAX_LEAF, "a leaf of {count} primitives");
        assert!(block < 1 << Self::BLOCK_BITS, "a wide tree with too many blocks");
        Child(Self::LEAF | (count - 1) << Self::BLOCK_BITS | block)
    }

    /// What the child is.
    #[inline(always)]
    pub fn contents(self) -> ChildContents {
        if self.0 & Self::LEAF == 0 {
            return ChildContents::Inner(self.0);
        }
        let block = self.0 & ((1 << Self::BLOCK_BITS) - 1);
        ChildContents::Leaf { block, count: ((self.0 >> Self::BLOCK_BITS) & 31) + 1 }
    }

    /// The child as the lower 32 bits of a key that is sorted by distance, see [`Child::of_key`].
    #[inline(always)]
    pub fn key(self, t: f32) -> u64 {
        u64::from(t.to_bits()) << 32 | u64::from(self.0)
    }

    /// The child and the distance of a key. Keys of distances that are not negative are in the order of the distances.
    #[inline(always)]
    pub fn of_key(key: u64) -> (Child, f32) {
        (Child(key as u32), f32::from_bits((key >> 32) as u32))
    }
}

/// A node with up to eight children, in 256 bytes: the boxes of all children as a structure of arrays.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct WideNode {
    /// `bounds[axis][side][i]` is a coordinate of the box of child `i`: the smallest for side 0, the largest for side 1. A place
    /// without a child has +∞ and -∞.
    pub bounds: [[[f32; 8]; 2]; 3],
    /// What the eight places hold. The children come first, then the empty places.
    pub children: [Child; 8],
}

message! { WideNode { bounds, children } }

impl WideNode {
    /// A node without children.
    pub const EMPTY: WideNode =
        WideNode { bounds: [[[f32::INFINITY; 8], [f32::NEG_INFINITY; 8]]; 3], children: [Child::EMPTY; 8] };

    /// Puts `child` with its box into place `index`.
    ///
    /// # Panics
    ///
    /// If `index` is 8 or more.
    pub fn set(&mut self, index: usize, bounds: &Aabb, child: Child) {
        for axis in 0..3 {
            self.bounds[axis][0][index] = bounds.min[axis];
            self.bounds[axis][1][index] = bounds.max[axis];
        }
        self.children[index] = child;
    }

    /// The box of place `index`.
    pub fn child_bounds(&self, index: usize) -> Aabb {
        let corner =
            |side: usize| Vec3::from_array(std::array::from_fn(|axis| self.bounds[axis][side][index]));
        Aabb::new(corner(0), corner(1))
    }

    /// The number of children.
    #[inline]
    pub fn n_children(&self) -> u32 {
        self.children.iter().filter(|&&child| child != Child::EMPTY).count() as u32
    }
}

/// The numbers of up to eight primitives that are tested at once. Free lanes have [`NO_PRIMITIVE`].
pub type BlockIds = [u32; BLOCK];

/// The number in a free lane of a block.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// A hierarchy with eight children per node. Node 0 is the root; a tree over no primitives has no nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WideTree {
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<WideNode>,
    /// The blocks of all leaves.
    pub blocks: Vec<BlockIds>,
}

message! { WideTree { nodes, blocks } }

/// The largest coordinate for which triangles are tested eight at once: a product of three such numbers does not overflow.
pub const LARGEST: f32 = (1u64 << 40) as f32;

/// Eight triangles as a structure of arrays, in 352 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct TriangleBlock {
    /// `corners[corner][axis][lane]`. A lane has NaN if its primitive is not a triangle, if the lane is free, or if
    /// a coordinate is above [`LARGEST`].
    pub corners: [[[f32; BLOCK]; 3]; 3],
    /// For each lane the largest coordinate of `b - a` and `c - a`, without its sign, by which rounding errors are bounded.
    pub size: [f32; BLOCK],
    /// The numbers of the primitives.
    pub ids: BlockIds,
}

message! { TriangleBlock { corners, size, ids } }

impl TriangleBlock {
    /// The block of the primitives `ids`; `triangle` returns the triangle of a primitive, or `None` if it is another shape.
    pub fn new(ids: BlockIds, triangle: impl Fn(u32) -> Option<Triangle>) -> TriangleBlock {
        let mut corners = [[[f32::NAN; BLOCK]; 3]; 3];
        let mut size = [f32::NAN; BLOCK];
        for (lane, &id) in ids.iter().enumerate().filter(|(_, id)| **id != NO_PRIMITIVE) {
            let Some(Triangle { a, b, c }) = triangle(id) else { continue };
            if !(a.abs().max(b.abs()).max(c.abs()).max_element() <= LARGEST) {
                continue;
            }
            size[lane] = (b - a).abs().max((c - a).abs()).max_element();
            for (corner, point) in [a, b, c].into_iter().enumerate() {
                for axis in 0..3 {
                    corners[corner][axis][lane] = point[axis];
                }
            }
        }
        TriangleBlock { corners, size, ids }
    }

    /// The `t` at which `ray` meets the plane of the triangle in `lane`, by the operations of the watertight test. `None` if
    /// rounding errors may change one of the first 26 binary digits.
    ///
    /// Where a ray passes through the inside of a triangle for certain, this is all that remains to be computed, and it takes a
    /// third of the time of the whole test.
    #[inline(always)]
    pub fn t_of_plane(&self, lane: usize, ray: &Ray) -> Option<f32> {
        let Triangle { a, b, c } = self.triangle(lane);
        let [o, d, a, b, c] = [ray.origin, ray.direction, a, b, c].map(Vec3::as_dvec3);
        let (to_a, normal) = (a - o, (b - a).cross(c - a));
        let (distance, slope) = (to_a.dot(normal), d.dot(normal));
        // Both are sums of six products, at most 6 e² times the largest coordinate of a - o or d, with 16 roundings.
        // The size e was rounded to single precision.
        let size = f64::from(self.size[lane]) * (1.0 + f64::from(f32::EPSILON));
        let needed = f64::from(1 << 26) * 48.0 * f64::EPSILON * size * size;
        let larger = |p: f64, q: f64| if p > q { p } else { q };
        let largest = |p: DVec3| larger(larger(p.x.abs(), p.y.abs()), p.z.abs());
        let is_right = (distance.abs() > needed * largest(to_a)) & (slope.abs() > needed * largest(d));
        is_right.then(|| (distance / slope) as f32)
    }

    /// The triangle of a lane; its coordinates are NaN if the lane holds none.
    #[inline(always)]
    pub fn triangle(&self, lane: usize) -> Triangle {
        let [a, b, c] = &self.corners;
        Triangle {
            a: Vec3::new(a[0][lane], a[1][lane], a[2][lane]),
            b: Vec3::new(b[0][lane], b[1][lane], b[2][lane]),
            c: Vec3::new(c[0][lane], c[1][lane], c[2][lane]),
        }
    }
}

/// A ray as wide nodes and blocks need it. It is made once per ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WideRay {
    /// For the near and the far planes of boxes the factors of `t = plane · scale + offset`: `1 / direction`, changed by more than
    /// the rounding errors, such that near planes are not too late and far planes not too early. Always finite and never 0.
    pub scale: [Vec3A; 2],
    /// The summands of `t = plane · scale + offset`: `-origin / direction`, changed in the same way. Always finite.
    pub offset: [Vec3A; 2],
    /// For each axis the side of a box that the ray passes first: 0 for the smallest coordinate, 1 for the largest.
    pub near_side: [usize; 3],
    /// The lower end of the range, which is not negative.
    pub t_min: f32,
    /// Three axes in cyclic order. The last one is the axis along which the ray moves fastest.
    pub axes: [usize; 3],
    /// The origin in world units, in the order of the axes.
    pub origin: [f32; 3],
    /// `-d_x / d_z` and `-d_y / d_z`, with z for the last axis. A point moved by `z` times these lies in the ray's own plane.
    pub shear: [f32; 2],
    /// `1 / d_z`.
    pub per_z: f32,
    /// Whether triangles may be tested eight at once: no coordinate of the ray is above [`LARGEST`].
    pub in_range: bool,
}

impl WideRay {
    /// Prepares a ray.
    #[inline(always)]
    pub fn new(ray: &Ray) -> WideRay {
        // Find the axis along which the ray moves fastest, without branches.
        let (o, d) = (Vec3A::from(ray.origin), Vec3A::from(ray.direction));
        let (speed, fastest, farthest) = (d.abs(), d.abs().max_element(), o.abs().max_element());
        let [not_x, not_y] = [usize::from(speed.x < fastest), usize::from(speed.y < fastest)];
        let z = not_x + (not_x & not_y);
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][z];
        let (origin, direction) = (o.to_array(), d.to_array());
        let per_z = 1.0 / direction[z];
        let in_range = farthest <= LARGEST && fastest <= LARGEST;

        // Where the reciprocal is infinite or very large, a smaller one takes its place, and planes are moved by more than
        // any t in the scene: they decide only whether the origin is between them.
        let (cap, reach) = if in_range { (CAP, 16.0 * LARGEST * per_z.abs()) } else { (1.0 / LARGEST, BIG) };
        let (reciprocal, cap) = (d.recip(), Vec3A::splat(cap));
        let is_capped = reciprocal.abs().cmpgt(cap);
        let inverse = reciprocal.abs().min(cap).copysign(d);
        let at_origin = o * inverse;
        let error = 16.0 * UNIT_ROUNDOFF * at_origin.abs()
            + Vec3A::select(is_capped, Vec3A::splat(reach.min(BIG)), Vec3A::ZERO);
        let negative = d.is_negative_bitmask() as usize;
        WideRay {
            scale: [inverse * (1.0 - 8.0 * UNIT_ROUNDOFF), inverse * (1.0 + 8.0 * UNIT_ROUNDOFF)],
            offset: [-at_origin - error, error - at_origin],
            near_side: [negative & 1, negative >> 1 & 1, negative >> 2 & 1],
            // The sum with 0 makes 0 of -0, whose bits would be those of a large number.
            t_min: ray.t_min + 0.0,
            axes,
            origin: [origin[axes[0]], origin[axes[1]], origin[z]],
            shear: [-direction[axes[0]] * per_z, -direction[axes[1]] * per_z],
            per_z,
            in_range,
        }
    }
}

/// Larger than any useful t and small enough for sums.
const BIG: f32 = (1u128 << 120) as f32;

/// The largest reciprocal: its product with a coordinate does not overflow.
const CAP: f32 = (1u128 << 80) as f32;

/// Which boxes of a wide node a ray enters, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entered {
    /// Bit `i` is set if the ray enters the box of child `i`.
    pub mask: u32,
    /// The `t` at which the ray enters the box of child `i`, not negative; any number where the bit is not set.
    pub t: [f32; 8],
}

message! { Entered { mask, t } }

/// What a filter says about the triangles of a block, a bit per lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Filtered {
    /// The triangles that the ray may hit. All others are missed.
    pub possible: u32,
    /// The triangles around the line of the ray, for certain: only `t` remains to be computed.
    pub certain: u32,
}

message! { Filtered { possible, certain } }

/// All that a search of a wide tree may ask. Each call is counted.
pub trait WideProbe {
    /// Which children of `node` the ray enters at `t_max` or before. Counts a node visit, and a box test per child.
    fn enter(&mut self, node: u32, t_max: f32) -> Entered;

    /// The children of `node`, whose boxes [`WideProbe::enter`] has tested.
    fn children(&self, node: u32) -> &[Child; 8];

    /// The lanes among the first `n` of `block` that the ray may hit before `t_max`, as bits: a lane without its bit is not
    /// hit. Counts a primitive test per lane, and a node visit for the first block of a leaf.
    fn candidates(&mut self, block: u32, n: u32, t_max: f32) -> u32;

    /// The hit of `ray` with the primitive in `lane` of `block`, or `None` if there is no hit with
    /// `ray.t_min < t < ray.t_max`.
    fn hit(&mut self, block: u32, lane: u32, ray: &Ray) -> Option<PrimitiveHit>;
}

/// The places that a search still has to visit, the last one on top.
///
/// The first 32 are in an array, which needs no allocation; a search that needs more is rare.
#[derive(Debug)]
pub struct Stack {
    fixed: [u64; Stack::FIXED],
    top: usize,
    more: Vec<u64>,
}

impl Stack {
    const FIXED: usize = 32;

    /// An empty stack.
    #[inline(always)]
    #[allow(clippy::new_without_default, reason = "a stack is a tool of one search and no value of its own")]
    pub fn new() -> Stack {
        Stack { fixed: [0; Stack::FIXED], top: 0, more: Vec::new() }
    }

    /// Puts a key on top.
    #[inline(always)]
    pub fn push(&mut self, key: u64) {
        if self.top < Stack::FIXED {
            self.fixed[self.top] = key;
        } else {
            Self::push_more(&mut self.more, key);
        }
        self.top += 1;
    }

    #[cold]
    fn push_more(more: &mut Vec<u64>, key: u64) {
        more.push(key);
    }

    /// Takes the key on top; `None` if the stack is empty.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<u64> {
        self.top = self.top.checked_sub(1)?;
        if self.top < Stack::FIXED { Some(self.fixed[self.top]) } else { self.more.pop() }
    }
}
