//! The published crates, each as its documentation shows.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use nalgebra::Point3;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::ray::RayHit;
use parry3d::math::Vector;
use parry3d::query::RayCast;
use parry3d::shape::TriMesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use std::time::Duration;

/// Finds hits of rays with triangles.
pub trait Contestant {
    /// The `t` of the closest hit of each ray; ∞ for a miss. With `any`, 0 for a ray that hits anything.
    fn trace(&self, rays: &[Ray], any: bool, found: &mut [f32]);
}

/// The number for an answer to whether anything is hit.
pub fn of_any(hit: bool) -> f32 {
    if hit { 0.0 } else { f32::INFINITY }
}

fn obvhs_triangles(triangles: &[Triangle]) -> Vec<obvhs::triangle::Triangle> {
    let point = |p: glam::Vec3| p.to_array().into();
    triangles
        .iter()
        .map(|t| obvhs::triangle::Triangle { v0: point(t.a), v1: point(t.b), v2: point(t.c) })
        .collect()
}

fn obvhs_ray(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin.to_array().into(), ray.direction.to_array().into(), ray.t_min, ray.t_max)
}

/// Makes a contestant of a tree of `obvhs`. Its trees have the same methods and no trait.
macro_rules! obvhs_contestant {
    ($(#[$doc:meta])* $name:ident, $Tree:ty, $build:path) => {
        $(#[$doc])*
        pub struct $name {
            tree: $Tree,
            triangles: Vec<obvhs::triangle::Triangle>,
        }

        impl $name {
            pub fn build(triangles: &[Triangle]) -> Self {
                let triangles = obvhs_triangles(triangles);
                let tree = $build(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
                // In the order of the tree, as its documentation recommends.
                let triangles = tree.primitive_indices.iter().map(|&i| triangles[i as usize]).collect();
                $name { tree, triangles }
            }
        }

        impl Contestant for $name {
            fn trace(&self, rays: &[Ray], any: bool, found: &mut [f32]) {
                let test = |ray: &_, id: usize| self.triangles[id].intersect(ray);
                for (ray, found) in rays.iter().zip(found) {
                    let mut hit = RayHit::none();
                    *found = if any {
                        of_any(!self.tree.ray_traverse_miss(obvhs_ray(ray), test))
                    } else if self.tree.ray_traverse(obvhs_ray(ray), &mut hit, test) {
                        hit.t
                    } else {
                        f32::INFINITY
                    };
                }
            }
        }
    };
}

obvhs_contestant!(
    /// `obvhs`: a binary tree.
    Obvhs2, Bvh2, obvhs::bvh2::builder::build_bvh2_from_tris
);
obvhs_contestant!(
    /// `obvhs`: the compressed tree with eight children per node.
    ObvhsWide, CwBvh, obvhs::cwbvh::builder::build_cwbvh_from_tris
);

/// `parry3d`.
pub struct Parry(TriMesh);

impl Parry {
    pub fn build(triangles: &[Triangle]) -> Self {
        let point = |p: glam::Vec3| Vector::new(p.x, p.y, p.z);
        let vertices = triangles.iter().flat_map(|t| [t.a, t.b, t.c].map(point)).collect();
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Parry(TriMesh::new(vertices, indices).expect("a mesh"))
    }
}

impl Contestant for Parry {
    fn trace(&self, rays: &[Ray], any: bool, found: &mut [f32]) {
        let vector = |p: glam::Vec3| Vector::new(p.x, p.y, p.z);
        for (ray, found) in rays.iter().zip(found) {
            // It has no search for any hit.
            let cast = parry3d::query::Ray::new(vector(ray.origin), vector(ray.direction));
            let hit = self.0.cast_local_ray(&cast, ray.t_max, false);
            *found = if any { of_any(hit.is_some()) } else { hit.unwrap_or(f32::INFINITY) };
        }
    }
}

/// `bvh`.
pub struct Bvh {
    tree: bvh::bvh::Bvh<f32, 3>,
    shapes: Vec<Shape>,
}

struct Shape {
    triangle: Triangle,
    obvhs: obvhs::triangle::Triangle,
    node: usize,
}

impl Bounded<f32, 3> for Shape {
    fn aabb(&self) -> Aabb<f32, 3> {
        let Triangle { a, b, c } = self.triangle;
        let point = |p: glam::Vec3| Point3::new(p.x, p.y, p.z);
        Aabb::with_bounds(point(a.min(b).min(c)), point(a.max(b).max(c)))
    }
}

impl BHShape<f32, 3> for Shape {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Bvh {
    pub fn build(triangles: &[Triangle]) -> Self {
        let shape = |(&triangle, obvhs)| Shape { triangle, obvhs, node: 0 };
        let mut shapes: Vec<Shape> = triangles.iter().zip(obvhs_triangles(triangles)).map(shape).collect();
        let tree = bvh::bvh::Bvh::build(&mut shapes);
        Bvh { tree, shapes }
    }

    /// The hits of one ray. The crate's own triangle test misses back faces, so that of `obvhs` is used.
    fn hits<'a>(
        &'a self,
        ray: &'a bvh::ray::Ray<f32, 3>,
        other: &'a obvhs::ray::Ray,
    ) -> impl Iterator<Item = f32> + 'a {
        let shapes = self.tree.traverse_iterator(ray, &self.shapes);
        shapes.map(|shape| shape.obvhs.intersect(other)).filter(|&t| t < other.tmax && t > other.tmin)
    }
}

fn bvh_ray(ray: &Ray) -> bvh::ray::Ray<f32, 3> {
    let (o, d) = (ray.origin, ray.direction);
    bvh::ray::Ray::new(Point3::new(o.x, o.y, o.z), nalgebra::Vector3::new(d.x, d.y, d.z))
}

impl Contestant for Bvh {
    fn trace(&self, rays: &[Ray], any: bool, found: &mut [f32]) {
        for (ray, found) in rays.iter().zip(found) {
            let (own, other) = (bvh_ray(ray), obvhs_ray(ray));
            let mut hits = self.hits(&own, &other);
            *found = if any { of_any(hits.next().is_some()) } else { hits.fold(f32::INFINITY, f32::min) };
        }
    }
}
