//! Emitters as inputs, and their geometry in double precision.

use checks::prelude::*;
use raykata::emitter::{AreaEmitter, EmitterShape};
use std::f64::consts::{PI, TAU};

/// An emitter, and the point that it illuminates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lit {
    pub emitter: AreaEmitter,
    pub from: Vec3,
}

/// The kinds of shapes.
pub(super) const KINDS: [&str; 3] = ["a parallelogram", "a triangle", "a sphere"];

/// The place of an emitter and of the point that it illuminates, before it is turned into numbers of single precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// The index of the kind in [`KINDS`].
    pub kind: usize,
    /// The normal of a parallelogram or triangle; the direction from a sphere to the point.
    pub axis: Vec3,
    /// How far the frame is turned around the axis, as a fraction of a full turn.
    pub turn: f64,
    /// A corner, or the centre of the sphere.
    pub corner: Vec3,
    /// The length of the shorter edge, or the radius.
    pub size: f64,
    /// By how much the second edge leans towards the first.
    pub lean: f64,
    /// The point relative to the corner, along the first edge, at right angles to it, and along the axis, in sizes. For a
    /// sphere only the last one counts: it is the distance from the centre less 1.
    pub place: DVec3,
    pub two_sided: bool,
}

impl Layout {
    /// The emitter and the point, rounded to single precision.
    pub fn lit(&self) -> Lit {
        let axis = self.axis.as_dvec3().normalize();
        let (x, _) = axis.any_orthonormal_pair();
        let (sin, cos) = (TAU * self.turn).sin_cos();
        let x = cos * x + sin * axis.cross(x);
        let y = axis.cross(x);
        let edges = (1.5 * self.size * x, self.size * (y + self.lean * x));
        let corner = self.corner.as_dvec3();
        let (a, b, c) = (corner.as_vec3(), (corner + edges.0).as_vec3(), (corner + edges.1).as_vec3());
        let shape = match self.kind {
            0 => EmitterShape::Parallelogram { corner: a, edges: (b - a, c - a) },
            1 => EmitterShape::Triangle(Triangle { a, b, c }),
            _ => EmitterShape::Sphere(Sphere { center: a, radius: self.size as f32 }),
        };
        let offset = match self.kind {
            2 => (1.0 + self.place.z) * axis,
            _ => self.place.x * x + self.place.y * y + self.place.z * axis,
        };
        let emitter = AreaEmitter { shape, radiance: Vec3::new(1.0, 2.0, 0.5), two_sided: self.two_sided };
        Lit { emitter, from: (corner + self.size * offset).as_vec3() }
    }
}

/// Layouts in all orientations and sizes. The point is in front of the emitter, at least a quarter of its size away.
pub(super) fn layouts() -> impl Strategy<Value = Layout> + Clone {
    let eighths = |low: i32, high: i32| (low..=high).prop_map(|n| f64::from(n) / 8.0);
    let place =
        (eighths(-12, 16), eighths(-12, 16), eighths(2, 24)).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    let kind = (0..KINDS.len(), nasty::unit(), 0..16i32, any::<bool>());
    // Products of four lengths, as in the square of an area, do not overflow at these scales.
    (kind, nasty::lattice(3), nasty::scale(-10..=10), eighths(-4, 4), place).prop_map(
        |((kind, axis, turn, two_sided), corner, scale, lean, place)| Layout {
            kind,
            axis,
            turn: f64::from(turn) / 16.0,
            corner: scale * corner,
            size: f64::from(scale),
            lean,
            place,
            two_sided,
        },
    )
}

impl Lit {
    /// The shape in double precision.
    fn flat(&self) -> Option<(DVec3, DVec3, DVec3, bool)> {
        match self.emitter.shape {
            EmitterShape::Parallelogram { corner, edges } => {
                Some((corner.as_dvec3(), edges.0.as_dvec3(), edges.1.as_dvec3(), false))
            }
            EmitterShape::Triangle(Triangle { a, b, c }) => {
                let a = a.as_dvec3();
                Some((a, b.as_dvec3() - a, c.as_dvec3() - a, true))
            }
            EmitterShape::Sphere(_) => None,
        }
    }

    /// The centre of the sphere as seen from the point, its radius, and `1 - cos θ` of its rim (2 from inside).
    fn cone(&self) -> (DVec3, f64, f64) {
        let EmitterShape::Sphere(sphere) = self.emitter.shape else { return (DVec3::Z, 0.0, 0.0) };
        let to_center = sphere.center.as_dvec3() - self.from.as_dvec3();
        let radius = f64::from(sphere.radius);
        let sin_squared = radius * radius / to_center.length_squared();
        let rim = if sin_squared < 1.0 { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) } else { 2.0 };
        (to_center, radius, rim)
    }

    /// The direction to the centre of the sphere, two directions across, and `1 - cos θ` of the rim.
    fn frame(&self) -> ([DVec3; 3], f64) {
        let (to_center, _, rim) = self.cone();
        let axis = to_center.normalize_or(DVec3::Y);
        let (x, y) = axis.any_orthonormal_pair();
        ([axis, x, y], rim)
    }

    /// The vector to the point of the emitter at these coordinates of the unit square. Cells of equal area of the square have
    /// equal areas of a parallelogram or triangle, and equal solid angles of a sphere.
    pub fn toward(&self, (s, t): (f64, f64)) -> DVec3 {
        let Some((corner, first, second, is_triangle)) = self.flat() else {
            let ([axis, x, y], rim) = self.frame();
            let below_one = s * rim;
            let sine = (below_one * (2.0 - below_one)).sqrt();
            let (sin, cos) = (TAU * t).sin_cos();
            return (1.0 - below_one) * axis + sine * (cos * x + sin * y);
        };
        let (s, t) = if is_triangle { (1.0 - (1.0 - s).sqrt(), (1.0 - s).sqrt() * t) } else { (s, t) };
        corner + s * first + t * second - self.from.as_dvec3()
    }

    /// The solid angle per area of the unit square at these coordinates.
    pub fn solid_angle(&self, place: (f64, f64)) -> f64 {
        let Some((_, first, second, is_triangle)) = self.flat() else {
            return TAU * self.cone().2;
        };
        let (to_point, cross) = (self.toward(place), first.cross(second));
        let area = if is_triangle { 0.5 } else { 1.0 };
        area * cross.dot(to_point).abs() / to_point.length().powi(3)
    }

    /// How far the point that the direction meets lies outside of the emitter, as a fraction of its edges or of the solid angle
    /// of a sphere; not above 0 if it lies inside.
    pub fn outside(&self, direction: DVec3) -> f64 {
        let Some((_, _, _, is_triangle)) = self.flat() else { return self.place(direction).0 - 1.0 };
        let (s, t) = self.along_edges(direction);
        let beyond = if is_triangle { s + t - 1.0 } else { s.max(t) - 1.0 };
        beyond.max(-s).max(-t)
    }

    /// How far the point of the plane that the direction meets lies along both edges, as fractions of them.
    fn along_edges(&self, direction: DVec3) -> (f64, f64) {
        let Some((corner, first, second, _)) = self.flat() else { return (0.0, 0.0) };
        let normal = first.cross(second);
        let to_corner = corner - self.from.as_dvec3();
        let offset = to_corner.dot(normal) / direction.dot(normal) * direction - to_corner;
        let s = offset.cross(second).dot(normal) / normal.length_squared();
        let t = first.cross(offset).dot(normal) / normal.length_squared();
        (s, t)
    }

    /// The coordinates in the unit square of the point that the direction meets.
    pub fn place(&self, direction: DVec3) -> (f64, f64) {
        let Some((_, _, _, is_triangle)) = self.flat() else {
            let ([axis, x, y], rim) = self.frame();
            let (cosine, sine_squared) = (direction.dot(axis), direction.cross(axis).length_squared());
            let below_one = if cosine > 0.0 { sine_squared / (1.0 + cosine) } else { 1.0 - cosine };
            let turn = direction.dot(y).atan2(direction.dot(x)) / TAU;
            return (below_one / rim, if turn < 0.0 { turn + 1.0 } else { turn });
        };
        let (s, t) = self.along_edges(direction);
        if is_triangle { (1.0 - (1.0 - s) * (1.0 - s).abs(), t / (1.0 - s)) } else { (s, t) }
    }

    /// How far the end of `distance` along `direction` is off the emitter, or behind the point that is seen, as a fraction of
    /// the size of the numbers.
    pub fn off(&self, direction: DVec3, distance: f64) -> f64 {
        let scale = distance.abs() + self.from.as_dvec3().abs().max_element();
        let Some((corner, first, second, _)) = self.flat() else {
            let (to_center, radius, rim) = self.cone();
            let off = (distance * direction - to_center).length() - radius;
            // From outside, the first hit is nearer than the middle of the chord.
            let behind = if rim < 2.0 {
                distance - to_center.dot(direction)
            } else {
                to_center.dot(direction) - distance
            };
            return off.abs().max(behind) / (scale + radius);
        };
        let normal = first.cross(second).normalize();
        let height = (distance * direction - (corner - self.from.as_dvec3())).dot(normal);
        (height / (scale + first.length())).abs()
    }

    /// The vector to the centre of a sphere.
    pub fn toward_center(&self) -> DVec3 {
        self.cone().0
    }

    /// The distance of the second hit with a sphere in this direction.
    pub fn far_side(&self, direction: DVec3) -> f64 {
        let (to_center, radius, _) = self.cone();
        let middle = to_center.dot(direction);
        middle + (radius * radius - (to_center - middle * direction).length_squared()).max(0.0).sqrt()
    }

    /// The vector to a point of the plane of a parallelogram or triangle, at these fractions of both edges.
    pub fn beyond(&self, s: f64, t: f64) -> DVec3 {
        let Some((corner, first, second, _)) = self.flat() else { return DVec3::Y };
        corner + s * first + t * second - self.from.as_dvec3()
    }

    /// Whether the point is behind a parallelogram or triangle, or inside of a sphere.
    pub fn is_behind(&self) -> bool {
        let Some((corner, first, second, _)) = self.flat() else { return self.cone().2 >= 2.0 };
        (self.from.as_dvec3() - corner).dot(first.cross(second)) < 0.0
    }

    /// The area of a parallelogram or triangle.
    pub fn area(&self) -> Option<f64> {
        let (_, first, second, is_triangle) = self.flat()?;
        Some(first.cross(second).length() * if is_triangle { 0.5 } else { 1.0 })
    }

    /// The corners of a parallelogram or triangle as seen from the point, in order.
    pub fn corners(&self) -> Vec<DVec3> {
        let Some((corner, first, second, is_triangle)) = self.flat() else { return Vec::new() };
        let a = corner - self.from.as_dvec3();
        if is_triangle {
            vec![a, a + first, a + second]
        } else {
            vec![a, a + first, a + first + second, a + second]
        }
    }

    /// The irradiance at the point, of a surface with this normal, if the whole emitter is above its horizon: Lambert's formula
    /// for a polygon, and `π (R / d)² cos θ` for a sphere. The radiance is 1.
    pub fn irradiance(&self, normal: DVec3) -> f64 {
        if self.flat().is_some() {
            return lambert(&self.corners(), normal);
        }
        let (to_center, radius, _) = self.cone();
        PI * radius * radius * to_center.dot(normal) / to_center.length().powi(3)
    }
}

/// The irradiance at the origin, of a surface with this normal, from a polygon of radiance 1 that is wholly above it: Lambert's
/// formula `½ Σ angle(vᵢ, vᵢ₊₁) (vᵢ × vᵢ₊₁) / |vᵢ × vᵢ₊₁| · n`.
pub(super) fn lambert(corners: &[DVec3], normal: DVec3) -> f64 {
    let edge = |index: usize| {
        let (v, w) = (corners[index], corners[(index + 1) % corners.len()]);
        v.angle_between(w) * v.cross(w).normalize().dot(normal)
    };
    0.5 * (0..corners.len()).map(edge).sum::<f64>().abs()
}

/// The nodes and weights of the Gauss–Legendre rule with three points on `0..1`.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// The number of nodes of [`nodes`] per cell.
pub(super) const NODES_PER_CELL: usize = GAUSS.len() * GAUSS.len();

/// Nodes of a product rule, `GAUSS` along both sides of each cell, which has a corner and a size: the place and the weight.
pub(super) fn nodes(cells: impl Iterator<Item = ((f64, f64), (f64, f64))>) -> Vec<((f64, f64), f64)> {
    let mut nodes = Vec::new();
    for ((x, y), (width, height)) in cells {
        for ((s, first), (t, second)) in GAUSS.into_iter().flat_map(|s| GAUSS.map(|t| (s, t))) {
            nodes.push(((x + s * width, y + t * height), first * second * width * height));
        }
    }
    nodes
}
