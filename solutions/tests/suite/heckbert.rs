//! Heckbert's business card: the picture of `scenes/heckbert.toml` is that of the program on the slide.
//!
//! `tests/golden/heckbert_corners.txt` is the output of that program without its first line, the size. To make it again, save the
//! text of the slide as `card.c`, give its `printf` the three numbers `U.x,U.y,U.z` (it passes the structure, which worked on the
//! machines of 1987), and mend two misprints: `if(((e=` has one parenthesis less, and the colour of the third sphere, `1.,8.,8`, is
//! `.1,.8,.8`, as in Graphics Gems IV:
//!
//! ```sh
//! gcc -std=gnu89 -w card.c -o card -lm && ./card | sed 1d
//! ```
//!
//! The card samples the upper left corners of pixels, the kit their centres. `heckbert_centers.txt` is the output after
//! `yx%32-32/2` has become `yx%32-32/2+.5`, and `32/2-yx++/32` has become `32/2-.5-yx++/32`.

use crate::scene::{render, whole};
use raykata::camera::Camera;
use raykata::scene::Scene;

/// The upper left 32 by 32 pixels are those of a program's output, in steps of 1/255.
#[track_caller]
fn assert_card(scene: &Scene, output: &str) {
    let film = render(scene).film;
    let mut expected = output.split_whitespace().map(|number| number.parse::<f32>().expect("a number"));
    for (x, y) in (0..32).flat_map(|y| (0..32).map(move |x| (x, y))) {
        let pixel = 255.0 * film.pixels[(y * film.width + x) as usize];
        for yours in pixel.to_array() {
            let other = expected.next().expect("three numbers per pixel");
            // The program rounds to whole numbers: half a step, and a hundredth for single precision here.
            assert!((yours - other).abs() <= 0.51, "column {x}, row {y}: {pixel}, the card has {other}");
        }
    }
    assert_eq!(expected.next(), None);
}

#[test]
fn the_business_card_is_the_picture_of_its_program() {
    assert_card(&whole("heckbert"), include_str!("../../../tests/golden/heckbert_centers.txt"));
}

/// In a picture of 33 by 33 pixels of the same size, the centres are the corners of the card's pixels.
#[test]
fn the_business_card_is_that_of_the_unchanged_program() {
    let mut scene = whole("heckbert");
    (scene.film.width, scene.film.height) = (33, 33);
    let half_height = (12.5f64.to_radians().tan() * 33.0 / 32.0) as f32;
    let degrees = 2.0 * half_height.atan().to_degrees();
    let Camera { position, towards, up, .. } = scene.camera;
    scene.camera = Camera::new(position, towards, up, degrees, 1.0).expect("a camera");
    assert_card(&scene, include_str!("../../../tests/golden/heckbert_corners.txt"));
}
