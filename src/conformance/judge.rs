//! One case on a device, and what is said of it.

use super::case::{Case, Stop};
use super::measurement::{Measurement, Pictures};
use super::need::Found;
use super::record::Record;
use super::test_bed::TestBed;
use super::verdict::Verdict;
use crate::gpu;
use crate::offscreen;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// Of the numbers of a case at most so many parts may depend on rounding: else it says nothing.
const MOST_LEFT_OUT: f64 = 0.1;

/// Of a channel of a picture that may be off by more than half a code of 255 little is known.
pub const WIDE_ALLOWANCE: f64 = 0.5 / 255.0;
/// Where this part of the channels or more is allowed that much, a pass proves little.
const MOST_WIDE: f64 = 0.1;

/// Runs `case` and judges it; the pictures are those that were compared, where it has drawn any.
pub fn judge(case: &Case, bed: &mut TestBed) -> (Record, Option<Pictures>) {
    let start = Instant::now();
    let (mut record, pictures) = judged(case, bed);
    if let Some(Ok(device)) = bed.wants_device().then(|| bed.device()) {
        let messages = device.take_validation_messages();
        record.validation_messages = messages.iter().map(ToString::to_string).collect();
    }
    if let (Some(first), true) = (record.validation_messages.first(), record.verdict.is_good()) {
        record.verdict = Verdict::InternalError;
        record.reason = format!("the validation layer complains: {first}");
    }
    record.ms = 1e3 * start.elapsed().as_secs_f64();
    (record, pictures)
}

fn judged(case: &Case, bed: &mut TestBed) -> (Record, Option<Pictures>) {
    let of = |verdict, reason| Record::unmeasured(&case.name, case.profile, verdict, reason);
    let needs: Vec<Found> = match bed.wants_device().then(|| bed.device()) {
        Some(Ok(device)) => {
            let gpu = device.gpu();
            let needs = case.needs.iter().map(|&item| Found::of(gpu, item));
            let events = case.wants_events.then(|| Found::events(gpu));
            needs.chain(events).collect()
        }
        Some(Err(error)) => return (of(verdict_of(&error), error.to_string()), None),
        None => Vec::new(),
    };
    if let Some((verdict, reason)) = lacking(&needs) {
        let record = Record {
            needs,
            ..of(verdict, reason)
        };
        return (record, None);
    }
    let ran = catch_unwind(AssertUnwindSafe(|| (case.run)(bed)));
    let (record, pictures) = match ran {
        Ok(Ok(measurement)) => {
            let (record, pictures) = measured(case, measurement);
            (record, pictures)
        }
        Ok(Err(Stop::Lacking(found))) => {
            let reason = Stop::Lacking(found.clone()).to_string();
            let record = Record {
                needs: needs.into_iter().chain([*found]).collect(),
                ..of(Verdict::NotSupported, reason)
            };
            return (record, None);
        }
        Ok(Err(stop)) => {
            let of_stop = match &stop {
                Stop::Offscreen(offscreen::Error::Gpu(error)) => verdict_of(error),
                Stop::Offscreen(_) | Stop::Lacking(_) | Stop::Suite(_) => Verdict::InternalError,
            };
            let (verdict, reason) = lacking(&needs).unwrap_or((of_stop, stop.to_string()));
            if verdict == Verdict::DeviceLost {
                bed.drop_device();
            }
            (of(verdict, reason), None)
        }
        Err(panic) => {
            // What it held may be half done.
            bed.drop_device();
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()));
            let reason = format!("the suite panicked: {}", text.unwrap_or_default());
            (of(Verdict::InternalError, reason), None)
        }
    };
    (Record { needs, ..record }, pictures)
}

/// A refusal that is no need of the case is no verdict on the device.
fn verdict_of(error: &gpu::Error) -> Verdict {
    match error {
        gpu::Error::OutOfMemory { .. } => Verdict::ResourceError,
        gpu::Error::DeviceLost { .. } => Verdict::DeviceLost,
        _ => Verdict::InternalError,
    }
}

/// What a need that is not met comes to.
fn lacking(needs: &[Found]) -> Option<(Verdict, String)> {
    let wrong = needs
        .iter()
        .find(|need| need.library_has && !need.device_has);
    if let Some(need) = wrong {
        let reason = format!(
            "the library takes {} as there, and the device says {}",
            need.name, need.device_says
        );
        return Some((Verdict::InternalError, reason));
    }
    let need = needs.iter().find(|need| !need.library_has)?;
    let Found {
        name,
        wanted,
        library_says,
        device_says,
        ..
    } = need;
    let reason = match need.device_has {
        false => format!("{name}: wanted {wanted}, the device says {device_says}"),
        true => format!(
            "{name}: wanted {wanted}, found {library_says}: lowered for this run, the device says {device_says}"
        ),
    };
    Some((Verdict::NotSupported, reason))
}

fn measured(case: &Case, measurement: Measurement) -> (Record, Option<Pictures>) {
    let found_sha256 = measurement.found_sha256();
    let Measurement {
        bound,
        checked,
        left_out,
        least,
        worst,
        quality,
        pictures,
        ..
    } = measurement;
    let all = (checked + left_out) as f64;
    let (verdict, reason, worst) = if worst.ratio > 1.0 {
        let reason = format!(
            "{}: expected {:e}, found {:e}, allowed {:e}",
            worst.at, worst.expected, worst.found, worst.allowed
        );
        (Verdict::Fail, reason, worst)
    } else if checked < least {
        let reason = format!("{checked} numbers were compared, at least {least} are wanted");
        (Verdict::InternalError, reason, worst)
    } else if left_out as f64 > MOST_LEFT_OUT * all {
        let reason = format!("{left_out} of {all} numbers depend on rounding");
        (Verdict::InternalError, reason, worst)
    } else {
        match quality {
            Some((better, meaning)) if better.ratio > 1.0 => {
                let reason = format!(
                    "{meaning}: {}: expected {:e}, found {:e}, better within {:e}",
                    better.at, better.expected, better.found, better.allowed
                );
                (Verdict::QualityWarning, reason, better)
            }
            _ => (Verdict::Pass, String::new(), worst),
        }
    };
    let record = Record {
        checked,
        left_out,
        found_sha256,
        worst: (worst.allowed > 0.0 || worst.ratio > 0.0).then_some(worst),
        weak_bound: bound
            .inputs
            .get("wide_share")
            .is_some_and(|&share| share > MOST_WIDE),
        bound: Some(bound),
        ..Record::unmeasured(&case.name, case.profile, verdict, reason)
    };
    (record, pictures)
}
