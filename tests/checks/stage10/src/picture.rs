//! The picture of stage 10: a third of it is scaled down, and a third of it up, by powers of two. No seam may be visible.

use checks::picture::{self, Composed, SMALL};
use checks::prelude::*;
use glam::Quat;

/// The scene in its plain size.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// The exponents of the scales of the three parts of the picture.
    exponents: [i32; 3],
    /// The turn of the gem in radians.
    turn: f32,
    /// The sphere beside the gem.
    sphere: Sphere,
}

/// The corners of an icosahedron that stands on the floor.
fn gem(turn: f32) -> Vec<Triangle> {
    let golden = 0.5 * (1.0 + 5f32.sqrt());
    let spin = Quat::from_rotation_y(turn) * Quat::from_rotation_x(0.365);
    let corners: Vec<Vec3> = (0..12)
        .map(|i| {
            let (one, long) =
                (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { golden } else { -golden });
            let mut corner = Vec3::ZERO;
            (corner[i / 4], corner[(i / 4 + 1) % 3]) = (one, long);
            0.55 * (spin * corner) + vec3(-0.6, 1.0, 0.0)
        })
        .collect();
    // Three corners make a face if each two of them are neighbours, which are at the distance 2 before scaling.
    let near = |p: usize, q: usize| (corners[p] - corners[q]).length() < 1.3;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in (b + 1..12).filter(|&c| near(a, b) && near(b, c) && near(a, c)) {
                faces.push(Triangle { a: corners[a], b: corners[b], c: corners[c] });
            }
        }
    }
    faces
}

/// A square on the floor, as two triangles.
fn floor() -> [Triangle; 2] {
    let [a, b, c, d] =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| vec3(2.6 * x, 0.0, 2.2 * z));
    [Triangle { a, b, c }, Triangle { a, b: c, c: d }]
}

/// The nearest hit of each ray: its `t` and the normal there, which has any length.
type Hit = Option<(f32, Vec3, Kind)>;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Gem,
    Sphere,
    Floor,
}

/// The scene at one scale. Functions in double precision get the whole scale, `watertight` half of its exponent, so that the
/// products of three lengths neither over- nor underflow in single precision.
struct Scaled {
    whole: f32,
    half: f32,
    gem: Vec<Triangle>,
    sphere: Sphere,
}

impl Scaled {
    fn new(place: &Place, exponent: i32) -> Scaled {
        let [whole, half] = [exponent, exponent / 2].map(|exponent| (exponent as f32).exp2());
        let gem = gem(place.turn).into_iter().map(|face| times(half, &face)).collect();
        let sphere = Sphere { center: whole * place.sphere.center, radius: whole * place.sphere.radius };
        Scaled { whole, half, gem, sphere }
    }

    /// The nearest hit of each ray of the plain size. `t` is that of the plain size.
    fn nearest(&self, kit: &dyn Kit, rays: &[Ray]) -> Vec<Hit> {
        let at = |scale: f32, ray: &Ray| Ray::new(scale * ray.origin, ray.direction);
        let mut nearest: Vec<Hit> = vec![None; rays.len()];
        let mut add = |index: usize, t: Option<f32>, scale: f32, normal: &dyn Fn(f32) -> Vec3, kind: Kind| {
            if let Some(t) =
                t.map(|t| t / scale).filter(|t| nearest[index].is_none_or(|(best, ..)| *t < best))
            {
                nearest[index] = Some((t, normal(t), kind));
            }
        };
        // The rays that meet the box of the gem are tested with its faces.
        let corners = self.gem.iter().flat_map(|face| [face.a, face.b, face.c]);
        let (min, max) =
            corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)));
        let bounds = Aabb::new(min, max);
        let slabs: Vec<SlabQuery> =
            rays.iter().map(|ray| SlabQuery { ray: at(self.half, ray), bounds }).collect();
        let entered = kit.conservative_slab(&slabs).into_iter().enumerate();
        let entered: Vec<usize> = entered.filter_map(|(index, span)| span.map(|_| index)).collect();
        for face in &self.gem {
            let query = |index: &usize| TriangleQuery { ray: at(self.half, &rays[*index]), triangle: *face };
            let hits = kit.watertight(&entered.iter().map(query).collect::<Vec<_>>());
            for (index, hit) in entered.iter().zip(hits) {
                add(
                    *index,
                    hit.map(|hit| hit.t),
                    self.half,
                    &|_| (face.b - face.a).cross(face.c - face.a),
                    Kind::Gem,
                );
            }
        }
        let queries: Vec<SphereQuery> =
            rays.iter().map(|ray| SphereQuery { ray: at(self.whole, ray), sphere: self.sphere }).collect();
        for (index, t) in kit.sphere_in_double(&queries).into_iter().enumerate() {
            let normal = |t: f32| self.whole * rays[index].at(t) - self.sphere.center;
            add(index, t, self.whole, &normal, Kind::Sphere);
        }
        for triangle in floor().map(|face| times(self.whole, &face)) {
            let query = |ray: &Ray| TriangleQuery { ray: at(self.whole, ray), triangle };
            let hits = kit.triangle_in_double(&rays.iter().map(query).collect::<Vec<_>>());
            for (index, hit) in hits.into_iter().enumerate() {
                add(index, hit.map(|hit| hit.t), self.whole, &|_| self.whole * Vec3::Y, Kind::Floor);
            }
        }
        nearest
    }

    fn colors(&self, kit: &dyn Kit, rays: &[Ray]) -> Vec<Vec3> {
        let light = vec3(0.35, 0.8, 0.48).normalize();
        let lengthened: Vec<Vec3> = rays.iter().map(|ray| self.whole * ray.direction).collect();
        // Directions of any length get the length 1.
        let directions = kit.safe_normalize(&lengthened).into_iter().zip(rays);
        let rays: Vec<Ray> = directions
            .map(|(direction, ray)| Ray::new(ray.origin, direction.unwrap_or(Vec3::ZERO)))
            .collect();
        let hits = self.nearest(kit, &rays);
        let normals: Vec<Vec3> =
            hits.iter().map(|hit| hit.map_or(Vec3::Y, |(_, normal, _)| normal)).collect();
        let facing = kit.safe_normalize(&normals).into_iter().zip(&rays).map(|(normal, ray)| {
            let normal = normal.unwrap_or(Vec3::ZERO);
            if normal.dot(ray.direction) > 0.0 { -normal } else { normal }
        });
        let facing: Vec<Vec3> = facing.collect();
        // Shadow rays start off the surface. Each point is rounded by less than 4e-6 at this distance from the camera.
        let lit: Vec<usize> = (0..rays.len())
            .filter(|&index| hits[index].is_some() && facing[index].dot(light) > 0.0)
            .collect();
        let starts: Vec<OffsetQuery> = lit
            .iter()
            .map(|&index| OffsetQuery {
                point: self.whole * rays[index].at(hits[index].map_or(0.0, |(t, ..)| t)),
                error: Vec3::splat(4e-6 * self.whole),
                normal: facing[index],
                direction: light,
            })
            .collect();
        let shadows: Vec<Ray> = kit
            .offset_origin(&starts)
            .into_iter()
            .map(|origin| Ray::new(origin / self.whole, light))
            .collect();
        let mut is_lit = vec![false; rays.len()];
        for (index, hit) in lit.into_iter().zip(self.nearest(kit, &shadows)) {
            is_lit[index] = hit.is_none();
        }
        let color = |index: usize| {
            let Some((t, _, kind)) = hits[index] else { return vec3(0.03, 0.04, 0.07) };
            let point = rays[index].at(t);
            let albedo = match kind {
                Kind::Gem => vec3(0.15, 0.75, 0.65),
                Kind::Sphere => vec3(0.9, 0.5, 0.2),
                Kind::Floor => {
                    let rings = 0.5 + 0.5 * (6.0 * point.length()).sin();
                    vec3(0.75, 0.72, 0.68).lerp(vec3(0.5, 0.5, 0.58), rings)
                }
            };
            let direct = if is_lit[index] { facing[index].dot(light).max(0.0) } else { 0.0 };
            albedo * (0.18 + 0.2 * facing[index].x.abs() + 0.75 * direct)
        };
        (0..rays.len()).map(color).collect()
    }
}

fn times(scale: f32, triangle: &Triangle) -> Triangle {
    Triangle { a: scale * triangle.a, b: scale * triangle.b, c: scale * triangle.c }
}

pub(super) fn picture_at_three_scales(trial: &Trial<'_>) -> CheckResult {
    let public = Place {
        exponents: [-60, 0, 60],
        turn: 0.35,
        sphere: Sphere { center: vec3(0.95, 0.6, 0.45), radius: 0.6 },
    };
    let hidden =
        (30..=60i32, -20..=20i32, 0.0..1f32, 0.4..0.7f32).prop_map(|(far, middle, turn, radius)| Place {
            exponents: [far, middle, -far],
            turn,
            sphere: Sphere { center: vec3(0.95, radius, 0.45), radius },
        });
    let place = trial.composed(public, hidden);
    let rays = picture::rays(trial, SMALL, vec3(0.5, 2.7, 5.2), vec3(0.1, 0.7, 0.0));
    let part = |index: usize| 3 * picture::column(trial, SMALL, index) / SMALL.width as usize;
    let colors = |kit: &dyn Kit| {
        let mut colors = vec![Vec3::ZERO; rays.len()];
        for (number, exponent) in place.exponents.into_iter().enumerate() {
            let pixels: Vec<usize> = (0..rays.len()).filter(|&index| part(index) == number).collect();
            let rays: Vec<Ray> = pixels.iter().map(|&index| rays[index]).collect();
            let shown = Scaled::new(&place, exponent).colors(kit, &rays);
            pixels.into_iter().zip(shown).for_each(|(index, color)| colors[index] = color);
        }
        colors
    };
    // The outlines of shapes and shadows cross about 300 of 1536 pixels, and rounding moves them by less than a
    // hundred-thousandth of a pixel.
    let composed = Composed { name: "stage10_three_scales", size: SMALL, rays: &rays, may_differ: 0.002 };
    composed.check(trial, colors)
}
