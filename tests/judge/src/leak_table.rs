//! Counts the leaks of closed meshes.

use crate::gauntlet::{Answers, Input, Row};
use crate::table::Table;
use anyhow::Result;
use oracle::gauntlet::leaks::{self, Aim, aimed};
use oracle::gauntlet::meshes::{Closed, closed};
use oracle::splitmix::Random;
use raykata::ray::Ray;
use raykata_cli::queue;

/// How many rays leak, by row and mesh. Methods are counted first, one per thread, then the functions of the kit.
pub fn table(rows: &[Row<'_>], seed: u64, rays: u64) -> Result<Table> {
    let meshes = closed();
    let of_method = |(): &(), row: &Row<'_>| {
        let count = |method| line(&meshes, |mesh, aim| leaks::count(mesh, aim, seed, rays, method));
        Ok(row.method.map(count))
    };
    let counted = queue::run(&queue::one_a_core(), rows, of_method)?;
    let cells = |(row, counted): (&Row<'_>, Option<Vec<String>>)| {
        let in_batches = |mesh: &Closed, aim| in_batches(mesh, aim, seed, rays, &row.answer);
        (row.name.clone(), counted.unwrap_or_else(|| line(&meshes, in_batches)))
    };
    Ok(Table {
        title: format!("leaks of {rays} rays at edges / at vertices, from inside closed meshes"),
        heads: meshes.iter().map(|mesh| mesh.name.to_owned()).collect(),
        rows: rows.iter().zip(counted).map(cells).collect(),
        notes: Vec::new(),
    })
}

/// Leaks of one row per million rays, over all meshes and both aims.
pub fn per_million(row: &Row<'_>, seed: u64, rays: u64) -> f64 {
    let meshes = closed();
    let pairs = || meshes.iter().flat_map(|mesh| Aim::ALL.map(|aim| (mesh, aim)));
    let leaks: u64 = pairs().map(|(mesh, aim)| in_batches(mesh, aim, seed, rays, &row.answer)).sum();
    1e6 * leaks as f64 / (rays * pairs().count() as u64) as f64
}

fn line(meshes: &[Closed], count: impl Fn(&Closed, Aim) -> u64) -> Vec<String> {
    let cell = |mesh: &Closed| {
        let [edges, vertices] = Aim::ALL.map(|aim| count(mesh, aim));
        format!("{edges}/{vertices}")
    };
    meshes.iter().map(cell).collect()
}

/// The same count with calls in batches, for kits, whose calls are expensive.
fn in_batches(mesh: &Closed, aim: Aim, seed: u64, rays: u64, answer: impl Fn(&[Input]) -> Answers) -> u64 {
    let mut random = Random::new(seed, aim as u64);
    let rays: Vec<(Ray, u32)> = (0..rays).map(|_| aimed(mesh, aim, &mut random)).collect();
    leaks_of(mesh, &rays, answer)
}

/// The number of rays that leak; each ray comes with a vertex near which it should hit. The triangles around
/// the vertices of all rays are tested in one batch, and all triangles only for rays that hit none of these.
fn leaks_of(mesh: &Closed, rays: &[(Ray, u32)], answer: impl Fn(&[Input]) -> Answers) -> u64 {
    let fan = |vertex: u32| &mesh.fans[vertex as usize];
    let near: Vec<Input> = rays
        .iter()
        .flat_map(|&(ray, vertex)| fan(vertex).iter().map(move |&index| (ray, mesh.triangle(index))))
        .collect();
    let mut answers = answer(&near).into_iter();
    let leaks = |&(ray, vertex): &(Ray, u32)| {
        let hit = answers.by_ref().take(fan(vertex).len()).filter(Option::is_some).count() > 0;
        let all = || -> Vec<Input> { mesh.all().into_iter().map(|triangle| (ray, triangle)).collect() };
        !hit && !answer(&all()).iter().any(Option::is_some)
    };
    rays.iter().map(leaks).filter(|&leaks| leaks).count() as u64
}
