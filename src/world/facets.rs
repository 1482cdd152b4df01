//! Shapes as triangles. Curved shapes have so many of them that the outline looks round, and interpolated
//! normals that make the shading look round.

use super::transforms::unit;
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Sphere};
use glam::{Vec2, Vec3, vec2};
use std::f32::consts::TAU;

/// Corners on a full circle: an error of 0.03 % of the radius.
const AROUND: usize = 128;

/// A triangle, with normals at its corners if the surface is curved, and with texture coordinates if it has
/// any.
#[derive(Clone, Copy)]
pub(super) struct Facet {
    /// The corners, anticlockwise seen from the front, which is the outside of a closed shape.
    pub corners: [Vec3; 3],
    /// Unit normals at the corners, on the side of the front; `None` if the triangle is shaded flat.
    pub normals: Option<[Vec3; 3]>,
    /// Texture coordinates at the corners, `(0, 0)` at the lower left of the image.
    pub uvs: Option<[Vec2; 3]>,
}

impl Facet {
    /// The same triangle with its second and third corner exchanged, so that its front becomes its back.
    pub fn turned(&self) -> Facet {
        fn turn<T: Copy>([a, b, c]: [T; 3]) -> [T; 3] {
            [a, c, b]
        }
        Facet { corners: turn(self.corners), normals: self.normals.map(turn), uvs: self.uvs.map(turn) }
    }
}

fn flat(a: Vec3, b: Vec3, c: Vec3) -> Facet {
    Facet { corners: [a, b, c], normals: None, uvs: None }
}

fn curved(corners: [Vec3; 3], normals: [Vec3; 3]) -> Facet {
    Facet { corners, normals: Some(normals), uvs: None }
}

/// A convex polygon as a fan of triangles around its first corner.
pub(super) fn polygon(corners: &[Vec3]) -> Vec<Facet> {
    (2..corners.len()).map(|i| flat(corners[0], corners[i - 1], corners[i])).collect()
}

/// A box as twelve triangles, with the whole image on each face.
pub(super) fn cuboid(cuboid: &Cuboid) -> Vec<Facet> {
    // Bits 0, 1 and 2 of a corner's number select `max` along x, y and z; faces run anticlockwise, seen from outside.
    let corner = |i: usize| {
        let pick =
            |bit: usize, axis: usize| if i >> bit & 1 == 1 { cuboid.max[axis] } else { cuboid.min[axis] };
        Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    // Each face begins with the lower left corner of its image.
    let faces = [[1, 0, 2, 3], [4, 5, 7, 6], [0, 1, 5, 4], [6, 7, 3, 2], [0, 4, 6, 2], [5, 1, 3, 7]];
    let image = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0)];
    let half = |face: [usize; 4], [i, j, k]: [usize; 3]| Facet {
        uvs: Some([image[i], image[j], image[k]]),
        ..flat(corner(face[i]), corner(face[j]), corner(face[k]))
    };
    faces.iter().flat_map(|&face| [half(face, [0, 1, 2]), half(face, [0, 2, 3])]).collect()
}

/// Unit vectors around `axis`, starting and ending with the same one.
fn circle(axis: Vec3) -> Vec<Vec3> {
    let (x, y) = unit(axis).any_orthonormal_pair();
    (0..=AROUND)
        .map(|i| {
            let (sin, cos) = (TAU * (i % AROUND) as f32 / AROUND as f32).sin_cos();
            cos * x + sin * y
        })
        .collect()
}

/// A disk as 128 triangles around its centre, without texture coordinates.
pub(super) fn disk(disk: &Disk) -> Vec<Facet> {
    cap(disk.center, disk.normal, disk.radius)
}

fn cap(center: Vec3, normal: Vec3, radius: f32) -> Vec<Facet> {
    let rim = circle(normal);
    rim.windows(2).map(|side| flat(center, center + radius * side[0], center + radius * side[1])).collect()
}

/// A closed cylinder as two disks and 256 triangles between them, without texture coordinates.
pub(super) fn cylinder(cylinder: &Cylinder) -> Vec<Facet> {
    let axis = cylinder.top - cylinder.base;
    let mut facets = cap(cylinder.top, axis, cylinder.radius);
    facets.extend(cap(cylinder.base, -axis, cylinder.radius));
    for side in circle(axis).windows(2) {
        let [n0, n1] = [side[0], side[1]];
        let [low0, low1] = [n0, n1].map(|n| cylinder.base + cylinder.radius * n);
        let [high0, high1] = [n0, n1].map(|n| cylinder.top + cylinder.radius * n);
        facets.push(curved([low0, low1, high1], [n0, n1, n1]));
        facets.push(curved([low0, high1, high0], [n0, n1, n0]));
    }
    facets
}

/// A closed cone as a disk and 128 triangles from there to the apex, without texture coordinates.
pub(super) fn cone(cone: &Cone) -> Vec<Facet> {
    let axis = cone.apex - cone.base;
    // Compute the normal in double precision, in which no product of two lengths overflows or underflows.
    let (along, radius) = (axis.as_dvec3(), f64::from(cone.radius));
    let height = along.length();
    let mut facets = cap(cone.base, -axis, cone.radius);
    for side in circle(axis).windows(2) {
        // The slope of the side is radius over height.
        let normal = |out: Vec3| (height * out.as_dvec3() + radius * along / height).normalize().as_vec3();
        let corners = [cone.base + cone.radius * side[0], cone.base + cone.radius * side[1], cone.apex];
        let normals = [normal(side[0]), normal(side[1]), normal(0.5 * (side[0] + side[1]))];
        facets.push(curved(corners, normals));
    }
    facets
}

/// A sphere as triangles between 128 meridians and in 64 bands of latitude, with longitude and latitude as
/// texture coordinates.
pub(super) fn sphere(sphere: &Sphere) -> Vec<Facet> {
    let rings = AROUND / 2;
    let directions: Vec<Vec<Vec3>> = (0..=rings)
        .map(|ring| {
            let (sin, cos) = (TAU / 2.0 * ring as f32 / rings as f32).sin_cos();
            // Make each pole a single point, so that there is no gap.
            let sin = if ring % rings == 0 { 0.0 } else { sin };
            // Go around from -z over -x, +z and +x, as an image wraps around, seen from outside.
            let meridian = |i: usize| {
                let (sin, cos) = (TAU * (i % AROUND) as f32 / AROUND as f32).sin_cos();
                Vec3::new(-sin, 0.0, -cos)
            };
            (0..=AROUND).map(|i| sin * meridian(i) + cos * Vec3::Y).collect()
        })
        .collect();
    let facet = |places: [(usize, usize); 3]| {
        let normals = places.map(|(ring, i)| directions[ring][i]);
        let uv = |(ring, i): (usize, usize)| vec2(i as f32 / AROUND as f32, 1.0 - ring as f32 / rings as f32);
        let corners = normals.map(|n| sphere.center + sphere.radius * n);
        Facet { uvs: Some(places.map(uv)), ..curved(corners, normals) }
    };
    let mut facets = Vec::new();
    for ring in 0..rings {
        for i in 0..AROUND {
            if ring > 0 {
                facets.push(facet([(ring, i), (ring + 1, i), (ring, i + 1)]));
            }
            if ring + 1 < rings {
                facets.push(facet([(ring, i + 1), (ring + 1, i), (ring + 1, i + 1)]));
            }
        }
    }
    facets
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume that the facets enclose; right only if they close and face outwards.
    fn volume(facets: &[Facet]) -> f32 {
        facets.iter().map(|f| f.corners[0].dot(f.corners[1].cross(f.corners[2]))).sum::<f32>() / 6.0
    }

    fn check_volume(facets: &[Facet], exact: f32) {
        let share = volume(facets) / exact;
        assert!((0.998..1.0001).contains(&share), "{share}"); // 128 corners: 0.04 % of a circle is missing, twice on a sphere
        for facet in facets {
            let [a, b, c] = facet.corners;
            let normal = (b - a).cross(c - a);
            assert!(facet.normals.is_none_or(|n| n.iter().all(|n| n.dot(normal) > 0.0)));
        }
    }

    #[test]
    fn closed_shapes_hold_their_volume_and_face_outwards() {
        let pi = TAU / 2.0;
        let (base, top) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.5, 4.0, 2.5));
        let height = (top - base).length();
        check_volume(&sphere(&Sphere { center: base, radius: 2.0 }), 4.0 / 3.0 * pi * 8.0);
        check_volume(&cuboid(&Cuboid { min: base, max: base + Vec3::new(1.0, 2.0, 3.0) }), 6.0);
        check_volume(&cylinder(&Cylinder { base, top, radius: 0.5 }), pi * 0.25 * height);
        check_volume(&cone(&Cone { base, apex: top, radius: 0.5 }), pi * 0.25 * height / 3.0);
    }
}
