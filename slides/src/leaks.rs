//! Pictures of what is counted per ray: leaks of a closed mesh, shadow rays per pixel, and ways to find light.

use crate::pictures::{crop, film_of, job, load, magnified, panels, render, shown};
use anyhow::Result;
use glam::{Vec3, vec3};
use oracle::gauntlet::meshes::icosahedron;
use raykata::film::Film;
use raykata::kit::{Kit, RayKind, TriangleQuery};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::scene::{NextEvent, TriangleMethod};
use raykata::shape::Triangle;
use std::collections::{BTreeSet, HashMap};
use std::f32::consts::{PI, TAU};
use std::path::Path;

/// The number of points on each edge to which rays go.
const POINTS: u32 = 6;

/// Rays from inside a closed mesh to its edges and vertices, which miss all triangles or hit one, in a map of directions.
pub fn leaks(kit: &dyn Kit, _root: &Path) -> Result<Vec<u8>> {
    // The mesh has 5,120 triangles: an icosahedron after four steps of Loop subdivision.
    let (corners, triangles) = icosahedron();
    let (positions, triangles) = (corners.map(Vec3::normalize).to_vec(), triangles.to_vec());
    let mut mesh = Mesh { positions, triangles, ..Mesh::default() };
    for _ in 0..4 {
        mesh = kit.loop_subdivide(&[mesh]).remove(0);
    }
    let origin = vec3(0.11, -0.07, 0.05);
    // Only the triangles around an edge can be hit by a ray to it: those that have one of its ends.
    let mut around: HashMap<u32, Vec<usize>> = HashMap::new();
    let mut edges = BTreeSet::new();
    for (index, corners) in mesh.triangles.iter().enumerate() {
        for i in 0..3 {
            around.entry(corners[i]).or_default().push(index);
            let [p, q] = [corners[i], corners[(i + 1) % 3]];
            edges.insert((p.min(q), p.max(q)));
        }
    }
    let mut rays = Vec::new();
    let mut queries = Vec::new();
    for (p, q) in edges {
        let [from, to] = [p, q].map(|vertex| mesh.positions[vertex as usize]);
        // The first point is a vertex; the others are rounded points of the edge.
        for i in 0..POINTS {
            let ray = Ray::new(origin, from.lerp(to, i as f32 / POINTS as f32) - origin);
            for &index in around[&p].iter().chain(&around[&q]) {
                let [a, b, c] = mesh.corners(index);
                queries.push((rays.len(), TriangleQuery { ray, triangle: Triangle { a, b, c } }));
            }
            rays.push(ray);
        }
    }
    let asked: Vec<TriangleQuery> = queries.iter().map(|(_, query)| *query).collect();
    let panel = |hits: Vec<bool>, name: &str| {
        let mut is_hit = vec![false; rays.len()];
        for ((ray, _), hit) in queries.iter().zip(hits) {
            is_hit[*ray] |= hit;
        }
        let text =
            format!("{name}: {} leaks of {} rays", is_hit.iter().filter(|hit| !**hit).count(), rays.len());
        (map_of_directions(&rays, &is_hit), text)
    };
    let hits =
        |answers: Vec<Option<raykata::kit::TriangleHit>>| answers.iter().map(Option::is_some).collect();
    let parts = [
        panel(hits(kit.triangle_cramer(&asked)), "triangle_cramer"),
        panel(hits(kit.watertight(&asked)), "watertight"),
    ];
    panels(&parts, 1)
}

/// A map of longitude and latitude: bright spots of three by three pixels where rays miss, and dark grey elsewhere.
fn map_of_directions(rays: &[Ray], is_hit: &[bool]) -> Film {
    const SIZE: [u32; 2] = [840, 280];
    let mut film = Film::new(SIZE[0], SIZE[1]);
    film.pixels.fill(Vec3::splat(0.03));
    let place = |ray: &Ray| -> [u32; 2] {
        let d = ray.direction.normalize();
        let (across, down) = (0.5 + d.x.atan2(-d.z) / TAU, d.y.clamp(-1.0, 1.0).acos() / PI);
        [(across * SIZE[0] as f32) as u32, (down * SIZE[1] as f32) as u32]
    };
    let mut draw = |[x, y]: [u32; 2], color: Vec3| {
        if x < SIZE[0] && y < SIZE[1] {
            film.pixels[(y * SIZE[0] + x) as usize] = color;
        }
    };
    for (ray, _) in rays.iter().zip(is_hit).filter(|(_, hit)| !**hit) {
        let [x, y] = place(ray);
        for dy in 0..3 {
            for dx in 0..3 {
                draw([(x + dx).saturating_sub(1), (y + dy).saturating_sub(1)], vec3(1.0, 0.85, 0.3));
            }
        }
    }
    film
}

/// scenes/leak.toml with two tests of triangles, and the number of primary rays without a hit.
pub fn leak_room(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "leak.toml")?;
    let mut parts = Vec::new();
    for (method, name) in
        [(TriangleMethod::Cramer, "triangle_cramer"), (TriangleMethod::Watertight, "watertight")]
    {
        scene.quality.triangle_method = method;
        let rendering = render(kit, &scene)?;
        let leaks = rendering.counts.primary - rendering.counts.hits;
        parts.push((rendering.film.toned(scene.film.tone), format!("{name}: {leaks} rays leak")));
    }
    panels(&parts, 2)
}

/// scenes/shadows.toml, and the number of shadow rays of each pixel.
pub fn shadow_ray_map(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    const SIZE: u32 = 125;
    let mut scene = load(root, "shadows.toml")?;
    (scene.film.width, scene.film.height) = (500, 500);
    let picture = shown(kit, &scene)?;
    (scene.film.width, scene.film.height) = (SIZE, SIZE);
    let job = job(&scene);
    let shadows = |x, y| kit.trace(&job, x, y).iter().filter(|ray| ray.kind == RayKind::Shadow).count();
    let mut map = magnified(&film_of([SIZE; 2], |x, y| grey(shadows(x, y) as f32)), 4);
    // A scale of eleven greys at the lower edge.
    for x in 0..map.width {
        for y in map.height - 24..map.height {
            map.pixels[(y * map.width + x) as usize] = grey((11 * x / map.width) as f32);
        }
    }
    let parts =
        [(picture, "the picture".to_owned()), (map, "shadow rays per pixel, scale 0 to 10".to_owned())];
    panels(&parts, 2)
}

/// A grey that looks as bright as the number is large, from 0 (black) to 10 (white).
fn grey(n: f32) -> Vec3 {
    Vec3::splat((n / 10.0).powf(2.2))
}

/// The tall block of scenes/cornell.toml and the wall beside it, with three ways to find the light.
pub fn cornell_next_event(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "cornell.toml")?;
    let mut parts = Vec::new();
    for (next_event, samples, name) in
        [(NextEvent::Off, 19, "by chance"), (NextEvent::Only, 16, "by samples"), (NextEvent::On, 16, "both")]
    {
        scene.quality.next_event = next_event;
        scene.quality.samples_per_pixel = samples;
        let film = render(kit, &scene)?.film.toned(scene.film.tone);
        parts.push((magnified(&crop(&film, [40, 90], [110, 110]), 2), format!("{name}, {samples} samples")));
    }
    panels(&parts, 3)
}
