//! Checks of `texel`.

use checks::prelude::*;
use raykata::material::Wrap;

pub(super) const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

/// The largest absolute index that is tested.
const REACH: i64 = 40;

/// The texels of `-reach..=reach`, counted step by step from 0 to either side, with a turn or a restart at the ends.
pub(super) fn row(size: u32, wrap: Wrap, reach: i64) -> Vec<u32> {
    let walk = |step: i64| {
        let (mut place, mut step) = (0, step);
        let next = move || {
            let here = place;
            match wrap {
                Wrap::Repeat => place = (place + step + i64::from(size)) % i64::from(size),
                Wrap::Clamp => place = (place + step).clamp(0, i64::from(size) - 1),
                // Each border pixel appears twice in a row.
                Wrap::Mirror if !(0..i64::from(size)).contains(&(place + step)) => step = -step,
                Wrap::Mirror => place += step,
            }
            here as u32
        };
        std::iter::repeat_with(next).take(reach as usize + 1).collect::<Vec<u32>>()
    };
    let below = walk(-1);
    below.into_iter().skip(1).rev().chain(walk(1)).collect()
}

pub(super) fn texels_wrap_as_they_should(trial: &Trial<'_>) -> CheckResult {
    let wrap = prop_oneof![Just(Wrap::Repeat), Just(Wrap::Clamp), Just(Wrap::Mirror)];
    let queries =
        (-REACH..REACH, 1..9u32, wrap).prop_map(|(index, size, wrap)| TexelQuery { index, size, wrap });
    // Indices at which each known mistake gives another column.
    let drawn = [(-1, Wrap::Repeat), (5, Wrap::Clamp), (-1, Wrap::Mirror), (5, Wrap::Mirror)]
        .map(|(index, wrap)| TexelQuery { index, size: 4, wrap });
    trial.each_and(&drawn, 3000, queries, <dyn Kit>::texel, judge_texel)
}

fn judge_texel(query: &TexelQuery, yours: u32) -> Judged {
    let TexelQuery { index, size, wrap } = *query;
    let of = |wrap| i64::from(row(size, wrap, REACH)[(index + REACH) as usize]);
    let (expected, size) = (of(wrap), i64::from(size));
    let is = |wrong: i64| yours == wrong as u32;
    // A formula that is wrong for one wrap mode only.
    let only = |mode: Wrap, wrong: i64| is(if wrap == mode { wrong } else { expected });
    let period = (2 * size - 2).max(1);
    let once = index.rem_euclid(period);
    let twice = index.rem_euclid(2 * size);
    let remainder = "you are wrong for negative indices: the remainder of a negative number is negative, so use rem_euclid";
    let unsigned = "you are wrong for negative indices: the remainder of a negative number, without its sign, counts from the other end, so use rem_euclid";
    let input = || format!("texel({index}, {size}, Wrap::{wrap:?})");
    let broken = || Broken::new(input(), yours, expected, "counted step by step");
    unless(i64::from(yours) == expected, broken).formulas([
        "you return an index of size or more: the last one is size - 1"
            .when(only(Wrap::Clamp, index.clamp(0, size))),
        "you take a negative index without its sign: Wrap::Clamp continues the border there, so it is 0"
            .when(only(Wrap::Clamp, index.abs().min(size - 1))),
        (only(Wrap::Repeat, index % size), remainder),
        (only(Wrap::Repeat, index.abs() % size), unsigned),
        // The lowest bits are right for a power of two.
        (only(Wrap::Repeat, if size & (size - 1) == 0 { expected } else { index.abs() % size }), unsigned),
        "you are off by one: Wrap::Mirror shows each border pixel twice in a row, and you show it once"
            .when(only(Wrap::Mirror, once.min(period - once))),
        "you are off by one for negative indices: Wrap::Mirror shows each border pixel twice in a row".when(
            only(Wrap::Mirror, {
                let there = index.abs() % (2 * size);
                there.min(2 * size - 1 - there)
            }),
        ),
        "you are off by one on the way back: Wrap::Mirror shows each border pixel twice in a row"
            .when(only(Wrap::Mirror, twice.min(2 * size - twice))),
        "you continue the border for Wrap::Repeat, as Wrap::Clamp does"
            .when(only(Wrap::Repeat, of(Wrap::Clamp))),
        "you continue the border for Wrap::Mirror, as Wrap::Clamp does"
            .when(only(Wrap::Mirror, of(Wrap::Clamp))),
        (only(Wrap::Clamp, of(Wrap::Repeat)), "you repeat the image for Wrap::Clamp, as Wrap::Repeat does"),
        (only(Wrap::Mirror, of(Wrap::Repeat)), "you repeat the image for Wrap::Mirror, as Wrap::Repeat does"),
        (is(of(Wrap::Clamp)), "you continue the border for each wrap mode, as Wrap::Clamp does"),
        (is(of(Wrap::Repeat)), "you repeat the image for each wrap mode, as Wrap::Repeat does"),
        (is(of(Wrap::Mirror)), "you mirror the image for each wrap mode, as Wrap::Mirror does"),
        "you exchange two modes: for Wrap::Repeat you continue the border, as Wrap::Clamp does".when(is(
            match wrap {
                Wrap::Repeat => of(Wrap::Clamp),
                Wrap::Clamp => of(Wrap::Repeat),
                Wrap::Mirror => expected,
            },
        )),
    ])
}
