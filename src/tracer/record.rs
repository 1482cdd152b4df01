//! Writing down the rays behind a pixel while they are followed.

use super::path::Path;
use crate::kit::{RayKind, TracedRay};
use crate::ray::Ray;

/// Receives every ray of a path. By default a ray is not kept.
pub trait Record {
    /// The path met nothing.
    fn miss(&mut self, _path: &Path) {}

    /// The path met a surface of this material at `t`. Gives its number.
    fn hit(&mut self, _path: &Path, _t: f32, _material: usize) -> usize {
        0
    }

    /// A shadow ray went out from the surface that the path number `parent` met.
    fn shadow(&mut self, _path: &Path, _parent: usize, _ray: &Ray, _blocked: bool) {}
}

/// Keeps nothing.
pub struct NoRecord;

impl Record for NoRecord {}

/// Keeps all rays, parents before children.
pub struct Rays<'a> {
    /// Names of the materials, by index.
    pub material_names: &'a [String],
    /// The rays.
    pub rays: Vec<TracedRay>,
}

impl Rays<'_> {
    fn push(&mut self, path: &Path, hit: Option<(f32, String)>) -> usize {
        let Path { ray, weight, depth, kind, parent, .. } = *path;
        self.rays.push(TracedRay { kind, parent, depth, weight, origin: ray.origin, dir: ray.dir, hit });
        self.rays.len() - 1
    }
}

impl Record for Rays<'_> {
    fn miss(&mut self, path: &Path) {
        self.push(path, None);
    }

    fn hit(&mut self, path: &Path, t: f32, material: usize) -> usize {
        let name = self.material_names.get(material).cloned().unwrap_or_default();
        self.push(path, Some((t, name)))
    }

    fn shadow(&mut self, path: &Path, parent: usize, ray: &Ray, blocked: bool) {
        let shadow = Path { ray: *ray, kind: RayKind::Shadow, parent: Some(parent), ..*path };
        self.push(&shadow, blocked.then(|| (0.0, String::new())));
    }
}
