//! What made the values between the voxels of a picture, and why.

use super::Renderer;
use crate::technique::{Filter, FilterBy, Settings};

/// One of the ways of [`FilterBy`], as words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Filtered {
    /// `corners`, `fetch` or `sampler`.
    pub by: &'static str,
    /// In a few words.
    pub because: &'static str,
}

impl Renderer<'_> {
    /// That of the last picture, which was one of these settings; `None` before there is one.
    pub fn filtered(&self, settings: &Settings) -> Option<Filtered> {
        let (.., variant) = self.passes.as_ref()?.key();
        let has_slow_sampler = self.device.gpu().has_slow_sampler();
        let by = match variant.filter {
            "footprint8" | "footprint16" => "corners",
            "linear" | "spline" => "sampler",
            _ => "fetch",
        };
        let because = match (by, settings.filter_by) {
            (_, _) if settings.conformance => "a conformance picture",
            (_, _) if variant.is_in_runs => "classified voxels lie in runs",
            ("fetch", _) if matches!(settings.filter, Filter::Nearest | Filter::CatmullRom) => {
                "the filter reads voxels one by one"
            }
            ("corners" | "fetch", FilterBy::Fetch) | ("sampler", FilterBy::Sampler) => "asked for",
            ("corners", _) => "the driver's sampler is slower",
            ("fetch", _) => "the device does not filter the format",
            (_, _) if has_slow_sampler => "no corners for this volume or this kind of picture",
            (_, _) => "no driver but llvmpipe was found to be faster without",
        };
        Some(Filtered { by, because })
    }
}
