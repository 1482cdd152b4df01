//! Distributions of rays and triangles: each targets a weakness of some method.

use crate::splitmix::Random;
use glam::{Vec3, vec3};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use std::f32::consts::TAU;

/// A distribution of inputs, with its name.
pub struct Distribution {
    /// The name, for the head of a column.
    pub name: &'static str,
    /// A description, which says what is hard.
    pub what: &'static str,
    /// Draws one input.
    pub draw: fn(&mut Random) -> (Ray, Triangle),
}

/// All distributions.
pub const DISTRIBUTIONS: [Distribution; 12] = [
    Distribution { name: "interior", what: "aimed well inside: every method should hit", draw: interior },
    Distribution { name: "edge", what: "aimed at a rounded point of an edge", draw: edge },
    Distribution { name: "vertex", what: "aimed at a corner", draw: vertex },
    Distribution {
        name: "sliver",
        what: "100,000 times as long as wide, aimed at the long edge",
        draw: sliver,
    },
    Distribution {
        name: "needle",
        what: "a side of a prism a million times as long as wide, from inside",
        draw: needle,
    },
    Distribution { name: "far", what: "a million sizes away, aimed at an edge", draw: far },
    Distribution { name: "tiny", what: "eight steps of a float wide, at 1, aimed at an edge", draw: tiny },
    Distribution { name: "offset", what: "at (148376, 1234, -223423), aimed at an edge", draw: offset },
    Distribution { name: "grazing", what: "nearly in the plane, aimed at an edge", draw: grazing },
    Distribution { name: "1e-14", what: "of size 1e-14, aimed at an edge", draw: small },
    Distribution { name: "1e14", what: "of size 1e14, aimed at an edge", draw: large },
    Distribution { name: "ties", what: "small whole numbers, exactly through an edge", draw: ties },
];

fn random_triangle(random: &mut Random) -> Triangle {
    let [a, b, c] = [(); 3].map(|()| random.in_cube());
    Triangle { a, b, c }
}

fn aimed(random: &mut Random, target: Vec3) -> Ray {
    let origin = 4.0 * random.in_cube();
    Ray::new(origin, target - origin)
}

fn on_edge(random: &mut Random, triangle: &Triangle) -> Vec3 {
    triangle.a.lerp(triangle.b, random.unit())
}

fn interior(random: &mut Random) -> (Ray, Triangle) {
    let triangle = random_triangle(random);
    let weights = [(); 3].map(|()| 0.1 + random.unit());
    let sum: f32 = weights.iter().sum();
    let target = (weights[0] * triangle.a + weights[1] * triangle.b + weights[2] * triangle.c) / sum;
    (aimed(random, target), triangle)
}

fn edge(random: &mut Random) -> (Ray, Triangle) {
    let triangle = random_triangle(random);
    let target = on_edge(random, &triangle);
    (aimed(random, target), triangle)
}

fn vertex(random: &mut Random) -> (Ray, Triangle) {
    let triangle = random_triangle(random);
    (aimed(random, triangle.b), triangle)
}

fn sliver(random: &mut Random) -> (Ray, Triangle) {
    let [a, b] = [(); 2].map(|()| random.in_cube());
    let c = a.lerp(b, random.unit()) + 1e-5 * random.direction();
    let triangle = Triangle { a, b, c };
    let target = on_edge(random, &triangle);
    (aimed(random, target), triangle)
}

fn needle(random: &mut Random) -> (Ray, Triangle) {
    // Take two lines along z, a thousandth from the axis and from each other.
    let turn = TAU * random.unit();
    let side = |angle: f32, z: f32| vec3(1e-3 * angle.cos(), 1e-3 * angle.sin(), z);
    let triangle = Triangle { a: side(turn, -1000.0), b: side(turn, 1000.0), c: side(turn + 1.0, 1000.0) };
    let origin = 1e-4 * random.in_cube();
    let share = random.unit();
    let target = triangle.a.lerp(triangle.b, share).lerp(triangle.c, 0.5 * random.unit());
    (Ray::new(origin, target - origin), triangle)
}

fn far(random: &mut Random) -> (Ray, Triangle) {
    let triangle = random_triangle(random);
    let origin = 1e6 * random.direction();
    let target = on_edge(random, &triangle);
    (Ray::new(origin, target - origin), triangle)
}

fn tiny(random: &mut Random) -> (Ray, Triangle) {
    let [a, b, c] = [(); 3].map(|()| Vec3::ONE + 1e-6 * random.in_cube());
    let triangle = Triangle { a, b, c };
    let target = on_edge(random, &triangle);
    (aimed(random, target), triangle)
}

fn offset(random: &mut Random) -> (Ray, Triangle) {
    let place = vec3(148_376.0, 1234.0, -223_423.0);
    let [a, b, c] = [(); 3].map(|()| place + random.in_cube());
    let triangle = Triangle { a, b, c };
    let target = on_edge(random, &triangle);
    let origin = place + 4.0 * random.in_cube();
    (Ray::new(origin, target - origin), triangle)
}

fn grazing(random: &mut Random) -> (Ray, Triangle) {
    let triangle = random_triangle(random);
    let target = on_edge(random, &triangle);
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a).normalize_or(Vec3::Z);
    let origin = target + 2.0 * (target - triangle.c) + 1e-5 * normal;
    (Ray::new(origin, target - origin), triangle)
}

fn scaled(random: &mut Random, size: f32) -> (Ray, Triangle) {
    let (ray, Triangle { a, b, c }) = edge(random);
    let direction = size * ray.direction;
    (Ray::new(size * ray.origin, direction), Triangle { a: size * a, b: size * b, c: size * c })
}

fn small(random: &mut Random) -> (Ray, Triangle) {
    scaled(random, 1e-14)
}

fn large(random: &mut Random) -> (Ray, Triangle) {
    scaled(random, 1e14)
}

fn ties(random: &mut Random) -> (Ray, Triangle) {
    let whole = |random: &mut Random| {
        vec3(random.below(17) as f32, random.below(17) as f32, random.below(17) as f32) - 8.0
    };
    loop {
        let [a, step, c, origin] = [(); 4].map(|()| whole(random));
        // The middle of the edge has whole coordinates, and the ray goes there.
        let triangle = Triangle { a, b: a + 2.0 * step, c };
        let direction = a + step - origin;
        if step.cross(c - a).dot(direction) != 0.0 {
            return (Ray::new(origin, direction), triangle);
        }
    }
}
