//! Nothing to do here: this makes pictures out of the functions of the stage files. What is not written yet is left
//! out, and the picture says so: without stage 4 it shows normals, without stage 3 every ray tests every primitive,
//! and without the search of stage 2 later shapes are painted over earlier ones, near or far.

use crate::camera_rays::Eye;
use crate::finder::Finder;
use crate::outlines;
use crate::plan::Plan;
use crate::radiance::Desk;
use crate::surfaces::{Hit, Looks};
use glam::{Vec3, uvec2};
use raykata::building;
use raykata::bvh::PrimitiveHit;
use raykata::count::{Counts, Event, Tally, Uncounted};
use raykata::film::Film;
use raykata::frame::{self, CameraSample, FrameSettings, Unwatched, Watch};
use raykata::kit::{Limits, RenderJob, Rendering, TracedRay, View, WeightedColor};
use raykata::ray::Ray;
use raykata::scene::Quality;
use raykata::world::{World, camera_for};
use std::time::Instant;

pub fn render(job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
    let started = Instant::now();
    let tracer = Tracer::new(job, watch);
    let build_seconds = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let (film, counts) =
        if job.count { tracer.frame::<Counts>(watch)? } else { tracer.frame::<Uncounted>(watch)? };
    Some(Rendering {
        film,
        counts,
        primitives: (tracer.finder.world.primitives.len() + tracer.finder.world.planes.len()) as u64,
        structure: tracer.finder.structure.size(),
        bytes_of_parts: tracer.finder.bytes_of_parts(),
        build_seconds,
        render_seconds: started.elapsed().as_secs_f64(),
        notes: [tracer.plan.notes, tracer.finder.world.notes].concat(),
    })
}

pub fn trace(job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
    let tracer = Tracer::new(job, &Unwatched);
    let sample = CameraSample::draw(&tracer.settings(), x, y, 0);
    let ray = tracer.eye.ray(&sample);
    let mut rays = Vec::new();
    let mut desk = Desk::<Uncounted>::default();
    let hit = tracer.closest_hit(&ray, &mut desk);
    tracer.radiance(ray, sample.points, hit, &mut desk, &mut |mut ray, material| {
        if let (Some(hit), Some(material)) = (&mut ray.hit, material) {
            hit.1 = job.scene.material_names.get(material).cloned().unwrap_or_default();
        }
        rays.push(ray);
    });
    rays
}

pub fn outlines(job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
    outlines::outlines(&Tracer::new(job, &Unwatched).finder.structure, depth as usize)
}

/// Rays that go on together through a structure that likes them so.
const PACKET: usize = 16;

pub fn first_hits(job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
    let plan = Plan::new(job);
    let finder = Finder::new(World::plain(&job.scene), &plan, &job.scene.quality);
    let n_primitives = finder.world.primitives.len() as u32;
    let named = |hit: Hit| match hit {
        Hit::Plane { t, index } => PrimitiveHit { t, primitive: n_primitives + index as u32 },
        Hit::Primitive(hit) => hit,
        Hit::Inner { t, outer, .. } => PrimitiveHit { t, primitive: outer },
    };
    let tally = &mut Uncounted;
    let hits: Vec<Option<Hit>> = if finder.likes_packets() {
        rays.chunks(PACKET).flat_map(|rays| finder.closest_hits(rays, tally)).collect()
    } else {
        let mut last = None;
        rays.iter().map(|ray| finder.closest_hit(ray, tally, &mut last)).collect()
    };
    hits.into_iter().map(|hit| hit.map(named)).collect()
}

pub struct Tracer<'a> {
    pub job: &'a RenderJob,
    pub plan: Plan,
    eye: Eye,
    pub finder: Finder,
    pub looks: Looks,
    pub limits: Limits,
}

impl<'a> Tracer<'a> {
    fn new(job: &'a RenderJob, watch: &dyn Watch) -> Self {
        let scene = &job.scene;
        let quality = &scene.quality;
        let plan = Plan::new(job);
        let world = World::new(scene, &plan.effects, &plan.crafts);
        let n_primitives = world.primitives.len() as u64;
        let finder = building::watched(watch, n_primitives, || Finder::new(world, &plan, quality));
        let eye = Eye {
            camera: camera_for(scene),
            sampler: quality.sampler,
            film: uvec2(scene.film.width, scene.film.height).as_vec2(),
            positions: plan.positions,
            weights: plan.weights,
        };
        let looks = Looks { tests: plan.tests, smooth: plan.smooth };
        let limits = Limits { max_depth: quality.max_depth, min_contribution: quality.min_contribution };
        Tracer { job, plan, eye, finder, looks, limits }
    }

    pub fn quality(&self) -> &Quality {
        &self.job.scene.quality
    }

    /// What the frame driver draws: only what the scene calls for.
    fn settings(&self) -> FrameSettings {
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

    fn frame<T: Tally>(&self, watch: &dyn Watch) -> Option<(Film, Counts)> {
        let (settings, packets) = (self.settings(), self.finder.likes_packets());
        let radiance = |sample: &CameraSample, desk: &mut Desk<T>| {
            desk.note(Event::Primary);
            let before = (self.job.view == View::Work).then(|| desk.counts());
            let ray = self.eye.ray(sample);
            let hit = if packets {
                let Desk { packets, tally, .. } = desk;
                packets.first_hit(sample, &settings, &self.eye, &self.finder, tally)
            } else {
                self.closest_hit(&ray, desk)
            };
            let mut color = self.radiance(ray, sample.points, hit, desk, &mut |_, _| {});
            if let Some(before) = before {
                color = work(&before, &desk.counts());
            }
            WeightedColor { color, weight: self.eye.weight(sample) }
        };
        frame::render(&settings, watch, radiance, |samples| self.eye.develop(samples))
    }
}

/// What was done between two counts, as a colour.
fn work(before: &Counts, after: &Counts) -> Vec3 {
    let nodes = after.node_visits - before.node_visits;
    let boxes = after.box_tests - before.box_tests;
    let primitives = after.primitive_tests - before.primitive_tests;
    Vec3::new(nodes as f32, boxes as f32, primitives as f32)
}
