//! Rays from inside closed meshes, aimed at shared edges and vertices. A ray that hits nothing is a leak.

use super::meshes::Closed;
use crate::splitmix::Random;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The target of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// A rounded point of an edge.
    Edge,
    /// A vertex.
    Vertex,
}

impl Aim {
    /// Both targets.
    pub const ALL: [Aim; 2] = [Aim::Edge, Aim::Vertex];
}

/// A ray from inside, and a vertex near which it should hit. Half of the directions have unit length.
pub fn aimed(mesh: &Closed, aim: Aim, random: &mut Random) -> (Ray, u32) {
    let corners = mesh.triangles[random.below(mesh.triangles.len() as u64) as usize];
    let side = random.below(3) as usize;
    let (vertex, next) = (corners[side], corners[(side + 1) % 3]);
    let origin = mesh.origin(random);
    let [from, to] = [vertex, next].map(|index| mesh.positions[index as usize]);
    let target = match aim {
        Aim::Edge => from.lerp(to, random.unit()),
        Aim::Vertex => from,
    };
    let way = target - origin;
    let unit = way.as_dvec3().normalize_or_zero().as_vec3();
    let direction = if random.below(2) == 0 { way } else { unit };
    (Ray::new(origin, direction), vertex)
}

/// Whether the ray hits no triangle of the mesh. The triangles around `vertex` are tested first, because the
/// ray goes there.
pub fn leaks(mesh: &Closed, ray: &Ray, vertex: u32, hit: impl Fn(&Ray, &Triangle) -> Option<f32>) -> bool {
    let near = mesh.fans[vertex as usize].iter().copied();
    let any = 0..mesh.triangles.len() as u32;
    !near.chain(any).any(|index| hit(ray, &mesh.triangle(index)).is_some())
}

/// The number of leaks among `count` rays.
pub fn count(
    mesh: &Closed,
    aim: Aim,
    seed: u64,
    count: u64,
    hit: impl Fn(&Ray, &Triangle) -> Option<f32>,
) -> u64 {
    let mut random = Random::new(seed, aim as u64);
    (0..count)
        .filter(|_| {
            let (ray, vertex) = aimed(mesh, aim, &mut random);
            leaks(mesh, &ray, vertex, &hit)
        })
        .count() as u64
}
