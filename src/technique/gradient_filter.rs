//! Which operator makes gradients, of which field: chosen apart from the filter that makes values.

use super::{Error, Filter, Settings, View};
use crate::resident::{GpuTransfer, GpuVolume, KeptOperator, TextureLayout};
use crate::shaders::{
    FrameFields, GRADIENT_CATMULL_ROM, GRADIENT_CENTRAL, GRADIENT_CUBIC, GRADIENT_KEPT,
    GRADIENT_KEPT_SOBEL, GRADIENT_LINEAR, GRADIENT_QUADRATIC, GRADIENT_SOBEL,
};
use crate::volume::{Spline, kernel::Kernel};

/// How gradients are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GradientFilter {
    /// Central differences, one voxel before and after, of the values as [`Settings::filter`] makes them.
    #[default]
    Central,
    /// The same of the trilinear field, whatever the filter.
    Linear,
    /// Sobel's 3 x 3 x 3 operator on the trilinear field, whatever the filter: smoother where voxels are noisy.
    Sobel,
    /// The derivative of the cubic B-spline through the voxels, whatever the filter.
    Cubic,
    /// The derivative of the filter's own kernel. Nearest and linear filters have none that is of use: it is zero, or
    /// jumps from voxel to voxel.
    Analytic,
}

/// Whether gradients are made where a sample is taken, or once at the voxels and kept beside them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GradientStorage {
    /// Made for each sample.
    #[default]
    OnTheFly,
    /// Kept; where they cannot be, the picture is refused.
    Precomputed,
    /// Kept where they can be and a graphics card has the memory, else made: on software devices they are no faster.
    Auto,
}

/// What makes a gradient of neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// Differences of filtered values.
    Central,
    /// Central differences of voxels.
    Linear,
    /// Sobel's.
    Sobel,
    /// The derivative of a kernel.
    Kernel(Kernel),
}

impl Operator {
    /// Its number in the parameters.
    pub(super) fn number(self) -> u32 {
        match self {
            Self::Central => GRADIENT_CENTRAL,
            Self::Linear => GRADIENT_LINEAR,
            Self::Sobel => GRADIENT_SOBEL,
            Self::Kernel(Kernel::Quadratic) => GRADIENT_QUADRATIC,
            Self::Kernel(Kernel::Cubic) => GRADIENT_CUBIC,
            Self::Kernel(Kernel::CatmullRom) => GRADIENT_CATMULL_ROM,
        }
    }
}

/// What an operator reads that does not take values from the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GradientSource {
    /// The voxels.
    Voxels,
    /// Coefficients along all three axes, in stacks too.
    Coefficients(Spline),
}

impl GradientSource {
    /// The spline of the coefficients.
    pub fn spline(self) -> Option<Spline> {
        match self {
            Self::Voxels => None,
            Self::Coefficients(spline) => Some(spline),
        }
    }
}

impl Settings {
    /// What makes the gradients. Central differences of linear values need no other way than those of all values.
    pub fn gradient_operator(&self) -> Operator {
        match self.gradient_filter {
            GradientFilter::Linear if self.filter == Filter::Linear => Operator::Central,
            GradientFilter::Central => Operator::Central,
            GradientFilter::Linear => Operator::Linear,
            GradientFilter::Sobel => Operator::Sobel,
            GradientFilter::Cubic => Operator::Kernel(Kernel::Cubic),
            GradientFilter::Analytic => self
                .filter
                .kernel()
                .map_or(Operator::Central, Operator::Kernel),
        }
    }

    /// What it reads; `None`: values as the filter makes them.
    pub fn gradient_source(&self) -> Option<GradientSource> {
        let spline = match (self.gradient_operator(), self.gradient_filter) {
            (Operator::Central, _) => return None,
            (Operator::Linear | Operator::Sobel, _) => None,
            (Operator::Kernel(_), GradientFilter::Cubic) => Some(Spline::Cubic),
            (Operator::Kernel(_), _) => self.filter.spline(),
        };
        Some(spline.map_or(GradientSource::Voxels, GradientSource::Coefficients))
    }

    /// The same where a volume that lies like this for its values does not hold it: a texture beside. Stacks hold
    /// coefficients along two axes, gradients want three.
    pub fn gradient_source_beside(&self, layout: TextureLayout) -> Option<GradientSource> {
        let source = self.gradient_source()?;
        let is_held = source.spline() == self.filter.spline()
            && (source == GradientSource::Voxels || layout == TextureLayout::Texture3d);
        (!is_held).then_some(source)
    }

    /// What can be kept at the voxels: operators on the trilinear field, which are linear in them; not in conformance
    /// pictures, which leave no filtering to the device.
    pub fn kept_operator(&self) -> Option<KeptOperator> {
        match (self.gradient_operator(), self.filter) {
            _ if self.conformance => None,
            (Operator::Linear, _) | (Operator::Central, Filter::Linear) => {
                Some(KeptOperator::Differences)
            }
            (Operator::Sobel, _) => Some(KeptOperator::Sobel),
            (Operator::Central | Operator::Kernel(_), _) => None,
        }
    }

    /// Whether the filter has a derivative, and what is to be kept can be.
    pub(super) fn check_gradient_filter(&self) -> Result<(), Error> {
        let filter = self.filter;
        if self.gradient_filter == GradientFilter::Analytic && filter.kernel().is_none() {
            return Err(Error::NoDerivative { filter });
        }
        let reason = match self.kept_operator() {
            Some(_) => return Ok(()),
            None if self.gradient_storage != GradientStorage::Precomputed => return Ok(()),
            None if self.conformance => "a conformance picture leaves no filtering to the device",
            None => "only operators on the trilinear field are the same between kept ones",
        };
        Err(Error::NotKept { reason })
    }
}

impl View<'_> {
    /// Where gradients count: how texels of what they are made of become codes.
    pub(super) fn set_gradients(
        &self,
        volume: &GpuVolume,
        transfer: Option<&GpuTransfer>,
        fields: &mut FrameFields,
    ) -> Result<(), Error> {
        let counts =
            self.settings.shading.is_some() || transfer.is_some_and(GpuTransfer::uses_gradient);
        if !counts {
            return Ok(());
        }
        let operator = self.settings.kept_operator();
        let kept = volume.kept_gradients();
        let kept = kept.filter(|kept| operator == Some(kept.operator()));
        match (self.settings.gradient_storage, kept) {
            (GradientStorage::Precomputed | GradientStorage::Auto, Some(kept)) => {
                fields.gradient_operator = match kept.operator() {
                    KeptOperator::Differences => GRADIENT_KEPT,
                    KeptOperator::Sobel => GRADIENT_KEPT_SOBEL,
                };
                fields.gradient_scale = kept.scale();
                return Ok(());
            }
            (GradientStorage::Precomputed, None) => {
                let reason = "the volume on the device has none";
                return Err(Error::NotKept { reason });
            }
            _ => {}
        }
        let Some(wanted) = self.settings.gradient_source() else {
            return Ok(());
        };
        let is_beside = volume.gradient_source().is_some();
        let read = volume.gradient_source().unwrap_or(volume);
        let found = read.spline();
        let wanted_beside = self.settings.gradient_source_beside(volume.layout());
        let is_hidden = volume.kept_gradients().is_some();
        if is_hidden || found != wanted.spline() || wanted_beside.is_some() && !is_beside {
            return Err(Error::WrongGradientSource { wanted, found });
        }
        let coding = read.texel().coding;
        fields.gradient_scale = coding.scale;
        fields.gradient_codes_are_integers = coding.is_integer.into();
        Ok(())
    }
}
