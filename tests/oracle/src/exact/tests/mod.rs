//! Compares the tiers with big integers, and verifies the bounds that they rely on.

mod cases;
mod counts;
mod hard;
mod reference;

use super::{Body, Contact, Tier, aabb, meet_with, order_with, verdict_with};
use crate::splitmix::Random;
use cases::ComparedCase;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use reference::Answer;

/// A number from the environment.
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|number| number.parse().ok()).unwrap_or(default)
}

/// Answers for a shape of a case with big integers.
type Reference = fn(&ComparedCase) -> Answer;

/// The shapes of a case, and the functions that answer for them.
fn bodies(case: &ComparedCase) -> [(Body, Reference); 7] {
    [
        (Body::Triangle(case.triangle), |case| reference::triangle(&case.ray, &case.triangle)),
        (Body::Plane(case.plane), |case| reference::plane(&case.ray, &case.plane)),
        (Body::Disk(case.disk), |case| reference::disk(&case.ray, &case.disk)),
        (Body::Sphere(case.sphere), |case| reference::sphere(&case.ray, &case.sphere)),
        (Body::Cuboid(case.cuboid), |case| reference::cuboid(&case.ray, &case.cuboid)),
        (Body::Cylinder(case.cylinder), |case| reference::cylinder(&case.ray, &case.cylinder)),
        (Body::Cone(case.cone), |case| reference::cone(&case.ray, &case.cone)),
    ]
}

fn agree(ray: &Ray, body: Body, answer: &Answer, context: u64) {
    // The widest integers are slow.
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
    for (body, slow) in bodies(case) {
        agree(ray, body, &slow(case), context);
    }
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

/// `CASES=1000000 SEED=7 cargo test --release -p oracle big_integers` compares more and other cases.
#[test]
fn all_tiers_agree_with_big_integers() {
    for case in 0..number("CASES", 20_000) {
        agree_on_all(&cases::any(number("SEED", 1), case), case);
    }
}

/// All shapes in every order, and spheres around the same points and around others.
#[test]
fn orders_of_surds_agree_with_big_integers() {
    let (mut compared, mut equal) = (0, 0);
    for number in 0..800 {
        let (case, other) = (cases::any(5, number), cases::any(6, number));
        let ray = &case.ray;
        let mut twin = case.sphere;
        twin.center += 2.0 * ray.direction.any_orthogonal_vector().normalize_or_zero().round();
        let mut asked: Vec<(Body, Answer)> =
            bodies(&case).into_iter().map(|(body, slow)| (body, slow(&case))).collect();
        asked.extend(
            [twin, other.sphere].map(|sphere| (Body::Sphere(sphere), reference::sphere(ray, &sphere))),
        );
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
