//! Zeros of both signs, denormal numbers and the largest numbers everywhere in a scene: each scene is refused
//! with an error that names the place, or is rendered without NaN.

use crate::scene::render;
use glam::Vec3;
use oracle::splitmix::Random;
use raykata::material::{Texture, Wrap};
use raykata::scene::{Accelerator, load};
use std::path::Path;
use std::sync::Arc;

/// Ordinary numbers, which are the most frequent, so that many scenes can be rendered.
const ORDINARY: [&str; 6] = ["0.5", "-1.0", "2.0", "0.25", "1.0", "-0.125"];
const FINITE: [&str; 7] =
    ["0.0", "-0.0", "1e-40", "-1e-40", "3.4028235e38", "-3.4028235e38", "1.1754944e-38"];
const ENDLESS: [&str; 3] = ["inf", "-inf", "nan"];

/// A scene with every shape and light; each `#` is replaced by a number.
const SCENE: &str = r#"
film = { width = 10, height = 8 }
[camera]
position = [#, 0.25, 6.0]
look_at = [0, 0, 0]
lens = { aperture = 0.01, focal_distance = 5.0 }
shutter = { open = 0, close = 1 }
[environment]
background = { zenith = 0.2, horizon = 0.4 }
ambient = 0.1
[quality]
samples_per_pixel = 2
texture_filter = "mipmap"
max_depth = 3
[materials.glass]
diffuse = 0.2
mirror = 0.3
transmission = 0.5
index_of_refraction = 1.5
roughness = 0.2
[materials.matt]
diffuse = [0.5, 0.4, 0.3]
specular = 0.3
exponent = 20
emission = 0.1
[[lights]]
point = { position = [#, 5.0, #] }
[[lights]]
area = { sphere = { center = [#, 4.0, #], radius = 0.5 } }
visible = true
[[lights]]
area = { rectangle = { corner = [#, 4.0, #], edges = [[1.0, 0.0, #], [0.0, 0.5, 1.0]] } }
visible = true
[[nodes]]
material = "glass"
shape = { sphere = { center = [#, #, #], radius = # } }
[[nodes]]
material = "matt"
shape = { plane = { point = [#, #, #], normal = [#, 1.0, #] } }
[[nodes]]
material = "glass"
transform_end = [{ translate = [#, 0.0, #] }]
shape = { triangle = { a = [#, #, #], b = [#, 1.0, #], c = [1.0, #, #] } }
[[nodes]]
material = "matt"
shape = { box = { min = [#, #, #], max = [4.0, 4.0, 4.0] } }
transform = [{ translate = [#, #, #] }]
"#;

fn fill(random: &mut Random, rate: f32) -> String {
    let mut parts = SCENE.split('#');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let list: &[&str] = match () {
            () if random.unit() >= rate => &ORDINARY,
            () if random.below(12) == 0 => &ENDLESS,
            () => &FINITE,
        };
        text += list[random.below(list.len() as u64) as usize];
        text += part;
    }
    text
}

#[test]
fn numbers_that_break_formulas_break_no_picture() {
    let pixels = Arc::new((0..64).map(|index| Vec3::splat((index % 7) as f32)).collect());
    let image = Texture { width: 8, height: 8, pixels, wrap: Wrap::Mirror };
    let (mut rendered, mut refused) = (0, 0);
    for n in 0..4000 {
        let mut random = Random::new(79, n);
        let text = fill(&mut random, [0.1, 0.2, 0.5][n as usize % 3]);
        let mut scene = match load::parse(Path::new("specials.toml"), &text) {
            Ok(scene) => scene,
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with("specials.toml:") && message.len() > 30, "{message}\n{text}");
                refused += 1;
                continue;
            }
        };
        // Show an image on every shape.
        scene.textures.push(image.clone());
        scene.materials.iter_mut().for_each(|material| material.texture = Some(0));
        for accelerator in [Accelerator::Bvh, Accelerator::BruteForce] {
            scene.quality.accelerator = accelerator;
            let bad = render(&scene).film.pixels.iter().filter(|pixel| !pixel.is_finite()).count();
            assert_eq!(bad, 0, "{bad} pixels are not finite, {accelerator:?}\n{text}");
        }
        rendered += 1;
    }
    assert!(rendered >= 600 && refused >= 600, "{rendered} rendered, {refused} refused");
}
