//! `raykata cost --equal-time`: the values of a parameter, each with as many samples per pixel as fit into the same time, for
//! one or more sizes of the lights.

use super::ladder::Ladder;
use super::measure::Bench;
use super::measured::{Point, Reference};
use super::plot::{Line, Plot, svg};
use super::setting::Setting;
use crate::columns::Columns;
use crate::html::csv_line;
use crate::report::{make_folder, write_file};
use anyhow::{Result, bail};
use glam::Vec3;
use raykata::scene::Scene;
use raykata::shape::Shape;
use std::path::Path;

/// How often each value is timed before its samples are chosen; the fastest frame counts.
const TRIALS: u64 = 3;

/// The most samples per pixel that a fast value gets.
const MOST_SAMPLES: f64 = 65_536.0;

/// One value with its share of the time.
struct Row {
    /// The factor of the size of the lights.
    size: f32,
    value: String,
    point: Point,
}

impl Row {
    fn samples(&self) -> u32 {
        self.point.setting.quality.samples_per_pixel
    }

    fn rays_per_second(&self) -> f64 {
        self.point.counts.rays() as f64 / self.point.seconds
    }
}

/// Measures each value of `ladders` at equal time with lights of each of `sizes`, prints a table and writes `equal_time.csv` and
/// `equal_time.svg` into `out`. `reference` gives the converged picture of a scene. `Ok(false)` if it was stopped.
pub fn run(
    bench: &Bench<'_>,
    scene: &Scene,
    ladders: &[Ladder],
    own_notes: &[String],
    sizes: &[f32],
    out: &Path,
    reference: impl Fn(&Scene) -> Result<Option<Reference>>,
) -> Result<bool> {
    let mut rows = Vec::new();
    for &size in sizes {
        let sized = with_lights_of(scene, size)?;
        let Some(right) = reference(&sized)? else { return Ok(false) };
        for ladder in ladders {
            let Some(timed) = with_equal_times(bench, &sized, ladder)? else { return Ok(false) };
            let measured = bench.measure(&sized, vec![timed], &right, own_notes)?;
            if bench.stopped() {
                return Ok(false);
            }
            let levels = measured.series.iter().flat_map(|series| &series.levels);
            rows.extend(levels.map(|(value, index)| {
                let value = format!("{}, {value}", ladder.name);
                Row { size, value, point: measured.points[*index].clone() }
            }));
        }
    }
    print(scene, sizes, &rows);
    make_folder(out)?;
    write_file(&out.join("equal_time.csv"), table(&rows).as_bytes())?;
    write_file(&out.join("equal_time.svg"), plot(&rows, sizes).as_bytes())?;
    println!("\nthe plot: {}", out.join("equal_time.svg").display());
    Ok(true)
}

/// The ladder with samples per pixel for each value such that all take as long as the slowest one does with its own.
fn with_equal_times(bench: &Bench<'_>, scene: &Scene, ladder: &Ladder) -> Result<Option<Ladder>> {
    // Time a frame of each value.
    let mut times = Vec::new();
    for (_, setting) in &ladder.levels {
        let mut fastest = f64::INFINITY;
        for trial in 0..TRIALS {
            let Some((_, seconds)) = bench.timed(&setting.apply(scene), bench.seed + trial)? else {
                return Ok(None);
            };
            fastest = fastest.min(seconds);
        }
        times.push(fastest);
    }
    // The time of a frame is proportional to its samples.
    let slowest = times.iter().copied().fold(0.0, f64::max);
    let level = |((name, setting), seconds): (&(String, Setting), &f64)| {
        let mut setting = setting.clone();
        let own = f64::from(setting.quality.samples_per_pixel);
        setting.quality.samples_per_pixel = (own * slowest / seconds).round().clamp(1.0, MOST_SAMPLES) as u32;
        (name.clone(), setting)
    };
    let levels = ladder.levels.iter().zip(&times).map(level).collect();
    Ok(Some(Ladder { parameter: ladder.parameter, name: ladder.name.clone(), levels, left_out: Vec::new() }))
}

/// The scene with spheres and polygons that emit light `size` times as large, and of the same power.
fn with_lights_of(scene: &Scene, size: f32) -> Result<Scene> {
    let mut sized = scene.clone();
    if size == 1.0 {
        return Ok(sized);
    }
    let emits = |material: &usize| scene.materials[*material].emission != Vec3::ZERO;
    let mut resized = 0;
    for shown in scene.shown().iter().filter(|shown| shown.materials.iter().any(emits)) {
        match &mut sized.nodes[shown.node].shape {
            Some(Shape::Sphere(sphere)) => sphere.radius *= size,
            Some(Shape::Polygon(polygon)) => {
                let center = polygon.corners.iter().sum::<Vec3>() / polygon.corners.len() as f32;
                polygon.corners.iter_mut().for_each(|corner| *corner = center + size * (*corner - center));
            }
            _ => bail!("`--light-sizes` changes spheres and polygons only; `{}` is neither", {
                &scene.nodes[shown.node].name
            }),
        }
        resized += 1;
    }
    if resized == 0 {
        bail!("`--light-sizes` needs surfaces that emit light, and the scene has none");
    }
    // The power of a light is proportional to its radiance times its area.
    for material in &mut sized.materials {
        material.emission /= size * size;
    }
    Ok(sized)
}

fn print(scene: &Scene, sizes: &[f32], rows: &[Row]) {
    let (width, height) = (scene.film.width, scene.film.height);
    println!(
        "at equal processor time of one thread, {width} × {height} pixels; samples are per pixel,\nrays in millions per second"
    );
    const COLUMNS: Columns = Columns("", &[-43, -1, 8, 9, 8, 10]);
    println!("{}", COLUMNS.row(&[&"", &"", &"samples", &"ms", &"rays", &"RMSE"]));
    for &size in sizes {
        if sizes.len() > 1 {
            println!("lights {size} times as large, of the same power");
        }
        let of_size = || rows.iter().filter(move |row| row.size == size);
        let is_best = |row: &Row| {
            of_size().all(|other| std::ptr::eq(other, row) || row.point.is_more_accurate(&other.point))
        };
        for row in of_size() {
            let mark = if is_best(row) { "•" } else { "" };
            let [ms, rays] =
                [1e3 * row.point.seconds, 1e-6 * row.rays_per_second()].map(|x| format!("{x:.1}"));
            let (value, error) = (format!("  {}", row.value), format!("{:.5}", row.point.error()));
            println!("{}", COLUMNS.row(&[&value, &mark, &row.samples(), &ms, &rays, &error]));
        }
        if !of_size().any(is_best) {
            println!("  no value is the best with 95 % confidence: too noisy to rank");
        }
    }
    println!(
        "• a smaller error than each other value, in rounds with the same random numbers, with 95 %\n  confidence"
    );
}

fn table(rows: &[Row]) -> String {
    let heads = ["light_size", "value", "samples", "seconds", "rays", "rmse"];
    let mut table = csv_line(&heads.map(str::to_owned));
    for row in rows {
        table += &csv_line(&[
            row.size.to_string(),
            row.value.clone(),
            row.samples().to_string(),
            row.point.seconds.to_string(),
            row.point.counts.rays().to_string(),
            row.point.error().to_string(),
        ]);
    }
    table
}

/// The error of each value over the size of the lights, or with one size over the rays that a second bought.
fn plot(rows: &[Row], sizes: &[f32]) -> String {
    let mut lines: Vec<Line> = Vec::new();
    for row in rows {
        let x = if sizes.len() > 1 { f64::from(row.size) } else { 1e-6 * row.rays_per_second() };
        let error = row.point.error();
        let point = [x, error, error, error];
        match lines.iter_mut().find(|line| line.name == row.value) {
            Some(line) => line.points.push(point),
            None => lines.push(Line { name: row.value.clone(), points: vec![point] }),
        }
    }
    for line in &mut lines {
        line.name = short(&line.name).to_owned();
    }
    svg(&Plot {
        title: "error at equal time",
        x_axis: match sizes.len() {
            0 | 1 => "million rays per second",
            _ => "size of the lights",
        },
        y_axis: "root mean square error in linear light",
        lines,
        floor: 1e-9,
        ..Plot::default()
    })
}

/// The value without the name of its ladder, which the plot has no room for.
fn short(value: &str) -> &str {
    value.split_once(", ").map_or(value, |(_, value)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_change_their_size_and_keep_their_power() {
        let scene = crate::report::scene_of_kit("veach");
        let sized = with_lights_of(&scene, 0.5).unwrap();
        let mut lights = 0;
        for (node, before) in sized.nodes.iter().zip(&scene.nodes) {
            let (Some(Shape::Sphere(after)), Some(Shape::Sphere(before))) = (&node.shape, &before.shape)
            else {
                continue;
            };
            assert_eq!(after.radius, 0.5 * before.radius);
            let material = node.material.expect("a light has a material");
            let [after, before] = [&sized, &scene].map(|scene| scene.materials[material].emission);
            assert_eq!(after, 4.0 * before);
            lights += 1;
        }
        assert_eq!(lights, 4);
        let dark = crate::report::scene_of_kit("stage1");
        assert!(with_lights_of(&dark, 2.0).is_err() && with_lights_of(&dark, 1.0).is_ok());
    }
}
