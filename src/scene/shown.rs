//! The shapes that a scene shows: those that can be reached from its roots, each with its materials.

use super::{Node, Scene};
use crate::shape::Shape;
use glam::{Affine3A, DAffine3, Vec3};
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
    /// Whether the product of the transforms from the root to the node differs between shutter times 0 and 1. Motions that
    /// cancel each other, up to rounding, are no motion.
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
        let mut walk = Walk {
            scene: self,
            moves_below: vec![None; self.nodes.len()],
            seen: BTreeSet::new(),
            listed: BTreeSet::new(),
            shown: Vec::new(),
        };
        for &root in &self.roots {
            walk.node(root, 0, &Motion::None);
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

    /// Whether a node has a surface that is drawn with curves.
    pub fn has_curved_surface(&self) -> bool {
        self.nodes.iter().any(|node| matches!(node.shape, Some(Shape::Bezier { .. } | Shape::Nurbs { .. })))
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
    /// For each node that was asked for, whether a node below it has two transforms.
    moves_below: Vec<Option<bool>>,
    /// The nodes that were visited, each with the material that it inherits and the motion above it. So a node with a
    /// million places is visited a few times only.
    seen: BTreeSet<(usize, usize, Vec<u64>)>,
    /// The nodes that were listed, each with its material and whether it moves.
    listed: BTreeSet<(usize, usize, bool)>,
    shown: Vec<Shown>,
}

impl Walk<'_> {
    fn node(&mut self, index: usize, material: usize, above: &Motion) {
        if !self.seen.insert((index, material, above.key())) {
            return;
        }
        let node: &Node = &self.scene.nodes[index];
        let material = node.material.unwrap_or(material);
        let motion = self.motion(index, above);
        let moves = !matches!(motion, Motion::None);
        if let Some(shape) = &node.shape
            && self.listed.insert((index, material, moves))
        {
            let mesh = if let Shape::Mesh(mesh) = shape { Some(*mesh) } else { None };
            let materials = self.scene.materials_of(shape, material);
            self.shown.push(Shown { node: index, mesh, materials, moves });
        }
        for &child in &node.children {
            self.node(child, material, &motion);
        }
    }

    /// The motion of the space of a node, whose parent has the motion `above`.
    fn motion(&mut self, index: usize, above: &Motion) -> Motion {
        let node: &Node = &self.scene.nodes[index];
        let moves = node.transform_end.is_some_and(|end| end != node.transform);
        let product = match above {
            Motion::Any => return Motion::Any,
            Motion::None if !moves => return Motion::None,
            Motion::None => Product::of(node),
            Motion::Product(above) => match above.times(&Product::of(node)) {
                None => return Motion::None,
                Some(product) => product,
            },
        };
        // Only a node below that moves as well can undo the motion.
        match self.moves_below(index) && self.seen.len() < MOST_VISITS {
            true => Motion::Product(Box::new(product)),
            false => Motion::Any,
        }
    }

    fn moves_below(&mut self, index: usize) -> bool {
        if let Some(known) = self.moves_below[index] {
            return known;
        }
        let scene = self.scene;
        let moves = |child: &usize| scene.nodes[*child].transform_end.is_some() || self.moves_below(*child);
        let below = scene.nodes[index].children.iter().any(moves);
        self.moves_below[index] = Some(below);
        below
    }
}

/// After so many visits, a motion that a node below could undo counts as motion: the picture is the same and costs more.
const MOST_VISITS: usize = 10_000;

/// How the space of a node moves while the shutter is open.
enum Motion {
    /// It stands still.
    None,
    /// It moves, and nodes below it may undo that.
    Product(Box<Product>),
    /// It moves, and so does everything below it.
    Any,
}

impl Motion {
    /// Numbers that differ between different motions.
    fn key(&self) -> Vec<u64> {
        match self {
            Motion::None => Vec::new(),
            Motion::Any => vec![0],
            Motion::Product(product) => {
                [product.0, product.1].iter().flat_map(|at| at.to_cols_array().map(f64::to_bits)).collect()
            }
        }
    }
}

/// The product of the transforms of several nodes at shutter times 0 and 1. A frame blends these two.
struct Product(DAffine3, DAffine3);

impl Product {
    fn of(node: &Node) -> Product {
        let double = |at: &Affine3A| DAffine3::from_cols_array(&at.to_cols_array().map(f64::from));
        Product(double(&node.transform), double(node.transform_end.as_ref().unwrap_or(&node.transform)))
    }

    /// The product of these transforms and those of a node below; `None` if both are equal up to the error of transforms
    /// in single precision.
    fn times(&self, below: &Product) -> Option<Product> {
        let (start, end) = (self.0 * below.0, self.1 * below.1);
        let error = f64::from(f32::EPSILON);
        let size = self.1.translation.length() + (self.1.matrix3 * below.1.translation).length();
        let turned = start.matrix3 - end.matrix3;
        let is_still = (start.translation - end.translation).length()
            <= error * (size + start.translation.length())
            && (0..3).all(|axis| turned.col(axis).length() <= error * start.matrix3.col(axis).length());
        (!is_still).then_some(Product(start, end))
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

    #[test]
    fn motions_are_compared_as_products() {
        let moves = |parent: &str, child: &str| {
            let text = format!(
                "camera = {{ position = [0, 0, 5], look_at = [0, 0, 0] }}\n\
                 [[nodes]]\nname = 'sphere'\nshape.sphere = {{ center = [0, 0, 0], radius = 1 }}\ntransform_end = [{child}]\n\
                 [[nodes]]\nname = 'between'\nchildren = ['sphere']\ntransform = [{{ scale = 3 }}]\n\
                 [[nodes]]\nchildren = ['between']\ntransform_end = [{parent}]\n"
            );
            parse(Path::new("test.toml"), &text).expect("a scene").shown()[0].moves
        };
        let turn = "{ rotate = { axis = [1, 2, 3], degrees = 360 } }";
        assert!(moves("{ translate = [1, 0, 0] }", "{ translate = [-1, 0, 0] }"));
        assert!(!moves("{ translate = [1, 0, 0] }", "{ translate = [-0.333333333, 0, 0] }"));
        assert!(!moves("{ scale = 2 }", "{ scale = 0.5 }"));
        assert!(!moves(turn, "") && !moves("", turn));
        assert!(moves("{ scale = 2 }", "") && moves("", "{ translate = [0, 1e-30, 0] }"));
    }
}
