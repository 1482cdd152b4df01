//! The scenes: triangles, and where the camera and the light are.

use glam::{Vec2, Vec3};
use oracle::gauntlet::meshes::icosahedron;
use oracle::splitmix::Random;
use raykata::shape::Triangle;

/// Triangles, and where the camera and the light are.
pub struct Scene {
    pub name: &'static str,
    pub triangles: Vec<Triangle>,
    pub eye: Vec3,
    pub target: Vec3,
    /// The angle of view, in degrees.
    pub field: f32,
    pub light: Vec3,
}

/// The scenes of the standard run.
pub const NAMES: [&str; 5] = ["icosphere", "stadium", "hair", "soup", "terrain"];

/// The scene of this name.
pub fn by_name(name: &str) -> Option<Scene> {
    // Around the origin, seen from the front.
    let in_front = |name, triangles| Scene {
        name,
        triangles,
        eye: Vec3::new(0.0, 0.0, 3.0),
        target: Vec3::ZERO,
        field: 45.0,
        light: Vec3::new(3.0, 4.0, 2.0),
    };
    Some(match name {
        "icosphere" => {
            Scene { eye: Vec3::new(0.0, 0.6, 2.6), ..in_front("icosphere", icosphere(59, Vec3::ZERO, 1.0)) }
        }
        "stadium" => Scene {
            name: "stadium",
            triangles: [icosphere(59, Vec3::new(0.0, -99.8, 0.0), 0.1), bowl(157, 79, 100.0)].concat(),
            eye: Vec3::new(0.0, -99.6, 0.5),
            target: Vec3::new(0.0, -99.8, 0.0),
            field: 60.0,
            light: Vec3::new(20.0, 60.0, 10.0),
        },
        "hair" => in_front("hair", hair(100_000)),
        "soup" => in_front("soup", soup(1_000_000)),
        "terrain" => terrain("terrain", 707),
        "terrain-12m" => terrain("terrain-12m", 2449),
        _ => return None,
    })
}

/// A landscape over a square, of `2 n²` triangles.
pub fn terrain(name: &'static str, n: usize) -> Scene {
    Scene {
        name,
        triangles: landscape(n),
        eye: Vec3::new(0.0, 0.45, 1.1),
        target: Vec3::new(0.0, -0.1, 0.0),
        field: 50.0,
        light: Vec3::new(1.0, 1.2, 0.3),
    }
}

/// A sphere with bumps: an icosahedron whose faces are divided into `n²` triangles each.
fn icosphere(n: usize, center: Vec3, radius: f32) -> Vec<Triangle> {
    let (corners, faces) = icosahedron();
    let bump = |p: Vec3| {
        let d = p.normalize();
        let height = 1.0 + 0.03 * ((9.0 * d.x).sin() * (11.0 * d.y).sin() + (13.0 * d.z).sin());
        center + radius * height * d
    };
    let mut triangles = Vec::new();
    for [a, b, c] in faces {
        let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
        let at =
            |i: usize, j: usize| bump(a + (b - a) * (i as f32 / n as f32) + (c - a) * (j as f32 / n as f32));
        for i in 0..n {
            for j in 0..n - i {
                triangles.push(Triangle { a: at(i, j), b: at(i + 1, j), c: at(i, j + 1) });
                if j + 1 < n - i {
                    triangles.push(Triangle { a: at(i + 1, j), b: at(i + 1, j + 1), c: at(i, j + 1) });
                }
            }
        }
    }
    triangles
}

/// The lower half of a sphere.
fn bowl(n: usize, m: usize, radius: f32) -> Vec<Triangle> {
    let at = |i: usize, j: usize| {
        let (phi, theta) =
            (i as f32 / n as f32 * std::f32::consts::TAU, j as f32 / m as f32 * std::f32::consts::FRAC_PI_2);
        radius * Vec3::new(phi.cos() * theta.cos(), -theta.sin(), phi.sin() * theta.cos())
    };
    grid(n, m, at)
}

/// The triangles of a grid of `n` by `m` quadrilaterals.
fn grid(n: usize, m: usize, at: impl Fn(usize, usize) -> Vec3) -> Vec<Triangle> {
    let mut triangles = Vec::with_capacity(2 * n * m);
    for j in 0..m {
        for i in 0..n {
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            triangles.extend([Triangle { a: p, b: q, c: r }, Triangle { a: q, b: s, c: r }]);
        }
    }
    triangles
}

/// Long thin triangles in random directions in a cube.
fn hair(n: usize) -> Vec<Triangle> {
    let mut random = Random::new(1, 0);
    let mut sliver = || {
        let (root, along) = (random.in_cube(), random.direction());
        let across = along.any_orthonormal_vector();
        Triangle { a: root - 0.25 * along, b: root + 0.25 * along, c: root + 0.25 * along + 0.002 * across }
    };
    (0..n).map(|_| sliver()).collect()
}

/// Small triangles everywhere in a cube.
fn soup(n: usize) -> Vec<Triangle> {
    let mut random = Random::new(2, 0);
    let mut triangle = || {
        let center = random.in_cube();
        let [a, b, c] = [0; 3].map(|_| center + 0.02 * random.in_cube());
        Triangle { a, b, c }
    };
    (0..n).map(|_| triangle()).collect()
}

/// The triangles of a landscape.
fn landscape(n: usize) -> Vec<Triangle> {
    let height = |p: Vec2| {
        let mut height = 0.0;
        for octave in 0..8 {
            let f = (1 << octave) as f32;
            height += 0.12 / f
                * (3.1 * f * p.x + 1.7 * octave as f32).sin()
                * (2.7 * f * p.y + 0.9 * octave as f32).cos();
        }
        height
    };
    let at = |i: usize, j: usize| {
        let p = 2.0 * Vec2::new(i as f32, j as f32) / n as f32 - 1.0;
        Vec3::new(p.x, height(p), p.y)
    };
    grid(n, n, at)
}
