//! `shape = { … }` of a node. Shapes of which a ray could hit nothing are refused: they are slips.

use super::names::Names;
use super::polygon;
use super::reader::{Table, Value};
use crate::scene::error::LoadError;
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Plane, Polygon, Shape, Sphere, Triangle};
use glam::Vec3;

/// All that may stand in `shape`.
pub(super) const KINDS: [&str; 9] =
    ["sphere", "plane", "triangle", "box", "cylinder", "cone", "disk", "polygon", "mesh"];

pub(super) fn shape(value: Value, meshes: &Names) -> Result<Shape, LoadError> {
    let kind = value.table(&KINDS)?.one_of(&KINDS)?;
    let shape = match kind.key {
        "sphere" => Shape::Sphere(sphere(kind)?),
        "plane" => Shape::Plane(plane(kind)?),
        "triangle" => Shape::Triangle(triangle(kind)?),
        "box" => Shape::Cuboid(cuboid(kind)?),
        "cylinder" => Shape::Cylinder(cylinder(kind)?),
        "cone" => Shape::Cone(cone(kind)?),
        "disk" => Shape::Disk(disk(kind)?),
        "polygon" => Shape::Polygon(Polygon { corners: polygon::corners(kind)? }),
        _ => return Ok(Shape::Mesh(meshes.find(kind)?)),
    };
    match shape.bounds(&[]) {
        Some(bounds) if !(bounds.min.is_finite() && bounds.max.is_finite()) => {
            Err(kind.error(format!("{} reaches beyond the largest number, 3.4e38", kind.name())))
        }
        _ => Ok(shape),
    }
}

pub(super) fn sphere(value: Value) -> Result<Sphere, LoadError> {
    let table = value.table(&["center", "radius"])?;
    Ok(Sphere { center: point(&table, "center")?, radius: radius(&table)? })
}

fn plane(value: Value) -> Result<Plane, LoadError> {
    let table = value.table(&["point", "normal"])?;
    Ok(Plane { point: point(&table, "point")?, normal: normal(&table)? })
}

/// Slivers and tiny triangles are fine; corners exactly on one line are not.
fn triangle(value: Value) -> Result<Triangle, LoadError> {
    let table = value.table(&["a", "b", "c"])?;
    let [a, b, c] = [point(&table, "a")?, point(&table, "b")?, point(&table, "c")?];
    let [edge, other] = [b, c].map(|corner| corner.as_dvec3() - a.as_dvec3());
    match edge.cross(other).length_squared() == 0.0 {
        true => Err(table.error("the corners of `triangle` lie on one line, so no ray can hit it")),
        false => Ok(Triangle { a, b, c }),
    }
}

/// A box may be flat along one axis, which makes it a rectangle.
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

pub(super) fn disk(value: Value) -> Result<Disk, LoadError> {
    let table = value.table(&["center", "normal", "radius"])?;
    Ok(Disk { center: point(&table, "center")?, normal: normal(&table)?, radius: radius(&table)? })
}

fn point(table: &Table, key: &str) -> Result<Vec3, LoadError> {
    table.need(key, "[0, 0, 0]")?.vector()
}

/// Of unit length, so that no square of a very short normal vanishes.
fn normal(table: &Table) -> Result<Vec3, LoadError> {
    table.need("normal", "[0, 1, 0]")?.direction()
}

fn radius(table: &Table) -> Result<f32, LoadError> {
    table.need("radius", "1.0")?.positive()
}

/// Two points that differ.
fn ends(table: &Table, from: &str, to: &str) -> Result<(Vec3, Vec3), LoadError> {
    let start = table.need(from, "[0, 0, 0]")?.vector()?;
    let end_value = table.need(to, "[0, 1, 0]")?;
    let end = end_value.vector()?;
    match start == end {
        true => Err(end_value.error(format!("`{from}` and `{to}` are the same point"))),
        false => Ok((start, end)),
    }
}
