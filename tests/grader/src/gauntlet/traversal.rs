//! Triangles in a hierarchy of the reference, and nothing else.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Probe};
use raykata::partition::Cells;
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::Triangle;
use solutions::{stage2_triangles, stage3_bvh};

/// The hierarchy over these triangles.
pub fn hierarchy(triangles: &[Triangle], split: Split, leaf_size: usize) -> Bvh {
    let bounds: Vec<Aabb> = triangles.iter().map(stage3_bvh::triangle_bounds).collect();
    stage3_bvh::build(&bounds, split, leaf_size)
}

/// Answers the questions of a search.
pub struct Triangles<'a> {
    bvh: &'a Bvh,
    triangles: &'a [Triangle],
    inverse_dir: Vec3,
}

impl<'a> Triangles<'a> {
    /// For one ray.
    pub fn new(bvh: &'a Bvh, triangles: &'a [Triangle], ray: &Ray) -> Self {
        Triangles { bvh, triangles, inverse_dir: ray.dir.recip() }
    }

    #[inline]
    fn test(&self, primitive: u32, ray: &Ray) -> Option<f32> {
        stage2_triangles::triangle_choice(ray, &self.triangles[primitive as usize]).map(|hit| hit.t)
    }
}

impl Probe for Triangles<'_> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.bvh.nodes[node as usize].contents
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        let bounds = &self.bvh.nodes[node as usize].bounds;
        stage3_bvh::slab(ray, self.inverse_dir, bounds).map(|(t_enter, _)| t_enter)
    }

    #[inline]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.test(primitive, ray)
    }
}

impl Cells for Triangles<'_> {
    fn visit(&mut self, _: u32) {}

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.test(primitive, ray)
    }
}

/// The same for rays that come in packets, with directions of their own.
pub struct Packet<'a>(pub Triangles<'a>);

impl Probe for Packet<'_> {
    fn open(&mut self, node: u32) -> Contents {
        self.0.open(node)
    }

    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.0.inverse_dir = ray.dir.recip();
        self.0.enter(node, ray)
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.0.test(primitive, ray)
    }
}
