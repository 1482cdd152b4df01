//! The closest hit of a ray.

use glam::Vec3;

/// The closest hit of a ray: its distance, the surface, and what the test found there.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// The surface that is hit, by its indices in the world.
    pub target: Target,
    /// What the test of the surface found beside `t`.
    pub detail: Detail,
}

/// The surface that a ray hits, by its indices in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Index of an infinite plane in `World::planes`.
    Plane(u32),
    /// Index of a primitive in `World::primitives`, which is not an instance.
    Primitive(u32),
    /// Index of an instance in `World::primitives`, and index of a primitive of its shared mesh.
    Instance(u32, u32),
}

/// What the test of a primitive found beside `t`. It is kept so that the primitive need not be tested again.
#[derive(Clone, Copy, Debug, Default)]
pub enum Detail {
    /// Nothing was found, or it was not kept.
    #[default]
    None,
    /// Barycentric coordinates `(β, γ)` of the hit in a triangle.
    Triangle(f32, f32),
    /// The unit normal of a solid at the hit, in its own space.
    Solid(Vec3),
}
