//! Embree, a library in C++ that is loaded while the program runs. This file has the only `unsafe` code of the repository.

use crate::crates::{Contestant, of_any};
use libloading::Library;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use std::ffi::{CString, c_char, c_int, c_void};
use std::ptr::null;

/// A sentence for machines without Embree.
pub const HOW_TO_GET: &str = "Embree is missing: run `pip install --target /tmp/embree embreex`, and name the file \
    `/tmp/embree/embreex.libs/libembree4-….so.4` after `--embree`.";

/// `RTCRayHit` of Embree 4: origin, `t_min`, direction, time, `t_max`, mask, id, flags; normal, u, v, primitive, geometry, and
/// instances, of which an index is all ones for a miss.
#[repr(C, align(16))]
struct RayHit([f32; 24]);

impl RayHit {
    fn new(ray: &Ray) -> RayHit {
        let mut words = [f32::from_bits(u32::MAX); 24];
        words[..3].copy_from_slice(&ray.origin.to_array());
        words[3] = ray.t_min;
        words[4..7].copy_from_slice(&ray.direction.to_array());
        (words[7], words[8], words[11]) = (0.0, ray.t_max, 0.0);
        RayHit(words)
    }
}

type Query = unsafe extern "C" fn(*mut c_void, *mut RayHit, *const c_void);

/// A scene of Embree of medium quality, which is the default.
pub struct Embree {
    scene: *mut c_void,
    intersect: Query,
    occluded: Query,
    release: unsafe extern "C" fn(*mut c_void),
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the scene is not used any more.
        unsafe { (self.release)(self.scene) };
    }
}

impl Embree {
    /// Builds a scene by the library at `path` and on so many threads. `None` if there is no such library.
    pub fn build(path: &str, triangles: &[Triangle], robust: bool, threads: usize) -> Option<Embree> {
        let threads = CString::new(format!("threads={threads},set_affinity=0")).ok()?;
        // SAFETY: the types are those of the headers of Embree 4. All buffers are made by Embree and have the stated sizes.
        unsafe {
            let library = Library::new(path).ok()?;
            macro_rules! call {
                ($name:literal($($argument:expr => $Type:ty),*) $(-> $Result:ty)?) => {
                    (library.get::<unsafe extern "C" fn($($Type),*) $(-> $Result)?>($name).ok()?)($($argument),*)
                };
            }
            let device = call!(b"rtcNewDevice"(threads.as_ptr() => *const c_char) -> *mut c_void);
            let scene = call!(b"rtcNewScene"(device => *mut c_void) -> *mut c_void);
            let flags = if robust { 4 } else { 0 };
            call!(b"rtcSetSceneFlags"(scene => *mut c_void, flags => c_int));
            let mesh = call!(b"rtcNewGeometry"(device => *mut c_void, 0 => c_int) -> *mut c_void);
            // Fill the buffers of indices (three numbers, type 0) and of vertices (three coordinates, type 1).
            for (kind, format, n) in [(0, 0x5003, triangles.len()), (1, 0x9003, 3 * triangles.len())] {
                let buffer = call!(b"rtcSetNewGeometryBuffer"(mesh => *mut c_void, kind => c_int, 0 => u32,
                    format => c_int, 12 => usize, n => usize) -> *mut [u32; 3]);
                for (i, Triangle { a, b, c }) in triangles.iter().enumerate() {
                    if kind == 0 {
                        buffer.add(i).write([0, 1, 2].map(|corner| 3 * i as u32 + corner));
                    } else {
                        let corners = [a, b, c].map(|point| point.to_array().map(f32::to_bits));
                        buffer.add(3 * i).cast::<[[u32; 3]; 3]>().write(corners);
                    }
                }
            }
            call!(b"rtcCommitGeometry"(mesh => *mut c_void));
            call!(b"rtcAttachGeometry"(scene => *mut c_void, mesh => *mut c_void) -> u32);
            call!(b"rtcReleaseGeometry"(mesh => *mut c_void));
            call!(b"rtcCommitScene"(scene => *mut c_void));
            let query = |name: &[u8]| library.get::<Query>(name).ok().map(|query| *query);
            let (intersect, occluded) = (query(b"rtcIntersect1")?, query(b"rtcOccluded1")?);
            let release = *library.get::<unsafe extern "C" fn(*mut c_void)>(b"rtcReleaseScene").ok()?;
            // Keep the library until the program ends: a library with threads cannot be unloaded.
            std::mem::forget(library);
            Some(Embree { scene, intersect, occluded, release })
        }
    }
}

impl Contestant for Embree {
    fn trace(&self, rays: &[Ray], any: bool, found: &mut [f32]) {
        for (ray, found) in rays.iter().zip(found) {
            let mut hit = RayHit::new(ray);
            // SAFETY: the scene is committed, and null stands for the default arguments.
            unsafe { (if any { self.occluded } else { self.intersect })(self.scene, &mut hit, null()) };
            *found = if any {
                of_any(hit.0[8] == f32::NEG_INFINITY)
            } else if hit.0[18].to_bits() == u32::MAX {
                f32::INFINITY
            } else {
                hit.0[8]
            };
        }
    }
}
