//! Everything that makes one picture.

use crate::camera::Camera;
use crate::shaders::MAX_CHANNELS;
use crate::technique::{Error, Keep, Mix, Mode, Role, Settings, View};
use crate::transfer::TransferFunction;
use crate::volume::Volume;

/// One of several things seen in the same place.
#[derive(Clone, Copy, Debug)]
pub struct Channel<'a> {
    /// On the grid of the scene's volume.
    pub volume: &'a Volume,
    /// As [`Scene::transfer`].
    pub transfer: Option<&'a TransferFunction>,
    /// Numbers, or labels that lie over (or hide) what the others show.
    pub role: Role,
}

/// What a scene's volume is seen together with, sample by sample.
#[derive(Clone, Copy, Debug, Default)]
pub enum Beside<'a> {
    /// It is alone.
    #[default]
    Nothing,
    /// Other things in the same place, each with a transfer function of its own: in composite a physical mixture,
    /// in modes that project the sum of the pictures of each.
    Channels(&'a [Channel<'a>]),
    /// Green, blue, and perhaps alpha; the scene's volume is red. All hold sRGB numbers from 0 to 1, the first
    /// three multiplied with alpha where there is one ([`crate::volume::read_colors`] makes them so). The transfer
    /// function is over alpha, or over luma (0 black to 1 white); its own colours are not used. Composite only.
    Colors(&'a [&'a Volume]),
}

impl<'a> Beside<'a> {
    /// The volumes, in their order.
    pub fn volumes(&self) -> Vec<&'a Volume> {
        match *self {
            Beside::Nothing => Vec::new(),
            Beside::Channels(channels) => channels.iter().map(|c| c.volume).collect(),
            Beside::Colors(volumes) => volumes.to_vec(),
        }
    }
}

/// A volume, how it is classified, who looks at it, and what is computed.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// What is shown.
    pub volume: &'a Volume,
    /// Value to colour and opacity; `None`: grey over the range of the projected values of this picture
    /// (projecting modes only).
    pub transfer: Option<&'a TransferFunction>,
    /// What the volume is seen together with.
    pub beside: Beside<'a>,
    /// The eye.
    pub camera: &'a Camera,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// The words of the picture.
    pub settings: &'a Settings,
}

impl<'a> Scene<'a> {
    /// How its volumes go together.
    pub fn mix(&self) -> Mix {
        match self.beside {
            Beside::Channels(channels) if !channels.is_empty() => Mix::Channels,
            Beside::Colors(_) => Mix::Colors,
            _ if self.is_graded() => Mix::Graded,
            Beside::Nothing | Beside::Channels(_) => Mix::Alone,
        }
    }

    /// True where a transfer function asks for gradients.
    fn is_graded(&self) -> bool {
        let functions = self.transfers().into_iter().flatten();
        functions.into_iter().any(TransferFunction::is_graded)
    }

    /// True where gradients make something of the picture.
    pub fn has_gradients(&self) -> bool {
        self.settings.shading.is_some() || self.is_graded()
    }

    /// Its volumes, that of the scene first.
    pub fn volumes(&self) -> Vec<&'a Volume> {
        let beside = self.beside.volumes();
        [self.volume].into_iter().chain(beside).collect()
    }

    /// What each volume is.
    pub fn roles(&self) -> Vec<Role> {
        let beside = match self.beside {
            Beside::Channels(channels) => channels.iter().map(|c| c.role).collect(),
            Beside::Nothing => Vec::new(),
            Beside::Colors(volumes) => vec![Role::Numbers; volumes.len()],
        };
        [Role::Numbers].into_iter().chain(beside).collect()
    }

    /// Its transfer functions: one for each channel, one for a colour.
    pub fn transfers(&self) -> Vec<Option<&'a TransferFunction>> {
        let beside = match self.beside {
            Beside::Channels(channels) => channels.iter().map(|c| c.transfer).collect(),
            Beside::Nothing | Beside::Colors(_) => Vec::new(),
        };
        [self.transfer].into_iter().chain(beside).collect()
    }

    /// The scenes whose pictures are added up: modes that project classify the channels one by one.
    pub fn projected(&self) -> Vec<Self> {
        let one = |(volume, transfer)| Self {
            volume,
            transfer,
            beside: Beside::Nothing,
            ..*self
        };
        let channels = self.volumes().into_iter().zip(self.transfers());
        channels.map(one).collect()
    }

    /// Whether its volumes can be put together.
    ///
    /// # Errors
    /// [`Error::OtherGrid`], [`Error::TooManyChannels`], [`Error::NoColor`], [`Error::NotMixed`],
    /// [`Error::NotShaded`], [`Error::NotShadedTogether`], [`Error::NotGraded`], [`Error::NotGradedTogether`],
    /// [`Error::FilterAlone`], and those of [`Settings::check`].
    pub fn check(&self) -> Result<(), Error> {
        let volumes = self.volumes();
        let (wanted, limit) = (volumes.len(), MAX_CHANNELS as usize);
        let grid = self.volume.grid();
        let has_labels = self.roles().contains(&Role::Labels);
        let Settings { mode, filter, .. } = *self.settings;
        self.settings.check()?;
        if self.mix() != Mix::Alone {
            self.settings.check_mixed()?;
        }
        if self.is_graded() {
            self.settings.check_graded()?;
        }
        if self.settings.keep_gradients == Keep::Always && self.volume.validity.is_some() {
            let reason = "where voxels have no data, neighbours of what is zero would be too";
            return Err(Error::NotKept { reason });
        }
        if self.settings.shading.is_some() && mode.is_projection() {
            return Err(Error::NotShaded { mode });
        }
        if self.is_graded() && mode.is_projection() {
            return Err(Error::NotGraded { mode });
        }
        match self.mix() {
            Mix::Alone | Mix::Graded => Ok(()),
            _ if self.is_graded() => Err(Error::NotGradedTogether),
            _ if self.settings.shading.is_some() => Err(Error::NotShadedTogether),
            // Modes that project draw them one by one.
            _ if filter.kernel().is_some() && !mode.is_projection() => {
                Err(Error::FilterAlone { filter })
            }
            _ if volumes.iter().any(|volume| volume.grid() != grid) => Err(Error::OtherGrid),
            Mix::Colors if !(3..=4).contains(&wanted) => Err(Error::NoColor { found: wanted }),
            Mix::Colors if mode != Mode::Composite => Err(Error::NotMixed { mode }),
            Mix::Channels if matches!(mode, Mode::Mida | Mode::Iso) => {
                Err(Error::NotMixed { mode })
            }
            Mix::Channels if mode.is_projection() && has_labels => Err(Error::NotMixed { mode }),
            _ if wanted > limit => Err(Error::TooManyChannels { wanted, limit }),
            _ => Ok(()),
        }
    }

    /// World length that opacities are for: the transfer function's own, else the smallest spacing.
    pub fn reference_length(&self) -> f64 {
        self.transfer
            .map_or_else(|| self.smallest_spacing(), |f| self.length_of(f))
    }

    /// World length that the opacities of `function` are for.
    pub fn length_of(&self, function: &TransferFunction) -> f64 {
        function
            .reference_length
            .unwrap_or_else(|| self.smallest_spacing())
    }

    fn smallest_spacing(&self) -> f64 {
        self.volume.grid().smallest_spacing()
    }
}

/// Where in the pixel its rays go through: a regular grid of `per_side` squared, the centre for one.
pub fn positions_in_pixel(per_side: u32) -> impl Iterator<Item = [f64; 2]> {
    let at = move |i: u32| (f64::from(i) + 0.5) / f64::from(per_side) - 0.5;
    (0..per_side).flat_map(move |y| (0..per_side).map(move |x| [at(x), at(y)]))
}

impl<'a> Scene<'a> {
    /// The view through one position in each pixel.
    pub fn view(&self, grid: &'a crate::volume::Grid, in_pixel: [f64; 2]) -> View<'a> {
        View {
            grid,
            camera: self.camera,
            extent_pixels: self.extent_pixels,
            in_pixel,
            settings: self.settings,
        }
    }
}
