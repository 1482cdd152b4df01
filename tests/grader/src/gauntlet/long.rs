//! The long run: hundreds of millions of rays at edges and vertices of closed meshes, in every structure of the reference,
//! and at corners of boxes. A file stores the progress, so that a stopped run can be continued.

use super::secondary_rays;
use crate::kits::Source;
use crate::queue;
use crate::report::{Thousands, bar_of_steps};
use crate::worker::Worker;
use anyhow::{Result, bail};
use judge::gauntlet::Input;
use judge::leak_table::leaks_of;
use judge::table::Table;
use oracle::exact::aabb::overlap;
use oracle::gauntlet::boxes::{at_a_corner, of_any_size};
use oracle::gauntlet::families::families;
use oracle::gauntlet::job::job;
use oracle::gauntlet::leaks::{Aim, aimed};
use oracle::gauntlet::meshes::Closed;
use oracle::splitmix::Random;
use raykata::kit::{Door, Kit, SlabQuery, TriangleQuery, kit_error};
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality, Split};
use raykata_cli::journal::Journal;
use raykata_cli::lock::Lock;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;

/// The number of rays of one piece of work in closed meshes.
const IN_MESHES: u64 = 50_000;
/// The most pieces that are done together: a structure over each mesh is built once for all of them.
const TOGETHER: usize = 20;
/// The number of rays of another piece of work: those of a frame of secondary rays.
const PIECE: u64 = secondary_rays::RAYS;
/// How many times as many rays a mesh gets as one that is slow: so both take about as long.
const TIMES_AS_MANY: usize = 8;
/// Time limit for a piece in one mesh, with the build of the structure and without much optimisation.
const PATIENCE: Duration = Duration::from_secs(600);

/// The progress.
struct State {
    seed: u64,
    /// The finished pieces of work per trial.
    done: BTreeMap<String, Done>,
}

#[derive(Default)]
struct Done {
    /// The numbers of the pieces.
    pieces: Vec<u64>,
    rays: u64,
    /// The number of leaks or false misses.
    failures: u64,
}

/// The structure in which closed meshes are searched, with its name in the table.
#[derive(Clone, Copy)]
struct Structure {
    name: &'static str,
    accelerator: Accelerator,
    split: Split,
}

/// Every structure that finds hits of single rays in another way.
const STRUCTURES: [Structure; 18] = {
    const fn new(name: &'static str, accelerator: Accelerator, split: Split) -> Structure {
        Structure { name, accelerator, split }
    }
    [
        new("brute force", Accelerator::BruteForce, Split::SurfaceArea),
        new("bvh, object median", Accelerator::Bvh, Split::ObjectMedian),
        new("bvh, spatial median", Accelerator::Bvh, Split::SpatialMedian),
        new("bvh, surface area", Accelerator::Bvh, Split::SurfaceArea),
        new("bvh, both children", Accelerator::BvhBothChildren, Split::SurfaceArea),
        new("bvh, last hit first", Accelerator::CachedBvh, Split::SurfaceArea),
        new("bvh, packets of eight", Accelerator::PacketBvh, Split::SurfaceArea),
        new("bvh, eight children", Accelerator::WideBvh, Split::SurfaceArea),
        new("bvh, eight children, object median", Accelerator::WideBvh, Split::ObjectMedian),
        new("bvh, subtrees moved", Accelerator::ReinsertedBvh, Split::SurfaceArea),
        new("bvh, streams of 64", Accelerator::StreamBvh, Split::SurfaceArea),
        new("grid", Accelerator::Grid, Split::SurfaceArea),
        new("octree", Accelerator::Octree, Split::SurfaceArea),
        new("octree by cells", Accelerator::OctreeByCells, Split::SurfaceArea),
        new("octree by neighbours", Accelerator::OctreeByNeighbours, Split::SurfaceArea),
        new("kd-tree", Accelerator::KdTree, Split::SurfaceArea),
        new("bsp tree", Accelerator::Bsp, Split::SurfaceArea),
        new("bsp tree, polygons in nodes", Accelerator::PolygonBsp, Split::SurfaceArea),
    ]
};

/// Counts the rays that start inside a closed mesh and miss it. Each ray has the index of a vertex near its hit.
fn leaks(kit: &dyn Kit, mesh: &Closed, structure: Structure, rays: &[(Ray, u32)]) -> u64 {
    // Test first the triangles around the vertex at which a ray is aimed: nearly every ray hits one of them.
    if structure.accelerator == Accelerator::BruteForce {
        let answer = |inputs: &[Input]| {
            let queries: Vec<TriangleQuery> =
                inputs.iter().map(|&(ray, triangle)| TriangleQuery { ray, triangle }).collect();
            kit.watertight(&queries).into_iter().map(|hit| hit.map(|hit| hit.t)).collect()
        };
        // A vertex may have hundreds of triangles, so a batch holds few rays.
        return rays.chunks(500).map(|rays| leaks_of(mesh, rays, answer)).sum();
    }
    let Structure { accelerator, split, .. } = structure;
    let quality = Quality { accelerator, split, leaf_size: 4, ..Quality::default() };
    let rays: Vec<Ray> = rays.iter().map(|(ray, _)| *ray).collect();
    let hits = kit.first_hits(&job(&mesh.all(), quality), &rays);
    hits.iter().filter(|hit| hit.is_none()).count() as u64
}

/// The kind of a piece of work.
#[derive(Clone, Copy)]
enum Trial {
    Mesh(Structure, Aim),
    Slab,
    SelfHit,
    Contact,
}

/// Finished work of a trial in the journal: the numbers of its pieces, and their failures.
type Piece = (Vec<u64>, u64);

impl State {
    fn add(&mut self, trial: Trial, (pieces, failures): &Piece) {
        let done = self.done.entry(trial.name()).or_default();
        done.pieces.extend(pieces);
        done.rays += trial.rays() * pieces.len() as u64;
        done.failures += failures;
    }
}

impl Trial {
    fn all() -> Vec<Trial> {
        let meshes =
            STRUCTURES.into_iter().flat_map(|structure| Aim::ALL.map(|aim| Trial::Mesh(structure, aim)));
        meshes.chain([Trial::Slab, Trial::SelfHit, Trial::Contact]).collect()
    }

    fn name(self) -> String {
        match self {
            Trial::Mesh(structure, Aim::Edge) => format!("{}, edges", structure.name),
            Trial::Mesh(structure, Aim::Vertex) => format!("{}, vertices", structure.name),
            Trial::Slab => "boxes, at corners".into(),
            Trial::SelfHit => "own surface, hit again".into(),
            Trial::Contact => "64 floats away, missed".into(),
        }
    }

    /// The number of rays of one piece of work.
    fn rays(self) -> u64 {
        match self {
            Trial::Mesh(..) => IN_MESHES,
            Trial::Slab | Trial::SelfHit | Trial::Contact => PIECE,
        }
    }

    /// Counts the failures among the rays of these pieces. Each piece has random numbers of its own, so the rays do not depend
    /// on which pieces are done together.
    fn failures(self, kit: &dyn Kit, meshes: &[Closed], seed: u64, pieces: &[u64]) -> Result<u64> {
        let randoms = pieces.iter().map(|&piece| Random::new(seed, piece));
        match self {
            Trial::SelfHit => randoms.map(|mut random| secondary_rays::self_hits(kit, &mut random)).sum(),
            Trial::Contact => randoms.map(|mut random| secondary_rays::lost_contacts(kit, &mut random)).sum(),
            Trial::Slab => Ok(randoms.map(|random| lost_boxes(kit, random)).sum()),
            Trial::Mesh(structure, aim) => {
                let turns = turns(meshes);
                let mut rays: Vec<Vec<(Ray, u32)>> = vec![Vec::new(); meshes.len()];
                for mut random in randoms {
                    for n in 0..IN_MESHES as usize {
                        let mesh = turns[n % turns.len()];
                        rays[mesh].push(aimed(&meshes[mesh], aim, &mut random));
                    }
                }
                Ok(meshes.iter().zip(&rays).map(|(mesh, rays)| leaks(kit, mesh, structure, rays)).sum())
            }
        }
    }
}

/// The order in which rays are aimed at the meshes, which repeats: a slow mesh gets one ray where another gets
/// [`TIMES_AS_MANY`].
fn turns(meshes: &[Closed]) -> Vec<usize> {
    let round = |n: usize| (0..meshes.len()).filter(move |&mesh| n == 0 || !meshes[mesh].is_slow);
    (0..TIMES_AS_MANY).flat_map(round).collect()
}

/// Counts the boxes of one piece of work that the conservative test loses although the ray meets them.
fn lost_boxes(kit: &dyn Kit, mut random: Random) -> u64 {
    let queries: Vec<SlabQuery> = (0..PIECE)
        .filter_map(|n| if n % 2 == 0 { at_a_corner(&mut random) } else { of_any_size(&mut random) })
        .collect();
    let meets = |query: &SlabQuery| {
        overlap(&query.ray, &query.bounds).is_some_and(|overlap| overlap.verdict.is_hit())
    };
    let answers = kit.conservative_slab(&queries);
    let missed = queries.iter().zip(answers).filter(|(query, answer)| answer.is_none() && meets(query));
    missed.count() as u64
}
/// Runs until `rays` rays of each kind are done. Returns the numbers, and whether no ray failed.
pub fn run(reference: &Source, rays: u64, seed: u64, file: &Path) -> Result<(Table, bool)> {
    let _lock = Lock::on(file)?;
    let about = format!("a gauntlet with --seed {seed}");
    if let Some(theirs) = Journal::<Piece>::about(file).filter(|theirs| *theirs != about) {
        bail!("{} is of {theirs}: use that seed, or name another file with --state", file.display());
    }
    let journal: Journal<Piece> = Journal::resume(file, &about)?;
    let mut state = State { seed, done: BTreeMap::new() };
    let trials = Trial::all();
    for (name, piece) in journal.kept() {
        if let Some(trial) = trials.iter().find(|trial| trial.name() == *name) {
            state.add(*trial, piece);
        }
    }
    // List the pieces of work that are not done, and put some of each trial together.
    let work: Vec<(Trial, Vec<u64>)> = Trial::all()
        .into_iter()
        .flat_map(|trial| {
            let done: BTreeSet<u64> = state
                .done
                .get(&trial.name())
                .into_iter()
                .flat_map(|done| done.pieces.iter().copied())
                .collect();
            let open: Vec<u64> =
                (0..rays.div_ceil(trial.rays())).filter(|piece| !done.contains(piece)).collect();
            open.chunks(TOGETHER).map(|pieces| (trial, pieces.to_vec())).collect::<Vec<_>>()
        })
        .collect();
    // Run them on all cores and store the progress regularly.
    let meshes = families();
    let kit = || Door(Worker::new(reference.program.clone(), PATIENCE));
    let kits: Vec<_> = (0..queue::cores()).map(|_| kit()).collect();
    let bar = bar_of_steps(work.iter().map(|(_, pieces)| pieces.len()).sum());
    let state = Mutex::new((state, journal));
    queue::run(&kits, &work, |kit, (trial, pieces)| {
        let failures = kit_error::catch(|| trial.failures(kit, &meshes, seed, pieces))??;
        bar.inc(pieces.len() as u64);
        let mut guard = state.lock().unwrap_or_else(|broken| broken.into_inner());
        let (state, journal) = &mut *guard;
        let piece = (pieces.clone(), failures);
        journal.add(&trial.name(), &piece)?;
        state.add(*trial, &piece);
        Ok(())
    })?;
    bar.finish_and_clear();
    let (state, _) = state.into_inner().unwrap_or_else(|broken| broken.into_inner());
    let succeeded = state.done.values().all(|done| done.failures == 0);
    Ok((table(&state, &meshes), succeeded))
}

fn table(state: &State, meshes: &[Closed]) -> Table {
    let turns = turns(meshes);
    let row = |(name, done): (&String, &Done)| {
        (name.clone(), [done.rays, done.failures].map(|n| Thousands(n).to_string()).to_vec())
    };
    Table {
        title: format!("{} closed meshes, seed {}", meshes.len(), state.seed),
        heads: ["rays", "failed"].map(str::to_owned).to_vec(),
        rows: state.done.iter().map(row).collect(),
        notes: vec![
            format!("Of the rays at edges and at vertices, a slow mesh gets 1 in {}, any other", turns.len()),
            format!("{TIMES_AS_MANY} in {}.", turns.len()),
        ],
    }
}
