//! Material libraries, and how OBJ files name them.

use super::Row;

/// Lines of the library below `newmtl red`, which is line 1.
const LINES: &[(&str, &str, &str)] = &[
    ("an empty material", "", ""),
    ("a diffuse colour", "Kd 1 0 0\n", "diffuse 1 0 0"),
    ("a grey", "Kd 0.5\n", "diffuse 0.5 0.5 0.5"),
    ("a colour with four numbers", "Kd 1 0 0 1\n", "diffuse 1 0 0"),
    ("an ambient colour", "Ka 1 1 1\n", "ambient 1 1 1"),
    ("a specular colour", "Ks 0.5 0.5 0.5\n", "specular 0.5 0.5 0.5"),
    ("a colour of emitted light", "Ke 4 4 4\n", "emission 4 4 4"),
    ("an exponent", "Ns 96.078431\n", "exponent 96.07843"),
    ("an exponent of 0", "Ns 0\n", "exponent 0"),
    ("an index of refraction", "Ni 1.5\n", "index 1.5"),
    ("an opacity", "d 0.25\n", "transmission 0.75 0.75 0.75"),
    ("an opacity of 1", "d 1.0\n", ""),
    ("an opacity with a halo", "d -halo 0.5\n", "transmission 0.5 0.5 0.5"),
    ("a transparency", "Tr 0.25\n", "transmission 0.25 0.25 0.25"),
    ("a transparency of 0", "Tr 0\n", ""),
    ("an opacity, then a transparency", "d 0.25\nTr 0.75\n", "transmission 0.75 0.75 0.75"),
    ("a transparency, then an opacity", "Tr 0.75\nd 0.25\n", "transmission 0.75 0.75 0.75"),
    ("an opacity and a transparency that contradict it", "d 1\nTr 1\n", ""),
    ("a transmission filter", "Tf 1 1 1\n", ""),
    ("the Phong model", "illum 2\n", ""),
    ("a diffuse model without highlight", "illum 1\nKs 0 0 0\n", ""),
    ("a sharpness", "sharpness 60\n", ""),
    ("physically based parameters", "Pr 0.5\nPm 1\nPs 0\nPc 0\nPcr 0\naniso 0\nanisor 0\n", ""),
    ("a blank before the keyword", "  Kd 1 0 0\n", "diffuse 1 0 0"),
    ("a tab before the keyword", "\tKd 1 0 0\n", "diffuse 1 0 0"),
    ("line ends of Windows in a library", "Kd 1 0 0\r\nd 1\r\n", "diffuse 1 0 0"),
    ("a comment in a library", "# a comment\nKd 1 0 0 # red\n", "diffuse 1 0 0"),
    ("no line end at the end of a library", "Kd 1 0 0", "diffuse 1 0 0"),
    ("numbers in scientific notation in a library", "Kd 1e0 0E+1 0.e0\n", "diffuse 1 0 0"),
    ("a bump map", "map_Bump -bm 1.0 bump.png\nbump bump.png\nnorm normal.png\n", ""),
    ("a map of another value", "map_Ks s.png\nmap_Ns n.png\nmap_d d.png\nmap_Ke e.png\nrefl sky.png\n", ""),
    ("a second material", "newmtl blue\nKd 0 0 1\n", ""),
    ("an image", "map_Kd wood.png\n", "texture"),
    ("an image in the current folder", "map_Kd ./wood.png\n", "texture"),
    ("an image in a folder of Windows", "map_Kd .\\wood.png\n", "texture"),
    ("an image with blanks in its name", "map_Kd my wood.png\n", "texture"),
    ("an image with a scale", "map_Kd -s 1 1 1 wood.png\n", "texture"),
    ("an image with an offset of two numbers", "map_Kd -o 0.5 0.5 wood.png\n", "texture"),
    ("an image with turbulence", "map_Kd -t 0 0 0 wood.png\n", "texture"),
    ("an image that is clamped", "map_Kd -clamp on wood.png\n", "texture"),
    ("an image without blending", "map_Kd -blendu off -blendv off wood.png\n", "texture"),
    ("an image with a range of colours", "map_Kd -mm 0 1 wood.png\n", "texture"),
    ("an image of one channel", "map_Kd -imfchan l wood.png\n", "texture"),
    ("an image with many options", "map_Kd -s 2 2 2 -o 0 0 0 -bm 1 -clamp off wood.png\n", "texture"),
    (
        "an image that is missing",
        "map_Kd no.png\n",
        " | s.toml:2:8: there is no texture `no.png` for mesh `m`; it is left out",
    ),
    (
        "an image in a folder of another computer",
        "map_Kd C:\\textures\\no.png\n",
        " | s.toml:2:8: there is no texture `no.png` for mesh `m`; it is left out",
    ),
    (
        "an image in the format JPEG",
        "map_Kd wood.jpg\n",
        " | s.toml:2:8: `wood.jpg` is a JPEG image, and textures are PNG or Radiance HDR files; it is left out",
    ),
    ("an image without a name", "map_Kd\n", " | m.mtl:2:1: `map_Kd` without a name; the line is ignored"),
    ("a negative exponent", "Ns -10\n", "exponent 0 | m.mtl:2:4: `Ns` is -10; 0 is used"),
    (
        "an index of refraction of 0",
        "Ni 0\n",
        " | m.mtl:2:4: `Ni` is 0, which is no index of refraction; 1 is used",
    ),
    ("an opacity above 1", "d 1.5\n", " | m.mtl:2:3: `d` is 1.5; 1 is used"),
    ("an opacity below 0", "d -1\n", "transmission 1 1 1 | m.mtl:2:3: `d` is -1; 0 is used"),
    ("a transparency above 1", "Tr 100\n", "transmission 1 1 1 | m.mtl:2:4: `Tr` is 100; 1 is used"),
    ("a negative colour", "Kd 1 -1 0\n", "diffuse 1 0 0 | m.mtl:2:6: `Kd` has the component -1; 0 is used"),
    (
        "a colour of two numbers",
        "Kd 1 0\n",
        " | m.mtl:2:1: `Kd` needs 3 numbers, but has 2; the line is ignored",
    ),
    (
        "a colour without numbers",
        "Kd\n",
        " | m.mtl:2:1: `Kd` needs 3 numbers, but has 0; the line is ignored",
    ),
    ("a colour that is NaN", "Kd nan 0 0\n", " | m.mtl:2:4: `nan` is not a number; the line is ignored"),
    (
        "a colour with decimal commas",
        "Kd 0,5 0 0\n",
        " | m.mtl:2:4: `0,5` is not a number; the line is ignored",
    ),
    (
        "a colour as a spectrum",
        "Kd spectral a.rfl\n",
        " | m.mtl:2:4: a colour as `spectral` is not supported",
    ),
    (
        "a colour in XYZ",
        "Kd xyz 1 1 1\n",
        " | m.mtl:2:4: a colour as `xyz` is not supported; the line is ignored",
    ),
    ("a constant colour", "illum 0\n", " | m.mtl:2:7: `illum 0` asks for a constant colour"),
    (
        "a highlight against the model",
        "illum 1\nKs 1 1 1\n",
        "specular 1 1 1 | m.mtl:2:7: `illum 1` asks for no",
    ),
    ("a model with reflections", "illum 3\n", " | m.mtl:2:7: `illum 3` asks for reflections"),
    ("a model of glass", "illum 4\n", " | m.mtl:2:7: `illum 4` asks for glass with reflections"),
    ("a model with refraction", "illum 7\n", " | m.mtl:2:7: `illum 7` asks for glass with reflections"),
    (
        "a model that only casts shadows",
        "illum 10\n",
        " | m.mtl:2:7: `illum 10` is not a model that is rendered",
    ),
    (
        "a material without a name in a library",
        "newmtl\n",
        " | m.mtl:2:1: `newmtl` without a name; the line is",
    ),
];

/// OBJ files beside a library `m.mtl` that defines a red material `red` and a blue material `dark blue`. Their lines are those
/// below a triangle, whose vertices are lines 1 to 3.
const USES: &[(&str, &str, &str)] = &[
    ("a library and a material", "mtllib m.mtl\nusemtl red\nf 1 2 3\n", "3v 1t 1m diffuse 1 0 0"),
    ("a material above its library", "usemtl red\nmtllib m.mtl\nf 1 2 3\n", "3v 1t 1m diffuse 1 0 0"),
    ("a library below the faces", "usemtl red\nf 1 2 3\nmtllib m.mtl\n", "3v 1t 1m diffuse 1 0 0"),
    ("a library between quotes", "mtllib \"m.mtl\"\nusemtl red\nf 1 2 3\n", "3v 1t 1m diffuse 1 0 0"),
    ("a library in the current folder", "mtllib ./m.mtl\nusemtl red\nf 1 2 3\n", "3v 1t 1m diffuse 1 0 0"),
    ("a library in a folder of Windows", "mtllib .\\m.mtl\nusemtl red\nf 1 2 3\n", "3v 1t 1m diffuse 1 0 0"),
    (
        "a library that is named twice",
        "mtllib m.mtl\nmtllib m.mtl\nusemtl red\nf 1 2 3\n",
        "3v 1t 1m diffuse 1 0 0",
    ),
    (
        "a material with blanks in its name",
        "mtllib m.mtl\nusemtl dark blue\nf 1 2 3\n",
        "3v 1t 1m diffuse 0 0 1",
    ),
    (
        "two materials",
        "mtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl dark blue\nf 1 3 2\n",
        "6v 2t 2m diffuse 1 0 0",
    ),
    (
        "a material that is used again",
        "mtllib m.mtl\nusemtl red\nf 1 2 3\no b\nusemtl red\nf 1 3 2\n",
        "3v 2t 1m diffuse 1 0 0",
    ),
    (
        "faces above the first material",
        "mtllib m.mtl\nf 1 2 3\nusemtl red\nf 1 3 2\n",
        "6v 2t 2m diffuse 1 0 0",
    ),
    ("a library without its material", "mtllib m.mtl\nf 1 2 3\n", "3v 1t"),
    (
        "a material that the library lacks",
        "mtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl green\nf 1 3 2\n",
        "6v 2t 2m diffuse 1 0 0 | m.obj:7:8: material `green` is not defined; these faces have the material `default`",
    ),
    (
        "a material with another case",
        "mtllib m.mtl\nusemtl RED\nf 1 2 3\n",
        "3v 1t 1m | m.obj:5:8: material `RED` is not defined",
    ),
    (
        "a material that ends at an empty `usemtl`",
        "mtllib m.mtl\nusemtl red\nf 1 2 3\nusemtl\nf 1 3 2\n",
        "6v 2t 2m diffuse 1 0 0 | m.obj:7:1: `usemtl` without a name",
    ),
];

pub(super) fn rows() -> Vec<Row> {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(1, 1).write_to(&mut png, image::ImageFormat::Png).expect("an image");
    let png = png.into_inner();
    let lines = LINES.iter().map(|(feature, lines, expected)| {
        let obj = format!("mtllib m.mtl\n{triangle}usemtl red\nf 1 2 3\n");
        let expected = format!("3v 1t 1m {expected}").replace("1m  |", "1m |");
        let mut row = Row::mesh(feature, "m.obj", obj, &expected);
        row.files.push(("m.mtl", format!("newmtl red\n{lines}").into_bytes()));
        row.files.extend([("wood.png", png.clone()), ("my wood.png", png.clone())]);
        row.files.push(("wood.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01".to_vec()));
        row
    });
    let uses = USES.iter().map(|(feature, lines, expected)| {
        let mut row = Row::mesh(feature, "m.obj", format!("{triangle}{lines}"), expected);
        row.files.push(("m.mtl", b"newmtl red\nKd 1 0 0\nnewmtl dark blue\nKd 0 0 1\n".to_vec()));
        row
    });
    let mut above = Row::mesh(
        "a value above the first material",
        "m.obj",
        format!("mtllib m.mtl\n{triangle}f 1 2 3\n"),
        "3v 1t | m.mtl:1:1: `Kd` before the first `newmtl`; the line is ignored",
    );
    above.files.push(("m.mtl", b"Kd 1 0 0\n".to_vec()));
    lines.chain(uses).chain([above]).collect()
}
