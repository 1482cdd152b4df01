//! Requests to the misbehaving worker: the radius selects what it does.

use glam::Vec3;
use raykata::kit::{Door, KitError, Shapes, SphereQuery, kit_error};
use raykata::ray::Ray;
use raykata::shape::Sphere;
use raykata_cli::worker::Worker;

pub type HitsOrError = Result<Vec<Option<f32>>, KitError>;

pub fn query(radius: f32) -> SphereQuery {
    SphereQuery {
        ray: Ray::new(Vec3::new(-20.0, 0.0, 0.0), Vec3::X),
        sphere: Sphere { center: Vec3::ZERO, radius },
    }
}

pub fn ask(door: &Door<Worker>, radius: f32) -> HitsOrError {
    kit_error::catch(|| door.sphere_algebraic(&[query(radius)]))
}

pub fn how_it_crashed(asked: HitsOrError) -> String {
    match asked {
        Err(KitError::Crashed { how }) => how,
        other => panic!("not a crash: {other:?}"),
    }
}
