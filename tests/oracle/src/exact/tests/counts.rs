//! Verifies the counts on which the tiers rely: roundings of the filter, and bits of the integers.

use super::cases;
use crate::exact::body::{Against, Asked, First, Meet, Order};
use crate::exact::ring::{Approx, Ring};
use crate::exact::scale::{Frame, Scale};
use crate::exact::{Question, WIDEST, Wide};
use std::cell::Cell;
use std::ops::{Add, Mul, Neg, Sub};

thread_local! {
    static DEEPEST: Cell<u32> = const { Cell::new(0) };
    static LARGEST: Cell<u32> = const { Cell::new(0) };
}

/// An exact integer with the number of roundings that a double would have had, and with a bound on the bits
/// of any integer that is computed in the same way: a bound for all inputs of these scales.
#[derive(Clone, Copy)]
struct Counted {
    value: Wide<WIDEST>,
    roundings: u32,
    bits: u32,
}

fn counted(value: Wide<WIDEST>, roundings: u32, bits: u32) -> Counted {
    LARGEST.set(LARGEST.get().max(bits));
    Counted { value, roundings, bits }
}

impl Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let roundings = self.roundings.max(other.roundings) + 1;
        counted(self.value + other.value, roundings, self.bits.max(other.bits) + 1)
    }
}

impl Sub for Counted {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Counted {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let roundings = self.roundings + other.roundings + 1;
        counted(self.value * other.value, roundings, self.bits + other.bits)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        counted(-self.value, self.roundings, self.bits)
    }
}

impl Ring for Counted {
    const EXACT: bool = true;

    fn input(x: f32, scale: Scale) -> Self {
        counted(Ring::input(x, scale), 0, scale.bits())
    }

    fn fraction(t: f64, unit: i32) -> (Self, Self) {
        let (n, d) = Ring::fraction(t, unit);
        let bits = |number: Wide<WIDEST>| {
            let (m, e) = number.rounded();
            // Exact: a fraction has 53 bits at most, and a power of two one.
            if m == 0.0 { 0 } else { ((m.to_bits() >> 52 & 0x7ff) as i32 - 1023 + 1 + e) as u32 }
        };
        (counted(n, 0, bits(n)), counted(d, 0, bits(d)))
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
        let bodies = super::bodies(&case).map(|(body, _)| body);
        for body in bodies {
            count(&Asked { ray, body, of: First }, 60);
            count(&Asked { ray, body, of: Meet }, 60);
            count(&Asked { ray, body, of: Against(1.000_000_059_604_644_8) }, 60);
            for other in bodies {
                count(&Order { ray, one: body, other }, 250);
            }
        }
    }
}
