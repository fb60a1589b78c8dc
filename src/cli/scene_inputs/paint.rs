//! Another variable that colours surfaces.

use super::{Other, Reader};
use crate::cli::Error;
use crate::cli::flags::{Classification, Component, context};
use crate::cli::load::{load_from, open};
use crate::technique::{Mode, Role};
use crate::transfer::{Classified, Window};
use crate::volume::{Grid, Volume, is_same_grid, regridded};

impl Reader<'_> {
    /// Another variable, or another number of the voxels, on the grid of the surfaces that it colours.
    pub(super) fn paint(&self, word: &str, grid: &Grid) -> Result<Other, Error> {
        let mut scene = self.scene.clone();
        scene.modes.levels.iso_color_by = None;
        match word.parse() {
            Ok(number) => scene.input.component = Some(Component::Number(number)),
            Err(_) => scene.input.variable = Some(word.to_owned()),
        }
        let source = open(&scene.input, &scene.input.limits())?;
        let header = source.header();
        scene.classification.context = scene.is_auto().then(|| context(header));
        let is_news = |what: &&String| !what.eq_ignore_ascii_case(&word.replace('_', " "));
        let what = header.long_name.as_ref().filter(is_news);
        let what = what.map_or(String::new(), |what| format!(", {what}"));
        let unit = header.unit.as_ref();
        let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
        let (volume, _) = load_from(source, &scene, self.device, self.progress)?;
        let volume = if is_same_grid(&volume.grid(), grid) {
            Volume {
                world_from_voxel: grid.world_from_voxel,
                ..volume
            }
        } else {
            let nowhere = || {
                Error::usage(
                    format!("--iso-color-by {word}: it has no data where the surfaces may be"),
                    "`stratavox info INPUT --variable NAME` says where a variable lies",
                )
            };
            let moved = regridded(&volume, grid)
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
        let function = match scene
            .classification
            .classification(&volume, Mode::Composite)?
        {
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
        let ends = [function.color.first(), function.color.last()];
        let [low, high] = ends.map(|point| point.map_or(0.0, |point| point.value));
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
