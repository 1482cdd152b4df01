//! The intervals of a ray in the nodes of a structure, computed by the definition: every node is tested.

use super::searches::Parts;
use super::{octant_mistakes, plane_mistakes};
use checks::double::box_interval;
use glam::uvec3;
use raykata::aabb::Aabb;
use raykata::partition::{
    Bsp, BspNode, Cell, CellTree, CutPlane, Grid, KdTree, Octree, OctreeNode, PlaneNode, PolygonBsp,
    PolygonBspNode, Tree, TreeNode,
};
use raykata::ray::Ray;

/// The interval of a ray in a cell that is widened a little, so that cells that the ray only touches are included.
fn part(ray: &Ray, cell: &Cell) -> Option<(f64, f64)> {
    part_of(ray, cell, (cell.max - cell.min).max_element() * (-16f64).exp2())
}

fn part_of(ray: &Ray, cell: &Cell, room: f64) -> Option<(f64, f64)> {
    let wide = Aabb::new((cell.min - room).as_vec3(), (cell.max + room).as_vec3());
    let (near, far) = box_interval(ray, &wide);
    let (near, far) = (near.max(f64::from(ray.t_min)), far.min(f64::from(ray.t_max)));
    (near <= far).then_some((near, far))
}

/// The interval of a ray in a closed cell, in double precision and without room.
pub(super) fn exactly(ray: &Ray, cell: &Cell) -> Option<(f64, f64)> {
    let (mut t, mut t_end) = (f64::from(ray.t_min), f64::from(ray.t_max));
    for axis in 0..3 {
        let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
        let (low, high) = (cell.min[axis] - o, cell.max[axis] - o);
        if d == 0.0 {
            (t, t_end) = if low <= 0.0 && 0.0 <= high { (t, t_end) } else { (f64::INFINITY, t_end) };
        } else {
            (t, t_end) = (t.max((low / d).min(high / d)), t_end.min((low / d).max(high / d)));
        }
    }
    (t <= t_end && t < f64::INFINITY).then_some((t, t_end))
}

/// A cell that a ray enters: the interval of the ray, and the primitives that the cell lists.
pub(super) struct Leaf {
    pub enter: f64,
    pub exit: f64,
    pub ids: Vec<u32>,
}

/// The leaves in the order in which the ray enters them.
fn in_order(mut leaves: Vec<Leaf>) -> Vec<Leaf> {
    leaves.sort_by(|p, q| {
        (p.enter, p.exit).partial_cmp(&(q.enter, q.exit)).unwrap_or(std::cmp::Ordering::Equal)
    });
    leaves
}

/// The cells of a structure as a ray goes through them, and the mistakes that are possible there.
pub(super) trait Structure {
    /// The leaves that the ray enters, in their order.
    fn leaves(&self, ray: &Ray) -> Vec<Leaf>;

    /// The primitives that a cell or a node lists; none for an inner node.
    fn listed(&self, node: u32) -> &[u32];

    /// The known mistakes of this structure's searches, each with whether it finds this hit.
    fn mistakes(&self, ray: &Ray, hits: &[f32], found: Option<(u32, f32)>) -> Vec<(bool, &'static str)>;
}

impl Structure for Grid {
    fn leaves(&self, ray: &Ray) -> Vec<Leaf> {
        let leaf = |(number, cell): (u32, Cell)| {
            let (enter, exit) = exactly(ray, &cell)?;
            Some(Leaf { enter, exit, ids: self.primitives(number).to_vec() })
        };
        in_order(numbered(self).filter_map(leaf).collect())
    }

    fn listed(&self, node: u32) -> &[u32] {
        self.primitives(node)
    }

    fn mistakes(&self, _: &Ray, _: &[f32], _: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
        Vec::new()
    }
}

/// The leaves of a tree of cells that a ray enters.
fn leaves_of_cells<N: TreeNode<Region = Cell>>(tree: &CellTree<N>, ray: &Ray) -> Vec<Leaf> {
    let mut leaves = Vec::new();
    tree.walk(usize::MAX, |node, cell, _| {
        if tree.nodes[node as usize].is_leaf()
            && let Some((enter, exit)) = exactly(ray, &cell)
        {
            leaves.push(Leaf { enter, exit, ids: tree.listed(node).to_vec() });
        }
    });
    in_order(leaves)
}

impl Structure for Octree {
    fn leaves(&self, ray: &Ray) -> Vec<Leaf> {
        leaves_of_cells(self, ray)
    }

    fn listed(&self, node: u32) -> &[u32] {
        Tree::listed(self, node)
    }

    fn mistakes(&self, ray: &Ray, hits: &[f32], found: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
        octant_mistakes::of_octree(self, ray, hits, found)
    }
}

impl Structure for KdTree {
    fn leaves(&self, ray: &Ray) -> Vec<Leaf> {
        leaves_of_cells(self, ray)
    }

    fn listed(&self, node: u32) -> &[u32] {
        Tree::listed(self, node)
    }

    fn mistakes(&self, ray: &Ray, hits: &[f32], found: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
        plane_mistakes::of_kd_tree(self, ray, hits, found)
    }
}

impl Structure for Bsp {
    fn leaves(&self, ray: &Ray) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        self.walk(|node, above, _| {
            let BspNode::Leaf { first, count } = self.nodes[node as usize] else { return };
            let range = (f64::from(ray.t_min), f64::from(ray.t_max));
            let (enter, exit) =
                above.iter().fold(range, |part, (plane, side)| on_side(ray, plane, *side, part, 0.0));
            if enter <= exit {
                leaves.push(Leaf { enter, exit, ids: self.primitives(first, count).to_vec() });
            }
        });
        in_order(leaves)
    }

    fn listed(&self, node: u32) -> &[u32] {
        Tree::listed(self, node)
    }

    fn mistakes(&self, ray: &Ray, hits: &[f32], found: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
        plane_mistakes::of_bsp(self, ray, hits, found)
    }
}

impl Structure for PolygonBsp {
    /// The leaves, and the planes that the ray reaches with the polygons on them.
    fn leaves(&self, ray: &Ray) -> Vec<Leaf> {
        let mut leaves = Vec::new();
        // A side contains the points within the room of its plane.
        let on_wide_side = |part: (f64, f64), (plane, side): &(CutPlane, f64)| {
            let wide = CutPlane { offset: plane.offset - side * self.room, ..*plane };
            on_side(ray, &wide, *side, part, 0.0)
        };
        self.walk(|node, above, _| {
            let range = (f64::from(ray.t_min), f64::from(ray.t_max));
            let part = above.iter().fold(range, on_wide_side);
            let ((enter, exit), end, first, count) = match self.nodes[node as usize] {
                PolygonBspNode::Leaf { first, count } => (part, part.1, first, count),
                PolygonBspNode::Inner { plane, first, count, .. } => {
                    let both = [(plane, -1.0), (plane, 1.0)].iter().fold(part, on_wide_side);
                    // No hit of a polygon lies behind its plane.
                    (both, f64::INFINITY, first, count)
                }
            };
            if enter <= exit {
                leaves.push(Leaf { enter, exit: end, ids: self.primitives(first, count).to_vec() });
            }
        });
        in_order(leaves)
    }

    fn listed(&self, node: u32) -> &[u32] {
        Tree::listed(self, node)
    }

    fn mistakes(&self, ray: &Ray, hits: &[f32], found: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
        plane_mistakes::of_polygon_bsp(self, ray, hits, found)
    }
}

fn numbered(grid: &Grid) -> impl Iterator<Item = (u32, Cell)> {
    let n = grid.resolution;
    (0..n.element_product()).map(move |i| (i, grid.cell(uvec3(i % n.x, i / n.x % n.y, i / (n.x * n.y)))))
}

pub(super) fn of_grid(grid: &Grid, ray: &Ray) -> Parts {
    numbered(grid).filter_map(|(i, cell)| part(ray, &cell).map(|(near, far)| (i, near, far))).collect()
}

/// The cells that the ray enters, or passes by within `room`.
pub(super) fn near_grid(grid: &Grid, ray: &Ray, room: f64) -> Parts {
    numbered(grid)
        .filter_map(|(i, cell)| part_of(ray, &cell, room).map(|(near, far)| (i, near, far)))
        .collect()
}

/// The cells that the ray passes through well inside their faces: by more than a 256th of their longest side.
pub(super) fn inside_grid(grid: &Grid, ray: &Ray) -> Parts {
    let inside = |cell: &Cell| part_of(ray, cell, (cell.max - cell.min).max_element() / -256.0);
    numbered(grid).filter_map(|(i, cell)| inside(&cell).map(|(near, far)| (i, near, far))).collect()
}

pub(super) fn of_cells<N: TreeNode<Region = Cell>>(tree: &CellTree<N>, ray: &Ray) -> Parts {
    let mut parts = Vec::new();
    tree.walk(usize::MAX, |node, cell, _| {
        parts.extend(part(ray, &cell).map(|(near, far)| (node, near, far)))
    });
    parts
}

pub(super) fn of_leaves(octree: &Octree, parts: &Parts) -> Vec<u32> {
    let is_leaf = |node: u32| matches!(octree.nodes[node as usize], OctreeNode::Leaf { .. });
    parts.iter().map(|(node, ..)| *node).filter(|&node| is_leaf(node)).collect()
}

pub(super) fn of_planes<N: PlaneNode>(bsp: &Tree<N>, ray: &Ray) -> Parts {
    let mut parts = Vec::new();
    bsp.walk(|node, above, _| {
        let (enter, exit) = part_in(ray, above);
        if enter <= exit {
            parts.push((node, enter, exit));
        }
    });
    parts
}

/// The inner nodes whose planes the ray reaches, within some room, in the part of it that is in the node.
pub(super) fn reached_planes(bsp: &PolygonBsp, ray: &Ray) -> Vec<u32> {
    let mut reached = Vec::new();
    bsp.walk(|node, above, _| {
        if let PolygonBspNode::Inner { plane, .. } = bsp.nodes[node as usize] {
            let with = |side: f64| above.iter().copied().chain([(plane, side)]).collect::<Vec<_>>();
            let ((enter, exit), (other_enter, other_exit)) =
                (part_in(ray, &with(1.0)), part_in(ray, &with(-1.0)));
            if enter <= exit && other_enter <= other_exit {
                reached.push(node);
            }
        }
    });
    reached
}

/// The part of a ray on these sides of planes, with some room.
fn part_in(ray: &Ray, above: &[(CutPlane, f64)]) -> (f64, f64) {
    let range = (f64::from(ray.t_min), f64::from(ray.t_max));
    above.iter().fold(range, |part, (plane, side)| on_side(ray, plane, *side, part, (-16f64).exp2()))
}

/// The part of an interval on one side of a plane, with `relative` room for rounding.
fn on_side(ray: &Ray, plane: &CutPlane, side: f64, (t, t_end): (f64, f64), relative: f64) -> (f64, f64) {
    let (height, rate) =
        (side * plane.distance(ray.origin), side * plane.normal.dot(ray.direction.as_dvec3()));
    let room = relative * (1.0 + height.abs());
    match rate {
        0.0 if height >= -room => (t, t_end),
        0.0 => (f64::INFINITY, f64::NEG_INFINITY),
        rate if rate > 0.0 => (t.max((-room - height) / rate), t_end),
        rate => (t, t_end.min((-room - height) / rate)),
    }
}
