//! The effects and shapes of a scene, which decide which parameters are useful.

use raykata::effects::{Effect, Effects};
use raykata::scene::{Accelerator, Scene};
use raykata::shape::Shape;

/// A scene and its effects.
pub struct Called<'a> {
    pub scene: &'a Scene,
    pub effects: &'a Effects,
    /// The number of primitives that rays are tested against.
    pub primitives: u64,
    /// The number of samples that ladders reach at least.
    pub most_samples: u32,
    /// Whether instances share a mesh.
    pub shares_meshes: bool,
}

impl Called<'_> {
    /// Whether rays are tested against triangles.
    pub fn shows_triangles(&self) -> bool {
        self.shows(|shape, moves| match shape {
            Shape::Triangle(_) | Shape::Mesh(_) | Shape::Bezier { .. } | Shape::Nurbs { .. } => true,
            Shape::Sphere(_) | Shape::Plane(_) | Shape::PlaneEquation(_) => false,
            // A moving shape has no object space of its own and is made of triangles.
            _ => moves,
        })
    }

    /// Whether rays are tested against spheres.
    pub fn shows_spheres(&self) -> bool {
        self.shows(|shape, _| matches!(shape, Shape::Sphere(_)))
    }

    /// Whether the structure is the scene graph itself.
    pub fn searches_the_graph(&self) -> bool {
        use Accelerator::{BoundingBoxes, BoundingSpheres, CachedBoundingBoxes};
        matches!(self.scene.quality.accelerator, BoundingBoxes | BoundingSpheres | CachedBoundingBoxes)
    }

    /// How often the finest curved surface or subdivided mesh can be made half as fine; 0 without one.
    pub fn tessellation(&self) -> u32 {
        let mut halvings = 0;
        self.shows(|shape, _| {
            halvings = halvings.max(match shape {
                Shape::Bezier { steps, .. } | Shape::Nurbs { steps, .. } => steps.ilog2(),
                Shape::Mesh(index) => self.scene.meshes[*index].subdivisions,
                _ => 0,
            });
            false
        });
        halvings
    }

    /// Whether `is_so` holds for a shape that is shown; its second argument is whether the shape moves while
    /// the shutter is open.
    fn shows(&self, mut is_so: impl FnMut(&Shape, bool) -> bool) -> bool {
        let motion = self.effects.calls_for(Effect::Motion);
        self.scene.shown().iter().any(|shown| {
            let shape = self.scene.nodes[shown.node].shape.as_ref();
            shape.is_some_and(|shape| is_so(shape, shown.moves && motion))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Called;
    use raykata::effects::Effects;
    use raykata::scene::load::parse;
    use std::path::Path;

    /// Checks whether a scene of one node shows triangles and spheres, without and with motion.
    #[track_caller]
    fn check(shape: &str, still: (bool, bool), moving: (bool, bool)) {
        let text = format!(
            "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nshutter = {{ open = 0, close = 1 }}\n\
             [[nodes]]\nshape = {{ {shape} }}\ntransform_end = [{{ translate = [1, 0, 0] }}]\n"
        );
        let scene = parse(Path::new("test.toml"), &text).unwrap_or_else(|error| panic!("{error}"));
        for (motion, expected) in [(false, still), (true, moving)] {
            let effects = Effects { motion, ..Effects::default() };
            let called = Called {
                scene: &scene,
                effects: &effects,
                primitives: 1,
                most_samples: 64,
                shares_meshes: false,
            };
            assert_eq!((called.shows_triangles(), called.shows_spheres()), expected, "{shape}");
        }
    }

    #[test]
    fn what_moves_and_has_an_end_is_made_of_triangles() {
        check("triangle = { a = [0, 0, 0], b = [1, 0, 0], c = [0, 1, 0] }", (true, false), (true, false));
        check("sphere = { center = [0, 0, 0], radius = 1 }", (false, true), (false, true));
        check("plane = { point = [0, 0, 0], normal = [0, 1, 0] }", (false, false), (false, false));
        check("box = { min = [0, 0, 0], max = [1, 1, 1] }", (false, false), (true, false));
    }
}
