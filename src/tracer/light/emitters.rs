//! The emitters of a scene that paths sample: surfaces of finite shapes that emit light, in world space.
//!
//! Other surfaces that emit light are found by chance only: whole quadrics and disks, spheres that are stretched, infinite
//! planes, and everything that moves.

use crate::emitter::{AreaEmitter, EmitterShape};
use crate::light_path::ChosenEmitter;
use crate::material::Material;
use crate::shape::{Cuboid, Triangle};
use crate::tracer::search::hit::Target;
use crate::world::{Geometry, Primitive, Solid, SolidShape, World};
use glam::{Affine3A, Vec3, vec3};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;

/// The most emitters. Instances share their mesh, and a million emissive instances of a large mesh would not fit into
/// memory as triangles. Those beyond this number are found by chance.
const MOST_EMITTERS: usize = 1 << 20;

/// All emitters that are sampled, each with the probability with which it is chosen.
///
/// The probability is proportional to the power: radiance, summed over the channels, times area. A vertex does not know
/// which emitters are near, but a bright or large emitter gives much light to most vertices. Uniform choice would spend
/// most samples on the many small triangles of one emissive mesh.
#[derive(Debug, Default)]
pub struct Emitters {
    emitters: Vec<AreaEmitter>,
    /// For each emitter the sum of the powers up to it and of its own.
    cumulative: Vec<f64>,
    /// The emitters of each surface, by the indices of its target: of a primitive, and of a primitive of its shared mesh.
    of_surface: HashMap<(u32, u32), Range<usize>>,
}

/// In place of the index of a primitive of a shared mesh: the surface belongs to no shared mesh.
const NO_INSTANCE: u32 = u32::MAX;

impl Emitters {
    /// The emitters of `world` whose materials `is_sampled` selects, by their indices in `World::materials`.
    pub fn new(world: &World, is_sampled: impl Fn(usize) -> bool) -> Emitters {
        let mut emitters = Emitters::default();
        let radiance = |material: u32| {
            let Material { emission, one_sided_emission, .. } = world.materials[material as usize];
            (is_sampled(material as usize) && emission != Vec3::ZERO)
                .then_some((emission, !one_sided_emission))
        };
        for (index, primitive) in (0..).zip(&world.primitives) {
            // An emitter that moves has no one place.
            if primitive.end.get().is_some() {
                continue;
            }
            if let Geometry::Instance(instance) = primitive.geometry {
                let instance = &world.instances[instance as usize];
                let mesh = &world.shared_meshes[instance.shared_mesh as usize].primitives;
                for (inner, part) in (0..).zip(mesh) {
                    let inherits = part.material == Primitive::INHERITED;
                    let material = if inherits { primitive.material } else { part.material };
                    if let Some(radiance) = radiance(material) {
                        let shapes = placed(&part.geometry, &instance.placement.to_world);
                        emitters.add((index, inner), shapes, radiance);
                    }
                }
            } else if let Some(radiance) = radiance(primitive.material) {
                emitters.add((index, NO_INSTANCE), shapes(world, &primitive.geometry), radiance);
            }
        }
        emitters
    }

    /// Adds the shapes of one surface, each with whether rays hit both of its sides. The radiance comes with whether the
    /// material emits light on both sides.
    fn add(
        &mut self,
        surface: (u32, u32),
        shapes: Vec<(EmitterShape, bool)>,
        (radiance, both_sides): (Vec3, bool),
    ) {
        let first = self.emitters.len();
        if first + shapes.len() > MOST_EMITTERS {
            return;
        }
        for (shape, two_sided) in shapes {
            let power = f64::from(radiance.element_sum()) * area(&shape);
            let before = self.cumulative.last().copied().unwrap_or(0.0);
            self.emitters.push(AreaEmitter { shape, radiance, two_sided: two_sided && both_sides });
            self.cumulative.push(before + if power.is_finite() { power } else { 0.0 });
        }
        self.of_surface.insert(surface, first..self.emitters.len());
    }

    /// Whether no emitter can be chosen.
    pub fn is_empty(&self) -> bool {
        self.total() <= 0.0
    }

    /// The number of emitters that can be chosen.
    pub fn len(&self) -> usize {
        if self.is_empty() { 0 } else { self.emitters.len() }
    }

    fn total(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }

    /// The emitter that the random number `u`, `0 <= u < 1`, chooses; `None` if there is none.
    pub fn choose(&self, u: f32) -> Option<ChosenEmitter> {
        let wanted = f64::from(u) * self.total();
        // The first emitter whose sum exceeds the wanted one has a power above 0.
        let index = self.cumulative.partition_point(|&sum| sum <= wanted);
        let emitter = *self.emitters.get(index)?;
        Some(ChosenEmitter { emitter, probability: self.probability(index) })
    }

    fn probability(&self, index: usize) -> f32 {
        let before = index.checked_sub(1).map_or(0.0, |before| self.cumulative[before]);
        ((self.cumulative[index] - before) / self.total()) as f32
    }

    /// The emitter to which `point` of the surface `target` belongs; `None` if the surface is not sampled.
    #[cold]
    pub fn at(&self, target: Target, point: Vec3) -> Option<ChosenEmitter> {
        let surface = match target {
            Target::Plane(_) => return None,
            Target::Primitive(primitive) => (primitive, NO_INSTANCE),
            Target::Instance(outer, inner) => (outer, inner),
        };
        let emitters = self.of_surface.get(&surface)?.clone();
        // Of the faces of a box and the triangles of a polygon take the nearest one.
        let nearest = emitters.min_by(|&a, &b| {
            let distance = |index: usize| distance_squared(&self.emitters[index].shape, point);
            distance(a).total_cmp(&distance(b))
        })?;
        let probability = self.probability(nearest);
        (probability > 0.0).then_some(ChosenEmitter { emitter: self.emitters[nearest], probability })
    }
}

/// The shapes of a primitive in world space, each with whether it emits light on both sides; none if it cannot be sampled.
fn shapes(world: &World, geometry: &Geometry) -> Vec<(EmitterShape, bool)> {
    match geometry {
        Geometry::Sphere(sphere) => vec![(EmitterShape::Sphere(*sphere), true)],
        Geometry::Solid(index) => of_solid(&world.solids[*index as usize]),
        Geometry::Triangle(_) | Geometry::OneSided(_) => placed(geometry, &Affine3A::IDENTITY),
        Geometry::Instance(_) => Vec::new(),
    }
}

/// A triangle under a transform. Rays pass through the back of a one-sided triangle, which emits no light.
fn placed(geometry: &Geometry, to_world: &Affine3A) -> Vec<(EmitterShape, bool)> {
    let Some(triangle) = geometry.triangle() else { return Vec::new() };
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|corner| to_world.transform_point3(corner));
    // A reflection exchanges front and back: exchange two corners, which exchanges them again.
    let is_reflection = to_world.matrix3.determinant() < 0.0;
    let shape = EmitterShape::Triangle(Triangle { a, b, c });
    let shape = if is_reflection { turned(shape) } else { shape };
    vec![(shape, matches!(geometry, Geometry::Triangle(_)))]
}

/// The faces of a box as parallelograms, or a polygon as triangles around its first corner. Both stay so under every
/// transform.
fn of_solid(solid: &Solid) -> Vec<(EmitterShape, bool)> {
    let point = |point: Vec3| solid.placement.to_world.transform_point3(point);
    // A reflection exchanges front and back.
    let is_reflection = solid.placement.to_world.matrix3.determinant() < 0.0;
    let shapes: Vec<EmitterShape> = match &solid.shape {
        SolidShape::Cuboid(cuboid) => faces(cuboid)
            .map(|[corner, end, other]| {
                let edges = (point(end) - point(corner), point(other) - point(corner));
                EmitterShape::Parallelogram { corner: point(corner), edges }
            })
            .to_vec(),
        SolidShape::Polygon(polygon) => {
            let corners: Vec<Vec3> = polygon.corners.iter().map(|&corner| point(corner)).collect();
            match corners[..] {
                // Four corners whose diagonals halve each other, up to rounding, are one parallelogram.
                [a, b, c, d] if (a + c - b - d).length() <= 1e-6 * (a - c).length() => {
                    vec![EmitterShape::Parallelogram { corner: a, edges: (b - a, d - a) }]
                }
                _ => (2..corners.len())
                    .map(|i| Triangle { a: corners[0], b: corners[i - 1], c: corners[i] })
                    .map(EmitterShape::Triangle)
                    .collect(),
            }
        }
        SolidShape::Sphere(_) | SolidShape::Cylinder(_) | SolidShape::Cone(_) | SolidShape::Disk(_) => {
            Vec::new()
        }
    };
    shapes.into_iter().map(|shape| (if is_reflection { turned(shape) } else { shape }, true)).collect()
}

/// The same shape with front and back exchanged.
fn turned(shape: EmitterShape) -> EmitterShape {
    match shape {
        EmitterShape::Sphere(_) => shape,
        EmitterShape::Triangle(Triangle { a, b, c }) => EmitterShape::Triangle(Triangle { a, b: c, c: b }),
        EmitterShape::Parallelogram { corner, edges: (u, v) } => {
            EmitterShape::Parallelogram { corner, edges: (v, u) }
        }
    }
}

/// For each face of a box a corner and the ends of the two edges from there, in the order that makes the outside the front.
fn faces(&Cuboid { min, max }: &Cuboid) -> [[Vec3; 3]; 6] {
    let [near, far] = [min, max].map(|corner| {
        let other = min + max - corner;
        let ends = [
            vec3(other.x, corner.y, corner.z),
            vec3(corner.x, other.y, corner.z),
            vec3(corner.x, corner.y, other.z),
        ];
        [[corner, ends[0], ends[1]], [corner, ends[1], ends[2]], [corner, ends[2], ends[0]]]
    });
    let near = near.map(|[corner, end, other]| [corner, other, end]);
    [near[0], near[1], near[2], far[0], far[1], far[2]]
}

/// The area of an emitter in square world units, in double precision, in which no square of a length overflows.
fn area(shape: &EmitterShape) -> f64 {
    let cross = |u: Vec3, v: Vec3| u.as_dvec3().cross(v.as_dvec3()).length();
    match shape {
        EmitterShape::Sphere(sphere) => 4.0 * PI * f64::from(sphere.radius).powi(2),
        EmitterShape::Triangle(triangle) => 0.5 * cross(triangle.b - triangle.a, triangle.c - triangle.a),
        EmitterShape::Parallelogram { edges, .. } => cross(edges.0, edges.1),
    }
}

/// The square of the distance from `point`, which lies on a surface, to a flat part of it: 0 up to rounding if it lies on
/// that part. It is exact where it is 0, and otherwise it is above 0.
fn distance_squared(shape: &EmitterShape, point: Vec3) -> f32 {
    let (corner, edges, is_triangle) = match *shape {
        EmitterShape::Sphere(_) => return 0.0,
        EmitterShape::Triangle(Triangle { a, b, c }) => (a, (b - a, c - a), true),
        EmitterShape::Parallelogram { corner, edges } => (corner, edges, false),
    };
    // Find the parameters of the point in the plane of the part, by ratios of areas.
    let normal = edges.0.cross(edges.1);
    let offset = point - corner;
    let s = offset.cross(edges.1).dot(normal) / normal.length_squared();
    let t = edges.0.cross(offset).dot(normal) / normal.length_squared();
    // Move them into the part.
    let (s, t) = (s.clamp(0.0, 1.0), t.clamp(0.0, 1.0));
    let outside = if is_triangle { (s + t).max(1.0) } else { 1.0 };
    let nearest = corner + s / outside * edges.0 + t / outside * edges.1;
    nearest.distance_squared(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Effects;
    use crate::files::scene::parse;
    use crate::graph::Placement;
    use crate::world::WorldFunctions;
    use std::path::Path;

    /// The placement by the product of the transforms, in place of the student's.
    fn place(path: &[Affine3A]) -> Option<Placement> {
        let to_world = path.iter().fold(Affine3A::IDENTITY, |product, next| product * *next);
        Some(Placement { to_world, to_object: to_world.inverse() })
    }

    fn world(nodes: &str) -> World {
        let text = format!(
            "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nshutter = {{ open = 0, close = 1 }}\n\
             [materials.glow]\nemission = [1, 2, 3]\n[materials.dim]\nemission = 0.5\n{nodes}"
        );
        let scene = parse(Path::new("scenes/test.toml"), &text).unwrap_or_else(|error| panic!("{error}"));
        let functions = WorldFunctions { placement: Some(place), ..WorldFunctions::default() };
        World::new(&scene, &Effects { motion: true, ..Effects::everything(&scene) }, &functions)
    }

    fn node(material: &str, shape: &str, rest: &str) -> String {
        format!("[[nodes]]\nmaterial = \"{material}\"\nshape = {{ {shape} }}\n{rest}\n")
    }

    const SPHERE: &str = "sphere = { center = [1, 0, 0], radius = 1 }";

    #[test]
    fn the_probabilities_are_the_powers_and_sum_to_one() {
        let triangle = "triangle = { a = [0, 0, 0], b = [2, 0, 0], c = [0, 2, 0] }";
        let world = world(&(node("glow", SPHERE, "") + &node("dim", triangle, "")));
        let emitters = Emitters::new(&world, |_| true);
        assert_eq!(emitters.len(), 2);
        // 4π · 6 against 2 · 1.5.
        let (sphere, triangle) = (24.0 * PI, 3.0);
        let expected = (triangle / (sphere + triangle)) as f32;
        let first = emitters.choose(0.0).expect("an emitter");
        assert!(matches!(first.emitter.shape, EmitterShape::Sphere(_)) && first.emitter.two_sided);
        assert!((first.probability - (1.0 - expected)).abs() < 1e-6);
        let last = emitters.choose(0.999_999).expect("an emitter");
        assert!(matches!(last.emitter.shape, EmitterShape::Triangle(_)));
        assert_eq!(last.emitter.radiance, Vec3::splat(0.5));
        assert!((last.probability - expected).abs() < 1e-6);
        // The same probability belongs to a ray that happens to hit the emitter.
        assert_eq!(emitters.at(Target::Primitive(1), Vec3::ZERO), Some(last));
        assert_eq!(emitters.at(Target::Plane(0), Vec3::ZERO), None);
    }

    #[test]
    fn shapes_without_an_exact_emitter_are_found_by_chance() {
        for (shape, rest) in [
            (SPHERE, "transform = [{ scale = [1, 2, 1] }]"),
            (SPHERE, "transform_end = [{ translate = [1, 0, 0] }]"),
            ("disk = { center = [0, 0, 0], normal = [0, 1, 0], radius = 1 }", ""),
            ("cylinder = { base = [0, -1, 0], top = [0, 1, 0], radius = 1 }", ""),
            ("plane = { point = [0, 0, 0], normal = [0, 1, 0] }", ""),
        ] {
            let world = world(&node("glow", shape, rest));
            assert_eq!(Emitters::new(&world, |_| true).len(), 0, "{shape} {rest}");
        }
        // A material that is not sampled has no emitters.
        let world = world(&node("glow", SPHERE, ""));
        assert!(Emitters::new(&world, |_| false).is_empty());
    }

    #[test]
    fn transforms_carry_emitters_to_the_world() {
        // A sphere under a uniform scale stays a sphere.
        let rest = "transform = [{ scale = 2 }, { translate = [0, 1, 0] }]";
        let emitters = Emitters::new(&world(&node("glow", SPHERE, rest)), |_| true);
        let sphere = crate::shape::Sphere { center: vec3(2.0, 1.0, 0.0), radius: 2.0 };
        assert_eq!(emitters.choose(0.5).expect("an emitter").emitter.shape, EmitterShape::Sphere(sphere));
        // The faces of a stretched box have its area, 2 (2·3 + 2·4 + 3·4), and each of its points belongs to its face.
        let shape = "box = { min = [0, 0, 0], max = [1, 1, 1] }";
        let world = world(&node("glow", shape, "transform = [{ scale = [2, 3, 4] }]"));
        let emitters = Emitters::new(&world, |_| true);
        assert_eq!(emitters.len(), 6);
        let whole: f64 = emitters.emitters.iter().map(|emitter| area(&emitter.shape)).sum();
        assert!((whole - 52.0).abs() < 1e-5, "{whole}");
        for (point, normal) in [
            (vec3(0.0, 1.0, 1.0), Vec3::X),
            (vec3(2.0, 1.0, 1.0), Vec3::X),
            (vec3(1.0, 3.0, 2.0), Vec3::Y),
            (vec3(1.0, 1.0, 4.0), Vec3::Z),
        ] {
            let at = emitters.at(Target::Primitive(0), point).expect("a face");
            let EmitterShape::Parallelogram { corner, edges } = at.emitter.shape else {
                panic!("a face is flat")
            };
            assert_eq!(edges.0.cross(edges.1).normalize().abs(), normal);
            assert_eq!((point - corner).dot(normal), 0.0);
        }
    }

    #[test]
    fn polygons_are_parallelograms_or_triangles() {
        let square = "polygon = { corners = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]] }";
        assert_eq!(Emitters::new(&world(&node("glow", square, "")), |_| true).len(), 1);
        let five = "polygon = { corners = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 2, 0], [0, 1, 0]] }";
        let emitters = Emitters::new(&world(&node("glow", five, "")), |_| true);
        assert_eq!(emitters.len(), 3);
        // Each point belongs to the triangle of the fan in which it lies.
        for (point, second) in [
            (vec3(1.5, 0.2, 0.0), vec3(2.0, 0.0, 0.0)),
            (vec3(1.4, 1.2, 0.0), vec3(2.0, 1.0, 0.0)),
            (vec3(0.3, 1.0, 0.0), vec3(1.0, 2.0, 0.0)),
        ] {
            let at = emitters.at(Target::Primitive(0), point).expect("a triangle");
            let EmitterShape::Triangle(triangle) = at.emitter.shape else {
                panic!("a fan consists of triangles")
            };
            assert_eq!(triangle.b, second, "{point}");
        }
    }

    #[test]
    fn instances_have_emitters_of_their_own() {
        let mesh = "[meshes.cube]\nfile = \"meshes/cube.obj\"\none_sided = true\n";
        let one = "[[nodes]]\nname = \"one\"\nshape = { mesh = \"cube\" }\n";
        let placed = |rest: &str| format!("[[nodes]]\nmaterial = \"glow\"\nchildren = [\"one\"]\n{rest}\n");
        let nodes = [mesh, one, &placed(""), &placed("transform = [{ scale = [-2, 2, 2] }]")].concat();
        let text = world(&nodes);
        assert_eq!(text.shared_meshes.len(), 1);
        let emitters = Emitters::new(&text, |_| true);
        let triangles = text.shared_meshes[0].primitives.len();
        assert_eq!(emitters.len(), 2 * triangles);
        let areas: Vec<f64> = emitters.emitters.iter().map(|emitter| area(&emitter.shape)).collect();
        let [first, second] = [&areas[..triangles], &areas[triangles..]].map(|part| part.iter().sum::<f64>());
        assert!((second - 4.0 * first).abs() < 1e-5 * second, "{first} {second}");
        // The front of each triangle of the mirrored copy is on the outside: the fronts enclose a positive volume.
        let volume = |emitters: &[AreaEmitter]| {
            let six = |emitter: &AreaEmitter| match emitter.shape {
                EmitterShape::Triangle(t) => t.a.dot(t.b.cross(t.c)),
                _ => panic!("meshes consist of triangles"),
            };
            emitters.iter().map(six).sum::<f32>()
        };
        let [own, mirrored] = [&emitters.emitters[..triangles], &emitters.emitters[triangles..]].map(volume);
        assert!(own > 0.0 && (mirrored - 8.0 * own).abs() < 1e-4 * mirrored, "{own} {mirrored}");
    }
}
