//! Renders frames with student functions: every function that is written is used, and notes say what a
//! picture lacks.
//!
//! [`Renderer`] renders the frames of a kit. `plan` decides what is computed, what replaces functions that are not
//! written, and which structure is used. `search` finds hits: it builds and searches a structure through a probe, which tests
//! rays against primitives; measurements use the structures again that `kept` keeps. `light` computes the light along a ray,
//! through the tree of its secondary rays (`whitted`) or along one random path (`path_tracer`). `camera_sampler` makes camera
//! rays, `frame` puts everything together, and [`driver`] renders the tiles. `counter` counts the work, and `gamma2` decodes
//! colours.

mod camera_sampler;
mod counter;
pub mod driver;
mod frame;
mod gamma2;
mod light;
mod plan;
mod search;

use crate::bvh::PrimitiveHit;
use crate::count::{Counts, Event, Tally, Uncounted};
use crate::film::Film;
use crate::kit::{
    Frames, KitError, RayVisits, RenderJob, Rendering, StudentFunctions, TracedRay, View, WeightedColor,
    kit_error,
};
use crate::progress::{Unwatched, Watch};
use crate::ray::Ray;
use crate::worker::Thread;
use crate::world::World;
use counter::Counter;
use driver::CameraSample;
use frame::Frame;
use gamma2::decoded;
use glam::Vec3;
use light::path::Path;
use light::record::{NoRecord, Rays};
use light::whitted::Scratch;
use plan::Plan;
use plan::written::Written;
use search::hit::{Hit, Target};
use search::kept::{self, Built};
use search::packets::PACKET;
use search::{Intersector, outlines};
use std::marker::PhantomData;
use std::time::Instant;

/// Renders frames with the student functions of `F`.
///
/// A function that turns out to be unfinished during a frame (`todo!`) is left out: the frame starts again
/// without it, and a note names it. Any other panic of a student function is passed on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Renderer<F>(PhantomData<F>);

impl<F> Renderer<F> {
    /// The renderer; it has no state.
    pub const NEW: Renderer<F> = Renderer(PhantomData);
}

impl<F: StudentFunctions> Frames for Renderer<F> {
    fn render(&self, job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
        let (rendering, notes) =
            with_written::<F, _>(job.view, |written| render(&decoded(job, written), written, watch));
        rendering.map(|mut rendering| {
            rendering.notes.extend(notes);
            rendering
        })
    }

    fn trace(&self, job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
        with_written::<F, _>(job.view, |written| trace(&decoded(job, written), written, x, y)).0.0
    }

    fn visits(&self, job: &RenderJob, x: u32, y: u32) -> Vec<(TracedRay, RayVisits)> {
        let traced = with_written::<F, _>(job.view, |written| trace(&decoded(job, written), written, x, y)).0;
        traced.0.into_iter().zip(traced.1).collect()
    }

    fn outlines(&self, job: &RenderJob, depth: u32) -> Vec<[Vec3; 2]> {
        let outlines = |written: &Written<F>| {
            let frame = Frame::new(job, written, &Unwatched);
            outlines::outlines(&frame.intersector.scene.structure, depth as usize)
        };
        with_written::<F, _>(job.view, outlines).0
    }

    fn first_hits(&self, job: &RenderJob, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
        with_written::<F, _>(job.view, |written| first_hits(job, written, rays)).0
    }
}

/// Calls `work` with the functions that are written and that `view` allows. If `work` reaches a `todo!` anyway, calls it again without
/// that function. Returns the result and a note for each such function.
fn with_written<F: StudentFunctions, R>(view: View, work: impl Fn(&Written<F>) -> R) -> (R, Vec<String>) {
    let mut written = Written::of(view);
    let mut notes = Vec::new();
    loop {
        // Run the work, and return if no student function panics.
        let error = match kit_error::catch(|| work(&written)) {
            Ok(result) => return (result, notes),
            Err(error) => error,
        };
        // Leave out an unfinished function, and pass any other panic on.
        match &error {
            KitError::NotWritten { task, place, function: Some(function) }
                if written.leave_out(*function) =>
            {
                notes.push(format!("{function} is left out, because it is not finished: {place}: {task}"));
            }
            _ => kit_error::unwind(error),
        }
    }
}

fn render<F: StudentFunctions>(
    job: &RenderJob,
    written: &Written<F>,
    watch: &dyn Watch,
) -> Option<Rendering> {
    // In a web page the standard library has no clock, and all times are 0.
    let clock = || (!cfg!(target_family = "wasm")).then(Instant::now);
    let seconds_since = |time: Option<Instant>| time.map_or(0.0, |time| time.elapsed().as_secs_f64());
    // Build the acceleration structures.
    let started = clock();
    let frame = Frame::new(job, written, watch);
    let build_seconds = seconds_since(started) + frame.earlier_seconds;
    // Render the pixels, with or without counts.
    let started = clock();
    let ran_before = started.and_then(|_| Thread::processor_time());
    let (film, counts) =
        if job.count { pixels::<F, Counts>(&frame, watch)? } else { pixels::<F, Uncounted>(&frame, watch)? };
    let render_seconds = seconds_since(started);
    let processor_time = ran_before.and_then(|before| Some(Thread::processor_time()? - before));
    let scene = &frame.intersector.scene;
    Some(Rendering {
        film,
        counts,
        primitives: (scene.world.primitives.len() + scene.world.planes.len()) as u64,
        accelerator: frame.plan.accelerator,
        structure: scene.structure.size(),
        bytes_of_parts: frame.intersector.bytes_of_parts(),
        build_seconds,
        render_seconds,
        processor_seconds: processor_time.map(|time| time.as_secs_f64()),
        notes: [&frame.plan.notes, &frame.intersector.notes, &scene.world.notes].map(Vec::as_slice).concat(),
    })
}

/// Renders all pixels of a frame; `None` if `watch` cancelled it.
fn pixels<F: StudentFunctions, T: Tally>(frame: &Frame<'_, F>, watch: &dyn Watch) -> Option<(Film, Counts)> {
    let (settings, packets) = (frame.settings(), frame.intersector.takes_packets());
    let radiance = |sample: &CameraSample, scratch: &mut Scratch<T>| {
        // Find the closest hit of the camera ray.
        scratch.note(Event::Primary);
        let before = (frame.job.view == View::Work).then(|| scratch.counts());
        let path = Path::from_camera(frame.camera.ray(sample), sample.points, frame.camera.cone());
        let hit = if packets {
            let Scratch { packets, tally, .. } = scratch;
            packets.first_hit(sample, &settings, &frame.camera, &frame.intersector, tally)
        } else {
            frame.closest_hit(&path.ray, scratch)
        };
        // Compute what the pixel shows: normals, light or work.
        let mut color = match frame.plan.view {
            View::Normals => frame.normal_as_color(&path, hit, scratch, &mut NoRecord),
            _ => match &frame.indirect {
                None => frame.radiance(path, hit, scratch, &mut NoRecord),
                Some(indirect) => frame.radiance_of_path(indirect, path, hit, scratch, &mut NoRecord),
            },
        };
        if let Some(before) = before {
            color = work(&before, &scratch.counts());
        }
        WeightedColor { color, weight: frame.camera.weight(sample) }
    };
    driver::render(&settings, watch, radiance, |samples| frame.camera.filter_pixel(samples))
}

/// The work between two counts as a colour: node visits, box tests and primitive tests.
fn work(before: &Counts, after: &Counts) -> Vec3 {
    let nodes = after.node_visits - before.node_visits;
    let boxes = after.box_tests - before.box_tests;
    let primitives = after.primitive_tests - before.primitive_tests;
    Vec3::new(nodes as f32, boxes as f32, primitives as f32)
}

/// The rays of the first sample of a pixel, and what the search for each of them visits.
fn trace<F: StudentFunctions>(
    job: &RenderJob,
    written: &Written<F>,
    x: u32,
    y: u32,
) -> (Vec<TracedRay>, Vec<RayVisits>) {
    // Make the camera ray of the first sample.
    let frame = Frame::new(job, written, &Unwatched);
    let sample = CameraSample::draw(&frame.settings(), x, y, 0);
    let path = Path::from_camera(frame.camera.ray(&sample), sample.points, frame.camera.cone());
    // Follow it as a frame does, and record all rays.
    let mut record = Rays { material_names: &job.scene.material_names, rays: Vec::new() };
    let mut scratch = Scratch::<Counter>::default();
    let hit = frame.closest_hit(&path.ray, &mut scratch);
    match frame.plan.view {
        View::Normals => frame.normal_as_color(&path, hit, &mut scratch, &mut record),
        _ => match &frame.indirect {
            None => frame.radiance(path, hit, &mut scratch, &mut record),
            Some(indirect) => frame.radiance_of_path(indirect, path, hit, &mut scratch, &mut record),
        },
    };
    (record.rays, scratch.tally.into_visits())
}

fn first_hits<F: StudentFunctions>(
    job: &RenderJob,
    written: &Written<F>,
    rays: &[Ray],
) -> Vec<Option<PrimitiveHit>> {
    // Build the structure of the scene's quality over the plain world.
    let plan = Plan::new(job, written);
    let Built { intersector, .. } = kept::built(job, &plan, written, true, || {
        Intersector::<F>::new(World::plain(&job.scene), &plan, &job.scene.quality, job.threads)
    });
    let n_primitives = intersector.scene.world.primitives.len() as u32;
    // Number the planes after the primitives.
    let primitive_of = |hit: Hit| match hit.target {
        Target::Plane(index) => PrimitiveHit { t: hit.t, primitive: n_primitives + index },
        Target::Primitive(primitive) | Target::Instance(primitive, _) => PrimitiveHit { t: hit.t, primitive },
    };
    // Search in packets, as for camera rays.
    let hits = rays.chunks(PACKET).flat_map(|rays| intersector.closest_hits(rays, &mut Uncounted));
    hits.map(|hit| hit.map(primitive_of)).collect()
}
