//! Scenes of triangles that are hard to search, and rays for them.

use super::meshes::closed;
use crate::splitmix::Random;
use glam::{Vec3, vec3};
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The triangles of a scene, and the region in which rays start.
pub struct HardScene {
    /// The name in tables.
    pub name: &'static str,
    /// The triangles that are searched.
    pub triangles: Vec<Triangle>,
    /// The largest distance along each axis between `middle` and the origin of a ray.
    pub room: f32,
    /// A point near the middle of the triangles.
    pub middle: Vec3,
}

/// All scenes: empty, one triangle, copies, hair, hills, flat, in a line, on a lattice, small in large, and far
/// away.
pub fn hard_scenes() -> Vec<HardScene> {
    let mut random = Random::new(11, 0);
    let sphere: Vec<Triangle> = closed().get(1).map(|mesh| mesh.all()).unwrap_or_default();
    let mut soup = |count: usize, size: f32, place: Vec3| -> Vec<Triangle> {
        let one = |_| {
            let at = place + 4.0 * size * random.in_cube();
            let [a, b, c] = [(); 3].map(|()| at + size * random.in_cube());
            Triangle { a, b, c }
        };
        (0..count).map(one).collect()
    };
    let scene = |name, triangles, room, middle| HardScene { name, triangles, room, middle };
    let unit = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };

    // A floor of size 100,000, and on it a pot of size a thousandth.
    let mut stadium = square(Vec3::ZERO, 1e5 * Vec3::X, 1e5 * Vec3::Z).to_vec();
    stadium.extend(sphere.iter().map(|t| map(t, |v| 1e-3 * v + vec3(0.0, 2e-3, 0.0))));
    let copies = soup(25, 1.0, Vec3::ZERO);
    let lattice = |n: i32| {
        let corner = |i: i32| vec3((i % 3) as f32, (i / 3 % 3) as f32, (i / 9 % 3) as f32) - 1.0;
        Triangle { a: corner(n), b: corner(7 * n + 1), c: corner(11 * n + 5) }
    };
    let line = |n: i32| {
        let x = n as f32;
        Triangle { a: vec3(x, 0.0, 0.0), b: vec3(x + 0.5, 0.0, 0.0), c: vec3(x + 1.0, 0.0, 0.0) }
    };
    vec![
        scene("nothing", Vec::new(), 2.0, Vec3::ZERO),
        scene("one", vec![unit], 2.0, Vec3::ZERO),
        scene("soup", soup(300, 1.0, Vec3::ZERO), 6.0, Vec3::ZERO),
        scene("each four times", [&copies[..]; 4].concat(), 6.0, Vec3::ZERO),
        scene("hair", hair(), 6.0, Vec3::ZERO),
        scene("terrain", terrain(), 6.0, vec3(0.0, 3.0, 0.0)),
        scene("room of flat walls", room(), 0.9, Vec3::ZERO),
        scene("lattice", (0..200).map(lattice).collect(), 3.0, Vec3::ZERO),
        scene("in a line, without area", (0..50).map(line).collect(), 30.0, Vec3::ZERO),
        scene("closed", sphere.clone(), 0.1, Vec3::ZERO),
        scene("small in large", stadium, 4e-3, vec3(0.0, 4e-3, 0.0)),
        scene("far away", soup(200, 1.0, vec3(1e5, 1e5, -1e5)), 6.0, vec3(1e5, 1e5, -1e5)),
        scene("huge", soup(200, 1e14, Vec3::ZERO), 6e14, Vec3::ZERO),
    ]
}

/// Strands a thousand times as long as wide.
fn hair() -> Vec<Triangle> {
    let mut random = Random::new(11, 1);
    let mut strand = || {
        let (root, along) = (4.0 * random.in_cube(), 3.0 * random.direction());
        Triangle { a: root, b: root + 3e-3 * random.direction(), c: root + along }
    };
    (0..300).map(|_| strand()).collect()
}

/// Hills of 18 by 18 squares, with whole eighths as heights.
fn terrain() -> Vec<Triangle> {
    let at = |x: i32, z: i32| {
        vec3(0.5 * x as f32 - 4.5, ((7 * x * x + 3 * x * z + 5 * z) % 9) as f32 / 8.0, 0.5 * z as f32 - 4.5)
    };
    let square = |x: i32, z: i32| {
        let [a, b, c, d] = [at(x, z), at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)];
        [Triangle { a, b, c }, Triangle { a, b: c, c: d }]
    };
    (0..18).flat_map(|x| (0..18).flat_map(move |z| square(x, z))).collect()
}

fn map(triangle: &Triangle, change: impl Fn(Vec3) -> Vec3) -> Triangle {
    Triangle { a: change(triangle.a), b: change(triangle.b), c: change(triangle.c) }
}

fn square(middle: Vec3, side: Vec3, up: Vec3) -> [Triangle; 2] {
    let [a, b, c, d] = [-side - up, side - up, side + up, up - side].map(|corner| middle + corner);
    [Triangle { a, b, c }, Triangle { a, b: c, c: d }]
}

/// Six walls of 4 × 4 squares each, seen from inside: every box of a wall is flat.
fn room() -> Vec<Triangle> {
    let mut walls = Vec::new();
    for (axis, way) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, -1.0), (axis, 1.0)]) {
        let [normal, side, up] = [0, 1, 2].map(|k| Vec3::AXES[(axis + k) % 3]);
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i as f32, j as f32))) {
            let middle = way * normal + (0.5 * i - 0.75) * side + (0.5 * j - 0.75) * up;
            walls.extend(square(middle, 0.25 * side, 0.25 * up));
        }
    }
    walls
}

impl HardScene {
    /// A ray at a corner, at an edge, into a triangle, along an axis, or anywhere.
    pub fn ray(&self, random: &mut Random) -> Ray {
        let origin = self.middle + self.room * random.in_cube();
        let anywhere = random.in_cube();
        if self.triangles.is_empty() {
            return Ray::new(origin, anywhere);
        }
        let Triangle { a, b, c } = self.triangles[random.below(self.triangles.len() as u64) as usize];
        let target = match random.below(5) {
            0 => a,
            1 => b.lerp(c, random.unit()),
            2 | 3 => (a + b + c) / 3.0,
            _ => return Ray::new(origin, anywhere),
        };
        // Sometimes go straight along an axis, from a point that has two coordinates of the target.
        if random.below(8) == 0 && target.is_finite() {
            let axis = random.below(3) as usize;
            let mut from = target;
            from[axis] = origin[axis];
            return Ray::new(from, target - from);
        }
        let direction = target - origin;
        Ray::new(origin, if direction == Vec3::ZERO || !direction.is_finite() { anywhere } else { direction })
    }
}
