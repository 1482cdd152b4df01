//! The picture of stage 8: two instances of a tower, a house, a pond and a gate.

use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;
use glam::{Affine3A, Quat};
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};
use std::f32::consts::TAU;

/// One of the solids of this stage.
#[derive(Clone, Debug)]
enum Solid {
    Cuboid(Cuboid),
    Cylinder(Cylinder),
    Cone(Cone),
    Disk(Disk),
    Polygon(Polygon),
}

/// A solid with its colour, below the nodes with these transforms from the root down.
#[derive(Clone, Debug)]
struct Part {
    path: Vec<Affine3A>,
    solid: Solid,
    color: Vec3,
}

fn at(place: Vec3) -> Affine3A {
    Affine3A::from_translation(place)
}

fn turned(angle: f32, scale: Vec3, place: Vec3) -> Affine3A {
    Affine3A::from_scale_rotation_translation(scale, Quat::from_rotation_y(angle), place)
}

/// A tower in a space of its own.
fn tower() -> Vec<(Solid, Vec3)> {
    let (stone, roof) = (vec3(0.75, 0.68, 0.55), vec3(0.75, 0.2, 0.12));
    let wall = Cylinder { base: Vec3::ZERO, top: 1.6 * Vec3::Y, radius: 0.5 };
    let gallery = Cylinder { base: 1.15 * Vec3::Y, top: 1.3 * Vec3::Y, radius: 0.6 };
    let cone = Cone { base: 1.6 * Vec3::Y, apex: 2.6 * Vec3::Y, radius: 0.68 };
    vec![(Solid::Cylinder(wall), stone), (Solid::Cylinder(gallery), 0.8 * stone), (Solid::Cone(cone), roof)]
}

/// The scene: `turn` turns it around the vertical axis, `stretch` is the height of the second tower.
fn parts(turn: f32, stretch: f32) -> Vec<Part> {
    let scene = turned(turn, Vec3::ONE, Vec3::ZERO);
    let towers = [
        turned(0.4, vec3(0.9, 1.1, 0.9), vec3(-1.5, 0.0, -0.3)),
        // Another size along each axis: its normals need the transpose of the inverse.
        turned(0.8, vec3(0.6, stretch, 1.0), vec3(1.6, 0.0, -0.6)),
    ];
    let mut parts: Vec<Part> = Vec::new();
    for place in towers {
        let part = |(solid, color): (Solid, Vec3)| Part { path: vec![scene, place], solid, color };
        parts.extend(tower().into_iter().map(part));
    }
    let (grass, water) = (vec3(0.25, 0.45, 0.2), vec3(0.2, 0.4, 0.7));
    let house = Cuboid { min: vec3(-0.7, 0.0, -0.4), max: vec3(0.7, 0.75, 0.4) };
    let chimney = Cuboid { min: vec3(0.3, 0.7, -0.15), max: vec3(0.5, 1.3, 0.05) };
    let gable = |z: f32| vec![vec3(-0.8, 0.72, z), vec3(0.8, 0.72, z), vec3(0.0, 1.4, z)];
    let roof = |side: f32| {
        let eaves = |z: f32| vec3(side * 0.8, 0.72, z);
        let ridge = |z: f32| vec3(0.0, 1.4, z);
        vec![eaves(0.5), eaves(-0.5), ridge(-0.5), ridge(0.5)]
    };
    let home = turned(-0.5, Vec3::ONE, vec3(0.0, 0.0, 0.1));
    let mut add = |path: &[Affine3A], solid: Solid, color: Vec3| {
        let path = std::iter::once(scene).chain(path.iter().copied()).collect();
        parts.push(Part { path, solid, color });
    };
    let hexagon = (0..6).map(|i| (f32::from(i as u8) / 6.0 * TAU).sin_cos());
    let hexagon = hexagon.map(|(sin, cos)| vec3(cos, 0.02, sin)).collect();
    add(&[home], Solid::Cuboid(house), vec3(0.85, 0.8, 0.65));
    add(&[home], Solid::Cuboid(chimney), vec3(0.6, 0.3, 0.22));
    add(&[home], Solid::Polygon(Polygon { corners: gable(0.42) }), vec3(0.9, 0.85, 0.7));
    add(&[home], Solid::Polygon(Polygon { corners: roof(1.0) }), vec3(0.7, 0.3, 0.15));
    add(&[home], Solid::Polygon(Polygon { corners: roof(-1.0) }), vec3(0.7, 0.3, 0.15));
    add(&[at(vec3(0.3, 0.0, 1.5))], Solid::Polygon(Polygon { corners: hexagon }), vec3(0.8, 0.75, 0.6));
    let pond = Disk { center: vec3(0.0, 0.04, 0.0), normal: 2.0 * Vec3::Y, radius: 0.75 };
    add(&[turned(0.3, vec3(1.0, 1.0, 0.8), vec3(0.3, 0.0, 1.5))], Solid::Disk(pond), water);
    add(&[], Solid::Disk(Disk { center: Vec3::ZERO, normal: Vec3::Y, radius: 3.6 }), grass);
    parts
}

/// The hits of rays with a solid in its own space.
fn hits(kit: &dyn Kit, rays: &[Ray], solid: &Solid) -> Vec<Option<SolidHit>> {
    fn queries<S: Clone>(rays: &[Ray], solid: &S) -> Vec<SolidQuery<S>> {
        rays.iter().map(|ray| SolidQuery { ray: *ray, solid: solid.clone() }).collect()
    }
    match solid {
        Solid::Cuboid(solid) => kit.cuboid(&queries(rays, solid)),
        Solid::Cylinder(solid) => kit.cylinder(&queries(rays, solid)),
        Solid::Cone(solid) => kit.cone(&queries(rays, solid)),
        Solid::Disk(solid) => kit.disk(&queries(rays, solid)),
        Solid::Polygon(solid) => kit.polygon(&queries(rays, solid)),
    }
}

fn colors(kit: &dyn Kit, rays: &[Ray], parts: &[Part]) -> Vec<Vec3> {
    let light = vec3(0.5, 0.8, 0.65).normalize();
    let mut nearest: Vec<(f32, Vec3)> =
        rays.iter().map(|ray| (f32::INFINITY, vec3(0.5, 0.62, 0.8) * (1.0 + ray.direction.y))).collect();
    let placements = kit.placement(&parts.iter().map(|part| part.path.clone()).collect::<Vec<_>>());
    for (part, placement) in parts.iter().zip(placements) {
        // A part that cannot be placed is missing in the picture.
        let Some(placement) = placement else { continue };
        let to_object = placement.to_object;
        let queries: Vec<ObjectRayQuery> =
            rays.iter().map(|&ray| ObjectRayQuery { ray, to_object }).collect();
        let hits = hits(kit, &kit.ray_to_object(&queries), &part.solid);
        let seen = hits.into_iter().enumerate().filter_map(|(pixel, hit)| Some((pixel, hit?)));
        let seen: Vec<(usize, SolidHit)> = seen.filter(|(pixel, hit)| hit.t < nearest[*pixel].0).collect();
        let normals: Vec<NormalQuery> =
            seen.iter().map(|(_, hit)| NormalQuery { normal: hit.normal, to_object }).collect();
        for ((pixel, hit), normal) in seen.into_iter().zip(kit.normal_to_world(&normals)) {
            // A disk and a polygon are seen from either side.
            let is_flat = matches!(part.solid, Solid::Disk(_) | Solid::Polygon(_));
            let is_behind = is_flat && normal.dot(rays[pixel].direction) > 0.0;
            let facing = if is_behind { -normal } else { normal };
            nearest[pixel] = (hit.t, part.color * (0.3 + 0.7 * facing.dot(light).max(0.0)));
        }
    }
    nearest.into_iter().map(|(_, color)| color).collect()
}

pub(super) fn picture_of_placed_solids(trial: &Trial<'_>) -> CheckResult {
    let (turn, stretch) = trial.composed((0.15, 0.8), (-0.6..0.6f32, 0.5..1.2f32));
    let parts = parts(turn, stretch);
    let rays = picture::rays(trial, LARGE, vec3(0.4, 3.2, 6.6), vec3(0.0, 0.85, 0.0));
    // Outlines and edges cross about 700 of 4800 pixels. There rounding decides which part a ray hits; single precision is off
    // by less than a ten-thousandth of a pixel.
    let composed = Composed { name: "stage8_placed_solids", size: LARGE, rays: &rays, may_differ: 0.002 };
    composed.check(trial, |kit| colors(kit, &rays, &parts))
}
