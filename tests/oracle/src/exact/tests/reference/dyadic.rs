//! Numbers `n * 2^e` of any length.

use dashu_int::{IBig, Sign};
use std::ops::{Add, Mul, Neg, Sub};

/// The number `n * 2^e`.
#[derive(Clone, Debug)]
pub struct Dyadic {
    n: IBig,
    e: isize,
}

impl Dyadic {
    /// A finite double.
    pub fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as isize;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (n, e) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
        let zeros = if n == 0 { 0 } else { n.trailing_zeros() };
        Dyadic { n: IBig::from(if x < 0.0 { -(n >> zeros) } else { n >> zeros }), e: e + zeros as isize }
    }

    fn aligned(&self, other: &Self) -> (IBig, IBig, isize) {
        let e = self.e.min(other.e);
        (&self.n << (self.e - e) as usize, &other.n << (other.e - e) as usize, e)
    }

    /// -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        match self.n.sign() {
            _ if self.n == IBig::ZERO => 0,
            Sign::Positive => 1,
            Sign::Negative => -1,
        }
    }
}

impl Add for &Dyadic {
    type Output = Dyadic;
    fn add(self, other: Self) -> Dyadic {
        let (a, b, e) = self.aligned(other);
        Dyadic { n: a + b, e }
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;
    fn sub(self, other: Self) -> Dyadic {
        let (a, b, e) = self.aligned(other);
        Dyadic { n: a - b, e }
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;
    fn mul(self, other: Self) -> Dyadic {
        if self.sign() == 0 || other.sign() == 0 {
            return Dyadic::new(0.0);
        }
        Dyadic { n: &self.n * &other.n, e: self.e + other.e }
    }
}

impl Neg for &Dyadic {
    type Output = Dyadic;
    fn neg(self) -> Dyadic {
        Dyadic { n: -&self.n, e: self.e }
    }
}
