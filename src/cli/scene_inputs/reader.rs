//! One number a voxel, read, and how its values are seen.

use super::{Others, SceneInputs, says_nothing};
use crate::{
    cli::{
        Error,
        flags::{Classification, ClassificationFlags, SceneFlags, summary},
        labels,
        load::load_from,
        memory::{DeviceRoom, Held, fitting},
        progress::Progress,
    },
    look::leave_out,
    technique::{Filter, Mode, PerMode},
    transfer::{LIT_LABEL_OPACITY, LabelTable, TransferFunction},
    volume::{Source, Volume, labels::labels_of},
};

/// What reading needs beside the source.
pub struct Reader<'a> {
    pub scene: &'a SceneFlags,
    pub mode: Mode,
    pub device: &'a dyn DeviceRoom,
    pub progress: &'a Progress,
}

impl Reader<'_> {
    pub fn one(&self, source: Box<dyn Source>) -> Result<SceneInputs, Error> {
        let header = source.header().clone();
        let is_labels = header.is_labels;
        let context = self.scene.context(&header);
        let (mut volume, height_factor) =
            load_from(source, self.scene, self.device, self.progress)?;
        let keeps_all = self.scene.keeps_all(self.mode) || volume.is_outline();
        if !keeps_all && let Some(note) = leave_out(&mut volume, &header) {
            self.progress
                .note(&format!("{note}; --keep-all draws them"));
        }
        let flags = &ClassificationFlags {
            // That of other numbers says nothing of these.
            opacity_function: match self.scene.opacity.are_given() {
                true => None,
                false => self.scene.classification.opacity_function.clone(),
            },
            context,
            ..self.scene.classification.clone()
        };
        let words = &self.scene.labels;
        let has_table = words.label_tf.is_some() && words.labels.is_none();
        let may_name = says_nothing(flags)? && self.mode == Mode::Composite;
        let is_cut = words.cut() && words.labels.is_none();
        // Words on labels take only what looks like labels for them.
        let looks_so = is_cut && may_name && {
            let found = flags.classification(&volume, self.mode)?;
            flags.found_labels(&found)
        };
        if (has_table || is_labels || looks_so)
            && may_name
            && let Some(function) = self.names(&volume)?
        {
            let function = Classification::Function(function);
            let modes = PerMode::default();
            return Ok(SceneInputs {
                filter: Some(Filter::Nearest),
                ..SceneInputs::new(volume, header, height_factor, function, modes)
            });
        }
        if is_cut {
            return Err(Error::usage(
                "--label-show, --label-hide and --label-dim are for labels: of a map over INPUT (--labels), or of INPUT in their own colours",
                "--labels FILE lays a map over INPUT",
            ));
        }
        let modes = &self.scene.modes;
        let none = ClassificationFlags::default();
        let paint = modes.paint(self.mode);
        // With another variable the words are of what colours the surfaces.
        let flags = if paint.is_some() { &none } else { flags };
        let flags = &flags.with_window_of(self.mode, || Ok(summary(&volume)))?;
        let classification = flags.classification(&volume, self.mode)?;
        let (per_mode, note) = modes.per_mode(
            self.mode,
            flags.window()?,
            flags.named(&classification),
            || Ok(summary(&volume)),
        )?;
        if let Some(note) = note {
            self.progress.note(&note);
        }
        let others = match paint {
            Some(word) => vec![self.paint(word, &volume, &per_mode.levels)?],
            None => Vec::new(),
        };
        let found_labels = flags.found_labels(&classification);
        if found_labels && self.scene.sampling.filter.is_none() {
            self.progress
                .note("the values look like labels: drawn with --filter nearest");
        }
        Ok(SceneInputs {
            filter: found_labels.then_some(Filter::Nearest),
            others: Others::Channels(others),
            ..SceneInputs::new(volume, header, height_factor, classification, per_mode)
        })
    }

    /// A volume of labels by itself: each in its colour. `None` where the values are none.
    fn names(&self, volume: &Volume) -> Result<Option<TransferFunction>, Error> {
        let table = self.scene.labels.table()?;
        let present = labels_of(volume);
        Ok(match (table, present) {
            (table, Some(present)) => {
                let mut table = table.unwrap_or_else(LabelTable::default);
                if self.scene.is_auto() {
                    table.opacity.get_or_insert(LIT_LABEL_OPACITY);
                }
                let function = table.function(present.into_keys(), labels::diagonal(volume));
                let words = &self.scene.labels;
                Some(LabelTable::cut(
                    function,
                    |label| words.shows(label),
                    |label| words.dims(Some(&table), label),
                    words.dim()?,
                ))
            }
            (_, None) if self.scene.labels.label_tf.is_some() || self.scene.labels.cut() => {
                return Err(Error::usage(
                    "--label-tf, --label-show, --label-hide and --label-dim are for labels, and the values of INPUT are none",
                    "--labels FILE lays a label map over INPUT",
                ));
            }
            (_, None) => None,
        })
    }

    /// The source, small enough for so many volumes, and what is to be known of it.
    pub fn fitted(&self, source: Box<dyn Source>, count: usize) -> Result<Box<dyn Source>, Error> {
        let input = &self.scene.input;
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        let held = Held::of(self.scene, count);
        let source = fitting(source, self.scene, self.device.memory()?, held)?;
        let (_, note) = input.time(source.header())?;
        input.check_one(source.header())?;
        for note in source.header().notes.iter().chain(&note) {
            self.progress.note(note);
        }
        Ok(source)
    }
}
