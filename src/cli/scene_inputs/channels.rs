//! Several numbers of a voxel, each seen by a function of its own.

use super::classified;
use super::{Other, Others, Reader, SceneInputs};
use crate::cli::Error;
use crate::cli::flags::{ChannelWord, Classification, summary};
use crate::cli::load::{denoise, say_what_was_lost, stretch};
use crate::technique::{Mode, Role};
use crate::transfer::{CHANNEL_COLORS, Window, of_channel, window_of_channel};
use crate::volume::{ComponentKind, Source, read_all};

impl Reader<'_> {
    pub(super) fn channels(
        &self,
        source: Box<dyn Source>,
        words: &[ChannelWord],
    ) -> Result<SceneInputs, Error> {
        if self.mode == Mode::Xray && words.iter().any(|word| word.window.is_none()) {
            return Err(Error::usage(
                "--mode xray of several channels needs a window of each, of its integrals",
                "--channel 0,window=0:9000",
            ));
        }
        let source = self.fitted(source, words.len())?;
        let header = source.header();
        let (time, _) = self.scene.input.time(header)?;
        let indices: Vec<u32> = words.iter().map(|word| word.index).collect();
        let limits = self.scene.input.limits();
        let mut volumes = read_all(source.as_ref(), indices, time, &limits)?;
        denoise(&mut volumes, self.scene)?;
        let height_factor = stretch(&mut volumes, self.scene, header, self.progress)?;
        let known = match &header.meaning {
            ComponentKind::Channels(known) => known.as_slice(),
            _ => &[],
        };
        let primaries = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let is_color = matches!(header.meaning, ComponentKind::Rgb | ComponentKind::Rgba);
        let mut made = Vec::new();
        let mut said = Vec::new();
        let mut drawn = Vec::new();
        for (nth, (word, volume)) in words.iter().zip(volumes).enumerate() {
            let of_file = known.get(word.index as usize);
            let own = primaries.get(word.index as usize).filter(|_| is_color);
            let srgb = word.srgb.or_else(|| {
                let color = of_file.and_then(|channel| channel.srgb);
                color.map(|c| c.map(f64::from)).or(own.copied())
            });
            let srgb = srgb.unwrap_or(CHANNEL_COLORS[nth % CHANNEL_COLORS.len()]);
            let window = word.window.or(of_file.and_then(|channel| channel.window));
            let window = window.and_then(|[low, high]| Window::new(low, high));
            let summary = summary(&volume);
            let window = window.unwrap_or_else(|| window_of_channel(&summary));
            let function = of_channel(&summary, srgb, classified(self.mode), Some(window));
            drawn.push(ChannelWord {
                index: word.index,
                srgb: Some(srgb),
                window: Some([window.low(), window.high()]),
            });
            let name = of_file.map_or("", |channel| channel.name.as_str());
            let name = match name {
                "" => format!("channel {}", word.index),
                name => format!("channel {} ({name})", word.index),
            };
            say_what_was_lost(&volume, &format!("voxels of {name}"), self.progress);
            let [r, g, b] = srgb;
            let ends = [function.opacity.first(), function.opacity.last()];
            let [low, high] = ends.map(|point| point.map_or(0.0, |point| point.value));
            said.push(format!(
                "{name} in {r:.2}:{g:.2}:{b:.2} over {low:.6}:{high:.6}"
            ));
            made.push(Other {
                volume,
                function,
                role: Role::Numbers,
            });
        }
        self.progress.note(&said.join("; "));
        let first = made.remove(0);
        let function = Classification::Function(first.function);
        let (header, modes) = (header.clone(), self.scene.modes.alone());
        Ok(SceneInputs {
            others: Others::Channels(made),
            channels: drawn,
            ..SceneInputs::new(first.volume, header, height_factor, function, modes)
        })
    }
}
