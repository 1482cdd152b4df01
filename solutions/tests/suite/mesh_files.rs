//! Pictures of meshes from files: what a file says of shading, and that its materials do not make light.

use crate::scene::render;
use glam::Vec3;
use raykata::scene::load;
use tempfile::TempDir;

/// A folder for the files of a test.
struct Folder(TempDir);

impl Folder {
    fn with<T: AsRef<[u8]>>(files: &[(&str, T)]) -> Folder {
        let folder = tempfile::tempdir().expect("a folder");
        files.iter().for_each(|(name, text)| std::fs::write(folder.path().join(name), text).expect("a file"));
        Folder(folder)
    }

    fn pixels(&self, scene: &str) -> Vec<Vec3> {
        let scene =
            load::parse(&self.0.path().join("scene.toml"), scene).unwrap_or_else(|error| panic!("{error}"));
        render(&scene).film.pixels
    }

    /// The picture of a mesh with these settings, and of its node with those.
    fn mesh(&self, mesh: &str, node: &str) -> Vec<Vec3> {
        self.pixels(&format!(
            "[film]\nwidth = 48\nheight = 48\n[camera]\nposition = [3, 2.5, 4]\nlook_at = [0, 0, 0]\nvertical_fov = 35\n\
             [environment]\nambient = 0.2\n[[lights]]\npoint = {{ position = [6, 6, 3] }}\n\
             [meshes.m]\nmaterials = false\n{mesh}\n[[nodes]]\nshape = {{ mesh = 'm' }}\n{node}"
        ))
    }
}

const FACES: [[i32; 4]; 6] =
    [[1, 5, 7, 3], [4, 3, 7, 8], [8, 7, 5, 6], [6, 2, 4, 8], [2, 1, 3, 4], [6, 5, 1, 2]];

/// The corners of a cube as lines after `start`.
fn corners(start: &str, half: f64, center: [f64; 3]) -> Vec<String> {
    let sign = |vertex: usize, bit: usize| if vertex & bit == 0 { half } else { -half };
    let at = |v: usize| [center[0] + sign(v, 4), center[1] + sign(v, 1), center[2] - sign(v, 2)];
    (0..8).map(|vertex| format!("{start}{}\n", at(vertex).map(|x| x.to_string()).join(" "))).collect()
}

fn cube() -> String {
    corners("v ", 1.0, [0.0; 3]).concat()
}

/// The lines of all faces of the cube, with `after` behind each corner: `#` stands for the number of the corner in its face, `@`
/// for that of the face. `first` is added to the numbers of vertices.
fn faces(first: i32, after: &str) -> Vec<String> {
    let corner = |face: usize, corner: usize| {
        let after = after.replace('#', &(corner + 1).to_string()).replace('@', &(face + 1).to_string());
        format!(" {}{after}", FACES[face][corner] + first)
    };
    (0..6).map(|face| format!("f{}\n", (0..4).map(|i| corner(face, i)).collect::<String>())).collect()
}

/// Texture coordinates, normals and materials belong to corners and faces, and do not tear the shape.
#[test]
fn what_corners_have_does_not_change_the_shape() {
    let plain = cube() + &faces(0, "").concat();
    let tables =
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\nvn 0 0 1\nvn -1 0 0\nvn 0 -1 0\nvn 1 0 0\nvn 0 0 -1\n";
    let rows = corners("", 1.0, [0.0; 3]);
    let rows = FACES.as_flattened().iter().map(|&v| rows[v as usize - 1].replace('\n', " 0 1\n"));
    let ply = "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
               property float t\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
    let ply_faces =
        (0..6).map(|face| format!("4 {} {} {} {}\n", 4 * face, 4 * face + 1, 4 * face + 2, 4 * face + 3));
    let folder = Folder::with(&[
        ("plain.obj", plain.clone()),
        ("uv.obj", cube() + tables + &faces(0, "/#").concat()),
        ("all.obj", cube() + tables + &faces(0, "/#/@").concat()),
        ("materials.obj", plain.replace("f ", "usemtl a\nusemtl b\nf ").replacen("usemtl b", "", 3)),
        ("uv.ply", ply.chars().map(String::from).chain(rows).chain(ply_faces).collect()),
    ]);
    for settings in ["", "subdivide = 1", "subdivide = 3"] {
        let of = |file: &str| folder.mesh(&format!("file = '{file}'\n{settings}"), "");
        for file in ["uv.obj", "materials.obj", "uv.ply", "all.obj"] {
            // Normals of the file are used if the mesh is not subdivided.
            let has_normals = file == "all.obj" && settings.is_empty();
            assert!(has_normals || of(file) == of("plain.obj"), "{file} {settings}");
        }
    }
}

/// Smoothing groups give flat faces and edges, as in a mesh that is flat or whose parts are separate.
#[test]
fn normals_are_averaged_within_smoothing_groups() {
    let pick = |lines: &[String], list: &[usize]| list.iter().map(|&i| &*lines[i]).collect::<String>();
    let (own, copied) = (faces(0, ""), faces(8, ""));
    let (one, other) = (pick(&own, &[1, 4]), [0, 2, 3, 5]);
    let folder = Folder::with(&[
        ("plain.obj", cube() + &own.concat()),
        ("off.obj", cube() + "s off\n" + &own.concat()),
        ("groups.obj", cube() + "s 1\n" + &one + "s 7\n" + &pick(&own, &other)),
        ("copies.obj", cube() + &cube() + &one + &pick(&copied, &other)),
    ]);
    let of = |mesh: &str| folder.mesh(mesh, "");
    let (flat, smooth) = (of("file = 'plain.obj'\nsmooth = false"), of("file = 'plain.obj'"));
    assert!(of("file = 'off.obj'") == flat && flat != smooth);
    assert!(of("file = 'off.obj'\nsubdivide = 2") == of("file = 'plain.obj'\nsubdivide = 2"));
    let groups = of("file = 'groups.obj'");
    assert!(groups == of("file = 'copies.obj'") && groups != smooth);
}

/// A mesh in map coordinates that its node brings to the origin looks like the mesh at the origin. All its numbers are exact.
#[test]
fn a_mesh_far_away_keeps_its_shape() {
    let far = corners("v ", 0.125, [500_000.25, 5_000_000.5, 30.0]).concat();
    let files =
        [("near.obj", cube()), ("far.obj", far)].map(|(name, text)| (name, text + &faces(0, "").concat()));
    let folder = Folder::with(&files);
    let steps = "transform = [{ translate = [-500000.25, -5000000.5, -30] }, { scale = 8 }]\n";
    assert!(folder.mesh("file = 'near.obj'", "") == folder.mesh("file = 'far.obj'", steps));
}

/// White light from everywhere stays at most white, for all values of materials that real files have.
#[test]
fn materials_of_libraries_make_no_light() {
    let lists = [
        &["", "Kd 0 0 0", "Kd 0.8 0.8 0.8", "kd 1 1 1\nKa 1 1 1", "Kd 2 2 2"][..],
        &["", "Ks 0.8 0.8 0.8\nNs 0", "Ks 1 1 1\nNs 30"],
        &["", "d 0", "d 0.3", "Tr 0.7", "d 1\nTr 1"],
        &["", "Ni 0", "Ni 1", "Ni 1.45"],
    ];
    let count: usize = lists.iter().map(|list| list.len()).product();
    let (mut library, mut cubes) = (String::new(), "mtllib m.mtl\n".to_owned());
    for number in 0..count {
        // The digits of the number choose the lines. The model changes nothing but warnings, so take each in turn.
        let (mut rest, mut text) = (number, format!("newmtl m{number}\nillum {}\n", number % 11));
        for list in lists {
            text += &format!("{}\n", list[rest % list.len()]);
            rest /= list.len();
        }
        library += &text;
        cubes += &corners("v ", 0.4, [(number % 20) as f64, (number / 20) as f64, 0.0]).concat();
        cubes += &format!("usemtl m{number}\n{}", faces(-9, "").concat());
    }
    let folder = Folder::with(&[("m.mtl", library), ("m.obj", cubes)]);
    for light in ["ambient = 1", "indirect_light = true"] {
        let pixels = folder.pixels(&format!(
            "[film]\nwidth = 80\nheight = 60\n[camera]\nposition = [9.5, 7, 30]\nlook_at = [9.5, 7, 0]\nvertical_fov = 30\n\
             [environment]\nbackground = 1\n{light}\n[quality]\nsamples_per_pixel = 4\n[meshes.m]\nfile = 'm.obj'\n\
             [[nodes]]\nshape = {{ mesh = 'm' }}\n"
        ));
        let brightest = pixels.iter().map(|pixel| pixel.max_element()).fold(0.0, f32::max);
        assert!(brightest <= 1.0 + 1e-6, "{light}: {brightest}"); // the weights of up to six rays are rounded
        assert!(pixels.iter().any(|pixel| pixel.max_element() < 0.5), "black materials are shown");
    }
}

/// At its poles, a sphere shows the upper and the lower rows of its image alone.
#[test]
fn the_image_of_a_sphere_does_not_repeat_across_the_poles() {
    let [red, blue] = [[128, 0, 0, 129], [0, 0, 128, 129]].map(|pixel: [u8; 4]| pixel.repeat(4 * 32));
    let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 4\n";
    let folder = Folder::with(&[("sky.hdr", [&header[..], &red, &blue].concat())]);
    for (filter, height) in [("bilinear", 4), ("mipmap", 4), ("bilinear", -4), ("mipmap", -4)] {
        let pixels = folder.pixels(&format!(
            "[film]\nwidth = 9\nheight = 9\n[camera]\nposition = [0, {height}, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\n\
             vertical_fov = 4\n[environment]\nambient = 1\n[quality]\ntexture_filter = '{filter}'\n\
             [textures.sky]\nfile = 'sky.hdr'\n[materials.sky]\ndiffuse = 1\ntexture = 'sky'\n\
             [[nodes]]\nmaterial = 'sky'\nshape = {{ sphere = {{ center = [0, 0, 0], radius = 1 }} }}\n"
        ));
        let color = if height > 0 { Vec3::X } else { Vec3::Z };
        assert!(pixels.iter().all(|pixel| *pixel == color), "{filter}, {height}");
    }
}
