//! Textures and meshes, which need a second file.

use super::{CAMERA, showing_all};
use crate::files::error::LoadError;
use crate::files::scene::{Limits, parse, parse_within};
use crate::material::{Material, Wrap};
use crate::scene::{Background, EnvironmentMap, Scene};
use crate::tests::folder::Folder;
use glam::Vec3;

/// Reads `text` behind a camera, and shows all of its meshes and textures, as if it lay in this folder.
fn parse_in(folder: &Folder, text: &str) -> Result<Scene, LoadError> {
    parse(&folder.path("s.toml"), &showing_all(&format!("{CAMERA}{text}")))
}

/// The message, without the path of the file in front, and its help.
fn trouble(result: Result<Scene, LoadError>) -> (Option<(usize, usize)>, String, String) {
    let error = result.expect_err("the scene should be refused");
    (error.place, error.message, error.help.unwrap_or_default())
}

#[test]
fn an_image_is_decoded_to_linear_light() {
    let folder = Folder::new("textures");
    let pixels = image::RgbImage::from_raw(2, 1, vec![0, 255, 188, 10, 0, 0]).expect("six bytes");
    pixels.save(folder.path("wood.png")).expect("a texture");
    let scene = parse_in(
        &folder,
        "[textures.wood]\nfile = 'wood.png'\nwrap = 'mirror'\n[materials.m]\ntexture = 'wood'",
    )
    .expect("a scene");
    let texture = &scene.textures[0];
    assert_eq!((texture.width, texture.height, texture.wrap), (2, 1, Wrap::Mirror));
    // Code 188 is middle grey: ((188/255 + 0.055) / 1.055)^2.4 = 0.5029; code 10 lies on the linear part:
    // 10/255/12.92.
    assert!((texture.pixels[0] - Vec3::new(0.0, 1.0, 0.502_886)).abs().max_element() < 1e-6);
    assert!((texture.pixels[1].x - 0.003_035_27).abs() < 1e-8);
    assert_eq!(scene.materials[1].texture, Some(0));
}

#[test]
fn finer_images_keep_their_fineness() {
    let folder = Folder::new("fine");
    let code = |code: u16| image::ImageBuffer::from_pixel(1, 1, image::Luma([code]));
    code(32_768).save(folder.path("grey.png")).expect("a texture");
    let bright = image::Rgb32FImage::from_pixel(1, 1, image::Rgb([4.0, 0.5, 0.0]));
    bright.save(folder.path("sky.hdr")).expect("a texture");
    let scene =
        parse_in(&folder, "[textures]\ngrey.file = 'grey.png'\nsky = { file = 'sky.hdr', wrap = 'clamp' }")
            .expect("a scene");
    // ((32768/65535 + 0.055) / 1.055)^2.4; 8 bits would give 0.2159 for code 128.
    assert!((scene.textures[0].pixels[0] - Vec3::splat(0.214_053)).abs().max_element() < 1e-5);
    assert_eq!(scene.textures[1].pixels[0], Vec3::new(4.0, 0.5, 0.0)); // powers of two are exact in RGBE
    assert_eq!(scene.textures[1].wrap, Wrap::Clamp);
}

#[test]
fn an_environment_map_is_an_image_around_the_scene() {
    let folder = Folder::new("environment");
    let mut bright = image::Rgb32FImage::from_pixel(2, 1, image::Rgb([4.0, 0.5, 0.0]));
    bright.save(folder.path("even.hdr")).expect("an image");
    bright.put_pixel(1, 0, image::Rgb([0.0; 3]));
    bright.save(folder.path("sky.hdr")).expect("an image");
    let parse =
        |map: &str| parse_in(&folder, &format!("environment.background = {{ {map} }}")).expect("a scene");
    let scene = parse("file = 'sky.hdr', rotation = 180, scale = 2");
    let map = EnvironmentMap { texture: 0, rotation: std::f32::consts::PI, scale: 2.0 };
    assert_eq!(scene.background, Background::Map(map));
    assert_eq!(scene.textures[0].pixels[..], [Vec3::new(4.0, 0.5, 0.0), Vec3::ZERO]);
    // A map that is the same in all directions is a colour.
    assert_eq!(parse("file = 'sky.hdr', scale = 0").background, Background::Color(Vec3::ZERO));
    let even = parse("file = 'even.hdr', scale = 2").background;
    assert_eq!(even, Background::Color(Vec3::new(8.0, 1.0, 0.0)));

    // The size of the image is known from its header; 4 GB are enough for 100 million pixels.
    folder.write("large.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 40000\n");
    let (_, message, _) = trouble(parse_in(&folder, "environment.background.file = 'large.hdr'"));
    assert!(message.starts_with("an image of 40000 by 20000 pixels takes about 32.0 GB"), "{message}");
}

#[test]
fn a_name_that_the_system_refuses_is_an_error() {
    let (_, message, _) = trouble(parse_in(&Folder::new("names"), "meshes.bunny.file = \"\\u0000\""));
    assert_eq!(message, "the file name `\\u{0}` contains a control character");
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
const MTL: &str = "newmtl red\nKd 1 0 0\nd 0.25\n";

#[test]
fn a_mesh_comes_with_its_materials_unless_the_scene_knows_better() {
    let folder = Folder::new("meshes");
    folder.write("m.ply", PLY);
    folder.write("m.obj", OBJ);
    folder.write("m.mtl", MTL);
    let scene = parse_in(&folder, "[meshes.p]\nfile = 'm.ply'\nsmooth = false\n[meshes.o]\nfile = 'm.obj'\n")
        .expect("a scene");
    assert_eq!(scene.meshes[0].mesh.triangles, [[0, 1, 2]]);
    assert_eq!(scene.meshes[0].mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(scene.meshes.iter().map(|mesh| mesh.smooth).collect::<Vec<_>>(), [false, true]);
    assert_eq!((&scene.meshes[0].materials, &scene.meshes[1].materials), (&vec![], &vec![1]));
    assert_eq!(scene.material_names, ["default", "o/red"]);
    let red = Material {
        ambient: 0.25 * Vec3::X,
        diffuse: 0.25 * Vec3::X,
        transmission: Vec3::splat(0.75),
        ..Material::default()
    };
    assert_eq!(scene.materials[1], red);

    let scene = parse_in(&folder, "[materials.red]\n[meshes.o]\nfile = 'm.obj'\n").expect("a scene");
    assert_eq!((scene.materials.len(), &scene.meshes[0].materials), (2, &vec![1]));
    let scene = parse_in(&folder, "[meshes.o]\nfile = 'm.obj'\nmaterials = false").expect("a scene");
    assert_eq!((scene.materials.len(), scene.meshes[0].materials.len()), (1, 0));

    // If another name is defined, faces with this one get the default.
    folder.write("m.obj", format!("{OBJ}usemtl blue\nf 1 3 2\n"));
    let scene = parse_in(&folder, "[meshes.o]\nfile = 'm.obj'\n").expect("a scene");
    assert_eq!(scene.meshes[0].materials, [1, 0]);
}

#[test]
fn memory_is_bounded_before_it_is_allocated() {
    let folder = Folder::new("memory");
    image::GrayImage::new(1000, 1000).save(folder.path("large.png")).expect("a texture");
    let limits = Limits { memory: 30_000_000 };
    let refused = |text: &str| {
        let text = showing_all(&format!("{CAMERA}film = {{ width = 10, height = 10 }}\n{text}"));
        let error = parse_within(&folder.path("s.toml"), &text, limits).expect_err("a limit");
        (error.place, error.message, error.help.unwrap_or_default())
    };
    let (place, message, help) = refused("textures.wood.file = 'large.png'");
    assert_eq!(place, Some((3, 22)));
    assert!(
        message.starts_with("an image of 1000 by 1000 pixels takes about 40.0 MB, and with"),
        "{message}"
    );
    assert_eq!(help, "make it smaller, or allow more memory: at least `--memory 1`");
    // Each of 100 patches fits, but not all.
    let net = "rows = [[[0,0,0],[1,0,0],[2,0,0],[3,0,0]],[[0,1,0],[1,1,0],[2,1,0],[3,1,0]],\
               [[0,2,0],[1,2,0],[2,2,0],[3,2,0]],[[0,3,0],[1,3,0],[2,3,0],[3,3,0]]]";
    let patch = format!("[[nodes]]\nshape = {{ bezier = {{ {net}, steps = 50 }} }}\n");
    let (place, message, _) = refused(&patch.repeat(100));
    assert_eq!(place.map(|(line, _)| line), Some(62), "{message}");
    assert!(message.starts_with("a surface of 5000 triangles takes about"), "{message}");
    // Two spans of 200 squares along u, one along v.
    let net = "rows = [[[0,0,0],[1,0,0],[2,0,0]],[[0,1,0],[1,1,0],[2,1,0]]], degree = 1";
    let (place, message, _) =
        refused(&format!("[[nodes]]\nshape = {{ bspline = {{ {net}, steps = 200 }} }}\n"));
    assert_eq!(place.map(|(line, _)| line), Some(4), "{message}");
    assert!(message.starts_with("a surface of 160000 triangles takes about"), "{message}");
    folder.write("m.ply", PLY);
    let (place, ..) = refused("[meshes.m]\nfile = 'm.ply'\nsubdivide = 9\n");
    assert_eq!(place.map(|(line, _)| line), Some(5));
}

/// A PNG file may say how its numbers are encoded, and the scene knows better.
#[test]
fn an_image_is_decoded_by_the_curve_that_it_states() {
    let folder = Folder::new("curves");
    let file = folder.path("grey.png");
    image::GrayImage::from_pixel(1, 1, image::Luma([51])).save(&file).expect("an image");
    let plain = std::fs::read(&file).expect("the image");
    // The exponent times 100,000, and the checksum of the chunk.
    let with_gamma = |gamma: u32, checksum: [u8; 4]| {
        let chunk = [&[0, 0, 0, 4], &b"gAMA"[..], &gamma.to_be_bytes(), &checksum].concat();
        let after_header = 33;
        [&plain[..after_header], &chunk, &plain[after_header..]].concat()
    };
    let srgb = ((51.0 / 255.0 + 0.055) / 1.055f32).powf(2.4);
    for (bytes, encoding, expected) in [
        (plain.clone(), "", srgb),
        (plain.clone(), "encoding = 'linear'", 0.2),
        (with_gamma(100_000, [49, 232, 150, 95]), "", 0.2),
        (with_gamma(45_455, [11, 252, 97, 5]), "", srgb),
        (with_gamma(50_000, [0, 153, 181, 52]), "", 0.04),
        (with_gamma(100_000, [49, 232, 150, 95]), "encoding = 'srgb'", srgb),
    ] {
        folder.write("grey.png", bytes);
        let scene =
            parse_in(&folder, &format!("[textures.grey]\nfile = 'grey.png'\n{encoding}\n")).expect("a scene");
        let grey = scene.textures[0].pixels[0].x;
        assert!((grey - expected).abs() < 1e-6, "{grey} for {expected}, {encoding}"); // a few roundings of a power
    }
}
