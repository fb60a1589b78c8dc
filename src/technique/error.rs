//! Why a picture cannot be made as asked.

use super::{Filter, GradientSource, Mode, Technique};
use crate::volume::Spline;

/// Why a picture cannot be made as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The step is too small for the volume.
    #[error("a ray through the volume would take {wanted:.0} samples, the limit is {limit}")]
    TooManySamples {
        /// What the longest ray would take.
        wanted: f64,
        /// What a ray may take.
        limit: u32,
    },
    /// Voxels whose materials make no volumes.
    #[error("classified voxels make no volume: {problem}")]
    Classified {
        /// What is wrong with them.
        problem: String,
    },
    /// The driver would cut the ray short.
    #[error(
        "a ray through the volume would take {wanted:.0} samples, and this driver ends its loops after {limit:.0} such \
         samples"
    )]
    LoopsEnd {
        /// What the longest ray would take.
        wanted: f64,
        /// How many there are turns for.
        limit: f64,
        /// The samples per voxel that give so many; `None` where samples lie on slices, whose number is that of voxels.
        samples_per_voxel: Option<f64>,
        /// Whether most of the turns are those of light that is followed from each sample.
        follows_light: bool,
    },
    /// The driver would leave splats out.
    #[error(
        "{wanted:.0} splats of voxels lie near a ray, and this driver ends its loops after {limit:.0} of them"
    )]
    SplatLoopsEnd {
        /// Near the longest ray.
        wanted: f64,
        /// How many there are turns for.
        limit: f64,
    },
    /// Compositing classifies every sample.
    #[error("compositing needs a transfer function")]
    NoTransferFunction,
    /// A volume is on the device in another way than the view's technique reads it.
    #[error("the volume lies on the device as {found:?}, this view reads it as {wanted:?}")]
    WrongLayout {
        /// What [`super::View::texture_layout`] says.
        wanted: crate::resident::TextureLayout,
        /// How the volume lies.
        found: crate::resident::TextureLayout,
    },
    /// A base plane has an eye on one side.
    #[error(
        "the eye lies among the slices that it sees: shear-warp has no base plane there, take raycast"
    )]
    EyeAmongSlices,
    /// Base rays fill an image of a fixed size.
    #[error("the view asks for an intermediate image of {:.0} x {:.0} base pixels, the limit is {} x {}: take fewer base pixels per voxel, another stack, or raycast", .wanted[0], .wanted[1], .limit[0], .limit[1])]
    IntermediateTooLarge {
        /// Base pixels across and down.
        wanted: [f64; 2],
        /// What there is room for.
        limit: [u32; 2],
    },
    /// Several volumes in a mode that has no mixture of them.
    #[error("mode {mode} shows one volume: several are mixed in composite")]
    NotMixed {
        /// The mode.
        mode: Mode,
    },
    /// A way to sample that not all techniques and modes have.
    #[error("{wanted} is for {of}, not for {found}")]
    NotFor {
        /// What was asked for.
        wanted: &'static str,
        /// What has it.
        of: &'static str,
        /// What has not.
        found: String,
    },
    /// The ends of a slab, or of a segment that crosses a surface, lie in voxels that its brick does not hold.
    #[error(
        "the volume lies in bricks, and {what} reach {reach:.1} voxels beyond theirs, the limit is {limit}: take more samples per voxel"
    )]
    SlabsTooLong {
        /// What is long.
        what: &'static str,
        /// Voxels.
        reach: f64,
        /// What bricks hold.
        limit: f64,
    },
    /// The numbers of a colour lie on one grid.
    #[error("the volumes to be mixed lie on different grids, or in different bricks")]
    OtherGrid,
    /// Volumes on grids of their own are mixed where each lies in one texture.
    #[error(
        "volumes on grids of their own are to be mixed, and one of them is too large for one texture of this device"
    )]
    OwnGridsInBricks,
    /// Interpolating splines read coefficients, all others the voxels.
    #[error("the filter {filter} reads {}, and the volume on the device holds {}", held(.filter.spline()), held(*.found))]
    WrongCoefficients {
        /// What was asked for.
        filter: Filter,
        /// What the volume on the device was made of.
        found: Option<Spline>,
    },
    /// Filters over more than two voxels of an axis are made for one volume.
    #[error("the filter {filter} reads one volume: several are mixed with linear or nearest")]
    FilterAlone {
        /// What was asked for.
        filter: Filter,
    },
    /// The parameters hold a fixed number of channels.
    #[error("{wanted} volumes are to be mixed, the limit is {limit}")]
    TooManyChannels {
        /// How many were asked for.
        wanted: usize,
        /// How many there may be.
        limit: usize,
    },
    /// What makes something opaque needs something that it makes opaque.
    #[error(
        "a volume that says how opaque another is stands right behind the numbers that are coloured"
    )]
    OpacityOfNothing,
    /// Colours are red, green, blue, and perhaps alpha.
    #[error("a colour is made of 3 or 4 volumes, not of {found}")]
    NoColor {
        /// How many there are.
        found: usize,
    },
    /// A mode whose samples must come from front to back, in a technique that blends them.
    #[error("{technique} has no mode {mode}, in which a sample depends on those before it")]
    NeedsRays {
        /// The rendering technique.
        technique: Technique,
        /// The mode.
        mode: Mode,
    },
    /// The planes of slicers, in a mode that slicers do not have.
    #[error(
        "mode {mode} takes samples along rays, not on the planes of a slicer, which has no such mode"
    )]
    NeedsRayLattice {
        /// The mode.
        mode: Mode,
    },
    /// Surfaces of no value, or of more than the parameters hold.
    #[error("surfaces of {found} values, wanted 1 to {limit}")]
    LevelCount {
        /// How many were asked for.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// What has an exact extreme is a trilinear field along rays.
    #[error(
        "{technique} in mode {mode}: an exact extreme is one of mip or minip along rays, filtered linearly"
    )]
    NotExact {
        /// The rendering technique.
        technique: Technique,
        /// The mode.
        mode: Mode,
    },
    /// Darkness by depth needs a depth.
    #[error("{technique} in mode {mode} has no one depth a ray: no depth cue")]
    NoDepth {
        /// The rendering technique.
        technique: Technique,
        /// The mode.
        mode: Mode,
    },
    /// A number of a mode that means nothing.
    #[error("{name} is {found}, wanted {wanted}")]
    OutOfRange {
        /// Which number.
        name: &'static str,
        /// What would do.
        wanted: &'static str,
        /// What was given.
        found: f64,
    },
    /// Light falls on what is composited.
    #[error(
        "mode {mode} projects one number a ray, on which no light falls: shading is for composite"
    )]
    NotShaded {
        /// The mode.
        mode: Mode,
    },
    /// Half-angle slices show one volume.
    #[error("half-angle slices are for one volume of numbers, not for several that are mixed")]
    NotShadedTogether,
    /// Light falls on what is composited.
    #[error(
        "mode {mode} projects one number a ray, on which no light falls: ambient occlusion is for composite"
    )]
    NotOccluded {
        /// The mode.
        mode: Mode,
    },
    /// A projected value has no gradient.
    #[error(
        "mode {mode} projects one number a ray, which has no gradient: widgets and gradient opacity are for composite"
    )]
    NoGradientTransfer {
        /// The mode.
        mode: Mode,
    },
    /// Several volumes have several gradients.
    #[error(
        "widgets and gradient opacity are for one volume of numbers, not for several that are mixed"
    )]
    GradientTransferAlone,
    /// Nearest and linear filters have no derivative that is of use.
    #[error(
        "the filter {filter} has no analytic gradient: its derivative is zero, or jumps from voxel to voxel"
    )]
    NoDerivative {
        /// The filter.
        filter: Filter,
    },
    /// Interpolating kept gradients would be another picture.
    #[error("gradients cannot be kept: {reason}")]
    NotKept {
        /// Why.
        reason: &'static str,
    },
    /// Gradients are made of what lies on the device.
    #[error("gradients read {}, and the volume on the device holds {} for them", held(.wanted.spline()), held(*.found))]
    WrongGradientSource {
        /// What [`super::Settings::gradient_source`] says.
        wanted: GradientSource,
        /// What the texture holds that they would read.
        found: Option<Spline>,
    },
    /// The parameters hold a fixed number of lights.
    #[error("{wanted} lights, the limit is {limit}")]
    TooManyLights {
        /// How many were asked for.
        wanted: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A direction has a length.
    #[error("the way to a light has the length 0")]
    NoWayToLight,
    /// The light's picture is that of one light.
    #[error("half-angle slices lie half way to one light, and {wanted} were given")]
    SeveralShadowLights {
        /// How many were asked for.
        wanted: usize,
    },
    /// Slices of all bricks in turn would have to be drawn before the light of the next slice is known.
    #[error(
        "half-angle slices go through all of the volume one by one, from the light: it must lie in one texture of the device, and lies in {bricks} bricks"
    )]
    ShadowsNeedOneBrick {
        /// How many bricks the volume lies in.
        bricks: usize,
    },
    /// Rays that are nearly as flat as the slices, or meet them from the other side.
    #[error(
        "rays of this perspective are up to {degrees:.0} degrees off the normal of slices half way to the light, the limit is {limit_degrees:.0}"
    )]
    TooSteep {
        /// The angle of the ray that is farthest off.
        degrees: f64,
        /// What may be.
        limit_degrees: f64,
    },
    /// The parameters hold a fixed number of planes.
    #[error("{wanted} clip planes, the limit is {limit}")]
    TooManyClipPlanes {
        /// How many were asked for.
        wanted: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl Error {
    /// Refuses a number that is not right.
    pub(super) fn unless(
        is_right: bool,
        name: &'static str,
        wanted: &'static str,
        found: f64,
    ) -> Result<(), Self> {
        match is_right {
            true => Ok(()),
            false => Err(Self::OutOfRange {
                name,
                wanted,
                found,
            }),
        }
    }
}

fn held(spline: Option<Spline>) -> String {
    spline.map_or("voxels".to_owned(), |spline| {
        let name = match spline {
            Spline::Quadratic => "quadratic",
            Spline::Cubic => "cubic",
        };
        format!("coefficients of the {name} spline")
    })
}
