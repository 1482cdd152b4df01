//! Tests secondary rays in whole frames. No ray may hit the surface that it leaves, and every ray must hit a wall that lies
//! 64 floats behind it.

use anyhow::{Result, anyhow, ensure};
use glam::Vec3;
use oracle::splitmix::Random;
use raykata::count::Counts;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, View};
use raykata::scene::load;
use std::path::Path;

/// The number of camera rays of one frame.
pub const RAYS: u64 = SIDE * SIDE;
const SIDE: u64 = 500;

/// A square pane, and the position of a camera that sees only the pane.
struct Pane {
    corners: [Vec3; 4],
    normal: Vec3,
    middle: Vec3,
    eye: Vec3,
}

impl Pane {
    /// Draws a random pane. Its size is 0.001 to 100,000, it lies up to 100 sizes away from the origin, and the camera is
    /// 1 to 10 sizes away from it along the normal.
    fn draw(random: &mut Random) -> Pane {
        // Draw size, position and orientation of the pane.
        let size = 10f32.powf(1.0 + 4.0 * random.signed());
        let middle = size * 10f32.powf(3.0 * random.unit() - 1.0) * random.in_cube();
        let normal = random.in_cube().try_normalize().unwrap_or(Vec3::Y);
        let (side, up) = normal.any_orthonormal_pair();
        let corner = |x: f32, y: f32| middle + size * (x * side + y * up);
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        // Draw the position of the camera.
        let lean = 0.9 * random.signed() * side + 0.9 * random.signed() * up;
        let eye = middle + size * (1.0 + 9.0 * random.unit()) * (normal + lean);
        Pane { corners, normal, middle, eye }
    }

    /// Returns 64 times the distance between the largest coordinate and the next float.
    fn gap(&self) -> f32 {
        let largest = self.corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        64.0 * (largest.next_up() - largest)
    }

    /// Returns a scene with a pane that reflects half of the light and transmits the other half straight on. With
    /// `with_wall`, a wall lies directly behind it.
    fn scene(&self, with_wall: bool) -> String {
        let list = |v: Vec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
        let polygon = |shift: Vec3| {
            let corners = self.corners.map(|corner| list(corner + shift)).join(", ");
            format!("[[nodes]]\nshape = {{ polygon = {{ corners = [{corners}] }} }}\n")
        };
        let away = if (self.eye - self.middle).dot(self.normal) > 0.0 { -self.normal } else { self.normal };
        let wall = if with_wall { polygon(self.gap() * away) } else { String::new() };
        // A fifth of the pane's half side fills half of the film, so that every ray hits the pane, even at an oblique
        // angle.
        let half_side = 0.5 * (self.corners[1] - self.corners[0]).length();
        let fov = 2.0 * (0.2 * half_side / (self.eye - self.middle).length()).atan().to_degrees();
        format!(
            "[film]\nwidth = {SIDE}\nheight = {SIDE}\n[camera]\nposition = {}\nlook_at = {}\nup = {}\n\
             vertical_fov = {fov:?}\n[quality]\nmax_depth = 1\nmin_contribution = 0\n[materials.pane]\ndiffuse = 0\n\
             mirror = 0.5\ntransmission = 0.5\n{}material = \"pane\"\n{wall}",
            list(self.eye),
            list(self.middle),
            list(self.corners[1] - self.corners[0]),
            polygon(Vec3::ZERO),
        )
    }
}

/// Renders a frame of the pane and returns its cost. Every camera ray must hit the pane and spawn two secondary rays.
fn counts(kit: &dyn Kit, scene: &str) -> Result<Counts> {
    let scene = load::parse(Path::new("pane.toml"), scene).map_err(|error| anyhow!("{error}"))?;
    let job = RenderJob { scene, view: View::Shaded, seed: 1, threads: 1, count: true, reuse: false };
    let counts = kit.render(&job, &Unwatched).map_or_else(Counts::default, |frame| frame.counts);
    ensure!(
        counts.reflection == counts.primary && counts.transmission == counts.primary,
        "a camera ray missed the pane: {counts:?}"
    );
    Ok(counts)
}

/// Counts the secondary rays of one frame that hit the pane again. The pane reflects [`RAYS`] rays and transmits as many.
pub fn self_hits(kit: &dyn Kit, random: &mut Random) -> Result<u64> {
    let counts = counts(kit, &Pane::draw(random).scene(false))?;
    Ok(counts.hits - counts.primary)
}

/// Counts the rays that miss the wall directly behind the pane, of the [`RAYS`] transmitted rays of one frame.
pub fn lost_contacts(kit: &dyn Kit, random: &mut Random) -> Result<u64> {
    let counts = counts(kit, &Pane::draw(random).scene(true))?;
    Ok(counts.transmission.saturating_sub(counts.hits - counts.primary))
}
