//! Moments: numbers with a unit such as `hours since 1900-01-01 00:00:0.0` and a calendar, to ISO 8601.
//!
//! CF Conventions 4.4. Days are counted from day 0 of a calendar's year 0; the Gregorian and Julian counts by
//! the usual leap rules, `standard` being Julian before 15 October 1582. Months and years of UDUNITS are no
//! calendar months, so such numbers keep their unit and get no date, as do years before 0.

/// A calendar of CF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Calendar {
    /// Julian before 1582-10-15, Gregorian from there.
    Standard,
    Gregorian,
    Julian,
    /// Every year has 365 days.
    NoLeap,
    /// Every year has 366 days.
    AllLeap,
    /// Every month has 30 days.
    Days360,
}

/// How the numbers of a time coordinate are meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clock {
    calendar: Calendar,
    /// Microseconds of one unit.
    unit_microseconds: f64,
    /// Microseconds of the reference moment since day 0.
    origin: i128,
}

impl Calendar {
    /// Historical calendars go from 1 BC to AD 1, and what a year 0 or an earlier one means there is disputed.
    fn first_year(self) -> i64 {
        match self {
            Self::Standard | Self::Julian => 1,
            _ => 0,
        }
    }
}

const SECOND: i128 = 1_000_000;
const DAY: i128 = 86_400 * SECOND;
/// The first day of the Gregorian calendar, and the last one of the Julian calendar before it.
const REFORM: (i64, i64, i64) = (1582, 10, 15);
const MONTH_DAYS: [i64; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
/// Years beyond have no names that anyone means.
const MAX_YEAR: i64 = 1_000_000;

impl Clock {
    /// From the attributes `units` and `calendar`; `None` where they tell no moments.
    pub(crate) fn of(units: &str, calendar: Option<&str>) -> Option<Self> {
        let calendar = match calendar.unwrap_or("standard").to_ascii_lowercase().as_str() {
            "standard" | "gregorian" => Calendar::Standard,
            "proleptic_gregorian" => Calendar::Gregorian,
            "julian" => Calendar::Julian,
            "noleap" | "365_day" => Calendar::NoLeap,
            "all_leap" | "366_day" => Calendar::AllLeap,
            "360_day" => Calendar::Days360,
            _ => return None,
        };
        let mut words = units.split_whitespace();
        let unit_microseconds = match words.next()?.to_ascii_lowercase().as_str() {
            "week" | "weeks" => 7.0 * 86_400e6,
            "day" | "days" | "d" => 86_400e6,
            "hour" | "hours" | "hr" | "hrs" | "h" => 3_600e6,
            "minute" | "minutes" | "min" | "mins" => 60e6,
            "second" | "seconds" | "sec" | "secs" | "s" => 1e6,
            "millisecond" | "milliseconds" | "msec" | "msecs" | "ms" => 1e3,
            "microsecond" | "microseconds" => 1.0,
            _ => return None,
        };
        let since = words.next()?;
        if !since.eq_ignore_ascii_case("since") {
            return None;
        }
        let rest: Vec<&str> = words.collect();
        let origin = origin(&rest.join(" "), calendar)?;
        Some(Self {
            calendar,
            unit_microseconds,
            origin,
        })
    }

    /// The moment of one number, `2005-08-28T12:00:00`, with a fraction of a second where there is one.
    pub(crate) fn iso(&self, number: f64) -> Option<String> {
        let microseconds = (number * self.unit_microseconds).round();
        // 1e21 microseconds are thirty million years.
        if microseconds.is_nan() || microseconds.abs() >= 1e21 {
            return None;
        }
        #[allow(clippy::cast_possible_truncation, reason = "checked by the line above")]
        let moment = self.origin.checked_add(microseconds as i128)?;
        let day = i64::try_from(moment.div_euclid(DAY)).ok()?;
        let (year, month, date) = date_of(day, self.calendar)?;
        if year < self.calendar.first_year() {
            return None;
        }
        let within = moment.rem_euclid(DAY);
        let part = |unit: i128, of: i128| within.div_euclid(unit).rem_euclid(of);
        let [hour, minute, second] = [
            part(SECOND.checked_mul(3600)?, 24),
            part(SECOND.checked_mul(60)?, 60),
            part(SECOND, 60),
        ];
        let fraction = within.rem_euclid(SECOND);
        let mut text = format!("{year:04}-{month:02}-{date:02}T{hour:02}:{minute:02}:{second:02}");
        if fraction != 0 {
            text += format!(".{fraction:06}").trim_end_matches('0');
        }
        Some(text)
    }
}

/// `1900-01-01 00:00:0.0`, `2000-1-1T12`, with `Z`, `UTC` or an offset `+01:00`, to microseconds.
fn origin(text: &str, calendar: Calendar) -> Option<i128> {
    let text = text
        .trim()
        .trim_end_matches("UTC")
        .trim_end_matches('Z')
        .trim();
    let (date, rest) = match text.find(['T', ' ']) {
        Some(at) => (text.get(..at)?, text.get(at.checked_add(1)?..)?.trim()),
        None => (text, ""),
    };
    let mut parts = date.split('-').map(str::parse::<i64>);
    let year = parts
        .next()?
        .ok()
        .filter(|&year| year >= calendar.first_year())?;
    let month = parts.next().unwrap_or(Ok(1)).ok()?;
    let day = parts.next().unwrap_or(Ok(1)).ok()?;
    if parts.next().is_some() {
        return None;
    }
    // Behind the time of day an offset from UTC may stand, with or without a blank.
    let (clock, zone) = match rest.find(['+', '-']) {
        Some(at) => (rest.get(..at)?.trim(), rest.get(at..)?),
        None => (rest, ""),
    };
    let time = if clock.is_empty() {
        0
    } else {
        microseconds(clock)?
    };
    let offset = match zone.strip_prefix('-') {
        Some(zone) => microseconds(zone)?.checked_neg()?,
        None => match zone.strip_prefix('+') {
            Some(zone) => microseconds(zone)?,
            None => 0,
        },
    };
    let days = i128::from(day_of(year, month, day, calendar)?);
    days.checked_mul(DAY)?
        .checked_add(time)?
        .checked_sub(offset)
}

/// `12`, `12:30`, `12:30:15.5`; `1230` in an offset.
fn microseconds(text: &str) -> Option<i128> {
    let mut parts = text.trim().split(':');
    let first = parts.next()?;
    let (hours, minutes) = match parts.next() {
        Some(minutes) => (first, minutes),
        None if first.len() == 4 => (first.get(..2)?, first.get(2..)?),
        None => (first, "0"),
    };
    let seconds: f64 = parts.next().unwrap_or("0").parse().ok()?;
    let hours: u8 = hours.parse().ok().filter(|&hours| hours <= 24)?;
    let minutes: u8 = minutes.parse().ok().filter(|&minutes| minutes < 60)?;
    if parts.next().is_some() || !(0.0..=60.0).contains(&seconds) {
        return None;
    }
    #[allow(
        clippy::cast_possible_truncation,
        reason = "at most 60 million by the line above"
    )]
    let fraction = (seconds * 1e6).round() as i128;
    let minutes = i128::from(hours)
        .checked_mul(60)?
        .checked_add(minutes.into())?;
    minutes
        .checked_mul(60)?
        .checked_mul(SECOND)?
        .checked_add(fraction)
}

/// Days of a month.
fn month_days(year: i64, month: i64, calendar: Calendar) -> Option<i64> {
    let index = usize::try_from(month.checked_sub(1)?).ok()?;
    let days = *MONTH_DAYS.get(index)?;
    Some(match calendar {
        Calendar::Days360 => 30,
        _ if month == 2 && is_leap(year, calendar) => 29,
        _ => days,
    })
}

fn is_leap(year: i64, calendar: Calendar) -> bool {
    let divides = |n: i64| year.rem_euclid(n) == 0;
    match calendar {
        Calendar::NoLeap | Calendar::Days360 => false,
        Calendar::AllLeap => true,
        Calendar::Julian => divides(4),
        Calendar::Standard if year <= REFORM.0 => divides(4),
        Calendar::Standard | Calendar::Gregorian => divides(4) && (!divides(100) || divides(400)),
    }
}

/// Days from day 0 of the calendar's year 0 to the first of a year. Of `Standard`, by the Gregorian count.
fn days_before(year: i64, calendar: Calendar) -> Option<i64> {
    let of = |days: i64| year.checked_mul(days);
    // Leap days of the years 0 to `year` - 1, negative before year 0.
    let last = year.checked_sub(1)?;
    let leaps = |n: i64| last.div_euclid(n).saturating_add(1);
    match calendar {
        Calendar::Days360 => of(360),
        Calendar::NoLeap => of(365),
        Calendar::AllLeap => of(366),
        Calendar::Julian => of(365)?.checked_add(leaps(4)),
        Calendar::Gregorian | Calendar::Standard => of(365)?
            .checked_add(leaps(4))?
            .checked_sub(leaps(100))?
            .checked_add(leaps(400)),
    }
}

/// The number of a day; `None` for one that the calendar lacks.
fn day_of(year: i64, month: i64, day: i64, calendar: Calendar) -> Option<i64> {
    if !(-MAX_YEAR..=MAX_YEAR).contains(&year) {
        return None;
    }
    if calendar == Calendar::Standard {
        return if (year, month, day) >= REFORM {
            day_of(year, month, day, Calendar::Gregorian)
        } else {
            // Both counts meet where 4 October of the one is followed by 15 October of the other.
            day_of(year, month, day, Calendar::Julian)?.checked_add(julian_shift()?)
        };
    }
    if !(1..=month_days(year, month, calendar)?).contains(&day) {
        return None;
    }
    let mut days = days_before(year, calendar)?.checked_add(day.checked_sub(1)?)?;
    for earlier in 1..month {
        days = days.checked_add(month_days(year, earlier, calendar)?)?;
    }
    Some(days)
}

/// What makes the Gregorian count of a Julian one.
fn julian_shift() -> Option<i64> {
    let (year, month, day) = REFORM;
    let gregorian = day_of(year, month, day, Calendar::Gregorian)?;
    // 15 October is 5 October of the Julian calendar.
    gregorian.checked_sub(day_of(year, month, 5, Calendar::Julian)?)
}

/// The date of a day's number.
fn date_of(day: i64, calendar: Calendar) -> Option<(i64, i64, i64)> {
    if calendar == Calendar::Standard {
        let (year, month, date) = REFORM;
        return if day >= day_of(year, month, date, Calendar::Gregorian)? {
            date_of(day, Calendar::Gregorian)
        } else {
            date_of(day.checked_sub(julian_shift()?)?, Calendar::Julian)
        };
    }
    // At most one year off: 400 Gregorian years have 146 097 days, 4 Julian ones 1461.
    let guess = match calendar {
        Calendar::Days360 => day.div_euclid(360),
        Calendar::AllLeap => day.div_euclid(366),
        Calendar::NoLeap => day.div_euclid(365),
        Calendar::Julian => day.checked_mul(4)?.div_euclid(1461),
        Calendar::Gregorian | Calendar::Standard => day.checked_mul(400)?.div_euclid(146_097),
    };
    let mut year = guess.checked_sub(1)?;
    if !(-MAX_YEAR..=MAX_YEAR).contains(&year) {
        return None;
    }
    while days_before(year.checked_add(1)?, calendar)? <= day {
        year = year.checked_add(1)?;
    }
    let mut left = day.checked_sub(days_before(year, calendar)?)?;
    let mut month = 1;
    while left >= month_days(year, month, calendar)? {
        left = left.checked_sub(month_days(year, month, calendar)?)?;
        month = i64::checked_add(month, 1)?;
    }
    Some((year, month, left.checked_add(1)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_cftime_in_every_calendar() {
        let text = include_str!("../../../tests/fixtures/netcdf/moments.json");
        let moments: Vec<(String, String, f64, String)> = serde_json::from_str(text).unwrap();
        assert!(moments.len() > 200);
        for (calendar, units, number, wanted) in moments {
            let place = format!("{number} {units}, {calendar}");
            let clock = Clock::of(&units, Some(&calendar)).expect(&place);
            if wanted.starts_with('-') {
                assert_eq!(clock.iso(number), None, "{place}");
                continue;
            }
            let found = clock.iso(number).expect(&place);
            let (seconds, fraction) = found.split_once('.').unwrap_or((&found, ""));
            assert_eq!(format!("{seconds}.{fraction:0<6}"), wanted, "{place}");
        }
    }

    #[test]
    fn what_tells_no_moment_is_none() {
        for units in [
            "K",
            "days",
            "days since",
            "days since yesterday",
            "months since 2000-01-01",
            "days since 2000-13-01",
            "days since 2000-02-30",
            "days since 2000-01-01 25:00",
            "days since 99999999999-01-01",
            "days since 0000-01-01",
            "days since -4712-01-01",
            "fortnights since 2000-01-01",
        ] {
            assert_eq!(Clock::of(units, None), None, "{units}");
        }
        assert_eq!(Clock::of("days since 2000-01-01", Some("none")), None);
        assert_eq!(Clock::of("days since 2000-02-29", Some("noleap")), None);
        let clock = Clock::of("days since 2000-01-01", None).unwrap();
        for number in [f64::NAN, f64::INFINITY, 1e300, 1e18] {
            assert_eq!(clock.iso(number), None, "{number}");
        }
    }
}
