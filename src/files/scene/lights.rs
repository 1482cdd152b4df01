//! Reads `[[lights]]`: point lights, spot lights, directional lights and area lights.

use super::reader::Value;
use super::shapes::{disk, sphere};
use crate::files::error::LoadError;
use crate::material::{AreaShape, Cone, Emitter, Falloff, Light, Material};
use crate::scene::{ColorPlace, Node, Scene, VisibleLight};
use glam::Vec3;

const KEYS: [&str; 8] = ["point", "spot", "directional", "area", "color", "intensity", "shadows", "visible"];

/// The lights of a scene.
#[derive(Default)]
pub(super) struct Lights {
    /// All lights of `[[lights]]` in the order of the file, in world space.
    pub list: Vec<Light>,
    /// The indices of those that are visible.
    visible: Vec<usize>,
}

/// The lights of `[[lights]]`, seen by a camera at this position; fails if a value is missing or out of range, if a rectangle has no area, or if a light
/// without an area is to be visible.
pub(super) fn lights(value: Option<Value>, camera: Vec3) -> Result<Lights, LoadError> {
    let mut lights = Lights::default();
    let Some(value) = value else { return Ok(lights) };
    for (index, value) in value.list("a list of tables, each under `[[lights]]`")?.into_iter().enumerate() {
        let (light, visible) = light(value, index, camera)?;
        lights.list.push(light);
        lights.visible.extend(visible.then_some(index));
    }
    Ok(lights)
}

/// Adds a node for each visible light, after all others: its shape, with a black material that emits the radiance of the
/// light.
pub(super) fn show(scene: &mut Scene, lights: &Lights) {
    for &index in &lights.visible {
        let light = &scene.lights[index];
        let Emitter::Area { shape, .. } = &light.emitter else { continue };
        let name = format!("light {}", index + 1);
        let (ambient, diffuse) = (Vec3::ZERO, Vec3::ZERO);
        let material =
            Material { ambient, diffuse, emission: light.visible_radiance(), ..Material::default() };
        let number = scene.materials.len();
        let shape = Some(shape.to_shape());
        scene.visible_lights.push(VisibleLight { light: index, material: number });
        scene.roots.push(scene.nodes.len());
        scene.nodes.push(Node { name: name.clone(), shape, material: Some(number), ..Node::default() });
        scene.materials.push(material);
        scene.material_names.push(name);
    }
}

/// A light, and whether it is visible.
fn light(value: Value, index: usize, camera: Vec3) -> Result<(Light, bool), LoadError> {
    let table = value.table(&KEYS)?;
    let emitter = table.one_of(&["point", "spot", "directional", "area"])?;
    let light = Light {
        cone: if emitter.key == "spot" { Some(cone(emitter)?) } else { None },
        emitter: match emitter.key {
            "point" => point(emitter, &["position", "falloff"])?,
            "spot" => point(emitter, &SPOT_KEYS)?,
            "directional" => {
                let table = emitter.table(&["direction"])?;
                Emitter::Directional { direction: table.need("direction", "[0, -1, 0]")?.direction()? }
            }
            _ => area(emitter)?,
        },
        color: table.get("color").map_or(Ok(Vec3::ONE), |color| color.color(ColorPlace::Light(index)))?,
        intensity: table.get("intensity").map_or(Ok(1.0), |intensity| intensity.not_negative())?,
        shadows: table.get("shadows").map_or(Ok(true), |shadows| shadows.truth())?,
    };
    let visible = match table.get("visible") {
        Some(visible) if visible.truth()? => visible,
        _ => return Ok((or_point(light, emitter, camera), false)),
    };
    let Emitter::Area { shape, .. } = &light.emitter else {
        let message = format!("a {} light has no surface that a ray could hit", emitter.key);
        return Err(visible.error(message).help("only area lights can be visible: delete the key"));
    };
    if !shape.to_shape().bounds(&[]).is_some_and(|bounds| bounds.min.is_finite() && bounds.max.is_finite()) {
        return Err(emitter.error("the light exceeds the largest number, 3.4e38, so it cannot be visible"));
    }
    match light.visible_radiance().is_finite() {
        true => Ok((light, true)),
        false => Err(visible
            .error("the light is so small or so strong that its radiance exceeds the largest number, 3.4e38")
            .help("make it larger, or its intensity lower")),
    }
}

/// The light, or a point light at its centre if its extent is nothing beside its distance from the camera.
fn or_point(light: Light, value: Value, camera: Vec3) -> Light {
    let Emitter::Area { shape, falloff } = &light.emitter else { return light };
    let position = shape.center();
    let extent = match shape {
        AreaShape::Rectangle { edges: (u, v), .. } => u.length().max(v.length()),
        AreaShape::Disk(disk) => disk.radius,
        AreaShape::Sphere(sphere) => sphere.radius,
    };
    match value.or_nothing(extent, position.distance(camera), "the light shines from one point") {
        0.0 => Light { emitter: Emitter::Point { position, falloff: *falloff }, ..light },
        _ => light,
    }
}

fn point(value: Value, keys: &[&str]) -> Result<Emitter, LoadError> {
    let table = value.table(keys)?;
    Ok(Emitter::Point {
        position: table.need("position", "[0, 5, 0]")?.vector()?,
        falloff: falloff(table.get("falloff"))?,
    })
}

const SPOT_KEYS: [&str; 5] = ["position", "direction", "angle", "edge", "falloff"];

/// The cone of a spot light. Its light is full up to `angle - edge` from the axis, and ends at `angle`.
fn cone(value: Value) -> Result<Cone, LoadError> {
    let table = value.table(&SPOT_KEYS)?;
    let angle = table.need("angle", "30")?;
    let degrees = angle.number_that("above 0, up to 180 degrees", |angle| 0.0 < angle && angle <= 180.0)?;
    let edge = table.get("edge").map_or(Ok(0.0), |edge| {
        edge.number_that(&format!("from 0 to `angle`, {degrees}"), |edge| (0.0..=degrees).contains(&edge))
    })?;
    // At 180 degrees the cone is the whole sphere, also for a cosine that is rounded to less than -1.
    let cosine = |degrees: f32| if degrees == 180.0 { f32::MIN } else { degrees.to_radians().cos() };
    Ok(Cone {
        axis: table.need("direction", "[0, -1, 0]")?.direction()?,
        full: cosine(degrees - edge),
        none: cosine(degrees),
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
