//! Known hard boxes.

use super::hard::ray;
use crate::exact::{Contact, aabb};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::ray::Ray;

#[test]
fn boxes() {
    let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let verdict = |ray: Ray, bounds: &Aabb| aabb::overlap(&ray, bounds).unwrap().verdict;
    let hits = |ray: Ray, bounds: &Aabb| verdict(ray, bounds).is_hit();
    // box/inside, box/o-on-face d-in-face, box/exit-at-0, box/-0.0 in all patterns.
    assert_eq!(verdict(ray([0.5, 0.5, 0.5], [1.0, 2.0, 3.0]), &unit), Contact::In);
    for pattern in 0..4 {
        let zero = |bit: u32| if pattern >> bit & 1 == 1 { -0.0 } else { 0.0 };
        assert!(hits(ray([0.0, 1.0, -2.0], [zero(0), zero(1), 1.0]), &unit));
        assert!(!hits(ray([-f32::from_bits(1), 0.5, -2.0], [zero(0), zero(1), 1.0]), &unit));
    }
    assert_eq!(verdict(ray([1.0, 0.5, 0.5], [1.0, 0.0, 0.0]), &unit), Contact::On);
    assert!(!hits(ray([1.0f32.next_up(), 0.5, 0.5], [1.0, 0.0, 0.0]), &unit));
    // box/flat, box/point, box/empty, box/flat-far, box/corner-aimed, box/denormal-d.
    let flat = Aabb::new(vec3(0.0, 0.0, 1e5), vec3(1.0, 1.0, 1e5));
    assert_eq!(verdict(ray([0.5, 0.5, 0.0], [0.0, 0.0, 1.0]), &flat), Contact::In);
    assert!(hits(ray([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), &Aabb::new(Vec3::Z, Vec3::Z)));
    assert!(!hits(ray([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), &Aabb::EMPTY));
    assert_eq!(verdict(ray([-1.0, -1.0, 0.5], [1.0, 1.0, 0.0]), &unit), Contact::In);
    assert_eq!(verdict(ray([-1.0, 1.0, 0.5], [1.0, -1.0, 0.0]), &unit), Contact::On);
    let tiny = f32::from_bits(1);
    assert_eq!(verdict(ray([-1.0, 0.5, 0.5], [tiny, 0.0, tiny]), &unit), Contact::Out);
    assert_eq!(verdict(ray([-0.5, 0.5, 0.25], [tiny, 0.0, tiny]), &unit), Contact::In);
    // The segment is closed at both ends.
    let segment = |t_min, t_max| ray([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0]).with_range(t_min, t_max);
    assert_eq!(verdict(segment(0.0, 1.0), &unit), Contact::On);
    assert_eq!(verdict(segment(2.0, 3.0), &unit), Contact::On);
    assert_eq!(verdict(segment(0.0, 1.0f32.next_down()), &unit), Contact::Out);
    assert_eq!(verdict(segment(1.5, 1.0), &unit), Contact::Out);
    assert!(aabb::overlap(&segment(0.0, 1.0), &unit).unwrap().margin < 1e-6);
    assert!(aabb::overlap(&segment(0.0, 1.5), &unit).unwrap().margin > 1e5);
}
