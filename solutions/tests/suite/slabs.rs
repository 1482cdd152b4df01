//! The slab test against exact arithmetic: it loses no box that a ray meets, for any range and direction.

use oracle::STABLE;
use oracle::exact::aabb::overlap;
use oracle::gauntlet::boxes::of_any_size;
use oracle::splitmix::Random;
use raykata::kit::SlabQuery;
use solutions::stage10_stability::conservative_slab;

#[test]
fn slabs_lose_no_box_that_is_met() {
    let mut random = Random::new(1, 0);
    let (mut met, mut passed, mut close) = (0, 0, 0);
    for _ in 0..1_000_000 {
        let Some(SlabQuery { ray, bounds }) = of_any_size(&mut random) else { continue };
        let Some(exact) = overlap(&ray, &bounds) else { continue };
        let yours = conservative_slab(&ray, ray.direction.recip(), &bounds);
        if exact.verdict.is_hit() {
            met += 1;
            assert!(yours.is_some(), "lost: {ray:?} {bounds:?}");
        } else if exact.margin > STABLE {
            passed += 1;
            // A box whose exit overflows may be entered at infinity, which costs a visit.
            let yours = yours.filter(|(enter, _)| enter.is_finite());
            assert_eq!(yours, None, "{ray:?} {bounds:?} {}", exact.margin);
        } else {
            close += 1;
        }
    }
    println!("{met} met, {passed} passed, {close} passed by a few roundings");
}
