//! The laws of the builder of BSP trees: which primitives each leaf lists.

use super::hulls::{self, usable};
use super::lists::{Fault, ended, fact, judge_references};
use checks::prelude::*;
use raykata::partition::{Bsp, BspNode, CutPlane, MOST_REFERENCES, TreeNode, corners};

/// A leaf: its number, the planes above it with the side on which it lies, and the primitives that it lists.
type Leaf = (u32, Vec<(CutPlane, f64)>, Vec<u32>);

fn leaves(bsp: &Bsp) -> Vec<Leaf> {
    let mut leaves = Vec::new();
    bsp.walk(|node, above, _| {
        if bsp.nodes[node as usize].is_leaf() {
            leaves.push((node, above.to_vec(), bsp.listed(node).to_vec()));
        }
    });
    leaves
}

const WHAT_MAKES_IT: &str = "the definition of a BSP tree";

fn judge_tree(query: &BspQuery, yours: &Bsp) -> CheckResult {
    let mut exchanged = yours.clone();
    for node in &mut exchanged.nodes {
        if let BspNode::Inner { back, front, .. } = node {
            std::mem::swap(back, front);
        }
    }
    let is_exchanged = |(yours, expected, mistakes): Fault| match fault(query, &exchanged) {
        None => {
            fact(yours, expected, "the children are exchanged: `front` is on the side of the plane's normal")
        }
        Some(_) => (yours, expected, mistakes),
    };
    let faults = || fault(query, yours).map(is_exchanged);
    hulls::judge_tree(query, WHAT_MAKES_IT, (yours.nodes.len(), yours.depth()), faults)
}

fn fault(query: &BspQuery, yours: &Bsp) -> Option<Fault> {
    // A corner within one float of a plane touches it. A corner within a 64th of the size may be counted as touching.
    let size = hulls::size(query);
    let (step, room) = (size * (-23f64).exp2(), size / 64.0);
    for (node, above, listed) in leaves(yours) {
        for (id, hull) in query.hulls.iter().enumerate() {
            let times = listed.iter().filter(|&&other| other == id as u32).count();
            let count = |times: usize| format!("primitive {id} is listed {times} times in leaf {node}");
            if !usable(hull) {
                if times > 0 {
                    let mistake = "you list a hull without corners: leave it out";
                    return Some(fact(count(times), count(0), mistake));
                }
                continue;
            }
            // A hull with a corner inside certainly overlaps the leaf. A hull that lies completely outside of one plane
            // certainly does not.
            let inside =
                |p: &Vec3, room: f64| above.iter().all(|(plane, side)| side * plane.distance(*p) >= room);
            let reaches = hull.iter().any(|p| inside(p, -step));
            let outside =
                above.iter().any(|(plane, side)| hull.iter().all(|p| side * plane.distance(*p) < -room));
            if reaches && times != 1 {
                let on_plane =
                    hull.iter().any(|p| above.iter().any(|(plane, _)| plane.distance(*p).abs() <= step));
                let missing = times == 0;
                let elsewhere = leaves(yours).iter().any(|(.., listed)| listed.contains(&(id as u32)));
                return Some((
                    count(times),
                    count(1),
                    named![
                        missing && elsewhere && on_plane =>
                            "a primitive that touches a plane, or lies in it, belongs to both sides",
                        missing && elsewhere => "a primitive that crosses or touches a plane belongs to both sides",
                        missing && !elsewhere => "you leave out a primitive: no leaf lists it",
                        !missing => "you list a primitive twice in one leaf",
                    ].to_vec(),
                ));
            }
            if outside && times > 0 {
                let mistake = "you list a primitive in a leaf that it does not overlap";
                return Some(fact(count(times), count(0), mistake));
            }
        }
    }
    None
}

pub(super) fn bsp_lists_what_reaches_into_leaves(trial: &Trial<'_>) -> CheckResult {
    let corner = || prop_oneof![2 => point(4), 1 => nasty::lattice(2), 1 => rough_point(4.0)];
    let tile = (corner(), corner(), corner(), 0..16i32).prop_map(|(a, b, c, kind)| match kind {
        0 => Vec::new(),
        1..=3 => vec![vec3(a.x, a.y, 1.0), vec3(b.x, b.y, 1.0), vec3(c.x, c.y, 1.0)],
        4..=6 => corners(&Aabb::new(a, a + b.abs())),
        _ => vec![a, b, c],
    });
    // At these scales the square of a normal, whose length is an area, is a normal number in single precision.
    let inputs = (prop::collection::vec(tile, 1..20), nasty::scale(-24..=24), 1..=4usize, 0..=6usize);
    let inputs = inputs.prop_map(|(mut hulls, scale, leaf_size, max_depth): (Vec<Vec<Vec3>>, _, _, _)| {
        hulls.iter_mut().flatten().for_each(|corner| *corner *= scale);
        BspQuery { hulls, leaf_size, max_depth }
    });
    trial.each(140, inputs, <dyn Kit>::bsp_build, |query, yours| judge_tree(query, &yours))
}

pub(super) fn bsp_build_ends(trial: &Trial<'_>) -> CheckResult {
    let boxes = hulls::infinite_boxes(trial.about(1000));
    for (name, hulls, most) in hulls::infinite_polygons().into_iter().chain(boxes) {
        judge_build(trial, name, hulls, 12, most)?;
    }
    // A plane that divides these has the eight long boxes, 67 %, on both sides.
    let from_to = |low: f32, high: f32| corners(&Aabb::new(vec3(low, 0.0, 0.0), vec3(high, 1.0, 1.0)));
    let ends = [(1.0, 2.0), (3.0, 4.0), (60.0, 61.0), (62.0, 63.0)].map(|(low, high)| from_to(low, high));
    let around = std::iter::repeat_n(from_to(0.0, 64.0), 8).chain(ends).collect();
    judge_build(trial, "eight long boxes around four short ones", around, 12, 1)?;
    judge_build(trial, "400 crossing needles", crossing_needles(400), 20, MOST_REFERENCES)?;
    // The plane of each square has both of them on one side, and a plane across them has both on both.
    let square =
        |z: f32| [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| vec3(x, y, z)).to_vec();
    let query = BspQuery { hulls: vec![square(0.0), square(1.0)], leaf_size: 1, max_depth: 12 };
    let n_nodes = trial.kit.bsp_build(std::slice::from_ref(&query))[0].nodes.len();
    let broken = Broken::new("build of 2 parallel squares, leaf_size 1", n_nodes, 1, "the number of nodes");
    let says = "a plane with all primitives on one side divides nothing: make a leaf where no plane leaves fewer on each side";
    if n_nodes == 1 { Ok(()) } else { Err(broken.because(says)) }
}

/// Thin triangles in all directions through a sphere: each plane has some of them on both sides.
pub(super) fn crossing_needles(n: usize) -> Vec<Vec<Vec3>> {
    // Points that are spread evenly over the unit sphere (Fibonacci lattice).
    let point = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f32 / n as f32;
        let (y, x) = (2.399_963 * i as f32).sin_cos();
        vec3(x * (1.0 - z * z).sqrt(), y * (1.0 - z * z).sqrt(), z)
    };
    (0..n).map(|i| vec![point(i), point(7 * i % n), point(7 * i % n) + 1e-3 * Vec3::ONE]).collect()
}

/// Judges a tree with leaves of one primitive, which may have `most` references per primitive.
fn judge_build(
    trial: &Trial<'_>,
    name: &str,
    hulls: Vec<Vec<Vec3>>,
    max_depth: usize,
    most: usize,
) -> CheckResult {
    let n = hulls.len();
    let query = BspQuery { hulls, leaf_size: 1, max_depth };
    let input = format!("build of {name}, leaf_size 1, max_depth {max_depth}");
    let too_deep = "stop at max_depth, and where no plane divides the primitives";
    let too_many = "you divide primitives that are on both sides of each plane: make a leaf of them";
    let build = || trial.kit.bsp_build(std::slice::from_ref(&query)).remove(0);
    let yours = ended(&input, WHAT_MAKES_IT, [too_deep, too_many], build)?;
    judge_tree(&query, &yours)?;
    judge_references(&input, &yours.items, most * n, too_many)
}

/// A wall at x = 2 between 5 small boxes and 8 others, of which 4 lie across the plane through the median centre. The wall's own
/// plane has fewer on its fuller side (10, not 11), and fewer on both (1, not 4).
fn judge_straddlers(trial: &Trial<'_>) -> CheckResult {
    let rows = |n: usize, low: f32, high: f32| {
        (0..n).map(move |i| corners(&Aabb::new(vec3(low, i as f32, 0.0), vec3(high, i as f32 + 0.5, 0.5))))
    };
    let wall = [(0.0, 0.0), (5.0, 0.0), (5.0, 0.5), (0.0, 0.5)].map(|(y, z)| vec3(2.0, y, z)).to_vec();
    let hulls =
        rows(5, 0.0, 1.0).chain([wall]).chain(rows(5, 4.0, 20.0)).chain(rows(4, 19.0, 20.0)).collect();
    let query = BspQuery { hulls, leaf_size: 2, max_depth: 1 };
    let yours = trial.kit.bsp_build(std::slice::from_ref(&query)).remove(0);
    judge_tree(&query, &yours)?;
    let many =
        "you choose a plane with many on both sides, although another has fewer on its fuller side, too";
    let input = "build of 14 boxes and a wall between them, leaf_size 2, max_depth 1";
    judge_references(input, &yours.items, query.hulls.len() + 1, many)
}

/// The sides of a prism: the plane of each has all others on one side, and a plane across the prism divides them.
fn judge_convex(trial: &Trial<'_>) -> CheckResult {
    let corner = |(i, z)| Vec2::from_angle(std::f32::consts::TAU * (i % 16) as f32 / 16.0).extend(z);
    let side = |i| [(i, 0.0), (i + 1, 0.0), (i + 1, 1.0), (i, 1.0)].map(corner).to_vec();
    let query = BspQuery { hulls: (0..16).map(side).collect(), leaf_size: 2, max_depth: 4 };
    let yours = trial.kit.bsp_build(std::slice::from_ref(&query)).remove(0);
    judge_tree(&query, &yours)?;
    let broken =
        Broken::new("build of the 16 sides of a prism, leaf_size 2", "a leaf", "a cut", "the definition");
    let says = "you make no cut at a convex body: try a plane across its longest extent, too";
    if yours.nodes.len() > 1 { Ok(()) } else { Err(broken.because(says)) }
}

/// Parallel sheets across a diagonal: planes across an axis do not divide them, but their own planes do.
pub(super) fn bsp_cuts_along_polygons(trial: &Trial<'_>) -> CheckResult {
    // As many primitives as a leaf may have.
    let few = BspQuery { hulls: hulls::sheets(4), leaf_size: 4, max_depth: 32 };
    let n_nodes = trial.kit.bsp_build(std::slice::from_ref(&few))[0].nodes.len();
    if n_nodes != 1 {
        let broken = Broken::new("build of 4 sheets, leaf_size 4", n_nodes, 1, "the number of nodes");
        let says = "you divide a node of leaf_size primitives: that is a leaf".when(n_nodes > 1);
        return Err(broken.explained_by([says]));
    }
    let n = 31;
    let query = BspQuery { hulls: hulls::sheets(n), leaf_size: 2, max_depth: 32 };
    let yours = trial.kit.bsp_build(std::slice::from_ref(&query)).remove(0);
    judge_tree(&query, &yours)?;
    let fullest = leaves(&yours).iter().map(|(.., listed)| listed.len()).max().unwrap_or(0);
    // A cut along a sheet lists the sheet on both sides, which makes one more reference per cut.
    let (references, depth) = (yours.items.len(), yours.depth());
    if fullest <= 2 && references <= 2 * n && depth <= 8 {
        judge_convex(trial)?;
        return judge_straddlers(trial);
    }
    let mistakes = named![
        yours.nodes.len() == 1 => "you make no cut: the planes of the polygons are the candidates",
        fullest > 2 => "you do not divide the parallel sheets down to leaf_size: the planes of the polygons are the candidates",
        references > 2 * n => "your planes have many sheets on both sides: the planes of the polygons are the candidates",
        depth > 8 => "your planes leave most sheets on one side: choose those that leave few primitives on the fuller side",
    ];
    let yours = format!("up to {fullest} sheets per leaf, {references} references, {depth} levels");
    let input = format!("build of {n} sheets side by side across a diagonal, leaf_size 2, max_depth 32");
    let expected = format!("2 per leaf, at most {} references, 8 levels", 2 * n);
    Err(Broken::with_texts(input, yours, expected, "counted").explained_by(mistakes))
}
