//! What a field is: parameter, level, time and member, by sections 1 and 4 of the Manual on Codes.

use super::level::Level;
use super::section::Section;
use crate::volume::Problem;

/// What a field is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Product {
    /// Discipline, category and number (code tables 0.0, 4.1, 4.2).
    pub parameter: [u8; 3],
    /// Common code table C-11.
    pub centre: u16,
    pub level: Level,
    /// When it holds, in seconds since 1970; of a span of time its end.
    pub seconds: i64,
    /// Perturbation number; 0 where there is no ensemble.
    pub member: u8,
    /// Mean, sum, ... over a span of time (code table 4.10), or over an ensemble (4.7).
    pub statistic: Option<[u8; 2]>,
}

/// Seconds of a minute, an hour, a day.
const MINUTE: i64 = 60;
const HOUR: i64 = 3600;
const DAY: i64 = 86_400;

/// What sections 1 and 4 say, or the name of a template that we do not read.
pub(super) fn product(
    discipline: u8,
    identification: &Section,
    section: &Section,
) -> Result<Result<Product, String>, Problem> {
    let template = section.u16(8)?;
    // Where the end of a span of time stands, and what is done over it.
    let (end, member, derived) = match template {
        0 => (None, None, None),
        1 => (None, Some(36), None),
        2 => (None, None, Some(35)),
        8 => (Some(35), None, None),
        11 => (Some(38), Some(36), None),
        12 => (Some(37), None, Some(35)),
        _ => return Ok(Err(format!("products of template 4.{template}"))),
    };
    let date = Date::of(identification, 13)?;
    let forecast = section.i32(19)?.into();
    let Some(seconds) = date.later(forecast, section.u8(18)?) else {
        return Ok(Err("times in units that are no span of time".to_owned()));
    };
    let seconds = match end {
        None => seconds,
        Some(octet) => Date::of(section, octet)?.seconds(),
    };
    // Behind the end: the number of spans (1 octet), missing values (4), the process of the first span.
    let process = end.map(|octet: usize| section.u8(octet.saturating_add(12)));
    let process = process.transpose()?.unwrap_or(u8::MAX);
    let derived = derived.map(|octet| section.u8(octet)).transpose()?;
    let derived = derived.unwrap_or(u8::MAX);
    let is_plain = process == u8::MAX && derived == u8::MAX;
    Ok(Ok(Product {
        parameter: [discipline, section.u8(10)?, section.u8(11)?],
        centre: identification.u16(6)?,
        level: Level::of(section)?,
        seconds,
        member: member.map_or(Ok(0), |octet| section.u8(octet))?,
        statistic: (!is_plain).then_some([process, derived]),
    }))
}

/// A moment of the Gregorian calendar.
#[derive(Clone, Copy)]
struct Date {
    year: i64,
    month: i64,
    /// Seconds since the first of the month.
    rest: i64,
}

impl Date {
    /// Seven octets: year (2), month, day, hour, minute, second.
    fn of(section: &Section, octet: usize) -> Result<Self, Problem> {
        let number = |k: usize| section.u8(octet.saturating_add(k)).map(i64::from);
        let parts = [
            number(3)?.saturating_sub(1).saturating_mul(DAY),
            number(4)?.saturating_mul(HOUR),
            number(5)?.saturating_mul(MINUTE),
            number(6)?,
        ];
        Ok(Self {
            year: section.u16(octet)?.into(),
            month: number(2)?,
            rest: parts.into_iter().fold(0, i64::saturating_add),
        })
    }

    /// Seconds since 1970, this much later (code table 4.4). `None` for a unit that is no time.
    fn later(self, count: i64, unit: u8) -> Option<i64> {
        let months = match unit {
            3 => 1,
            4 => 12,
            5 => 120,
            6 => 360,
            7 => 1200,
            _ => 0,
        };
        let seconds = match unit {
            0 => MINUTE,
            1 => HOUR,
            2 => DAY,
            3..=7 => 0,
            10 => HOUR.saturating_mul(3),
            11 => HOUR.saturating_mul(6),
            12 => HOUR.saturating_mul(12),
            13 => 1,
            _ => return None,
        };
        let month = self.month.saturating_add(count.saturating_mul(months));
        let begun = Self { month, ..self };
        Some(
            begun
                .seconds()
                .saturating_add(count.saturating_mul(seconds)),
        )
    }

    fn seconds(self) -> i64 {
        let months = self.month.saturating_sub(1);
        let year = self.year.saturating_add(months.div_euclid(12));
        let month = months.rem_euclid(12);
        // Years begin in March, so that a leap day is the last of one: 153 days are five months.
        let is_early = month < 2;
        let year = year.saturating_sub(is_early.into());
        let month = month.saturating_add(10).rem_euclid(12);
        let leaps = year
            .div_euclid(4)
            .saturating_sub(year.div_euclid(100))
            .saturating_add(year.div_euclid(400));
        let in_year = month.saturating_mul(153).saturating_add(2).div_euclid(5);
        let days = year
            .saturating_mul(365)
            .saturating_add(leaps)
            .saturating_add(in_year)
            // Days from 1 March of the year 0 to 1 January 1970.
            .saturating_sub(719_468);
        days.saturating_mul(DAY).saturating_add(self.rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first_of(year: i64, month: i64) -> Date {
        Date {
            year,
            month,
            rest: 0,
        }
    }

    #[test]
    fn moments_are_those_of_the_calendar() {
        // By `date -u -d ... +%s`.
        for (year, month, seconds) in [
            (1970, 1, 0),
            (2000, 3, 951_868_800),
            (2024, 2, 1_706_745_600),
            (2024, 3, 1_709_251_200),
            (1900, 1, -2_208_988_800),
        ] {
            assert_eq!(first_of(year, month).seconds(), seconds, "{year}-{month}");
        }
        let later = |count, unit| first_of(2024, 2).later(count, unit);
        assert_eq!(later(1, 3), Some(1_709_251_200), "a month");
        assert_eq!(later(-2, 4), Some(first_of(2022, 2).seconds()), "years");
        assert_eq!(later(29, 2), Some(1_709_251_200), "days");
        assert_eq!(later(2, 11), Some(1_706_745_600 + 43_200), "six hours");
        assert_eq!(later(1, 255), None);
    }
}
