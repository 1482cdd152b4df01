//! The reference pictures in `scenes/reference`, with which `raykata view` compares in a hand-out, are those of the solutions.
//! `INSTA_UPDATE=always` writes them: each pixel is the mean of two by two pixels of the picture, in linear light.

use crate::scene::{job, path, rendered, whole};
use glam::Vec3;
use image::RgbImage;
use raykata::film::{Film, decode_srgb, encode_srgb};
use raykata::kit::RenderJob;
use raykata::scene::Scene;

/// The scenes of the stages. Stages 10 and 12 have `scenes/showcase.png`.
const NAMES: [&str; 10] =
    ["stage1", "stage2", "stage3", "stage4", "stage5", "stage6", "stage7", "stage8", "stage9", "cornell"];

/// The number of pixels of the picture per pixel of the record, and per pixel of the comparison, in each direction.
const RECORDED: u32 = 2;
const COMPARED: u32 = 10;

fn picture(scene: &Scene) -> Film {
    rendered(&RenderJob { seed: 0, threads: 0, ..job(scene) }).film.toned(scene.film.tone)
}

#[test]
fn recorded_references_are_the_pictures_of_the_solutions() {
    let writes = std::env::var("INSTA_UPDATE").is_ok_and(|how| how == "always");
    for name in NAMES {
        let mut scene = whole(name);
        let file = path(&format!("reference/{name}")).with_extension("png");
        if writes {
            picture(&scene).means(RECORDED).write_png(&file, encode_srgb).unwrap();
            continue;
        }
        // Compare a small picture, which takes little time, with the means of the record.
        let record: RgbImage = image::open(&file).unwrap().into_rgb8();
        let (width, height) = (scene.film.width, scene.film.height);
        assert_eq!(record.dimensions(), (width / RECORDED, height / RECORDED), "{name}");
        let linear = |byte: u8| decode_srgb(f32::from(byte) / 255.0);
        let bytes = record.pixels().map(|pixel| Vec3::from_array(pixel.0.map(linear))).collect();
        let record = Film { width: width / RECORDED, height: height / RECORDED, pixels: bytes };
        let record = record.means(COMPARED / RECORDED);
        (scene.film.width, scene.film.height) = (width / COMPARED, height / COMPARED);
        scene.quality.samples_per_pixel = scene.quality.samples_per_pixel.clamp(16, 36);
        let small = picture(&scene);
        let off = |(a, b): (&Vec3, &Vec3)| f64::from((*a - *b).abs().element_sum()) / 3.0;
        let mean = record.pixels.iter().zip(&small.pixels).map(off).sum::<f64>() / record.pixels.len() as f64;
        println!("{name}: mean difference {mean:.5}");
        // Random light is noisy with so few samples: 0.020 was measured for the Cornell box, and at most 0.004 for the others.
        let most = if name == "cornell" { 0.04 } else { 0.008 };
        assert!(mean < most, "{name}: {mean}; INSTA_UPDATE=always records the picture again");
    }
}
