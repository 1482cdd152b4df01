//! Decodes the colours and images of a scene that are encoded with gamma 2.

use super::plan::written::Written;
use crate::film::encode_srgb;
use crate::kit::{Function, RenderJob, StudentFunctions};
use crate::scene::VisibleLight;
use glam::Vec3;
use std::borrow::Cow;
use std::sync::Arc;

/// The job with the colours and images of [`Scene::gamma2`](crate::scene::Scene::gamma2) decoded by `decode_gamma`; the
/// same job if there are none, or if that function is not written.
pub fn decoded<'a, F: StudentFunctions>(job: &'a RenderJob, written: &Written<F>) -> Cow<'a, RenderJob> {
    let encoded = &job.scene.gamma2;
    if encoded.is_empty() || !written.has(Function::decode_gamma) {
        return Cow::Borrowed(job);
    }
    let mut decoded = job.clone();
    // Replace the colours.
    for (place, bytes) in &encoded.colors {
        if let Some(color) = decoded.scene.color_mut(*place) {
            *color = Vec3::from_array(bytes.map(F::decode_gamma));
        }
    }
    // A visible light emits its colour.
    for VisibleLight { light, material } in decoded.scene.visible_lights.clone() {
        decoded.scene.materials[material].emission = decoded.scene.lights[light].visible_radiance();
    }
    // Replace the images: encode each component again, which gives the byte of the file, and decode that.
    let table: [f32; 256] = std::array::from_fn(|byte| F::decode_gamma(byte as u8));
    for &index in &encoded.textures {
        if let Some(texture) = decoded.scene.textures.get_mut(index) {
            let decode = |pixel: &Vec3| pixel.map(|component| table[usize::from(encode_srgb(component))]);
            texture.pixels = Arc::new(texture.pixels.iter().map(decode).collect());
        }
    }
    Cow::Owned(decoded)
}
