//! A record of the rays behind a pixel, while they are followed.

use super::path::Path;
use crate::kit::{RayKind, TracedRay};
use crate::ray::Ray;

/// Receives every ray that is followed. The default methods keep nothing.
pub trait Record {
    /// Receives a path that hits nothing.
    fn miss(&mut self, _path: &Path) {}

    /// Receives a path that hits a surface of material `_material` at `_t`, in lengths of the direction.
    /// Returns the index of the path in the record.
    fn hit(&mut self, _path: &Path, _t: f32, _material: usize) -> usize {
        0
    }

    /// Receives a shadow ray from the surface that path `_parent` of the record hits.
    fn shadow(&mut self, _path: &Path, _parent: usize, _ray: &Ray, _blocked: bool) {}
}

/// A record that keeps nothing, for frames.
pub struct NoRecord;

impl Record for NoRecord {}

/// A record that keeps all rays, parents before children.
pub struct Rays<'a> {
    /// The names of the materials of the scene, by index.
    pub material_names: &'a [String],
    /// The rays so far; an index into them is the number of a path.
    pub rays: Vec<TracedRay>,
}

impl Rays<'_> {
    fn push(&mut self, path: &Path, hit: Option<(f32, String)>) -> usize {
        let Path { ray, weight, depth, kind, parent, .. } = *path;
        self.rays.push(TracedRay {
            kind,
            parent,
            depth,
            weight,
            origin: ray.origin,
            direction: ray.direction,
            hit,
        });
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
