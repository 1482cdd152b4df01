//! Meshes before they are placed: subdivided, with their normals, and curved surfaces made of triangles. The
//! number of instances of each mesh is counted here as well.

use super::WorldFunctions;
use super::facets::Facet;
use crate::effects::Effects;
use crate::mesh::Mesh;
use crate::scene::{Node, Scene, SceneMesh};
use crate::shape::Shape;
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// A mesh that can be placed in the world: subdivided and with its normals.
pub(super) struct PreparedMesh {
    /// Positions, triangles and texture coordinates, in the space of the mesh.
    pub mesh: Arc<Mesh>,
    /// One unit normal per vertex; empty for a mesh that is shaded flat.
    pub normals: Vec<Vec3>,
    /// For each of the mesh's own material names, the index of the material in the scene; empty if the mesh
    /// takes the material of its node.
    pub materials: Vec<usize>,
    /// Whether the triangles are hit from their front only.
    pub one_sided: bool,
    /// Whether the mesh is kept once and placed by instances.
    pub shared: bool,
    /// Index into [`super::World::shared_meshes`], once a first instance has been made.
    pub shared_mesh: Option<u32>,
}

/// All shapes that are meshes of triangles: the meshes of the scene, and its curved surfaces.
pub(super) struct Meshes {
    /// The meshes of the scene, with the indices that they have there.
    pub of_scene: Vec<PreparedMesh>,
    /// The curved surfaces, by the index of the node that shows the surface.
    pub of_nodes: HashMap<usize, PreparedMesh>,
}

impl Meshes {
    /// Subdivides the meshes of `scene`, computes normals where `effects` asks for smooth meshes, and divides
    /// curved surfaces into triangles, each as far as `functions` has the function for it.
    pub fn new(scene: &Scene, effects: &Effects, functions: &WorldFunctions) -> Meshes {
        let places = InstanceCounts::count(scene);
        let shared = |places: u64| places > 1 && !scene.quality.copies && functions.placement.is_some();
        let of_scene = scene.meshes.iter().enumerate().map(|(index, source)| {
            let smooth = effects.smooth_meshes.get(index) == Some(&true);
            let (mesh, is_new) = divided(source, functions);
            PreparedMesh {
                normals: if smooth { normals_of(&mesh, is_new, functions) } else { Vec::new() },
                mesh,
                materials: source.materials.clone(),
                one_sided: source.one_sided && functions.one_sided,
                shared: shared(places.of_meshes[index]),
                shared_mesh: None,
            }
        });
        let surface = |(index, node): (usize, &Node)| {
            let mesh = match &node.shape {
                Some(Shape::Bezier { patch, steps }) => {
                    let parameters = spread(&[[0.0, 1.0]], *steps);
                    let point = functions.bezier_point?;
                    surface_mesh([&parameters, &parameters], |uv| point(patch, uv))
                }
                Some(Shape::Nurbs { patch, steps }) => {
                    let [across, along] = [0, 1].map(|axis| spread(&patch.spans(axis), *steps));
                    let point = functions.nurbs_point?;
                    surface_mesh([&across, &along], |uv| point(patch, uv))
                }
                _ => return None,
            };
            let ready = PreparedMesh {
                normals: normals_of(&mesh, true, functions),
                mesh: Arc::new(mesh),
                materials: Vec::new(),
                one_sided: false,
                shared: shared(places.of_nodes[index]),
                shared_mesh: None,
            };
            Some((index, ready))
        };
        Meshes {
            of_scene: of_scene.collect(),
            of_nodes: scene.nodes.iter().enumerate().filter_map(surface).collect(),
        }
    }
}

/// The mesh, subdivided as often as the scene asks, and whether it differs from that in its file.
fn divided(source: &SceneMesh, functions: &WorldFunctions) -> (Arc<Mesh>, bool) {
    match functions.subdivide {
        Some(subdivide) if source.subdivisions > 0 => {
            let mut mesh = subdivide(&source.mesh);
            for _ in 1..source.subdivisions {
                mesh = subdivide(&mesh);
            }
            (Arc::new(mesh), true)
        }
        _ => (source.mesh.clone(), false),
    }
}

/// One normal per vertex: those of the file if the mesh is that of the file, otherwise averages; none if
/// there is no function for them.
fn normals_of(mesh: &Mesh, is_new: bool, functions: &WorldFunctions) -> Vec<Vec3> {
    match functions.vertex_normals {
        _ if !is_new && !mesh.normals.is_empty() => mesh.normals.clone(),
        Some(average) => average(mesh),
        None => Vec::new(),
    }
}

/// The parameters that divide each of the `spans`, of which each begins where the one before ends, into `steps` equal parts.
/// The ends of the spans are among them exactly.
fn spread(spans: &[[f32; 2]], steps: u32) -> Vec<f32> {
    let within = |&[start, end]: &[f32; 2]| {
        (0..steps).map(move |step| {
            let t = step as f32 / steps as f32;
            ((1.0 - t) * start + t * end).clamp(start, end)
        })
    };
    spans.iter().flat_map(within).chain(spans.last().map(|span| span[1])).collect()
}

/// A curved surface as squares of two triangles between its points at the `parameters` along `u` and along `v`, of which
/// there are two or more each. The triangles are anticlockwise where `∂u × ∂v` points to the viewer. The texture coordinates
/// run from 0 to 1 over the parameters.
fn surface_mesh(parameters: [&[f32]; 2], point: impl Fn(Vec2) -> Vec3) -> Mesh {
    let [columns, rows] = parameters.map(|list| list.len() as u32);
    let grid = || parameters[1].iter().flat_map(|&v| parameters[0].iter().map(move |&u| Vec2::new(u, v)));
    let [start, end] = [0, 1].map(|last: usize| {
        let at = |list: &[f32]| if last == 1 { list[list.len() - 1] } else { list[0] };
        Vec2::new(at(parameters[0]), at(parameters[1]))
    });
    let square = |row: u32, column: u32| {
        let [a, b] = [row * columns + column, (row + 1) * columns + column];
        [[a, a + 1, b + 1], [a, b + 1, b]]
    };
    let squares = (0..rows - 1).flat_map(|row| (0..columns - 1).flat_map(move |column| square(row, column)));
    Mesh {
        positions: grid().map(point).collect(),
        uvs: grid().map(|uv| (uv - start) / (end - start)).collect(),
        triangles: squares.collect(),
        ..Mesh::default()
    }
}

/// The number of instances of each node and of each mesh in the scene.
struct InstanceCounts {
    of_nodes: Vec<u64>,
    of_meshes: Vec<u64>,
}

impl InstanceCounts {
    fn count(scene: &Scene) -> InstanceCounts {
        // Go down from the roots: a child has an instance for each instance of each of its parents.
        let mut of_nodes = vec![0u64; scene.nodes.len()];
        for index in parents_first(scene) {
            if scene.roots.contains(&index) {
                of_nodes[index] += 1;
            }
            for &child in &scene.nodes[index].children {
                of_nodes[child] += of_nodes[index];
            }
        }
        // Add up the instances of the nodes that show each mesh.
        let mut of_meshes = vec![0; scene.meshes.len()];
        for (node, places) in scene.nodes.iter().zip(&of_nodes) {
            if let Some(Shape::Mesh(mesh)) = node.shape {
                of_meshes[mesh] += places;
            }
        }
        InstanceCounts { of_nodes, of_meshes }
    }
}

/// All nodes that are reached from a root, each before its children.
fn parents_first(scene: &Scene) -> Vec<usize> {
    fn visit(scene: &Scene, node: usize, seen: &mut [bool], order: &mut Vec<usize>) {
        if std::mem::replace(&mut seen[node], true) {
            return;
        }
        for &child in &scene.nodes[node].children {
            visit(scene, child, seen, order);
        }
        order.push(node);
    }
    let (mut seen, mut order) = (vec![false; scene.nodes.len()], Vec::new());
    for &root in &scene.roots {
        visit(scene, root, &mut seen, &mut order);
    }
    order.reverse();
    order
}

impl PreparedMesh {
    /// The index in the scene of the material of triangle `face`; `None` if it takes the material of its
    /// node.
    pub fn material_of(&self, face: usize) -> Option<u32> {
        let name = *self.mesh.face_materials.get(face)?;
        self.materials.get(name as usize).map(|&material| material as u32)
    }

    /// Triangle `face` with the normals and texture coordinates at its corners, if the mesh has them.
    ///
    /// # Panics
    ///
    /// If the mesh has no triangle `face`.
    pub fn facet(&self, face: usize) -> Facet {
        let vertices = self.mesh.triangles[face];
        let normals =
            (!self.normals.is_empty()).then(|| vertices.map(|vertex| self.normals[vertex as usize]));
        let uvs = (!self.mesh.uvs.is_empty()).then(|| vertices.map(|vertex| self.mesh.uvs[vertex as usize]));
        Facet { corners: self.mesh.corners(face), normals, uvs }
    }
}
