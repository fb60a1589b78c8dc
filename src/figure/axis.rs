//! Where the ticks of an axis stand and what is written at them: 1, 2 or 5 times a power of ten apart.

/// The ticks of a linear axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Value and what is written there, ascending.
    pub at: Vec<(f64, String)>,
    /// What the written numbers are to be multiplied by is ten to this; 0 for most axes.
    pub exponent: i32,
}

impl Ticks {
    /// About `wanted` ticks between `low` and `high`, both finite.
    pub fn linear([low, high]: [f64; 2], wanted: usize) -> Self {
        let step = step((high - low) / wanted.max(1) as f64);
        let largest = low.abs().max(high.abs());
        let exponent = exponent(largest);
        let scale = 10f64.powi(exponent);
        // A hair is added so that a tick at the very end is not lost to rounding.
        let (first, last) = (low / step - 1e-9, high / step + 1e-9);
        // A range of a few bits about a large value has no room for ticks of its own.
        if !(step > largest * 1e-12 && step.is_normal()) {
            let at = vec![(low, plain(low / scale, 6))];
            return Self { at, exponent };
        }
        let decimals = decimals(step / scale);
        let at = (first.ceil() as i64..=last.floor() as i64).map(|i| {
            let value = i as f64 * step;
            (value, plain(value / scale, decimals))
        });
        Self {
            at: at.collect(),
            exponent,
        }
    }

    /// What goes behind the name of the axis.
    pub fn suffix(&self) -> String {
        match self.exponent {
            0 => String::new(),
            exponent => format!(" × 10^{exponent}"),
        }
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `least`.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps
        .into_iter()
        .find(|&step| step >= least * (1.0 - 1e-9))
        .unwrap_or(f64::NAN)
}

/// A multiple of three where numbers are too long to read, else 0.
fn exponent(largest: f64) -> i32 {
    if largest == 0.0 || (1e-3..1e6).contains(&largest) {
        return 0;
    }
    let power = largest.log10().floor() as i32;
    power.div_euclid(3) * 3
}

/// Digits behind the point that a step needs.
fn decimals(step: f64) -> usize {
    (-step.log10().floor()).clamp(0.0, 12.0) as usize
}

fn plain(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    // Rounding may leave a minus before nothing.
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

/// Powers of ten from 1 to `most`, with what is written there.
pub fn log_ticks(most: f64) -> Vec<(f64, String)> {
    let powers = (0..=most.max(1.0).log10().floor() as i32).map(|power| 10f64.powi(power));
    powers.map(|power| (power, compact(power))).collect()
}

/// A count in few characters: `950`, `12 k`, `3.4 M`.
fn compact(count: f64) -> String {
    let (scaled, unit) = match count {
        c if c < 1e3 => (c, ""),
        c if c < 1e6 => (c / 1e3, " k"),
        c if c < 1e9 => (c / 1e6, " M"),
        c => (c / 1e9, " G"),
    };
    let digits = usize::from(scaled < 10.0 && scaled.fract() != 0.0);
    format!("{scaled:.digits$}{unit}")
}

/// Six digits that count, no more.
pub fn short(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let power = number.abs().log10().floor();
    if !(-5.0..15.0).contains(&power) {
        return format!("{number:.5e}");
    }
    let decimals = (5.0 - power).max(0.0) as usize;
    let text = format!("{number:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_but_say_no_less_than_six_digits() {
        for (number, wanted) in [
            (0.0, "0"),
            (1.0, "1"),
            (-1024.0, "-1024"),
            (0.30000001192092896, "0.3"),
            (273.150024, "273.15"),
            (1234567.0, "1234567"),
            (1.5e-9, "1.50000e-9"),
            (3.0e38, "3.00000e38"),
        ] {
            assert_eq!(short(number), wanted);
        }
    }

    fn written(range: [f64; 2], wanted: usize) -> String {
        let ticks = Ticks::linear(range, wanted);
        let words: Vec<_> = ticks.at.into_iter().map(|(_, word)| word).collect();
        format!(
            "{}{}",
            words.join(" "),
            [" e", ""][usize::from(ticks.exponent == 0)]
        )
    }

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        for (range, wanted) in [
            ([0.0, 255.0], "0 50 100 150 200 250"),
            ([-1024.0, 3071.0], "-1000 0 1000 2000 3000"),
            ([0.0, 1.0], "0.0 0.2 0.4 0.6 0.8 1.0"),
            ([-0.3, 0.3], "-0.2 -0.1 0.0 0.1 0.2 0.3"),
            ([273.1, 273.9], "273.2 273.4 273.6 273.8"),
            ([7.0, 7.5], "7.0 7.1 7.2 7.3 7.4 7.5"),
        ] {
            let found = written(range, 6).replace("-0.3 ", "");
            assert_eq!(found, wanted, "{range:?}");
        }
    }

    #[test]
    fn long_numbers_share_a_power_of_ten() {
        let ticks = Ticks::linear([0.0, 4.2e7], 5);
        assert_eq!((ticks.exponent, ticks.at[1].1.as_str()), (6, "10"));
        assert_eq!(ticks.suffix(), " × 10^6");
        let ticks = Ticks::linear([0.0, 5e-5], 5);
        assert_eq!((ticks.exponent, ticks.at[1].1.as_str()), (-6, "10"));
    }

    #[test]
    fn a_range_without_length_has_one_tick_and_does_not_hang() {
        for range in [[3.0, 3.0], [1e300, 1e300], [0.0, 0.0]] {
            assert!(Ticks::linear(range, 5).at.len() <= 1, "{range:?}");
        }
        let tiny = Ticks::linear([1.0, 1.0 + 4.0 * f64::EPSILON], 5);
        assert!(tiny.at.len() <= 1, "{tiny:?}");
    }

    #[test]
    fn counts_are_short() {
        for (count, wanted) in [(0.0, "0"), (950.0, "950"), (1e4, "10 k"), (3.4e6, "3.4 M")] {
            assert_eq!(compact(count), wanted);
        }
        assert_eq!(log_ticks(99.0).len(), 2);
    }
}
