//! Light on its way to a host's target: which pictures have any, and what shaders are told (`shaders/lib/tone.wgsl`).

use super::compatibility::refuse;
use super::{Error, Settings};
use crate::picture::{ColorSpace, Tone, ToneCurve};
use crate::shaders::{TONE_EXPOSED, TONE_FILMIC, TONE_NEUTRAL};

const TONE: &str = "tone mapping";

/// 2 to more than this is no normal f32, nor is 1 over it.
const MOST_STOPS: f64 = 126.0;

impl Settings {
    /// Whether the picture has light for [`Settings::tone`], and that is one.
    ///
    /// # Errors
    /// [`Error::NotFor`] and [`Error::OutOfRange`].
    pub(super) fn check_tone(&self) -> Result<(), Error> {
        let (mode, exposure) = (self.mode, self.tone.exposure);
        let wanted = "-126 to 126 stops";
        let is_gain = exposure.abs() <= MOST_STOPS;
        Error::unless(is_gain, "the exposure", wanted, exposure)?;
        let is_toned = self.tone != Tone::default();
        let of = "composites and surfaces";
        let found = format_args!("mode {mode}");
        refuse(is_toned && mode.is_projection(), TONE, of, found)?;
        let is_display = self.color_space == ColorSpace::Display;
        let (of, found) = ("linear light", "display numbers");
        refuse(is_toned && is_display, TONE, of, found)
    }

    /// What is done with light, and what it is multiplied by.
    pub(super) fn of_tone(&self) -> (u32, f32) {
        let Tone { exposure, curve } = self.tone;
        let number = match curve {
            ToneCurve::None if exposure == 0.0 => 0,
            ToneCurve::None => TONE_EXPOSED,
            ToneCurve::Neutral => TONE_NEUTRAL,
            ToneCurve::Filmic => TONE_FILMIC,
        };
        (number, exposure.exp2() as f32)
    }
}
