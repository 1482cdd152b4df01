//! Compares the tiers with big integers, and verifies the bounds that they rely on.

mod boxes;
#[path = "../../../examples/oracle/cases.rs"]
#[expect(dead_code, reason = "some of it is for measuring")]
mod cases;
mod counts;
mod hard;
#[path = "../../../examples/oracle/reference/mod.rs"]
mod reference;

use super::{Body, Contact, Tier, aabb, meet_with, order_with, verdict_with};
use crate::splitmix::Random;
use cases::ComparedCase;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use reference::Answer;

fn agree(ray: &Ray, body: Body, answer: &Answer, context: u64) {
    // The widest integers are slow in this profile; the long run of `examples/oracle` asks them always.
    for tier in Tier::ALL.into_iter().filter(|&tier| tier != Tier::Widest || context.is_multiple_of(8)) {
        let must = matches!(tier, Tier::Auto | Tier::Widest);
        let word = |verdict| [Contact::Out, Contact::On, Contact::In].iter().position(|&v| v == verdict);
        let verdict = verdict_with(tier, ray, body);
        assert!(verdict.is_some() || !must, "case {context} {tier:?} {ray:?} {body:?}: no answer");
        if let Some(verdict) = verdict {
            assert_eq!(word(verdict), Some(answer.0.into()), "case {context} {tier:?} {ray:?} {body:?}");
        }
        let meeting = meet_with(tier, ray, body);
        assert!(meeting.is_some() || !must, "case {context} {tier:?} {ray:?} {body:?}: no answer");
        if let Some(meeting) = meeting {
            let fits = match (&answer.1, meeting.t) {
                (None, None) => true,
                (Some(time), Some(t)) => time.rounds_to(t),
                _ => false,
            };
            assert!(fits, "case {context} {tier:?} {ray:?} {body:?}: {meeting:?}");
        }
    }
}

fn agree_on_all(case: &ComparedCase, context: u64) {
    let ray = &case.ray;
    agree(ray, Body::Triangle(case.triangle), &reference::triangle(ray, &case.triangle), context);
    agree(ray, Body::Plane(case.plane), &reference::plane(ray, &case.plane), context);
    agree(ray, Body::Disk(case.disk), &reference::disk(ray, &case.disk), context);
    agree(ray, Body::Sphere(case.sphere), &reference::sphere(ray, &case.sphere), context);
    agree(ray, Body::Cuboid(case.cuboid), &reference::cuboid(ray, &case.cuboid), context);
    agree(ray, Body::Cylinder(case.cylinder), &reference::cylinder(ray, &case.cylinder), context);
    agree(ray, Body::Cone(case.cone), &reference::cone(ray, &case.cone), context);
    let bounds = Aabb::new(case.cuboid.min, case.cuboid.max);
    let overlaps = reference::overlaps(ray, &bounds);
    for tier in Tier::ALL.into_iter().filter(|&tier| tier != Tier::Widest || context.is_multiple_of(8)) {
        let verdict = aabb::verdict_with(tier, ray, &bounds);
        assert!(
            verdict.is_none_or(|verdict| verdict.is_hit() == overlaps),
            "case {context} {tier:?} {ray:?} {bounds:?}"
        );
        assert!(
            verdict.is_some() || !matches!(tier, Tier::Auto | Tier::Widest),
            "case {context} {tier:?}: {ray:?}"
        );
    }
}

#[test]
fn all_tiers_agree_with_big_integers() {
    for case in 0..20_000 {
        agree_on_all(&cases::any(1, case), case);
    }
}

/// Spheres, cylinders and cones in every order, around the same points and around others.
#[test]
fn orders_of_surds_agree_with_big_integers() {
    let (mut compared, mut equal) = (0, 0);
    for number in 0..800 {
        let (case, other) = (cases::any(5, number), cases::any(6, number));
        let ray = &case.ray;
        let mut twin = case.sphere;
        twin.center += 2.0 * ray.direction.any_orthogonal_vector().normalize_or_zero().round();
        let asked = [
            (Body::Sphere(case.sphere), reference::sphere(ray, &case.sphere)),
            (Body::Sphere(twin), reference::sphere(ray, &twin)),
            (Body::Sphere(other.sphere), reference::sphere(ray, &other.sphere)),
            (Body::Cylinder(case.cylinder), reference::cylinder(ray, &case.cylinder)),
            (Body::Cone(case.cone), reference::cone(ray, &case.cone)),
            (Body::Disk(case.disk), reference::disk(ray, &case.disk)),
        ];
        for (one, first) in &asked {
            for (two, second) in &asked {
                let (Some(first), Some(second)) = (&first.1, &second.1) else { continue };
                // Beyond that the plain comparison of roots takes too long.
                if [first, second]
                    .iter()
                    .any(|time| time.cmp_double(1e30).is_gt() || time.cmp_double(-1e30).is_lt())
                {
                    continue;
                }
                let order = first.cmp_any(second);
                for tier in Tier::ALL.into_iter().filter(|&tier| tier != Tier::Widest) {
                    let answer = order_with(tier, ray, *one, *two);
                    assert!(
                        answer.is_none_or(|answer| answer == order),
                        "case {number} {tier:?} {one:?} {two:?}"
                    );
                }
                compared += 1;
                equal += u32::from(order.is_eq());
            }
        }
    }
    assert!(compared > 300 && equal > 30 && equal < compared, "{compared} {equal}");
}
