//! Numbers and units as they are written in a picture.

use crate::figure::Ticks;

/// A unit as it is printed: `m s-1` is `m s⁻¹`; `None` for one that is no word.
pub fn printed(unit: &str) -> Option<String> {
    let compact = unit.trim().replace("**", "").replace('^', "");
    match compact.as_str() {
        "" | "1" | "none" | "-" => return None,
        "degC" | "celsius" | "Celsius" | "degrees_C" => return Some("°C".to_owned()),
        _ => {}
    }
    let words = compact.split_whitespace().map(|word| {
        let digits = word.trim_start_matches(|c: char| !c.is_ascii_digit() && c != '-');
        let base = &word[..word.len() - digits.len()];
        let is_power = !base.is_empty() && !digits.is_empty() && digits.parse::<i32>().is_ok();
        match is_power {
            true => format!("{base}{}", raised(digits)),
            false => word.to_owned(),
        }
    });
    Some(words.collect::<Vec<_>>().join(" "))
}

/// A whole number as raised digits.
fn raised(number: &str) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        _ => "⁰¹²³⁴⁵⁶⁷⁸⁹"
            .chars()
            .nth(c.to_digit(10).unwrap_or(0) as usize)
            .unwrap_or(c),
    };
    number.chars().map(digit).collect()
}

/// Ten to a power, in front of a unit: `×10⁻⁶`; nothing for 0.
pub fn power(exponent: i32) -> Option<String> {
    (exponent != 0).then(|| format!("×10{}", raised(&exponent.to_string())))
}

/// A number with U+2212 for its sign.
pub fn signed(text: &str) -> String {
    text.replace('-', "−")
}

/// The unit in which numbers up to `largest` are written, and the factor that makes them so: shares of mass below a
/// tenth are in g/kg.
pub fn scaled(unit: Option<&str>, largest: f64) -> (Option<String>, f64) {
    let compact = unit.unwrap_or("").replace(' ', "");
    let is_share = matches!(
        compact.as_str(),
        "kgkg-1" | "kg/kg" | "kgkg**-1" | "kgkg^-1"
    );
    if is_share && largest < 0.1 {
        return (Some("g kg⁻¹".to_owned()), 1e3);
    }
    (unit.and_then(printed), 1.0)
}

/// Between 3 and 7 ticks, no more than `most` where that can be.
pub fn ticks(range: [f64; 2], most: usize) -> Ticks {
    let most = most.clamp(3, 7);
    let all = (2..=7).rev().map(|wanted| Ticks::linear(range, wanted));
    let fitting = all.filter(|ticks| (3..=7).contains(&ticks.at.len()));
    let all: Vec<Ticks> = fitting.collect();
    let fits = all.iter().find(|ticks| ticks.at.len() <= most);
    let least = all.iter().min_by_key(|ticks| ticks.at.len());
    fits.or(least)
        .cloned()
        .unwrap_or_else(|| Ticks::linear(range, 3))
}

/// At most 7 ticks of a logarithmic axis, both ends above 0: powers of ten, with twos and fives between them where
/// there are fewer than three.
pub fn log_ticks([low, high]: [f64; 2], most: usize) -> Vec<(f64, String)> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let of = |factors: &[f64]| -> Vec<f64> {
        let all = powers
            .clone()
            .flat_map(|power| factors.iter().map(move |f| f * 10_f64.powi(power)));
        let inside = low * (1.0 - 1e-9)..=high * (1.0 + 1e-9);
        all.filter(|value| inside.contains(value)).collect()
    };
    let mut found = of(&[1.0]);
    if found.len() < 3 {
        found = of(&[1.0, 2.0, 5.0]);
    }
    let every = found.len().div_ceil(most.clamp(3, 7));
    let text = |value: f64| match (1e-3..1e4).contains(&value) {
        true => number(value),
        false => {
            let power = (value * (1.0 + 1e-9)).log10().floor() as i32;
            let factor = (value / 10_f64.powi(power)).round();
            match factor == 1.0 {
                true => format!("10{}", raised(&power.to_string())),
                false => format!("{factor}×10{}", raised(&power.to_string())),
            }
        }
    };
    found
        .into_iter()
        .step_by(every.max(1))
        .map(|value| (value, text(value)))
        .collect()
}

/// A length of 1, 2 or 5 times a power of ten, no longer than `most` metres, and how it is written. Without metres
/// the number alone.
pub fn round_length(most: f64, metres: Option<f64>) -> (f64, String) {
    let power = 10_f64.powf(most.log10().floor());
    let steps = [5.0, 2.0, 1.0].map(|step| step * power);
    let length = steps.into_iter().find(|&step| step <= most * (1.0 + 1e-9));
    let length = length.unwrap_or(power);
    let Some(metres) = metres else {
        return (length, format!("{} units", number(length)));
    };
    // Round in the unit that is written: a kilometre is not 1 2 5 of other units.
    let most = most * metres;
    let units = [
        (1e3, "km"),
        (1.0, "m"),
        (1e-3, "mm"),
        (1e-6, "µm"),
        (1e-9, "nm"),
    ];
    let (unit, name) = units
        .into_iter()
        .find(|(unit, _)| most >= *unit)
        .unwrap_or((1e-9, "nm"));
    let (length, _) = round_length(most / unit, None);
    (length * unit / metres, format!("{} {name}", number(length)))
}

/// A number of few digits.
fn number(x: f64) -> String {
    let decimals = (-x.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    match x.abs() < 1e6 && x.abs() >= 1e-6 {
        true => format!("{x:.decimals$}"),
        false => format!("{x:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_printed_with_raised_powers() {
        for (unit, wanted) in [
            ("m s-1", "m s⁻¹"),
            ("m**2 s**-2", "m² s⁻²"),
            ("K", "K"),
            ("HU", "HU"),
            ("degC", "°C"),
        ] {
            assert_eq!(printed(unit).as_deref(), Some(wanted));
        }
        assert_eq!((printed("1"), power(0)), (None, None));
        assert_eq!(power(-6).as_deref(), Some("×10⁻⁶"));
        assert_eq!(
            scaled(Some("kg kg-1"), 0.02),
            (Some("g kg⁻¹".to_owned()), 1e3)
        );
        assert_eq!(scaled(Some("kg kg-1"), 0.2).1, 1.0);
    }

    #[test]
    fn three_to_seven_ticks_stand_in_every_range() {
        for range in [
            [0.0, 255.0],
            [-1024.0, 3071.0],
            [0.0, 1e-30],
            [999.9998, 1000.0002],
            [-0.3, 0.3],
            [269.5, 303.0],
            [0.0, 4.2e7],
        ] {
            for most in 3..=7 {
                let count = ticks(range, most).at.len();
                assert!((3..=7).contains(&count), "{range:?}, {most}: {count}");
            }
        }
    }

    #[test]
    fn a_scale_takes_half_of_its_room_where_a_round_length_does() {
        // Lengths of 1 to 10 units, in steps of a fortieth of a decade.
        for room in (0..40).map(|i| 10_f64.powf(f64::from(i) / 40.0) * (1.0 + 1e-12)) {
            for metres in [None, Some(1e-3), Some(1.0), Some(1e3)] {
                let part = round_length(room, metres).0 / room;
                let fits = [1.0, 2.0, 5.0].map(|length| length / room);
                let has_half = fits.iter().any(|part| (0.5..=1.0).contains(part));
                let least = if has_half { 0.5 } else { 0.4 };
                assert!((least..=1.0).contains(&part), "{room} {metres:?}: {part}");
            }
        }
    }

    #[test]
    fn a_scale_is_1_2_or_5_in_a_unit_that_is_read() {
        for (most, metres, length, text) in [
            (73.0, Some(1e-3), 50.0, "50 mm"),
            (0.3, Some(1e-3), 0.2, "200 µm"),
            (480.0, Some(1e3), 200.0, "200 km"),
            (0.9, Some(1e3), 0.5, "500 m"),
            (30.0, None, 20.0, "20 units"),
            (0.07, None, 0.05, "0.05 units"),
        ] {
            let (found, words) = round_length(most, metres);
            assert!((found / length - 1.0).abs() < 1e-9, "{found} {words}");
            assert_eq!(words, text);
        }
    }
}
