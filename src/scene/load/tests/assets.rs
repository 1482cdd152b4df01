//! Materials, textures, meshes and lights.

use super::{CAMERA, check_refused_with, scene_with};
use crate::material::{AreaShape, Emitter, Falloff, Light, Material, Wrap};
use crate::scene::Scene;
use crate::scene::error::LoadError;
use crate::scene::load::parse;
use crate::shape::{Disk, Sphere};
use glam::Vec3;
use std::path::{Path, PathBuf};

/// A folder that goes away with its value.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("raykata-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder for the test");
        Folder(path)
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(super) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("a file for the test");
    }

    /// Reads `text` behind a camera as if it lay in this folder.
    fn parse(&self, text: &str) -> Result<Scene, LoadError> {
        parse(&self.path("s.toml"), &format!("{CAMERA}{text}"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The message, without the path of the file in front, and its help.
fn trouble(result: Result<Scene, LoadError>) -> (Option<(usize, usize)>, String, String) {
    let error = result.expect_err("the scene should be refused");
    (error.place, error.message, error.help.unwrap_or_default())
}

#[test]
fn materials_keep_their_order_and_default_comes_first() {
    let scene = scene_with(
        "[materials.red]\ndiffuse = [1, 0, 0]\nexponent = 5\n\
         [materials.glass]\ntransmission = 0.9\nindex_of_refraction = 1.5\nambient = 0\nroughness = 1\n\
         mirror = 0.1\nspecular = 2\nemission = 3\n\
         [materials.default]\ndiffuse = 0.25\n",
    );
    assert_eq!(scene.material_names, ["default", "red", "glass"]);
    let grey = Vec3::splat(0.25);
    assert_eq!(scene.materials[0], Material { ambient: grey, diffuse: grey, ..Material::default() });
    assert_eq!(
        scene.materials[1],
        Material { ambient: Vec3::X, diffuse: Vec3::X, exponent: 5.0, ..Material::default() }
    );
    let glass = Material {
        ambient: Vec3::ZERO,
        transmission: Vec3::splat(0.9),
        index_of_refraction: 1.5,
        roughness: 1.0,
        mirror: Vec3::splat(0.1),
        specular: Vec3::splat(2.0),
        emission: Vec3::splat(3.0),
        ..Material::default()
    };
    assert_eq!(scene.materials[2], glass);
}

#[test]
fn materials_have_limits() {
    let red = |rest: &str, message: &str| {
        check_refused_with(&format!("[materials.red]\n{rest}"), &format!("s.toml:{message}"));
    };
    red("index_of_refraction = 0", "3:23: `index_of_refraction` must be above 0, and is 0");
    red("roughness = 1.5", "3:13: `roughness` must be from 0 to 1, and is 1.5");
    red("exponent = -1", "3:12: `exponent` must be at least 0, and is -1");
    red("diffuse = [inf, 0, 0]", "3:12: entry 1 of `diffuse` must be a finite number, and is inf");
    red("texture = 'wood'", "3:11: unknown texture `wood`\nhelp: the scene defines none");
}

#[test]
fn an_image_is_decoded_to_linear_light() {
    let folder = Folder::new("textures");
    let pixels = image::RgbImage::from_raw(2, 1, vec![0, 255, 188, 10, 0, 0]).expect("six bytes");
    pixels.save(folder.path("wood.png")).expect("a texture");
    let scene = folder
        .parse("[textures.wood]\nfile = 'wood.png'\nwrap = 'mirror'\n[materials.m]\ntexture = 'wood'")
        .expect("a scene");
    let texture = &scene.textures[0];
    assert_eq!((texture.width, texture.height, texture.wrap), (2, 1, Wrap::Mirror));
    // Code 188 is middle grey: ((188/255 + 0.055) / 1.055)^2.4 = 0.5029; code 10 lies on the line: 10/255/12.92.
    assert!((texture.pixels[0] - Vec3::new(0.0, 1.0, 0.502_886)).abs().max_element() < 1e-6);
    assert!((texture.pixels[1].x - 0.003_035_27).abs() < 1e-8);
    assert_eq!(scene.materials[1].texture, Some(0));
}

#[test]
fn files_that_cannot_be_used_say_why() {
    let folder = Folder::new("missing");
    folder.write("wood.png", "not a picture");
    folder.write("bunny.stl", "solid");
    let (place, message, help) = trouble(folder.parse("textures.wood.file = 'wod.png'"));
    assert_eq!((place, message.as_str()), (Some((2, 22)), "there is no file `wod.png`"));
    assert_eq!(help, format!("looked for {}; did you mean `wood.png`?", folder.path("wod.png").display()));

    let (place, message, help) = trouble(folder.parse("meshes.bunny.file = 'no/bunny.ply'"));
    assert_eq!((place, message.as_str()), (Some((2, 21)), "there is no file `no/bunny.ply`"));
    let (path, parent) = (folder.path("no/bunny.ply"), folder.path("no"));
    assert_eq!(help, format!("looked for {}, and there is no folder {}", path.display(), parent.display()));

    let (place, message, help) = trouble(folder.parse("textures.wood.file = 'wood.png'"));
    assert_eq!(place, Some((2, 22)));
    assert!(message.starts_with("cannot use 'wood.png' as a texture: "), "{message}");
    assert_eq!(help, "textures are PNG or Radiance HDR files");

    let (_, message, help) = trouble(folder.parse("meshes.bunny.file = 'bunny.stl'"));
    assert_eq!(
        (message.as_str(), help.as_str()),
        ("'bunny.stl' is no mesh that can be read", "meshes are `.ply` or `.obj` files")
    );
    let (_, message, _) = trouble(folder.parse("meshes.bunny.file = ''"));
    assert_eq!(message, "`` is a folder, not a file");
    let (_, message, help) = trouble(folder.parse("[meshes.bunny]"));
    assert_eq!(
        (message.as_str(), help.as_str()),
        ("`bunny` lacks `file`", "add it, for example `file = \"bunny.ply\"`")
    );
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
    let scene = folder
        .parse("[meshes.p]\nfile = 'm.ply'\nsmooth = false\n[meshes.o]\nfile = 'm.obj'\n")
        .expect("a scene");
    assert_eq!(scene.meshes[0].mesh.triangles, [[0, 1, 2]]);
    assert_eq!(scene.meshes[0].mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(scene.meshes.iter().map(|mesh| mesh.smooth).collect::<Vec<_>>(), [false, true]);
    assert_eq!((&scene.meshes[0].materials, &scene.meshes[1].materials), (&vec![], &vec![1]));
    assert_eq!(scene.material_names, ["default", "o/red"]);
    let red = Material {
        ambient: Vec3::X,
        diffuse: Vec3::X,
        transmission: Vec3::splat(0.75),
        ..Material::default()
    };
    assert_eq!(scene.materials[1], red);

    let scene = folder.parse("[materials.red]\n[meshes.o]\nfile = 'm.obj'\n").expect("a scene");
    assert_eq!((scene.materials.len(), &scene.meshes[0].materials), (2, &vec![1]));
    let scene = folder.parse("[meshes.o]\nfile = 'm.obj'\nmaterials = false").expect("a scene");
    assert_eq!((scene.materials.len(), scene.meshes[0].materials.len()), (1, 0));
}

#[test]
fn lamps_arrive_as_written() {
    let scene = scene_with(
        "[[lights]]\npoint = { position = [1, 2, 3], falloff = 'inverse_square' }\nintensity = 2\n\
         [[lights]]\ndirectional = { direction = [0, -5, 0] }\ncolor = [1, 0, 0]\n\
         [[lights]]\narea = { rectangle = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 0, 1]] } }\n\
         [[lights]]\narea = { disk = { center = [0, 1, 0], normal = [0, 0, 2], radius = 3 } }\n\
         [[lights]]\narea = { sphere = { center = [0, 1, 0], radius = 3 }, falloff = 'inverse_square' }\n",
    );
    let lamp = |emitter| Light { emitter, color: Vec3::ONE, intensity: 1.0 };
    let (center, radius, none, square) = (Vec3::Y, 3.0, Falloff::None, Falloff::InverseSquare);
    let point = Emitter::Point { position: Vec3::new(1.0, 2.0, 3.0), falloff: square };
    assert_eq!(scene.lights[0], Light { intensity: 2.0, ..lamp(point) });
    let directional = Emitter::Directional { direction: Vec3::NEG_Y };
    assert_eq!(scene.lights[1], Light { color: Vec3::X, ..lamp(directional) });
    let shape = AreaShape::Rectangle { corner: Vec3::ZERO, edges: (Vec3::X, Vec3::Z) };
    assert_eq!(scene.lights[2], lamp(Emitter::Area { shape, falloff: none }));
    let shape = AreaShape::Disk(Disk { center, normal: Vec3::Z, radius });
    assert_eq!(scene.lights[3], lamp(Emitter::Area { shape, falloff: none }));
    let shape = AreaShape::Sphere(Sphere { center, radius });
    assert_eq!(scene.lights[4], lamp(Emitter::Area { shape, falloff: square }));
}

#[test]
fn lamps_have_limits() {
    let light = |rest: &str, message: &str| {
        check_refused_with(&format!("[[lights]]\n{rest}"), &format!("s.toml:{message}"));
    };
    light("", "2:1: entry 1 of `lights` needs one of `point`, `directional`, `area`, and has none");
    light(
        "point = { position = [0, 0, 0] }\narea = {}",
        "4:1: entry 1 of `lights` has both `point` and `area`\nhelp: delete one of the two",
    );
    light(
        "intensity = -1\npoint = { position = [0, 0, 0] }",
        "3:13: `intensity` must be at least 0, and is -1",
    );
    light("point = {}", "3:9: `point` lacks `position`\nhelp: add it, for example `position = [0, 5, 0]`");
    light(
        "area = { rectangle = { corner = [0, 0, 0], edges = [[1, 0, 0], [2, 0, 0]] } }",
        "3:52: the edges run along one line, so the lamp has no area",
    );
    light(
        "area = { sphere = { center = [0, 0, 0], radius = 0 } }",
        "3:50: `radius` must be above 0, and is 0",
    );
    light(
        "point = { position = [0, 0, 0], falloff = 'linear' }",
        "3:43: unknown value of `falloff`: `linear`\nhelp: known are `none`, `inverse_square`",
    );
}

#[test]
fn the_examples_of_the_reference_can_be_read() {
    let reference = include_str!("../format.md");
    let examples: Vec<&str> =
        reference.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!examples.is_empty());
    for example in examples {
        if let Err(error) = parse(Path::new("format.md"), example) {
            panic!("{error}");
        }
    }
}
