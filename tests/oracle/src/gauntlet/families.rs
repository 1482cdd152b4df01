//! Closed meshes of many families: walls in planes through the ray's origin, facets of one plane, corners at distances of very
//! different sizes, rounded scans, extreme sizes.

use super::meshes::{Builder, Closed, closed, icosphere, lattice_cube};
use crate::splitmix::Random;
use glam::{Vec3, vec3};
use std::collections::{HashMap, HashSet};
use std::f32::consts::TAU;

/// All closed meshes: those of [`closed`], and one or more of each family.
pub fn families() -> Vec<Closed> {
    let cave_far = |p: Vec3| p + vec3(1_048_576.0, -2_097_152.0, 524_288.0);
    let squash = |p: Vec3| p * vec3(1.0, 1.0, 1e-7);
    // Integer factors keep the walls in planes through the origin.
    let tilt =
        |p: Vec3| vec3(3.0 * p.x + p.y - p.z, p.x + 2.0 * p.y + 5.0 * p.z, p.y - 2.0 * p.x + 7.0 * p.z);
    let own = [
        cave(3, 4),
        cave(5, 5).placed("cave, far", cave_far),
        star_prism(),
        Closed { room: Vec3::ZERO, ..star_prism().placed("star prism, tilted", tilt) },
        urchin(0.0),
        urchin(0.3).placed("urchin, off its middle", |p| p),
        sizes_mixed("corners at 2^±8", 8),
        sizes_mixed("corners at 2^±30", 30),
        sizes_mixed("corners at 2^±60", 60),
        scan(),
        tunnel(),
        torus(),
        crown(),
        lattice_cube().placed("pancake", squash),
        icosphere(2).placed("size 2^-100", |p| p * 2f32.powi(-100)),
        icosphere(2).placed("size 2^-140", |p| p * 2f32.powi(-100) * 2f32.powi(-40)),
        icosphere(2).placed("size 2^100", |p| p * 2f32.powi(100)),
    ];
    closed().into_iter().chain(own).collect()
}

/// A room with winding tunnels on a lattice: rays from lattice points lie in the planes of many walls.
fn cave(seed: u64, reach: i32) -> Closed {
    let mut open: HashSet<[i32; 3]> = HashSet::new();
    for x in -2..2 {
        for y in -2..2 {
            open.extend((-2..2).map(|z| [x, y, z]));
        }
    }
    let neighbour = |mut cell: [i32; 3], side: usize| {
        cell[side / 2] += if side.is_multiple_of(2) { -1 } else { 1 };
        cell
    };
    let mut random = Random::new(seed, 0);
    for _ in 0..60 {
        let mut at = [0; 3];
        for _ in 0..12 {
            let to = neighbour(at, random.below(6) as usize);
            if to.iter().all(|number| number.abs() <= reach) {
                at = to;
            }
            open.insert(at);
        }
    }
    let mut builder = Builder::default();
    // Sort the cells, so that the mesh is the same in every run.
    let mut cells: Vec<[i32; 3]> = open.iter().copied().collect();
    cells.sort();
    for cell in cells {
        for side in (0..6).filter(|&side| !open.contains(&neighbour(cell, side))) {
            let axis = side / 2;
            let (u, v) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
            let mut corner = Vec3::from_array(cell.map(|number| number as f32));
            corner[axis] += (side % 2) as f32;
            builder.quad([corner, corner + u, corner + u + v, corner + v]);
        }
    }
    builder.build("cave", Vec3::ZERO, Vec3::splat(1.4)).with_lattice(1.0)
}

/// A prism whose outline jumps between two distances from the axis: each wall at a jump lies in a plane through the axis.
fn star_prism() -> Closed {
    let outline = [(5, 0), (4, 1), (3, 2), (2, 3), (1, 4), (0, 5)];
    let quarter_turns = (0..4).flat_map(|quarter| {
        outline[..5].iter().map(move |&(x, y)| match quarter {
            0 => (x, y),
            1 => (-y, x),
            2 => (-x, -y),
            _ => (y, -x),
        })
    });
    // Each direction at the distance of the sector before it and of the sector after it.
    let corners: Vec<Vec3> = quarter_turns
        .enumerate()
        .flat_map(|(sector, (x, y))| {
            let factors = if sector % 2 == 0 { [2.0, 3.0] } else { [3.0, 2.0] };
            factors.map(|factor| factor * vec3(x as f32, y as f32, 0.0))
        })
        .collect();
    let (low, high) = (vec3(0.0, 0.0, -2.0), vec3(0.0, 0.0, 3.0));
    let mut builder = Builder::default();
    builder.prism(&corners, low, high);
    builder.build("star prism", Vec3::ZERO, vec3(0.0, 0.0, 1.4)).with_lattice(0.5)
}

/// A sphere whose faces are moved outwards by factors of 1, 2 and 4, and joined by walls in planes through the origin.
fn urchin(room: f32) -> Closed {
    let sphere = icosphere(1);
    let mut random = Random::new(11, 0);
    let levels: Vec<u32> = sphere.triangles.iter().map(|_| random.below(3) as u32).collect();
    let at = |level: u32, p: Vec3| p * (1 << level) as f32;
    let mut builder = Builder::default();
    let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
    for (index, (corners, &level)) in sphere.triangles.iter().zip(&levels).enumerate() {
        let positions = corners.map(|corner| sphere.positions[corner as usize]);
        builder.triangle(positions.map(|p| at(level, p)));
        for side in 0..3 {
            let (i, j) = (corners[side], corners[(side + 1) % 3]);
            // Build the wall when the second face of an edge is found.
            let Some(other) = sides.insert([i.min(j), i.max(j)], index as u32) else { continue };
            let other = levels[other as usize];
            let [p, q] = [positions[side], positions[(side + 1) % 3]];
            for step in level.min(other)..level.max(other) {
                builder.quad([at(step, p), at(step, q), at(step + 1, q), at(step + 1, p)]);
            }
        }
    }
    builder.build("urchin", Vec3::ZERO, Vec3::splat(room))
}

/// A sphere whose corners are moved along their directions to distances from `2^-range` to `2^range`.
fn sizes_mixed(name: &'static str, range: i32) -> Closed {
    let mut sphere = icosphere(2);
    let mut random = Random::new(13, range as u64);
    for position in &mut sphere.positions {
        *position *= 2f32.powi(random.below(2 * range as u64 + 1) as i32 - range);
    }
    Closed { name, room: Vec3::splat(0.2 * 2f32.powi(-range)), ..sphere }
}

/// A sphere whose coordinates are rounded to multiples of 1/32, as a scanner does: many facets lie in one plane, and some
/// have no area.
fn scan() -> Closed {
    let sphere = icosphere(4);
    let round = |p: Vec3| (32.0 * p).round() / 32.0;
    let mut builder = Builder::default();
    for corners in &sphere.triangles {
        builder.triangle(corners.map(|corner| round(sphere.positions[corner as usize])));
    }
    builder.build("scan", Vec3::ZERO, Vec3::splat(0.3)).with_lattice(1.0 / 32.0)
}

/// A pipe of radius 1 that is a billion times as long as wide.
fn tunnel() -> Closed {
    let rim = |i: usize| {
        let (sin, cos) = (TAU * i as f32 / 32.0).sin_cos();
        vec3(cos, sin, 0.0)
    };
    let rim: [Vec3; 32] = std::array::from_fn(rim);
    let mut builder = Builder::default();
    builder.prism(&rim, vec3(0.0, 0.0, -(2f32.powi(30))), vec3(0.0, 0.0, 2f32.powi(31)));
    builder.build("tunnel", Vec3::ZERO, vec3(0.5, 0.5, 1e9))
}

/// A ring, seen from inside its pipe.
fn torus() -> Closed {
    const AROUND: u32 = 48;
    const SECTION: u32 = 12;
    let mut random = Random::new(17, 0);
    let bumps: Vec<f32> = (0..AROUND * SECTION).map(|_| 0.8 + 0.2 * random.unit()).collect();
    let at = |i: u32, j: u32| {
        let (i, j) = (i % AROUND, j % SECTION);
        let (sin, cos) = (TAU * i as f32 / AROUND as f32).sin_cos();
        let (s, c) = (TAU * j as f32 / SECTION as f32).sin_cos();
        let radius = bumps[(i * SECTION + j) as usize];
        let out = 2.0 + radius * c;
        vec3(out * cos, out * sin, radius * s)
    };
    let mut builder = Builder::default();
    for i in 0..AROUND {
        for j in 0..SECTION {
            builder.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    builder.build("torus", vec3(2.0, 0.0, 0.0), Vec3::splat(0.3))
}

/// A double cone with 300 triangles around each apex.
fn crown() -> Closed {
    const SIDES: u32 = 300;
    let rim = |i: u32| {
        let (sin, cos) = (TAU * (i % SIDES) as f32 / SIDES as f32).sin_cos();
        vec3(cos, sin, if i.is_multiple_of(2) { 0.05 } else { -0.05 })
    };
    let mut builder = Builder::default();
    for i in 0..SIDES {
        builder.triangle([vec3(0.0, 0.0, -1.0), rim(i + 1), rim(i)]);
        builder.triangle([vec3(0.0, 0.0, 1.0), rim(i), rim(i + 1)]);
    }
    builder.build("crown", Vec3::ZERO, Vec3::splat(0.3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Body, verdict};
    use crate::gauntlet::leaks::{Aim, aimed};
    use raykata::ray::Ray;

    #[test]
    fn every_mesh_is_closed_around_the_origins_of_its_rays() {
        for mesh in families() {
            let mut edges = HashMap::new();
            for &[a, b, c] in &mesh.triangles {
                for (p, q) in [(a, b), (b, c), (c, a)].into_iter().filter(|(p, q)| p != q) {
                    *edges.entry((p.min(q), p.max(q))).or_insert(0) += 1;
                }
            }
            // Where two cells of a cave touch along an edge, the edge has four sides. A facet of a scan that collapsed to
            // an edge has two sides there.
            assert!(edges.values().all(|sides| sides % 2 == 0), "{}", mesh.name);
            // By exact arithmetic, every ray from inside hits the mesh.
            let mut random = Random::new(1, 0);
            for n in 0..60 {
                let ray = match n % 3 {
                    0 => aimed(&mesh, Aim::Edge, &mut random).0,
                    1 => aimed(&mesh, Aim::Vertex, &mut random).0,
                    _ => Ray::new(mesh.origin(&mut random), random.direction()),
                };
                let hits = |t: &raykata::shape::Triangle| {
                    verdict(&ray, Body::Triangle(*t)).is_some_and(|v| v.is_hit())
                };
                assert!(mesh.all().iter().any(hits), "{}: no hit from inside, {ray:?}", mesh.name);
            }
        }
    }
}
