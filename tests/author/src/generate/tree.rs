//! Generates a tree for forests: a trunk that forks, and leaves of two triangles.

use glam::{Quat, Vec3, vec3};
use std::f32::consts::TAU;
use std::fmt::Write;

/// The number of forks from the trunk to a twig.
const FORKS: u32 = 5;
/// The number of corners around a branch.
const AROUND: usize = 5;
/// The angle between two leaves around a twig, in radians: the golden angle, so that no leaf lies above another.
const GOLDEN: f32 = 2.399_963;

#[derive(Default)]
struct Tree {
    vertices: Vec<Vec3>,
    bark: Vec<[usize; 3]>,
    leaves: Vec<[usize; 3]>,
    n_branches: u32,
}

/// Returns the tree as an OBJ file, about one unit high, with the materials `bark` and `leaf`.
pub fn obj() -> String {
    let mut tree = Tree::default();
    tree.branch(Vec3::ZERO, Quat::IDENTITY, 0.34, 0.035, FORKS);
    let mut text = String::from("# a tree, made by raykata generate; CC0\n");
    for vertex in &tree.vertices {
        // Five digits give a hundredth of a millimetre on a tree of one metre.
        let _ = writeln!(text, "v {:.5} {:.5} {:.5}", vertex.x, vertex.y, vertex.z);
    }
    for (material, faces) in [("bark", &tree.bark), ("leaf", &tree.leaves)] {
        let _ = writeln!(text, "usemtl {material}");
        for [a, b, c] in faces {
            let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
        }
    }
    text
}

impl Tree {
    /// Adds a tapering branch from `base` along the y axis of `turn`, and the branches or leaves at its end.
    fn branch(&mut self, base: Vec3, turn: Quat, length: f32, radius: f32, forks: u32) {
        let number = self.n_branches;
        self.n_branches += 1;
        let top = base + length * (turn * Vec3::Y);
        let first = self.vertices.len();
        for (center, radius) in [(base, radius), (top, 0.65 * radius)] {
            for i in 0..AROUND {
                let angle = TAU * i as f32 / AROUND as f32;
                self.vertices.push(center + radius * (turn * vec3(angle.cos(), 0.0, angle.sin())));
            }
        }
        for i in 0..AROUND {
            let (a, b) = (first + i, first + (i + 1) % AROUND);
            self.bark.extend([[a, a + AROUND, b], [b, a + AROUND, b + AROUND]]);
        }
        if forks == 0 {
            (0..5).for_each(|leaf| self.leaf(base.lerp(top, 0.4 + 0.15 * leaf as f32), turn, leaf as f32));
            return;
        }
        // Each fork has three twigs. The golden angle rotates them from fork to fork.
        for i in 0..3 {
            let around = Quat::from_rotation_y(TAU * i as f32 / 3.0 + GOLDEN * number as f32);
            let lean = Quat::from_rotation_z(0.5 + 0.07 * (number % 5) as f32);
            let (length, radius) = ((0.74 - 0.05 * i as f32) * length, 0.6 * radius);
            self.branch(top, turn * around * lean, length, radius, forks - 1);
        }
    }

    fn leaf(&mut self, at: Vec3, turn: Quat, number: f32) {
        let turn = turn * Quat::from_rotation_y(GOLDEN * number) * Quat::from_rotation_z(1.1);
        let first = self.vertices.len();
        let outline = [
            vec3(0.0, 0.0, 0.0),
            vec3(0.012, 0.025, 0.016),
            vec3(0.0, 0.06, 0.0),
            vec3(0.012, 0.025, -0.016),
        ];
        self.vertices.extend(outline.map(|corner| at + turn * corner));
        self.leaves.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
}
