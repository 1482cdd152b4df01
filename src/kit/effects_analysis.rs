//! Stage 7, the effects analysis: queries and answers.

use crate::message;

/// The number of rays of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// The number of rays from the camera.
    pub primary: u64,
    /// The number of shadow rays.
    pub shadow: u64,
    /// The number of reflected rays.
    pub reflection: u64,
    /// The number of refracted rays.
    pub transmission: u64,
}

message! { RayCounts { primary, shadow, reflection, transmission } }

/// The hits of rays with surfaces of one material.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MaterialHits {
    /// The index of the material.
    pub material: usize,
    /// The number of rays that hit the material.
    pub hits: u64,
    /// For each light of the scene: the number of sampled points of the light, over all hits, that lie in
    /// front of the surface.
    pub in_front: Vec<u64>,
}

message! { MaterialHits { material, hits, in_front } }
