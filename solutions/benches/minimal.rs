//! Measures the cost of the full renderer on a scene that needs no effects: `cargo bench -p solutions --bench
//! minimal`.
//!
//! It is compared with a minimal ray caster that supports only this scene: triangles of one colour, point
//! lights, one sample in the centre of each pixel. Both use the same hierarchy, the same ray/triangle test
//! and the same ray offset, and trace the same rays. The difference is that the full renderer has to find out
//! that the scene has no mirrors, lenses and so on. They render in turn on one thread; the output is the
//! medians of the times and the median of their ratios.

use anyhow::{Result, ensure};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Probe};
use raykata::frame::Unwatched;
use raykata::kit::{LightSample, RenderJob, Surface, View};
use raykata::material::{Emitter, Light};
use raykata::ray::Ray;
use raykata::scene::{Background, Scene, load};
use raykata::shape::{Shape, Triangle};
use raykata::world::camera_for;
use solutions::{stage3_boxes, stage3_build, stage3_traversal, stage4_shading, stage10_stability};
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 41;

fn main() -> Result<()> {
    let scene = load::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/plain.toml"))?;
    println!(
        "{:>17}  {:>9}  {:>10}  {:>8}  {:>6}",
        "lights with shadow", "rays", "minimal ms", "full ms", "ratio"
    );
    for lights in [3, 1, 0] {
        let mut scene = scene.clone();
        // Zero lights with shadow means one light that casts no shadow.
        scene.lights.truncate(lights.max(1));
        scene.lights[0].shadows = lights > 0;
        compare(&scene, lights)?;
    }
    Ok(())
}

fn compare(scene: &Scene, lights: usize) -> Result<()> {
    let job = |count| RenderJob {
        scene: scene.clone(),
        view: View::Shaded,
        seed: 0,
        threads: 1,
        count,
        reuse: false,
    };
    let full = |count| solutions::kit().render(&job(count), &Unwatched).expect("not cancelled");
    let caster = Caster::new(scene);

    let (mut picture, mut rays) = (Vec::new(), 0);
    caster.render(&mut picture, &mut rays);
    let counted = full(true);
    ensure!(counted.counts.rays() == rays, "the renderer traces {} rays, {rays} do", counted.counts.rays());
    let off =
        counted.film.pixels.iter().zip(&picture).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-5);
    // Shadow rays start at points that differ by a rounding error, so a few pixels at edges of shadows may differ.
    ensure!(off.count() * 10_000 <= picture.len(), "the pictures differ");

    let (mut minimal, mut fully, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let started = Instant::now();
        caster.render(&mut picture, &mut rays);
        let took = started.elapsed().as_secs_f64();
        let seconds = full(false).render_seconds;
        ratios.push(seconds / took);
        minimal.push(1e3 * took);
        fully.push(1e3 * seconds);
    }
    let [minimal, fully, ratio] = [minimal, fully, ratios].map(median);
    println!("{lights:>17}  {:>9}  {minimal:>10.1}  {fully:>8.1}  {ratio:>6.3}", counted.counts.rays());
    Ok(())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The minimal ray caster with its scene.
struct Caster<'a> {
    scene: &'a Scene,
    triangles: Vec<Triangle>,
    bvh: Bvh,
    /// The position and the radiance of each light, and whether it casts shadows.
    lights: Vec<(Vec3, Vec3, bool)>,
    ambient: Vec3,
    diffuse: Vec3,
    background: Vec3,
}

impl<'a> Caster<'a> {
    fn new(scene: &'a Scene) -> Self {
        let mut triangles = Vec::new();
        for node in &scene.nodes {
            let Some(Shape::Mesh(mesh)) = node.shape else { continue };
            let mesh = &scene.meshes[mesh].mesh;
            for index in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(index).map(|corner| node.transform.transform_point3(corner));
                triangles.push(Triangle { a, b, c });
            }
        }
        let bounds: Vec<Aabb> = triangles.iter().map(stage3_boxes::triangle_bounds).collect();
        let bvh = stage3_build::build(&bounds, scene.quality.split, scene.quality.leaf_size as usize);
        let light = |light: &Light| match light.emitter {
            Emitter::Point { position, .. } => (position, light.radiance(), light.shadows),
            _ => panic!("a point light"),
        };
        let material = &scene.materials[1];
        Caster {
            scene,
            triangles,
            bvh,
            lights: scene.lights.iter().map(light).collect(),
            ambient: scene.ambient * material.ambient,
            diffuse: material.diffuse,
            background: match scene.background {
                Background::Color(color) => color,
                _ => panic!("a background of one colour"),
            },
        }
    }

    fn render(&self, picture: &mut Vec<Vec3>, rays: &mut u64) {
        let (camera, film) = (camera_for(self.scene), self.scene.film);
        let size = glam::uvec2(film.width, film.height).as_vec2();
        picture.clear();
        *rays = 0;
        for row in 0..film.height {
            for column in 0..film.width {
                let place = (glam::uvec2(column, row).as_vec2() + 0.5) / size;
                picture.push(self.color(&camera.ray(place.x, place.y), rays));
            }
        }
    }

    fn color(&self, ray: &Ray, rays: &mut u64) -> Vec3 {
        *rays += 1;
        let Some(hit) = stage3_traversal::closest_hit(&self.bvh, &mut self.probe(ray), ray) else {
            return self.background;
        };
        let triangle = &self.triangles[hit.primitive as usize];
        let surface = surface(ray, triangle);
        let mut color = self.ambient;
        for &(light, radiance, shadows) in &self.lights {
            let to_light = light - surface.point;
            let distance = to_light.length();
            let light = LightSample { direction: to_light / distance, distance, radiance };
            let Some(shadow_ray) = stage4_shading::shadow_ray(&surface, &light) else { continue };
            if shadows {
                *rays += 1;
                if stage3_traversal::any_hit(&self.bvh, &mut self.probe(&shadow_ray), &shadow_ray) {
                    continue;
                }
            }
            color += self.diffuse * radiance * surface.geometric_normal.dot(light.direction);
        }
        color
    }

    fn probe(&self, ray: &Ray) -> Triangles<'_> {
        Triangles { bvh: &self.bvh, triangles: &self.triangles, inverse_direction: ray.direction.recip() }
    }
}

/// A probe for one ray.
struct Triangles<'a> {
    bvh: &'a Bvh,
    triangles: &'a [Triangle],
    inverse_direction: Vec3,
}

impl Probe for Triangles<'_> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.bvh.nodes[node as usize].contents
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        let bounds = &self.bvh.nodes[node as usize].bounds;
        stage3_boxes::slab(ray, self.inverse_direction, bounds).map(|(t_enter, _)| t_enter)
    }

    #[inline]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        stage10_stability::watertight(ray, &self.triangles[primitive as usize]).map(|hit| hit.t)
    }
}

/// The point where the ray hits the triangle, with its normals on the viewer's side.
fn surface(ray: &Ray, triangle: &Triangle) -> Surface {
    let Triangle { a, b, c } = *triangle;
    let hit = stage10_stability::watertight(ray, triangle).expect("it was hit");
    let weights = [1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma];
    let terms = [weights[0] * a, weights[1] * b, weights[2] * c];
    let normal = (b - a).cross(c - a).normalize();
    let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
    Surface {
        point: terms[0] + terms[1] + terms[2],
        error: 3.5 * f32::EPSILON * (terms[0].abs() + terms[1].abs() + terms[2].abs()),
        geometric_normal: normal,
        shading_normal: normal,
    }
}
