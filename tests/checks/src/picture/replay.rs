//! One pixel of a picture, asked for again: `raykata check CHECK --pixel X,Y`.

use super::{CHANNEL_TOLERANCE, Size, gamma, linear, read_golden};
use crate::broken::CheckResult;
use glam::Vec3;
use raykata::film::Film;
use raykata::ray::Ray;
use std::sync::{Mutex, PoisonError};

/// A request for one pixel. The check of a picture asks the kit only for what this pixel needs, and leaves the result here.
#[derive(Debug)]
pub struct Replay {
    /// The column, from the left.
    pub x: u32,
    /// The row, from the top.
    pub y: u32,
    result: Mutex<Option<Replayed>>,
}

/// What is known about a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// The name of the golden picture.
    pub picture: String,
    /// The size of the picture; the pixel may lie outside.
    pub size: Size,
    /// The ray through the middle of the pixel; `None` for a picture of random samples.
    pub ray: Option<Ray>,
    /// The colour of the golden picture; `None` if the pixel lies outside of it.
    pub expected: Option<Vec3>,
    /// The colour that the answers of the kit make, once they are known.
    pub yours: Option<Vec3>,
}

impl Replayed {
    /// Whether the colours differ by more than a picture may.
    pub fn differs(&self) -> bool {
        let (Some(yours), Some(expected)) = (self.yours, self.expected) else { return true };
        let bytes = |color: Vec3| Film { width: 1, height: 1, pixels: vec![color] }.to_bytes(gamma());
        let [yours, expected] = [yours, expected].map(bytes);
        let mut channels = yours.rgb.iter().zip(&expected.rgb);
        yours.not_a_number > 0 || channels.any(|(a, b)| a.abs_diff(*b) > CHANNEL_TOLERANCE)
    }
}

impl Replay {
    /// A request for the pixel in column `x` and row `y`.
    pub fn new(x: u32, y: u32) -> Replay {
        Replay { x, y, result: Mutex::new(None) }
    }

    /// What is known about the pixel; `None` if the check compares no picture.
    pub fn result(&self) -> Option<Replayed> {
        self.result.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Composes the pixel, and leaves what is known before and after that, because student code may not answer.
    pub(super) fn show(
        &self,
        name: &str,
        size: Size,
        ray: Option<Ray>,
        color: impl FnOnce() -> Option<Vec3>,
    ) -> CheckResult {
        let golden = read_golden(name)?;
        let is_inside = self.x < golden.width() && self.y < golden.height();
        let expected = is_inside.then(|| linear(&golden, self.x, self.y));
        let keep = |yours| {
            let result = Replayed { picture: name.into(), size, ray, expected, yours };
            *self.result.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        };
        keep(None);
        if is_inside {
            keep(color());
        }
        Ok(())
    }
}

/// The line of a message with the command that asks for a pixel again.
pub(super) fn command(check: &str, x: u32, y: u32) -> String {
    format!("replay the worst pixel: cargo run -- check {check} --pixel {x},{y}")
}
