//! What a ray meets first.

use glam::Vec3;

/// What a ray meets first, and where.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// What is met.
    pub target: Target,
    /// Where on it.
    pub detail: Detail,
}

/// Which surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Index of an infinite plane of the world.
    Plane(u32),
    /// Index of a primitive of the world.
    Primitive(u32),
    /// Index of an instance among the primitives of the world, and of a primitive of the mesh that it places.
    Instance(u32, u32),
}

/// What the test of a primitive found beside `t`, so that the primitive that is met need not be tested again.
#[derive(Clone, Copy, Debug, Default)]
pub enum Detail {
    /// Nothing, or it was not kept.
    #[default]
    None,
    /// Barycentric coordinates `(β, γ)` of a triangle.
    Triangle(f32, f32),
    /// The normal of a solid, in its own space.
    Solid(Vec3),
}
