//! Other volumes that are seen together with the first: read, placed in the same world, given functions of their own.

use super::{Other, Reader, classified};
use crate::cli::flags::{
    Classification, ClassificationFlags, WindowWord, WithWord, context, summary,
};
use crate::cli::load::{denoise, open, say_what_was_lost};
use crate::cli::memory::{Held, fitting};
use crate::cli::timings::Loaded;
use crate::cli::{Error, exaggerate};
use crate::technique::{Mode, Role};
use crate::transfer::{CHANNEL_COLORS, TransferFunction, Window, of_channel};
use crate::volume::{Grid, Header, Volume, is_same_grid};
use glam::DVec3;

/// Places along each axis of a grid at which it is asked whether they lie in another one.
const PLACES: u32 = 16;

impl Reader<'_> {
    /// All volumes of `--with`, for one on `grid` whose heights are drawn so much higher.
    pub(super) fn with(&self, grid: &Grid, height_factor: f64) -> Result<Vec<Other>, Error> {
        let words = self.scene.with.volumes().enumerate();
        let read = words.map(|(nth, word)| {
            let read = self.with_one(nth, word, grid, height_factor);
            read.map_err(|error| error.of_with(word))
        });
        read.collect()
    }

    fn with_one(
        &self,
        nth: usize,
        word: &WithWord,
        grid: &Grid,
        height_factor: f64,
    ) -> Result<Other, Error> {
        let mut input = word.input(&self.scene.input);
        let limits = input.limits();
        let source = open(&input, &limits)?;
        if source.header().times == 1 {
            input.time = None;
        }
        let (pick, note) = input.pick(source.header())?;
        let name = word.name();
        if let Some(note) = note {
            self.progress.note(&format!("{name}: {note}"));
        }
        let held = Held::of(self.scene, 2);
        let source = fitting(source, self.scene, self.device.memory()?, held)?;
        let (mut volume, loaded) = Loaded::volume(source.as_ref(), pick, &limits)?;
        self.progress.loaded(loaded);
        say_what_was_lost(&volume, &format!("voxels of {name}"), self.progress);
        denoise(std::slice::from_mut(&mut volume), self.scene)?;
        volume.world_from_voxel = word.moved(volume.world_from_voxel)?;
        volume.world_from_voxel = exaggerate::stretched(volume.world_from_voxel, height_factor);
        if is_same_grid(grid, &volume.grid()) {
            volume.world_from_voxel = grid.world_from_voxel;
        }
        let share = share_inside(&volume.grid(), grid);
        if share == 0.0 {
            return Err(Error::usage(
                format!(
                    "--with {name}: it lies beside the volume, and nothing of it would be seen"
                ),
                "`stratavox info FILE` says where a volume lies in the world",
            ));
        }
        // What is projected is projected one by one, each in its own box.
        if share < 1.0 && !self.mode.is_projection() {
            self.progress.note(&format!(
                "{name}: {:.0} % of it lie in the box of the volume, the rest is not seen",
                100.0 * share
            ));
        }
        let function = self.function_with(nth, word, &volume, source.header())?;
        let ends = [function.opacity.first(), function.opacity.last()];
        let [low, high] = ends.map(|point| point.map_or(0.0, |point| point.value));
        self.progress
            .note(&format!("with {name}, from {low:.6} to {high:.6}"));
        Ok(Other {
            volume,
            function,
            role: Role::Numbers,
        })
    }

    fn function_with(
        &self,
        nth: usize,
        word: &WithWord,
        volume: &Volume,
        header: &Header,
    ) -> Result<TransferFunction, Error> {
        let has_function =
            word.preset.is_some() || word.function.is_some() || word.colormap.is_some();
        if self.mode == Mode::Xray && word.window.is_none() {
            return Err(Error::usage(
                "--mode xray of several volumes needs a window of each, of its integrals",
                "--with FILE,window=0:9000",
            ));
        }
        // Of maxima and means a grey would not tell two volumes apart.
        let is_plain = self.mode.is_projection() && !has_function;
        if word.color.is_some() || is_plain {
            let srgb = word
                .color
                .unwrap_or(CHANNEL_COLORS[(nth + 1) % CHANNEL_COLORS.len()]);
            let window = word.window.and_then(|[low, high]| Window::new(low, high));
            return Ok(of_channel(
                &summary(volume),
                srgb,
                classified(self.mode),
                window,
            ));
        }
        let flags = ClassificationFlags {
            preset: word.preset.clone(),
            colormap: word.colormap.clone(),
            transfer_function: word.function.as_ref().map(|f| f.transfer_function.clone()),
            transfer_function_of_fractions: word.function.as_ref().map(|f| f.of_fractions),
            window: word.window.map(WindowWord::Values),
            context: self.scene.is_auto().then(|| context(header)),
            ..ClassificationFlags::default()
        };
        let function = match flags.classification(volume, self.mode)? {
            Classification::Function(function) => function,
            Classification::RangeOfPicture => {
                Window::of_range(volume.value_range).grey(classified(self.mode))
            }
        };
        if function.uses_gradient() {
            return Err(Error::usage(
                "--with: widgets and gradient opacity are for one volume alone, and several are drawn",
                "take a function of the value alone",
            ));
        }
        Ok(function)
    }
}

/// How much of a grid's box lies in that of another one.
fn share_inside(grid: &Grid, other: &Grid) -> f64 {
    let other_from_grid = other.world_from_voxel.inverse() * grid.world_from_voxel;
    let at = |n: u32, k: usize| (f64::from(n) + 0.5) / f64::from(PLACES) * f64::from(grid.dims[k]);
    let all = (0..PLACES.pow(3)).map(|n| [n % PLACES, n / PLACES % PLACES, n / PLACES / PLACES]);
    let is_inside = |[x, y, z]: [u32; 3]| {
        let p = other_from_grid.transform_point3(DVec3::new(at(x, 0), at(y, 1), at(z, 2)));
        p.cmpge(DVec3::ZERO).all() && p.cmple(other.far_corner()).all()
    };
    let inside = all.filter(|&place| is_inside(place)).count();
    inside as f64 / f64::from(PLACES.pow(3))
}

impl Error {
    /// What is said of the words for INPUT, said of those for a volume beside it.
    fn of_with(self, word: &WithWord) -> Self {
        let path = &word.path;
        let Self::Usage { message, hint } = self else {
            return self;
        };
        let message = ["variable", "component", "window"]
            .into_iter()
            .fold(message, |message, key| {
                message.replace(&format!("--{key} "), &format!("--with {path},{key}="))
            });
        let hint = match &*hint {
            "choose one with --variable NAME" => "--with FILE,variable=NAME chooses one".into(),
            "--component 0" => "--with FILE,component=0".into(),
            _ => hint,
        };
        Self::Usage { message, hint }
    }
}
