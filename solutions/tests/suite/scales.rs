//! A scene that is scaled by 2^k, from k = -60 to 60, with its camera, gives the same picture bit for bit: no rounding
//! and no comparison with a fixed number depends on the size. First hits are the same from k = -100 to 100.
//!
//! The limits are those of squares in single precision, which glam's lengths and scalar products compute: the square of
//! 2^-60 is near the smallest normal number, that of 2^60 near the largest. Intersection tests compute in double precision.

use crate::scene::{job, render, scene};
use oracle::splitmix::Random;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Scene};

/// Shapes of size `2^k` with a mirror, glass and shadows of a directional light, which does not get weaker with the
/// distance.
fn scaled(k: i32) -> Scene {
    let size = |x: f32| x * 2f32.powi(k);
    let at = |x: f32, y: f32, z: f32| format!("[{:e}, {:e}, {:e}]", size(x), size(y), size(z));
    scene(&format!(
        r#"
film = {{ width = 40, height = 30 }}
camera = {{ position = {eye}, look_at = {middle} }}
[environment]
background = [0.2, 0.3, 0.5]
ambient = 0.1
[quality]
max_depth = 3
[materials.matt]
diffuse = [0.6, 0.5, 0.3]
specular = 0.3
exponent = 20
[materials.mirror]
diffuse = 0.1
mirror = 0.7
[textures.picture]
file = "images/bricks.png"
[materials.picture]
texture = "picture"
mirror = 0.2
[materials.glass]
transmission = 0.9
index_of_refraction = 1.5
fresnel = "schlick"
[[lights]]
directional = {{ direction = [-0.4, -1.0, -0.3] }}
[[nodes]]
material = "matt"
shape = {{ plane = {{ point = {below}, normal = [0, 1, 0] }} }}
[[nodes]]
material = "mirror"
shape = {{ sphere = {{ center = {left}, radius = {radius:e} }} }}
[[nodes]]
material = "glass"
shape = {{ sphere = {{ center = {right}, radius = {radius:e} }} }}
[[nodes]]
material = "matt"
shape = {{ triangle = {{ a = {a}, b = {b}, c = {c} }} }}
[[nodes]]
material = "mirror"
shape = {{ triangle = {{ a = {a}, b = {c}, c = {d} }} }}
[[nodes]]
material = "picture"
transform = [{{ rotate = {{ axis = [1, 2, 3], degrees = 40 }} }}, {{ translate = {front} }}]
shape = {{ sphere = {{ center = [0, 0, 0], radius = {small:e} }} }}
[[nodes]]
material = "matt"
transform = [{{ rotate = {{ axis = [0, 1, 0], degrees = 30 }} }}, {{ translate = {front} }}]
shape = {{ box = {{ min = {low}, max = {high} }} }}
[[nodes]]
material = "matt"
transform = [{{ rotate = {{ axis = [0, 1, 0], degrees = 30 }} }}, {{ translate = {front} }}]
shape = {{ cylinder = {{ base = {low}, top = {above}, radius = {small:e} }} }}
[[nodes]]
material = "matt"
transform = [{{ rotate = {{ axis = [0, 1, 0], degrees = 30 }} }}, {{ translate = {front} }}]
shape = {{ cone = {{ base = {high}, apex = {above}, radius = {small:e} }} }}
[[nodes]]
material = "matt"
transform = [{{ rotate = {{ axis = [0, 1, 0], degrees = 30 }} }}, {{ translate = {front} }}]
shape = {{ disk = {{ center = {above}, normal = [0.2, 1, 1], radius = {small:e} }} }}
"#,
        eye = at(0.5, 1.0, 6.0),
        middle = at(0.0, 0.3, 0.0),
        below = at(0.0, -1.0, 0.0),
        left = at(-1.4, 0.0, 0.5),
        right = at(1.3, 0.1, 1.5),
        front = at(0.1, -0.5, 2.5),
        low = at(-1.3, -0.4, -0.2),
        high = at(-0.7, 0.1, 0.3),
        above = at(-0.9, 0.9, 0.4),
        radius = size(0.9),
        small = size(0.3),
        a = at(-1.0, -0.9, -1.5),
        b = at(2.2, -0.8, -1.0),
        c = at(0.4, 2.1, -1.2),
        d = at(-2.0, 1.5, -2.5),
    ))
}

#[test]
fn a_picture_does_not_depend_on_the_size_of_the_scene() {
    let one = render(&scaled(0)).film;
    for k in [-60, -45, -30, -12, 7, 25, 40, 60] {
        let other = render(&scaled(k)).film;
        let differ = one.pixels.iter().zip(&other.pixels).filter(|(p, q)| p != q).count();
        assert_eq!(differ, 0, "scaled by 2^{k}, {differ} of 1200 pixels differ");
    }
}

#[test]
fn first_hits_do_not_depend_on_the_size_of_the_scene() {
    let mut random = Random::new(1, 0);
    let rays: Vec<Ray> = (0..4000)
        .map(|_| {
            let origin = 3.0 * random.in_cube();
            Ray::new(origin, if random.below(2) == 0 { random.direction() } else { -origin })
        })
        .collect();
    for accelerator in [Accelerator::BruteForce, Accelerator::Bvh, Accelerator::KdTree, Accelerator::Grid] {
        let hits = |k: i32| {
            let mut scene = scaled(k);
            scene.quality.accelerator = accelerator;
            let size = 2f32.powi(k);
            // Directions keep their lengths, so t has the size of the scene.
            let rays: Vec<Ray> = rays.iter().map(|ray| Ray::new(size * ray.origin, ray.direction)).collect();
            let hits = solutions::kit().first_hits(&job(&scene), &rays);
            hits.into_iter().map(|hit| hit.map(|hit| (hit.primitive, hit.t / size))).collect::<Vec<_>>()
        };
        let one = hits(0);
        for k in [-100, -75, -60, -20, 20, 60, 75, 100] {
            let differ = one.iter().zip(hits(k)).filter(|(one, other)| *one != other).count();
            assert_eq!(differ, 0, "scaled by 2^{k}, {accelerator:?}: {differ} of {} rays differ", rays.len());
        }
    }
}
