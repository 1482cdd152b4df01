//! Times within the shutter interval, and positions of moving objects.

use super::pixels::unit_number;
use checks::prelude::*;
use checks::statistics::{columns, covers_each_part};
use raykata::camera::Shutter;

/// The table of the slide.
const TABLE: [[u32; 4]; 4] = [[7, 11, 3, 14], [4, 15, 13, 9], [16, 1, 8, 12], [6, 10, 5, 2]];

pub(super) fn temporal_table_has_each_time_once(trial: &Trial<'_>) -> CheckResult {
    let judge = |cells: &[(u32, u32)]| -> Vec<CheckResult> {
        match kit_error::catch(|| trial.kit.temporal_slot(cells)) {
            Ok(slots) => {
                let twice = |slot: &u32| slots.iter().filter(|other| *other == slot).count() > 1;
                proven(cells.iter().zip(&slots).map(|(cell, slot)| judge_slot(*cell, *slot, twice(slot))))
            }
            Err(KitError::Panicked { message, place }) => {
                let ((x, y), yours) = (cells[0], format!("a panic at {place}: {message}"));
                let input = format!("temporal_slot(x, y) for x in {x}..{}, y in {y}..{}", x + 4, y + 4);
                let broken = Broken::with_texts(input, yours, "each of 1..=16 once", "the definition");
                // The first block must have passed.
                vec![Err(broken.explained_by([((x, y) != (0, 0), REPEAT)]))]
            }
            Err(error) => kit_error::unwind(error),
        }
    };
    let block =
        |(x, y): (u32, u32)| (0..16).map(|index| (x + index % 4, y + index / 4)).collect::<Vec<(u32, u32)>>();
    // Judge the first block alone, because code without the repetition panics outside of it.
    all_hold(judge(&block((0, 0))))?;
    let others = [(4, 8), (1, 3), (1022, 765), (4_294_967_288, 4_294_967_288)];
    all_hold(others.into_iter().flat_map(|corner| judge(&block(corner))).collect())?;
    let corners = (0..u32::MAX - 3, 0..u32::MAX - 3);
    trial.forall(50, corners, |corners| {
        corners.iter().map(|corner| all_hold(judge(&block(*corner)))).collect()
    })
}

const REPEAT: &str = "blocks repeat: take x and y modulo 4";

/// `twice` says whether the block of this cell has the slot twice.
fn judge_slot((x, y): (u32, u32), slot: u32, twice: bool) -> Judged {
    let expected = TABLE[y as usize % 4][x as usize % 4];
    let broken = || {
        let input = format!("temporal_slot({x}, {y})");
        Broken::new(input, slot, expected, "the table of the slide").explained_by([
            // The first block is right, so the table is as well.
            (x.max(y) > 3, REPEAT),
            (twice, "a block of 4 × 4 cells has this slot twice, and another one is missing: compare the table and its index"),
        ])
    };
    unless(slot == expected, broken).formulas(named![
        slot == TABLE[x as usize % 4][y as usize % 4] => "you exchange rows and columns: y is the row",
        slot == 1 + 4 * (y % 4) + x % 4 => "you number the slots in order: use the table",
        slot + 1 == expected => "slots are counted from 1",
        slot == TABLE[3 - y as usize % 4][x as usize % 4] => "your rows are upside down: row 0 is the first line",
    ])
}

fn paste(query: &TimeQuery) -> String {
    let TimeQuery { shutter, slot, slots, u } = query;
    format!("time_in_shutter({}, {slot}, {slots}, {})", shutter.paste(), u.paste())
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
    // Begin with a shutter for which all known mistakes give different times, and one that is open for a moment only.
    let drawn = TimeQuery { shutter: Shutter { open: 0.25, close: 0.875 }, slot: 2, slots: 4, u: 0.375 };
    let moment = TimeQuery { shutter: Shutter { open: 0.3, close: 0.3 }, slot: 16, slots: 16, u: 0.75 };
    trial.each_and(&[drawn, moment], 3000, queries, <dyn Kit>::time_in_shutter, judge_time)
}

const FROM_ZERO: &str = "you count slots from 0: slot 1 begins at open";
const WITHOUT_OPEN: &str = "you start at 0: the shutter opens at open";
const TIMES_CLOSE: &str = "you multiply by close: use open + share * (close - open)";

fn judge_time(query: &TimeQuery, yours: f32) -> Judged {
    let (open, close) = (f64::from(query.shutter.open), f64::from(query.shutter.close));
    let u = f64::from(query.u);
    let share = |slot: u32| (f64::from(slot) - 1.0 + u) / f64::from(query.slots);
    let here = share(query.slot);
    let at = |share: f64| open + share * (close - open);
    let expected = at(here);
    let near = |time: f64| (f64::from(yours) - time).abs() < 3e-7; // a few roundings of 1
    let open_then = (query.shutter.open..=query.shutter.close).contains(&yours);
    let next = at(share(query.slot + 1));
    let broken = || {
        Broken::new(paste(query), yours, expected, "double precision")
            .explained_by([(near(expected), "your time is outside open..=close by a rounding error: clamp")])
    };
    unless(near(expected) && open_then, broken).formulas([
        (near(next), FROM_ZERO),
        (near(next.min(close)), FROM_ZERO),
        (near(here), "you return a fraction of the interval: scale it to open..close"),
        (near(expected - open), WITHOUT_OPEN),
        (near((expected - open).clamp(open, close)), WITHOUT_OPEN),
        (near(open + here * close), TIMES_CLOSE),
        (near((open + here * close).clamp(open, close)), TIMES_CLOSE),
        (near(at(u)), "you leave out the slot: u is the position in the slot"),
        "you do not use u: every time is the beginning of its slot"
            .when(near(at((f64::from(query.slot) - 1.0) / f64::from(query.slots)))),
        "you do not use u: every time is the middle of its slot"
            .when(near(at(share(query.slot) - (u - 0.5) / f64::from(query.slots)))),
        (near(close + here * (open - close)), "you go from close to open"),
    ])
}

pub(super) fn times_are_even(trial: &Trial<'_>) -> CheckResult {
    let shutter = Shutter { open: 0.25, close: 0.75 };
    let are_in_slot = std::cell::Cell::new(true);
    // A time depends on one number. The other one spreads the times over the square.
    let places = |u: &[Vec2]| {
        let query = |u: &Vec2| TimeQuery { shutter, slot: 7, slots: 16, u: u.x };
        let times = trial.kit.time_in_shutter(&u.iter().map(query).collect::<Vec<_>>());
        let share = |time: &f32| 32.0 * (f64::from(*time) - 0.25) - 6.0;
        are_in_slot.set(times.iter().all(|time| (-1e-3..=1.001).contains(&share(time))));
        Ok(times.iter().map(share).zip(u.iter().map(|u| f64::from(u.y))).collect())
    };
    let axes = ["the time in its slot", "another number"];
    covers_each_part("time_in_shutter in slot 7 of 16", axes, trial.seed, None, places, |counts| {
        let of_slot = columns(counts);
        vec![(
            are_in_slot.get() && of_slot.contains(&0) && of_slot.iter().any(|n| *n > 0),
            "you do not use the whole slot: u is the position in the slot",
        )]
    })
}

type Move = (Vec3, Vec3, f32);

fn describe((start, end, time): &Move) -> String {
    call("lerp", &[start, end, time])
}

/// Pairs of points at any distance from each other, at all scales, some equal in a coordinate.
fn ways() -> impl Strategy<Value = (Vec3, Vec3)> + Clone {
    let near_each_other = (point(4), point(4), magnitude(-7.0, 3.0), nasty::any_scale())
        .prop_map(|(start, step, small, scale)| (scale * start, scale * (start + small * step)));
    prop_oneof![3 => near_each_other, 1 => (nasty::point(), nasty::point())]
}

const ROUNDED_END: &str = "start + t (end - start) has a rounding error at the end";
const CLAMPED_IN_ORDER: &str = "you clamp as if start were below end: use start.min(end) and start.max(end)";

pub(super) fn lerp_is_exact_where_it_must(trial: &Trial<'_>) -> CheckResult {
    let ends = || prop_oneof![(rough_point(1000.0), rough_point(1000.0)), (nasty::point(), nasty::point())];
    let inputs = (ends(), 0.0..=1.0f32, 0..4i32).prop_map(|((start, end), time, which)| match which {
        0 => (start, end, 0.0),
        1 => (start, end, 1.0),
        _ => (start, start, time),
    });
    trial.each(3000, inputs, <dyn Kit>::lerp, |query, yours| {
        let (start, end, time) = *query;
        let expected = if time == 1.0 { end } else { start };
        let is = |v: Vec3| (yours - v).abs().cmple(f32::EPSILON * v.abs()).all();
        let still = start == end;
        // A start at any time but 1, or an end at time 1, must be exact.
        let source = if still { "start, because start equals end" } else { "bit for bit" };
        unless(yours == expected, || Broken::new(describe(query), yours, expected, source)).formulas([
            (yours == start + time * (end - start), ROUNDED_END),
            (yours == (start + time * (end - start)).max(start.min(end)).min(start.max(end)), ROUNDED_END),
            "(1 - t) a + t a has a rounding error: clamp between start and end"
                .when(is((1.0 - time) * start + time * end)),
            (yours == ((1.0 - time) * start + time * end).min(end).max(start), CLAMPED_IN_ORDER),
            (yours == ((1.0 - time) * start + time * end).max(start).min(end), CLAMPED_IN_ORDER),
            (yours == if time == 1.0 { start } else { end }, "you exchange start and end"),
        ])
    })
}

pub(super) fn lerp_stays_on_the_way(trial: &Trial<'_>) -> CheckResult {
    // Times just below 1, where a rounding error may leave the box, and just above 0.
    let time = prop_oneof![6 => 0.0..=1.0f32, 1 => Just(1.0 - f32::EPSILON / 2.0), 1 => Just(1e-7f32)];
    let queries = (ways(), time).prop_map(|((start, end), time)| (start, end, time));
    trial.each(4000, queries, <dyn Kit>::lerp, |query, yours| {
        let (start, end, time) = *query;
        let exact = start.as_dvec3().lerp(end.as_dvec3(), f64::from(time));
        // The tolerance covers five roundings of the larger end, per axis: end - start is up to twice as large.
        let slack = 3e-7 * start.abs().max(end.abs()).as_dvec3();
        let off = |place: DVec3| (yours.as_dvec3() - place).abs();
        let near = off(exact).cmple(slack).all();
        let inside = Aabb::new(start.min(end), start.max(end)).contains(yours);
        let at = |time: f64| start.as_dvec3().lerp(end.as_dvec3(), time);
        let is = |place: DVec3| off(place).cmple(2.0 * slack).all();
        let (start_at, end_at, t) = (start.as_dvec3(), end.as_dvec3(), f64::from(time));
        let broken = || {
            let rounded = "your point is outside the box of both ends by a rounding error: clamp";
            Broken::new(describe(query), yours, exact.as_vec3(), "double precision, within the ends")
                .explained_by([(near, rounded)])
        };
        unless(near && inside, broken).formulas([
            (is(at(1.0 - t)), "you exchange start and end"),
            (is(start_at + t * end_at), "you use end as a displacement: it is a position"),
            (is(at(t * t * (3.0 - 2.0 * t))), "your speed varies: the motion is linear in time"),
            (is(at(0.5)), "you return the midpoint for every time"),
            (is(start_at), "you return start for every time"),
            (is(end_at), "you return end for every time"),
            (is(exact.max(start_at).min(end_at)), CLAMPED_IN_ORDER),
            (is(exact.min(end_at).max(start_at)), CLAMPED_IN_ORDER),
        ])
    })
}

pub(super) fn motion_bounds_covers_the_way_and_no_more(trial: &Trial<'_>) -> CheckResult {
    // Boxes of all kinds: points, flat boxes, equal boxes, and boxes that share a coordinate.
    let around = || {
        let sizes = prop_oneof![point(2), nasty::lattice(1)];
        (prop_oneof![point(4), nasty::lattice(1)], sizes)
            .prop_map(|(min, size)| Aabb::new(min, min + size.abs()))
    };
    let scaled = |bounds: Aabb, scale: f32| Aabb::new(scale * bounds.min, scale * bounds.max);
    let ways = (around(), around(), nasty::any_scale())
        .prop_map(move |(start, end, scale)| (scaled(start, scale), scaled(end, scale)));
    trial.each(2000, ways, <dyn Kit>::motion_bounds, judge_bounds)
}

fn judge_bounds((start, end): &(Aabb, Aabb), yours: Aabb) -> Judged {
    let expected = Aabb::new(start.min.min(end.min), start.max.max(end.max));
    let way = 0.5 * (end.min + end.max - start.min - start.max);
    let moved = Aabb::new(start.min.min(start.min + way), start.max.max(start.max + way));
    let outside = !(yours.min.cmple(expected.min).all() && expected.max.cmple(yours.max).all());
    let broken = || {
        let input = call("motion_bounds", &[start, end]);
        Broken::new(input, yours, expected, "the corners move along straight lines").explained_by([
            (outside, "part of the motion is outside your box"),
            (!outside, "your box is larger than necessary"),
        ])
    };
    unless(yours == expected, broken).formulas(named![
        yours == *start => "you return the start box: include the end box",
        yours == *end => "you return the end box: include the start box",
        yours == Aabb::new(0.5 * (start.min + end.min), 0.5 * (start.max + end.max)) =>
            "you return the box at half time: include both ends",
        yours == Aabb::new(start.min.max(end.min), start.max.min(end.max)) =>
            "you return the intersection of both boxes: return the box around them",
        yours == Aabb::new(start.min, end.max) => "you take min from start and max from end: use both boxes for each",
        yours == moved => "you move the start box: the end box may have another size",
    ])
}
