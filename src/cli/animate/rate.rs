//! Frames a second, as a fraction: 25, 29.97 or 30000/1001.

use std::{fmt, str::FromStr};

/// Frames a second. Both parts fit 16 bits, as an APNG has them, and have no common divisor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    /// So many frames ...
    pub frames: u16,
    /// ... in so many seconds.
    pub seconds: u16,
}

impl Default for Rate {
    /// A whole number of hundredths of a second a frame, which is what a GIF counts in.
    fn default() -> Self {
        Self {
            frames: 25,
            seconds: 1,
        }
    }
}

impl Rate {
    /// Frames a second.
    pub fn per_second(self) -> f64 {
        f64::from(self.frames) / f64::from(self.seconds)
    }

    /// When frame `number` begins, in whole hundredths of a second.
    pub fn begin_hundredths(self, number: u32) -> u64 {
        let (frames, seconds) = (u64::from(self.frames), u64::from(self.seconds));
        (2 * 100 * u64::from(number) * seconds + frames) / (2 * frames)
    }
}

impl FromStr for Rate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || {
            "wanted frames a second from 0.01 to 1000, such as 25, 29.97 or 30000/1001".to_owned()
        };
        let (frames, seconds) = match text.split_once('/') {
            Some((frames, seconds)) => (frames.parse().ok(), seconds.parse().ok()),
            None => {
                let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
                let places = u32::try_from(fraction.len()).ok().filter(|&n| n <= 4);
                let digits: Option<u64> = format!("{whole}{fraction}").parse().ok();
                (digits, places.map(|places| 10_u64.pow(places)))
            }
        };
        let (Some(frames), Some(seconds)) = (frames, seconds) else {
            return Err(wanted());
        };
        let divisor = common_divisor(frames, seconds).max(1);
        let (frames, seconds) = (frames / divisor, seconds / divisor);
        let in_range = seconds > 0
            && frames.saturating_mul(100) >= seconds
            && frames <= seconds.saturating_mul(1000);
        match (u16::try_from(frames), u16::try_from(seconds)) {
            (Ok(frames), Ok(seconds)) if in_range => Ok(Self { frames, seconds }),
            _ => Err(wanted()),
        }
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.frames, self.seconds)
    }
}

/// Euclid's.
fn common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_a_number_or_a_fraction() {
        for (text, frames, seconds) in [
            ("25", 25, 1),
            ("29.97", 2997, 100),
            ("12.50", 25, 2),
            ("30000/1001", 30_000, 1001),
            ("0.5", 1, 2),
        ] {
            assert_eq!(text.parse(), Ok(Rate { frames, seconds }), "{text}");
        }
        for text in [
            "",
            "0",
            "-1",
            "1e3",
            "1001",
            "0.001",
            "25/0",
            "25/",
            "99999/70000",
            "3.14159",
            "18446744073709551615",
        ] {
            assert!(text.parse::<Rate>().is_err(), "{text}");
        }
    }

    #[test]
    fn hundredths_do_not_drift() {
        let rate: Rate = "30".parse().expect("a rate");
        let begins: Vec<u64> = (0..7).map(|n| rate.begin_hundredths(n)).collect();
        // 3.33, 6.67, 10, 13.33, 16.67, 20 hundredths.
        assert_eq!(begins, [0, 3, 7, 10, 13, 17, 20]);
    }
}
