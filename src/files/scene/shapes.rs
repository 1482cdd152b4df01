//! Reads `shape = { … }` of a node. Shapes that no ray can hit are refused, because they are mistakes.

use super::names::Names;
use super::nurbs;
use super::reader::{Table, Value};
use crate::files::error::LoadError;
use crate::geometry::triangulate::{self, Cut, area_vector};
use crate::mesh::Mesh;
use crate::scene::SceneMesh;
use crate::shape::{
    BezierPatch, Cone, Cuboid, Cylinder, Disk, Plane, PlaneEquation, Polygon, Shape, Sphere, Triangle,
};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// All kinds of shapes: exactly one of these keys must stand in `shape`.
pub(super) const KINDS: [&str; 12] = [
    "sphere", "plane", "triangle", "box", "cylinder", "cone", "disk", "polygon", "bezier", "bspline",
    "nurbs", "mesh",
];

/// The shape of a node in the space of the node; `meshes` are the names that `mesh` may refer to. Fails if a
/// value is missing or out of range, or if the shape is degenerate or exceeds the range of `f32`.
///
/// A polygon that is not convex becomes a mesh, which is added to `all_meshes`: the ray test for polygons, an exercise,
/// is for convex ones.
pub(super) fn shape(
    value: Value,
    meshes: &Names,
    all_meshes: &mut Vec<SceneMesh>,
) -> Result<Shape, LoadError> {
    let kind = value.table(&KINDS)?.one_of(&KINDS)?;
    let shape = match kind.key {
        "sphere" => Shape::Sphere(sphere(kind)?),
        "plane" => plane(kind)?,
        "triangle" => Shape::Triangle(triangle(kind)?),
        "box" => Shape::Cuboid(cuboid(kind)?),
        "cylinder" => Shape::Cylinder(cylinder(kind)?),
        "cone" => Shape::Cone(cone(kind)?),
        "disk" => Shape::Disk(disk(kind)?),
        "bezier" => bezier(kind)?,
        "bspline" | "nurbs" => nurbs::nurbs(kind)?,
        "polygon" => match polygon(kind, all_meshes)? {
            mesh @ Shape::Mesh(_) => return Ok(mesh),
            convex => convex,
        },
        _ => return Ok(Shape::Mesh(meshes.find(kind)?)),
    };
    match shape.bounds(&[]) {
        Some(bounds) if !(bounds.min.is_finite() && bounds.max.is_finite()) => {
            Err(kind.error(format!("{} exceeds the largest number, 3.4e38", kind.name())))
        }
        _ => Ok(shape),
    }
}

/// A sphere from its `center` and its `radius`, which must be above 0.
pub(super) fn sphere(value: Value) -> Result<Sphere, LoadError> {
    let table = value.table(&["center", "radius"])?;
    Ok(Sphere { center: point(&table, "center")?, radius: radius(&table)? })
}

/// A plane by a point and a normal, or by the coefficients of its equation.
fn plane(value: Value) -> Result<Shape, LoadError> {
    let table = value.table(&["point", "normal", "coefficients"])?;
    let Some(coefficients) = table.get("coefficients") else {
        return Ok(Shape::Plane(Plane { point: point(&table, "point")?, normal: normal(&table)? }));
    };
    if let Some(other) = table.get("point").or(table.get("normal")) {
        let message = format!("`plane` has both `coefficients` and `{}`", other.key);
        return Err(other.error(message).help("give `point` and `normal`, or `coefficients` alone"));
    }
    let [a, b, c, d] = coefficients.numbers("four numbers")?;
    let equation = PlaneEquation { normal: Vec3::new(a, b, c), d };
    if equation.normal == Vec3::ZERO {
        let message = "the first three of `coefficients` are 0, so they give no plane";
        return Err(coefficients
            .error(message)
            .help("A x + B y + C z + D = 0: write, for example, [0, 1, 0, -2]"));
    }
    // The transforms of the scene use a point of the plane.
    match equation.to_plane().point.is_finite() {
        true => Ok(Shape::PlaneEquation(equation)),
        false => Err(coefficients.error("the plane is farther away than the largest number, 3.4e38")),
    }
}

/// A triangle. Slivers and tiny triangles are accepted; corners exactly on one line are not.
fn triangle(value: Value) -> Result<Triangle, LoadError> {
    let table = value.table(&["a", "b", "c"])?;
    let [a, b, c] = [point(&table, "a")?, point(&table, "b")?, point(&table, "c")?];
    let [edge, other] = [b, c].map(|corner| corner.as_dvec3() - a.as_dvec3());
    match edge.cross(other).length_squared() == 0.0 {
        true => Err(table.error("the corners of `triangle` lie on one line, so no ray can hit it")),
        false => Ok(Triangle { a, b, c }),
    }
}

/// A box, which may be flat along one axis; that makes it a rectangle.
fn cuboid(value: Value) -> Result<Cuboid, LoadError> {
    let table = value.table(&["min", "max"])?;
    let [min, max] = [point(&table, "min")?, point(&table, "max")?];
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if min[axis] > max[axis] {
            let (min, max) = (min[axis], max[axis]);
            let message = format!("`min` of `box` is {min} along {name}, which is above `max`, {max}");
            return Err(table.error(message).help("exchange the two numbers"));
        }
    }
    match min.cmpeq(max).bitmask().count_ones() {
        0 | 1 => Ok(Cuboid { min, max }),
        _ => Err(table.error("`box` is flat along more than one axis, so no ray can hit it")),
    }
}

fn cylinder(value: Value) -> Result<Cylinder, LoadError> {
    let table = value.table(&["base", "top", "radius"])?;
    let (base, top) = ends(&table, "base", "top")?;
    Ok(Cylinder { base, top, radius: radius(&table)? })
}

fn cone(value: Value) -> Result<Cone, LoadError> {
    let table = value.table(&["base", "apex", "radius"])?;
    let (base, apex) = ends(&table, "base", "apex")?;
    Ok(Cone { base, apex, radius: radius(&table)? })
}

/// A disk from its `center`, its `normal`, which is scaled to unit length, and its `radius`, which must be
/// above 0.
pub(super) fn disk(value: Value) -> Result<Disk, LoadError> {
    let table = value.table(&["center", "normal", "radius"])?;
    Ok(Disk { center: point(&table, "center")?, normal: normal(&table)?, radius: radius(&table)? })
}

/// A Bézier patch. A net that is partly folded together is accepted, because teapots have such nets; a net of
/// a single point is not.
fn bezier(value: Value) -> Result<Shape, LoadError> {
    let table = value.table(&["rows", "steps"])?;
    let list = table.need("rows", "four rows of four points")?;
    let mut patch = BezierPatch { rows: [[Vec3::ZERO; 4]; 4] };
    for (row, row_value) in patch.rows.iter_mut().zip(list.list_of(4, "four rows of four points")?) {
        for (point, point_value) in row.iter_mut().zip(row_value.list_of(4, "four points")?) {
            *point = point_value.vector()?;
        }
    }
    let corner = patch.rows[0][0];
    if patch.rows.as_flattened().iter().all(|point| *point == corner) {
        return Err(list.error("all points of the net are the same, so no ray can hit the surface"));
    }
    let steps = table.get("steps").map_or(Ok(16), |steps| steps.whole(1..=1024))?;
    let place = table.get("steps").unwrap_or(value);
    value.source.budget.triangles(|why| place.error(why), 2 * u64::from(steps).pow(2))?;
    Ok(Shape::Bezier { patch: Box::new(patch), steps })
}

/// A polygon. A concave one becomes a mesh; a polygon whose outline crosses itself becomes a fan, with a warning.
fn polygon(value: Value, meshes: &mut Vec<SceneMesh>) -> Result<Shape, LoadError> {
    let corners = polygon_corners(value)?;
    let triangles: Vec<[usize; 3]> = match triangulate::cut(&corners) {
        Cut::Fan => return Ok(Shape::Polygon(Polygon { corners })),
        Cut::Triangles(triangles) => triangles,
        Cut::Crossed => {
            let warning =
                value.error("the outline of the polygon crosses itself, so its triangles are a guess");
            value.warn(
                warning.help("list the corners in order around the polygon, or divide it into several"),
            );
            triangulate::fan(corners.len()).collect()
        }
    };
    value.source.budget.triangles(|why| value.error(why), triangles.len() as u64)?;
    let triangles = triangles.into_iter().map(|triangle| triangle.map(|corner| corner as u32)).collect();
    let mesh = Mesh { positions: corners, triangles, ..Mesh::default() };
    meshes.push(SceneMesh { mesh: Arc::new(mesh), ..SceneMesh::default() });
    Ok(Shape::Mesh(meshes.len() - 1))
}

fn point(table: &Table, key: &str) -> Result<Vec3, LoadError> {
    table.need(key, "[0, 0, 0]")?.vector()
}

/// A normal, scaled to unit length, so that the square of a very short one does not vanish.
fn normal(table: &Table) -> Result<Vec3, LoadError> {
    table.need("normal", "[0, 1, 0]")?.direction()
}

fn radius(table: &Table) -> Result<f32, LoadError> {
    table.need("radius", "1.0")?.positive()
}

/// The two points of an axis, which must differ.
fn ends(table: &Table, from: &str, to: &str) -> Result<(Vec3, Vec3), LoadError> {
    let start = table.need(from, "[0, 0, 0]")?.vector()?;
    let end_value = table.need(to, "[0, 1, 0]")?;
    let end = end_value.vector()?;
    match start == end {
        true => Err(end_value.error(format!("`{from}` and `{to}` are the same point"))),
        false => Ok((start, end)),
    }
}

/// The largest distance of a corner from the plane, relative to the size of the polygon: corners written with
/// five digits are that far away.
const FLATNESS: f64 = 1e-5;

/// The corners of a polygon, at least three and in order. Fails if two neighbours are the same point, if all
/// lie on one line, or if one lies outside of the common plane.
fn polygon_corners(value: Value) -> Result<Vec<Vec3>, LoadError> {
    let list = value.table(&["corners"])?.need("corners", "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]")?;
    let items = list.list("a list of points")?;
    if items.len() < 3 {
        return Err(
            list.error(format!("a polygon has three corners or more, and this one has {}", items.len()))
        );
    }
    let corners: Vec<Vec3> = items.iter().map(Value::vector).collect::<Result<_, _>>()?;
    let exact: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let after = |index: usize| (index + 1) % corners.len();
    if let Some(index) = (0..corners.len()).find(|&index| corners[index] == corners[after(index)]) {
        let message = format!("corners {} and {} are the same point", index + 1, after(index) + 1);
        return Err(items[after(index)].error(message));
    }

    let Some(normal) = area_vector(&exact).try_normalize() else {
        return Err(list.error("the corners lie on one line, so no ray can hit the polygon"));
    };
    if let Some(index) = first_corner_off_plane(&exact, normal) {
        return Err(items[index]
            .error(format!("corner {} does not lie in the plane of the polygon", index + 1))
            .help("divide the polygon into triangles"));
    }
    Ok(corners)
}

/// The first corner that is too far from the plane through the mean of all corners.
fn first_corner_off_plane(corners: &[DVec3], normal: DVec3) -> Option<usize> {
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let size = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
    // Allow for the rounding of the coordinates to `f32` as well, which matters far from the origin.
    let largest = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    let tolerance = FLATNESS * size + f64::from(f32::EPSILON) * largest;
    corners.iter().position(|corner| (corner - middle).dot(normal).abs() > tolerance)
}
