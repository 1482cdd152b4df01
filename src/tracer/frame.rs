//! One frame: its plan, its acceleration structures and its camera, put together for a job.

use super::camera_sampler::CameraSampler;
use super::driver::FrameSettings;
use super::light::indirect::IndirectLight;
use super::light::interaction::SurfaceOptions;
use super::light::texture_filter::Pyramids;
use super::plan::Plan;
use super::plan::written::Written;
use super::search::Intersector;
use super::search::kept::{self, Built};
use crate::kit::{Limits, RenderJob, StudentFunctions};
use crate::progress::{self, Watch};
use crate::scene::Quality;
use crate::world::World;
use std::sync::Arc;

/// Everything that the rays of a frame need. It is built once and shared by all threads.
pub struct Frame<'a, F> {
    /// The scene to render, with view, seed and number of threads.
    pub job: &'a RenderJob,
    /// Which of the effects of the scene are computed, and by which functions.
    pub plan: Plan,
    /// Makes camera rays from samples, and colours of pixels from the colours of samples.
    pub camera: CameraSampler<F>,
    /// Finds the hits of rays in the flattened scene.
    pub intersector: Arc<Intersector<F>>,
    /// The seconds that an earlier frame took to build the structures that this one uses again; 0 if they were built now.
    pub earlier_seconds: f64,
    /// By which functions and with which normals hits become surface interactions.
    pub surface_options: SurfaceOptions,
    /// The smaller copies of all images, if images are filtered.
    pub pyramids: Option<Pyramids>,
    /// What paths of indirect light sample; `None` if no indirect light is computed.
    pub indirect: Option<IndirectLight>,
    /// At which depth and weight a path ends.
    pub limits: Limits,
}

impl<'a, F: StudentFunctions> Frame<'a, F> {
    /// Plans the frame, flattens the scene and builds the acceleration structures; `watch` receives the
    /// progress of the build.
    pub fn new(job: &'a RenderJob, written: &Written<F>, watch: &dyn Watch) -> Self {
        let scene = &job.scene;
        let quality = &scene.quality;
        let plan = Plan::new(job, written);
        let Built { intersector, earlier_seconds } = kept::built(job, &plan, written, false, || {
            let world = World::new(scene, &plan.effects, &plan.world);
            let n_primitives = world.primitives.len() as u64;
            progress::watched(watch, n_primitives, || Intersector::new(world, &plan, quality, job.threads))
        });
        let world = &intersector.scene.world;
        let pyramids = plan.mipmaps.then(|| Pyramids::new(world, &plan.effects));
        let indirect = plan.paths.as_ref().map(|paths| IndirectLight::new(scene, world, paths));
        let camera = CameraSampler::new(scene, &plan);
        let surface_options = SurfaceOptions {
            tests: plan.tests,
            smooth: plan.smooth,
            facing: plan.facing,
            lift: job.scene.quality.lift_shadow_rays,
        };
        let limits = Limits { max_depth: quality.max_depth, min_contribution: quality.min_contribution };
        Frame { job, plan, camera, intersector, earlier_seconds, surface_options, pyramids, indirect, limits }
    }

    /// The quality settings of the scene that is rendered.
    pub fn quality(&self) -> &Quality {
        &self.job.scene.quality
    }

    /// The settings of the frame driver: film size, threads, seed, and random numbers only for the effects of
    /// the plan.
    pub fn settings(&self) -> FrameSettings {
        let (film, quality) = (&self.job.scene.film, self.quality());
        let settings = FrameSettings {
            width: film.width,
            height: film.height,
            rows: film.rendered_rows(),
            samples_per_pixel: quality.samples_per_pixel,
            sampler: quality.sampler,
            lens: false,
            motion: false,
            on_the_way: false,
            threads: self.job.threads,
            seed: self.job.seed,
        };
        let settings = settings.for_effects(&self.plan.effects);
        FrameSettings { on_the_way: settings.on_the_way || self.indirect.is_some(), ..settings }
    }
}
