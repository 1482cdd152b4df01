//! The laws of the search of a BSP tree.

use super::scenes::{Scene, Thing, along, room, sphere};
use super::searches::{BSP, Described, agrees, queries, spheres_and_rays};
use super::structures::{bsp, diagonal, tile, two_leaves};
use checks::prelude::*;
use checks::tree::closest_of;
use raykata::partition::CutPlane;

pub(super) fn bsp_search_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    // The box of the large sphere crosses the plane x + y = 0, so both leaves list it. Its hit is in front of the
    // plane, behind the hit of the small sphere.
    let large = Thing::Sphere(Sphere { center: vec3(4.0, 4.0, 0.0), radius: 5.0 });
    let scene = Scene::new(vec![large, sphere(0.25, 0.2, 0.0, 0.125)]);
    let ray = Ray::new(vec3(-1.0, -1.0, 0.0), vec3(1.0, 1.0, 0.0));
    let tree = two_leaves(diagonal(), &[0], &[0, 1]);
    let mut asked = Described::new();
    asked.ask("BSP tree of one plane x + y = 0, both leaves list primitive 0", &tree, &scene, ray);
    // Nothing is hit before the plane, so the other side decides.
    let alone = Scene::new(vec![sphere(3.0, 3.0, 0.0, 0.5)]);
    asked.ask("BSP tree of one plane x + y = 0", &two_leaves(diagonal(), &[], &[0]), &alone, ray);
    asked.control("BSP tree of one plane", two_leaves(diagonal(), &[0, 1, 2], &[]), ray, (0.0, 1.0));
    asked.judge(trial.kit, &BSP)?;
    agrees(trial, &BSP)
}

/// The plane lies behind the ray or beyond its end, or the ray is parallel to it.
pub(super) fn bsp_planes_behind_and_beyond_do_not_end_the_search(trial: &Trial<'_>) -> CheckResult {
    let scene = Scene::new(vec![
        sphere(-4.0, -4.0, 0.0, 1.0),
        sphere(4.0, 4.0, 0.0, 1.0),
        sphere(-4.0, 2.0, 0.0, 1.0),
    ]);
    let tree = two_leaves(diagonal(), &[0, 2], &[1]);
    let cases = [
        ("the plane is behind the ray", Ray::new(vec3(1.0, 1.0, 0.0), vec3(1.0, 1.0, 0.0))),
        ("the plane is behind the ray", Ray::new(vec3(-1.0, -1.0, 0.0), vec3(-1.0, -1.0, 0.0))),
        ("the ray ends before the plane", Ray::new(vec3(-8.0, -8.0, 0.0), Vec3::ONE).with_range(0.0, 5.0)),
        (
            "the ray starts beyond the plane",
            Ray::new(vec3(-8.0, -8.0, 0.0), vec3(1.0, 1.0, 0.0)).with_range(9.0, 20.0),
        ),
        ("the ray runs along the plane", Ray::new(vec3(-8.0, 6.0, 0.0), vec3(1.0, -1.0, 0.0))),
        (
            "the ray crosses the plane, and hits nothing before it",
            Ray::new(vec3(-1.0, -1.0, 0.0), vec3(1.0, 1.0, 0.0)),
        ),
    ];
    let mut asked = Described::new();
    for (what, ray) in cases {
        asked.ask(format!("BSP tree of one plane x + y = 0: {what}"), &tree, &scene, ray);
    }
    asked.judge(trial.kit, &BSP)
}

/// Rays that run in the plane or start on it, and polygons that lie in it.
pub(super) fn bsp_takes_rays_on_and_along_planes(trial: &Trial<'_>) -> CheckResult {
    let mut asked = Described::new();
    let spheres = Scene::new(vec![
        sphere(3.0, -3.0, 0.0, 0.5),
        sphere(-3.0, 3.0, 0.0, 0.5),
        sphere(0.0, 0.0, 4.0, 0.5),
    ]);
    let stack = Scene::new(vec![tile(0.0), tile(1.0), tile(-1.0)]);
    for (behind, before) in
        [(&[0u32, 1, 2][..], &[][..]), (&[][..], &[0u32, 1, 2][..]), (&[1][..], &[0, 2][..])]
    {
        let tree = two_leaves(diagonal(), behind, before);
        let in_plane = [vec3(1.0, -1.0, 0.0), vec3(-1.0, 1.0, -0.0), vec3(0.0, -0.0, 1.0)]
            .map(|direction| Ray::new(Vec3::ZERO, direction));
        asked.ask_all("BSP tree of one plane x + y = 0, and a ray in it", &tree, &spheres, in_plane);
        let across = [
            Ray::new(vec3(-3.0, -3.0, 0.2), vec3(1.0, 1.0, 0.0)),
            Ray::new(vec3(2.0, 2.5, -0.3), vec3(-1.0, -1.1, 0.1)),
        ];
        asked.ask_all("BSP tree of one plane x + y = 0, with triangles in it", &tree, &stack, across);
    }
    // Rays from a point of the plane to each side.
    let sides = Scene::new(vec![sphere(3.0, 3.0, 0.0, 0.5), sphere(-3.0, -3.0, 0.0, 0.5)]);
    let tree = two_leaves(diagonal(), &[1], &[0]);
    for direction in [vec3(1.0, 1.0, 0.0), vec3(-1.0, -1.0, 0.0)] {
        let rays =
            [Vec3::ZERO, vec3(1.0, -1.0, 0.0)].map(|origin| Ray::new(origin, direction - origin / 3.0));
        asked.ask_all("BSP tree of one plane x + y = 0, and a ray that starts on it", &tree, &sides, rays);
    }
    // Planes that do not pass through the origin of the world: the height of a ray in such a plane is a rounding error.
    for size in [2f32.powi(-10), 1.0, 2f32.powi(17)] {
        for (axis, i) in (0..3).flat_map(|axis| (1..12).map(move |i| (axis, i))) {
            let turn = |x: f32, y: f32| size * along(axis, vec3(x, y, 0.0));
            // The two coordinates of each point add up to 1.75, and have few bits.
            let x = i as f32 / 8.0;
            let (origin, direction) = (turn(x, 1.75 - x), turn(1.0, -1.0));
            let normal = turn(1.0, 1.0).as_dvec3().normalize();
            let plane = CutPlane { normal, offset: normal.dot(turn(1.75, 0.0).as_dvec3()) };
            let center = origin + 3.0 * direction;
            let scene = Scene::new(vec![Thing::Sphere(Sphere { center, radius: 0.25 * size })]);
            for (behind, before) in [(&[0u32][..], &[][..]), (&[][..], &[0u32][..])] {
                let tree = two_leaves(plane, behind, before);
                let what = "BSP tree of one plane far from the origin, and a ray in it";
                asked.ask(what, &tree, &scene, Ray::new(origin, direction));
            }
        }
    }
    // A room whose walls lie in the planes of the tree.
    let (room, rays) = room();
    let tree = bsp(&room.hulls(), 5);
    asked.ask_all("BSP tree over a room of twelve triangles", &tree, &room, rays);
    asked.judge(trial.kit, &BSP)
}

pub(super) fn bsp_search_visits_what_the_ray_enters_before_its_hit(trial: &Trial<'_>) -> CheckResult {
    let (scene, rays) = spheres_and_rays(64, 5, (8, 1.5));
    let cells = bsp(&scene.hulls(), 8);
    let all = queries(&cells, &scene, &rays);
    // The same rays, which begin a little before the hit.
    let late = all.iter().map(|query| {
        let (_, t) = closest_of(&query.hits, &query.ray).expect("each ray hits");
        CellsQuery { ray: query.ray.with_range(0.9 * t, f32::INFINITY), ..query.clone() }
    });
    BSP.visits(trial.kit, "BSP tree over 64 spheres", &all.iter().cloned().chain(late).collect::<Vec<_>>())
}
