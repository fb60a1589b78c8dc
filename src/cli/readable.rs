//! Numbers as a person reads them.

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

/// Digits in groups of three.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// In the largest unit that leaves a whole number before the point.
pub fn bytes(count: u64) -> String {
    let mut number = count as f64;
    for unit in ["bytes", "KiB", "MiB", "GiB"] {
        if number < 1024.0 {
            let decimals = usize::from(unit != "bytes" && number < 100.0);
            return format!("{number:.decimals$} {unit}");
        }
        number /= 1024.0;
    }
    format!("{number:.1} TiB")
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

    #[test]
    fn counts_and_bytes_are_easy_to_read() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(1_234_567), "1 234 567");
        for (count, wanted) in [
            (900, "900 bytes"),
            (1536, "1.5 KiB"),
            (14_155_776, "13.5 MiB"),
            (200 << 30, "200 GiB"),
            (3 << 40, "3.0 TiB"),
        ] {
            assert_eq!(bytes(count), wanted);
        }
    }
}
