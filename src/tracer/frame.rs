//! One frame: its plan, what rays meet, and the camera, put together for a job.

use super::camera_sampler::CameraSampler;
use super::interaction::Looks;
use super::intersector::Intersector;
use super::plan::Plan;
use super::written::Written;
use crate::building;
use crate::frame::{FrameSettings, Watch};
use crate::kit::{Limits, RenderJob, StudentFunctions};
use crate::scene::Quality;
use crate::world::World;

/// Everything that the rays of a frame need, built once.
pub struct Frame<'a, F> {
    /// What was asked for.
    pub job: &'a RenderJob,
    /// What of it is computed.
    pub plan: Plan,
    /// Makes rays.
    pub camera: CameraSampler<F>,
    /// Finds what they meet.
    pub intersector: Intersector<F>,
    /// How surfaces are looked at.
    pub looks: Looks,
    /// When a path ends.
    pub limits: Limits,
}

impl<'a, F: StudentFunctions> Frame<'a, F> {
    /// Plans the frame and builds the structures; `watch` hears how far they are.
    pub fn new(job: &'a RenderJob, written: &Written<F>, watch: &dyn Watch) -> Self {
        let scene = &job.scene;
        let quality = &scene.quality;
        let plan = Plan::new(job, written);
        let world = World::new(scene, &plan.effects, &plan.world);
        let n_primitives = world.primitives.len() as u64;
        let intersector = building::watched(watch, n_primitives, || Intersector::new(world, &plan, quality));
        let camera = CameraSampler::new(scene, &plan);
        let looks = Looks { tests: plan.tests, smooth: plan.smooth, facing: plan.facing };
        let limits = Limits { max_depth: quality.max_depth, min_contribution: quality.min_contribution };
        Frame { job, plan, camera, intersector, looks, limits }
    }

    /// How the scene is to be rendered.
    pub fn quality(&self) -> &Quality {
        &self.job.scene.quality
    }

    /// What the frame driver draws: only what the scene calls for.
    pub fn settings(&self) -> FrameSettings {
        let (film, quality) = (&self.job.scene.film, self.quality());
        let settings = FrameSettings {
            width: film.width,
            height: film.height,
            samples_per_pixel: quality.samples_per_pixel,
            sampler: quality.sampler,
            lens: false,
            motion: false,
            on_the_way: false,
            threads: self.job.threads,
            seed: self.job.seed,
        };
        settings.obey(&self.plan.effects)
    }
}
