//! Reads `[[lights]]`: point lights, directional lights and area lights.

use super::reader::Value;
use super::shapes::{disk, sphere};
use crate::material::{AreaShape, Emitter, Falloff, Light};
use crate::scene::ColorPlace;
use crate::scene::error::LoadError;
use glam::Vec3;

const KEYS: [&str; 6] = ["point", "directional", "area", "color", "intensity", "shadows"];

/// All lights of `[[lights]]` in the order of the file, in world space; fails if a value is missing or out of
/// range, or if a rectangle has no area.
pub(super) fn lights(value: Option<Value>) -> Result<Vec<Light>, LoadError> {
    let Some(value) = value else { return Ok(Vec::new()) };
    let lights = value.list("a list of tables, each under `[[lights]]`")?;
    lights.into_iter().enumerate().map(|(index, value)| light(value, index)).collect()
}

fn light(value: Value, index: usize) -> Result<Light, LoadError> {
    let table = value.table(&KEYS)?;
    let emitter = table.one_of(&["point", "directional", "area"])?;
    Ok(Light {
        emitter: match emitter.key {
            "point" => point(emitter)?,
            "directional" => {
                let table = emitter.table(&["direction"])?;
                Emitter::Directional { direction: table.need("direction", "[0, -1, 0]")?.direction()? }
            }
            _ => area(emitter)?,
        },
        color: table.get("color").map_or(Ok(Vec3::ONE), |color| color.color(ColorPlace::Light(index)))?,
        intensity: table.get("intensity").map_or(Ok(1.0), |intensity| intensity.not_negative())?,
        shadows: table.get("shadows").map_or(Ok(true), |shadows| shadows.truth())?,
    })
}

fn point(value: Value) -> Result<Emitter, LoadError> {
    let table = value.table(&["position", "falloff"])?;
    Ok(Emitter::Point {
        position: table.need("position", "[0, 5, 0]")?.vector()?,
        falloff: falloff(table.get("falloff"))?,
    })
}

fn area(value: Value) -> Result<Emitter, LoadError> {
    let table = value.table(&["rectangle", "disk", "sphere", "falloff"])?;
    let outline = table.one_of(&["rectangle", "disk", "sphere"])?;
    let shape = match outline.key {
        "rectangle" => rectangle(outline)?,
        "disk" => AreaShape::Disk(disk(outline)?),
        _ => AreaShape::Sphere(sphere(outline)?),
    };
    Ok(Emitter::Area { shape, falloff: falloff(table.get("falloff"))? })
}

fn rectangle(value: Value) -> Result<AreaShape, LoadError> {
    let table = value.table(&["corner", "edges"])?;
    let corner = table.need("corner", "[0, 5, 0]")?.vector()?;
    let edges_value = table.need("edges", "[[1, 0, 0], [0, 0, 1]]")?;
    let edges = edges_value.list_of(2, "two edges of three numbers each")?;
    let (u, v) = (edges[0].vector()?, edges[1].vector()?);
    // In double precision the products of two `f32` are exact.
    if u.as_dvec3().cross(v.as_dvec3()).length_squared() == 0.0 {
        return Err(edges_value.error("the edges are parallel or zero, so the light has no area"));
    }
    Ok(AreaShape::Rectangle { corner, edges: (u, v) })
}

fn falloff(value: Option<Value>) -> Result<Falloff, LoadError> {
    let choices = [("none", Falloff::None), ("inverse_square", Falloff::InverseSquare)];
    value.map_or(Ok(Falloff::None), |value| value.choice(&choices))
}
