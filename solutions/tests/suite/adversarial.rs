//! Lists of triangles that are hard to divide: their boxes overlap, coincide, or differ extremely in size.

use glam::{Vec3, vec3};
use oracle::splitmix::Random;
use raykata::shape::Triangle;

/// A named list of triangles.
pub struct Hard {
    pub name: &'static str,
    pub triangles: Vec<Triangle>,
}

/// All hard lists, of about `n` triangles each.
pub fn hard_lists(n: usize) -> Vec<Hard> {
    let list = |name, triangles| Hard { name, triangles };
    let numbered =
        |name, triangle: &dyn Fn(f32) -> Triangle| list(name, (0..n).map(|i| triangle(i as f32)).collect());
    let drawn = |name, seed, triangle: fn(usize, &mut Random) -> Triangle| {
        let mut random = Random::new(seed, 0);
        list(name, (0..n).map(|i| triangle(i, &mut random)).collect())
    };
    vec![
        // Thin triangles in all directions through the whole unit sphere.
        drawn("needles", 1, |_, random| {
            let (p, q) = (random.direction(), random.direction());
            tile(p, q - p, 1e-3 * random.direction())
        }),
        // Thin triangles in all directions, each a third of the extent of all of them long.
        drawn("short needles", 8, |_, random| {
            tile(random.in_cube(), 0.7 * random.direction(), 1e-3 * random.direction())
        }),
        // Thin triangles, each nearly along an axis through the whole cube.
        drawn("needles along the axes", 9, |i, random| {
            let mut p = random.in_cube();
            p[i % 3] = -1.0;
            tile(p, 2.0 * Vec3::AXES[i % 3] + 0.02 * random.direction(), 1e-3 * random.direction())
        }),
        // Thin triangles side by side along the diagonal of a cube: the box of each is nearly the cube.
        drawn("diagonals", 2, |_, random| {
            tile(0.1 * random.in_cube(), Vec3::splat(10.0), 1e-3 * random.direction())
        }),
        list("coincident", vec![tile(Vec3::ZERO, Vec3::X, vec3(0.0, 1.0, 1.0)); n]),
        list("one point", vec![tile(Vec3::ONE, Vec3::ZERO, Vec3::ZERO); n]),
        list("heaps of five", heaps(n)),
        list("cluster far off", cluster_far_off(n)),
        list("one huge triangle", one_huge(n)),
        // Large parallel triangles close to each other.
        numbered("flat sheets", &|i| tile(vec3(0.0, 0.0, 1e-3 * i), 10.0 * Vec3::X, 10.0 * Vec3::Y)),
        // Large triangles that share a side.
        numbered("sheets through one line", &|i| {
            tile(vec3(0.0, 0.0, -1.0), vec3(i.cos(), i.sin(), 0.0), 2.0 * Vec3::Z)
        }),
        // Triangles around one point, each larger than the one before.
        numbered("nested", &|i| {
            tile(Vec3::splat(-i - 1.0), (i + 1.0) * vec3(2.0, 0.0, 2.0), Vec3::splat(2.0 * (i + 1.0)))
        }),
        // Triangles with one common corner, each larger than the one before.
        numbered("nested in a corner", &|i| {
            tile(Vec3::ZERO, (i + 1.0) * vec3(1.0, 0.0, 1.0), Vec3::splat(i + 1.0))
        }),
        // Triangles whose sizes and distances are in geometric progression, from 1e-30 to 1e30.
        numbered("sizes in geometric progression", &|i| {
            let size = 10f32.powf(-30.0 + 60.0 * i / n as f32);
            tile(Vec3::splat(size), 0.5 * size * Vec3::X, 0.5 * size * Vec3::ONE)
        }),
        // Thin triangles with one common corner, like the pole of a sphere.
        drawn("fan around one vertex", 6, |_, random| {
            tile(Vec3::ZERO, random.direction(), random.direction())
        }),
    ]
}

/// The triangle with a corner at `p` and the sides `u` and `v`.
fn tile(p: Vec3, u: Vec3, v: Vec3) -> Triangle {
    Triangle { a: p, b: p + u, c: p + v }
}

/// Five equal small triangles at each of many places.
fn heaps(n: usize) -> Vec<Triangle> {
    let mut random = Random::new(3, 0);
    let heap = |_| [tile(random.in_cube(), 1e-4 * Vec3::X, 1e-4 * Vec3::ONE); 5];
    (0..n / 5).flat_map(heap).collect()
}

/// A tiny cluster, and a few triangles a billion times as far away.
fn cluster_far_off(n: usize) -> Vec<Triangle> {
    let mut random = Random::new(4, 0);
    let near = (0..n).map(|_| tile(random.in_cube(), 0.1 * random.direction(), 0.1 * random.direction()));
    let far = [Vec3::X, Vec3::Y, Vec3::NEG_Z].map(|p| tile(1e9 * p, Vec3::Y, Vec3::Z));
    near.chain(far).collect()
}

/// Small triangles, and one of size 1e30 among them.
fn one_huge(n: usize) -> Vec<Triangle> {
    let mut random = Random::new(5, 0);
    let small = (0..n).map(|_| tile(random.in_cube(), 0.1 * random.direction(), 0.1 * random.direction()));
    let huge = tile(vec3(-1e30, -1e30, 0.0), vec3(3e30, 0.0, 0.0), vec3(0.0, 3e30, 0.0));
    small.collect::<Vec<Triangle>>().into_iter().chain([huge]).collect()
}
