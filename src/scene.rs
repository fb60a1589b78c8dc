//! Everything that makes one picture.

mod labels_over;

pub(crate) use labels_over::LabelsOver;

use crate::camera::Camera;
use crate::points::{PointField, Points};
use crate::shaders::{Frame, MAX_CHANNELS};
use crate::technique::pathtrace::{Medium, most_extinction};
use crate::technique::preclassified::Law;
use crate::technique::splat::points::reference_length;
use crate::technique::{self, mixture::opacities_have_colors};
use crate::technique::{
    CutFaces, Error, GradientStorage, InPixel, Mode, Role, SampleInputs, Settings, View,
};
use crate::transfer::{Absorption, HomogeneousRanges, Tolerance, TransferFunction};
use crate::volume::Volume;

/// One of several things seen in the same place.
#[derive(Clone, Copy, Debug)]
pub struct Channel<'a> {
    /// On the grid of the scene's volume, or on one of its own: what of it lies in the box of the scene's volume is seen.
    pub volume: &'a Volume,
    /// As [`Scene::transfer`].
    pub transfer: Option<&'a TransferFunction>,
    /// Numbers, labels that lie over (or hide) what the others show, or how opaque the channel before it is.
    pub role: Role,
}

/// What a scene's volume is seen together with, sample by sample.
#[derive(Clone, Copy, Debug, Default)]
pub enum Beside<'a> {
    /// It is alone.
    #[default]
    Nothing,
    /// Other things in the same place, each with a transfer function of its own: in composite a physical mixture,
    /// in modes that project the sum of the pictures of each, and one alone, of numbers, in iso: what colours the
    /// surfaces, by the colours of its function.
    Channels(&'a [Channel<'a>]),
    /// Green, blue, and perhaps alpha; the scene's volume is red. All hold sRGB numbers from 0 to 1, the first
    /// three multiplied with alpha where there is one ([`crate::volume::read_colors`] makes them so). The transfer
    /// function is over alpha, or over luma (0 black to 1 white); its own colours are not used. Composite only.
    Colors(&'a [&'a Volume]),
    /// Green, blue and depth of voxels that are classified already, the scene's volume is red
    /// ([`crate::technique::preclassified::preclassified`] makes them). Of the transfer function only the reference
    /// length is used, which must be that of the depths. Composite only.
    Classified(&'a [&'a Volume]),
    /// It is alone, and its voxels are classified by the transfer function before they are interpolated
    /// ([`mod@crate::technique::preclassified`]): the picture is that of [`Beside::Classified`] with the volumes made so. Composite
    /// only, and a function of values alone.
    Preclassified,
    /// Scattered points, which are drawn in place of the volume: that is [`Points::binned`] of them, and says where they are
    /// and which values they have. By splatting, with [`Splat::of_points`](crate::technique::splat::Splat::of_points), or by rays
    /// through [`Settings::field`]: then the volume is [`Points::binned_within`] of its radius.
    Points(&'a Points),
}

impl<'a> Beside<'a> {
    /// The volumes, in their order.
    pub fn volumes(&self) -> Vec<&'a Volume> {
        match *self {
            Beside::Nothing | Beside::Preclassified | Beside::Points(_) => Vec::new(),
            Beside::Channels(channels) => channels.iter().map(|c| c.volume).collect(),
            Beside::Colors(volumes) | Beside::Classified(volumes) => volumes.to_vec(),
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
    pub fn mix(&self) -> SampleInputs {
        match self.beside {
            Beside::Channels(channels) if !channels.is_empty() => SampleInputs::Channels,
            Beside::Colors(_) | Beside::Classified(_) | Beside::Preclassified => {
                SampleInputs::Colors
            }
            Beside::Nothing | Beside::Channels(_) | Beside::Points(_) => {
                SampleInputs::of_one(self.transfer)
            }
        }
    }

    /// True where a transfer function asks for gradients.
    fn uses_gradient(&self) -> bool {
        let functions = self.transfers().into_iter().flatten();
        functions.into_iter().any(TransferFunction::uses_gradient)
    }

    /// True where gradients make something of the picture.
    pub fn has_gradients(&self) -> bool {
        self.settings.shading.is_some() || self.uses_gradient()
    }

    /// Its volumes, that of the scene first.
    pub fn volumes(&self) -> Vec<&'a Volume> {
        let beside = self.beside.volumes();
        [self.volume].into_iter().chain(beside).collect()
    }

    /// What each volume is; of voxels that are classified each of the four that are made of them.
    pub fn roles(&self) -> Vec<Role> {
        let beside = match self.beside {
            Beside::Channels(channels) => channels.iter().map(|c| c.role).collect(),
            Beside::Nothing | Beside::Points(_) => Vec::new(),
            Beside::Colors(volumes) => vec![Role::Numbers; volumes.len()],
            Beside::Classified(volumes) => vec![Role::Material; volumes.len()],
            Beside::Preclassified => vec![Role::Material; 3],
        };
        [Role::Numbers].into_iter().chain(beside).collect()
    }

    /// Its transfer functions: one for each channel, one for a colour.
    pub fn transfers(&self) -> Vec<Option<&'a TransferFunction>> {
        let beside = match self.beside {
            Beside::Channels(channels) => channels.iter().map(|c| c.transfer).collect(),
            Beside::Nothing
            | Beside::Colors(_)
            | Beside::Classified(_)
            | Beside::Preclassified
            | Beside::Points(_) => Vec::new(),
        };
        [self.transfer].into_iter().chain(beside).collect()
    }

    /// True where voxels are classified, and what they are made of is interpolated.
    pub(crate) fn is_classified(&self) -> bool {
        matches!(self.beside, Beside::Classified(_) | Beside::Preclassified)
    }

    /// By what its voxels are classified, where they are not yet.
    ///
    /// # Errors
    /// [`Error::NoTransferFunction`].
    pub(crate) fn law(&self) -> Result<Option<Law>, Error> {
        if !matches!(self.beside, Beside::Preclassified) {
            return Ok(None);
        }
        let function = self.transfer.ok_or(Error::NoTransferFunction)?;
        let own = function.reference_length;
        Ok(Some(Law {
            function: function.clone(),
            reference_length: own.unwrap_or_else(|| self.default_length()),
            space: self.settings.color_space,
        }))
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
    /// [`Error::NotShaded`], [`Error::NotShadedTogether`], [`Error::NoGradientTransfer`], [`Error::GradientTransferAlone`],
    /// [`Error::NotOccluded`], [`Error::FilterAlone`], [`Error::OpacityOfNothing`], [`Error::NotFor`] and those of
    /// [`Settings::check`].
    pub fn check(&self) -> Result<(), Error> {
        let labels = self.labels_over();
        if !labels.is_empty() {
            // Crop boxes are those of voxels.
            let grid = self.volume.grid();
            if labels.iter().any(|map| map.volume.grid() != grid) {
                return Err(Error::OtherGrid);
            }
            return self.under_labels().check();
        }
        let volumes = self.volumes();
        let grid = self.volume.grid();
        let has_own_grids = volumes.iter().any(|volume| volume.grid() != grid);
        let roles = self.roles();
        let (wanted, limit) = (roles.len(), MAX_CHANNELS as usize);
        // What a voxel is called, and what makes it opaque, are no numbers that can be projected.
        let only_composite = |role: &Role| matches!(role, Role::Labels | Role::Opacity);
        let Settings { mode, filter, .. } = *self.settings;
        self.settings.check()?;
        let are_several = !self.mix().is_of_one();
        if are_several {
            self.settings.check_mixed()?;
        }
        let is_classified = self.is_classified();
        self.law()?;
        self.settings.check_splatted(are_several, is_classified)?;
        self.settings
            .check_points(matches!(self.beside, Beside::Points(_)))?;
        let are_points = matches!(self.beside, Beside::Points(_));
        let is_one = self.mix() == SampleInputs::Scalar && !are_points;
        let are_numbers = self.mix() != SampleInputs::Colors && !are_points;
        self.settings
            .check_path_volume(are_numbers && !has_own_grids, 1)?;
        self.settings.check_path_functions(&self.transfers())?;
        self.settings.check_scattering_volume(is_one, 1)?;
        self.settings.check_scattering_function(self.transfer)?;
        if self.uses_gradient() {
            self.settings.check_graded()?;
        }
        self.settings.check_holes(self.volume.validity.is_some())?;
        if self.settings.gradient_storage == GradientStorage::Precomputed
            && self.volume.validity.is_some()
        {
            let reason = "where voxels have no data, neighbours of what is zero would be too";
            return Err(Error::NotKept { reason });
        }
        if self.settings.shading.is_some() && mode.is_projection() {
            return Err(Error::NotShaded { mode });
        }
        if self.settings.ambient_occlusion.is_some() && mode.is_projection() {
            return Err(Error::NotOccluded { mode });
        }
        if self.uses_gradient() && mode.is_projection() {
            return Err(Error::NoGradientTransfer { mode });
        }
        // The picture of the maximum has no gradient.
        if self.uses_gradient() && mode == Mode::Mida && self.settings.per_mode.mida_gamma > 0.0 {
            return Err(Error::NoGradientTransfer { mode });
        }
        if is_classified && matches!(self.settings.cut_faces, Some(CutFaces::Grey(_))) {
            return Err(Error::NotFor {
                wanted: "a window of greys on cut faces",
                of: "values",
                found: "classified voxels".to_owned(),
            });
        }
        match self.mix() {
            mix if mix.is_of_one() => Ok(()),
            _ if self.uses_gradient() => Err(Error::GradientTransferAlone),
            SampleInputs::Channels if mode == Mode::Iso => self.check_painted(),
            _ if self.settings.check_lit_mixture().is_err() => self.settings.check_lit_mixture(),
            // Modes that project draw them one by one.
            _ if filter.kernel().is_some() && !mode.is_projection() => {
                Err(Error::FilterAlone { filter })
            }
            SampleInputs::Colors if has_own_grids => Err(Error::OtherGrid),
            SampleInputs::Colors if is_classified && wanted != 4 => {
                Err(Error::NoColor { found: wanted })
            }
            SampleInputs::Colors if !(3..=4).contains(&wanted) => {
                Err(Error::NoColor { found: wanted })
            }
            SampleInputs::Colors if mode != Mode::Composite => Err(Error::NotMixed { mode }),
            SampleInputs::Channels if mode == Mode::Mida => Err(Error::NotMixed { mode }),
            SampleInputs::Channels if mode.is_projection() && roles.iter().any(only_composite) => {
                Err(Error::NotMixed { mode })
            }
            SampleInputs::Channels if !opacities_have_colors(&roles) => {
                Err(Error::OpacityOfNothing)
            }
            _ if wanted > limit => Err(Error::TooManyChannels { wanted, limit }),
            _ if has_own_grids => self.settings.check_own_grids(),
            _ => Ok(()),
        }
    }

    /// Surfaces of the first volume are coloured by one other, of numbers.
    fn check_painted(&self) -> Result<(), Error> {
        let Settings { mode, filter, .. } = *self.settings;
        match self.beside {
            Beside::Channels([one]) if one.role == Role::Numbers => {
                if filter.kernel().is_some() {
                    return Err(Error::FilterAlone { filter });
                }
                match one.transfer {
                    None => Err(Error::NoTransferFunction),
                    Some(function) if function.uses_gradient() => Err(Error::GradientTransferAlone),
                    Some(_) => Ok(()),
                }
            }
            _ => Err(Error::NotMixed { mode }),
        }
    }

    /// World length that opacities are for: the transfer function's own, else the smallest spacing; of scattered points as
    /// much as lies along a ray through the centre of one of the median standard deviation, or the radius of their field.
    pub fn reference_length(&self) -> f64 {
        self.transfer
            .map_or_else(|| self.default_length(), |f| self.length_of(f))
    }

    /// World length that the opacities of `function` are for: so much less of denser matter that scatters light once.
    pub fn length_of(&self, function: &TransferFunction) -> f64 {
        let own = function.reference_length;
        own.unwrap_or_else(|| self.default_length()) / self.settings.density_of_rays()
    }

    /// How a function of this scene takes light away: of matter that scatters by what it says of that.
    pub(crate) fn absorption(&self, function: &TransferFunction) -> Absorption {
        self.settings.absorption(function, self.default_length())
    }

    /// Tells the parameters what paths want to know of the volume and its function, for a device that ends loops after so many turns.
    ///
    /// # Errors
    /// Where matter is too dense for paths.
    pub(crate) fn tell_paths(
        &self,
        frame: &mut Frame,
        max_loop_turns: u32,
    ) -> Result<(), technique::Error> {
        let (true, Some(function)) = (self.settings.technique.traces_paths(), self.transfer) else {
            return Ok(());
        };
        let medium = Medium {
            function,
            absorption: self.absorption(function),
            has_holes: self.volumes().iter().any(|v| v.validity.is_some()),
            is_searched: self.settings.conformance,
            value_range: self.volume.value_range,
            smallest_spacing: self.volume.grid().smallest_spacing(),
            beside: (self.mix() == SampleInputs::Channels).then(|| {
                let others = self.transfers().into_iter().skip(1).flatten();
                let most = others.map(|f| most_extinction(f, self.absorption(f)));
                most.sum()
            }),
        };
        let fields = self.settings.path.fields_of(&medium)?;
        fields.tell(frame, max_loop_turns)
    }

    /// Between which values samples look alike, where steps adapt to that.
    pub(crate) fn alike(&self) -> Option<HomogeneousRanges> {
        let (error, function) = self.settings.adaptive_steps.zip(self.transfer)?;
        let tolerance = Tolerance {
            error,
            longest_ray: self.volume.grid().diagonal(),
        };
        let length = self.length_of(function);
        Some(HomogeneousRanges::new(
            function,
            length,
            self.settings.color_space,
            tolerance,
        ))
    }

    /// The field of its points, where rays are cast through that.
    pub(crate) fn point_field(&self) -> Option<PointField> {
        match (self.beside, self.settings.field) {
            (Beside::Points(points), Some(kernel)) => Some(PointField::new(points, kernel)),
            _ => None,
        }
    }

    fn default_length(&self) -> f64 {
        match self.beside {
            Beside::Points(points) => match &self.settings.field {
                Some(field) => field.radius,
                None => reference_length(points.median_std()),
            },
            _ => self.volume.grid().smallest_spacing(),
        }
    }
}

/// Where in the pixel its rays go through: in the middles of a regular grid, or at a place of each of its cells that
/// depends on the pixel, and others in each picture of a film.
pub fn positions_in_pixel(settings: &Settings) -> impl Iterator<Item = InPixel> + use<> {
    let per_side = settings.rays_per_side;
    let is_uneven = settings.uneven_rays && per_side > 1;
    let cell_pixels = if is_uneven {
        1.0 / f64::from(per_side)
    } else {
        0.0
    };
    let at = move |i: u32| (f64::from(i) + 0.5) / f64::from(per_side) - 0.5;
    let cell = move |x: u32, y: u32| InPixel {
        at: [at(x), at(y)],
        cell_pixels,
    };
    (0..per_side).flat_map(move |y| (0..per_side).map(move |x| cell(x, y)))
}

impl<'a> Scene<'a> {
    /// The view through one position in each pixel.
    pub fn view(&self, grid: &'a crate::volume::Grid, in_pixel: impl Into<InPixel>) -> View<'a> {
        View {
            grid,
            camera: self.camera,
            extent_pixels: self.extent_pixels,
            in_pixel: in_pixel.into(),
            settings: self.settings,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::Jitter;

    #[test]
    fn uneven_rays_go_through_each_cell_of_each_pixel_once_and_elsewhere_in_the_next_frame() {
        let volume = Volume::from_voxels(
            [4; 3],
            glam::DAffine3::IDENTITY,
            crate::volume::Voxels::U8(vec![0; 64]),
            crate::volume::Rescale::default(),
            None,
        );
        let volume = volume.expect("64 voxels");
        let camera = Camera {
            eye: glam::dvec3(2.0, 2.0, -9.0),
            target: glam::dvec3(2.0, 2.0, 0.0),
            up: glam::DVec3::Y,
            projection: crate::camera::Projection::Orthographic { view_height: 4.0 },
            zoom: 1.0,
        };
        // From the middles of their cells, in sides of a cell, for each ray of each of 32 x 32 pixels.
        let places = |uneven_rays, seed, frame| {
            let settings = Settings {
                rays_per_side: 3,
                uneven_rays,
                jitter: Jitter { seed, frame },
                ..Settings::default()
            };
            let scene = Scene {
                volume: &volume,
                transfer: None,
                beside: Beside::Nothing,
                camera: &camera,
                extent_pixels: [32; 2],
                settings: &settings,
            };
            let grid = volume.grid();
            let rays = positions_in_pixel(&settings).flat_map(|in_pixel| {
                let frame = scene.view(&grid, in_pixel).on_cpu();
                let frame = frame.expect("parameters").frame;
                let pixels = (0..32 * 32).map(|i| [i % 32, i / 32].map(|n| f64::from(n) + 0.5));
                let place = move |pixel: [f64; 2]| {
                    let found = crate::ray::place_in_pixel(&frame, pixel);
                    [0, 1].map(|k| 3.0 * (found[k] - pixel[k]))
                };
                pixels.map(place).collect::<Vec<_>>()
            });
            rays.collect::<Vec<_>>()
        };
        assert!(places(false, 3, 1).iter().all(|place| *place == [0.0; 2]));
        let uneven = places(true, 3, 1);
        let count = uneven.len() as f64;
        assert!(uneven.iter().flatten().all(|x| (-0.5..=0.5).contains(x)));
        let mean =
            |number: &dyn Fn(usize) -> f64| (0..uneven.len()).map(number).sum::<f64>() / count;
        // Five standard errors of even numbers on [-1/2, 1/2] and of products of two of them.
        for axis in [0, 1] {
            let x = |i: usize| uneven[i % uneven.len()][axis];
            assert!(mean(&x).abs() < 5.0 * (1.0 / 12.0 / count).sqrt());
            let square = mean(&|i| x(i) * x(i));
            assert!((square - 1.0 / 12.0).abs() < 5.0 * (1.0 / 180.0 / count).sqrt());
            // The neighbour to the right, the one below, the next ray.
            for step in [1, 32, 1024] {
                let together = mean(&|i| x(i) * x(i + step));
                assert!(together.abs() < 5.0 / 12.0 / count.sqrt(), "{step}");
            }
        }
        let both = mean(&|i| uneven[i][0] * uneven[i][1]);
        assert!(both.abs() < 5.0 / 12.0 / count.sqrt());
        assert_eq!(uneven, places(true, 3, 1));
        assert_ne!(uneven, places(true, 4, 1));
        assert_ne!(uneven, places(true, 3, 2));
    }
}
