//! The laws of the builder of BSP trees with polygons in their nodes: where each part of each polygon lies.

use super::hulls::{self, usable};
use super::lists::{Fault, ended, fact, judge_references};
use checks::prelude::*;
use raykata::partition::{CutPlane, MOST_REFERENCES, PlaneNode, PolygonBsp, PolygonBspNode, corners};

const WHAT_MAKES_IT: &str = "the definition of a BSP tree with polygons in its nodes";

/// What the contract says of a hull.
#[derive(PartialEq)]
enum Kind {
    Polygon,
    Solid,
    /// A sliver or a bent polygon: rounding decides whether its corners have a plane.
    Unclear,
}

fn kind(hull: &[Vec3], size: f64) -> Kind {
    let p: Vec<DVec3> = hull.iter().map(|corner| corner.as_dvec3()).collect();
    if !(3..8).contains(&p.len()) {
        return Kind::Solid;
    }
    let doubled: DVec3 = (1..p.len() - 1).map(|i| (p[i] - p[0]).cross(p[i + 1] - p[0])).sum();
    let area = doubled.length();
    let bent = p.iter().map(|corner| (*corner - p[0]).dot(doubled).abs()).fold(0.0, f64::max);
    // Bent by a hundredth of the size, corners have no plane with any room that is allowed, which is a 1000th.
    match area {
        0.0 => Kind::Solid,
        _ if area > 1e-6 * size * size && bent <= 1e-12 * size * area => Kind::Polygon,
        _ if area > 1e-6 * size * size && bent > 1e-2 * size * area => Kind::Solid,
        _ => Kind::Unclear,
    }
}

fn judge_tree(query: &BspQuery, yours: &PolygonBsp) -> CheckResult {
    hulls::judge_tree(query, WHAT_MAKES_IT, (yours.nodes.len(), yours.depth()), || fault(query, yours))
}

fn fault(query: &BspQuery, yours: &PolygonBsp) -> Option<Fault> {
    let size = hulls::size(query);
    if !(0.0..=size / 1000.0).contains(&yours.room) {
        let expected = format!("0 to {}", size / 1000.0);
        let mistake = "room is from 0 to a 1000th of the largest coordinate";
        return Some(fact(format!("room: {}", yours.room), expected, mistake));
    }
    // Judge each node: what it lists must be in its region and, in an inner node, in its plane.
    let slack = size / 64.0;
    let mut faults = Vec::new();
    yours.walk(|node, above, depth| {
        let (listed, plane) = (yours.listed(node), yours.nodes[node as usize].plane());
        let excused = depth == query.max_depth || yours.items.len() > 2 * query.hulls.len();
        faults.extend(listing_fault(query, (node, listed), plane, above, (size, slack, excused)));
        // A solid with a corner in the region of a leaf belongs to the leaf.
        if plane.is_some() {
            return;
        }
        let step = size * (-23f64).exp2();
        for (id, hull) in query.hulls.iter().enumerate() {
            let inside = |p: &Vec3| above.iter().all(|(plane, side)| side * plane.distance(*p) >= -step);
            let is_solid = usable(hull) && kind(hull, size) == Kind::Solid;
            if is_solid && hull.iter().any(inside) && !listed.contains(&(id as u32)) {
                let yours = format!("solid {id} is not listed in leaf {node}");
                let mistake = "a solid belongs to every leaf that it overlaps or touches";
                faults.push(fact(yours, "once".into(), mistake));
            }
        }
    });
    faults.into_iter().next().or_else(|| gap(query, yours, size))
}

/// A fault in what a node lists; `excused` if it may list polygons although it is a leaf.
fn listing_fault(
    query: &BspQuery,
    (node, listed): (u32, &[u32]),
    plane: Option<CutPlane>,
    above: &[(CutPlane, f64)],
    (size, slack, excused): (f64, f64, bool),
) -> Option<Fault> {
    for (index, &id) in listed.iter().enumerate() {
        let Some(hull) = query.hulls.get(id as usize) else {
            let yours = format!("primitive {id}");
            return Some(fact(yours, "a number of a hull".into(), "there is no such primitive"));
        };
        let says = |what: &str| format!("node {node} lists primitive {id}{what}");
        if !usable(hull) {
            let mistake = "you list a hull without corners: leave it out";
            return Some(fact(says(""), "not listed".into(), mistake));
        }
        if listed[..index].contains(&id) {
            return Some(fact(says(" twice"), "once".into(), "you list a primitive twice in one node"));
        }
        let kind = kind(hull, size);
        if let Some(plane) = plane {
            if kind == Kind::Solid {
                let mistake = "only polygons lie in planes: list a solid in the leaves that it overlaps";
                return Some(fact(says(", a solid"), "polygons only".into(), mistake));
            }
            let off = hull.iter().map(|corner| plane.distance(*corner).abs()).fold(0.0, f64::max);
            if off > slack {
                let mistake =
                    "you list a polygon at a node although it does not lie in the plane of the node";
                return Some(fact(says(&format!(", {off} off its plane")), "in the plane".into(), mistake));
            }
        } else if kind == Kind::Polygon && !excused {
            let mistake =
                "every part of every polygon lies on a partition plane: divide until no polygon is left";
            return Some(fact(says(", a polygon in a leaf"), "in a node with its plane".into(), mistake));
        }
        // Clip a polygon to the region, which is widened by the slack.
        let wide = |plane: &CutPlane, side: f64| CutPlane { offset: plane.offset - side * slack, ..*plane };
        let corners: Vec<DVec3> = hull.iter().map(|corner| corner.as_dvec3()).collect();
        let within =
            |(plane, side): &(CutPlane, f64)| hull.iter().any(|p| side * plane.distance(*p) >= -slack);
        let reaches = match kind {
            Kind::Polygon => {
                let clip =
                    |part: Vec<DVec3>, (plane, side): &(CutPlane, f64)| wide(plane, *side).keep(&part, *side);
                above.iter().fold(corners, clip).len() > 2
            }
            _ => above.iter().all(within),
        };
        if !reaches {
            return Some((
                says(", of which no part is there"),
                "not listed".into(),
                vec![
                    "split a polygon that crosses a plane, and pass only its parts on: you pass the whole polygon to both sides"
                        .when(kind == Kind::Polygon && above.iter().all(within)),
                    (true, "you list a primitive in a node that it does not reach"),
                ],
            ));
        }
    }
    None
}

/// A point of a polygon that no node on the way to it lists.
fn gap(query: &BspQuery, yours: &PolygonBsp, size: f64) -> Option<Fault> {
    let room = 2.0 * yours.room.max(size * (-23f64).exp2());
    for (id, hull) in query.hulls.iter().enumerate() {
        if !usable(hull) || kind(hull, size) == Kind::Solid {
            continue;
        }
        for point in points(hull) {
            if !is_covered(yours, 0, point, id as u32, room) {
                let nowhere = !yours.items.contains(&(id as u32));
                let is_near = is_covered(yours, 0, point, id as u32, size / 1000.0);
                return Some((
                    format!("no node lists polygon {id} at its point {point}"),
                    "one node".into(),
                    vec![
                        (nowhere, "you leave out a polygon: no node lists it"),
                        (
                            is_near,
                            "a node lists it, but farther from its plane than room: store the room with which you build",
                        ),
                        "a part of a polygon is lost: a polygon that crosses a plane has a part on each side"
                            .when(!nowhere),
                    ],
                ));
            }
        }
    }
    None
}

/// Points inside a polygon: between its centre and its corners and sides.
fn points(hull: &[Vec3]) -> Vec<DVec3> {
    let p: Vec<DVec3> = hull.iter().map(|corner| corner.as_dvec3()).collect();
    let center = p.iter().sum::<DVec3>() / p.len() as f64;
    let on_sides = (0..p.len()).map(|i| 0.5 * (p[i] + p[(i + 1) % p.len()]));
    let ends: Vec<DVec3> = p.iter().copied().chain(on_sides).collect();
    let between = |end: &DVec3| [0.37, 0.71, 0.96].map(|s| center.lerp(*end, s));
    ends.iter().flat_map(between).chain([center]).collect()
}

/// Whether a node that lists the polygon `id` contains `point`, within `room`.
fn is_covered(bsp: &PolygonBsp, node: u32, point: DVec3, id: u32, room: f64) -> bool {
    let is_listed = bsp.listed(node).contains(&id);
    let PolygonBspNode::Inner { plane, back, front, .. } = bsp.nodes[node as usize] else { return is_listed };
    let height = plane.normal.dot(point) - plane.offset;
    (is_listed && height.abs() <= room)
        || (height >= -room && is_covered(bsp, front, point, id, room))
        || (height <= room && is_covered(bsp, back, point, id, room))
}

pub(super) fn polygon_bsp_puts_polygons_on_planes(trial: &Trial<'_>) -> CheckResult {
    let corner = || prop_oneof![2 => point(4), 1 => nasty::lattice(2), 1 => rough_point(4.0)];
    let hull = (corner(), corner(), corner(), 0..16i32).prop_map(|(a, b, c, kind)| match kind {
        0 => Vec::new(),
        1..=2 => vec![vec3(a.x, a.y, 1.0), vec3(b.x, b.y, 1.0), vec3(c.x, c.y, 1.0)],
        3 => corners(&Aabb::new(a, a + b.abs())),
        // Four corners of any kind, eight in a plane, and a parallelogram.
        6 => vec![a, b, c, a + vec3(b.y, b.z, b.x)],
        7 => (0..8)
            .map(|i| (4.0 * Vec2::from_angle(std::f32::consts::FRAC_PI_4 * i as f32)).round().extend(a.z))
            .collect(),
        4..=5 => vec![a.round(), b.round(), b.round() + c.round() - a.round(), c.round()],
        _ => vec![a, b, c],
    });
    let inputs = (prop::collection::vec(hull, 1..10), nasty::scale(-24..=24), 1..=3usize, 0..=24usize);
    let inputs = inputs.prop_map(|(mut hulls, scale, leaf_size, max_depth): (Vec<Vec<Vec3>>, _, _, _)| {
        // Half of the trees are too shallow for all polygons.
        let max_depth = if max_depth < 12 { max_depth / 2 } else { max_depth + 8 };
        hulls.iter_mut().flatten().for_each(|corner| *corner *= scale);
        BspQuery { hulls, leaf_size, max_depth }
    });
    // Squares side by side, each a little farther from the plane of the first one, up to a 1000th.
    let square = |i: i32| {
        let at = |x: f32, y: f32| vec3(i as f32 + x, y, 1.0 + 2f32.powi(i - 22));
        vec![at(0.0, 0.0), at(0.5, 0.0), at(0.5, 0.5), at(0.0, 0.5)]
    };
    let steps = BspQuery { hulls: (0..12).map(square).collect(), leaf_size: 1, max_depth: 32 };
    trial.each_and(&[steps], 140, inputs, <dyn Kit>::polygon_bsp_build, |query, yours| {
        judge_tree(query, &yours)
    })
}

pub(super) fn polygon_bsp_build_ends(trial: &Trial<'_>) -> CheckResult {
    let polygons = hulls::infinite_polygons().map(|(name, hulls, most)| (name, hulls, most, 20));
    // So deep a tree would split each triangle into more than `MOST_REFERENCES` parts.
    let name = "400 large triangles that cross each other";
    let crossing = [(name, crossing_triangles(400), MOST_REFERENCES, 32)];
    let boxes = hulls::infinite_boxes(trial.about(1000)).map(|(name, hulls, most)| (name, hulls, most, 20));
    for (name, hulls, most, max_depth) in polygons.into_iter().chain(crossing).chain(boxes) {
        let n = hulls.len();
        let query = BspQuery { hulls, leaf_size: 1, max_depth };
        let input = format!("build of {name}, leaf_size 1, max_depth {max_depth}");
        let too_deep = "stop at max_depth, and where no plane divides the solids";
        let too_many = "you divide where that repeats too many primitives: make a leaf where `ListGrowth::divide` returns `None`";
        let build = || trial.kit.polygon_bsp_build(std::slice::from_ref(&query)).remove(0);
        let yours = ended(&input, WHAT_MAKES_IT, [too_deep, too_many], build)?;
        judge_tree(&query, &yours)?;
        judge_references(&input, &yours.items, most * n, too_many)?;
        // One plane has all squares; a few more planes may come before it.
        let depth = yours.depth();
        if most == 1 && depth > 8 {
            let levels = format!("{depth} levels");
            let broken = Broken::with_texts(input, levels, "at most 8 levels", "counted");
            return Err(broken.explained_by([
                "list all polygons that lie in the plane at the node: you list one, and pass the others on"
                    .when(depth > n / 2),
            ]));
        }
    }
    Ok(())
}

/// Triangles with corners that are spread evenly over the unit sphere: each crosses most of the others.
fn crossing_triangles(n: usize) -> Vec<Vec<Vec3>> {
    let corners: Vec<Vec3> = super::bsps::crossing_needles(n).into_iter().map(|needle| needle[0]).collect();
    (0..n).map(|i| [i, i + n / 3, i + 2 * n / 3].map(|j| corners[j % n]).to_vec()).collect()
}

/// Parallel sheets across a diagonal: their own planes split none of them.
pub(super) fn polygon_bsp_splits_few_polygons(trial: &Trial<'_>) -> CheckResult {
    let n = 31;
    let query = BspQuery { hulls: hulls::sheets(n), leaf_size: 2, max_depth: 32 };
    let yours = trial.kit.polygon_bsp_build(std::slice::from_ref(&query)).remove(0);
    judge_tree(&query, &yours)?;
    // A plane across an axis would split most sheets, and the planes of the sheets in their order make a list.
    let (references, depth) = (yours.items.len(), yours.depth());
    if references <= n + n / 2 && depth <= 16 {
        return Ok(());
    }
    let input = format!("build of {n} sheets side by side across a diagonal, leaf_size 2, max_depth 32");
    let expected = format!("at most {} references, 16 levels", n + n / 2);
    let yours = format!("{references} references, {depth} levels");
    Err(Broken::with_texts(input, yours, expected, "counted").explained_by([
        "your planes split many sheets: prefer a plane that splits few polygons".when(references > n + n / 2),
        "your planes leave most sheets on one side: prefer a plane that leaves few primitives on its fuller side"
            .when(depth > 16),
    ]))
}
