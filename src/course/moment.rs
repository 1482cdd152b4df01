//! Dates of a course: when a stage is due, and when a submission was handed in.

use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;
use toml::value::{Datetime, Offset, Time};

/// A date and a time, as TOML writes them: `2026-11-02`, `2026-11-02 23:59` or `2026-11-02T23:59:00+01:00`. A date without a
/// time is the end of that day.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moment {
    /// Seconds since the beginning of 1970, by the clock of the moment's place if it has no offset from UTC.
    seconds: i64,
    /// Whether the offset from UTC is known.
    has_offset: bool,
    /// The text, as it was written.
    written: String,
}

impl Moment {
    /// The moment of a TOML value; `None` if the value has no date.
    pub fn new(value: &Datetime) -> Option<Moment> {
        let date = value.date?;
        let time = value.time.map(|Time { hour, minute, second, .. }| [hour, minute, second.unwrap_or(0)]);
        let [hour, minute, second] = time.unwrap_or([23, 59, 59]).map(i64::from);
        let offset = match value.offset {
            Some(Offset::Custom { minutes }) => i64::from(minutes),
            Some(Offset::Z) | None => 0,
        };
        let days = days(i64::from(date.year), i64::from(date.month), i64::from(date.day));
        let seconds = ((days * 24 + hour) * 60 + minute - offset) * 60 + second;
        Some(Moment { seconds, has_offset: value.offset.is_some(), written: value.to_string() })
    }

    /// Compares two moments; `None` if only one of them has an offset from UTC.
    pub fn compare(&self, other: &Moment) -> Option<Ordering> {
        (self.has_offset == other.has_offset).then(|| self.seconds.cmp(&other.seconds))
    }

    /// How much later this moment is than `due`, in the largest unit that fits, such as `3 hours`. `None` if it is not later,
    /// or if that is unknown.
    pub fn later_than(&self, due: &Moment) -> Option<String> {
        if self.compare(due) != Some(Ordering::Greater) {
            return None;
        }
        let seconds = self.seconds - due.seconds;
        let units = [("day", 86_400), ("hour", 3_600), ("minute", 60), ("second", 1)];
        let (unit, length) = units.into_iter().find(|(_, length)| seconds >= *length)?;
        let n = seconds / length;
        Some(format!("{n} {unit}{}", if n == 1 { "" } else { "s" }))
    }
}

impl FromStr for Moment {
    type Err = String;

    fn from_str(text: &str) -> Result<Moment, String> {
        let value = text.trim().parse().ok();
        value.and_then(|value| Moment::new(&value)).ok_or_else(|| {
            format!(
                "`{text}` is not a date such as 2026-11-02, 2026-11-02T23:59:00 or 2026-11-02T23:59:00+01:00"
            )
        })
    }
}

impl fmt::Display for Moment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written.replacen('T', " ", 1))
    }
}

/// Days since 1 January 1970 in the Gregorian calendar.
fn days(year: i64, month: i64, day: i64) -> i64 {
    // Count years from March, so that a leap day is the last day of its year.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    365 * year + leap_days + (153 * month + 2) / 5 + day - 719_469
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(text: &str) -> Moment {
        text.parse().unwrap()
    }

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(days(1970, 1, 1), 0);
        assert_eq!(days(2000, 3, 1), 11_017);
        assert_eq!(days(2000, 3, 1) - days(2000, 2, 28), 2);
        assert_eq!(days(2100, 3, 1) - days(2100, 2, 28), 1);
        assert_eq!(days(2026, 11, 25), 20_782);
    }

    #[test]
    fn a_day_ends_before_the_next() {
        let due = moment("2026-11-02");
        assert_eq!(moment("2026-11-02T23:59:59").later_than(&due), None);
        assert_eq!(moment("2026-11-03T00:00:00").later_than(&due).unwrap(), "1 second");
        assert_eq!(moment("2026-11-03 03:30:00").later_than(&due).unwrap(), "3 hours");
        assert_eq!(moment("2026-11-05").later_than(&due).unwrap(), "3 days");
    }

    #[test]
    fn offsets_count_and_are_not_mixed_with_local_times() {
        let due = moment("2026-11-02T23:59:00+01:00");
        assert_eq!(moment("2026-11-02T22:59:00Z").later_than(&due), None);
        assert_eq!(moment("2026-11-02T23:00:00Z").later_than(&due).unwrap(), "1 minute");
        assert_eq!(moment("2026-11-04").compare(&due), None);
        for wrong in ["", "tomorrow", "12:00:00", "2026-13-01", "2.11.2026"] {
            assert!(wrong.parse::<Moment>().is_err(), "{wrong}");
        }
    }
}
