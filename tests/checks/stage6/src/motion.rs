//! Times within the shutter interval, and positions of moving objects.

use super::pixels::unit_number;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{magnitude, point, rough_point};
use checks::judge::{compare, known};
use checks::paste::{Paste, call};
use checks::statistics::{SAMPLES, columns, covers_evenly, pairs};
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::camera::Shutter;
use raykata::kit::{KitError, TimeQuery, kit_error};

/// The table of the slide.
const TABLE: [[u32; 4]; 4] = [[7, 11, 3, 14], [4, 15, 13, 9], [16, 1, 8, 12], [6, 10, 5, 2]];

pub(super) fn temporal_table_has_each_time_once(trial: &Trial<'_>) -> CheckResult {
    // Any 4 × 4 cells in a square have each slot once, because blocks repeat.
    for (left, top) in [(0, 0), (4, 8), (1, 3), (1022, 765)] {
        let cells: Vec<(u32, u32)> = (0..16).map(|index| (left + index % 4, top + index / 4)).collect();
        let repeat = "blocks repeat: take x and y modulo 4";
        let slots = match kit_error::catch(|| trial.kit.temporal_slot(&cells)) {
            Ok(slots) => slots,
            Err(KitError::Panicked { message, place }) => {
                let input =
                    format!("temporal_slot(x, y) for x in {left}..{}, y in {top}..{}", left + 4, top + 4);
                let yours = format!("a panic at {place}: {message}");
                let broken = Broken::with_texts(input, yours, "each of 1..=16 once", "the definition");
                return Err(broken.looks_like((left > 0).then_some(repeat)));
            }
            Err(error) => kit_error::unwind(error),
        };
        let mut sorted = slots.clone();
        sorted.sort_unstable();
        if sorted != (1..=16).collect::<Vec<_>>() {
            let input = format!("temporal_slot(x, y) for x in {left}..{}, y in {top}..{}", left + 4, top + 4);
            let broken = Broken::new(input, &slots, "each of 1..=16 once", "the table is a permutation");
            let diagnosis = match () {
                () if sorted == (0..16).collect::<Vec<_>>() => "slots are counted from 1",
                () if left > 0 => repeat,
                () => "your table is wrong: one slot is in it twice, and another is missing",
            };
            return Err(broken.looks_like(Some(diagnosis)));
        }
        for ((x, y), slot) in cells.into_iter().zip(slots) {
            let expected = TABLE[y as usize % 4][x as usize % 4];
            if slot != expected {
                let diagnosis = match () {
                    () if slot == TABLE[x as usize % 4][y as usize % 4] => {
                        "you exchange rows and columns: y is the row"
                    }
                    () if slot == 1 + 4 * (y % 4) + x % 4 => "you number the slots in order: use the table",
                    () => "",
                };
                let input = format!("temporal_slot({x}, {y})");
                let broken = Broken::new(input, slot, expected, "the table of the slide");
                return Err(broken.looks_like(known(diagnosis)));
            }
        }
    }
    Ok(())
}

fn paste(query: &TimeQuery) -> String {
    format!(
        "time_in_shutter(&Shutter {{ open: {}, close: {} }}, {}, {}, {})",
        query.shutter.open.paste(),
        query.shutter.close.paste(),
        query.slot,
        query.slots,
        query.u.paste()
    )
}

pub(super) fn times_lie_in_their_slots(trial: &Trial<'_>) -> CheckResult {
    let shutter = (0.0..1.0f32, 0.0..=1.0f32)
        .prop_map(|(first, second)| Shutter { open: first.min(second), close: first.max(second) });
    let whole = Just(Shutter { open: 0.0, close: 1.0 });
    let queries = (prop_oneof![shutter, whole], 1..=16u32, 0.0..1.0f32, unit_number()).prop_map(
        |(shutter, slots, share, u)| TimeQuery {
            shutter,
            slot: 1 + ((share * slots as f32) as u32).min(slots - 1),
            slots,
            u,
        },
    );
    let judge = |queries: &[TimeQuery]| {
        compare(queries, trial.kit.time_in_shutter(queries), |query, yours| {
            let (open, close) = (f64::from(query.shutter.open), f64::from(query.shutter.close));
            let u = f64::from(query.u);
            let share = |slot: u32| (f64::from(slot) - 1.0 + u) / f64::from(query.slots);
            let here = share(query.slot);
            let at = |share: f64| open + share * (close - open);
            let expected = at(here);
            let near = |time: f64| (f64::from(yours) - time).abs() < 3e-7; // a few roundings of 1
            let open_then = (query.shutter.open..=query.shutter.close).contains(&yours);
            if near(expected) && open_then {
                return Ok(());
            }
            let diagnosis = match () {
                () if near(expected) => "your time is outside open..=close by a rounding error: clamp",
                () if near(at(share(query.slot + 1))) => "you count slots from 0: slot 1 begins at open",
                () if near(here) => "you return a fraction of the interval: scale it to open..close",
                () if near(expected - open) => "you start at 0: the shutter opens at open",
                () if near((open + here * close).clamp(open, close)) => {
                    "you multiply by close: use open + share * (close - open)"
                }
                () if near(at(u)) => "you leave out the slot: u is the position in the slot",
                () => "",
            };
            Err(Broken::new(paste(query), yours, expected, "double precision").looks_like(known(diagnosis)))
        })
    };
    // Begin with a shutter for which all known mistakes give different times.
    let drawn = TimeQuery { shutter: Shutter { open: 0.25, close: 0.875 }, slot: 2, slots: 4, u: 0.375 };
    judge(&[drawn]).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, queries, judge)
}

pub(super) fn times_are_even(trial: &Trial<'_>) -> CheckResult {
    let shutter = Shutter { open: 0.25, close: 0.75 };
    let u = pairs(trial.seed, SAMPLES);
    let queries: Vec<TimeQuery> = u
        .iter()
        .enumerate()
        .map(|(index, u)| TimeQuery { shutter, slot: 1 + index as u32 % 16, slots: 16, u: u.x })
        .collect();
    let times = trial.kit.time_in_shutter(&queries);
    // Times must be uniform over the whole interval and within each slot.
    let place = |time: &f32| {
        let share = 2.0 * (f64::from(*time) - 0.25);
        ((16.0 * share).fract(), share)
    };
    let places: Vec<(f64, f64)> = times.iter().map(place).collect();
    covers_evenly("time_in_shutter in 16 slots", &places, ["the time in its slot", "the time"], |counts| {
        let of_slot = columns(counts);
        if of_slot.contains(&0) { "you do not use the whole slot: u is the position in the slot" } else { "" }
    })
}

type Move = (Vec3, Vec3, f32);

fn describe((start, end, time): &Move) -> String {
    call("lerp", &[start, end, time])
}

pub(super) fn lerp_is_exact_where_it_must(trial: &Trial<'_>) -> CheckResult {
    let ends = || (rough_point(1000.0), rough_point(1000.0));
    let time = prop_oneof![Just(0.0f32), Just(1.0f32)];
    let at_ends = (ends(), time).prop_map(|((start, end), time)| (start, end, time));
    trial.forall(1000, at_ends, |queries| {
        compare(queries, trial.kit.lerp(queries), |query, yours| {
            let expected = if query.2 == 0.0 { query.0 } else { query.1 };
            let broken = || Broken::new(describe(query), yours, expected, "bit for bit");
            let near = (yours - expected).length() < 1e-3;
            let smaller = yours == query.0.min(query.1);
            match yours == expected {
                true => Ok(()),
                false if near => {
                    Err(broken().looks_like(Some("start + t (end - start) has a rounding error at the end")))
                }
                false => Err(broken().looks_like(smaller.then_some(
                    "you clamp as if start were below end: use start.min(end) and start.max(end)",
                ))),
            }
        })
    })?;
    let still = (rough_point(1000.0), 0.0..=1.0f32).prop_map(|(place, time)| (place, place, time));
    trial.forall(2000, still, |queries| {
        compare(queries, trial.kit.lerp(queries), |query, yours| match yours == query.0 {
            true => Ok(()),
            false => Err(Broken::new(describe(query), yours, query.0, "start, because start equals end")
                .looks_like(Some("(1 - t) a + t a has a rounding error: clamp between start and end"))),
        })
    })
}

pub(super) fn lerp_stays_on_the_way(trial: &Trial<'_>) -> CheckResult {
    let near_each_other = (point(4), point(4), magnitude(-7.0, 3.0))
        .prop_map(|(start, step, scale)| (start, start + scale * step));
    let queries = (near_each_other, 0.0..=1.0f32).prop_map(|((start, end), time)| (start, end, time));
    let judge = |queries: &[Move]| {
        compare(queries, trial.kit.lerp(queries), |query, yours| {
            let (start, end, time) = *query;
            let exact = start.as_dvec3().lerp(end.as_dvec3(), f64::from(time));
            // The tolerance covers three roundings of the larger end.
            let slack = 2e-7 * f64::from(start.abs().max(end.abs()).max_element());
            let near = (yours.as_dvec3() - exact).abs().max_element() <= slack;
            let inside = Aabb::new(start.min(end), start.max(end)).contains(yours);
            if near && inside {
                return Ok(());
            }
            let at = |time: f64| start.as_dvec3().lerp(end.as_dvec3(), time);
            let is = |place: DVec3| (yours.as_dvec3() - place).length() <= 2.0 * slack;
            let (start_at, t) = (start.as_dvec3(), f64::from(time));
            let diagnosis = match () {
                () if near => "your point is outside the box of both ends by a rounding error: clamp",
                () if is(at(1.0 - t)) => "you exchange start and end",
                () if is(start_at + t * end.as_dvec3()) => "you use end as a displacement: it is a position",
                () if is(at(t * t * (3.0 - 2.0 * t))) => "your speed varies: the motion is linear in time",
                () if is(at(0.5)) => "you return the midpoint for every time",
                () => "",
            };
            Err(Broken::new(describe(query), yours, exact.as_vec3(), "double precision, within the ends")
                .looks_like(known(diagnosis)))
        })
    };
    judge(&[(vec3(1.0, 2.0, -3.0), vec3(2.0, -2.0, 4.5), 0.25)]).into_iter().collect::<CheckResult>()?;
    trial.forall(4000, queries, judge)
}

pub(super) fn motion_bounds_covers_the_way_and_no_more(trial: &Trial<'_>) -> CheckResult {
    let around = || (point(4), point(2)).prop_map(|(min, size)| Aabb::new(min, min + size.abs()));
    let ways = (around(), around()).prop_map(|(start, end)| (start, end));
    let judge = |queries: &[(Aabb, Aabb)]| {
        compare(queries, trial.kit.motion_bounds(queries), |(start, end), yours| {
            let expected = Aabb::new(start.min.min(end.min), start.max.max(end.max));
            if yours == expected {
                return Ok(());
            }
            let at = |time: f64| {
                let blend = |a: Vec3, b: Vec3| a.as_dvec3().lerp(b.as_dvec3(), time);
                (blend(start.min, end.min), blend(start.max, end.max))
            };
            let outside = |(min, max): (DVec3, DVec3)| {
                !(yours.min.as_dvec3().cmple(min).all() && max.cmple(yours.max.as_dvec3()).all())
            };
            let way = 0.5 * (end.min + end.max - start.min - start.max);
            let moved = Aabb::new(start.min.min(start.min + way), start.max.max(start.max + way));
            let diagnosis = match () {
                () if yours == *start => "you return the start box: include the end box",
                () if yours == *end => "you return the end box: include the start box",
                () if yours == Aabb::new(0.5 * (start.min + end.min), 0.5 * (start.max + end.max)) => {
                    "you return the box at half time: include both ends"
                }
                () if yours == Aabb::new(start.min.max(end.min), start.max.min(end.max)) => {
                    "you return the intersection of both boxes: return the box around them"
                }
                () if yours == Aabb::new(start.min, end.max) => {
                    "you take min from start and max from end: use both boxes for each"
                }
                () if yours == moved => "you move the start box: the end box may have another size",
                () if [0.0, 0.5, 1.0].into_iter().any(|time| outside(at(time))) => {
                    "part of the motion is outside your box"
                }
                () => "your box is larger than necessary",
            };
            let input = call("motion_bounds", &[start, end]);
            Err(Broken::new(input, yours, expected, "the corners move along straight lines")
                .looks_like(known(diagnosis)))
        })
    };
    // Begin with a box that moves along each axis and changes its size.
    let drawn =
        (Aabb::new(Vec3::ZERO, vec3(1.0, 1.0, 2.0)), Aabb::new(vec3(0.5, -1.0, 1.0), vec3(4.0, 0.5, 1.5)));
    judge(&[drawn]).into_iter().collect::<CheckResult>()?;
    trial.forall(2000, ways, judge)
}
