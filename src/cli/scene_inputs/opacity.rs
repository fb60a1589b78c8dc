//! Numbers that say how opaque the volume is, in the place of its own: read, brought to its grid, given a function.

use super::super::{
    Error, exaggerate,
    flags::{Classification, ClassificationFlags, Component, InputFlags, Numbers, WindowWord},
    load::{denoise, open, say_what_was_lost},
    memory::{Held, fitting},
    timings::Loaded,
};
use super::{Other, Reader};
use crate::{
    technique::{Mode, Role},
    transfer::TransferFunction,
    volume::{Grid, Header, Volume, is_same_grid, regridded},
};

impl Reader<'_> {
    /// The numbers that words name, on the grid of what they make opaque; heights are drawn so much higher.
    pub fn opacity(&self, grid: &Grid, height_factor: f64) -> Result<Other, Error> {
        self.numbers(grid, height_factor)
            .map_err(Error::of_opacity_flags)
    }

    fn numbers(&self, grid: &Grid, height_factor: f64) -> Result<Other, Error> {
        let flags = &self.scene.opacity;
        let mut input = flags.input(&self.scene.input);
        let limits = input.limits();
        let source = open(&input, &limits)?;
        self.check(&input, source.header())?;
        // A file of one time is of all times.
        if flags.opacity_from.is_some() && source.header().times == 1 {
            input.time = None;
        }
        let (pick, note) = input.pick(source.header())?;
        // Of the file that is coloured it has been said.
        if let (Some(note), true) = (&note, flags.opacity_from.is_some()) {
            self.progress.note(&format!("{}: {note}", flags.word()));
        }
        let held = Held::of(self.scene, 2);
        let source = fitting(source, self.scene, self.device.memory()?, held)?;
        let header = source.header();
        let name = name(&input, header, pick.component);
        let (mut volume, loaded) = Loaded::volume(source.as_ref(), pick, &limits)?;
        self.progress.loaded(loaded);
        say_what_was_lost(&volume, &format!("voxels of {name}"), self.progress);
        denoise(std::slice::from_mut(&mut volume), self.scene)?;
        volume.world_from_voxel = exaggerate::stretched(volume.world_from_voxel, height_factor);
        let volume = self.placed(volume, grid, &name)?;
        let function = self.function_of_opacity(&volume)?;
        let ends = [function.opacity.first(), function.opacity.last()];
        let [low, high] = ends.map(|point| point.map_or(0.0, |point| point.value));
        self.progress.note(&format!(
            "opaque by {name}: its opacity has points from {low:.6} to {high:.6}"
        ));
        Ok(Other {
            volume,
            function,
            role: Role::Opacity,
        })
    }

    /// Refuses numbers that are those of the colour.
    fn check(&self, input: &InputFlags, header: &Header) -> Result<(), Error> {
        let colored = &self.scene.input;
        let is_same = input.path == colored.path
            && input.variable == colored.variable
            && input.component == colored.component;
        if is_same {
            return Err(Error::usage(
                format!(
                    "{} names the numbers that are coloured: their own opacity needs no word",
                    self.scene.opacity.word()
                ),
                "leave it out; --opacity-tf FILE says how opaque they are",
            ));
        }
        let Some(Component::Number(component)) = input.component else {
            return Ok(());
        };
        if component < header.components {
            return Ok(());
        }
        Err(Error::usage(
            format!(
                "--opacity-component {component}: a voxel has {} of them, counted from 0",
                header.components
            ),
            "--opacity-component 0",
        ))
    }

    fn placed(&self, volume: Volume, grid: &Grid, name: &str) -> Result<Volume, Error> {
        if is_same_grid(grid, &volume.grid()) {
            return Ok(Volume {
                world_from_voxel: grid.world_from_voxel,
                ..volume
            });
        }
        let path = self.scene.opacity.input(&self.scene.input).path;
        let refused = |problem: String| Error::Input {
            path: path.clone().unwrap_or_default().into(),
            problem,
        };
        let (moved, share) =
            regridded(&volume, grid).map_err(|problem| refused(problem.to_string()))?;
        if share == 0.0 {
            return Err(refused(
                "no voxel of the volume has data there: they do not overlap".to_owned(),
            ));
        }
        self.progress.note(&format!(
            "{name} lies on another grid: each voxel of the volume takes its value there, which {:.0} % of them have",
            100.0 * share
        ));
        Ok(moved)
    }

    /// That of `--opacity-tf`, else one by the values; of both only the opacity is used.
    fn function_of_opacity(&self, volume: &Volume) -> Result<TransferFunction, Error> {
        let file = self.scene.classification.opacity_function.as_ref();
        let flags = ClassificationFlags {
            transfer_function: file.map(|file| file.transfer_function.clone()),
            transfer_function_of_fractions: file.map(|file| file.of_fractions),
            window: self
                .scene
                .opacity
                .opacity_window
                .map(|Numbers(ends)| WindowWord::Values(ends)),
            ..ClassificationFlags::default()
        };
        let Classification::Function(function) = flags.classification(volume, Mode::Composite)?
        else {
            unreachable!("only integrals have no function yet")
        };
        if function.uses_gradient() {
            return Err(Error::usage(
                "widgets and gradient opacity are for one volume alone, and the opacity is of other numbers",
                "take a function of the value alone for --opacity-tf",
            ));
        }
        Ok(function)
    }
}

impl Error {
    /// What is said of the words for INPUT, said of those for what makes it opaque.
    fn of_opacity_flags(self) -> Self {
        const HINTS: [(&str, &str); 4] = [
            (
                "choose one with --variable NAME",
                "choose one with --opacity-variable NAME",
            ),
            ("leave out --variable", "leave out --opacity-variable"),
            ("--component 0", "--opacity-component 0"),
            ("--window -200,800", "--opacity-window -200,800"),
        ];
        let Self::Usage { message, hint } = self else {
            return self;
        };
        let found = HINTS.into_iter().find(|(of_input, _)| *of_input == hint);
        let message = ["variable", "component", "window"]
            .into_iter()
            .fold(message, |message, word| {
                message.replace(&format!("--{word}"), &format!("--opacity-{word}"))
            });
        Self::Usage {
            message,
            hint: found.map_or(hint, |(_, of_opacity)| of_opacity.into()),
        }
    }
}

fn name(input: &InputFlags, header: &Header, component: u32) -> String {
    let file = input.file().and_then(|path| path.file_name());
    let file = file.map(|name| name.to_string_lossy().into_owned());
    let variable = input.variable.clone();
    let name = variable.or(file).or(input.path.clone()).unwrap_or_default();
    match header.components {
        1 => name,
        _ => format!("number {component} of {name}"),
    }
}
