//! Pictures of meshes from files: what a file says of shading, and that its materials do not make light.

use crate::frames::render;
use glam::Vec3;
use raykata::scene::load;
use std::fmt::Write;
use std::path::PathBuf;

/// A folder for the files of a test, which is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn with<T: AsRef<[u8]>>(name: &str, files: &[(&str, T)]) -> Folder {
        let folder = std::env::temp_dir().join(format!("raykata-mesh-files-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        files
            .iter()
            .for_each(|(name, text)| std::fs::write(folder.join(name), text.as_ref()).expect("a file"));
        Folder(folder)
    }

    /// The pixels of a scene that shows a mesh of the folder.
    fn picture(&self, scene: &str) -> Vec<Vec3> {
        let scene = load::parse(&self.0.join("scene.toml"), scene).unwrap_or_else(|error| panic!("{error}"));
        render(&scene).film.pixels
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const CUBE: &str = "v 1 1 -1\nv 1 -1 -1\nv 1 1 1\nv 1 -1 1\nv -1 1 -1\nv -1 -1 -1\nv -1 1 1\nv -1 -1 1\n";
const FACES: [[u32; 4]; 6] =
    [[1, 5, 7, 3], [4, 3, 7, 8], [8, 7, 5, 6], [6, 2, 4, 8], [2, 1, 3, 4], [6, 5, 1, 2]];

/// The faces of the cube, with `after` behind the index of each corner: `#` stands for the number of the corner in its face,
/// `@` for that of the face.
fn faces(after: &str) -> String {
    let corner = |face: usize, corner: usize| {
        let after = after.replace('#', &(corner + 1).to_string()).replace('@', &(face + 1).to_string());
        format!(" {}{after}", FACES[face][corner])
    };
    (0..6).map(|face| format!("f{}\n", (0..4).map(|i| corner(face, i)).collect::<String>())).collect()
}

fn scene(mesh: &str) -> String {
    format!(
        "[film]\nwidth = 48\nheight = 48\n[camera]\nposition = [3, 2.5, 4]\nlook_at = [0, 0, 0]\nvertical_fov = 35\n\
         [environment]\nambient = 0.2\n[[lights]]\npoint = {{ position = [6, 6, 3] }}\n\
         [meshes.m]\n{mesh}\n[[nodes]]\nshape = {{ mesh = 'm' }}\n"
    )
}

/// Texture coordinates, normals and materials belong to corners and faces, and do not tear the shape.
#[test]
fn what_corners_have_does_not_change_the_shape() {
    let tables =
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\nvn 0 0 1\nvn -1 0 0\nvn 0 -1 0\nvn 1 0 0\nvn 0 0 -1\n";
    let materials: String =
        faces("").lines().enumerate().map(|(i, f)| format!("usemtl m{i}\n{f}\n")).collect();
    let vertices: String = FACES
        .iter()
        .flatten()
        .map(|&v| format!("{} 0 {v}\n", &CUBE.lines().nth(v as usize - 1).unwrap()[2..]))
        .collect();
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
         property float t\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n{vertices}\
         4 0 1 2 3\n4 4 5 6 7\n4 8 9 10 11\n4 12 13 14 15\n4 16 17 18 19\n4 20 21 22 23\n"
    );
    let folder = Folder::with(
        "corners",
        &[
            ("plain.obj", &format!("{CUBE}{}", faces(""))),
            ("uv.obj", &format!("{CUBE}{tables}{}", faces("/#"))),
            ("all.obj", &format!("{CUBE}{tables}{}", faces("/#/@"))),
            ("materials.obj", &format!("{CUBE}{materials}")),
            ("uv.ply", &ply),
        ],
    );
    for settings in ["", "subdivide = 1\n", "subdivide = 3\n"] {
        let of =
            |file: &str| folder.picture(&scene(&format!("file = '{file}'\nmaterials = false\n{settings}")));
        let plain = of("plain.obj");
        for file in ["uv.obj", "materials.obj", "uv.ply", "all.obj"] {
            // Normals of the file are used if the mesh is not subdivided.
            assert!(of(file) == plain || (file == "all.obj" && settings.is_empty()), "{file} {settings}");
        }
    }
}

/// Smoothing groups give flat faces and edges, as in a mesh that is flat or whose parts are separate.
#[test]
fn normals_are_averaged_within_smoothing_groups() {
    // Faces 2 and 5 meet at an edge; copies of the vertices separate them from the others.
    let lines: Vec<String> = faces("").lines().map(str::to_owned).collect();
    let pick = |list: &[usize]| list.iter().map(|&i| format!("{}\n", lines[i])).collect::<String>();
    let copied = |list: &[usize]| {
        let corner = |v: u32| (v + 8).to_string();
        list.iter().map(|&i| format!("f {}\n", FACES[i].map(corner).join(" "))).collect::<String>()
    };
    let folder = Folder::with(
        "groups",
        &[
            ("off.obj", &format!("{CUBE}s off\n{}", faces(""))),
            ("plain.obj", &format!("{CUBE}{}", faces(""))),
            ("groups.obj", &format!("{CUBE}s 1\n{}s 7\n{}", pick(&[1, 4]), pick(&[0, 2, 3, 5]))),
            ("copies.obj", &format!("{CUBE}{CUBE}{}{}", pick(&[1, 4]), copied(&[0, 2, 3, 5]))),
        ],
    );
    let of = |mesh: &str| folder.picture(&scene(mesh));
    let (flat, smooth) = (of("file = 'plain.obj'\nsmooth = false"), of("file = 'plain.obj'"));
    assert!(of("file = 'off.obj'") == flat && flat != smooth);
    assert!(of("file = 'off.obj'\nsubdivide = 2") == of("file = 'plain.obj'\nsubdivide = 2"));
    let groups = of("file = 'groups.obj'");
    assert!(groups == of("file = 'copies.obj'") && groups != smooth);
}

/// A mesh in map coordinates that its node brings to the origin looks like the mesh at the origin.
#[test]
fn a_mesh_far_away_keeps_its_shape() {
    let far: String = CUBE
        .lines()
        .map(|line| {
            let c: Vec<f64> = line.split(' ').skip(1).map(|c| c.parse().expect("a number")).collect();
            format!("v {} {} {}\n", c[0] * 0.125 + 500000.25, c[1] * 0.125 + 5000000.5, c[2] * 0.125 + 30.0)
        })
        .collect();
    let folder = Folder::with(
        "far",
        &[("near.obj", &format!("{CUBE}{}", faces(""))), ("far.obj", &format!("{far}{}", faces("")))],
    );
    let near = folder.picture(&scene("file = 'near.obj'"));
    let steps = "transform = [{ translate = [-500000.25, -5000000.5, -30] }, { scale = 8 }]\n";
    let far = folder.picture(&(scene("file = 'far.obj'") + steps));
    // All numbers of this mesh are exact.
    assert!(near == far);
}

/// White light from everywhere stays at most white, for all values of materials that real files have.
#[test]
fn materials_of_libraries_make_no_light() {
    let (mut library, mut faces_of_all, mut n) = (String::new(), String::new(), 0);
    for diffuse in ["", "Kd 0 0 0", "Kd 0.8 0.8 0.8", "kd 1 1 1\nKa 1 1 1", "Kd 2 2 2"] {
        for highlight in ["", "Ks 0.8 0.8 0.8\nNs 0", "Ks 1 1 1\nNs 30"] {
            for opacity in ["", "d 0", "d 0.3", "Tr 0.7", "d 1\nTr 1"] {
                for index in ["", "Ni 0", "Ni 1", "Ni 1.45"] {
                    // The model changes nothing but warnings, so take each in turn.
                    let _ = writeln!(
                        library,
                        "newmtl m{n}\n{diffuse}\n{highlight}\n{opacity}\n{index}\nillum {}",
                        n % 11
                    );
                    let (column, row) = (n % 20, n / 20);
                    for line in CUBE.lines() {
                        let c: Vec<f32> =
                            line.split(' ').skip(1).map(|c| c.parse().expect("a number")).collect();
                        let _ = writeln!(
                            faces_of_all,
                            "v {} {} {}",
                            0.4 * c[0] + column as f32,
                            0.4 * c[1] + row as f32,
                            0.4 * c[2]
                        );
                    }
                    let _ = writeln!(faces_of_all, "usemtl m{n}");
                    for face in FACES {
                        let _ = writeln!(
                            faces_of_all,
                            "f {}",
                            face.map(|v| (v as i32 - 9).to_string()).join(" ")
                        );
                    }
                    n += 1;
                }
            }
        }
    }
    let folder =
        Folder::with("furnace", &[("m.mtl", library), ("m.obj", &format!("mtllib m.mtl\n{faces_of_all}"))]);
    for (light, most) in [("ambient = 1", 1.0), ("indirect_light = true", 1.0)] {
        let pixels = folder.picture(&format!(
            "[film]\nwidth = 80\nheight = 60\n[camera]\nposition = [9.5, 7, 30]\nlook_at = [9.5, 7, 0]\nvertical_fov = 30\n\
             [environment]\nbackground = 1\n{light}\n[quality]\nsamples_per_pixel = 4\n[meshes.m]\nfile = 'm.obj'\n\
             [[nodes]]\nshape = {{ mesh = 'm' }}\n"
        ));
        let brightest = pixels.iter().map(|pixel| pixel.max_element()).fold(0.0, f32::max);
        println!("{light}: {brightest}");
        assert!(brightest <= most + 1e-5, "{light}: {brightest}"); // rounding of up to 6 weights
        assert!(pixels.iter().any(|pixel| pixel.max_element() < 0.5));
    }
}

/// At its poles, a sphere shows the upper and the lower row of its image alone.
#[test]
fn the_image_of_a_sphere_does_not_repeat_across_the_poles() {
    let row = |pixel: [u8; 4]| pixel.repeat(4);
    let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    let [red, blue] = [row([128, 0, 0, 129]), row([0, 0, 128, 129])];
    let folder = Folder::with("poles", &[("sky.hdr", [&header[..], &red, &blue].concat())]);
    for filter in ["bilinear", "mipmap"] {
        for (height, other) in [(4, Vec3::Z), (-4, Vec3::X)] {
            let pixels = folder.picture(&format!(
                "[film]\nwidth = 9\nheight = 9\n[camera]\nposition = [0, {height}, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\n\
                 vertical_fov = 4\n[environment]\nambient = 1\n[quality]\ntexture_filter = '{filter}'\n\
                 [textures.sky]\nfile = 'sky.hdr'\n[materials.sky]\ndiffuse = 1\ntexture = 'sky'\n\
                 [[nodes]]\nmaterial = 'sky'\nshape = {{ sphere = {{ center = [0, 0, 0], radius = 1 }} }}\n"
            ));
            assert!(
                pixels.iter().all(|pixel| pixel.dot(other) == 0.0 && pixel.max_element() > 0.9),
                "{filter}"
            );
        }
    }
}
