//! The bounding volume hierarchy as data. Splitting, building and traversing it are exercises of stage 3.

use crate::aabb::Aabb;
use crate::ray::Ray;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What a builder needs to know of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrimitiveRef {
    /// Which primitive this is.
    pub id: u32,
    /// A box around it.
    pub bounds: Aabb,
    /// The middle of that box.
    pub centroid: Vec3,
}

/// What a node holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Contents {
    /// Two nodes below.
    Inner {
        /// Number of the left one.
        left: u32,
        /// Number of the right one.
        right: u32,
    },
    /// The primitives `order[first..first + count]`.
    Leaf {
        /// Where they begin in [`Bvh::order`].
        first: u32,
        /// How many they are.
        count: u32,
    },
}

/// A node: a box, and what lies in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Node {
    /// Holds everything below.
    pub bounds: Aabb,
    /// What lies below.
    pub contents: Contents,
}

/// A hierarchy over primitives `0..n`. Node 0 is the root; a hierarchy over nothing has no nodes.
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bvh {
    /// All nodes, a parent before its children.
    pub nodes: Vec<Node>,
    /// Every primitive once, those of a leaf side by side.
    pub order: Vec<u32>,
    most_nodes: usize,
}

impl Bvh {
    /// An empty hierarchy that will hold `n_primitives`.
    pub fn for_primitives(n_primitives: usize) -> Self {
        // A binary tree whose leaves hold something has at most one inner node fewer than leaves.
        let most_nodes = (2 * n_primitives).saturating_sub(1);
        Bvh { nodes: Vec::new(), order: Vec::with_capacity(n_primitives), most_nodes }
    }

    /// Adds a node around `bounds` and gives its number. It is a leaf with nothing in it until
    /// [`Bvh::set_leaf`] or [`Bvh::set_children`] says otherwise.
    ///
    /// # Panics
    ///
    /// When there are more nodes than any tree over these primitives can have: then some split has put all
    /// primitives on one side, and the recursion would never end.
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

    /// Makes `node` a leaf that holds `primitives`.
    pub fn set_leaf(&mut self, node: u32, primitives: &[PrimitiveRef]) {
        crate::building::placed(primitives.len());
        let first = self.order.len() as u32;
        self.order.extend(primitives.iter().map(|primitive| primitive.id));
        self.nodes[node as usize].contents = Contents::Leaf { first, count: primitives.len() as u32 };
    }

    /// Makes `node` the parent of `left` and `right`.
    pub fn set_children(&mut self, node: u32, left: u32, right: u32) {
        self.nodes[node as usize].contents = Contents::Inner { left, right };
    }

    /// The number of the root, if there is anything.
    pub fn root(&self) -> Option<u32> {
        (!self.nodes.is_empty()).then_some(0)
    }

    /// The primitives of a leaf.
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.order[first as usize..(first + count) as usize]
    }

    /// Nodes on the longest way down, the root counted; 0 when there is nothing.
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

/// Everything that a search for hits may ask. Each question is counted, so what a search costs is known exactly.
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
    /// What `node` holds. Counts a node visit.
    fn open(&mut self, node: u32) -> Contents;

    /// The `t` at which `ray` enters the box of `node`: at least `ray.t_min`, which is the answer for a ray that starts
    /// inside, and below `ray.t_max`. `None` if the ray misses the box within that range. A box that is entered at exactly
    /// `t_max` may be reported or not, because no hit counts there: `slab` of stage 3, which frames ask, reports it; a
    /// table does not. Counts a box test.
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32>;

    /// The `t` at which `ray` hits `primitive`, if it does for `t_min < t < t_max`. Counts a primitive test.
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32>;
}

/// The primitive that a ray meets, and where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrimitiveHit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Which primitive.
    pub primitive: u32,
}

/// What it costs to look into an inner node (two box tests), in the unit of [`INTERSECTION_COST`].
pub const TRAVERSAL_COST: f32 = 1.0;

/// What it costs to test one primitive.
pub const INTERSECTION_COST: f32 = 1.0;
