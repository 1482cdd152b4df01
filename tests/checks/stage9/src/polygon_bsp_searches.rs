//! The laws of the search in a BSP tree with polygons in its nodes.

use super::parts;
use super::scenes::{Scene, Thing, room, sphere, wall};
use super::searches::{Described, POLYGON_BSP, agrees, place, queries, spheres_and_rays};
use super::structures::{diagonal, one_plane, polygon_bsp, tile};
use checks::prelude::*;
use raykata::partition::{PolygonBsp, TreeNode};

pub(super) fn polygon_bsp_search_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    // A large sphere in the leaf of the near side is hit on the far side, behind a triangle on the plane.
    let large = Thing::Sphere(raykata::shape::Sphere { center: vec3(4.0, 4.0, 0.0), radius: 5.0 });
    let scene = Scene::new(vec![large, tile(0.0), sphere(0.25, 0.2, 0.0, 0.125)]);
    let mut asked = Described::new();
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
    asked.judge(trial.kit, &POLYGON_BSP)?;
    agrees(trial, &POLYGON_BSP)
}

/// Planes behind the ray or beyond its end, and rays that run in a plane, start on it, or end on it.
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
    let mut asked = Described::new();
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
    let (room, rays) = room();
    let tree = polygon_bsp(&room.hulls(), 8);
    asked.ask_all("BSP tree over a room of twelve triangles", &tree, &room, rays);
    asked.judge(trial.kit, &POLYGON_BSP)
}

pub(super) fn polygon_bsp_visits_what_the_ray_enters_before_its_hit(trial: &Trial<'_>) -> CheckResult {
    let (spheres, rays) = spheres_and_rays(64, 5, (8, 1.5));
    // A wall of two triangles stands behind every fourth sphere.
    let tiles = (0..64).step_by(4).flat_map(|i| {
        wall(i % 3, 0.0, 0.4).map(|thing| thing.moved(|point| point + place(i, 8, 1.5) + 0.45))
    });
    let scene = Scene::new(spheres.things.iter().cloned().chain(tiles).collect());
    let cells = polygon_bsp(&scene.hulls(), 8);
    POLYGON_BSP.all_visits(trial.kit, &queries(&cells, &scene, &rays), |query, yours| {
        POLYGON_BSP.judge_visits("BSP tree over 64 spheres and 32 triangles", query, &yours)?;
        judge_tests(query, &yours)
    })
}

/// Judges the tests: each tested primitive is in a visited leaf, or on the plane of a visited node that the ray reaches
/// in the node.
fn judge_tests(query: &CellsQuery<PolygonBsp>, yours: &CellsAnswer) -> CheckResult {
    let (cells, ray) = (&query.cells, &query.ray);
    let reached = parts::reached_planes(cells, ray);
    let is_reached = |node: u32| cells.nodes[node as usize].is_leaf() || reached.contains(&node);
    let may_test = |primitive: u32| {
        yours.visits.iter().any(|&node| is_reached(node) && cells.listed(node).contains(&primitive))
    };
    match yours.tests.iter().find(|&&primitive| !may_test(primitive)) {
        None => Ok(()),
        Some(primitive) => Err(Broken::with_texts(
            format!("BSP tree over 64 spheres and 32 triangles\n{}", ray.paste()),
            format!("a test of polygon {primitive}"),
            "none: the ray does not come to its plane within the node",
            "counted",
        )
        .because("you test polygons on planes that the ray does not reach within the node: test them between the near side and the far side")),
    }
}
