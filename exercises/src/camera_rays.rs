//! Nothing to do here: rays from the camera, and whatever else is drawn at random, through the functions of stage 6.

use crate::stage6_distribution::{
    between, develop, gaussian_weight, gloss, jittered, lens_ray, on_disk, on_lamp_disk, on_rectangle,
    pixel_position, temporal_slot, time_in_shutter, toward_ball,
};
use glam::{Vec2, Vec3, uvec2};
use raykata::camera::Camera;
use raykata::frame::CameraSample;
use raykata::kit::{Bounce, Child, LightSample, Surface, WeightedColor};
use raykata::material::{AreaShape, Emitter, Light};
use raykata::random::{Points, Purpose, Stratum};
use raykata::ray::Ray;
use raykata::scene::Sampler;
use raykata::shape::{Plane, Sphere, Triangle};
use raykata::world::{EndlessPlane, Geometry, Primitive, World};

/// What makes rays out of samples.
pub struct Eye {
    pub camera: Camera,
    pub sampler: Sampler,
    /// Width and height of the film in pixels.
    pub film: Vec2,
    /// Whether samples have places of their own in the pixel.
    pub positions: bool,
    /// Whether the samples of a pixel are weighted.
    pub weights: bool,
}

impl Eye {
    /// The ray of a sample.
    #[inline(always)]
    pub fn ray(&self, sample: &CameraSample) -> Ray {
        let on_film = (uvec2(sample.column, sample.row).as_vec2() + self.place(sample)) / self.film;
        let mut ray = self.camera.ray(on_film.x, on_film.y);
        if let (Some(lens), Some(stratum)) = (&self.camera.lens, &sample.lens) {
            ray = lens_ray(&self.camera, &ray, lens, on_disk(jittered(stratum)));
        }
        ray.time = self.time(sample);
        ray
    }

    /// How much a sample counts in its pixel.
    #[inline(always)]
    pub fn weight(&self, sample: &CameraSample) -> f32 {
        match self.sampler {
            Sampler::Gaussian if self.weights => gaussian_weight(self.place(sample) - 0.5),
            _ => 1.0,
        }
    }

    /// Where in its pixel a sample lies.
    #[inline(always)]
    fn place(&self, sample: &CameraSample) -> Vec2 {
        match &sample.pixel {
            None => Vec2::splat(0.5),
            Some(stratum) if self.positions => pixel_position(self.sampler, stratum),
            Some(stratum) => stratum.u,
        }
    }

    #[inline(always)]
    fn time(&self, sample: &CameraSample) -> f32 {
        let Some(shutter) = &self.camera.shutter else { return 0.0 };
        let Some(stratum) = &sample.time else { return shutter.open };
        let (slot, slots) = match (self.sampler, &sample.pixel) {
            // The cells of all pixels together are one large grid, which the table covers.
            (Sampler::Jittered | Sampler::Gaussian, Some(Stratum { cell, grid, .. })) => {
                let cell = uvec2(sample.column, sample.row) * *grid + *cell;
                (temporal_slot(cell.x, cell.y), 16)
            }
            _ => (1, 1),
        };
        time_in_shutter(shutter, slot, slots, stratum.u.x)
    }

    /// The colour that the samples of a pixel make.
    #[inline(always)]
    pub fn develop(&self, samples: &[WeightedColor]) -> Vec3 {
        match samples {
            [only] => only.color,
            _ if self.weights => develop(samples),
            _ => samples.iter().map(|sample| sample.color).sum::<Vec3>() / samples.len() as f32,
        }
    }
}

/// The light from part `part` of `parts` of an area light: its share of the whole.
pub fn from_area(
    light: &Light,
    shape: &AreaShape,
    at: &Surface,
    points: &Points,
    index: usize,
    part: u32,
    parts: u32,
) -> LightSample {
    let u = jittered(&points.stratum(Purpose::Light(index as u32), part, parts));
    let sample = match shape {
        AreaShape::Rectangle { corner, edges } => {
            light.from_place(on_rectangle(*corner, *edges, u), at.point)
        }
        AreaShape::Disk(disk) => light.from_place(on_lamp_disk(disk, u), at.point),
        AreaShape::Sphere(ball) => light.from_ball(ball, toward_ball(ball, at.point, u), at.point),
    };
    LightSample { radiance: sample.radiance / parts as f32, ..sample }
}

/// The outline of an area light.
pub fn outline(light: &Light) -> Option<&AreaShape> {
    match &light.emitter {
        Emitter::Area { shape, .. } => Some(shape),
        Emitter::Point { .. } | Emitter::Directional { .. } => None,
    }
}

/// Part `part` of `parts` of the rays that a rough surface makes of `child`: its share of the weight.
pub fn blurred(child: &Child, at: &Surface, roughness: f32, points: &Points, part: u32, parts: u32) -> Child {
    let u = jittered(&points.stratum(Purpose::Gloss(child.bounce), part, parts));
    let side = match child.bounce {
        Bounce::Reflection => at.geometric_normal,
        Bounce::Transmission => -at.geometric_normal,
    };
    let direction = gloss(child.direction, side, roughness, u);
    Child { direction, weight: child.weight / parts as f32, ..*child }
}

/// Where a primitive is at `time`.
#[inline]
pub fn geometry_at(world: &World, primitive: &Primitive, time: f32) -> Geometry {
    match primitive.end.get() {
        None => primitive.geometry,
        Some(end) => moved(&primitive.geometry, &world.ends[end], time),
    }
}

#[cold]
fn moved(start: &Geometry, end: &Geometry, time: f32) -> Geometry {
    match (start, end) {
        (Geometry::Sphere(start), Geometry::Sphere(end)) => Geometry::Sphere(Sphere {
            center: between(start.center, end.center, time),
            radius: between(Vec3::splat(start.radius), Vec3::splat(end.radius), time).x,
        }),
        (Geometry::Triangle(start), Geometry::Triangle(end)) => {
            Geometry::Triangle(triangle_between(start, end, time))
        }
        _ => *start, // A primitive keeps its kind, and solids stand still.
    }
}

fn triangle_between(start: &Triangle, end: &Triangle, time: f32) -> Triangle {
    Triangle {
        a: between(start.a, end.a, time),
        b: between(start.b, end.b, time),
        c: between(start.c, end.c, time),
    }
}

/// Where a plane is at `time`, and the axes of its texture.
pub fn plane_at(plane: &EndlessPlane, time: f32) -> (Plane, [Vec3; 2]) {
    match &plane.motion {
        None => (plane.plane, plane.axes),
        Some([start, end]) => {
            let Triangle { a, b, c } = triangle_between(start, end, time);
            let axes = [b - a, c - a];
            (Plane { point: a, normal: axes[0].cross(axes[1]).normalize() }, axes)
        }
    }
}
