//! Numbers, vectors and colours of a scene file. TOML has 64-bit numbers, `nan` and `inf`; a scene has finite
//! `f32` only.

use super::reader::Value;
use crate::files::error::LoadError;
use crate::film::decode_srgb;
use crate::scene::{ColorPlace, Encoding};
use glam::{DVec3, Vec3};
use std::ops::RangeInclusive;
use toml::de::DeValue;

impl<'a> Value<'a> {
    /// The value as a whole number; fails if it is not an integer in the closed `range`.
    pub fn whole(&self, range: RangeInclusive<u32>) -> Result<u32, LoadError> {
        let DeValue::Integer(integer) = self.item() else { return Err(self.wrong("a whole number")) };
        // A number that does not fit into 128 bits is outside of any range.
        let wide = i128::from_str_radix(integer.as_str(), integer.radix()).unwrap_or(i128::MAX);
        u32::try_from(wide)
            .ok()
            .filter(|number| range.contains(number))
            .ok_or_else(|| self.wrong(&format!("a whole number from {} to {}", range.start(), range.end())))
    }

    /// The value as a finite number, rounded to `f32`; fails if it is `nan`, infinite, too large for an
    /// `f32`, or rounded to 0 without being 0.
    pub fn number(&self) -> Result<f32, LoadError> {
        let exact: f64 = match self.item() {
            DeValue::Float(float) => float.as_str().parse().unwrap_or(f64::NAN),
            DeValue::Integer(integer) if integer.radix() == 10 => {
                integer.as_str().parse().unwrap_or(f64::NAN)
            }
            DeValue::Integer(integer) => {
                i128::from_str_radix(integer.as_str(), integer.radix()).map_or(f64::INFINITY, |n| n as f64)
            }
            _ => return Err(self.wrong("a number")),
        };
        let number = exact as f32;
        let spelled = self.spelled();
        if exact.is_nan() || (exact.is_infinite() && spelled.contains("inf")) {
            return Err(self.wrong("a finite number"));
        }
        let limit = match number {
            _ if number.is_infinite() => "too large: the largest number is 3.4e38",
            _ if number == 0.0 && exact != 0.0 => "too close to zero: the smallest number is 1.4e-45",
            _ => return Ok(number),
        };
        Err(self.error(format!("{} is {spelled}, which is {limit}", self.name())))
    }

    /// The value as a finite number for which `holds` is true, and fails otherwise; `condition` says in the
    /// message which numbers are accepted.
    pub fn number_that(&self, condition: &str, holds: impl Fn(f32) -> bool) -> Result<f32, LoadError> {
        match self.number()? {
            number if holds(number) => Ok(number),
            _ => Err(self.wrong(condition)),
        }
    }

    /// The value as a finite number above 0; fails otherwise.
    pub fn positive(&self) -> Result<f32, LoadError> {
        self.number_that("above 0", |number| number > 0.0)
    }

    /// The value as a finite number of at least 0; fails otherwise.
    pub fn not_negative(&self) -> Result<f32, LoadError> {
        self.number_that("at least 0", |number| number >= 0.0)
    }

    /// The value as a number in `0..=1`; fails otherwise.
    pub fn share(&self) -> Result<f32, LoadError> {
        self.number_that("from 0 to 1", |number| (0.0..=1.0).contains(&number))
    }

    /// The number, which is this value or follows from it; 0, with a warning, if single precision cannot tell it from 0
    /// beside `whole`, so that it would cost time and change nothing. `what` is what the scene has then.
    pub fn or_nothing(&self, number: f32, whole: f32, what: &str) -> f32 {
        let negligible = f32::EPSILON / 2.0 * whole;
        if number == 0.0 || number > negligible {
            return number;
        }
        let message = format!("{} is too small to change the picture; {what}", self.spelled());
        self.warn(self.error(message).help("write 0, or a larger number"));
        0.0
    }

    /// The value as a point or an offset; fails if it is not a list of three finite numbers.
    pub fn vector(&self) -> Result<Vec3, LoadError> {
        Ok(Vec3::from_array(self.numbers("three numbers")?))
    }

    /// The value as a direction, scaled to unit length; fails if it is not a list of three finite numbers
    /// that are not all 0.
    pub fn direction(&self) -> Result<Vec3, LoadError> {
        Ok(self.direction_f64()?.as_vec3())
    }

    /// The same as [`Value::direction`] in double precision, in which the square of no `f32` overflows or
    /// vanishes.
    pub fn direction_f64(&self) -> Result<DVec3, LoadError> {
        let vector = self.vector()?.as_dvec3();
        vector.try_normalize().ok_or_else(|| {
            self.error(format!("{} has no length, so it gives no direction", self.name()))
                .help("give a direction, for example `[0, 1, 0]`")
        })
    }

    /// The value as a linear colour: one number for a grey, or three for red, green and blue, or a text with two
    /// hexadecimal digits for each, such as `"#ff8000"`. Fails if a number is below 0 or not finite.
    ///
    /// A text is decoded with the sRGB curve. If the scene asks for gamma 2, its bytes are kept for `place`, where the
    /// frame decodes them.
    pub fn color(&self, place: ColorPlace) -> Result<Vec3, LoadError> {
        let wanted = "a colour, that is one number, three, or a text such as \"#ff8000\"";
        if self.item().as_str().is_some() {
            let bytes = self.text().ok().and_then(hexadecimal).ok_or_else(|| self.wrong(wanted))?;
            if self.source.encoding.get() == Encoding::Gamma2 {
                self.source.gamma2.borrow_mut().colors.push((place, bytes));
            }
            return Ok(Vec3::from_array(bytes.map(|byte| decode_srgb(f32::from(byte) / 255.0))));
        }
        let color = self.one_or_three(wanted)?;
        self.each_component(color, "at least 0", |number| number >= 0.0)
    }

    /// The value as scale factors along the axes: one number for all three, or three. Fails if one of them is
    /// 0 or not finite.
    pub fn factors(&self) -> Result<Vec3, LoadError> {
        let factors = self.one_or_three("one number or three")?;
        self.each_component(factors, "other than 0", |number| number != 0.0)
    }

    /// The value as a list of exactly `N` finite numbers; fails otherwise, with `wanted` in the message.
    pub fn numbers<const N: usize>(&self, wanted: &str) -> Result<[f32; N], LoadError> {
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(self.list_of(N, wanted)?) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    /// The items of the value as a list of exactly `count` items; fails otherwise, with `wanted` in the
    /// message.
    pub fn list_of(&self, count: usize, wanted: &str) -> Result<Vec<Value<'a>>, LoadError> {
        let items = self.list(wanted)?;
        match items.len() {
            length if length == count => Ok(items),
            length => Err(self.error(format!("{} must be {wanted}, but has {length}", self.name()))),
        }
    }

    fn one_or_three(&self, wanted: &str) -> Result<Vec3, LoadError> {
        match self.item() {
            DeValue::Integer(_) | DeValue::Float(_) => Ok(Vec3::splat(self.number()?)),
            _ => Ok(Vec3::from_array(self.numbers(wanted)?)),
        }
    }

    /// `vector`, which was read from this value, if `holds` is true for each component; fails otherwise.
    fn each_component(
        &self,
        vector: Vec3,
        condition: &str,
        holds: fn(f32) -> bool,
    ) -> Result<Vec3, LoadError> {
        let Some(bad) = vector.to_array().iter().position(|&component| !holds(component)) else {
            return Ok(vector);
        };
        let items = self.list("").unwrap_or_default();
        Err(items.get(bad).unwrap_or(self).wrong(condition))
    }
}

/// Red, green and blue of a text such as `#ff8000`; `None` if it has another form.
fn hexadecimal(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let [_, red, green, blue] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([red, green, blue])
}
