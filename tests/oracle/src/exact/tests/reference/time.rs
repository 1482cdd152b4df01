//! Values of `t`, rational or roots of quadratics.

use super::dyadic::Dyadic;
use raykata::ray::Ray;
use std::cmp::Ordering;

/// A value of `t`.
#[derive(Clone, Debug)]
pub enum Time {
    /// A fraction with a positive denominator.
    Ratio(Dyadic, Dyadic),
    /// The smaller (`false`) or larger (`true`) root of `a t² + 2 b t + c = 0` with `a > 0`.
    Root(Dyadic, Dyadic, Dyadic, bool),
}

impl Time {
    pub(super) fn ratio(n: Dyadic, d: Dyadic) -> Time {
        if d.sign() < 0 { Time::Ratio(-&n, -&d) } else { Time::Ratio(n, d) }
    }

    /// Compares the value with the fraction `n / d`, `d > 0`.
    fn cmp_ratio(&self, n: &Dyadic, d: &Dyadic) -> Ordering {
        match self {
            Time::Ratio(p, q) => (&(p * d) - &(n * q)).sign().cmp(&0),
            Time::Root(a, b, c, larger) => {
                let two_b = b + b;
                let value = &(&(a * &(n * n)) + &(&two_b * &(n * d))) + &(c * &(d * d));
                // Find the side of the vertex -b / a on which the fraction lies.
                let side = (&(n * a) + &(b * d)).sign();
                match (value.sign(), larger) {
                    (-1, false) => Ordering::Less,
                    (-1, true) => Ordering::Greater,
                    (1, _) if side < 0 => Ordering::Greater,
                    (1, _) => Ordering::Less,
                    // The fraction is one of the two roots: this one, unless it lies on the side of the other.
                    (_, false) => 0.cmp(&side.max(0)),
                    (_, true) => 0.cmp(&side.min(0)),
                }
            }
        }
    }

    /// Compares two values; two roots must be roots of the same polynomial.
    pub fn cmp(&self, other: &Time) -> Ordering {
        match (self, other) {
            (_, Time::Ratio(n, d)) => self.cmp_ratio(n, d),
            (Time::Ratio(n, d), _) => other.cmp_ratio(n, d).reverse(),
            (Time::Root(a, b, c, one), Time::Root(.., two)) => {
                let double = (&(b * b) - &(a * c)).sign() == 0;
                if double { Ordering::Equal } else { one.cmp(two) }
            }
        }
    }

    /// Compares any two values. Two roots of different polynomials are equal if the polynomials share this
    /// root, which is then rational. Otherwise they differ, so that bisection separates them.
    pub fn cmp_any(&self, other: &Time) -> Ordering {
        let (Time::Root(a, b, c, _), Time::Root(d, e, f, _)) = (self, other) else {
            return self.cmp(other);
        };
        let minor = |x: &Dyadic, y: &Dyadic, u: &Dyadic, v: &Dyadic| &(x * v) - &(y * u);
        let (ae, ac, bf) = (minor(a, b, d, e), minor(a, c, d, f), minor(b, c, e, f));
        if ae.sign() == 0 && ac.sign() == 0 && bf.sign() == 0 {
            return self.cmp(other);
        }
        let ae_twice = &ae + &ae;
        let shared = (&(&ac * &ac) - &(&ae_twice * &(&bf + &bf))).sign() == 0;
        if shared && ae.sign() != 0 {
            let Time::Ratio(n, d) = Time::ratio(-&ac, ae_twice) else { unreachable!("a ratio is a ratio") };
            if self.cmp_ratio(&n, &d).is_eq() && other.cmp_ratio(&n, &d).is_eq() {
                return Ordering::Equal;
            }
        }
        let one = Dyadic::new(1.0);
        let (mut low, mut high) = (Dyadic::new(-200f64.exp2()), Dyadic::new(200f64.exp2()));
        loop {
            let middle = &(&low + &high) * &Dyadic::new(0.5);
            let sides = (self.cmp_ratio(&middle, &one), other.cmp_ratio(&middle, &one));
            match sides {
                (Ordering::Less, Ordering::Less) => high = middle,
                (Ordering::Greater, Ordering::Greater) => low = middle,
                (one, other) => return one.cmp(&other),
            }
        }
    }

    /// Compares the value with a double.
    pub fn cmp_double(&self, t: f64) -> Ordering {
        if t.is_infinite() {
            return if t > 0.0 { Ordering::Less } else { Ordering::Greater };
        }
        self.cmp_ratio(&Dyadic::new(t), &Dyadic::new(1.0))
    }

    pub(super) fn is_in_range(&self, ray: &Ray) -> bool {
        self.cmp_double(f64::from(ray.t_min)).is_gt() && self.cmp_double(f64::from(ray.t_max)).is_lt()
    }

    /// Whether `t` is this value rounded to nearest, ties to even.
    pub fn rounds_to(&self, t: f32) -> bool {
        let wide =
            |x: f32| if x.is_infinite() { f64::from(x.signum()) * 128f64.exp2() } else { f64::from(x) };
        let even = t.to_bits() & 1 == 0;
        let below = if t == f32::NEG_INFINITY { None } else { Some((wide(t.next_down()) + wide(t)) / 2.0) };
        let above = if t == f32::INFINITY { None } else { Some((wide(t.next_up()) + wide(t)) / 2.0) };
        let enough = |order: Ordering, wanted| order == wanted || (even && order == Ordering::Equal);
        below.is_none_or(|b| enough(self.cmp_double(b), Ordering::Greater))
            && above.is_none_or(|a| enough(self.cmp_double(a), Ordering::Less))
    }
}
