//! Meshes before they are placed: subdivided, with their normals, and curved surfaces made of triangles. The
//! number of instances of each mesh is counted here as well.

use super::WorldFunctions;
use super::facets::Facet;
use crate::effects::Effects;
use crate::mesh::Mesh;
use crate::scene::{Node, Scene, SceneMesh};
use crate::shape::{BezierPatch, Shape};
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// A mesh that can be placed in the world: subdivided and with its normals.
pub(super) struct PreparedMesh {
    /// Positions, triangles and texture coordinates, in the space of the mesh.
    pub mesh: Arc<Mesh>,
    /// Unit normals at the corners of each triangle; empty for a mesh that is shaded flat.
    pub normals: Vec<[Vec3; 3]>,
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
            let (mesh, normals) = prepared(source, smooth, functions);
            PreparedMesh {
                normals,
                mesh,
                materials: source.materials.clone(),
                one_sided: source.one_sided && functions.one_sided,
                shared: shared(places.of_meshes[index]),
                shared_mesh: None,
            }
        });
        let surface = |(index, node): (usize, &Node)| {
            let (mesh, normals) = match &node.shape {
                Some(Shape::Bezier { patch, steps }) => {
                    let parameters = spread(&[[0.0, 1.0]], *steps);
                    let point = functions.bezier_point?;
                    let corner = patch.rows[0][0];
                    let near = BezierPatch { rows: patch.rows.map(|row| row.map(|point| point - corner)) };
                    surface_mesh([&parameters, &parameters], |uv| point(patch, uv), |uv| point(&near, uv))
                }
                Some(Shape::Nurbs { patch, steps }) => {
                    let [across, along] = [0, 1].map(|axis| spread(&patch.spans(axis), *steps));
                    let point = functions.nurbs_point?;
                    let (mut near, corner) = (patch.clone(), patch.rows[0][0]);
                    near.rows.iter_mut().flatten().for_each(|point| *point -= corner);
                    surface_mesh([&across, &along], |uv| point(patch, uv), |uv| point(&near, uv))
                }
                _ => return None,
            };
            let ready = PreparedMesh {
                normals: at_corners(&mesh.triangles, &normals),
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

/// The mesh, subdivided as often as the scene asks, and the normals at the corners of its triangles if it is smooth: those of
/// the file if the mesh is that of the file, otherwise averages; none if there is no function for them.
fn prepared(source: &SceneMesh, smooth: bool, functions: &WorldFunctions) -> (Arc<Mesh>, Vec<[Vec3; 3]>) {
    let file = &source.mesh;
    let average = |shape: &Mesh| match functions.vertex_normals {
        Some(average) if smooth => at_corners(&shape.triangles, &average(shape)),
        _ => Vec::new(),
    };
    match functions.subdivide {
        Some(subdivide) if source.subdivisions > 0 => {
            let (shape, shown) = subdivided(source, subdivide);
            let normals = average(&shape);
            (Arc::new(shown.unwrap_or(shape)), normals)
        }
        _ if smooth && !file.normals.is_empty() => (file.clone(), at_corners(&file.triangles, &file.normals)),
        _ if source.places.is_empty() && source.groups.is_empty() => (file.clone(), average(file)),
        _ => (file.clone(), average(&joined(source, &source.groups))),
    }
}

/// The values at the corners of triangles of a table with one value per vertex; none if an entry is missing.
fn at_corners<T: Copy>(triangles: &[[u32; 3]], values: &[T]) -> Vec<[T; 3]> {
    let at = |&[a, b, c]: &[u32; 3]| {
        let value = |vertex: u32| values.get(vertex as usize).copied();
        Some([value(a)?, value(b)?, value(c)?])
    };
    triangles.iter().map(at).collect::<Option<_>>().unwrap_or_default()
}

/// The positions and triangles alone: vertices at the same place are one vertex where their triangles belong to the same of
/// the `groups`, which are as in [`SceneMesh::groups`].
fn joined(source: &SceneMesh, groups: &[u32]) -> Mesh {
    let file = &source.mesh;
    let (mut mesh, mut numbers) = (Mesh::default(), HashMap::new());
    for (face, triangle) in file.triangles.iter().enumerate() {
        let group = groups.get(face).copied().unwrap_or(1);
        // A flat triangle shares its vertices with no other.
        let alone = if group == 0 { face } else { 0 };
        mesh.triangles.push(triangle.map(|vertex| {
            let place = source.places.get(vertex as usize).copied().unwrap_or(vertex);
            *numbers.entry((place, group, alone)).or_insert_with(|| {
                mesh.positions.push(file.positions[vertex as usize]);
                mesh.positions.len() as u32 - 1
            })
        }));
    }
    mesh
}

/// The mesh of `source` after its steps of subdivision: its shape, in which all triangles at a place share a vertex, and the
/// mesh that is shown if it has materials or texture coordinates. The triangles of both are in the same order.
///
/// The function of stage 8 gets the shape alone, because its vertices can have one pair of texture coordinates each. It passes
/// on the material of each triangle, and here the number of the triangle stands in its place. From this follow the material and
/// the texture coordinates of each new triangle.
fn subdivided(source: &SceneMesh, subdivide: fn(&Mesh) -> Mesh) -> (Mesh, Option<Mesh>) {
    let file = &source.mesh;
    let mut shape = joined(source, &[]);
    let mut uvs = at_corners(&file.triangles, &file.uvs);
    let mut materials = file.face_materials.clone();
    for _ in 0..source.subdivisions {
        let parents: Vec<u32> = (0..shape.triangles.len() as u32).collect();
        let coarse = Mesh { face_materials: parents, ..shape };
        shape = subdivide(&coarse);
        let parents = std::mem::take(&mut shape.face_materials);
        uvs = divided_uvs(&coarse, &shape, &parents, &uvs);
        materials = parents.iter().filter_map(|&parent| materials.get(parent as usize).copied()).collect();
    }
    if uvs.is_empty() && materials.is_empty() {
        return (shape, None);
    }
    let mut shown =
        Mesh { face_materials: materials, material_names: file.material_names.clone(), ..shape.clone() };
    if !uvs.is_empty() {
        // Each corner gets a vertex of its own.
        shown.positions = (0..shape.triangles.len()).flat_map(|face| shape.corners(face)).collect();
        shown.triangles = (0..uvs.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
        shown.uvs = uvs.into_flattened();
    }
    (shape, Some(shown))
}

/// The texture coordinates at the corners of the triangles of `fine`, which come from the `parents` in `coarse`: an old vertex
/// keeps those of its corner, and a vertex on an edge has the mean of its ends. None if a vertex is neither.
fn divided_uvs(coarse: &Mesh, fine: &Mesh, parents: &[u32], uvs: &[[Vec2; 3]]) -> Vec<[Vec2; 3]> {
    // Find the vertex on each edge: in the triangle at an old vertex, the next vertex is on the edge that begins there.
    let mut on_edges = vec![[u32::MAX; 3]; coarse.triangles.len()];
    for (triangle, &parent) in fine.triangles.iter().zip(parents) {
        let Some(old) = coarse.triangles.get(parent as usize) else { return Vec::new() };
        for (corner, vertex) in old.iter().enumerate() {
            if let Some(here) = triangle.iter().position(|one| one == vertex) {
                on_edges[parent as usize][corner] = triangle[(here + 1) % 3];
            }
        }
    }
    let of_triangle = |(triangle, &parent): (&[u32; 3], &u32)| {
        let (parent, old, on_edges) =
            (uvs.get(parent as usize)?, coarse.triangles[parent as usize], on_edges[parent as usize]);
        let at = |vertex: u32| match old.iter().position(|&one| one == vertex) {
            Some(corner) => Some(parent[corner]),
            None => {
                let edge = on_edges.iter().position(|&one| one == vertex)?;
                Some(0.5 * (parent[edge] + parent[(edge + 1) % 3]))
            }
        };
        Some([at(triangle[0])?, at(triangle[1])?, at(triangle[2])?])
    };
    fine.triangles.iter().zip(parents).map(of_triangle).collect::<Option<_>>().unwrap_or_default()
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
/// there are two or more each, and its normal at each of these points. The triangles are anticlockwise where `∂u × ∂v` points
/// to the viewer. The texture coordinates run from 0 to 1 over the parameters.
///
/// The normals are those of the surface and not averages over triangles: then neighbouring surfaces that continue each other
/// smoothly have the same normals where they meet. They are computed from `near`, the same surface moved to the origin, where
/// points have smaller rounding errors.
fn surface_mesh(
    parameters: [&[f32]; 2],
    point: impl Fn(Vec2) -> Vec3,
    near: impl Fn(Vec2) -> Vec3,
) -> (Mesh, Vec<Vec3>) {
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
    let mesh = Mesh {
        positions: grid().map(point).collect(),
        uvs: grid().map(|uv| (uv - start) / (end - start)).collect(),
        triangles: squares.collect(),
        ..Mesh::default()
    };
    // A sixteenth of a square: for 8 squares per quarter of a circle the difference has an error of 5e-5, from the third
    // derivative as much as from rounding.
    let step = (end - start) / (16.0 * Vec2::new(columns as f32 - 1.0, rows as f32 - 1.0));
    let normals = grid().map(|uv| normal_of_surface(&near, uv, step, [start, end])).collect();
    (mesh, normals)
}

/// The unit normal `∂u × ∂v` of a surface at `uv`, from differences over `step`.
fn normal_of_surface(point: impl Fn(Vec2) -> Vec3, uv: Vec2, step: Vec2, [start, end]: [Vec2; 2]) -> Vec3 {
    let normal = |uv: Vec2| {
        let [along_u, along_v] = [Vec2::X, Vec2::Y].map(|axis| {
            let step = step * axis;
            let at = |steps: f32| point(uv + steps * step).as_dvec3();
            let fits = |steps: f32| {
                let moved = uv + steps * step;
                moved.clamp(start, end) == moved
            };
            // At an end of the domain use the two points on the one side. Both differences have an error of second order.
            match (fits(-1.0), fits(1.0)) {
                (true, true) => at(1.0) - at(-1.0),
                (false, _) => 4.0 * at(1.0) - at(2.0) - 3.0 * at(0.0),
                (true, false) => 3.0 * at(0.0) + at(-2.0) - 4.0 * at(-1.0),
            }
        });
        // Where an edge is drawn together in a point, a derivative is nothing but rounding errors.
        let (lengths, cross) = (along_u.length() * along_v.length(), along_u.cross(along_v));
        let is_point = along_u.length().min(along_v.length()) < 1e-3 * along_u.length().max(along_v.length());
        (!is_point && cross.length() > 1e-6 * lengths).then(|| cross.normalize().as_vec3())
    };
    // At such a point take the normal close to it, in the direction of the middle.
    let inside = uv + step * (0.5 * (start + end) - uv).signum();
    normal(uv).or_else(|| normal(inside)).unwrap_or(Vec3::Z)
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
        let uvs = (!self.mesh.uvs.is_empty()).then(|| vertices.map(|vertex| self.mesh.uvs[vertex as usize]));
        Facet { corners: self.mesh.corners(face), normals: self.normals.get(face).copied(), uvs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    /// The normals of an eighth of a sphere are its points, also at the pole, where all points of an edge are one. The bounds
    /// are the errors of the differences, and one step away from the pole.
    #[test]
    fn a_surface_has_its_own_normals() {
        let point = |uv: Vec2| {
            let (longitude, latitude) = (FRAC_PI_2 * uv.x, FRAC_PI_2 * uv.y);
            let around = Vec3::new(longitude.cos(), 0.0, -longitude.sin());
            latitude.cos() * around + latitude.sin() * Vec3::Y
        };
        let parameters = spread(&[[0.0, 1.0]], 8);
        let (mesh, normals) = surface_mesh([&parameters, &parameters], point, point);
        for (point, normal) in mesh.positions.iter().zip(normals) {
            let bound = if point.y > 0.9999 { 1.01 * FRAC_PI_2 / 128.0 } else { 3e-4 };
            assert!((*point - normal).length() < bound, "{normal} at {point}");
        }
    }

    /// A square with a seam of texture coordinates along its diagonal, and a function that divides it without moving it.
    #[test]
    fn texture_coordinates_follow_the_triangles() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::ZERO, Vec3::X + Vec3::Y, Vec3::Y];
        // The second triangle has its own part of the image: one unit further.
        let uvs = positions.iter().enumerate().map(|(i, p)| p.truncate() + (i / 3) as f32).collect();
        let mesh = Mesh { positions, uvs, triangles: vec![[0, 1, 2], [3, 4, 5]], ..Mesh::default() };
        let source = SceneMesh {
            mesh: Arc::new(mesh),
            places: vec![0, 1, 2, 0, 2, 3],
            subdivisions: 2,
            ..SceneMesh::default()
        };
        // Each edge gets a vertex of its own per triangle, and the triangles come in another order.
        let divide = |mesh: &Mesh| {
            let (mut positions, mut triangles, mut parents) =
                (mesh.positions.clone(), Vec::new(), Vec::new());
            for (&[a, b, c], &parent) in mesh.triangles.iter().zip(&mesh.face_materials).rev() {
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                    positions.push(0.5 * (mesh.positions[p as usize] + mesh.positions[q as usize]));
                    positions.len() as u32 - 1
                });
                triangles.extend([[bc, ca, ab], [b, bc, ab], [a, ab, ca], [bc, c, ca]]);
                parents.extend([parent; 4]);
            }
            Mesh { positions, triangles, face_materials: parents, ..Mesh::default() }
        };
        let (shape, shown) = subdivided(&source, divide);
        let shown = shown.expect("a mesh with texture coordinates");
        assert_eq!((shape.triangles.len(), shown.triangles.len()), (32, 32));
        for triangle in &shown.triangles {
            let at = |vertex: u32| shown.uvs[vertex as usize] - shown.positions[vertex as usize].truncate();
            let [a, b, c] = triangle.map(at);
            assert!(a == b && b == c && (a == Vec2::ZERO || a == Vec2::ONE), "{a} {b} {c}");
        }
    }
}
