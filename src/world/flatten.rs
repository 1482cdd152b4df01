//! Down the scene graph: transforms are multiplied, shapes become primitives, and what moves is kept at both ends of
//! its way.

use super::facets::{self, Facet};
use super::{EndlessPlane, Geometry, Primitive, Slot, VertexNormals, World, what_is_not_simulated};
use crate::effects::Effects;
use crate::scene::{Node, Scene, SceneMesh, blend};
use crate::shape::{Plane, Shape, Sphere, Triangle};
use glam::{Affine3A, Mat3, Mat3A, Vec2, Vec3};

pub(super) fn flatten(scene: &Scene, effects: &Effects, vertex_normals: Option<&VertexNormals<'_>>) -> World {
    let smooth = |(index, mesh)| match effects.smooth_meshes.get(index) {
        Some(true) => normals_of(mesh, vertex_normals),
        _ => Vec::new(),
    };
    let mut flattener = Flattener {
        scene,
        effects,
        // What does not move while the shutter is open stands where it is when it opens.
        still_at: scene.camera.shutter.map_or(0.0, |shutter| shutter.open),
        mesh_normals: scene.meshes.iter().enumerate().map(smooth).collect(),
        world: World {
            materials: scene.materials.clone(),
            lights: scene.lights.clone(),
            textures: scene.textures.clone(),
            notes: what_is_not_simulated(scene),
            ..World::default()
        },
    };
    for &root in &scene.roots {
        flattener.node(&scene.nodes[root], &Way::still(Affine3A::IDENTITY), 0);
    }
    flattener.world
}

fn normals_of(mesh: &SceneMesh, vertex_normals: Option<&VertexNormals<'_>>) -> Vec<Vec3> {
    match vertex_normals {
        _ if !mesh.mesh.normals.is_empty() => mesh.mesh.normals.clone(),
        Some(average) => average(&mesh.mesh),
        None => Vec::new(),
    }
}

/// Where something is: to the world at time 0, and at time 1 if it moves.
struct Way {
    start: Affine3A,
    end: Option<Affine3A>,
}

impl Way {
    fn still(start: Affine3A) -> Way {
        Way { start, end: None }
    }

    fn then(&self, node: &Node) -> Way {
        let moves = self.end.is_some() || node.transform_end.is_some();
        let end = || self.end.unwrap_or(self.start) * node.transform_end.unwrap_or(node.transform);
        Way { start: self.start * node.transform, end: moves.then(end) }
    }
}

struct Flattener<'a> {
    scene: &'a Scene,
    effects: &'a Effects,
    still_at: f32,
    mesh_normals: Vec<Vec<Vec3>>,
    world: World,
}

impl Flattener<'_> {
    /// Adds `node` and all below it. `way` belongs to its parent, `material` is inherited.
    fn node(&mut self, node: &Node, way: &Way, material: usize) {
        let way = way.then(node);
        let material = node.material.unwrap_or(material);
        if let Some(shape) = &node.shape {
            let way = match way.end {
                Some(end) if self.effects.motion && end != way.start => Way { end: Some(end), ..way },
                Some(end) => Way::still(blend(&way.start, &end, self.still_at)),
                None => Way::still(way.start),
            };
            self.shape(shape, &way, material as u32);
        }
        for &child in &node.children {
            self.node(&self.scene.nodes[child], &way, material);
        }
    }

    fn shape(&mut self, shape: &Shape, way: &Way, material: u32) {
        match shape {
            Shape::Sphere(sphere) => self.sphere(sphere, way, material),
            Shape::Plane(plane) => self.plane(plane, way, material),
            Shape::Triangle(t) => {
                let uvs = Some([Vec2::ZERO, Vec2::X, Vec2::Y]);
                self.facets(&[Facet { corners: [t.a, t.b, t.c], normals: None, uvs }], way, material);
            }
            Shape::Polygon(polygon) => self.facets(&facets::polygon(&polygon.corners), way, material),
            Shape::Cuboid(cuboid) => self.facets(&facets::cuboid(cuboid), way, material),
            Shape::Cylinder(cylinder) => self.facets(&facets::cylinder(cylinder), way, material),
            Shape::Cone(cone) => self.facets(&facets::cone(cone), way, material),
            Shape::Disk(disk) => self.facets(&facets::disk(disk), way, material),
            Shape::Mesh(index) => self.mesh(*index, way, material),
        }
    }

    /// A sphere stays one as long as it is not stretched, not even halfway.
    fn sphere(&mut self, sphere: &Sphere, way: &Way, material: u32) {
        let at = |to_world: &Affine3A| {
            let radius = uniform_scale(to_world)? * sphere.radius;
            Some(Sphere { center: to_world.transform_point3(sphere.center), radius })
        };
        let start = at(&way.start);
        let ends = way.end.map(|end| (at(&end), at(&blend(&way.start, &end, 0.5))));
        let (start, end) = match (start, ends) {
            (Some(start), None) => (start, None),
            // A turning sphere would shrink on its way, since matrices are blended entry by entry.
            (Some(start), Some((Some(end), Some(half))))
                if (2.0 * half.radius - start.radius - end.radius).abs() <= 1e-5 * half.radius =>
            {
                (start, Some(Geometry::Sphere(end)))
            }
            _ => return self.facets(&facets::sphere(sphere), way, material),
        };
        let image = match self.reads_image(material) {
            true => {
                let own = Mat3::from(way.start.matrix3).transpose();
                Slot::push(&mut self.world.ball_axes, own)
            }
            false => Slot::NONE,
        };
        let end = end.map_or(Slot::NONE, |end| Slot::push(&mut self.world.ends, end));
        let geometry = Geometry::Sphere(start);
        self.world.primitives.push(Primitive { geometry, material, normals: Slot::NONE, image, end });
    }

    fn plane(&mut self, plane: &Plane, way: &Way, material: u32) {
        let (u, v) = plane_axes(plane.normal);
        let corners = |to_world: &Affine3A| {
            let a = to_world.transform_point3(plane.point);
            let [b, c] = [u, v].map(|axis| a + to_world.transform_vector3(axis));
            // A mirroring transform would turn the plane inside out.
            let mirrored = to_world.matrix3.determinant() < 0.0;
            if mirrored { Triangle { a, b: c, c: b } } else { Triangle { a, b, c } }
        };
        let normal = (normal_matrix(&way.start) * plane.normal.normalize()).normalize();
        let point = way.start.transform_point3(plane.point);
        self.world.planes.push(EndlessPlane {
            plane: Plane { point, normal },
            material,
            axes: [u, v].map(|axis| way.start.transform_vector3(axis)),
            motion: way.end.map(|end| [corners(&way.start), corners(&end)]),
        });
    }

    fn facets(&mut self, facets: &[Facet], way: &Way, material: u32) {
        for facet in facets {
            self.triangle(facet, way, material);
        }
    }

    fn mesh(&mut self, index: usize, way: &Way, material: u32) {
        let SceneMesh { mesh, materials, .. } = &self.scene.meshes[index];
        for (face, vertices) in mesh.triangles.iter().enumerate() {
            let own = mesh.face_materials.get(face).and_then(|&name| materials.get(name as usize));
            let normals = &self.mesh_normals[index];
            let normals = (!normals.is_empty()).then(|| vertices.map(|vertex| normals[vertex as usize]));
            let uvs = (!mesh.uvs.is_empty()).then(|| vertices.map(|vertex| mesh.uvs[vertex as usize]));
            let facet = Facet { corners: mesh.corners(face), normals, uvs };
            self.triangle(&facet, way, own.map_or(material, |&own| own as u32));
        }
    }

    fn triangle(&mut self, facet: &Facet, way: &Way, material: u32) {
        let world = &mut self.world;
        let corners = |to_world: &Affine3A| {
            let [a, b, c] = facet.corners.map(|corner| to_world.transform_point3(corner));
            Geometry::Triangle(Triangle { a, b, c })
        };
        let mut normals = Slot::NONE;
        if let Some(own) = facet.normals {
            let carried = |to_world: &Affine3A| {
                let matrix = normal_matrix(to_world);
                own.map(|normal| (matrix * normal).normalize_or_zero())
            };
            normals = Slot::push(&mut world.normals, carried(&way.start));
            if let Some(end) = &way.end {
                world.normals.push(carried(end));
            }
        }
        let end = way.end.map_or(Slot::NONE, |end| Slot::push(&mut world.ends, corners(&end)));
        let uvs = facet.uvs.filter(|_| self.effects.materials[material as usize].texture);
        let image = uvs.map_or(Slot::NONE, |uvs| Slot::push(&mut world.uvs, uvs));
        let geometry = corners(&way.start);
        world.primitives.push(Primitive { geometry, material, normals, image, end });
    }

    fn reads_image(&self, material: u32) -> bool {
        self.effects.materials[material as usize].texture
    }
}

/// Two unit vectors at right angles to `normal` and each other, `u × v` along it. On the floor they are x and -z, so that
/// an image lies upright for who looks along -z.
fn plane_axes(normal: Vec3) -> (Vec3, Vec3) {
    let normal = normal.normalize();
    // Any axis far from the normal will do; x for floors and ceilings, y for walls.
    let u = if normal.y.abs() > 0.5 { Vec3::X } else { Vec3::Y.cross(normal).normalize() };
    let u = (u - u.dot(normal) * normal).normalize();
    (u, normal.cross(u))
}

/// Carries normals to the world: the inverse transpose, up to a positive factor, so that a mirrored transform keeps
/// the outside outside.
fn normal_matrix(to_world: &Affine3A) -> Mat3A {
    to_world.matrix3.inverse().transpose()
}

/// The factor by which a transform scales, if it scales all directions alike to a few roundings.
fn uniform_scale(to_world: &Affine3A) -> Option<f32> {
    let gram = to_world.matrix3.transpose() * to_world.matrix3;
    let squared = gram.x_axis.x;
    // Each entry of the product sums three rounded products: 1e-5 leaves room for rotations and for nothing visible.
    let alike = (gram - Mat3A::from_diagonal(Vec3::splat(squared))).to_cols_array();
    alike.iter().all(|entry| entry.abs() <= 1e-5 * squared).then(|| squared.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_plane_stand_at_right_angles() {
        for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::Z, Vec3::new(1.0, 2.0, -3.0)] {
            let (u, v) = plane_axes(normal);
            assert!((u.cross(v) - normal.normalize()).length() < 1e-6, "{normal}");
        }
        assert_eq!(plane_axes(Vec3::Y), (Vec3::X, Vec3::NEG_Z));
    }

    #[test]
    fn a_turning_sphere_is_no_sphere_halfway() {
        let turned = Affine3A::from_rotation_y(2.0);
        assert!(uniform_scale(&turned).is_some());
        let half = uniform_scale(&blend(&Affine3A::IDENTITY, &turned, 0.5));
        assert!(half.is_none_or(|scale| scale < 0.9), "{half:?}");
    }
}
