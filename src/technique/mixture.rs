//! Several volumes in one place, put together sample by sample: the words, the parameters, and the CPU reference of
//! `shaders/lib/material_channels.wgsl`, `sample_colors.wgsl` and `material_colors.wgsl`.
//!
//! ```text
//! channels    sigma = sum of sigma_i        c = sum of sigma_i c_i / sigma
//! opacity     c_i of the value of one       sigma_i of the value of the next
//! colours     c as the volumes say it       sigma of alpha, or of luma
//! dimmed      sigma = d sigma                c = y + d (c - y),  y the luminance of c
//! ```
//!
//! The first is a physical mixture: emitters and absorbers in one place, none of which knows of the others, add
//! up their emission and their extinction (Max 1995). It does not depend on the order of channels.

use super::Error;
use super::own_grid::ChannelGrids;
use crate::color::decode_srgb;
use crate::picture::ColorSpace;
use crate::real::Real;
use crate::resident::{Cell, GpuTransfer, GpuVolume};
use crate::shaders::{FrameFields, MAX_CHANNELS};
use crate::transfer::TransferFunction;

/// How volumes go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SampleInputs {
    /// There is one.
    #[default]
    Scalar,
    /// There is one, and its gradient counts.
    ScalarGradient,
    /// The same, for nothing but unhindered light, by central differences.
    Shaded,
    /// The same, by central differences, for such light and to weigh the opacity by its magnitude.
    GradientOpacity,
    /// Each is a thing of its own with a transfer function of its own.
    Channels,
    /// Red, green, blue, and perhaps alpha, of one colour.
    Colors,
}

impl SampleInputs {
    /// How `function` goes with a volume that is alone.
    pub fn of_one(function: Option<&TransferFunction>) -> Self {
        match function.and_then(|function| function.gradient_transfer.as_ref()) {
            None => Self::Scalar,
            Some(gradient_transfer)
                if gradient_transfer.widgets.is_empty() && !gradient_transfer.share.is_empty() =>
            {
                Self::GradientOpacity
            }
            Some(_) => Self::ScalarGradient,
        }
    }

    /// Whether there is one volume.
    pub fn is_of_one(self) -> bool {
        self == Self::Scalar || self.uses_gradient()
    }

    /// Whether gradients count.
    pub fn uses_gradient(self) -> bool {
        matches!(
            self,
            Self::ScalarGradient | Self::Shaded | Self::GradientOpacity
        )
    }

    /// With all that gradients may count for.
    pub(crate) fn general(self) -> Self {
        match self.uses_gradient() {
            true => Self::ScalarGradient,
            false => self,
        }
    }

    /// Its part of a shader's name.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Scalar => "",
            Self::ScalarGradient => ".scalar_gradient",
            Self::Shaded => ".shaded",
            Self::GradientOpacity => ".gradient_opacity",
            Self::Channels => ".channels",
            Self::Colors => ".colors",
        }
    }
}

/// What a channel is among others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Role {
    /// Numbers, filtered as the settings say.
    #[default]
    Numbers,
    /// Names of things: always the nearest, and where they are no data the whole sample is hidden.
    Labels,
    /// Of classified voxels: light, and the optical depth over the reference length ([`super::preclassified`]).
    Material,
    /// How opaque the numbers right before it are, which say the colour. What it is itself is not seen, and where
    /// one of the two has no data neither is the other.
    Opacity,
}

/// One of the volumes that are put together, on the device.
#[derive(Clone, Copy, Debug)]
pub struct GpuChannel<'a> {
    /// Cut into the same bricks as the others ([`GpuVolume::several`]), or on a grid of its own: all in one brick each then.
    pub volume: &'a GpuVolume,
    /// What it is.
    pub role: Role,
}

impl<'a> GpuChannel<'a> {
    /// Numbers.
    pub fn numbers(volume: &'a GpuVolume) -> Self {
        Self {
            volume,
            role: Role::Numbers,
        }
    }
}

/// Fills the lanes of the parameters.
pub(super) fn set_channels(
    parts: &[GpuChannel],
    transfer: Option<&GpuTransfer>,
    fields: &mut FrameFields,
) -> Result<(), Error> {
    let limit = MAX_CHANNELS as usize;
    if parts.len() > limit {
        let wanted = parts.len();
        return Err(Error::TooManyChannels { wanted, limit });
    }
    fields.channel_count = parts.len() as u32;
    fn cells<'a>(part: &GpuChannel<'a>) -> impl Iterator<Item = Cell> + 'a {
        part.volume.bricks().iter().map(|brick| brick.cell)
    }
    let first = *parts[0].volume.grid();
    let grids = parts.iter().map(|part| *part.volume.grid());
    let has_own_grids = grids.clone().any(|grid| grid != first);
    let is_whole = |part: &GpuChannel| part.volume.bricks().len() == 1;
    if has_own_grids && !parts.iter().all(is_whole) {
        return Err(Error::OwnGridsInBricks);
    }
    let ChannelGrids { from_voxel, dims } = ChannelGrids::new(&first, grids);
    (fields.channel_from_voxel, fields.channel_dims) = (from_voxel, dims);
    let is_classified = parts.iter().any(|part| part.role == Role::Material);
    fields.colors_are_classified = is_classified.into();
    for (c, part) in parts.iter().enumerate() {
        let volume = part.volume;
        if !has_own_grids && cells(part).ne(cells(&parts[0])) {
            return Err(Error::OtherGrid);
        }
        let coding = volume.texel().coding;
        fields.channel_code_scale[c] = coding.scale;
        fields.channel_code_offset[c] = coding.offset;
        fields.channel_slope[c] = coding.slope;
        fields.channel_intercept[c] = coding.intercept;
        fields.channel_codes_are_integers[c] = coding.is_integer.into();
        fields.channel_is_labels[c] = (part.role == Role::Labels).into();
        fields.channel_is_opacity[c] = (part.role == Role::Opacity).into();
        fields.channel_has_holes[c] = volume.has_holes().into();
    }
    let layouts = transfer.map_or(&[][..], GpuTransfer::layouts);
    for (c, layout) in layouts.iter().enumerate().take(limit) {
        fields.channel_table_first[c] = layout.table_first;
        fields.channel_table_scale[c] = layout.table_scale;
        fields.channel_table_count[c] = layout.table_count;
        fields.channel_table_row[c] = layout.table_row;
        fields.channel_point_first[c] = layout.point_first;
        fields.channel_color_point_count[c] = layout.color_point_count;
        fields.channel_opacity_point_count[c] = layout.opacity_point_count;
        let is_step = layout.interpolation == crate::transfer::Interpolation::Step;
        fields.channel_interpolation_is_step[c] = is_step.into();
        fields.channel_reference_length[c] = layout.reference_length;
    }
    Ok(())
}

/// Whether each volume that says how opaque another is stands right behind numbers.
pub fn opacities_have_colors(roles: &[Role]) -> bool {
    let is_right = |pair: &[Role]| pair[1] != Role::Opacity || pair[0] == Role::Numbers;
    roles.first() != Some(&Role::Opacity) && roles.windows(2).all(is_right)
}

/// The material of a sample of these values, those of labels all there; `None` for no data. `classify` gives that
/// of one value of a channel, and `lit` the same with the light that falls on it there.
pub fn material_of<R: Real>(
    roles: &[Role],
    values: &[Option<R>],
    classify: impl Fn(usize, R) -> [R; 4],
    lit: impl Fn(usize, R, [R; 4]) -> [R; 4],
) -> Option<[R; 4]> {
    let seen = (0..values.len()).filter(|&c| roles[c] != Role::Opacity);
    let material = |c: usize| {
        let value = values[c]?;
        let own = classify(c, value);
        if roles.get(c + 1) != Some(&Role::Opacity) {
            return Some(lit(c, value, own));
        }
        let ([r, g, b, _], opaque) = (own, values[c + 1]?);
        Some(lit(c + 1, opaque, [r, g, b, classify(c + 1, opaque)[3]]))
    };
    let mut there = seen.filter_map(material).peekable();
    there.peek()?;
    Some(mixed(there))
}

/// The material (red, green, blue, extinction) of several in one place.
pub fn mixed<R: Real>(materials: impl IntoIterator<Item = [R; 4]>) -> [R; 4] {
    let zero = R::from_f64(0.0);
    let mut light = [zero; 3];
    let mut sum = zero;
    for [r, g, b, extinction] in materials {
        let color = [r, g, b];
        light = std::array::from_fn(|c| light[c] + extinction * color[c]);
        sum = sum + extinction;
    }
    if sum == zero {
        return [zero; 4];
    }
    let [r, g, b] = light.map(|c| c / sum);
    [r, g, b, sum]
}

/// The same where a label is dimmed: so much is left of extinction and colour.
pub fn dimmed<R: Real>([r, g, b, extinction]: [R; 4], dim: R) -> [R; 4] {
    let n = R::from_f32;
    let grey = n(0.2126) * r + n(0.7152) * g + n(0.0722) * b;
    let [r, g, b] = [r, g, b].map(|c| grey + dim * (c - grey));
    [r, g, b, dim * extinction]
}

/// The sRGB colour of a sample and the value that its opacity is classified by: luma, or alpha, with which the
/// other three come multiplied.
pub fn color_of<R: Real>(color: [R; 3], alpha: Option<R>) -> ([R; 3], R) {
    let n = R::from_f32;
    match alpha {
        None => {
            let [r, g, b] = color;
            (color, n(0.2126) * r + n(0.7152) * g + n(0.0722) * b)
        }
        Some(alpha) => {
            let share = |c: R| (c / alpha.max(n(1e-6))).max(n(0.0)).min(n(1.0));
            (color.map(share), alpha)
        }
    }
}

/// The material of an sRGB colour.
pub fn colored<R: Real>(srgb: [R; 3], extinction: R, space: ColorSpace) -> [R; 4] {
    let shown = |c: R| match space {
        ColorSpace::Linear => decode_srgb(c),
        ColorSpace::Display => c,
    };
    let [r, g, b] = srgb.map(shown);
    [r, g, b, extinction]
}
