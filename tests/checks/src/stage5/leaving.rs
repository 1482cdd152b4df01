//! Where rays start that go on.

use crate::Trial;
use crate::broken::{Broken, Outcome};
use glam::{DVec3, Vec3, vec3};
use raykata::camera::Camera;
use raykata::kit::{
    ChildrenQuery, LightSample, RayKind, RenderJob, ShadeQuery, ShadowQuery, Surface, TracedRay, View,
};
use raykata::material::{Fresnel, Material};
use raykata::scene::{FilmSettings, Node, Quality, Scene};
use raykata::shape::{Shape, Sphere};

/// Pixels along each side of the picture.
const SIDE: u32 = 12;

/// A ball that mirrors and lets through, large in the picture and nowhere near the origin.
fn scene(size: f32) -> (Scene, Sphere) {
    let ball = Sphere { center: size * vec3(0.7, -0.3, 0.45), radius: size };
    let eye = ball.center + size * vec3(0.4, 0.8, 3.0);
    let camera =
        Camera::new(eye, ball.center - eye, Vec3::Y, 34.0, 1.0).expect("a camera that looks at the ball");
    let mut scene = Scene::empty(camera);
    scene.film = FilmSettings { width: SIDE, height: SIDE, encoding: Default::default() };
    scene.quality = Quality { max_depth: 3, min_contribution: 0.0, ..Quality::default() };
    scene.materials.push(Material {
        mirror: Vec3::splat(0.5),
        transmission: Vec3::splat(0.5),
        index_of_refraction: 1.5,
        fresnel: Fresnel::None,
        ..Material::default()
    });
    scene.material_names.push("glass".into());
    scene.nodes.push(Node { shape: Some(Shape::Sphere(ball)), material: Some(1), ..Node::default() });
    scene.roots.push(0);
    (scene, ball)
}

/// R6: the slide starts the ray at `hit.Point()`, which is rounded: in half of all cases the ray meets its own surface.
pub(super) fn rays_that_go_on_leave_their_surface(trial: &Trial<'_>) -> Outcome {
    ask_what_it_takes(trial);
    for size in [1.0, 1e-3, 1e5] {
        let (scene, ball) = scene(size);
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: 1, count: false };
        let mut judged = 0;
        for pixel in 0..SIDE * SIDE {
            let rays = trial.kit.trace(&job, pixel % SIDE, pixel / SIDE);
            for ray in
                rays.iter().filter(|ray| matches!(ray.kind, RayKind::Reflection | RayKind::Transmission))
            {
                judged += 1;
                judge(ray, &ball)?;
            }
        }
        if judged == 0 {
            let input =
                format!("the rays behind {SIDE} × {SIDE} pixels, in front of a ball of radius {size}");
            let broken = Broken::told(input, "no ray goes on", "mirrored and refracted rays", "the scene");
            return Err(
                broken.looks_like(Some("the ball is not found or not lit: run the checks of stages 1 to 4"))
            );
        }
    }
    Ok(())
}

/// Says what is not written yet of this stage, and else of stage 4: where a ray starts is the work of both.
fn ask_what_it_takes(trial: &Trial<'_>) {
    let material = Material::default();
    let normal = Vec3::Y;
    let surface =
        Surface { point: Vec3::ZERO, error: Vec3::ZERO, geometric_normal: normal, shading_normal: normal };
    let light = LightSample { direction: normal, distance: 1.0, radiance: Vec3::ONE };
    trial.kit.children(&[ChildrenQuery {
        dir: -normal,
        normal,
        entering: true,
        material: material.clone(),
        weight: Vec3::ONE,
        depth: 0,
        limits: super::children::FAR,
    }]);
    trial.kit.shadow_ray(&[ShadowQuery { surface, light }]);
    trial.kit.shade(&[ShadeQuery {
        surface,
        to_viewer: normal,
        material,
        ambient: Vec3::ONE,
        lights: vec![light],
        visible: vec![true],
    }]);
}

/// Looks in double precision on which side of the ball a ray starts, and whether that is the one it goes to.
fn judge(ray: &TracedRay, ball: &Sphere) -> Outcome {
    let [origin, dir, center] = [ray.origin, ray.dir, ball.center].map(Vec3::as_dvec3);
    let radius = f64::from(ball.radius);
    let out = origin - center;
    // Along the surface either side will do.
    let slope = out.normalize().dot(dir.normalize());
    if slope.abs() < 1e-3 {
        return Ok(());
    }
    let height = (out.length() - radius) * slope.signum();
    // Eight roundings of the way from the centre and of the place, each at most a step of the largest coordinate, and
    // the steps beyond. A fixed offset that is right for a ball of one size is not for others.
    let reach = radius + origin.abs().max_element();
    let most = 64.0 * 2.0 * crate::double::U * reach;
    let diagnosis = match () {
        () if 0.0 < height && height < most => return Ok(()),
        () if height >= most => "a fixed offset is too large here: what touches the surface is not seen",
        () if height > -most => {
            "the ray starts on the surface, or a rounding beyond it, and hits it again: move it by the error of the \
             point, to the side to which it goes"
        }
        () => {
            "the ray starts on the other side: what is mirrored stays on this side, what goes through does not"
        }
    };
    let goes = if slope > 0.0 { "away from" } else { "into" };
    let input = format!(
        "a ray {goes} the ball around {:?} of radius {:?},\n{:?} of depth {}",
        ball.center, ball.radius, ray.kind, ray.depth
    );
    let told = |height: f64| {
        let side = if (height > 0.0) == (slope > 0.0) { "outside" } else { "inside" };
        format!("starts {:.1e} of the radius {side} of its surface", height.abs() / radius)
    };
    let yours =
        if origin.is_finite() { told(height) } else { format!("starts at {}", DVec3::to_string(&origin)) };
    let side = if slope > 0.0 { "outside" } else { "inside" };
    let expected = format!("{side}, by {:.0e} of the radius at most", most / radius);
    Err(Broken::told(input, yours, expected, "double precision").looks_like(Some(diagnosis)))
}
