//! From the samples of a pixel to camera rays, and from their colours to the colour of the pixel, by the
//! functions of stage 6.

use super::driver::CameraSample;
use super::light::texture_filter::Cone;
use super::plan::Plan;
use crate::camera::Camera;
use crate::kit::{StudentFunctions, WeightedColor};
use crate::random::Stratum;
use crate::ray::Ray;
use crate::scene::{Sampler, Scene};
use crate::world::camera_for;
use glam::{Vec2, Vec3, uvec2};
use std::marker::PhantomData;

/// Makes camera rays from samples, and the colour of a pixel from the colours of its samples.
pub struct CameraSampler<F> {
    camera: Camera,
    sampler: Sampler,
    /// Width and height of the film in pixels.
    film: Vec2,
    /// Whether the student function `pixel_position` places samples in the pixel.
    positions: bool,
    /// Whether the samples of a pixel are weighted.
    weights: bool,
    /// The cone of each camera ray.
    cone: Cone,
    functions: PhantomData<F>,
}

impl<F: StudentFunctions> CameraSampler<F> {
    /// The sampler for the camera and the film of `scene`.
    pub fn new(scene: &Scene, plan: &Plan) -> Self {
        let camera = camera_for(scene);
        // The samples of a pixel share its width.
        let samples = scene.quality.samples_per_pixel.max(1) as f32;
        let pixel = 2.0 * camera.half_height / scene.film.height as f32 / samples.sqrt();
        CameraSampler {
            cone: match camera.orthographic {
                true => Cone { width: pixel, spread: 0.0 },
                false => Cone { width: 0.0, spread: pixel },
            },
            camera,
            sampler: scene.quality.sampler,
            film: uvec2(scene.film.width, scene.film.height).as_vec2(),
            positions: plan.positions,
            weights: plan.weights,
            functions: PhantomData,
        }
    }

    /// The camera ray of a sample in world space, through the pixel position, the lens and the shutter time
    /// that the sample draws. Without a shutter its time is 0; without a drawn time it is the time at which
    /// the shutter opens.
    #[inline(always)]
    pub fn ray(&self, sample: &CameraSample) -> Ray {
        let on_film = (uvec2(sample.column, sample.row).as_vec2() + self.place(sample)) / self.film;
        let mut ray = self.camera.ray(on_film.x, on_film.y);
        if let (Some(lens), Some(stratum)) = (&self.camera.lens, &sample.lens) {
            ray = F::lens_ray(&self.camera, &ray, lens, F::sample_disk(F::jittered(stratum)));
        }
        ray.time = self.time(sample);
        ray
    }

    /// The cone that a camera ray stands for: as wide as a pixel in the middle of the film, divided by the root of the number
    /// of samples.
    #[inline(always)]
    pub fn cone(&self) -> Cone {
        self.cone
    }

    /// The weight of a sample in its pixel: 1, or that of the Gaussian filter at its distance from the
    /// centre.
    #[inline(always)]
    pub fn weight(&self, sample: &CameraSample) -> f32 {
        match self.sampler {
            Sampler::Gaussian if self.weights => F::gaussian_weight(self.place(sample) - 0.5),
            _ => 1.0,
        }
    }

    /// The position of a sample in pixels from the upper left corner of its pixel; a Gaussian filter reaches
    /// beyond the pixel.
    #[inline(always)]
    fn place(&self, sample: &CameraSample) -> Vec2 {
        match &sample.pixel {
            None => Vec2::splat(0.5),
            Some(stratum) if self.positions => F::pixel_position(self.sampler, stratum),
            Some(stratum) => stratum.u,
        }
    }

    /// The shutter time of a sample, `0..=1`.
    #[inline(always)]
    fn time(&self, sample: &CameraSample) -> f32 {
        let Some(shutter) = &self.camera.shutter else { return 0.0 };
        let Some(stratum) = &sample.time else { return shutter.open };
        let (slot, slots) = match (self.sampler, &sample.pixel) {
            // Number the cells of all pixels as one large grid, over which the table repeats.
            (Sampler::Jittered | Sampler::Gaussian, Some(Stratum { cell, grid, .. })) => {
                let cell = uvec2(sample.column, sample.row) * *grid + *cell;
                (F::temporal_slot(cell.x, cell.y), 16)
            }
            _ => (1, 1),
        };
        F::time_in_shutter(shutter, slot, slots, stratum.u.x)
    }

    /// The linear colour of a pixel from its samples: the colour of a single sample, the weighted mean by
    /// `filter_pixel`, or the plain mean if the filter functions are not written. Without samples the plain mean
    /// is NaN.
    #[inline(always)]
    pub fn filter_pixel(&self, samples: &[WeightedColor]) -> Vec3 {
        match samples {
            [only] => only.color,
            _ if self.weights => F::filter_pixel(samples),
            _ => samples.iter().map(|sample| sample.color).sum::<Vec3>() / samples.len() as f32,
        }
    }
}
