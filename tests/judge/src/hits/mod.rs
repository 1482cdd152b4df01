//! Judges first hits exactly, for `raykata cost`. It reads a scene from standard input and answers with rays;
//! then it reads the hits of a kit for each setting, and answers with verdicts.
//!
//! Rays go from the camera through the picture. If a ray hits a triangle, two more rays are aimed at an edge
//! and at a corner of that triangle, if the neighbouring triangles close the surface there.

mod search;
mod surface;

use anyhow::{Result, ensure};
use oracle::exact::{Body, meet};
use oracle::splitmix::Random;
use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::scene::Scene;
use raykata::worker::{receive, send};
use raykata::world::{World, camera_for};
use raykata_cli::cost::Verdicts;
use raykata_cli::queue;
use search::Search;
use std::io::{ErrorKind, Read, Write};
use surface::Surface;

/// The columns and rows of rays through the picture. Rays at edges and corners make at most three times as many.
const THROUGH: (u32, u32) = (64, 36);

/// The most bodies: with more, the exact search takes minutes.
const MOST_BODIES: usize = 3_000_000;

/// Answers requests until the pipe closes.
pub fn serve(mut asked: impl Read, mut answers: impl Write) -> Result<()> {
    let scene: Scene = receive(&mut asked)?;
    let jury = Jury::new(&scene)?;
    let rays = jury.as_ref().map(|jury| jury.asked.iter().map(|one| one.ray).collect::<Vec<Ray>>());
    send(&mut answers, &rays)?;
    let Some(jury) = jury else { return Ok(()) };
    loop {
        match receive(&mut asked) {
            Ok(hits) => send(&mut answers, &jury.verdicts(hits)?)?,
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error.into()),
        }
    }
}

/// A ray and its exact first hit.
struct ExactRay {
    ray: Ray,
    /// The `t` of the first hit, correctly rounded; `None` if there is none.
    first: Option<f32>,
    /// Whether the surface is closed around the hit, so that a ray that passes through it is a leak.
    closed: bool,
}

/// The bodies of a scene, and the rays with their exact hits.
struct Jury {
    bodies: Vec<Body>,
    asked: Vec<ExactRay>,
}

impl Jury {
    fn new(scene: &Scene) -> Result<Option<Jury>> {
        let world = World::plain(scene);
        if world.primitives.len() > MOST_BODIES || world.primitives.is_empty() {
            return Ok(None);
        }
        let bodies = search::bodies(&world);
        let search = Search::over(&bodies, world.primitives.len());
        let surface = Surface::of(&bodies);
        let camera = camera_for(scene);
        let rows: Vec<u32> = (0..THROUGH.1).collect();
        let of_row = |_: &(), &row: &u32| {
            let mut random = Random::new(u64::from(row), 31);
            let mut asked = Vec::new();
            for column in 0..THROUGH.0 {
                let (x, y) = (column as f32 + random.unit(), row as f32 + random.unit());
                let ray = camera.ray(x / THROUGH.0 as f32, y / THROUGH.1 as f32);
                let (index, one) = search.asked(ray);
                asked.push(one);
                let Some(Body::Triangle(_)) = index.map(|index| bodies[index as usize]) else { continue };
                for aim in surface.aims(ray.origin, index.unwrap_or_default(), &mut random) {
                    let (index, one) = search.asked(Ray::new(ray.origin, aim.target - ray.origin));
                    // Another body may occlude the target.
                    let closed = index.is_some_and(|index| aim.around.contains(&index));
                    asked.push(ExactRay { closed, ..one });
                }
            }
            Ok(asked)
        };
        let asked = queue::run(&queue::one_a_core(), &rows, of_row)?.into_iter().flatten().collect();
        Ok(Some(Jury { bodies, asked }))
    }

    fn verdicts(&self, hits: Vec<Option<PrimitiveHit>>) -> Result<Verdicts> {
        ensure!(hits.len() == self.asked.len(), "{} hits of {} rays", hits.len(), self.asked.len());
        let mut verdicts = Verdicts { rays: hits.len() as u64, ..Verdicts::default() };
        for (asked, found) in self.asked.iter().zip(hits) {
            verdicts.wrong += u64::from(self.is_wrong(asked, found));
            verdicts.leaks += u64::from(asked.closed && is_beyond(asked.first, found));
        }
        Ok(verdicts)
    }

    fn is_wrong(&self, asked: &ExactRay, found: Option<PrimitiveHit>) -> bool {
        let met = |hit: PrimitiveHit| meet(&asked.ray, *self.bodies.get(hit.primitive as usize)?)?.t;
        match (found, asked.first) {
            (None, first) => first.is_some(),
            (Some(hit), first) => !met(hit).zip(first).is_some_and(|(t, first)| is_same(t, first)),
        }
    }
}

/// Whether two `t` differ by a few roundings only, so that single precision cannot tell which hit is first.
fn is_same(t: f32, first: f32) -> bool {
    (t - first).abs() <= 4.0 * f32::EPSILON * first.abs()
}

/// Whether a ray has passed through its first hit. A thousandth of the distance is more than the rounding
/// error of any sensible test, and less than the thickness of an object.
fn is_beyond(first: Option<f32>, found: Option<PrimitiveHit>) -> bool {
    first.is_some_and(|first| found.is_none_or(|hit| hit.t > first + 1e-3 * first.abs()))
}
