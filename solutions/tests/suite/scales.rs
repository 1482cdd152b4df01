//! A scene that is scaled by 2^k, from k = -45 to 60, with its camera, gives the same picture bit for bit: no rounding
//! and no comparison with a fixed number depends on the size.

use crate::frames::render;
use crate::scene::scene;
use raykata::scene::Scene;

/// Shapes of size `2^k` with a mirror, glass and shadows of a directional light, which does not get weaker with the
/// distance.
fn scaled(k: i32) -> Scene {
    let size = |x: f32| x * 2f32.powi(k);
    let at = |x: f32, y: f32, z: f32| format!("[{:e}, {:e}, {:e}]", size(x), size(y), size(z));
    scene(&format!(
        r#"
[film]
width = 40
height = 30
[camera]
position = {eye}
look_at = {middle}
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
"#,
        eye = at(0.5, 1.0, 6.0),
        middle = at(0.0, 0.3, 0.0),
        below = at(0.0, -1.0, 0.0),
        left = at(-1.4, 0.0, 0.5),
        right = at(1.3, 0.1, 1.5),
        radius = size(0.9),
        a = at(-1.0, -0.9, -1.5),
        b = at(2.2, -0.8, -1.0),
        c = at(0.4, 2.1, -1.2),
        d = at(-2.0, 1.5, -2.5),
    ))
}

#[test]
fn a_picture_does_not_depend_on_the_size_of_the_scene() {
    let one = render(&scaled(0)).film;
    // Below 2⁻⁴⁵ the squared half chord of a grazed sphere becomes a denormal number: at 2⁻⁶⁰ one pixel differs.
    for k in [-45, -30, -12, 7, 25, 40, 60] {
        let other = render(&scaled(k)).film;
        let differ = one.pixels.iter().zip(&other.pixels).filter(|(p, q)| p != q).count();
        assert_eq!(differ, 0, "scaled by 2^{k}, {differ} of 1200 pixels differ");
    }
}
