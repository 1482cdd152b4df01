//! Checks of `effects` for scenes with a lens and a shutter.

use super::scenes::one_sphere;
use super::whole::{hidden_lights, judge, plain, with_lights};
use checks::prelude::*;
use raykata::camera::{Lens, Shutter};
use raykata::effects::Effects;
use raykata::material::Material;
use raykata::scene::{Node, Scene};

/// A scene with a lens, a shutter and a sphere that may move.
struct Filmed {
    what: &'static str,
    /// The aperture of the lens.
    lens: Option<f32>,
    /// When the shutter opens and closes.
    shutter: Option<(f32, f32)>,
    sphere: Moving,
    /// The effects `lens` and `motion`.
    expected: [bool; 2],
}

/// How the sphere moves.
#[derive(Clone, Copy, PartialEq)]
enum Moving {
    /// It has one transform.
    No,
    /// It has two transforms.
    Yes,
    /// It has two equal transforms.
    InPlace,
    /// A second sphere, which no root reaches, has two transforms.
    Elsewhere,
}

fn filmed() -> [Filmed; 12] {
    let (open, small) = (Some((0.0, 1.0)), Some(0.1));
    [
        ("a lens of aperture 0", Some(0.0), None, Moving::No, [false, false]),
        ("a lens", small, None, Moving::No, [true, false]),
        ("a lens with a tiny aperture", Some(1e-7), None, Moving::No, [true, false]),
        ("a shutter, and a sphere at rest", None, open, Moving::No, [false, false]),
        ("a moving sphere without a shutter", None, None, Moving::Yes, [false, false]),
        (
            "a moving sphere, and a shutter that closes at the time at which it opens",
            None,
            Some((0.5, 0.5)),
            Moving::Yes,
            [false, false],
        ),
        (
            "a moving sphere, and a shutter that closes before it opens",
            None,
            Some((0.5, 0.25)),
            Moving::Yes,
            [false, false],
        ),
        ("a moving sphere, and a shutter", None, Some((0.25, 0.5)), Moving::Yes, [false, true]),
        ("a moving sphere, a lens and a shutter", small, open, Moving::Yes, [true, true]),
        ("a moving sphere and a lens", small, None, Moving::Yes, [true, false]),
        ("a shutter, and a moving sphere that no root reaches", None, open, Moving::Elsewhere, [false; 2]),
        (
            "a shutter, and a sphere whose transform is the same at both times",
            None,
            open,
            Moving::InPlace,
            [false, false],
        ),
    ]
    .map(|(what, lens, shutter, sphere, expected)| Filmed { what, lens, shutter, sphere, expected })
}

impl Filmed {
    fn scene(&self) -> Scene {
        let mut scene = one_sphere(Material::default());
        let moved = Some(glam::Affine3A::from_translation(Vec3::X));
        match self.sphere {
            Moving::No => {}
            Moving::Yes => scene.nodes[0].transform_end = moved,
            Moving::InPlace => scene.nodes[0].transform_end = Some(scene.nodes[0].transform),
            Moving::Elsewhere => {
                let node = Node { transform_end: moved, ..scene.nodes[0].clone() };
                scene.nodes.push(node);
            }
        }
        scene.camera.lens = self.lens.map(|aperture| Lens { aperture, focal_distance: 3.0 });
        scene.camera.shutter = self.shutter.map(|(open, close)| Shutter { open, close });
        scene
    }

    /// Mistakes, each with whether it gives this answer.
    fn mistakes(&self, yours: &Effects) -> Vec<(bool, &'static str)> {
        let [lens, motion] = self.expected;
        let is = |lens, motion| *yours == Effects { lens, motion, ..plain() };
        let (has_lens, has_shutter) = (self.lens.is_some(), self.shutter.is_some());
        let opens = self.shutter.is_some_and(|(open, close)| close > open);
        let moves = self.sphere == Moving::Yes;
        let two_transforms = moves || self.sphere == Moving::InPlace;
        named![
            is(has_lens, motion) => "an aperture of 0 is a pinhole: you test only whether there is a lens",
            is(self.lens.is_some_and(|aperture| aperture > 1e-5), motion) =>
                "you compare the aperture with a fixed limit: every aperture above 0 blurs",
            is(lens && has_shutter, motion) => "an aperture above 0 blurs, with or without a shutter",
            is(false, motion) => "lens stays false, but every aperture above 0 blurs",
            is(lens, motion && has_lens) => "a shape that moves while the shutter is open is blurred, with or without a lens",
            is(lens, has_shutter && moves) =>
                "you ignore when the shutter closes: all rays have the same time if it closes as it opens",
            is(lens, self.shutter.is_some_and(|(open, close)| close >= open) && moves) =>
                "all rays have the same time if the shutter closes as it opens: compare both times by >",
            is(lens, self.shutter.is_some_and(|(open, close)| close != open) && moves) =>
                "a shutter that closes before it opens takes no time: compare both times by >",
            is(lens, opens) => "you ignore the shapes: no shape moves in some of the scenes",
            is(lens, moves) => "without a shutter all rays have time 0: you test only whether a shape moves",
            is(lens, opens && self.sphere != Moving::No) =>
                "you count nodes: a shape that no root reaches does not count, so use shape.moves of scene.shown()",
            is(lens, opens && two_transforms) => "equal transforms at both times are no motion: use shape.moves of scene.shown()",
            is(lens, opens && (moves || self.sphere == Moving::Elsewhere)) => ELSEWHERE,
            is(lens, false) => "you never set motion: a shape that moves while the shutter is open is blurred",
        ].to_vec()
    }
}

const ELSEWHERE: &str = "a shape that no root reaches does not count: use scene.shown()";

pub(super) fn lens_and_time_matter_only_where_they_are_seen(trial: &Trial<'_>) -> CheckResult {
    let lights = hidden_lights(trial);
    let plain = with_lights(plain(), lights.len());
    let filmed = filmed();
    let mut scenes: Vec<Scene> = filmed.iter().map(Filmed::scene).collect();
    scenes.iter_mut().for_each(|scene| scene.lights.extend_from_slice(&lights));
    let law = |filmed: &Filmed, yours: Effects| {
        let [lens, motion] = filmed.expected;
        judge(filmed.what, &yours, &Effects { lens, motion, ..plain.clone() })
    };
    all_hold(compare_formulas(&filmed, trial.kit.effects(&scenes), law, Filmed::mistakes))
}
