//! Moments as seconds.
//!
//! ```text
//! day(y, m, d) = 365 y' + y'/4 - y'/100 + y'/400 + (153 m' + 2) / 5 + d - 1,   the year y' begins in March
//! ```
//!
//! ISO 8601 in the Gregorian calendar, or a number with its unit.

/// Seconds of each moment since the first one; `None` where one is neither a date nor a number with a unit of time.
pub fn seconds_since_first(names: &[String]) -> Option<Vec<f64>> {
    let all = |of: fn(&str) -> Option<f64>| names.iter().map(|name| of(name)).collect();
    let seconds: Option<Vec<f64>> = all(seconds);
    let seconds = seconds.or_else(|| all(counted))?;
    let first = *seconds.first()?;
    Some(seconds.into_iter().map(|t| t - first).collect())
}

fn seconds(name: &str) -> Option<f64> {
    let name = name.trim().trim_end_matches('Z');
    let (date, clock) = name.split_once(['T', ' ']).unwrap_or((name, "0:0:0"));
    let mut parts = date.splitn(3, '-').map(|part| part.parse::<i64>().ok());
    let [year, month, day] = [parts.next()??, parts.next()??, parts.next()??];
    let fits = year.abs() < 100_000 && (1..=12).contains(&month) && (1..=31).contains(&day);
    if !fits {
        return None;
    }
    let mut parts = clock.splitn(3, ':').map(|part| part.parse::<f64>().ok());
    let [hour, minute] = [parts.next()??, parts.next()??];
    let second = parts.next().unwrap_or(Some(0.0))?;
    let [y, m] = match month > 2 {
        true => [year, month - 3],
        false => [year - 1, month + 9],
    };
    let leaps = y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400);
    let days = 365 * y + leaps + (153 * m + 2) / 5 + day - 1;
    let seconds = 86400.0 * days as f64 + 3600.0 * hour + 60.0 * minute + second;
    Some(seconds).filter(|seconds| seconds.is_finite())
}

/// Of `13.5 h`: a length of time since whatever the file counts from.
fn counted(name: &str) -> Option<f64> {
    let (number, unit) = name.trim().split_once(' ')?;
    let of_unit = match unit.trim() {
        "s" | "sec" | "second" | "seconds" => 1.0,
        "min" | "minute" | "minutes" => 60.0,
        "h" | "hr" | "hour" | "hours" => 3600.0,
        "d" | "day" | "days" => 86400.0,
        _ => return None,
    };
    let number: f64 = number.parse().ok()?;
    Some(number * of_unit).filter(|seconds| seconds.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_seconds_after_the_first() {
        let of = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
            seconds_since_first(&names)
        };
        let hours = of(&[
            "2005-08-28T12:00:00",
            "2005-08-28T15:00:00.5",
            "2005-08-29T00:00",
        ]);
        assert_eq!(hours, Some(vec![0.0, 10800.5, 43200.0]));
        let day = 86400.0;
        let leap = of(&[
            "2000-02-28",
            "2000-03-01",
            "2001-03-01",
            "1999-12-31T00:00:00Z",
        ]);
        assert_eq!(leap, Some(vec![0.0, 2.0 * day, 367.0 * day, -59.0 * day]));
        assert_eq!(of(&["1900-02-28", "1900-03-01"]), Some(vec![0.0, day]));
        assert_eq!(of(&["3 days", "4.5 days"]), Some(vec![0.0, 1.5 * day]));
        assert_eq!(of(&["0 h", "13.71 h"]), Some(vec![0.0, 13.71 * 3600.0]));
        assert_eq!(of(&["3 days", "2000-02-28"]), None);
        assert_eq!(of(&["3", "4"]), None);
        assert_eq!(of(&["3 days", "inf days"]), None);
        assert_eq!(of(&[]), None);
    }
}
