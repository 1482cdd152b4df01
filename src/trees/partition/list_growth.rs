//! The bound on the references of a partition: how often the builder of a tree may list primitives again.

/// The most references per primitive in the leaves of a partition. A reference is one entry in the list of
/// one leaf or cell.
///
/// Trees over the scenes of the kit have up to 9. With 16 references of 4 bytes, a million primitives take 64
/// MB. A ray searches each leaf at most once, so it never tests more than 16 times as many primitives as brute
/// force, however much the primitives overlap.
///
/// The bound costs little where primitives do not overlap much: `raykata render scenes/stage2.toml
/// --accelerator octree --size 64x36 --spp 1` counts 24,236 references and 19,540 primitive tests with 16, and
/// 1,229,622 references and 19,099 primitive tests without a bound.
pub const MOST_REFERENCES: usize = 16;

/// How many times as many references there are as at the root, on the way from the root to a node: the product
/// over all divisions on the way of the references after a division per reference before it.
///
/// If no node has a growth above [`MOST_REFERENCES`], all leaves together have at most `MOST_REFERENCES · n`
/// references to `n` primitives. Proof: let each node have the weight (number of its references) / (its
/// growth). The weights of the children add up to the weight of their parent, so those of all leaves add up to
/// that of the root, which is `n`. Each leaf has at most `MOST_REFERENCES` times its weight in references.
///
/// The growth of a node depends only on its primitives and those of the nodes above it. So the tree does not
/// depend on the order in which nodes are built, which it would if a builder counted down a total.
///
/// ```
/// use raykata::partition::ListGrowth;
/// // 100 long boxes of which each is in 3 of 4 cells: two divisions are allowed, and a third is not.
/// let once = ListGrowth::ROOT.divide(100, 300).unwrap();
/// let twice = once.divide(75, 225).unwrap();
/// assert_eq!(twice.divide(56, 168), None);
/// // A division that repeats no primitive is always allowed.
/// assert_eq!(twice.divide(56, 56), Some(twice));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListGrowth(f64);

impl ListGrowth {
    /// The growth of the root, 1.
    pub const ROOT: ListGrowth = ListGrowth(1.0);

    /// The growth of the children of a node with this growth. The node lists `before` primitives, above 0, and
    /// its children together list `after`. `None` if the growth would be above [`MOST_REFERENCES`]; then the
    /// node must be a leaf.
    pub fn divide(self, before: usize, after: usize) -> Option<ListGrowth> {
        let growth = self.0 * after as f64 / before as f64;
        (growth <= MOST_REFERENCES as f64).then_some(ListGrowth(growth))
    }
}
