//! A plan as data.

use crate::effects::Effects;
use crate::kit::View;
use crate::light_path::PathEffects;
use crate::scene::Accelerator;
use crate::tracer::search::intersection::ShapeTests;
use crate::world::WorldFunctions;
use glam::Vec3;

/// What a frame computes: the effects of the scene, as far as the student functions for them are written.
pub struct Plan {
    /// The effects that the scene asks for and that are written.
    pub effects: Effects,
    /// The acceleration structure, never [`Accelerator::Auto`]; `None` if no search is written, not even brute force.
    pub accelerator: Option<Accelerator>,
    /// Which student functions test rays against triangles and spheres.
    pub tests: ShapeTests,
    /// Whether `conservative_slab` of stage 10 tests the boxes of hierarchies; otherwise `slab` of stage 3.
    pub conservative: bool,
    /// Whether `offset_origin` of stage 10 moves the origins of rays that leave a surface; otherwise the functions of
    /// stages 4 and 5 that make these rays.
    pub offsets: bool,
    /// Whether `safe_normalize` of stage 10 normalizes the directions of rays.
    pub safe_units: bool,
    /// Which functions of stage 12 a wide tree uses.
    pub wide: WidePlan,
    /// What a pixel shows: light, normals or work. If `shade` is not written, it shows normals.
    pub view: View,
    /// The student functions that the world is made with, and the kinds of shapes that are shown.
    pub world: WorldFunctions,
    /// Whether normals are interpolated over the triangles of smooth meshes.
    pub smooth: bool,
    /// Whether normals are turned to the side from which the ray comes.
    pub facing: bool,
    /// Whether `pixel_position` is written; otherwise samples lie anywhere in the pixel.
    pub positions: bool,
    /// Whether the filter functions are written; otherwise all samples of a pixel have the same weight.
    pub weights: bool,
    /// For each light of the scene whether it is visible.
    pub visible_lights: Vec<bool>,
    /// Whether `texture_color` is written, which reads images.
    pub images: bool,
    /// Whether images are filtered, because the scene asks for it and a surface that is shown has an image.
    pub mipmaps: bool,
    /// Whether coats reflect light.
    pub coats: bool,
    /// Whether a material that is shown emits light. Without any, no emission is added at a hit.
    pub emission: bool,
    /// The ambient light that surfaces reflect: that of the scene, or none where indirect light is computed, for which it
    /// stands.
    pub ambient: Vec3,
    /// What paths of indirect light need; `None` if no path bounces off a diffuse surface, or if it is left out.
    pub paths: Option<PathEffects>,
    /// Whether `jittered` of stage 6 is written; otherwise the random numbers of paths are not stratified.
    pub jittered: bool,
    /// What the picture will lack, one sentence each; empty if nothing.
    pub notes: Vec<String>,
}

/// Which functions of stage 12 are written, beside those without which there is no wide tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WidePlan {
    /// Whether `build_parallel` is written.
    pub parallel: bool,
    /// Whether `build_binned` is written. Without both, the tree of stage 3 is flattened.
    pub binned: bool,
    /// Whether `may_hit` is written; otherwise each triangle of a leaf is tested.
    pub may_hit: bool,
}
