//! Volumes of colour: drawn in it, or red, green and blue projected one by one.

use super::super::{
    Error,
    flags::Classification,
    labels,
    load::{denoise, say_what_was_lost, stretch},
};
use super::{Other, Others, Reader, SceneInputs};
use crate::{
    technique::{Mode, Role},
    transfer::{Classified, Window, of_colors},
    volume::{Header, Source, Volume, read_colors},
};

impl Reader<'_> {
    /// The volume in its own colours.
    pub fn colors(&self, source: Box<dyn Source>) -> Result<SceneInputs, Error> {
        let flags = &self.scene.classification;
        if let Some(preset) = &flags.preset {
            return Err(Error::usage(
                format!("--preset {preset} colours numbers, and this volume has its own colours"),
                "take one of them: --component 0",
            ));
        }
        if let Some(map) = &flags.colormap {
            return Err(Error::usage(
                format!("--colormap {map} colours numbers, and this volume has its own colours"),
                "take one of them: --component 0",
            ));
        }
        let by_alpha = source.header().components == 4;
        let source = self.fitted(source, source_count(by_alpha))?;
        let (time, _) = self.scene.input.time(source.header())?;
        let limits = self.scene.input.limits();
        let mut volumes = read_colors(source.as_ref(), time, &limits)?;
        denoise(&mut volumes, self.scene)?;
        let height_factor = stretch(&mut volumes, self.scene, source.header(), self.progress)?;
        for volume in &volumes {
            say_what_was_lost(volume, "voxels", self.progress);
        }
        let window = flags.window()?;
        if self.mode.is_projection() {
            let header = source.header().clone();
            return self.projected_colors(volumes, window, header, height_factor);
        }
        let function = match (flags.function_of_file()?, window) {
            (Some(function), Some(window)) => function.spread_over(window),
            (Some(function), None) => function,
            (None, window) => of_colors(labels::diagonal(&volumes[0]), by_alpha, window),
        };
        self.progress.note(if by_alpha {
            "a voxel holds a colour: drawn in it, opaque by its alpha; --component N takes one number"
        } else {
            "a voxel holds a colour: drawn in it, opaque by its luma; --component N takes one number"
        });
        let red = volumes.remove(0);
        let function = Classification::Function(function);
        let (header, modes) = (source.header().clone(), self.scene.modes.alone());
        Ok(SceneInputs {
            others: Others::Colors(volumes),
            ..SceneInputs::new(red, header, height_factor, function, modes)
        })
    }

    /// Red, green and blue each projected by itself.
    fn projected_colors(
        &self,
        volumes: Vec<Volume>,
        window: Option<Window>,
        header: Header,
        height_factor: f64,
    ) -> Result<SceneInputs, Error> {
        if self.mode == Mode::Xray {
            return Err(Error::usage(
                "--mode xray: the integral of a colour has no window",
                "take one number of it: --component 0",
            ));
        }
        self.progress
            .note("red, green and blue are projected one by one, and added");
        let window = window.unwrap_or(Window::of_range([0.0, 1.0]));
        let mut made: Vec<Other> = Vec::new();
        for (c, volume) in volumes.into_iter().take(3).enumerate() {
            let mut function = window.grey(Classified::Projection);
            function.color[1].srgb = std::array::from_fn(|k| f64::from(u8::from(k == c)));
            made.push(Other {
                volume,
                function,
                role: Role::Numbers,
            });
        }
        let first = made.remove(0);
        let function = Classification::Function(first.function);
        let modes = self.scene.modes.alone();
        Ok(SceneInputs {
            others: Others::Channels(made),
            ..SceneInputs::new(first.volume, header, height_factor, function, modes)
        })
    }
}

fn source_count(by_alpha: bool) -> usize {
    3 + usize::from(by_alpha)
}
