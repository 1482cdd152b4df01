//! The laws of the BSP tree with polygons in its nodes: where each part of each polygon lies, and the search.

use super::lists::{Fault, ended, fact, judge_references};
use super::parts;
use super::scenes::{Scene, Thing, sphere, wall};
use super::searches::{Asked, Searcher, agrees, judge_visits, queries, spheres_and_rays};
use super::structures::polygon_bsp;
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use checks::generate::{point, rough_point};
use checks::judge::compare;
use checks::nasty;
use checks::paste::Paste;
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::kit::{BspQuery, CellsAnswer, CellsQuery};
use raykata::partition::{CutPlane, MOST_REFERENCES, PolygonBsp, PolygonBspNode, corners};
use raykata::ray::Ray;
use raykata::shape::Triangle;

const WHAT_MAKES_IT: &str = "the definition of a BSP tree with polygons in its nodes";

fn describe(query: &BspQuery) -> String {
    let hulls: Vec<String> = query.hulls.iter().map(checks::paste::list).collect();
    format!("build(&[{}], {}, {})", hulls.join(", "), query.leaf_size, query.max_depth)
}

fn usable(hull: &[Vec3]) -> bool {
    !hull.is_empty() && hull.iter().all(|corner| corner.is_finite())
}

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
    match area {
        0.0 => Kind::Solid,
        _ if area > 1e-6 * size * size && bent <= 1e-12 * size * area => Kind::Polygon,
        _ => Kind::Unclear,
    }
}

fn judge_tree(query: &BspQuery, yours: &PolygonBsp) -> CheckResult {
    let nothing = !query.hulls.iter().any(|hull| usable(hull));
    super::lists::judge_tree(
        || describe(query),
        WHAT_MAKES_IT,
        (nothing, yours.nodes.len()),
        || fault(query, yours),
    )
}

fn fault(query: &BspQuery, yours: &PolygonBsp) -> Option<Fault> {
    if yours.depth() > query.max_depth + 1 {
        let (deep, expected) = (yours.depth() - 1, query.max_depth);
        let (deep, expected) = (format!("a node at depth {deep}"), format!("at most {expected}"));
        return Some(fact(deep, expected, "the tree is deeper than max_depth"));
    }
    let sizes = query.hulls.iter().flatten().filter(|p| p.is_finite()).map(|p| p.abs().max_element());
    let size = f64::from(sizes.fold(0.0, f32::max));
    if !(0.0..=size / 1000.0).contains(&yours.room) {
        let expected = format!("0 to {}", size / 1000.0);
        let mistake = "room is from 0 to a 1000th of the largest coordinate";
        return Some(fact(format!("room: {}", yours.room), expected, mistake));
    }
    // Judge each node: what it lists must be in its region and, in an inner node, in its plane.
    let slack = size / 64.0;
    let mut faults = Vec::new();
    yours.walk(|node, above, depth| {
        let (listed, plane) = match yours.nodes[node as usize] {
            PolygonBspNode::Inner { plane, first, count, .. } => {
                (yours.primitives(first, count), Some(plane))
            }
            PolygonBspNode::Leaf { first, count } => (yours.primitives(first, count), None),
        };
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
                faults.push(fact(
                    format!("solid {id} is not listed in leaf {node}"),
                    "once".into(),
                    "a solid belongs to every leaf that it overlaps or touches",
                ));
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
            return Some(fact(
                format!("primitive {id}"),
                "a number of a hull".into(),
                "there is no such primitive",
            ));
        };
        let says = |what: &str| format!("node {node} lists primitive {id}{what}");
        if !usable(hull) {
            let mistake = "you list a hull with NaN or without corners: leave it out";
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
                    (
                        kind == Kind::Polygon && above.iter().all(within),
                        "split a polygon that crosses a plane, and pass only its parts on: you pass the whole polygon to both sides",
                    ),
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
                return Some((
                    format!("no node lists polygon {id} at its point {point}"),
                    "one node".into(),
                    vec![
                        (nowhere, "you leave out a polygon: no node lists it"),
                        (
                            !nowhere,
                            "a part of a polygon is lost: a polygon that crosses a plane has a part on each side",
                        ),
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
    match bsp.nodes[node as usize] {
        PolygonBspNode::Leaf { first, count } => bsp.primitives(first, count).contains(&id),
        PolygonBspNode::Inner { plane, first, count, back, front } => {
            let height = plane.normal.dot(point) - plane.offset;
            let here = height.abs() <= room && bsp.primitives(first, count).contains(&id);
            here || (height >= -room && is_covered(bsp, front, point, id, room))
                || (height <= room && is_covered(bsp, back, point, id, room))
        }
    }
}

pub(super) fn polygon_bsp_puts_polygons_on_planes(trial: &Trial<'_>) -> CheckResult {
    let corner = || prop_oneof![2 => point(4), 1 => nasty::lattice(2), 1 => rough_point(4.0)];
    let hull = (corner(), corner(), corner(), 0..16i32).prop_map(|(a, b, c, kind)| match kind {
        0 => vec![a, Vec3::NAN, c],
        1..=2 => vec![vec3(a.x, a.y, 1.0), vec3(b.x, b.y, 1.0), vec3(c.x, c.y, 1.0)],
        3 => corners(&Aabb::new(a, a + b.abs())),
        // A parallelogram.
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
    trial.forall(140, inputs, |queries| {
        compare(queries, trial.kit.polygon_bsp_build(queries), |query, yours| judge_tree(query, &yours))
    })
}

pub(super) fn polygon_bsp_build_ends(trial: &Trial<'_>) -> CheckResult {
    let square = |s: f32| vec![vec3(-s, -s, 0.0), vec3(s, -s, 0.0), vec3(s, s, 0.0), vec3(-s, s, 0.0)];
    let star = (0..30).map(|i| {
        let (y, x) = (i as f32 * 0.21).sin_cos();
        vec![vec3(x, y, -1.0), vec3(-x, -y, -1.0), vec3(-x, -y, 1.0), vec3(x, y, 1.0)]
    });
    let line = (0..20).map(|i| [0.0, 0.5, 0.7].map(|x| vec3(i as f32 + x, 0.0, 0.0)).to_vec());
    let hulls: [(&str, Vec<Vec<Vec3>>, usize); 4] = [
        // One node lists all of them.
        ("forty squares in one plane", (1..=40).map(|i| square(i as f32)).collect(), 1),
        ("thirty sheets through one line", star.collect(), MOST_REFERENCES),
        ("twenty slivers in a line", line.collect(), MOST_REFERENCES),
        ("400 large triangles that cross each other", crossing_triangles(400), MOST_REFERENCES),
    ];
    let boxes = |all: Vec<Aabb>| -> Vec<Vec<Vec3>> { all.iter().map(corners).collect() };
    let sets = super::lists::infinite().into_iter().map(|(name, all)| (name, boxes(all), MOST_REFERENCES));
    for (name, hulls, most) in hulls.into_iter().chain(sets) {
        let n = hulls.len();
        let query = BspQuery { hulls, leaf_size: 1, max_depth: 20 };
        let input = format!("build of {name}, leaf_size 1, max_depth 20");
        let too_deep = "stop at max_depth, and where no plane divides the solids";
        let too_many = "you divide where that repeats too many primitives: make a leaf where `Growth::divide` returns `None`";
        let build = || trial.kit.polygon_bsp_build(std::slice::from_ref(&query)).remove(0);
        let yours = ended(&input, WHAT_MAKES_IT, [too_deep, too_many], build)?;
        judge_tree(&query, &yours)?;
        judge_references(&input, &yours.items, most * n, too_many)?;
        // One plane has all squares; a few more planes may come before it.
        let depth = yours.depth();
        if most == 1 && depth > 8 {
            let levels = format!("{depth} levels");
            let broken = Broken::with_texts(input, levels, "at most 8 levels", "counted");
            return Err(broken.explained_by([(
                depth > n / 2,
                "list all polygons that lie in the plane at the node: you list one, and pass the others on",
            )]));
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
    let sheet = |at: f32| {
        let p = |u: f32, v: f32| vec3(at + u, at - u, v);
        vec![p(-40.0, -40.0), p(40.0, -40.0), p(40.0, 40.0), p(-40.0, 40.0)]
    };
    let n = 31;
    let hulls = (0..n).map(|i| sheet(0.25 * i as f32)).collect();
    let query = BspQuery { hulls, leaf_size: 2, max_depth: 32 };
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
        (
            references > n + n / 2,
            "your planes split many sheets: prefer a plane that splits few polygons",
        ),
        (
            depth > 16,
            "your planes leave most sheets on one side: prefer a plane that leaves few primitives on its fuller side",
        ),
    ]))
}

/// A tree of one plane with these primitives on it, behind it and in front of it.
fn one_plane(plane: CutPlane, on_plane: &[u32], behind: &[u32], before: &[u32]) -> PolygonBsp {
    let mut bsp = PolygonBsp { room: 1e-6, ..PolygonBsp::default() };
    let root = bsp.add_node(0, 1);
    let [back, front] = [bsp.add_node(1, 1), bsp.add_node(1, 1)];
    bsp.set_leaf(back, behind);
    bsp.set_leaf(front, before);
    bsp.set_children(root, plane, on_plane, back, front);
    bsp
}

fn diagonal() -> CutPlane {
    CutPlane { normal: DVec3::new(1.0, 1.0, 0.0).normalize(), offset: 0.0 }
}

/// A triangle in the plane x + y = 0.
fn tile(z: f32) -> Thing {
    let corners = [vec3(4.0, -4.0, z - 4.0), vec3(-4.0, 4.0, z - 4.0), vec3(0.0, 0.0, z + 4.0)];
    Thing::Tile(Triangle { a: corners[0], b: corners[1], c: corners[2] })
}

pub(super) fn polygon_bsp_search_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    // A large sphere in the leaf of the near side is hit on the far side, behind a triangle on the plane.
    let large = Thing::Sphere(raykata::shape::Sphere { center: vec3(4.0, 4.0, 0.0), radius: 5.0 });
    let scene = Scene::new(vec![large, tile(0.0), sphere(0.25, 0.2, 0.0, 0.125)]);
    let mut asked = Asked::new();
    for (origin, direction) in
        [(vec3(-3.0, -3.0, 0.0), vec3(1.0, 1.0, 0.0)), (vec3(3.0, 2.0, 0.3), vec3(-1.0, -1.0, 0.1))]
    {
        let ray = Ray::new(origin, direction);
        let what = "BSP tree of one plane x + y = 0 with triangle 1 on it";
        asked.ask(what, &one_plane(diagonal(), &[1], &[0], &[0, 2]), &scene, ray);
        let alone = Scene::new(vec![tile(0.0), tile(1.0)]);
        asked.ask(what, &one_plane(diagonal(), &[1, 0], &[], &[]), &alone, ray);
    }
    let ray = Ray::new(vec3(-3.0, -3.0, 0.0), vec3(1.0, 1.0, 0.0));
    let control = one_plane(diagonal(), &[], &[0, 1, 2], &[]);
    asked.control("BSP tree of one plane without polygons", control, ray, (0.0, 2.0));
    asked.judge(|queries| trial.kit.polygon_bsp_search(queries))?;
    agrees(trial, Searcher::PolygonBsp)
}

/// Trap A7, and rays that run in a plane, start on it, or end on it.
pub(super) fn polygon_bsp_takes_rays_on_and_along_planes(trial: &Trial<'_>) -> CheckResult {
    let scene = Scene::new(vec![
        sphere(-4.0, -4.0, 0.0, 1.0),
        sphere(4.0, 4.0, 0.0, 1.0),
        sphere(3.0, -3.0, 6.0, 0.5),
        tile(0.0),
        tile(1.0),
    ]);
    let tree = one_plane(diagonal(), &[4, 3], &[0, 2], &[1]);
    let in_front = one_plane(diagonal(), &[4, 3], &[0], &[1, 2]);
    let cases = [
        ("the plane is behind the ray", vec3(1.0, 1.0, 0.0), vec3(1.0, 1.0, 0.0), (0.0, f32::INFINITY)),
        ("the plane is behind the ray", vec3(-1.0, -1.0, 0.0), vec3(-1.0, -1.0, 0.0), (0.0, f32::INFINITY)),
        ("the ray ends before the plane", vec3(-8.0, -8.0, 0.0), vec3(1.0, 1.0, 0.0), (0.0, 5.0)),
        ("the ray starts beyond the plane", vec3(-8.0, -8.0, 0.0), vec3(1.0, 1.0, 0.0), (9.0, 20.0)),
        ("the ray crosses the plane", vec3(-2.0, -2.0, 0.0), vec3(1.0, 1.0, 0.0), (0.0, f32::INFINITY)),
        ("the ray crosses the plane", vec3(2.0, 2.5, 0.5), vec3(-1.0, -1.0, 0.1), (0.0, f32::INFINITY)),
        ("the ray runs in the plane", vec3(0.0, 0.0, 6.0), vec3(1.0, -1.0, 0.0), (0.0, f32::INFINITY)),
        ("the ray runs in the plane", vec3(6.0, -6.0, 6.0), vec3(-1.0, 1.0, -0.0), (0.0, f32::INFINITY)),
        ("the ray starts on the plane", vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 0.0), (0.0, f32::INFINITY)),
        ("the ray starts on the plane", vec3(0.5, -0.5, 0.0), vec3(-1.0, -0.75, 0.0), (0.0, f32::INFINITY)),
    ];
    let mut asked = Asked::new();
    for (what, origin, direction, (t_min, t_max)) in cases {
        let ray = Ray::new(origin, direction).with_range(t_min, t_max);
        for tree in [&tree, &in_front] {
            let what = format!("BSP tree of one plane x + y = 0 with two triangles on it: {what}");
            asked.ask(what, tree, &scene, ray);
        }
    }
    // A triangle that counts as lying in the plane, and is bent out of it by less than the room; the ray runs beside the
    // plane within the room.
    let bent = [vec3(4.0, -4.0, -4.0), vec3(-4.0, 4.0, -4.0), vec3(0.004, 0.004, 4.0)];
    let bent = Scene::new(vec![Thing::Tile(Triangle { a: bent[0], b: bent[1], c: bent[2] })]);
    for height in [0.001, 0.002, 0.003] {
        let tree = PolygonBsp { room: 0.008, ..one_plane(diagonal(), &[0], &[], &[]) };
        let ray = Ray::new(vec3(height, height, 6.0), Vec3::NEG_Z);
        asked.ask(
            "BSP tree of one plane, room 0.008, and a triangle that is up to 0.006 off it",
            &tree,
            &bent,
            ray,
        );
    }
    // A room whose walls lie in the planes of the tree.
    let walls = (0..3).flat_map(|axis| [wall(axis, -1.0, 1.0), wall(axis, 1.0, 1.0)]).flatten();
    let room = Scene::new(walls.collect());
    let tree = polygon_bsp(&room.hulls(), 8);
    for i in 0..64 {
        let spread = |k: i32| ((i * k) % 17) as f32 / 8.5 - 1.0;
        let ray = Ray::new(vec3(0.1, -0.2, 0.3), vec3(spread(3), spread(5), spread(7) + 0.01));
        asked.ask("BSP tree over a room of twelve triangles", &tree, &room, ray);
    }
    asked.judge(|queries| trial.kit.polygon_bsp_search(queries))
}

pub(super) fn polygon_bsp_visits_what_the_ray_enters_before_its_hit(trial: &Trial<'_>) -> CheckResult {
    let place = |i: usize| vec3((i % 8) as f32, (i / 8 % 4) as f32, (i / 32) as f32 * 1.5);
    let (spheres, rays) = spheres_and_rays(&(0..64).map(place).collect::<Vec<Vec3>>(), 5, 12.0);
    // Each sphere gets three walls behind it.
    let tiles = (0..64).step_by(4).flat_map(|i| {
        let [a, b] = wall(i % 3, 0.0, 0.4);
        [a, b].map(|thing| match thing {
            Thing::Tile(Triangle { a, b, c }) => {
                let [a, b, c] = [a, b, c].map(|corner| corner + place(i) + 0.45);
                Thing::Tile(Triangle { a, b, c })
            }
            thing => thing,
        })
    });
    let scene = Scene::new(spheres.things.iter().cloned().chain(tiles).collect());
    let cells = polygon_bsp(&scene.hulls(), 8);
    let queries = queries(&cells, &scene, &rays);
    all_hold(compare(&queries, trial.kit.polygon_bsp_search(&queries), |query, yours| {
        let parts = parts::of_polygon_bsp(&cells, &query.ray);
        judge_visits("BSP tree over 64 spheres and 32 triangles", query, &parts, &yours)?;
        judge_tests(query, &yours)
    }))
}

/// Judges the tests: each tested primitive is in a visited leaf, or on the plane of a visited node that the ray reaches
/// in the node.
fn judge_tests(query: &CellsQuery<PolygonBsp>, yours: &CellsAnswer) -> CheckResult {
    let (cells, ray) = (&query.cells, &query.ray);
    let reached = parts::reached_planes(cells, ray);
    let may_test = |primitive: u32| {
        yours.visits.iter().any(|&node| match cells.nodes[node as usize] {
            PolygonBspNode::Leaf { first, count } => cells.primitives(first, count).contains(&primitive),
            PolygonBspNode::Inner { first, count, .. } => {
                reached.contains(&node) && cells.primitives(first, count).contains(&primitive)
            }
        })
    };
    match yours.tests.iter().find(|&&primitive| !may_test(primitive)) {
        None => Ok(()),
        Some(primitive) => Err(Broken::with_texts(
            format!("BSP tree over 64 spheres and 32 triangles\n{}", ray.paste()),
            format!("a test of polygon {primitive}"),
            "none: the ray does not come to its plane within the node",
            "counted",
        )
        .explained_by([(
            true,
            "you test polygons on planes that the ray does not reach within the node: test them between the near side and the far side",
        )])),
    }
}
