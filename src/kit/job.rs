//! Frames: the request to render one, and the answer.

use crate::count::Counts;
use crate::film::Film;
use crate::message;
use crate::scene::{Accelerator, Scene};
use serde::{Deserialize, Serialize};

/// What the pixels of a picture show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum View {
    /// The light that arrives at the camera, in linear radiance.
    #[default]
    Shaded,
    /// The shading normals of the surfaces as colours, `0.5 * normal + 0.5`; the background where there is no
    /// surface.
    Normals,
    /// The cost of a pixel: node visits, box tests and primitive tests of all its rays, per sample, in place
    /// of red, green and blue.
    Work,
    /// The light, by the functions of the stages up to this one. Those of later stages count as not written.
    UpToStage(u8),
}

message! { enum View { Shaded, Normals, Work, UpToStage(stage) } }

/// A request to render a whole frame in the process that contains the student's code.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderJob {
    /// The scene, with the size of the film and the quality of the picture.
    pub scene: Scene,
    /// What the pixels show.
    pub view: View,
    /// The seed of the random numbers: equal seeds give equal pictures.
    pub seed: u64,
    /// The number of threads; 0 takes one per core.
    pub threads: usize,
    /// Whether work is counted. Rays and pixels are the same either way.
    pub count: bool,
    /// Whether the acceleration structures of an earlier job in the same process may be used again, if it had the same
    /// scene and kept them. Pixels, counts and the reported build time are the same either way.
    pub reuse: bool,
}

message! { RenderJob { scene, view, seed, threads, count, reuse } }

impl RenderJob {
    /// Whether a picture has the width of the job's film, and the rows that the job asks for.
    pub(super) fn fits(&self, film: &Film) -> bool {
        let (width, height) = (self.scene.film.width, self.scene.film.rendered_rows().n_rows());
        let pixels = u64::from(width) * u64::from(height);
        (film.width, film.height) == (width, height) && film.pixels.len() as u64 == pixels
    }
}

/// The size of an acceleration structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StructureSize {
    /// The number of nodes, or of cells of a grid.
    pub nodes: u64,
    /// The number of nodes on the longest path from the root to a leaf, both counted; 1 for a grid.
    pub levels: u64,
    /// The number of references to primitives in all leaves together.
    pub references: u64,
    /// The memory of nodes and lists, in bytes.
    pub bytes: u64,
}

message! { StructureSize { nodes, levels, references, bytes } }

/// A rendered frame and its cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rendering {
    /// The picture in linear light; only the rows that the job asked for.
    pub film: Film,
    /// Work by kind; zero if the job did not ask for counts.
    pub counts: Counts,
    /// The number of primitives in the frame, infinite planes included.
    pub primitives: u64,
    /// The acceleration structure that was used, never [`Accelerator::Auto`]; `None` if no search is written.
    pub accelerator: Option<Accelerator>,
    /// The size of the structure over the scene; `None` if there is none, because every primitive is tested.
    /// Shared meshes have structures of their own, which are not included.
    pub structure: Option<StructureSize>,
    /// The memory of the structures of all shared meshes together, in bytes.
    pub bytes_of_parts: u64,
    /// The time to prepare the frame and build its structures, in seconds.
    pub build_seconds: f64,
    /// The time to render the pixels, in seconds.
    pub render_seconds: f64,
    /// The processor time that the thread of this request spent on the pixels, in seconds: of all work on them if the job asks
    /// for one thread. `None` where the operating system does not say it.
    pub processor_seconds: Option<f64>,
    /// What is missing in the picture and why, and which structure is coarser than the scene asks for, one
    /// sentence each.
    pub notes: Vec<String>,
}

message! { Rendering {
    film, counts, primitives, accelerator, structure, bytes_of_parts, build_seconds, render_seconds,
    processor_seconds, notes
} }
