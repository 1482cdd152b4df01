//! Rays that leave a surface, as whole frames trace them: none may meet the surface that it leaves, and all must meet
//! what lies 64 steps of a float behind it.

use anyhow::{Result, anyhow, ensure};
use glam::Vec3;
use oracle::splitmix::Random;
use raykata::count::Counts;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, View};
use raykata::scene::load;
use std::path::Path;

/// Rays of one frame.
pub const RAYS: u64 = SIDE * SIDE;
const SIDE: u64 = 500;

/// A square pane somewhere, and an eye that sees nothing else.
struct Pane {
    corners: [Vec3; 4],
    normal: Vec3,
    middle: Vec3,
    eye: Vec3,
}

impl Pane {
    /// Of size 0.001 to 100,000, up to 100 sizes away from the origin, looked at from 1 to 10 sizes away.
    fn draw(random: &mut Random) -> Pane {
        let size = 10f32.powf(1.0 + 4.0 * random.signed());
        let middle = size * 10f32.powf(3.0 * random.unit() - 1.0) * random.in_cube();
        let normal = random.in_cube().try_normalize().unwrap_or(Vec3::Y);
        let (side, up) = normal.any_orthonormal_pair();
        let corner = |x: f32, y: f32| middle + size * (x * side + y * up);
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let lean = 0.9 * random.signed() * side + 0.9 * random.signed() * up;
        let eye = middle + size * (1.0 + 9.0 * random.unit()) * (normal + lean);
        Pane { corners, normal, middle, eye }
    }

    /// 64 steps of a float of the largest coordinate.
    fn gap(&self) -> f32 {
        let largest = self.corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        64.0 * (largest.next_up() - largest)
    }

    /// A mirror that lets half of the light through, straight on; and, if asked for, a wall right behind it.
    fn scene(&self, with_wall: bool) -> String {
        let list = |v: Vec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
        let polygon = |shift: Vec3| {
            let corners = self.corners.map(|corner| list(corner + shift)).join(", ");
            format!("[[nodes]]\nshape = {{ polygon = {{ corners = [{corners}] }} }}\n")
        };
        let away = if (self.eye - self.middle).dot(self.normal) > 0.0 { -self.normal } else { self.normal };
        let wall = if with_wall { polygon(self.gap() * away) } else { String::new() };
        // A fifth of the pane's half side fills half of the film, so that every ray meets the pane, aslant as well.
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

/// What a frame of the pane cost; every ray from the camera must have met it and have sent on two.
fn counts(kit: &dyn Kit, scene: &str) -> Result<Counts> {
    let scene = load::parse(Path::new("pane.toml"), scene).map_err(|error| anyhow!("{error}"))?;
    let job = RenderJob { scene, view: View::Shaded, seed: 1, threads: 1, count: true };
    let counts = kit.render(&job, &Unwatched).map_or_else(Counts::default, |frame| frame.counts);
    ensure!(
        counts.reflection == counts.primary && counts.transmission == counts.primary,
        "not every ray from the eye met the pane: {counts:?}"
    );
    Ok(counts)
}

/// Of [`RAYS`] rays each that a mirror and a pane of glass send on in one frame: how many meet it once more.
pub fn self_hits(kit: &dyn Kit, random: &mut Random) -> Result<u64> {
    let counts = counts(kit, &Pane::draw(random).scene(false))?;
    Ok(counts.hits - counts.primary)
}

/// Of [`RAYS`] rays through a pane in one frame: how many miss the wall right behind it.
pub fn lost_contacts(kit: &dyn Kit, random: &mut Random) -> Result<u64> {
    let counts = counts(kit, &Pane::draw(random).scene(true))?;
    Ok(counts.transmission.saturating_sub(counts.hits - counts.primary))
}
