//! The light along rays: surface interactions, Whitted's tree of secondary rays, and random paths of indirect light.

pub mod emitters;
pub mod environment;
pub mod indirect;
pub mod interaction;
pub mod path;
pub mod path_tracer;
pub mod random_choices;
pub mod record;
pub mod rough_lobe;
pub mod texture_filter;
pub mod whitted;
