//! The counts that the tiers rest on: roundings of the filter, and bits of the integers.

use super::cases;
use crate::exact::body::{Against, First, Meet, Order};
use crate::exact::ring::{Approx, Ring};
use crate::exact::scale::{Frame, Scale};
use crate::exact::{Body, Question, WIDEST, Wide};
use std::cell::Cell;
use std::ops::{Add, Mul, Neg, Sub};

thread_local! {
    static DEEPEST: Cell<u32> = const { Cell::new(0) };
    static LARGEST: Cell<u32> = const { Cell::new(0) };
}

/// An exact integer that knows how many roundings a double would have met on the way to it.
#[derive(Clone, Copy)]
struct Counted {
    value: Wide<WIDEST>,
    roundings: u32,
}

fn counted(value: Wide<WIDEST>, roundings: u32) -> Counted {
    let (m, e) = value.rounded();
    if m != 0.0 {
        // 2^(exponent of m) <= |m| < twice that, but for the rounding of m, which can only make it larger.
        let bits = (m.to_bits() >> 52 & 0x7ff) as i32 - 1023 + 1 + e;
        let least = bits - i32::from(m.abs() == crate::exact::ring::power(bits - 1 - e));
        LARGEST.set(LARGEST.get().max(least as u32));
    }
    Counted { value, roundings }
}

impl Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        counted(self.value + other.value, self.roundings.max(other.roundings) + 1)
    }
}

impl Sub for Counted {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        counted(self.value - other.value, self.roundings.max(other.roundings) + 1)
    }
}

impl Mul for Counted {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        counted(self.value * other.value, self.roundings + other.roundings + 1)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        counted(-self.value, self.roundings)
    }
}

impl Ring for Counted {
    const EXACT: bool = true;

    fn input(x: f32, scale: Scale) -> Self {
        counted(Ring::input(x, scale), 0)
    }

    fn fraction(t: f64, unit: i32) -> (Self, Self) {
        let (n, d) = Ring::fraction(t, unit);
        (counted(n, 0), counted(d, 0))
    }

    fn sign(&self) -> Option<i32> {
        DEEPEST.set(DEEPEST.get().max(self.roundings));
        self.value.sign()
    }

    fn approx(&self) -> Option<Approx> {
        DEEPEST.set(DEEPEST.get().max(self.roundings));
        self.value.approx()
    }
}

fn count<Q: Question>(question: &Q, most_roundings: u32) {
    let frame: Frame = question.frame(true);
    DEEPEST.set(0);
    LARGEST.set(0);
    let bits = question.bits(&frame);
    if bits < 64 * WIDEST as u32 {
        let _ = question.ask::<Counted>(&frame);
        assert!(LARGEST.get() <= bits, "{} bits, not {bits}", LARGEST.get());
        assert!(DEEPEST.get() <= most_roundings, "{} roundings", DEEPEST.get());
    }
}

#[test]
fn bits_and_roundings_are_as_counted() {
    for number in 0..600 {
        let case = cases::any(3, number);
        let ray = &case.ray;
        let bodies = [
            Body::Triangle(case.triangle),
            Body::Plane(case.plane),
            Body::Disk(case.disk),
            Body::Sphere(case.sphere),
            Body::Cuboid(case.cuboid),
            Body::Cylinder(case.cylinder),
            Body::Cone(case.cone),
        ];
        for body in bodies {
            count(&First { ray, body }, 60);
            count(&Meet { ray, body }, 60);
            count(&Against { ray, body, t: 1.000_000_059_604_644_8 }, 60);
            for other in bodies {
                count(&Order { ray, one: body, other }, 250);
            }
        }
    }
}
