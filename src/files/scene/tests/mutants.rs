//! The reader ends without a panic on any text, and every error points into the file.

use super::{CAMERA, parse};
use std::ops::Range;
use std::path::Path;
use toml::de::DeTable;

/// A scene with one example of everything that needs no other file.
const SCENE: &str = "
[film]
width = 64
encoding = 'gamma2'
[camera]
position = [0, 1, 5]
look_at = [0, 0, 0]
lens = { aperture = 0.1, focal_distance = 5.0 }
shutter = { open = 0.0, close = 1.0 }
[environment]
ambient = 0.1
[quality]
split = 'surface_area'
[materials.red]
diffuse = [0.8, 1e-1, 0x0]
index_of_refraction = 1.5
[[lights]]
area = { rectangle = { corner = [0, 5, 0], edges = [[1, 0, 0], [0, 0, 1]] }, falloff = 'none' }
visible = true
[[lights]]
directional = { direction = [0, -1, 0] }
intensity = 2
[[nodes]]
name = 'a'
children = ['b']
transform = [{ scale = 2 }, { rotate = { axis = [0, 1, 0], degrees = 30 } }]
transform_end = [{ matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]] }]
[[nodes]]
name = 'b'
material = 'red'
shape = { polygon = { corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] } }
[[nodes]]
shape = { cone = { base = [0, 0, 0], apex = [0, 1, 0], radius = 1 } }
[[nodes]]
shape = { box = { min = [0, 0, 0], max = [1, 1, 1] } }
";

/// Fragments from which mistakes are made.
const SCRAPS: [&str; 36] = [
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "1e-50",
    "99999999999999999999",
    "3.4e38",
    "0x",
    "[",
    "]",
    "{",
    "}",
    "'",
    "\"",
    "\"\"\"",
    "=",
    ",",
    ".",
    "\n",
    "\r",
    "#",
    "[[nodes]]\n",
    "[nodes]\n",
    "[materials]\n",
    "'a'",
    "'b'",
    "true",
    "1979-05-27",
    "é",
    "\u{feff}",
    "\0",
    "[[lights]]\n",
    "mesh = 'm'",
    "\\u0000",
    "texture = 't'",
];

/// Steps of Knuth's MMIX generator; the upper half is random enough to make mistakes.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit
    }

    /// A place between two characters of `text`.
    fn place(&mut self, text: &str) -> usize {
        let place = self.below(text.len() + 1);
        (0..=place).rev().find(|&place| text.is_char_boundary(place)).unwrap_or(0)
    }
}

/// The word or number at or after some place of `text`.
fn word(text: &str, random: &mut Random) -> Range<usize> {
    let is_word = |c: char| c.is_alphanumeric() || "._+-".contains(c);
    let place = random.place(text);
    let start = text[place..].find(is_word).map_or(text.len(), |start| place + start);
    let end = text[start..].find(|c| !is_word(c)).map_or(text.len(), |end| start + end);
    start..end
}

/// Makes one mistake: a word replaced by another, which is often valid TOML, or a fragment anywhere, which seldom is.
fn mutate(text: &mut String, random: &mut Random) {
    let target = word(text, random);
    let other = text[word(text, random)].to_string();
    let scrap = SCRAPS[random.below(SCRAPS.len())];
    let place = random.place(text);
    match random.below(5) {
        0 => text.replace_range(target, ""),
        1 => text.replace_range(target, scrap),
        2 | 3 => text.replace_range(target, &other),
        _ => text.insert_str(place, scrap),
    }
}

#[test]
fn no_text_makes_the_reader_panic() {
    assert!(parse(Path::new("s.toml"), SCENE).is_ok());
    let mut random = Random(1);
    let (mut sound, mut syntax) = (0, 0);
    for round in 0..20_000 {
        let mut text = SCENE.to_string();
        for _ in 0..=random.below(3) {
            mutate(&mut text, &mut random);
        }
        // A panic fails the test, with the round as the seed of the mistake.
        let result = std::panic::catch_unwind(|| parse(Path::new("s.toml"), &text));
        match result.unwrap_or_else(|_| panic!("round {round} panics on\n{text}")) {
            Ok(_) => sound += 1,
            Err(error) => {
                syntax += u32::from(DeTable::parse(&text).is_err());
                assert!(error.place.is_some(), "round {round}: {error:?}");
                assert!(error.span.start <= error.span.end && error.span.end <= text.len(), "{error:?}");
                assert!(error.message.chars().all(|c| !c.is_control()), "round {round}: {error:?}");
            }
        }
    }
    // If all mistakes ended in the TOML parser, the test would not reach the reader.
    assert!(
        syntax < 15_000 && sound > 200,
        "{syntax} of 20000 mutants are invalid TOML, {sound} are valid scenes"
    );
}

#[test]
fn every_beginning_of_a_scene_is_read_to_its_end() {
    let scene = format!("{CAMERA}{}", &SCENE[SCENE.find("[environment]").unwrap_or(0)..]);
    for end in 0..=scene.len() {
        let _ = parse(Path::new("s.toml"), &scene[..end]);
    }
}
