//! What tells pictures of one place apart: times, echoes, strengths of diffusion.

use super::fields::DataSet;
use super::tags::*;
use crate::volume::Problem;

/// An attribute by which pictures of one place differ, the surest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Temporal,
    Diffusion,
    Echo,
    Trigger,
    Frame,
    Acquired,
    Segment,
}

impl Kind {
    pub(super) const COUNT: usize = 7;
    pub(super) const ALL: [Self; Self::COUNT] = [
        Self::Temporal,
        Self::Diffusion,
        Self::Echo,
        Self::Trigger,
        Self::Frame,
        Self::Acquired,
        Self::Segment,
    ];

    pub(super) fn of(self, moments: &[Option<f64>; Self::COUNT]) -> Option<f64> {
        // A field-less enum counts from 0.
        moments.get(self as usize).copied().flatten()
    }

    pub(super) fn put(self, moments: &mut [Option<f64>; Self::COUNT], number: f64) {
        if let Some(moment) = moments.get_mut(self as usize) {
            *moment = Some(number);
        }
    }

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Temporal => "temporal positions",
            Self::Diffusion => "b values",
            Self::Echo => "echo times",
            Self::Trigger => "trigger times",
            Self::Frame => "frame times",
            Self::Acquired => "acquisition times",
            Self::Segment => "segments",
        }
    }

    /// True where the same numbers stand at every place; a clock goes on from place to place.
    pub(super) fn is_same_everywhere(self) -> bool {
        !matches!(self, Self::Acquired | Self::Trigger)
    }

    /// A moment as a header names it; times of day as seconds after the first.
    pub(super) fn name(self, number: f64, first: f64) -> String {
        match self {
            Self::Temporal | Self::Segment => format!("{number}"),
            Self::Diffusion => format!("{number} s/mm2"),
            Self::Echo | Self::Trigger | Self::Frame => format!("{number} ms"),
            // Clocks tick in microseconds.
            Self::Acquired => format!("{} s", ((number - first) * 1e6).round() / 1e6),
        }
    }
}

/// The moments that stand in the first of `sets` that has each.
pub(super) fn moments(sets: &[Option<&DataSet>]) -> Result<[Option<f64>; Kind::COUNT], Problem> {
    let first = |read: &dyn Fn(&DataSet) -> Result<Option<f64>, Problem>| {
        sets.iter()
            .flatten()
            .find_map(|set| read(set).transpose())
            .transpose()
    };
    let temporal = |set: &DataSet| match set.u32(TEMPORAL_POSITION_INDEX)? {
        Some(index) => Ok(Some(f64::from(index))),
        None => set.number(TEMPORAL_POSITION),
    };
    let diffusion = |set: &DataSet| set.f64(DIFFUSION_B_VALUE);
    let echo = |set: &DataSet| match set.f64(EFFECTIVE_ECHO_TIME)? {
        Some(time) => Ok(Some(time)),
        None => set.number(ECHO_TIME),
    };
    let trigger = |set: &DataSet| match set.f64(NOMINAL_CARDIAC_TRIGGER_DELAY)? {
        Some(time) => Ok(Some(time)),
        None => set.number(TRIGGER_TIME),
    };
    Ok([
        first(&temporal)?,
        first(&diffusion)?,
        first(&echo)?,
        first(&trigger)?,
        None,
        first(&|set| Ok(acquired(set)))?,
        first(&|set| Ok(set.u16(REFERENCED_SEGMENT_NUMBER)?.map(f64::from)))?,
    ])
}

/// Seconds since a day long ago; `None` where there is no time or it is not one.
fn acquired(set: &DataSet) -> Option<f64> {
    let both = set
        .text(FRAME_ACQUISITION_DATE_TIME)
        .or_else(|| set.text(ACQUISITION_DATE_TIME));
    match both {
        Some(both) => Some(days(both.get(..8)?)? * 86_400.0 + seconds_of_day(both.get(8..)?)?),
        None => {
            let day = set
                .text(ACQUISITION_DATE)
                .and_then(|day| days(&day))
                .unwrap_or(0.0);
            Some(day * 86_400.0 + seconds_of_day(&set.text(ACQUISITION_TIME)?)?)
        }
    }
}

/// Days of `YYYYMMDD` since 0000-03-01 in the Gregorian calendar: years and months are counted from March on, so
/// that a leap day comes last.
fn days(date: &str) -> Option<f64> {
    let number =
        |range: std::ops::Range<usize>| date.get(range)?.parse::<u32>().ok().map(f64::from);
    let (year, month, day) = (number(0..4)?, number(4..6)?, number(6..8)?);
    let (year, month) = if month > 2.0 {
        (year, month - 3.0)
    } else {
        (year - 1.0, month + 9.0)
    };
    let leap_days = (year / 4.0).floor() - (year / 100.0).floor() + (year / 400.0).floor();
    Some(year * 365.0 + leap_days + ((153.0 * month + 2.0) / 5.0).floor() + day - 1.0)
}

/// Seconds of `HHMMSS.FFFFFF`, of which all but the hours may be left out. A zone behind it is the same for all.
fn seconds_of_day(time: &str) -> Option<f64> {
    let time = time.split(['+', '-']).next()?;
    let hours = time.get(0..2)?.parse::<u32>().ok()?;
    let minutes = time
        .get(2..4)
        .map_or(Some(0), |text| text.parse::<u32>().ok())?;
    let seconds = match time.get(4..).filter(|text| !text.is_empty()) {
        Some(text) => text
            .parse::<f64>()
            .ok()
            .filter(|seconds| (0.0..61.0).contains(seconds))?,
        None => 0.0,
    };
    Some(f64::from(hours) * 3600.0 + f64::from(minutes) * 60.0 + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_has_86400_seconds_also_across_a_leap_day_and_a_new_year() {
        for (before, after, apart) in [
            ("20240228", "20240301", 2.0),
            ("20230228", "20230301", 1.0),
            ("19991231", "20000101", 1.0),
            ("19000228", "19000301", 1.0),
            ("20000101", "20010101", 366.0),
        ] {
            assert_eq!(
                days(after).unwrap() - days(before).unwrap(),
                apart,
                "{before}"
            );
        }
    }

    #[test]
    fn times_may_be_cut_short_and_what_is_none_is_passed_over() {
        assert_eq!(
            seconds_of_day("072730.5"),
            Some(7.0 * 3600.0 + 27.0 * 60.0 + 30.5)
        );
        assert_eq!(seconds_of_day("0727"), Some(7.0 * 3600.0 + 27.0 * 60.0));
        assert_eq!(seconds_of_day("07"), Some(7.0 * 3600.0));
        assert_eq!(
            seconds_of_day("072730.000000+0100"),
            Some(7.0 * 3600.0 + 27.0 * 60.0 + 30.0)
        );
        for none in ["", "7", "ab", "07:27:30", "0727nan", "0727inf"] {
            assert_eq!(seconds_of_day(none), None, "{none}");
        }
    }
}
