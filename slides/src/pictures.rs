//! Pictures that are composed of parts: crops that are magnified, and panels with captions.

use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use raykata::camera::Camera;
use raykata::film::{Film, decode_srgb, encode_srgb};
use raykata::kit::{Kit, RenderJob, Rendering, TriangleQuery, View};
use raykata::partition::KdHeuristics;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Sampler, Scene, Split, TextureFilter};
use raykata::shape::Triangle;
use raykata::world::camera_for;
use raykata_cli::caption;
use raykata_cli::compare::{heat_color, with_edges};
use raykata_cli::report;
use raykata_cli::strip::paste;
use std::path::Path;

/// Pixels between two panels.
const GAP: u32 = 8;

pub fn load(root: &Path, name: &str) -> Result<Scene> {
    Ok(raykata::scene::load::load(&root.join("scenes").join(name))?)
}

pub fn job(scene: &Scene) -> RenderJob {
    RenderJob { reuse: false, ..report::job(scene.clone()) }
}

pub fn render(kit: &dyn Kit, scene: &Scene) -> Result<Rendering> {
    report::render(kit, &job(scene))
}

/// The work of each pixel of a scene, and what it cost in all.
pub fn work(kit: &dyn Kit, scene: &Scene) -> Result<Rendering> {
    report::render(kit, &RenderJob { view: View::Work, ..job(scene) })
}

/// Panels in a row whose pixels are colours for sums, on one logarithmic scale.
pub fn heat_panels(mut films: Vec<(Film, String)>, sum: fn(&Vec3) -> f32) -> Result<Vec<u8>> {
    let most = films.iter().flat_map(|(film, _)| &film.pixels).map(sum).fold(0.0, f32::max);
    for pixel in films.iter_mut().flat_map(|(film, _)| &mut film.pixels) {
        *pixel = heat_color(sum(pixel), most);
    }
    panels(&films, films.len() as u32)
}

/// The picture as a screen shows it, in linear light up to 1.
pub fn shown(kit: &dyn Kit, scene: &Scene) -> Result<Film> {
    Ok(render(kit, scene)?.film.toned(scene.film.tone))
}

/// The rays through the centres of all pixels, row by row.
pub fn rays_of(camera: &Camera, [width, height]: [u32; 2]) -> Vec<Ray> {
    let place = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
    let ray = |i: u32| camera.ray(place(i % width, width), place(i / width, height));
    (0..width * height).map(ray).collect()
}

/// A picture of this size whose pixel in column x and row y is `pixel(x, y)`.
pub fn film_of([width, height]: [u32; 2], pixel: impl Fn(u32, u32) -> Vec3) -> Film {
    let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    Film { width, height, pixels }
}

/// The part of a picture from column and row `corner`, `size` pixels wide and high.
pub fn crop(film: &Film, corner: [u32; 2], size: [u32; 2]) -> Film {
    film_of(size, |x, y| film.at(corner[0] + x, corner[1] + y))
}

/// The picture with each pixel repeated `times` along both axes.
pub fn magnified(film: &Film, times: u32) -> Film {
    film_of([times * film.width, times * film.height], |x, y| film.at(x / times, y / times))
}

/// Panels of equal size in rows of `columns`, each with its caption below, as a PNG file.
pub fn panels(parts: &[(Film, String)], columns: u32) -> Result<Vec<u8>> {
    let first = &parts.first().context("there are no panels")?.0;
    let (width, height) = (first.width, first.height + caption::HEIGHT);
    let rows = (parts.len() as u32).div_ceil(columns);
    let mut sheet = Film::new(columns * width + (columns - 1) * GAP, rows * height + (rows - 1) * GAP);
    for (index, (film, text)) in (0..).zip(parts) {
        let [left, top] = [index % columns * (width + GAP), index / columns * (height + GAP)];
        paste(film, &mut sheet, [left, top]);
        caption::write(&mut sheet, text, [left, top + film.height], width);
    }
    png(&sheet)
}

pub fn png(film: &Film) -> Result<Vec<u8>> {
    let bytes = film.to_bytes(encode_srgb).rgb;
    let picture = image::RgbImage::from_raw(film.width, film.height, bytes).context("the size is wrong")?;
    compressed(&picture)
}

/// A PNG file that is as small as the encoder can make it.
pub fn compressed(picture: &image::RgbImage) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let (compression, filter) = (CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(PngEncoder::new_with_quality(&mut bytes, compression, filter))?;
    Ok(bytes)
}

/// Crops of scenes/plain.toml in a row, each with a sampler and a number of samples, magnified four times.
fn plain(kit: &dyn Kit, root: &Path, size: [u32; 2], parts: &[(Sampler, u32, &str)]) -> Result<Vec<u8>> {
    let mut scene = load(root, "plain.toml")?;
    let mut films = Vec::new();
    for &(sampler, samples, text) in parts {
        (scene.quality.sampler, scene.quality.samples_per_pixel) = (sampler, samples);
        films.push((magnified(&crop(&shown(kit, &scene)?, CROP, size), 4), text.to_owned()));
    }
    panels(&films, films.len() as u32)
}

/// Where the outline of the knot lies in scenes/plain.toml.
const CROP: [u32; 2] = [250, 60];

/// The outline of the knot with one sample per pixel and with many.
pub fn antialias_crops(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let parts = [(Sampler::Center, 1, "not antialiased"), (Sampler::Jittered, 64, "antialiased")];
    plain(kit, root, [130, 100], &parts)
}

/// The outline of the knot with three samplers.
pub fn sampler_strip(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let parts = [
        (Sampler::Center, 16, "center"),
        (Sampler::Random, 16, "random"),
        (Sampler::Jittered, 16, "jittered"),
    ];
    plain(kit, root, [90, 90], &parts)
}

/// The outline of the knot with a sample at the centre, at a random place, and with several samples.
pub fn sampling_101(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let parts = [
        (Sampler::Center, 1, "centre"),
        (Sampler::Random, 1, "random"),
        (Sampler::Jittered, 16, "16 samples, averaged"),
    ];
    plain(kit, root, [90, 90], &parts)
}

/// The boxes of the hierarchy over a mesh at several levels.
pub fn hierarchy_levels(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "hierarchy.toml")?;
    (scene.film.width, scene.film.height) = (220, 220);
    let film = shown(kit, &scene)?;
    let panel = |level: u32| {
        let edges = kit.outlines(&job(&scene), level);
        // Each box has twelve edges.
        let text = match edges.len() / 12 {
            1 => format!("level {level}: 1 box"),
            n => format!("level {level}: {n} boxes"),
        };
        (with_edges(&film, &camera_for(&scene), &edges), text)
    };
    panels(&[0, 2, 4, 6, 8, 10].map(panel), 3)
}

/// The cells of four partitions of space over the same scene.
pub fn four_partitions(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "stage9.toml")?;
    (scene.film.width, scene.film.height) = (400, 250);
    let film = shown(kit, &scene)?;
    let camera = camera_for(&scene);
    let mut parts = Vec::new();
    for (accelerator, name) in [
        (Accelerator::Grid, "grid"),
        (Accelerator::Octree, "octree"),
        (Accelerator::KdTree, "kd-tree"),
        (Accelerator::Bsp, "BSP tree"),
    ] {
        scene.quality.accelerator = accelerator;
        parts.push((with_edges(&film, &camera, &kit.outlines(&job(&scene), 6)), name.to_owned()));
    }
    panels(&parts, 2)
}

/// A floor of tiles up to the horizon, with two filters of its texture.
pub fn tiles(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "tiles.toml")?;
    scene.quality.samples_per_pixel = 1;
    let mut parts = Vec::new();
    for (filter, name) in [(TextureFilter::Bilinear, "bilinear"), (TextureFilter::Mipmap, "mipmap")] {
        scene.quality.texture_filter = filter;
        let rendering = render(kit, &scene)?;
        let film = rendering.film.toned(scene.film.tone);
        let text = format!("{name}: {} image reads", rendering.counts.texture_reads);
        parts.push((magnified(&crop(&film, [0, 150], [320, 150]), 2), text));
    }
    panels(&parts, 2)
}

/// Heckbert's scene, with large pixels.
pub fn heckbert(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    png(&magnified(&shown(kit, &load(root, "heckbert.toml")?)?, 14))
}

/// Grey fields with equal steps of light, and with equal steps of the byte.
pub fn gamma_steps(kit: &dyn Kit, _root: &Path) -> Result<Vec<u8>> {
    const FIELD: u32 = 76;
    let linear: Vec<f32> = (0..16).map(|i| i as f32 / 15.0).collect();
    let encoded = kit.encode_gamma(&linear);
    let bytes: Vec<u8> = (0..16).map(|i| 17 * i).collect();
    let decoded = kit.decode_gamma(&bytes);
    let height = FIELD + 2 * caption::HEIGHT;
    let mut sheet = image::RgbImage::new(16 * FIELD, 2 * height + GAP);
    for (row, (light, bytes)) in [(&linear, &encoded), (&decoded, &bytes)].into_iter().enumerate() {
        let top = row as u32 * (height + GAP);
        for (column, (light, &byte)) in (0..).zip(light.iter().zip(bytes)) {
            // Write the text on a film of its own, whose pixels are 0 to 1.
            let mut text = Film::new(FIELD, 2 * caption::HEIGHT);
            caption::write(&mut text, &format!("{light:.3}"), [0, 0], FIELD);
            caption::write(&mut text, &byte.to_string(), [0, caption::HEIGHT], FIELD);
            for y in 0..height {
                for x in 0..FIELD {
                    let grey = if y < FIELD {
                        byte
                    } else {
                        (255.0 * text.at(x, y - FIELD).max_element()).round() as u8
                    };
                    sheet.put_pixel(column * FIELD + x, top + y, image::Rgb([grey; 3]));
                }
            }
        }
    }
    compressed(&sheet)
}

/// The picture of the check of three scales, magnified.
pub fn three_scales(_kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let picture = image::open(root.join("tests/golden/stage10_three_scales.png"))?.into_rgb8();
    let (width, height) = (picture.width(), picture.height());
    // Decode what `panels` encodes.
    let color = |x, y| (Vec3::from(picture.get_pixel(x, y).0.map(f32::from)) / 255.0).map(decode_srgb);
    let film = film_of([width, height], color);
    let third = width / 3;
    let part = |index: u32, name: &str| {
        (magnified(&crop(&film, [index * third, 0], [third, height]), 8), name.to_owned())
    };
    panels(&[part(0, "2^-60"), part(1, "1"), part(2, "2^60")], 3)
}

/// The leaves of two kd-trees over the same scene, the easy way and with all heuristics.
pub fn kd_easy_and_five(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "stage9.toml")?;
    (scene.film.width, scene.film.height) = (560, 350);
    scene.quality.accelerator = Accelerator::KdTree;
    let camera = camera_for(&scene);
    let mut parts = Vec::new();
    for (heuristics, name) in [(KdHeuristics::NONE, "easy way"), (KdHeuristics::default(), "five heuristics")]
    {
        scene.quality.kd_heuristics = heuristics;
        let rendering = render(kit, &scene)?;
        let nodes = rendering.structure.context("there is no structure")?.nodes;
        let tests = rendering.counts.primitive_tests as f64 / rendering.counts.rays() as f64;
        let film = rendering.film.toned(scene.film.tone);
        let edges = kit.outlines(&job(&scene), 9);
        let text = format!("{name}: {nodes} nodes, {tests:.1} tests/ray");
        parts.push((with_edges(&film, &camera, &edges), text));
    }
    panels(&parts, 2)
}

/// The tests of each pixel with the three splits, on one logarithmic scale.
pub fn split_heatmaps(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "stage3.toml")?;
    (scene.film.width, scene.film.height) = (270, 169);
    let mut films = Vec::new();
    for (split, name) in [
        (Split::ObjectMedian, "object median"),
        (Split::SpatialMedian, "spatial median"),
        (Split::SurfaceArea, "surface area"),
    ] {
        scene.quality.split = split;
        let rendering = work(kit, &scene)?;
        let counts = rendering.counts;
        let tests = (counts.box_tests + counts.primitive_tests) as f64 / counts.rays() as f64;
        films.push((rendering.film, format!("{name}: {tests:.0} tests/ray")));
    }
    heat_panels(films, |pixel| pixel.element_sum())
}

/// A triangle by Cramer's rule, with the right determinant and with that of the lecture notes.
pub fn cramer_determinant(kit: &dyn Kit, _root: &Path) -> Result<Vec<u8>> {
    const SIZE: u32 = 240;
    let triangle = Triangle { a: vec3(0.1, -0.6, 0.2), b: vec3(1.2, 0.3, -0.4), c: vec3(-0.7, 0.8, 0.5) };
    let position = vec3(1.3, -0.9, 2.2);
    let target = (triangle.a + triangle.b + triangle.c) / 3.0;
    let camera = Camera::new(position, target - position, Vec3::Y, 50.0, 1.0)?;
    let rays = rays_of(&camera, [SIZE; 2]);
    let queries: Vec<_> = rays.iter().map(|&ray| TriangleQuery { ray, triangle }).collect();
    let right = kit.triangle_cramer(&queries).into_iter().map(|hit| hit.map(|hit| [hit.beta, hit.gamma]));
    let wrong = rays.iter().map(|ray| with_wrong_determinant(ray, &triangle));
    let panel = |hits: Vec<Option<[f32; 2]>>, name: &str| {
        let mut film = Film::new(SIZE, SIZE);
        for (pixel, hit) in film.pixels.iter_mut().zip(&hits) {
            *pixel = match *hit {
                Some([beta, gamma]) => vec3(1.0 - beta - gamma, beta, gamma),
                None => Vec3::splat(0.02),
            };
        }
        let text = format!("{name}: {} hits", hits.iter().flatten().count());
        (magnified(&film, 2), text)
    };
    panels(&[panel(right.collect(), "triangle_cramer"), panel(wrong.collect(), "notes")], 2)
}

/// Cramer's rule with the determinant `a(fk - gj) + b(gl - hk) + c(hj - fl)` of the lecture notes, for the equations
/// `a x + b y + c z = d`, `e x + f y + g z = h`, `i x + j y + k z = l`. Their columns are two edges, the direction and the
/// right side.
fn with_wrong_determinant(ray: &Ray, triangle: &Triangle) -> Option<[f32; 2]> {
    let (p, q, d) = (triangle.a - triangle.b, triangle.a - triangle.c, ray.direction);
    let s = triangle.a - ray.origin;
    let (a, [b, f, j], [c, g, k], [_, h, l]) = (p.x, q.to_array(), d.to_array(), s.to_array());
    let determinant = a * (f * k - g * j) + b * (g * l - h * k) + c * (h * j - f * l);
    let beta = s.dot(q.cross(d)) / determinant;
    let gamma = p.dot(s.cross(d)) / determinant;
    let t = p.dot(q.cross(s)) / determinant;
    (ray.contains(t) && beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0).then_some([beta, gamma])
}
