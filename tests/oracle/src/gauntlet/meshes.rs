//! Closed meshes: every ray from inside must hit the mesh.

use crate::splitmix::Random;
use glam::{Vec3, vec3};
use raykata::shape::Triangle;
use std::collections::HashMap;
use std::f32::consts::TAU;

/// A closed mesh around the point `inside`.
pub struct Closed {
    /// The name in tables.
    pub name: &'static str,
    /// The positions of its vertices.
    pub positions: Vec<Vec3>,
    /// Three vertex indices per triangle.
    pub triangles: Vec<[u32; 3]>,
    /// A point well inside.
    pub inside: Vec3,
    /// How far from `inside` rays may start, along each axis.
    pub room: Vec3,
    /// Half of the rays start at `inside` plus multiples of this length, so that many start exactly in the plane of a
    /// triangle; 0 if there is no such length.
    pub lattice: f32,
    /// For each vertex, the triangles around it.
    pub fans: Vec<Vec<u32>>,
}

impl Closed {
    pub(super) fn new(
        name: &'static str,
        positions: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
        inside: Vec3,
        room: Vec3,
    ) -> Self {
        let mut fans = vec![Vec::new(); positions.len()];
        for (index, triangle) in triangles.iter().enumerate() {
            triangle.iter().for_each(|&vertex| fans[vertex as usize].push(index as u32));
        }
        Closed { name, positions, triangles, inside, room, lattice: 0.0, fans }
    }

    /// The mesh with every position, and `inside`, mapped by `place`.
    pub(super) fn placed(mut self, name: &'static str, place: impl Fn(Vec3) -> Vec3) -> Self {
        let corner = place(self.inside + self.room);
        self.positions.iter_mut().for_each(|position| *position = place(*position));
        self.inside = place(self.inside);
        self.room = (corner - self.inside).abs();
        Closed { name, ..self }
    }

    /// The mesh with rays that start on a lattice.
    pub(super) fn with_lattice(self, lattice: f32) -> Self {
        Closed { lattice, ..self }
    }

    /// A point inside at which a ray may start.
    pub fn origin(&self, random: &mut Random) -> Vec3 {
        let offset = self.room * random.in_cube();
        let on_lattice = self.lattice > 0.0 && random.below(2) == 0;
        self.inside + if on_lattice { (offset / self.lattice).round() * self.lattice } else { offset }
    }

    /// The triangle with this index.
    pub fn triangle(&self, index: u32) -> Triangle {
        let [a, b, c] = self.triangles[index as usize].map(|vertex| self.positions[vertex as usize]);
        Triangle { a, b, c }
    }

    /// All triangles.
    pub fn all(&self) -> Vec<Triangle> {
        (0..self.triangles.len() as u32).map(|index| self.triangle(index)).collect()
    }
}

/// Collects triangles whose corners are given by their positions.
#[derive(Default)]
pub(super) struct Builder {
    positions: Vec<Vec3>,
    numbers: HashMap<[u32; 3], u32>,
    triangles: Vec<[u32; 3]>,
}

impl Builder {
    fn vertex(&mut self, p: Vec3) -> u32 {
        // Add 0 to make -0 equal to 0.
        *self.numbers.entry((p + 0.0).to_array().map(f32::to_bits)).or_insert_with(|| {
            self.positions.push(p);
            self.positions.len() as u32 - 1
        })
    }

    pub fn triangle(&mut self, corners: [Vec3; 3]) {
        let corners = corners.map(|corner| self.vertex(corner));
        self.triangles.push(corners);
    }

    pub fn quad(&mut self, [a, b, c, d]: [Vec3; 4]) {
        self.triangle([a, b, c]);
        self.triangle([a, c, d]);
    }

    /// A closed prism around the axis between two points, with this outline.
    pub fn prism(&mut self, corners: &[Vec3], low: Vec3, high: Vec3) {
        for (index, &p) in corners.iter().enumerate() {
            let q = corners[(index + 1) % corners.len()];
            self.quad([p + low, q + low, q + high, p + high]);
            self.triangle([low, q + low, p + low]);
            self.triangle([high, p + high, q + high]);
        }
    }

    pub fn build(self, name: &'static str, inside: Vec3, room: Vec3) -> Closed {
        Closed::new(name, self.positions, self.triangles, inside, room)
    }
}

/// Closed meshes that are quick to test.
pub fn closed() -> Vec<Closed> {
    let far = vec3(148_376.0, 1234.0, -223_423.0);
    vec![
        tetrahedron(),
        icosphere(3),
        rough_sphere(),
        lattice_cube(),
        needle_prism(),
        icosphere(3).placed("offset", |p| far + p),
        rough_sphere().placed("rough, offset", |p| far + p),
        icosphere(1).placed("8 steps wide", |p| Vec3::ONE + 4.0 * f32::EPSILON * p),
        icosphere(3).placed("1e-6 at 1", |p| Vec3::ONE + 1e-6 * p),
        icosphere(3).placed("size 1e-14", |p| 1e-14 * p),
        icosphere(3).placed("size 1e14", |p| 1e14 * p),
        icosphere(3).placed("size 1e6", |p| 1e6 * p),
    ]
}

fn tetrahedron() -> Closed {
    let positions =
        vec![vec3(1.0, 1.0, 1.0), vec3(1.0, -1.0, -1.0), vec3(-1.0, 1.0, -1.0), vec3(-1.0, -1.0, 1.0)];
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    Closed::new("tetrahedron", positions, triangles, Vec3::ZERO, Vec3::splat(0.1))
}

/// The corners of an icosahedron around the origin with edges of length 2, and its triangles.
pub fn icosahedron() -> ([Vec3; 12], [[u32; 3]; 20]) {
    let g = 0.5 + 1.25f32.sqrt();
    let corners = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ];
    let triangles = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    (corners.map(Vec3::from), triangles)
}

/// A sphere of `20 * 4^levels` triangles.
pub(super) fn icosphere(levels: u32) -> Closed {
    let (corners, triangles) = icosahedron();
    let mut positions = corners.map(Vec3::normalize).to_vec();
    let mut triangles = triangles.to_vec();
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |p: u32, q: u32| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                positions.push(((positions[p as usize] + positions[q as usize]) / 2.0).normalize());
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    Closed::new("icosphere", positions, triangles, Vec3::ZERO, Vec3::splat(0.3))
}

/// A sphere of longitudes and latitudes, with a different radius at each vertex.
fn rough_sphere() -> Closed {
    const RINGS: u32 = 16;
    const AROUND: u32 = 32;
    let mut random = Random::new(7, 0);
    let mut positions = vec![Vec3::Y];
    for ring in 1..RINGS {
        let (sin, cos) = (TAU / 2.0 * ring as f32 / RINGS as f32).sin_cos();
        for i in 0..AROUND {
            let (s, c) = (TAU * i as f32 / AROUND as f32).sin_cos();
            positions.push((0.75 + 0.25 * random.unit()) * vec3(sin * c, cos, sin * s));
        }
    }
    positions.push(-Vec3::Y);
    let last = positions.len() as u32 - 1;
    let at = |ring: u32, i: u32| 1 + (ring - 1) * AROUND + i % AROUND;
    let mut triangles = Vec::new();
    for i in 0..AROUND {
        triangles.push([0, at(1, i + 1), at(1, i)]);
        triangles.push([last, at(RINGS - 1, i), at(RINGS - 1, i + 1)]);
        for ring in 1..RINGS - 1 {
            triangles.push([at(ring, i), at(ring, i + 1), at(ring + 1, i)]);
            triangles.push([at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)]);
        }
    }
    Closed::new("rough sphere", positions, triangles, Vec3::ZERO, Vec3::splat(0.2))
}

/// A cube whose faces are divided into squares of whole coordinates.
pub(super) fn lattice_cube() -> Closed {
    const N: u8 = 8;
    let mut builder = Builder::default();
    for axis in 0..3 {
        for side in [0, N] {
            for i in 0..N {
                for j in 0..N {
                    let at = |i: u8, j: u8| {
                        let mut p = Vec3::ZERO;
                        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side.into(), i.into(), j.into());
                        p - f32::from(N) / 2.0
                    };
                    builder.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    builder.build("lattice cube", Vec3::ZERO, Vec3::splat(2.0))
}

/// A prism that is a million times as long as wide.
fn needle_prism() -> Closed {
    const SIDES: u32 = 300;
    let mut positions = vec![vec3(0.0, 0.0, -1000.0), vec3(0.0, 0.0, 1000.0)];
    for i in 0..SIDES {
        let (sin, cos) = (TAU * i as f32 / SIDES as f32).sin_cos();
        positions.push(vec3(1e-3 * cos, 1e-3 * sin, -1000.0));
        positions.push(vec3(1e-3 * cos, 1e-3 * sin, 1000.0));
    }
    let low = |i: u32| 2 + 2 * (i % SIDES);
    let triangles = (0..SIDES)
        .flat_map(|i| {
            let [l0, l1] = [low(i), low(i + 1)];
            [[0, l1, l0], [1, l0 + 1, l1 + 1], [l0, l1, l1 + 1], [l0, l1 + 1, l0 + 1]]
        })
        .collect();
    Closed::new("needle prism", positions, triangles, Vec3::ZERO, vec3(3e-4, 3e-4, 300.0))
}
