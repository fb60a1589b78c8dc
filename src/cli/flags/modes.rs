//! What single modes want to know: flags to [`PerMode`], once the volume is known.

use super::{Error, LevelFlags, finite};
use crate::{
    figure::short,
    technique::{self, DEFAULT_ATTENUATION, Mode, PerMode, Settings},
    transfer::{TransferFunction, ValueSummary, Window},
};
use clap::Args;
use serde::{Deserialize, Serialize};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModeFlags {
    /// lmip: the first local maximum over this is shown [default: the middle of the window]
    #[arg(long, value_name = "VALUE", value_parser = finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lmip_threshold: Option<f64>,
    /// mida: from -1, composite, to 0, where new maxima clear what lies before them, to 1, mip [default: 0]
    #[arg(long, value_name = "G", value_parser = finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mida_gamma: Option<f64>,
    /// attenuated-mip: a value fades to 1/e behind matter of full value over 1/F of the box's diagonal [default: 16]
    #[arg(long, value_name = "F", value_parser = finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attenuation: Option<f64>,
    /// mip, minip, lmip, attenuated-mip: how much darker the far end is, 0 to 1 [default: 0]
    #[arg(long, value_name = "F", value_parser = finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_cue: Option<f64>,
    /// mip, minip: the extreme of the interpolated volume itself, between samples too
    #[arg(long, help_heading = HEADING)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub exact_maximum: bool,
    #[command(flatten)]
    #[serde(skip_serializing_if = "LevelFlags::say_nothing")]
    pub levels: LevelFlags,
}

/// Under which these stand in `--help`.
const HEADING: &str = "Modes";

impl ModeFlags {
    /// What can be said wrong before a voxel is read.
    pub fn check(&self, settings: &Settings) -> Result<(), Error> {
        let mode = settings.mode;
        let asked = Settings {
            per_mode: self.given(),
            ..settings.clone()
        };
        asked.check_mode().map_err(refused)?;
        self.levels.check()?;
        if settings.technique.traces_paths() && self.levels.iso_color_by.is_some() {
            return Err(Error::usage(
                "--iso-color-by is for --mode iso: paths go through one volume of numbers",
                "--iso-color says what colours surfaces have in --technique pathtrace",
            ));
        }
        if mode == Mode::Iso {
            return Ok(());
        }
        self.given().check(mode).map_err(|error| {
            Error::usage(
                error.to_string(),
                "`stratavox render --help` says what these numbers mean",
            )
        })
    }

    /// The other variable that surfaces are coloured by.
    pub fn paint(&self, mode: Mode) -> Option<&str> {
        let word = self.levels.iso_color_by.as_deref();
        word.filter(|_| mode == Mode::Iso)
    }

    /// Of several numbers a voxel.
    pub fn check_several(&self, mode: Mode) -> Result<(), Error> {
        if !mode.needs_rays() {
            return Ok(());
        }
        Err(Error::usage(
            format!("--mode {mode} shows one number a voxel, and several channels are drawn"),
            "take one of them: --component 0",
        ))
    }

    /// Of values that decide nothing.
    pub fn alone(&self) -> PerMode {
        self.given()
    }

    /// What the words say, defaults where they do not.
    fn given(&self) -> PerMode {
        PerMode {
            mida_gamma: self.mida_gamma.unwrap_or(0.0),
            attenuation: self.attenuation.unwrap_or(DEFAULT_ATTENUATION),
            depth_cue: self.depth_cue.unwrap_or(0.0),
            lmip_threshold: self.lmip_threshold.unwrap_or(0.0),
            exact_maximum: self.exact_maximum,
            ..PerMode::default()
        }
    }

    /// All of it for values that look like `summary`, which is asked for where it decides anything, and are coloured
    /// by `function` where one is named; and what a person should know of what was chosen.
    pub fn per_mode(
        &self,
        mode: Mode,
        window: Option<Window>,
        function: Option<&TransferFunction>,
        summary: impl FnOnce() -> Result<ValueSummary, Error>,
    ) -> Result<(PerMode, Option<String>), Error> {
        let mut per_mode = self.given();
        let mut note = None;
        match mode {
            Mode::Lmip if self.lmip_threshold.is_none() => {
                let window = match window {
                    Some(window) => window,
                    None => Window::of_range(summary()?.range),
                };
                per_mode.lmip_threshold = window.at(0.5);
                note = Some(format!(
                    "local maxima count over {}, the middle of the window; --lmip-threshold sets it",
                    short(per_mode.lmip_threshold)
                ));
            }
            Mode::AttenuatedMip => {
                let window = match window {
                    Some(window) => window,
                    None => Window::of_range(summary()?.range),
                };
                per_mode.unit_values = [window.low(), window.high()];
            }
            Mode::Mida => {
                let window = match window {
                    Some(window) => window,
                    None => usual(&summary()?),
                };
                per_mode.unit_values = [window.low(), window.high()];
                note = Some(format!(
                    "maxima are compared between {} and {}; --window sets it",
                    short(window.low()),
                    short(window.high())
                ));
            }
            Mode::Iso => {
                (per_mode.levels, note) = self.levels.levels(function, summary)?;
            }
            // Those that paths meet; others do not look at them.
            Mode::Composite if !self.levels.iso.is_empty() => {
                (per_mode.levels, note) = self.levels.levels(None, summary)?;
            }
            _ => {}
        }
        Ok((per_mode, note))
    }

    /// Flags that change nothing in this mode, a sentence each.
    pub fn idle(&self, mode: Mode, traces_paths: bool) -> Vec<&'static str> {
        let given = [
            (
                self.lmip_threshold,
                Mode::Lmip,
                "--lmip-threshold has no effect without --mode lmip",
            ),
            (
                self.mida_gamma,
                Mode::Mida,
                "--mida-gamma has no effect without --mode mida",
            ),
            (
                self.attenuation,
                Mode::AttenuatedMip,
                "--attenuation has no effect without --mode attenuated-mip",
            ),
        ];
        let mut notes = Vec::new();
        if !self.levels.say_nothing() && mode != Mode::Iso && !traces_paths {
            notes.push(
                "--iso and its colours have no effect without --mode iso or --technique pathtrace",
            );
        }
        let idle = given
            .into_iter()
            .filter(|&(given, of, _)| given.is_some() && mode != of);
        notes.extend(idle.map(|(_, _, note)| note));
        notes
    }
}

/// A mode that technique and lattice do not have, by flags.
fn refused(problem: technique::Error) -> Error {
    use technique::Error as Problem;
    let (text, hint) = match problem {
        Problem::NeedsRays { mode, .. } => (
            format!(
                "--mode {mode} needs --technique raycast: in it a sample depends on those before it"
            ),
            "leave out --technique, or take --mode mip",
        ),
        Problem::NeedsRayLattice { mode } => (
            format!(
                "--mode {mode} takes samples along rays: --lattice planes is for modes that slicers have"
            ),
            "leave out --lattice",
        ),
        Problem::NoDepth { technique, .. } if !technique.has_depth() => (
            "--depth-cue needs --technique raycast: blending keeps no depth".to_owned(),
            "leave out --technique",
        ),
        Problem::NoDepth { mode, .. } => (
            format!("--depth-cue: --mode {mode} has no one depth a ray"),
            "--mode mip has one, and minip, lmip and attenuated-mip",
        ),
        Problem::NotExact { .. } => (
            "--exact-maximum is one of --mode mip or minip along rays, filtered linearly"
                .to_owned(),
            "leave out --technique, --lattice and --filter",
        ),
        other => (
            other.to_string(),
            "`stratavox render --help` says what goes together",
        ),
    };
    Error::usage(text, hint)
}

/// Where all but a thousandth of the voxels lie: one hot voxel does not make the others equal.
fn usual(summary: &ValueSummary) -> Window {
    let [low, high] = [0.0005, 0.9995].map(|share| summary.quantile(share));
    Window::new(low, high).unwrap_or(Window::of_range(summary.range))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::flags::summary;
    use crate::named::Named;
    use crate::technique::{Lattice, Technique};
    use crate::volume::{Rescale, Volume, Voxels};
    use glam::DAffine3;

    fn of(flags: &ModeFlags, mode: Mode, window: Option<Window>) -> (PerMode, Option<String>) {
        let voxels = Voxels::U8(vec![0, 10, 20, 30, 40, 50, 60, 70]);
        let place = DAffine3::IDENTITY;
        let volume = Volume::from_voxels([2, 2, 2], place, voxels, Rescale::default(), None);
        let volume = volume.expect("a volume");
        flags
            .per_mode(mode, window, None, || Ok(summary(&volume)))
            .expect("numbers")
    }

    #[test]
    fn local_maxima_count_over_the_middle_of_the_window() {
        let flags = ModeFlags::default();
        let (found, note) = of(&flags, Mode::Lmip, None);
        assert_eq!(found.lmip_threshold, 35.0);
        assert!(note.expect("a note").contains("over 35"));
        let (found, _) = of(&flags, Mode::Lmip, Window::new(10.0, 20.0));
        assert_eq!(found.lmip_threshold, 15.0);
        let flags = ModeFlags {
            lmip_threshold: Some(7.0),
            ..flags
        };
        let (found, note) = of(&flags, Mode::Lmip, None);
        assert_eq!((found.lmip_threshold, note), (7.0, None));
    }

    #[test]
    fn values_without_a_unit_come_from_the_window_or_the_volume() {
        let flags = ModeFlags::default();
        let (found, _) = of(&flags, Mode::AttenuatedMip, None);
        assert_eq!(found.unit_values, [0.0, 70.0]);
        for mode in [Mode::AttenuatedMip, Mode::Mida] {
            let (found, _) = of(&flags, mode, Window::new(10.0, 20.0));
            assert_eq!(found.unit_values, [10.0, 20.0], "{mode:?}");
        }
    }

    #[test]
    fn numbers_that_mean_nothing_and_flags_of_other_modes_are_named() {
        let settings = |technique, mode| Settings {
            technique,
            mode,
            ..Settings::default()
        };
        let refused = |flags: &ModeFlags, technique, mode| {
            let error = flags.check(&settings(technique, mode));
            let error = error.expect_err("refused");
            assert_eq!(error.exit_code(), 2);
            error.to_string()
        };
        let gamma = ModeFlags {
            mida_gamma: Some(1.5),
            ..ModeFlags::default()
        };
        let text = refused(&gamma, Technique::Raycast, Mode::Mida);
        assert_eq!(text, "the gamma of MIDA is 1.5, wanted -1 to 1");
        assert_eq!(gamma.idle(Mode::Mip, false).len(), 1);
        assert!(gamma.idle(Mode::Mida, false).is_empty());
        let cue = ModeFlags {
            depth_cue: Some(0.5),
            ..ModeFlags::default()
        };
        let text = refused(&cue, Technique::Slices3d, Mode::Mip);
        assert!(text.contains("--technique raycast"), "{text}");
        let text = refused(&cue, Technique::Raycast, Mode::Xray);
        assert!(text.contains("--mode xray"), "{text}");
        let none = ModeFlags::default();
        for mode in [Mode::Lmip, Mode::AttenuatedMip, Mode::Mida] {
            let text = refused(&none, Technique::Slices2d, mode);
            assert!(text.contains(mode.name()), "{text}");
            let mut right = settings(Technique::Raycast, mode);
            none.check(&right).expect("right");
            right.lattice = Lattice::Planes;
            let text = none.check(&right).expect_err("refused").to_string();
            assert!(text.contains("--lattice planes"), "{text}");
        }
    }
}
