//! Another variable that colours surfaces: where no word says over which values, over those at the surfaces.

use super::{Other, Parts, Reader, SceneInputs, limits, says_nothing};
use crate::cli::Error;
use crate::cli::flags::{Classification, ClassificationFlags, Component, SceneFlags, WindowWord};
use crate::cli::load::{load_from, open, open_first};
use crate::cli::memory::DeviceRoom;
use crate::cli::progress::Progress;
use crate::cli::readable::in_unit;
use crate::look::summary_at;
use crate::technique::{Level, Mode, Role, Settings};
use crate::transfer::{Classified, TransferFunction, Window};
use crate::volume::{Volume, is_same_grid, regridded};

/// The scene of a film, whose surfaces have the colours of all its times where nobody says their range.
pub fn with_range_of_film(
    scene: &SceneFlags,
    settings: &Settings,
    times: u32,
    device: &dyn DeviceRoom,
    progress: &Progress,
) -> Result<SceneFlags, Error> {
    let mut whole = scene.clone();
    if scene.modes.paint(settings.mode).is_none() || !says_nothing(&scene.classification)? {
        return Ok(whole);
    }
    let quiet = Progress::of_part();
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for time in 0..times {
        progress.stage("look at all times", time as usize, times as usize);
        let mut scene = scene.clone();
        scene.input.time = Some(time.to_string());
        let limits = limits(&scene);
        let source = open_first(&mut scene, &limits, &quiet)?;
        let shown = SceneInputs::of(source, &scene, settings, device, &quiet)?;
        let parts = shown.parts();
        let Parts::Channels(others) = &parts else {
            continue;
        };
        let paint = others.iter().find(|other| other.role == Role::Numbers);
        let function = paint.and_then(|paint| paint.transfer);
        if let Some([low, high]) = function.and_then(colored) {
            range = [range[0].min(low), range[1].max(high)];
        }
    }
    if range[0] < range[1] {
        whole.classification.window = Some(WindowWord::Values(range));
    }
    Ok(whole)
}

/// From where to where a function has colours.
fn colored(function: &TransferFunction) -> Option<[f64; 2]> {
    let (first, last) = (function.color.first()?, function.color.last()?);
    Some([first.value, last.value])
}

impl Reader<'_> {
    /// Another variable, or another number of the voxels, on the grid of the surfaces that it colours.
    pub(super) fn paint(
        &self,
        word: &str,
        surfaces: &Volume,
        levels: &[Level],
    ) -> Result<Other, Error> {
        let mut scene = self.scene.clone();
        scene.modes.levels.iso_color_by = None;
        match word.parse() {
            Ok(number) => scene.input.component = Some(Component::Number(number)),
            Err(_) => scene.input.variable = Some(word.to_owned()),
        }
        let source = open(&scene.input, &scene.input.limits())?;
        let header = source.header();
        scene.classification.context = scene.context(header);
        let is_news = |what: &&String| !what.eq_ignore_ascii_case(&word.replace('_', " "));
        let what = header.long_name.as_ref().filter(is_news);
        let what = what.map_or(String::new(), |what| format!(", {what}"));
        let unit = in_unit(header.unit.as_deref());
        let (volume, _) = load_from(source, &scene, self.device, self.progress)?;
        let volume = if is_same_grid(&volume.grid(), &surfaces.grid()) {
            Volume {
                world_from_voxel: surfaces.world_from_voxel,
                ..volume
            }
        } else {
            let nowhere = || {
                Error::usage(
                    format!("--iso-color-by {word}: it has no data where the surfaces may be"),
                    "`stratavox info INPUT --variable NAME` says where a variable lies",
                )
            };
            let moved = regridded(&volume, &surfaces.grid())
                .ok()
                .filter(|(_, share)| *share > 0.0);
            let (moved, share) = moved.ok_or_else(nowhere)?;
            self.progress.note(&format!(
                "{word} lies on another grid: taken at the voxels of the surfaces, linear between its own; it covers \
                 {:.0} % of them",
                100.0 * share
            ));
            moved
        };
        let flags = &scene.classification;
        let function = match at_surfaces(flags, surfaces, levels, &volume)? {
            Classification::Function(function) => function,
            Classification::RangeOfPicture => {
                Window::of_range(volume.value_range).grey(Classified::Samples)
            }
        };
        if function.uses_gradient() {
            return Err(Error::usage(
                "--iso-color-by takes the colours of values, and this function is of their gradient too",
                "take a function of the value alone",
            ));
        }
        let [low, high] = colored(&function).unwrap_or_default();
        self.progress.note(&format!(
            "surfaces are coloured by {word}{what}, from {low:.6} to {high:.6}{unit}; --window, --preset and --tf say otherwise"
        ));
        Ok(Other {
            volume,
            function,
            role: Role::Numbers,
        })
    }
}

/// How the numbers of `volume` are seen at these surfaces. Labels have the colours of all.
fn at_surfaces(
    flags: &ClassificationFlags,
    surfaces: &Volume,
    levels: &[Level],
    volume: &Volume,
) -> Result<Classification, Error> {
    let of_all = flags.classification(volume, Mode::Composite)?;
    if !says_nothing(flags)? || flags.found_labels(&of_all) {
        return Ok(of_all);
    }
    let levels: Vec<f64> = levels.iter().map(|level| level.value).collect();
    match summary_at(surfaces, &levels, volume) {
        Some(seen) => flags.classification_of(Mode::Composite, || Ok(seen.clone())),
        None => Ok(of_all),
    }
}
