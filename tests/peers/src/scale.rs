//! How costs grow with the number of triangles, from 10,000 to 12 million.

use crate::embree::Embree;
use crate::reference::Wide;
use crate::{date_and_machine, fail, measure, median, on_threads, print_row, scenes};
use raykata_cli::cost::plot::{Line, Plot, svg};
use std::time::Instant;

/// Half of the square root of the number of triangles of each landscape.
const SIDES: [usize; 5] = [71, 224, 707, 1414, 2449];

/// Prints a table of builds and searches, and draws their times into the file `to`.
pub fn run(library: &str, to: &str) {
    // Builds on one thread come first: Embree keeps the largest number of threads that it has had.
    let mut table = Vec::new();
    for threads in [1, 2] {
        for (row, side) in SIDES.into_iter().enumerate() {
            let scene = scenes::terrain("terrain", side);
            let triangles = scene.triangles.as_slice();
            let memory = if threads == 1 { memory_in_new_process(side) } else { 0.0 };
            let own = builds(threads, || Wide::build(triangles));
            let embree = builds(1, || Embree::build(library, triangles, false, threads).is_some());
            if threads == 1 {
                let speed = on_threads(1, || measure(&scene, library, true));
                table.push((triangles.len() as f64, [own, embree, 0.0, 0.0], memory, speed));
            } else {
                table[row].1[2..].copy_from_slice(&[own, embree]);
            }
        }
    }
    let names = ["build, per triangle", "camera ray", "diffuse ray", "shadow ray"];
    let mut lines = names.map(|name| Line { name: name.into(), points: Vec::new() });
    println!("\n{}:\n", date_and_machine());
    let head = [
        "triangles",
        "build, s",
        "on two threads",
        "times as fast",
        "time / Embree's, on one and two threads",
        "memory of the build / tree",
        "µs per camera, diffuse, shadow ray",
        "speed / Embree's",
    ];
    print_row(head.map(String::from).into());
    print_row(vec!["---".into(); head.len()]);
    for (n, [one, embree_one, two, embree_two], memory, speed) in table {
        let [camera, diffuse, shadow] = speed[0].microseconds;
        for (line, y) in lines.iter_mut().zip([1e6 * one / n, camera, diffuse, shadow]) {
            line.points.push([n, y, y, y]);
        }
        print_row(vec![
            format!("{n}"),
            format!("{one:.3}"),
            format!("{two:.3}"),
            format!("{:.2}", one / two),
            format!("{:.2}, {:.2}", one / embree_one, two / embree_two),
            format!("{memory:.2}"),
            format!("{camera:.2}, {diffuse:.2}, {shadow:.2}"),
            speed[0].ratio.map(|ratio| format!("{ratio:.2}")).join(", "),
        ]);
    }
    let plot = Plot {
        title: "the same landscape in more and more triangles",
        x_axis: "triangles",
        y_axis: "microseconds on one thread",
        lines: lines.into(),
        guides: Vec::new(),
        pareto_front: Vec::new(),
        floor: 1e-3,
    };
    std::fs::write(to, svg(&plot)).unwrap_or_else(|error| fail(&format!("{to}: {error}")));
}

/// The elapsed seconds of a build, median of five.
fn builds<T: Send>(threads: usize, build: impl Fn() -> T + Sync) -> f64 {
    let one = || {
        let started = Instant::now();
        let built = build();
        let time = started.elapsed().as_secs_f64();
        drop(built);
        time
    };
    on_threads(threads, || median((0..5).map(|_| one()).collect()))
}

/// The memory of a build, measured in a process of its own: this one keeps memory that it has freed.
fn memory_in_new_process(side: usize) -> f64 {
    let program = std::env::current_exe().unwrap_or_else(|error| fail(&error.to_string()));
    let output = std::process::Command::new(program).args(["--memory", &side.to_string()]).output();
    output
        .ok()
        .and_then(|output| String::from_utf8_lossy(&output.stdout).trim().parse().ok())
        .unwrap_or(f64::NAN)
}

/// The memory that a build on two threads takes beside the mesh at most, in relation to its tree, as Linux tells.
pub fn memory_of_build(side: usize) -> f64 {
    let scene = scenes::terrain("terrain", side);
    let status = |field: &str| {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix(field));
        line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(f64::NAN)
    };
    let before = status("VmRSS:");
    // Start the largest value anew.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let wide = on_threads(2, || Wide::build(&scene.triangles));
    1024.0 * (status("VmHWM:") - before) / wide.bytes() as f64
}
