//! The shapes that a scene shows: those that can be reached from its roots, each with its materials.

use super::{Node, Scene};
use crate::shape::Shape;
use glam::Vec3;
use std::collections::BTreeSet;

/// A shape that the scene shows, with the materials and the motion that it has there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Index of the node that holds the shape, in [`Scene::nodes`].
    pub node: usize,
    /// Index of the mesh in [`Scene::meshes`], if the shape is a mesh.
    pub mesh: Option<usize>,
    /// Indices into [`Scene::materials`] of the materials of the shape, in ascending order, each once.
    pub materials: Vec<usize>,
    /// Whether the transform of the node, or of a node above it, differs between shutter times 0 and 1.
    pub moves: bool,
}

impl Scene {
    /// Every shape that is reached from a root, depth first, once for each combination of inherited material
    /// and motion.
    ///
    /// A node with many places is listed once per combination, so the time does not grow with the number of
    /// its places.
    ///
    /// # Panics
    ///
    /// If an index of the scene into its nodes or meshes is out of range. A scene that [`crate::files::scene`]
    /// has read has no such index.
    pub fn shown(&self) -> Vec<Shown> {
        let mut walk = Walk { scene: self, seen: BTreeSet::new(), shown: Vec::new() };
        for &root in &self.roots {
            walk.node(root, 0, false);
        }
        walk.shown
    }

    /// The indices of all materials that are shown and emit light, in ascending order, each once.
    ///
    /// # Panics
    ///
    /// If an index of the scene into its nodes, meshes or materials is out of range.
    pub fn emitters(&self) -> Vec<usize> {
        let emits = |material: &usize| self.materials[*material].emission != Vec3::ZERO;
        let materials = self.shown().into_iter().flat_map(|shape| shape.materials).filter(emits);
        materials.collect::<BTreeSet<usize>>().into_iter().collect()
    }

    fn materials_of(&self, shape: &Shape, otherwise: usize) -> Vec<usize> {
        let Shape::Mesh(index) = shape else { return vec![otherwise] };
        let mesh = &self.meshes[*index];
        if mesh.mesh.face_materials.is_empty() || mesh.materials.is_empty() {
            return vec![otherwise];
        }
        let names: BTreeSet<u32> = mesh.mesh.face_materials.iter().copied().collect();
        let materials: BTreeSet<usize> = names
            .iter()
            .map(|name| mesh.materials.get(*name as usize).copied().unwrap_or(otherwise))
            .collect();
        materials.into_iter().collect()
    }
}

struct Walk<'a> {
    scene: &'a Scene,
    /// The nodes that were visited, each with the material that it inherits and whether a node above it
    /// moves. So a node with a million places is visited a few times only.
    seen: BTreeSet<(usize, usize, bool)>,
    shown: Vec<Shown>,
}

impl Walk<'_> {
    fn node(&mut self, index: usize, material: usize, moves: bool) {
        if !self.seen.insert((index, material, moves)) {
            return;
        }
        let node: &Node = &self.scene.nodes[index];
        let material = node.material.unwrap_or(material);
        let moves = moves || node.transform_end.is_some_and(|end| end != node.transform);
        if let Some(shape) = &node.shape {
            let mesh = if let Shape::Mesh(mesh) = shape { Some(*mesh) } else { None };
            let materials = self.scene.materials_of(shape, material);
            self.shown.push(Shown { node: index, mesh, materials, moves });
        }
        for &child in &node.children {
            self.node(child, material, moves);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::files::scene::parse;
    use std::path::Path;

    #[test]
    fn materials_are_inherited_and_motion_is_passed_on() {
        let text = r#"
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
[materials.red]
diffuse = [1, 0, 0]
[materials.unused]
mirror = 1
[[nodes]]
name = "sphere"
shape = { sphere = { center = [0, 0, 0], radius = 1 } }
[[nodes]]
material = "red"
children = ["sphere"]
transform_end = [{ translate = [1, 0, 0] }]
[[nodes]]
children = ["sphere"]
"#;
        let scene = parse(Path::new("test.toml"), text).expect("a scene");
        let shown: Vec<_> = scene.shown().into_iter().map(|s| (s.node, s.materials, s.moves)).collect();
        assert_eq!(shown, [(0, vec![1], true), (0, vec![0], false)]);
    }
}
