//! The sets of boxes over which trees are built.

use checks::prelude::*;
use oracle::splitmix::Random;

/// The name of a set of boxes, and the boxes.
pub type Scene = (&'static str, Vec<Aabb>);

fn around(center: Vec3, half: Vec3) -> Aabb {
    Aabb::new(center - half, center + half)
}

/// Sets of boxes as scenes have them: small and large ones, dense and sparse, long and flat.
pub fn scenes() -> Vec<Scene> {
    let mut random = Random::new(12, 1);
    let mut cloud = |n: usize, half: f32| -> Vec<Aabb> {
        (0..n).map(|_| around(random.in_cube(), Vec3::splat(half))).collect()
    };
    let (even, soup) = (cloud(2000, 0.02), cloud(600, 0.3));
    // A small dense object in a large sparse surrounding.
    let mut stadium = cloud(1500, 0.01);
    stadium.extend(cloud(300, 0.004).iter().map(|one| Aabb::new(100.0 * one.min, 100.0 * one.max)));
    stadium.push(around(Vec3::ZERO, vec3(110.0, 1.0, 110.0)));
    // Long thin boxes that lean in all directions.
    let hair = (0..1200)
        .map(|i| {
            let root = random.in_cube() * vec3(1.0, 0.02, 1.0);
            let lean = random.in_cube() * vec3(0.15, 0.0, 0.15);
            let segment = vec3(0.0, (i % 8) as f32 / 8.0, 0.0);
            let (low, high) = (root + segment, root + segment + lean + vec3(0.0, 0.125, 0.0));
            Aabb::new(low.min(high) - 0.001, low.max(high) + 0.001)
        })
        .collect();
    // The cells of a landscape: flat neighbours that touch each other.
    let height = |x: i32, z: i32| 2.0 * (0.3 * x as f32).sin() * (0.2 * z as f32).cos();
    let landscape = (0..40 * 40)
        .map(|i| {
            let (x, z) = (i % 40, i / 40);
            let corners = [(x, z), (x + 1, z), (x, z + 1), (x + 1, z + 1)];
            let points = corners.map(|(x, z)| vec3(x as f32, height(x, z), z as f32));
            let low = points.into_iter().fold(Vec3::INFINITY, Vec3::min);
            Aabb::new(low, points.into_iter().fold(Vec3::NEG_INFINITY, Vec3::max))
        })
        .collect();
    // Boxes of all sizes, from 1 down to 2⁻¹⁰.
    let sizes = (0..1000)
        .map(|i| around(random.in_cube(), 0.5f32.powi(i % 11) * 0.2 * (random.in_cube().abs() + 0.1)))
        .collect();
    vec![
        ("an even cloud", even),
        ("a soup of large boxes", soup),
        ("a small object in a stadium", stadium),
        ("hair", hair),
        ("a landscape", landscape),
        ("boxes of all sizes", sizes),
    ]
}
