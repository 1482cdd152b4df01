//! The bounding volume hierarchy as data. Splitting, building and traversing it are exercises of stage 3.

use crate::aabb::Aabb;
use crate::message;
use crate::ray::Ray;
use glam::Vec3;

/// A primitive as the builder of a hierarchy sees it: its number, its box and the centre of that box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveRef {
    /// The number of the primitive. [`Bvh::set_leaf`] copies it into [`Bvh::order`].
    pub id: u32,
    /// A closed box that contains the primitive, in world units.
    pub bounds: Aabb,
    /// The centre of `bounds`, in world units, by which splits sort primitives.
    pub centroid: Vec3,
}

message! { PrimitiveRef { id, bounds, centroid } }

/// What a node contains: either two child nodes or a range of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contents {
    /// An inner node, which has exactly two children.
    Inner {
        /// The index of the left child in [`Bvh::nodes`].
        left: u32,
        /// The index of the right child in [`Bvh::nodes`].
        right: u32,
    },
    /// A leaf, which contains the primitives `order[first..first + count]`.
    Leaf {
        /// The index in [`Bvh::order`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf.
        count: u32,
    },
}

message! { enum Contents { Inner { left, right }, Leaf { first, count } } }

/// A node of a bounding volume hierarchy: a box and what it contains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// A closed box around all primitives below this node, in world units.
    pub bounds: Aabb,
    /// The node's children, or its primitives if it is a leaf.
    pub contents: Contents,
}

message! { Node { bounds, contents } }

/// A bounding volume hierarchy over primitives `0..n`. Node 0 is the root; a hierarchy over no primitives has
/// no nodes.
///
/// Two primitives in two leaves below a root:
///
/// ```
/// use glam::Vec3;
/// use raykata::aabb::Aabb;
/// use raykata::bvh::{Bvh, PrimitiveRef};
/// let boxes = [0.0, 2.0].map(|x| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0)));
/// let refs = [0, 1].map(|id| PrimitiveRef {
///     id: id as u32,
///     bounds: boxes[id],
///     centroid: boxes[id].min + 0.5,
/// });
/// let mut bvh = Bvh::for_primitives(2);
/// let root = bvh.add_node(Aabb::new(Vec3::ZERO, Vec3::splat(3.0)));
/// let (left, right) = (bvh.add_node(boxes[0]), bvh.add_node(boxes[1]));
/// bvh.set_leaf(left, &refs[..1]);
/// bvh.set_leaf(right, &refs[1..]);
/// bvh.set_children(root, left, right);
/// assert_eq!((bvh.root(), bvh.depth()), (Some(0), 2));
/// assert_eq!(bvh.order, [0, 1]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<Node>,
    /// The numbers of all primitives, each exactly once. The primitives of a leaf are adjacent.
    pub order: Vec<u32>,
    /// The most nodes that [`Bvh::add_node`] adds.
    pub most_nodes: usize,
}

message! { Bvh { nodes, order, most_nodes } }

impl Bvh {
    /// A hierarchy without nodes, which can take at most the `2 n - 1` nodes that a binary tree over
    /// `n_primitives` primitives can have.
    pub fn for_primitives(n_primitives: usize) -> Self {
        // A binary tree with no empty leaf has one inner node fewer than leaves.
        let most_nodes = (2 * n_primitives).saturating_sub(1);
        Bvh { nodes: Vec::new(), order: Vec::with_capacity(n_primitives), most_nodes }
    }

    /// Adds a node with the box `bounds` and returns its index in [`Bvh::nodes`]. The node is a leaf without
    /// primitives until [`Bvh::set_leaf`] or [`Bvh::set_children`] changes it.
    ///
    /// # Panics
    ///
    /// If the hierarchy already has as many nodes as a tree over its primitives can have. Then some split has
    /// put all primitives on one side, and the recursion would never end.
    #[track_caller]
    pub fn add_node(&mut self, bounds: Aabb) -> u32 {
        assert!(
            self.nodes.len() < self.most_nodes,
            "node {} of a tree that can have {} at most: a split left one side empty, so the recursion never ends",
            self.nodes.len() + 1,
            self.most_nodes
        );
        self.nodes.push(Node { bounds, contents: Contents::Leaf { first: 0, count: 0 } });
        self.nodes.len() as u32 - 1
    }

    /// Makes `node` a leaf with `primitives`: appends their ids to [`Bvh::order`]. Call it once per leaf.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`.
    pub fn set_leaf(&mut self, node: u32, primitives: &[PrimitiveRef]) {
        crate::progress::placed(primitives.len());
        let first = self.order.len() as u32;
        self.order.extend(primitives.iter().map(|primitive| primitive.id));
        self.nodes[node as usize].contents = Contents::Leaf { first, count: primitives.len() as u32 };
    }

    /// Makes `node` an inner node with the children `left` and `right`, which are indices in [`Bvh::nodes`].
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`. The two children are not checked.
    pub fn set_children(&mut self, node: u32, left: u32, right: u32) {
        self.nodes[node as usize].contents = Contents::Inner { left, right };
    }

    /// The index of the root, which is 0; `None` if there are no nodes.
    pub fn root(&self) -> Option<u32> {
        (!self.nodes.is_empty()).then_some(0)
    }

    /// The numbers of the primitives of a leaf, `order[first..first + count]`.
    ///
    /// # Panics
    ///
    /// If the range does not lie in [`Bvh::order`].
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.order[first as usize..(first + count) as usize]
    }

    /// The number of nodes on the longest path from the root to a leaf, both counted; 0 if there are no
    /// nodes. The nodes must form a tree: on a cycle the function does not return.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn depth(&self) -> usize {
        let mut deepest = 0;
        let mut waiting: Vec<(u32, usize)> = self.root().map(|root| (root, 1)).into_iter().collect();
        while let Some((node, depth)) = waiting.pop() {
            deepest = deepest.max(depth);
            if let Contents::Inner { left, right } = self.nodes[node as usize].contents {
                waiting.extend([(left, depth + 1), (right, depth + 1)]);
            }
        }
        deepest
    }
}

/// All that a search for hits may ask about a scene: the contents of a node, the entry into its box, the hit
/// with a primitive. Each call is counted, so the cost of a search is known exactly.
///
/// In the checks of stage 3 a table answers in place of a scene:
///
/// ```
/// use glam::Vec3;
/// use raykata::bvh::{Bvh, Probe};
/// use raykata::kit::{SearchQuery, Table, TableProbe};
/// use raykata::ray::Ray;
/// let ray = Ray::new(Vec3::ZERO, Vec3::Z);
/// let table = Table { boxes: vec![(1.0, 4.0)], primitives: vec![2.0, f32::INFINITY] };
/// let query = SearchQuery { bvh: Bvh::default(), ray, table };
/// let mut probe = TableProbe::new(&query);
/// assert_eq!(probe.enter(0, &ray), Some(1.0));
/// assert_eq!((probe.hit(0, &ray), probe.hit(1, &ray)), (Some(2.0), None));
/// assert_eq!((probe.counts.box_tests, probe.counts.primitive_tests), (1, 2));
/// ```
pub trait Probe {
    /// The contents of `node`. Counts a node visit.
    ///
    /// # Panics
    ///
    /// May panic if `node` is not a node of the hierarchy.
    fn open(&mut self, node: u32) -> Contents;

    /// The `t` at which `ray` enters the box of `node`: at least `ray.t_min`, which is the answer for a ray
    /// that starts inside, and below `ray.t_max`. `None` if the ray misses the box within that range. A box
    /// that is entered at exactly `t_max` may be reported or not, because no hit counts there: `slab` of
    /// stage 3, which frames call, reports it; a table does not. Counts a box test.
    ///
    /// # Panics
    ///
    /// May panic if `node` is not a node of the hierarchy.
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32>;

    /// The `t` at which `ray` hits `primitive`, or `None` if there is no hit with
    /// `ray.t_min < t < ray.t_max`. Counts a primitive test.
    ///
    /// # Panics
    ///
    /// May panic if there is no primitive with this number.
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32>;
}

/// A hit of a ray: the number of the primitive and the ray parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveHit {
    /// The ray parameter of the hit: the distance along the ray, in lengths of its direction.
    pub t: f32,
    /// The number of the primitive that is hit.
    pub primitive: u32,
}

message! { PrimitiveHit { t, primitive } }

/// The depth from which on every split of a hierarchy is an object median; the root has depth 0.
///
/// A balanced tree over 2⁶⁴ primitives is as deep, so useful trees end before it. But a spatial median may
/// split off one primitive per level. Such a tree over a million primitives would have a million levels, and a
/// recursion over it would overflow the stack.
pub const DEEPEST_SPLIT: usize = 64;

/// The cost of visiting an inner node, which takes two box tests, in the surface area heuristic. Its unit is
/// the cost of one primitive test, [`INTERSECTION_COST`].
pub const TRAVERSAL_COST: f32 = 1.0;

/// The cost of one test of a ray against a primitive in the surface area heuristic. It is the unit of cost.
pub const INTERSECTION_COST: f32 = 1.0;
