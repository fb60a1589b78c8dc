//! What words put beside the first volume: numbers that make it opaque, other volumes, labels over it.

use super::{Other, Others, Reader, SceneInputs, fade, says_nothing};
use crate::cli::flags::Classification;
use crate::cli::{Error, labels};
use crate::technique::Mode;
use std::sync::Arc;

impl SceneInputs {
    /// The same with all of it. A volume whose function no word names is drawn faint where something lies inside of it.
    pub(super) fn with_beside(mut self, reader: &Reader) -> Result<Self, Error> {
        let scene = reader.scene;
        let (grid, height_factor) = (self.volume.grid(), self.height_factor);
        let mut is_hiding = false;
        if scene.opacity.are_given() {
            let others = self.others_for(scene.opacity.word())?;
            others.push(reader.opacity(&grid, height_factor)?);
        }
        if scene.with.volumes().next().is_some() {
            let others = self.others_for("--with")?;
            others.extend(reader.with(&grid, height_factor)?);
            is_hiding = reader.mode == Mode::Composite;
        }
        if scene.labels.labels.is_some() {
            self.others_for("--labels")?;
            let map = labels::read(scene, &grid, height_factor, reader.mode, reader.progress)?;
            if reader.mode == Mode::Composite {
                let mut opacities = map.function.opacity.iter();
                is_hiding |= opacities.any(|point| point.opacity > 0.0);
            } else {
                labels::hide_in(Arc::make_mut(&mut self.volume), &map.volume);
            }
            let others = self.others_for("--labels")?;
            if reader.mode != Mode::Composite {
                others
                    .iter_mut()
                    .for_each(|other| labels::hide_in(&mut other.volume, &map.volume));
            }
            others.push(map);
        }
        let is_plain = says_nothing(&scene.classification)? && !scene.opacity.are_given();
        if is_hiding && is_plain {
            fade(&mut self.classification);
            reader.progress.note(
                "the volume is drawn faint, so that what lies inside is seen; a --preset or --tf is drawn as it is",
            );
        }
        Ok(self)
    }

    /// What lies beside the volume, where `word` may put something there.
    fn others_for(&mut self, word: &str) -> Result<&mut Vec<Other>, Error> {
        if let Classification::Function(function) = &self.classification
            && function.uses_gradient()
        {
            return Err(Error::usage(
                format!(
                    "{word}: widgets and gradient opacity are for one volume alone, and several are drawn"
                ),
                "take a function of the value alone",
            ));
        }
        match &mut self.others {
            Others::Channels(others) => Ok(others),
            Others::Colors(_) | Others::Preclassified | Others::Points(_) => Err(Error::usage(
                format!("{word} goes with volumes of numbers, and this one is of colours"),
                "take one of them: --component 0",
            )),
        }
    }
}
