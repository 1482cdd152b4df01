//! The words of nearly all checks, with the questions and answers of the door: `use checks::prelude::*`.

pub use crate::broken::{Broken, CheckResult, Words, all_hold};
pub use crate::double::U;
pub use crate::generate::{direction, fractions, magnitude, point, rough_point};
pub use crate::judge::{Judged, compare, compare_formulas, proven, unless};
pub use crate::paste::{Arguments, Paste, call, list};
pub use crate::{Trial, named, nasty};
pub use glam::{DVec3, Vec2, Vec3, vec2, vec3};
pub use proptest::prelude::*;
pub use raykata::aabb::Aabb;
pub use raykata::kit::*;
pub use raykata::ray::Ray;
pub use raykata::shape::{Plane, Sphere, Triangle};
