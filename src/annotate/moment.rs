//! The moment that a picture shows.
//!
//! Dates are those of the file, which are UTC; between two of them a date is rounded to the minute, or to the second
//! where the file's dates have seconds. Dates are counted by the Gregorian calendar.

use super::{facts::Facts, sheet::Sheet};
use crate::figure::Anchor;

/// Pixels that the words of the first and the last time, and these, take at most: the same in all frames of a film.
pub fn widest(sheet: &Sheet, facts: &Facts, text: &str) -> f64 {
    let last = f64::from(facts.times.saturating_sub(1));
    let ends = [0.0, last]
        .into_iter()
        .filter_map(|time| words(facts, time));
    let even = |text: &str| text.replace(|c: char| c.is_ascii_digit(), "0");
    let all = ends.chain([text.to_owned()]);
    all.map(|text| sheet.width(&even(&text), 1.0))
        .fold(0.0, f64::max)
}

/// What is written of time `time`, counted from 0; `None` where nothing is known.
pub fn words(facts: &Facts, time: f64) -> Option<String> {
    let name = |time: f64| facts.time_names.get(time as usize);
    let Some(first) = name(0.0) else {
        let shown = (time + 1.0).round();
        return (facts.times > 1).then(|| format!("time {shown} of {}", facts.times));
    };
    let ends = [time.floor(), time.ceil()].map(name);
    let [from, to] = [ends[0]?, ends[1]?];
    let Some([start, begin, end]) = seconds(first)
        .zip(seconds(from))
        .zip(seconds(to))
        .map(|((a, b), c)| [a, b, c])
    else {
        return Some(between(from, to, time));
    };
    let moment = begin + time.fract() * (end - begin);
    let has_seconds = facts
        .time_names
        .iter()
        .any(|name| seconds(name).is_some_and(|s| s % 60.0 != 0.0));
    let unit = if has_seconds { 1.0 } else { 60.0 };
    let moment = (moment / unit).round() * unit;
    let since = match facts.time_names.len() {
        1 => String::new(),
        _ => format!("  {}", relative(moment - start)),
    };
    Some(format!("{} UTC{since}", date(moment, has_seconds)))
}

/// Two numbers with the same unit make one between them; of other words the nearer.
fn between(from: &str, to: &str, time: f64) -> String {
    let number = |text: &str| {
        let (number, unit) = text.split_once(' ')?;
        Some((number.parse::<f64>().ok()?, unit.to_owned()))
    };
    match (number(from), number(to)) {
        (Some((a, unit)), Some((b, other))) if unit == other && time.fract() != 0.0 => {
            let value = a + time.fract() * (b - a);
            format!("{value:.2} {unit}")
        }
        _ if time.fract() < 0.5 => from.to_owned(),
        _ => to.to_owned(),
    }
}

/// Seconds since 1970 of `2005-08-28T12:00:00`.
fn seconds(iso: &str) -> Option<f64> {
    let (date, clock) = iso.split_once('T')?;
    let mut parts = date.splitn(3, '-').map(|part| part.parse::<i64>().ok());
    let [year, month, day] = [parts.next()??, parts.next()??, parts.next()??];
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    let mut parts = clock.split(':').map(|part| part.parse::<f64>().ok());
    let [hour, minute, second] = [
        parts.next()??,
        parts.next()??,
        parts.next().unwrap_or(Some(0.0))?,
    ];
    // Days from the civil date: years begin in March, leap days are their last.
    let year = if month <= 2 { year - 1 } else { year };
    let (era, of_era) = (year.div_euclid(400), year.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let days = era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468;
    Some(days as f64 * 86_400.0 + hour * 3600.0 + minute * 60.0 + second)
}

/// `2005-08-28 12:00`.
fn date(moment: f64, has_seconds: bool) -> String {
    let whole = moment.round() as i64;
    let (days, clock) = (whole.div_euclid(86_400), whole.rem_euclid(86_400));
    let shifted = days + 719_468;
    let (era, of_era) = (shifted.div_euclid(146_097), shifted.rem_euclid(146_097));
    let of_400 = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * of_400 + of_400 / 4 - of_400 / 100);
    let from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = era * 400 + of_400 + i64::from(month <= 2);
    let [hour, minute, second] = [clock / 3600, clock / 60 % 60, clock % 60];
    let text = format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}");
    if has_seconds {
        format!("{text}:{second:02}")
    } else {
        text
    }
}

/// `+6 h`, `+1 h 30 min`, `+45 s`.
fn relative(seconds: f64) -> String {
    let whole = seconds.abs().round() as i64;
    let sign = if seconds < 0.0 { "−" } else { "+" };
    let parts = [
        (whole / 86_400, "d"),
        (whole / 3600 % 24, "h"),
        (whole / 60 % 60, "min"),
        (whole % 60, "s"),
    ];
    // Hours go on to three days.
    let words: Vec<String> = match whole < 3 * 86_400 {
        true => [(whole / 3600, "h"), parts[2], parts[3]].to_vec(),
        false => parts.to_vec(),
    }
    .into_iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, unit)| format!("{count} {unit}"))
    .collect();
    match words.is_empty() {
        true => "+0 h".to_owned(),
        false => format!("{sign}{}", words.join(" ")),
    }
}

/// Draws it from `at` on, digits in cells of one width, so that they stand still in a film.
pub fn draw(sheet: &mut Sheet, at: [f64; 2], text: &str) {
    let gap = sheet.width("00", 1.0) - 2.0 * sheet.width("0", 1.0);
    let cell = sheet.width("0", 1.0) + gap;
    let ends = text.chars().map(|c| match c {
        c if c.is_ascii_digit() => cell,
        ' ' => sheet.width("0 0", 1.0) - 2.0 * sheet.width("0", 1.0) - gap,
        c => sheet.width(&c.to_string(), 1.0) + gap,
    });
    let advances: Vec<f64> = ends.collect();
    let whole: f64 = advances.iter().sum();
    let ink = sheet.ink([at[0], at[1] - sheet.em], [at[0] + whole, at[1]]);
    let mut x = at[0];
    for (c, advance) in text.chars().zip(advances) {
        let middle = x + 0.5 * (advance - gap);
        sheet.text([middle, at[1]], &c.to_string(), 1.0, Anchor::Middle, ink);
        x += advance;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(names: &[&str], times: u32) -> Facts {
        Facts {
            time_names: names.iter().map(|&name| name.to_owned()).collect(),
            times,
            ..Facts::default()
        }
    }

    #[test]
    fn dates_are_written_to_the_minute_with_what_has_passed() {
        let known = facts(
            &[
                "2005-02-28T21:00:00",
                "2005-03-01T00:00:00",
                "2005-03-04T00:00:00",
            ],
            3,
        );
        let at = |time| words(&known, time).expect("a time");
        assert_eq!(at(0.0), "2005-02-28 21:00 UTC  +0 h");
        assert_eq!(at(1.0), "2005-03-01 00:00 UTC  +3 h");
        assert_eq!(at(0.1), "2005-02-28 21:18 UTC  +18 min");
        assert_eq!(at(2.0), "2005-03-04 00:00 UTC  +3 d 3 h");
        // 29 February is there in 2000 and not in 1900.
        for (iso, wanted) in [
            ("2000-02-29T12:30:00", "2000-02-29 12:30"),
            ("1900-03-01T00:00:00", "1900-03-01 00:00"),
        ] {
            assert_eq!(date(seconds(iso).expect("a date"), false), wanted);
        }
        assert_eq!(
            date(seconds("1970-01-01T00:01:00").expect("a date"), false),
            "1970-01-01 00:01"
        );
    }

    #[test]
    fn without_dates_times_are_counted_or_numbers_with_their_unit() {
        assert_eq!(words(&facts(&[], 8), 2.0).as_deref(), Some("time 3 of 8"));
        assert_eq!(words(&facts(&[], 1), 0.0), None);
        let known = facts(&["0 s", "1.5 s"], 2);
        assert_eq!(words(&known, 1.0).as_deref(), Some("1.5 s"));
        assert_eq!(words(&known, 0.5).as_deref(), Some("0.75 s"));
    }
}
