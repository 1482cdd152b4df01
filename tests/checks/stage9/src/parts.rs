//! The intervals of a ray in the nodes of a structure, computed by the definition: every node is tested.

use checks::double::box_interval;
use checks::prelude::*;
use glam::{UVec3, uvec3};
use raykata::partition::{Cell, CellTree, CutPlane, Grid, PlaneNode, PolygonBsp, Tree, TreeNode};

/// A room for a cell that is a little larger, so that it includes what a ray only touches: a share of its longest side.
pub(super) fn touching(cell: &Cell) -> f64 {
    (cell.max - cell.min).max_element() * (-16f64).exp2()
}

/// A room for a smaller cell, into which a ray comes only well inside the faces: by a 256th of the longest side.
pub(super) fn well_inside(cell: &Cell) -> f64 {
    (cell.max - cell.min).max_element() / -256.0
}

/// The interval of a ray in a cell that is larger by `room` on all sides.
fn part(ray: &Ray, cell: &Cell, room: f64) -> Option<(f64, f64)> {
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

/// The cells of a grid that a ray enters.
pub(super) fn leaves_of_grid(grid: &Grid, ray: &Ray) -> Vec<Leaf> {
    let leaf = |(number, _, cell): (u32, UVec3, Cell)| {
        let (enter, exit) = exactly(ray, &cell)?;
        Some(Leaf { enter, exit, ids: grid.primitives(number).to_vec() })
    };
    in_order(numbered(grid).filter_map(leaf).collect())
}

/// The leaves of a tree of cells that a ray enters.
pub(super) fn leaves_of_cells<N: TreeNode<Region = Cell>>(tree: &CellTree<N>, ray: &Ray) -> Vec<Leaf> {
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

/// The leaves of a tree of planes that a ray enters, and the planes that it reaches with the polygons on them. A side
/// contains the points within `room` of its plane.
pub(super) fn leaves_of_planes<N: PlaneNode>(tree: &Tree<N>, room: f64, ray: &Ray) -> Vec<Leaf> {
    let mut leaves = Vec::new();
    let on_wide_side = |part: (f64, f64), (plane, side): &(CutPlane, f64)| {
        let wide = CutPlane { offset: plane.offset - side * room, ..*plane };
        on_side(ray, &wide, *side, part, 0.0)
    };
    tree.walk(|node, above, _| {
        let inner = &tree.nodes[node as usize];
        let here = inner.plane().map(|plane| [(plane, -1.0), (plane, 1.0)]);
        let range = (f64::from(ray.t_min), f64::from(ray.t_max));
        let (enter, exit) = above.iter().chain(here.iter().flatten()).fold(range, on_wide_side);
        if enter <= exit && inner.range().is_some() {
            // No hit of a polygon lies behind its plane.
            let exit = if here.is_some() { f64::INFINITY } else { exit };
            leaves.push(Leaf { enter, exit, ids: tree.listed(node).to_vec() });
        }
    });
    in_order(leaves)
}

/// The cells of a grid, each with its number and its coordinates.
pub(super) fn numbered(grid: &Grid) -> impl Iterator<Item = (u32, UVec3, Cell)> {
    let n = grid.resolution;
    (0..n.element_product()).map(move |i| {
        let at = uvec3(i % n.x, i / n.x % n.y, i / (n.x * n.y));
        (i, at, grid.cell(at))
    })
}

/// The interval of a ray in each node of a structure: `(node, entry, exit)`, in double precision.
pub(super) type Parts = Vec<(u32, f64, f64)>;

/// The cells that the ray enters if each is larger by its `room`.
pub(super) fn of_grid(grid: &Grid, ray: &Ray, room: impl Fn(&Cell) -> f64) -> Parts {
    let entered =
        |(i, _, cell): (u32, UVec3, Cell)| part(ray, &cell, room(&cell)).map(|(near, far)| (i, near, far));
    numbered(grid).filter_map(entered).collect()
}

pub(super) fn of_cells<N: TreeNode<Region = Cell>>(tree: &CellTree<N>, ray: &Ray) -> Parts {
    let mut parts = Vec::new();
    tree.walk(usize::MAX, |node, cell, _| {
        parts.extend(part(ray, &cell, touching(&cell)).map(|(near, far)| (node, near, far)))
    });
    parts
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
        if let Some(plane) = bsp.nodes[node as usize].plane() {
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
