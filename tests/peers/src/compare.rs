//! Compares the wide tree with the binary tree of stage 3: the same hits, bit for bit, on rays for which a search is hard.

use crate::reference::Wide;
use crate::scenes;
use glam::Vec3;
use oracle::gauntlet::families::families;
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::Triangle;
use solutions::{stage3_build, stage3_traversal, stage10_stability};

/// The kinds of rays. The ninth kind of input are the same rays in meshes with triangles that are flat or without area.
const KINDS: [&str; 8] = [
    "at vertices",
    "at edges",
    "at insides",
    "along axes with zeros of both signs",
    "from surfaces",
    "on a lattice",
    "of odd lengths",
    "with odd ranges",
];

/// Compares about `n` rays in all meshes, on all processors, and returns whether all answers are the same.
pub fn run(n: u64) -> bool {
    let mut meshes: Vec<(String, Vec<Triangle>, Vec3)> = Vec::new();
    for mesh in families() {
        meshes.push((mesh.name.into(), mesh.all(), mesh.inside));
        meshes.push((format!("{}, with flat triangles", mesh.name), with_flat(mesh.all()), mesh.inside));
    }
    meshes.extend(
        scenes::NAMES
            .iter()
            .filter_map(|name| scenes::by_name(name))
            .map(|s| (s.name.into(), s.triangles, s.eye)),
    );
    let per_kind = n.div_ceil((meshes.len() * KINDS.len()) as u64);
    let mut total = [0; 3];
    for (name, triangles, inside) in meshes {
        let trees = Trees::new(&triangles, inside);
        let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
        let work = |thread: u64| {
            (0..KINDS.len()).map(|kind| trees.compare(kind, thread, per_kind.div_ceil(threads))).collect()
        };
        let counts: Vec<Vec<[u64; 3]>> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..threads).map(|thread| scope.spawn(move || work(thread))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap_or_default()).collect()
        });
        let mut sum = [0; 3];
        counts.iter().flatten().for_each(|counts| (0..3).for_each(|i| sum[i] += counts[i]));
        let ([rays, hits, differences], n) = (sum, triangles.len());
        println!("{name}: {n} triangles, {rays} rays, {hits} hits, {differences} differences");
        (0..3).for_each(|i| total[i] += sum[i]);
    }
    let [rays, hits, differences] = total;
    println!("\n{rays} rays ({}), {hits} hits, {differences} differences", KINDS.join(", "));
    differences == 0
}

/// The triangles, and others among them: copies, triangles without area, and triangles that lie in planes of axes.
fn with_flat(mut triangles: Vec<Triangle>) -> Vec<Triangle> {
    let own = triangles.clone();
    for (i, &Triangle { a, b, c }) in own.iter().enumerate().step_by(3) {
        let flat = |p: Vec3| p.with_x(a.x);
        triangles.push(match i / 3 % 4 {
            0 => Triangle { a: b, b: c, c: a },
            1 => Triangle { a, b, c: a },
            2 => Triangle { a, b, c: a.midpoint(b) },
            _ => Triangle { a, b: flat(b), c: flat(c) },
        });
    }
    triangles
}

/// Both trees over some triangles.
struct Trees<'a> {
    triangles: &'a [Triangle],
    inside: Vec3,
    wide: Wide,
    bvh: Bvh,
    /// A power of two of the size of the scene, by which a lattice is spaced.
    step: f32,
}

impl<'a> Trees<'a> {
    fn new(triangles: &'a [Triangle], inside: Vec3) -> Trees<'a> {
        let bounds: Vec<Aabb> =
            triangles.iter().map(|t| Aabb::new(t.a.min(t.b).min(t.c), t.a.max(t.b).max(t.c))).collect();
        let bvh = stage3_build::build(&bounds, Split::SurfaceArea, 4);
        let size = bvh.nodes[0].bounds.max - bvh.nodes[0].bounds.min;
        let step = 2f32.powi(size.max_element().log2() as i32) / 16.0;
        Trees { triangles, inside, wide: Wide::build(triangles), bvh, step }
    }

    /// A ray of a kind.
    fn ray(&self, kind: usize, random: &mut Random) -> Ray {
        let any = |random: &mut Random| self.triangles[random.below(self.triangles.len() as u64) as usize];
        let on = |random: &mut Random, Triangle { a, b, c }: Triangle| match random.below(3) {
            0 => a,
            1 => a.lerp(b, random.unit()),
            _ => a.lerp(b, random.unit()).lerp(c, random.unit()),
        };
        let triangle = any(random);
        let Triangle { a, b, c } = triangle;
        let mut origin = self.inside + self.step * random.in_cube();
        let mut target = on(random, triangle);
        match kind {
            0 => target = a,
            1 => target = a.lerp(b, random.unit()),
            2 => target = a.lerp(b, random.unit()).lerp(c, random.unit()),
            3 => {
                // One or two coordinates of the direction are zero, of any sign.
                let zero = if random.below(2) == 0 { 0.0 } else { -0.0 };
                let axes = [[0, 1], [1, 2], [2, 0], [0, 0], [1, 1], [2, 2]][random.below(6) as usize];
                axes.iter().for_each(|&axis| origin[axis] = target[axis]);
                let mut ray = Ray::new(origin, target - origin);
                axes.iter().for_each(|&axis| ray.direction[axis] = zero);
                return ray;
            }
            4 => {
                let other = any(random);
                origin = on(random, other);
            }
            5 => {
                let lattice = |p: Vec3| (p / self.step).round() * self.step;
                (origin, target) = (lattice(origin), lattice(target));
            }
            _ => {}
        }
        let mut ray = Ray::new(origin, target - origin);
        if kind == 6 {
            ray.direction *= 2f32.powi(random.below(61) as i32 - 30);
        }
        ray
    }

    /// The numbers of rays, of hits, and of differences.
    fn compare(&self, kind: usize, thread: u64, n: u64) -> [u64; 3] {
        let mut random = Random::new(49, (thread << 8) + kind as u64);
        let mut counts = [0; 3];
        for _ in 0..n {
            let mut ray = self.ray(kind, &mut random);
            if ray.direction == Vec3::ZERO {
                continue;
            }
            let mut probe = Binary { trees: self, inverse: ray.direction.recip() };
            let mut expected = stage3_traversal::closest_hit(&self.bvh, &mut probe, &ray);
            if let (7, Some(hit)) = (kind, expected) {
                // Let the range begin or end at the hit, or a float beside it.
                let ends = [hit.t.next_down(), hit.t, hit.t.next_up()];
                let [from, to] = [(); 2].map(|()| ends[random.below(3) as usize]);
                let (t_min, t_max) = [(from, f32::INFINITY), (0.0, to), (from, to)][random.below(3) as usize];
                ray = ray.with_range(t_min.max(0.0), t_max);
                expected = stage3_traversal::closest_hit(&self.bvh, &mut probe, &ray);
            }
            let (closest, any) = self.wide.both(&ray);
            let bits = |hit: Option<PrimitiveHit>| hit.map(|hit| (hit.t.to_bits(), hit.primitive));
            counts[0] += 1;
            counts[1] += u64::from(expected.is_some());
            if bits(closest) != bits(expected) || any != expected.is_some() {
                counts[2] += 1;
                if counts[2] < 3 {
                    println!("  {}: {ray:?}: {closest:?}, {any}, and not {expected:?}", KINDS[kind]);
                }
            }
        }
        counts
    }
}

/// Answers the questions of a search in the binary tree.
struct Binary<'a> {
    trees: &'a Trees<'a>,
    inverse: Vec3,
}

impl Probe for Binary<'_> {
    fn open(&mut self, node: u32) -> Contents {
        self.trees.bvh.nodes[node as usize].contents
    }

    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        let bounds = &self.trees.bvh.nodes[node as usize].bounds;
        stage10_stability::conservative_slab(ray, self.inverse, bounds).map(|(enter, _)| enter)
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        stage10_stability::watertight(ray, &self.trees.triangles[primitive as usize]).map(|hit| hit.t)
    }
}
